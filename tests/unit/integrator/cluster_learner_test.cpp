// What shadow rays teach the choice of a light.
#include "integrator/guiding/cluster_learner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/builder.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// Point lights of intensity 1 in a row over a floor, each one lit up to the place right beneath it: y = 0, |x| < 1.
LightSet row_of_lights(int count) {
  LightSetBuilder builder;
  for (int i = 0; i < count; ++i) builder.add_point({-1 + 2 * (float(i) + 0.5f) / float(count), 1, 0}, gray_rgb(1.0f));
  return std::move(builder).build({LightSelection::bvh}, {0, 0, 0}, 3);
}
const Vec3f up{0, 1, 0};

// Rays of random places to lights that the hierarchy chooses. A wall at x = 0 hides the lights of the other side.
void teach(ClusterLearner& learner, const LightSet& lights, int rounds, int records) {
  RandomStream<float> r(3, 5);
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) learner.refine(300);
    for (int i = 0; i < records; ++i) {
      const Vec3f p{2 * r.next() - 1, 0, 0.2f * r.next()};
      const LightChoice<float> choice = lights.hierarchy().choose<float>(p, up, r.next(), true);
      const LightSample<float> light = lights.sample_light<float>(choice.light, p, up, r.next2(), true);
      const bool right = choice.light >= lights.count() / 2;
      learner.add({p, up, LightId(choice.light), choice.mass.value, dot(up, light.wi) * average(light.radiance),
                   right == (p.x > 0)});
    }
  }
}

// The share of the light that comes from lights behind the wall, as they are chosen.
double hidden_share(const LightSet& lights, Vec3f p) {
  double hidden = 0;
  for (std::uint32_t k = 0; k < lights.count(); ++k)
    if ((k >= lights.count() / 2) != (p.x > 0)) hidden += double(lights.choice_mass<float>(k, p, up, true).value);
  return hidden;
}

// A sun, which a wall at x = 0 hides where x < 0, and a sky, which it does not hide; with a row of lights, and without.
TEST(ClusterLearner, leaves_a_light_without_a_place_where_it_is_hidden_and_a_planted_fault_is_found) {
  for (const auto& [placed, has_wall] : {std::pair(0, true), std::pair(10, true), std::pair(10, false)}) {
    LightSetBuilder builder;
    for (int i = 0; i < placed; ++i) builder.add_point({-0.9f + 0.2f * float(i), 1, 0}, gray_rgb(1.0f));
    builder.add_uniform_infinite(gray_rgb(0.5f));
    builder.add_distant({0, 1, 0}, gray_rgb(2.0f));
    const LightSet lights = std::move(builder).build({LightSelection::bvh}, {0, 0, 0}, 3);
    ASSERT_EQ(lights.beyond().size(), 2u);
    const std::uint32_t sky = lights.beyond()[0], sun = lights.beyond()[1];
    ClusterLearner learner(std::vector<Vec3f>{{-1, 0, 0}, {1, 0, 0}}, lights);
    RandomStream<float> r(3, 5);
    for (int round = 0; round < 4; ++round) {
      if (round > 0) learner.refine(300);
      for (int i = 0; i < 20000; ++i) {
        const Vec3f p{2 * r.next() - 1, 0, 0.2f * r.next()};
        LightChoice<float> choice{i % 3 == 0 ? sun : sky, {1}, true};
        if (i % 3 == 2 && placed > 0) choice = lights.hierarchy().choose<float>(p, up, r.next(), true);
        const LightSample<float> light = lights.sample_light<float>(choice.light, p, up, r.next2(), true);
        const float contribution = std::max(dot(up, light.wi), 0.0f) * average(light.radiance) / light.density.value;
        learner.add({p, up, LightId(choice.light), choice.mass.value, contribution,
                     choice.light != sun || p.x > 0 || !has_wall});
      }
    }
    const LightSet learned = lights.with(std::make_shared<ClusterField>(learner.field()));
    const auto mass = [&](std::uint32_t light, float x) {
      return double(learned.choice_mass<float>(light, Vec3f{x, 0, 0.1f}, up, true).value);
    };
    const double equal = 0.1 / (placed > 0 ? 3 : 2);  // a tenth of the choices are equal
    for (float x : {0.2f, 0.5f, 0.9f}) {
      const double of_hidden_sun = mass(sun, -x) - equal, of_sun = mass(sun, x) - equal;
      // The fault: rays that do not say what is in the way.
      if (!has_wall) {
        EXPECT_GT(of_hidden_sun, 0.5 * of_sun) << x;
        continue;
      }
      EXPECT_GE(of_hidden_sun, 0) << x;
      EXPECT_LT(of_hidden_sun, 0.1 * of_sun) << x;
      // The sun sends 2, and the sky pi / 2, of which each sample contributes as much: its density is that of the
      // cosine. A few records of the places around count, too, which see less of the sun.
      const double ratio = of_sun / (mass(sky, x) - equal), expected = 2 / (double(pi) / 2);
      EXPECT_LT(ratio, 1.001 * expected) << x;
      EXPECT_GT(ratio, 0.99 * expected) << x;
      EXPECT_GT(mass(sky, -x), mass(sky, x)) << x;
    }
  }
}

