// The scheduler: the same picture for any number of threads, stopping, time limits, plans; lanes against single floats.
#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <thread>

#include "render/timed_plan.h"
#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {

namespace {

// A scene with many code paths: glass, metal, a lamp, a textured floor and a sky.
constexpr std::string_view scene_text = R"(
LookAt 0 1.5 -4  0 0.5 0  0 1 0
Camera "perspective" "float fov" [ 40 ] "float lensradius" [ 0.02 ] "float focaldistance" [ 4 ]
Film "rgb" "integer xresolution" [ 48 ] "integer yresolution" [ 40 ]
PixelFilter "gaussian"
Integrator "path"
WorldBegin
LightSource "infinite" "rgb L" [ 0.3 0.4 0.5 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 5 4 3 ]
  Translate 1 3 -1
  Shape "sphere" "float radius" [ 0.3 ]
AttributeEnd
Texture "checks" "spectrum" "checkerboard" "float uscale" [ 8 ] "float vscale" [ 8 ]
    "rgb tex1" [ 0.7 0.6 0.5 ] "rgb tex2" [ 0.1 0.1 0.2 ]
Material "diffuse" "texture reflectance" [ "checks" ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
AttributeBegin
  Translate -0.6 0.5 0
  Material "dielectric"
  Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
AttributeBegin
  Translate 0.6 0.5 0
  Material "conductor" "float roughness" [ 0.1 ]
  Shape "sphere" "float radius" [ 0.5 ]
AttributeEnd
)";

const TestScene& scene() {
  static const TestScene s{scene_text};
  return s;
}

bool same_bits(const Film& a, const Film& b) {
  for (int y = a.bounds().y0; y < a.bounds().y1; ++y)
    for (int x = a.bounds().x0; x < a.bounds().x1; ++x) {
      const PixelEstimate &p = a.pixel(x, y), &q = b.pixel(x, y);
      const PixelFeatures &f = a.features(x, y), &g = b.features(x, y);
      if (p.passes != q.passes || p.non_finite != q.non_finite || f.object != g.object || f.hits != g.hits ||
          f.sums != g.sums)
        return false;
      for (int c = 0; c < rgb_size; ++c)
        if (p.mean[c] != q.mean[c] || p.m2[c] != q.m2[c]) return false;
    }
  const ImageEstimate i = a.image(), j = b.image();
  for (int c = 0; c < rgb_size; ++c)
    if (i.mean[c] != j.mean[c] || i.standard_error[c] != j.standard_error[c]) return false;
  return i.passes == j.passes;
}

// An integrator whose samples are known and whose passes take a while.
class Slow final : public PixelIntegrator {
 public:
  explicit Slow(std::chrono::microseconds pause) : pause_(pause) {}
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    std::this_thread::sleep_for(pause_);
    for (PixelSample& s : out) s.radiance = gray_rgb(float(pass.points.pass));
    ++calls_;
    return {out.size(), 0, 0};
  }
  int calls() const { return calls_; }

 private:
  std::chrono::microseconds pause_;
  mutable std::atomic<int> calls_{0};
};

class StopsAt final : public RenderObserver {
 public:
  explicit StopsAt(double fraction) : fraction_(fraction) {}
  void progress(const Progress& p) override {
    reached_ = p.fraction >= fraction_;
    finished_ += p.finished ? 1 : 0;
    EXPECT_GE(p.fraction, last_);
    last_ = p.fraction;
  }
  bool stop_requested() override { return reached_; }
  int finished() const { return finished_; }

 private:
  double fraction_, last_ = 0;
  bool reached_ = false;
  int finished_ = 0;
};

RenderSettings slow_settings(PassPlan plan, int threads) {
  RenderSettings s;
  s.image.bounds = {0, 0, 80, 40};
  s.image.width = 80, s.image.height = 40;
  s.plan = plan;
  s.threads = threads;
  return s;
}

}  // namespace

