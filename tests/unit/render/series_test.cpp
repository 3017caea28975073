// Series of frames: the same picture for any number of threads, clean ends, and a film over series.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "integrator/restir/history.h"
#include "integrator/restir/pixels.h"
#include "render/timed_plan.h"
#include "reuse_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

const TestScene& scene() {
  static const TestScene s{reuse_scenes(40).front().text};
  return s;
}

RenderResult series(const char* way, PassPlan plan, int threads, int first_pass = 0,
                    std::optional<PixelBounds> crop = {}) {
  const ChosenIntegrator chosen = scene().integrator(way);
  RenderSettings s = scene().settings(PointSetKind::blue_noise, plan, 5, threads);
  s.plan.first_pass = first_pass;
  if (crop) s.image.bounds = *crop;
  RenderObserver silent;
  return render(chosen.any(), s, silent);
}

void expect_same(const Film& a, const Film& b) {
  for (int y = a.bounds().y0; y < a.bounds().y1; ++y)
    for (int x = a.bounds().x0; x < a.bounds().x1; ++x)
      for (int c = 0; c < rgb_size; ++c) {
        ASSERT_EQ(a.pixel(x, y).mean[c], b.pixel(x, y).mean[c]) << x << " " << y;
        ASSERT_EQ(a.pixel(x, y).m2[c], b.pixel(x, y).m2[c]) << x << " " << y;
        ASSERT_EQ(a.features(x, y).albedo(c), b.features(x, y).albedo(c)) << x << " " << y;
      }
  EXPECT_EQ(a.image().passes, b.image().passes);
  EXPECT_EQ(a.image().mean[0], b.image().mean[0]);
}

TEST(Series, have_the_same_bits_for_any_number_of_threads) {
  for (const char* way :
       {"restir-di:candidates=2,radius=10,rounds=2", "restir-di:groups=off,neighbours=3,radius=10,rounds=2",
        "restir-di:radius=10,visibility-reuse=off", "restir-di:groups=off,radius=10,visibility-reuse=off",
        "restir-di:rounds=0", "restir-pt:candidates=2,radius=10,temporal=on",
        "restir-pt:groups=off,neighbours=3,radius=10,temporal=on", "light", "bdpt", "vcm:radius=0.1"}) {
    SCOPED_TRACE(way);
    const RenderResult one = series(way, {4, 2}, 1);
    EXPECT_EQ(one.film.image().passes, 2);
    EXPECT_EQ(one.film.samples(3, 3), 8);
    EXPECT_GT(one.film.image().mean[0], 0);
    for (int threads : {2, 5}) expect_same(one.film, series(way, {4, 2}, threads).film);
  }
}

// Without neighbours a round hands on what there is; without rounds the same is shown another way.
TEST(Series, show_the_same_without_rounds_and_without_neighbours) {
  const Film none = series("restir-di:rounds=0", {4, 1}, 2).film;
  for (const char* way : {"restir-di:neighbours=0", "restir-di:neighbours=0,groups=off"}) {
    const Film alone = series(way, {4, 1}, 2).film;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double mean = alone.pixel(x, y).mean[0];
        ASSERT_NEAR(none.pixel(x, y).mean[0], mean, 1e-5 * mean) << way << " " << x << " " << y;
      }
  }
}

// What compilers make of the order of sums may differ between packs, so that a few pixels choose otherwise.
TEST(Series, choose_alike_in_one_lane_and_in_packs_nearly_everywhere) {
  for (const std::string way : {"restir-di:candidates=2", "restir-pt:candidates=2"}) {
    const Film pack = series(way.c_str(), {3, 1}, 1).film;
    const Film one = series((way + ",lanes=one").c_str(), {3, 1}, 1).film;
    EXPECT_EQ(pack.non_finite() + one.non_finite(), 0u) << way;
    int alike = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double a = pack.pixel(x, y).mean[0], b = one.pixel(x, y).mean[0];
        ASSERT_TRUE(std::isfinite(a) && std::isfinite(b)) << way << " " << x << " " << y;
        alike += std::abs(a - b) <= 1e-4 * std::abs(a) ? 1 : 0;
      }
    EXPECT_GE(alike, 40 * 40 * 98 / 100) << way;
  }
}

