// Every distribution of directions and of points in the plane: samples against density, density against 1, and back.
#include <gtest/gtest.h>

#include <algorithm>

#include "mc/hemisphere.h"
#include "mc/microfacet.h"
#include "mc/phong_lobe.h"
#include "mc/regular_polygon.h"
#include "mc/rejection.h"
#include "mc/spherical_rectangle.h"
#include "mc/spherical_triangle.h"
#include "mc/triangle.h"
#include "statistics.h"

namespace montelux {
namespace {

using namespace test;

const double level = sidak_level(family_level, 60);
constexpr double samples = 200000;
const LocalFrame<float> pole = LocalFrame<float>::from_normal({0, 0, 1});

// A planted fault: the first coordinate a little too low.
Vec2f bent(Vec2f u) { return {std::pow(u.x, 1.08f), u.y}; }

double distance_on_circle(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 1 - d);
}

template <class Sample, class Invert>
void expect_round_trip(Sample sample, Invert invert, double tolerance) {
  RandomStream<float> stream(3, 14);
  for (int i = 0; i < 2000; ++i) {
    const Vec2f u = stream.next2();
    const Vec2f back = invert(sample(u));
    EXPECT_NEAR(back.x, u.x, tolerance) << u.x << " " << u.y;
    EXPECT_LT(distance_on_circle(back.y, u.y), tolerance) << u.x << " " << u.y;
    EXPECT_TRUE(back.x >= 0 && back.x < 1 && back.y >= 0 && back.y < 1);
  }
}

template <class Sample>
void expect_lanes_equal_floats(Sample sample) {
  using F = NativeFloats;
  RandomStream<F> stream(lane_index<F>(), Uint<F>(5u));
  for (int i = 0; i < 100; ++i) {
    const Vec2<F> u = stream.next2();
    const auto many = sample(u);
    for (int k = 0; k < native_lanes; ++k) {
      const auto one = sample(lane(u, k));
      EXPECT_EQ(lane(many.x, k), one.x);
      EXPECT_EQ(lane(many.y, k), one.y);
    }
  }
}

// All properties of one distribution over the sphere.
template <class Sample, class DensityFunction, class Invert>
void check_directions(Sample sample, DensityFunction density, Invert invert, int panels = 1, double tolerance = 2e-3) {
  const auto fair = [&](RandomStream<float>& s) { return sample(s.next2()); };
  const auto faulty = [&](RandomStream<float>& s) { return sample(bent(s.next2())); };
  const TestResult good = chi_square_sample_density(fair, density, samples, 1, pole, panels);
  EXPECT_GT(good.p_value, level) << good.note;
  const TestResult bad = chi_square_sample_density(faulty, density, samples, 1, pole, panels);
  EXPECT_LT(bad.p_value, level) << bad.note;
  EXPECT_NEAR(integrate_sphere(density, pole, 40 * panels), 1, 1e-4);
  expect_round_trip(sample, invert, tolerance);
  expect_lanes_equal_floats(sample);
}

TEST(Sphere, samples_match_density) {
  check_directions([](auto u) { return sample_sphere(u); }, [](Vec3f) { return sphere_density<float>().value; },
                   [](Vec3f w) { return invert_sphere(w); });
}

TEST(Hemisphere, samples_match_density) {
  check_directions([](auto u) { return sample_hemisphere(u); }, [](Vec3f w) { return hemisphere_density(w.z).value; },
                   [](Vec3f w) { return invert_hemisphere(w); });
}

TEST(Hemisphere, rejection_gives_the_same_directions_with_the_efficiency_of_the_volumes) {
  AcceptanceRate rate;
  const auto sample = [&](RandomStream<float>& s) {
    const auto r = sample_hemisphere_by_rejection(s);
    rate.add(r);
    return r.value;
  };
  const TestResult r = chi_square_sample_density(
      sample, [](Vec3f w) { return hemisphere_density(w.z).value; }, samples, 1);
  EXPECT_GT(r.p_value, level) << r.note;
  EXPECT_GT(z_test(rate.efficiency(), rate.standard_error(), std::numbers::pi / 6).p_value, level);
  EXPECT_LT(z_test(rate.efficiency(), rate.standard_error(), 1.01 * std::numbers::pi / 6).p_value, level);
}

TEST(CosineHemisphere, samples_match_density) {
  check_directions([](auto u) { return sample_cosine_hemisphere(u); },
                   [](Vec3f w) { return cosine_hemisphere_density(w.z).value; },
                   [](Vec3f w) { return invert_cosine_hemisphere(w); });
}

TEST(Cone, samples_match_density) {
  // Edges on the lines of both grids.
  for (float open : {0.2f, 0.6f, 2.0f})
    check_directions([=](auto u) { return sample_cone(decltype(u.x)(open), u); },
                     [=](Vec3f w) { return w.z >= 1 - open ? cone_density(open).value : 0.0f; },
                     [=](Vec3f w) { return invert_cone(open, w); });
}

TEST(Cone, narrow_cone_is_uniform_in_its_own_chart) {
  for (float open : {1e-6f, 1e-3f}) {
    const auto chart = [=](Vec3f w) {
      const double r2 = double(w.x) * w.x + double(w.y) * w.y;
      const double turns = std::atan2(double(w.y), double(w.x)) / (2 * std::numbers::pi);
      return SpherePoint{r2 / (1 + std::sqrt(1 - r2)) / double(open), turns - std::floor(turns)};
    };
    const auto one = [](double, double) { return 1.0; };
    EXPECT_GT(
        chi_square_square([&](auto& s) { return chart(sample_cone(open, s.next2())); }, one, coarse_grid, samples, 1)
            .p_value,
        level);
    EXPECT_LT(chi_square_square([&](auto& s) { return chart(sample_cone(open, bent(s.next2()))); }, one, coarse_grid,
                                samples, 1)
                  .p_value,
              level);
    expect_round_trip([=](Vec2f u) { return sample_cone(open, u); }, [=](Vec3f w) { return invert_cone(open, w); },
                      1e-4);
  }
}

TEST(PhongLobe, samples_match_density) {
  for (float n : {0.0f, 1.0f, 7.5f, 30.0f})
    check_directions([=](auto u) { return sample_phong_lobe(decltype(u.x)(n), u); },
                     [=](Vec3f w) { return phong_lobe_density(n, w.z).value; },
                     [=](Vec3f w) { return invert_phong_lobe(n, w); }, 2);
}

TEST(GgxNormals, samples_match_density) {
  for (Roughness<float> a : {Roughness<float>{0.5f, 0.5f}, {0.2f, 0.7f}, {1.0f, 0.3f}})
    check_directions(
        [=](auto u) {
          using F = decltype(u.x);
          return sample_ggx_normal(Roughness<F>{a.x, a.y}, u);
        },
        [=](Vec3f m) { return ggx_normal_density(m, a).value; }, [=](Vec3f m) { return invert_ggx_normal(m, a); }, 4);
}

TEST(GgxVisibleNormals, samples_match_density_for_every_view) {
  for (Roughness<float> a : {Roughness<float>{0.5f, 0.5f}, {0.25f, 0.8f}})
    for (Vec3f view : {Vec3f{0, 0, 1}, {0.6f, -0.3f, 0.5f}, {-0.2f, 0.9f, 0.05f}}) {
      const Vec3f wo = normalize(view);
      check_directions(
          [=](auto u) {
            using F = decltype(u.x);
            return sample_visible_normal(splat<F>(wo), Roughness<F>{a.x, a.y}, u);
          },
          [=](Vec3f m) { return visible_normal_density(wo, m, a).value; },
          [=](Vec3f m) { return invert_visible_normal(wo, m, a); }, 4);
    }
}

TEST(GgxVisibleNormals, smooth_surfaces_match_density_in_the_stretched_space) {
  // h = M^-1 m, m = M h with M = diag(ax, ay, 1): dm = ax ay / |M h|^3 dh.
  for (Roughness<float> a : {Roughness<float>{0.01f, 0.04f}, {0.001f, 0.001f}})
    for (Vec3f view : {Vec3f{0, 0, 1}, {0.6f, -0.3f, 0.5f}}) {
      const Vec3f wo = normalize(view);
      const auto sample = [&](RandomStream<float>& s, bool faulty) {
        const Vec2f u = s.next2();
        const Vec3f m = sample_visible_normal(wo, a, faulty ? bent(u) : u);
        return normalize(Vec3f{m.x / a.x, m.y / a.y, m.z});
      };
      const auto density = [&](Vec3f h) {
        if (h.z <= 0) return 0.0f;
        const Vec3f m{a.x * h.x, a.y * h.y, h.z};
        const float l = length(m);
        return visible_normal_density(wo, m / l, a).value * a.x * a.y / (l * l * l);
      };
      const auto p_value = [&](bool faulty) {
        return chi_square_sample_density([&](auto& s) { return sample(s, faulty); }, density, samples, 1, pole, 4)
            .p_value;
      };
      EXPECT_GT(p_value(false), level);
      EXPECT_LT(p_value(true), level);
    }
}

TEST(GgxVisibleNormals, masking_is_the_seen_part_of_the_projected_area) {
  // The defining equation: the integral of D(m) max(wo.m, 0) G1 is the projected area wo.z (Heitz 2014, eq. 14).
  const Roughness<float> a{0.3f, 0.7f};
  for (Vec3f view : {Vec3f{0, 0, 1}, {0.6f, -0.3f, 0.5f}, {-0.2f, 0.9f, 0.05f}}) {
    const Vec3f wo = normalize(view);
    const double seen = integrate_sphere(
        [&](Vec3f m) { return ggx_g1(wo, a) * std::max(dot(wo, m), 0.0f) * ggx_d(m, a); }, pole, 100, 0, 1);
    EXPECT_NEAR(seen / double(wo.z), 1, 2e-4);
  }
}

// ---- spherical polygons: the chart is the plane, where dw = cos / d^2 dA
// ----------------------------------------------

struct Plane {
  Vec3f corner, edge_x, edge_y;
  // Coordinates along the edges of the point of the plane in the direction w.
  SpherePoint hit(Vec3f w) const {
    const Vec3f n = cross(edge_x, edge_y);
    const double t = double(dot(corner, n)) / double(dot(w, n));
    const Vec3f p = w * float(t) - corner;
    const double n2 = dot(n, n);
    return {double(dot(cross(p, edge_y), n)) / n2, double(dot(cross(edge_x, p), n)) / n2};
  }
  // Solid angle over the unit square of coordinates.
  double solid_angle_density(double x, double y) const {
    const Vec3f p = corner + edge_x * float(x) + edge_y * float(y), n = cross(edge_x, edge_y);
    return std::abs(double(dot(p, n))) / std::pow(double(dot(p, p)), 1.5);
  }
};

const std::vector<Plane> planes{{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}},
                                {{0.5f, 2, -1}, {0.8f, 0, 0}, {0, 0.3f, 1.4f}},
                                {{3, 0.1f, 2}, {0, 0.2f, 0}, {0.1f, 0, 0.2f}},
                                {{-0.5f, -3, 0.05f}, {1, 0, 0}, {0, 8, 0}}};

