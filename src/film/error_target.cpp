#include "film/error_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "film/film.h"
#include "film/intervals.h"
#include "film/reciprocals.h"
#include "mc/confidence.h"

namespace montelux {

namespace {

// Of longer renders, and of pixels' calibrated intervals: what more samples do not take from divisor_deviation().
constexpr double many_samples = std::numeric_limits<double>::infinity();

// The factor for the upper end of a squared error. Deviations of its logarithm: of the estimate, which decides at each
// look whether the render ends; and those that do not depend on that decision, and so count for one look. Among these
// is the chance of the image itself: the spread of passes, by which renders end, is independent of their mean where
// noise is normal (Chow and Robbins 1965).
double upper_factor(const ErrorTarget& target, double of_estimate, double of_one_look, double spent) {
  const double wrong = 1 - target.confidence;
  return std::exp(
      std::hypot(normal_quantile(1 - wrong * spent) * of_estimate, normal_quantile(1 - wrong) * of_one_look));
}

// How a squared error falls with the number of samples: like their `power`, the uncertainty of which is relative.
struct Decay {
  double power = 1, uncertainty = 0;
};

// `deviation`: of the logarithm of the squared error's estimate. `later`: the bound by what is in it however many
// samples there are; the rest may fall.
void predict_work(const ErrorTarget& target, double deviation, double later, TargetState& state,
                  const Decay& decay = {}) {
  constexpr double of_passes = 0.1;  // how well the errors of longer passes follow that law
  const auto work_of = [&](double bound) { return std::pow(bound / target.error, 2 / decay.power); };
  const double of_power = decay.uncertainty * std::log(std::max(work_of(state.bound), 1.0));
  const double factor = std::exp(std::hypot(1.96 * deviation / decay.power, of_passes, of_power));
  const double now = work_of(state.bound), then = work_of(std::min(later, state.bound));
  // A little more at least, if the bound is not below the target yet.
  state.work = std::clamp(then, std::min(now, 1.1), now), state.work_low = then / factor,
  state.work_high = now * factor;
}

void judge_relative(const ErrorTarget& target, const ErrorEstimate& error, double passes, double spent,
                    TargetState& state) {
  const double of_estimate = error.chance_deviation(passes - 1), of_image = error.chance_deviation();
  const auto bound_with = [&](double log_deviation) {
    const double of_one_look = std::hypot(of_image, log_deviation);
    return std::sqrt(error.relative_mse * upper_factor(target, of_estimate, of_one_look, spent));
  };
  state.error = std::sqrt(error.relative_mse);
  state.bound = bound_with(error.log_deviation);
  const double later = bound_with(divisor_deviation(many_samples));
  predict_work(target, of_estimate, later, state);
}

// The upper end of the squared error that a filter leaves: its estimate is a sum over pixels of terms of both signs, so
// its deviation adds to it; what bright samples the image has not met yet multiplies it, as without the filter. At
// worst the filter leaves all noise: no more samples are needed than without it.
void judge_denoised(const ErrorTarget& target, const ErrorEstimate& error, const FilteredError& filtered, double passes,
                    double spent, TargetState& state) {
  constexpr double of_choice = 0.15;  // deviation of the logarithm: each pixel takes the least of several estimates
  constexpr Decay decay{filtered_power, 0.25};
  const double wrong = 1 - target.confidence;
  const double of_estimate = std::hypot(filtered.deviation, filtered.unfiltered * error.chance_deviation(passes - 1));
  const double of_image = filtered.unfiltered * error.chance_deviation();
  const auto bound_with = [&](double log_deviation) {
    const double factor = std::exp(normal_quantile(1 - wrong) * std::hypot(log_deviation, of_choice));
    const double of_one_look = std::hypot(normal_quantile(1 - wrong) * of_image, filtered.relative_mse * (factor - 1));
    return std::sqrt(filtered.relative_mse + std::hypot(normal_quantile(1 - wrong * spent) * of_estimate, of_one_look));
  };
  state.error = std::sqrt(filtered.relative_mse), state.bound = bound_with(error.log_deviation);
  const double deviation = filtered.relative_mse > 0 ? of_estimate / filtered.relative_mse : 0;
  predict_work(target, deviation, bound_with(divisor_deviation(many_samples)), state, decay);
  TargetState noisy;
  judge_relative(target, error, passes, spent, noisy);
  state.work = std::min(state.work, noisy.work), state.work_low = std::min(state.work_low, noisy.work_low);
  state.work_high = std::min(state.work_high, noisy.work_high);
}

// The relative errors of the pixels that have two passes.
struct PixelErrors {
  std::vector<double> squares;  // estimates of their expected squares
  double freedom = 0;           // the degrees of freedom of such an estimate
};

// Of a pixel, its channels' squared errors times the reciprocals of their squared expectations; negative where it has
// fewer than two passes.
template <class SquaredError>
std::vector<double> relative_squares(const FilmPlanes& p, const Reciprocals& reciprocals, SquaredError squared_error) {
  std::vector<double> squares(p.passes.size(), -1);
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (p.passes[i] < 2) continue;
    const std::array<double, rgb_size> reciprocal = reciprocals.of(i);
    squares[i] = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) squares[i] += squared_error(c, i) * reciprocal[c] / rgb_size;
  }
  return squares;
}

