// Irradiance, its gradients and the distance of what is around are those of closed forms; interpolation between records
// errs as much as theory says.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "integrator/irradiance_cache/cache.h"
#include "mc/random.h"
#include "statistics.h"

namespace montelux::test {
namespace {

constexpr double pi_ = std::numbers::pi;
constexpr float nothing = std::numeric_limits<float>::infinity();
constexpr double light[] = {1, 0.25, 3};
Spectrum<float> light_times(double x) {
  return from_rgb(Rgb{{float(light[0] * x), float(light[1] * x), float(light[2] * x)}});
}

// A light in view of the point at the origin: what a direction (of the world) meets.
struct Seen {
  bool lit;
  float distance;
};
// One estimate of a hemisphere about n.
template <class Around>
HemisphereEstimate sampled(const HemisphereStrata& strata, const Vec3f& n, std::uint32_t seed, Around around) {
  const LocalFrame<float> frame = LocalFrame<float>::from_normal(n);
  RandomStream<float> random(seed, 0x5be0cd19u);
  std::vector<HemisphereSample> samples;
  for (int j = 0; j < strata.rows; ++j)
    for (int k = 0; k < strata.columns; ++k) {
      const Seen seen = around(frame.to_world(strata.direction(float(j), float(k), random.next2())));
      samples.push_back({light_times(seen.lit ? 1 : 0), seen.distance});
    }
  return integrate_hemisphere(strata, samples, frame);
}
// A number of each of many estimates.
template <class Around, class Value>
std::vector<double> many(const HemisphereStrata& strata, const Vec3f& n, Around around, Value value) {
  std::vector<double> all;
  for (std::uint32_t i = 0; i < 64; ++i) all.push_back(value(sampled(strata, n, i, around)));
  return all;
}
double level(std::size_t tests) { return sidak_level(family_level, double(tests)); }
// Whether the mean may be `truth`, up to what cells of a finite size do.
bool agrees(const std::vector<double>& values, double truth, double allowance, double own) {
  const SampleSummary s = summarize(values);
  const double distance = std::max(0.0, std::abs(s.mean - truth) - allowance);
  return distance == 0 || t_test(SampleSummary{distance, s.variance, s.count}, 0).p_value >= own;
}

// A disk of radius 0.7 at the height 1.1 parallel to the plane, which the points on it see from the side.
constexpr double disk_radius = 0.7, disk_height = 1.1;
// Irradiance at the distance d from its axis, for a radiance of 1, and its derivative by d.
double under_disk(double d) {
  const double a = disk_radius * disk_radius, b = disk_height * disk_height, c = d * d;
  return pi_ / 2 * (1 - (c + b - a) / std::sqrt((c + b + a) * (c + b + a) - 4 * a * c));
}
double slope_under_disk(double d) {
  const double a = disk_radius * disk_radius, b = disk_height * disk_height, c = d * d;
  const double root = std::sqrt((c + b + a) * (c + b + a) - 4 * a * c);
  return -pi_ / 2 * (2 * d / root - (c + b - a) * (2 * d * (c + b + a) - 4 * a * d) / (root * root * root));
}
// As seen from the point (d, 0, 0).
Seen disk(const Vec3f& w, double d) {
  const double t = disk_height / double(w.z), x = d + t * double(w.x), y = t * double(w.y);
  const bool lit = w.z > 0 && x * x + y * y < disk_radius * disk_radius;
  return {lit, lit ? float(t) : nothing};
}

TEST(HemisphereStrata, are_about_as_many_as_wanted_and_share_the_hemisphere_evenly) {
  for (const int samples : {8, 60, 512, 4000}) {
    const HemisphereStrata strata = HemisphereStrata::of(samples);
    EXPECT_NEAR(strata.count(), samples, 0.15 * samples + 1);
    // The mean of the sine's square over all cells is 1/2, and no cell's directions leave it.
    for (const float u : {0.01f, 0.99f})
      for (int j = 0; j < strata.rows; ++j) {
        const Vec3f w = strata.direction(float(j), 1.0f, Vec2f{u, 0.5f});
        EXPECT_NEAR(w.x * w.x + w.y * w.y, (float(j) + u) / float(strata.rows), 1e-5f);
        EXPECT_NEAR(std::atan2(w.y, w.x), 2 * pi_ * 1.5 / strata.columns, 1e-5);
      }
  }
}

// A sky that is bright within a cone about c has the vector irradiance pi sin^2 c, of which irradiance is the part
// along the normal.
TEST(HemisphereGradients, of_the_normal_are_those_of_a_bright_cone) {
  constexpr double sine = 0.4;
  const Vec3f n = normalize(Vec3f{0.2f, -0.3f, 0.8f});
  const Vec3f c = normalize(LocalFrame<float>::from_normal(n).to_world({0.5f, 0.3f, 0.7f}));
  const auto cone = [&](const Vec3f& w) { return Seen{double(dot(w, c)) > std::sqrt(1 - sine * sine), nothing}; };
  const HemisphereStrata strata = HemisphereStrata::of(2000);
  const Vec3f truth = cross(n, c) * float(pi_ * sine * sine);
  const LocalFrame<float> frame = LocalFrame<float>::from_normal(n);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(agrees(many(strata, n, cone, [&](const HemisphereEstimate& e) { return double(e.irradiance[int(i)]); }),
                       light[i] * pi_ * sine * sine * double(dot(n, c)), 0, level(9)));
    for (const Vec3f& axis : {frame.s, frame.t}) {
      const auto turning = many(
          strata, n, cone, [&](const HemisphereEstimate& e) { return double(dot(e.gradients.rotational[i], axis)); });
      const double right = light[i] * double(dot(truth, axis)), size = light[i] * double(length(truth));
      EXPECT_TRUE(agrees(turning, right, 0.005 * size, level(9))) << summarize(turning).mean << " where " << right;
      // The other direction; the light of another component.
      EXPECT_FALSE(agrees(turning, -right, 0.005 * size, level(9)));
      EXPECT_FALSE(agrees(turning, right / light[i] * light[(i + 1) % 3], 0.005 * size, level(9)));
    }
    EXPECT_TRUE(agrees(many(strata, n, cone,
                            [&](const HemisphereEstimate& e) { return double(length(e.gradients.translational[i])); }),
                       0, 0, level(9)));
  }
}

// Borders of cells are not those of surfaces: an error of the first order in the width of a cell remains.
double allowance_of(const HemisphereStrata& strata, double gradient) { return 2.0 / strata.rows * std::abs(gradient); }

TEST(HemisphereGradients, of_the_place_are_those_under_a_bright_disk) {
  const Vec3f n{0, 0, 1};
  for (const int samples : {1000, 16000})
    for (const double d : {0.3, 0.9, 2.0}) {
      const HemisphereStrata strata = HemisphereStrata::of(samples);
      std::vector<HemisphereEstimate> estimates;
      for (std::uint32_t i = 0; i < 64; ++i)
        estimates.push_back(sampled(strata, n, i, [&](const Vec3f& w) { return disk(w, d); }));
      for (std::size_t i = 0; i < 3; ++i) {
        std::vector<double> along, across, irradiance;
        for (const HemisphereEstimate& e : estimates) {
          const Vec3f& gradient = e.gradients.translational[i];
          along.push_back(double(gradient.x)), across.push_back(double(gradient.y));
          irradiance.push_back(double(e.irradiance[int(i)]));
        }
        const double right = light[i] * slope_under_disk(d), allowance = allowance_of(strata, right), own = level(54);
        EXPECT_TRUE(agrees(irradiance, light[i] * under_disk(d), 0, own));
        EXPECT_TRUE(agrees(across, 0, allowance, own));
        EXPECT_TRUE(agrees(along, right, allowance, own))
            << d << ": " << summarize(along).mean << " where " << right << " is right";
        EXPECT_FALSE(agrees(along, -right, allowance, own));
        EXPECT_TRUE(samples == 1000 || !agrees(along, 1.05 * right, allowance, own));
        EXPECT_FALSE(agrees(along, right / light[i] * light[(i + 1) % 3], allowance, own));
      }
    }
}

// A wall of height H that is long: pi / 2 (1 - d / sqrt(d^2 + H^2)).
TEST(HemisphereGradients, of_the_place_are_those_before_a_bright_wall) {
  constexpr double d = 0.8, height = 1.5;
  const auto wall = [&](const Vec3f& w) {
    const double t = d / double(w.x);
    const bool hit = w.x > 0 && t * double(w.z) < height;
    return Seen{hit, hit ? float(t) : nothing};
  };
  const double right = pi_ / 2 * height * height / std::pow(d * d + height * height, 1.5);
  for (const int samples : {1000, 16000}) {
    const HemisphereStrata strata = HemisphereStrata::of(samples);
    const auto slope = many(strata, {0, 0, 1}, wall,
                            [](const HemisphereEstimate& e) { return double(e.gradients.translational[0].x); });
    EXPECT_TRUE(agrees(slope, right, allowance_of(strata, right), level(2)))
        << summarize(slope).mean << " where " << right << " is right";
    EXPECT_FALSE(agrees(slope, (samples == 1000 ? 1.3 : 1.1) * right, allowance_of(strata, right), level(2)));
  }
}

// Under a plane at the height h: the mean of cos / h over the projected solid angle is 2 / (3 h), that of h / cos is 2
// h.
TEST(HemisphereDistance, is_the_harmonic_mean_of_those_to_a_plane) {
  constexpr double h = 0.7;
  const auto plane = [](const Vec3f& w) { return Seen{true, float(h) / w.z}; };
  const HemisphereStrata strata = HemisphereStrata::of(500);
  const auto means = many(strata, {0, 0, 1}, plane, [](const HemisphereEstimate& e) { return 1 / double(e.distance); });
  EXPECT_TRUE(agrees(means, 1 / (1.5 * h), 1e-6, level(1))) << summarize(means).mean;
  EXPECT_FALSE(agrees(means, 1 / (2 * h), 1e-6, level(1)));
  const float distances[] = {1, 3, nothing};
  EXPECT_FLOAT_EQ(harmonic_mean_distance(distances), 2.25f);
  EXPECT_EQ(harmonic_mean_distance(std::span(distances).last(1)), nothing);
}

TEST(HemisphereGradients, vanish_in_uniform_light) {
  const auto all = [](const Vec3f& w) { return Seen{true, 1 + w.x}; };
  const HemisphereEstimate e = sampled(HemisphereStrata::of(200), {0, 1, 0}, 1, all);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(e.irradiance[int(i)], pi_ * light[i], 1e-5);
    EXPECT_LT(length(e.gradients.rotational[i]), 1e-5f);
    EXPECT_EQ(length(e.gradients.translational[i]), 0.0f);
  }
}

