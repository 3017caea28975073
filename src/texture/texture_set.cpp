#include "texture/texture_set.h"

namespace montelux {

namespace {

template <class V, class Textures>
std::optional<V> constant_of(const Textures& textures, std::size_t i) {
  if (const auto* constant = std::get_if<ConstantTexture<V>>(&textures[i])) return constant->value;
  return std::nullopt;
}

template <class V>
PackOf<V> pack_value(const TextureSet& set, const Texture<V>& texture, const TexturePack& points, TextureMask on) {
  return std::visit(
      [&](const auto& t) -> PackOf<V> {
        if constexpr (requires { t.at(set, points, on); })
          return t.at(set, points, on);
        else
          return point_by_point<V>(t, set, points, on);
      },
      texture);
}

}  // namespace

NumberTextureId TextureSet::add(NumberTexture texture) {
  numbers_.push_back(std::move(texture));
  return NumberTextureId(numbers_.size() - 1);
}
SpectrumTextureId TextureSet::add(SpectrumTexture texture) {
  spectra_.push_back(std::move(texture));
  return SpectrumTextureId(spectra_.size() - 1);
}

float TextureSet::number(NumberTextureId id, const TexturePoint& point) const {
  return std::visit([&](const auto& texture) -> float { return texture.at(*this, point); }, numbers_[std::size_t(id)]);
}
Rgb TextureSet::color(SpectrumTextureId id, const TexturePoint& point) const {
  return std::visit([&](const auto& texture) -> Rgb { return texture.at(*this, point); }, spectra_[std::size_t(id)]);
}
NativeFloats TextureSet::number(NumberTextureId id, const TexturePack& points, TextureMask on) const {
  return pack_value<float>(*this, numbers_[std::size_t(id)], points, on);
}
RgbOf<NativeFloats> TextureSet::color(SpectrumTextureId id, const TexturePack& points, TextureMask on) const {
  return pack_value<Rgb>(*this, spectra_[std::size_t(id)], points, on);
}

std::optional<float> TextureSet::constant(NumberTextureId id) const {
  return constant_of<float>(numbers_, std::size_t(id));
}
std::optional<Rgb> TextureSet::constant(SpectrumTextureId id) const {
  return constant_of<Rgb>(spectra_, std::size_t(id));
}

TextureSet::ImageKey TextureSet::key_of(const std::filesystem::path& path,
                                        const std::optional<ColorEncoding>& encoding) {
  return {path.lexically_normal().string(), encoding ? to_string(*encoding) : std::string()};
}

Result<TexelImage> TextureSet::read(const std::filesystem::path& path,
                                    const std::optional<ColorEncoding>& encoding) const {
  const auto embedded = embedded_.find(path.lexically_normal().string());
  return embedded == embedded_.end() ? TexelImage::read(path, encoding)
                                     : TexelImage::read(path, *embedded->second, encoding);
}

Result<std::shared_ptr<const TexelImage>> TextureSet::image(const std::filesystem::path& path,
                                                            std::optional<ColorEncoding> encoding) {
  auto [place, is_new] = images_.try_emplace(key_of(path, encoding));
  if (is_new) {
    Result<TexelImage> image = read(path, encoding);
    if (!image) {
      images_.erase(place);
      return image.failure();
    }
    place->second = std::make_shared<const TexelImage>(std::move(image).value());
  }
  return place->second;
}

void TextureSet::read_ahead(const std::vector<ImageRequest>& requests, const ForEachNumber& for_each) {
  std::map<ImageKey, const ImageRequest*> wanted;
  for (const ImageRequest& request : requests) {
    const ImageKey key = key_of(request.path, request.encoding);
    if (!images_.contains(key)) wanted.try_emplace(key, &request);
  }
  if (wanted.empty()) return;
  const std::vector<std::pair<ImageKey, const ImageRequest*>> list(wanted.begin(), wanted.end());
  std::vector<std::shared_ptr<const TexelImage>> images(list.size());
  for_each(list.size(), [&](std::size_t i) {
    Result<TexelImage> image = read(list[i].second->path, list[i].second->encoding);
    if (image) images[i] = std::make_shared<const TexelImage>(std::move(image).value());
  });
  for (std::size_t i = 0; i < list.size(); ++i)
    if (images[i]) images_.emplace(list[i].first, std::move(images[i]));
}

void TextureSet::embed(const std::filesystem::path& path, std::shared_ptr<const std::string> bytes) {
  embedded_[path.lexically_normal().string()] = std::move(bytes);
}

std::size_t TextureSet::image_bytes() const {
  std::size_t sum = 0;
  for (const auto& [key, image] : images_) sum += image->bytes();
  return sum;
}

}  // namespace montelux
