#include "render/pilot_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "film/picture_error.h"
#include "math/special.h"
#include "mc/moments.h"
#include "mc/random.h"

namespace montelux {

namespace {

// The expectation of each pixel of a window, by the pilots that are weighted, as the mean over the pixels around it:
// its noise should be small beside the errors that are divided by it, or they would seem too small.
std::vector<PixelMean> expectation_of(std::span<const CandidatePilot> pilots, std::span<const double> weights,
                                      std::size_t window, const PixelBounds& bounds) {
  constexpr double enough_samples = 64;
  double samples = 0;
  for (const CandidatePilot& pilot : pilots) samples += pilot.samples();
  int radius = 1;
  while ((2 * radius + 1) * (2 * radius + 1) * samples < enough_samples) ++radius;
  const int width = bounds.width(), height = bounds.height();
  std::vector<PixelMean> pooled(std::size_t(bounds.area()), PixelMean{}), smooth = pooled;
  for (std::size_t k = 0; k < pilots.size(); ++k)
    for (const std::vector<PixelMean>& pass : pilots[k].windows[window].passes)
      for (std::size_t i = 0; i < pooled.size(); ++i)
        for (std::size_t c = 0; c < rgb_size; ++c) pooled[i][c] += weights[k] * pass[i][c] / passes_of_pilot;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      PixelMean& out = smooth[std::size_t(y * width + x)];
      double count = 0;
      for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); ++u, ++count)
          for (std::size_t c = 0; c < rgb_size; ++c) out[c] += pooled[std::size_t(v * width + u)][c];
      for (double& value : out) value /= count;
    }
  return smooth;
}

// The mean of a pixel over the passes, and the squared error of one sample, by the spread of the passes.
struct PixelFigures {
  double mean = 0, error = 0;
};
PixelFigures figures_of(const CandidatePilot& pilot, const WindowPilot& window, std::size_t i, std::size_t c) {
  const double a = window.passes[0][i][c], b = window.passes[1][i][c];
  return {(a + b) / 2, (a - b) * (a - b) / 2 * pilot.samples_per_pass};
}

// Weights of the pilots' means, inversely proportional to their squared errors.
std::vector<double> weights_of(std::span<const CandidatePilot> pilots) {
  std::vector<double> weights;
  for (const CandidatePilot& pilot : pilots) {
    double error = 0;
    for (const WindowPilot& window : pilot.windows)
      for (std::size_t i = 0; i < window.passes[0].size(); ++i)
        for (std::size_t c = 0; c < rgb_size; ++c) error += figures_of(pilot, window, i, c).error;
    weights.push_back(1 / std::max(error / pilot.samples(), 1e-30));
  }
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= all;
  return weights;
}

// The errors of a pilot in one window.
WindowError error_of(const CandidatePilot& pilot, std::size_t number, const std::vector<PixelMean>& expectation,
                     LargestTerms& largest) {
  const WindowPilot& window = pilot.windows[number];
  WindowError error{double(expectation.size()), window.cost / pilot.samples()};
  double difference = 0;
  for (std::size_t i = 0; i < expectation.size(); ++i) {
    double relative = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double divisor = expectation[i][c] * expectation[i][c] + relative_epsilon;
      relative += figures_of(pilot, window, i, c).error / divisor / rgb_size;
      difference += window.passes[0][i][c] - window.passes[1][i][c], error.sum += expectation[i][c];
    }
    error.relative += relative;
    largest.add(relative);
  }
  error.of_sum = difference * difference / 2 * pilot.samples_per_pass;
  return error;
}

// What `pilot` lacks of the light that `other` shows.
MissingLightOfPilot missing_light(const CandidatePilot& pilot, const CandidatePilot& other, std::size_t window,
                                  const std::vector<PixelMean>& expectation) {
  MissingLightOfPilot missing;
  for (std::size_t i = 0; i < expectation.size(); ++i)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double divisor = expectation[i][c] * expectation[i][c] + relative_epsilon;
      const PixelFigures a = figures_of(pilot, pilot.windows[window], i, c),
                         b = figures_of(other, other.windows[window], i, c);
      const double difference = b.mean - a.mean;
      missing.light += difference / std::sqrt(divisor);
      missing.error +=
          (pilot.samples() * (difference * difference - b.error / other.samples()) - a.error) / divisor / rgb_size;
    }
  return missing;
}

