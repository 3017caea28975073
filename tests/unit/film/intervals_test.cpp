// The intervals of pixels, on noise whose law is known: how often they contain the expectation.
#include "film/intervals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "film/film.h"
#include "mc/confidence.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr int side = 64, passes = 8;
constexpr PixelBounds bounds{0, 0, side, side};

// A pixel: uniform noise around `base`, of relative half-width `spread`, and in a share of the samples a bright one.
struct Law {
  float base = 0.2f, spread = 0.3f, bright = 0;
  double probability = 0;
  std::uint32_t object = 1;
  bool emits = false;  // the bright samples are those of an emitter that the camera sees
  std::uint32_t emission_rays = 1;
  double expectation() const { return double(base) + probability * double(bright); }
  // Of the mean over all passes of one sample.
  double standard_error() const {
    const double even = double(base) * double(spread) / std::sqrt(3.0);
    return std::sqrt((even * even + probability * (1 - probability) * double(bright) * double(bright)) / passes);
  }
};

template <class LawOf>
Film film_of(LawOf law_of, std::uint32_t seed) {
  Film film(bounds);
  const RandomStream<float> random(seed, 5u);
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<PixelSample> samples(std::size_t(bounds.area()));
    for (int i = 0; i < bounds.area(); ++i) {
      const Law law = law_of(i % side, i / side);
      const std::uint32_t number = 2 * std::uint32_t(pass * bounds.area() + i);
      PixelSample& s = samples[std::size_t(i)];
      const bool hit = double(random.at(number)) < law.probability;
      s.radiance = gray_rgb(law.base * (1 + law.spread * (2 * random.at(number + 1) - 1)) + (hit ? law.bright : 0.0f));
      s.features.coverage = 1, s.features.object = law.object;
      if (hit && law.emits) s.features.emission = gray_rgb(law.bright);
      s.features.emission_rays = law.emission_rays;
      s.features.albedo = gray_rgb(law.object % 2 == 0 ? 0.9f : 0.2f);
    }
    film.add_pass(bounds, pass, 1, samples);
  }
  return film;
}

// The share of pixels whose interval contains the expectation, and the mean half-width over that of 1.96 true standard
// errors; where `counts` says so. `scale`: of the half-widths, to plant a fault.
struct Coverage {
  double share = 0, width = 0;
};

template <class LawOf, class Counts>
Coverage coverage_of(LawOf law_of, Counts counts, double scale = 1) {
  constexpr int seeds = 6;
  double covered = 0, all = 0, widths = 0, oracle = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const PixelIntervals intervals = pixel_intervals(film_of(law_of, std::uint32_t(seed)));
    for (int i = 0; i < bounds.area(); ++i) {
      const int x = i % side, y = i / side;
      if (!counts(x, y)) continue;
      const Law law = law_of(x, y);
      const double low = double(intervals.low[0][std::size_t(i)]), high = double(intervals.high[0][std::size_t(i)]);
      const double mean = (low + high) / 2, half = scale * (high - low) / 2;
      covered += std::abs(mean - law.expectation()) <= half, all += 1;
      widths += half, oracle += 1.96 * law.standard_error();
    }
  }
  return {covered / all, widths / oracle};
}

bool everywhere(int, int) { return true; }

// The share that intervals by the pixel alone cover.
template <class LawOf>
double coverage_by_student(LawOf law_of) {
  const Film film = film_of(law_of, 0);
  double covered = 0;
  for (int i = 0; i < bounds.area(); ++i) {
    const PixelEstimate p = film.pixel(i % side, i / side);
    const Interval range = confidence_interval(p.mean[0], std::sqrt(p.variance_of_mean(0)), passes);
    const double expectation = law_of(i % side, i / side).expectation();
    covered += range.low <= expectation && expectation <= range.high;
  }
  return covered / bounds.area();
}

// The share that intervals by the neighbours' variance cover, all neighbours alike, and their widths as above.
template <class LawOf, class Counts>
Coverage coverage_by_box(LawOf law_of, Counts counts) {
  const Film film = film_of(law_of, 0);
  double covered = 0, all = 0, widths = 0, oracle = 0;
  for (int y = 3; y < side - 3; ++y)
    for (int x = 3; x < side - 3; ++x) {
      if (!counts(x, y)) continue;
      double variance = 0;
      for (int k = 0; k < 49; ++k) variance += film.pixel(x + k % 7 - 3, y + k / 7 - 3).variance_of_mean(0) / 49;
      const Law law = law_of(x, y);
      const double half = 1.96 * std::sqrt(variance);
      covered += std::abs(film.pixel(x, y).mean[0] - law.expectation()) <= half, all += 1;
      widths += half, oracle += 1.96 * law.standard_error();
    }
  return {covered / all, widths / oracle};
}