// Samples of directions by two numbers against their density in a chart of the unit square, which integrates to one;
// bent numbers do not follow it. The map has an inverse, and is the same in every lane.
template <class DensityFunction, class Chart, class Sample, class Invert>
void expect_to_follow(DensityFunction density, Chart chart, Sample sample, Invert invert) {
  const auto p_value = [&](auto numbers, Grid grid) {
    return chi_square_square([&](auto& s) { return chart(sample(numbers(s.next2()))); }, density, grid, samples, 1, 2)
        .p_value;
  };
  for (Grid grid : {coarse_grid, fine_grid}) EXPECT_GT(p_value([](Vec2f u) { return u; }, grid), level);
  EXPECT_LT(p_value(bent, coarse_grid), level);
  EXPECT_NEAR(integrate2(density, 0, 1, 0, 1, 64), 1, 1e-4);
  expect_round_trip(sample, invert, 2e-2);
  expect_lanes_equal_floats(sample);
}

TEST(SphericalTriangle, samples_are_uniform_in_solid_angle) {
  for (const Plane& plane : planes) {
    const auto of = [&]<class F>(F) {
      return SphericalTriangle<F>::from_corners(splat<F>(plane.corner), splat<F>(plane.corner + plane.edge_x),
                                                splat<F>(plane.corner + plane.edge_y));
    };
    const SphericalTriangle<float> t = of(1.0f);
    // Barycentric coordinates unfolded to the square: 1 - x - y = root, y = v root.
    const auto chart = [&](Vec3f w) {
      const SpherePoint b = plane.hit(w);
      const double root = std::clamp(1 - b.x, 1e-12, 1.0);
      return SpherePoint{std::clamp(root * root, 0.0, 1 - 1e-9), std::clamp(b.y / root, 0.0, 1 - 1e-9)};
    };
    const auto density = [&](double u, double v) {
      const double root = std::sqrt(u);
      return 0.5 * plane.solid_angle_density(1 - root, v * root) * double(spherical_triangle_density(t).value);
    };
    const auto sample = [&](auto u) { return sample_spherical_triangle(of(u.x), u); };
    expect_to_follow(density, chart, sample, [&](Vec3f w) { return invert_spherical_triangle(t, w); });
  }
}

