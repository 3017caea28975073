// A comparison of methods whose errors are known: what it measures, what it decides, and what it does not.
#include "lab/compare/comparison.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "lab/compare/pilot.h"
#include "noise.h"
#include "statistics.h"
#include "work_clock.h"

namespace montelux::lab {
namespace {

using namespace montelux::test;

// Every sample is `mean` plus noise of standard deviation `sigma`, uniform in distribution, and takes so many
// nanoseconds of the clock, if there is one. `together`: all pixels have the same noise. Two of the same `first`
// dimension have the same noise in a comparison, except for its size.
class Noise final : public PixelIntegrator {
 public:
  Noise(float mean, float sigma, bool together = false) : mean_(mean), sigma_(sigma), together_(together) {}
  Noise(float mean, float sigma, double nanoseconds, WorkClock& clock, std::uint32_t first)
      : mean_(mean), sigma_(sigma), first_(first), nanoseconds_(nanoseconds), clock_(&clock) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    for_each_noise(pass, together_, [&](std::size_t i, const Sampler<float>& sampler) {
      for (int c = 0; c < 3; ++c) out[i].radiance[c] = mean_ + noise(sampler, first_ + std::uint32_t(c), sigma_);
    });
    if (clock_) clock_->pass(1e-9 * nanoseconds_ * double(out.size()));
    return {};
  }

 private:
  float mean_, sigma_;
  bool together_ = false;
  std::uint32_t first_ = 0;
  double nanoseconds_ = 0;
  WorkClock* clock_ = nullptr;
};

// Series whose frames are those of Noise, after `warm_up` frames that take as long and show nothing.
class WarmedUp final : public CoupledIntegrator {
 public:
  WarmedUp(const Noise& noise, int warm_up) : noise_(noise), warm_up_(warm_up) {}
  int frames() const override { return 1; }
  int warm_up() const override { return warm_up_; }
  int stages() const override { return 1; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<Frames>(noise_, pass);
  }

 private:
  class Frames final : public FrameSeries {
   public:
    Frames(const Noise& noise, const SeriesPass& pass) : noise_(noise), pass_(pass) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      PointSet points = pass_.points;
      points.samples_per_pass = 1, points.pass = mix_bits(points.pass * 1024 + std::uint32_t(step.frame));
      return noise_.trace({tile, points, {}}, out);
    }

   private:
    const Noise& noise_;
    SeriesPass pass_;
  };
  const Noise& noise_;
  int warm_up_;
};

ComparisonSettings settings(int samples, int repeats) {
  ComparisonSettings s;
  s.render.image.bounds = {0, 0, 32, 32}, s.render.image.width = s.render.image.height = 32, s.render.threads = 1;
  s.samples = samples, s.repeats = repeats;
  return s;
}

ComparedMethod compared_method(const char* label, const PixelIntegrator& integrator) {
  return {label, label, integrator, PointSetKind::independent, {}};
}

Reference exact(float value) {
  Reference r;
  r.mean = make_pixel_buffer(32, 32, {"R", "G", "B"}), r.variance = r.mean;
  for (float& v : r.mean.values) v = value;
  r.degrees_of_freedom = INFINITY, r.origin = "exact";
  return r;
}

TEST(Comparison, measures_the_squared_error_and_states_it_by_its_own_bars) {
  const Noise one(1, 0.5f), two(1, 1);
  const ComparisonResult r =
      run_comparison({compared_method("a", one), compared_method("b", two)}, exact(1), settings(16, 12), {});
  for (std::size_t i = 0; i < 2; ++i) {
    const MethodResult& m = r.methods[i];
    const double truth = (i == 0 ? 0.25 : 1.0) / 16;
    // The mean over repeats of a mean over 3072 values is near normal.
    EXPECT_LT(std::abs(m.mse.mean - truth) / m.mse.standard_error, student_t_quantile(1 - family_level / 8, 11));
    EXPECT_LT(std::abs(m.variance.mean - truth) / m.variance.standard_error,
              student_t_quantile(1 - family_level / 8, 11));
    EXPECT_FALSE(m.agreement.differs());
    EXPECT_EQ(m.repeats.size(), 12u);
    EXPECT_EQ(m.samples.mean, 16);
    // Independent samples: the squared error falls with their number.
    EXPECT_LT(std::abs(m.slope_by_samples.mean + 1) / m.slope_by_samples.standard_error,
              student_t_quantile(1 - family_level / 8, 11));
  }
  // A planted fault: a truth 5 % off is seen.
  EXPECT_GT(std::abs(r.methods[0].mse.mean - 1.05 * 0.25 / 16) / r.methods[0].mse.standard_error,
            student_t_quantile(1 - family_level / 8, 11));
}

