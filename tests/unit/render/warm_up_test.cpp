// The time of frames that are not shown, by a clock that the work itself moves on: all seconds are exact.
#include <gtest/gtest.h>

#include "render/render.h"
#include "work_clock.h"

namespace montelux {
namespace {

using test::WorkClock;

constexpr PixelBounds bounds{0, 0, 40, 24};
constexpr int tiles = 3 * 2, warm_up = 3, stages = 2;
constexpr double begin_seconds = 0.5, tile_seconds = 0.25;  // of a step of a frame that is shown
constexpr double frame_seconds = tiles * stages * tile_seconds;

class Timed final : public CoupledIntegrator {
 public:
  Timed(WorkClock& clock, double warm_up_tile_seconds) : clock_(&clock), warm_up_tile_(warm_up_tile_seconds) {}
  int frames() const override { return 16; }
  int warm_up() const override { return montelux::warm_up; }
  int stages() const override { return montelux::stages; }
  std::unique_ptr<Chain> begin(const ChainPass&) const override {
    clock_->pass(begin_seconds);
    return std::make_unique<TimedChain>(*this);
  }
  // Of one chain.
  double warm_up_seconds() const { return montelux::warm_up * montelux::stages * tiles * warm_up_tile_; }

 private:
  class TimedChain final : public Chain {
   public:
    explicit TimedChain(const Timed& of) : of_(of) {}
    RayCounts run(const ChainStep& step, const PixelBounds&, std::span<PixelSample>) override {
      of_.clock_->pass(step.frame < montelux::warm_up ? of_.warm_up_tile_ : tile_seconds);
      return {};
    }

   private:
    const Timed& of_;
  };
  WorkClock* clock_;
  double warm_up_tile_;
};

RenderSettings settings(const WorkClock& clock, PassPlan plan, int threads) {
  RenderSettings s;
  s.bounds = bounds, s.width = bounds.width(), s.height = bounds.height();
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
    // Planted faults: the time is shared out by the number of frames; a chain's beginning is taken for warm-up.
    EXPECT_NE(r.warm_up, r.seconds * warm_up / (warm_up + 2));
    EXPECT_NE(r.warm_up, 3 * (timed.warm_up_seconds() + begin_seconds));
  }
}

TEST(WarmUp, does_not_bring_the_end_nearer_where_it_does_not_count) {
  WorkClock clock;
  const Timed timed(clock, 1);
  RenderObserver silent;
  RenderSettings s = settings(clock, {2, 1000}, 2);
  s.seconds = 2 * (begin_seconds + 2 * frame_seconds);
  s.warm_up_counts = false;
  const RenderResult shown = render(timed, s, silent);
  EXPECT_EQ(shown.shown_seconds(), *s.seconds);
  EXPECT_EQ(shown.film.samples(0, 0), 4);
  EXPECT_EQ(shown.film.image().passes, 2);
  // The first warm-up takes longer than that, and a picture has a frame all the same.
  s.warm_up_counts = true;
  const RenderResult all = render(timed, s, silent);
  EXPECT_EQ(all.film.samples(0, 0), 1);
  EXPECT_EQ(all.shown_seconds(), begin_seconds + frame_seconds);
}

TEST(WarmUp, is_planned_for_where_it_counts) {
  WorkClock clock;
  const Timed timed(clock, 1);
  RenderSettings s = settings(clock, {}, 2);
  s.warm_up_counts = false;
  // Sixteen frames in four chains; a chain of one frame is all that is left of that with the warm-up.
  const double seconds = 16 * (begin_seconds + frame_seconds);
  EXPECT_EQ(plan_for_time(timed, s, seconds).samples_per_pass, 4);
  s.warm_up_counts = true;
  EXPECT_EQ(plan_for_time(timed, s, seconds).samples_per_pass, 1);
}

TEST(WarmUp, is_none_where_pixels_are_alone) {
  class Alone final : public PixelIntegrator {
   public:
    RayCounts trace(const TilePass&, std::span<PixelSample>) const override { return {}; }
  };
  WorkClock clock;
  RenderObserver silent;
  EXPECT_EQ(render(Alone(), settings(clock, {1, 2}, 1), silent).warm_up, 0);
}

}  // namespace
}  // namespace montelux