// ---- the cache

// The record at (x, y) of the plane under the disk, with its closed form.
CacheRecord under_disk_at(float x, float y) {
  const double d = std::hypot(double(x), double(y));
  CacheRecord record{{{x, y, 0}, {0, 0, 1}}, light_times(under_disk(d)), {}, 1};
  for (std::size_t i = 0; i < std::size_t(spectrum_size); ++i)
    record.gradients.translational[i] =
        Vec3f{x, y, 0} * float(double(light_times(1)[int(i)]) * slope_under_disk(d) / std::max(d, 1e-6));
  return record;
}
// Mean square error of the interpolation between records that count within `radius`, by realisation: records stand at
// random places, where there is none yet.
SampleSummary squared_errors(double radius, bool gradients) {
  std::vector<double> all;
  for (std::uint32_t i = 0; i < 12; ++i) {
    RandomStream<float> random(i, 0x2545f491u);
    IrradianceCache cache({0.3f, float(radius), float(radius), gradients, false});
    const auto place = [&](float half) {
      const Vec2f u = random.next2();
      return Vec2f{half * (2 * u.x - 1), half * (2 * u.y - 1)};
    };
    const int tries = int(40 / (radius * radius));
    for (int k = 0; k < tries; ++k) {
      const Vec2f at = place(1);
      if (!cache.covers({{at.x, at.y, 0}, {0, 0, 1}})) cache.insert(under_disk_at(at.x, at.y));
    }
    double sum = 0;
    int count = 0;
    for (int k = 0; k < 4000; ++k) {
      const Vec2f at = place(0.6f);
      const auto shown = cache.irradiance({{at.x, at.y, 0}, {0, 0, 1}});
      if (!shown) continue;
      const double truth = light[1] * under_disk(std::hypot(double(at.x), double(at.y)));
      sum += (double((*shown)[1]) - truth) * (double((*shown)[1]) - truth), ++count;
    }
    EXPECT_GT(count, 3900);
    all.push_back(sum / count);
  }
  return summarize(all);
}

