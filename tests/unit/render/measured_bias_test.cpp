// The bias that passes measure: its mean and error, for any number of threads, in one render or several.
#include "render/measured_bias.h"

#include <gtest/gtest.h>

#include "render/series.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

TEST(BiasEstimate, is_the_mean_over_passes_with_its_standard_error) {
  EXPECT_FALSE(estimate_bias({}));
  EXPECT_FALSE(estimate_bias({{3, {1, 2, 3}}}));
  const auto bias = estimate_bias({{0, {1, 0, 5}}, {4, {3, 0, 5}}, {7, {5, 3, 5}}});
  ASSERT_TRUE(bias);
  EXPECT_EQ(bias->passes, 3);
  EXPECT_EQ(bias->mean, (MeanDifference{3, 1, 5}));
  EXPECT_DOUBLE_EQ(bias->standard_error[0], std::sqrt(4.0 / 3));
  EXPECT_DOUBLE_EQ(bias->standard_error[1], 1);
  EXPECT_DOUBLE_EQ(bias->standard_error[2], 0);
}

TEST(BiasOfPasses, has_the_same_bits_for_any_number_of_threads_and_where_a_film_is_continued) {
  const TestScene scene(R"(Film "rgb" "integer xresolution" 40 "integer yresolution" 40
LookAt 0 0.2 -0.9   0 -0.1 0   0 1 0
Camera "perspective" "float fov" 70
WorldBegin
LightSource "point" "rgb I" [ 1 2 3 ] "point3 from" [ 0.3 0.7 -0.2 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.6 0.7 ]
Shape "bilinearmesh" "integer indices" [ 0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7 ]
    "point3 P" [ -1 -1 -1   1 -1 -1   -1 1 -1   1 1 -1   -1 -1 1   1 -1 1   -1 1 1   1 1 1 ]
)");
  const ChosenIntegrator cache = scene.integrator("irradiance-cache:samples=20,pairs=0.2"),
                         path = scene.integrator("path"), unmeasured = scene.integrator("irradiance-cache:pairs=0");
  RenderObserver silent;
  RenderSettings s = scene.settings(PointSetKind::blue_noise, {2, 3}, 1, 1);
  const RenderResult whole = render(cache.any(), s, silent);
  ASSERT_EQ(whole.bias.size(), 3u);
  EXPECT_NE(whole.bias.at(0), whole.bias.at(1));
  s.threads = 4;
  EXPECT_EQ(render(cache.any(), s, silent).bias, whole.bias);
  s.plan.passes = 1;
  RenderResult first = render(cache.any(), s, silent);
  FilmSnapshot last;
  s.keeping.keep = [&](FilmSnapshot snapshot) { last = std::move(snapshot); };
  BegunFilm begun{std::move(first.film), first.rays, first.seconds, std::move(first.bias)};
  s.plan.passes = 3, s.begun = &begun;
  EXPECT_EQ(render(cache.any(), s, silent).bias, whole.bias);
  EXPECT_EQ(last.bias, whole.bias);
  s.begun = nullptr, s.keeping.keep = {};
  EXPECT_TRUE(render(path.any(), s, silent).bias.empty());
  EXPECT_TRUE(render(unmeasured.any(), s, silent).bias.empty());

  // Series are compared with the unbiased samples of the same numbers.
  const ChosenIntegrator limited = scene.integrator("path:maxdepth=1");
  const PassesAsSeries same(*path.any().pixel()), darker(*limited.any().pixel());
  s = scene.settings(PointSetKind::blue_noise, {1, 3}, 1, 1), s.unbiased = path.any().pixel();
  EXPECT_EQ(render(same, s, silent).bias, (BiasOfPasses{{0, {}}, {1, {}}, {2, {}}}));
  const BiasOfPasses lost = render(darker, s, silent).bias;
  ASSERT_EQ(lost.size(), 3u);
  for (const auto& [pass, difference] : lost)
    for (const double channel : difference) EXPECT_LT(channel, -0.01);
}

}  // namespace
}  // namespace montelux::test