// Whatever the others choose: the means agree within their errors, which are small where lights are few and large.
TEST(Series, have_one_mean_in_one_lane_and_in_packs) {
  const TestScene blockers{reuse_scenes(40)[1].text};
  const auto film = [&](const std::string& way, std::uint32_t seed) {
    const ChosenIntegrator chosen = blockers.integrator(way);
    RenderObserver silent;
    return render(chosen.any(), blockers.settings(PointSetKind::blue_noise, {4, 16}, seed, 2), silent).film;
  };
  const auto image = [](const Film& f, int c) {
    const ImageEstimate e = f.image();
    return SampleSummary{e.mean[c], e.standard_error[c] * e.standard_error[c] * e.passes, double(e.passes)};
  };
  const std::string ways[] = {"restir-di:candidates=2", "restir-pt:candidates=2"};
  const double level = sidak_level(family_level, 2.0 * double(std::size(ways)) * rgb_size);
  for (const std::string& way : ways) {
    const Film one = film(way + ",lanes=one", 1), pack = film(way, 2);
    EXPECT_EQ(one.non_finite() + pack.non_finite(), 0u) << way;
    EXPECT_EQ(one.image().passes, 16) << way;
    EXPECT_EQ(pack.image().passes, 16) << way;
    for (int c = 0; c < rgb_size; ++c) {
      EXPECT_GE(welch_test(image(one, c), image(pack, c)).p_value, level) << way;
      SampleSummary wrong = image(pack, c);
      wrong.mean *= 1.05;
      EXPECT_LT(welch_test(image(one, c), wrong).p_value, level) << way << ": a pack that is 5 % too bright passes";
    }
  }
}

TEST(Series, add_up_to_the_film_of_one_render) {
  const char* way = "restir-di:candidates=2";
  Film first = series(way, {4, 2}, 1).film;
  first.merge(series(way, {4, 3}, 1, 2).film);
  const Film whole = series(way, {4, 5}, 1).film;
  for (int c = 0; c < rgb_size; ++c) EXPECT_NEAR(first.image().mean[c], whole.image().mean[c], 1e-12);
  EXPECT_EQ(first.image().passes, 5);
}

TEST(Series, keep_to_the_crop) {
  const PixelBounds crop{7, 9, 31, 26};
  const RenderResult r = series("restir-di", {2, 1}, 2, 0, crop);
  EXPECT_EQ(r.film.bounds(), crop);
  EXPECT_GT(r.film.pixel(20, 20).mean[0], 0);
}

// Smaller than a tile, than a block of pixels that share, than a group.
TEST(Series, are_lit_in_the_smallest_pictures) {
  for (const char* way : {"restir-di", "restir-di:groups=off", "restir-pt:temporal=on"})
    for (const PixelBounds crop : {PixelBounds{20, 20, 21, 21}, {18, 20, 21, 22}, {17, 25, 34, 26}}) {
      const RenderResult r = series(way, {4, 4}, 2, 0, crop);
      EXPECT_EQ(r.film.bounds(), crop);
      EXPECT_EQ(r.film.non_finite(), 0u);
      for (int y = crop.y0; y < crop.y1; ++y)
        for (int x = crop.x0; x < crop.x1; ++x) {
          EXPECT_EQ(r.film.samples(x, y), 16);
          EXPECT_GT(r.film.pixel(x, y).mean[0], 0) << way << " " << x << " " << y;
        }
    }
}

TEST(Series, do_not_show_their_warm_up) {
  const RenderResult r = series("restir-di:warm-up=3,candidates=2", {2, 2}, 2);
  EXPECT_EQ(r.film.samples(5, 5), 4);
  EXPECT_EQ(r.film.image().passes, 2);
  // A frame after two that are not shown is the third of three, which is what these have more than the first two.
  const auto of_frames = [](const char* way, int frames) {
    const ChosenIntegrator chosen = scene().integrator(way);
    RenderObserver silent;
    return render(chosen.any(), scene().settings(PointSetKind::independent, {frames, 1}, 5, 2), silent).film;
  };
  const char* way = "restir-di:candidates=2";
  const Film shown = of_frames("restir-di:candidates=2,warm-up=2", 1), two = of_frames(way, 2),
             three = of_frames(way, 3);
  int differ = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double mean = three.pixel(x, y).mean[0], third = 3 * mean - 2 * two.pixel(x, y).mean[0];
      ASSERT_NEAR(shown.pixel(x, y).mean[0], third, 1e-5 * mean + 1e-6) << x << " " << y;
      differ += std::abs(third - mean) > 1e-3 * mean ? 1 : 0;
    }
  EXPECT_GT(differ, 500);  // or any frames would do
}

