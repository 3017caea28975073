// Means of the image and of its blocks in every pass, each component by itself, and the comparison of two ways to
// render a scene. Passes are independent, whatever the pixels of a pass share.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "pass_means.h"

namespace montelux::test {

// Of one component, by quantity (the image first, then blocks of 8 x 8 pixels row by row), the values of all passes.
using ComponentMeans = std::array<std::vector<std::vector<double>>, rgb_size>;

inline void add_components(const Film& film, ComponentMeans& means) {
  constexpr int side = 8;
  const PixelBounds& b = film.bounds();
  const int across = (b.width() + side - 1) / side, down = (b.height() + side - 1) / side;
  for (int c = 0; c < rgb_size; ++c) {
    std::vector<double> sums(std::size_t(1 + across * down), 0.0), counts = sums;
    for (int y = b.y0; y < b.y1; ++y)
      for (int x = b.x0; x < b.x1; ++x) {
        const auto block = std::size_t(1 + (y - b.y0) / side * across + (x - b.x0) / side);
        for (const std::size_t i : {std::size_t(0), block}) sums[i] += film.pixel(x, y).mean[c], counts[i] += 1;
      }
    std::vector<std::vector<double>>& own = means[std::size_t(c)];
    own.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) own[i].push_back(sums[i] / counts[i]);
  }
}

// The largest relative standard error of the image mean in a component.
inline double image_error(const ComponentMeans& means) {
  double largest = 0;
  for (const auto& component : means) {
    const SampleSummary image = summarize(component[0]);
    largest = std::max(largest, image.standard_error() / image.mean);
  }
  return largest;
}

// As many passes as the image mean needs for this relative standard error in every component, by a first look, and
// `max_passes` at most.
inline ComponentMeans measure_components(double wanted, int max_passes, const TestScene& scene, const std::string& way,
                                         int samples_per_pass, std::uint32_t seed) {
  constexpr int first_look = 32;
  const ChosenIntegrator chosen = scene.integrator(way);
  ComponentMeans means;
  RenderObserver silent;
  const auto measure = [&](int first, int end) {
    for (int pass = first; pass < end; ++pass) {
      RenderSettings s = scene.settings(PointSetKind::blue_noise, {samples_per_pass, 1}, seed, 0);
      s.plan.first_pass = pass;
      const Film film = render(chosen.any(), s, silent).film;
      EXPECT_EQ(film.non_finite(), 0u) << way;
      add_components(film, means);
    }
  };
  measure(0, first_look);
  const double ratio = image_error(means) / wanted;
  int passes = std::clamp(int(1.1 * ratio * ratio * first_look) + 1, first_look, max_passes);
  measure(first_look, passes);
  // Where a first look sees too few of the bright paths.
  while (image_error(means) > 1.1 * wanted && passes < max_passes) {
    const int more = std::min(passes / 2, max_passes - passes);
    measure(passes, passes + more), passes += more;
  }
  return means;
}

inline ComponentMeans scaled(ComponentMeans means, double factor) {
  for (auto& component : means)
    for (auto& quantity : component)
      for (double& x : quantity) x *= factor;
  return means;
}

// Welch's test of every quantity in every component, at a level for all of them together: half of it for the image,
// half for the blocks.
struct ComponentVerdict {
  bool differ = false;
  double smallest_p = 1;
  double image_difference = 0, image_error = 0;  // relative, in the component whose difference is the largest
  double error_of_blocks = 0;                    // the largest standard error of one, relative to its mean
};
inline ComponentVerdict compare_components(const ComponentMeans& a, const ComponentMeans& b, double level) {
  ComponentVerdict v;
  const double blocks = double(rgb_size * (a[0].size() - 1)), of_image = sidak_level(level / 2, rgb_size),
               of_block = sidak_level(level / 2, blocks);
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i) {
      const SampleSummary x = summarize(a[c][i]), y = summarize(b[c][i]);
      const double error = std::hypot(x.standard_error(), y.standard_error()) / y.mean;
      if (i == 0 && std::abs(x.mean / y.mean - 1) >= std::abs(v.image_difference))
        v.image_difference = x.mean / y.mean - 1, v.image_error = error;
      if (i > 0) v.error_of_blocks = std::max(v.error_of_blocks, error);
      const double p = welch_test(x, y).p_value;
      v.smallest_p = std::min(v.smallest_p, p);
      v.differ = v.differ || p < (i == 0 ? of_image : of_block);
    }
  return v;
}

}  // namespace montelux::test
