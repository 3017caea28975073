// Where the light of a path comes from. A tally receives it; a render without layers has none.
#pragma once
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <unordered_map>
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
  // Of bidirectional integrators: vertices that were drawn from the light, the one at the light included, and whether
  // the last of them is merged with one from the eye.
  Uint<F> light_vertices = Uint<F>(technique == Technique::light_sampling ? 1u : 0u);
  bool merged = false;
  F weight = F(1.0f);  // by which strategies share the light; a part of the contribution
};

// That of one lane.
template <class F>
LightOrigin<float> lane_of(const LightOrigin<F>& from, int k) {
  return {lane(from.bounces, k),        lane(from.light, k), from.technique,
          lane(from.light_vertices, k), from.merged,         lane(from.weight, k)};
}

// The numbers of the layers to which a contribution belongs, one of each family.
class OwnLayers {
 public:
  OwnLayers(const LayerPlan& plan, const LightOrigin<float>& from) {
    int first = 0;
    const auto add = [&](std::uint32_t number, int layers) {
      numbers_[count_++] = std::uint32_t(first) + number, first += layers;
    };
    if (plan.bounces) add(std::min(from.bounces, std::uint32_t(*plan.bounces) + 1), plan.bounce_count());
    if (plan.light_groups) add(plan.group_of_light[from.light], plan.group_count());
    if (plan.techniques) add(from.bounces == 0 ? 0u : std::uint32_t(from.technique), plan.technique_count());
    if (!plan.strategies) return;
    const int strategy = plan.strategy_number(from.bounces, from.light_vertices, from.merged);
    add(std::uint32_t(strategy), plan.strategy_count());
    if (plan.alone && strategy < plan.alone_count()) alone_ = first + strategy;
  }
  std::span<const std::uint32_t> all() const { return std::span(numbers_).first(count_); }
  // Of the strategy by itself; negative: there is none.
  int alone() const { return alone_; }

 private:
  std::array<std::uint32_t, 4> numbers_{};
  std::size_t count_ = 0;
  int alone_ = -1;
};

// What the strategy of a contribution would have found by itself: 0 where that is beyond the range of the sums.
inline Rgb without_weight(const Rgb& contribution, float weight) {
  Rgb all = contribution;
  float sum = 0;
  for (float& x : all.c) x /= weight, sum += x < 0 ? -x : x;
  return sum < ExactSum::largest ? all : gray_rgb(0);
}
inline ExactRgb exact(const Rgb& contribution) {
  ExactRgb sum;
  for (int i = 0; i < rgb_size; ++i) sum.c[i].add(contribution.c[i]);
  return sum;
}

// Keeps nothing and costs nothing.
struct NoTally {
  static constexpr bool records = false;
};
inline constexpr NoTally no_tally;

// A tally that also receives light of samples that are in no lane yet, by add_early().
template <class Tally>
concept TakesEarlyLight = requires {
  &Tally::add_early;
};

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
  void add(Mask<F> on, const Spectrum<F>& contribution, const LightOrigin<F>& from) {
    for_each_lane(on, [&](int k) { add_lane(k, lane(contribution, k), lane_of(from, k)); });
  }

  // The same, of a sample that is not in a lane yet.
  void add_early(std::uint32_t output, const Spectrum<float>& contribution, const LightOrigin<float>& from) {
    early_.emplace(output, Early{contribution, from});
  }

  // The sample of lane k is done. One that is not finite, or beyond the range of the sums, is excluded and set to NaN.
  void finish(int k, std::uint32_t output, PixelSample& sample) {
    if (!early_.empty()) {
      const auto [first, last] = early_.equal_range(output);
      for (auto at = first; at != last; ++at) add_lane(k, at->second.contribution, at->second.from);
      early_.erase(first, last);
    }
    const auto lane_sums = std::span(lanes_).subspan(std::size_t(k) * stride_, stride_);
    float& brightness = brightness_[std::size_t(k)];
    bool good = brightness < ExactSum::largest;
    for (float x : sample.radiance.c) good = good && x - x == 0.0f;
    if (good)
      for (std::size_t i = 0; i < stride_; ++i) sums_[output / samples_per_pixel_ * stride_ + i] += lane_sums[i];
    else
      sample.radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
    std::fill(lane_sums.begin(), lane_sums.end(), ExactRgb{});
    brightness = 0;
  }

  // The sample of a pixel is complete, to which light was added in several parts, each with a finish() of its own: of a
  // tile with one sample for each pixel. One that is not finite, or beyond what the sums can hold, is in no layer.
  void settle(std::uint32_t output, PixelSample& sample) {
    bool good = true;
    for (float x : sample.radiance.c) good = good && x < ExactSum::largest && -x < ExactSum::largest;
    if (good) return;
    sample.radiance = gray_rgb(std::numeric_limits<float>::quiet_NaN());
    std::fill_n(sums_.begin() + std::ptrdiff_t(output * stride_), stride_, ExactRgb{});
  }

 private:
  struct Early {
    Spectrum<float> contribution;
    LightOrigin<float> from;
  };

  void add_lane(int k, const Spectrum<float>& carried, const LightOrigin<float>& from) {
    const Rgb contribution = to_rgb(carried);
    float& brightness = brightness_[std::size_t(k)];
    for (float x : contribution.c) brightness += x < 0 ? -x : x;
    if (!(brightness < ExactSum::largest)) return;
    const ExactRgb sum = exact(contribution);
    ExactRgb* sums = &lanes_[std::size_t(k) * stride_];
    *sums++ += sum;
    const OwnLayers own(plan_, from);
    for (const std::uint32_t number : own.all()) sums[number] += sum;
    if (own.alone() >= 0) sums[own.alone()] += exact(without_weight(contribution, from.weight));
  }

  const LayerPlan& plan_;
  std::size_t stride_;
  std::uint32_t samples_per_pixel_;
  std::span<ExactRgb> sums_;
  std::vector<ExactRgb> lanes_;
  std::unordered_multimap<std::uint32_t, Early> early_;  // by output
  std::vector<float> brightness_;  // sum of absolute values, by lane; once beyond the range it stays there
};

}  // namespace montelux
