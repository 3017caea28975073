#include "film/picture_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "film/partial_cover.h"
#include "film/reciprocals.h"
#include "mc/tail.h"

namespace montelux {

namespace {

// Sums over pixels.
struct Sums {
  double squared = 0, relative = 0;
  double chance = 0;  // variance of the relative squared errors
  // Of the relative errors without the correction for partial covers; without the rims of emitters.
  double seen = 0, seen_squares = 0;
  double samples = 0;  // of the pixels
  LargestTerms largest;
};

void add_pixel(const FilmPlanes& p, const Reciprocals& reciprocals, const PartialCovers& covers, std::size_t i,
               Sums& sums) {
  const std::array<double, rgb_size> reciprocal = reciprocals.of(i);
  double variance = 0, of_pixel_alone = 0;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    const double of_channel = double(p.variance[c][i]) / rgb_size;
    variance += of_channel, of_pixel_alone += of_channel * reciprocal[c];
  }
  double relative = of_pixel_alone;
  for (double of_channel : covers.correction(i, reciprocal)) relative += of_channel / rgb_size;
  relative = std::max(relative, 0.0);
  sums.squared += variance, sums.relative += relative, sums.samples += double(p.samples[i]);
  if (!covers.is_at_rim(i)) {
    sums.seen += of_pixel_alone, sums.seen_squares += of_pixel_alone * of_pixel_alone;
    sums.largest.add(of_pixel_alone);
  }
  const double squared_mean = relative * relative, of_normal = 3 * squared_mean;
  sums.chance += std::max(covers.mean_square(i).value_or(of_normal) - squared_mean, 0.0);
}

// The standard deviation of the logarithm of an error whose tail has this index, by the images of 109 scenes with 8 to
// 512 samples: a tail whose cubes have a mean hides nothing, and it hides the less the more pixels share in the error,
// by the number of equal ones. A heavier tail hides no more than one of index 1.5: a bright sample that an image does
// not have takes less from it than it would add.
double tail_deviation(double index, double equal_pixels) {
  constexpr double light_tail = 3, heaviest_tail = 1.5, of_tail = 1.5, few_pixels = 40;
  const double tail = std::max(1 / std::max(index, heaviest_tail) - 1 / light_tail, 0.0);
  return of_tail * tail * std::min(few_pixels / equal_pixels, 1.0);
}

// What one sample of light that is met by chance adds to the mean over the pixels that have two passes.
void add_chance_light(const FilmPlanes& p, ErrorEstimate& error) {
  double of_one = 0, mean = 0, added = 0;
  for (std::size_t i = 0; i < p.passes.size(); ++i) {
    if (p.passes[i] < 2) continue;
    of_one += 1 / std::max(double(p.samples[i]), 1.0);
    for (const Plane& channel : p.mean) mean += double(channel[i]) / rgb_size;
  }
  const double pixels = double(error.pixels);
  for (std::size_t c = 0; c < rgb_size; ++c) {
    error.chance_light[c] = double(p.max_chance_radiance.c[c]) * of_one / (pixels * pixels);
    added += error.chance_light[c] / rgb_size;
  }
  error.chance_share = added > 0 ? added * pixels / std::abs(mean) : 0;
}

// Over the pixels that have two passes.
Sums sum_pixels(const FilmPlanes& p) {
  const Reciprocals reciprocals(p);
  const PartialCovers covers(p);
  Sums sums;
  for (std::size_t i = 0; i < p.passes.size(); ++i)
    if (p.passes[i] >= 2) add_pixel(p, reciprocals, covers, i, sums);
  return sums;
}

}  // namespace

Interval interval_with_missing(const Interval& interval, double chance_light, double confidence) {
  const double middle = (interval.low + interval.high) / 2;
  return {interval.low, middle + std::hypot(interval.high - middle, missing_samples(confidence) * chance_light)};
}

ErrorEstimate estimate_error(const FilmPlanes& p) {
  ErrorEstimate error;
  error.all = std::size_t(std::count(p.expected.begin(), p.expected.end(), std::uint8_t(1)));
  error.pixels = std::size_t(std::ranges::count_if(p.passes, [](std::uint32_t passes) { return passes >= 2; }));
  if (error.pixels == 0) return error;
  const Sums sums = sum_pixels(p);
  error.mse = sums.squared / double(error.pixels), error.relative_mse = sums.relative / double(error.pixels);
  error.effective_pixels = sums.chance > 0 ? 2 * sums.relative * sums.relative / sums.chance : double(error.pixels);
  error.tail_index = hill_index(sums.largest.sorted());
  const double equal_pixels = sums.seen_squares > 0 ? sums.seen * sums.seen / sums.seen_squares : double(error.pixels);
  error.log_deviation =
      divisor_deviation(sums.samples / double(error.pixels)) + tail_deviation(error.tail_index, equal_pixels);
  const double factor = std::exp(1.96 * std::hypot(error.chance_deviation(), error.log_deviation));
  add_chance_light(p, error);
  const double missing = error.missing_share(default_confidence);
  error.relative_low = error.relative_mse / factor;
  error.relative_high = error.relative_mse * factor + missing * missing;
  return error;
}

}  // namespace montelux
