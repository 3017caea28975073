// The relative error that a film states, on noise whose law is known: the truth is the formula, not a picture.
#include "film/picture_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "film/film.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr int side = 64, passes = 8;
constexpr PixelBounds bounds{0, 0, side, side};

// A pixel that is `base`, and `base + bright` with a probability; `emits`: the excess is an emitter that the camera
// sees; `before_darkness`: nothing is beyond the excess.
struct RareLight {
  float base = 0.2f, bright = 0;
  double probability = 0;
  bool emits = false, before_darkness = false;
  std::uint32_t rays = 1;  // of each sample: the excess is the mean of what they show
};

// The film of eight passes, and its true relative mean squared error.
struct Picture {
  Film film{bounds};
  double true_error = 0;
};

template <class Law>
Picture picture_of(Law law, std::uint32_t seed, int samples_per_pass = 1) {
  Picture picture;
  const RandomStream<float> random(seed, 5u);
  for (int pass = 0; pass < passes; ++pass) {
    const int count = bounds.area() * samples_per_pass;
    auto samples = std::vector<PixelSample>(std::size_t(count));
    for (int k = 0; k < count; ++k) {
      const int i = k / samples_per_pass;
      const RareLight light = law(i % side, i / side);
      const auto number = std::uint32_t(pass * count + k);
      bool hit = double(random.at(number)) < light.probability;
      float excess = hit ? light.bright : 0.0f;
      for (std::uint32_t ray = 1; ray < light.rays; ++ray)
        if (double(random.fork(ray).at(number)) < light.probability) hit = true, excess += light.bright;
      excess /= float(light.rays);
      PixelSample& s = samples[std::size_t(k)];
      s.radiance = gray_rgb(light.base + excess);
      s.features.coverage = light.before_darkness && !hit ? 0.0f : 1.0f, s.features.object = 1,
      s.features.albedo = gray_rgb(0.5f);
      if (hit && light.emits) s.features.emission = gray_rgb(excess);
      s.features.emission_rays = light.rays;
    }
    picture.film.add_pass(bounds, pass, samples_per_pass, samples);
  }
  for (int i = 0; i < bounds.area(); ++i) {
    const RareLight light = law(i % side, i / side);
    const double expected = double(light.base) + light.probability * double(light.bright);
    const double difference = picture.film.pixel(i % side, i / side).mean[0] - expected;
    picture.true_error += difference * difference / (expected * expected + 0.01) / bounds.area();
  }
  return picture;
}

// Stated and true, by the law of the noise, in the mean of some pictures.
struct Means {
  double stated = 0, over_own_mean = 0, truth = 0;
  int unsure = 0;
};

template <class Law>
Means means_of(Law law) {
  constexpr int seeds = 24;
  Means means;
  for (int seed = 0; seed < seeds; ++seed) {
    const Picture picture = picture_of(law, std::uint32_t(seed));
    const ErrorEstimate error = picture.film.error();
    means.stated += error.relative_mse / seeds, means.truth += picture.true_error / seeds;
    means.unsure += error.is_unsure();
    for (int i = 0; i < bounds.area(); ++i) {
      const PixelEstimate& p = picture.film.pixel(i % side, i / side);
      means.over_own_mean += p.variance_of_mean(0) / (p.mean[0] * p.mean[0] + 0.01) / bounds.area() / seeds;
    }
  }
  return means;
}

}  // namespace