TEST(Render, gives_the_same_bits_for_any_number_of_threads) {
  for (const NamedPointSet& set : point_set_names) {
    const Film one = scene().render(set.kind, {2, 3}, 5, Lanes::native, 1).film;
    for (int threads : {2, 3, 8})
      EXPECT_TRUE(same_bits(one, scene().render(set.kind, {2, 3}, 5, Lanes::native, threads).film))
          << set.name << ", " << threads << " threads";
  }
}

TEST(Render, seeds_and_passes_give_other_bits) {
  const Film one = scene().render(PointSetKind::padded_sobol, {2, 3}, 5).film;
  EXPECT_FALSE(same_bits(one, scene().render(PointSetKind::padded_sobol, {2, 3}, 6).film));
  EXPECT_FALSE(same_bits(one, scene().render(PointSetKind::padded_sobol, {2, 4}, 5).film));
}

TEST(Render, a_render_that_continues_adds_the_passes_that_were_to_come) {
  const PathTracer tracer = scene().tracer();
  RenderObserver silent;
  RenderSettings s = scene().settings(PointSetKind::blue_noise, {2, 3}, 5);
  Film film = render(tracer, s, silent).film;
  s.plan.first_pass = 3, s.plan.passes = 4;
  film.merge(render(tracer, s, silent).film);
  const Film all = scene().render(PointSetKind::blue_noise, {2, 7}, 5).film;
  const ImageEstimate a = film.image(), b = all.image();
  EXPECT_EQ(a.passes, b.passes);
  for (int c = 0; c < rgb_size; ++c) {
    EXPECT_NEAR(a.mean[c], b.mean[c], 1e-12 * b.mean[c]);
    EXPECT_NEAR(a.standard_error[c], b.standard_error[c], 1e-12 * b.mean[c]);
  }
}

TEST(Render, a_crop_shows_the_same_pixels_as_the_whole) {
  const PathTracer tracer = scene().tracer();
  RenderObserver silent;
  RenderSettings s = scene().settings(PointSetKind::sobol, {2, 2}, 5);
  const Film all = render(tracer, s, silent).film;
  s.image.bounds = {7, 5, 29, 23};
  const Film part = render(tracer, s, silent).film;
  for (int y = 5; y < 23; ++y)
    for (int x = 7; x < 29; ++x) EXPECT_EQ(all.pixel(x, y).mean[0], part.pixel(x, y).mean[0]);
}

// Rounding may differ between the loops, so that single paths part; the means agree within their errors.
TEST(Render, one_lane_and_the_native_pack_agree) {
  const Film one = scene().render(PointSetKind::independent, {4, 16}, 1, Lanes::one).film;
  const Film pack = scene().render(PointSetKind::independent, {4, 16}, 2, Lanes::native).film;
  const auto image = [](const Film& film, int c) {
    const ImageEstimate e = film.image();
    return SampleSummary{e.mean[c], e.standard_error[c] * e.standard_error[c] * e.passes, double(e.passes)};
  };
  const double level = sidak_level(family_level, 2 * rgb_size);
  for (int c = 0; c < rgb_size; ++c) {
    EXPECT_GE(welch_test(image(one, c), image(pack, c)).p_value, level);
    SampleSummary wrong = image(pack, c);
    wrong.mean *= 1.05;
    EXPECT_LT(welch_test(image(one, c), wrong).p_value, level) << "a pack that is 5 % too bright passes";
  }
}

TEST(Render, with_the_same_seed_one_lane_and_the_pack_take_nearly_all_paths_alike) {
  const Film one = scene().render(PointSetKind::padded_sobol, {1, 1}, 3, Lanes::one).film;
  const Film pack = scene().render(PointSetKind::padded_sobol, {1, 1}, 3, Lanes::native).film;
  int alike = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) {
      const double a = one.pixel(x, y).mean[0], b = pack.pixel(x, y).mean[0];
      alike += std::abs(a - b) <= 1e-3 * std::max(a, b) ? 1 : 0;
    }
  EXPECT_GE(alike, 48 * 40 * 95 / 100);
}