// The mean over windows, in standard errors.
double significance(const std::vector<MissingLightOfPilot>& missing, double MissingLightOfPilot::*value) {
  Moments moments;
  for (const MissingLightOfPilot& m : missing) moments.add(m.*value);
  return moments.mean / std::max(moments.standard_error(), 1e-30);
}

// Limits the light of the two in a hundred windows where it is largest, so that single bright samples of the other
// pilot show no light. Those of the pilot itself count in full: without them it would seem to lack what it rarely
// finds.
void limit_light(std::vector<MissingLightOfPilot>& missing) {
  constexpr double kept = 0.98;
  std::vector<double> sizes;
  for (const MissingLightOfPilot& m : missing) sizes.push_back(std::abs(m.light));
  const auto limit = sizes.begin() + std::ptrdiff_t(kept * double(sizes.size() - 1));
  std::ranges::nth_element(sizes, limit);
  for (MissingLightOfPilot& m : missing) m.light = std::min(m.light, *limit);
}

// Light that is missing from a pilot of so many samples of each pixel, with significance, and does not show in the
// spread of its samples either: it is rare in them. Adds to the errors what they are at least.
//
// Were this light found by hits of the size h, relative to the expectation, then there would be D / h of them per
// sample, where D is the sum of the missing light over the pixels, and their squared error would be D h. Fewer than 3
// hits were expected, or some would have been seen (with a probability of 0.95): so h is at least samples D / 3. It
// counts in each window by its share of the light.
bool add_rare_light(std::vector<MissingLightOfPilot> missing, double samples, std::vector<WindowError>& errors) {
  constexpr double significant = 3, unseen_hits = 3;
  // Where hits have been seen, but fewer than expected, the spread shows more than a small part of the error.
  constexpr double max_part_seen = 1.0 / 40;
  limit_light(missing);
  const double deviations = significance(missing, &MissingLightOfPilot::light);
  if (deviations < significant) return false;
  double light = 0, positive = 0, seen = 0;
  for (const MissingLightOfPilot& m : missing) light += m.light / rgb_size, positive += std::max(m.light, 0.0);
  for (const WindowError& e : errors) seen += e.relative;
  const double at_least = light * (1 - 2 / deviations), error = samples * at_least * at_least / unseen_hits;
  if (seen > max_part_seen * error) return false;
  for (std::size_t w = 0; w < errors.size(); ++w)
    errors[w].relative += error * std::max(missing[w].light, 0.0) / positive;
  return true;
}

// Whether light is missing from a pilot with significance. Then its errors are those against the mean of the other one.
bool adds_missing_light(const std::vector<MissingLightOfPilot>& missing, std::vector<WindowError>& errors) {
  constexpr double significant = 3;
  if (significance(missing, &MissingLightOfPilot::light) < significant ||
      significance(missing, &MissingLightOfPilot::error) < significant)
    return false;
  for (std::size_t w = 0; w < errors.size(); ++w)
    errors[w].relative = std::max(errors[w].relative + missing[w].error, 0.0);
  return true;
}

}  // namespace

void PilotPair::append(const PilotPair& more) {
  first.insert(first.end(), more.first.begin(), more.first.end());
  other.insert(other.end(), more.other.begin(), more.other.end());
  first_misses.insert(first_misses.end(), more.first_misses.begin(), more.first_misses.end());
  first_shows.insert(first_shows.end(), more.first_shows.begin(), more.first_shows.end());
  largest.merge(more.largest);
}

std::vector<PilotPair> pairs_of(std::span<const CandidatePilot> pilots, std::span<const PixelBounds> windows) {
  const std::vector<double> weights = weights_of(pilots);
  std::vector<PilotPair> pairs(pilots.size());
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const std::vector<PixelMean> expectation = expectation_of(pilots, weights, w, windows[w]);
    for (std::size_t k = 0; k < pilots.size(); ++k) {
      PilotPair& pair = pairs[k];
      pair.first_samples = pilots[0].samples();
      pair.other.push_back(error_of(pilots[k], w, expectation, pair.largest));
      pair.first.push_back(pairs[0].other[w]);
      pair.first_misses.push_back(missing_light(pilots[0], pilots[k], w, expectation));
      pair.first_shows.push_back(missing_light(pilots[k], pilots[0], w, expectation));
    }
  }
  return pairs;
}

