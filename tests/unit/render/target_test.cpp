// Renders that end at a requested error.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include "render/target_plan.h"
#include "tile_numbers.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{0, 0, 32, 24};

// The expectation of a pixel.
double truth(int x, int y) { return 0.2 + 0.02 * x + 0.01 * y; }

// Samples around it: exponentially distributed, so that the mean of few of them is skewed.
enum class Channels { equal, independent };
class Noise final : public PixelIntegrator {
 public:
  explicit Noise(std::uint32_t seed, Channels channels = Channels::equal) : seed_(seed), channels_(channels) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    RandomStream<float> random = test::tile_numbers(pass, seed_);
    std::size_t i = 0;
    for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
      for (int x = pass.tile.x0; x < pass.tile.x1; ++x)
        for (std::uint32_t s = 0; s < pass.points.samples_per_pass; ++s) {
          const auto sample = [&] { return float(truth(x, y)) * -std::log1p(-random.next()); };
          Rgb& radiance = out[i++].radiance;
          radiance = gray_rgb(sample());
          if (channels_ == Channels::independent) radiance.c[1] = sample(), radiance.c[2] = sample();
        }
    return {out.size(), 0, 0};
  }

 private:
  std::uint32_t seed_;
  Channels channels_;
};

// The same as a coupled integrator.
class SeriesNoise final : public CoupledIntegrator {
 public:
  explicit SeriesNoise(std::uint32_t seed) : noise_(seed) {}
  int frames() const override { return 2; }
  int warm_up() const override { return 0; }
  int stages() const override { return 1; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<Frames>(noise_, pass.points);
  }

 private:
  class Frames final : public FrameSeries {
   public:
    Frames(const Noise& noise, const PointSet& points) : noise_(noise), points_(points) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      PointSet points = points_;
      points.samples_per_pass = 1, points.pass = 1000 * points.pass + std::uint32_t(step.frame);
      return noise_.trace({tile, points, {}, {}, {}, {}}, out);
    }

   private:
    const Noise& noise_;
    PointSet points_;
  };
  Noise noise_;
};

double true_error(const Film& film, const ErrorTarget& target) {
  double sum = 0, difference = 0, all = 0, beyond = 0;
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      const double expected = truth(x, y), off = film.mean(x, y)[0] - expected;
      const double square = off * off / (expected * expected + 0.01);
      sum += square, difference += off, all += expected, beyond += square > target.error * target.error;
    }
  switch (target.measure) {
    case TargetMeasure::mean:
      return std::abs(difference / all);
    case TargetMeasure::pixels:
      return beyond <= (1 - target.share) * bounds.area() ? 0 : 1;
    default:
      return std::sqrt(sum / bounds.area());
  }
}

RenderSettings settings_for(int threads) {
  RenderSettings s;
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.image.sampler = PointSetKind::independent;
  s.threads = threads;
  return s;
}

RenderResult render_to(const AnyIntegrator& integrator, const ErrorTarget& target, RenderSettings s,
                       int passes = 4000) {
  s.plan = {1, passes};
  s.work = std::make_shared<TargetPlan>(TargetJudge(target)), s.target = TargetJudge(target);
  RenderObserver silent;
  return render(integrator, s, silent);
}

constexpr ErrorTarget relative{TargetMeasure::relative, 0.25}, pixels{TargetMeasure::pixels, 0.4, 0.9},
    mean{TargetMeasure::mean, 0.0175};

void expect_same(const Film& a, const Film& b) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      ASSERT_EQ(a.pixel(x, y).passes, b.pixel(x, y).passes) << x << " " << y;
      ASSERT_EQ(a.mean(x, y), b.mean(x, y)) << x << " " << y;
    }
}

TEST(TargetPlan, gives_the_same_bits_for_any_number_of_threads_and_after_a_stop) {
  const Noise noise(1);
  for (const ErrorTarget& target : {relative, pixels, mean}) {
    const RenderResult one = render_to(noise, target, settings_for(1));
    EXPECT_FALSE(one.interrupted);
    EXPECT_GT(one.film.image().passes, 8);
    expect_same(one.film, render_to(noise, target, settings_for(3)).film);
    for (int before : {3, 4, 11}) {
      RenderResult part = render_to(noise, target, settings_for(2), before);
      BegunFilm begun{std::move(part.film), part.rays, part.seconds, {}};
      RenderSettings s = settings_for(2);
      s.begun = &begun;
      const RenderResult whole = render_to(noise, target, s);
      // A stop between two looks is one more look than without it only if it shows the target.
      expect_same(one.film, whole.film);
    }
  }
}

