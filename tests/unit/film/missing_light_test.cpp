// Light that is met by chance, on noise whose law is known: what may be missing while no sample shows it.
#include <gtest/gtest.h>

#include <cmath>

#include "film/error_target.h"
#include "film/film.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{0, 0, 12, 8};
constexpr int passes = 16, samples = 96 * passes;
constexpr double base = 0.2;
constexpr Rgb bright{{3000.0f, 1000.0f, 200.0f}};

// Even light, and with a probability that of the brightest light by chance.
Film film_of(double probability, std::uint32_t seed, const Rgb& stated) {
  Film film(bounds);
  film.set_max_chance_radiance(stated);
  const RandomStream<float> random(seed, 7u);
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<PixelSample> out(std::size_t(bounds.area()));
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool hit =
          double(random.at(std::uint32_t(pass) * std::uint32_t(out.size()) + std::uint32_t(i))) < probability;
      out[i].radiance = gray_rgb(float(base)) + (hit ? bright : gray_rgb(0.0f));
    }
    film.add_pass(bounds, pass, 1, out);
  }
  return film;
}

// The share of films whose upper end is not below the true mean of a channel.
double covered(double expected_hits, int channel, const Rgb& stated) {
  constexpr int films = 1000;
  int good = 0;
  const double probability = expected_hits / samples;
  for (std::uint32_t seed = 0; seed < films; ++seed) {
    const Film film = film_of(probability, seed, stated);
    const ImageEstimate image = film.image();
    const auto c = std::size_t(channel);
    const Interval plain = confidence_interval(image.mean[c], image.standard_error[c], image.passes, 0.95);
    const Interval interval = interval_with_missing(plain, film.error().chance_light[c], 0.95);
    EXPECT_EQ(interval.low, plain.low);
    good += interval.high >= base + probability * double(bright.c[c]);
  }
  return double(good) / films;
}

TEST(MissingLight, is_within_the_interval_of_the_mean_in_every_channel) {
  // Of 1000 films, 931 is below 95 % by 2.7 standard deviations.
  for (double hits : {0.3, 1.0, 2.0, 2.9, 4.0, 8.0})
    for (int channel = 0; channel < rgb_size; ++channel) EXPECT_GE(covered(hits, channel, bright), 0.931) << hits;
}

TEST(MissingLightPlanted, that_nothing_is_known_of_or_a_third_of_it_is_found) {
  EXPECT_LT(covered(1, 0, gray_rgb(0)), 0.7);
  EXPECT_LT(covered(2, 0, bright * 0.33f), 0.9);
}

TEST(MissingLight, keeps_a_target_from_being_reached_and_says_how_much_more_it_takes) {
  const Film film = film_of(0, 1, bright), unknowing = film_of(0, 1, gray_rgb(0));
  const double mean = (3000.0 + 1000 + 200) / 3 / samples, missing = -std::log(0.05) * mean / base;
  for (TargetMeasure measure :
       {TargetMeasure::mean, TargetMeasure::relative, TargetMeasure::pixels, TargetMeasure::denoised}) {
    ErrorTarget target;
    target.measure = measure, target.error = 0.05;
    const auto state_of = [&](const Film& f) {
      FilmPlanes planes(bounds);
      planes.copy(f, bounds);
      return judge(target, planes, f.error(), f.image(), 1, FilteredError{});
    };
    EXPECT_TRUE(state_of(unknowing).reaches(target));
    const TargetState state = state_of(film);
    EXPECT_FALSE(state.reaches(target));
    // Nothing else adds to the bound, which falls like the number of samples. Planes are floats: the rest is rounding.
    EXPECT_NEAR(state.bound, missing, 1e-6 * missing);
    EXPECT_NEAR(state.work, missing / target.error, 1e-6 * state.work);
  }
  EXPECT_TRUE(film.error().may_miss_light());
  EXPECT_NEAR(film.error().missing_share(0.95), missing, 1e-6 * missing);
  EXPECT_FALSE(unknowing.error().may_miss_light());
}

}  // namespace

}  // namespace montelux