// Stops at the first query.
class StopsAtOnce final : public RenderObserver {
 public:
  bool stop_requested() override { return true; }
};

TEST(Series, that_are_stopped_end_between_frames_with_a_picture) {
  const ChosenIntegrator chosen = scene().integrator("restir-di");
  const RenderSettings s = scene().settings(PointSetKind::independent, {1024, 64}, 1, 2);
  StopsAtOnce observer;
  const RenderResult r = render(chosen.any(), s, observer);
  EXPECT_TRUE(r.interrupted);
  EXPECT_EQ(r.film.image().passes, 1);
  EXPECT_GE(r.film.samples(0, 0), 1);
  EXPECT_LT(r.film.samples(0, 0), 1024);
  EXPECT_EQ(r.film.non_finite(), 0u);
}

// A series that is broken off counts as a pass, and is none of the passes that were planned.
TEST(Series, that_are_broken_off_are_not_whole) {
  const ChosenIntegrator chosen = scene().integrator("restir-di");
  StopsAtOnce observer;
  EXPECT_TRUE(render(chosen.any(), scene().settings(PointSetKind::independent, {1024, 1}, 1, 2), observer).interrupted);
  RenderSettings s = scene().settings(PointSetKind::independent, plan_for_budget(chosen.any()), 1, 2);
  s.stop = std::make_shared<TimeBudget>(600, 0);
  EXPECT_TRUE(render(chosen.any(), s, observer).interrupted);
}

TEST(Series, end_in_time) {
  const ChosenIntegrator chosen = scene().integrator("restir-di:frames=4");
  RenderSettings s = scene().settings(PointSetKind::independent, {}, 1, 2);
  RenderObserver silent;
  // By a clock that the machine's load does not move: whole series are planned where there is time for them.
  std::atomic<int> requested{0};
  s.clock = [&requested] { return 1e-5 * ++requested; };
  s.plan = plan_for_time(chosen.any(), s, 0.3, silent).plan;
  EXPECT_EQ(s.plan.samples_per_pass, 4);
  s.clock = {};
  s.stop = std::make_shared<TimeLimit>(0.3);
  const RenderResult r = render(chosen.any(), s, silent);
  EXPECT_FALSE(r.interrupted);
  EXPECT_GE(r.film.image().passes, 1);
  EXPECT_LT(r.seconds, 10);
}

TEST(Series, are_planned_whole) {
  const ChosenIntegrator chosen = scene().integrator("restir-di:frames=16");
  const PassPlan plan = plan_passes(chosen.any(), 97, PointSetKind::independent);
  EXPECT_EQ(plan.samples_per_pass, 16);
  EXPECT_EQ(plan.passes, 7);
  // Series are shorter where an error bar would have too few of them.
  const PassPlan few = plan_passes(chosen.any(), 33, PointSetKind::independent);
  EXPECT_EQ(few.samples_per_pass, 8);
  EXPECT_EQ(few.passes, 5);
  const ChosenIntegrator path = scene().integrator("path");
  EXPECT_EQ(plan_passes(path.any(), 33, PointSetKind::independent).samples_per_pass,
            plan_passes(33, PointSetKind::independent).samples_per_pass);
}

// Two pictures of a sequence; the film of the second.
Film second_picture(const char* way, int first_passes, int threads, SeriesMemories& memories,
                    std::optional<PixelBounds> crop = {}) {
  const ChosenIntegrator chosen = scene().integrator(way);
  RenderSettings s = scene().settings(PointSetKind::blue_noise, {2, first_passes}, 5, threads);
  s.sequence.memories = &memories;
  if (crop) s.image.bounds = *crop;
  RenderObserver silent;
  render(chosen.any(), s, silent);
  s.plan.passes = 3, s.image.seed = 6;
  return render(chosen.any(), s, silent).film;
}

