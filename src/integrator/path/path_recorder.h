// Writes down one path as the path loop traces it.
#pragma once
#include "integrator/tally.h"
#include "integrator/traced_path.h"
#include "scene/materials.h"

namespace montelux {

// What the path loop knows of a vertex once the path has left it.
template <class F>
struct VertexVisit {
  const SurfaceHit<F>& x;
  const SurfaceScattering<F>& bsdf;
  const Spectrum<F>& throughput;
  const Vec3<F>& direction;
  F density, survival;
  Mask<F> delta, on, passes, in_medium, continues;
};

// A tally of a single path.
class PathRecorder {
 public:
  static constexpr bool records = true;
  static constexpr bool records_vertices = true;

  template <class F>
  void add(Mask<F> on, const Spectrum<F>& contribution, const LightOrigin<F>& from) {
    for_each_lane(on & (max_component(contribution) != F(0.0f)), [&](int k) {
      path_.contributions.push_back({path_.vertices.size(), to_rgb(lane(contribution, k)), lane(from.bounces, k),
                                     lane(from.light, k),
                                     lane(from.bounces, k) == 0 ? Technique::emission : from.technique});
    });
  }
  void add_early(std::uint32_t, const Spectrum<float>& contribution, const LightOrigin<float>& from) {
    add<float>(true, contribution, from);
  }
  void finish(int, std::uint32_t, const PixelSample& sample) { path_.radiance = sample.radiance; }

  template <class F>
  void visit(const VertexVisit<F>& v) {
    for_each_lane(v.on, [&](int k) {
      using enum PathVertex::Kind;
      const bool is_medium = lane_of_mask(v.in_medium, k);
      const Vec3f normal = is_medium ? Vec3f{0, 0, 0} : lane(v.bsdf.frame.n, k);
      path_.vertices.push_back({is_medium ? medium : lane_of_mask(v.passes, k) ? interface : surface,
                                lane(v.x.point.p, k), normal, lane(v.x.distance, k), lane(v.x.object, k),
                                lane(v.x.material, k), BsdfKind(lane(v.bsdf.kind, k)), to_rgb(lane(v.throughput, k)), lane(v.direction, k),
                                lane(v.density, k), lane_of_mask(v.delta, k), lane(v.survival, k), lane_of_mask(v.continues, k)});
    });
  }

  TracedPath take() && { return std::move(path_); }

 private:
  template <class M>
  static bool lane_of_mask(const M& mask, int k) {
    if constexpr (std::is_same_v<M, bool>)
      return mask;
    else
      return lane(mask, k);
  }

  TracedPath path_;
};

}  // namespace montelux
