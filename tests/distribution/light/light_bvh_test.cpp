#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "light/builder.h"
#include "light/bvh.h"
#include "light/cluster_field.h"
#include "statistics.h"

namespace montelux {
namespace {

using test::chi_square_test;
using test::family_level;
using test::sidak_level;
using P = NativeFloats;

Vec3f in_box(RandomStream<float>& r, float size) { return Vec3f{r.next(), r.next(), r.next()} * size; }
Vec3f on_sphere(RandomStream<float>& r) {
  float z = 2 * r.next() - 1, s = safe_sqrt(1 - z * z);
  SinCos<float> a = sin_cos_two_pi(r.next());
  return {s * a.cos, s * a.sin, z};
}

// Triangles of all sizes and powers, some of them of two sides, with points and lights without a place among them.
LightSet mixed_lights(int triangles, std::uint32_t seed, LightSelection selection) {
  RandomStream<float> r(seed, 7);
  LightSetBuilder builder;
  for (int i = 0; i < triangles; ++i) {
    Vec3f p = in_box(r, 10);
    float size = exp(-6 * r.next());
    Emission e;
    e.radiance = gray_rgb(exp(4 * r.next()));
    e.two_sided = r.next() < 0.2f;
    builder.add(TriangleShape{p, p + on_sphere(r) * size, p + on_sphere(r) * size}, e);
    if (i % 8 != 3) continue;
    const Vec3f q = in_box(r, 10);
    builder.add_point(q, gray_rgb(r.next()));
  }
  builder.add_uniform_infinite(gray_rgb(0.5f));
  builder.add_distant({0, 0, 1}, gray_rgb(1.0f));
  return std::move(builder).build({selection}, {5, 5, 5}, 9);
}

constexpr LightSelection selections[] = {LightSelection::uniform, LightSelection::power, LightSelection::bvh};

// Those of the hierarchy, whose clusters have any factors: other ones at each of eight places.
LightSet with_factors(const LightSet& lights, std::uint32_t seed) {
  PlaceTree tree;
  tree.size = 12;
  for (std::uint32_t c = 0; c < PlaceTree::classes; ++c) tree.nodes[c] = PlaceTree::leaf | c;
  tree.nodes.back() = PlaceTree::classes;  // halved along x
  for (std::uint32_t k : {6u, 7u}) tree.nodes.push_back(PlaceTree::leaf | k);
  RandomStream<float> r(seed, 13);
  const std::size_t clusters = lights.hierarchy().numbered_nodes().size();
  const std::size_t beyond = lights.beyond().size(), columns = clusters + 1 + beyond;
  std::vector<float> factors(8 * columns);
  for (std::size_t i = 0; i < factors.size(); ++i) factors[i] = i % columns == 0 ? 1.0f : exp(-4 * r.next());
  return lights.with(std::make_shared<ClusterField>(std::move(tree), std::uint32_t(clusters), std::uint32_t(beyond),
                                                    std::move(factors)));
}

// A set of lights, chosen in each way: with few lights the hierarchy is scanned; of many it has clusters of several; of
// none with a place it is empty.
struct Way {
  std::string name;
  LightSet lights;
};
std::vector<Way> ways(int triangles, std::uint32_t seed) {
  std::vector<Way> all;
  for (LightSelection selection : selections)
    all.push_back(
        {std::string(light_selection_names[std::size_t(selection)]), mixed_lights(triangles, seed, selection)});
  for (int count : {0, 12, triangles, 300}) {
    const std::string name = "clusters, of " + std::to_string(count);
    all.push_back({name, with_factors(mixed_lights(count, seed, LightSelection::bvh), seed)});
  }
  return all;
}

TEST(LightChoice, masses_over_all_lights_sum_to_one) {
  for (const auto& [name, lights] : ways(60, 1)) {
    RandomStream<float> r(3, 4);
    for (int i = 0; i < 200; ++i) {
      Vec3f p = in_box(r, 12), n = i % 2 ? on_sphere(r) : Vec3f{0, 0, 0};
      double sum = 0;
      for (std::uint32_t k = 0; k < lights.count(); ++k) sum += lights.choice_mass<float>(k, p, n, true).value;
      // A branch of which neither half can send light keeps its share, so that a little may be lost, never won.
      EXPECT_LE(sum, 1 + 1e-5) << name;
      // With any factors it may be more: frequencies say how much, below.
      if (!name.starts_with("clusters")) {
        EXPECT_GT(sum, 0.6) << name;
      }
      if (name == "uniform" || name == "power") {
        EXPECT_NEAR(sum, 1, 1e-5);
      }
    }
  }
}

TEST(LightChoice, frequencies_match_masses_and_a_planted_fault_is_found) {
  const int points = 8, draws = 20000;
  const std::vector<Way> all = ways(40, 2);
  for (const auto& [name, lights] : all) {
    RandomStream<float> r(5, 6);
    for (int i = 0; i < points; ++i) {
      Vec3f p = in_box(r, 12), n = i % 2 ? on_sphere(r) : Vec3f{0, 0, 0};
      std::vector<double> seen(lights.count() + 1), expected(lights.count() + 1);
      for (int k = 0; k < draws; ++k) {
        LightChoice<float> c = lights.choose(p, n, r.next(), true);
        seen[c.valid ? c.light : lights.count()] += 1;
        if (c.valid) {
          ASSERT_EQ(c.mass.value, lights.choice_mass<float>(c.light, p, n, true).value);
        }
      }
      double rest = draws;
      for (std::uint32_t k = 0; k < lights.count(); ++k) {
        expected[k] = draws * double(lights.choice_mass<float>(k, p, n, true).value);
        rest -= expected[k];
      }
      // Nothing chosen: a branch whose halves both cannot reach the point. Rounding of the sum is no such branch.
      expected.back() = rest > 1e-5 * draws ? rest : 0;
      double level = sidak_level(family_level, double(points * all.size()));
      test::TestResult fit = chi_square_test(seen, expected);
      EXPECT_GT(fit.p_value, level) << name << ": " << fit.note << " " << fit.statistic << " at " << fit.degrees;
      // A choice that confuses two neighbours in the order.
      std::rotate(seen.begin(), seen.begin() + 1, seen.end());
      if (name != "uniform") {
        EXPECT_LT(chi_square_test(seen, expected).p_value, level) << name;
      }
    }
  }
}

// The planted fault: masses that do not know the factors, also of lights without a place.
TEST(LightChoice, masses_without_the_factors_of_the_choice_are_rejected) {
  const int points = 8, draws = 20000;
  for (int count : {0, 12, 300}) {
    const LightSet plain = mixed_lights(count, 2, LightSelection::bvh), known = with_factors(plain, 2);
    RandomStream<float> r(5, 6);
    int rejected = 0;
    for (int i = 0; i < points; ++i) {
      const Vec3f p = in_box(r, 12), n = i % 2 ? on_sphere(r) : Vec3f{0, 0, 0};
      std::vector<double> seen(plain.count() + 1), expected(plain.count() + 1);
      for (int k = 0; k < draws; ++k) {
        const LightChoice<float> c = known.choose(p, n, r.next(), true);
        seen[c.valid ? c.light : plain.count()] += 1;
      }
      double rest = draws;
      for (std::uint32_t k = 0; k < plain.count(); ++k) {
        expected[k] = draws * double(plain.choice_mass<float>(k, p, n, true).value);
        rest -= expected[k];
      }
      expected.back() = std::max(rest, 0.0);
      rejected += chi_square_test(seen, expected).p_value < sidak_level(family_level, points);
    }
    // By chance the factors of sun and sky may be alike in a leaf, of which half of the points share two.
    EXPECT_GE(rejected, count == 0 ? points / 2 : points) << count;
  }
}

TEST(LightChoice, no_light_that_reaches_a_point_has_probability_zero) {
  RandomStream<float> r(8, 9);
  int contributing = 0;
  for (std::uint32_t scene = 0; scene < 30; ++scene) {
    LightSet lights = mixed_lights(scene < 10 ? 3 : scene < 25 ? 60 : 300, 100 + scene, LightSelection::bvh);
    for (int i = 0; i < 60; ++i) {
      Vec3f p = in_box(r, 12), n = i % 2 ? on_sphere(r) : Vec3f{0, 0, 0};
      for (std::uint32_t k = 0; k < lights.count(); ++k)
        for (int s = 0; s < 4; ++s) {
          LightSample<float> sample = lights.sample_light<float>(k, p, n, {r.next(), r.next()}, true);
          if (!sample.valid || is_black(sample.radiance) || (i % 2 && dot(sample.wi, n) <= 0)) continue;
          ++contributing;
          ASSERT_GT(lights.choice_mass<float>(k, p, n, true).value, 0.0f)
              << light_kind_names[std::size_t(lights.kind(LightId(k)))];
        }
    }
  }
  EXPECT_GT(contributing, 10000);
}

TEST(LightChoice, lanes_choose_as_one_float_does) {
  for (const Way& way : ways(50, 3)) {
    const LightSet& lights = way.lights;
    SCOPED_TRACE(way.name);
    RandomStream<float> r(10, 11);
    for (int i = 0; i < 200; ++i) {
      Vec3<P> p, n;
      P u;
      Mask<P> on = mask_of_bits<P>(mix_bits(std::uint32_t(i)));
      for (int k = 0; k < native_lanes; ++k) {
        set_lane(p, k, in_box(r, 12));
        set_lane(n, k, k % 3 ? on_sphere(r) : Vec3f{0, 0, 0});
        set_lane(u, k, r.next());
      }
      LightChoice<P> c = lights.choose(p, n, u, on);
      Mass<P> mass = lights.choice_mass(c.light, p, n, Mask<P>(on & c.valid));
      for_each_lane(on, [&](int k) {
        LightChoice<float> one = lights.choose(lane(p, k), lane(n, k), lane(u, k), true);
        ASSERT_EQ(lane(c.valid, k), one.valid);
        if (!one.valid) return;
        EXPECT_EQ(lane(c.light, k), one.light);
        EXPECT_EQ(lane(c.mass.value, k), one.mass.value);
        EXPECT_EQ(lane(mass.value, k), one.mass.value);
      });
    }
  }
}

// One point light of intensity 1 at distance d, so that the hierarchy's estimate 1 / d^2 is exact, beside lights
// without a place. The share of these, of irradiance E, is E / (E + 1 / d^2) between a third of their equal share and
// all of it.
TEST(LightChoice, lights_without_a_place_have_the_share_of_their_irradiance) {
  const float radiance = 0.25f, sun = 0.5f;  // a sky has the irradiance pi L
  for (const bool has_sun : {false, true}) {
    LightSetBuilder builder;
    builder.add_point({0, 0, 0}, gray_rgb(1.0f));
    builder.add_uniform_infinite(gray_rgb(radiance));
    if (has_sun) builder.add_distant({0, 0, 1}, gray_rgb(sun));
    const LightSet lights = std::move(builder).build({LightSelection::bvh}, {0, 0, 0}, 7);
    const double number = has_sun ? 2 : 1, equal = number / (number + 1);
    const double irradiance = pi * double(radiance) + (has_sun ? double(sun) : 0.0);
    int lowest = 0, equals = 0, between = 0;
    for (float d = 0.125f; d < 8; d *= 1.25f) {
      double share = 0;
      for (std::uint32_t k = 1; k < lights.count(); ++k)
        share += double(lights.choice_mass<float>(k, {0, d, 0}, {0, 0, 0}, true).value);
      const auto truth = [&](double e) {
        const double by_irradiance = e / (e + 1 / (double(d) * double(d)));
        return std::clamp(by_irradiance, equal / 3, equal);
      };
      EXPECT_NEAR(share, truth(irradiance), 1e-5) << d;
      const double by_irradiance = irradiance / (irradiance + 1 / (double(d) * double(d)));
      if (by_irradiance < equal / 3) ++lowest;
      if (by_irradiance > equal) ++equals;
      if (by_irradiance > equal / 3 && by_irradiance < equal) {
        ++between;
        // A planted fault: the power of a sky counts as that of parallel light.
        EXPECT_GT(std::abs(share - truth(4 * pi * double(radiance) + (has_sun ? double(sun) : 0.0))), 1e-3) << d;
      }
    }
    EXPECT_GT(lowest, 1);
    EXPECT_GT(equals, 1);
    EXPECT_GT(between, 1);
  }
}

// Behind a lamp of one side nothing is left to the lamp.
TEST(LightChoice, is_among_lights_without_a_place_where_no_other_emits_to) {
  LightSetBuilder builder;
  Emission lamp;
  lamp.radiance = gray_rgb(1.0f);
  builder.add(TriangleShape{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, lamp);
  builder.add_uniform_infinite(gray_rgb(1e-3f));
  const LightSet lights = std::move(builder).build({LightSelection::bvh}, {0, 0, 0}, 7);
  const auto of_sky = [&](Vec3f p) { return lights.choice_mass<float>(1u, p, {0, 0, 0}, true).value; };
  const float front = of_sky({0.3f, 0.3f, 2}), back = of_sky({0.3f, 0.3f, -2});
  EXPECT_EQ(std::max(front, back), 1.0f);
  EXPECT_LT(std::min(front, back), 0.5f);
}

}  // namespace
}  // namespace montelux