const ReuseMemory& opened(const SeriesMemory& memory) { return dynamic_cast<const ReuseMemory&>(memory); }
template <class Reservoirs>
double largest_confidence_of(const Reservoirs& reservoirs) {
  float largest = 0;
  for (const auto& r : reservoirs) largest = std::max(largest, r.confidence);
  return double(largest);
}
// Bytes of a pixel that a series keeps, as docs/reuse.md says for three components. With a fourth one, the four colours
// of its lights, and three more of its paths, are larger by a float each.
constexpr std::size_t lights_bytes = 328 + 16 * (spectrum_size - rgb_size);
constexpr std::size_t paths_bytes = 620 + 28 * (spectrum_size - rgb_size);

double largest_confidence(const SeriesMemory& memory) { return largest_confidence_of(opened(memory).lights); }

TEST(Series, continue_from_the_picture_before_each_from_its_own) {
  const char* way = "restir-di:candidates=2,neighbours=0";
  SeriesMemories memories;
  const Film film = second_picture(way, 3, 1, memories);
  ASSERT_EQ(memories.size(), 3u);
  for (const auto& memory : memories) {
    // Four frames of one candidate each: two of the first picture, two of the second.
    EXPECT_EQ(largest_confidence(*memory), 4);
    EXPECT_EQ(memory->bytes(), std::size_t(40 * 40) * lights_bytes);
  }
  SeriesMemories by_many;
  expect_same(film, second_picture(way, 3, 4, by_many));
}

TEST(Series, continue_from_the_picture_before_with_their_paths) {
  SeriesMemories memories;
  second_picture("restir-pt:temporal=on,neighbours=0", 3, 2, memories);
  ASSERT_EQ(memories.size(), 3u);
  for (const auto& memory : memories) {
    EXPECT_EQ(largest_confidence(*memory), 4);
    EXPECT_EQ(largest_confidence_of(opened(*memory).paths), 4);
    EXPECT_EQ(memory->bytes(), std::size_t(40 * 40) * paths_bytes);
  }
}

TEST(Series, find_the_same_history_in_a_crop) {
  const char* way = "restir-di:candidates=2,neighbours=0";
  const PixelBounds crop{7, 15, 31, 32};
  SeriesMemories of_all, of_crop;
  const Film all = second_picture(way, 3, 2, of_all), part = second_picture(way, 3, 2, of_crop, crop);
  const ReuseMemory &whole = opened(*of_all[0]), &own = opened(*of_crop[0]);
  ASSERT_EQ(own.bounds, crop);
  int with_history = 0;
  // Except for the edge, whose history may be outside.
  for (int y = crop.y0 + 1; y < crop.y1 - 1; ++y)
    for (int x = crop.x0 + 1; x < crop.x1 - 1; ++x) {
      const float confidence = own.lights[pixel_number(crop, x, y)].confidence;
      EXPECT_EQ(confidence, whole.lights[pixel_number(whole.bounds, x, y)].confidence) << x << " " << y;
      EXPECT_EQ(part.pixel(x, y).mean[0], all.pixel(x, y).mean[0]) << x << " " << y;
      with_history += confidence == 4;
    }
  EXPECT_GT(with_history, 240);  // of 330: nearly all that show the floor, which begins in row 19
}

// A new reservoir has confidence 1; what is remembered, of the frame or of the picture before, at most the cap.
TEST(Series, trust_what_they_remember_up_to_the_cap) {
  struct Case {
    int cap;
    double after_eight_frames, after_another_picture;
  };
  for (const Case& c : {Case{0, 1, 1}, {3, 4, 4}, {6, 7, 7}, {20, 8, 9}}) {
    const ChosenIntegrator chosen =
        scene().integrator(fmt::format("restir-di:candidates=2,neighbours=0,m-cap={}", c.cap));
    RenderSettings s = scene().settings(PointSetKind::blue_noise, {8, 1}, 5, 2);
    SeriesMemories memories;
    s.sequence.memories = &memories;
    RenderObserver silent;
    render(chosen.any(), s, silent);
    EXPECT_EQ(largest_confidence(*memories.at(0)), c.after_eight_frames) << c.cap;
    s.plan.samples_per_pass = 1, s.image.seed = 6;
    render(chosen.any(), s, silent);
    EXPECT_EQ(largest_confidence(*memories.at(0)), c.after_another_picture) << c.cap;
  }
}