TEST(Render, a_request_to_stop_leaves_the_passes_that_are_done) {
  for (int threads : {1, 3}) {
    Slow slow(std::chrono::microseconds(500));
    StopsAt observer(0.005);
    const RenderResult result = render(slow, slow_settings({2, 10000}, threads), observer);
    EXPECT_TRUE(result.interrupted);
    EXPECT_EQ(observer.finished(), 1);
    const ImageEstimate image = result.film.image();
    EXPECT_GE(image.passes, 1);
    EXPECT_LT(image.passes, 10000);
    // Pass p has the value p everywhere: a pixel has the mean of the numbers of its tile's passes.
    double mean = 0;
    for (const auto& [index, tile] : result.film.tiles()) {
      double own = 0;
      for (const FilmPass& pass : tile.passes) own += pass.pass / double(tile.passes.size());
      EXPECT_DOUBLE_EQ(result.film.pixel(tile.cells.x0, tile.cells.y0).mean[0], own);
      mean += own * tile.cells.area() / result.film.bounds().area();
    }
    EXPECT_NEAR(image.mean[0], mean, 1e-9);
    EXPECT_EQ(
        result.rays.camera, std::uint64_t(result.film.non_finite()) + [&] {
          std::uint64_t n = 0;
          for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 80; ++x) n += std::uint64_t(result.film.samples(x, y));
          return n;
        }());
  }
}

TEST(Render, a_finished_render_is_not_interrupted) {
  Slow slow(std::chrono::microseconds(10));
  RenderObserver silent;
  const RenderResult result = render(slow, slow_settings({2, 5}, 2), silent);
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.film.image().passes, 5);
  EXPECT_EQ(slow.calls(), 5 * 6);
}

// Without end except for the time.
RenderResult render_in_time(std::chrono::microseconds pause, double seconds) {
  const Slow slow(pause);
  RenderObserver silent;
  RenderSettings s = slow_settings({1, 1 << 20}, 2);
  s.stop = std::make_shared<TimeLimit>(seconds);
  return render(slow, s, silent);
}

TEST(Render, a_time_limit_ends_the_render_soon_after) {
  const RenderResult result = render_in_time(std::chrono::microseconds(300), 0.3);
  EXPECT_FALSE(result.interrupted);
  EXPECT_GE(result.seconds, 0.3);
  EXPECT_LT(result.seconds, 3);  // a loaded machine may be late, but not by the work that was left: minutes
  EXPECT_GE(result.film.image().passes, 1);
}

TEST(Render, an_integrator_that_throws_ends_the_render_with_its_exception) {
  class Broken final : public PixelIntegrator {
    RayCounts trace(const TilePass& pass, std::span<PixelSample>) const override {
      if (pass.points.pass == 2) throw std::runtime_error("broken");
      return {};
    }
  } broken;
  RenderObserver silent;
  EXPECT_THROW(render(broken, slow_settings({1, 50}, 3), silent), std::runtime_error);
}

