#include "light/builder.h"

namespace montelux {

LightId LightSetBuilder::add(LightKind kind, const LightRow& row, std::optional<LightBounds> bounds, float power) {
  auto id = LightId(std::uint32_t(tables_.kinds.size()));
  tables_.rows.push_back(row);
  tables_.kinds.push_back(std::uint32_t(kind));
  tables_.bounds.push_back(bounds);
  tables_.powers.push_back(power);
  return id;
}

LightSetBuilder::SurfaceRow LightSetBuilder::surface_row(const Emission& emission, float area, bool flip) {
  SurfaceRow r;
  Rgb factor = gray(emission.scale), mean = emission.radiance;
  if (emission.image)
    mean = emission.image->mean();
  else
    factor = emission.radiance * emission.scale;
  if (emission.power && area > 0) {
    // Without an image, L is taken to have luminance 1, as pbrt-v4 has it.
    float exitance = pi * (emission.image ? luminance(mean) : 1.0f) * (emission.two_sided ? 2.0f : 1.0f);
    if (exitance > 0) factor *= gray(*emission.power / (exitance * area));
  }
  r.row.set(light_slot::emission, factor);
  r.row.set_bits(light_slot::flags, (emission.two_sided ? light_two_sided : 0) | (flip ? light_flipped : 0));
  if (emission.image) {
    tables_.images.push_back(emission.image);
    r.row.set_bits(light_slot::image, std::uint32_t(tables_.images.size()));
  }
  r.mean_radiance = average(emission.image ? factor * mean : factor);
  return r;
}

LightId LightSetBuilder::add_triangle(const TriangleShape& shape, const Emission& emission) {
  using T = TriangleEmitter<float>;
  Vec3f e1 = shape.p1 - shape.p0, e2 = shape.p2 - shape.p0, c = cross(e1, e2);
  float twice = length(c), area = 0.5f * twice;
  Vec3f n = twice > 0 ? c * ((shape.flip ? -1.0f : 1.0f) / twice) : Vec3f{0, 0, 1};
  auto [row, radiance] = surface_row(emission, area, shape.flip);
  row.set(T::corner, shape.p0), row.set(T::edge1, e1), row.set(T::edge2, e2), row.set(T::normal, n);
  row.set(T::area, area);
  row.set(T::uv0, shape.uv0), row.set(T::uv1, shape.uv1), row.set(T::uv2, shape.uv2);
  LightBounds b;
  b.low = min(shape.p0, min(shape.p1, shape.p2)), b.high = max(shape.p0, max(shape.p1, shape.p2));
  b.axis = n, b.cos_spread = 1, b.cos_emission = 0;
  b.intensity = radiance * area, b.two_sided = emission.two_sided;
  return add(LightKind::triangle, row, b, pi * b.intensity * (emission.two_sided ? 2.0f : 1.0f));
}

LightId LightSetBuilder::add_uniform_infinite(Rgb radiance) {
  LightRow row;
  row.set(light_slot::emission, radiance);
  return add(LightKind::uniform_infinite, row, std::nullopt, average(radiance));
}

LightId LightSetBuilder::add_point(Vec3f p, Rgb intensity) {
  LightRow row;
  row.set(light_slot::emission, intensity);
  row.set(light_slot::shape, p);
  LightBounds b;
  b.low = b.high = p;
  b.intensity = average(intensity);
  return add(LightKind::point, row, b, 4 * pi * b.intensity);
}

LightId LightSetBuilder::add_distant(Vec3f toward, Rgb irradiance) {
  LightRow row;
  row.set(light_slot::emission, irradiance);
  row.set(light_slot::shape, normalize(toward));
  return add(LightKind::distant, row, std::nullopt, average(irradiance));
}

LightSet LightSetBuilder::build(LightSettings settings, Vec3f scene_centre, float scene_radius) && {
  tables_.scene_centre = scene_centre;
  tables_.scene_radius = scene_radius > 0 ? scene_radius : 1.0f;
  return LightSet(std::move(tables_), settings);
}

}  // namespace montelux
