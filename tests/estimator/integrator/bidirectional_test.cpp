// Bidirectional path tracing shows what path tracing shows, likewise with mergings of a small radius, and faults in its
// weights and corrections are found.
#include <gtest/gtest.h>

#include "box_rooms.h"
#include "integrator/bidirectional/eye_subpaths.h"
#include "light_room.h"

namespace montelux::test {
namespace {

// One pass as `bdpt` makes it, with other weights or another correction for the adjoint; splats count `splats` times.
template <class Correction = AdjointCorrection, class Weights = StrategyWeights, bool in_media = false>
PassMeans by_hand(const TestScene& scene, int per_pass, int passes, std::uint32_t seed, float splats = 1) {
  using F = NativeFloats;
  using Frame = BidirectionalFrame<Accel, Weights>;
  PassMeans means;
  const AliasTable by_power = scene.scene().lights.by_power();
  const auto media = light_media(scene.scene(), scene.accel());
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {per_pass, 1}, seed);
  const PixelBounds& bounds = s.image.bounds;
  for (int number = 0; number < passes; ++number) {
    const SeriesPass pass{bounds, s.image.points(number, per_pass), {}, {}};
    SplatPlane plane(bounds, scene.scene().filter);
    Film film(bounds);
    std::vector<PixelPass> pixels(std::size_t(bounds.area()));
    for (int i = 0; i < per_pass; ++i) {
      const Frame frame{scene.scene(),
                        scene.accel(),
                        &by_power,
                        pass,
                        std::uint32_t(i),
                        {},
                        BidirectionalPaths{},
                        Weights(true),
                        false,
                        plane,
                        std::uint32_t(bounds.area()),
                        media ? &*media : nullptr};
      RayCounts counts;
      const LightVertices light = light_vertices<F, Correction, in_media>(frame, bounds, Splatting::on, counts);
      std::vector<PixelSample> samples(std::size_t(bounds.area()));
      EyeSubpaths<F, Frame, Correction, in_media>(frame, light).run(bounds, samples);
      for (int y = 0, k = 0; y < s.image.height; ++y)
        for (int x = 0; x < s.image.width; ++x, ++k) {
          const Rgb splat = plane.take(x, y);
          PixelSample& sample = samples[std::size_t(k)];
          for (int c = 0; c < rgb_size; ++c) sample.radiance.c[c] += splats * splat.c[c];
          pixels[std::size_t(k)].add(sample);
        }
    }
    film.add_pass(bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}

struct NoCorrection {
  template <class F>
  F operator()(const Vec3<F>&, F, const Vec3<F>&, F) const {
    return F(1.0f);
  }
};
// Refraction scales the flux of particles as it scales radiance.
struct RefractionScalesFlux {
  template <class F>
  F operator()(const Vec3<F>& in, F ng_in, const Vec3<F>& out, F ng_out) const {
    constexpr float eta = 1.5f;
    const F scale = select(in.z * out.z > F(0.0f), F(1.0f), select(in.z < F(0.0f), F(eta * eta), F(1 / (eta * eta))));
    return AdjointCorrection()(in, ng_in, out, ng_out) * scale;
  }
};
// Subpaths from the eye do not know that their first vertex could have been splatted.
struct WithoutLens : StrategyWeights {
  using StrategyWeights::StrategyWeights;
  template <class F>
  PartialWeights<F> first_from_lens(Density<Area, F>, F, float, F) const {
    return {F(0.0f), F(0.0f), F(0.0f)};
  }
};
// A density per steradian is taken for one per area.
struct WrongMeasure : StrategyWeights {
  using StrategyWeights::StrategyWeights;
  template <class F>
  F connection(const PartialWeights<F>& eye, const BothDensities<F>& at_eye, F, const PartialWeights<F>& light,
               const BothDensities<F>& at_light, F, F, F) const {
    return StrategyWeights::connection(eye, at_eye, F(1.0f), light, at_light, F(1.0f), F(1.0f));
  }
};
// A light that was sampled is not told from one that was met.
struct WithoutMeeting : StrategyWeights {
  using StrategyWeights::StrategyWeights;
  template <class F>
  F met(const PartialWeights<F>&, const LightEnd<F>&, F) const {
    return F(1.0f);
  }
};

TEST(Bidirectional, agrees_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const char* way : {"bdpt", "bdpt:mis=balance", "bdpt:roulette-depth=0"}) {
    const Comparison c = compared(measured(scene, way, 16, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  EXPECT_FALSE(caught(by_hand(scene, 16, 40, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, WithoutLens>(scene, 16, 40, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, WrongMeasure>(scene, 16, 40, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, WithoutMeeting>(scene, 16, 40, 3)));
  EXPECT_TRUE(caught(by_hand(scene, 16, 40, 3, 2)));
}

// A wall that is lit by a floor alone, whose shading normals lean far to one side.
TEST(Bidirectional, agrees_with_path_at_shading_normals_and_needs_their_correction) {
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
  EXPECT_FALSE(compared(by_hand(scene, 16, 60, 3), path).differ());
  EXPECT_TRUE(compared(by_hand<NoCorrection>(scene, 16, 60, 3), path).differ());
}

TEST(Bidirectional, agrees_with_path_in_a_box_with_glass_and_metal) {
  const TestScene scene(box(ball("\"dielectric\"", -0.5, 0.1) + ball("\"conductor\" \"float roughness\" 0", 0.5, 0.5)));
  const Comparison c = compared(measured(scene, "bdpt", 16, 60, 2), measured(scene, "path", 64, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(Bidirectional, agrees_with_path_between_glossy_surfaces_of_every_sort) {
  const TestScene scene(box(ball("\"conductor\" \"float roughness\" 0.1", -0.5, 0.1) +
                            ball("\"coatedconductor\" \"float conductor.roughness\" 0.3", 0.5, 0.5) +
                            "Material \"coateddiffuse\" \"rgb reflectance\" [ 0.2 0.3 0.8 ] \"float roughness\" 0\n"
                            "Shape \"bilinearmesh\" \"point3 P\" [ -0.9 0.01 -0.9  0.9 0.01 -0.9  -0.9 0.01 0.9  "
                            "0.9 0.01 0.9 ]\n"));
  const Comparison c = compared(measured(scene, "bdpt", 16, 60, 2), measured(scene, "path", 64, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

// A lamp within rough glass that is in view: subpaths meet within the glass.
TEST(Bidirectional, agrees_with_path_around_rough_glass_and_needs_the_adjoint_of_refraction) {
  const TestScene scene(
      box(ball("\"dielectric\" \"float roughness\" 0.4", -0.4, 0.2) +
          "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [ 8 4 2 ]\nMaterial \"diffuse\" \"rgb reflectance\" [ "
          "0.3 0.3 0.3 ]\nTranslate -0.4 0.45 0.2\nShape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n"));
  const PassMeans path = measured(scene, "path", 64, 60, 1);
  const Comparison c = compared(measured(scene, "bdpt", 16, 60, 2), path);
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
  EXPECT_TRUE(compared(by_hand<RefractionScalesFlux>(scene, 16, 40, 3), path).differ());
}

TEST(Bidirectional, agrees_with_path_for_every_camera_and_filter) {
  const std::pair<std::string, std::string> pairs[] = {
      {"Camera \"orthographic\" \"float screenwindow\" [ -0.9 0.9 -0.6 0.6 ]", "\"box\""},
      {"Camera \"orthographic\" \"float screenwindow\" [ -0.9 0.9 -0.6 0.6 ] \"float lensradius\" 0.1 \"float "
       "focaldistance\" 2",
       "\"mitchell\""},
      {"Camera \"spherical\" \"string mapping\" \"equirectangular\"", "\"gaussian\""},
      {"Camera \"spherical\" \"string mapping\" \"equalarea\"", "\"triangle\""},
      {"Camera \"perspective\" \"float fov\" 90", "\"sinc\""}};
  for (const auto& [camera, filter] : pairs) {
    SCOPED_TRACE(camera);
    const TestScene scene(room(camera, filter));
    const PassMeans path = measured(scene, "path", 16, 80, 1), both = measured(scene, "bdpt", 16, 60, 2);
    const Comparison c = compared(both, path);
    EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
    PassMeans more = both;
    for (auto& values : more.values)
      for (double& x : values) x *= 1.05;
    EXPECT_TRUE(compared(more, path).differ());
  }
}

// Rays through the centres of pixels alone find what paths from the eye find; nothing is splatted.
TEST(Bidirectional, agrees_with_path_without_a_pixel_filter) {
  const TestScene scene("Option \"bool disablepixeljitter\" true\n" + room(lens, gaussian));
  const Comparison c = compared(measured(scene, "bdpt", 16, 40, 2), measured(scene, "path", 16, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(Bidirectional, agrees_with_path_where_things_move) {
  std::string text = room(lens, gaussian);
  text.insert(text.find("LookAt"), "ActiveTransform EndTime\nTranslate 0.3 0 0\nActiveTransform All\n");
  text +=
      "AttributeBegin\nActiveTransform EndTime\nTranslate 0 0.8 0\nActiveTransform All\nMaterial \"diffuse\"\n"
      "Translate 0.4 0.2 -0.4\nShape \"sphere\" \"float radius\" 0.2\nAttributeEnd\n";
  const TestScene scene(text);
  ASSERT_TRUE(scene.scene().moves());
  const Comparison c = compared(measured(scene, "bdpt", 16, 60, 2), measured(scene, "path", 16, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

// ---- participating media

// In clear air: a liquid in a ball of rough glass, and a cloud that surrounds a lamp.
const std::string& liquid_and_cloud() {
  static const std::string text = [] {
    std::string t = box("");
    t.insert(t.find("LookAt"), R"(MakeNamedMedium "milk" "string type" "homogeneous" "rgb sigma_a" [ 0 0.2 0.5 ]
  "rgb sigma_s" [ 4 2 1 ] "float g" 0.6
MakeNamedMedium "cloud" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.1 0.1 ] "rgb sigma_s" [ 1 2 3 ]
)");
    t += R"(AttributeBegin
Material "dielectric" "float roughness" 0.3
MediumInterface "milk" ""
Translate -0.45 0.45 0.2
Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Translate 0.45 0.9 0.3
AttributeBegin
Material "interface"
MediumInterface "cloud" ""
Shape "sphere" "float radius" 0.4
AttributeEnd
MediumInterface "cloud" "cloud"
AreaLightSource "diffuse" "rgb L" [ 20 15 10 ]
Material "diffuse" "rgb reflectance" [ 0.3 0.3 0.3 ]
Shape "sphere" "float radius" 0.1
AttributeEnd
)";
    return t;
  }();
  return text;
}

// The probability of passing a medium is that of the connection alone, but not of the others.
struct PassesOnce : StrategyWeights {
  using StrategyWeights::StrategyWeights;
  template <class F>
  PartialWeights<F> arrive(const PartialWeights<F>& w, F distance_squared, F cos, F) const {
    return StrategyWeights::arrive(w, distance_squared, cos, F(1.0f));
  }
};

TEST(BidirectionalInMedia, agrees_with_path_in_a_foggy_room_and_planted_faults_are_found) {
  const TestScene scene(foggy_room());
  const PassMeans path = measured(scene, "path", 32, 60, 1);
  for (const char* way : {"bdpt", "bdpt:mis=balance", "vcm:radius=0.02,photons=1024", "metropolis:strategies=bdpt"}) {
    const Comparison c = compared(measured(scene, way, 16, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  EXPECT_FALSE(caught(by_hand<AdjointCorrection, StrategyWeights, true>(scene, 16, 60, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, WithoutLens, true>(scene, 16, 60, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, PassesOnce, true>(scene, 16, 60, 3)));
  EXPECT_TRUE(caught(by_hand<AdjointCorrection, StrategyWeights, true>(scene, 16, 60, 3, 2)));
}

TEST(BidirectionalInMedia, agrees_with_path_in_a_liquid_and_around_a_lamp_in_a_cloud) {
  const TestScene scene(liquid_and_cloud());
  const PassMeans path = measured(scene, "path", 32, 60, 1);
  for (const char* way : {"bdpt", "vcm:radius=0.02,photons=1024"}) {
    const Comparison c = compared(measured(scene, way, 8, 60, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
}

TEST(BidirectionalInMedia, ends_where_maxdepth_says) {
  const TestScene scene(foggy_room());
  for (const int depth : {0, 1, 2}) {
    const std::string limit = ":maxdepth=" + std::to_string(depth);
    const Comparison c =
        compared(measured(scene, "bdpt" + limit, 16, 40, 2), measured(scene, "path" + limit, 32, 60, 1));
    EXPECT_FALSE(c.differ()) << depth << ": " << c.smallest << " of " << c.tests;
  }
}

TEST(Bidirectional, ends_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2, 3}) {
    const std::string limit = "maxdepth=" + std::to_string(depth);
    const PassMeans path = measured(scene, "path:" + limit, 16, 60, 1);
    for (const std::string way : {"bdpt:", "metropolis:strategies=bdpt,"}) {
      const Comparison c = compared(measured(scene, way + limit, 16, 40, 2), path);
      EXPECT_FALSE(c.differ()) << way << depth << ": " << c.smallest << " of " << c.tests;
    }
  }
  EXPECT_TRUE(
      compared(measured(scene, "bdpt:maxdepth=2", 16, 40, 2), measured(scene, "path:maxdepth=3", 16, 60, 1)).differ());
}

// The films of a scene are the same for one thread, several, and single lanes.
void expect_same_bits(const TestScene& scene) {
  const auto film = [&](const char* way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {4, 3}, 5, threads), silent).film;
  };
  const Film one = film("bdpt", 1);
  for (const auto& [way, threads] : {std::pair("bdpt", 2), std::pair("bdpt", 5), std::pair("bdpt:lanes=one", 1)}) {
    const Film other = film(way, threads);
    for (int y = 0; y < one.bounds().y1; ++y)
      for (int x = 0; x < one.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c) ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << way;
  }
}

TEST(Bidirectional, has_the_same_bits_for_any_number_of_threads_and_lanes) {
  expect_same_bits(TestScene(room(lens, gaussian)));
  expect_same_bits(TestScene(foggy_room() + R"(LightSource "spot" "rgb I" [ 2 3 4 ]
  "point3 from" [ 0.8 1.8 -0.8 ] "point3 to" [ -0.3 0 0.3 ]
)"));
}

// ---- vertex connection and merging

// So small that its bias is far below the noise of these tests, with so many photons that mergings have weight.
const std::string merging = "vcm:radius=0.02,photons=16384,alpha=1";

// What is planted in the weights of one pass, made as `vcm` makes it.
template <class Weights>
PassMeans merged_by_hand(const TestScene& scene, int passes, std::uint32_t seed) {
  using F = NativeFloats;
  using Frame = BidirectionalFrame<Accel, Weights>;
  constexpr std::uint32_t paths = 16384;
  constexpr float radius = 0.02f;
  PassMeans means;
  const AliasTable by_power = scene.scene().lights.by_power();
  const RenderSettings s = scene.settings(PointSetKind::blue_noise, {1, 1}, seed);
  const PixelBounds& bounds = s.image.bounds;
  PhotonMap map(1, true);
  for (int number = 0; number < passes; ++number) {
    const SeriesPass pass{bounds, s.image.points(number, 1), {}, {}};
    SplatPlane plane(bounds, scene.scene().filter);
    const Frame frame{scene.scene(),
                      scene.accel(),
                      &by_power,
                      pass,
                      0,
                      {},
                      BidirectionalPaths{},
                      Weights(true, pi * radius * radius * float(paths)),
                      false,
                      plane,
                      paths,
                      nullptr,
                      &map};
    RayCounts counts;
    std::vector<Photon>& photons = map.box(0);
    photons.clear();
    follow_light_subpaths<F>(
        frame, paths, [](std::uint32_t i) { return i; }, Splatting::on, counts,
        [&](const LightVertexView<F>& view, Mask<F> on) {
          const auto& v = view.vertex;
          const Spectrum<F> flux = v.path.flux * (1 / float(paths));
          for_each_lane(on, [&](int k) {
            photons.push_back({lane(v.at.x.point.p, k),
                               lane(-v.at.d, k),
                               lane(v.at.x.point.ng, k),
                               lane(flux, k),
                               lane(v.path.depth, k),
                               lane(v.path.site.index, k),
                               {lane(view.weights.vcm, k), lane(view.weights.vm, k)}});
          });
        });
    map.arrange(radius);
    const LightVertices light = light_vertices<F>(frame, bounds, Splatting::off, counts);
    std::vector<PixelSample> samples(std::size_t(bounds.area()));
    EyeSubpaths<F, Frame>(frame, light).run(bounds, samples);
    std::vector<PixelPass> pixels(samples.size());
    for (int y = 0, k = 0; y < s.image.height; ++y)
      for (int x = 0; x < s.image.width; ++x, ++k) {
        const Rgb splat = plane.take(x, y);
        PixelSample& sample = samples[std::size_t(k)];
        for (int c = 0; c < rgb_size; ++c) sample.radiance.c[c] += splat.c[c];
        pixels[std::size_t(k)].add(sample);
      }
    Film film(bounds);
    film.add_pass(bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}
// Mergings count in full beside connections.
struct MergedTwice : StrategyWeights {
  using StrategyWeights::StrategyWeights;
  template <class F>
  F merging(const PartialWeights<F>&, const PartialWeights<F>&, const BothDensities<F>&) const {
    return F(1.0f);
  }
};
// Connections do not know that their vertices could have been merged.
struct ForgottenMergings : StrategyWeights {
  ForgottenMergings(bool power, float merges) : StrategyWeights(power), whole_(power, merges) {}
  template <class F>
  F merging(const PartialWeights<F>& eye, const PartialWeights<F>& light, const BothDensities<F>& at_eye) const {
    return whole_.merging(eye, light, at_eye);
  }
  StrategyWeights whole_;
};

TEST(Merging, agrees_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(room(lens, gaussian));
  const PassMeans path = measured(scene, "path", 16, 60, 1);
  for (const std::string& way :
       {merging, merging + ",mis=balance", merging + ",kernel=constant", merging + ",connect=off"}) {
    const Comparison c = compared(measured(scene, way, 8, 40, 2), path);
    EXPECT_FALSE(c.differ()) << way << ": " << c.smallest << " of " << c.tests;
  }
  const auto caught = [&](const PassMeans& other) { return compared(other, path).differ(); };
  EXPECT_FALSE(caught(merged_by_hand<StrategyWeights>(scene, 200, 3)));
  EXPECT_TRUE(caught(merged_by_hand<MergedTwice>(scene, 200, 3)));
  EXPECT_TRUE(caught(merged_by_hand<ForgottenMergings>(scene, 200, 3)));
}

TEST(Merging, agrees_with_path_in_a_box_with_glass_and_metal) {
  const TestScene scene(box(ball("\"dielectric\"", -0.5, 0.1) + ball("\"conductor\" \"float roughness\" 0", 0.5, 0.5)));
  const Comparison c =
      compared(measured(scene, merging, 8, 60, 2), measured(scene, "path:roulette-depth=5", 256, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(Merging, agrees_with_path_where_things_move) {
  std::string text = room(lens, gaussian);
  text.insert(text.find("LookAt"), "ActiveTransform EndTime\nTranslate 0.3 0 0\nActiveTransform All\n");
  const TestScene scene(text);
  ASSERT_TRUE(scene.scene().moves());
  const Comparison c = compared(measured(scene, merging, 8, 60, 2), measured(scene, "path", 16, 60, 1));
  EXPECT_FALSE(c.differ()) << c.smallest << " of " << c.tests;
}

TEST(Merging, ends_where_maxdepth_says) {
  const TestScene scene(room(lens, gaussian));
  for (const int depth : {0, 1, 2, 3})
    for (const char* connect : {",connect=on", ",connect=off"}) {
      const std::string limit = "maxdepth=" + std::to_string(depth);
      const Comparison c = compared(measured(scene, merging + connect + "," + limit, 8, 40, 2),
                                    measured(scene, "path:" + limit, 16, 60, 1));
      EXPECT_FALSE(c.differ()) << connect << depth << ": " << c.smallest << " of " << c.tests;
    }
}

TEST(Merging, has_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(room(lens, gaussian));
  const auto film = [&](const char* way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {4, 3}, 5, threads), silent).film;
  };
  const Film one = film("vcm:radius=0.1", 1);
  for (const auto& [way, threads] :
       {std::pair("vcm:radius=0.1", 2), std::pair("vcm:radius=0.1", 5), std::pair("vcm:radius=0.1,lanes=one", 1)}) {
    const Film other = film(way, threads);
    for (int y = 0; y < one.bounds().y1; ++y)
      for (int x = 0; x < one.bounds().x1; ++x)
        for (int c = 0; c < rgb_size; ++c) ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << way;
  }
}

}  // namespace
}  // namespace montelux::test
