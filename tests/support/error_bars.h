// How often error bars hold what they promise, over many seeds.
#pragma once
#include <algorithm>

#include "error_bar_scenes.h"
#include "statistics.h"

namespace montelux::test {

// Over seeds, for one scene and one point set.
struct Coverage {
  double pixels = 0, pixel_intervals = 0;  // 95 % intervals of pixels that hold the truth, and all
  double images = 0, seeds = 0;            // the same for the image mean
  double estimated_mse = 0, true_mse = 0;  // sums over seeds of means over pixels; the truth's own error is taken off
  std::vector<double> pixel_share;         // by seed
  std::vector<double> estimated, squares;  // by seed: estimated and true squared error, means over pixels

  // Of the estimated to the true mean squared error.
  double ratio() const { return estimated_mse / true_mse; }
  // Is that ratio in [low, high]? Student's test of estimated - r true, r the nearest ratio of the range.
  double ratio_p_value(double low, double high) const {
    const double nearest = std::clamp(ratio(), low, high);
    std::vector<double> excess;
    for (std::size_t i = 0; i < squares.size(); ++i) excess.push_back(estimated[i] - nearest * squares[i]);
    return t_test(excess, 0).p_value;
  }
  // Is the mean share of covered pixels in [low, high]?
  double pixels_p_value(double low, double high) const {
    const SampleSummary share = summarize(pixel_share);
    return t_test(share, std::clamp(share.mean, low, high)).p_value;
  }
};

// Of the films that `film_of` gives for each seed. `shrink` plants a fault: standard errors are multiplied by it.
template <class FilmOf>
Coverage measure_coverage_of(FilmOf film_of, const Truth& truth, PassPlan plan, int seeds, double shrink = 1) {
  Coverage c;
  const double t = student_t_quantile(0.975, plan.passes - 1);
  for (int seed = 1; seed <= seeds; ++seed) {
    const Film film = film_of(std::uint32_t(seed));
    const PixelBounds& b = film.bounds();
    double held = 0, pixels = 0, squares = 0, estimated = 0;
    std::size_t i = 0;
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x, ++i) {
        const PixelEstimate& p = film.pixel(x, y);
        const double variance = shrink * shrink * p.variance_of_mean(0), off = p.mean[0] - truth.mean[i];
        // The truth's own variance widens the interval by next to nothing.
        held += off * off <= t * t * (variance + truth.variance[i]) ? 1 : 0;
        pixels += 1;
        estimated += variance;
        squares += off * off - truth.variance[i];
      }
    c.true_mse += squares / pixels, c.estimated_mse += estimated / pixels;
    c.estimated.push_back(estimated / pixels), c.squares.push_back(squares / pixels);
    c.pixels += held, c.pixel_intervals += pixels, c.pixel_share.push_back(held / pixels);
    const ImageEstimate image = film.image();
    const double off = image.mean[0] - truth.image, error = shrink * image.standard_error[0];
    c.images += off * off <= t * t * (error * error + truth.image_error * truth.image_error) ? 1 : 0;
    c.seeds += 1;
  }
  return c;
}

// By path tracing.
inline Coverage measure_coverage(const TestScene& scene, const Truth& truth, PointSetKind sampler, PassPlan plan,
                                 int seeds, double shrink = 1) {
  return measure_coverage_of(
      [&](std::uint32_t seed) { return scene.render(sampler, plan, seed, Lanes::native, 0).film; }, truth, plan, seeds,
      shrink);
}
// By the integrator of this name and settings.
inline Coverage measure_coverage(const TestScene& scene, const Truth& truth, std::string_view integrator, PassPlan plan,
                                 int seeds, double shrink = 1) {
  const ChosenIntegrator chosen = scene.integrator(integrator);
  return measure_coverage_of(
      [&](std::uint32_t seed) {
        RenderObserver silent;
        return render(chosen.any(), scene.settings(PointSetKind::blue_noise, plan, seed, 0), silent).film;
      },
      truth, plan, seeds, shrink);
}

struct ShareInterval {
  double low = 0, high = 1;
};
// Two-sided exact interval of a probability (Clopper and Pearson 1934).
inline ShareInterval binomial_interval(double successes, double trials, double level) {
  // The p at which `tail`, which rises with p, reaches a value.
  const auto where = [](auto tail, double value) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) (tail(0.5 * (low + high)) < value ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  };
  const auto at_least = [&](double k) { return [=](double p) { return incomplete_beta(k, trials - k + 1, p); }; };
  return {successes > 0 ? where(at_least(successes), 0.5 * level) : 0,
          successes < trials ? where(at_least(successes + 1), 1 - 0.5 * level) : 1};
}
// Student's, of the mean of independent values.
inline ShareInterval mean_interval(const std::vector<double>& x, double level) {
  const SampleSummary s = summarize(x);
  const double half = student_t_quantile(1 - 0.5 * level, double(x.size()) - 1) * s.standard_error();
  return {s.mean - half, s.mean + half};
}

// Two-sided exact test (Clopper and Pearson 1934): is the probability of a success in [low, high]?
inline double binomial_p_value(double successes, double trials, double low, double high) {
  const auto at_least = [&](double k, double p) {
    return k <= 0 ? 1.0 : k > trials ? 0.0 : incomplete_beta(k, trials - k + 1, p);
  };
  const double as_many = at_least(successes, high), as_few = 1 - at_least(successes + 1, low);
  return std::min(1.0, 2 * std::min(as_many, as_few));
}

}  // namespace montelux::test
