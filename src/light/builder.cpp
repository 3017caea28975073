#include "light/builder.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace montelux {

namespace {

float radians(float degrees) { return degrees * (pi / 180); }

// The smallest box around points; also the bounds of a flat surface.
void set_box(LightBounds& b, std::initializer_list<Vec3f> points) {
  b.low = b.high = *points.begin();
  for (Vec3f p : points) b.low = min(b.low, p), b.high = max(b.high, p);
}

Vec3f unit_or_z(Vec3f v) {
  float l = length(v);
  return l > 0 && is_finite(l) ? v * (1 / l) : Vec3f{0, 0, 1};
}

// The mean of a function over the unit square by midpoints: sufficient for choosing lights and for scaling power.
template <class AreaAt>
double mean_over_square(AreaAt area_at, int n) {
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += area_at((float(i) + 0.5f) / float(n), (float(j) + 0.5f) / float(n));
  return sum / (double(n) * n);
}

// The mean of the texels in the box around the triangle's part of an image, plus one texel on each side because
// look-ups are bilinear; a large box is sampled by 64 x 64 texels. If all of these are black, others may still emit:
// the result is then a thousandth of `whole`, the mean of the image, so that only what is certainly black has no power.
Rgb texel_mean(const LightImage& image, const Rgb& whole, const TriangleShape& shape) {
  const auto range = [](float a, float b, float c, int size) {
    const auto place = [size](float x, int further) {
      return std::clamp(int(std::floor(std::clamp(x, 0.0f, 1.0f) * float(size))) + further, 0, size - 1);
    };
    return std::pair{place(std::min({a, b, c}), -1), place(std::max({a, b, c}), 1)};
  };
  const auto [x0, x1] = range(shape.uv0.x, shape.uv1.x, shape.uv2.x, image.width);
  const auto [y0, y1] = range(1 - shape.uv0.y, 1 - shape.uv1.y, 1 - shape.uv2.y, image.height);
  const int x_step = (x1 - x0) / 64 + 1, y_step = (y1 - y0) / 64 + 1;
  Rgb sum{};
  int count = 0;
  for (int y = y0; y <= y1; y += y_step)
    for (int x = x0; x <= x1; x += x_step, ++count) sum += image.at(x, y);
  const bool all_seen = x_step == 1 && y_step == 1;
  return all_seen || average(sum) > 0 ? sum * (1 / float(std::max(count, 1))) : whole * 1e-3f;
}

}  // namespace

LightId LightSetBuilder::add_row(LightKind kind, const LightRow& row, std::optional<LightBounds> bounds, float power) {
  auto id = LightId(std::uint32_t(tables_.kinds.size()));
  tables_.rows.push_back(row);
  tables_.kinds.push_back(std::uint32_t(kind));
  tables_.bounds.push_back(bounds);
  tables_.powers.push_back(std::isfinite(power) && power > 0 ? power : 0.0f);
  auto& names = tables_.group_names;
  const auto found = std::find(names.begin(), names.end(), group_);
  tables_.groups.push_back(std::uint32_t(found - names.begin()));
  if (found == names.end()) names.push_back(group_);
  return id;
}

void LightSetBuilder::begin_group(const std::string& name) { group_ = name; }

std::uint32_t LightSetBuilder::number_of(std::shared_ptr<const LightImage> image) {
  if (tables_.images.empty() || tables_.images.back() != image) {
    tables_.images.push_back(std::move(image));
    tables_.distributions.push_back(nullptr), tables_.excesses.push_back(nullptr);
  }
  return std::uint32_t(tables_.images.size());
}

std::uint32_t LightSetBuilder::number_of_directions(std::shared_ptr<const LightImage> image) {
  const std::uint32_t number = number_of(image);
  if (tables_.distributions[number - 1]) return number;
  tables_.distributions[number - 1] = distribution_of(*image);
  tables_.excesses[number - 1] = std::make_shared<const ExcessDistribution>(std::move(image));
  return number;
}

std::uint32_t LightSetBuilder::number_of(const Transform& to_world) {
  tables_.transforms.push_back(light_transform(to_world));
  return std::uint32_t(tables_.transforms.size() - 1);
}

