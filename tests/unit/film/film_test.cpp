// The film's running sums against the plain formulas, and merging.
#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{2, 1, 7, 5};
constexpr int samples_per_pass = 3;

// Samples of one pass over a tile, of a wide range of brightness.
std::vector<PixelSample> samples_of(const PixelBounds& tile, int pass, std::uint32_t seed) {
  RandomStream<float> random(seed, std::uint32_t(pass));
  std::vector<PixelSample> samples(std::size_t(tile.area() * samples_per_pass));
  for (PixelSample& s : samples) {
    for (float& c : s.radiance.c) c = std::exp(8 * random.next() - 4);
    s.features.coverage = random.next() < 0.5f ? 1.0f : 0.0f;
    s.features.depth = 1 + random.next();
    s.features.object = 1 + std::uint32_t(5 * random.next());
  }
  return samples;
}

Film film_of(int first_pass, int passes) {
  Film film(bounds);
  for (int p = first_pass; p < first_pass + passes; ++p)
    film.add_pass(bounds, p, samples_per_pass, samples_of(bounds, p, 7));
  return film;
}

// A film of two tiles: the passes of each, from its own source of numbers.
constexpr PixelBounds left_tile{2, 1, 4, 5}, right_tile{4, 1, 7, 5};
Film halves(const std::vector<int>& left, const std::vector<int>& right) {
  Film film(bounds);
  for (int p : left) film.add_pass(left_tile, p, samples_per_pass, samples_of(left_tile, p, 1));
  for (int p : right) film.add_pass(right_tile, p, samples_per_pass, samples_of(right_tile, p, 2));
  return film;
}

void expect_near_relative(double a, double b, double tolerance) { EXPECT_NEAR(a, b, tolerance * std::abs(b)); }

void expect_same(const Film& a, const Film& b, double tolerance) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      const PixelEstimate &p = a.pixel(x, y), &q = b.pixel(x, y);
      EXPECT_EQ(p.passes, q.passes);
      EXPECT_EQ(p.non_finite, q.non_finite);
      for (int c = 0; c < rgb_size; ++c) {
        expect_near_relative(p.mean[c], q.mean[c], tolerance);
        expect_near_relative(p.m2[c], q.m2[c], tolerance);
      }
      EXPECT_EQ(a.samples(x, y), b.samples(x, y));
      EXPECT_EQ(a.features(x, y).hits, b.features(x, y).hits);
      EXPECT_EQ(a.features(x, y).object, b.features(x, y).object);
      expect_near_relative(a.features(x, y).depth(), b.features(x, y).depth(), tolerance);
    }
  const ImageEstimate i = a.image(), j = b.image();
  EXPECT_EQ(i.passes, j.passes);
  for (int c = 0; c < rgb_size; ++c) {
    expect_near_relative(i.mean[c], j.mean[c], tolerance);
    expect_near_relative(i.standard_error[c], j.standard_error[c], tolerance);
  }
}

}  // namespace

TEST(Film, pixels_hold_mean_and_variance_of_the_pass_means) {
  constexpr int passes = 11;
  const Film film = film_of(0, passes);
  for (int pixel = 0; pixel < bounds.area(); ++pixel) {
    std::vector<double> means(passes);
    double mean = 0, squares = 0;
    for (int p = 0; p < passes; ++p) {
      const auto samples = samples_of(bounds, p, 7);
      for (int s = 0; s < samples_per_pass; ++s)
        means[std::size_t(p)] += double(samples[std::size_t(pixel * samples_per_pass + s)].radiance.c[1]) / 3;
      mean += means[std::size_t(p)] / passes;
    }
    for (double m : means) squares += (m - mean) * (m - mean);
    const PixelEstimate& e = film.pixel(bounds.x0 + pixel % bounds.width(), bounds.y0 + pixel / bounds.width());
    EXPECT_EQ(e.passes, std::uint32_t(passes));
    expect_near_relative(e.mean[1], mean, 1e-13);
    expect_near_relative(e.variance_of_mean(1), squares / (passes - 1) / passes, 1e-12);
  }
}

TEST(Film, image_estimate_is_that_of_the_pass_means_of_the_whole_image) {
  constexpr int passes = 9;
  const Film film = film_of(0, passes);
  std::vector<double> means(passes);
  double mean = 0, squares = 0;
  for (int p = 0; p < passes; ++p) {
    const auto samples = samples_of(bounds, p, 7);
    for (const PixelSample& s : samples) means[std::size_t(p)] += double(s.radiance.c[2]) / double(samples.size());
    mean += means[std::size_t(p)] / passes;
  }
  for (double m : means) squares += (m - mean) * (m - mean);
  const ImageEstimate image = film.image();
  EXPECT_EQ(image.passes, passes);
  expect_near_relative(image.mean[2], mean, 1e-13);
  expect_near_relative(image.standard_error[2], std::sqrt(squares / (passes - 1) / passes), 1e-12);
}

