// Energy, reciprocity, and the same result in one lane and in many.
#include <gtest/gtest.h>

#include "cases.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

Vec3f any_direction(RandomStream<float>& stream) {
  const float cos = 2 * stream.next() - 1;
  return direction(cos, stream.next());
}

// The mean weight of samples, which is the part of the light that is not absorbed; `fault` is planted.
template <class Model>
SampleSummary albedo(const Model& model, Vec3f wo, int component, double fault = 1) {
  RandomStream<float> stream(21, 22);
  std::vector<double> x;
  for (int i = 0; i < 20000; ++i) {
    const BsdfContext<float> context = context_of(stream, TransportMode::importance);
    const float u = stream.next();
    const BsdfSample<float> s = model.sample(wo, u, stream.next2(), context);
    x.push_back(s.valid ? fault * double(s.weight[component]) : 0);
  }
  return summarize(x);
}

TEST(BsdfEnergy, no_model_gains_energy) {
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    for (const Vec3f wo : outgoing_directions()) {
      // Importance that enters glass keeps its amount; what radiance gains by the index is undone on leaving.
      const auto gains = [](const SampleSummary& x) {
        return at_most_p_value(x.mean, x.standard_error() + 2e-6, 1) < sidak_level(family_level, 800);
      };
      for (int k = 0; k < spectrum_size; ++k) {
        const SampleSummary s = albedo(model, wo, k);
        EXPECT_FALSE(gains(s)) << Model::name << ", " << c.label << ", wo.z = " << wo.z << ": " << s.mean;
      }
      EXPECT_TRUE(!c.lossless || gains(albedo(model, wo, 0, 1.01))) << Model::name << ", " << c.label;
    }
  });
}

TEST(BsdfEnergy, lossless_models_return_all_light) {
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if (!c.lossless) return;
    for (const Vec3f wo : outgoing_directions())
      for (int k = 0; k < spectrum_size; ++k) {
        const SampleSummary s = albedo(model, wo, k), faulty = albedo(model, wo, k, 0.99);
        EXPECT_GT(z_test(s.mean, s.standard_error() + 1e-6, 1).p_value, sidak_level(family_level, 100))
            << Model::name << ", " << c.label << " " << s.mean;
        EXPECT_LT(z_test(faulty.mean, faulty.standard_error() + 1e-6, 1).p_value, sidak_level(family_level, 100));
      }
  });
}

// White Lambert under a coat without absorption, walked to the end; and a perfect mirror under the same coat.
TEST(BsdfEnergy, coats_over_white_return_all_light) {
  const CoatCase coat{.thickness = 1e-30f, .max_depth = 2000};
  BsdfCase diffuse{"", {}}, mirror{"", {}};
  put(diffuse.row, coat), put(mirror.row, coat);
  put(diffuse.row, CoatedDiffuseSlots::reflectance, {gray_rgb(1)});
  put(mirror.row, CoatedConductorSlots::conductor_alpha_x, {0, 0, gray_rgb(1), gray_rgb(1e9f)});
  const BsdfCase summed = summed_coat_case("", coat, 1);
  for (const Vec3f wo : outgoing_directions()) {
    const SampleSummary c = albedo(CoatedDiffuse<float>(BsdfRows<float>{&summed.row}), wo, 0);
    EXPECT_GT(z_test(c.mean, c.standard_error() + 1e-4, 1).p_value, sidak_level(family_level, 12)) << c.mean;
    const SampleSummary d = albedo(CoatedDiffuse<float>(BsdfRows<float>{&diffuse.row}), wo, 0);
    const SampleSummary m = albedo(CoatedConductor<float>(BsdfRows<float>{&mirror.row}), wo, 0);
    EXPECT_GT(z_test(d.mean, d.standard_error() + 1e-5, 1).p_value, sidak_level(family_level, 12)) << d.mean;
    EXPECT_GT(z_test(m.mean, m.standard_error() + 1e-5, 1).p_value, sidak_level(family_level, 12)) << m.mean;
    const SampleSummary f = albedo(CoatedDiffuse<float>(BsdfRows<float>{&diffuse.row}), wo, 0, 0.95);
    EXPECT_LT(z_test(f.mean, f.standard_error() + 1e-5, 1).p_value, sidak_level(family_level, 12)) << f.mean;
  }
}