TEST(Series, leave_no_more_than_there_is_room_for) {
  const ChosenIntegrator chosen = scene().integrator("restir-di:candidates=2,neighbours=0");
  RenderSettings s = scene().settings(PointSetKind::blue_noise, {2, 3}, 5, 2);
  SeriesMemories memories;
  s.sequence.memories = &memories;
  RenderObserver silent;
  constexpr std::size_t of_one = std::size_t(40 * 40) * lights_bytes;
  s.sequence.max_memory = of_one + of_one / 2;
  EXPECT_EQ(render(chosen.any(), s, silent).forgotten, 2);
  ASSERT_EQ(memories.size(), 3u);
  ASSERT_NE(memories[0], nullptr);
  EXPECT_EQ(memories[0]->bytes(), of_one);
  EXPECT_EQ(memories[1], nullptr);
  EXPECT_EQ(memories[2], nullptr);
  // The next image: series 0 continues, and the others restart. Their earlier histories use no memory.
  s.sequence.max_memory = 3 * of_one, s.image.seed = 6;
  const RenderResult next = render(chosen.any(), s, silent);
  EXPECT_EQ(next.forgotten, 0);
  EXPECT_EQ(next.film.image().passes, 3);
  EXPECT_GT(next.film.image().mean[0], 0);
  ASSERT_EQ(memories.size(), 3u);
  for (const auto& memory : memories) ASSERT_NE(memory, nullptr);
  EXPECT_EQ(largest_confidence(*memories[0]), 4);
  EXPECT_EQ(largest_confidence(*memories[1]), 2);
  EXPECT_EQ(largest_confidence(*memories[2]), 2);
  --s.sequence.max_memory;
  EXPECT_EQ(render(chosen.any(), s, silent).forgotten, 1);
  EXPECT_NE(memories[1], nullptr);
  EXPECT_EQ(memories[2], nullptr);
  // Of the last picture nothing is kept, and nothing missed.
  s.sequence.max_memory = 0;
  EXPECT_EQ(render(chosen.any(), s, silent).forgotten, 0);
  for (const auto& memory : memories) EXPECT_EQ(memory, nullptr);
}

TEST(Series, without_a_picture_before_start_from_nothing) {
  SeriesMemories memories, none;
  second_picture("restir-di:candidates=2,neighbours=0", 1, 2, memories);
  ASSERT_EQ(memories.size(), 3u);
  EXPECT_EQ(largest_confidence(*memories[0]), 4);
  EXPECT_EQ(largest_confidence(*memories[1]), 2);
  {
    const char* off = "restir-di:candidates=2,carry=off";
    const Film film = second_picture(off, 3, 2, none);
    for (const auto& memory : none) EXPECT_EQ(memory, nullptr);
    const ChosenIntegrator chosen = scene().integrator(off);
    RenderObserver silent;
    expect_same(film, render(chosen.any(), scene().settings(PointSetKind::blue_noise, {2, 3}, 6, 1), silent).film);
  }
  // Where nothing is learnt from the frame before, nothing is from the picture before.
  SeriesMemories idle;
  second_picture("restir-pt:candidates=2,neighbours=0", 3, 2, idle);
  for (const auto& memory : idle) EXPECT_EQ(memory, nullptr);
  // Nor does a series continue an earlier image if the one in between had no series with its number.
  SeriesMemories gap;
  second_picture("restir-di:candidates=2,neighbours=0", 3, 2, gap);
  ASSERT_EQ(gap.size(), 3u);
  second_picture("restir-di:candidates=2,neighbours=0", 1, 2, gap);
  ASSERT_EQ(gap.size(), 3u);
  EXPECT_EQ(largest_confidence(*gap[0]), 8);
  EXPECT_EQ(largest_confidence(*gap[2]), 2);
  // What is of another crop is not looked at.
  const ChosenIntegrator chosen = scene().integrator("restir-di:candidates=2,neighbours=0");
  RenderSettings s = scene().settings(PointSetKind::blue_noise, {1, 1}, 6, 1);
  s.image.bounds = {3, 3, 20, 20}, s.sequence.memories = &memories;
  RenderObserver silent;
  render(chosen.any(), s, silent);
  EXPECT_EQ(largest_confidence(*memories[0]), 1);
}

