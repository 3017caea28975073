// Series of frames over a part of the pixels: what they show, and how they are planned for a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "pass_means.h"
#include "render/pilot_windows.h"
#include "render/timed_plan.h"
#include "reuse_scenes.h"
#include "work_clock.h"

namespace montelux::test {
namespace {

constexpr int size = 36, stride = 3;

const TestScene& scene() {
  static const TestScene s{reuse_scenes(size).front().text};
  return s;
}
// One that radiosity can render, with a filter that reaches over several pixels.
const TestScene& diffuse_scene() {
  static const TestScene s{R"(LookAt 0 1 -3  0 0.7 0  0 1 0
Camera "perspective" "float fov" [ 50 ]
Film "rgb" "integer xresolution" [ 40 ] "integer yresolution" [ 31 ]
PixelFilter "gaussian"
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.3 0.5 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 6 5 4 ]
  Shape "bilinearmesh" "point3 P" [ -0.5 2 -0.5  0.5 2 -0.5  -0.5 2 0.5  0.5 2 0.5 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.4 0.3 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 0 2  2 0 2 ]
Material "diffuse" "rgb reflectance" [ 0.3 0.6 0.7 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 1 1  1 1 1 ]
)"};
  return s;
}

Film film_of(const TestScene& of, const char* way, PassPlan plan, int cells, int threads = 1) {
  const ChosenIntegrator chosen = of.integrator(way);
  RenderSettings s = of.settings(PointSetKind::blue_noise, plan, 5, threads);
  s.plan.stride = cells;
  RenderObserver silent;
  return render(chosen.any(), s, silent).film;
}

PassMeans sparse_passes(const TestScene& of, const AnyIntegrator& integrator, int samples, int passes,
                        std::uint32_t seed) {
  PassMeans means;
  RenderObserver silent;
  for (int pass = 0; pass < passes; ++pass) {
    RenderSettings s = of.settings(PointSetKind::blue_noise, {samples, 1}, seed, 0);
    s.plan.first_pass = pass, s.plan.stride = stride;
    add_pass(render(integrator, s, silent).film, {9, 9}, means);
  }
  return means;
}

TEST(SparseSeries, have_the_mean_of_the_path_tracer_at_their_pixels) {
  const std::pair<const char*, int> ways[] = {{"restir-di:radius=4,candidates=4", 72},
                                              {"restir-di:radius=4,candidates=4,groups=off,temporal=on", 88},
                                              {"restir-pt:radius=4,candidates=4", 72},
                                              {"light", 96},
                                              {"bdpt", 96},
                                              {"metropolis:bootstrap=16", 160}};
  const double level = sidak_level(0.01, double(std::size(ways)));
  const PassMeans truth = sparse_passes(scene(), scene().integrator("path").any(), 64, 48, 1);
  std::uint32_t seed = 2;
  for (const auto& [way, passes] : ways) {
    const PassMeans sparse = sparse_passes(scene(), scene().integrator(way).any(), 8, passes, ++seed);
    const MeansVerdict v = compare_means(sparse, truth, level);
    EXPECT_FALSE(v.differ) << way << ": " << v.smallest_p << " at " << v.where << ", " << v.difference;
    EXPECT_EQ(sparse.non_finite, 0u);
    EXPECT_LT(v.image_error, 0.03) << way;
  }
}

// A planted fault: cells that are taken for pixels.
class WithoutGrid final : public CoupledIntegrator {
 public:
  explicit WithoutGrid(const CoupledIntegrator& inner) : inner_(inner) {}
  int frames() const override { return inner_.frames(); }
  int warm_up() const override { return inner_.warm_up(); }
  int stages() const override { return inner_.stages(); }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    SeriesPass without = pass;
    without.grid.reset();
    return inner_.begin(without);
  }

 private:
  const CoupledIntegrator& inner_;
};

TEST(SparseSeries, that_take_cells_for_pixels_have_another_mean) {
  const PassMeans truth = sparse_passes(scene(), scene().integrator("path").any(), 64, 48, 1);
  for (const char* way : {"restir-di:radius=4,candidates=4", "light", "bdpt"}) {
    const ChosenIntegrator chosen = scene().integrator(way);
    const WithoutGrid faulty(*chosen.coupled);
    EXPECT_TRUE(compare_means(sparse_passes(scene(), faulty, 8, 48, 2), truth, 0.01).differ) << way;
  }
}

