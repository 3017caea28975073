// How fast a light is chosen and sampled, by the number of lights, for one lane and for a pack. Items are samples.
#include <benchmark/benchmark.h>

#include "light/builder.h"
#include "mc/random.h"

namespace montelux {
namespace {

LightSet triangles(int count, LightSelection selection) {
  RandomStream<float> r(1, 2);
  auto in_box = [&](float size) { return Vec3f{r.next() - 0.5f, r.next() - 0.5f, r.next() - 0.5f} * size; };
  LightSetBuilder b;
  for (int i = 0; i < count; ++i) {
    Vec3f p = in_box(20);
    b.add(TriangleShape{p, p + in_box(0.5f), p + in_box(0.5f)}, {.radiance = gray_rgb(r.next())});
  }
  return std::move(b).build({selection}, {0, 0, 0}, 20);
}

template <class F, LightSelection selection>
void sample_lights(benchmark::State& state) {
  LightSet lights = triangles(int(state.range(0)), selection);
  RandomStream<F> r(lane_index<F>(), Uint<F>(7u));
  for (auto _ : state) {
    Vec3<F> p{r.next() * 20.0f - 10.0f, r.next() * 20.0f - 10.0f, r.next() * 20.0f - 10.0f};
    F choice = r.next();
    Vec2<F> u = r.next2();
    LightSample<F> s = lights.sample(p, Vec3<F>{F(0.0f), F(0.0f), F(1.0f)}, choice, u, Mask<F>(true));
    benchmark::DoNotOptimize(s);
  }
  state.SetItemsProcessed(state.iterations() * lanes_of<F>);
}

void build_hierarchy(benchmark::State& state) {
  for (auto _ : state) {
    LightSet lights = triangles(int(state.range(0)), LightSelection::bvh);
    benchmark::DoNotOptimize(lights);
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

BENCHMARK(sample_lights<float, LightSelection::bvh>)->Arg(1)->Arg(100)->Arg(10000);
BENCHMARK(sample_lights<NativeFloats, LightSelection::bvh>)->Arg(1)->Arg(100)->Arg(10000);
BENCHMARK(sample_lights<float, LightSelection::power>)->Arg(10000);
BENCHMARK(sample_lights<NativeFloats, LightSelection::power>)->Arg(10000);
BENCHMARK(build_hierarchy)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace montelux
