// What time ends, what frames that are not shown take of it, and what is planned by it: by a clock that the work itself
// moves on, so that all seconds are exact.
#include <gtest/gtest.h>

#include "render/timed_plan.h"
#include "work_clock.h"

namespace montelux {
namespace {

using test::WorkClock;

constexpr PixelBounds bounds{0, 0, 32, 32};
constexpr int tiles = 2 * 2, warm_up = 3, stages = 2;
constexpr double begin_seconds = 0.5, tile_seconds = 0.25;  // of a step of a frame that is shown, for 16 x 16 pixels
constexpr double frame_seconds = tiles * stages * tile_seconds;

// Every sample is one more than the number of its series.
class Timed final : public CoupledIntegrator {
 public:
  Timed(WorkClock& clock, double warm_up_tile_seconds, int warm_up_frames = montelux::warm_up)
      : clock_(&clock), warm_up_tile_(warm_up_tile_seconds), warm_up_(warm_up_frames) {}
  int frames() const override { return 16; }
  int warm_up() const override { return warm_up_; }
  int stages() const override { return montelux::stages; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    clock_->pass(begin_seconds);
    return std::make_unique<TimedSeries>(*this, float(pass.points.pass + 1));
  }
  // Of one series.
  double warm_up_seconds() const { return warm_up_ * montelux::stages * tiles * warm_up_tile_; }

 private:
  class TimedSeries final : public FrameSeries {
   public:
    TimedSeries(const Timed& of, float radiance) : of_(of), radiance_(radiance) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      of_.clock_->pass((step.frame < of_.warm_up_ ? of_.warm_up_tile_ : tile_seconds) * tile.area() / 256);
      if (step.stage + 1 == montelux::stages)
        for (PixelSample& sample : out) sample.radiance = gray_rgb(radiance_);
      return {};
    }

   private:
    const Timed& of_;
    float radiance_;
  };
  WorkClock* clock_;
  double warm_up_tile_;
  int warm_up_;
};

// Pixels that learn nothing from each other.
constexpr double sample_seconds = 32 * 32 / 1024.0;  // of all pixels
class Alone final : public PixelIntegrator {
 public:
  explicit Alone(WorkClock& clock) : clock_(&clock) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample>) const override {
    clock_->pass(pass.tile.area() * double(pass.points.samples_per_pass) / 1024.0);
    return {};
  }

 private:
  WorkClock* clock_;
};

RenderSettings settings(const WorkClock& clock, PassPlan plan, int threads) {
  RenderSettings s;
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.plan = plan, s.threads = threads, s.clock = clock.clock();
  return s;
}

TEST(WarmUp, has_its_own_seconds_whatever_the_number_of_threads) {
  for (int threads : {1, 2, 5}) {
    WorkClock clock;
    const Timed timed(clock, 1.0 / 64);
    RenderObserver silent;
    const RenderResult r = render(timed, settings(clock, {2, 3}, threads), silent);
    EXPECT_EQ(r.warm_up, 3 * timed.warm_up_seconds());
    EXPECT_EQ(r.shown_seconds(), 3 * (begin_seconds + 2 * frame_seconds));
    // Planted faults: the time is shared out by the number of frames; the beginning of a series is taken for warm-up.
    EXPECT_NE(r.warm_up, r.seconds * warm_up / (warm_up + 2));
    EXPECT_NE(r.warm_up, 3 * (timed.warm_up_seconds() + begin_seconds));
  }
}

TEST(WarmUp, does_not_bring_the_end_nearer_where_it_does_not_count) {
  WorkClock clock;
  const Timed timed(clock, 1);
  RenderObserver silent;
  RenderSettings s = settings(clock, {2, 1000}, 2);
  const double seconds = 2 * (begin_seconds + 2 * frame_seconds);
  s.stop = std::make_shared<TimeLimit>(seconds, false);
  const RenderResult shown = render(timed, s, silent);
  EXPECT_EQ(shown.shown_seconds(), seconds);
  EXPECT_EQ(shown.film.samples(0, 0), 4);
  EXPECT_EQ(shown.film.image().passes, 2);
  // The first warm-up takes longer than that, and a picture has a frame all the same.
  s.stop = std::make_shared<TimeLimit>(seconds, true);
  const RenderResult all = render(timed, s, silent);
  EXPECT_EQ(all.film.samples(0, 0), 1);
  EXPECT_EQ(all.shown_seconds(), begin_seconds + frame_seconds);
}

