#include "material/measured_table.h"

#include <algorithm>

namespace montelux {

namespace {

// Where half vectors are closer to the normal, the density is the one at this angle: it grows without bound.
constexpr float min_half_angle = 1e-7f;
// The least projected area that is divided by.
constexpr float min_sigma = 1e-6f;

struct Spherical {
  float theta, phi;
};
Spherical spherical(Vec3f w) { return {atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z), atan2(w.y, w.x)}; }

// The unit square of directions: x = sqrt(2 theta / pi) has more room for the surroundings of the normal (the paper's
// section 4).
Vec2f place_of(float theta, float phi) {
  const float turns = (phi + pi) * inv_two_pi;
  return {std::sqrt(theta * (2 / pi)), turns - std::floor(turns)};
}
Spherical at_place(Vec2f p) { return {p.x * p.x * (pi / 2), (2 * p.y - 1) * pi}; }

// Between which of the increasing values x is, and how far; x beyond the ends is clamped.
struct Between {
  std::uint32_t first;
  float second_weight;
};
Between between(const std::vector<float>& values, float x) {
  const auto after = std::upper_bound(values.begin(), values.end(), x);
  if (after == values.begin()) return {0, 0};
  if (after == values.end()) return {std::uint32_t(values.size() - 1), 0};
  const auto i = std::uint32_t(after - values.begin() - 1);
  return {i, (x - values[i]) / (values[i + 1] - values[i])};
}

// The signs of x and y with which wo is in the measured sector; wi has the same.
Vec2f signs(AzimuthSymmetry symmetry, Vec3f wo) {
  const float y = wo.y > 0 ? -1.0f : 1.0f;
  if (symmetry == AzimuthSymmetry::none) return {1, 1};
  return {symmetry == AzimuthSymmetry::half_turn ? y : wo.x > 0 ? -1.0f : 1.0f, y};
}

}  // namespace

// What the tables need of wo.
struct MeasuredTable::Outgoing {
  Vec3f w;  // within the measured sector
  Vec2f sign;
  Spherical angles;
  float zero_azimuth;  // to which those of half vectors are relative
  TableBlend blend;

  Vec3f in_sector(Vec3f v) const { return {sign.x * v.x, sign.y * v.y, v.z}; }
};

// A half vector within the sector.
struct MeasuredTable::Half {
  Vec3f m;
  float theta;  // its angle with the normal
  Vec2f place;
};

MeasuredTable::MeasuredTable(MeasuredData data)
    : elevations_(std::move(data.elevations)),
      azimuths_(std::move(data.azimuths)),
      symmetry_(data.symmetry),
      divided_by_facets_(data.divided_by_facets),
      ndf_(std::move(data.ndf), data.ndf_size),
      sigma_(std::move(data.sigma), data.sigma_size),
      vndf_(data.vndf, data.vndf_size),
      luminance_(data.luminance, data.value_size),
      values_(std::move(data.values), data.value_size) {}

MeasuredTable::Outgoing MeasuredTable::outgoing(Vec3f wo) const {
  Outgoing o{wo, signs(symmetry_, wo), {}, 0, {}};
  o.w = o.in_sector(wo), o.angles = spherical(o.w);
  if (is_isotropic()) o.zero_azimuth = o.angles.phi;
  const Between azimuth = between(azimuths_, o.angles.phi), elevation = between(elevations_, o.angles.theta);
  o.blend.count = 0;
  for (std::uint32_t a = 0; a < 2; ++a)
    for (std::uint32_t e = 0; e < 2; ++e) {
      const float weight = (a ? azimuth.second_weight : 1 - azimuth.second_weight) *
                           (e ? elevation.second_weight : 1 - elevation.second_weight);
      if (weight == 0) continue;
      const auto k = std::size_t(o.blend.count++);
      o.blend.tables[k] = (azimuth.first + a) * std::uint32_t(elevations_.size()) + elevation.first + e;
      o.blend.weights[k] = weight;
    }
  return o;
}

// `u`: the place of half.m in the square that the facets' density warps to half vectors.
BsdfValue<float> MeasuredTable::value_at(const Outgoing& o, const Half& half, Vec2f u) const {
  // From the square of u to that of m, to half vectors (d m = 2 pi^2 x sin(theta) dx dy), to directions (d wi = 4
  // (wo.m) d m).
  const float theta = max(half.theta, min_half_angle);
  const float to_half = 2 * pi * pi * std::sqrt(theta * (2 / pi)) * sin_cos(theta).sin;
  const float density = luminance_.density(o.blend, u).value * vndf_.density(o.blend, half.place).value /
                        (to_half * 4 * max(dot(o.w, half.m), 1e-6f));
  if (!(density > 0)) return {gray(0.0f), {0}};

  const std::array<float, rgb_size> rgb = values_(o.blend, u);
  float facets = 1;
  if (divided_by_facets_) {
    const float sigma = sigma_({}, place_of(o.angles.theta, o.angles.phi))[0];
    facets = ndf_({}, half.place)[0] / (4 * max(sigma, min_sigma));
  }
  return {from_rgb(Rgb{{rgb[0], rgb[1], rgb[2]}} * facets), {density}};
}

BsdfValue<float> MeasuredTable::evaluate(Vec3f wo, Vec3f wi) const {
  const Outgoing o = outgoing(wo);
  const Vec3f m = normalize(o.w + o.in_sector(wi));
  const Spherical angles = spherical(m);
  const Half half{m, angles.theta, place_of(angles.theta, angles.phi - o.zero_azimuth)};
  return value_at(o, half, vndf_.invert(o.blend, half.place));
}

MeasuredTable::Sample MeasuredTable::sample(Vec3f wo, Vec2f u) const {
  const Outgoing o = outgoing(wo);
  const Vec2f v = luminance_.sample(o.blend, u), place = vndf_.sample(o.blend, v);
  const Spherical angles = at_place(place);
  const SinCos<float> theta = sin_cos(angles.theta), phi = sin_cos(angles.phi + o.zero_azimuth);
  const Vec3f m{theta.sin * phi.cos, theta.sin * phi.sin, theta.cos};
  const Vec3f wi = reflect(o.w, m);
  if (!(wi.z > 0)) return {o.in_sector(wi), {gray(0.0f), {0}}};
  return {o.in_sector(wi), value_at(o, {m, angles.theta, place}, v)};
}

}  // namespace montelux
