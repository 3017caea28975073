// Light of delta lights that comes to rough surfaces by way of smooth ones, which no ray from the eye meets: walks that
// follow it through the scene.
#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "accel/accel.h"
#include "scene/scene.h"

namespace montelux {

// Surfaces that may have a smooth part: rows of the world, and instances with the rows of their objects.
class SmoothTargets {
 public:
  // `scene` must outlive it. `wanted(material)`: which surfaces instead.
  explicit SmoothTargets(const Scene& scene, const std::function<bool(std::size_t)>& wanted = {});
  bool empty() const { return world_.empty() && instances_.empty(); }

  // A point of one of them, where it is at the start of the time. Every part of them has a density, whose value does
  // not matter here.
  Vec3f point(RandomStream<float>& random) const;

 private:
  static std::size_t pick(RandomStream<float>& random, std::size_t count);
  Vec3f point_of_row(std::uint32_t number, RandomStream<float>& random) const;

  const Scene& scene_;
  std::vector<std::uint32_t> world_, instances_;
  std::vector<std::vector<std::uint32_t>> objects_;
};

// The smooth surfaces between a light and a rough surface, in the order of the light.
struct SmoothChain {
  BsdfKind first;              // model of the first of them
  std::vector<bool> reflects;  // of each event; else it refracts
  bool is_plain = true;        // all of them are is_plain_specular(), or were wanted although rough
  float irradiance = 0;        // that the light has where the walk aims, at normal incidence
  Vec3f last;                  // where the last of them is met
};

// Follows light from `light` toward `target`, by smooth surfaces alone, to one that is rough, at least in part. The
// chain that leads there, the first for which `counts(chain)` is true; none: the light ends before. Rough surfaces of
// materials with passes(material) count as smooth ones.
std::optional<SmoothChain> follow_light(const Scene& scene, const Accel& accel, LightId light, const Vec3f& target,
                                        RandomStream<float> random,
                                        const std::function<bool(const SmoothChain&)>& counts,
                                        const std::function<bool(std::size_t)>& passes = {});

}  // namespace montelux
