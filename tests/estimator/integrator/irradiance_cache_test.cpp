// The irradiance cache shows what path tracing shows where its records are dense, and faults in what makes up its
// estimate are found.
#include <gtest/gtest.h>

#include "box_rooms.h"
#include "integrator/irradiance_cache/filling.h"
#include "light_room.h"

namespace montelux::test {
namespace {

// So dense that the bias is far below the noise of these tests.
const std::string dense = "irradiance-cache:accuracy=0.05,min-spacing=1e-4,samples=64";

// What is planted in the records of a pass.
struct Fault {
  float irradiance = 1;  // a factor
  bool swapped = false;  // components of colour
};
// Passes of one frame each, with a fault in the records.
PassMeans by_hand(const TestScene& scene, int passes, std::uint32_t seed, const Fault& fault = {}) {
  using F = NativeFloats;
  IrradianceCacheSettings settings;
  settings.accuracy = 0.05f, settings.min_spacing = 1e-4f, settings.max_spacing = 0.2f, settings.samples = 64;
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {1, 1}, seed);
  const PixelBounds& all = s.image.bounds;
  PassMeans means;
  for (int number = 0; number < passes; ++number) {
    CacheFilling<F, Accel> filling(scene.scene(), scene.accel(), settings, {all, s.image.points(number, 1)});
    for (int stage = 0; stage < CacheFilling<F, Accel>::stages; ++stage) {
      const std::optional<std::size_t> units = filling.units(0, stage);
      if (!units) filling.run(0, stage, all);
      for (std::size_t i = 0; i < units.value_or(0); ++i) filling.run_unit(0, stage, i);
    }
    IrradianceCache cache({settings.accuracy, settings.min_spacing, settings.max_spacing});
    for (CacheRecord record : filling.cache().records()) {
      record.irradiance = record.irradiance * fault.irradiance;
      if (fault.swapped) std::swap(record.irradiance[0], record.irradiance[1]);
      cache.insert(record);
    }
    Film film(all);
    std::vector<PixelSample> samples(std::size_t(all.area()));
    const TilePass pass = filling.request(0, all);
    FirstHits<F> starts(scene.scene(), scene.accel(), pass, samples);
    CachedPaths<F, FirstHits<F>> paths(starts, cache, samples.size(), false);
    PathSettings settings_of_path = filling.path();
    run_cache_paths<F>(scene.scene(), scene.accel(), settings_of_path, pass, samples, paths, no_tally);
    std::vector<PixelPass> pixels(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) pixels[i].add(samples[i]);
    film.add_pass(all, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}

TEST(IrradianceCache, agrees_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const std::string& way : {dense, dense + ",gradients=off", dense + ",clamping=off,roulette-depth=0"}) {
    const Comparison c = compared(measured(scene, way, 4, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  constexpr int passes = 80;
  EXPECT_FALSE(caught(by_hand(scene, passes, 3)));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.irradiance = std::numbers::pi_v<float>})));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.irradiance = 0.8f})));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.swapped = true})));
}

// A fog that glows, with a cloud and a lamp in it, in a box of walls.
TEST(IrradianceCache, agrees_with_path_in_media_and_planted_faults_are_found) {
  std::string text = foggy_room();
  const std::size_t fog = text.find("\"float g\" 0.4");
  text.insert(fog, "\"rgb Le\" [ 0.5 1 0.2 ] ");
  const TestScene scene(text, ".", std::pair(16, 16));
  const PassMeans path = measured(scene, "path", 32, 100, 1);
  const Comparison c = compared(measured(scene, dense, 8, 60, 2), path);
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  constexpr int passes = 200;
  EXPECT_FALSE(caught(by_hand(scene, passes, 3)));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.irradiance = 0.7f})));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.swapped = true})));
}

TEST(IrradianceCache, ends_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2, 3}) {
    const std::string limit = "maxdepth=" + std::to_string(depth);
    const Comparison c =
        compared(measured(scene, dense + "," + limit, 4, 40, 2), measured(scene, "path:" + limit, 16, 60, 1));
    EXPECT_FALSE(c.differ()) << depth << ": " << c.smallest << " of " << c.tests;
  }
  EXPECT_TRUE(compared(measured(scene, dense + ",maxdepth=2", 4, 40, 2), measured(scene, "path:maxdepth=3", 16, 60, 1))
                  .differ());
}

TEST(IrradianceCache, has_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(room(lens, gaussian));
  const auto film = [&](const std::string& settings, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator("irradiance-cache:samples=40,min-spacing=0.01" + settings);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {3, 2}, 5, threads), silent).film;
  };
  const Film one = film("", 1);
  for (const auto& [settings, threads] : {std::pair("", 2), std::pair("", 5), std::pair(",lanes=one", 1)}) {
    const Film other = film(settings, threads);
    for (int y = 0; y < one.bounds().y1; ++y)
      for (int x = 0; x < one.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c)
          ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << threads << settings;
  }
}

}  // namespace
}  // namespace montelux::test
