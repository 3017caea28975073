// Shadow rays traced in another order have the same results.
#include "integrator/restir/shadow_ray_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace montelux::test {
namespace {

// A ray is hidden where its numbers say so; the sizes of packs are written down.
struct NumberedRays {
  std::vector<int>* packs;
  static float hash(float x) { return x * 0.6180339887f - std::floor(x * 0.6180339887f); }

  template <class F>
  Mask<F> occluded(const Ray<F>& ray, Mask<F> on) const {
    packs->push_back(count(on));
    const F x = ray.o.x + ray.d.y * 10.0f + ray.t_max * 100.0f + ray.time * 1000.0f;
    Uint<F> hidden(0u);
    for_each_lane(on, [&](int k) { set_lane(hidden, k, hash(lane(x, k)) < 0.4f ? 1u : 0u); });
    return on & (hidden != Uint<F>(0u));
  }
};

template <class F>
void expect_the_same_answers(std::size_t count_of_packs) {
  std::vector<Ray<F>> ways(count_of_packs);
  const auto open = std::make_unique<Mask<F>[]>(count_of_packs), expected = std::make_unique<Mask<F>[]>(count_of_packs);
  std::vector<int> sizes, unused;
  std::uint64_t requested = 0;
  for (std::size_t i = 0; i < count_of_packs; ++i) {
    Uint<F> on(0u);
    for (int k = 0; k < int(lanes_of<F>); ++k) {
      const auto x = float(i * lanes_of<F> + std::size_t(k));
      set_lane(ways[i].o, k, {x, 0, 0}), set_lane(ways[i].d, k, {0, x, 1});
      set_lane(ways[i].t_max, k, x + 1), set_lane(ways[i].time, k, 0.5f * x);
      if ((i + std::size_t(k)) % 4 != 1) set_lane(on, k, 1u);
    }
    open[i] = on != Uint<F>(0u);
    requested += std::uint64_t(count(open[i]));
    expected[i] = open[i] & !NumberedRays{&unused}.occluded<F>(ways[i], open[i]);
  }
  RayCounts counts;
  keep_open<F>(NumberedRays{&sizes}, std::span<const Ray<F>>(ways), std::span<Mask<F>>(open.get(), count_of_packs),
               counts);
  int hidden = 0;
  for (std::size_t i = 0; i < count_of_packs; ++i) {
    EXPECT_EQ(bits(open[i]), bits(expected[i])) << i;
    hidden += count(expected[i]);
  }
  EXPECT_GT(hidden, int(requested) / 3);
  EXPECT_LT(hidden, int(requested));
  // Every ray once, in packs that are full except the last one.
  EXPECT_EQ(counts.shadow, requested);
  EXPECT_EQ(sizes.size(), (requested + lanes_of<F> - 1) / lanes_of<F>);
}

TEST(ShadowRayBatch, rays_have_the_answers_that_they_have_one_by_one) {
  for (std::size_t packs : {std::size_t(3), std::size_t(16), std::size_t(37)}) {
    expect_the_same_answers<NativeFloats>(packs);
    expect_the_same_answers<float>(packs);
  }
}

TEST(ShadowRayBatch, nothing_is_traced_where_no_lane_is_on) {
  std::vector<Ray<NativeFloats>> ways(5);
  Mask<NativeFloats> open[5];
  for (auto& mask : open) mask = Mask<NativeFloats>(false);
  std::vector<int> sizes;
  RayCounts counts;
  keep_open<NativeFloats>(NumberedRays{&sizes}, std::span<const Ray<NativeFloats>>(ways),
                          std::span<Mask<NativeFloats>>(open), counts);
  EXPECT_TRUE(sizes.empty());
  EXPECT_EQ(counts.shadow, 0u);
}

}  // namespace
}  // namespace montelux::test
