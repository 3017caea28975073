// The directional albedo of the models that estimate it: its mean is that of the weights of sampled directions, and by
// quadrature that of the values, with less noise than the weights.
#include <gtest/gtest.h>

#include <numbers>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

constexpr int draws = 20000;

struct Albedos {
  std::array<SampleSummary, 3> estimate, weight, difference;
};

// Estimates and weights by the same numbers.
template <BsdfKind kind>
Albedos albedos(const BsdfCase& c, Vec3f wo, double fault = 1) {
  RandomStream<float> stream(61, 62);
  std::array<std::vector<double>, 3> estimate, weight, difference;
  const BsdfLanes<float> lanes{std::uint32_t(kind), &c.row, true};
  for (int i = 0; i < draws; ++i) {
    const BsdfContext<float> context = context_of(stream);
    const float u = stream.next();
    const Vec2f u2 = stream.next2();
    const BsdfSample<float> drawn = sample<float>(lanes, wo, Vec3f{u, u2.x, u2.y}, context);
    const Rgb a = to_rgb(albedo<float>(lanes, wo, drawn, u2, context)), w = to_rgb(drawn.weight);
    for (std::size_t k = 0; k < 3; ++k) {
      estimate[k].push_back(fault * double(a.c[k]));
      weight[k].push_back(drawn.valid ? double(w.c[k]) * double(drawn.eta_scale) : 0);
      difference[k].push_back(estimate[k].back() - weight[k].back());
    }
  }
  Albedos all;
  for (std::size_t k = 0; k < 3; ++k)
    all.estimate[k] = summarize(estimate[k]), all.weight[k] = summarize(weight[k]),
    all.difference[k] = summarize(difference[k]);
  return all;
}

bool is_zero(const SampleSummary& difference, double scale) {
  const double distance = std::max(0.0, std::abs(difference.mean) - 1e-5 * scale);
  return distance == 0 || z_test(distance, difference.standard_error(), 0).p_value > sidak_level(family_level, 800);
}

TEST(BsdfAlbedo, has_the_mean_of_the_weights_and_less_noise) {
  for_each_kind([&]<BsdfKind kind>() {
    for (const BsdfCase& c : CasesOf<kind>::all()) {
      double noise = 0, noise_of_weights = 0;
      for (const Vec3f wo : outgoing_directions()) {
        const Albedos all = albedos<kind>(c, wo);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::string where = std::string(name(kind)) + ", " + c.label + ", wo.z = " + std::to_string(wo.z);
          const SampleSummary &e = all.estimate[k], &w = all.weight[k];
          EXPECT_TRUE(is_zero(all.difference[k], w.mean)) << where << ": " << e.mean << ", weights " << w.mean;
          noise += e.variance, noise_of_weights += w.variance;
        }
      }
      EXPECT_LE(noise, noise_of_weights * 1.001 + 1e-9) << name(kind) << ", " << c.label;
    }
  });
}

// By quadrature of the values over the hemispheres, where these are no estimates and nothing is a delta.
TEST(BsdfAlbedo, is_the_integral_of_the_value) {
  constexpr int rows = 400, columns = 256;
  int tested = 0;
  for_each_kind([&]<BsdfKind kind>() {
    for (const BsdfCase& c : CasesOf<kind>::all()) {
      const BsdfOf<kind, float> model(BsdfRows<float>{&c.row});
      const bool smooth = c.label.find("smooth") != std::string::npos || c.label.find("mirror") != std::string::npos ||
                          c.label.find("pane") == 0 || c.label == "green pane";
      if (is_layered<BsdfOf<kind, float>> || model.is_delta() || smooth || BsdfOf<kind, float>::name == "measured")
        continue;
      const Vec3f wo = direction(0.6f, 0.3f);
      RandomStream<float> stream(3, 4);
      const BsdfContext<float> context = context_of(stream, TransportMode::importance);
      std::array<double, 3> integral{};
      for (int side : {1, -1})
        for (int i = 0; i < rows; ++i)
          for (int j = 0; j < columns; ++j) {
            const float cos = (float(i) + 0.5f) / rows;
            const Vec3f wi = direction(float(side) * cos, (float(j) + 0.5f) / columns);
            const Rgb f = to_rgb(model.evaluate(wo, wi, context).f_cos);
            for (std::size_t k = 0; k < 3; ++k)
              integral[k] += double(f.c[k]) * 2 * std::numbers::pi / (rows * double(columns));
          }
      const Albedos all = albedos<kind>(c, wo), faulty = albedos<kind>(c, wo, 1.06);
      const auto agrees = [&](const SampleSummary& s, double truth) {
        const double distance = std::max(0.0, std::abs(s.mean - truth) - 2e-3 * truth);  // of the quadrature
        return distance == 0 || z_test(distance, s.standard_error(), 0).p_value > sidak_level(family_level, 200);
      };
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_TRUE(agrees(all.estimate[k], integral[k]))
            << name(kind) << ", " << c.label << ": " << all.estimate[k].mean << ", not " << integral[k];
        EXPECT_FALSE(agrees(faulty.estimate[k], integral[k])) << name(kind) << ", " << c.label;
      }
      ++tested;
    }
  });
  EXPECT_GT(tested, 20);
}

}  // namespace
}  // namespace montelux
