// Films as bytes: read again they are what was written, and what was not is refused.
#include "film/film_bytes.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "film/film.h"
#include "mc/random.h"

namespace montelux {

namespace {

constexpr PixelBounds bounds{3, 2, 10, 8};
constexpr int side = 4, samples_per_pass = 2;

LayerPlan plan(bool spread) {
  LayerPlan plan;
  plan.techniques = true, plan.spread = spread;
  return plan;
}

// The first tile has another number of passes, the last one none; pixels with and without hits. With layers it has
// halves as well.
Film film_of(const std::optional<LayerPlan>& layers) {
  Film film(bounds, layers, 1, layers.has_value());
  const std::vector<PixelBounds> tiles = tiles_of(bounds, side);
  RandomStream<float> random(5, 6);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    film.name_tile(tiles[t]);
    for (int pass = 0; pass < (t == 0 ? 5 : t + 1 < tiles.size() ? 3 : 0); ++pass) {
      const auto pixels = std::size_t(tiles[t].area());
      std::vector<PixelSample> samples(pixels * samples_per_pass);
      for (PixelSample& s : samples) {
        for (float& c : s.radiance.c) c = std::exp(30 * random.next() - 15);
        if (random.next() < 0.1f) s.radiance.c[1] = std::numeric_limits<float>::infinity();
        s.features.coverage = random.next() < 0.4f ? 1.0f : 0.0f;
        s.features.depth = 1e4f * random.next(), s.features.object = std::uint32_t(3e9f * random.next());
        s.features.position = {-random.next(), 1e-6f * random.next(), -1e6f};
        s.features.normal = {-1, 0, 0}, s.features.albedo = gray_rgb(random.next());
        s.features.emission = gray_rgb(t == 1 ? random.next() : 0), s.features.emission_rays = t == 1 ? 8 : 1;
      }
      std::vector<ExactRgb> sums;
      if (layers) {
        sums.resize(pixels * (std::size_t(layers->count()) + 1));
        for (ExactRgb& sum : sums)
          for (ExactSum& c : sum.c) c.add(random.next() - 0.25f);
      }
      film.add_pass(tiles[t], pass * 1000003, samples_per_pass, samples, sums);
    }
  }
  return film;
}

std::string bytes_of(const Film& film) {
  std::string bytes;
  for (const auto& [index, tile] : film.tiles()) film.write_tile(tile.cells, bytes);
  return bytes;
}

Film film_from(std::string_view bytes, const std::optional<LayerPlan>& layers) {
  Film film(bounds, layers, 1, layers.has_value());
  ByteReader in(bytes);
  for (const PixelBounds& tile : tiles_of(bounds, side)) film.read_tile(tile, in);
  if (!in.at_end()) throw std::invalid_argument("more follows");
  return film;
}

}  // namespace

TEST(FilmBytes, are_the_film) {
  for (const std::optional<LayerPlan>& layers : {std::optional<LayerPlan>(), {plan(false)}, {plan(true)}}) {
    const Film film = film_of(layers);
    const std::string bytes = bytes_of(film);
    const Film again = film_from(bytes, layers);
    EXPECT_EQ(bytes_of(again), bytes);
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        const PixelEstimate p = film.pixel(x, y), q = again.pixel(x, y);
        const PixelFeatures f = film.features(x, y), g = again.features(x, y);
        EXPECT_EQ(std::tie(p.passes, p.non_finite, p.half_passes, p.half_sum),
                  std::tie(q.passes, q.non_finite, q.half_passes, q.half_sum));
        EXPECT_EQ(std::tie(f.hits, f.samples, f.object, f.sums, f.emission, f.emission_rays),
                  std::tie(g.hits, g.samples, g.object, g.sums, g.emission, g.emission_rays));
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(std::tie(p.mean[c], p.m2[c]), std::tie(q.mean[c], q.m2[c]));
          if (!layers) continue;
          EXPECT_EQ(film.layers()->halves(x, y, 1), again.layers()->halves(x, y, 1));
          EXPECT_EQ(film.layers()->layer_mean(x, y, 2, c), again.layers()->layer_mean(x, y, 2, c));
          if (!layers->spread) continue;
          EXPECT_EQ(film.layers()->spread(x, y, 2).m2[c], again.layers()->spread(x, y, 2).m2[c]);
          EXPECT_EQ(film.layers()->spread(x, y, 2).co_moment[c], again.layers()->spread(x, y, 2).co_moment[c]);
        }
      }
  }
}

TEST(FilmBytes, of_a_part_are_refused) {
  const std::string bytes = bytes_of(film_of(plan(true)));
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(film_from(std::string_view(bytes).substr(0, size), plan(true)), std::invalid_argument) << size;
  EXPECT_THROW(film_from(bytes + '\0', plan(true)), std::invalid_argument);
}

// Whatever the bytes are, the film that is read can be worked with: sums are within what so many passes come to.
TEST(FilmBytes, that_are_damaged_make_a_film_or_are_refused) {
  const std::string good = bytes_of(film_of({}));
  RandomStream<float> random(9, 10);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = good;
    bytes[std::size_t(random.next() * float(bytes.size()))] ^= char(1 << int(8 * random.next()));
    try {
      Film film = film_from(bytes, {});
      film.image();
      film.error();
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(FilmBytes, take_few_bytes_of_numbers_of_few_bits) {
  const auto size = [](double x) {
    std::string bytes;
    ByteWriter(bytes).sum(ExactSum(x));
    return bytes.size();
  };
  EXPECT_EQ(size(0), 1u);
  EXPECT_EQ(size(1), 2u);
  EXPECT_LE(size(-1), 2u);
  EXPECT_LE(size(0.1f), 6u);
  EXPECT_LE(size(1e11), 17u);
  for (double x : {0.0, 1.0, -1.0, 0.1, -1e11, 128.0, -128.0, 0x1p-62, -0x1p-62, 0x1p39}) {
    std::string bytes;
    ByteWriter(bytes).sum(ExactSum(x));
    ByteReader in(bytes);
    EXPECT_EQ(in.sum(1), ExactSum(x)) << x;
    EXPECT_TRUE(in.at_end());
  }
}

}  // namespace montelux
