// Of every kind of light: samples follow the density, and both ways to ask for the density agree.
#include <gtest/gtest.h>

#include "light_cases.h"
#include "statistics.h"

namespace montelux::test {
namespace {

Vec2f drawn(const LightCase& c, RandomStream<float>& r) {
  const float choice = r.next();
  LightSample<float> s = c.lights.sample<float>(c.reference, c.n, choice, r.next2(), true);
  if (!s.valid) return {-1, -1};
  return c.chart(is_infinite(c.kind) ? s.wi : c.reference + s.wi * s.distance);
}

TEST(LightKinds, all_have_a_case_save_those_that_no_ray_shows) {
  for (std::size_t k = 0; k < light_kind_names.size(); ++k)
    EXPECT_EQ(light_cases(LightKind(k)).empty(), is_delta(LightKind(k))) << light_kind_names[k];
}

TEST(LightKinds, samples_follow_the_density_and_a_planted_fault_is_found) {
  std::vector<LightCase> cases = all_light_cases();
  double level = sidak_level(family_level, double(2 * cases.size()));
  for (const LightCase& c : cases) {
    SCOPED_TRACE(c.name);
    for (Grid grid : {coarse_grid, fine_grid}) {
      auto sample = [&](RandomStream<float>& r) { return drawn(c, r); };
      TestResult fit = chi_square_square(
          sample, [&](double x, double y) { return chart_density(c, x, y); }, grid, 80000, 11);
      EXPECT_GT(fit.p_value, level) << fit.note;
    }
    auto tilted = [&](double x, double y) { return chart_density(c, x, y) * (1.08 - 0.16 * (y < 0.5 ? 1 : 0)); };
    auto sample = [&](RandomStream<float>& r) { return drawn(c, r); };
    EXPECT_LT(chi_square_square(sample, tilted, coarse_grid, 80000, 11).p_value, level);
  }
}

TEST(LightKinds, a_ray_finds_the_density_and_the_radiance_of_the_sample) {
  for (const LightCase& c : all_light_cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(21, 22);
    int valid = 0;
    for (int i = 0; i < 2000; ++i) {
      const float choice = r.next();
      LightSample<float> s = c.lights.sample<float>(c.reference, c.n, choice, r.next2(), true);
      if (!s.valid) continue;
      ++valid;
      EXPECT_FALSE(s.delta);
      EXPECT_NEAR(length(s.wi), 1, 1e-5f);
      Vec2f at = c.chart(is_infinite(c.kind) ? s.wi : c.reference + s.wi * s.distance);
      LightPoint point = c.at(double(at.x), double(at.y));
      if (is_infinite(c.kind)) point.p = s.wi;
      LightHit<float> hit = met(c, point);
      // A direction on the edge of two texels may be looked up in either.
      if (c.kind == LightKind::image_infinite && std::abs(hit.density.value / s.density.value - 1) > 1e-3f) {
        float x = at.x * 10, y = at.y * 10;
        EXPECT_LT(min(abs(x - round(x)), abs(y - round(y))), 1e-3f);
        continue;
      }
      EXPECT_NEAR(hit.density.value / s.density.value, 1, 2e-3f);
      for (int k = 0; k < spectrum_size; ++k) EXPECT_FLOAT_EQ(hit.radiance[k], s.radiance[k]);
    }
    EXPECT_GT(valid, 200);
  }
}

TEST(LightKinds, one_side_stays_dark) {
  for (LightKind kind : {LightKind::triangle, LightKind::parallelogram, LightKind::bilinear_patch, LightKind::disk}) {
    LightCase c = light_cases(kind)[0];
    LightPoint middle = c.at(0.4, 0.4);
    Vec3f behind = middle.p - middle.n * 0.7f;
    for (float x : {0.1f, 0.5f, 0.9f})
      EXPECT_FALSE(c.lights.sample<float>(behind, {0, 0, 0}, 0.5f, Vec2f{x, 0.3f}, true).valid) << c.name;
    LightHit<float> hit = c.lights.hit<float>(0, behind, {0, 0, 0}, middle.p, middle.n, middle.uv, middle.n, true);
    EXPECT_TRUE(is_black(hit.radiance)) << c.name;
  }
}

}  // namespace
}  // namespace montelux::test