Law even(int, int) { return {}; }

// Bright samples that half of the pixels have not met.
Law rare(int, int) { return {0.1f, 0.3f, 4, 0.08, 1}; }

// A shadow whose edge no feature shows: nine times the noise on one side.
Law shadow(int x, int) { return x < side / 2 ? Law{0.05f} : Law{0.45f}; }

// Objects of four pixels width, of which every other one has 25 times the noise.
Law stripes(int x, int) { return x / 4 % 2 ? Law{0.5f, 0.5f, 0, 0, 2} : Law{0.1f, 0.1f, 0, 0, 1}; }

// Lamps that fill one pixel, and a small part of those around it.
bool beside_lamp(int x, int y) { return x % 8 >= 3 && x % 8 <= 5 && y % 8 >= 3 && y % 8 <= 5; }
Law lamps(int x, int y) {
  const bool lamp = x % 8 == 4 && y % 8 == 4;
  return {0.05f, 0.3f, beside_lamp(x, y) ? 30.0f : 0.0f, lamp ? 0.8 : 0.04, 1, true};
}

// A lamp that fills pixels, and a seventh of those along its edge, so that half of these have no sample of it.
bool at_edge(int x, int) { return x % 12 == 3 || x % 12 == 8; }
Law wide_lamp(int x, int) {
  const bool lamp = x % 12 > 3 && x % 12 < 8;
  return {0.05f, 0.3f, lamp || x % 12 == 3 || x % 12 == 8 ? 30.0f : 0.0f, lamp ? 1.0 : 1.0 / 7, 1, true};
}

// A highlight of few pixels, whose samples are bright or not, on a dark surface.
Law highlight(int x, int y) {
  const bool bright = std::abs(x - side / 2) < 3 && std::abs(y - side / 2) < 3;
  return bright ? Law{5, 0.3f, 40, 0.5, 1} : Law{0.02f};
}
// The pixels of the wide neighbourhood, without those beside it.
bool near_highlight(int x, int y) {
  const int distance = std::max(std::abs(x - side / 2), std::abs(y - side / 2));
  return distance > 6 && distance < 15;
}

}  // namespace

TEST(PixelIntervals, contain_the_expectation_with_their_probability) {
  const Coverage c = coverage_of(even, everywhere);
  EXPECT_GT(c.share, 0.94);
  EXPECT_LT(c.share, 0.97);
  EXPECT_LT(c.width, 1.12);
}

TEST(PixelIntervals, reject_an_error_bar_that_is_20_percent_short) {
  EXPECT_LT(coverage_of(even, everywhere, 0.8).share, 0.93);
  EXPECT_LT(coverage_of(rare, everywhere, 0.8).share, 0.93);
}

TEST(PixelIntervals, know_of_bright_samples_that_the_pixel_has_not_met) {
  EXPECT_LT(coverage_by_student(rare), 0.75);
  const Coverage c = coverage_of(rare, everywhere);
  EXPECT_GT(c.share, 0.93);
  EXPECT_LT(c.share, 0.975);
  EXPECT_LT(c.width, 1.25);
}

TEST(PixelIntervals, keep_to_the_pixel_at_the_edge_of_a_shadow) {
  const auto dark_side = [](int x, int) { return x >= side / 2 - 3 && x < side / 2; };
  const auto bright_side = [](int x, int) { return x >= side / 2 && x < side / 2 + 3; };
  for (const Coverage& c : {coverage_of(shadow, dark_side), coverage_of(shadow, bright_side)}) {
    EXPECT_GT(c.share, 0.92);
    EXPECT_LT(c.share, 0.985);
    EXPECT_LT(c.width, 1.3);
  }
}

// Without regard to the brightness of both, their intervals are 79 times as wide as those of the oracle.
TEST(PixelIntervals, are_less_wide_near_a_highlight_that_is_surely_brighter) {
  const Coverage c = coverage_of(highlight, near_highlight);
  EXPECT_GT(c.share, 0.94);
  EXPECT_LT(c.width, 30);
}

