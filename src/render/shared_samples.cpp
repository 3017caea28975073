#include "render/shared_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "film/limits.h"
#include "transport/dimensions.h"

namespace montelux {

namespace {

constexpr std::size_t emission = rgb_size, seen_emission = 2 * rgb_size, excluded = 3 * rgb_size, hit = excluded + 1,
                      channel_count = hit + 1 + feature_channel_count;
// What counts for several pixels, of one sample: its radiance, the emission that is no part of it, that of the
// features, and 1 if one of these is not finite, so that the sample is excluded; then 1 if it hit a surface, and the
// features. Filled up to whole vectors.
using Channels = std::array<float, (channel_count + 7) / 8 * 8>;
// Their sums over samples.
using Sums = std::array<double, std::tuple_size_v<Channels>>;

bool is_kept(const PixelSample& sample) {
  return montelux::is_kept(sample.radiance) && montelux::is_kept(sample.emission) &&
         montelux::is_kept(sample.features.emission);
}

Channels channels_of(const PixelSample& sample) {
  Channels channels{};
  const Features& f = sample.features;
  if (is_kept(sample)) {
    for (std::size_t c = 0; c < rgb_size; ++c)
      channels[c] = sample.radiance.c[c], channels[emission + c] = sample.emission.c[c],
      channels[seen_emission + c] = f.emission.c[c];
  } else {
    channels[excluded] = 1;
  }
  if (f.coverage <= 0) return channels;
  channels[hit] = 1;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto finite = [](float x) { return std::isfinite(x) ? x : 0; };
    ((channels[hit + 1 + I] = finite(feature_rows[feature_channels[I].row].value(f, feature_channels[I].channel))),
     ...);
  }
  (std::make_index_sequence<feature_channel_count>());
  return channels;
}

// Weights along one axis, by channel: light takes them with their signs; features take magnitudes that sum to 1, so
// that their means stay within their range where the filter is negative.
std::vector<Channels> channel_weights(const std::vector<float>& signed_weights) {
  float all = 0;
  for (const float w : signed_weights) all += std::abs(w);
  std::vector<Channels> weights;
  for (const float w : signed_weights) {
    Channels& own = weights.emplace_back();
    own.fill(std::abs(w) / all);
    std::fill_n(own.begin(), hit, w);
  }
  return weights;
}

template <class From>
void add_weighted(Sums& to, const Channels& weights, const From& from) {
  for (std::size_t c = 0; c < to.size(); ++c) to[c] += double(weights[c]) * double(from[c]);
}

// The sums of one pixel: from those of what it shares, and from what belongs to its own samples alone.
PixelPass pass_of(const Sums& sums, std::span<const PixelSample> own) {
  PixelPass pass;
  PixelFeatures& features = pass.features;
  double lamps[rgb_size] = {};
  for (const PixelSample& sample : own) {
    const Features& f = sample.features;
    (is_kept(sample) ? pass.finite : pass.non_finite) += 1;
    features.emission_rays += f.emission_rays;
    for (std::size_t c = 0; c < rgb_size; ++c) lamps[c] += sample.lamps.c[c];
    if (features.object == 0 && f.coverage > 0) features.object = f.object;
  }
  const double samples = double(own.size());
  features.samples = samples;
  // Where all samples hit, their weights sum to 1, rounded.
  constexpr double rounding = 1e-6;
  features.hits = sums[hit] > samples * (1 - rounding) ? samples : sums[hit];
  for (std::size_t i = 0; i < feature_channel_count; ++i) features.sums[i] = sums[hit + 1 + i];
  // Where samples are excluded, the mean is that of the others, if these are enough of the filter.
  const double left = samples - sums[excluded];
  if (left < 0.5) pass.finite = 0;
  if (pass.finite == 0) return pass;
  const double scale = pass.finite / left;
  const bool has_lamp_rays = features.emission_rays > samples;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    const double of_lamps = lamps[c] * pass.finite / samples;
    pass.sum[c] = sums[c] * scale + (has_lamp_rays ? of_lamps : sums[emission + c] * scale);
    pass.emission[c] = within(has_lamp_rays ? of_lamps : sums[seen_emission + c] * scale, ExactSum::largest);
    features.emission += pass.emission[c] / rgb_size;
  }
  return pass;
}

}  // namespace

