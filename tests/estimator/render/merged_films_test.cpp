// The error bars of films that were interrupted, cut into parts and merged: they hold the truth as often as they say.
#include <gtest/gtest.h>

#include <cmath>

#include "film/film.h"
#include "mc/confidence.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{0, 0, 4, 2};
constexpr int films = 3000;
constexpr double truth = 1, confidence = 0.9;

// A sample of a pixel in a pass: noise of its own, and noise that all pixels of the pass have in common.
float sample_of(std::uint32_t film, int pass, int x, int y) {
  RandomStream<float> common(film, std::uint32_t(1000 + pass)), own(film, std::uint32_t(8 * pass + x + 4 * y) + 5000);
  return float(truth) + 0.5f * (common.next() - 0.5f) + (own.next() - 0.5f);
}

void add(Film& film, std::uint32_t number, const PixelBounds& tile, int pass, int known_as) {
  std::vector<PixelSample> samples;
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) samples.push_back({gray_rgb(sample_of(number, pass, x, y)), {}});
  film.add_pass(tile, known_as, 1, samples);
}

// Twelve passes in three parts, of which the second was interrupted: in it the tiles on the right lack two passes,
// which the third part has. `shift`: what the number of a pass is off in the tiles on the right.
Film merged(std::uint32_t number, int shift) {
  const std::vector<PixelBounds> tiles = tiles_of(bounds, 2);
  Film parts[3] = {Film(bounds), Film(bounds), Film(bounds)};
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (int pass = 0; pass < 12; ++pass) {
      const int part = pass < 4 ? 0 : pass < (t == 0 ? 8 : 6) ? 1 : 2;
      add(parts[part], number, tiles[t], pass, t == 0 ? pass : (pass + shift) % 12);
    }
  Film film = std::move(parts[2]);
  film.merge(parts[0]);
  film.merge(parts[1]);
  return film;
}

// How many of the intervals of the image's mean hold the truth.
int coverage(int shift) {
  int covered = 0;
  for (std::uint32_t number = 0; number < films; ++number) {
    const ImageEstimate image = merged(number, shift).image();
    const Interval i = confidence_interval(image.mean[0], image.standard_error[0], image.passes, confidence);
    covered += i.low <= truth && truth <= i.high;
  }
  return covered;
}

// Four standard errors of the number.
const double tolerance = 4 * std::sqrt(films * confidence * (1 - confidence));

TEST(MergedFilms, intervals_of_the_mean_hold_the_truth_as_often_as_they_say) {
  EXPECT_NEAR(coverage(0), films * confidence, tolerance);
}

// Passes that meet by their position in the films instead of by their number: what they have in common does not show.
TEST(MergedFilms, passes_that_meet_wrongly_are_detected) { EXPECT_LT(coverage(4), films * confidence - 2 * tolerance); }

TEST(MergedFilms, intervals_of_pixels_hold_the_truth_as_often_as_they_say) {
  for (const double factor : {1.0, std::sqrt(0.5)}) {  // the second as if parts were counted twice
    int covered = 0;
    for (std::uint32_t number = 0; number < films; ++number) {
      const PixelEstimate p = merged(number, 0).pixel(3, 1);
      EXPECT_EQ(p.passes, 12u);
      const Interval i = confidence_interval(p.mean[0], factor * std::sqrt(p.variance_of_mean(0)), 12, confidence);
      covered += i.low <= truth && truth <= i.high;
    }
    if (factor == 1)
      EXPECT_NEAR(covered, films * confidence, tolerance);
    else
      EXPECT_LT(covered, films * confidence - 2 * tolerance);
  }
}

}  // namespace

}  // namespace montelux
