// The choice between integrators whose efficiencies are known.
#include "render/integrator_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mc/moments.h"
#include "mc/random.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{0, 0, 128, 96};

// Gray samples of expectation 1 by a function of a uniform number and the pixel, with so many rays for each.
struct Law {
  std::function<float(float, int, int)> value;
  std::uint64_t rays = 1;
};

class Noise final : public PixelIntegrator {
 public:
  // Passes are counted from `first`: below that they are those of an image. Squares of `side` pixels share numbers.
  explicit Noise(Law law, std::uint32_t seed = 0, std::uint32_t first = 0, int side = 1)
      : law_(std::move(law)), seed_(seed), first_(first), side_(side) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    std::uint32_t number = pass.points.pass;
    if (first_ > 0 && number >= first_) number = (number - first_) % 8;
    std::size_t i = 0;
    for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
      for (int x = pass.tile.x0; x < pass.tile.x1; ++x) {
        RandomStream<float> random(mix_bits(number + 1) ^ mix_bits(seed_ + 77),
                                   std::uint32_t(1000 * (y / side_) + x / side_));
        for (std::uint32_t s = 0; s < pass.points.samples_per_pass; ++s)
          out[i++].radiance = gray_rgb(law_.value(random.next(), x, y));
      }
    return {law_.rays * out.size(), 0, 0};
  }

 private:
  Law law_;
  std::uint32_t seed_, first_;
  int side_;
};

// The same by series of frames, whose pixels share a number in each frame and window.
class SharedNoise final : public CoupledIntegrator {
 public:
  explicit SharedNoise(Law law) : law_(std::move(law)) {}
  int frames() const override { return 16; }
  int warm_up() const override { return 0; }
  int stages() const override { return 2; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<Frames>(law_, pass);
  }

 private:
  class Frames final : public FrameSeries {
   public:
    Frames(const Law& law, const SeriesPass& pass) : law_(law), pass_(pass) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      if (step.stage == 0) return {law_.rays * out.size(), 0, 0};
      RandomStream<float> random(mix_bits(pass_.points.pass) + std::uint32_t(step.frame),
                                 std::uint32_t(1000 * pass_.bounds.y0 + pass_.bounds.x0));
      const float u = random.next();
      std::size_t i = 0;
      for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x) out[i++].radiance = gray_rgb(law_.value(u, x, y));
      return {};
    }

   private:
    const Law& law_;
    SeriesPass pass_;
  };
  Law law_;
};

// Uniformly distributed, with this standard deviation.
Law uniform(double deviation, std::uint64_t rays = 1) {
  const float half = float(std::sqrt(3) * deviation);
  return {[half](float u, int, int) { return 1 + half * (2 * u - 1); }, rays};
}

ChoiceSettings settings_for(double samples = 400, std::uint32_t seed = 1, int threads = 1) {
  ChoiceSettings s;
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.image.sampler = PointSetKind::independent, s.image.seed = seed;
  s.samples = samples, s.threads = threads;
  return s;
}

IntegratorChoice choose(const AnyIntegrator& first, const AnyIntegrator& other, const ChoiceSettings& settings,
                        double ray_cost = 1) {
  RenderObserver silent;
  return choose_by_pilots({{"first", [&] { return first; }}, {"other", [&] { return other; }, ray_cost, 4}}, settings,
                          silent);
}

TEST(IntegratorChoice, takes_the_candidate_that_is_more_efficient) {
  // A ninth of the squared error for three times the rays.
  const Noise first(uniform(0.9)), other(uniform(0.3, 3));
  const IntegratorChoice choice = choose(first, other, settings_for());
  EXPECT_EQ(choice.chosen, 1u);
  EXPECT_EQ(choice.reason, ChoiceReason::better);
  ASSERT_EQ(choice.ratios.size(), 1u);
  EXPECT_NEAR(choice.ratios[0].ratio, 3, 0.4);
  EXPECT_LT(choice.ratios[0].low, 3);
  EXPECT_GT(choice.ratios[0].high, 3);
  EXPECT_LT(choice.ratios[0].low, 3);
  EXPECT_GT(choice.ratios[0].high, 3);
}

TEST(IntegratorChoice, states_intervals_that_hold_the_ratio) {
  int within = 0;
  constexpr int runs = 100;
  for (std::uint32_t seed = 0; seed < runs; ++seed) {
    const Noise first(uniform(0.5), seed), other(uniform(0.5), seed + 1000);
    const CandidateRatio ratio = choose(first, other, settings_for(300, seed)).ratios.at(0);
    within += ratio.low <= 1 && ratio.high >= 1;
  }
  EXPECT_GE(within, 85);
}

