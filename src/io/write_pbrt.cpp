#include "io/write_pbrt.h"

#include <set>

#include "image/output_file.h"
#include "io/numbers.h"
#include "io/pbrt/parameters.h"
#include "io/pbrt/picture.h"
#include "light/table.h"
#include "material/table.h"
#include "medium/table.h"
#include "scene/shape_models.h"
#include "texture/table.h"

namespace montelux {

namespace {

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n')
      result += "\\n";
    else
      result += c;
  }
  return result + "\"";
}

// A value as written between brackets.
std::string value_text(float v) { return shortest(v); }
std::string value_text(int v) { return std::to_string(v); }
std::string value_text(std::uint32_t v) { return std::to_string(v); }
std::string value_text(std::uint8_t v) { return v ? "true" : "false"; }
std::string value_text(const std::string& v) { return in_quotes(v); }
std::string value_text(Vec2f v) { return shortest(v.x) + " " + shortest(v.y); }
std::string value_text(Vec3f v) { return shortest(v.x) + " " + shortest(v.y) + " " + shortest(v.z); }
std::string value_text(const SpectrumValue& v) {
  if (const auto* rgb = std::get_if<RgbValue>(&v))
    return value_text(Vec3f{rgb->rgb.c[0], rgb->rgb.c[1], rgb->rgb.c[2]});
  if (const auto* name = std::get_if<NamedSpectrum>(&v)) return in_quotes(name->name);
  if (const auto* blackbody = std::get_if<Blackbody>(&v)) return shortest(blackbody->kelvin);
  std::string text;
  const auto& sampled = std::get<SampledValue>(v);
  for (std::size_t i = 0; i < sampled.values.size(); ++i)
    text += (i ? " " : "") + shortest(sampled.wavelengths[i]) + " " + shortest(sampled.values[i]);
  return text;
}

template <class T>
std::string array_text(std::string_view type_and_name, const std::vector<T>& values) {
  std::string text = " " + in_quotes(type_and_name) + " [";
  for (const T& value : values) text += " " + value_text(value);
  return text + " ]";
}

std::string_view type_word(const Parameter& parameter) {
  if (parameter.type != ParameterType::spectrum) return pbrt::spelling(parameter.type);
  const auto* values = std::get_if<std::vector<SpectrumValue>>(&parameter.values);
  if (!values || values->empty() || std::holds_alternative<RgbValue>(values->front())) return "rgb";
  return std::holds_alternative<Blackbody>(values->front()) ? "blackbody" : "spectrum";
}

std::string parameter_text(const Parameter& parameter) {
  std::string header = std::string(type_word(parameter)) + " " + parameter.name;
  if (const auto* name = std::get_if<TextureName>(&parameter.values))
    return " " + in_quotes(header) + " [ " + in_quotes(name->name) + " ]";
  return std::visit(
      [&](const auto& values) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(values)>, TextureName>)
          return {};
        else
          return array_text(header, values);
      },
      parameter.values);
}

std::string parameters_text(const ParameterList& list) {
  std::string text;
  for (const Parameter& parameter : list.all()) text += parameter_text(parameter);
  return text;
}

std::string transform_text(const Transform& transform) {
  if (transform.is_identity()) return {};
  std::string text = "Transform [";
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) text += " " + shortest(transform.matrix().m[row][column]);
  return text + " ]\n";
}

// Only the last of the later transforms: pbrt's format has no others.
std::string moving_transform_text(const Transform& start, const std::vector<Transform>& later) {
  if (later.empty()) return transform_text(start);
  // The preceding transform may differ at either end.
  const auto whole = [](const Transform& t) { return t.is_identity() ? std::string("Identity\n") : transform_text(t); };
  return "ActiveTransform StartTime\n" + whole(start) + "ActiveTransform EndTime\n" + whole(later.back()) +
         "ActiveTransform All\n";
}

class Writer {
 public:
  explicit Writer(const SceneDesc& scene) : scene_(scene) { name_materials(); }