// A camera that moves from a red panel to a green one.
TEST(Render, of_every_integrator_is_of_the_moment_of_its_shutter) {
  const TestScene panels(R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
LookAt -2 0 -5  -2 0 0  0 1 0
ActiveTransform EndTime
Identity
LookAt 2 0 -5  2 0 0  0 1 0
ActiveTransform All
Camera "orthographic"
WorldBegin
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
AreaLightSource "diffuse" "rgb L" [ 1 0 0 ] "bool twosided" [ true ]
Shape "bilinearmesh" "point3 P" [ -4 -2 0  0 -2 0  -4 2 0  0 2 0 ]
AreaLightSource "diffuse" "rgb L" [ 0 1 0 ] "bool twosided" [ true ]
Shape "bilinearmesh" "point3 P" [ 0 -2 0  4 -2 0  0 2 0  4 2 0 ]
)");
  RenderObserver silent;
  for (const char* way : {"path", "naive", "direct", "distribution", "tracepath", "restir-di", "restir-pt", "radiosity",
                          "bdpt", "vcm", "sppm", "photonmap", "irradiance-cache"}) {
    const ChosenIntegrator chosen = panels.integrator(way);
    RenderSettings s = panels.settings(PointSetKind::blue_noise, {1, 2}, 1, 1);
    for (const float time : {0.0f, 1.0f}) {
      s.image.shutter = Shutter{time, time};
      const ImageEstimate image = render(chosen.any(), s, silent).film.image();
      EXPECT_GT(image.mean[time == 0 ? 0 : 1], 0.9) << way;
      EXPECT_NEAR(image.mean[time == 0 ? 1 : 0], 0, 1e-12) << way;  // colours are rounded
    }
  }
}

// Roulette with the same random number every time would never end a path that survives once.
TEST(Render, by_fixed_points_ends_where_paths_have_no_end) {
  const TestScene room(R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
Integrator "path" "integer maxdepth" 1000000000
LookAt 0 0 -0.5  0 0 0  0 1 0
Camera "perspective"
WorldBegin
AreaLightSource "diffuse" "rgb L" [ 0.1 0.1 0.1 ]
ReverseOrientation
Material "diffuse" "rgb reflectance" [ 0.9 0.9 0.9 ]
Shape "sphere"
)");
  const ChosenIntegrator path = room.integrator("path");
  RenderObserver silent;
  for (int samples : {1, 4}) {
    const RenderResult r = render(path.any(), room.settings(PointSetKind::uniform_grid, {samples, 1}, 1, 1), silent);
    EXPECT_GT(r.film.image().mean[0], 0.1);
    EXPECT_EQ(r.film.image().passes, 1);
  }
}

// Even where the first pass takes longer than the time: no part of the picture is missing.
TEST(Render, that_time_ends_has_a_whole_pass) {
  const RenderResult result = render_in_time(std::chrono::milliseconds(30), 0.001);
  EXPECT_FALSE(result.interrupted);
  EXPECT_GE(result.film.image().passes, 1);
  const PixelBounds& b = result.film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) EXPECT_GE(result.film.pixel(x, y).passes, 1u) << x << " " << y;
}

// Takes time by the sample, as integrators do.
class SlowSamples final : public PixelIntegrator {
 public:
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    std::this_thread::sleep_for(out.size() * std::chrono::microseconds(50));
    for (PixelSample& s : out) s.radiance = gray_rgb(1.0f);
    samples_ += int(out.size());
    if (pass.grid) stride_ = pass.grid->stride;
    return {out.size(), 0, 0};
  }
  int samples() const { return samples_; }

 private:
  mutable std::atomic<int> samples_{0}, stride_{1};
};

TEST(Render, the_speed_is_measured_on_a_part_of_the_pixels) {
  RenderSettings s;
  s.image.bounds = {0, 0, 400, 300}, s.image.width = 400, s.image.height = 300, s.threads = 1;
  const SlowSamples slow;  // a sample of every pixel takes 6 s
  RenderObserver silent;
  const TimedPlan timed = plan_for_time(slow, s, 1, silent);
  EXPECT_LT(slow.samples(), 400 * 300 / 8);
  EXPECT_GT(timed.sample_seconds, 5.9);
  EXPECT_GE(timed.plan.stride, 2);
  EXPECT_EQ(timed.plan.samples_per_pass, 1);
}