TEST(WarmUp, is_planned_for_where_it_counts) {
  WorkClock clock;
  const Timed timed(clock, 1);
  RenderSettings s = settings(clock, {}, 2);
  RenderObserver silent;
  // Sixteen frames in four series, with room for the inaccuracy of the measured speed; a series of one frame is all
  // that is left of that with the warm-up.
  const double seconds = 18 * (begin_seconds + frame_seconds);
  EXPECT_EQ(plan_for_time(timed, s, {seconds, false}, silent).plan.samples_per_pass, 4);
  EXPECT_EQ(plan_for_time(timed, s, {seconds, true}, silent).plan.samples_per_pass, 1);
}

// A single frame that prepares a series may take longer than many others: what is left of a quarter of the time is for
// these, and it is not thought to come again with each of them.
TEST(WarmUp, of_one_long_frame_is_planned_for_as_long_as_it_takes) {
  WorkClock clock;
  const Timed timed(clock, 4, 1);
  RenderSettings s = settings(clock, {}, 2);
  RenderObserver silent;
  const double series = timed.warm_up_seconds() + begin_seconds + 6 * frame_seconds;
  const int frames = plan_for_time(timed, s, {4 * series, true}, silent).plan.samples_per_pass;
  // The time of a series is measured to within some percent, here the time of two frames. If all frames were thought to
  // take the same time there would be one.
  EXPECT_GE(frames, 3);
  EXPECT_LE(frames, 6);
}

TEST(WarmUp, is_none_where_pixels_are_alone) {
  WorkClock clock;
  RenderObserver silent;
  const RenderResult r = render(Alone(clock), settings(clock, {1, 2}, 1), silent);
  EXPECT_EQ(r.seconds, 2 * sample_seconds);
  EXPECT_EQ(r.warm_up, 0);
}

// Frames of a warm-up are none of those that are done.
TEST(Series, that_time_breaks_off_count_if_half_done_or_the_first) {
  struct Case {
    int whole, more;  // series of eight frames; frames of the one that is broken off
    int passes;
    double mean;  // over the series that count, whatever their length
  };
  for (const Case& c : {Case{1, 3, 1, 1.0}, {1, 4, 2, 1.5}, {2, 3, 2, 1.5}, {2, 7, 3, 2.0}, {0, 1, 1, 1.0}}) {
    WorkClock clock;
    const Timed timed(clock, 1);
    RenderObserver silent;
    RenderSettings s = settings(clock, {8, 100}, 2);
    const double seconds = (c.whole + 1) * begin_seconds + (8 * c.whole + c.more) * frame_seconds;
    s.stop = std::make_shared<TimeLimit>(seconds, false);
    const RenderResult r = render(timed, s, silent);
    EXPECT_EQ(r.shown_seconds(), seconds);
    EXPECT_EQ(r.film.image().passes, c.passes) << c.whole << " " << c.more;
    EXPECT_EQ(r.film.pixel(31, 31).mean[0], c.mean) << c.whole << " " << c.more;
    // What is not in the mean is not among the samples.
    const int shown = 8 * c.whole + (c.passes > c.whole ? c.more : 0);
    EXPECT_EQ(r.film.samples(31, 31), shown) << c.whole << " " << c.more;
    EXPECT_FALSE(r.interrupted);
  }
}

// The same points once more would tell nothing.
TEST(Plans, of_points_that_are_fixed_have_one_pass) {
  WorkClock clock;
  const Alone alone(clock);
  RenderObserver silent;
  RenderSettings s = settings(clock, {}, 1);
  for (int samples : {1, 100, 1024, 1025, 2048, 100000}) {
    const PassPlan plan = plan_passes(samples, PointSetKind::uniform_grid);
    EXPECT_EQ(plan.samples_per_pass, samples);
    EXPECT_EQ(plan.passes, 1) << samples;
    s.image.sampler = PointSetKind::uniform_grid;
    const PassPlan by_time = plan_for_time(alone, s, samples * sample_seconds, silent).plan;
    // The measurement of the speed takes the time of one or two of them, or of 2 %.
    EXPECT_GE(by_time.samples_per_pass, std::clamp(samples - 2 - samples / 50, 1, max_fixed_samples));
    EXPECT_LE(by_time.samples_per_pass, std::min(samples, max_fixed_samples));
    EXPECT_EQ(by_time.passes, 1) << samples;
    // As many as time allows of others.
    s.image.sampler = PointSetKind::sobol;
    EXPECT_GT(plan_for_time(alone, s, samples * sample_seconds, silent).plan.passes, 100000);
  }
  EXPECT_GT(plan_passes(2048, PointSetKind::sobol).passes, 1);
}

}  // namespace
}  // namespace montelux
