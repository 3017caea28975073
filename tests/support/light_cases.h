// One or more lights of every kind, each alone in a set, with a chart of its points for tests.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "light/builder.h"
#include "mc/triangle.h"

namespace montelux::test {

// A point of a light by its place (x, y) in the unit square; for infinite lights `p` is a direction.
struct LightPoint {
  Vec3f p, n;
  Vec2f uv;
  double jacobian;  // area (solid angle) per unit of the square
};

struct LightCase {
  std::string name;
  LightKind kind;
  LightSet lights;
  Vec3f reference, n;  // n: the side of the reference point that scatters, or zero
  std::function<LightPoint(double, double)> at;
  std::function<Vec2f(Vec3f)> chart;  // the inverse of `at`, from a point (direction)
};

inline LightSet alone(LightSetBuilder builder) { return std::move(builder).build({}, {0, 0, 0}, 10); }
inline Vec2f in_square(double x, double y) {
  return {clamp(float(x), 0.0f, one_minus_epsilon), clamp(float(y), 0.0f, one_minus_epsilon)};
}

inline LightCase triangle_case(std::string name, TriangleShape s, Emission e, Vec3f reference) {
  LightSetBuilder b;
  b.add(s, e);
  Vec3f e1 = s.p1 - s.p0, e2 = s.p2 - s.p0, c = cross(e1, e2);
  auto at = [=](double x, double y) {
    Vec2f w = sample_triangle(Vec2f{float(x), float(y)});
    return LightPoint{s.p0 + e1 * w.x + e2 * w.y, normalize(c) * (s.flip ? -1.0f : 1.0f),
                      s.uv0 * (1 - w.x - w.y) + s.uv1 * w.x + s.uv2 * w.y, 0.5 * double(length(c))};
  };
  auto chart = [=](Vec3f p) {
    Vec3f q = p - s.p0;
    float inverse = 1 / dot(c, c);
    return invert_triangle(Vec2f{dot(cross(q, e2), c) * inverse, dot(cross(e1, q), c) * inverse});
  };
  return {std::move(name), LightKind::triangle, alone(std::move(b)), reference, {0, 0, 0}, at, chart};
}

// A patch whose parameters are found by Newton's method.
inline LightCase patch_case(std::string name, LightKind kind, PatchShape s, Emission e, Vec3f reference) {
  LightSetBuilder b;
  b.add(s, e);
  auto point = [=](double x, double y) {
    auto X = float(x), Y = float(y);
    return (s.p00 * (1 - X) + s.p10 * X) * (1 - Y) + (s.p01 * (1 - X) + s.p11 * X) * Y;
  };
  auto dx = [=](double y) { return (s.p10 - s.p00) * float(1 - y) + (s.p11 - s.p01) * float(y); };
  auto dy = [=](double x) { return (s.p01 - s.p00) * float(1 - x) + (s.p11 - s.p10) * float(x); };
  auto at = [=](double x, double y) {
    Vec3f c = cross(dx(y), dy(x));
    return LightPoint{point(x, y), normalize(c) * (s.flip ? -1.0f : 1.0f), {float(x), float(y)}, double(length(c))};
  };
  auto chart = [=](Vec3f p) {
    double x = 0.5, y = 0.5;
    for (int i = 0; i < 20; ++i) {
      Vec3f r = p - point(x, y), u = dx(y), v = dy(x), c = cross(u, v);
      x += double(dot(cross(r, v), c) / dot(c, c)), y += double(dot(cross(u, r), c) / dot(c, c));
    }
    return in_square(x, y);
  };
  return {std::move(name), kind, alone(std::move(b)), reference, {0, 0, 0}, at, chart};
}

inline LightCase disk_case(std::string name, DiskShape s, Emission e, Vec3f reference) {
  LightSetBuilder b;
  b.add(s, e);
  Vec3f across = cross(s.to_world.direction(Vec3f{1, 0, 0}), s.to_world.direction(Vec3f{0, 1, 0}));
  Vec3f n = normalize(s.to_world.normal(Vec3f{0, 0, s.flip ? -1.0f : 1.0f}));
  double inner2 = double(s.inner_radius) * s.inner_radius, r2 = double(s.radius) * s.radius;
  double area = double(length(across)) * double(pi) * (r2 - inner2) * double(s.phi_max) / 360;
  auto at = [=](double x, double y) {
    double r = std::sqrt(inner2 + x * (r2 - inner2)), phi = y * double(s.phi_max) / 180 * double(pi);
    Vec3f own{float(r * std::cos(phi)), float(r * std::sin(phi)), s.height};
    return LightPoint{s.to_world.point(own), n, {float(y), 0}, area};
  };
  auto chart = [=](Vec3f p) {
    Vec3f own = s.to_world.inverted().point(p);
    double turns = std::atan2(double(own.y), double(own.x)) / (2 * double(pi));
    return in_square((double(own.x * own.x + own.y * own.y) - inner2) / (r2 - inner2),
                     (turns - std::floor(turns)) * 360 / double(s.phi_max));
  };
  return {std::move(name), LightKind::disk, alone(std::move(b)), reference, {0, 0, 0}, at, chart};
}

// A sphere or cylinder; Jacobians by the derivatives of the mapped chart.
template <class Shape>
LightCase quadric_case(std::string name, Shape s, Emission e, Vec3f reference) {
  constexpr bool sphere = std::is_same_v<Shape, SphereShape>;
  LightSetBuilder b;
  b.add(s, e);
  double r = double(s.radius), low = double(s.z_min), high = double(s.z_max),
         turn = double(s.phi_max) / 180 * double(pi);
  if (sphere) low = std::max(low, -r), high = std::min(high, r);
  auto at = [=](double x, double y) {
    double z = low + x * (high - low), phi = y * turn, ring = sphere ? std::sqrt(std::max(0.0, r * r - z * z)) : r;
    Vec3f own{float(ring * std::cos(phi)), float(ring * std::sin(phi)), float(z)};
    Vec3f outward{own.x, own.y, sphere ? own.z : 0.0f};
    double slope = sphere ? -z / std::max(ring, 1e-9) : 0;
    Vec3f along{float(slope * std::cos(phi)), float(slope * std::sin(phi)), 1}, around{-own.y, own.x, 0};
    double area =
        double(length(cross(s.to_world.direction(along), s.to_world.direction(around)))) * (high - low) * turn;
    return LightPoint{s.to_world.point(own),
                      normalize(s.to_world.normal(outward)) * (s.flip ? -1.0f : 1.0f),
                      {float(y), float(x)},
                      area};
  };
  auto chart = [=](Vec3f p) {
    Vec3f own = s.to_world.inverted().point(p);
    double turns = std::atan2(double(own.y), double(own.x));
    if (turns < 0) turns += 2 * double(pi);
    return in_square((double(own.z) - low) / (high - low), turns / turn);
  };
  return {std::move(name),
          sphere ? LightKind::sphere : LightKind::cylinder,
          alone(std::move(b)),
          reference,
          {0, 0, 0},
          at,
          chart};
}

inline LightCase uniform_infinite_case(std::string name, Vec3f n) {
  LightSetBuilder b;
  b.add_uniform_infinite(gray_rgb(2.0f));
  LocalFrame<float> frame = LocalFrame<float>::from_normal(dot(n, n) > 0 ? n : Vec3f{0, 0, 1});
  auto at = [=](double x, double y) {
    double z = 2 * x - 1, r = std::sqrt(1 - z * z), phi = 2 * double(pi) * y;
    Vec3f w = frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
    return LightPoint{w, -w, {0, 0}, 4 * double(pi)};
  };
  auto chart = [=](Vec3f w) {
    Vec3f v = frame.to_local(w);
    double turns = std::atan2(double(v.y), double(v.x)) / (2 * double(pi));
    return in_square(0.5 + 0.5 * double(v.z), turns - std::floor(turns));
  };
  return {std::move(name), LightKind::uniform_infinite, alone(std::move(b)), {0, 0, 0}, n, at, chart};
}

// Ten texels a side, so that the cells of the tests' grids lie within texels.
inline std::shared_ptr<LightImage> test_image() {
  auto image = std::make_shared<LightImage>(LightImage{10, 10, {}});
  for (int i = 0; i < 100; ++i)
    image->texels.push_back({float((i * 37) % 11), float((i * 17) % 7) * 0.5f, i % 9 == 4 ? 12.0f : 0.25f});
  return image;
}

// `compensated`: sampled beside rays that materials draw.
inline LightCase image_infinite_case(bool compensated = false) {
  LightSetBuilder b;
  Transform turned = rotate(50, 1, 2, 3);
  b.add_image_infinite(turned, gray_rgb(0.5f), test_image());
  auto at = [=](double x, double y) {
    Vec3f w = turned.direction(sphere_from_square(Vec2f{float(x), float(y)}));
    return LightPoint{w, -w, {0, 0}, 4 * double(pi)};
  };
  auto chart = [=](Vec3f w) { return square_from_sphere(turned.inverted().direction(w)); };
  LightSet lights = alone(std::move(b));
  if (compensated) lights = *lights.compensated();
  return {compensated ? "image infinite, compensated" : "image infinite, turned",
          LightKind::image_infinite,
          std::move(lights),
          {0, 0, 0},
          {0, 0, 0},
          at,
          chart};
}

// Every way in which a light of the kind is sampled by a density; none for delta lights.
inline std::vector<LightCase> light_cases(LightKind kind) {
  Emission one{.radiance = {2, 1, 0.5f}}, both{.radiance = gray_rgb(1.5f), .two_sided = true};
  Transform skew = translate(0.3, -0.2, 0.1) * rotate(40, 1, 1, 0) * scale(1, 1.7, 0.6);
  switch (kind) {
    case LightKind::triangle: {
      TriangleShape t{{-1, -0.5f, 0}, {1.2f, -0.3f, 0.2f}, {0.1f, 1.1f, -0.3f}};
      return {triangle_case("triangle", t, one, {0.2f, 0.1f, 0.8f}),
              triangle_case("triangle from afar", t, both, {20, 90, -180}),
              triangle_case("triangle at a grazing angle", t, both, {2.5f, 0.2f, 0.1f})};
    }
    case LightKind::parallelogram: {
      PatchShape square{{-1, -1, 0}, {1, -1, 0}, {-1, 0.5f, 0}, {1, 0.5f, 0}, {}, {1, 0}, {0, 1}, {1, 1}, true};
      PatchShape slanted{{-1, -1, 0}, {1, -1, 0}, {-0.5f, 0.5f, 0.2f}, {1.5f, 0.5f, 0.2f}};
      return {patch_case("rectangle", kind, square, one, {0.4f, 0.8f, -0.9f}),
              patch_case("rectangle from afar", kind, square, both, {-20, 200, -300}),
              patch_case("parallelogram", kind, slanted, one, {0.4f, 0.3f, 0.9f})};
    }
    case LightKind::bilinear_patch: {
      PatchShape s{{-1, -1, 0.3f}, {1, -1.2f, 0}, {-1, 1, 0}, {0.7f, 0.9f, 0.5f}};
      PatchShape plane{{-1, -1, 0}, {1, -1, 0}, {-0.5f, 1, 0}, {0.4f, 1, 0}};
      return {patch_case("bilinear patch", kind, s, one, {0.1f, 0.2f, 2}),
              patch_case("flat bilinear patch", kind, plane, both, {0.1f, 0.9f, -0.8f})};
    }
    case LightKind::disk:
      return {disk_case("disk", {{}, 1, 0, 0.5f, 360, false}, one, {0.3f, 0.2f, 1.5f}),
              disk_case("sector of an elliptic ring", {skew, 1.2f, 0.5f, 0, 250, true}, both, {0.5f, 1, 1})};
    case LightKind::sphere:
      return {quadric_case("sphere", SphereShape{{}, 0.6f}, one, {0, 0, 1}),
              quadric_case("sphere from within", SphereShape{{}, 2, -1e9f, 1e9f, 360, true}, one, {0.5f, 0.9f, -0.3f}),
              quadric_case("ellipsoid", SphereShape{skew, 1}, both, {0.1f, 0.2f, 2.5f}),
              quadric_case("part of a sphere", SphereShape{{}, 1, -0.4f, 0.7f, 200}, both, {1, 2, 0.5f})};
    case LightKind::cylinder:
      return {quadric_case("cylinder", CylinderShape{{}, 0.5f, -1, 1, 360}, both, {2, 0.3f, 0.5f}),
              quadric_case("part of an elliptic cylinder", CylinderShape{skew, 0.8f, -0.5f, 1, 120}, both, {1, 2, 1})};
    case LightKind::uniform_infinite:
      return {uniform_infinite_case("sky on both sides", {0, 0, 0}),
              uniform_infinite_case("sky on one side", normalize(Vec3f{1, -2, 0.5f}))};
    case LightKind::image_infinite:
      return {image_infinite_case(), image_infinite_case(true)};
    case LightKind::point:
    case LightKind::spot:
    case LightKind::goniometric:
    case LightKind::projection:
    case LightKind::distant:
      return {};
  }
  return {};
}

inline std::vector<LightCase> all_light_cases() {
  std::vector<LightCase> all;
  for (std::size_t k = 0; k < light_kind_names.size(); ++k)
    for (LightCase& c : light_cases(LightKind(k))) all.push_back(std::move(c));
  return all;
}

// What hit() or escaped() says of a point of the case's light.
inline LightHit<float> met(const LightCase& c, const LightPoint& at) {
  if (is_infinite(c.kind)) return c.lights.escaped<float>(0, c.reference, c.n, at.p, true);
  Vec3f d = at.p - c.reference;
  return c.lights.hit<float>(0, c.reference, c.n, at.p, at.n, at.uv, normalize(d), true);
}
// Its density per unit of the chart's square, zero where no light comes from.
inline double chart_density(const LightCase& c, double x, double y) {
  LightPoint at = c.at(x, y);
  LightHit<float> hit = met(c, at);
  if (is_infinite(c.kind)) return double(hit.density.value) * at.jacobian;
  Vec3f d = at.p - c.reference;
  double d2 = double(dot(d, d)), cos = std::abs(double(dot(at.n, d))) / std::sqrt(d2);
  return double(hit.density.value) * at.jacobian * cos / d2;
}

}  // namespace montelux::test
