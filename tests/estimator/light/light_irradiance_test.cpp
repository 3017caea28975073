// The irradiance that lights bring to a point, against closed forms.
#include <gtest/gtest.h>

#include "light_cases.h"
#include "mc/hemisphere.h"
#include "mc/mis.h"
#include "statistics.h"

namespace montelux::test {
namespace {

constexpr int draws = 80000;

struct Dvec {
  double x, y, z;
};
Dvec to_double(Vec3f a) { return {double(a.x), double(a.y), double(a.z)}; }
double dot_of(Dvec a, Dvec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Of a polygon of radiance 1 that lies above the horizon of n (Lambert 1760).
double polygon_irradiance(std::vector<Vec3f> corners, Vec3f at, Vec3f n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Dvec a = to_double(corners[i] - at), b = to_double(corners[(i + 1) % corners.size()] - at);
    Dvec c{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    double sine = std::sqrt(dot_of(c, c));
    sum += std::atan2(sine, dot_of(a, b)) * dot_of(c, to_double(n)) / sine;
  }
  return std::abs(sum) / 2;
}

// The mean over sample() and its error, on the component that has radiance 1; `one_side` passes n on.
SampleSummary irradiance(const LightSet& lights, Vec3f p, Vec3f n, bool one_side, double fault = 1) {
  RandomStream<float> r(31, one_side);
  std::vector<double> x;
  for (int i = 0; i < draws; ++i) {
    const float u = r.next();
    LightSample<float> s = lights.sample<float>(p, one_side ? n : Vec3f{0, 0, 0}, u, r.next2(), true);
    x.push_back(s.valid ? fault * double(s.radiance[0] * max(dot(s.wi, n), 0.0f) / s.density.value) : 0);
  }
  return summarize(x);
}

struct Expected {
  std::string name;
  LightSet lights;
  Vec3f p, n;
  double truth;
};

LightSet set_of(auto shape, Emission e) {
  LightSetBuilder b;
  b.add(shape, e);
  return alone(std::move(b));
}

// By the chart of a case: what its visible points send to its reference point.
double by_quadrature(const LightCase& c, Vec3f n) {
  return integrate2(
      [&](double x, double y) {
        LightPoint at = c.at(x, y);
        Vec3f d = at.p - c.reference;
        double d2 = double(dot(d, d)), cos = double(dot(d, n)) / std::sqrt(d2),
               facing = -double(dot(d, at.n)) / std::sqrt(d2);
        return std::max(cos, 0.0) * std::max(facing, 0.0) / d2 * at.jacobian;
      },
      0, 1, 0, 1, 40);
}

std::vector<Expected> expectations() {
  std::vector<Expected> all;
  Emission one{.radiance = gray_rgb(1.0f)};
  Vec3f up{0, 0, 1}, origin{0, 0, 0};
  for (float height : {0.3f, 2.0f, 300.0f}) {
    TriangleShape t{{-1, -0.7f, height}, {0.2f, 1.1f, height + 0.1f}, {1.3f, -0.2f, height}};
    all.push_back({"triangle", set_of(t, one), origin, up, polygon_irradiance({t.p0, t.p1, t.p2}, origin, up)});
    PatchShape r{{-1, -1, height}, {-1, 0.4f, height}, {2, -1, height}, {2, 0.4f, height}};
    all.push_back(
        {"rectangle", set_of(r, one), origin, up, polygon_irradiance({r.p00, r.p10, r.p11, r.p01}, origin, up)});
    PatchShape s{{-1, -1, height}, {-1, 0.4f, height}, {2, -0.5f, height}, {2, 0.9f, height}};
    all.push_back(
        {"parallelogram", set_of(s, one), origin, up, polygon_irradiance({s.p00, s.p10, s.p11, s.p01}, origin, up)});
    DiskShape disk{translate(0, 0, double(height)), 0.8f, 0, 0, 360, true};
    double h = double(height);
    all.push_back({"disk", set_of(disk, one), origin, up, std::numbers::pi * 0.64 / (0.64 + h * h)});
    SphereShape sphere{translate(0.5, 0, h + 0.9), 0.8f};
    double d2 = 0.25 + (h + 0.9) * (h + 0.9), r_z = (h + 0.9) / std::sqrt(d2);
    all.push_back({"sphere", set_of(sphere, one), origin, up, std::numbers::pi * 0.64 / d2 * r_z});
  }
  SphereShape around{{}, 3, -1e9f, 1e9f, 360, true};
  all.push_back({"sphere from within", set_of(around, one), {0.5f, 1, -0.7f}, up, std::numbers::pi});
  PatchShape kite{{-1, -1, 1}, {-1, 1, 1}, {0.6f, -0.5f, 1}, {0.4f, 0.5f, 1}};
  all.push_back({"flat bilinear patch", set_of(kite, one), origin, up,
                 polygon_irradiance({kite.p00, kite.p10, kite.p11, kite.p01}, origin, up)});
  LightCase cylinder = quadric_case("cylinder", CylinderShape{rotate(90, 1, 0, 0), 0.5f, -1, 1}, one, {0, 0.3f, -2});
  all.push_back({cylinder.name, cylinder.lights, cylinder.reference, up, by_quadrature(cylinder, up)});
  LightSetBuilder sky, dome;
  sky.add_uniform_infinite(gray_rgb(1.0f));
  all.push_back({"uniform sky", alone(std::move(sky)), origin, normalize(Vec3f{1, 2, -1}), std::numbers::pi});
  // A radiance of 1 in the directions with positive z, which are the inner half of the map, and in the 128 texels that
  // the equator halves: what they have beyond it cannot reach a plane that looks up.
  auto half = std::make_shared<LightImage>(LightImage{64, 64, std::vector<Rgb>(64 * 64, gray_rgb(0.0f))});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      if (std::abs(x - 31.5) + std::abs(y - 31.5) < 32.1) half->texels[std::size_t(64 * y + x)] = gray_rgb(1.0f);
  double lit = 0;
  for (const Rgb& t : half->texels) lit += double(t[0]);
  EXPECT_EQ(lit, 64 * 64 / 2 + 128 / 2);
  dome.add_image_infinite(rotate(90, 1, 0, 0), gray_rgb(1.0f), half);
  LightSet dome_set = alone(std::move(dome));
  all.push_back({"image of a half sky", dome_set, origin, {0, -1, 0}, std::numbers::pi});
  return all;
}

TEST(LightIrradiance, matches_closed_forms_and_a_planted_fault_is_found) {
  std::vector<Expected> all = expectations();
  double level = sidak_level(family_level, double(2 * all.size()));
  int found = 0;
  for (const Expected& e : all) {
    SCOPED_TRACE(e.name);
    for (bool one_side : {false, true}) {
      SampleSummary s = irradiance(e.lights, e.p, e.n, one_side);
      // Where every sample is worth the same there is rounding only.
      if (s.standard_error() < 1e-5 * e.truth) {
        EXPECT_NEAR(s.mean / e.truth, 1, 1e-4);
        continue;
      }
      EXPECT_GT(z_test(s.mean, s.standard_error(), e.truth).p_value, level) << s.mean << " for " << e.truth;
      SampleSummary wrong = irradiance(e.lights, e.p, e.n, one_side, 1.06);
      found += z_test(wrong.mean, wrong.standard_error(), e.truth).p_value < level ? 1 : 0;
      EXPECT_LT(z_test(wrong.mean, wrong.standard_error(), e.truth).p_value, level) << wrong.standard_error() / e.truth;
    }
  }
  EXPECT_GT(found, 10);
}

TEST(LightIrradiance, many_lights_add_up_whatever_the_choice) {
  Vec3f up{0, 0, 1};
  for (LightSelection selection : {LightSelection::uniform, LightSelection::power, LightSelection::bvh}) {
    LightSetBuilder b;
    RandomStream<float> r(5, 5);
    double truth = 0;
    for (int i = 0; i < 30; ++i) {
      Vec3f p{4 * r.next() - 2, 4 * r.next() - 2, 1 + r.next()};
      TriangleShape t{p, p + Vec3f{0, 0.5f, 0.1f}, p + Vec3f{0.4f, 0, 0}};
      b.add(t, {.radiance = gray_rgb(1.0f), .two_sided = i % 2 == 0});
      truth += polygon_irradiance({t.p0, t.p1, t.p2}, {0, 0, 0}, up);
      b.add_point(p, gray_rgb(0.02f));
      truth += 0.02 * double(p.z / (length(p) * length_squared(p)));
    }
    b.add_uniform_infinite(gray_rgb(0.1f));
    b.add_distant({0.3f, 0, 1}, gray_rgb(0.2f));
    truth += 0.1 * std::numbers::pi + 0.2 / std::sqrt(1.09);
    LightSet lights = std::move(b).build({selection}, {0, 0, 0}, 5);
    SampleSummary s = irradiance(lights, {0, 0, 0}, up, true);
    double level = sidak_level(family_level, 3);
    EXPECT_GT(z_test(s.mean, s.standard_error(), truth).p_value, level) << s.mean << " for " << truth;
    SampleSummary wrong = irradiance(lights, {0, 0, 0}, up, true, 1 + 8 * s.standard_error() / truth);
    EXPECT_LT(z_test(wrong.mean, wrong.standard_error(), truth).p_value, level);
  }
}

// The irradiance of the test image by both techniques: toward the light, and by the cosine. `weighed_by`: whose
// densities the weights are made of.
SampleSummary irradiance_by_both(const LightSet& lights, const LightSet& weighed_by, Vec3f n) {
  RandomStream<float> r(32, 7);
  std::vector<double> x;
  const Vec3f origin{0, 0, 0};
  for (int i = 0; i < draws; ++i) {
    const float u = r.next();
    const LightSample<float> s = lights.sample<float>(origin, origin, u, r.next2(), true);
    double sum = 0;
    if (const float cosine = dot(s.wi, n); s.valid && cosine > 0)
      sum += double(s.radiance[0] * cosine / s.density.value) *
             double(balance_weight(s.density, cosine_hemisphere_density(cosine)));
    const Vec3f wi = LocalFrame<float>::from_normal(n).to_world(sample_cosine_hemisphere(r.next2()));
    const LightHit<float> hit = weighed_by.escaped<float>(0, origin, origin, wi, true);
    sum += double(hit.radiance[0] * pi) * double(balance_weight(cosine_hemisphere_density(dot(wi, n)), hit.density));
    x.push_back(sum);
  }
  return summarize(x);
}

// What the image of light_cases.h sends to a plane, by the midpoints of small parts of its texels.
double image_irradiance(const LightCase& c, Vec3f n) {
  constexpr int parts = 1000;
  double sum = 0;
  for (int y = 0; y < parts; ++y)
    for (int x = 0; x < parts; ++x) {
      const Vec3f w = c.at((x + 0.5) / parts, (y + 0.5) / parts).p;
      sum += std::max(double(dot(w, n)), 0.0) * double(test_image()->at(x / (parts / 10), y / (parts / 10))[0]) * 0.5;
    }
  return sum * 4 * double(pi) / (double(parts) * parts);
}

TEST(LightIrradiance, of_compensated_lights_is_shared_with_directions_by_the_cosine) {
  const LightCase c = image_infinite_case();
  const LightSet compensated = *c.lights.compensated();
  const double level = sidak_level(family_level, 12);
  const auto p_value = [](const SampleSummary& s, double truth) {
    return z_test(s.mean, s.standard_error(), truth).p_value;
  };
  for (const Vec3f n : {Vec3f{0, 0, 1}, normalize(Vec3f{1, -2, 0.5f}), Vec3f{-1, 0, 0}}) {
    const double truth = image_irradiance(c, n);
    EXPECT_GT(p_value(irradiance_by_both(compensated, compensated, n), truth), level);
    EXPECT_GT(p_value(irradiance_by_both(c.lights, c.lights, n), truth), level);
    // Planted: the directions take the light to be sampled as without compensation. Alone it misses what is dim.
    EXPECT_LT(p_value(irradiance_by_both(compensated, c.lights, n), truth), level);
    EXPECT_LT(p_value(irradiance(compensated, {0, 0, 0}, n, false), truth), level);
  }
}

// Of a sky that is brighter on one side. The standard errors of 80000 draws are known to 1 %.
TEST(LightIrradiance, of_compensated_lights_has_less_noise) {
  LightSetBuilder b;
  b.add_image_infinite(
      {}, gray_rgb(1.0f),
      std::make_shared<LightImage>(LightImage{2, 2, {gray_rgb(0.8f), gray_rgb(1.6f), gray_rgb(0.9f), gray_rgb(0.7f)}}));
  const LightSet lights = alone(std::move(b)), compensated = *lights.compensated();
  const Vec3f up{0, 0, 1};
  const SampleSummary all = irradiance_by_both(lights, lights, up),
                      shared = irradiance_by_both(compensated, compensated, up);
  EXPECT_LT(shared.standard_error(), 0.8 * all.standard_error());
}

TEST(LightIrradiance, leaves_lights_as_they_are_where_there_is_nothing_to_compensate) {
  EXPECT_FALSE(light_cases(LightKind::disk)[0].lights.compensated().has_value());
  EXPECT_FALSE(light_cases(LightKind::uniform_infinite)[0].lights.compensated().has_value());
  LightSetBuilder even;
  even.add_image_infinite({}, gray_rgb(1.0f),
                          std::make_shared<LightImage>(LightImage{2, 2, std::vector<Rgb>(4, gray_rgb(0.5f))}));
  EXPECT_FALSE(alone(std::move(even)).compensated().has_value());
}

}  // namespace
}  // namespace montelux::test