// The pixels of passes over a coarse image, whose cells show the mean of their pixels.
PassMeans coarse_passes(const TestScene& of, const AnyIntegrator& integrator, const PixelGrid& grid, int samples,
                        int passes, std::uint32_t seed) {
  PassMeans means;
  const PixelBounds cells = grid.cells();
  for (int pass = 0; pass < passes; ++pass) {
    const ImageSettings image = of.settings(PointSetKind::blue_noise, {samples, 1}, seed, 0).image;
    std::vector<PixelMean> values;
    trace_window(integrator, image, cells, pass, samples, values, grid);
    Film film(cells);
    film.name_tile(cells);
    std::vector<PixelPass> sums(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      PixelSample sample;
      for (std::size_t c = 0; c < rgb_size; ++c) sample.radiance.c[c] = float(values[i][c]);
      sums[i].add(sample);
    }
    film.add_pass(cells, pass, sums);
    add_pass(film, {3, 3}, means);
  }
  return means;
}

TEST(CoarseImages, show_the_means_of_their_cells) {
  // The last cells are smaller: 36 is no multiple of 5.
  const PixelGrid coarse{{0, 0, size, size}, 5, true};
  const double level = sidak_level(0.01, 4);
  // The truth: means over 5 x 5 pixels of whole images.
  PassMeans truth;
  RenderObserver silent;
  for (int pass = 0; pass < 48; ++pass) {
    RenderSettings s = scene().settings(PointSetKind::blue_noise, {64, 1}, 1, 0);
    s.plan.first_pass = pass;
    const Film film = render(scene().integrator("path").any(), s, silent).film;
    Film cells(coarse.cells());
    cells.name_tile(coarse.cells());
    std::vector<PixelPass> sums;
    for (int y = 0; y < coarse.cells().height(); ++y)
      for (int x = 0; x < coarse.cells().width(); ++x) {
        const PixelBounds pixels = coarse.pixels(x, y);
        PixelSample mean;
        for (int v = pixels.y0; v < pixels.y1; ++v)
          for (int u = pixels.x0; u < pixels.x1; ++u)
            for (int c = 0; c < rgb_size; ++c)
              mean.radiance.c[c] += float(film.pixel(u, v).mean[c]) / float(pixels.area());
        sums.emplace_back().add(mean);
      }
    cells.add_pass(coarse.cells(), pass, sums);
    add_pass(cells, {3, 3}, truth);
  }
  std::uint32_t seed = 2;
  for (const auto& [way, passes] : {std::pair("path", 400), std::pair("light", 800), std::pair("bdpt", 400)}) {
    const ChosenIntegrator chosen = scene().integrator(way);
    const PassMeans means = coarse_passes(scene(), chosen.any(), coarse, 8, passes, ++seed);
    const MeansVerdict v = compare_means(means, truth, level);
    EXPECT_FALSE(v.differ) << way << ": " << v.smallest_p << " at " << v.where << ", " << v.difference;
    EXPECT_LT(v.image_error, 0.03) << way;
    // A planted fault: a pixel shown for its cell.
    PixelGrid one = coarse;
    one.is_mean = false;
    EXPECT_TRUE(compare_means(coarse_passes(scene(), chosen.any(), one, 8, passes, seed), truth, level).differ) << way;
  }
}

TEST(SparseSeries, of_radiosity_show_the_pixels_of_the_whole_picture) {
  const char* way = "radiosity:elementsize=0.3,warm-up=3";
  const Film whole = film_of(diffuse_scene(), way, {2, 2}, 1), sparse = film_of(diffuse_scene(), way, {2, 2}, stride);
  int sampled = 0;
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 40; ++x) {
      if (!sparse.is_sampled(x, y)) continue;
      ++sampled;
      for (int c = 0; c < rgb_size; ++c) EXPECT_EQ(sparse.pixel(x, y).mean[c], whole.pixel(x, y).mean[c]) << x << y;
      EXPECT_EQ(sparse.features(x, y).object, whole.features(x, y).object);
    }
  EXPECT_EQ(sampled, 14 * 11);
}

