// Photon mapping shows what path tracing shows where its kernel is small, and faults in what makes up its estimate are
// found.
#include <gtest/gtest.h>

#include "integrator/photons/filling.h"
#include "integrator/photons/gathering.h"
#include "integrator/photons/photonmap.h"
#include "integrator/photons/sppm.h"
#include "light_room.h"

namespace montelux::test {
namespace {

// So small that its bias is far below the noise of these tests.
const std::string small = "sppm:radius=0.02,photons=16384";

struct NoCorrection {
  template <class F>
  F operator()(const Vec3<F>&, F, const Vec3<F>&, F) const {
    return F(1.0f);
  }
};
const std::string gathering = "photonmap:radius=0.02,caustic-radius=0.02,photons=16384,caustic-photons=16384";

// What is planted in the photons of a frame.
struct Fault {
  bool twice = false;         // every second photon is stored twice
  bool direct_twice = false;  // photons straight from the light, beside next-event estimation
  float flux = 1;             // a factor of the flux
};

// Passes of one frame each, as sppm makes them, by another correction for shading normals or with a fault.
template <class Correction = AdjointCorrection>
PassMeans by_hand(const TestScene& scene, int passes, std::uint32_t seed, const Fault& fault = {}) {
  using F = NativeFloats;
  using Sink = PhotonSink<F>;
  constexpr std::uint32_t paths = 16384;
  constexpr float radius = 0.02f;
  const SppmSettings settings;
  const AliasTable by_power = scene.scene().lights.by_power();
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {1, 1}, seed);
  PassMeans means;
  PhotonMap map(1);
  for (int number = 0; number < passes; ++number) {
    const PointSet points = s.image.points(number, 1);
    std::vector<Photon>& box = map.box(0);
    box.clear();
    const LightWalkScene<Accel> walk{
        scene.scene(), scene.accel(), by_power, photon_points(points, 0, paths), scene.scene().shutter, {}, {}, 2};
    Sink sink(box, fault.direct_twice ? 0 : 1, fault.flux / float(paths));
    RayCounts counts;
    LightWalk<F, Accel, Sink, Correction>(walk, sink, counts).run(paths, [](std::uint32_t i) {
      return PathSite<float>{0, 0, i};
    });
    const std::size_t stored = box.size();
    for (std::size_t i = 0; fault.twice && i < stored; i += 2) box.push_back(Photon(box[i]));
    map.arrange(radius);
    Film film(s.image.bounds);
    std::vector<PixelSample> samples(std::size_t(s.image.bounds.area()));
    PhotonGathering<F, Accel>(scene.scene(), scene.accel(), settings.gathering(),
                              PhotonLookups{PhotonLookup(map, settings.kernel)})
        .run({s.image.bounds, points}, samples);
    std::vector<PixelPass> pixels(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) pixels[i].add(samples[i]);
    film.add_pass(s.image.bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}

// What is planted in a final gathering.
struct GatheringFault {
  bool all_in_view = false;       // photons of all paths at the surfaces in view, not those of caustics alone
  bool direct_twice = false;      // caustics with the photons straight from the light
  bool no_direct_beyond = false;  // the global map without those
  float glossy_of_caustics = 4;   // other directions than those that paths from the eye follow
};
// Passes of one frame each, as photonmap makes them, with a fault.
PassMeans gathered_by_hand(const TestScene& scene, int passes, std::uint32_t seed, const GatheringFault& fault = {}) {
  using F = NativeFloats;
  using Filling = PhotonFilling<F, Accel>;
  constexpr std::uint32_t paths = 16384;
  constexpr float radius = 0.02f;
  const PhotonMapSettings settings;
  const PhotonLights lights = photon_lights(scene.scene(), scene.accel());
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {1, 1}, seed);
  const std::optional<float> glossy = fault.all_in_view ? std::nullopt : std::optional(fault.glossy_of_caustics);
  PassMeans means;
  for (int number = 0; number < passes; ++number) {
    const SeriesPass pass{s.image.bounds, s.image.points(number, 1)};
    Filling global(scene.scene(), scene.accel(), lights, pass, {paths, fault.no_direct_beyond ? 1u : 0u, {}, 2, {}});
    Filling caustics(scene.scene(), scene.accel(), lights, pass, {paths, fault.direct_twice ? 0u : 1u, {}, 2, glossy});
    for (int stage = 0; stage < Filling::stages; ++stage) {
      for (std::size_t i = 0; i < global.units(stage); ++i) global.run_unit({0, radius, 0, {}}, stage, i);
      for (std::size_t i = 0; i < caustics.units(stage); ++i) caustics.run_unit({1, radius, 0, {}}, stage, i);
    }
    Film film(s.image.bounds);
    std::vector<PixelSample> samples(std::size_t(s.image.bounds.area()));
    PhotonGathering<F, Accel>(scene.scene(), scene.accel(), settings.gathering(), caustics.lookups(settings.kernel),
                              global.lookups(settings.kernel))
        .run({s.image.bounds, pass.points}, samples);
    std::vector<PixelPass> pixels(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) pixels[i].add(samples[i]);
    film.add_pass(s.image.bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}

TEST(PhotonGathering, agrees_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const char* more : {"", ",nee=off", ",gather-rays=1,kernel=cone", ",gather-rays=0", ",glossy=0.5"}) {
    const Comparison c = compared(measured(scene, gathering + more, 8, 40, 2), path);
    EXPECT_FALSE(c.differ()) << more << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const GatheringFault& fault) {
    return compared(gathered_by_hand(scene, 200, 3, fault), path).differ();
  };
  EXPECT_FALSE(caught({}));
  EXPECT_TRUE(caught({.all_in_view = true}));
  EXPECT_TRUE(caught({.direct_twice = true}));
  EXPECT_TRUE(caught({.no_direct_beyond = true}));
  EXPECT_TRUE(caught({.glossy_of_caustics = 0.2f}));
}

// Caustics of a glossy metal are those of the directions that paths from the eye follow, and of no others.
TEST(PhotonGathering, agrees_with_path_where_a_glossy_metal_reflects_light) {
  const TestScene scene(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 1.5 -0.5   0 0 0.3   0 1 0
Camera "perspective" "float fov" 50
WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 9 6 3 ]
  Material "diffuse" "rgb reflectance" [ 0 0 0 ]
  Translate -0.5 0.8 -0.6
  Shape "sphere" "float radius" 0.2
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.6 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Material "conductor" "float roughness" 0.08 "bool remaproughness" false
Shape "bilinearmesh" "point3 P" [ -1 0 0.8  1 0 0.8  -1 1 1  1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.3 0.5 0.8 ]
Shape "bilinearmesh" "point3 P" [ 0.9 0 -1  0.9 0 1  0.9 1 -1  0.9 1 1 ]
)");
  const PassMeans path = measured(scene, "path", 32, 60, 1);
  for (const char* glossy : {"1e30", "4", "0.5"}) {
    const Comparison c = compared(measured(scene, gathering + ",glossy=" + glossy, 8, 40, 2), path);
    EXPECT_FALSE(c.differ()) << glossy << ": " << c.smallest << " of " << c.tests;
  }
  EXPECT_FALSE(compared(gathered_by_hand(scene, 200, 3), path).differ());
  EXPECT_TRUE(compared(gathered_by_hand(scene, 200, 3, {.glossy_of_caustics = 0.5f}), path).differ());
  EXPECT_TRUE(compared(gathered_by_hand(scene, 200, 3, {.glossy_of_caustics = 40}), path).differ());
}

TEST(Photons, agree_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const std::string& way : {small, small + ",nee=off", small + ",kernel=constant,glossy=0.5"}) {
    const Comparison c = compared(measured(scene, way, 8, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  constexpr int passes = 300;
  EXPECT_FALSE(caught(by_hand(scene, passes, 3)));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.twice = true})));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.direct_twice = true})));
  // Flux that is not divided by the number of paths; an area of the kernel that is pi r.
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.flux = 16384})));
  EXPECT_TRUE(caught(by_hand(scene, passes, 3, {.flux = 0.02f})));
}

