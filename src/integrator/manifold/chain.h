// Specular chains: what a ray from a rough surface becomes at mirrors and glass whose events are given, with its
// differentials. Slightly rough surfaces take part by one of their facets, whose normal is given, too (Zeltner,
// Georgiev and Jakob 2020, "Specular Manifold Sampling", sec. 4.2).
#pragma once
#include <array>
#include <vector>

#include "accel/accel.h"
#include "geometry/double3.h"
#include "integrator/manifold/settings.h"
#include "transport/stored_vertex.h"

namespace montelux {

// Which event happens at each vertex of a chain, in the order of a path from the eye.
struct ChainKind {
  std::uint32_t length = 0;       // vertices, from 1 to max_chain_length
  std::uint32_t reflections = 0;  // bit i: a reflection at vertex i; else a refraction
  bool reflects(std::uint32_t i) const { return ((reflections >> i) & 1u) != 0; }
};

// Which surface a chain meets.
struct ChainPlace {
  std::uint32_t geometry = 0, instance = 0;
  bool operator==(const ChainPlace&) const = default;
};

// How a surface takes part in chains.
enum class Caster : std::uint32_t { none, smooth, rough };

// The ray that leaves the last vertex of a chain. Differentials are with respect to the two parameters a and b of the
// first direction, w + a s + b t with orthonormal s and t.
struct SpecularChain {
  Vec3f w, s, t;                                // at the rough vertex
  Vec3d p, d;                                   // the last vertex, and the unit direction from there
  std::array<Vec3d, 2> dp, dd;                  // their derivatives
  std::array<ChainPlace, max_chain_length> at;  // of the vertices
  Spectrum<float> left;                         // weight of the events and of the media on the way (radiance)
  StoredOrigin<float> last;
};

// Traces chains through a scene without participating media.
class ChainTracer {
 public:
  // Both must outlive it. Rough surfaces take part up to this roughness.
  ChainTracer(const Scene& scene, const Accel& accel, float max_roughness);

  // How surfaces of the material take part.
  Caster caster(std::size_t material) const { return Caster(casters_[material]); }
  // The same at surfaces, in every lane; none where the surface is a curve, or is smooth although its material is
  // rough, or the reverse.
  template <class F>
  Uint<F> caster_at(const SurfaceHit<F>& x, Mask<F> is_delta, Mask<F> on) const {
    const Uint<F> caster = gather(casters_.data(), select(on, x.material, Uint<F>(0u)));
    const Uint<F> wanted =
        select(is_delta, Uint<F>(std::uint32_t(Caster::smooth)), Uint<F>(std::uint32_t(Caster::rough)));
    return select(on & !x.ray_facing & (caster == wanted), caster, Uint<F>(std::uint32_t(Caster::none)));
  }
  // Follows the unit direction w from a rough vertex. False where the ray does not meet as many surfaces with such
  // events. `random` decides for mixtures of materials and for facets: chains with the same numbers go through the same
  // scene. A facet's normal has the density D(m) cos(m), which depends on no direction, and the weight of the chain is
  // divided by it.
  bool trace(const StoredOrigin<float>& from, const Vec3f& w, const ChainKind& kind, const RandomStream<float>& random,
             SpecularChain& chain, std::uint64_t& rays) const;

  const Scene& scene() const { return scene_; }
  const Accel& accel() const { return accel_; }

 private:
  const Scene& scene_;
  const Accel& accel_;
  std::vector<std::uint32_t> casters_;  // a Caster by material
};

}  // namespace montelux
