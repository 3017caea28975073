// A scene as stated by a file: plain data that can be printed, changed and written again.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "math/transform.h"
#include "parameter/value.h"

namespace montelux {

enum class MaterialDescId : std::uint32_t {};
enum class ObjectDescId : std::uint32_t {};
enum class MediumDescId : std::uint32_t {};

struct TextureDesc {
  std::string name;
  bool is_spectrum = false;  // false: a texture of numbers
  Entity entity;
  Transform texture_to_world;
};

struct MaterialDesc {
  std::string name;  // empty if it was stated in place
  Entity entity;
};

struct MediumDesc {
  std::string name;
  Entity entity;
};

// The media on the two sides of a surface; none: empty space. `outside` is where the oriented normal points.
struct MediumSidesDesc {
  std::optional<MediumDescId> inside, outside;
};

struct ShapeDesc {
  Entity entity;
  Transform object_to_world;
  bool reverse_orientation = false;
  MaterialDescId material{};
  std::optional<Entity> area_light;
  // Vertices in object space, for trianglemesh, plymesh (already read), and the control mesh of loopsubdiv.
  std::shared_ptr<const Mesh> mesh;
  // The transforms of a moving shape at times evenly spaced up to the end of the transforms' time; object_to_world is
  // that at the start.
  std::vector<Transform> object_to_world_later;
  MediumSidesDesc media{};
};

struct LightDesc {
  Entity entity;
  Transform light_to_world;
};

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

struct SceneDesc {
  std::string file;    // the file that was read; paths of the description are relative to `folder`
  std::string folder;  // absolute or relative to the working directory
  // Bytes of image files that are contained in the scene file, by the names that the description uses for them.
  std::map<std::string, std::shared_ptr<const std::string>> embedded;
  Entity camera{"perspective", {}, {}};
  Transform world_to_camera;
  std::vector<Transform> world_to_camera_later;     // of a moving camera, like that of a shape
  double transforms_start = 0, transforms_end = 1;  // the time from the first transform to the last
  // The exposure interval, in the same unit, for images whose brightness does not depend on it; none: as given by
  // the camera's shutteropen and shutterclose.
  std::optional<std::pair<double, double>> shutter;
  std::optional<double> frame_rate;  // default frames per unit of time
  // The time that the frames of a sequence divide; none: that of the transforms.
  std::optional<std::pair<double, double>> whole_time;
  int frames_held = 1 << 30;  // how many of the requested frames, from the first on, the transforms are valid for
  Entity film{"rgb", {}, {}};
  Entity filter{"gaussian", {}, {}};
  Entity sampler{"zsobol", {}, {}};
  Entity integrator{"volpath", {}, {}};
  Entity accelerator{"bvh", {}, {}};
  ParameterList options;
  std::vector<TextureDesc> textures;
  std::vector<MaterialDesc> materials;  // number 0 is the default material (diffuse)
  std::vector<MediumDesc> media;
  std::optional<MediumDescId> camera_medium;  // in which the camera stands
  std::vector<LightDesc> lights;
  std::vector<ShapeDesc> shapes;
  std::vector<ObjectDesc> objects;
  std::vector<InstanceDesc> instances;
};

}  // namespace montelux