// A comparison of two methods by the work's own clock, each interval at the level of the family.
PairVerdict verdict_by_work(const Noise& a, const Noise& b, const WorkClock& clock, int repeats = 8) {
  ComparisonSettings s = settings(16, repeats);
  s.render.clock = clock.clock(), s.confidence = 1 - family_level;
  const ComparisonResult r = run_comparison({compared_method("a", a), compared_method("b", b)}, exact(1), s, {});
  EXPECT_EQ(r.verdicts.size(), 1u);
  return r.verdicts.front();
}
bool holds(const Measured& interval, double truth) { return interval.low < truth && truth < interval.high; }

// The pair is decided, its ratio is the true one, and each of the ratios that a fault would give is excluded.
void expect_ratio(const PairVerdict& v, double truth, std::initializer_list<double> faults) {
  EXPECT_TRUE(v.decided);
  for (ErrorMeasure measure : {ErrorMeasure::relative_mse, ErrorMeasure::mse}) {
    const Measured& ratio = v.ratio[measure];
    EXPECT_TRUE(holds(ratio, truth)) << ratio.low << " to " << ratio.high;
    for (double fault : faults) EXPECT_FALSE(holds(ratio, fault)) << fault;
  }
}

// Planted faults: the variance is taken for four fifths of what it is; or is not squared.
TEST(Comparison, decides_for_the_method_of_less_noise_at_the_same_cost) {
  WorkClock clock;
  const Noise quiet(1, 0.5f, 400, clock, 0), loud(1, 1, 400, clock, 3);
  expect_ratio(verdict_by_work(quiet, loud, clock), 4, {5, 2});
}

// A planted fault: the time is not counted.
TEST(Comparison, decides_for_the_cheaper_of_equal_noise) {
  WorkClock clock;
  const Noise cheap(1, 1, 200, clock, 0), dear(1, 1, 2000, clock, 3);
  expect_ratio(verdict_by_work(dear, cheap, clock), 0.1, {1});
}

// The pilots of a comparison, and what they make of the reference.
ReferenceGoal goal_of(const std::vector<ComparedMethod>& compared_methods, const ComparisonSettings& s) {
  const ComparisonState state = begin_comparison(compared_methods, {}, s);
  std::vector<std::size_t> all(compared_methods.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<double> samples(compared_methods.size(), s.samples);
  const auto pilots = run_pilots(compared_methods, state, std::vector<double>(compared_methods.size(), 1e-6), s, {});
  return plan_reference(pilots, all, samples, s.measure, 0.05);
}

// Bright on the left (mean 10), dark on the right (mean 0.1), with noise of its own on each side.
class TwoTone final : public PixelIntegrator {
 public:
  TwoTone(float bright, float dark, WorkClock& clock, std::uint32_t first)
      : sigma_{bright, dark}, clock_(&clock), first_(first) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    for_each_noise(pass, false, [&](std::size_t i, const Sampler<float>& sampler) {
      const auto x = int(i / pass.points.samples_per_pass) % (pass.tile.x1 - pass.tile.x0) + pass.tile.x0;
      const std::size_t side = x < 16 ? 0 : 1;
      for (int c = 0; c < 3; ++c)
        out[i].radiance[c] = (side == 0 ? 10.0f : 0.1f) + noise(sampler, first_ + std::uint32_t(c), sigma_[side]);
    });
    clock_->pass(4e-7 * double(out.size()));
    return {};
  }
  static Reference truth() {
    Reference r = exact(10);
    for (int y = 0; y < 32; ++y)
      for (int x = 16; x < 32; ++x)
        for (int c = 0; c < 3; ++c) r.mean.at(x, y, c) = 0.1f;
    return r;
  }

 private:
  float sigma_[2];
  WorkClock* clock_;
  std::uint32_t first_;
};