TEST(TargetPlan, ends_series) {
  const SeriesNoise noise(1);
  RenderSettings s = settings_for(2);
  s.plan = {2, 4000};
  s.work = std::make_shared<TargetPlan>(TargetJudge(relative)), s.target = TargetJudge(relative);
  RenderObserver silent;
  const RenderResult result = render(noise, s, silent);
  EXPECT_FALSE(result.interrupted);
  EXPECT_TRUE(TargetJudge(relative).judge(result.film, false).reaches(relative));
  EXPECT_NEAR(2 * result.film.image().passes, render_to(Noise(1), relative, settings_for(1)).film.image().passes, 6);
}

TEST(TargetPlan, does_not_end_without_light) {
  class Dark final : public PixelIntegrator {
   public:
    RayCounts trace(const TilePass&, std::span<PixelSample> out) const override {
      for (PixelSample& s : out) s.radiance = gray_rgb(0.0f);
      return {};
    }
  };
  const RenderResult result = render_to(Dark(), relative, settings_for(2), 100);
  EXPECT_EQ(result.film.image().passes, 100);
  EXPECT_FALSE(TargetJudge(relative).judge(result.film, false).is_known);
}

// The end of the plan is the most that it may take: it is no time left to the error.
TEST(TargetPlan, shows_no_time_left_as_long_as_it_is_not_known) {
  class SlowAndDark final : public PixelIntegrator {
   public:
    RayCounts trace(const TilePass&, std::span<PixelSample> out) const override {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      for (PixelSample& s : out) s.radiance = gray_rgb(0.0f);
      return {};
    }
  };
  class Watching final : public RenderObserver {
   public:
    void progress(const Progress& p) override {
      if (p.finished) return;
      ++looks;
      shown = std::max({shown, p.fraction, p.remaining});
    }
    int looks = 0;
    double shown = 0;
  };
  for (const bool with_target : {true, false}) {
    RenderSettings s = settings_for(2);
    s.plan = {1, 40};
    if (with_target) s.work = std::make_shared<TargetPlan>(TargetJudge(relative)), s.target = TargetJudge(relative);
    Watching observer;
    (void)render(SlowAndDark(), s, observer);
    EXPECT_GT(observer.looks, 0);
    EXPECT_EQ(observer.shown > 0, !with_target) << observer.shown;
  }
}

TEST(Looks, spend_all_of_the_probability_and_not_more) {
  for (TargetMeasure measure : {TargetMeasure::relative, TargetMeasure::denoised}) {
    const Looks looks(measure);
    double spent = 0;
    int look = 0, number = 0;
    while (number < 400) {
      const int next = looks.after(look);
      EXPECT_TRUE(looks.is_look(next));
      for (int between = look + 1; between < next; ++between) EXPECT_FALSE(looks.is_look(between));
      spent += looks.spent(next), look = next, ++number;
      if (look > (1 << 20)) break;
    }
    EXPECT_LT(spent, 1);
    EXPECT_GT(spent, 0.95);
  }
}

// Of many renders, the share whose true error is within the target.
template <class Render>
double share_within(const ErrorTarget& target, int seeds, Render render_one) {
  int within = 0;
  for (int seed = 0; seed < seeds; ++seed)
    within += true_error(render_one(std::uint32_t(seed)), target) <= target.error;
  return double(within) / seeds;
}

// Samples with little noise, some of which are brighter.
struct RareLight {
  float probability, brightness;
  float index;  // the brightness falls like a power law from there on, up to 1e4 times as much; 0: all are alike
  double mean() const {
    const double all = index > 0 ? (1 - std::pow(1e-4, 1 - 1.0 / double(index))) / (1 - 1 / double(index)) : 1;
    return double(probability * brightness) * all;
  }
};
class RareBrightNoise final : public PixelIntegrator {
 public:
  static constexpr float base = 0.2f;
  RareBrightNoise(std::uint32_t seed, const RareLight& light) : seed_(seed), light_(light) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    RandomStream<float> random = test::tile_numbers(pass, seed_);
    for (PixelSample& s : out) {
      const float noise = 0.8f + 0.4f * random.next();
      const bool hit = random.next() < light_.probability;
      const float u = 1e-4f + (1 - 1e-4f) * random.next();
      s.radiance = gray_rgb(base * noise +
                            (hit ? light_.brightness * (light_.index > 0 ? std::pow(u, -1 / light_.index) : 1) : 0.0f));
    }
    return {out.size(), 0, 0};
  }

 private:
  std::uint32_t seed_;
  RareLight light_;
};