// A quarter of the squared error for six times the rays: a rule that ignores cost would take it.
TEST(IntegratorChoice, keeps_the_first_candidate_where_the_other_one_costs_more_than_it_gains) {
  const Noise first(uniform(0.5)), other(uniform(0.25, 6));
  EXPECT_EQ(choose(first, other, settings_for()).chosen, 0u);
  EXPECT_EQ(choose(first, other, settings_for()).reason, ChoiceReason::none_better);
  EXPECT_EQ(choose(first, other, settings_for(), 1.0 / 6).chosen, 1u) << "without the cost";
}

TEST(IntegratorChoice, counts_the_cost_of_a_ray) {
  const Noise first(uniform(0.5)), other(uniform(0.25));
  EXPECT_EQ(choose(first, other, settings_for(), 1).chosen, 1u);
  EXPECT_EQ(choose(first, other, settings_for(), 5).chosen, 0u);
}

// A ninth of the squared error of pixels, but noise that 8 x 8 pixels share, which no filter averages: that of means
// over 4 x 4 pixels is 16/9 of the other one's. Planted: errors of pixels, as for an image that is not filtered.
TEST(IntegratorChoice, knows_what_the_removal_of_noise_leaves) {
  const Noise first(uniform(0.9), 1), shared(uniform(0.3), 2, 0, 8), own(uniform(0.3), 3);
  const auto holds = [](const IntegratorChoice& choice, double ratio) {
    return choice.ratios.at(0).low < ratio && ratio < choice.ratios.at(0).high;
  };
  ChoiceSettings settings = settings_for(2000);
  EXPECT_EQ(choose(first, shared, settings).chosen, 1u);
  EXPECT_TRUE(holds(choose(first, shared, settings), 9));
  settings.is_filtered = true;
  EXPECT_EQ(choose(first, shared, settings).chosen, 0u);
  EXPECT_TRUE(holds(choose(first, shared, settings), 9.0 / 16));
  EXPECT_LT(choose(first, shared, settings).ratios.at(0).high, 1);
  EXPECT_EQ(choose(first, own, settings).chosen, 1u);
  EXPECT_TRUE(holds(choose(first, own, settings), 9));
}

TEST(IntegratorChoice, rarely_leaves_the_first_candidate_for_an_equal_one) {
  int left = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const Noise first(uniform(0.5), seed), other(uniform(0.5), seed + 1000);
    left += choose(first, other, settings_for(300, seed)).chosen == 1;
  }
  EXPECT_LE(left, 6);
}

TEST(IntegratorChoice, keeps_the_first_candidate_where_there_is_no_noise) {
  const Noise first(uniform(0)), other(uniform(0));
  EXPECT_EQ(choose(first, other, settings_for()).chosen, 0u);
  const Noise dark({[](float, int, int) { return 0.0f; }});
  EXPECT_EQ(choose(dark, dark, settings_for()).chosen, 0u);
}

// Light that hardly any sample finds: most pilots show none of it, and their spread is small.
TEST(IntegratorChoice, sees_that_the_pilot_of_the_first_candidate_lacks_light) {
  constexpr float chance = 1e-7f;
  const Noise first({[](float u, int, int) { return u < chance ? 0.8f / chance : 0.2f + 0.01f * u; }}),
      other(uniform(0.5, 3));
  int chosen = 0, observed = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const IntegratorChoice choice = choose(first, other, settings_for(400, seed));
    chosen += choice.chosen == 1, observed += choice.reason == ChoiceReason::more_light;
  }
  EXPECT_GE(chosen, 9);
  EXPECT_GE(observed, 9);
}

// Series whose pictures are the same for any part of the image, so that a part takes as many rays as all of it: pilots
// of windows would never choose it.
class Splats final : public CoupledIntegrator {
 public:
  explicit Splats(Law law, std::uint32_t seed = 0) : law_(std::move(law)), seed_(seed) {}
  int frames() const override { return 16; }
  int warm_up() const override { return 0; }
  int stages() const override { return 1; }
  bool splats() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<Frames>(law_, seed_, pass);
  }

 private:
  class Frames final : public FrameSeries {
   public:
    Frames(const Law& law, std::uint32_t seed, const SeriesPass& pass) : noise_(law, seed), pass_(pass) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      PointSet points = pass_.points;
      points.pass += 1000 * std::uint32_t(step.frame), points.samples_per_pass = 1;
      const RayCounts rays = noise_.trace({tile, points, {}, {}, {}, pass_.grid}, out);
      const bool is_whole = pass_.grid && pass_.grid->bounds == bounds;
      return is_whole ? rays : RayCounts{1000 * rays.camera, 0, 0};
    }

   private:
    Noise noise_;
    SeriesPass pass_;
  };
  Law law_;
  std::uint32_t seed_;
};

