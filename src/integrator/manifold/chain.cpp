#include "integrator/manifold/chain.h"

#include "material/specular_lobe.h"
#include "mc/microfacet.h"
#include "scene/normal_gradient.h"
#include "scene/smoothness.h"
#include "transport/vertex.h"

namespace montelux {

namespace {

// Surfaces that one segment crosses without an event have numbers of their own.
constexpr std::uint32_t numbers_per_event = 1u << 16;
// The number of the facet of an event among them.
constexpr std::uint32_t of_facet = numbers_per_event - 1;

// A ray and its derivatives.
struct RayDifferential {
  Vec3d p, d;
  std::array<Vec3d, 2> dp, dd;

  // To the point at the distance t, where the surface has the geometric normal ng (Igehy 1999, eq. 10 to 12).
  void move(double t, const Vec3d& ng) {
    for (std::size_t j = 0; j < 2; ++j) {
      const Vec3d moved = dp[j] + dd[j] * t;
      dp[j] = moved - d * (dot(ng, moved) / dot(ng, d));
    }
  }
  // At the shading normal n (unit, against d), which changes by dn.
  void reflect(const Vec3d& n, const std::array<Vec3d, 2>& dn) {
    const double c = dot(d, n);
    for (std::size_t j = 0; j < 2; ++j) {
      const double dc = dot(dd[j], n) + dot(d, dn[j]);
      dd[j] = dd[j] - (n * dc + dn[j] * c) * 2.0;
    }
    d = unit(d - n * (2 * c));
  }
  // False at total internal reflection.
  bool refract(const Vec3d& n, const std::array<Vec3d, 2>& dn, double relative_eta) {
    const double ratio = 1 / relative_eta, c = -dot(d, n), squared = 1 - ratio * ratio * (1 - c * c);
    if (!(squared > 0)) return false;
    const double cos_t = std::sqrt(squared), along = ratio * c - cos_t;
    for (std::size_t j = 0; j < 2; ++j) {
      const double dc = -(dot(dd[j], n) + dot(d, dn[j])), dcos_t = ratio * ratio * c * dc / cos_t;
      dd[j] = dd[j] * ratio + n * (ratio * dc - dcos_t) + dn[j] * along;
    }
    d = unit(d * ratio + n * along);
    return true;
  }
};

// A normal, unit, and its derivatives.
struct MovingNormal {
  Vec3d n;
  std::array<Vec3d, 2> dn;
};

// The facet with the normal `local` in the frame of LocalFrame::from_normal(), of which all that matters is that it
// depends on the shading normal alone: facets are distributed alike in all directions about it.
MovingNormal facet_at(const MovingNormal& shading, const Vec3d& local) {
  const Vec3d& n = shading.n;
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z);
  const double b = n.x * n.y * a;
  const Vec3d s{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, t{b, sign + n.y * n.y * a, -n.y};
  MovingNormal facet{s * local.x + t * local.y + n * local.z, {}};
  for (std::size_t j = 0; j < 2; ++j) {
    const Vec3d& d = shading.dn[j];
    const double da = a * a * d.z, db = (d.x * n.y + n.x * d.y) * a + n.x * n.y * da;
    const Vec3d ds{sign * (2 * n.x * d.x * a + n.x * n.x * da), sign * db, -sign * d.x};
    const Vec3d dt{db, 2 * n.y * d.y * a + n.y * n.y * da, -d.y};
    facet.dn[j] = ds * local.x + dt * local.y + d * local.z;
  }
  return facet;
}

// f |cos wi| over the density of wi, without the event's own weight, for a facet whose normal m has the density
// D(m) cos(m). The cosines are those of wo with the facet, and of wo, wi and m with the surface.
float facet_weight(float o_m, float o_z, float i_z, float m_z, const Roughness<float>& roughness) {
  const auto at = [](float cosine) { return Vec3f{safe_sqrt(1 - cosine * cosine), 0, cosine}; };
  return o_m * ggx_g2(at(o_z), at(i_z), roughness) / (o_z * m_z);
}

}  // namespace

ChainTracer::ChainTracer(const Scene& scene, const Accel& accel, float max_roughness) : scene_(scene), accel_(accel) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    casters_.push_back(std::uint32_t(is_plain_specular(scene.materials, i)               ? Caster::smooth
                                     : is_plain_rough(scene.materials, i, max_roughness) ? Caster::rough
                                                                                         : Caster::none));
}

