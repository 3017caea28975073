#include "scene/prepare.h"

#include <filesystem>
#include <functional>
#include <map>

#include "material/build.h"
#include "material/measured_file.h"
#include "scene/geometry_builder.h"
#include "scene/spectra.h"
#include "texture/build.h"

namespace montelux {

namespace {

// The images that textures, materials and lights will request.
std::vector<ImageRequest> images_of(const SceneDesc& desc) {
  std::vector<ImageRequest> images;
  const auto add = [&](const std::string& file, std::optional<ColorEncoding> encoding) {
    if (!file.empty()) images.push_back({std::filesystem::path(desc.folder) / file, encoding});
  };
  for (const TextureDesc& texture : desc.textures)
    if (const auto* image = std::get_if<ImageTextureDesc>(&texture.model)) add(image->file, image->encoding);
  for (const MaterialDesc& material : desc.materials) add(material.normal_file, ColorEncoding{});
  for (const LightDesc& light : desc.lights)
    std::visit(
        [&](const auto& stated) {
          if constexpr (requires { stated.file; }) add(stated.file, std::nullopt);
        },
        light.model);
  return images;
}

// Prepares one scene, one family at a time. Each family reports its errors and uses a harmless substitute,
// so that one run reports all errors of a scene.
class Preparation {
 public:
  Preparation(const SceneDesc& desc, const PrepareOptions& options, Diagnostics& diagnostics)
      : desc_(desc),
        diagnostics_(diagnostics),
        for_each_(options.for_each),
        picture_(picture_settings(desc, options.resolution, diagnostics)),
        textures_(std::make_unique<TextureSet>()),
        texture_builder_(*textures_, desc.folder, reflectance_rgb, diagnostics) {}

  PreparedScene run() {
    for (const auto& [name, bytes] : desc_.embedded)
      textures_->embed(std::filesystem::path(desc_.folder) / name, bytes);
    if (for_each_) textures_->read_ahead(images_of(desc_), for_each_);
    for (const TextureDesc& t : desc_.textures) texture_builder_.add(t);
    std::vector<Material> materials = make_materials();
    MediumSet media = make_media();
    LightSetBuilder lights;
    GeometryStore geometry = make_geometry(materials, lights);
    for (const LightDesc& light : desc_.lights) lights.add(light, light_inputs(), diagnostics_);
    Vec3f centre = (bounds_.low + bounds_.high) * 0.5f;
    float radius = length(bounds_.high - centre);
    if (bounds_.is_empty()) centre = {0, 0, 0}, radius = 1;

    Scene scene{
        std::move(geometry),
        std::move(textures_),
        {},
        std::move(media),
        medium_number(desc_.camera_medium),
        std::move(lights).build({picture_.light_selection}, centre, radius),
        make_camera(),
        Filter::build(desc_.filter),
        picture_.imaging_ratio,
        bounds_,
        {},
        shutter_of(picture_.shutter_open, picture_.shutter_close, picture_.transforms_start, picture_.transforms_end),
        picture_.pixel_centres};
    // Media in which no path can be cost nothing.
    if (!scene.geometry.bounds_media && scene.camera_medium == empty_space) scene.media = {};
    scene.materials = MaterialSet(std::move(materials), scene.textures.get());
    return {std::move(scene), picture_};
  }

 private:
  std::vector<Material> make_materials();
  MediumSet make_media();
  std::uint32_t medium_number(std::optional<MediumDescId> id) const {
    return id ? medium_numbers_[std::size_t(*id)] : empty_space;
  }
  Camera make_camera();
  void break_mixture_cycles(std::vector<Material>& materials);
  GeometryStore make_geometry(const std::vector<Material>& materials, LightSetBuilder& lights);
  LightInputs light_inputs();
  std::shared_ptr<const LightImage> light_image(const std::string& file, const SourceLocation& where);
  std::shared_ptr<const MeasuredTable> measured_table(const std::string& file, const SourceLocation& where);
  std::optional<std::uint32_t> alpha_of(const ShapeDesc& shape);

