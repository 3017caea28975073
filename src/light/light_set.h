// All lights of a scene, ready for sampling: flat tables that packs gather from.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "light/bvh.h"
#include "light/emission.h"
#include "light/emitters.h"
#include "light/image.h"
#include "light/images.h"
#include "light/light_point.h"
#include "mc/discrete.h"

namespace montelux {

// The tables of a LightSet, as filled by a builder: one entry per light unless stated.
struct LightTables {
  std::vector<LightRow> rows;
  std::vector<std::uint32_t> kinds;
  std::vector<std::optional<LightBounds>> bounds;                        // none: the light has no position
  std::vector<float> powers;                                             // emitted, W, averaged over the components
  std::vector<LightTransform> transforms;                                // by the number in a row; at least one
  std::vector<std::shared_ptr<const LightImage>> images;                 // by the number in a row
  std::vector<std::shared_ptr<const PiecewiseConstant2>> distributions;  // of each image; null: not needed
  std::vector<std::shared_ptr<const ExcessDistribution>> excesses;       // the same
  std::vector<std::uint32_t> groups;                                     // indices into group_names
  std::vector<std::string> group_names;
  Vec3f scene_centre{};
  float scene_radius = 1;
};

class ClusterField;
class SkyField;

// A light from infinity, as SkyField divides it: its density on the square map of the sphere.
struct SkyLight {
  LightId light{};
  LightTransform transform{};
  std::shared_ptr<const PiecewiseConstant2> table;
};

struct LightPolygon {
  std::array<Vec3f, 4> corners;
  int count = 0;  // 3 or 4
};

// Immutable. Every function is for one lane or many; `n` is the unit normal of the side that scatters at the reference
// point, or the zero vector if both sides do (or there is no surface). If n is given, lights and directions
// entirely on its other side may have probability zero. Idle lanes may contain anything.
class LightSet {
 public:
  LightSet() = default;  // no lights
  explicit LightSet(LightTables tables, LightSettings settings = {});

  // The same lights with other settings of the choice.
  LightSet with(LightSettings settings) const { return LightSet(tables_, settings); }
  // The same lights, one of which is sampled by the field.
  LightSet with(std::shared_ptr<const SkyField> sky) const;
  // The same lights, of which the hierarchy chooses by what the field knows of its clusters.
  LightSet with(std::shared_ptr<const ClusterField> clusters) const;
  // The same lights for next-event estimation beside directions that materials draw, which find all light as well: of
  // images at infinity only what exceeds their mean is sampled (Karlík et al. 2019, "MIS Compensation"). Only sampling
  // toward the lights changes. None: nothing would.
  std::optional<LightSet> compensated() const;
  // The lights with a place, if they are chosen by a hierarchy; else it is empty.
  const LightBvh& hierarchy() const { return bvh_; }
  // The light that `sky` is for, as SkyField takes it: the brightest that a ray hits when it leaves the scene; none:
  // there is no such light.
  std::optional<SkyLight> sky_light() const;

  std::uint32_t count() const { return std::uint32_t(tables_.kinds.size()); }
  LightKind kind(LightId light) const { return LightKind(tables_.kinds[std::uint32_t(light)]); }
  // Of its points; none: it has no position.
  const std::optional<LightBounds>& bounds(LightId light) const { return tables_.bounds[std::uint32_t(light)]; }
  // The group of every light, for layers of an image, and the names of the groups, in the order of their lights.
  const std::vector<std::uint32_t>& groups() const { return tables_.groups; }
  const std::vector<std::string>& group_names() const { return tables_.group_names; }
  const LightSettings& settings() const { return settings_; }
  float scene_radius() const { return tables_.scene_radius; }
  // Whether there are lights that no ray hits.
  bool has_delta() const { return has_delta_; }
  // Whether there are lights at one point.
  bool has_points() const { return has_points_; }
  // Whether there are lights with holes, which only rays find.
  bool has_masked() const { return has_masked_; }
  // The largest radiance that a ray meets at any light, or at those with holes alone, by channel.
  Rgb max_hit_radiance(bool masked_alone) const;

  std::uint32_t placed_count() const { return count() - std::uint32_t(unbounded_.size()); }
  // Lights without a position: they emit from infinity, or everywhere.
  bool has_beyond() const { return !unbounded_.empty(); }
  std::span<const std::uint32_t> beyond() const { return unbounded_; }
  // From each of them, with nothing in the way, averaged over the components.
  std::span<const float> beyond_irradiances() const { return unbounded_irradiances_; }
  template <class F>
  Mask<F> is_beyond(Uint<F> light, Mask<F> on) const;

  // The light to sample at p, and the probability of that choice (equal bit for bit).
  template <class F>
  LightChoice<F> choose(Vec3<F> p, Vec3<F> n, F u, Mask<F> on) const;
  template <class F>
  Mass<F> choice_mass(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on) const;

