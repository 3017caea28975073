#include "texture/texel_image.h"

#include <algorithm>
#include <cmath>

#include "math/byte_gather.h"
#include "math/prefetch.h"

namespace montelux {

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
  // Alpha is used only if it is not constant 1.
  for (std::size_t i = std::size_t(*alpha); i < pixels.values.size(); i += pixels.channels.size())
    if (pixels.values[i] != 1.0f) {
      s.alpha = true;
      s.channels.push_back(*alpha);
      break;
    }
  return s;
}

// Applies `convert(value, is_alpha)` to each selected value; interleaved.
template <class T, class Convert>
std::vector<T> packed(const PixelBuffer& pixels, const Selection& s, Convert convert) {
  const std::size_t stride = pixels.channels.size(), kept = s.channels.size(), count = pixels.pixel_count();
  std::vector<T> values(count * kept);
  for (std::size_t k = 0; k < kept; ++k) {
    const bool is_alpha = s.alpha && k + 1 == kept;
    const float* from = pixels.values.data() + s.channels[k];
    for (std::size_t i = 0; i < count; ++i) values[i * kept + k] = convert(from[i * stride], is_alpha);
  }
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

// The texel that replaces (x, y), which is at most one image away.
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

// s in texels, limited so that it fits an integer for every s (including not a number).
template <class F>
F in_texels(F s, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) return clamp((s - floor(s)) * float(size), 0.0f, float(size));
  return clamp(s * float(size), -float(size), 2.0f * float(size));
}

// The two texels between which x lies along one axis, and whether they are inside the image.
struct Neighbours {
  Uint<NativeFloats> first, second;
  Mask<NativeFloats> first_inside, second_inside;
};
Neighbours neighbours(NativeFloats first, int size, Wrap wrap) {
  using F = NativeFloats;
  const F n(static_cast<float>(size)), zero(0.0f);
  F second = first + 1.0f;
  const Mask<F> first_inside = (first >= zero) & (first < n), second_inside = (second >= zero) & (second < n);
  if (wrap == Wrap::repeat) {
    first = select(first < zero, first + n, first);
    second = select(second >= n, second - n, second);
  }
  return {to_uint(clamp(first, 0.0f, float(size - 1))), to_uint(clamp(second, 0.0f, float(size - 1))), first_inside,
          second_inside};
}

}  // namespace

Result<TexelImage> TexelImage::read(const std::filesystem::path& path, std::optional<ColorEncoding> encoding) {
  // The values as stored; integers are decoded here.
  Result<Image> file = read_image(path, ColorEncoding{});
  if (!file) return file.failure();
  return from(*file, encoding);
}

Result<TexelImage> TexelImage::read(const std::filesystem::path& name, const std::string& bytes,
                                    std::optional<ColorEncoding> encoding) {
  Result<Image> file = read_image(name, bytes, ColorEncoding{});
  if (!file) return file.failure();
  return from(*file, encoding);
}

TexelImage TexelImage::from(const Image& file, std::optional<ColorEncoding> encoding) {
  const bool is_integer = file.stored == SampleType::uint8 || file.stored == SampleType::uint16;
  const ColorEncoding code =
      is_integer ? encoding.value_or(ColorEncoding{ColorEncoding::Kind::srgb, 1.0f}) : ColorEncoding{};
  const PixelBuffer& pixels = file.pixels;
  const Selection selection = select_channels(pixels);
  TexelImage image(pixels.width, pixels.height, int(selection.channels.size()), selection.alpha);
  if (file.stored == SampleType::uint8) {
    for (int i = 0; i < 256; ++i) image.decoded_[i] = decode(code, float(i) / 255.0f);
    // The values are codes over 255, up to rounding.
    auto codes = packed<std::uint8_t>(
        pixels, selection, [](float x, bool) { return std::uint8_t(std::clamp(x * 255.0f, 0.0f, 255.0f) + 0.5f); });
    codes.insert(codes.end(), 3, 0);
    image.texels_ = std::move(codes);
  } else if (file.stored == SampleType::half) {
    image.texels_ = packed<std::uint16_t>(pixels, selection, [](float x, bool) { return float_to_half(x); });
  } else {
    image.texels_ = packed<float>(pixels, selection,
                                  [&](float x, bool alpha) { return is_integer && !alpha ? decode(code, x) : x; });
  }
  return image;
}

TexelImage TexelImage::from(const PixelBuffer& pixels) {
  const Selection selection = select_channels(pixels);
  TexelImage image(pixels.width, pixels.height, int(selection.channels.size()), selection.alpha);
  image.texels_ = packed<float>(pixels, selection, [](float x, bool) { return x; });
  return image;
}

