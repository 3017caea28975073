// Photons of events in media show what path tracing shows where their kernels are small, and faults in what makes up
// their estimate are found.
#include <gtest/gtest.h>

#include "integrator/photons/filling.h"
#include "integrator/photons/gathering.h"
#include "light_room.h"

namespace montelux::test {
namespace {

// A coloured room filled with coloured fog, with a lamp, a glass ball and a glossy wall.
const char* const foggy_room = R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
LookAt 0 0 -2.4  0 0 0  0 1 0
Camera "perspective" "float fov" 60
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .05 .1 .02 ] "rgb sigma_s" [ .4 .8 .2 ] "float g" 0.4
WorldBegin
AttributeBegin
Material "interface"
MediumInterface "fog" ""
Shape "trianglemesh" "integer indices" [ 0 2 1  1 2 3  4 5 6  5 7 6  0 1 4  1 5 4  2 6 3  3 6 7  0 4 2  2 4 6  1 3 5  3 7 5 ]
  "point3 P" [ -.99 -.99 -1.2  .99 -.99 -1.2  -.99 .99 -1.2  .99 .99 -1.2
               -.99 -.99 .99   .99 -.99 .99   -.99 .99 .99   .99 .99 .99 ]
AttributeEnd
AttributeBegin
  MediumInterface "fog" "fog"
  AreaLightSource "diffuse" "rgb L" [ 8 7 5 ]
  Shape "bilinearmesh" "point3 P" [ -.3 .95 -.3  .3 .95 -.3  -.3 .95 .3  .3 .95 .3 ]
AttributeEnd
AttributeBegin
  MediumInterface "" "fog"
  Material "dielectric"
  Translate 0.4 -0.5 0.2
  Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 1  1 -1 1  -1 1 1  1 1 1 ]
Material "conductor" "float roughness" 0.4
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1 ]
)";
constexpr const char* in_general = "sppm:radius=0.03,medium-radius=0.06,photons=8192";
constexpr const char* gathered =
    "photonmap:radius=0.03,caustic-radius=0.03,medium-radius=0.06,photons=8192,caustic-photons=8192";

// What is planted in the photons of events.
struct Fault {
  bool no_directions = false;  // as if the phase function were left out
  bool undivided = false;      // by the scattering coefficient
  bool direct_twice = false;   // photons straight from the light, beside next-event estimation
};
// What is planted in the second events on segments: the first ones count in full beside them; they are left out.
template <class F, class Rays, class Add>
struct UnsharedSegmentLights : RaySegmentLights<F, Rays, Add> {
  using RaySegmentLights<F, Rays, Add>::RaySegmentLights;
  F share(const auto&...) const { return F(1.0f); }
};
struct NoSegmentLight {
  void operator()(const auto&...) const {}
};
template <class F, class Rays, class Add>
struct UnseenSegmentLights : RaySegmentLights<F, Rays, NoSegmentLight> {
  UnseenSegmentLights(const Scene& scene, const Rays& rays, Mask<F> on, std::uint64_t& traced, const Add&)
      : RaySegmentLights<F, Rays, NoSegmentLight>(scene, rays, on, traced, {}) {}
};
template <template <class, class, class> class Segments = RaySegmentLights>
PassMeans by_hand(const TestScene& scene, int passes, std::uint32_t seed, const Fault& fault = {}) {
  using F = NativeFloats;
  using Sink = PhotonSink<F>;
  constexpr std::uint32_t paths = 8192;
  const SppmSettings settings;
  const Scene& s = scene.scene();
  const PhotonLights lights = photon_lights(s, scene.accel());
  const RenderSettings render = scene.settings(PointSetKind::blue_noise, {1, 1}, seed);
  PassMeans means;
  PhotonMap surfaces(1), events(1);
  RandomStream<float> random(seed, 5);
  const Spectrum<float> scattering = s.media.scattering<float>(1u);
  for (int number = 0; number < passes; ++number) {
    const PointSet points = render.image.points(number, 1);
    surfaces.box(0).clear(), events.box(0).clear();
    const LightWalkScene<Accel> walk{
        s, scene.accel(),          *lights.by_power, photon_points(points, 0, paths), s.shutter, {}, {},
        2, Densities::for_weights, &*lights.media};
    Sink sink(surfaces.box(0), fault.direct_twice ? 0 : 1, 1 / float(paths), nullptr,
              MediumBox{s.media, events.box(0)});
    RayCounts counts;
    LightWalk<F, Accel, Sink, AdjointCorrection, true>(walk, sink, counts).run(paths, [](std::uint32_t i) {
      return PathSite<float>{0, 0, i};
    });
    for (Photon& photon : events.box(0)) {
      if (fault.undivided) photon.flux = photon.flux * scattering;
      if (!fault.no_directions) continue;
      const float z = 2 * random.next() - 1, angle = 2 * pi * random.next(), r = std::sqrt(1 - z * z);
      photon.wi = {r * std::cos(angle), r * std::sin(angle), z};
    }
    for (const auto& [map, radius] : {std::pair(&surfaces, 0.03f), std::pair(&events, 0.06f)}) map->arrange(radius);
    Film film(render.image.bounds);
    std::vector<PixelSample> samples(std::size_t(render.image.bounds.area()));
    PhotonGathering<F, Accel, true, Segments>(
        s, scene.accel(), settings.gathering(),
        PhotonLookups{PhotonLookup(surfaces, settings.kernel), PhotonLookup(events, settings.kernel)})
        .run({render.image.bounds, points}, samples);
    std::vector<PixelPass> pixels(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) pixels[i].add(samples[i]);
    film.add_pass(render.image.bounds, 0, pixels);
    add_pass(film, {}, means);
  }
  return means;
}

