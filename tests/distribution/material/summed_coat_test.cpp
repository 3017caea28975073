// Coats over Lambert's law whose walks are summed in closed form, against the walks themselves, their own density, and
// the series of a smooth coat.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cases.h"
#include "material/coat_table.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

struct Coats {
  BsdfCase walked, summed;
};
std::vector<Coats> coats() {
  const CoatCase all[] = {{.alpha_x = 0.4f, .alpha_y = 0.4f},
                          {.alpha_x = 0.05f, .alpha_y = 0.3f, .thickness = 0.3f, .max_depth = 5},
                          {.alpha_x = 0.2f, .alpha_y = 0.2f, .eta = 2, .max_depth = 100},
                          {.alpha_x = 0.8f, .alpha_y = 0.8f},  // too rough for a series
                          {.thickness = 0.1f}};
  std::vector<Coats> result;
  for (const CoatCase& c : all) result.push_back({coated_diffuse_case("", c, 0.9f), summed_coat_case("", c, 0.9f)});
  return result;
}

SampleSummary mean_value(const BsdfCase& c, Vec3f wo, Vec3f wi, int count, std::uint32_t seed, TransportMode mode) {
  const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
  RandomStream<float> stream(seed, 3u);
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(double(model.evaluate(wo, wi, context_of(stream, mode)).f_cos[1]));
  return summarize(x);
}

TEST(SummedCoat, value_is_that_of_the_walks) {
  std::uint32_t seed = 10;
  for (const Coats& c : coats())
    for (const TransportMode mode : {TransportMode::radiance, TransportMode::importance})
      for (const Vec3f wi : {direction(0.35f, 0.9f), direction(0.9f, 0.3f)}) {
        const Vec3f wo = direction(0.6f, 0.2f);
        const SampleSummary walked = mean_value(c.walked, wo, wi, 60000, ++seed, mode);
        SampleSummary summed = mean_value(c.summed, wo, wi, 20000, ++seed, mode);
        EXPECT_GT(welch_test(walked, summed).p_value, sidak_level(family_level, 20))
            << walked.mean << " by walks, " << summed.mean;
        summed.mean *= 1.04;
        EXPECT_LT(welch_test(walked, summed).p_value, sidak_level(family_level, 20));
      }
}

TEST(SummedCoat, rough_directions_follow_the_density) {
  std::uint32_t seed = 40;
  for (const BsdfCase& c : {summed_coat_case("", {.alpha_x = 0.4f, .alpha_y = 0.4f}, 0.3f),
                            summed_coat_case("", {.alpha_x = 0.2f, .alpha_y = 0.5f, .eta = 1.8f}, 0.8f)}) {
    const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
    RandomStream<float> none(9, 1u);
    const BsdfContext<float> context = context_of(none);
    for (const Vec3f wo : outgoing_directions()) {
      const auto test = [&](auto fault) {
        return chi_square_sample_density(
            [&](RandomStream<float>& stream) {
              const float u = stream.next();
              const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
              return s.valid ? s.wi : Vec3f{0, 0, 0};
            },
            [&](Vec3f wi) { return fault(model.evaluate(wo, wi, context).density.value, wi); }, 100000, seed,
            LocalFrame<float>::from_normal({0, 0, 1}), 2);
      };
      seed += 2;
      const TestResult right = test([](float p, Vec3f) { return p; });
      EXPECT_GT(right.p_value, sidak_level(family_level, 16)) << "wo.z = " << wo.z << ": " << right.note;
      const TestResult wrong = test([](float p, Vec3f wi) { return p * (wi.x > 0 ? 1.05f : 0.95f); });
      EXPECT_LT(wrong.p_value, sidak_level(family_level, 16)) << "wo.z = " << wo.z;
    }
  }
}

// A smooth coat over white reflects 4 % of the light, but what it mirrors has a fifth of the samples; over black it has
// nearly all of them. The samples divide an interval of u, so that equidistant ones count exactly.
TEST(SummedCoat, mirror_image_has_a_fifth_of_the_samples_at_least) {
  const auto mirrored = [](float reflectance) {
    const BsdfCase c = summed_coat_case("", {}, reflectance);
    const CoatedDiffuse<float> model(BsdfRows<float>{&c.row});
    RandomStream<float> none(9, 1u);
    constexpr int samples = 1000;
    int count = 0;
    for (int i = 0; i < samples; ++i) {
      const float u = (float(i) + 0.5f) / samples;
      const BsdfSample<float> s = model.sample(direction(0.9f, 0.4f), u, {0.3f, 0.6f}, context_of(none));
      count += s.valid && s.delta;
    }
    return count;
  };
  EXPECT_EQ(mirrored(0.9f), 200);
  EXPECT_GT(mirrored(0.001f), 900);
}

