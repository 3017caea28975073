// Renders that end when the error that is left after the removal of noise is the requested one.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "api/denoise.h"
#include "render/target_plan.h"
#include "tile_numbers.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{0, 0, 64, 48};
constexpr ErrorTarget target{TargetMeasure::denoised, 0.05}, of_noise{TargetMeasure::relative, 0.05};

// Coloured, with an edge that the features show and a shadow that only the colours show.
double truth(int x, int y, std::size_t c) {
  const double object = y < 22 ? 1 : 0.4 + 0.2 * double(c), shadow = x < 21 ? 0.2 : 1;
  return (0.3 + 0.005 * x) * object * shadow;
}

// Exponentially distributed samples.
class NoiseOfObjects final : public PixelIntegrator {
 public:
  explicit NoiseOfObjects(std::uint32_t seed) : seed_(seed) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    RandomStream<float> random = test::tile_numbers(pass, seed_);
    std::size_t i = 0;
    for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
      for (int x = pass.tile.x0; x < pass.tile.x1; ++x)
        for (std::uint32_t k = 0; k < pass.points.samples_per_pass; ++k) {
          PixelSample& s = out[i++];
          const double value = -std::log1p(-double(random.next()));
          for (std::size_t c = 0; c < rgb_size; ++c) s.radiance.c[c] = float(truth(x, y, c) * value);
          s.features.coverage = 1, s.features.object = y < 22 ? 1 : 2;
          s.features.albedo = gray_rgb(y < 22 ? 0.8f : 0.3f), s.features.normal = {0, 0, 1};
        }
    return {out.size(), 0, 0};
  }

 private:
  std::uint32_t seed_;
};

RenderResult render_to(const TargetJudge& judge, std::uint32_t seed, RenderSettings s = {}, int passes = 2000) {
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.image.sampler = PointSetKind::independent, s.image.halves = true;
  s.plan = {1, passes};
  s.work = std::make_shared<TargetPlan>(judge), s.target = judge;
  RenderObserver silent;
  return render(NoiseOfObjects(seed), s, silent);
}

// What the removal of noise leaves, against the truth.
double true_error(const Film& film) {
  const Result<DenoisedLayers> denoised = denoise(film, {1});
  if (!denoised) return 1e9;
  const PixelBuffer& image = denoised->layers;
  double sum = 0;
  for (int i = 0; i < bounds.area(); ++i)
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const double expected = truth(i % bounds.width(), i / bounds.width(), c);
      const double off = double(image.values[std::size_t(i) * image.channels.size() + c]) - expected;
      sum += off * off / (expected * expected + relative_epsilon) / rgb_size;
    }
  return std::sqrt(sum / bounds.area());
}

// 30 renders: with a probability of 95 % at least 25 are within, in 99 of 100 tests.
constexpr int seeds = 30, min_within = 25;
int renders_within(const TargetJudge& judge) {
  int within = 0;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    const RenderResult result = render_to(judge, seed);
    EXPECT_LT(result.film.image().passes, 2000);
    within += true_error(result.film) <= target.error;
  }
  return within;
}

TEST(DenoisedTarget, keeps_its_promise) { EXPECT_GE(renders_within(judge_of(target, 1)), min_within); }

TEST(DenoisedTarget, would_break_its_promise_by_a_filter_that_states_a_third_of_the_error) {
  const TargetJudge third(
      target, [](const Film& film, const std::function<bool()>& stops) -> std::optional<FilteredError> {
        const Denoising stated = denoise(film, {1, stops}).value().estimate;
        return FilteredError{stated.relative_mse / 9, stated.unfiltered / 9, stated.relative_deviation / 9};
      });
  EXPECT_LT(renders_within(third), min_within);
}

TEST(DenoisedTarget, takes_a_fraction_of_the_samples_that_the_noise_would) {
  double with_filter = 0, without = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    with_filter += render_to(judge_of(target, 1), seed).film.image().passes;
    without += render_to(judge_of(of_noise, 1), seed).film.image().passes;
  }
  EXPECT_LT(with_filter, without / 3);
}

