// Both halves of the passes of a film.
#include "film/half_sums.h"

#include <gtest/gtest.h>

#include "film/film.h"
#include "film/film_bytes.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{1, 2, 5, 5};

std::vector<PixelSample> samples_of(int pass) {
  RandomStream<float> random(9, std::uint32_t(pass));
  std::vector<PixelSample> samples(std::size_t(bounds.area()));
  for (PixelSample& s : samples) {
    for (float& c : s.radiance.c) c = 10 * random.next();
    s.features.coverage = random.next() < 0.7f ? 1.0f : 0.0f;
    for (float& c : s.features.albedo.c) c = random.next();
    if (s.features.coverage > 0 && random.next() < 0.5f) s.features.emission = {{1, 2, random.next()}};
    s.features.normal = {random.next(), -random.next(), 0.5f};
  }
  return samples;
}

Film film_of(const std::vector<int>& passes) {
  Film film(bounds, {}, 1, true);
  for (int pass : passes) film.add_pass(bounds, pass, 1, samples_of(pass));
  return film;
}

void expect_same(const Film& a, const Film& b) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      const auto of_a = a.halves(x, y), of_b = b.halves(x, y);
      for (std::size_t h = 0; h < 2; ++h) {
        EXPECT_EQ(of_a[h].share, of_b[h].share);
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(of_a[h].mean[c], of_b[h].mean[c]);
          EXPECT_EQ(of_a[h].emission[c], of_b[h].emission[c]);
          EXPECT_EQ(of_a[h].albedo[c], of_b[h].albedo[c]);
          EXPECT_EQ(of_a[h].normal[c], of_b[h].normal[c]);
        }
      }
    }
}

}  // namespace

TEST(HalfSums, are_the_means_over_passes_with_even_and_odd_numbers) {
  const std::vector<int> passes{0, 1, 2, 3, 6};
  const Film film = film_of(passes);
  std::size_t i = 0;
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x, ++i) {
      double mean[2] = {}, emission[2] = {}, albedo[2] = {}, hits[2] = {}, all = 0, hits_of_all = 0;
      for (int pass : passes) {
        const PixelSample s = samples_of(pass)[i];
        mean[pass % 2] += double(s.radiance.c[1]) / (pass % 2 == 0 ? 3 : 2);
        emission[pass % 2] += double(s.features.emission.c[2]) / (pass % 2 == 0 ? 3 : 2);
        if (s.features.coverage == 0) continue;
        albedo[pass % 2] += double(s.features.albedo.c[2]), hits[pass % 2] += 1;
        all += double(s.features.albedo.c[2]), hits_of_all += 1;
      }
      const std::array<PixelHalf, 2> halves = film.halves(x, y);
      EXPECT_NEAR(halves[0].share, 0.6, 1e-12);
      EXPECT_NEAR(halves[1].share, 0.4, 1e-12);
      for (std::size_t h = 0; h < 2; ++h) {
        EXPECT_NEAR(halves[h].mean[1], mean[h], 1e-9);
        EXPECT_NEAR(halves[h].emission[2], emission[h], 1e-9);
        const double expected = hits[h] > 0 ? albedo[h] / hits[h] : hits_of_all > 0 ? all / hits_of_all : 0;
        EXPECT_NEAR(halves[h].albedo[2], expected, 1e-6);
      }
      EXPECT_NEAR(halves[0].share * halves[0].mean[0] + halves[1].share * halves[1].mean[0], film.pixel(x, y).mean[0],
                  1e-9);
    }
}

TEST(HalfSums, are_the_whole_where_one_half_has_no_pass) {
  const Film film = film_of({1, 3});
  const std::array<PixelHalf, 2> halves = film.halves(2, 3);
  const std::size_t place = std::size_t((3 - bounds.y0) * bounds.width() + 2 - bounds.x0);
  double emission = 0;
  for (int pass : {1, 3}) emission += double(samples_of(pass)[place].features.emission.c[2]) / 2;
  for (const PixelHalf& half : halves) {
    EXPECT_EQ(half.share, 1);
    EXPECT_EQ(half.mean[0], film.pixel(2, 3).mean[0]);
    EXPECT_NEAR(half.emission[2], emission, 1e-9);
  }
}

TEST(HalfSums, have_the_same_bits_merged_in_any_order_and_read_again) {
  const Film whole = film_of({0, 1, 2, 3, 4, 5});
  Film merged = film_of({5, 2, 0});
  merged.merge(film_of({4, 1, 3}));
  expect_same(whole, merged);

  std::string bytes;
  whole.write_tile(bounds, bytes);
  Film read(bounds, {}, 1, true);
  ByteReader in(bytes);
  read.read_tile(bounds, in);
  EXPECT_TRUE(in.at_end());
  expect_same(whole, read);
  EXPECT_THROW(merged.merge(Film(bounds)), std::invalid_argument);
}

}  // namespace montelux
