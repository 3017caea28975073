// The materials of a scene, and how a surface scatters at the points of a pack.
#pragma once
#include <array>
#include <vector>

#include "material/bound_material.h"
#include "material/material.h"
#include "scene/surface.h"
#include "texture/texture_set.h"

namespace montelux {

// A vertex ready to scatter: for every lane the model, its parameters, and the frame in which it works.
template <class F>
struct SurfaceScattering {
  BsdfSlots<F> slots;    // the parameters that the models of the lanes have
  Uint<F> kind;          // of BsdfKind
  LocalFrame<F> frame;   // z: the shading normal, normal map applied
  Vec3<F> light_normal;  // unit, on the side of wo; zero if light from both sides matters. For the choice of a light
  Mask<F> is_interface;  // nothing scatters: the path continues straight on
  Mask<F> is_delta;      // no direction towards a light can scatter

  BsdfLanes<F> lanes(Mask<F> on) const { return {kind, &slots, on}; }
};

class MaterialSet {
 public:
  MaterialSet() = default;
  // `textures` must outlive the set.
  MaterialSet(std::vector<Material> materials, const TextureSet* textures);

  // `d` is the direction of the incoming ray. `random` is used for mixtures.
  template <class F>
  SurfaceScattering<F> scattering(const SurfaceHit<F>& at, const Vec3<F>& d, Mask<F> on, RandomStream<F> random) const;

  // Whether a material lets a path pass unchanged at a point: for a mixture, u in [0, 1) decides.
  bool is_interface_at(std::uint32_t material, const TexturePoints<float>& point, float u) const;

  std::size_t size() const { return materials_.size(); }
  // Whether any surface lets paths pass unchanged: otherwise packs need not test for it.
  bool has_interfaces() const { return has_interfaces_; }
  const Material& operator[](std::size_t i) const { return materials_[i]; }

 private:
  // What packs gather of each material.
  enum Trait : std::uint32_t { needs_look_up = 1, is_mixture = 2, is_interface = 4, slots_shift = 8 };

  // Chooses among the parts of mixtures, through all levels of nesting.
  template <class F>
  Uint<F> settle_mixtures(Uint<F> material, const TexturePoints<F>& points, Mask<F> on, F u) const;
  // Textures and normal maps of the lanes that have one material.
  template <class F>
  void look_up(const Material& material, const SurfacePoint<F>& at, const TexturePoints<F>& points, Mask<F> on,
               SurfaceScattering<F>& s) const;

  std::vector<Material> materials_;
  const TextureSet* textures_ = nullptr;
  // One word, or one row, per material.
  std::vector<std::uint32_t> kinds_, traits_;
  std::vector<BsdfRow> rows_;
  bool has_mixtures_ = false, has_interfaces_ = false;
  std::array<std::uint32_t, bsdf_kind_count> two_sided_{};  // by BsdfKind
};

}  // namespace montelux