TEST(CacheInterpolation, errs_in_proportion_to_the_spacing_and_with_gradients_to_its_square) {
  for (const bool gradients : {false, true}) {
    const SampleSummary wide = squared_errors(0.2, gradients), narrow = squared_errors(0.1, gradients);
    const Exponent e = measured_exponent(narrow, wide, 2);
    const double right = gradients ? 4 : 2;
    std::printf("%s gradients: exponent %.3g +- %.1g\n", gradients ? "with" : "without", e.value, e.standard_error);
    EXPECT_LT(std::abs(e.value - right), 0.15 + 3.3 * e.standard_error) << e.value << " +- " << e.standard_error;
    EXPECT_LT(e.standard_error, 0.2);
    EXPECT_GT(std::abs(e.value - (6 - right)), 1.0 + 3.3 * e.standard_error);
  }
}

// On a ball far from all else, under a sky that is bright above the horizon: pi (1 + cos) / 2. Normals within the
// accuracy a differ by angles whose sine's half is below a / sqrt 2, and irradiance by pi / 2 times that at most.
struct WithoutNormals {
  float operator()(const CacheRecord& record, const CacheQuery& at, float accuracy) const {
    const float error = length(at.p - record.at.p) / record.distance;
    return error < accuracy ? 1 / std::max(error, 1e-4f) - 1 / accuracy : 0;
  }
};
TEST(CacheInterpolation, does_not_mix_surfaces_whose_normals_differ) {
  constexpr float accuracy = 0.2f, ball = 0.01f;
  IrradianceCache cache({accuracy, 0.001f, 10, false, false});
  RandomStream<float> random(3, 9);
  const auto irradiance_at = [](const Vec3f& n) { return pi_ * (1 + double(n.z)) / 2; };
  for (int i = 0; i < 4000; ++i) {
    const Vec3f n = sample_sphere(random.next2());
    if (!cache.covers({n * ball, n})) cache.insert({{n * ball, n}, light_times(irradiance_at(n)), {}, 10});
  }
  EXPECT_GT(cache.size(), 20u);
  const double bound = pi_ / 2 * 2 * std::asin(double(accuracy) / std::numbers::sqrt2) * 1.001;
  double worst = 0, worst_without = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3f n = sample_sphere(random.next2());
    const CacheQuery at{n * ball, n};
    if (const auto shown = cache.irradiance(at))
      worst = std::max(worst, std::abs(double((*shown)[0]) - irradiance_at(n)));
    const double without = double((*cache.irradiance(at, WithoutNormals{}))[0]);
    worst_without = std::max(worst_without, std::abs(without - irradiance_at(n)));
  }
  EXPECT_LT(worst, bound);
  EXPECT_GT(worst_without, bound);
}