// Along the surface and straight up, with the first and the last of all random numbers.
TEST(BsdfEnergy, results_are_finite_at_the_edges) {
  const Vec3f edges[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, direction(1e-6f, 0.3f), direction(-1e-6f, 0.3f)};
  const float numbers[] = {0, 0.5f, one_minus_epsilon};
  RandomStream<float> stream(51, 52);
  const auto finite = [](const Spectrum<float>& x, float p) {
    return std::all_of(x.c, x.c + spectrum_size, [](float c) { return is_finite(c); }) && is_finite(p) && p >= 0;
  };
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    for (const Vec3f wo : edges)
      for (const Vec3f wi : edges) {
        const BsdfValue<float> v = model.evaluate(wo, wi, context_of(stream));
        EXPECT_TRUE(finite(v.f_cos, v.density.value)) << Model::name << ", " << c.label << wo.z << " " << wi.z;
      }
    for (const Vec3f wo : edges)
      for (const float u : numbers)
        for (const float x : numbers)
          for (const float y : numbers) {
            const BsdfSample<float> s = model.sample(wo, u, {x, y}, context_of(stream));
            if (!s.valid) continue;
            EXPECT_TRUE(finite(s.weight, s.density.value)) << Model::name << ", " << c.label << " " << wo.z;
            EXPECT_NEAR(length(s.wi), 1, 1e-4) << Model::name << ", " << c.label << " " << wo.z;
            EXPECT_TRUE(s.delta || s.density.value > 0)
                << Model::name << ", " << c.label << " " << wo.z << " " << s.wi.z;
          }
  });
}

TEST(BsdfReciprocity, value_is_symmetric_up_to_the_squared_index) {
  RandomStream<float> stream(31, 32);
  for_each_case([&]<class Model>(const Model& model, const BsdfCase& c) {
    if (is_layered<Model> || model.is_delta() || Model::name == "diffusetransmission" || !c.reciprocal) return;
    float eta = 1;
    if constexpr (requires { model.eta(); }) eta = model.eta();
    const BsdfContext<float> radiance = context_of(stream), importance{TransportMode::importance, radiance.random};
    for (int i = 0; i < 2000; ++i) {
      const Vec3f wo = any_direction(stream);
      const Vec3f wi = any_direction(stream);
      if (std::abs(wo.z) < 0.02f || std::abs(wi.z) < 0.02f || length(wo + wi) < 0.2f) continue;
      const int k = i % spectrum_size;
      const float there = model.evaluate(wo, wi, radiance).f_cos[k] / std::abs(wi.z);
      const float back = model.evaluate(wi, wo, radiance).f_cos[k] / std::abs(wo.z);
      const auto squared_index = [eta](Vec3f w) { return w.z < 0 ? eta * eta : 1.0f; };
      ASSERT_NEAR(there * squared_index(wi), back * squared_index(wo), 2e-3 * there + 1e-5) << Model::name << c.label;
      // Importance scatters as radiance does the other way.
      const float adjoint = model.evaluate(wi, wo, importance).f_cos[k] / std::abs(wo.z);
      ASSERT_NEAR(there, adjoint, 2e-3 * there + 1e-5) << Model::name << ", " << c.label;
    }
  });
}

// ---- lanes ----------------------------------------------------------------------------------------------------------

template <class F>
BsdfContext<F> keyed_context(Uint<F> key, TransportMode mode) {
  return {mode, RandomStream<F>(key, Uint<F>(99u))};
}