TEST(Comparison, decides_by_the_measure_that_is_chosen) {
  // By squared error the first is twice as good, by relative squared error the second four times.
  WorkClock clock;
  const TwoTone bright(0.5f, 0.5f, clock, 0), dark(1, 0.25f, clock, 3);
  for (ErrorMeasure measure : {ErrorMeasure::relative_mse, ErrorMeasure::mse}) {
    ComparisonSettings s = settings(16, 8);
    s.render.clock = clock.clock(), s.confidence = 1 - family_level, s.measure = measure, s.slopes = false;
    const std::vector<ComparedMethod> both{compared_method("a", bright), compared_method("b", dark)};
    const ComparisonResult r = run_comparison(both, TwoTone::truth(), s, {});
    const PairVerdict& v = r.verdicts.front();
    EXPECT_TRUE(v.decided);
    EXPECT_EQ(winner_of(v.ratio[ErrorMeasure::relative_mse]), -1);
    EXPECT_EQ(winner_of(v.ratio[ErrorMeasure::mse]), 1);
    EXPECT_EQ(v.likeness, Likeness::none);
    // 1 / 100.01 and 1 / 0.02 are the divisors of both sides.
    const auto error = [](double left, double right) { return left * left / 100.01 + right * right / 0.02; };
    EXPECT_TRUE(holds(v.ratio[ErrorMeasure::relative_mse], error(1, 0.25) / error(0.5, 0.5)));
    // Its reference is made by the method that the verdict is going to prefer.
    EXPECT_EQ(goal_of(both, s).method, measure == ErrorMeasure::mse ? 0u : 1u);
  }
}

TEST(Comparison, sees_which_methods_are_the_same) {
  const Noise one(1, 0.5f), same(1, 0.5f), other(1, 0.5f, true);
  std::vector<ComparedMethod> three{compared_method("a", one), compared_method("b", same), compared_method("c", other)};
  EXPECT_EQ(run_comparison(three, exact(1), settings(4, 2), {}).verdicts[0].likeness, Likeness::pictures);
  EXPECT_EQ(run_comparison(three, exact(1), settings(4, 2), {}).verdicts[1].likeness, Likeness::none);
  three[0].settings = three[1].settings = "noise", three[2].settings = "noise together";
  const ComparisonResult r = run_comparison(three, exact(1), settings(4, 2), {});
  EXPECT_EQ(r.verdicts[0].likeness, Likeness::settings);
  EXPECT_FALSE(r.verdicts[0].decided);
  EXPECT_EQ(r.verdicts[1].likeness, Likeness::none);
}

TEST(Comparison, of_one_pass_a_repeat_knows_no_error_bars_and_says_no_more) {
  const Noise one(1, 0.5f), two(1, 1);
  const ComparisonResult r =
      run_comparison({compared_method("a", one), compared_method("b", two)}, exact(1), settings(1, 6), {});
  for (const MethodResult& m : r.methods) {
    EXPECT_EQ(m.coverage.count, 0);
    EXPECT_EQ(m.variance.count, 0);
    EXPECT_EQ(m.efficiency[ErrorMeasure::mse].count, 6);
    EXPECT_EQ(m.agreement.degrees_of_freedom, 5);
  }
}

TEST(Comparison, takes_passes_of_all_repeats_for_the_error_of_the_image_mean) {
  const Noise one(1, 0.5f);
  const ComparisonResult r = run_comparison({compared_method("a", one)}, exact(1), settings(16, 4), {});
  const MethodResult& m = r.methods[0];
  EXPECT_EQ(m.agreement.degrees_of_freedom, 4 * m.repeats[0].passes - 1);
  // 1024 pixels of 64 samples: standard error 0.5 / 256; its own relative error is that of a chi of many degrees.
  EXPECT_NEAR(m.agreement.standard_error / (0.5 / 256), 1, 0.5);
  // A repeat that does not know its passes counts as one.
  ComparisonState state = begin_comparison({compared_method("a", one)}, exact(1), settings(16, 4));
  run_rounds({compared_method("a", one)}, settings(16, 4), 4, {}, state);
  for (Repeat& repeat : state.methods[0].repeats) repeat.passes = 0;
  EXPECT_EQ(result_of({compared_method("a", one)}, state, settings(16, 4)).methods[0].agreement.degrees_of_freedom, 3);
}

TEST(Comparison, leaves_equals_undecided) {
  WorkClock clock;
  const Noise one(1, 1, 400, clock, 0), other(1, 1, 400, clock, 3);
  EXPECT_FALSE(verdict_by_work(one, other, clock).decided);
  // What half the noise makes up for in four times the work.
  const Noise quiet(1, 0.5f, 1600, clock, 3);
  EXPECT_FALSE(verdict_by_work(one, quiet, clock).decided);
}

TEST(Comparison, counts_the_time_of_its_turns) {
  WorkClock clock;
  const Noise dear(1, 1, 2000, clock, 0);
  ComparisonSettings s = settings(16, 4);
  s.render.clock = clock.clock();
  const ComparisonResult r = run_comparison({compared_method("a", dear)}, exact(1), s, {});
  for (const Repeat& repeat : r.methods[0].repeats)
    EXPECT_NEAR(repeat.seconds, 2000e-9 * 16 * 32 * 32, 1e-12 * repeat.seconds);
}

