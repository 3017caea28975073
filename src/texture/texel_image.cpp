#include "texture/texel_image.h"

#include <algorithm>
#include <cmath>

namespace montelux {

std::optional<Wrap> parse_wrap(std::string_view name) {
  if (name == "repeat") return Wrap::repeat;
  if (name == "black") return Wrap::black;
  if (name == "clamp") return Wrap::clamp;
  if (name == "octahedralsphere") return Wrap::octahedral;
  return std::nullopt;
}

namespace {

// The channels of a buffer that a texture keeps: one gray or red, green, blue; then alpha.
struct Selection {
  std::vector<int> channels;
  bool alpha = false;
};

Selection select_channels(const PixelBuffer& pixels) {
  std::array<int, 3> rgb = rgb_channels(pixels);
  std::optional<int> alpha = find_channel(pixels, "A");
  bool gray = rgb[0] == rgb[1] && rgb[1] == rgb[2];
  Selection s{gray ? std::vector<int>{rgb[0]} : std::vector<int>(rgb.begin(), rgb.end()), false};
  if (!alpha || *alpha == rgb[0]) return s;
  // Alpha counts only where it says something.
  for (std::size_t i = std::size_t(*alpha); i < pixels.values.size(); i += pixels.channels.size())
    if (pixels.values[i] != 1.0f) {
      s.alpha = true;
      s.channels.push_back(*alpha);
      break;
    }
  return s;
}

// Each selected value through `convert(value, is_alpha)`, interleaved.
template <class T, class Convert>
std::vector<T> packed(const PixelBuffer& pixels, const Selection& s, Convert convert) {
  std::vector<T> values;
  values.reserve(pixels.pixel_count() * s.channels.size());
  const std::size_t stride = pixels.channels.size();
  for (std::size_t i = 0; i < pixels.pixel_count(); ++i)
    for (std::size_t k = 0; k < s.channels.size(); ++k)
      values.push_back(
          convert(pixels.values[i * stride + std::size_t(s.channels[k])], s.alpha && k + 1 == s.channels.size()));
  return values;
}

struct Place {
  int x, y;
  bool inside;
};

int modulo(int a, int n) {
  int r = a % n;
  return r < 0 ? r + n : r;
}

// The texel that stands for (x, y), at most one image away.
Place wrapped(int x, int y, int width, int height, Wrap wrap) {
  if (x >= 0 && y >= 0 && x < width && y < height) return {x, y, true};
  switch (wrap) {
    case Wrap::repeat:
      return {modulo(x, width), modulo(y, height), true};
    case Wrap::clamp:
      return {std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1), true};
    case Wrap::octahedral:
      // Beyond an edge lies its other half, mirrored about the middle.
      if (x < 0 || x >= width) x = x < 0 ? -1 - x : 2 * width - 1 - x, y = height - 1 - y;
      if (y < 0 || y >= height) y = y < 0 ? -1 - y : 2 * height - 1 - y, x = width - 1 - x;
      return {std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1), true};
    case Wrap::black:
      break;
  }
  return {0, 0, false};
}

// s in texels, bounded so that it fits an integer whatever s is (not a number included).
float in_texels(float s, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) s -= std::floor(s);
  return clamp(s * float(size), -float(size), 2.0f * float(size));
}

}  // namespace

Result<TexelImage> TexelImage::read(const std::filesystem::path& path, std::optional<ColorEncoding> encoding) {
  // The values as stored; integers are decoded here.
  Result<Image> file = read_image(path, ColorEncoding{});
  if (!file) return file.failure();
  const bool is_integer = file->stored == SampleType::uint8 || file->stored == SampleType::uint16;
  const ColorEncoding code =
      is_integer ? encoding.value_or(ColorEncoding{ColorEncoding::Kind::srgb, 1.0f}) : ColorEncoding{};
  const PixelBuffer& pixels = file->pixels;
  const Selection selection = select_channels(pixels);
  TexelImage image;
  image.width_ = pixels.width;
  image.height_ = pixels.height;
  image.has_alpha_ = selection.alpha;
  image.color_channels_ = int(selection.channels.size()) - int(selection.alpha);
  if (file->stored == SampleType::uint8) {
    for (int i = 0; i < 256; ++i) image.decoded_[i] = decode(code, float(i) / 255.0f);
    image.texels_ = packed<std::uint8_t>(
        pixels, selection, [](float x, bool) { return std::uint8_t(std::clamp(std::lround(x * 255.0f), 0l, 255l)); });
  } else if (file->stored == SampleType::half) {
    image.texels_ = packed<std::uint16_t>(pixels, selection, [](float x, bool) { return float_to_half(x); });
  } else {
    image.texels_ = packed<float>(pixels, selection,
                                  [&](float x, bool alpha) { return is_integer && !alpha ? decode(code, x) : x; });
  }
  return image;
}