// The mean of the squared errors of a pixel's channels is distributed like that of so many independent ones: 3 where
// the errors of channels are independent, 1 where they are equal (Satterthwaite 1946). By the variance of the channels'
// mean over the mean of their variances.
double independent_channels(const FilmPlanes& p) {
  double ratios = 0, pixels = 0;
  for (std::size_t i = 0; i < p.passes.size(); ++i) {
    double variance = 0;
    for (const Plane& channel : p.variance) variance += double(channel[i]) / rgb_size;
    if (p.passes[i] < 2 || variance <= 0) continue;
    const double half_difference = (double(p.first_half[i]) - double(p.second_half[i])) / 2;
    ratios += half_difference * half_difference / variance, pixels += 1;
  }
  const double ratio = std::clamp(pixels > 0 ? ratios / pixels : 1, 1.0 / rgb_size, 1.0);
  const double correlation = (rgb_size * ratio - 1) / (rgb_size - 1);
  return rgb_size / (1 + (rgb_size - 1) * correlation * correlation);
}

// By the calibrated intervals of pixels, which know what light a pixel may have missed.
PixelErrors errors_by_intervals(const FilmPlanes& p, const Reciprocals& reciprocals, double passes) {
  const PixelIntervals intervals = pixel_intervals(p);
  const double freedom = interval_freedom(passes);
  const double width = 2 * student_t_quantile((1 + intervals.confidence) / 2, freedom);
  const auto squared_error = [&](std::size_t c, std::size_t i) {
    const double error = (double(intervals.high[c][i]) - double(intervals.low[c][i])) / width;
    return error * error;
  };
  std::vector<double> squares = relative_squares(p, reciprocals, squared_error);
  std::erase_if(squares, [](double square) { return square < 0; });
  return {std::move(squares), freedom};
}

// By the variances of the pixels, shrunk toward the mean of the eight around each.
PixelErrors errors_by_variances(const FilmPlanes& p, const Reciprocals& reciprocals, double passes) {
  constexpr double prior_degrees = 2;
  const int width = p.bounds.width(), height = p.bounds.height();
  const std::vector<double> own =
      relative_squares(p, reciprocals, [&](std::size_t c, std::size_t i) { return double(p.variance[c][i]); });
  PixelErrors errors{{}, passes - 1 + prior_degrees};
  errors.squares.reserve(own.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int px, int py) { return own[std::size_t(py) * std::size_t(width) + std::size_t(px)]; };
      const double variance = at(x, y);
      if (variance < 0) continue;
      double sum = 0, count = 0;
      for (int py = std::max(y - 1, 0); py <= std::min(y + 1, height - 1); ++py)
        for (int px = std::max(x - 1, 0); px <= std::min(x + 1, width - 1); ++px)
          if ((px != x || py != y) && at(px, py) >= 0) sum += at(px, py), ++count;
      const double around = count > 0 ? sum / count : variance;
      errors.squares.push_back(((passes - 1) * variance + prior_degrees * around) / errors.freedom);
    }
  return errors;
}

// The mean over pixels of P(error > x): the square of an error over its estimate has an F distribution, here by its
// table, since there are many pixels.
class MissedShare {
 public:
  // `channels`: the number of independent ones.
  MissedShare(const PixelErrors& errors, double channels) : pixels_(double(errors.squares.size())) {
    for (double square : errors.squares)
      if (square > 0) scales_.push_back(double(table_.size() - 1) / (largest * std::sqrt(square)));
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double x = largest * double(i) / double(table_.size() - 1), f = channels * x * x;
      table_[i] = incomplete_beta(errors.freedom / 2, channels / 2, errors.freedom / (errors.freedom + f));
    }
  }
  double operator()(double error) const {
    double sum = 0;
    for (double scale : scales_) {
      const double at = error * scale;
      if (at >= double(table_.size() - 1)) continue;
      const auto below = std::size_t(at);
      sum += table_[below] + (at - double(below)) * (table_[below + 1] - table_[below]);
    }
    return sum / pixels_;
  }
  // The error beyond which there is this share of the pixels.
  double error_of(double share) const {
    double low = 0, high = 1e-6;
    while ((*this)(high) > share && high < 1e6) high *= 4;
    if (high <= 1e-6) return (*this)(0) > share ? high : 0;
    for (int i = 0; i < 30; ++i) {
      const double middle = (low + high) / 2;
      ((*this)(middle) > share ? low : high) = middle;
    }
    return high;
  }

 private:
  static constexpr double largest = 24;
  double pixels_;
  std::vector<double> scales_;  // of the pixels that have an error, from it to the place in the table
  std::array<double, 1025> table_{};
};

