// A scene as stated by a file or a program: plain data that can be printed, changed and written again. It is in the
// terms of Montelux; each reader translates those of its format.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "camera/description.h"
#include "filter/description.h"
#include "geometry/curve.h"
#include "geometry/mesh.h"
#include "light/description.h"
#include "light/light.h"
#include "material/description.h"
#include "math/transform.h"
#include "mc/point_set.h"
#include "medium/description.h"
#include "parameter/value.h"
#include "texture/description.h"

namespace montelux {

enum class MaterialDescId : std::uint32_t {};
enum class ObjectDescId : std::uint32_t {};
enum class MediumDescId : std::uint32_t {};

// The media on the two sides of a surface; none: empty space. `outside` is where the oriented normal points.
struct MediumSidesDesc {
  std::optional<MediumDescId> inside, outside;
};

// The forms of shapes, in object space. Angles are in degrees.
struct MeshForm {
  std::shared_ptr<const Mesh> mesh;
  // The file that it was read from, and those of its later poses; empty: it is in the scene file.
  std::string file{};
  std::vector<std::string> later_files{};
};
struct SubdivisionForm {
  std::shared_ptr<const Mesh> control;  // triangles
  int levels = 3;                       // of Loop's subdivision
};
struct SphereForm {
  float radius = 1;
  std::optional<float> z_min{}, z_max{};  // none: all of it
  float phi_max = 360;
};
struct DiskForm {
  float radius = 1, inner_radius = 0;
  float height = 0;  // its z
  float phi_max = 360;
};
struct CylinderForm {
  float radius = 1;
  float z_min = -1, z_max = 1;
  float phi_max = 360;
};
using ShapeForm = std::variant<MeshForm, SubdivisionForm, SphereForm, DiskForm, CylinderForm, CurveDesc>;

struct ShapeDesc {
  ShapeForm form;
  SourceLocation where{};
  std::optional<NumberInput> alpha{};  // opacity; none: 1
  bool one_sided = false;              // the camera does not see the back of a mesh
  Transform object_to_world{};
  // The transforms of a moving shape at times evenly spaced up to the end of the transforms' time; object_to_world is
  // that at the start.
  std::vector<Transform> object_to_world_later{};
  bool reverse_orientation = false;
  MaterialDescId material{};
  std::optional<AreaLightDesc> area_light{};
  MediumSidesDesc media{};
};

// The vertices of a mesh, or of the control mesh of a subdivision surface; null for other forms.
inline std::shared_ptr<const Mesh> mesh_of(const ShapeDesc& shape) {
  if (const auto* mesh = std::get_if<MeshForm>(&shape.form)) return mesh->mesh;
  if (const auto* surface = std::get_if<SubdivisionForm>(&shape.form)) return surface->control;
  return nullptr;
}

// Shapes that are placed by instances; their transforms map to the object's space.
struct ObjectDesc {
  std::string name;
  std::vector<ShapeDesc> shapes;
};

struct InstanceDesc {
  ObjectDescId object{};
  Transform object_to_world;
  SourceLocation where;
  std::vector<Transform> object_to_world_later;  // of a moving instance, like that of a shape
};

struct FilmDesc {
  int width = 1280, height = 720;                     // in pixels
  std::optional<std::array<float, 4>> crop_window{};  // x0 x1 y0 y1 of the part to render, in [0, 1]
  std::optional<std::array<int, 4>> pixel_bounds{};   // the same in pixels; it has precedence
  std::optional<float> iso{};                         // sensitivity, which scales the image; none: 100
  std::optional<float> max_component{};               // clamp of a sample's components (biased)
  std::string file{};                                 // to be written
  SourceLocation where{};
};

struct SamplingDesc {
  PointSetKind points = PointSetKind::blue_noise;
  int samples = 16;  // per pixel
  std::uint32_t seed = 0;
  bool pixel_centres = false;  // all samples are in the middle of pixel, lens and shutter (biased)
};

struct IntegratorDesc {
  std::string name = "path";                                    // of integrator_names()
  std::vector<std::pair<std::string, std::string>> settings{};  // name and value, as in "ao:distance=2"
  std::optional<int> max_depth{};                               // maximum number of bounces
  LightSelection light_selection = LightSelection::bvh;
  SourceLocation where{};
};

// A name in the file that Montelux replaces by another one.
struct ReplacedName {
  std::string family, stated, instead;
};

struct SceneDesc {
  std::string file;    // the file that was read; paths of the description are relative to `folder`
  std::string folder;  // absolute or relative to the working directory
  // Bytes of image files that are contained in the scene file, by the names that the description uses for them.
  std::map<std::string, std::shared_ptr<const std::string>> embedded;
  CameraDesc camera;
  Transform world_to_camera;
  std::vector<Transform> world_to_camera_later;     // of a moving camera, like that of a shape
  double transforms_start = 0, transforms_end = 1;  // the time from the first transform to the last
  // The exposure interval, in the same unit, for images whose brightness does not depend on it; none: the camera's.
  std::optional<std::pair<double, double>> shutter;
  std::optional<double> frame_rate;  // default frames per unit of time
  // The time that the frames of a sequence divide; none: that of the transforms.
  std::optional<std::pair<double, double>> whole_time;
  int frames_held = 1 << 30;  // how many of the requested frames, from the first on, the transforms are valid for
  FilmDesc film;
  FilterDesc filter;
  SamplingDesc sampling;
  IntegratorDesc integrator;
  std::vector<ReplacedName> replaced;
  std::vector<TextureDesc> textures;
  std::vector<MaterialDesc> materials;  // number 0 is the default material (diffuse)
  std::vector<MediumDesc> media;
  std::optional<MediumDescId> camera_medium;  // around the camera
  std::vector<LightDesc> lights;
  std::vector<ShapeDesc> shapes;
  std::vector<ObjectDesc> objects;
  std::vector<InstanceDesc> instances;
};

}  // namespace montelux