// The normal turns from one end of a bowl to the other: E = n . Phi is continued exactly up to second order.
TEST(CacheInterpolation, follows_the_normal_by_the_rotational_gradient) {
  const Vec3f flux = {0.4f, -0.2f, 0.9f}, n{0, 0, 1};
  const auto error_with = [&](float sign) {
    IrradianceCache cache({0.3f, 1, 1, true, false});
    CacheRecord record{{{0, 0, 0}, n}, gray(dot(flux, n)), {}, 1};
    for (Vec3f& g : record.gradients.rotational) g = cross(n, flux) * sign;
    cache.insert(record);
    double worst = 0;
    for (const float angle : {0.05f, 0.1f, 0.2f})
      for (const Vec3f& toward : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{-1, 0, 0}}) {
        const Vec3f turned = n * std::cos(angle) + toward * std::sin(angle);
        const auto shown = cache.irradiance({{0, 0, 0}, turned});
        EXPECT_TRUE(shown);
        worst = std::max(worst, std::abs(double((*shown)[0]) - double(dot(flux, turned))) / double(angle * angle));
      }
    return worst;
  };
  EXPECT_LT(error_with(1), 0.5);   // 1 - cos of n . Phi is not followed
  EXPECT_GT(error_with(-1), 2.0);  // the gradient the wrong way
}

