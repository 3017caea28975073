// Coated models, whose values are estimates, against themselves and against closed forms and quadrature.
#include <gtest/gtest.h>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

// The mean of a model's f |cos| for one pair of directions, by component.
template <class Model>
SampleSummary mean_value(const Model& model, Vec3f wo, Vec3f wi, int count, std::uint32_t seed, int component = 0) {
  RandomStream<float> stream(seed, 3u);
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(model.evaluate(wo, wi, context_of(stream)).f_cos[component]);
  return summarize(x);
}

CoatedDiffuse<float> coated_diffuse(const CoatCase& coat, float reflectance) {
  const BsdfCase c = coated_diffuse_case("", coat, reflectance);
  return CoatedDiffuse<float>(BsdfRows<float>{&c.row});
}

// ---- against itself: drawn directions and uniform ones see the same light
// --------------------------------------------

constexpr int cells_z = 3, cells_azimuth = 4, cells = cells_z * cells_azimuth;
int cell_of(Vec3f w) {
  const double turns = std::atan2(double(w.y), double(w.x)) / (2 * std::numbers::pi) + 0.5;
  const int row = std::min(cells_z - 1, int(std::abs(w.z) * cells_z));
  return row * cells_azimuth + std::min(cells_azimuth - 1, int(turns * cells_azimuth));
}
struct Sums {
  std::vector<double> first = std::vector<double>(cells + 1), second = std::vector<double>(cells + 1);
  void add(int cell, double x) {
    // The last cell is the whole hemisphere.
    for (const int k : {cell, cells}) first[std::size_t(k)] += x, second[std::size_t(k)] += x * x;
  }
  SampleSummary of(std::size_t k, double n) const {
    const double mean = first[k] / n;
    return {mean, std::max(0.0, second[k] / n - mean * mean), n};
  }
};

// The least p-value over the cells that the light reflected into a cell is the same by sample() and by evaluate().
template <class Model>
double sample_against_value(const Model& model, Vec3f wo, double fault, std::uint32_t seed,
                            Densities densities = Densities::for_weights) {
  constexpr int count = 50000;
  Sums drawn, uniform;
  RandomStream<float> stream(seed, 9u);
  for (int i = 0; i < count; ++i) {
    BsdfContext<float> context = context_of(stream);
    context.densities = densities;
    const float u = stream.next();
    const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
    if (s.valid && !s.delta) drawn.add(cell_of(s.wi), s.weight[0] * fault);
    // Cosine-distributed directions for the integral of the value.
    const Vec2f u2 = stream.next2();
    const Vec3f wi = sample_cosine_side(wo, u2);
    const BsdfContext<float> other = context_of(stream);
    uniform.add(cell_of(wi), model.evaluate(wo, wi, other).f_cos[0] / double(cosine_density(wi)));
  }
  double smallest = 1;
  for (std::size_t k = 0; k <= cells; ++k)
    smallest = std::min(smallest, welch_test(drawn.of(k, count), uniform.of(k, count)).p_value);
  return std::min(1.0, smallest * (cells + 1));
}

TEST(LayeredBsdf, sampled_weights_integrate_the_value) {
  std::uint32_t seed = 100;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if constexpr (is_layered<Model>) {
      if (model.is_delta()) return;
      for (const Vec3f wo : outgoing_directions())
        EXPECT_GT(sample_against_value(model, wo, 1.0, seed++), sidak_level(family_level, 80))
            << Model::name << ", " << c.label << ", wo.z = " << wo.z;
    }
  });
}

TEST(LayeredBsdf, sampled_weights_with_a_planted_loss_are_rejected) {
  EXPECT_LT(sample_against_value(coated_diffuse({}, 0.8f), outgoing_directions()[1], 0.97, 5), family_level);
}

TEST(LayeredBsdf, weights_of_directions_of_exact_density_integrate_the_value) {
  std::uint32_t seed = 1100;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if constexpr (is_layered<Model>) {
      if (model.is_delta()) return;
      for (const Vec3f wo : outgoing_directions())
        EXPECT_GT(sample_against_value(model, wo, 1.0, seed++, Densities::exact), sidak_level(family_level, 80))
            << Model::name << ", " << c.label << ", wo.z = " << wo.z;
    }
  });
  EXPECT_LT(sample_against_value(coated_diffuse({}, 0.8f), outgoing_directions()[1], 0.97, 5, Densities::exact),
            family_level);
}

