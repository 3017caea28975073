// The materials of a scene, and how a surface scatters at the points of a pack.
#pragma once
#include <array>
#include <vector>

#include "material/build.h"
#include "material/material.h"
#include "scene/surface.h"
#include "texture/texture_set.h"

namespace montelux {

// A vertex ready to scatter: for every lane the model, its parameters, and the frame in which it works.
template <class F>
struct SurfaceScattering {
  alignas(64) BsdfRow storage[lanes_of<F>];
  Uint<F> kind;          // of BsdfKind
  Frame<F> frame;        // z: the shading normal, normal map applied
  Vec3<F> light_normal;  // unit, on the side of wo; zero where light of both sides counts. For the choice of a light
  Mask<F> is_interface;  // nothing scatters: the path goes straight on
  Mask<F> is_delta;      // no direction toward a light can scatter

  BsdfLanes<F> lanes(Mask<F> on) const { return {kind, storage, on}; }
};

class MaterialSet {
 public:
  MaterialSet() = default;
  // `textures` must outlive the set.
  MaterialSet(std::vector<Material> materials, const TextureSet* textures);

  // `d` is the direction in which the path came. `random` serves mixtures.
  template <class F>
  SurfaceScattering<F> scattering(const SurfaceHit<F>& at, const Vec3<F>& d, Mask<F> on, RandomStream<F> random) const;

  std::size_t size() const { return materials_.size(); }
  const Material& operator[](std::size_t i) const { return materials_[i]; }

 private:
  // One point by itself: textures, mixtures, normal maps. Writes the row, and changes the frame where a map says so.
  struct PointScattering {
    BsdfKind kind;
    bool is_interface;
  };
  PointScattering look_up(std::uint32_t material, const SurfacePoint<float>& at, float u, BsdfRow& row,
                          Frame<float>& frame) const;

  std::vector<Material> materials_;
  const TextureSet* textures_ = nullptr;
  // What packs gather, a word each a material.
  std::vector<std::uint32_t> kinds_, plain_;
  std::array<std::uint32_t, bsdf_kind_count> two_sided_{};  // by BsdfKind
};

}  // namespace montelux
