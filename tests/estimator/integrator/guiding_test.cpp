// Path guiding estimates the same light as path: with any field, learned or not. Faults in its densities are found.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "integrator/guiding/guided_scattering.h"
#include "integrator/path/loop.h"
#include "pass_means.h"

namespace montelux::test {

// A fault: light samples are weighed as if directions came from the BSDF alone.
struct UnmixedGuide {
  static constexpr bool guides = true;
  const GuideField& field;
};
template <class F>
struct UnmixedChoice : GuideChoice<F> {
  using GuideChoice<F>::GuideChoice;
  void mix(const Vec3<F>&, Density<SolidAngle, F>&) const {}
};
template <class F>
UnmixedChoice<F> guide_choice(const UnmixedGuide& guide, const Vertex<F>& v, Mask<F> on, F u) {
  return UnmixedChoice<F>(guide.field, v, on, u);
}

// Another: the densities state a smaller share than directions have.
struct UnderstatedGuide {
  static constexpr bool guides = true;
  const GuideField& field;
};
template <class F>
GuideChoice<F> guide_choice(const UnderstatedGuide& guide, const Vertex<F>& v, Mask<F> on, F u) {
  GuideChoice<F> choice(guide.field, v, on, u);
  choice.site.share = choice.site.share * 0.8f;
  return choice;
}

namespace {

// Half of all directions by one table, which is uneven and knows nothing of the scene.
GuideField any_field() {
  std::vector<GuideField::Table> tables(1);
  RandomStream<float> r(1, 6);
  for (float& w : tables[0].weights) w = 0.1f + r.next();
  tables[0].share = 0.5f;
  return GuideField(PlaceTree{}, tables);
}

// The mean of the components over the image, by passes.
template <class Guide, class F = NativeFloats>
std::vector<double> pass_means(const TestScene& scene, int passes, int samples) {
  const PictureSettings& picture = scene.picture();
  const GuideField field = any_field();
  PathSettings settings;
  settings.max_depth = picture.max_depth;
  std::vector<double> means;
  for (int i = 0; i < passes; ++i) {
    const TilePass pass{picture.crop, {PointSetKind::independent, 4, std::uint32_t(i), std::uint32_t(samples)}};
    std::vector<PixelSample> out(std::size_t(picture.crop.area() * samples));
    trace_paths<F>(scene.scene(), scene.scene().lights, scene.accel(), settings, pass, out, no_tally, Guide{field});
    double sum = 0;
    for (const PixelSample& s : out)
      for (float c : s.radiance.c) sum += double(c);
    means.push_back(sum / (3 * double(out.size())));
  }
  return means;
}

TEST(PathGuiding, finds_closed_forms_by_any_field_and_a_false_density_is_found) {
  const std::filesystem::path folder = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/analytic";
  struct Case {
    const char* scene;
    bool finds_unmixed, finds_understated;
  };
  const Case cases[] = {{"rectangle-light-near.pbrt", true, true},  {"sky-two-tone.pbrt", true, true},
                        {"closed-furnace-box.pbrt", false, true},   {"furnace-coated.pbrt", false, true},
                        {"furnace-transmission.pbrt", false, true}, {"rough-metal-45.pbrt", false, true}};
  const double level = sidak_level(family_level, std::size(cases));
  const nlohmann::json expected = nlohmann::json::parse(read_text(folder / "expected.json"));
  for (const Case& c : cases) {
    SCOPED_TRACE(c.scene);
    double truth = 0;
    for (const nlohmann::json& e : expected)
      if (e.at("scene") == c.scene) truth = e.at("value").get<double>();
    ASSERT_GT(truth, 0);
    const TestScene scene(read_text(folder / c.scene), folder.string());
    const auto p_value = [&](const std::vector<double>& means) {
      const SampleSummary s = summarize(means);
      return std::abs(s.mean - truth) < 1e-5 * truth ? 1.0 : t_test(s, truth).p_value;
    };
    EXPECT_GT(p_value(pass_means<FieldGuide>(scene, 64, 32)), level);
    if (c.finds_unmixed) {
      EXPECT_LT(p_value(pass_means<UnmixedGuide>(scene, 64, 32)), level);
    }
    if (c.finds_understated) {
      EXPECT_LT(p_value(pass_means<UnderstatedGuide>(scene, 64, 32)), level);
    }
  }
}

// A room whose lamp shines into the next one: light comes by a doorway alone. A glossy floor, a glass ball, coats.
const std::string doorway = R"(
LookAt 0 1 -1.8  0 0.8 0  0 1 0
Camera "perspective" "float fov" [ 70 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
PixelFilter "box"
WorldBegin
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 0.7 0.65 0.5 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.6 0.1 0.1 ]
MakeNamedMaterial "satin" "string type" "coateddiffuse" "rgb reflectance" [ 0.2 0.4 0.5 ] "float roughness" [ 0.2 ]
MakeNamedMaterial "brass" "string type" "conductor" "spectrum eta" "metal-CuZn-eta" "spectrum k" "metal-CuZn-k" "float roughness" [ 0.3 ]
NamedMaterial "satin"
Shape "bilinearmesh" "point3 P" [ -2 0 -2  -2 0 4  2 0 -2  2 0 4 ]
NamedMaterial "white"
Shape "bilinearmesh" "point3 P" [ -2 2 -2  2 2 -2  -2 2 4  2 2 4 ]
Shape "bilinearmesh" "point3 P" [ -2 0 4  -2 2 4  2 0 4  2 2 4 ]
Shape "bilinearmesh" "point3 P" [ -2 0 -2  2 0 -2  -2 2 -2  2 2 -2 ]
NamedMaterial "red"
Shape "bilinearmesh" "point3 P" [ -2 0 -2  -2 2 -2  -2 0 4  -2 2 4 ]
Shape "bilinearmesh" "point3 P" [ 2 0 -2  2 0 4  2 2 -2  2 2 4 ]
NamedMaterial "white"
Shape "bilinearmesh" "point3 P" [ -2 0 1  -2 2 1  1.2 0 1  1.2 2 1 ]
NamedMaterial "brass"
AttributeBegin
  Translate -0.8 0.4 0
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
Material "dielectric" "float eta" [ 1.5 ]
AttributeBegin
  Translate 0.3 0.4 -0.2
  Shape "sphere" "float radius" [ 0.4 ]
AttributeEnd
NamedMaterial "white"
AreaLightSource "diffuse" "rgb L" [ 30 40 60 ]
Shape "bilinearmesh" "point3 P" [ -1.5 1.9 2  -1.0 1.9 2  -1.5 1.9 2.5  -1.0 1.9 2.5 ]
)";

// The mean squared error of the pixels of an image of 16 x 32 samples.
double squared_error(const TestScene& scene, const ChosenIntegrator& chosen) {
  RenderObserver silent;
  return render(chosen.any(), scene.settings(PointSetKind::blue_noise, {16, 32}, 3, 0), silent).film.mse();
}

TEST(PathGuiding, estimates_the_same_light_as_path) {
  const std::filesystem::path glossy = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/glossy-indirect";
  const TestScene behind_door(doorway),
      of_metal(read_text(glossy / "glossy-indirect.pbrt"), glossy.string(), std::pair(32, 24));
  const double level = sidak_level(3e-3, 4);
  for (const TestScene* scene : {&behind_door, &of_metal}) {
    const ChosenIntegrator path = scene->integrator("path");
    const PassMeans plain = measure_passes(*scene, path, 16, 96, 1);
    for (const std::string settings : {"", ",mis=balance,light-selection=ris:4,roulette=efficiency"}) {
      SCOPED_TRACE(settings);
      const ChosenIntegrator guided = scene->integrator("path:guiding=on,guiding-paths=60000" + settings);
      const PassMeans m = measure_passes(*scene, guided, 16, 96, 2);
      expect_same_means(m, plain, level);
      // Where light comes by a doorway the guide finds it, and saves about a sixth of the squared error. What fewer
      // paths teach depends on which of them find the caustic.
      if (scene == &behind_door && settings.empty()) {
        const ChosenIntegrator taught = scene->integrator("path:guiding=on,guiding-paths=120000");
        EXPECT_LT(squared_error(*scene, taught), 0.95 * squared_error(*scene, path));
      }
    }
  }
}

}  // namespace
}  // namespace montelux::test