IntegratorChoice choose_splats(const AnyIntegrator& first, const AnyIntegrator& other, const ChoiceSettings& settings) {
  RenderObserver silent;
  return choose_by_pilots({{"first", [&] { return first; }}, {"other", [&] { return other; }, 1, 4, 0, true}}, settings,
                          silent);
}

// A caustic on a twentieth of the image, which the first candidate hardly ever finds.
TEST(IntegratorChoice, finds_a_caustic_by_pilots_of_the_whole_image) {
  // Cells of the coarse image are counted, and the law is of cells.
  const auto in_caustic = [](int x, int y) { return x >= 10 && x < 20 && y >= 10 && y < 25; };
  constexpr float chance = 1e-7f;
  const Noise first({[&](float u, int x, int y) {
    return 0.2f + 0.01f * u + (in_caustic(x, y) && u < chance ? 0.8f / chance : 0.0f);
  }});
  const auto other = [&](std::uint32_t seed) {
    return Splats(
        {[&](float u, int x, int y) { return 0.205f + 0.05f * (u - 0.5f) + (in_caustic(x, y) ? 0.8f : 0.0f); }, 3},
        seed);
  };
  int chosen = 0, observed = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Splats splats = other(seed);
    const IntegratorChoice choice = choose_splats(first, splats, settings_for(600, seed));
    chosen += choice.chosen == 1, observed += choice.reason == ChoiceReason::more_light;
    EXPECT_LE(choice.share, max_pilot_share);
  }
  EXPECT_EQ(chosen, 10);
  EXPECT_EQ(observed, 10);
}

// Without that light the same integrator is 25 times as noisy for three times the rays.
TEST(IntegratorChoice, keeps_the_first_candidate_where_there_is_no_caustic) {
  const Noise first(uniform(0.1));
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Splats splats(uniform(0.5, 3), seed);
    const IntegratorChoice choice = choose_splats(first, splats, settings_for(600, seed));
    EXPECT_EQ(choice.chosen, 0u);
    // Squared errors of 12,288 cells: a standard error of 1.5 %, of which 5 are allowed.
    EXPECT_NEAR(75 * choice.ratios.at(0).ratio, 1, 5 * 0.015);
  }
}

// A candidate whose noise is small, except for rare samples without bound: no pilot tells its error.
TEST(IntegratorChoice, keeps_the_first_candidate_where_few_bright_samples_determine_the_error_of_the_other_one) {
  const Noise first(uniform(0.5));
  const auto with_tail = [](float index) {
    return Law{[index](float u, int, int) { return 0.99f + 0.002f * std::pow(1 - u, -1 / index); }};
  };
  int chosen = 0, unsure = 0, bounded = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    // Squared errors have half of the index.
    const Noise heavy(with_tail(1.4f), seed), light(with_tail(6), seed);
    const IntegratorChoice choice = choose(first, heavy, settings_for(1000, seed));
    chosen += choice.chosen == 1, unsure += choice.ratios.at(0).is_unsure;
    bounded += choose(first, light, settings_for(1000, seed)).chosen == 1;
  }
  EXPECT_LE(chosen, 1);
  EXPECT_GE(unsure, 19);
  EXPECT_EQ(bounded, 20);
}

TEST(IntegratorChoice, measures_the_error_that_is_requested) {
  // Little noise, except for one pixel in 16, which has very much: good for a share of 90 % of the pixels alone.
  const Noise first(uniform(0.5)), other({[](float u, int x, int y) {
    return 1 + (x % 4 == 0 && y % 4 == 0 ? 8.0f : 0.05f) * (u < 0.5f ? -1 : 1);
  }});
  ChoiceSettings settings = settings_for(4000);
  EXPECT_EQ(choose(first, other, settings).chosen, 0u);

  // Little noise in most windows and very much in some. A number of samples that reaches the error takes long pilots.
  const Noise patches(
      {[](float u, int x, int y) { return 1 + (x / 32 == 1 && y / 32 == 1 ? 8.0f : 0.05f) * (u < 0.5f ? -1 : 1); }});
  EXPECT_EQ(choose(first, patches, settings).chosen, 0u);
  settings.target = ErrorTarget{TargetMeasure::pixels, 0.005, 0.8};
  EXPECT_EQ(choose(first, patches, settings).chosen, 1u);

  // Pixels that share their errors have the same ones, but their mean has more.
  const SharedNoise shared(uniform(0.25));
  EXPECT_EQ(choose(first, shared, settings_for(4000)).chosen, 1u);
  settings.target = ErrorTarget{TargetMeasure::mean, 1e-5};
  EXPECT_EQ(choose(first, shared, settings).chosen, 0u);
  EXPECT_EQ(choose(shared, first, settings).chosen, 1u);
}