// The estimated error that a share of the pixels is within over the true one: the mean of 20 images of 32 passes.
template <class MakeNoise, class Expectation>
double estimate_of_pixels(double share, MakeNoise noise_of, Expectation expectation) {
  constexpr int images = 20;
  const ErrorTarget target{TargetMeasure::pixels, 0.1, share};
  double ratio = 0;
  for (std::uint32_t seed = 0; seed < images; ++seed) {
    RenderSettings s = settings_for(1);
    s.plan = {1, 32};
    RenderObserver silent;
    const Film film = render(noise_of(seed), s, silent).film;
    std::vector<double> errors;
    for (int y = bounds.y0; y < bounds.y1; ++y)
      for (int x = bounds.x0; x < bounds.x1; ++x) {
        const double expected = expectation(x, y);
        double square = 0;
        for (double value : film.mean(x, y)) square += (value - expected) * (value - expected) / rgb_size;
        errors.push_back(std::sqrt(square / (expected * expected + 0.01)));
      }
    std::ranges::sort(errors);
    ratio += TargetJudge(target).judge(film, true).error / errors[std::size_t(share * double(errors.size()))] / images;
  }
  return ratio;
}

// If channels are independent, the error of a pixel scatters less, and half of the pixels are within 1.32 times the
// error that they would be within with equal channels.
TEST(TargetState, knows_the_errors_of_pixels) {
  for (Channels channels : {Channels::equal, Channels::independent})
    for (double share : {0.5, 0.9, 0.97}) {
      const double ratio = estimate_of_pixels(
          share, [=](std::uint32_t seed) { return Noise(seed, channels); }, truth);
      EXPECT_GT(ratio, 0.97) << int(channels) << " " << share;
      EXPECT_LT(ratio, 1.12) << int(channels) << " " << share;
    }
}

double estimate_beside(const RareLight& light, double share) {
  const double expected = double(RareBrightNoise::base) + light.mean();
  return estimate_of_pixels(
      share, [&](std::uint32_t seed) { return RareBrightNoise(seed, light); }, [=](int, int) { return expected; });
}

// Nearly all pixels lack the light of the bright samples, which a few show. By the variances of the pixels half as much
// would be stated.
TEST(TargetState, knows_the_light_that_pixels_have_missed) {
  const double ratio = estimate_beside({1e-4f, 100, 0}, 0.9);
  EXPECT_GT(ratio, 0.9);
  EXPECT_LT(ratio, 1.5);
}

// A few samples of extreme brightness are most of the light. The intervals of all pixels around them are so wide that
// 14 times the error would be stated.
TEST(TargetState, knows_that_most_pixels_are_not_those_of_extreme_samples) {
  const double ratio = estimate_beside({1e-2f, 0.5f, 0.6f}, 0.9);
  EXPECT_GT(ratio, 0.9);
  EXPECT_LT(ratio, 2);
}

// A rule that looks after every pass, and takes the estimate for the truth. That of the errors of pixels is 6 % too
// large for this noise: Student's t expects that pixels differ more.
class LooksTooOften final : public WorkPlan {
 public:
  explicit LooksTooOften(const ErrorTarget& target) : target_(target) {}
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>&) const override {
    const int done = film.image().passes;
    const TargetState state = TargetJudge(target_).judge(film, true);
    const double factor = target_.measure == TargetMeasure::mean     ? 1.96
                          : target_.measure == TargetMeasure::pixels ? 1 / 1.06
                                                                     : 1;
    if (done == passes.passes || (state.is_known && factor * state.error <= target_.error)) return {};
    return {film.tiles().size(), [done](std::size_t i) { return WorkUnit{i, done}; }};
  }
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override {
    return std::uint64_t(film.tiles().size()) * std::uint64_t(passes.passes);
  }

 private:
  ErrorTarget target_;
};

// 200 renders: with a probability of 95 % at least 183 are within, in 99 of 100 tests.
constexpr int seeds = 200;
constexpr double min_share = 183.0 / seeds;

TEST(TargetPlan, keeps_its_promise) {
  for (const ErrorTarget& target : {relative, pixels, mean}) {
    const double share = share_within(
        target, seeds, [&](std::uint32_t seed) { return render_to(Noise(seed), target, settings_for(1)).film; });
    EXPECT_GE(share, min_share) << "measure " << int(target.measure);
  }
}

TEST(TargetPlan, is_better_than_a_rule_that_looks_too_often) {
  for (const ErrorTarget& target : {relative, pixels, mean}) {
    const double share = share_within(target, seeds, [&](std::uint32_t seed) {
      RenderSettings s = settings_for(1);
      s.plan = {1, 4000}, s.work = std::make_shared<LooksTooOften>(target);
      RenderObserver silent;
      return render(Noise(seed), s, silent).film;
    });
    EXPECT_LT(share, min_share) << "measure " << int(target.measure);
  }
}

}  // namespace
}  // namespace montelux
