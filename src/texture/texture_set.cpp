#include "texture/texture_set.h"

#include <algorithm>
#include <cmath>

#include "texture/noise.h"

namespace montelux {

namespace {

bool is_even(float whole) { return whole * 0.5f == std::floor(whole * 0.5f); }

bool in_dot(Vec2f st) {
  constexpr float radius = 0.35f, shift = 0.5f - radius;
  auto noise = [](float x, float y) { return gradient_noise({x, y, 0.5f}); };
  float s = std::floor(st.x + 0.5f), t = std::floor(st.y + 0.5f);
  if (noise(s + 0.5f, t + 0.5f) <= 0) return false;
  // The disc stays inside its cell.
  float dx = st.x - (s + shift * noise(s + 1.5f, t + 2.8f));
  float dy = st.y - (t + shift * noise(s + 4.5f, t + 9.8f));
  return dx * dx + dy * dy < radius * radius;
}

Rgb marble_color(float t) {
  constexpr std::array<Rgb, 9> colors{{{{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.5f, 0.5f, 0.5f}},
                                       {{0.6f, 0.59f, 0.58f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.58f, 0.58f, 0.6f}},
                                       {{0.2f, 0.2f, 0.33f}},
                                       {{0.58f, 0.58f, 0.6f}}}};
  constexpr int segments = int(colors.size()) - 3;
  // A cubic Bezier segment by de Casteljau's scheme.
  t = clamp(t, 0.0f, 1.0f);
  int first = std::min(int(t * segments), segments - 1);
  float u = t * segments - float(first);
  std::array<Rgb, 4> p{colors[first], colors[first + 1], colors[first + 2], colors[first + 3]};
  for (int n = 3; n > 0; --n)
    for (int i = 0; i < n; ++i) p[i] = p[i] * (1 - u) + p[i + 1] * u;
  return p[0] * 1.5f;
}

// Looks up a texture of numbers (V is float) or of spectra (V is Rgb) at a point.
template <class V>
struct LookUp {
  const TextureSet& set;
  const TexturePoint& point;

  V operator()(const ConstantTexture<V>& t) const { return t.value; }
  V operator()(const ScaleTexture<V>& t) const { return set.value(t.texture, point) * set.number(t.factor, point); }
  V operator()(const MixTexture<V>& t) const { return blend(t.first, t.second, set.number(t.amount, point)); }
  V operator()(const DirectionMixTexture<V>& t) const {
    return blend(t.across, t.along, abs_dot(point.n, t.direction));
  }
  V operator()(const CheckerboardTexture<V>& t) const {
    float cell;
    if (t.flat) {
      Vec2f st = apply(*t.flat, point);
      cell = std::floor(st.x) + std::floor(st.y);
    } else {
      Vec3f p = t.world_to_texture.point(point.p);
      cell = std::floor(p.x) + std::floor(p.y) + std::floor(p.z);
    }
    return set.value(is_even(cell) ? t.even : t.odd, point);
  }
  V operator()(const BilerpTexture<V>& t) const {
    Vec2f st = apply(t.mapping, point);
    return (t.v00 * (1 - st.x) + t.v10 * st.x) * (1 - st.y) + (t.v01 * (1 - st.x) + t.v11 * st.x) * st.y;
  }
  V operator()(const DotsTexture<V>& t) const {
    return set.value(in_dot(apply(t.mapping, point)) ? t.inside : t.outside, point);
  }
  V operator()(const ImageTexture& t) const {
    Vec2f st = apply(t.mapping, point);
    st.y = 1 - st.y;
    st = t.folded(st);
    if constexpr (std::is_same_v<V, float>) {
      float x = t.scale * number_of(t, st);
      return t.invert ? max(1 - x, 0.0f) : x;
    } else {
      Rgb x = (t.nearest ? t.image->nearest(st, t.wrap) : t.image->bilinear(st, t.wrap)) * t.scale;
      x = per_component([&](float c) { return max(t.invert ? 1 - c : c, 0.0f); }, x);
      return t.tint ? x * *t.tint : x;
    }
  }
  V operator()(const ThresholdTexture& t) const { return set.number(t.texture, point) >= t.edge ? 1.0f : 0.0f; }
  V operator()(const FbmTexture& t) const {
    return fractional_brownian_motion(t.world_to_texture.point(point.p), t.roughness, t.octaves);
  }
  V operator()(const WrinkledTexture& t) const {
    return turbulence(t.world_to_texture.point(point.p), t.roughness, t.octaves);
  }
  V operator()(const WindyTexture& t) const {
    Vec3f p = t.world_to_texture.point(point.p);
    float strength = fractional_brownian_motion(p * 0.1f, 0.5f, 3);
    return std::abs(strength) * fractional_brownian_motion(p, 0.5f, 6);
  }
  V operator()(const MarbleTexture& t) const {
    Vec3f p = t.world_to_texture.point(point.p) * t.scale;
    float vein = p.y + t.variation * fractional_brownian_motion(p, t.roughness, t.octaves);
    return marble_color(0.5f + 0.5f * std::sin(vein));
  }

 private:
  static float number_of(const ImageTexture& t, Vec2f st) {
    if (t.channel)
      return t.nearest ? t.image->nearest_channel(st, t.wrap, *t.channel)
                       : t.image->bilinear_channel(st, t.wrap, *t.channel);
    return t.nearest ? t.image->nearest_number(st, t.wrap) : t.image->bilinear_number(st, t.wrap);
  }
  V blend(TextureId<V> a, TextureId<V> b, float t) const {
    return set.value(a, point) * (1 - t) + set.value(b, point) * t;
  }
};

template <class V, class Textures>
std::optional<V> constant_of(const Textures& textures, std::size_t i) {
  if (const auto* constant = std::get_if<ConstantTexture<V>>(&textures[i])) return constant->value;
  return std::nullopt;
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
  return std::visit(LookUp<float>{*this, point}, numbers_[std::size_t(id)]);
}
Rgb TextureSet::color(SpectrumTextureId id, const TexturePoint& point) const {
  return std::visit(LookUp<Rgb>{*this, point}, spectra_[std::size_t(id)]);
}

std::optional<float> TextureSet::constant(NumberTextureId id) const {
  return constant_of<float>(numbers_, std::size_t(id));
}
std::optional<Rgb> TextureSet::constant(SpectrumTextureId id) const {
  return constant_of<Rgb>(spectra_, std::size_t(id));
}

Result<std::shared_ptr<const TexelImage>> TextureSet::image(const std::filesystem::path& path,
                                                            std::optional<ColorEncoding> encoding) {
  auto [place, is_new] =
      images_.try_emplace({path.lexically_normal().string(), encoding ? to_string(*encoding) : std::string()});
  if (is_new) {
    const auto embedded = embedded_.find(path.lexically_normal().string());
    Result<TexelImage> image = embedded == embedded_.end() ? TexelImage::read(path, encoding)
                                                           : TexelImage::read(path, *embedded->second, encoding);
    if (!image) {
      images_.erase(place);
      return image.failure();
    }
    place->second = std::make_shared<const TexelImage>(std::move(image).value());
  }
  return place->second;
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