TEST(IntegratorChoice, takes_a_small_share_of_the_work_or_none) {
  const Noise first(uniform(0.5)), other(uniform(0.3, 6));
  for (double samples : {1.0, 16.0, 64.0, 100.0, 200.0, 1000.0, 20000.0}) {
    const IntegratorChoice choice = choose(first, other, settings_for(samples));
    EXPECT_LE(choice.share, max_pilot_share) << samples;
    EXPECT_EQ(choice.reason == ChoiceReason::too_short, choice.samples == 0) << samples;
    EXPECT_EQ(choice.reason == ChoiceReason::too_short, samples < 70) << samples;
  }
  // An error that few samples reach leaves no time for pilots either, whatever the most of them.
  ChoiceSettings to_error = settings_for(20000);
  to_error.target = ErrorTarget{TargetMeasure::relative, 0.1};
  EXPECT_EQ(choose(first, other, to_error).reason, ChoiceReason::too_short);
}

TEST(IntegratorChoice, is_the_same_for_any_number_of_threads) {
  const Noise first(uniform(0.5)), other(uniform(0.3));
  const SharedNoise shared(uniform(0.3));
  for (const AnyIntegrator& candidate : {AnyIntegrator(other), AnyIntegrator(shared)}) {
    const IntegratorChoice one = choose(first, candidate, settings_for(400, 3, 1));
    for (int threads : {2, 5}) {
      const IntegratorChoice many = choose(first, candidate, settings_for(400, 3, threads));
      EXPECT_EQ(one.chosen, many.chosen);
      EXPECT_EQ(one.share, many.share);
      EXPECT_EQ(one.ratios.at(0).ratio, many.ratios.at(0).ratio);
      EXPECT_EQ(one.ratios.at(0).low, many.ratios.at(0).low);
    }
  }
}

TEST(IntegratorChoice, has_no_pilots_without_a_second_candidate) {
  const Noise first(uniform(0.5));
  RenderObserver silent;
  const IntegratorChoice choice =
      choose_by_pilots({{"first", [&] { return AnyIntegrator(first); }}}, settings_for(), silent);
  EXPECT_EQ(choice.reason, ChoiceReason::single);
  EXPECT_EQ(choice.share, 0);
}

// How many standard errors the mean of the images is from the expectation. Both candidates have rare bright samples, so
// that a pilot that shows a small error is dark, and the cheaper rays of the other one make the choice uncertain.
// `reuses`: the pilots' passes are those of the image.
double deviation(bool reuses) {
  constexpr std::uint32_t first_pilot_pass = 1u << 30;
  const Law rare{[](float u, int, int) { return u < 0.001f ? 1000 * 0.9f + 0.1f : 0.1f; }};
  RenderObserver silent;
  Moments moments;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    const Noise first(rare, seed, reuses ? first_pilot_pass : 0),
        other(rare, seed + 100000, reuses ? first_pilot_pass : 0);
    const IntegratorChoice choice = choose(first, other, settings_for(300, seed), 0.55);
    const Noise& chosen = choice.chosen == 1 ? other : first;
    double sum = 0;
    std::vector<PixelSample> samples(std::size_t(bounds.area()));
    for (int pass = 0; pass < 8; ++pass) {
      chosen.trace({bounds, settings_for().image.points(pass, 1)}, samples);
      for (const PixelSample& sample : samples) sum += double(sample.radiance.c[0]);
    }
    moments.add(sum / 8 / bounds.area());
  }
  return (moments.mean - 1) / std::sqrt(moments.variance() / double(moments.count));
}

TEST(IntegratorChoice, leaves_the_image_unbiased) { EXPECT_LT(std::abs(deviation(false)), 3.5); }

TEST(IntegratorChoice, would_bias_an_image_of_its_own_samples) { EXPECT_GT(std::abs(deviation(true)), 3.5); }

}  // namespace
}  // namespace montelux
