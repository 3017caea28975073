#include "integrator/missing_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "integrator/catalogue.h"
#include "integrator/first_vertex.h"
#include "integrator/random_eye_ray.h"
#include "integrator/smooth_walks.h"

namespace montelux {

namespace {

// Walks that are followed in any case, and where none of them finds anything.
constexpr std::uint32_t usual_walks = 1024, longest_search = 16384;
constexpr int deepest = 16;

// "point lights", "point and spot lights".
template <class Kind, class Name>
std::string list_of(const std::vector<Kind>& kinds, Name name) {
  std::string list;
  for (std::size_t i = 0; i < kinds.size(); ++i)
    list += (i == 0 ? "" : i + 1 < kinds.size() ? ", " : " and ") + std::string(name(kinds[i]));
  return list;
}

MissingLight missing_caustics(const DeltaCaustics& caustics) {
  const std::string lights =
      list_of(caustics.lights, [](LightKind kind) { return light_kind_names[std::size_t(kind)]; });
  const std::string surfaces = list_of(caustics.surfaces, [](BsdfKind kind) { return name(kind); });
  return {
      fmt::format("light of {} lights through smooth surfaces ({})", lights, surfaces),
      fmt::format("light of {} lights that reaches surfaces through smooth glass or mirrors may be missing ({}): "
                  "no ray meets such a light, and no light sample passes such a surface; sppm, photonmap and vcm "
                  "find it, path:manifold=2 behind up to two such surfaces, and light and bdpt what the camera sees "
                  "of it directly (and a small sphere that shines, in the light's place, is found)",
                  lights, surfaces)};
}

// Of path:manifold.
MissingLight missing_long_chains(const DeltaCaustics& caustics, int chain_length) {
  const std::string lights =
      list_of(caustics.lights, [](LightKind kind) { return light_kind_names[std::size_t(kind)]; });
  const std::string surfaces = list_of(caustics.surfaces, [](BsdfKind kind) { return name(kind); });
  return {fmt::format("light of {} lights through smooth surfaces that manifold={} does not pass ({})", lights,
                      chain_length, surfaces),
          fmt::format("light of {} lights that reaches surfaces by way of more than {} smooth surfaces, or of smooth "
                      "ones with coats or normal maps, may be missing ({}): manifold={} does not look for it (a larger "
                      "number finds longer ways; sppm, photonmap and vcm find all)",
                      lights, chain_length, surfaces, chain_length)};
}

// Follows a camera ray by smooth surfaces alone. The model of the first of them, where the ray comes to light or to a
// rough surface.
std::optional<BsdfKind> look(const Scene& scene, const Accel& accel, const Ray<float>& eye,
                             RandomStream<float> random) {
  using F = float;
  std::uint64_t traced = 0;
  const auto [found, hit] = accel.trace<F>(eye, true, RayUse::camera);
  NextVertex<F> at =
      follow_ray<F>(scene, accel, free_point(eye.o), eye, hit, found, random.fork(0), traced, FullWeight{});
  std::optional<BsdfKind> first;
  for (int depth = 1; at.found && depth <= deepest; ++depth) {
    const Vec2f u = random.next2();
    const BsdfSample<F> next = sample<F>(at.bsdf.lanes(true), at.wo, {random.next(), u.x, u.y}, at.context);
    if (!next.valid || !next.delta || !(max_component(next.weight) > 0)) return std::nullopt;
    if (!first) first = BsdfKind(at.bsdf.kind);
    const Ray<F> ray = at.ray_toward(at.bsdf.frame.to_world(next.wi));
    at = next_vertex<F>(scene, accel, free_point(ray.o), ray, true, random.fork(std::uint32_t(depth)), traced,
                        FullWeight{});
    if (!is_black(at.emitted) || (at.found && !at.bsdf.is_delta)) return first;
  }
  return std::nullopt;
}

// Of an integrator that finds such light where the camera sees it directly.
std::optional<MissingLight> missing_reflected_caustics(const DeltaCaustics& caustics,
                                                       const std::vector<BsdfKind>& seen) {
  if (seen.empty()) return std::nullopt;
  const std::string lights =
      list_of(caustics.lights, [](LightKind kind) { return light_kind_names[std::size_t(kind)]; });
  const std::string surfaces = list_of(seen, [](BsdfKind kind) { return name(kind); });
  return MissingLight{
      fmt::format("light of {} lights through smooth surfaces, seen by way of others ({})", lights, surfaces),
      fmt::format("light of {} lights that smooth glass or mirrors focus on a surface may be missing where the camera "
                  "sees that in a mirror or through smooth glass ({}): no two vertices of its paths can be connected "
                  "(sppm, photonmap and vcm find it)",
                  lights, surfaces)};
}

std::optional<MissingLight> missing_reflections(const std::vector<BsdfKind>& seen) {
  if (seen.empty()) return std::nullopt;
  const std::string surfaces = list_of(seen, [](BsdfKind kind) { return name(kind); });
  return MissingLight{fmt::format("light seen by way of smooth surfaces ({})", surfaces),
                      fmt::format("what the camera sees in mirrors or through smooth glass ({}) is missing: paths from "
                                  "the lights are connected with the lens at rough surfaces alone (path finds it)",
                                  surfaces)};
}

}  // namespace

DeltaCaustics delta_caustics(const Scene& scene, const Accel& accel, int chain_length) {
  if (!scene.lights.has_delta()) return {};
  const SmoothTargets targets(scene);
  if (targets.empty()) return {};
  std::vector<LightId> lights;
  for (std::uint32_t i = 0; i < scene.lights.count(); ++i)
    if (is_delta(scene.lights.kind(LightId(i)))) lights.push_back(LightId(i));
  const RandomStream<float> all(0x243f6a88u, 0x85a308d3u);
  const auto is_missing = [&](const SmoothChain& chain) {
    return !chain.is_plain || int(chain.reflects.size()) > chain_length;
  };
  std::set<LightKind> kinds;
  std::set<BsdfKind> surfaces;
  for (std::uint32_t i = 0; i < (kinds.empty() ? longest_search : usual_walks); ++i) {
    RandomStream<float> random = all.fork(i);
    // The lights take turns; each walk has a target of its own.
    const LightId light = lights[i % lights.size()];
    const Vec3f target = targets.point(random);
    if (const auto chain = follow_light(scene, accel, light, target, random, is_missing))
      kinds.insert(scene.lights.kind(light)), surfaces.insert(chain->first);
  }
  return {{kinds.begin(), kinds.end()}, {surfaces.begin(), surfaces.end()}};
}

bool has_indirect_light(const Scene& scene, const Accel& accel, int width, int height) {
  constexpr int tiles = 64, side = 4;
  constexpr std::uint32_t samples = 4;
  const Result<ChosenIntegrator> path = choose_integrator({"path", {}}, {}, scene, accel);
  const PixelIntegrator& paths = *path->integrator;
  LayerPlan plan;
  plan.bounces = 1;
  const RandomStream<float> places(0x13198a2eu, 0x03707344u);
  for (std::uint32_t i = 0; i < tiles; ++i) {
    const int x = int(places.at(2 * i) * float(std::max(width - side, 0) + 1));
    const int y = int(places.at(2 * i + 1) * float(std::max(height - side, 0) + 1));
    const PixelBounds tile{x, y, std::min(x + side, width), std::min(y + side, height)};
    const TilePass pass{tile, {PointSetKind::independent, 0xa4093822u, i, samples}};
    std::vector<PixelSample> out(std::size_t(tile.area()) * samples);
    const std::size_t stride = std::size_t(plan.count()) + 1;
    std::vector<ExactRgb> sums(std::size_t(tile.area()) * stride);
    paths.trace_layers(pass, plan, out, sums);
    // The last layer of a pixel holds what was scattered more than once.
    for (std::size_t last = stride - 1; last < sums.size(); last += stride)
      if (!(sums[last] == ExactRgb{})) return true;
  }
  return false;
}

std::vector<BsdfKind> smooth_surfaces_in_view(const Scene& scene, const Accel& accel, int width, int height) {
  constexpr std::uint32_t rays = 8192;
  const RandomStream<float> all(0x299f31d0u, 0x082efa98u);
  std::set<BsdfKind> seen;
  for (std::uint32_t i = 0; i < rays; ++i) {
    RandomStream<float> random = all.fork(i);
    if (const auto kind = look(scene, accel, random_eye_ray(scene, width, height, random).ray, random))
      seen.insert(*kind);
  }
  return {seen.begin(), seen.end()};
}

std::vector<MissingLight> missing_light(LightSearch search, const Scene& scene, const Accel& accel, int width,
                                        int height, int chain_length) {
  const auto misses = [search](PathClass c) { return finding(search, c) == Finding::no; };
  std::vector<MissingLight> missing;
  if (misses(PathClass::lsde_delta))
    if (const DeltaCaustics caustics = delta_caustics(scene, accel); caustics.any())
      missing.push_back(missing_caustics(caustics));
  if (search == LightSearch::with_chains)
    if (const DeltaCaustics caustics = delta_caustics(scene, accel, chain_length); caustics.any())
      missing.push_back(missing_long_chains(caustics, chain_length));
  if (search == LightSearch::both_ends && misses(PathClass::lsdse_delta))
    if (const DeltaCaustics caustics = delta_caustics(scene, accel); caustics.any())
      if (const auto light = missing_reflected_caustics(caustics, smooth_surfaces_in_view(scene, accel, width, height)))
        missing.push_back(*light);
  if (misses(PathClass::lse))
    if (const auto light = missing_reflections(smooth_surfaces_in_view(scene, accel, width, height)))
      missing.push_back(*light);
  if (misses(PathClass::ldde) && has_indirect_light(scene, accel, width, height))
    missing.push_back({"light that was scattered more than once",
                       "light that was scattered more than once is missing: this integrator computes one scattering "
                       "event (path finds it)"});
  return missing;
}

}  // namespace montelux