LightSetBuilder::Surface LightSetBuilder::surface(const Emission& emission, float area, bool flip) {
  begin_group(emission.group);
  Surface s{};
  Rgb factor = emission.image ? emission.tint * emission.scale : emission.radiance * emission.scale;
  const bool known = emission.image && emission.image_mean;
  Rgb mean = known ? *emission.image_mean : emission.image ? emission.image->mean() : gray_rgb(1);
  float sides = emission.two_sided ? 2.0f : 1.0f;
  if (emission.power && area > 0) {
    // Without an image, L is taken to have luminance 1.
    float exitance = pi * (emission.image ? luminance(mean) : 1.0f) * sides;
    if (exitance > 0) factor = factor * (*emission.power / (exitance * area));
  }
  s.row.set_emission(factor);
  s.row.set_bits(light_slot::flags, (emission.two_sided ? light_two_sided : 0) | (flip ? light_flipped : 0) |
                                        (emission.masked ? light_masked : 0));
  if (emission.image) s.row.set_bits(light_slot::image, number_of(emission.image));
  s.bounds.intensity = area > 0 && !emission.masked ? average(factor * mean) * area : 0.0f;
  s.bounds.two_sided = emission.two_sided;
  s.power = pi * s.bounds.intensity * sides;
  return s;
}

// ---- surfaces -------------------------------------------------------------------------------------------------------

LightId LightSetBuilder::add(const TriangleShape& shape, const Emission& emission) {
  using T = TriangleEmitter<float>;
  Vec3f e1 = shape.p1 - shape.p0, e2 = shape.p2 - shape.p0, c = cross(e1, e2);
  float area = 0.5f * length(c);
  Vec3f n = unit_or_z(c) * (shape.flip ? -1.0f : 1.0f);
  auto [row, bounds, power] = surface(emission, area, shape.flip);
  if (emission.image && emission.local_power && !emission.masked) {
    const Rgb whole = emission.image_mean ? *emission.image_mean : emission.image->mean();
    const float local = average(texel_mean(*emission.image, whole, shape) * to_rgb(row.emission())) * area;
    power *= bounds.intensity > 0 ? local / bounds.intensity : 0.0f;
    bounds.intensity = local;
  }
  row.set(T::corner, shape.p0), row.set(T::edge1, e1), row.set(T::edge2, e2), row.set(T::normal, n);
  row.set(T::area, area);
  row.set(T::uv0, shape.uv0), row.set(T::uv1, shape.uv1), row.set(T::uv2, shape.uv2);
  set_box(bounds, {shape.p0, shape.p1, shape.p2});
  bounds.axis = n, bounds.cos_spread = 1;
  return add_row(LightKind::triangle, row, bounds, power);
}

LightId LightSetBuilder::add(const PatchShape& shape, const Emission& emission) {
  Vec3f a = shape.p10 - shape.p00, b = shape.p01 - shape.p00, c = shape.p11 - shape.p10 - b;
  float size = max(length(a), length(b)), sign = shape.flip ? -1.0f : 1.0f;
  if (length(c) < 1e-5f * size) {
    using T = ParallelogramEmitter<float>;
    float area = length(cross(a, b));
    Vec3f n = unit_or_z(cross(a, b)) * sign;
    auto [row, bounds, power] = surface(emission, area, shape.flip);
    if (std::abs(dot(a, b)) < 1e-5f * length(a) * length(b))
      row.set_bits(light_slot::flags, std::bit_cast<std::uint32_t>(row.v[light_slot::flags]) | light_special);
    row.set(T::corner, shape.p00), row.set(T::edge1, a), row.set(T::edge2, b), row.set(T::normal, n);
    row.set(T::area, area);
    row.set(T::uv00, shape.uv00), row.set(T::uv10, shape.uv10);
    row.set(T::uv01, shape.uv01), row.set(T::uv11, shape.uv11);
    set_box(bounds, {shape.p00, shape.p10, shape.p01, shape.p11});
    bounds.axis = n, bounds.cos_spread = 1;
    return add_row(LightKind::parallelogram, row, bounds, power);
  }
  using T = BilinearPatchEmitter<float>;
  auto scaled_normal = [&](float x, float y) { return cross(a + c * y, b + c * x); };
  auto area = float(mean_over_square([&](float x, float y) { return double(length(scaled_normal(x, y))); }, 32));
  auto [row, bounds, power] = surface(emission, area, shape.flip);
  row.set(T::corner, shape.p00), row.set(T::along_x, a), row.set(T::along_y, b), row.set(T::twist, c);
  row.set(T::uv00, shape.uv00), row.set(T::uv10, shape.uv10), row.set(T::uv01, shape.uv01),
      row.set(T::uv11, shape.uv11);
  set_box(bounds, {shape.p00, shape.p10, shape.p01, shape.p11});
  // The components of the normal are linear in each parameter, so the corners' normals span all of them.
  Vec3f corners[4] = {scaled_normal(0, 0), scaled_normal(1, 0), scaled_normal(0, 1), scaled_normal(1, 1)};
  bounds.axis = unit_or_z(scaled_normal(0.5f, 0.5f)) * sign;
  bounds.cos_spread = 1;
  for (Vec3f n : corners) bounds.cos_spread = min(bounds.cos_spread, dot(unit_or_z(n), bounds.axis) * sign);
  if (bounds.cos_spread < 0.1f) bounds.cos_spread = -1;
  return add_row(LightKind::bilinear_patch, row, bounds, power);
}