TEST(Render, less_time_than_a_sample_of_every_pixel_gives_a_sparse_picture) {
  RenderSettings s;
  s.image.bounds = {3, 5, 203, 105}, s.image.width = 210, s.image.height = 110, s.threads = 1;
  s.plan = {1, 1}, s.plan.stride = 7;
  const SlowSamples slow;
  RenderObserver silent;
  const RenderResult result = render(slow, s, silent);
  EXPECT_EQ(slow.samples(), 29 * 15);
  EXPECT_EQ(result.film.image().passes, 1);
  for (int y = 5; y < 105; ++y)
    for (int x = 3; x < 203; ++x) EXPECT_EQ(result.film.pixel(x, y).mean[0], 1) << x << " " << y;
}

// The cells of a sparse picture are the pixels of the whole one, bit for bit.
TEST(Render, sparse_pixels_are_those_of_the_whole_picture) {
  RenderSettings s = scene().settings(PointSetKind::independent, {2, 1}, 5, 1);
  s.image.sharing = nullptr;  // as those of a sparse one have none
  const ChosenIntegrator chosen = scene().integrator("path");
  RenderObserver silent;
  const Film whole = render(chosen.any(), s, silent).film;
  s.plan.stride = 3;
  const Film sparse = render(chosen.any(), s, silent).film;
  int sampled = 0;
  for (int y = 0; y < s.image.height; ++y)
    for (int x = 0; x < s.image.width; ++x) {
      if (!sparse.is_sampled(x, y)) continue;
      ++sampled;
      EXPECT_EQ(sparse.pixel(x, y).mean[0], whole.pixel(x, y).mean[0]) << x << " " << y;
    }
  EXPECT_EQ(sampled, 16 * 14);
}

// Traces until its caller wants to stop, as a path through a costly material does.
class Endless final : public PixelIntegrator {
 public:
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    if (pass.tile.x0 == 0 && pass.tile.y0 == 0) {
      for (int i = 0; i < 10000 && !pass.stop_requested(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (PixelSample& s : out) s.radiance = gray_rgb(1.0f);
    return {out.size(), 0, 0};
  }
};

TEST(Render, a_request_to_stop_drops_the_unit_in_work) {
  const Endless endless;
  class Stop final : public RenderObserver {
    bool stop_requested() override { return true; }
  } stop;
  const RenderResult result = render(endless, slow_settings({2, 1}, 2), stop);
  EXPECT_TRUE(result.interrupted);
  EXPECT_LT(result.seconds, 5);  // 10 s by itself
  EXPECT_EQ(result.film.samples(0, 0), 0);
  EXPECT_EQ(result.film.image().passes, 0);
}

// Also the pass that measures the speed may take long.
TEST(Render, a_request_to_stop_is_heard_while_the_speed_is_measured) {
  class Stop final : public RenderObserver {
    bool stop_requested() override { return true; }
  } stop;
  const Slow slow(std::chrono::milliseconds(50));
  RenderSettings s = slow_settings({}, 1);
  plan_for_time(slow, s, 1, stop);
  EXPECT_LT(slow.calls(), 6);  // of the six tiles
}

TEST(Render, plans_take_the_samples_requested_in_passes_of_a_power_of_two) {
  for (const NamedPointSet& set : point_set_names)
    for (int samples : {1, 2, 7, 16, 64, 100, 256, 1000, 4096, 100000}) {
      const PassPlan plan = plan_passes(samples, set.kind);
      EXPECT_GE(plan.samples(), samples);
      EXPECT_LT(plan.samples(), samples + plan.samples_per_pass);
      EXPECT_EQ(plan.samples_per_pass & (plan.samples_per_pass - 1), 0);
      if (samples >= 8) {
        EXPECT_GE(plan.passes, 8) << set.name << ", " << samples;
      }
      // No more than are needed: longer point sets have less noise.
      if (samples <= 4096 && set.kind != PointSetKind::independent) {
        EXPECT_LE(plan.passes, std::has_single_bit(unsigned(samples)) ? 8 : 16) << set.name << ", " << samples;
      }
    }
}

}  // namespace montelux::test