// A wall that is lit by a floor alone, whose shading normals lean far to one side.
TEST(Photons, agree_with_path_at_shading_normals_and_need_their_correction) {
  const TestScene scene(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 0.7 -0.5   0 0.7 1   0 1 0
Camera "orthographic" "float screenwindow" [ -0.6 0.6 -0.6 0.6 ]
WorldBegin
LightSource "spot" "rgb I" [ 9 6 3 ] "point3 from" [ 0 1.9 -0.9 ] "point3 to" [ 0 0 0 ] "float coneangle" 25
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.6 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -1 0 -1  -1 0 1  1 0 1  1 0 -1 ]
  "normal N" [ -1 1 1  -1 1 1  1 1 0.5  1 1 0.5 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -1 0 1  1 0 1  -1 2 1  1 2 1 ]
)");
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  EXPECT_FALSE(compared(by_hand(scene, 200, 3), path).differ());
  EXPECT_TRUE(compared(by_hand<NoCorrection>(scene, 200, 3), path).differ());
}

TEST(Photons, agree_with_path_where_things_move) {
  std::string text = room(lens, gaussian);
  text.insert(text.find("LookAt"), "ActiveTransform EndTime\nTranslate 0.3 0 0\nActiveTransform All\n");
  text.resize(text.find("Material \"dielectric\""));
  text +=
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 0.8 0\nActiveTransform All\nMaterial \"diffuse\"\n"
      "Translate 0.4 0.2 -0.4\nShape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n";
  const TestScene scene(text);
  ASSERT_TRUE(scene.scene().moves());
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const std::string& way : {small, gathering}) {
    const Comparison c = compared(measured(scene, way, 8, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
}

TEST(Photons, end_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2, 3}) {
    const std::string limit = "maxdepth=" + std::to_string(depth);
    const PassMeans path = measured(scene, "path:" + limit, 16, 60, 1);
    for (const std::string& way : {small, small + ",nee=off", gathering, gathering + ",nee=off"}) {
      const Comparison c = compared(measured(scene, way + "," + limit, 8, 40, 2), path);
      EXPECT_FALSE(c.differ()) << way << depth << ": " << c.smallest << " of " << c.tests;
    }
  }
  EXPECT_TRUE(compared(measured(scene, small + ",maxdepth=2", 8, 40, 2), measured(scene, "path:maxdepth=3", 16, 60, 1))
                  .differ());
}

TEST(Photons, have_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(room(lens, gaussian));
  const auto film = [&](const std::string& way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {3, 2}, 5, threads), silent).film;
  };
  for (const std::string way :
       {"sppm:radius=0.1", "photonmap:radius=0.1,caustic-radius=0.1,gather-rays=3", "photonmap:radius=0.1,nearest=9"}) {
    const Film one = film(way, 1);
    for (const auto& [more, threads] : {std::pair("", 2), std::pair("", 5), std::pair(",lanes=one", 1)}) {
      const Film other = film(way + more, threads);
      for (int y = 0; y < one.bounds().y1; ++y)
        for (int x = 0; x < one.bounds().x1; ++x)
          for (int c = 0; c < rgb_size; ++c)
            ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << way << more << ", " << threads;
    }
  }
}

}  // namespace
}  // namespace montelux::test