// The internal reflectance of a smooth coat is one integral of Fresnel's law.
TEST(SummedCoat, internal_reflectance_of_a_smooth_coat_is_an_integral_over_angles) {
  for (const float eta : {1.2f, 1.5f, 2.4f})
    for (const float thickness : {1e-30f, 0.01f, 0.5f}) {
      const double truth = integrate(
          [&](double mu) {
            return 2 * mu * double(fresnel_dielectric(float(-mu), eta)) * std::exp(-2 * double(thickness) / mu);
          },
          0, 1, 20000);
      EXPECT_NEAR(internal_reflectance({{0, 0}, eta, thickness}), truth, 1e-4 * truth) << eta << " " << thickness;
    }
}

// The transmittance by Walter et al. 2007, eq. 21, as an integral over the normals m of all facets: of the light that
// falls on them the part that enters, is not masked (Heitz 2014, eq. 99) and crosses the layer.
double transmittance(double c, double alpha, double eta, double thickness) {
  const double s = std::sqrt(1 - c * c);
  const auto lambda = [&](double cosine) {
    return (std::sqrt(1 + alpha * alpha * (1 - cosine * cosine) / (cosine * cosine)) - 1) / 2;
  };
  constexpr int slopes = 300, azimuths = 100;
  double sum = 0;
  for (int j = 0; j < slopes; ++j) {
    // 1 - u is the square of `rest`: the steepest facets, whose part is large, are then as dense as others.
    const double rest = 1 - (j + 0.5) / slopes, u = 1 - rest * rest;
    const double tan2 = alpha * alpha * u / (rest * rest), m_z = 1 / std::sqrt(1 + tan2);
    for (int k = 0; k < azimuths; ++k) {
      const double m_x = m_z * std::sqrt(tan2) * std::cos(std::numbers::pi * (k + 0.5) / azimuths);
      const double cos_i = s * m_x + c * m_z;
      if (cos_i <= 0) continue;
      const double cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (eta * eta));
      const double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t), q = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
      const double down = m_z * (cos_t - cos_i / eta) + c / eta;  // the cosine of the refracted direction
      if (down <= 0) continue;
      const double facing = cos_i / (m_z * c), seen = 1 / (1 + lambda(c) + lambda(down));
      sum += 2 * rest * (1 - (p * p + q * q) / 2) * facing * seen * std::exp(-thickness / down);
    }
  }
  return sum / (slopes * azimuths);
}

struct SeriesError {
  double largest = 0, mean = 0;  // above the horizon
  double horizon = 0;
};
SeriesError error_of_series(const CoatParameters& coat, float alpha_of_series,
                            const std::array<float, coat_transmittance::terms>& series) {
  SeriesError r;
  const auto error_at = [&](double c) {
    const double stated = double(coat_transmittance::at(float(c), alpha_of_series, coat.eta, coat.thickness, series));
    return std::abs(stated - transmittance(c, double(coat.alpha.x), double(coat.eta), double(coat.thickness)));
  };
  for (const double c : {0.002, 0.004, 0.01}) r.horizon = std::max(r.horizon, error_at(c));
  constexpr int cosines = 24;
  for (int i = 0; i < cosines; ++i) {
    const double error = error_at((i + 0.5) / cosines);
    r.largest = std::max(r.largest, error), r.mean += error / cosines;
  }
  return r;
}
SeriesError error_of_series(float alpha, float eta, float thickness, float alpha_of_series) {
  return error_of_series({{alpha, alpha}, eta, thickness}, alpha_of_series,
                         coat_transmittance::series({{alpha_of_series, alpha_of_series}, eta, thickness}));
}

// The planted fault: the series of a coat that is less rough.
TEST(SummedCoat, transmittance_is_the_integral_over_all_facets) {
  for (const float eta : {1.3f, 1.5f, 2.0f, 4.0f})
    for (const float alpha : {0.002f, 0.01f, 0.05f, 0.2f, 0.35f, 0.6f})
      for (const float thickness : {1e-30f, 0.01f, 0.5f}) {
        const SeriesError error = error_of_series(alpha, eta, thickness, alpha);
        EXPECT_LT(error.horizon, 2e-3) << eta << " " << alpha << " " << thickness;
        EXPECT_LT(error.largest, 5e-4) << eta << " " << alpha << " " << thickness;
        EXPECT_LT(error.mean, 1.5e-4) << eta << " " << alpha << " " << thickness;
        const SeriesError fault = error_of_series(alpha, eta, thickness, 0.85f * alpha);
        EXPECT_TRUE(fault.horizon > 2e-3 || fault.largest > 5e-4) << eta << " " << alpha << " " << thickness;
      }
}