// Alone, and with 12 frames of warm-up before each: the same frames at the same cost.
ComparisonResult comparison_of_warm_frames(bool warm_up_counts) {
  WorkClock clock;
  const Noise alone(1, 1, 1024, clock, 0), frame(1, 1, 1024, clock, 3);
  const WarmedUp warmed(frame, 12);
  ComparisonSettings s = settings(16, 8);
  s.render.clock = clock.clock(), s.warm_up_counts = warm_up_counts, s.confidence = 1 - family_level;
  return run_comparison({compared_method("a", alone), {"b", "b", warmed, PointSetKind::independent, {}}}, exact(1), s,
                        {});
}

TEST(Comparison, leaves_the_time_of_warm_up_out_if_requested) {
  const ComparisonResult r = comparison_of_warm_frames(false);
  const double frame = 1024e-9 * 32 * 32;
  for (const Repeat& repeat : r.methods[1].repeats) {
    EXPECT_NEAR(repeat.seconds, 16 * frame, 1e-9 * frame);
    EXPECT_NEAR(repeat.warm_up, 16 * 12 * frame, 1e-9 * frame);
    EXPECT_NEAR(repeat.all_seconds, 16 * 13 * frame, 1e-9 * frame);
  }
  for (const Repeat& repeat : r.methods[0].repeats) EXPECT_EQ(repeat.seconds, repeat.all_seconds);
  const PairVerdict& v = r.verdicts.front();
  EXPECT_FALSE(v.decided);
  for (ErrorMeasure measure : {ErrorMeasure::relative_mse, ErrorMeasure::mse}) {
    EXPECT_TRUE(holds(v.ratio[measure], 1)) << v.ratio[measure].low << " to " << v.ratio[measure].high;
    EXPECT_TRUE(holds(v.whole_ratio[measure], 13));
    // A planted fault: warm-up is counted all the same.
    EXPECT_FALSE(holds(v.ratio[measure], 13));
  }
  // Single passes of k samples have one warm-up each, and errors and seconds as without.
  for (const ConvergencePoint& p : r.methods[1].convergence)
    EXPECT_NEAR(p.seconds.mean, p.samples * frame, 1e-9 * frame) << p.samples;
  EXPECT_TRUE(holds(r.methods[1].slope_by_time, -1));
}

TEST(Comparison, counts_all_time_by_default) {
  const ComparisonResult r = comparison_of_warm_frames(true);
  for (const MethodResult& m : r.methods)
    for (const Repeat& repeat : m.repeats) EXPECT_EQ(repeat.seconds, repeat.all_seconds);
  EXPECT_TRUE(r.verdicts.front().decided);
  EXPECT_TRUE(holds(r.verdicts.front().ratio[ErrorMeasure::mse], 13));
  // A planted fault: a slope over seconds with the warm-up in them is another.
  EXPECT_FALSE(holds(r.methods[1].slope_by_time, -1));
}

TEST(Comparison, gives_warm_frames_as_much_counted_time_as_the_others) {
  WorkClock clock;
  const Noise alone(1, 1, 1024, clock, 0), frame(1, 1, 1024, clock, 3);
  const WarmedUp warmed(frame, 12);
  ComparisonSettings s = settings(16, 4);
  const double seconds = 1024e-9 * 32 * 32;
  s.render.clock = clock.clock(), s.warm_up_counts = false, s.slopes = false, s.seconds = 4 * 20 * seconds;
  const ComparisonResult r =
      run_comparison({compared_method("a", alone), {"b", "b", warmed, PointSetKind::independent, {}}}, exact(1), s, {});
  for (const Repeat& repeat : r.methods[1].repeats) {
    EXPECT_GE(repeat.seconds, (1 - 1e-9) * 20 * seconds);
    EXPECT_LE(repeat.seconds, 21 * seconds * (1 + 1e-9));
  }
  EXPECT_TRUE(r.methods[1].convergence.empty());
}

TEST(Comparison, finds_a_bias_and_its_size) {
  const Noise right(1, 0.5f), wrong(1.02f, 0.5f);
  const ComparisonResult r =
      run_comparison({compared_method("a", right), compared_method("b", wrong)}, exact(1), settings(64, 8), {});
  EXPECT_FALSE(r.methods[0].agreement.differs());
  EXPECT_TRUE(r.methods[1].agreement.differs());
  const Measured& b = r.methods[1].bias_squared;
  const double largest = student_t_quantile(1 - family_level / 8, 7);
  EXPECT_LT(std::abs(b.mean - 0.0004) / b.standard_error, largest);
  // A planted fault: a mean that is off by half as much again.
  EXPECT_GT(std::abs(b.mean - 0.0009) / b.standard_error, largest);
}