TEST(SphericalTriangle, solid_angle_of_an_octant_is_half_pi_and_of_a_small_one_its_projected_area) {
  const auto t = SphericalTriangle<float>::from_corners({1, 0, 0}, {0, 3, 0}, {0, 0, 0.5f});
  EXPECT_NEAR(t.solid_angle, std::numbers::pi / 2, 1e-6);
  const auto s = SphericalTriangle<float>::from_corners({0, 0, 100}, {1, 0, 100}, {0, 1, 100});
  EXPECT_NEAR(s.solid_angle / 0.5e-4, 1, 2e-3);
}

TEST(SphericalRectangle, samples_are_uniform_in_solid_angle) {
  for (const Plane& plane : planes) {
    const auto of = [&]<class F>(F) {
      return SphericalRectangle<F>::from_edges(splat<F>(plane.corner), splat<F>(plane.edge_x), splat<F>(plane.edge_y));
    };
    const SphericalRectangle<float> rectangle = of(1.0f);
    const auto chart = [&](Vec3f w) {
      const SpherePoint p = plane.hit(w);
      return SpherePoint{std::clamp(p.x, 0.0, 1 - 1e-9), std::clamp(p.y, 0.0, 1 - 1e-9)};
    };
    const auto density = [&](double x, double y) {
      return plane.solid_angle_density(x, y) * double(spherical_rectangle_density(rectangle).value);
    };
    const auto sample = [&](auto u) { return sample_spherical_rectangle(of(u.x), u); };
    expect_to_follow(density, chart, sample, [&](Vec3f w) { return invert_spherical_rectangle(rectangle, w); });
  }
}

