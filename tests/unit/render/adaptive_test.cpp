// More passes for the tiles where they lower the error most.
#include <gtest/gtest.h>

#include <cmath>

#include "mc/moments.h"
#include "render/adaptive_plan.h"
#include "render/pass_shares.h"
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

FirstPart first_part_of(const PixelIntegrator& light, int threads, int passes) {
  const int first = first_passes(passes).value();
  RenderObserver silent;
  return render_first_part(light, settings_for(threads, first), TargetMeasure::mean, double(first) / passes, silent);
}

// An image whose first passes divide the others, rendered up to the level `end`.
RenderResult render_adaptive(const PixelIntegrator& light, int threads, int passes, int end) {
  FirstPart first = first_part_of(light, threads, passes);
  RenderSettings s = settings_for(threads, end);
  s.work = std::make_shared<AdaptivePlan>(first.shares, first_passes(passes).value(), std::nullopt);
  s.begun = &first.begun;
  RenderObserver silent;
  return render(light, s, silent);
}
Film render_adaptive(std::uint32_t seed, int threads, int passes) {
  return render_adaptive(RareLight(seed), threads, passes, passes).film;
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

std::vector<TileFigures> even_tiles(std::size_t count, double error) { return {count, TileFigures{error, 1, 1}}; }

TEST(PassShares, are_those_of_the_root_of_error_over_cost) {
  // Two halves, so large that most tiles see only their like.
  ImageFigures image{even_tiles(4000, 1), 20};
  for (std::size_t t = 2000; t < 4000; ++t) image.tiles[t].error = 16;
  const std::vector<double> shares = pass_shares(image, 0);
  // The root of error of a tile with that added, a fifth of the squared mean of the roots of 1 and 4.
  EXPECT_NEAR(shares.back() / shares.front(), (4 + 0.45) / (1 + 0.45), 1e-3);
  double mean = 0;
  for (double share : shares) mean += share / 4000;
  EXPECT_NEAR(mean, 1, 1e-9);
  EXPECT_NEAR(expected_gain(image, shares), 8.5 / (0.5 / shares.front() + 8 / shares.back()), 0.02);
  for (double share : pass_shares(image, 0.9)) EXPECT_GE(share, 0.9);
}

TEST(PassShares, of_an_even_image_or_of_one_without_noise_are_equal) {
  for (double error : {0.0, 3.0})
    for (double share : pass_shares({std::vector<TileFigures>(12, {error, 2, 64}), 4}, 0.25))
      EXPECT_NEAR(share, 1, 1e-12);
}

TEST(PassShares, are_smaller_where_passes_cost_more) {
  ImageFigures image{even_tiles(400, 1), 20};
  for (std::size_t t = 0; t < 200; ++t) image.tiles[t].cost = 10;
  const std::vector<double> shares = pass_shares(image, 0);
  EXPECT_LT(shares.front(), 0.7 * shares.back());
}

// Except for means over all 1200 tiles: a thousand times the error changes a share by less than 5 %.
TEST(PassShares, of_a_tile_hardly_depend_on_its_own_error) {
  // Noise that varies over the image, so that there is a gain.
  ImageFigures image{even_tiles(1200, 1), 40};
  for (std::size_t t = 0; t < 1200; ++t) image.tiles[t].error = 1 + 9 * double(t) / 1200;
  const std::size_t own = 614;
  const std::vector<double> before = pass_shares(image, 0.25);
  image.tiles[own].error *= 1000;
  const std::vector<double> after = pass_shares(image, 0.25);
  EXPECT_NEAR(after[own] / before[own], 1, 0.05);
  EXPECT_GT(std::abs(before[own] - 1), 0.01);
}

TEST(PassShares, are_equal_where_few_tiles_that_none_around_foresees_have_all_the_error) {
  // A caustic of one tile that the samples have found, and hardly any other noise.
  ImageFigures image{even_tiles(1200, 1e-6), 40};
  for (std::size_t t = 0; t < 1200; t += 3) image.tiles[t].error *= 2;
  image.tiles[614].error = 1;
  EXPECT_GE(expected_gain(image, pass_shares(image, 0.25)), 0.97);
}

TEST(AdaptivePlan, gives_the_same_bits_for_any_number_of_threads_and_after_a_stop) {
  const Film one = render_adaptive(1, 1, 40);
  EXPECT_NEAR(mean_passes(one), 40, 1);
  expect_same(one, render_adaptive(1, 3, 40));
  const RareLight light(1);
  const std::vector<double> shares = first_part_of(light, 1, 40).shares;
  for (int before : {1, 4, 17}) {
    RenderResult part = render_adaptive(light, 2, 40, before);
    BegunFilm begun{std::move(part.film), part.rays, part.seconds, {}};
    RenderSettings s = settings_for(2, 40);
    s.work = std::make_shared<AdaptivePlan>(shares, 10, std::nullopt), s.begun = &begun;
    RenderObserver silent;
    expect_same(one, render(light, s, silent).film);
  }
  // The tiles of rare light have more passes.
  const auto last = std::prev(one.tiles().end());
  EXPECT_GT(last->second.passes.size(), 1.5 * double(one.tiles().begin()->second.passes.size()));
}

TEST(AdaptivePlan, ends_at_an_error) {
  const RareLight light(5);
  const TargetJudge judge(ErrorTarget{TargetMeasure::mean, 0.02});
  FirstPart first = first_part_of(light, 2, 16);
  RenderSettings s = settings_for(2, 4000);
  s.work = std::make_shared<AdaptivePlan>(first.shares, 4, judge), s.target = judge, s.begun = &first.begun;
  RenderObserver silent;
  const RenderResult result = render(light, s, silent);
  EXPECT_LT(mean_passes(result.film), 1000);
  EXPECT_TRUE(judge.judge(result.film, false).reaches(judge.target()));
}

// An allocation that sees the samples that it weighs: after four passes of each tile, as many more as their error
// requires.
class SeesItsOwnSamples final : public WorkPlan {
 public:
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>&) const override {
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

// How many standard errors the mean over so many images is from the expectation, 1.
template <class Render>
double deviation(std::uint32_t images, Render render_one) {
  Moments moments;
  for (std::uint32_t seed = 0; seed < images; ++seed) moments.add(render_one(seed).image().mean[0]);
  return (moments.mean - 1) / std::sqrt(moments.variance() / double(moments.count));
}

TEST(AdaptivePlan, is_unbiased) {
  EXPECT_LT(std::abs(deviation(1000, [](std::uint32_t seed) { return render_adaptive(seed, 1, 16); })), 3.5);
}

TEST(AdaptivePlan, would_be_biased_if_it_saw_its_own_samples) {
  EXPECT_LT(deviation(1000,
                      [](std::uint32_t seed) {
                        RenderSettings s = settings_for(1, 200);
                        s.work = std::make_shared<SeesItsOwnSamples>();
                        RenderObserver silent;
                        return render(RareLight(seed), s, silent).film;
                      }),
            -3.5);
}

// The same light by the points of a sampler, whose pixels need not be independent.
class RareLightOfPoints final : public PixelIntegrator {
 public:
  explicit RareLightOfPoints(std::uint32_t seed) : seed_(seed) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    PointSet points = pass.points;
    points.kind = PointSetKind::blue_noise, points.seed = seed_;
    std::size_t i = 0;
    for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
      for (int x = pass.tile.x0; x < pass.tile.x1; ++x)
        for (std::uint32_t k = 0; k < points.samples_per_pass; ++k) {
          const Vec2<float> u = Sampler<float>(points, unsigned(x), unsigned(y), k).get2(0u);
          const bool is_bright = u.x < 0.25f && u.y < 0.2f;
          out[i++].radiance = gray_rgb(x < 24 ? 0.9f + 0.2f * u.x : (is_bright ? 20.0f : 0.0f));
        }
    return {out.size(), 0, 0};
  }

 private:
  std::uint32_t seed_;
};

// Points that are blue over the image are not independent from pixel to pixel: the bias is below a tenth of the
// standard error of one image.
TEST(AdaptivePlan, has_a_small_bias_at_most_by_points_that_pixels_share) {
  constexpr std::uint32_t images = 1000;
  const double of_one =
      deviation(images, [](std::uint32_t seed) { return render_adaptive(RareLightOfPoints(seed), 1, 16, 16).film; }) /
      std::sqrt(double(images));
  EXPECT_LT(std::abs(of_one), 0.1);
}

}  // namespace
}  // namespace montelux
