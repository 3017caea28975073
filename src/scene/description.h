// A scene as a file states it: plain data that can be printed, changed and written again.
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

struct TextureDesc {
  std::string name;
  bool is_spectrum = false;  // else a texture of numbers
  Entity entity;
  Transform texture_to_world;
};

struct MaterialDesc {
  std::string name;  // empty for one that was stated in place
  Entity entity;
};

struct ShapeDesc {
  Entity entity;
  Transform object_to_world;
  bool reverse_orientation = false;
  MaterialDescId material{};
  std::optional<Entity> area_light;
  // Vertices in object space, for trianglemesh, plymesh (already read), and the control mesh of loopsubdiv.
  std::shared_ptr<const Mesh> mesh;
  // Where it moves, at moments evenly spaced up to the end of the transforms' time; object_to_world is that of the
  // start.
  std::vector<Transform> object_to_world_later;
};

struct LightDesc {
  Entity entity;
  Transform light_to_world;
};

// Shapes that are placed by instances; their transforms lead to the object's space.
struct ObjectDesc {
  std::string name;
  std::vector<ShapeDesc> shapes;
};

struct InstanceDesc {
  ObjectDescId object{};
  Transform object_to_world;
  SourceLocation where;
  std::vector<Transform> object_to_world_later;  // where it moves, as that of a shape
};

struct SceneDesc {
  std::string file;    // the file that was read; paths of the description are relative to `folder`
  std::string folder;  // absolute or relative to the working directory
  // Bytes of image files that are a part of the scene file, by the names that the description has for them.
  std::map<std::string, std::shared_ptr<const std::string>> embedded;
  Entity camera{"perspective", {}, {}};
  Transform world_to_camera;
  std::vector<Transform> world_to_camera_later;     // where the camera moves, as that of a shape
  double transforms_start = 0, transforms_end = 1;  // the time from the first transform to the last
  // When the shutter is open, in the same unit, for images whose brightness does not depend on it; none: as the
  // camera's shutteropen and shutterclose say.
  std::optional<std::pair<double, double>> shutter;
  std::optional<double> frame_rate;  // pictures a unit of time, where nothing else is asked for
  // The time that the frames of a sequence share out; none: that of the transforms.
  std::optional<std::pair<double, double>> whole_time;
  int frames_held = 1 << 30;  // of those asked for, from the first on, as many as the transforms are good for
  Entity film{"rgb", {}, {}};
  Entity filter{"gaussian", {}, {}};
  Entity sampler{"zsobol", {}, {}};
  Entity integrator{"volpath", {}, {}};
  Entity accelerator{"bvh", {}, {}};
  ParameterList options;
  std::vector<TextureDesc> textures;
  std::vector<MaterialDesc> materials;  // number 0 is the default material (diffuse)
  std::vector<LightDesc> lights;
  std::vector<ShapeDesc> shapes;
  std::vector<ObjectDesc> objects;
  std::vector<InstanceDesc> instances;
};

}  // namespace montelux
