// More passes for the tiles where they lower the error most.
#include <gtest/gtest.h>

#include <cmath>

#include "mc/moments.h"
#include "render/adaptive_plan.h"
#include "tile_numbers.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{0, 0, 40, 24};
constexpr int side = 8;

// Samples of expectation 1 that are rarely bright on the right, and little noisy on the left.
class RareLight final : public PixelIntegrator {
 public:
  explicit RareLight(std::uint32_t seed) : seed_(seed) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    RandomStream<float> random = test::tile_numbers(pass, seed_);
    for (PixelSample& s : out) {
      const float u = random.next();
      s.radiance = gray_rgb(pass.tile.x0 < 24 ? 0.9f + 0.2f * u : (u < 0.05f ? 20.0f : 0.0f));
    }
    return {out.size(), 0, 0};
  }

 private:
  std::uint32_t seed_;
};

RenderSettings settings_for(int threads, int passes) {
  RenderSettings s;
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.image.sampler = PointSetKind::independent;
  s.plan = {1, passes}, s.plan.max_unit_samples = side * side;
  s.threads = threads;
  return s;
}

std::vector<double> shares_by_pilot(const RareLight& light) {
  RenderObserver silent;
  const PilotTiles tiles = tiles_of_pilot(pilot_of(light, settings_for(1, 1), 2, 2, silent), TargetMeasure::mean, side);
  return pass_shares(tiles.tiles, tiles.columns);
}

RenderResult render_adaptive(std::uint32_t seed, int threads, int passes, BegunFilm* begun = nullptr) {
  const RareLight light(seed);
  RenderSettings s = settings_for(threads, passes);
  s.work = std::make_shared<AdaptivePlan>(shares_by_pilot(light), std::nullopt), s.begun = begun;
  RenderObserver silent;
  return render(light, s, silent);
}

void expect_same(const Film& a, const Film& b) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      ASSERT_EQ(a.pixel(x, y).passes, b.pixel(x, y).passes) << x << " " << y;
      ASSERT_EQ(a.mean(x, y), b.mean(x, y)) << x << " " << y;
    }
}

double mean_passes(const Film& film) {
  double sum = 0;
  for (const auto& [index, tile] : film.tiles()) sum += double(tile.passes.size());
  return sum / double(film.tiles().size());
}

TEST(PassShares, are_those_of_the_root_of_error_over_cost) {
  // Two halves, so large that most tiles see only their like.
  std::vector<PilotTile> tiles;
  for (int i = 0; i < 4000; ++i) tiles.push_back({i < 2000 ? 1.0 : 16.0, 1, 1});
  const std::vector<double> shares = pass_shares(tiles, 20);
  // The error of a tile with that added by shrinkage, 0.3 of the mean of 8.5.
  EXPECT_NEAR(shares.back() / shares.front(), std::sqrt((16 + 2.55) / (1 + 2.55)), 1e-3);
  double mean = 0;
  for (double share : shares) mean += share / 4000;
  EXPECT_NEAR(mean, 1, 1e-9);
  EXPECT_GT(expected_gain(tiles, shares), 1.2);
}

TEST(PassShares, of_an_even_image_or_of_one_without_noise_are_equal) {
  for (double error : {0.0, 3.0})
    for (double share : pass_shares(std::vector<PilotTile>(12, PilotTile{error, 2, 64}), 4))
      EXPECT_NEAR(share, 1, 1e-12);
}

TEST(PassShares, are_smaller_where_passes_cost_more) {
  std::vector<PilotTile> tiles(12, PilotTile{1, 1, 1});
  tiles[5].cost = 10;
  const std::vector<double> shares = pass_shares(tiles, 4);
  EXPECT_LT(shares[5], 0.7 * shares[0]);
}

TEST(AdaptivePlan, gives_the_same_bits_for_any_number_of_threads_and_after_a_stop) {
  const Film one = render_adaptive(1, 1, 40).film;
  EXPECT_NEAR(mean_passes(one), 40, 1);
  expect_same(one, render_adaptive(1, 3, 40).film);
  for (int before : {1, 4, 17}) {
    RenderResult part = render_adaptive(1, 2, before);
    BegunFilm begun{std::move(part.film), part.rays, part.seconds, {}};
    expect_same(one, render_adaptive(1, 2, 40, &begun).film);
  }
  // The tiles of rare light have more passes.
  const auto last = std::prev(one.tiles().end());
  EXPECT_GT(last->second.passes.size(), 1.5 * double(one.tiles().begin()->second.passes.size()));
}

TEST(AdaptivePlan, ends_at_an_error) {
  const RareLight light(5);
  const ErrorTarget target{TargetMeasure::mean, 0.02};
  RenderSettings s = settings_for(2, 4000);
  s.work = std::make_shared<AdaptivePlan>(shares_by_pilot(light), target), s.target = target;
  RenderObserver silent;
  const RenderResult result = render(light, s, silent);
  EXPECT_LT(mean_passes(result.film), 1000);
  EXPECT_TRUE(judge(target, result.film, false).reaches(target));
}

// An allocation that sees the samples that it weighs: after four passes of each tile, as many more as their error
// requires.
class SeesItsOwnSamples final : public WorkPlan {
 public:
  WorkRound next_round(const Film& film, const PassPlan& passes) const override {
    std::vector<WorkUnit> units;
    std::size_t number = 0;
    const bool is_pilot = film.passes(film.tiles().begin()->second.cells) < 4;
    for (const auto& [index, tile] : film.tiles()) {
      int end = 4;
      if (!is_pilot) {
        double variance = 0;
        for (int y = tile.cells.y0; y < tile.cells.y1; ++y)
          for (int x = tile.cells.x0; x < tile.cells.x1; ++x) variance += film.pixel(x, y).variance_of_mean(0);
        end = std::min(4 + int(variance / 24), passes.passes);
      }
      if (is_pilot || tile.passes.size() == 4)
        for (int pass = int(tile.passes.size()); pass < end; ++pass) units.push_back({number, pass});
      ++number;
    }
    const std::size_t count = units.size();
    return {count, [all = std::move(units)](std::size_t i) { return all[i]; }};
  }
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override {
    return film.tiles().size() * std::size_t(passes.passes);
  }
};

// How many standard errors the mean over many images is from the expectation, 1.
template <class Render>
double deviation(Render render_one) {
  Moments moments;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) moments.add(render_one(seed).image().mean[0]);
  return (moments.mean - 1) / std::sqrt(moments.variance() / double(moments.count));
}

TEST(AdaptivePlan, is_unbiased) {
  EXPECT_LT(std::abs(deviation([](std::uint32_t seed) { return render_adaptive(seed, 1, 16).film; })), 3.5);
}

TEST(AdaptivePlan, would_be_biased_if_it_saw_its_own_samples) {
  EXPECT_LT(deviation([](std::uint32_t seed) {
              RenderSettings s = settings_for(1, 200);
              s.work = std::make_shared<SeesItsOwnSamples>();
              RenderObserver silent;
              return render(RareLight(seed), s, silent).film;
            }),
            -3.5);
}

}  // namespace
}  // namespace montelux