std::shared_ptr<const SampleSharing> sharing_for(const Filter& filter) {
  // The pixels around a tile are traced for it alone.
  constexpr int tile_side = 32, max_reach = 8;
  constexpr double min_gain = 1.1;  // in squared error for the same time
  auto sharing = std::make_shared<const SampleSharing>(filter);
  const int x = sharing->reach_x(), y = sharing->reach_y();
  if (std::max(x, y) == 0 || std::max(x, y) > max_reach) return nullptr;
  const double work = (1 + 2.0 * x / tile_side) * (1 + 2.0 * y / tile_side);
  return sharing->noise() * work * min_gain < sharing->noise_of_own_samples() ? sharing : nullptr;
}

bool filters_share_samples(const ImageSettings& image) { return image.sharing && !image.layers; }

bool filters_share_samples(const ImageSettings& image, const AnyIntegrator& integrator) {
  return filters_share_samples(image) && integrator.pixel();
}

void widen_tiles(const PixelBounds& image, PassPlan& plan) {
  // Enough tiles for many threads remain. A plan with smaller units of work ends soon.
  constexpr int many = 64, units = 1 << 18;
  if (plan.max_unit_samples < PassPlan{}.max_unit_samples) return;
  plan.max_unit_samples = units;
  if (image.area() >= many * widest_tile * widest_tile) plan.max_tile_side = widest_tile;
}

SharedSamples::SharedSamples(const SampleSharing& sharing, const PixelBounds& tile, const PointSet& points)
    : tile_(tile), reach_x_(sharing.reach_x()), reach_y_(sharing.reach_y()) {
  const std::uint32_t film = path_dimension::film;
  for (std::uint32_t i = 0; i < points.samples_per_pass; ++i) {
    weights_.push_back(sharing.at(Sampler<float>(points, 0u, 0u, i).get2(film)));
    offsets_.push_back(weights_.back().offset);
  }
}

PixelBounds SharedSamples::around() const {
  return {tile_.x0 - reach_x_, tile_.y0 - reach_y_, tile_.x1 + reach_x_, tile_.y1 + reach_y_};
}

void SharedSamples::sum(std::span<const PixelSample> samples, std::vector<PixelPass>& pixels) const {
  const PixelBounds all = around();
  const auto across = std::size_t(all.width()), width = std::size_t(tile_.width()), count = weights_.size();
  const auto taps_x = std::size_t(2 * reach_x_ + 1), taps_y = std::size_t(2 * reach_y_ + 1);
  std::vector<Sums> sums(std::size_t(tile_.area()), Sums{});
  std::vector<Channels> row(across);
  std::vector<Sums> filtered(width);
  std::vector<std::vector<Channels>> x_weights, y_weights;
  for (const SampleSharing::Weights& weights : weights_)
    x_weights.push_back(channel_weights(weights.x)), y_weights.push_back(channel_weights(weights.y));
  // Row by row, so that the samples and the sums of one stay in the nearest caches.
  for (std::size_t y = 0; y < std::size_t(all.height()); ++y)
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t x = 0; x < across; ++x) row[x] = channels_of(samples[(y * across + x) * count + i]);
      for (std::size_t x = 0; x < width; ++x) {
        filtered[x] = {};
        for (std::size_t tap = 0; tap < taps_x; ++tap)
          if (weights_[i].x[tap] != 0) add_weighted(filtered[x], x_weights[i][tap], row[x + taps_x - 1 - tap]);
      }
      for (std::size_t tap = 0; tap < taps_y; ++tap) {
        const int of_tile = int(y) - 2 * reach_y_ + int(tap);
        if (weights_[i].y[tap] == 0 || of_tile < 0 || of_tile >= tile_.height()) continue;
        Sums* to = &sums[std::size_t(of_tile) * width];
        for (std::size_t x = 0; x < width; ++x) add_weighted(to[x], y_weights[i][tap], filtered[x]);
      }
    }
  pixels.clear();
  for (std::size_t y = 0; y < std::size_t(tile_.height()); ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t own = (y + std::size_t(reach_y_)) * across + x + std::size_t(reach_x_);
      pixels.push_back(pass_of(sums[y * width + x], samples.subspan(own * count, count)));
    }
}

}  // namespace montelux
