// Paths from the eye that end at the first diffuse surface, where the cache knows the indirect light: a source of paths
// for the path loop.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "integrator/irradiance_cache/hemisphere_paths.h"

namespace montelux {

// What the cache shows at a sample, for a comparison: the irradiance, and what it is multiplied by for the light of the
// sample.
struct CachedLight {
  CachePoint point;
  Spectrum<float> irradiance, weight;
};

// `Starts` are the paths at their first surface, as FirstHits has them.
template <class F, class Starts>
class CachedPaths {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // `outputs`: the number of results of the path loop. `by_depth`: the number of scattering events is limited.
  // `compared`: by output, 1 where cached() keeps what the cache shows; empty: nowhere. `in_parts`: the records have
  // parts, which are wanted.
  CachedPaths(Starts& starts, const IrradianceCache& cache, std::size_t outputs, bool by_depth,
              std::span<const std::uint8_t> compared = {}, bool in_parts = false)
      : starts_(starts),
        cache_(cache),
        by_depth_(by_depth),
        in_parts_(in_parts),
        compared_(compared),
        deepest_(outputs, endless),
        is_smooth_(outputs, 1) {}

  // Points where the cache has no record, on paths that arrived there by mirrors and smooth glass alone. All paths
  // without a record continue.
  std::vector<CachePoint>& missed() { return missed_; }
  const std::vector<CachedLight>& cached() const { return cached_; }

  // For the path loop.
  M refill(PathState<F>& path, M on) { return starts_.refill(path, on); }
  // After the surface where the cache had a record a path only looks for emission, which is direct light there.
  U deepest(const PathState<F>& path) const { return gather(deepest_.data(), path.output); }

  // Light that other surfaces send to a vertex and that it scatters toward the path: sink(on, light, origin) receives
  // it.
  template <class Sink>
  void indirect_light(const PathState<F>& path, const Vertex<F>& v, M scatters, Sink sink) {
    const M diffuse = scatters & (v.bsdf.kind == U(std::uint32_t(kind_of<Diffuse>))) & !v.x.ray_facing & !v.in_medium;
    Spectrum<F> irradiance = gray(F(0.0f));
    M known(false);
    if (any(diffuse)) {
      const F side = copysign(F(1.0f), v.wo.z);
      const Vec3<F> n = v.bsdf.frame.n * side;
      for_each_lane(diffuse, [&](int k) {
        const std::uint32_t depth = lane(path.depth, k), output = lane(path.output, k);
        const CacheQuery at = query(path, v, n, k);
        if (const auto found = cache_.irradiance(at)) {
          set_lane(irradiance, k, *found);
          deepest_[output] = depth + 1;
          set_bit(known, k);
        } else if (is_smooth_[output] != 0) {
          missed_.push_back(point_at(path, v, at, k));
        }
      });
      if (any(known)) {
        // At the normal the cosine is 1.
        const BsdfValue<F> value = evaluate<F>(v.bsdf.lanes(known), v.wo, Vec3<F>{F(0.0f), F(0.0f), side}, v.context);
        if (!compared_.empty()) keep(path, v, n, known, irradiance, path.throughput * value.f_cos * path.weight);
        if (in_parts_)
          send_parts(path, v, n, known, value.f_cos, sink);
        else
          sink(known, value.f_cos * irradiance, LightOrigin<F>{path.depth, U(0u), Technique::light_sampling});
      }
    }
    for_each_lane(scatters & !v.bsdf.is_delta, [&](int k) { is_smooth_[lane(path.output, k)] = 0; });
  }

 private:
  static constexpr std::uint32_t endless = 0x7fffffffu;

  static void set_bit(M& mask, int k) { mask = mask | mask_of_bits<F>(1u << k); }
  CacheQuery query(const PathState<F>& path, const Vertex<F>& v, const Vec3<F>& n, int k) const {
    return {lane(v.x.point.p, k), lane(n, k), by_depth_ ? lane(path.depth, k) : 0};
  }
  template <class Sink>
  void send_parts(const PathState<F>& path, const Vertex<F>& v, const Vec3<F>& n, M known, const Spectrum<F>& f_cos,
                  Sink sink) {
    for_each_lane(known, [&](int k) {
      for (const LightPart& part : cache_.parts(query(path, v, n, k)))
        sink(mask_of_bits<F>(1u << k), f_cos * splat<F>(part.contribution),
             LightOrigin<F>{path.depth + U(part.from.bounces), U(part.from.light), part.from.technique});
    });
  }
  void keep(const PathState<F>& path, const Vertex<F>& v, const Vec3<F>& n, M on, const Spectrum<F>& irradiance,
            const Spectrum<F>& weight) {
    for_each_lane(on, [&](int k) {
      if (compared_[lane(path.output, k)] != 0)
        cached_.push_back({point_at(path, v, query(path, v, n, k), k), lane(irradiance, k), lane(weight, k)});
    });
  }
  static CachePoint point_at(const PathState<F>& path, const Vertex<F>& v, const CacheQuery& at, int k) {
    Media<float> media;
    get_lane_words(v.media.along_wo(), k, media);
    return {at,
            lane(v.x.point.p_error, k),
            lane(v.x.point.ng, k),
            media,
            lane(path.time, k),
            lane(path.depth, k),
            lane(path.x, k),
            lane(path.y, k)};
  }

  Starts& starts_;
  const IrradianceCache& cache_;
  const bool by_depth_, in_parts_;
  const std::span<const std::uint8_t> compared_;
  std::vector<std::uint32_t> deepest_;   // by output: where the path ends
  std::vector<std::uint8_t> is_smooth_;  // by output: nothing rough so far
  std::vector<CachePoint> missed_;
  std::vector<CachedLight> cached_;
};

}  // namespace montelux