double samples_for_unit_error(const std::vector<WindowError>& errors, std::span<const double> weights,
                              const ErrorTarget& target, std::size_t all_windows) {
  WindowError sum;
  double windows = 0;
  for (std::size_t w = 0; w < errors.size(); ++w) {
    windows += weights[w];
    sum.pixels += weights[w] * errors[w].pixels, sum.relative += weights[w] * errors[w].relative;
    sum.of_sum += weights[w] * errors[w].of_sum, sum.sum += weights[w] * errors[w].sum;
  }
  switch (target.measure) {
    case TargetMeasure::relative:
    case TargetMeasure::denoised:
      return sum.relative / sum.pixels;
    case TargetMeasure::mean:
      // The windows' errors are independent: of the sum over all windows it is that of these times a number, and the
      // square of the sum is that of these times its square.
      return sum.of_sum / (sum.sum * sum.sum) * windows / double(all_windows);
    case TargetMeasure::pixels:
      break;
  }
  // Pixels of a window have normal errors of equal variance: the number at which the stated share of all is within 1.
  double low = 0, high = 1;
  const auto within = [&](double samples) {
    double pixels = 0;
    for (std::size_t w = 0; w < errors.size(); ++w) {
      const double deviation = std::sqrt(errors[w].relative / errors[w].pixels / samples);
      pixels += weights[w] * errors[w].pixels * (deviation > 0 ? 2 * special::normal_cdf(1 / deviation) - 1 : 1.0);
    }
    return pixels / sum.pixels;
  };
  while (within(high) < target.share && high < 1e12) low = high, high *= 4;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (within(middle) < target.share ? low : high) = middle;
  }
  return high;
}

CandidateRatio ratio_of(const std::string& name, PilotPair pair, const ErrorTarget& target, std::size_t all_windows) {
  CandidateRatio result{name};
  std::vector<WindowError>&first = pair.first, &other = pair.other;
  result.finds_more_light = (pair.is_whole_image && add_rare_light(pair.first_misses, pair.first_samples, first)) ||
                            adds_missing_light(pair.first_misses, first);
  adds_missing_light(pair.first_shows, other);
  result.is_unsure = hill_index(pair.largest.sorted()) < 1;
  const std::size_t count = first.size();
  std::vector<double> weights(count, 1.0);
  const auto ratio = [&] {
    double cost = 0, of_other = 0;
    for (std::size_t w = 0; w < count; ++w) cost += weights[w] * first[w].cost, of_other += weights[w] * other[w].cost;
    const double of_first = samples_for_unit_error(first, weights, target, all_windows) * cost;
    return of_first / (samples_for_unit_error(other, weights, target, all_windows) * of_other);
  };
  result.ratio = ratio();
  // Without noise there is nothing to gain.
  if (!std::isfinite(result.ratio) || !(result.ratio > 0)) return {result.name, 1, 0, 1, false};
  constexpr int resamples = 400;
  constexpr double tail = 0.025;
  // The Bayesian bootstrap (Rubin 1981): weights are exponentially distributed. A sum that one window determines, where
  // the only rare bright sample is, may then be far smaller, but not as if that had never been seen.
  RandomStream<float> random(std::uint32_t(count), 0x5eedu);
  std::vector<double> ratios;
  for (int i = 0; i < resamples; ++i) {
    for (double& weight : weights) weight = -std::log1p(-double(random.next()));
    if (const double one = ratio(); std::isfinite(one)) ratios.push_back(one);
  }
  if (ratios.size() < resamples / 2) return {result.name, 1, 0, 1, false};
  std::ranges::sort(ratios);
  result.low = ratios[std::size_t(tail * double(ratios.size()))];
  result.high = ratios[std::size_t((1 - tail) * double(ratios.size() - 1))];
  return result;
}

}  // namespace montelux