  // A direction towards some light. Only directions sampled by solid angle have the densities that hit() states.
  template <class F>
  LightSample<F> sample(Vec3<F> p, Vec3<F> n, F u_choice, Vec2<F> u, Mask<F> on,
                        LightMeasure measure = LightMeasure::solid_angle) const;
  // The same for a given light: its density and radiance do not include the choice.
  template <class F>
  LightSample<F> sample_light(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on,
                              LightMeasure measure = LightMeasure::solid_angle) const;

  // A point of a given light, sampled at p by solid angle, with the density of sample_light.
  template <class F>
  LightPointDraw<F> draw_light_point(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on) const;
  // The point p of the surface of `light` with its oriented unit normal; `radiance` is the result of hit_radiance.
  template <class F>
  LightPoint<F> point_of_hit(Uint<F> light, Vec3<F> p, Vec3<F> ng, Spectrum<F> radiance, Mask<F> on) const;
  // Where a light at one point is. `exists`: the lanes that have such a light.
  template <class F>
  LightPosition<F> position(Uint<F> light, Mask<F> on) const;
  // What a light point contributes at p.
  template <class F>
  LightPointView<F> view(const LightPoint<F>& point, Vec3<F> p, Vec3<F> n, Mask<F> on) const;

  // For a ray that left reference_p along the unit wi and hit the surface of `light` at p, where the oriented unit
  // normal is ng and uv are the surface's parameters.
  template <class F>
  LightHit<F> hit(Uint<F> light, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> p, Vec3<F> ng, Vec2<F> uv,
                  Vec3<F> wi, Mask<F> on) const;
  // Only the density of hit() or escaped(), for a light of any kind: for one without bounds p does not matter. Of a
  // delta light the probability of its choice, as sample() has it.
  template <class F>
  Density<SolidAngle, F> sampling_density(Uint<F> light, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> p,
                                          Vec3<F> wi, Mask<F> on) const;
  // Only the radiance of hit(), as needed by a camera ray.
  template <class F>
  Spectrum<F> hit_radiance(Uint<F> light, Vec3<F> ng, Vec2<F> uv, Vec3<F> wi, Mask<F> on) const;

  // The corners, in order, of a light that is a flat polygon; none for the other kinds.
  std::optional<LightPolygon> polygon(LightId light) const;

  // The lights that a ray hits when it leaves the scene, by their index in 0 ... infinite_count() - 1.
  int infinite_count() const { return infinite_count_; }
  LightId infinite_light(int index) const { return LightId(unbounded_[std::size_t(index)]); }
  template <class F>
  LightHit<F> escaped(int infinite_index, Vec3<F> reference_p, Vec3<F> reference_n, Vec3<F> wi, Mask<F> on) const;
  // The sum of their radiances.
  template <class F>
  Spectrum<F> escaped_radiance(Vec3<F> wi, Mask<F> on) const;

  // ---- rays that start at lights

  // Chooses lights in proportion to their power: for rays that start at lights. There must be a light.
  AliasTable by_power() const;
  // A ray from a light that is given.
  template <class F>
  LightEmission<F> emit(Uint<F> light, Vec2<F> u_point, Vec2<F> u_direction, Mask<F> on) const;
  // The densities with which emit() draws the ray along the unit d from the point p of a light; n is the unit normal of
  // the side of its surface that emits. p and n do not matter for other lights.
  template <class F>
  EmissionDensities<F> emission_densities(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec3<F> d, Mask<F> on) const;
  // The inverse of emit(): the numbers with which it draws the ray along the unit d from p, where a light has a choice;
  // elsewhere 0. n as above. Of a light without a place p is where the ray starts, on the disk.
  template <class F>
  EmissionNumbers<F> emission_numbers(Uint<F> light, Vec3<F> p, Vec3<F> n, Vec3<F> d, Mask<F> on) const;

