// Where the light that a path gathers comes from: told to a tally, which the ordinary render does without.
#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "color/spectrum.h"
#include "image/layers.h"
#include "image/pixel_sample.h"

namespace montelux {

// What is known of one contribution.
template <class F>
struct LightOrigin {
  Uint<F> bounces;      // scattering events between the lamp and the camera
  Uint<F> light;        // its number
  Technique technique;  // of light after a bounce; without one it is emission
};

// Keeps nothing and costs nothing.
struct NoTally {
  static constexpr bool records = false;
};
inline constexpr NoTally no_tally;

// The contributions of the samples of a tile, layer by layer, without rounding. The sums of a pixel are consecutive:
// first that of all contributions, then those of the layers. Lane by lane a sample's contributions are gathered until
// it is known to be finite.
class LayerTally {
 public:
  static constexpr bool records = true;

  LayerTally(const LayerPlan& plan, std::uint32_t samples_per_pixel, std::span<ExactRgb> sums)
      : plan_(plan),
        stride_(std::size_t(plan.count()) + 1),
        samples_per_pixel_(samples_per_pixel),
        sums_(sums),
        lanes_(stride_ * native_lanes),
        brightness_(native_lanes) {}

  // `light` as it counts in the pixel, weights of camera and filter included.
  template <class F>
  void add(Mask<F> on, const Spectrum<F>& light, const LightOrigin<F>& from) {
    for_each_lane(on, [&](int k) {
      add_lane(k, lane(light, k), {lane(from.bounces, k), lane(from.light, k), from.technique});
    });
  }

  // The sample of lane k is done. One that is not finite, or beyond what the sums can hold, is left out, and shows it.
  void finish(int k, std::uint32_t slot, PixelSample& sample) {
    const auto lane_sums = std::span(lanes_).subspan(std::size_t(k) * stride_, stride_);
    float& brightness = brightness_[std::size_t(k)];
    bool good = brightness < ExactSum::largest;
    for (float x : sample.radiance.c) good = good && x - x == 0.0f;
    if (good)
      for (std::size_t i = 0; i < stride_; ++i) sums_[slot / samples_per_pixel_ * stride_ + i] += lane_sums[i];
    else
      sample.radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
    std::fill(lane_sums.begin(), lane_sums.end(), ExactRgb{});
    brightness = 0;
  }

 private:
  void add_lane(int k, const Spectrum<float>& carried, const LightOrigin<float>& from) {
    const Rgb light = to_rgb(carried);
    float& brightness = brightness_[std::size_t(k)];
    for (float x : light.c) brightness += x < 0 ? -x : x;
    if (!(brightness < ExactSum::largest)) return;
    ExactRgb exact;
    for (int i = 0; i < rgb_size; ++i) exact.c[i].add(light.c[i]);
    ExactRgb* sums = &lanes_[std::size_t(k) * stride_];
    *sums++ += exact;
    if (plan_.bounces) {
      sums[std::min(from.bounces, std::uint32_t(*plan_.bounces) + 1)] += exact;
      sums += plan_.bounce_count();
    }
    if (plan_.light_groups) {
      sums[plan_.group_of_light[from.light]] += exact;
      sums += plan_.group_count();
    }
    if (plan_.techniques) sums[from.bounces == 0 ? 0u : std::uint32_t(from.technique)] += exact;
  }

  const LayerPlan& plan_;
  std::size_t stride_;
  std::uint32_t samples_per_pixel_;
  std::span<ExactRgb> sums_;
  std::vector<ExactRgb> lanes_;
  std::vector<float> brightness_;  // sum of absolute values, by lane; once beyond the range it stays there
};

}  // namespace montelux
