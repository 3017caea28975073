#include "image/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "color/transfer.h"

namespace montelux {

namespace {

constexpr int anchor_count = 9;
// At equal steps, sRGB-encoded.
constexpr std::array<std::array<std::uint32_t, anchor_count>, 2> anchors{{
    {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21908c, 0x27ad81, 0x5dc863, 0xaadc32, 0xfde725},
    {0x000004, 0x1d1147, 0x51127c, 0x822681, 0xb63679, 0xe65164, 0xfb8861, 0xfec287, 0xfcfdbf},
}};

struct Oklab {
  float lightness, a, b;
};

Oklab to_oklab(const Rgb& c) {
  const float l = std::cbrt(0.4122214708f * c.c[0] + 0.5363325363f * c.c[1] + 0.0514459929f * c.c[2]);
  const float m = std::cbrt(0.2119034982f * c.c[0] + 0.6806995451f * c.c[1] + 0.1073969566f * c.c[2]);
  const float s = std::cbrt(0.0883024619f * c.c[0] + 0.2817188376f * c.c[1] + 0.6299787005f * c.c[2]);
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

Rgb from_oklab(const Oklab& c) {
  const auto cube = [](float x) { return x * x * x; };
  const float l = cube(c.lightness + 0.3963377774f * c.a + 0.2158037573f * c.b);
  const float m = cube(c.lightness - 0.1055613458f * c.a - 0.0638541728f * c.b);
  const float s = cube(c.lightness - 0.0894841775f * c.a - 1.2914855480f * c.b);
  Rgb rgb{{4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
           -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
           -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s}};
  for (float& x : rgb.c) x = std::clamp(x, 0.0f, 1.0f);
  return rgb;
}

using Anchors = std::array<Oklab, anchor_count>;

Anchors anchors_of(ColorMap map) {
  Anchors all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::uint32_t hex = anchors[std::size_t(map)][i];
    Rgb rgb;
    for (int c = 0; c < 3; ++c) rgb.c[c] = srgb_decode(float(hex >> (16 - 8 * c) & 255u) / 255.0f);
    all[i] = to_oklab(rgb);
  }
  return all;
}

}  // namespace

Rgb color_at(ColorMap map, float t) {
  const float x = (t > 0 ? std::min(t, 1.0f) : 0.0f) * float(anchor_count - 1);
  const int i = std::min(int(x), anchor_count - 2);
  static const std::array<Anchors, 2> of_maps{anchors_of(ColorMap::viridis), anchors_of(ColorMap::magma)};
  const Oklab low = of_maps[std::size_t(map)][std::size_t(i)], high = of_maps[std::size_t(map)][std::size_t(i + 1)];
  const float u = x - float(i);
  return from_oklab({lerp(u, low.lightness, high.lightness), lerp(u, low.a, high.a), lerp(u, low.b, high.b)});
}

Rgb color_of_number(std::uint32_t number) {
  if (number == 0) return Rgb{};
  const float hue = 2 * pi * std::fmod(float(number % 100000u) * 0.6180339887f, 1.0f);
  const float lightness = 0.55f + 0.15f * float((number * 0x9e3779b9u >> 16) % 3u), chroma = 0.11f;
  return from_oklab({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
}

}  // namespace montelux