TEST(Film, sums_every_channel_of_the_table_of_features_and_leaves_out_what_is_not_finite) {
  constexpr PixelBounds pixel{0, 0, 1, 1};
  RandomStream<float> random(3, 0);
  std::array<double, feature_channel_count> expected{};
  Film film(pixel);
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<PixelSample> samples(1);
    Features& f = samples[0].features;
    f.coverage = 1, f.depth = 10 * random.next();
    f.position = {random.next(), -random.next(), random.next()};
    f.normal = {random.next(), random.next(), -random.next()};
    for (float& c : f.albedo.c) c = random.next();
    if (pass == 3) f.albedo.c[1] = f.depth = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < feature_channel_count; ++i) {
      const float value = feature_rows[feature_channels[i].row].value(f, feature_channels[i].channel);
      expected[i] += std::isfinite(value) ? double(value) : 0;
    }
    film.add_pass(pixel, pass, 1, samples);
  }
  const PixelFeatures sums = film.features(0, 0);
  EXPECT_EQ(sums.hits, 4);
  for (std::size_t i = 0; i < feature_channel_count; ++i) EXPECT_NEAR(sums.sums[i], expected[i], 1e-7) << i;
  EXPECT_GT(sums.depth(), 1);
  EXPECT_LT(sums.normal(2), -0.1);
  EXPECT_EQ(sums.albedo(1), sums.sums[feature_channel("albedo") + 1]);
}

TEST(Film, a_mean_far_from_zero_keeps_its_small_variance) {
  PixelSums sums;
  const double base = 1e8;
  for (double x : {base + 1, base + 2, base + 3}) sums.add_mean(0, {x, x, x});
  const PixelEstimate e = sums.estimate();
  EXPECT_DOUBLE_EQ(e.mean[0], base + 2);
  EXPECT_DOUBLE_EQ(e.variance_of_mean(0), 1.0 / 3);
}

TEST(Film, merging_two_films_is_one_film_of_all_passes) {
  Film merged = film_of(0, 5);
  merged.merge(film_of(5, 8));
  expect_same(merged, film_of(0, 13), 0);
}

TEST(Film, of_the_same_passes_is_the_same_bits_in_any_order) {
  const Film whole = film_of(0, 6);
  for (const std::vector<int>& order : {std::vector{5, 4, 3, 2, 1, 0}, {3, 0, 5, 1, 4, 2}}) {
    Film film(bounds);
    for (int p : order) film.add_pass(bounds, p, samples_per_pass, samples_of(bounds, p, 7));
    expect_same(film, whole, 0);
    Film merged = film_of(order[0], 1);
    for (std::size_t i = 1; i < order.size(); ++i) merged.merge(film_of(order[i], 1));
    expect_same(merged, whole, 0);
  }
}

TEST(Film, has_a_pass_once) {
  Film film = film_of(3, 2);
  EXPECT_THROW(film.add_pass(bounds, 4, samples_per_pass, samples_of(bounds, 4, 7)), std::invalid_argument);
  EXPECT_THROW(film.merge(film_of(4, 2)), std::invalid_argument);
  expect_same(film, film_of(3, 2), 0);
}

TEST(Film, of_other_tiles_is_not_merged) {
  Film film = film_of(0, 1), other(bounds);
  other.add_pass(right_tile, 1, samples_per_pass, samples_of(right_tile, 1, 7));
  EXPECT_THROW(film.merge(other), std::invalid_argument);
}

TEST(Film, merging_is_associative) {
  Film left = film_of(0, 3);
  left.merge(film_of(3, 4));
  left.merge(film_of(7, 6));
  Film right = film_of(3, 4);
  right.merge(film_of(7, 6));
  Film all = film_of(0, 3);
  all.merge(right);
  expect_same(left, all, 0);
}

TEST(Film, merging_an_empty_film_changes_nothing) {
  Film film = film_of(0, 4);
  film.merge(Film(bounds));
  expect_same(film, film_of(0, 4), 0);
  Film empty(bounds);
  empty.merge(film_of(0, 4));
  expect_same(empty, film_of(0, 4), 0);
}