// A texture's roughness is between those of the table. The planted fault: a roughness that is less by two fifths.
TEST(SummedCoat, table_has_the_transmittance_of_every_roughness) {
  for (const float eta : {1.3f, 1.5f, 2.4f}) {
    constexpr float thickness = 0.01f;
    const CoatTable table(eta, thickness);
    for (const float alpha : {0.0013f, 0.0023f, 0.007f, 0.031f, 0.0953f, 0.107f, 0.333f, 0.587f}) {
      const SeriesError error = error_of_series({{alpha, alpha}, eta, thickness}, alpha, table.at(alpha).series);
      EXPECT_LT(error.horizon, 2e-3) << eta << " " << alpha;
      EXPECT_LT(error.largest, 6e-4) << eta << " " << alpha;
      EXPECT_LT(error.mean, 1.5e-4) << eta << " " << alpha;
      const SeriesError fault =
          error_of_series({{alpha, alpha}, eta, thickness}, 0.6f * alpha, table.at(0.6f * alpha).series);
      EXPECT_TRUE(fault.horizon > 2e-3 || fault.largest > 6e-4) << eta << " " << alpha;
    }
  }
}

// The planted fault: a layer that is thicker by a twentieth.
TEST(SummedCoat, table_has_the_internal_reflectance_of_every_roughness) {
  constexpr float eta = 1.5f, thickness = 0.2f;
  const CoatTable table(eta, thickness), thicker(eta, 1.05f * thickness);
  for (const float alpha : {0.0005f, 0.0013f, 0.02f, 0.11f, 0.37f, 0.62f, 0.93f}) {
    const double truth = double(internal_reflectance({{alpha, alpha}, eta, thickness}));
    EXPECT_NEAR(double(table.at(alpha).internal), truth, 3e-3 * truth) << alpha;
    EXPECT_LT(double(thicker.at(alpha).internal), (1 - 3e-3) * truth) << alpha;
  }
}

// In all lanes at once, smooth and rough ones, and beyond what is known.
TEST(SummedCoat, table_is_read_in_lanes_as_in_one) {
  const CoatTable table(1.5f, 0.01f);
  constexpr std::array alphas{0.0f, 0.0005f, 0.001f, 0.02f, 0.3f, 0.6f, 0.601f, 0.9f, 1.1f, 7.0f};
  NativeFloats alpha(0.0f);
  for (std::size_t k = 0; k < std::size_t(native_lanes); ++k) set_lane(alpha, int(k), alphas[k % alphas.size()]);
  const auto known = table.at(alpha);
  for (int k = 0; k < native_lanes; ++k) {
    const auto one = table.at(lane(alpha, k));
    EXPECT_EQ(lane(known.internal, k), one.internal) << k;
    for (std::size_t term = 0; term < one.series.size(); ++term)
      EXPECT_EQ(lane(known.series[term], k), one.series[term]) << k << " " << term;
  }
  EXPECT_EQ(table.at(0.0005f).series, (std::array<float, coat_transmittance::terms>{}));
  EXPECT_LT(table.at(0.6f).series[0], 1);
  EXPECT_EQ(table.at(0.601f).series[0], coat_transmittance::none);
  EXPECT_GT(table.at(0.99f).internal, 0);
  EXPECT_EQ(table.at(1.1f).internal, 0);
  EXPECT_EQ(CoatTable(5, 0.01f).at(0.1f).series[0], coat_transmittance::none);
}

// A smooth coat has a series of zeros; a coat with a direction, a very rough one, or one of an index near 1 or below,
// none.
TEST(SummedCoat, transmittance_has_a_series_where_it_depends_on_the_cosine_alone) {
  for (const float term : coat_transmittance::series({{0, 0}, 1.5f, 0.1f})) EXPECT_NEAR(term, 0, 1e-6);
  EXPECT_EQ(coat_transmittance::series({{0.1f, 0.2f}, 1.5f, 0.1f})[0], coat_transmittance::none);
  EXPECT_EQ(coat_transmittance::series({{0.7f, 0.7f}, 1.5f, 0.1f})[0], coat_transmittance::none);
  for (const float eta : {0.7f, 1.1f, 5.0f})
    EXPECT_EQ(coat_transmittance::series({{0.1f, 0.1f}, eta, 0.1f})[0], coat_transmittance::none);
}

}  // namespace
}  // namespace montelux
