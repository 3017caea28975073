// A scene that a program describes, and a scene that is ready to render.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>

#include "montelux/render.h"
#include "montelux/result.h"
#include "montelux/values.h"

namespace montelux::api {

// Triangles and bilinear patches over common vertices.
struct Mesh {
  std::vector<Vec3> positions;  // in object space
  std::vector<Vec3> normals{};  // one a vertex, of any length; empty: flat faces
  std::vector<Vec2> uvs{};      // one a vertex; empty: (0, 0), (1, 0), (1, 1) at the corners of each triangle
  std::vector<std::uint32_t> triangles{};  // three vertices each; the geometric normal is (p1 - p0) x (p2 - p0)
  std::vector<std::uint32_t> quads{};      // four each, as a patch has them: (u, v) = (0, 0), (1, 0), (0, 1), (1, 1)
  Parameters parameters{};                 // further ones of the shape "trianglemesh", as "alpha"
};

// The participating media on the two sides of a shape; none: empty space.
struct MediumSides {
  std::optional<MediumId> inside{}, outside{};  // outside is where the surface normal points
};

// How a shape looks, and where it is.
struct Surface {
  std::optional<MaterialId> material{};  // default: diffuse of reflectance 0.5
  std::optional<Model> area_light{};     // of the family "area light": the shape emits from the side of its normal
  Transform object_to_world{};           // of a part of an object: to that object's space
  bool reverse_orientation = false;      // the normal points to the other side
  std::optional<ObjectId> object{};      // the shape is a part of that object, and is seen where the object is placed
  MediumSides media{};                   // a shape of material "interface" bounds media and does not scatter
};

enum class TextureKind { number, color };

// The description of a scene: plain data that grows by these calls. None of them fails for what is in the description;
// prepare() reports all that is wrong at once.
class Scene {
 public:
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene);
  ~Scene();

  // Where the names of files (images, meshes) begin; default: the working directory.
  void set_folder(std::filesystem::path folder);
  // The size of the picture in pixels, and further parameters of the film "rgb". Default: 1280 x 720.
  void set_film(int width, int height, Parameters parameters = {});
  // Default: "perspective", at the origin, looking along +z.
  void set_camera(Model camera, const Transform& camera_to_world = {});
  void set_filter(Model filter);          // of pixels; default: "gaussian"
  void set_sampler(Model sampler);        // default: "zsobol", replaced by "blue-noise"
  void set_integrator(Model integrator);  // default: "path"

  MaterialId add_material(Model material);
  // A participating medium ("homogeneous"); its coefficients are per unit of length of the world.
  MediumId add_medium(Model medium);
  // The medium around the camera; default: empty space.
  void set_camera_medium(std::optional<MediumId> medium);
  // Of numbers or of colours, by what its values are.
  TextureId add_texture(TextureKind kind, Model texture, const Transform& texture_to_world = {});
  void add_light(Model light, const Transform& light_to_world = {});
  // A quadric, curves, or a mesh of a file.
  void add_shape(Model shape, const Surface& surface = {});
  void add_mesh(Mesh mesh, const Surface& surface = {});
  // Shapes that are stored once and seen in many places.
  ObjectId add_object();
  void add_instance(ObjectId object, const Transform& object_to_world);

  struct Content;
  const Content& content() const { return *content_; }

 private:
  std::unique_ptr<Content> content_;
};

struct PrepareOptions {
  int threads = 0;  // to build the acceleration structure; 0: all of the machine
};

// What an integrator renders: complete, immutable. May be rendered by several threads at once.
class PreparedScene {
 public:
  struct Parts;
  explicit PreparedScene(std::unique_ptr<Parts> parts);
  PreparedScene(PreparedScene&&) noexcept;
  PreparedScene& operator=(PreparedScene&&) noexcept;
  ~PreparedScene();

  // Of the picture, in pixels.
  int width() const;
  int height() const;
  // Warnings and notes of its preparation.
  const std::vector<Message>& messages() const;

  // Fails where a setting does not fit the scene, and where memory is too small.
  Result<Picture> render(const RenderSettings& settings = {}) const;

 private:
  std::unique_ptr<Parts> parts_;
};

// Checks the description, reads the files that it names and builds the acceleration structure. The error holds a
// message for everything that is wrong. The description may be changed or destroyed afterwards.
Result<PreparedScene> prepare(const Scene& scene, const PrepareOptions& options = {});

// The same for a scene file: .pbrt, .pbrt.gz, .gltf or .glb.
Result<PreparedScene> load(const std::filesystem::path& file, const PrepareOptions& options = {});

}  // namespace montelux::api
