#include "integrator/smooth_walks.h"

#include <algorithm>

#include "integrator/first_vertex.h"
#include "material/lobe.h"
#include "scene/smoothness.h"

namespace montelux {

namespace {

constexpr int deepest = 16;

}  // namespace

SmoothTargets::SmoothTargets(const Scene& scene, const std::function<bool(std::size_t)>& wanted) : scene_(scene) {
  const GeometryStore& g = scene.geometry;
  std::vector<bool> smooth;
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    smooth.push_back(wanted ? wanted(i) : may_be_smooth(scene.materials, i));
  const auto take = [&](std::size_t first, std::size_t count, std::vector<std::uint32_t>& rows) {
    for (std::size_t i = first; i < first + count; ++i)
      if (smooth[g.rows[i].material] && g.rows[i].kind != GeometryKind::curves) rows.push_back(std::uint32_t(i));
  };
  take(0, g.world_rows, world_);
  objects_.resize(g.objects.size());
  for (std::size_t i = 0; i < g.objects.size(); ++i) take(g.objects[i].first, g.objects[i].count, objects_[i]);
  for (std::uint32_t i = 0; i < g.instances.size(); ++i)
    if (!objects_[g.instances[i].object].empty()) instances_.push_back(i);
}

Vec3f SmoothTargets::point(RandomStream<float>& random) const {
  const std::size_t i = pick(random, world_.size() + instances_.size());
  if (i < world_.size()) return point_of_row(world_[i], random);
  const PlacedObject& placed = scene_.geometry.instances[instances_[i - world_.size()]];
  const auto& rows = objects_[placed.object];
  return placed.object_to_world.point(point_of_row(rows[pick(random, rows.size())], random));
}

std::size_t SmoothTargets::pick(RandomStream<float>& random, std::size_t count) {
  return std::min(std::size_t(double(random.next()) * double(count)), count - 1);
}

Vec3f SmoothTargets::point_of_row(std::uint32_t number, RandomStream<float>& random) const {
  const GeometryStore& g = scene_.geometry;
  const GeometryRow& row = g.rows[number];
  Vec2f u = random.next2();
  if (row.kind == GeometryKind::shape) return sample_area(g.shapes[row.first], u).point.p;
  const auto& corners = g.triangles[row.first + pick(random, row.count)];
  if (u.x + u.y > 1) u = {1 - u.x, 1 - u.y};
  const auto corner = [&](std::size_t i) { return g.vertices[corners[i]].position; };
  const Vec3f a = corner(0), b = corner(1), c = corner(2);
  return a + (b - a) * u.x + (c - a) * u.y;
}

std::optional<SmoothChain> follow_light(const Scene& scene, const Accel& accel, LightId light, const Vec3f& target,
                                        RandomStream<float> random,
                                        const std::function<bool(const SmoothChain&)>& counts,
                                        const std::function<bool(std::size_t)>& passes) {
  using F = float;
  const Vec3f zero{0, 0, 0};
  const LightSample<F> from = scene.lights.sample_light<F>(std::uint32_t(light), target, zero, random.next2(), true);
  if (!from.valid || !(max_component(from.radiance) > 0)) return std::nullopt;
  Ray<F> ray{target + from.wi * from.distance, -from.wi, ray_infinity, scene.shutter.time(random.next())};
  SmoothChain chain{};
  chain.irradiance = max_component(from.radiance);
  std::uint64_t traced = 0;
  for (int depth = 0; depth < deepest; ++depth) {
    const NextVertex<F> at = next_vertex<F>(scene, accel, free_point(ray.o), ray, true,
                                            random.fork(std::uint32_t(depth)), traced, NoWeight{});
    if (!at.found) return std::nullopt;
    const bool passes_rough = !at.bsdf.is_delta && passes && passes(at.x.material);
    if (!chain.reflects.empty() && !at.bsdf.is_delta && !passes_rough && counts(chain)) return chain;
    const Vec2f u = random.next2();
    const BsdfSample<F> next = sample<F>(at.bsdf.lanes(true), at.wo, {random.next(), u.x, u.y}, at.context);
    if (!next.valid || !(next.delta || passes_rough) || !(max_component(next.weight) > 0)) return std::nullopt;
    if (chain.reflects.empty()) chain.first = BsdfKind(at.bsdf.kind);
    chain.reflects.push_back(same_side(at.wo, next.wi)), chain.last = at.x.point.p;
    const bool is_plain = at.bsdf.is_delta && is_plain_specular(scene.materials, at.x.material);
    chain.is_plain = chain.is_plain && (is_plain || passes_rough);
    ray = at.ray_toward(at.bsdf.frame.to_world(next.wi));
  }
  return std::nullopt;
}

}  // namespace montelux
