// Images as used by textures and lights: compact in memory, decoded when looked up.
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "color/rgb.h"
#include "color/transfer.h"
#include "image/image_file.h"
#include "texture/wrap.h"

namespace montelux {

// One colour channel (grey) or three, and possibly alpha. Row 0 is the top. Positions (s, t) range over [0, 1]^2 from
// the upper left corner of the image; texel (x, y) covers [x, x + 1) / width by [y, y + 1) / height. Values are linear.
// Immutable, so that threads can share it.
class TexelImage {
 public:
  // 8-bit and half-precision values are stored unchanged. `encoding` states the meaning of integers (default: sRGB);
  // floating-point values are linear. An alpha channel that is 1 throughout is dropped.
  static Result<TexelImage> read(const std::filesystem::path& path, std::optional<ColorEncoding> encoding);
  // The same for a file in memory; messages call it by the name.
  static Result<TexelImage> read(const std::filesystem::path& name, const std::string& bytes,
                                 std::optional<ColorEncoding> encoding);
  // From linear values.
  static TexelImage from(const PixelBuffer& pixels);

  int width() const { return width_; }
  int height() const { return height_; }
  bool is_gray() const { return color_channels_ == 1; }
  bool has_alpha() const { return has_alpha_; }
  std::size_t bytes() const;

  // The texel (x, y), which must be within the image.
  Rgb texel(int x, int y) const;
  // 1 if there is no alpha.
  float alpha_texel(int x, int y) const;

  // The nearest texel, and the interpolation of the four nearest.
  Rgb nearest(Vec2f st, Wrap wrap) const;
  Rgb bilinear(Vec2f st, Wrap wrap) const;
  // The image as numbers: alpha if there is any, else the mean of the colour channels.
  float nearest_number(Vec2f st, Wrap wrap) const;
  float bilinear_number(Vec2f st, Wrap wrap) const;
  float bilinear_alpha(Vec2f st, Wrap wrap) const;
  // One channel of the image: red, green, blue, or alpha (3).
  float nearest_channel(Vec2f st, Wrap wrap, int channel) const;
  float bilinear_channel(Vec2f st, Wrap wrap, int channel) const;
  // bilinear() for a pack, bit for bit, with the look-ups of all lanes in flight together. Zero in idle lanes.
  RgbOf<NativeFloats> bilinear(const Vec2<NativeFloats>& st, Wrap wrap, Mask<NativeFloats> on) const;

  // The mean of the texels with x in [x0, x1) and y in [y0, y1), which must not be empty.
  Rgb average(int x0, int y0, int x1, int y1) const;

 private:
  // Without texels yet. `channels`: the number of colour and alpha channels.
  TexelImage(int width, int height, int channels, bool has_alpha)
      : width_(width), height_(height), color_channels_(channels - int(has_alpha)), has_alpha_(has_alpha) {}

  static TexelImage from(const Image& file, std::optional<ColorEncoding> encoding);
  float value(int x, int y, int channel) const;
  float number_texel(int x, int y) const;
  float channel_texel(int x, int y, int channel) const;
  int channels() const { return color_channels_ + int(has_alpha_); }
  template <class Texel>
  auto nearest_of(Vec2f st, Wrap wrap, Texel texel) const;
  template <class Texel>
  auto bilinear_of(Vec2f st, Wrap wrap, Texel texel) const;
  // The texels with these numbers, counted along rows. Not for halves.
  RgbOf<NativeFloats> texels(Uint<NativeFloats> number) const;

  int width_, height_, color_channels_;
  bool has_alpha_;
  // 8-bit codes (followed by three zero bytes, so that each can be read as a 32-bit word), bits of halves, or
  // floats; interleaved.
  std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> texels_;
  std::array<float, 256> decoded_{};  // of the 8-bit colour codes
};

// The float of the same value (IEEE 754 binary16), and the bits of the half nearest to a float (ties to even).
float half_to_float(std::uint16_t bits);
std::uint16_t float_to_half(float x);

}  // namespace montelux
