// Photon mapping shows what path tracing shows where its kernel is small, and faults in what makes up its estimate are
// found.
#include <gtest/gtest.h>

#include "integrator/photons/gathering.h"
#include "integrator/photons/sppm.h"
#include "integrator/photons/tracing.h"
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
  PhotonMap map(paths, 1);
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
    map.count(box, radius);
    map.lay_out(radius);
    map.deal(0);
    map.put_in_order(0, 1, 1);
    Film film(s.image.bounds);
    std::vector<PixelSample> samples(std::size_t(s.image.bounds.area()));
    PhotonGathering<F, Accel>(scene.scene(), scene.accel(), settings.gathering(), PhotonLookup(map, settings.kernel))
        .run({s.image.bounds, points}, samples);
    std::vector<PixelPass> pixels(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) pixels[i].add(samples[i]);
    film.add_pass(s.image.bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
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
  const Comparison c = compared(measured(scene, small, 8, 40, 2), measured(scene, "path", 16, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(Photons, end_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2, 3}) {
    const std::string most = "maxdepth=" + std::to_string(depth);
    for (const char* nee : {",nee=on,", ",nee=off,"}) {
      const Comparison c =
          compared(measured(scene, small + nee + most, 8, 40, 2), measured(scene, "path:" + most, 16, 60, 1));
      EXPECT_FALSE(c.differ()) << nee << depth << ": " << c.smallest << " of " << c.tests;
    }
  }
  EXPECT_TRUE(compared(measured(scene, small + ",maxdepth=2", 8, 40, 2), measured(scene, "path:maxdepth=3", 16, 60, 1))
                  .differ());
}

TEST(Photons, have_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(room(lens, gaussian));
  const auto film = [&](const char* way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {3, 2}, 5, threads), silent).film;
  };
  const Film one = film("sppm:radius=0.1", 1);
  for (const auto& [way, threads] :
       {std::pair("sppm:radius=0.1", 2), std::pair("sppm:radius=0.1", 5), std::pair("sppm:radius=0.1,lanes=one", 1)}) {
    const Film other = film(way, threads);
    for (int y = 0; y < one.bounds().y1; ++y)
      for (int x = 0; x < one.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c) ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << way;
  }
}

}  // namespace
}  // namespace montelux::test