// What is reflected in deltas, by walks and beside directions of exact density; `fault` scales the latter.
template <class Model>
double walked_against_exact_deltas(const Model& model, Vec3f wo, double fault, std::uint32_t seed) {
  std::vector<double> walked, exact;
  RandomStream<float> stream(seed, 5u);
  for (int i = 0; i < 50000; ++i)
    for (std::vector<double>* all : {&walked, &exact}) {
      const BsdfContext<float> context = all == &exact ? exact_context_of(stream) : context_of(stream);
      const float u = stream.next();
      const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
      all->push_back(s.valid && s.delta ? s.weight[0] * (all == &exact ? fault : 1.0) : 0.0);
    }
  const SampleSummary a = summarize(walked), b = summarize(exact);
  // Where there are none, nothing is to be said.
  if (a.mean == 0 && b.mean == 0) return 1;
  return welch_test(a, b).p_value;
}

TEST(LayeredBsdf, deltas_beside_exact_densities_are_those_of_walks) {
  std::uint32_t seed = 1300;
  int seen = 0;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if constexpr (is_layered<Model>)
      for (const Vec3f wo : outgoing_directions()) {
        EXPECT_GT(walked_against_exact_deltas(model, wo, 1.0, ++seed), sidak_level(family_level, 80))
            << Model::name << ", " << c.label << ", wo.z = " << wo.z;
        seen += walked_against_exact_deltas(model, wo, 1.2, seed) < sidak_level(family_level, 80) ? 1 : 0;
      }
  });
  EXPECT_GT(seen, 10);  // the planted fault, wherever there are deltas
}

// ---- against closed forms
// --------------------------------------------------------------------------------------------

// A smooth coat over Lambert's law, all internal reflections summed: f = T(wo) T(wi) r / (pi eta^2 (1 - r F)), F the
// internal reflectance of diffuse light; both dimmed by the absorption of the layer.
double smooth_coat_over_diffuse(double cos_o, double cos_i, double r, double eta, double thickness, int bounces) {
  const auto inside = [&](double c) { return std::sqrt(1 - (1 - c * c) / (eta * eta)); };
  const auto pass = [&](double c) {
    return (1 - double(fresnel_dielectric(float(c), float(eta)))) * std::exp(-thickness / inside(c));
  };
  const double internal = integrate(
      [&](double mu) {
        return 2 * mu * double(fresnel_dielectric(float(-mu), float(eta))) * std::exp(-2 * thickness / mu);
      },
      0, 1, 2000);
  double series = 0, term = 1;
  for (int b = 0; b < bounces; ++b, term *= r * internal) series += term;
  return pass(cos_o) * pass(cos_i) * r / (std::numbers::pi * eta * eta) * series * cos_i;
}

TEST(LayeredBsdf, smooth_coat_over_diffuse_matches_the_series) {
  const Vec3f wo = direction(0.7f, 0.2f), wi = direction(0.4f, 0.9f);
  std::uint32_t seed = 200;
  for (const float thickness : {1e-30f, 0.2f})
    for (const int depth : {2, 3, 10, 200}) {
      const auto model = coated_diffuse({.thickness = thickness, .max_depth = float(depth)}, 0.9f);
      const double truth =
          smooth_coat_over_diffuse(double(wo.z), double(wi.z), 0.9f, 1.5, double(thickness), (depth + 1) / 2);
      const SampleSummary s = mean_value(model, wo, wi, 100000, ++seed);
      EXPECT_GT(z_test(s.mean, s.standard_error() + 1e-6 * truth, truth).p_value, sidak_level(family_level, 20))
          << "thickness " << thickness << ", depth " << depth << ": " << s.mean << " for " << truth;
      EXPECT_LT(z_test(s.mean, s.standard_error() + 1e-6 * truth, 1.02 * truth).p_value, sidak_level(family_level, 20));
    }
}