// Rare samples make the light of the dark side, which is as if it had fewer samples of the other one's kind.
TEST(PixelIntervals, know_of_rare_bright_samples_beside_what_is_brighter) {
  const auto law = [](int x, int) { return x < side / 2 ? Law{0.1f, 0.3f, 4, 0.08, 1} : Law{0.5f, 0.3f, 4, 0.5, 1}; };
  const Coverage c = coverage_of(law, [](int x, int) { return x < side / 2 && x >= side / 2 - 12; });
  EXPECT_GT(c.share, 0.93);
  EXPECT_LT(c.share, 0.985);
}

TEST(PixelIntervals, keep_to_the_pixels_of_the_same_object) {
  const auto quiet = [](int x, int) { return x / 4 % 2 == 0; };
  const auto noisy = [](int x, int) { return x / 4 % 2 == 1; };
  for (const Coverage& c : {coverage_of(stripes, quiet), coverage_of(stripes, noisy)}) {
    EXPECT_GT(c.share, 0.93);
    EXPECT_LT(c.share, 0.975);
    EXPECT_LT(c.width, 1.2);
  }
  // The same figures reject neighbours of which none is unlike.
  EXPECT_GT(coverage_by_box(stripes, quiet).width, 5);
  EXPECT_LT(coverage_by_box(stripes, noisy).share, 0.9);
}

TEST(PixelIntervals, know_of_a_lamp_beside_the_pixel) {
  const Coverage c = coverage_of(lamps, beside_lamp);
  EXPECT_GT(c.share, 0.95);
  EXPECT_LT(c.width, 1.4);
}

// Independent samples: fewer are spread over the pixel as well as the limit expects.
TEST(PixelIntervals, know_of_the_edge_of_a_lamp) {
  const Coverage c = coverage_of(wide_lamp, at_edge);
  EXPECT_GT(c.share, 0.93);
  EXPECT_LT(c.width, 1.3);
}

// A sample of a thousand of a thousand times the light: the interval of a pixel that has none is not that of one.
// Rays for lamps went to the pixels at the edge of a lamp alone, so that those beside them show nothing of it.
TEST(PixelIntervals, are_not_widened_beside_a_lamp_whose_pixels_are_known) {
  const auto lamp = [](int x, std::uint32_t rays_at_edge) {
    const bool edge = x % 12 == 3 || x % 12 == 8, inside = x % 12 > 3 && x % 12 < 8;
    return Law{0.05f, 0.3f, inside ? 30.0f : edge ? 15.0f : 0.0f, 1, 1, true, edge ? rays_at_edge : 1};
  };
  const auto beside_edge = [](int x, int) { return x % 12 == 2 || x % 12 == 9; };
  const auto known = [&](int x, int) { return lamp(x, 8); };
  const auto unknown = [&](int x, int) { return lamp(x, 1); };
  const Coverage c = coverage_of(known, beside_edge);
  EXPECT_GT(c.share, 0.93);
  EXPECT_LT(c.width, 1.3);
  EXPECT_GT(coverage_of(unknown, beside_edge).width, 10);
}

TEST(PixelIntervals, are_not_widened_by_what_hardly_any_pixel_has) {
  const auto fireflies = [](int, int) { return Law{0.2f, 0.3f, 200, 1e-4, 1}; };
  const Coverage c = coverage_of(fireflies, everywhere);
  EXPECT_LT(c.width, 0.6);
}

TEST(PixelIntervals, have_no_end_where_there_is_one_pass) {
  Film film(PixelBounds{0, 0, 3, 2});
  film.add_pass({0, 0, 3, 2}, 0, 1, std::vector<PixelSample>(6));
  const PixelIntervals one = pixel_intervals(film);
  EXPECT_TRUE(std::isinf(one.low[0][0]) && one.low[0][0] < 0);
  EXPECT_TRUE(std::isinf(one.high[2][5]) && one.high[2][5] > 0);
  film.add_pass({0, 0, 3, 2}, 1, 1, std::vector<PixelSample>(6));
  const PixelIntervals two = pixel_intervals(film);
  EXPECT_EQ(two.low[0][0], 0);
  EXPECT_EQ(two.high[0][0], 0);
}

TEST(PixelIntervals, grow_with_the_confidence) {
  const Film film = film_of(even, 1);
  const PixelIntervals usual = pixel_intervals(film), sure = pixel_intervals(film, 0.999);
  EXPECT_EQ(sure.confidence, 0.999);
  for (std::size_t i = 0; i < std::size_t(bounds.area()); ++i) {
    EXPECT_LT(sure.low[1][i], usual.low[1][i]);
    EXPECT_GT(sure.high[1][i], usual.high[1][i]);
  }
}

}  // namespace montelux