TEST(PictureError, is_true_where_any_pixel_may_have_a_rare_bright_sample) {
  const Means m = means_of([](int, int) { return RareLight{0.2f, 40, 0.002, false}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
  // A divisor that shares the noise counts each of them as 1 at most.
  EXPECT_LT(m.over_own_mean, 0.2 * m.truth);
}

TEST(PictureError, is_true_where_every_sample_is_alike) {
  const Means m = means_of([](int x, int y) {
    return RareLight{0.1f + 0.01f * float(x), 0.2f + 0.02f * float(y), 0.5, false};
  });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
}

// Each lamp fills a part of one pixel, a part whose logarithm is uniform.
RareLight small_lamp(int x, int y) {
  const bool is_lamp = x % 4 == 1 && y % 4 == 2;
  const double part = 0.001 * std::pow(800.0, double((x * 7 + y * 3) % 61) / 61);
  return {0.05f, 30, is_lamp ? part : 0.0, true};
}

TEST(PictureError, is_true_where_small_lamps_are_seen) {
  const Means m = means_of(small_lamp);
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
}

// How much of a pixel is inside a disk, at this distance of its centre from the edge: the filters of pixels overlap, or
// do not.
double inside(double distance, bool overlap) {
  return overlap ? 0.5 * std::erfc(-distance / (0.5 * std::sqrt(2.0))) : std::clamp(distance + 0.5, 0.0, 1.0);
}

double inside_a_disk(int x, int y, bool overlap) { return inside(14.3 - std::hypot(x - 30.2, y - 33.7), overlap); }

// Where no sample of a pixel hits the disk, both its mean and its variance seem to be zero. Without what the pixels
// around show, 0.08 and 0.24 of the error would be stated.
TEST(PictureError, is_true_at_the_edge_of_a_lamp) {
  const Means m = means_of([](int x, int y) { return RareLight{0.01f, 10, inside_a_disk(x, y, true), true}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
  EXPECT_LT(m.over_own_mean, 0.3 * m.truth);
}

// A filter with negative lobes makes the pixels beside a lamp negative, and some part of it has the expectation 0. The
// true error is large where a pixel has that part, so it is a mean over pictures. Points of the distribution of a part
// that happen to lie there would state up to 2.5 times the mean.
TEST(PictureError, is_true_at_the_edge_of_a_lamp_in_negative_surroundings) {
  double stated = 0, truth = 0, largest = 0;
  constexpr int pictures = 96;
  for (int i = 0; i < pictures; ++i) {
    const float base = -0.3f * std::pow(100.0f, float(i * 37 % pictures) / pictures);
    const Picture picture = picture_of(
        [&](int x, int y) {
          return RareLight{base, 1000, inside_a_disk(x, y, true), true};
        },
        std::uint32_t(i));
    const double error = picture.film.error().relative_mse;
    stated += error, truth += picture.true_error, largest = std::max(largest, error);
  }
  EXPECT_GT(stated, 0.5 * truth);
  EXPECT_LT(stated, 1.5 * truth);
  EXPECT_LT(largest, 1.3 * truth / pictures);
}

TEST(PictureError, is_true_at_the_edge_of_a_surface_before_darkness) {
  const Means m = means_of([](int x, int y) { return RareLight{0, 3, inside_a_disk(x, y, true), false, true}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
  EXPECT_LT(m.over_own_mean, 0.5 * m.truth);
}

// The pixels beside the edge show nothing of the lamp, which eight samples do not tell for sure: the error is
// stated 4.9 times too large, and would be 7.6 times if the halves were not compared.
TEST(PictureError, knows_by_halves_that_pixels_do_not_overlap) {
  const Means m = means_of([](int x, int y) { return RareLight{0.01f, 10, inside_a_disk(x, y, false), true}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 6 * m.truth);
}

// Rays for lamps went to the pixels at the edge alone: those beside them show nothing of the lamp. If they might, 2.1
// times the error would be stated.
TEST(PictureError, knows_by_rays_for_lamps_that_pixels_show_nothing_of_it) {
  const Means m = means_of([](int x, int y) {
    const double part = inside_a_disk(x, y, false);
    return RareLight{0.01f, 10, part, true, false, part > 0 && part < 1 ? 8u : 1u};
  });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
}

// Lamps of a fiftieth of a pixel, which the pixels around see through the tails of their filters, and no others. It is
// stated 1.8 times too large; 4.8 times if others might see them.
TEST(PictureError, knows_by_rays_for_lamps_that_no_others_see_a_small_one) {
  const Means m = means_of([](int x, int y) {
    const int dx = std::abs(x % 8 - 4), dy = std::abs(y % 8 - 4), distance = std::max(dx, dy);
    const double part = distance == 0 ? 0.02 : distance == 1 ? 0.001 : 0;
    return RareLight{0.01f, 500, part, true, false, part > 0 ? 64u : 1u};
  });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 2 * m.truth);
}

TEST(PictureError, knows_a_dark_pixel_beside_bright_ones_by_itself) {
  // Columns of light without noise, and between them dark ones with a little.
  const Means m = means_of([](int x, int) { return x % 2 ? RareLight{5} : RareLight{0.05f, 0.1f, 0.5, false}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
}

// Most of the nearest neighbours have none of the bright samples.
TEST(PictureError, is_true_where_bright_samples_are_rare_among_the_neighbours) {
  const Means m = means_of([](int, int) { return RareLight{0.02f, 250, 0.001, false}; });
  EXPECT_GT(m.stated, 0.8 * m.truth);
  EXPECT_LT(m.stated, 1.25 * m.truth);
}

TEST(PictureError, says_so_where_few_bright_samples_decide) {
  const auto rare = [](int, int) { return RareLight{0.2f, 400, 5e-5, false}; };
  const auto even = [](int, int) { return RareLight{0.2f, 0.2f, 0.5, false}; };
  const ErrorEstimate unsure = picture_of(rare, 3).film.error(), sure = picture_of(even, 3).film.error();
  EXPECT_TRUE(unsure.is_unsure());
  EXPECT_GT(unsure.relative_high, 2 * unsure.relative_low);
  EXPECT_FALSE(sure.is_unsure());
  EXPECT_LT(sure.relative_low, sure.relative_mse);
  // Of many pixels nothing is left but what the divisor may be off.
  EXPECT_LT(sure.relative_high, 1.6 * sure.relative_low);
}

// Some pixels are bright details, and others rarely have a bright sample: few of the latter are in an image, and their
// divisors are hard to tell from those of details. The interval is as wide as the tail of the errors says.
TEST(PictureError, has_an_interval_that_knows_of_its_tail) {
  constexpr int images = 200;
  int within = 0, without_tail = 0;
  for (std::uint32_t seed = 0; seed < images; ++seed) {
    const RandomStream<float> details(seed, 6u);
    const Picture picture = picture_of(
        [&](int x, int y) {
          const bool is_detail = details.at(std::uint32_t(y * side + x)) < 0.01f;
          return is_detail ? RareLight{0.2f, 20, 0.5, false} : RareLight{0.2f, 40, 1e-3, false};
        },
        seed);
    const ErrorEstimate e = picture.film.error();
    const double chance = std::sqrt(2 / e.effective_pixels);
    within += picture.true_error >= e.relative_low && picture.true_error <= e.relative_high;
    without_tail +=
        picture.true_error <= e.relative_mse * std::exp(1.96 * std::hypot(chance, divisor_deviation(passes)));
  }
  EXPECT_GE(within, 0.95 * images);
  EXPECT_LT(without_tail, 0.8 * images);
}

// The law of the hits is known at the rim of an emitter that is larger than a pixel, and no tail is added for it (with
// one, its mean is 0.22 here). Where every emitter is smaller than a pixel, it is.
TEST(PictureError, has_no_tail_at_the_rim_of_a_lamp) {
  constexpr int images = 100;
  int above = 0;
  double of_rim = 0, of_small_lamps = 0;  // deviations beyond that of the divisor
  for (std::uint32_t seed = 0; seed < images; ++seed) {
    const Picture rim = picture_of(
        [](int x, int y) {
          return RareLight{0.05f, 10, inside_a_disk(x, y, true), true};
        },
        seed);
    const ErrorEstimate e = rim.film.error(), of_small = picture_of(small_lamp, seed).film.error();
    above += rim.true_error > e.relative_high;
    of_rim += (e.log_deviation - divisor_deviation(passes)) / images;
    of_small_lamps += (of_small.log_deviation - divisor_deviation(passes)) / images;
  }
  EXPECT_LE(above, 0.06 * images);
  EXPECT_EQ(of_rim, 0);
  EXPECT_GT(of_small_lamps, 0.1);
}

// Of images of a law(x, y, seed): how many of their intervals contain the true error, and means.
struct Intervals {
  int within = 0;
  double deviation = 0, tail_index = 0;
  double width = 0;  // the upper end over the lower one
};
template <class Law>
Intervals intervals_of(int images, Law law, int samples_per_pass = 1) {
  Intervals all;
  for (int seed = 0; seed < images; ++seed) {
    const auto number = std::uint32_t(seed);
    const auto law_of_image = [&](int x, int y) { return law(x, y, number); };
    const Picture picture = picture_of(law_of_image, number, samples_per_pass);
    const ErrorEstimate e = picture.film.error();
    all.within += picture.true_error >= e.relative_low && picture.true_error <= e.relative_high;
    all.deviation += e.log_deviation / images, all.tail_index += e.tail_index / images;
    all.width += e.relative_high / e.relative_low / images;
  }
  return all;
}

// A tail hides the less the more pixels share in the error: this one would give a deviation of 0.5 to a few pixels.
TEST(PictureError, has_a_narrower_interval_where_many_pixels_have_a_tail) {
  constexpr int images = 200;
  const Intervals all = intervals_of(images, [](int x, int y, std::uint32_t seed) {
    const float u = RandomStream<float>(seed, 6u).at(std::uint32_t(y * side + x));
    return RareLight{0.2f, 2 * std::pow(std::max(u, 1e-4f), -0.35f), 0.1, false};
  });
  EXPECT_LT(all.tail_index, 2);
  EXPECT_LT(all.deviation, 0.2);
  EXPECT_GE(all.within, 0.95 * images);
}

// Of 128 samples the divisors are known, and of 4096 pixels the sum of squares.
TEST(PictureError, has_a_narrow_interval_where_all_is_known) {
  constexpr int images = 60, samples_per_pass = 16;
  const auto law = [](int x, int y, std::uint32_t) {
    return RareLight{0.1f + 0.01f * float(x), 0.2f + 0.02f * float(y), 0.5, false};
  };
  const Intervals all = intervals_of(images, law, samples_per_pass);
  EXPECT_GE(all.within, 0.95 * images);
  EXPECT_LT(all.width, 1.3);
}

// Nearly all pixels are without noise, and the errors of the others differ by powers of ten: a tail without a mean. The
// image shows all that there is, so that the interval must not be wider than its few pixels make it.
TEST(PictureError, has_an_interval_of_bounded_width_however_heavy_its_tail) {
  constexpr int images = 200;
  const Intervals all = intervals_of(images, [](int x, int y, std::uint32_t) {
    const bool is_noisy = x % 5 == 2 && y % 5 == 2;
    return RareLight{0.2f, is_noisy ? 2 * std::exp2(-0.1f * float(x + y)) : 0.0f, 0.3, false};
  });
  EXPECT_LT(all.tail_index, 1);
  EXPECT_LT(all.deviation, 0.65);
  EXPECT_GE(all.within, 0.95 * images);
}

// The variance of the true error of images, by the binomial distribution of the hits of each pixel.
template <class Law>
double variance_of_true_error(Law law) {
  double variance = 0;
  for (int i = 0; i < bounds.area(); ++i) {
    const RareLight light = law(i % side, i / side);
    const double p = light.probability, expected = double(light.base) + p * double(light.bright);
    double pmf = std::pow(1 - p, passes), mean = 0, square = 0;
    for (int hits = 0; hits <= passes && p < 1; ++hits) {
      const double difference = double(light.bright) * (double(hits) / passes - p);
      const double error = difference * difference / (expected * expected + 0.01) / bounds.area();
      mean += pmf * error, square += pmf * error * error;
      pmf *= double(passes - hits) / (hits + 1) * p / (1 - p);
    }
    variance += square - mean * mean;
  }
  return variance;
}

// At the edge of a lamp few hits make most of the error.
TEST(PictureError, knows_how_uncertain_rare_hits_make_it) {
  const auto law = [](int x, int y) { return RareLight{0.01f, 10, inside_a_disk(x, y, true), true}; };
  constexpr int images = 200;
  double stated = 0;
  int within = 0;
  for (std::uint32_t seed = 0; seed < images; ++seed) {
    const Picture picture = picture_of(law, seed);
    const ErrorEstimate e = picture.film.error();
    stated += e.relative_mse * e.relative_mse * 2 / e.effective_pixels / images;
    within += picture.true_error >= e.relative_low && picture.true_error <= e.relative_high;
  }
  const double truth = variance_of_true_error(law);
  EXPECT_GT(stated, 0.5 * truth);
  EXPECT_LT(stated, 2 * truth);
  EXPECT_GE(within, 0.95 * images);
}

}  // namespace montelux