TEST(LayeredBsdf, coat_of_the_index_of_air_shows_the_base) {
  const auto model = coated_diffuse({.eta = 1, .thickness = 1e-30f}, 0.6f);
  const Vec3f wo = direction(0.5f, 0.2f), wi = direction(0.3f, 0.9f);
  const SampleSummary s = mean_value(model, wo, wi, 100, 1);
  EXPECT_NEAR(s.mean, 0.6 / std::numbers::pi * 0.3, 1e-6);
}

// Single scattering in a layer over black (Chandrasekhar 1960, sec. 7).
TEST(LayeredBsdf, single_scattering_matches_chandrasekhar) {
  const float g = 0.4f, albedo = 0.7f, thickness = 0.8f;
  const auto model = coated_diffuse({.eta = 1, .thickness = thickness, .g = g, .albedo = albedo, .max_depth = 1}, 0.0f);
  std::uint32_t seed = 300;
  for (const Vec3f wo : {direction(0.9f, 0.2f), direction(0.3f, 0.6f)}) {
    const Vec3f wi = direction(0.5f, 0.9f);
    const double o = double(wo.z), i = double(wi.z);
    const double truth = albedo * double(henyey_greenstein(-dot(wo, wi), g)) * i / (o + i) *
                         (1 - std::exp(-thickness * (1 / o + 1 / i)));
    const SampleSummary s = mean_value(model, wo, wi, 100000, ++seed);
    EXPECT_GT(z_test(s.mean, s.standard_error(), truth).p_value, sidak_level(family_level, 4)) << s.mean << truth;
    EXPECT_LT(z_test(s.mean, s.standard_error(), 1.03 * truth).p_value, sidak_level(family_level, 4));
  }
}

// Through a rough coat down to Lambert's law and out: the two passages are two integrals, done here by quadrature.
TEST(LayeredBsdf, rough_coat_matches_quadrature_of_one_bounce) {
  const float alpha = 0.4f, eta = 1.5f, reflectance = 0.8f;
  const auto model =
      coated_diffuse({.alpha_x = alpha, .alpha_y = alpha, .thickness = 1e-30f, .max_depth = 1}, reflectance);
  const Dielectric<float> coat({alpha, alpha}, eta);
  const Vec3f wo = direction(0.7f, 0.2f), wi = direction(0.35f, 0.5f);
  const auto radiance = TransportMode::radiance;
  const LocalFrame<float> up = LocalFrame<float>::from_normal({0, 0, 1});
  const double enters = integrate_sphere(
      [&](Vec3f w) { return coat.evaluate_lobes<Lobes::transmission>(wo, w, radiance).f_cos; }, up, 48, -1, 0);
  const double leaves = integrate_sphere(
      [&](Vec3f w) { return -w.z * coat.evaluate_lobes<Lobes::transmission>(w, wi, radiance).f_cos; }, up, 48, -1, 0);
  const double truth = enters * double(reflectance) / std::numbers::pi * leaves +
                       double(coat.evaluate_lobes<Lobes::reflection>(wo, wi, radiance).f_cos);
  const SampleSummary s = mean_value(model, wo, wi, 200000, 400);
  EXPECT_GT(z_test(s.mean, s.standard_error(), truth).p_value, family_level) << s.mean << " for " << truth;
  EXPECT_LT(z_test(s.mean, s.standard_error(), 1.03 * truth).p_value, family_level);
}

TEST(LayeredBsdf, value_is_reciprocal) {
  std::uint32_t seed = 500;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if constexpr (is_layered<Model>) {
      if (model.is_delta()) return;
      const Vec3f wo = direction(0.8f, 0.2f), wi = direction(0.35f, 0.55f);
      SampleSummary there = mean_value(model, wo, wi, 50000, ++seed), back = mean_value(model, wi, wo, 50000, ++seed);
      const double scale = double(wi.z) / double(wo.z);
      back.mean *= scale, back.variance *= scale * scale;
      // A value that is not drawn is symmetric to rounding.
      there.variance += 50000 * square(1e-6 * there.mean);
      EXPECT_GT(welch_test(there, back).p_value, sidak_level(family_level, 20))
          << Model::name << ", " << c.label << ": " << there.mean << " and " << back.mean;
      back.mean *= 1.3;
      EXPECT_LT(welch_test(there, back).p_value, sidak_level(family_level, 20)) << Model::name << ", " << c.label;
    }
  });
}