 private:
  template <class F>
  MONTELUX_INLINE LightRows<F> rows(Uint<F> light, Mask<F> on) const {
    return {tables_.rows.data(), tables_.transforms.data(), select(on, light, Uint<F>(0u))};
  }
  // The choice between the unbounded lights, at the start of [0, 1), and the hierarchy, which has the rest.
  template <class F>
  struct BeyondChoice {
    Uint<F> light;    // the unbounded one, where one is chosen
    F mass;           // its probability
    Mask<F> chosen;   // elsewhere it is the hierarchy
    F share, u_rest;  // the probability of that, and the number for its choice
  };
  template <class F>
  MONTELUX_INLINE BeyondChoice<F> choose_beyond(Vec3<F> p, Vec3<F> n, F u, const NoFactors&) const;
  template <class F>
  MONTELUX_INLINE BeyondChoice<F> choose_beyond(Vec3<F> p, Vec3<F> n, F u, const ClusterFactors<F>& factors) const;
  template <class F>
  struct BeyondMass {
    F of_light, share;  // of a given unbounded light; of the hierarchy
  };
  template <class F>
  MONTELUX_INLINE BeyondMass<F> beyond_mass(Uint<F> light, Vec3<F> p, Vec3<F> n, const NoFactors&) const;
  template <class F>
  MONTELUX_INLINE BeyondMass<F> beyond_mass(Uint<F> light, Vec3<F> p, Vec3<F> n,
                                            const ClusterFactors<F>& factors) const;
  // The probability of each unbounded light, where nothing is known.
  template <class F>
  F unbounded_mass(Vec3<F> p, Vec3<F> n) const;
  // Calls take(j, mass) for each unbounded light, in their order; and returns in which lanes the hierarchy has the
  // rest.
  template <class F, class Take>
  MONTELUX_INLINE Mask<F> for_each_known_mass(Vec3<F> p, Vec3<F> n, const ClusterFactors<F>& factors, Take take) const;
  // choose() and choice_mass() by the hierarchy and the unbounded lights.
  template <class F, class Factors>
  MONTELUX_INLINE LightChoice<F> choose_by_bvh(Vec3<F> p, Vec3<F> n, F u, Mask<F> on, const Factors& factors) const;
  template <class F, class Factors>
  MONTELUX_INLINE Mass<F> mass_by_bvh(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on, const Factors& factors) const;
  // Calls f(kind, lanes) once for each kind of light among the lanes.
  template <class F, class Function>
  void for_each_kind(Uint<F> light, Mask<F> on, Function f) const;
  LightImages images() const { return {tables_.images.data(), tables_.distributions.data()}; }
  LightImages images_from_places() const {
    return {tables_.images.data(), compensated_.empty() ? tables_.distributions.data() : compensated_.data()};
  }

  template <class F>
  LightSample<F> sample_kind(LightKind kind, const LightRows<F>& rows, Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on,
                             LightMeasure measure) const;
  template <class F>
  Spectrum<F> surface_emission(const LightRows<F>& rows, Vec2<F> uv, Mask<F> on) const;
  template <class F>
  LightSample<F> sample_point_light(LightKind kind, const LightRows<F>& rows, Vec3<F> p, Mask<F> on) const;
  template <class F>
  LightEmission<F> emit_surface(LightKind kind, const LightRows<F>& rows, Vec2<F> u_point, Vec2<F> u_direction,
                                Mask<F> on) const;
  template <class F>
  static Density<SolidAngle, F> surface_emission_density(const LightRows<F>& rows, Vec3<F> n, Vec3<F> d);
  template <class F>
  LightEmission<F> emit_point(LightKind kind, const LightRows<F>& rows, Vec2<F> u, Mask<F> on) const;
  template <class F>
  LightEmission<F> emit_beyond(LightKind kind, const LightRows<F>& rows, Vec2<F> u_point, Vec2<F> u_direction,
                               Mask<F> on) const;
  template <class F>
  Density<Area, F> beyond_position_density() const;
  template <class F>
  Vec2<F> beyond_place_numbers(Vec3<F> p, Vec3<F> d) const;
  // Radiance, and the light's own density, without field and choice.
  template <class F>
  LightHit<F> escaped_light(LightId light, Vec3<F> n, Vec3<F> wi, Mask<F> on) const;
  // sample_light() of the light that has a field, and its density.
  template <class F>
  LightSample<F> sample_sky(Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on) const;
  template <class F>
  Density<SolidAngle, F> sky_density(Vec3<F> p, Vec3<F> n, Vec3<F> wi, Mask<F> on) const;
  // The same with the field of clusters.
  template <class F>
  LightChoice<F> choose_by_clusters(Vec3<F> p, Vec3<F> n, F u, Mask<F> on) const;
  template <class F>
  Mass<F> mass_by_clusters(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on) const;

  LightTables tables_;
  LightSettings settings_;
  // Distributions of the images at infinity for sampling toward them; empty: as for rays that start there.
  std::vector<std::shared_ptr<const PiecewiseConstant2>> compensated_;
  std::shared_ptr<const SkyField> sky_;           // null: every light is sampled on its own
  LightId light_of_sky_{};                        // the light that is sampled by the field
  std::shared_ptr<const ClusterField> clusters_;  // null: the hierarchy knows nothing of what is hidden
  LightBvh bvh_;                                  // if lights are chosen by the hierarchy
  std::optional<AliasTable> power_table_;         // if they are chosen by power
  std::vector<std::uint32_t> unbounded_;          // first the infinite ones, then the distant ones
  int infinite_count_ = 0;
  bool has_delta_ = false, has_points_ = false, has_masked_ = false;
  float equal_mass_ = 0;  // of each unbounded light if the hierarchy has no larger share than one of them
  std::vector<float> unbounded_irradiances_;  // with nothing in the way, averaged over the components
  float unbounded_irradiance_ = 0;            // their sum
};

}  // namespace montelux

#include "light/light_set_choice.h"
#include "light/light_set_emission.h"
#include "light/light_set_inversion.h"
#include "light/light_set_points.h"
#include "light/light_set_sampling.h"