LightId LightSetBuilder::add(const DiskShape& shape, const Emission& emission) {
  using T = DiskEmitter<float>;
  Vec3f centre = shape.to_world.point(Vec3f{0, 0, shape.height});
  Vec3f a = shape.to_world.direction(Vec3f{shape.radius, 0, 0});
  Vec3f b = shape.to_world.direction(Vec3f{0, shape.radius, 0});
  float inner = shape.radius > 0 ? shape.inner_radius / shape.radius : 0, turn = shape.phi_max / 360;
  float area = length(cross(a, b)) * pi * turn * (1 - inner * inner);
  Vec3f n = unit_or_z(shape.to_world.normal(Vec3f{0, 0, shape.flip ? -1.0f : 1.0f}));
  auto [row, bounds, power] = surface(emission, area, shape.flip);
  row.set(T::centre, centre), row.set(T::axis1, a), row.set(T::axis2, b), row.set(T::normal, n);
  row.set(T::area, area), row.set(T::inner, inner), row.set(T::turn, turn);
  // The extent of an ellipse along an axis is the length of the vector of its half axes' components there.
  Vec3f reach{std::hypot(a.x, b.x), std::hypot(a.y, b.y), std::hypot(a.z, b.z)};
  set_box(bounds, {centre - reach, centre + reach});
  bounds.axis = n, bounds.cos_spread = 1;
  return add_row(LightKind::disk, row, bounds, power);
}