// ---- the density ----------------------------------------------------------------------------------------------------

// A function of the directions alone: the same by sample() and by evaluate(), whatever their random numbers, and
// greater than zero. The planted fault: the value for another wi. Estimates by random numbers fail in the same way.
TEST(LayeredBsdf, density_for_weights_depends_on_the_directions_alone) {
  std::uint32_t seed = 600;
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if constexpr (is_layered<Model>) {
      if (model.is_delta()) return;
      const Vec3f wo = direction(0.6f, 0.2f);
      RandomStream<float> stream(++seed, 3u);
      double largest = 0, faulty = 0;
      int samples = 0;
      for (int i = 0; i < 5000; ++i) {
        const BsdfContext<float> context = context_of(stream), other = context_of(stream);
        const float u = stream.next();
        const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
        if (!s.valid || s.delta) continue;
        const float evaluated = model.evaluate(wo, s.wi, other).density.value;
        ASSERT_GT(evaluated, 0) << Model::name << ", " << c.label;
        largest = std::max(largest, std::abs(double(s.density.value / evaluated) - 1));
        const float elsewhere = model.evaluate(wo, normalize(s.wi + Vec3f{0, 0, 0.05f}), other).density.value;
        faulty = std::max(faulty, std::abs(double(s.density.value / elsewhere) - 1));
        ++samples;
      }
      EXPECT_GT(samples, 500) << Model::name << ", " << c.label;
      EXPECT_LT(largest, 1e-4) << Model::name << ", " << c.label;
      EXPECT_GT(faulty, 1e-4) << Model::name << ", " << c.label;
    }
  });
}

// Light of half a sky by multiple importance sampling, one uniform direction and one walk: the mean is that of walks
// alone. The variance is little more; with weights by an independent estimate of the density it was 22 times that.
TEST(LayeredBsdf, weights_combine_walks_with_samples_of_a_light) {
  const BsdfCase c = coated_conductor_case("", {.alpha_x = 0.01f, .alpha_y = 0.01f}, 0.01f, 0.01f);
  const CoatedConductor<float> model(BsdfRows<float>{&c.row});
  const Vec3f wo = direction(0.6f, 0.2f);
  RandomStream<float> stream(900, 3u);
  const auto sky = [](Vec3f w) { return w.x < 0 ? 1.0 : 0.0; };  // half of it
  std::vector<double> combined, walked, faulty;
  for (int i = 0; i < 200000; ++i) {
    const float u = stream.next();
    const Vec2f u2 = stream.next2(), v2 = stream.next2();
    const BsdfSample<float> s = model.sample(wo, u, u2, context_of(stream));
    const Density<SolidAngle, float> even = hemisphere_density(1.0f);
    const Vec3f w = sample_hemisphere(v2);
    const BsdfValue<float> v = model.evaluate(wo, w, context_of(stream));
    const double by_walk = s.valid ? double(s.weight[0]) * sky(s.wi) : 0;
    const double share = s.valid && !s.delta ? double(power_weight(s.density, even)) : 1;
    const double by_light = double(v.f_cos[0] / even.value) * sky(w);
    const double other = double(power_weight(even, v.density));
    combined.push_back(by_walk * share + by_light * other);
    faulty.push_back(by_walk * share + by_light * double(power_weight(even, {0.5f * v.density.value})));
    walked.push_back(by_walk);
  }
  const SampleSummary a = summarize(combined), b = summarize(walked), fault = summarize(faulty);
  EXPECT_GT(welch_test(a, b).p_value, family_level) << a.mean << " and " << b.mean;
  EXPECT_LT(welch_test(fault, b).p_value, family_level) << fault.mean << " and " << b.mean;
  EXPECT_LT(a.variance, 2 * b.variance) << a.variance << " and " << b.variance;
}

}  // namespace
}  // namespace montelux