TEST(CacheRecords, of_another_depth_or_behind_do_not_count) {
  IrradianceCache cache({0.3f, 1, 1, true, true});
  cache.insert({{{0, 0, 0}, {0, 0, 1}, 2}, gray(1.0f), {}, 1});
  EXPECT_TRUE(cache.covers({{0.1f, 0, 0}, {0, 0, 1}, 2}));
  EXPECT_FALSE(cache.covers({{0.1f, 0, 0}, {0, 0, 1}, 1}));
  EXPECT_FALSE(cache.covers({{0.1f, 0, 0}, {0, 0, -1}, 2}));
  EXPECT_TRUE(cache.covers({{0, 0, 0.2f}, {0, 0, 1}, 2}));
  EXPECT_FALSE(cache.covers({{0, 0, -0.2f}, {0, 0, 1}, 2}));
  EXPECT_FALSE(cache.covers({{1.1f, 0, 0}, {0, 0, 1}, 2}));
}

// The point at which a record counts is in the cell where it is looked for, whatever its size and place.
TEST(CacheRecords, are_found_within_their_radius_and_not_beyond) {
  RandomStream<float> random(5, 5);
  constexpr float accuracy = 0.25f;
  IrradianceCache cache({accuracy, 1e-3f, 2, false, false});
  std::vector<CacheRecord> all;
  for (int i = 0; i < 600; ++i) {
    const Vec2f u = random.next2();
    const CacheRecord record{
        {{4 * u.x - 2, 4 * u.y - 2, 0}, {0, 0, 1}}, gray(float(i)), {}, std::exp2(10 * random.next() - 8) / accuracy};
    cache.insert(record), all.push_back(record);
  }
  for (int i = 0; i < 2000; ++i) {
    const Vec2f u = random.next2();
    const CacheQuery at{{4 * u.x - 2, 4 * u.y - 2, 0}, {0, 0, 1}};
    std::vector<float> expected, found;
    for (const CacheRecord& record : cache.records())
      if (CacheWeight{}(record, at, accuracy) > 0) expected.push_back(record.irradiance[0]);
    cache.for_each_near(at, [&](const CacheRecord& record, float) { found.push_back(record.irradiance[0]); });
    std::ranges::sort(found);
    ASSERT_EQ(found, expected);
  }
}

// What one record saw at the distance 0.3, its neighbours see at 0.3 and the way to it at most.
TEST(CacheRecords, bound_the_distances_of_their_neighbours) {
  for (const bool clamping : {true, false})
    for (const bool small_first : {true, false}) {
      IrradianceCache cache({1, 0.01f, 10, true, clamping});
      const CacheRecord small{{{0, 0, 0}, {0, 0, 1}}, gray(1.0f), {}, 0.3f},
          large{{{0.5f, 0, 0}, {0, 0, 1}}, gray(1.0f), {}, 4};
      cache.insert(small_first ? small : large), cache.insert(small_first ? large : small);
      float largest = 0;
      for (const CacheRecord& record : cache.records()) largest = std::max(largest, record.distance);
      EXPECT_FLOAT_EQ(largest, clamping ? 0.8f : 4.0f);
    }
  IrradianceCache cache({0.5f, 0.1f, 1, true, true});
  cache.insert({{{0, 0, 0}, {0, 0, 1}}, gray(1.0f), {}, 1e-5f}),
      cache.insert({{{9, 0, 0}, {0, 0, 1}}, gray(1.0f), {}, nothing});
  EXPECT_FLOAT_EQ(cache.records()[0].distance, 0.2f);
  EXPECT_FLOAT_EQ(cache.records()[1].distance, 2.0f);
}

}  // namespace
}  // namespace montelux::test