LightId LightSetBuilder::add_quadric(LightKind kind, const Transform& to_world, LightRow own, float own_area, bool flip,
                                     const Emission& emission) {
  const auto& m = to_world.matrix().m;
  double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  auto volume = float(std::abs(det));
  float radius = own.v[quadric_radius], low = own.v[quadric_low], high = own.v[quadric_high];
  bool sphere = kind == LightKind::sphere;
  // Area grows differently at different normals.
  double growth = mean_over_square(
      [&](float x, float y) {
        float z = sphere ? lerp(x, low, high) / radius : 0.0f, r = safe_sqrt(1 - z * z);
        SinCos<float> angle = sin_cos_two_pi(y * own.v[quadric_turn]);
        return double(volume * length(to_world.normal(Vec3f{r * angle.cos, r * angle.sin, z})));
      },
      32);
  auto [row, bounds, power] = surface(emission, own_area * float(growth), flip);
  for (int slot = light_slot::shape; slot < light_row_size; ++slot) row.v[slot] = own.v[slot];
  row.set(quadric_area, own_area), row.set(quadric_volume_scale, volume);
  row.set_bits(light_slot::transform, number_of(to_world));
  row.set(quadric_centre, to_world.point(Vec3f{0, 0, 0}));

  // A whole sphere that remains a sphere is sampled by its visible cap, if nothing else of it emits towards the point.
  Vec3f x = to_world.direction(Vec3f{radius, 0, 0}), y = to_world.direction(Vec3f{0, radius, 0});
  Vec3f z = to_world.direction(Vec3f{0, 0, radius});
  float r2 = dot(x, x), tolerance = 1e-5f * r2;
  bool round = std::abs(dot(y, y) - r2) < tolerance && std::abs(dot(z, z) - r2) < tolerance &&
               std::abs(dot(x, y)) < tolerance && std::abs(dot(y, z)) < tolerance && std::abs(dot(z, x)) < tolerance;
  bool whole = sphere && low <= -radius && high >= radius && own.v[quadric_turn] >= 1;
  const bool far_side_shines = emission.seen_through && (flip || emission.two_sided);
  if (whole && round && !far_side_shines) {
    row.set_bits(light_slot::flags, std::bit_cast<std::uint32_t>(row.v[light_slot::flags]) | light_special);
    row.set(quadric_world_radius, sqrt(r2));
  }
  // The mean projected area of a convex body is a quarter of its surface (Cauchy); for a part, at most half of its own.
  bounds.intensity *= whole ? 0.25f : 0.5f;
  Vec3f reach{std::hypot(x.x, y.x), std::hypot(x.y, y.y), std::hypot(x.z, y.z)};
  if (sphere) reach = {std::hypot(reach.x, z.x), std::hypot(reach.y, z.y), std::hypot(reach.z, z.z)};
  Vec3f bottom = to_world.point(Vec3f{0, 0, sphere ? 0 : low}), top = to_world.point(Vec3f{0, 0, sphere ? 0 : high});
  set_box(bounds, {bottom - reach, bottom + reach, top - reach, top + reach});
  return add_row(kind, row, bounds, power);
}

LightId LightSetBuilder::add(const SphereShape& shape, const Emission& emission) {
  LightRow own;
  float r = shape.radius, low = clamp(min(shape.z_min, shape.z_max), -r, r),
        high = clamp(max(shape.z_min, shape.z_max), -r, r);
  own.set(quadric_radius, r), own.set(quadric_low, low), own.set(quadric_high, high);
  own.set(quadric_turn, shape.phi_max / 360);
  return add_quadric(LightKind::sphere, shape.to_world, own, radians(shape.phi_max) * r * (high - low), shape.flip,
                     emission);
}

LightId LightSetBuilder::add(const CylinderShape& shape, const Emission& emission) {
  LightRow own;
  float low = min(shape.z_min, shape.z_max), high = max(shape.z_min, shape.z_max);
  own.set(quadric_radius, shape.radius), own.set(quadric_low, low), own.set(quadric_high, high);
  own.set(quadric_turn, shape.phi_max / 360);
  return add_quadric(LightKind::cylinder, shape.to_world, own, radians(shape.phi_max) * shape.radius * (high - low),
                     shape.flip, emission);
}

// ---- lights in a point ----------------------------------------------------------------------------------------------

LightId LightSetBuilder::add_point(Vec3f p, Rgb intensity) {
  LightRow row;
  row.set_emission(intensity);
  row.set(light_slot::shape, p);
  LightBounds b;
  b.low = b.high = p;
  b.intensity = average(intensity);
  return add_row(LightKind::point, row, b, 4 * pi * b.intensity);
}

float solid_angle(const SpotCone& cone) {
  const float cos_end = std::cos(radians(cone.end)), cos_edge = std::cos(radians(std::max(cone.edge, 0.0f)));
  // The mean over the edge is one half, that of its square one third.
  return two_pi * (1 - (cone.squared ? (cos_end + 2 * cos_edge) / 3 : 0.5f * (cos_edge + cos_end)));
}

LightId LightSetBuilder::add_spot(Vec3f p, Vec3f axis, const SpotCone& cone, Rgb intensity) {
  using T = SpotEmitter<float>;
  LightRow row;
  float cos_end = std::cos(radians(cone.end)), cos_edge = std::cos(radians(std::max(cone.edge, 0.0f)));
  row.set_emission(intensity);
  row.set(T::place, p), row.set(T::axis, unit_or_z(axis)), row.set(T::cos_end, cos_end), row.set(T::cos_edge, cos_edge);
  row.set(T::bend, cone.squared ? 0.0f : 2.0f);
  LightBounds b;
  b.low = b.high = p;
  b.axis = unit_or_z(axis), b.cos_spread = cos_end, b.cos_emission = 1;
  b.intensity = average(intensity);
  return add_row(LightKind::spot, row, b, solid_angle(cone) * b.intensity);
}