TEST(SparseSeries, see_what_the_pixels_see_that_they_represent) {
  // Nothing is reused: the first frame is the pixels' own.
  const char* way = "restir-di:rounds=0,temporal=off";
  const Film whole = film_of(scene(), way, {1, 1}, 1), sparse = film_of(scene(), way, {1, 1}, stride);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      if (!sparse.is_sampled(x, y)) continue;
      ASSERT_EQ(sparse.features(x, y).depth(), whole.features(x, y).depth()) << x << " " << y;
      ASSERT_EQ(sparse.pixel(x, y).mean[0], whole.pixel(x, y).mean[0]) << x << " " << y;
    }
}

TEST(SparseSeries, have_the_same_bits_for_any_number_of_threads) {
  const auto expect_same = [](const Film& a, const Film& b) {
    ASSERT_EQ(a.grid(), b.grid());
    for (int y = a.bounds().y0; y < a.bounds().y1; ++y)
      for (int x = a.bounds().x0; x < a.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c) {
          ASSERT_EQ(a.pixel(x, y).mean[c], b.pixel(x, y).mean[c]) << x << " " << y;
          ASSERT_EQ(a.pixel(x, y).m2[c], b.pixel(x, y).m2[c]) << x << " " << y;
        }
  };
  for (const char* way :
       {"restir-di:candidates=2,radius=4", "restir-gi:radius=4", "restir-pt:radius=4,groups=off", "light", "bdpt",
        "vcm:radius=0.1", "sppm:radius=0.1", "photonmap:radius=0.1,caustic-radius=0.1,photons=2000",
        "irradiance-cache:samples=20", "radiosity:elementsize=0.3,warm-up=2"}) {
    SCOPED_TRACE(way);
    // 20 x 16 cells: two tiles.
    const Film one = film_of(diffuse_scene(), way, {2, 2}, 2, 1);
    EXPECT_GT(one.image().mean[0], 0);
    for (int threads : {2, 5}) expect_same(one, film_of(diffuse_scene(), way, {2, 2}, 2, threads));
  }
}

TEST(SparseSeries, neither_use_nor_leave_a_memory) {
  const ChosenIntegrator chosen = scene().integrator("restir-di:radius=4");
  const auto second_picture = [&](int first, int second, SeriesMemories& memories) {
    RenderSettings s = scene().settings(PointSetKind::blue_noise, {2, 1}, 5);
    s.sequence.memories = &memories, s.plan.stride = first;
    RenderObserver silent;
    render(chosen.any(), s, silent);
    s.plan.stride = second, s.image.seed = 6;
    return render(chosen.any(), s, silent).film;
  };
  SeriesMemories dense, sparse, mixed;
  second_picture(1, 1, dense);
  ASSERT_EQ(dense.size(), 1u);
  EXPECT_NE(dense[0], nullptr);
  const Film after_sparse = second_picture(stride, stride, sparse), after_dense = second_picture(1, stride, mixed);
  ASSERT_EQ(sparse.size(), 1u);
  EXPECT_EQ(sparse[0], nullptr);
  EXPECT_EQ(after_sparse.image().mean[0], after_dense.image().mean[0]);
}

// Takes time by the cell, and more for what does not depend on the pixels.
class TimedFrames final : public CoupledIntegrator {
 public:
  TimedFrames(WorkClock& clock, double pixel_seconds, double frame_seconds, int warm_up)
      : clock_(clock), pixel_(pixel_seconds), frame_(frame_seconds), warm_up_(warm_up) {}
  int frames() const override { return 16; }
  int warm_up() const override { return warm_up_; }
  int stages() const override { return 1; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    max_cells_ = std::max(max_cells_.load(), pass.bounds.area());
    return std::make_unique<Frames>(*this);
  }
  int max_cells() const { return max_cells_; }  // of the series so far