// Few lights, which are scanned; many, each a cluster; more than there are clusters.
class ClusterLearnerOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Lights, ClusterLearnerOf, testing::Values(2, 10, 100, 1000));

TEST_P(ClusterLearnerOf, leaves_lights_behind_a_wall_for_those_that_arrive) {
  const LightSet lights = row_of_lights(GetParam());
  ClusterLearner learner(std::vector<Vec3f>{{-1, 0, 0}, {1, 0, 0}}, lights);
  teach(learner, lights, 4, 20000);
  const LightSet learned = lights.with(std::make_shared<ClusterField>(learner.field()));
  for (float x : {-0.8f, -0.3f, -0.1f, 0.1f, 0.4f, 0.9f}) {
    const Vec3f p{x, 0, 0.1f};
    const double before = hidden_share(lights, p), after = hidden_share(learned, p);
    EXPECT_LT(after, 0.65 * before) << x << ": " << before;
    EXPECT_GT(after, 0) << x;
    for (std::uint32_t k = 0; k < lights.count(); ++k)
      ASSERT_GT(learned.choice_mass<float>(k, p, up, true).value, 0.0f) << k;
  }
}

// Where everything arrives the hierarchy chooses as it does on its own, up to what it misjudges and the noise of
// records.
TEST_P(ClusterLearnerOf, changes_little_where_nothing_is_hidden) {
  const LightSet lights = row_of_lights(GetParam());
  ClusterLearner learner(std::vector<Vec3f>{{-1, 0, 0}, {1, 0, 0}}, lights);
  RandomStream<float> r(3, 5);
  for (int i = 0; i < 40000; ++i) {
    const Vec3f p{2 * r.next() - 1, 0, 0.2f * r.next()};
    const LightChoice<float> choice = lights.hierarchy().choose<float>(p, up, r.next(), true);
    const LightSample<float> light = lights.sample_light<float>(choice.light, p, up, r.next2(), true);
    learner.add({p, up, LightId(choice.light), choice.mass.value, dot(up, light.wi) * average(light.radiance), true});
  }
  const LightSet learned = lights.with(std::make_shared<ClusterField>(learner.field()));
  for (float x : {-0.7f, 0.2f, 0.6f}) {
    const Vec3f p{x, 0, 0.1f};
    double distance = 0;  // half the sum of the differences: the share of the choices that have changed
    for (std::uint32_t k = 0; k < lights.count(); ++k)
      distance += 0.5 * double(std::abs(learned.choice_mass<float>(k, p, up, true).value -
                                        lights.choice_mass<float>(k, p, up, true).value));
    EXPECT_LT(distance, 0.25) << x;
  }
}

// Of another orientation nothing was learned: there, what is expected is that everything arrives.
TEST(ClusterLearner, changes_little_where_there_are_no_records) {
  const LightSet lights = row_of_lights(10);
  ClusterLearner learner(std::vector<Vec3f>{{-1, 0, 0}, {1, 0, 0}}, lights);
  teach(learner, lights, 4, 20000);
  const LightSet learned = lights.with(std::make_shared<ClusterField>(learner.field()));
  const Vec3f p{0.5f, 0, 0.1f};
  // How well importances estimate contributions was learned of the other orientation, and differs by some percent from
  // light to light.
  for (std::uint32_t k = 0; k < lights.count(); ++k) {
    const auto mass = [&](const LightSet& set, Vec3f n) { return double(set.choice_mass<float>(k, p, n, true).value); };
    EXPECT_NEAR(mass(learned, {0, 0, 0}), mass(lights, {0, 0, 0}), 0.15 * mass(lights, {0, 0, 0})) << k;
    if (k < lights.count() / 2) {
      EXPECT_LT(mass(learned, up), 0.6 * mass(lights, up)) << k;
    }
  }
}

}  // namespace
}  // namespace montelux::test