TEST(DenoisedTarget, gives_the_same_bits_for_any_number_of_threads_and_after_a_stop) {
  const RenderResult whole = render_to(judge_of(target, 1), 5);
  const int passes = whole.film.image().passes;
  for (int threads : {1, 2}) {
    RenderSettings s;
    s.threads = threads;
    RenderResult part = render_to(judge_of(target, threads), 5, s, passes - 3);
    BegunFilm begun{std::move(part.film), part.rays, part.seconds, {}, {}};
    s.begun = &begun;
    const RenderResult result = render_to(judge_of(target, threads), 5, s);
    ASSERT_EQ(result.film.image().passes, passes);
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) ASSERT_EQ(whole.film.mean(x, y), result.film.mean(x, y));
  }
}

TEST(DenoisedTarget, is_unknown_without_halves_or_if_the_filter_is_stopped) {
  const Film film = render_to(judge_of(target, 1), 3).film;
  EXPECT_TRUE(judge_of(target, 1).judge(film, true).is_known);
  EXPECT_FALSE(TargetJudge(target).judge(film, true).is_known);
  EXPECT_FALSE(judge_of(target, 1).judge(film, true, [] { return true; }).is_known);
  Film without_halves(bounds);
  const std::vector<PixelSample> gray(std::size_t(bounds.area()), PixelSample{gray_rgb(0.5f), {}});
  for (int pass = 0; pass < 4; ++pass) without_halves.add_pass(bounds, pass, 1, gray);
  EXPECT_FALSE(judge_of(target, 1).judge(without_halves, true).is_known);
}

TEST(DenoisedTarget, filters_a_film_once) {
  int calls = 0;
  const TargetJudge judge(target, [&calls](const Film&, const auto&) {
    ++calls;
    return FilteredError{0.01, 0.004, 0.001};
  });
  const Film a = render_to(judge_of(of_noise, 1), 3, {}, 8).film, b = render_to(judge_of(of_noise, 1), 4, {}, 8).film;
  const TargetJudge copy = judge.with_error(0.5);
  const double bound = judge.judge(a, true).bound;
  EXPECT_EQ(copy.judge(a, true).bound, bound);
  EXPECT_EQ(calls, 1);
  copy.judge(b, true);
  EXPECT_EQ(calls, 2);
}

TEST(DenoisedTarget, keeps_the_layers_that_were_judged_last) {
  const auto kept = std::make_shared<JudgedLayers>();
  const TargetJudge judge = judge_of(target, 1, kept);
  const Film a = render_to(judge_of(of_noise, 1), 3, {}, 8).film, b = render_to(judge_of(of_noise, 1), 4, {}, 8).film;
  judge.judge(a, true), judge.judge(b, true);
  EXPECT_FALSE(kept->take(a));
  const std::optional<DenoisedLayers> layers = kept->take(b);
  ASSERT_TRUE(layers);
  const Result<DenoisedLayers> filtered = denoise(b, {1});
  EXPECT_EQ(layers->layers.channels, filtered->layers.channels);
  EXPECT_EQ(layers->layers.values, filtered->layers.values);
  EXPECT_FALSE(kept->take(b));
}

TEST(DenoisedTarget, does_not_try_a_filter_that_would_have_to_remove_nearly_all) {
  int calls = 0;
  const auto count = [&calls](const Film&, const auto&) {
    ++calls;
    return FilteredError{0.01, 0.004, 0.001};
  };
  render_to(TargetJudge(ErrorTarget{TargetMeasure::denoised, 0.001}, count), 3, {}, 20);
  EXPECT_EQ(calls, 0);
  render_to(TargetJudge(ErrorTarget{TargetMeasure::denoised, 0.05}, count), 3, {}, 20);
  EXPECT_GT(calls, 2);
}

// While a film is in work, by what was left of the last film. The tolerances are those of rounding.
TEST(DenoisedTarget, foresees_what_will_be_left) {
  const TargetJudge judge(target, [](const Film&, const auto&) { return FilteredError{0.01, 0.004, 0.001}; });
  const Film film = render_to(judge_of(of_noise, 1), 3, {}, 8).film;
  FilmPlanes planes(bounds);
  planes.copy(film, bounds);
  const ErrorEstimate error = estimate_error(planes);
  ErrorEstimate less = error;
  less.relative_mse /= 16;
  EXPECT_FALSE(judge.judge(planes, error, film.image()).is_known);
  judge.judge(film, true);
  EXPECT_NEAR(judge.judge(planes, error, film.image()).error, 0.1, 1e-9);
  EXPECT_NEAR(judge.judge(planes, less, film.image()).error, 0.1 / std::pow(16, filtered_power / 2), 1e-9);
}

}  // namespace
}  // namespace montelux