  std::string write() {
    write_options();
    text_ += "WorldBegin\n";
    // Resets the medium of the camera: each shape states its own media.
    if (has_camera_medium()) text_ += "MediumInterface \"\" \"\"\n";
    for (const TextureDesc& texture : scene_.textures) write_texture(texture);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) write_material(i);
    for (const LightDesc& light : scene_.lights) {
      write_colored(light_models().write(name_of(light.model), light), "light", [&](const Entity& entity) {
        write_block(light.light_to_world, "LightSource " + entity_text(entity));
      });
    }
    for (const ObjectDesc& object : scene_.objects) {
      text_ += "ObjectBegin " + in_quotes(object.name) + "\n";
      for (const ShapeDesc& shape : object.shapes) write_shape(shape);
      text_ += "ObjectEnd\n";
    }
    for (const ShapeDesc& shape : scene_.shapes) write_shape(shape);
    for (const InstanceDesc& instance : scene_.instances)
      write_block(instance.object_to_world,
                  "ObjectInstance " + in_quotes(scene_.objects[static_cast<std::size_t>(instance.object)].name),
                  instance.object_to_world_later);
    return std::move(text_);
  }

 private:
  static std::string entity_text(const Entity& entity) {
    return in_quotes(entity.type) + parameters_text(entity.parameters);
  }

  static Entity stated_material(const MaterialDesc& material) {
    return material_models().write(name_of(material.model), material);
  }
  // The default material is written without a name as long as it has not been changed.
  bool is_default(std::size_t i) const {
    if (i != 0 || !scene_.materials[i].name.empty()) return false;
    const Entity entity = stated_material(scene_.materials[i]);
    return entity.type == "diffuse" && entity.parameters.all().empty();
  }

  void name_materials() {
    std::set<std::string> taken;
    for (const MaterialDesc& material : scene_.materials) taken.insert(material.name);
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
      std::string name = scene_.materials[i].name;
      if (name.empty() && !is_default(i)) {
        name = "unnamed-" + std::to_string(i);
        while (taken.contains(name)) name += "'";
        taken.insert(name);
      }
      material_names_.push_back(name);
    }
  }

  void state_color_space(const std::string& space) {
    if (!space.empty() && space != color_space_) text_ += "ColorSpace " + in_quotes(space) + "\n";
    if (!space.empty()) color_space_ = space;
  }

  // The colour space of an rgb value; empty for other parameters.
  static std::string color_space_of(const Parameter& parameter) {
    if (const auto* values = std::get_if<std::vector<SpectrumValue>>(&parameter.values))
      for (const SpectrumValue& value : *values)
        if (const auto* rgb = std::get_if<RgbValue>(&value)) return rgb->color_space;
    return {};
  }
  static std::string color_space_of(const Entity& entity) {
    for (const Parameter& parameter : entity.parameters.all())
      if (std::string space = color_space_of(parameter); !space.empty()) return space;
    return {};
  }

  // Writes an entity in the colour space of its first rgb value. Those in others are stated before it, as defaults of
  // `family` in a block of their own.
  template <class Write>
  void write_colored(const Entity& entity, std::string_view family, Write write) {
    const std::string space = color_space_of(entity);
    Entity own{entity.type, {}, {}};
    std::vector<Parameter> others;
    for (const Parameter& parameter : entity.parameters.all()) {
      const std::string its = color_space_of(parameter);
      if (its.empty() || its == space)
        own.parameters.add(parameter);
      else
        others.push_back(parameter);
    }
    const std::string before = color_space_;
    if (!others.empty()) text_ += "AttributeBegin\n";
    for (const Parameter& parameter : others) {
      state_color_space(color_space_of(parameter));
      text_ += "Attribute " + in_quotes(family) + parameter_text(parameter) + "\n";
    }
    state_color_space(space);
    write(own);
    if (others.empty()) return;
    text_ += "AttributeEnd\n";
    color_space_ = before;
  }

  void write_block(const Transform& transform, const std::string& content, const std::vector<Transform>& later = {}) {
    text_ += "AttributeBegin\n" + moving_transform_text(transform, later) + content + "\nAttributeEnd\n";
  }

  void write_options() {
    const pbrt::StatedPicture picture = pbrt::stated_picture(scene_);
    for (const Parameter& option : picture.options.all()) text_ += "Option" + parameter_text(option) + "\n";
    text_ += "Film " + entity_text(picture.film) + "\n";
    text_ += "PixelFilter " + entity_text(picture.filter) + "\n";
    text_ += "Sampler " + entity_text(picture.sampler) + "\n";
    text_ += "Integrator " + entity_text(picture.integrator) + "\n";
    // A scene without motion may have no interval.
    const bool has_times = scene_.transforms_start < scene_.transforms_end;
    if (has_times && (scene_.transforms_start != 0 || scene_.transforms_end != 1))
      text_ += "TransformTimes " + shortest(scene_.transforms_start) + " " + shortest(scene_.transforms_end) + "\n";
    for (const MediumDesc& medium : scene_.media) write_medium(medium);
    if (has_camera_medium()) text_ += "MediumInterface \"\" " + medium_name(scene_.camera_medium) + "\n";
    text_ += moving_transform_text(scene_.world_to_camera, scene_.world_to_camera_later);
    text_ += "Camera " + entity_text(picture.camera) + "\n";
  }

  void write_texture(const TextureDesc& texture) {
    write_colored(texture_models().write(name_of(texture.model), texture), "texture", [&](const Entity& entity) {
      const std::string text = "Texture " + in_quotes(texture.name) +
                               (texture.is_spectrum ? " \"spectrum\" " : " \"float\" ") + entity_text(entity);
      if (texture.texture_to_world.is_identity())
        text_ += text + "\n";
      else
        write_block(texture.texture_to_world, text);
    });
  }

  void write_material(std::size_t i) {
    if (is_default(i)) return;
    write_colored(stated_material(scene_.materials[i]), "material", [&](const Entity& entity) {
      text_ += "MakeNamedMaterial " + in_quotes(material_names_[i]) + " \"string type\" [ " + in_quotes(entity.type) +
               " ]" + parameters_text(entity.parameters) + "\n";
    });
  }

  void write_medium(const MediumDesc& medium) {
    if (!medium.model) return;  // left out by a lenient reading
    const Entity entity = medium_models().write(name_of(*medium.model), *medium.model);
    state_color_space(color_space_of(entity));
    text_ += "MakeNamedMedium " + in_quotes(medium.name) + " \"string type\" [ " + in_quotes(entity.type) + " ]" +
             parameters_text(entity.parameters) + "\n";
  }
  std::string medium_name(std::optional<MediumDescId> id) const {
    const bool is_there = id && scene_.media[std::size_t(*id)].model;
    return in_quotes(is_there ? scene_.media[std::size_t(*id)].name : "");
  }

  bool has_camera_medium() const { return medium_name(scene_.camera_medium) != in_quotes(""); }

  static std::string mesh_text(const Mesh& mesh) {
    std::string text = array_text("point3 P", mesh.positions);
    if (!mesh.normals.empty()) text += array_text("normal N", mesh.normals);
    if (!mesh.tangents.empty()) text += array_text("vector3 S", mesh.tangents);
    if (!mesh.uvs.empty()) text += array_text("point2 uv", mesh.uvs);
    std::vector<Vec3f> positions, normals;
    for (const MeshPose& pose : mesh.later) {
      positions.insert(positions.end(), pose.positions.begin(), pose.positions.end());
      normals.insert(normals.end(), pose.normals.begin(), pose.normals.end());
    }
    if (!positions.empty()) text += array_text("point3 P1", positions);
    if (!normals.empty()) text += array_text("normal N1", normals);
    return text + array_text("integer indices", mesh.quads.empty() ? mesh.triangles : mesh.quads);
  }

  void write_shape(const ShapeDesc& shape) {
    std::string text, emission;
    if (shape.area_light) {
      const Entity entity = area_light_models().write("diffuse", *shape.area_light);
      state_color_space(color_space_of(entity));
      emission = "AreaLightSource " + entity_text(entity) + "\n";
    }
    const std::string& material = material_names_[static_cast<std::size_t>(shape.material)];
    if (!material.empty()) text += "NamedMaterial " + in_quotes(material) + "\n";
    if (shape.reverse_orientation) text += "ReverseOrientation\n";
    const std::string inside = medium_name(shape.media.inside), outside = medium_name(shape.media.outside);
    if (inside != outside) text += "MediumInterface " + inside + " " + outside + "\n";
    text += emission + "Shape " + entity_text(shape_models().write(name_of(shape.form), shape));
    // The mesh of a file stays in that file.
    const auto* form = std::get_if<MeshForm>(&shape.form);
    const bool is_in_file = form && !form->file.empty();
    if (const auto mesh = mesh_of(shape); mesh && !is_in_file) text += mesh_text(*mesh);
    write_block(shape.object_to_world, text, shape.object_to_world_later);
  }

  const SceneDesc& scene_;
  std::vector<std::string> material_names_;
  std::string color_space_ = "srgb";
  std::string text_;
};

}  // namespace

std::string write_pbrt(const SceneDesc& scene) { return Writer(scene).write(); }

Status write_pbrt_file(const SceneDesc& scene, const std::string& path) { return write_file(path, write_pbrt(scene)); }

}  // namespace montelux