// ---- the plane
// --------------------------------------------------------------------------------------------------------

// The disk's chart: squared radius and azimuth, which keeps area.
SpherePoint disk_chart(Vec2f p) {
  const double turns = std::atan2(double(p.y), double(p.x)) / (2 * std::numbers::pi);
  return {std::clamp(double(p.x) * p.x + double(p.y) * p.y, 0.0, 1 - 1e-9),
          std::clamp(turns - std::floor(turns), 0.0, 1 - 1e-9)};
}
double disk_chart_density(double x, double y) {
  const double r = std::sqrt(x);
  const Vec2f p{float(r * std::cos(2 * std::numbers::pi * y)), float(r * std::sin(2 * std::numbers::pi * y))};
  return std::numbers::pi * double(disk_density(p).value);
}

template <class Sample>
double disk_p_value(Sample sample) {
  double smallest = 1;
  for (Grid grid : {coarse_grid, fine_grid})
    smallest = std::min(smallest, chi_square_square([&](auto& s) { return disk_chart(sample(s)); }, disk_chart_density,
                                                    grid, samples, 1)
                                      .p_value);
  return smallest;
}

TEST(Disk, samples_match_density) {
  const auto polar = [](auto u) { return sample_disk_polar(u); };
  const auto concentric = [](auto u) { return sample_disk_concentric(u); };
  EXPECT_GT(disk_p_value([&](auto& s) { return polar(s.next2()); }), level);
  EXPECT_GT(disk_p_value([&](auto& s) { return concentric(s.next2()); }), level);
  EXPECT_LT(disk_p_value([&](auto& s) { return polar(bent(s.next2())); }), level);
  EXPECT_LT(disk_p_value([&](auto& s) { return concentric(bent(s.next2())); }), level);
  expect_round_trip(
      polar, [](Vec2f p) { return invert_disk_polar(p); }, 1e-4);
  expect_round_trip(
      concentric, [](Vec2f p) { return invert_disk_concentric(p); }, 1e-4);
  expect_lanes_equal_floats(polar);
  expect_lanes_equal_floats(concentric);
}

// The polygon's chart: squared share of the way to the rim, and the place on the rim. It keeps area.
SpherePoint polygon_chart(Vec2f p, int n) {
  const double turns = std::atan2(double(p.y), double(p.x)) / (2 * std::numbers::pi), sector = 1.0 / n;
  const double side = std::floor((turns - std::floor(turns)) / sector),
               middle = 2 * std::numbers::pi * (side + 0.5) * sector;
  const double x = double(p.x) * std::cos(middle) + double(p.y) * std::sin(middle);
  const double y = double(p.y) * std::cos(middle) - double(p.x) * std::sin(middle);
  const double share = x / std::cos(std::numbers::pi * sector);
  const double along = (y / (std::max(share, 1e-30) * std::sin(std::numbers::pi * sector)) + 1) / 2;
  return {std::clamp(share * share, 0.0, 1 - 1e-9), std::clamp((side + along) * sector, 0.0, 1 - 1e-9)};
}