bool ChainTracer::trace(const StoredOrigin<float>& from, const Vec3f& w, const ChainKind& kind,
                        const RandomStream<float>& random, SpecularChain& chain, std::uint64_t& rays) const {
  using F = float;
  const LocalFrame<F> frame = LocalFrame<F>::from_normal(w);
  chain.w = w, chain.s = frame.s, chain.t = frame.t, chain.left = gray(1.0f), chain.at = {};
  RayDifferential r{to_double(from.p), to_double(w), {}, {to_double(frame.s), to_double(frame.t)}};
  r.dp = {Vec3d{0, 0, 0}, Vec3d{0, 0, 0}};
  Segment<F> segment{from.ray_toward(w), {}, from.media_toward(scene_.media, w)};
  std::uint32_t events = 0, crossings = 0;
  double distance = 0;  // since the last event
  while (events < kind.length) {
    ++rays;
    const auto [found, hit] = accel_.trace<F>(segment.ray, true);
    if (!found) return false;
    segment.hit = hit;
    const Vertex<F> v(scene_, segment, {true, true},
                      {TransportMode::radiance, random.fork(events * numbers_per_event + crossings)});
    distance += double(v.x.distance);
    chain.left *= v.media.along_wo().left(v.x.distance);
    if (v.bsdf.is_interface) {
      cross_interface(segment, v, true);
      ++crossings;
      continue;
    }
    const Caster caster = Caster(caster_at<F>(v.x, v.bsdf.is_delta, true));
    if (caster == Caster::none) return false;
    const bool reflects = kind.reflects(events);
    const Vec3d ng = to_double(v.x.point.ng), ns = to_double(v.bsdf.frame.n), d = r.d;
    const double side = dot(ns, d) > 0 ? -1 : 1;
    if (std::abs(dot(ng, d)) < 1e-6) return false;
    r.move(distance, ng);
    r.p = to_double(v.x.point.p);
    const NormalGradient gradient =
        normal_gradient(scene_.geometry, hit, v.x.point.p, v.bsdf.frame.n, segment.ray.time);
    const MovingNormal shading{ns * side, {gradient.along(r.dp[0]) * side, gradient.along(r.dp[1]) * side}};
    MovingNormal m = shading;
    Roughness<float> roughness{};
    if (caster == Caster::rough) {
      roughness = specular_facets(BsdfKind(v.bsdf.kind), v.bsdf.slots);
      m = facet_at(shading,
                   to_double(sample_ggx_normal(roughness, random.fork(events * numbers_per_event + of_facet).next2())));
    }
    const double o_m = -dot(d, m.n);
    if (!(o_m > 0)) return false;
    const SpecularLobe<float> lobe =
        specular_lobe(BsdfKind(v.bsdf.kind), v.bsdf.slots, std::copysign(float(o_m), v.wo.z), reflects);
    if (reflects)
      r.reflect(m.n, m.dn);
    else if (lobe.relative_eta != 1 && !r.refract(m.n, m.dn, double(lobe.relative_eta)))
      return false;
    chain.left *= lobe.weight;
    if (caster == Caster::rough) {
      const double i_z = dot(r.d, shading.n) * (reflects ? 1 : -1);
      if (!(i_z > 0)) return false;
      chain.left = chain.left * facet_weight(float(o_m), float(-dot(d, shading.n)), float(i_z),
                                             float(dot(m.n, shading.n)), roughness);
    }
    if (!(max_component(chain.left) > 0)) return false;
    chain.at[events] = {hit.geometry, hit.instance};
    const Vec3f onward = to_float(r.d);
    if (++events == kind.length) chain.last = stored_origin(v);
    segment.media = v.media_toward(onward), segment.ray = v.ray_toward(onward), crossings = 0, distance = 0;
  }
  chain.p = r.p, chain.d = r.d, chain.dp = r.dp, chain.dd = r.dd;
  return true;
}

}  // namespace montelux