TEST(Film, films_of_different_bounds_do_not_merge) {
  Film film = film_of(0, 2);
  EXPECT_THROW(film.merge(Film({0, 0, 5, 4})), std::invalid_argument);
}

TEST(Film, samples_that_are_not_finite_are_counted_and_kept_out) {
  const PixelBounds one{0, 0, 1, 1};
  Film film(one);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()};
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<PixelSample> samples(3);
    samples[0].radiance = gray_rgb(1.0f), samples[1].radiance = gray_rgb(3.0f);
    samples[2].radiance = gray_rgb(2.0f);
    samples[2].radiance.c[pass % 3] = bad[pass % 2];
    film.add_pass(one, pass, 3, samples);
  }
  EXPECT_EQ(film.non_finite(), 4u);
  EXPECT_EQ(film.pixel(0, 0).passes, 4u);
  for (double m : film.pixel(0, 0).mean) EXPECT_DOUBLE_EQ(m, 2);
  EXPECT_DOUBLE_EQ(film.samples(0, 0), 12);
}

TEST(Film, a_pass_without_a_finite_sample_is_no_pass_of_that_pixel) {
  const PixelBounds two{0, 0, 2, 1};
  Film film(two);
  for (int pass = 0; pass < 3; ++pass) {
    std::vector<PixelSample> samples(2);
    samples[0].radiance = gray_rgb(pass == 1 ? std::numeric_limits<float>::infinity() : 1.0f);
    samples[1].radiance = gray_rgb(2.0f);
    film.add_pass(two, pass, 1, samples);
  }
  EXPECT_EQ(film.pixel(0, 0).passes, 2u);
  EXPECT_EQ(film.pixel(1, 0).passes, 3u);
  EXPECT_EQ(film.non_finite(), 1u);
}

TEST(Film, below_two_passes_the_error_is_unknown) {
  const Film film = film_of(0, 1);
  EXPECT_TRUE(std::isinf(film.pixel(2, 1).variance_of_mean(0)));
  EXPECT_TRUE(std::isinf(film.image().standard_error[0]));
  EXPECT_EQ(film.error().pixels, 0u);
}

TEST(Film, image_has_the_passes_of_the_tile_that_has_fewest) {
  EXPECT_EQ(halves({0, 1, 2}, {0, 1}).image().passes, 2);
  EXPECT_EQ(halves({0, 1, 2}, {}).image().passes, 0);
}

// A render that was interrupted has more passes of some tiles than of others. The continued render pairs passes by
// their numbers.
TEST(Film, passes_of_tiles_meet_by_their_numbers) {
  Film film = halves({0, 1}, {0});
  film.merge(halves({2}, {1, 2}));
  expect_same(film, halves({0, 1, 2}, {0, 1, 2}), 0);
}

// The mean of each tile over its own passes, and the variance of that: tiles that share passes vary together.
TEST(Film, image_of_tiles_with_different_passes_has_the_mean_and_the_error_of_their_estimates) {
  const PixelBounds two{0, 0, 2, 1}, left{0, 0, 1, 1}, right{1, 0, 2, 1};
  // Passes of the tiles; correlated by half, or each by its own, or opposite, where the mean has no error but what the
  // left tile's other passes leave.
  for (const double correlation : {0.5, 0.0, -1.0}) {
    constexpr int films = 4000, left_passes = 12, right_passes = 8;
    Moments means, variances;
    for (int f = 0; f < films; ++f) {
      RandomStream<float> random(std::uint32_t(f), 77);
      Film film(two);
      for (int pass = 0; pass < left_passes; ++pass) {
        const double a = double(random.next()) - 0.5, b = double(random.next()) - 0.5;
        const double other = correlation * a + std::sqrt(1 - correlation * correlation) * b;
        std::vector<PixelSample> sample(1);
        sample[0].radiance = gray_rgb(float(1 + a));
        film.add_pass(left, pass, 1, sample);
        sample[0].radiance = gray_rgb(float(3 + other));
        if (pass < right_passes) film.add_pass(right, pass, 1, sample);
      }
      const ImageEstimate image = film.image();
      EXPECT_EQ(image.passes, right_passes);
      means.add(image.mean[0]), variances.add(image.standard_error[0] * image.standard_error[0]);
    }
    const double own = 1.0 / 12, n = left_passes, k = right_passes;
    const double truth = (own / n + own / k + 2 * correlation * own / n) / 4;
    EXPECT_NEAR(means.mean, 2, 4 * means.standard_error());
    EXPECT_NEAR(means.variance(), truth, 0.1 * truth) << correlation;
    // Of the part that passes share, 98 % are seen: sqrt((k - 1) n / (k (n - 1))).
    const double seen = (own / n + own / k + 2 * correlation * own / n * std::sqrt((k - 1) * n / (k * (n - 1)))) / 4;
    EXPECT_NEAR(variances.mean, seen, 4 * variances.standard_error()) << correlation;
    // Tiles that were taken for independent of each other, or as varying as one, would be told from it.
    for (const double wrong : {-1.0, 0.0, 0.5, 1.0})
      if (wrong != correlation) {
        const double planted = (own / n + own / k + 2 * wrong * own / n) / 4;
        EXPECT_GT(std::abs(variances.mean - planted), 6 * variances.standard_error()) << correlation << " " << wrong;
      }
  }
}

