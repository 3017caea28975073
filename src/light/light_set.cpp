#include "light/light_set.h"

#include <algorithm>
#include <array>
#include <span>

#include "light/cluster_field.h"
#include "light/sky_field.h"

namespace montelux {

LightSet::LightSet(LightTables tables, LightSettings settings) : tables_(std::move(tables)), settings_(settings) {
  if (tables_.transforms.empty()) tables_.transforms.push_back({});
  for (std::uint32_t i = 0; i < count(); ++i)
    if (is_unbounded(kind(LightId(i)))) unbounded_.push_back(i);
  std::stable_partition(unbounded_.begin(), unbounded_.end(),
                        [&](std::uint32_t i) { return is_infinite(kind(LightId(i))); });
  infinite_count_ = int(std::count_if(unbounded_.begin(), unbounded_.end(),
                                      [&](std::uint32_t i) { return is_infinite(kind(LightId(i))); }));
  for (std::uint32_t i = 0; i < count(); ++i) {
    has_delta_ |= is_delta(kind(LightId(i))), has_points_ |= is_at_point(kind(LightId(i)));
    has_masked_ |= rows<float>(i, true).flag(light_masked);
  }
  if (settings_.selection == LightSelection::power && count() > 0) power_table_ = by_power();
  if (settings_.selection == LightSelection::bvh) bvh_ = LightBvh(tables_.bounds);
  std::size_t shares = unbounded_.size() + (bvh_.empty() ? 0 : 1);
  equal_mass_ = shares > 0 ? 1.0f / float(shares) : 0.0f;
  // Powers are those through the disk of the scene; of a light from all directions a plane receives a quarter.
  const float disk = pi * tables_.scene_radius * tables_.scene_radius;
  for (const std::uint32_t i : unbounded_) {
    unbounded_irradiances_.push_back(tables_.powers[i] / disk * (is_infinite(kind(LightId(i))) ? 0.25f : 1.0f));
    unbounded_irradiance_ += unbounded_irradiances_.back();
  }
}

LightSet LightSet::with(std::shared_ptr<const SkyField> sky) const {
  LightSet lights = *this;
  if (sky) lights.light_of_sky_ = sky->light();
  lights.sky_ = std::move(sky);
  return lights;
}

LightSet LightSet::with(std::shared_ptr<const ClusterField> clusters) const {
  LightSet lights = *this;
  lights.clusters_ = std::move(clusters);
  return lights;
}

std::optional<LightSet> LightSet::compensated() const {
  auto distributions = tables_.distributions;
  for (std::uint32_t i : unbounded_) {
    if (kind(LightId(i)) != LightKind::image_infinite) continue;
    const std::size_t image = rows<float>(i, true).bits(light_slot::image) - 1;
    if (distributions[image] != tables_.distributions[image]) continue;  // another light has the same image
    if (auto excess = tables_.excesses[image]->get()) distributions[image] = std::move(excess);
  }
  if (distributions == tables_.distributions) return std::nullopt;
  LightSet lights = *this;
  lights.compensated_ = std::move(distributions);
  return lights;
}

Rgb LightSet::max_hit_radiance(bool masked_alone) const {
  const auto raise = [](Rgb& largest, const Rgb& other) {
    for (int c = 0; c < rgb_size; ++c) largest.c[c] = std::max(largest.c[c], other.c[c]);
  };
  std::vector<std::optional<Rgb>> of_images(tables_.images.size());  // which many lights may share
  Rgb largest = gray_rgb(0);
  for (std::uint32_t i = 0; i < count(); ++i) {
    const LightRows<float> row = rows<float>(i, true);
    if (is_delta(kind(LightId(i))) || (masked_alone && !row.flag(light_masked))) continue;
    Rgb radiance = to_rgb(row.emission());
    if (const std::uint32_t image = row.bits(light_slot::image); image > 0) {
      std::optional<Rgb>& texel = of_images[image - 1];
      if (!texel) {
        texel = gray_rgb(0);
        for (const Rgb& other : tables_.images[image - 1]->texels) raise(*texel, other);
      }
      radiance = radiance * *texel;
    }
    raise(largest, radiance);
  }
  return largest;
}

std::optional<SkyLight> LightSet::sky_light() const {
  const auto infinite = std::span(unbounded_).first(std::size_t(infinite_count_));
  if (infinite.empty()) return std::nullopt;
  const auto light = LightId(*std::ranges::max_element(infinite, {}, [&](auto i) { return tables_.powers[i]; }));
  if (kind(light) != LightKind::image_infinite)
    return SkyLight{light, light_transform({}), std::make_shared<PiecewiseConstant2>(std::array{1.0f}, 1u, 1u)};
  const LightRows<float> row = rows<float>(std::uint32_t(light), true);
  return SkyLight{light, tables_.transforms[row.bits(light_slot::transform)],
                  tables_.distributions[row.bits(light_slot::image) - 1]};
}

template <class F>
LightSample<F> LightSet::sample_sky(Vec3<F> p, Vec3<F> n, Vec2<F> u, Mask<F> on) const {
  const SkySample<F> s = sky_->sample(p, n, u, on);
  const LightRows<F> row = rows<F>(Uint<F>(std::uint32_t(light_of_sky_)), on);
  LightSample<F> r{};
  r.wi = s.wi, r.distance = F(2.0f * tables_.scene_radius);
  r.radiance = row.emission(), r.density = s.density;
  if (kind(light_of_sky_) == LightKind::image_infinite)
    r.radiance = r.radiance * ImageInfinite<F>(row, images()).factor_at(s.place, on);
  r.valid = on & !is_black(r.radiance) & (r.density.value > F(0.0f));
  r.delta = Mask<F>(false), r.infinite = Mask<F>(true);
  return r;
}

template <class F>
Density<SolidAngle, F> LightSet::sky_density(Vec3<F> p, Vec3<F> n, Vec3<F> wi, Mask<F> on) const {
  return sky_->density(p, n, wi, on);
}

template <class F>
LightChoice<F> LightSet::choose_by_clusters(Vec3<F> p, Vec3<F> n, F u, Mask<F> on) const {
  return choose_by_bvh(p, n, u, on, clusters_->at(p, n, on));
}

template <class F>
Mass<F> LightSet::mass_by_clusters(Uint<F> light, Vec3<F> p, Vec3<F> n, Mask<F> on) const {
  return mass_by_bvh(light, p, n, on, clusters_->at(p, n, on));
}

#define MONTELUX_LEARNED(F)                                                                        \
  template LightSample<F> LightSet::sample_sky(Vec3<F>, Vec3<F>, Vec2<F>, Mask<F>) const;          \
  template Density<SolidAngle, F> LightSet::sky_density(Vec3<F>, Vec3<F>, Vec3<F>, Mask<F>) const; \
  template LightChoice<F> LightSet::choose_by_clusters(Vec3<F>, Vec3<F>, F, Mask<F>) const;        \
  template Mass<F> LightSet::mass_by_clusters(Uint<F>, Vec3<F>, Vec3<F>, Mask<F>) const;
MONTELUX_LEARNED(float)
MONTELUX_LEARNED(NativeFloats)
#undef MONTELUX_LEARNED

AliasTable LightSet::by_power() const {
  return AliasTable(std::vector<double>(tables_.powers.begin(), tables_.powers.end()));
}

std::optional<LightPolygon> LightSet::polygon(LightId light) const {
  const LightKind its_kind = kind(light);
  if (its_kind != LightKind::triangle && its_kind != LightKind::parallelogram) return std::nullopt;
  const LightRows<float> row = rows<float>(std::uint32_t(light), true);
  // The rows of both kinds begin with a corner and two edges.
  const TriangleEmitter<float> flat(row);
  const Vec3f a = flat.p0, b = a + flat.e1, d = a + flat.e2;
  if (its_kind == LightKind::triangle) return LightPolygon{{a, b, d, d}, 3};
  return LightPolygon{{a, b, b + flat.e2, d}, 4};
}

}  // namespace montelux