TexelImage TexelImage::from(const PixelBuffer& pixels) {
  const Selection selection = select_channels(pixels);
  TexelImage image;
  image.width_ = pixels.width;
  image.height_ = pixels.height;
  image.has_alpha_ = selection.alpha;
  image.color_channels_ = int(selection.channels.size()) - int(selection.alpha);
  image.texels_ = packed<float>(pixels, selection, [](float x, bool) { return x; });
  return image;
}

std::size_t TexelImage::bytes() const {
  return std::visit([](const auto& v) { return v.size() * sizeof(v[0]); }, texels_);
}

float TexelImage::value(int x, int y, int channel) const {
  std::size_t i =
      (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(channels()) + std::size_t(channel);
  if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&texels_))
    return channel < color_channels_ ? decoded_[(*codes)[i]] : float((*codes)[i]) / 255.0f;
  if (const auto* halves = std::get_if<std::vector<std::uint16_t>>(&texels_)) return half_to_float((*halves)[i]);
  return std::get<std::vector<float>>(texels_)[i];
}

Rgb TexelImage::texel(int x, int y) const {
  const std::size_t i = (std::size_t(y) * std::size_t(width_) + std::size_t(x)) * std::size_t(channels());
  const std::size_t next = is_gray() ? 0 : 1;  // from one primary to the next
  if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&texels_)) {
    const std::uint8_t* c = codes->data() + i;
    return {{decoded_[c[0]], decoded_[c[next]], decoded_[c[2 * next]]}};
  }
  if (const auto* halves = std::get_if<std::vector<std::uint16_t>>(&texels_)) {
    const std::uint16_t* c = halves->data() + i;
    return {{half_to_float(c[0]), half_to_float(c[next]), half_to_float(c[2 * next])}};
  }
  const float* c = std::get<std::vector<float>>(texels_).data() + i;
  return {{c[0], c[next], c[2 * next]}};
}
float TexelImage::alpha_texel(int x, int y) const { return has_alpha_ ? value(x, y, color_channels_) : 1.0f; }
float TexelImage::number_texel(int x, int y) const {
  if (has_alpha_) return value(x, y, color_channels_);
  return is_gray() ? value(x, y, 0) : montelux::average(texel(x, y));
}

template <class Texel>
auto TexelImage::nearest_of(Vec2f st, Wrap wrap, Texel texel_at) const {
  Place p = wrapped(int(std::floor(in_texels(st.x, width_, wrap))), int(std::floor(in_texels(st.y, height_, wrap))),
                    width_, height_, wrap);
  return p.inside ? texel_at(p.x, p.y) : decltype(texel_at(0, 0)){};
}

template <class Texel>
auto TexelImage::bilinear_of(Vec2f st, Wrap wrap, Texel texel_at) const {
  float x = in_texels(st.x, width_, wrap) - 0.5f, y = in_texels(st.y, height_, wrap) - 0.5f;
  float x0 = std::floor(x), y0 = std::floor(y), tx = x - x0, ty = y - y0;
  auto corner = [&](int dx, int dy) {
    Place p = wrapped(int(x0) + dx, int(y0) + dy, width_, height_, wrap);
    return p.inside ? texel_at(p.x, p.y) : decltype(texel_at(0, 0)){};
  };
  return (corner(0, 0) * (1 - tx) + corner(1, 0) * tx) * (1 - ty) + (corner(0, 1) * (1 - tx) + corner(1, 1) * tx) * ty;
}

Rgb TexelImage::nearest(Vec2f st, Wrap wrap) const {
  return nearest_of(st, wrap, [this](int x, int y) { return texel(x, y); });
}
Rgb TexelImage::bilinear(Vec2f st, Wrap wrap) const {
  return bilinear_of(st, wrap, [this](int x, int y) { return texel(x, y); });
}
float TexelImage::nearest_number(Vec2f st, Wrap wrap) const {
  return nearest_of(st, wrap, [this](int x, int y) { return number_texel(x, y); });
}
float TexelImage::bilinear_number(Vec2f st, Wrap wrap) const {
  return bilinear_of(st, wrap, [this](int x, int y) { return number_texel(x, y); });
}
float TexelImage::bilinear_alpha(Vec2f st, Wrap wrap) const {
  return bilinear_of(st, wrap, [this](int x, int y) { return alpha_texel(x, y); });
}

Rgb TexelImage::average(int x0, int y0, int x1, int y1) const {
  std::array<double, spectrum_size> sum{};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      Rgb t = texel(x, y);
      for (int c = 0; c < spectrum_size; ++c) sum[c] += double(t[c]);
    }
  Rgb mean;
  for (int c = 0; c < spectrum_size; ++c) mean[c] = float(sum[c] / (double(x1 - x0) * double(y1 - y0)));
  return mean;
}

}  // namespace montelux
