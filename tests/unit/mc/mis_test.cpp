#include "mc/mis.h"

#include <gtest/gtest.h>

#include <vector>

#include "mc/random.h"

namespace montelux {
namespace {

using F = NativeFloats;

TEST(Mis, weights_of_all_techniques_sum_to_one_and_vanish_with_the_density) {
  for (const NamedMisHeuristic& entry : mis_heuristic_names) {
    EXPECT_EQ(mis_heuristic_named(entry.name), entry.heuristic);
    RandomStream<float> stream(1, 2);
    for (int i = 0; i < 1000; ++i) {
      std::vector<float> products;
      for (int j = 0; j < 5; ++j) {
        const float u = stream.next();
        products.push_back(u < 0.2f ? 0.0f : std::pow(10.0f, 60 * u - 30));
      }
      if (i % 10 == 0) products[3] = products[1];
      float sum = 0, largest = 0;
      for (std::size_t j = 0; j < 5; ++j) {
        const float w = mis_weight<float>(entry.heuristic, products, j);
        if (products[j] == 0) {
          EXPECT_EQ(w, 0);
        }
        sum += w, largest = std::max(largest, products[j]);
      }
      if (largest > 0) {
        EXPECT_NEAR(sum, 1, 1e-6) << entry.name;
      }
    }
  }
}

TEST(Mis, two_techniques_have_the_weights_of_the_general_form_in_every_lane) {
  RandomStream<float> stream(4, 2);
  for (int i = 0; i < 300; ++i) {
    F a, b;
    for (int k = 0; k < native_lanes; ++k)
      set_lane(a, k, std::pow(10.0f, 20 * stream.next() - 10)),
          set_lane(b, k, std::pow(10.0f, 20 * stream.next() - 10));
    const F balance = balance_weight(a, b), power = power_weight(a, b);
    const std::array<F, 2> both{a, b};
    const F general = mis_weight<F>(MisHeuristic::power, both, 0);
    for (int k = 0; k < native_lanes; ++k) {
      const std::array<float, 2> one{lane(a, k), lane(b, k)};
      EXPECT_NEAR(lane(balance, k), mis_weight<float>(MisHeuristic::balance, one, 0), 1e-6);
      EXPECT_NEAR(lane(power, k), mis_weight<float>(MisHeuristic::power, one, 0), 1e-6);
      EXPECT_EQ(lane(general, k), mis_weight<float>(MisHeuristic::power, one, 0));
    }
  }
}

TEST(Mis, weights_stay_finite_at_the_ends_of_the_range) {
  EXPECT_EQ(balance_weight(0.0f, 0.0f), 0);
  EXPECT_EQ(power_weight(0.0f, 1.0f), 0);
  EXPECT_EQ(power_weight(1.0f, 0.0f), 1);
  EXPECT_NEAR(power_weight(1e30f, 1e30f), 0.5f, 1e-6);
  EXPECT_NEAR(power_weight(1e-30f, 1e30f), 0, 1e-6);
  EXPECT_NEAR(balance_weight(3.0f, 1.0f), 0.75f, 1e-7);
  EXPECT_NEAR(balance_weight(2.0f, Density<SolidAngle>{3}, 1.0f, Density<SolidAngle>{2}), 0.75f, 1e-7);
}

}  // namespace
}  // namespace montelux
