#include "denoise/small_lamps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "denoise/box_mean.h"
#include "film/max_around.h"
#include "math/functions.h"

namespace montelux {

namespace {

constexpr float lamp_contrast = 300;  // over the brightness around
constexpr int lamp_reach = 2;         // pixels: its edges, where few samples find it
constexpr int around_reach = 8;       // as far as the filter

// The mean of the channels of the image.
float gray_of(const NoisyImage& image, ColorPlanes HalfPlanes::*colors, std::size_t i) {
  const auto& [a, b] = image.halves;
  float sum = 0;
  for (std::size_t c = 0; c < rgb_size; ++c)
    sum += a.share[i] * (a.*colors)[c][i] + (1 - a.share[i]) * (b.*colors)[c][i];
  return sum / rgb_size;
}

// 1 for pixels at a small lamp; empty if there is none.
std::vector<std::uint8_t> small_lamps(const NoisyImage& image) {
  Plane emission(image.pixels()), around(image.pixels());
  for (std::size_t i = 0; i < emission.size(); ++i) {
    emission[i] = gray_of(image, &HalfPlanes::emission, i);
    around[i] = gray_of(image, &HalfPlanes::color, i) - emission[i];
  }
  if (std::ranges::none_of(emission, [](float e) { return e > 0; })) return {};
  around = box_mean(around, image.width, image.height, around_reach);
  const Plane brightest = max_around(emission, image.width, lamp_reach);
  std::vector<std::uint8_t> found(image.pixels());
  bool any = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // The darkest brightness is that of relative errors.
    found[i] = brightest[i] > lamp_contrast * std::sqrt(square(around[i]) + 0.01f);
    any |= found[i] != 0;
  }
  return any ? found : std::vector<std::uint8_t>{};
}

// Moves the `parts` of the colours to the kept light. `variance`: of the mean of both halves, by then that of the rest;
// null if it is not known. Where light is kept, its variance and that of the rest are those of two numbers, the halves.
KeptLight keep(const NoisyImage& image, const std::array<ColorPlanes, 2>& parts, std::array<ColorPlanes*, 2> colors,
               ColorPlanes* variance) {
  KeptLight kept{{*colors[0], *colors[1]}, {}, {}};
  if (variance) kept.variance = kept.covariance = *variance;
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < image.pixels(); ++i) {
      std::array<float, 2> rest;
      for (std::size_t h = 0; h < 2; ++h) {
        float& light = kept.halves[h][c][i];
        rest[h] = light * (1 - parts[h][c][i]), light -= rest[h];
        (*colors[h])[c][i] = rest[h];
      }
      if (!variance) continue;
      float &of_kept = kept.variance[c][i], &with_rest = kept.covariance[c][i], &of_rest = (*variance)[c][i];
      of_kept = with_rest = 0;
      if (parts[0][c][i] == 0 && parts[1][c][i] == 0) continue;
      const float share = image.halves[0].share[i], both = share * (1 - share), all = of_rest;
      of_kept = both * square(kept.halves[0][c][i] - kept.halves[1][c][i]);
      of_rest = both * square(rest[0] - rest[1]);
      with_rest = 0.5f * (all - of_kept - of_rest);
    }
  return kept;
}

}  // namespace

std::optional<SplitImage> split_small_lamps(const NoisyImage& image) {
  std::vector<std::uint8_t> lamps = small_lamps(image);
  if (lamps.empty()) return std::nullopt;
  SplitImage split{image, {}, {}, {}};
  NoisyImage& rest = split.rest;
  rest.whole.reset();  // it shows the lamps
  // What is kept of each colour. The halves have their own parts, which do not depend on each other.
  std::array<ColorPlanes, 2> parts;
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      parts[h][c].resize(image.pixels());
      for (std::size_t i = 0; i < lamps.size(); ++i) {
        const float share = image.halves[0].share[i], color = image.halves[h].color[c][i];
        if (lamps[i] == 0 || !(share > 0 && share < 1) || !(color > 0)) continue;
        parts[h][c][i] = std::clamp(image.halves[h].emission[c][i] / color, 0.0f, 1.0f);
      }
    }
  split.kept = keep(image, parts, {&rest.halves[0].color, &rest.halves[1].color}, &rest.variance);
  for (NoisyLayer& layer : rest.layers)
    split.kept_layers.push_back(
        keep(image, parts, {&layer.halves[0], &layer.halves[1]}, layer.knows_variance() ? &layer.variance : nullptr));
  split.is_lamp = std::move(lamps);
  return split;
}

}  // namespace montelux