TEST(RegularPolygon, samples_match_density) {
  for (const int n : {3, 5, 6, 8}) {
    const auto sample = [n](auto u) { return sample_regular_polygon(u, n); };
    const double area = n * std::sin(2 * std::numbers::pi / n) / 2;
    const auto density = [&](double x, double y) {
      const double side = std::floor(y * n), w = y * n - side, r = std::sqrt(x), step = 2 * std::numbers::pi / n;
      const Vec2f p{float(r * ((1 - w) * std::cos(step * side) + w * std::cos(step * (side + 1)))),
                    float(r * ((1 - w) * std::sin(step * side) + w * std::sin(step * (side + 1))))};
      return area * double(regular_polygon_density(p * 0.9999f, n).value);
    };
    const auto p_value = [&](auto draw) {
      double smallest = 1;
      for (Grid grid : {coarse_grid, fine_grid})
        smallest = std::min(
            smallest,
            chi_square_square([&](auto& s) { return polygon_chart(draw(s), n); }, density, grid, samples, 1).p_value);
      return smallest;
    };
    EXPECT_GT(p_value([&](auto& s) { return sample(s.next2()); }), level) << n;
    EXPECT_LT(p_value([&](auto& s) { return sample(bent(s.next2())); }), level) << n;
    // The disk is no polygon.
    EXPECT_LT(p_value([&](auto& s) { return sample_disk_concentric(s.next2()); }), level) << n;
    EXPECT_EQ(regular_polygon_density(Vec2f{-1.01f, 0.0f}, n).value, 0.0f);
    expect_round_trip(
        sample, [n](Vec2f p) { return invert_regular_polygon(p, n); }, 2e-4);
    expect_lanes_equal_floats(sample);
  }
}

// Squares of a grid become parts of equal area that hang together: their corners stay close.
TEST(RegularPolygon, neighbours_in_the_square_stay_neighbours) {
  constexpr int n = 64;
  for (const int corners : {3, 6})
    for (int i = 0; i < n; ++i)
      for (int j = 0; j + 1 < n; ++j) {
        const auto at = [&](int x, int y) {
          return sample_regular_polygon(Vec2f{(float(x) + 0.5f) / n, (float(y) + 0.5f) / n}, corners);
        };
        const Vec2f across = at(j + 1, i) - at(j, i), up = at(i, j + 1) - at(i, j);
        ASSERT_LT(std::hypot(across.x, across.y), 6.0f / n);
        ASSERT_LT(std::hypot(up.x, up.y), 6.0f / n);
      }
}

TEST(Disk, rejection_matches_density_with_the_efficiency_of_the_areas) {
  AcceptanceRate rate;
  EXPECT_GT(disk_p_value([&](auto& s) {
              const auto r = sample_disk_by_rejection(s);
              rate.add(r);
              return r.value;
            }),
            level);
  EXPECT_GT(z_test(rate.efficiency(), rate.standard_error(), std::numbers::pi / 4).p_value, level);
}

TEST(Disk, the_map_with_radius_u_is_caught) {
  EXPECT_LT(disk_p_value([](auto& s) {
              const Vec2f u = s.next2();
              const SinCos<float> azimuth = sin_cos_two_pi(u.y);
              return Vec2f{u.x * azimuth.cos, u.x * azimuth.sin};
            }),
            1e-12);
}

TEST(Triangle, samples_match_density) {
  // Chart of the triangle with corners (0, 0), (1, 0), (0, 1) that keeps area: fold the square's upper half over.
  const auto sample = [](auto u) { return sample_triangle(u); };
  const auto p_value = [&](auto draw) {
    double smallest = 1;
    for (Grid grid : {coarse_grid, fine_grid}) {
      std::uint32_t n = 0;
      smallest = std::min(
          smallest, chi_square_square(
                        [&](auto& s) {
                          const Vec2f b = draw(s);
                          return (++n & 1u) != 0 ? b : Vec2f{1 - b.x - 1e-7f, 1 - b.y - 1e-7f};
                        },
                        [](double, double) { return 0.5 * double(triangle_density(0.5f).value); }, grid, samples, 1)
                        .p_value);
    }
    return smallest;
  };
  EXPECT_GT(p_value([&](auto& s) { return sample(s.next2()); }), level);
  EXPECT_LT(p_value([&](auto& s) { return sample(bent(s.next2())); }), level);
  expect_round_trip(
      sample, [](Vec2f b) { return invert_triangle(b); }, 1e-3);
  expect_lanes_equal_floats(sample);
}

}  // namespace
}  // namespace montelux
