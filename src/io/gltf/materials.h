// Materials of a glTF document, as materials, area lights and masks of the description.
#pragma once
#include "io/gltf/textures.h"

namespace montelux::gltf {

// What a surface with one material consists of.
struct MaterialUse {
  MaterialDescId id{};
  // For mirrored texture coordinates: the same with the green of the normal map inverted.
  std::optional<MaterialDescId> mirrored;
  std::optional<AreaLightDesc> area_light;
  bool repeats_emission = false;     // its texture repeats beyond its edges, which that of an area light does not
  std::optional<NumberInput> alpha;  // of the shapes
  bool one_sided = false;            // backs are not shown
  int uv_set = 0;
};

class MaterialReader {
 public:
  MaterialReader(Document& document, SceneDesc& scene)
      : document_(document), scene_(scene), textures_(document, scene) {}

  // The material with that number (which must be valid), or with none: glTF's default. Each is read once.
  const MaterialUse& use(std::optional<std::size_t> number);

 private:
  // A factor, and the texture that it multiplies.
  struct Factor {
    Rgb value = gray_rgb(1.0f);
    std::optional<TextureUse> texture;
  };
  MaterialUse read(const Element& material);
  MaterialUse read_unlit(const Element& material);
  SpectrumInput spectrum(const Factor& factor, TexelMeaning meaning);
  NumberInput channel(const Factor& factor, ImageChannel channel);
  void read_specular(const Element& extensions, MetallicRoughnessDesc& base);
  // The same with a coat and a grain, if there are any.
  MaterialModel with_coat_and_grain(const MetallicRoughnessDesc& base, const Element& extensions);
  static SpectrumValue absorption(const Element& volume);
  NormalMapDesc normal_map(const Element& info);
  static std::optional<MaterialDesc> mirrored(const MaterialDesc& material);
  MaterialDescId add(MaterialDesc material, const std::string& name);
  MaterialDescId transmitting(const MaterialDesc& base, const Element& material, const std::string& name);
  MaterialModel glass(const MaterialDesc& base, const Element& material);
  std::optional<AreaLightDesc> emission(const Element& material);
  std::optional<AreaLightDesc> emission_of(const Factor& factor, double scale, const Element& where);
  std::optional<NumberInput> alpha(const Element& material);
  static bool repeats(const std::optional<TextureUse>& texture);
  Factor base_color(const Element& material);
  double base_alpha(const Element& material) const;
  // Records which set of texture coordinates a material uses, and warns if textures differ.
  void note_uv_set(const std::optional<TextureUse>& use, const Element& material);

  Document& document_;
  SceneDesc& scene_;
  TextureReader textures_;
  std::map<std::optional<std::size_t>, MaterialUse> uses_;
  std::optional<int> uv_set_;   // of the current material
  bool has_lost_coat_ = false;  // whether the omitted coat of glass has been reported
};

}  // namespace montelux::gltf