TEST(Comparison, takes_no_common_error_of_all_pixels_for_a_bias) {
  const Noise right(1, 0.5f, true), wrong(1.5f, 0.5f, true);
  const ComparisonResult r =
      run_comparison({compared_method("a", right), compared_method("b", wrong)}, exact(1), settings(16, 12), {});
  EXPECT_FALSE(r.methods[0].agreement.differs()) << r.methods[0].agreement.t;
  EXPECT_TRUE(r.methods[1].agreement.differs());
}

TEST(Comparison, takes_no_common_error_of_the_reference_for_a_bias) {
  // Every pixel of the reference is off by the same: two of its standard errors, which its passes tell.
  const Noise right(1, 0.5f);
  Reference off = exact(1);
  for (float& v : off.mean.values) v += 0.02f;
  for (float& v : off.variance.values) v = 1e-4f;
  off.variance_of_image = {1e-4, 1e-4, 1e-4};
  EXPECT_FALSE(run_comparison({compared_method("a", right)}, off, settings(16, 12), {}).methods[0].agreement.differs());
  // A planted fault: its pixels are taken as independent.
  off.variance_of_image.reset();
  EXPECT_TRUE(run_comparison({compared_method("a", right)}, off, settings(16, 12), {}).methods[0].agreement.differs());
}

TEST(Comparison, makes_a_reference_that_is_good_enough) {
  const Noise quiet(1, 0.5f), loud(1, 2);
  const std::vector<ComparedMethod> both{compared_method("a", quiet), compared_method("b", loud)};
  const ComparisonSettings s = settings(16, 4);
  const ReferenceGoal goal = goal_of(both, s);
  EXPECT_EQ(goal.method, 0u);
  const Reference r = make_reference(both, goal, s, {});
  for (ErrorMeasure by : {ErrorMeasure::relative_mse, ErrorMeasure::mse})
    EXPECT_LE(variance_by(by, r), goal.variance[by]);
  // Two fifths of the samples would not have been enough.
  EXPECT_GT(variance_by(s.measure, r), 0.4 * goal.variance[s.measure]);
  // Independent pixels: the variance of the image mean is that of a pixel over their number, up to its spread.
  for (double v : r.variance_of_image.value()) EXPECT_LT(std::abs(std::log(v * 1024 / mean_value(r.variance))), 3);
  EXPECT_EQ(r.origin.substr(0, 2), "a,");
  EXPECT_LT(run_comparison(both, r, s, {}).reference_share[s.measure], 0.25);
}

TEST(Comparison, takes_the_reference_s_own_noise_off) {
  const Noise one(1, 0.5f);
  Reference noisy = exact(1);
  RandomStream<float> random(5u, 6u);
  // A reference of the variance that four times the samples have.
  for (std::size_t i = 0; i < noisy.mean.values.size(); ++i) {
    noisy.mean.values[i] += 0.5f / 8 * std::sqrt(12.0f) * (random.next() - 0.5f);
    noisy.variance.values[i] = 0.25f / 64;
  }
  const ComparisonResult r =
      run_comparison({compared_method("a", one), compared_method("b", one)}, noisy, settings(16, 12), {});
  const double truth = 0.25 / 16, share = 0.25 / 64 / truth;
  // The reference's noise is the same in every repeat: its mean square over 3072 values has this error of its own.
  const double own = share * truth * std::sqrt(0.8 / 3072);
  const double error = std::hypot(r.methods[0].mse.standard_error, own);
  const double largest = student_t_quantile(1 - family_level / 8, 11);
  EXPECT_LT(std::abs(r.methods[0].mse.mean - truth) / error, largest);
  // A planted fault: the reference's noise is left in.
  EXPECT_GT(std::abs(r.methods[0].mse.mean - truth * (1 + share)) / error, largest);
  EXPECT_NEAR(r.reference_share[ErrorMeasure::mse], 0.25 / 64 / std::min(r.methods[0].mse.mean, r.methods[1].mse.mean),
              1e-6);
}

TEST(Comparison, stops_when_requested) {
  const Noise one(1, 0.5f);
  std::atomic<int> requested{0};
  ComparisonWatch watch;
  watch.stop = [&] { return ++requested > 3; };
  const ComparisonResult r =
      run_comparison({compared_method("a", one), compared_method("b", one)}, exact(1), settings(16, 50), watch);
  EXPECT_TRUE(r.interrupted);
  EXPECT_LT(r.methods[0].repeats.size(), 50u);
}

}  // namespace
}  // namespace montelux::lab