TEST(PhotonsInFog, agree_with_path_in_a_coloured_room_and_planted_faults_are_found) {
  const TestScene scene(foggy_room);
  const PassMeans path = measured(scene, "path", 32, 100, 1);
  for (const std::string way : {in_general, gathered})
    for (const char* more : {"", ",nee=off", ",glossy=0.2,kernel=cone"}) {
      const Comparison c = compared(measured(scene, way + more, 8, 40, 2), path);
      EXPECT_FALSE(c.differ()) << way << more << ": " << c.smallest << " of " << c.tests;
    }
  const auto caught = [&](const Fault& fault) { return compared(by_hand(scene, 200, 3, fault), path).differ(); };
  EXPECT_FALSE(caught({}));
  EXPECT_TRUE(caught({.no_directions = true}));
  EXPECT_TRUE(caught({.undivided = true}));
  EXPECT_TRUE(caught({.direct_twice = true}));
}

// Direct light alone is unbiased. One lamp is behind an interface, another one before it.
TEST(PhotonsInFog, have_the_light_of_lamps_at_one_point_and_planted_faults_are_found) {
  const TestScene scene(fog_with_cloud +
                        "LightSource \"spot\" \"rgb I\" [ 20 10 20 ] \"point3 from\" [ -0.4 1.2 -1.2 ] "
                        "\"point3 to\" [ 0 0 0 ]\n");
  PassMeans path;
  for (const std::string limit : {"maxdepth=1", "maxdepth=none"}) {
    path = measured(scene, "path:" + limit, 16, 80, 1);
    for (const std::string way : {in_general, gathered}) {
      const Comparison c = compared(measured(scene, way + "," + limit, 16, 80, 2), path);
      EXPECT_FALSE(c.differ()) << way << limit << ": " << c.smallest << " of " << c.tests;
    }
  }
  EXPECT_FALSE(compared(by_hand(scene, 200, 4), path).differ());
  EXPECT_TRUE(compared(by_hand<UnsharedSegmentLights>(scene, 200, 4), path).differ());
  EXPECT_TRUE(compared(by_hand<UnseenSegmentLights>(scene, 200, 4), path).differ());
}

TEST(PhotonsInFog, end_where_maxdepth_says) {
  const TestScene scene(foggy_room);
  for (const int depth : {1, 2}) {
    const std::string limit = "maxdepth=" + std::to_string(depth);
    const PassMeans path = measured(scene, "path:" + limit, 32, 60, 1);
    for (const std::string way : {in_general, gathered})
      for (const char* more : {",", ",nee=off,"}) {
        const Comparison c = compared(measured(scene, way + more + limit, 8, 40, 2), path);
        EXPECT_FALSE(c.differ()) << way << more << depth << ": " << c.smallest << " of " << c.tests;
      }
  }
}

TEST(PhotonsInFog, have_the_same_bits_for_any_number_of_threads_and_lanes) {
  const TestScene scene(foggy_room);
  const auto film = [&](const std::string& way, int threads) {
    RenderObserver silent;
    const ChosenIntegrator chosen = scene.integrator(way);
    return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {3, 2}, 5, threads), silent).film;
  };
  for (const std::string way : {"sppm:medium-radius=0.2", "photonmap:gather-rays=2", "photonmap:nearest=9"}) {
    const Film one = film(way, 1);
    for (const auto& [more, threads] : {std::pair("", 3), std::pair(",lanes=one", 1)}) {
      const std::string other_way = way + more;
      const Film other = film(other_way, threads);
      for (int y = 0; y < one.bounds().y1; ++y)
        for (int x = 0; x < one.bounds().x1; ++x)
          for (int c = 0; c < rgb_size; ++c)
            ASSERT_EQ(one.pixel(x, y).mean[c], other.pixel(x, y).mean[c]) << other_way << ", " << threads;
    }
  }
}

}  // namespace
}  // namespace montelux::test
