// Photons near a point: the hash grid of the photon maps, and the kd-tree of nanoflann. Items are photons for builds
// and look-ups for the rest. Both use one thread. Photons lie on the faces of 200 boxes; look-ups are at photons.
#include <benchmark/benchmark.h>

#include <cmath>
#include <nanoflann.hpp>

#include "integrator/photons/photon_map.h"
#include "mc/random.h"

namespace montelux {
namespace {

std::vector<Photon> photons_on_boxes(std::size_t count) {
  RandomStream<float> r(1, 2);
  std::vector<Vec3f> corners, sizes;
  for (int i = 0; i < 200; ++i) {
    corners.push_back({10 * r.next(), 10 * r.next(), 10 * r.next()});
    sizes.push_back({r.next() + 0.1f, r.next() + 0.1f, r.next() + 0.1f});
  }
  std::vector<Photon> photons;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t box = std::min(std::size_t(r.next() * 200), std::size_t{199});
    Vec3f p{r.next(), r.next(), r.next()}, n{0, 0, 0};
    const int face = std::min(int(r.next() * 6), 5);
    const float end = float(face & 1);
    if (face / 2 == 0) p.x = end, n.x = 2 * end - 1;
    if (face / 2 == 1) p.y = end, n.y = 2 * end - 1;
    if (face / 2 == 2) p.z = end, n.z = 2 * end - 1;
    const Vec3f at = corners[box] + Vec3f{p.x * sizes[box].x, p.y * sizes[box].y, p.z * sizes[box].z};
    photons.push_back({at, n, n, gray(1.0f), 1, std::uint32_t(i)});
  }
  return photons;
}

// The radius of a disk that holds so many photons on average: the boxes have a mean area of 6 x 0.6^2.
float radius_for(double photons, std::size_t all) {
  return float(std::sqrt(photons / double(all) * 200 * 6 * 0.36 / 3.14159));
}

struct Cloud {
  const std::vector<Photon>& photons;
  std::size_t kdtree_get_point_count() const { return photons.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    const Vec3f& p = photons[i].p;
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, std::uint32_t>;

PhotonMap grid_of(const std::vector<Photon>& photons, float radius) {
  PhotonMap map(photons.size(), 1);
  for (int stage = 0; stage < PhotonMap::stages; ++stage)
    map.run_unit(stage, 0, radius, [&](std::vector<Photon>& box) { return box = photons, RayCounts{}; });
  return map;
}

void build_grid(benchmark::State& state) {
  const auto photons = photons_on_boxes(1000000);
  for (auto _ : state) benchmark::DoNotOptimize(grid_of(photons, radius_for(double(state.range(0)), photons.size())));
  state.SetItemsProcessed(state.iterations() * std::int64_t(photons.size()));
}

void build_tree(benchmark::State& state) {
  const auto photons = photons_on_boxes(1000000);
  const Cloud cloud{photons};
  for (auto _ : state) {
    Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(std::size_t(state.range(0))));
    benchmark::DoNotOptimize(tree.usedMemory(tree));
  }
  state.SetItemsProcessed(state.iterations() * std::int64_t(photons.size()));
}

// range: photons in a disk of the radius.
void look_up_in_grid(benchmark::State& state) {
  const auto photons = photons_on_boxes(1000000);
  const PhotonMap map = grid_of(photons, radius_for(double(state.range(0)), photons.size()));
  NearPhotons near;
  std::size_t i = 0, found = 0;
  for (auto _ : state) {
    map.near(photons[i].p, near);
    found += near.count, i = (i + 7919) % photons.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["found"] = double(found) / double(state.iterations());
}

void look_up_in_tree(benchmark::State& state) {
  const auto photons = photons_on_boxes(1000000);
  const Cloud cloud{photons};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(std::size_t(state.range(1))));
  const float radius = radius_for(double(state.range(0)), photons.size());
  std::vector<std::pair<std::uint32_t, float>> near;
  nanoflann::SearchParams unsorted;
  unsorted.sorted = false;
  std::size_t i = 0, found = 0;
  for (auto _ : state) {
    const float p[3] = {photons[i].p.x, photons[i].p.y, photons[i].p.z};
    found += tree.radiusSearch(p, radius * radius, near, unsorted), i = (i + 7919) % photons.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["found"] = double(found) / double(state.iterations());
}

BENCHMARK(build_grid)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(build_tree)->Arg(10)->Arg(32)->Unit(benchmark::kMillisecond);
BENCHMARK(look_up_in_grid)->Arg(10)->Arg(100)->Arg(1000);
BENCHMARK(look_up_in_tree)->ArgsProduct({{10, 100, 1000}, {10, 32}});

}  // namespace
}  // namespace montelux