  const SceneDesc& desc_;
  Diagnostics& diagnostics_;
  const ForEachNumber& for_each_;
  PictureSettings picture_;
  std::unique_ptr<TextureSet> textures_;
  TextureBuilder texture_builder_;
  std::map<std::string, std::shared_ptr<const LightImage>> light_images_;        // by file
  std::map<std::string, std::shared_ptr<const MeasuredTable>> measured_tables_;  // by path
  CoatTables coat_tables_;
  std::vector<std::uint32_t> medium_numbers_;  // of the description's media, in the scene
  Bounds3 bounds_;
};

std::vector<Material> Preparation::make_materials() {
  std::map<std::string, std::uint32_t> numbers;
  for (std::size_t i = 0; i < desc_.materials.size(); ++i)
    if (!desc_.materials[i].name.empty()) numbers[desc_.materials[i].name] = std::uint32_t(i);
  MaterialInputs inputs{
      texture_builder_,
      metal_rgb,
      unbounded_rgb,
      index_of_refraction,
      [&](const std::string& name) -> std::optional<std::uint32_t> {
        auto found = numbers.find(name);
        if (found == numbers.end()) return std::nullopt;
        return found->second;
      },
      [&](const std::string& file, const SourceLocation& where) { return measured_table(file, where); },
      coat_tables_,
      diagnostics_};
  std::vector<Material> materials;
  for (const MaterialDesc& material : desc_.materials) materials.push_back(build_material(material, inputs));
  if (materials.empty()) materials.push_back(build_material({}, inputs));
  break_mixture_cycles(materials);
  return materials;
}

std::shared_ptr<const MeasuredTable> Preparation::measured_table(const std::string& file, const SourceLocation& where) {
  const std::filesystem::path path = (std::filesystem::path(desc_.folder) / file).lexically_normal();
  auto [place, is_new] = measured_tables_.try_emplace(path.string());
  if (!is_new) return place->second;
  Result<MeasuredTable> table = read_measured_table(path);
  if (table)
    place->second = std::make_shared<const MeasuredTable>(std::move(table).value());
  else
    diagnostics_.error(where, table.error());
  return place->second;
}

// The media in which a path can be: those on the sides of surfaces, and the camera's.
std::vector<bool> media_with_paths(const SceneDesc& desc) {
  std::vector<bool> has_paths(desc.media.size());
  const auto mark = [&](std::optional<MediumDescId> id) {
    if (id) has_paths[std::size_t(*id)] = true;
  };
  const auto mark_sides = [&](const std::vector<ShapeDesc>& shapes) {
    for (const ShapeDesc& shape : shapes)
      if (shape.media.inside != shape.media.outside) mark(shape.media.inside), mark(shape.media.outside);
  };
  mark(desc.camera_medium), mark_sides(desc.shapes);
  for (const ObjectDesc& object : desc.objects) mark_sides(object.shapes);
  return has_paths;
}

// The other media, and those that a lenient reading has left out, are empty space.
MediumSet Preparation::make_media() {
  MediumSet media;
  const MediumInputs inputs{unbounded_rgb, emission_rgb};
  const std::vector<bool> has_paths = media_with_paths(desc_);
  const auto add = [&](const auto& stated) { return media.add(stated.build(inputs)); };
  for (std::size_t i = 0; i < desc_.media.size(); ++i) {
    const std::optional<MediumModel>& model = desc_.media[i].model;
    medium_numbers_.push_back(model && has_paths[i] ? std::visit(add, *model) : empty_space);
  }
  return media;
}

Camera Preparation::make_camera() {
  auto built = [&](const Transform& place) {
    return build_camera(desc_.camera, place, picture_.width, picture_.height, diagnostics_);
  };
  if (desc_.world_to_camera_later.empty()) return built(desc_.world_to_camera);
  std::vector<Transform> later;
  for (const Transform& t : desc_.world_to_camera_later) later.push_back(t.inverted());
  return built(Transform()).moved({desc_.world_to_camera.inverted(), later});
}

// A mixture that contains itself has no value: it is reported and replaced by a diffuse surface.
void Preparation::break_mixture_cycles(std::vector<Material>& materials) {
  enum class Visit { none, open, done };
  std::vector<Visit> visits(materials.size(), Visit::none);
  std::function<bool(std::uint32_t)> has_cycle = [&](std::uint32_t i) {
    if (visits[i] == Visit::open) return true;
    if (visits[i] == Visit::done || !materials[i].mixture) return false;
    visits[i] = Visit::open;
    bool found = false;
    for (std::uint32_t child : materials[i].mixture->children) found = has_cycle(child) || found;
    visits[i] = Visit::done;
    if (!found) return false;
    diagnostics_.error(desc_.materials[i].where, "the mix contains itself");
    materials[i].mixture.reset();
    return false;
  };
  for (std::uint32_t i = 0; i < materials.size(); ++i) has_cycle(i);
}

// Whether a mixture may be an interface. Mixtures do not contain themselves.
bool is_partly_interface(const std::vector<Material>& materials, std::uint32_t number) {
  const std::optional<Mixture>& mixture = materials[number].mixture;
  return mixture && std::ranges::any_of(mixture->children, [&](std::uint32_t child) {
           return materials[child].is_interface || is_partly_interface(materials, child);
         });
}

GeometryStore Preparation::make_geometry(const std::vector<Material>& materials, LightSetBuilder& lights) {
  ShapeInputs inputs{[this](const AreaLightDesc& light) { return emission_of(light, light_inputs(), diagnostics_); },
                     [this](const ShapeDesc& shape) { return alpha_of(shape); },
                     [&](MaterialDescId id) { return materials[std::size_t(id)].is_interface; },
                     [&](MaterialDescId id) { return is_partly_interface(materials, std::uint32_t(id)); },
                     [&](MaterialDescId id) { return uses_parameters(materials[std::size_t(id)]); },
                     [&](const ShapeDesc& shape) -> std::optional<MediumSides> {
                       const MediumSides sides{medium_number(shape.media.inside), medium_number(shape.media.outside)};
                       return sides.inside == sides.outside ? std::nullopt : std::optional(sides);
                     }};
  GeometryBuilder builder(inputs, lights, diagnostics_);
  for (const ShapeDesc& shape : desc_.shapes) builder.add_world_shape(shape);
  for (const ObjectDesc& object : desc_.objects) builder.add_object(object);
  for (const InstanceDesc& instance : desc_.instances) builder.add_instance(instance);
  GeometryStore store = builder.take();
  bounds_ = builder.bounds();
  return store;
}

std::optional<std::uint32_t> Preparation::alpha_of(const ShapeDesc& shape) {
  if (!shape.alpha) return 0;
  const NumberTextureId texture = texture_builder_.number(*shape.alpha);
  if (std::optional<float> constant = textures_->constant(texture)) {
    if (*constant >= 1) return 0;
    if (*constant <= 0) return std::nullopt;
  }
  return std::uint32_t(texture) + 1;
}

LightInputs Preparation::light_inputs() {
  return {emission_rgb,
          [this](const std::string& file, const SourceLocation& where) { return light_image(file, where); }};
}

std::shared_ptr<const LightImage> Preparation::light_image(const std::string& file, const SourceLocation& where) {
  auto [place, is_new] = light_images_.try_emplace(file);
  if (!is_new) return place->second;
  auto image = textures_->image(std::filesystem::path(desc_.folder) / file);
  if (!image) {
    diagnostics_.error(where, image.error());
    return nullptr;
  }
  const TexelImage& texels = **image;
  auto light_image = std::make_shared<LightImage>();
  place->second = light_image;
  light_image->width = texels.width(), light_image->height = texels.height();
  light_image->texels.reserve(std::size_t(texels.width()) * std::size_t(texels.height()));
  for (int y = 0; y < texels.height(); ++y)
    for (int x = 0; x < texels.width(); ++x) light_image->texels.push_back(texels.texel(x, y));
  return light_image;
}

}  // namespace

std::optional<PreparedScene> prepare(const SceneDesc& desc, const PrepareOptions& options, Diagnostics& diagnostics) {
  const int before = diagnostics.errors();
  PreparedScene scene = Preparation(desc, options, diagnostics).run();
  if (diagnostics.errors() > before) return std::nullopt;
  return scene;
}

}  // namespace montelux