TEST(Film, a_sample_that_is_not_finite_hides_no_pass_of_the_image) {
  const PixelBounds two{0, 0, 2, 1};
  Film film(two);
  for (int pass = 0; pass < 5; ++pass) {
    std::vector<PixelSample> samples(2);
    samples[0].radiance = gray_rgb(pass == 0 ? std::numeric_limits<float>::infinity() : 1.0f);
    samples[1].radiance = gray_rgb(1.0f);
    film.add_pass(two, pass, 1, samples);
  }
  const ImageEstimate image = film.image();
  EXPECT_EQ(image.passes, 5);
  for (int c = 0; c < rgb_size; ++c) {
    EXPECT_EQ(image.mean[c], 1);
    EXPECT_EQ(image.standard_error[c], 0);
  }
  EXPECT_TRUE(film.error().whole());
}

TEST(Film, error_is_the_mean_variance_of_the_pixels) {
  const Film film = film_of(0, 6);
  double mse = 0;
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x)
      for (int c = 0; c < rgb_size; ++c) mse += film.pixel(x, y).variance_of_mean(c) / (3 * bounds.area());
  const ErrorEstimate e = film.error();
  EXPECT_EQ(e.pixels, std::size_t(bounds.area()));
  EXPECT_TRUE(e.whole());
  expect_near_relative(e.mse, mse, 1e-6);  // planes hold single precision
  expect_near_relative(film.mse(), mse, 1e-12);
}

TEST(Film, error_of_a_part_is_not_that_of_the_whole) {
  const Film film = halves({0, 1}, {0});
  const ErrorEstimate e = film.error();
  EXPECT_EQ(e.pixels, std::size_t(left_tile.area()));
  EXPECT_EQ(e.all, std::size_t(bounds.area()));
  EXPECT_FALSE(e.whole());
}

TEST(Film, a_sparse_film_repeats_the_pixels_that_are_sampled) {
  const PixelBounds picture{10, 20, 17, 25};  // 7 x 5 in cells of 3 x 3: 3 x 2 of them, cut off at the right and below
  Film film(picture, {}, 3);
  const PixelBounds cells = film.grid().cells();
  EXPECT_EQ(cells, (PixelBounds{0, 0, 3, 2}));
  std::vector<PixelSample> samples(6);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].radiance = gray_rgb(float(i));
  film.add_pass(cells, 0, 1, samples);
  int sampled = 0;
  for (int y = 20; y < 25; ++y)
    for (int x = 10; x < 17; ++x) {
      EXPECT_EQ(film.pixel(x, y).mean[0], (x - 10) / 3 + 3 * ((y - 20) / 3)) << x << " " << y;
      sampled += film.samples(x, y) > 0;
    }
  EXPECT_EQ(sampled, 6);
  EXPECT_TRUE(film.is_sampled(11, 21));
  EXPECT_TRUE(film.is_sampled(16, 24));  // the middle of the last cell is outside
  EXPECT_EQ(film.image().passes, 1);
  EXPECT_DOUBLE_EQ(film.image().mean[0], 2.5);
}

// A figure of a part of the picture would pass for one of the whole.
TEST(Film, of_a_sparse_picture_states_no_error) {
  for (const int stride : {1, 2}) {
    Film film({0, 0, 8, 8}, {}, stride);
    const PixelBounds cells = film.grid().cells();
    std::vector<PixelSample> samples(std::size_t(cells.area()));
    for (int pass = 0; pass < 4; ++pass) {
      for (PixelSample& s : samples) s.radiance = gray_rgb(float(1 + pass));
      film.add_pass(cells, pass, 1, samples);
    }
    EXPECT_EQ(film.error().whole(), stride == 1);
    EXPECT_GT(film.mse(), 0);
  }
}

}  // namespace montelux