// Every lane of a mixed pack gives the bits of the same call in one lane.
TEST(BsdfLanes, pack_equals_single_lanes) {
  using F = NativeFloats;
  struct Entry {
    std::uint32_t kind;
    BsdfRow row;
  };
  std::vector<Entry> entries;
  for_each_kind([&]<BsdfKind kind>() {
    for (const BsdfCase& c : CasesOf<kind>::all()) entries.push_back({std::uint32_t(kind), c.row});
  });
  RandomStream<float> stream(41, 42);
  for (int round = 0; round < 400; ++round) {
    const TransportMode mode = round % 2 ? TransportMode::radiance : TransportMode::importance;
    std::vector<BsdfRow> rows(native_lanes);
    std::vector<ScatterQuery<float>> queries(native_lanes);
    Uint<F> kind(0u), key(0u);
    ScatterQuery<F> query;
    std::uint32_t wanted = 0;
    for (int k = 0; k < native_lanes; ++k) {
      const Entry& e = entries[std::size_t(stream.next() * float(entries.size()))];
      rows[std::size_t(k)] = e.row;
      const Vec3f wo = any_direction(stream);
      const Vec3f wi = any_direction(stream);
      const bool want = stream.next() < 0.7f;
      const float u = stream.next();
      queries[std::size_t(k)] = {wo, wi, want, u, stream.next2()};
      set_lane(kind, k, e.kind), set_lane(key, k, std::uint32_t(round * 64 + k));
      set_lane(query.wo, k, wo), set_lane(query.wi_light, k, wi), set_lane(query.u, k, u);
      set_lane(query.u2, k, queries[std::size_t(k)].u2);
      wanted |= std::uint32_t(want) << k;
    }
    query.light_wanted = mask_of_bits<F>(wanted);
    BsdfSlots<F> slots;
    for (int i = 0; i < bsdf_row_size; ++i)
      for (int k = 0; k < native_lanes; ++k) set_lane(slots.v[i], k, rows[std::size_t(k)].v[i]);
    const Scattering<F> pack = scatter<F>({kind, &slots, Mask<F>(true)}, query, keyed_context<F>(key, mode));
    for (int k = 0; k < native_lanes; ++k) {
      const Scattering<float> one = scatter<float>({lane(kind, k), &rows[std::size_t(k)], true},
                                                   queries[std::size_t(k)], keyed_context<float>(lane(key, k), mode));
      const std::string where = std::string(name(BsdfKind(lane(kind, k)))) + " in round " + std::to_string(round);
      ASSERT_EQ(lane(pack.next.valid, k), one.next.valid) << where;
      ASSERT_EQ(lane(pack.toward_light.density.value, k), one.toward_light.density.value) << where;
      for (int c = 0; c < spectrum_size; ++c)
        ASSERT_EQ(lane(pack.toward_light.f_cos[c], k), one.toward_light.f_cos[c]) << where;
      if (!one.next.valid) continue;
      ASSERT_EQ(lane(pack.next.delta, k), one.next.delta) << where;
      ASSERT_EQ(lane(pack.next.wi.x, k), one.next.wi.x) << where;
      ASSERT_EQ(lane(pack.next.wi.z, k), one.next.wi.z) << where;
      for (int c = 0; c < spectrum_size; ++c) ASSERT_EQ(lane(pack.next.weight[c], k), one.next.weight[c]) << where;
      ASSERT_EQ(lane(pack.next.eta_scale, k), one.next.eta_scale) << where;
      if (one.next.delta) continue;
      ASSERT_EQ(lane(pack.next.density.value, k), one.next.density.value) << where;
    }
  }
}

TEST(BsdfLanes, idle_lanes_are_zero_and_invalid) {
  using F = NativeFloats;
  BsdfSlots<F> slots;
  for (F& v : slots.v) v = F(1e30f);
  const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
  const ScatterQuery<F> query{up, up, Mask<F>(true), F(0.5f), {F(0.5f), F(0.5f)}};
  const auto context = keyed_context<F>(lane_index<F>(), TransportMode::radiance);
  for (std::uint32_t kind = 0; kind < bsdf_kind_count; ++kind) {
    const Scattering<F> s = scatter<F>({Uint<F>(kind), &slots, Mask<F>(false)}, query, context);
    EXPECT_FALSE(any(s.next.valid));
    for (int k = 0; k < native_lanes; ++k) EXPECT_EQ(lane(s.toward_light.f_cos[0], k), 0);
  }
}

}  // namespace
}  // namespace montelux