LightId LightSetBuilder::add_goniometric(const Transform& to_world, Rgb intensity,
                                         std::shared_ptr<const LightImage> image) {
  // The image's pole lies along y.
  Matrix4 swap;
  swap.m = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  LightRow row;
  LightBounds b;
  b.low = b.high = to_world.point(Vec3f{0, 0, 0});
  b.intensity = average(intensity) * (image ? average(image->mean()) : 1.0f);
  row.set_emission(intensity);
  row.set(light_slot::shape, b.low);
  row.set_bits(light_slot::transform, number_of(to_world * Transform(swap, swap)));
  if (image) row.set_bits(light_slot::image, number_of_directions(std::move(image)));
  return add_row(LightKind::goniometric, row, b, 4 * pi * b.intensity);
}

LightId LightSetBuilder::add_projection(const Transform& to_world, float fov, Rgb factor,
                                        std::shared_ptr<const LightImage> image) {
  // The slide's first row is at its upper edge.
  Transform slide = to_world * scale(1, -1, 1);
  float aspect = float(image->width) / float(image->height), tangent = std::tan(0.5f * radians(fov));
  float width = std::max(aspect, 1.0f), height = std::max(1 / aspect, 1.0f);
  LightRow row;
  LightBounds b;
  b.low = b.high = to_world.point(Vec3f{0, 0, 0});
  b.axis = unit_or_z(to_world.direction(Vec3f{0, 0, 1}));
  b.cos_spread = 1 / std::sqrt(1 + square(tangent) * (square(width) + square(height)));
  b.cos_emission = 1;
  b.intensity = average(factor * image->mean());
  row.set_emission(factor);
  row.set(projection_place, b.low), row.set(projection_cotangent, 1 / tangent);
  row.set(projection_half_width, width), row.set(projection_half_height, height);
  row.set_bits(light_slot::transform, number_of(slide));
  row.set_bits(light_slot::image, number_of_directions(std::move(image)));
  float solid_angle = 4 * std::asin(square(tangent) * width * height /
                                    std::sqrt((1 + square(tangent * width)) * (1 + square(tangent * height))));
  return add_row(LightKind::projection, row, b, solid_angle * b.intensity);
}

// ---- lights without a place -----------------------------------------------------------------------------------------

LightId LightSetBuilder::add_distant(Vec3f toward, Rgb irradiance) {
  LightRow row;
  row.set_emission(irradiance);
  row.set(light_slot::shape, unit_or_z(toward));
  return add_row(LightKind::distant, row, std::nullopt, pi * average(irradiance));
}

LightId LightSetBuilder::add_uniform_infinite(Rgb radiance) {
  LightRow row;
  row.set_emission(radiance);
  return add_row(LightKind::uniform_infinite, row, std::nullopt, 4 * pi * pi * average(radiance));
}

LightId LightSetBuilder::add_image_infinite(const Transform& to_world, Rgb factor,
                                            std::shared_ptr<const LightImage> image) {
  LightRow row;
  row.set_emission(factor);
  row.set_bits(light_slot::transform, number_of(to_world));
  float power = 4 * pi * pi * average(factor * image->mean());
  row.set_bits(light_slot::image, number_of_directions(std::move(image)));
  return add_row(LightKind::image_infinite, row, std::nullopt, power);
}

LightSet LightSetBuilder::build(LightSettings settings, Vec3f scene_centre, float scene_radius) && {
  tables_.scene_centre = scene_centre;
  tables_.scene_radius = scene_radius > 0 ? scene_radius : 1.0f;
  // Light from infinity is incident on the scene's disk; its power is stated without the area of the disk.
  for (std::size_t i = 0; i < tables_.kinds.size(); ++i)
    if (is_unbounded(LightKind(tables_.kinds[i]))) tables_.powers[i] *= square(tables_.scene_radius);
  return LightSet(std::move(tables_), settings);
}

}  // namespace montelux
