#include "image/display.h"

#include <algorithm>
#include <cmath>

#include "color/transfer.h"

namespace montelux {
namespace {

float hable_segment(float x) {
  return (x * (0.15f * x + 0.05f) + 0.004f) / (x * (0.15f * x + 0.5f) + 0.06f) - 0.02f / 0.3f;
}

float hable(float x) { return hable_segment(2.0f * x) / hable_segment(11.2f); }

float narkowicz(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

std::uint8_t to_byte(float linear) { return std::uint8_t(srgb_encode(linear) * 255.0f + 0.5f); }

}  // namespace

float apply_curve(ToneCurve curve, float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  // Beyond this the curves are flat, and their quotients would overflow.
  float x = std::min(linear, 1e9f);
  float y = curve == ToneCurve::hable ? hable(x) : curve == ToneCurve::aces ? narkowicz(x) : x;
  return std::clamp(y, 0.0f, 1.0f);
}

DisplayImage to_display(const PixelBuffer& image, const DisplayTransform& transform) {
  DisplayImage out{image.width, image.height, image.channel_count() < 3 ? 1 : 3, {}};
  out.values.reserve(image.pixel_count() * std::size_t(out.channel_count));
  std::array<int, 3> rgb = rgb_channels(image);
  float scale = std::exp2(transform.exposure);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      Rgb color = rgb_at(image, rgb, x, y);
      for (int c = 0; c < out.channel_count; ++c)
        out.values.push_back(to_byte(apply_curve(transform.curve, color.c[c] * scale)));
    }
  return out;
}

}  // namespace montelux
