// The film's layers against plain formulas.
#include "film/layer_film.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "film/film.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{1, 0, 4, 2};
constexpr int layers = 3, passes = 7, samples = 4;

// The sums of one pixel in one pass: layers that go together, and all light.
std::vector<ExactRgb> pass_of(int x, int y, int pass) {
  RandomStream<float> random(std::uint32_t(x + 10 * y), std::uint32_t(pass));
  std::vector<ExactRgb> sums(layers + 1);
  const float common = random.next();
  for (int i = 1; i <= layers; ++i)
    for (int c = 0; c < rgb_size; ++c) sums[std::size_t(i)].c[c].add(float(i) * common + random.next());
  for (int i = 1; i <= layers; ++i) sums[0] += sums[std::size_t(i)];
  return sums;
}

LayerFilm film_of(int first, int count) {
  LayerFilm film(bounds, layers, true, true);
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x)
      for (int p = first; p < first + count; ++p) film.add(x, y, samples, pass_of(x, y, p), p % 2 == 0);
  return film;
}

// By their definitions, from all passes at once.
LayerSpread spread_of(int x, int y, int layer) {
  LayerSpread s;
  for (int c = 0; c < rgb_size; ++c) {
    double all_mean = 0;
    const auto value = [&](int p, int i) { return pass_of(x, y, p)[std::size_t(i)].c[c].value() / samples; };
    for (int p = 0; p < passes; ++p) s.mean[c] += value(p, layer + 1) / passes, all_mean += value(p, 0) / passes;
    for (int p = 0; p < passes; ++p) {
      const double off = value(p, layer + 1) - s.mean[c];
      s.m2[c] += off * off, s.co_moment[c] += off * (value(p, 0) - all_mean);
    }
  }
  return s;
}

void expect_right_halves(const LayerFilm& film, int x, int y, int layer) {
  const std::array<LayerHalf, 2> halves = film.halves(x, y, layer);
  for (std::size_t c = 0; c < rgb_size; ++c) {
    double sum[2] = {}, count[2] = {};
    for (int p = 0; p < passes; ++p)
      sum[p % 2] += pass_of(x, y, p)[std::size_t(layer + 1)].c[c].value() / samples, count[p % 2] += 1;
    for (std::size_t h = 0; h < 2; ++h) EXPECT_NEAR(halves[h][c], sum[h] / count[h], 1e-13);
  }
}

void expect_right(const LayerFilm& film) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x)
      for (int i = -1; i < layers; ++i) {
        const LayerSpread found = film.spread(x, y, i), right = spread_of(x, y, i);
        for (int c = 0; c < rgb_size; ++c) {
          EXPECT_NEAR(found.mean[c], right.mean[c], 1e-13);
          EXPECT_NEAR(found.m2[c], right.m2[c], 1e-13);
          EXPECT_NEAR(found.co_moment[c], right.co_moment[c], 1e-13);
          EXPECT_NEAR(film.variance_of_mean(x, y, i, c), right.m2[c] / (passes - 1) / passes, 1e-13);
          EXPECT_NEAR(i < 0 ? film.mean(x, y, c) : film.layer_mean(x, y, i, c), right.mean[c], 1e-13);
        }
        if (i >= 0) expect_right_halves(film, x, y, i);
      }
}

TEST(LayerFilm, has_the_moments_of_all_passes) { expect_right(film_of(0, passes)); }

TEST(LayerFilm, merges_to_the_film_of_all_passes) {
  LayerFilm film = film_of(0, 3);
  film.merge(film_of(3, passes - 3));
  expect_right(film);
  LayerFilm fresh(bounds, layers, true, true);
  fresh.merge(film);
  expect_right(fresh);
}

TEST(LayerFilm, does_not_merge_with_other_layers) {
  LayerFilm film(bounds, layers, true, false);
  EXPECT_THROW(film.merge(LayerFilm(bounds, layers + 1, true, false)), std::invalid_argument);
  EXPECT_THROW(film.merge(LayerFilm(bounds, layers, false, false)), std::invalid_argument);
  EXPECT_THROW(film.merge(LayerFilm(bounds, layers, true, true)), std::invalid_argument);
  LayerPlan plan;
  plan.techniques = true;
  Film with(bounds, plan);
  EXPECT_THROW(with.merge(Film(bounds)), std::invalid_argument);
}

TEST(LayerFilm, has_the_whole_as_both_halves_where_one_has_no_pass) {
  for (int only : {0, 1}) {
    const LayerFilm film = film_of(only, 1);
    const std::array<LayerHalf, 2> halves = film.halves(bounds.x0, bounds.y0, 1);
    for (std::size_t c = 0; c < rgb_size; ++c)
      for (const LayerHalf& half : halves)
        EXPECT_NEAR(half[c], pass_of(bounds.x0, bounds.y0, only)[2].c[c].value() / samples, 1e-13);
  }
}

TEST(LayerFilm, knows_no_variance_of_one_pass) {
  EXPECT_TRUE(std::isinf(film_of(0, 1).variance_of_mean(bounds.x0, bounds.y0, 0, 0)));
}

// One sample of three is not finite: neither the picture nor its layers have it.
TEST(Film, leaves_a_sample_that_is_not_finite_out_of_the_layers_too) {
  LayerPlan plan;
  plan.techniques = true;
  const PixelBounds one{0, 0, 1, 1};
  Film film(one, plan);
  std::vector<PixelSample> pixel(3);
  pixel[0].radiance = gray_rgb(1.0f), pixel[1].radiance = gray_rgb(std::nanf("")), pixel[2].radiance = gray_rgb(2.0f);
  std::vector<ExactRgb> sums(std::size_t(plan.count()) + 1);
  for (int c = 0; c < rgb_size; ++c) sums[0].c[c].add(3), sums[2].c[c].add(3);
  film.add_pass(one, 0, 3, pixel, sums);
  EXPECT_EQ(film.non_finite(), 1u);
  EXPECT_EQ(film.pixel(0, 0).mean[0], 1.5);
  EXPECT_EQ(film.layers()->mean(0, 0, 0), 1.5);
  EXPECT_EQ(film.layers()->layer_mean(0, 0, 1, 0), 1.5);
}

}  // namespace

}  // namespace montelux
