// Textures of a glTF document, as textures of the description.
#pragma once
#include "io/gltf/document.h"

namespace montelux::gltf {

// What the texels of an image represent.
enum class TexelMeaning { color, data };

// The content of a textureInfo, checked.
struct TextureUse {
  std::string file;                                // image, relative to the scene's folder, or embedded
  int uv_set = 0;                                  // index n of TEXCOORD_n
  std::array<double, 6> uv_map{1, 0, 0, 0, 1, 0};  // KHR_texture_transform, rows: (u, v) upward to (s, t) upward
  std::array<Fold, 2> folds{};                     // along u and v
  bool nearest = false;
  SourceLocation where;
};

class TextureReader {
 public:
  TextureReader(Document& document, SceneDesc& scene) : document_(document), scene_(scene) {}

  // The texture that a material names ({"index": ...}); nothing if there is none, or none that can be read.
  std::optional<TextureUse> use(const Element& info);

  // The name of a texture of spectra: the image times the factor.
  std::string spectrum(const TextureUse& use, const Rgb& factor, TexelMeaning meaning);
  // The name of a texture of numbers: one channel of the image times the factor.
  std::string number(const TextureUse& use, ImageChannel channel, double factor);
  // The names of two derived textures: the square of the given one, and one that is 1 where the given one is at least
  // `edge`, else 0.
  std::string squared(const std::string& texture);
  std::string threshold(const std::string& texture, double edge);

 private:
  std::optional<std::string> image_file(const Element& image, std::size_t number);
  void read_sampler(const Element& sampler, TextureUse& use) const;
  void read_transform(const Element& transform, TextureUse& use) const;
  static ImageTextureDesc image_of(const TextureUse& use);
  // The name of a new texture with this content.
  std::string add(bool is_spectrum, TextureModel model, const SourceLocation& where);

  Document& document_;
  SceneDesc& scene_;
  std::map<std::size_t, std::optional<std::string>> files_;  // by number of the image
};

}  // namespace montelux::gltf
