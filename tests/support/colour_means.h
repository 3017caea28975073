// The mean of a picture in each colour component, with its standard error, and its tests.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

inline constexpr int passes = 32;

struct Mean {
  std::array<double, 3> mean{}, standard_error{};
};

inline Mean measure(const TestScene& scene, const std::string& way, int samples_per_pass, std::uint32_t seed) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderObserver silent;
  const RenderResult result =
      render(chosen.any(), scene.settings(PointSetKind::independent, {samples_per_pass, passes}, seed), silent);
  const ImageEstimate image = result.film.image();
  EXPECT_EQ(result.film.non_finite(), 0u);
  Mean m;
  for (std::size_t c = 0; c < 3; ++c) m.mean[c] = image.mean[c], m.standard_error[c] = image.standard_error[c];
  return m;
}

// Student's test, with an allowance for paths that are summed in 32 bits.
inline double p_value(double mean, double standard_error, double truth) {
  const double distance = std::max(0.0, std::abs(mean - truth) - 1e-5 * truth);
  return distance == 0 ? 1 : 2 * student_t_cdf(-distance / standard_error, passes - 1);
}

// Welch's, of one mean and a multiple of another.
inline double p_value_of_difference(const Mean& a, const Mean& b, std::size_t component, double factor) {
  const auto variance = [&](const Mean& m) {
    return m.standard_error[component] * m.standard_error[component] * passes;
  };
  return welch_test({a.mean[component], variance(a), passes}, {factor * b.mean[component], variance(b), passes})
      .p_value;
}

}  // namespace montelux::test