// A bright sample that few pixels have widens the intervals of all pixels around, most of which have far less error: so
// the error is at most twice what the variances show.
void judge_pixels(const ErrorTarget& target, const FilmPlanes& planes, double passes, double spent,
                  TargetState& state) {
  constexpr double max_over_variances = 2;
  const Reciprocals reciprocals(planes);
  const PixelErrors by_intervals = errors_by_intervals(planes, reciprocals, passes),
                    by_variances = errors_by_variances(planes, reciprocals, passes);
  const double channels = independent_channels(planes);
  const MissedShare missed(by_intervals, channels), missed_by_variances(by_variances, channels);
  const auto error_of = [&](double share) {
    return std::min(missed.error_of(share), max_over_variances * missed_by_variances.error_of(share));
  };
  const double share = 1 - target.share, count = std::max(share * double(by_intervals.squares.size()), 1.0);
  const double of_estimate = 1 / std::sqrt(count * (passes - 1)), of_image = 1 / std::sqrt(count);
  state.error = error_of(share);
  state.bound =
      error_of(share / upper_factor(target, of_estimate, std::hypot(of_image, divisor_deviation(many_samples)), spent));
  predict_work(target, of_estimate, state.bound, state);
}

// The standard error of the mean over pixels and channels if pixels were independent: inaccurate in what it assumes,
// but known from few passes.
double error_of_independent_pixels(const FilmPlanes& p) {
  double variance = 0, pixels = 0;
  for (std::size_t i = 0; i < p.passes.size(); ++i) {
    if (p.passes[i] < 2) continue;
    double deviation = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) deviation += std::sqrt(double(p.variance[c][i])) / rgb_size;
    variance += deviation * deviation, ++pixels;
  }
  return std::sqrt(variance) / pixels;
}

void judge_mean(const ErrorTarget& target, const FilmPlanes& planes, const ImageEstimate& image, TargetState& state) {
  double mean = 0, error = 0;
  for (int c = 0; c < rgb_size; ++c) {
    mean += image.mean[c] / rgb_size;
    // The standard error of a mean of channels is at most the mean of theirs.
    error += image.standard_error[c] / rgb_size;
  }
  const double passes = image.passes;
  state.error = error / std::abs(mean);
  state.bound = state.error * student_t_quantile((1 + target.confidence) / 2, passes - 1);
  constexpr double few_passes = 8;
  if (passes >= few_passes) return predict_work(target, std::sqrt(2 / (passes - 1)), state.bound, state);
  TargetState predicted;
  const double normal = normal_quantile((1 + target.confidence) / 2);
  predicted.bound = normal * error_of_independent_pixels(planes) / std::abs(mean);
  predict_work(target, 0.5, predicted.bound, predicted);
  state.work = predicted.work, state.work_low = predicted.work_low, state.work_high = predicted.work_high;
}

// Light that may be missing falls like the number of samples, the rest of a bound like its root: work w for both, where
// the rest requires `work` alone, is the solution of work / w + missing^2 / (target w)^2 = 1.
double work_with_missing(double work, double missing_over_target) {
  return (work + std::sqrt(work * work + 4 * missing_over_target * missing_over_target)) / 2;
}

void add_missing_light(const ErrorTarget& target, double missing, TargetState& state) {
  if (missing <= 0) return;
  for (double* work : {&state.work, &state.work_low, &state.work_high})
    *work = work_with_missing(*work, missing / target.error);
  state.bound = std::hypot(state.bound, missing);
}

}  // namespace

TargetState judge(const ErrorTarget& target, const FilmPlanes& planes, const ErrorEstimate& error,
                  const ImageEstimate& image, double spent, const std::optional<FilteredError>& filtered) {
  TargetState state;
  const bool has_light = std::ranges::any_of(image.mean, [](double mean) { return mean != 0; });
  if (image.passes < 2 || !error.whole() || !has_light) return state;
  if (target.measure == TargetMeasure::denoised && !filtered) return state;
  state.is_known = true;
  switch (target.measure) {
    case TargetMeasure::relative:
      judge_relative(target, error, image.passes, spent, state);
      break;
    case TargetMeasure::pixels:
      judge_pixels(target, planes, image.passes, spent, state);
      break;
    case TargetMeasure::mean:
      judge_mean(target, planes, image, state);
      break;
    case TargetMeasure::denoised:
      judge_denoised(target, error, *filtered, image.passes, spent, state);
      break;
  }
  add_missing_light(target, error.missing_share(target.confidence), state);
  return state;
}

}  // namespace montelux