std::size_t TexelImage::bytes() const {
  const std::size_t values = std::size_t(width_) * std::size_t(height_) * std::size_t(channels());
  return std::visit([&](const auto& v) { return values * sizeof(v[0]); }, texels_);
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
  const std::size_t next = is_gray() ? 0 : 1;  // step from one primary to the next
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

float TexelImage::channel_texel(int x, int y, int channel) const {
  if (channel == 3) return alpha_texel(x, y);
  return value(x, y, is_gray() ? 0 : channel);
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

float TexelImage::nearest_channel(Vec2f st, Wrap wrap, int channel) const {
  return nearest_of(st, wrap, [this, channel](int x, int y) { return channel_texel(x, y, channel); });
}
float TexelImage::bilinear_channel(Vec2f st, Wrap wrap, int channel) const {
  return bilinear_of(st, wrap, [this, channel](int x, int y) { return channel_texel(x, y, channel); });
}

RgbOf<NativeFloats> TexelImage::texels(Uint<NativeFloats> number) const {
  using U = Uint<NativeFloats>;
  RgbOf<NativeFloats> r;
  const U first = number * U(std::uint32_t(channels()));
  if (const auto* codes = std::get_if<std::vector<std::uint8_t>>(&texels_)) {
    const U word = gather_bytes(codes->data(), first);
    for (int i = 0; i < rgb_size; ++i)
      r.c[i] = i > 0 && is_gray() ? r.c[0] : gather(decoded_.data(), (word >> (8 * i)) & U(0xffu));
    return r;
  }
  const float* floats = std::get<std::vector<float>>(texels_).data();
  for (int i = 0; i < rgb_size; ++i) r.c[i] = i > 0 && is_gray() ? r.c[0] : gather(floats + i, first);
  return r;
}

RgbOf<NativeFloats> TexelImage::bilinear(const Vec2<NativeFloats>& st, Wrap wrap, Mask<NativeFloats> on) const {
  using F = NativeFloats;
  const RgbOf<F> black = splat<F>(Rgb{});
  const bool is_small = bytes() < (std::size_t(1) << 30);
  if (!is_small || wrap == Wrap::octahedral || std::holds_alternative<std::vector<std::uint16_t>>(texels_)) {
    RgbOf<F> r = black;
    for_each_lane(on, [&](int k) { set_lane(r, k, bilinear(lane(st, k), wrap)); });
    return r;
  }
  const F x = in_texels(st.x, width_, wrap) - 0.5f, y = in_texels(st.y, height_, wrap) - 0.5f;
  const F x0 = floor(x), y0 = floor(y), tx = x - x0, ty = y - y0;
  const Neighbours column = neighbours(x0, width_, wrap), row = neighbours(y0, height_, wrap);
  // The second row lies far from the first in memory: both are loaded at the same time.
  const auto load_row = [&](Uint<F> j) {
    const Uint<F> at = (j * std::uint32_t(width_) + column.first) * std::uint32_t(channels());
    std::visit([&](const auto& texels) { prefetch(texels.data(), at, on); }, texels_);
  };
  load_row(row.first), load_row(row.second);
  const auto corner = [&](Uint<F> i, Mask<F> i_inside, Uint<F> j, Mask<F> j_inside) {
    const RgbOf<F> t = texels(j * std::uint32_t(width_) + i);
    return wrap == Wrap::black ? select(i_inside & j_inside, t, black) : t;
  };
  const RgbOf<F> t00 = corner(column.first, column.first_inside, row.first, row.first_inside);
  const RgbOf<F> t10 = corner(column.second, column.second_inside, row.first, row.first_inside);
  const RgbOf<F> t01 = corner(column.first, column.first_inside, row.second, row.second_inside);
  const RgbOf<F> t11 = corner(column.second, column.second_inside, row.second, row.second_inside);
  const F sx = 1.0f - tx, sy = 1.0f - ty;
  return select(on, (t00 * sx + t10 * tx) * sy + (t01 * sx + t11 * tx) * ty, black);
}

Rgb TexelImage::average(int x0, int y0, int x1, int y1) const {
  std::array<double, rgb_size> sum{};
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      Rgb t = texel(x, y);
      for (int c = 0; c < rgb_size; ++c) sum[c] += double(t[c]);
    }
  Rgb mean;
  for (int c = 0; c < rgb_size; ++c) mean[c] = float(sum[c] / (double(x1 - x0) * double(y1 - y0)));
  return mean;
}

}  // namespace montelux
