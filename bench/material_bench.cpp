// Time of one vertex (a value toward a light and a sample) for each model, in one lane and in a full pack. The rate is
// in vertices per second.
#include <benchmark/benchmark.h>

#include <vector>

#include "material/material.h"
#include "material/measured_table.h"

namespace montelux {
namespace {

// A table of the usual size for an isotropic surface.
const MeasuredTable& bench_table() {
  static const MeasuredTable table = [] {
    const GridSize grid{32, 32};
    MeasuredData data;
    for (int i = 0; i < 8; ++i) data.elevations.push_back(0.2f * float(i));
    data.azimuths = {0};
    data.ndf_size = data.sigma_size = data.vndf_size = data.value_size = grid;
    data.ndf.assign(grid.points(), 0.3f), data.sigma.assign(grid.points(), 0.8f);
    data.vndf.assign(8 * grid.points(), 1), data.luminance = data.vndf;
    data.values.assign(3 * 8 * grid.points(), 0.5f);
    return MeasuredTable(std::move(data));
  }();
  return table;
}

// Rough where the model can be; a middling grey.
BsdfRow bench_row(BsdfKind kind) {
  BsdfRow row;
  const auto put = [&](int slot, std::initializer_list<float> values) {
    for (float v : values) row.v[slot++] = v;
  };
  const auto is = [kind](auto... kinds) { return ((kind == kinds) || ...); };
  if (is(kind_of<Diffuse>)) put(DiffuseSlots::reflectance, {0.5f, 0.5f, 0.5f});
  if (is(kind_of<Conductor>)) put(ConductorSlots::alpha_x, {0.3f, 0.3f, 0.2f, 0.9f, 1.1f, 3.9f, 2.5f, 2.1f});
  if (is(kind_of<Dielectric>, kind_of<TintedDielectric>)) put(DielectricSlots::alpha_x, {0.3f, 0.3f, 1.5f});
  if (is(kind_of<TintedDielectric>)) put(TintedDielectricSlots::tint, {1, 1, 1});
  if (is(kind_of<CoatedDiffuse>, kind_of<CoatedConductor>))
    put(LayeredSlots::alpha_x, {0.3f, 0.3f, 1.5f, 0.01f, 0, 0, 0, 0, 10, 1});
  if (is(kind_of<CoatedDiffuse>)) put(CoatedDiffuseSlots::reflectance, {0.5f, 0.5f, 0.5f});
  if (is(kind_of<CoatedConductor>))
    put(CoatedConductorSlots::conductor_alpha_x, {0.3f, 0.3f, 0.2f, 0.9f, 1.1f, 3.9f, 2.5f, 2.1f});
  if (is(kind_of<DiffuseTransmission>))
    put(DiffuseTransmissionSlots::reflectance, {0.4f, 0.4f, 0.4f, 0.3f, 0.3f, 0.3f});
  if (is(kind_of<ThinDielectric>)) put(ThinDielectricSlots::eta, {1.5f, 1, 1, 1});
  if (is(kind_of<Phong>)) put(PhongSlots::diffuse, {0.4f, 0.4f, 0.4f, 0.3f, 0.3f, 0.3f, 30});
  if (is(kind_of<MetallicRoughness>, kind_of<CoatedMetallicRoughness>)) {
    put(MetallicRoughnessSlots::base, {0.5f, 0.5f, 0.5f});
    put(MetallicRoughnessSlots::metallic, {0.5f, 0.3f, 1});
    put(MetallicRoughnessSlots::specular_color, {1, 1, 1});
    put(MetallicRoughnessSlots::reflected, {0.04f});
  }
  if (is(kind_of<CoatedMetallicRoughness>))
    put(CoatedMetallicRoughnessSlots::grain_x, {1, 0, 1, 0, 1, 0.1f, 1, 0, 0, 1});
  if (is(kind_of<Measured>)) put_address(&bench_table(), row.v + MeasuredSlots::table);
  return row;
}

template <class F>
void vertex(benchmark::State& state) {
  const auto kind = BsdfKind(state.range(0));
  const BsdfRow row = bench_row(kind);
  BsdfSlots<F> slots;
  for (int i = 0; i < bsdf_row_size; ++i) slots.v[i] = F(row.v[i]);
  const BsdfLanes<F> lanes{Uint<F>(std::uint32_t(kind)), &slots, Mask<F>(true)};
  RandomStream<F> stream(lane_index<F>(), Uint<F>(7u));
  for (auto _ : state) {
    const Vec3<F> wo = direction_at(F(0.1f) + 0.9f * stream.next(), stream.next());
    const Vec3<F> wi = sample_cosine_hemisphere(stream.next2());
    const F u = stream.next();
    const ScatterQuery<F> query{wo, wi, Mask<F>(true), u, stream.next2()};
    const BsdfContext<F> context{TransportMode::radiance, stream.fork(to_uint(F(stream.next() * 1e6f)))};
    benchmark::DoNotOptimize(scatter<F>(lanes, query, context));
  }
  state.SetItemsProcessed(std::int64_t(state.iterations()) * lanes_of<F>);
  state.SetLabel(std::string(name(kind)));
}

BENCHMARK(vertex<float>)->DenseRange(0, int(bsdf_kind_count) - 1);
BENCHMARK(vertex<NativeFloats>)->DenseRange(0, int(bsdf_kind_count) - 1);

}  // namespace
}  // namespace montelux