 private:
  class Frames final : public FrameSeries {
   public:
    explicit Frames(const TimedFrames& of) : of_(of) {}
    RayCounts run(const SeriesStep&, const PixelBounds& tile, std::span<PixelSample> out) override {
      of_.clock_.pass((tile.x0 == 0 && tile.y0 == 0 ? of_.frame_ : 0) + of_.pixel_ * tile.area());
      for (PixelSample& sample : out) sample.radiance = gray_rgb(1.0f);
      return {};
    }

   private:
    const TimedFrames& of_;
  };
  WorkClock& clock_;
  double pixel_, frame_;
  int warm_up_;
  mutable std::atomic<int> max_cells_{0};
};

constexpr PixelBounds screen{0, 0, 640, 360};

RenderSettings settings(const WorkClock& clock) {
  RenderSettings s;
  s.image.bounds = screen, s.image.width = screen.width(), s.image.height = screen.height();
  s.threads = 1, s.clock = clock.clock();
  return s;
}

TEST(SparseSeries, are_planned_if_a_frame_takes_longer_than_the_time_which_they_keep) {
  struct Case {
    double frame;  // seconds of a whole frame, in all
    double fixed;  // of these, what does not depend on the pixels
    int warm_up;
    bool is_sparse;
  };
  for (const Case& c : {Case{12, 0, 0, true},
                        {2, 0, 0, true},
                        {100, 0, 0, true},
                        {3, 0.25, 0, true},
                        {2, 0.05, 3, true},
                        {0.5, 0, 0, false},
                        {0.5, 0.002, 0, false}}) {
    SCOPED_TRACE(c.frame);
    WorkClock clock;
    const TimedFrames timed(clock, (c.frame - c.fixed) / screen.area(), c.fixed, c.warm_up);
    RenderSettings s = settings(clock);
    RenderObserver silent;
    const TimedPlan plan = plan_for_time(timed, s, 1, silent);
    const double measuring = clock.clock()();
    EXPECT_LE(measuring, c.fixed > 0 ? 0.7 : 0.2);
    EXPECT_EQ(plan.plan.stride > 1, c.is_sparse);
    // Not too little; and exact if all of it is the pixels'.
    EXPECT_GE(plan.sample_seconds, 0.99 * c.frame * (1 + c.warm_up));
    if (c.fixed == 0) {
      EXPECT_NEAR(plan.sample_seconds, c.frame, 0.01 * c.frame);
    }
    if (c.is_sparse) {
      EXPECT_LT(timed.max_cells(), screen.area() / 4);
      EXPECT_EQ(plan.plan.samples_per_pass, 1);
    }
    s.plan = plan.plan;
    s.stop = std::make_shared<TimeLimit>(1 - measuring, true, 0.1);
    const RenderResult r = render(timed, s, silent);
    EXPECT_GE(r.film.image().passes, 1);
    EXPECT_LE(clock.clock()(), 1.1);
    if (c.is_sparse) {
      EXPECT_GE(clock.clock()(), 0.8);
    }
  }
}

// Where what does not depend on the pixels takes more than the time, fewer pixels would not help.
TEST(SparseSeries, are_no_sparser_than_helps) {
  WorkClock clock;
  const TimedFrames timed(clock, 16.0 / screen.area(), 4, 0);
  RenderObserver silent;
  const TimedPlan plan = plan_for_time(timed, settings(clock), 1, silent);
  EXPECT_LT(plan.plan.stride, 64);
  EXPECT_NEAR(plan.first_seconds, 4, 0.5);
}

TEST(TimeLimit, begins_no_frame_that_ends_much_too_late) {
  RenderState state;
  state.is_covered = true, state.seconds = 8, state.next_frame = 4;
  EXPECT_FALSE(TimeLimit(10).stops(state));
  EXPECT_FALSE(TimeLimit(10, true, 3).stops(state));
  EXPECT_TRUE(TimeLimit(10, true, 1).stops(state));
  state.is_covered = false;  // no image yet
  EXPECT_FALSE(TimeLimit(10, true, 1).stops(state));
  state.is_covered = true, state.next_frame = 0, state.seconds = 10;
  EXPECT_TRUE(TimeLimit(10, true, 1).stops(state));
}

}  // namespace
}  // namespace montelux::test