// Frames that take a hundredth of a second each, by a clock of their own.
class TickingFrames final : public CoupledIntegrator {
 public:
  class Frames final : public FrameSeries {
   public:
    explicit Frames(std::atomic<int>& ticks) : ticks_(ticks) {}
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample>) override {
      // The last tile of the 40 x 40 pixels ends the frame.
      if (step.stage == 1 && tile.x1 == 40 && tile.y1 == 40) ++ticks_;
      return {};
    }

   private:
    std::atomic<int>& ticks_;
  };
  int frames() const override { return 4; }
  int warm_up() const override { return 0; }
  int stages() const override { return 2; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass&) const override { return std::make_unique<Frames>(ticks_); }
  SecondsClock clock() const {
    return [this] { return 0.01 * ticks_; };
  }

 private:
  mutable std::atomic<int> ticks_{0};
};
RenderResult within(TimeBudget budget) {
  const TickingFrames integrator;
  RenderSettings s = scene().settings(PointSetKind::independent, plan_for_budget(integrator), 1, 1);
  s.stop = std::make_shared<TimeBudget>(budget), s.clock = integrator.clock();
  RenderObserver silent;
  return render(integrator, s, silent);
}

TEST(Budget, is_filled_by_whole_frames_of_one_series) {
  for (auto [budget, frames] : {std::pair{TimeBudget{0.0451, 0}, 4}, {{0.0401, 0.005}, 3}, {{0.0401, 0.015}, 2}}) {
    const RenderResult r = within(budget);
    EXPECT_EQ(r.film.samples(3, 3), frames) << budget.seconds() << " " << budget.ending();
    EXPECT_EQ(r.film.samples(39, 39), frames);
    EXPECT_LE(r.seconds, budget.seconds());
    EXPECT_FALSE(r.interrupted);
    // One series has no error bar.
    EXPECT_EQ(r.film.image().passes, 1);
    EXPECT_EQ(r.film.error().pixels, 0u);
  }
}

TEST(Budget, that_is_too_small_gives_one_frame) {
  const RenderResult r = within({0.001, 0});
  EXPECT_EQ(r.film.samples(3, 3), 1);
  EXPECT_GT(r.seconds, 0.001);
}

TEST(Budget, is_filled_by_whole_passes_of_other_integrators) {
  class Ticking final : public PixelIntegrator {
   public:
    mutable std::atomic<int> ticks{0};
    RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
      EXPECT_EQ(out.size(), std::size_t(pass.tile.area()));
      for (PixelSample& sample : out) sample.radiance = gray_rgb(float(pass.points.pass));
      ticks += pass.tile.x1 == 40 && pass.tile.y1 == 40;
      return {};
    }
  } integrator;
  RenderSettings s = scene().settings(PointSetKind::independent, plan_for_budget(integrator), 1, 1);
  s.stop = std::make_shared<TimeBudget>(0.0351, 0), s.clock = [&] { return 0.01 * integrator.ticks; };
  RenderObserver silent;
  const RenderResult r = render(integrator, s, silent);
  EXPECT_EQ(r.film.image().passes, 3);
  EXPECT_EQ(r.film.pixel(5, 5).mean[0], 1);
  EXPECT_NEAR(r.film.pixel(39, 5).variance_of_mean(0), 1.0 / 3, 1e-12);
}

TEST(Series, hand_on_what_goes_wrong) {
  class Broken final : public CoupledIntegrator {
   public:
    class Frames final : public FrameSeries {
      RayCounts run(const SeriesStep& step, const PixelBounds&, std::span<PixelSample>) override {
        if (step.frame == 1) throw std::runtime_error("broken");
        return {};
      }
    };
    int frames() const override { return 4; }
    int warm_up() const override { return 0; }
    int stages() const override { return 2; }
    std::unique_ptr<FrameSeries> begin(const SeriesPass&) const override { return std::make_unique<Frames>(); }
  };
  RenderObserver silent;
  const Broken broken;
  EXPECT_THROW(render(broken, scene().settings(PointSetKind::independent, {4, 2}, 1, 3), silent), std::runtime_error);
}

}  // namespace
}  // namespace montelux::test
