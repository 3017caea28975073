#include "geometry/tessellate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "geometry_samples.h"

namespace montelux {
namespace {

using test::random_direction;
using test::Stream;

// Counter-clockwise seen from outside.
Mesh octahedron() {
  Mesh m;
  m.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  m.triangles = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return m;
}

Mesh icosahedron() {
  const float g = 1.618034f;
  Mesh m;
  m.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.triangles = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                 3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  return m;
}

// n x n vertices in the plane, each square cut along the same diagonal; closed up to a torus where `wrap`.
Mesh grid(std::uint32_t n, bool wrap) {
  Mesh m;
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) m.positions.push_back({float(i), float(j), 0});
  auto at = [&](std::uint32_t i, std::uint32_t j) { return j % n * n + i % n; };
  for (std::uint32_t j = 0; j + (wrap ? 0 : 1) < n; ++j)
    for (std::uint32_t i = 0; i + (wrap ? 0 : 1) < n; ++i)
      for (std::uint32_t v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        m.triangles.push_back(v);
  return m;
}

std::ptrdiff_t euler_characteristic(const Mesh& m) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < m.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(m.triangles[t + k], m.triangles[t + (k + 1) % 3]));
  return std::ptrdiff_t(m.positions.size()) - std::ptrdiff_t(edges.size()) + std::ptrdiff_t(m.triangles.size() / 3);
}

TEST(LoopSubdivision, keeps_the_topology) {
  struct Case {
    Mesh mesh;
    std::ptrdiff_t characteristic;
  };
  for (const Case& c : {Case{octahedron(), 2}, Case{icosahedron(), 2}, Case{grid(4, true), 0}, Case{grid(4, false), 1}})
    for (int level = 0; level <= 3; ++level) {
      Mesh m = loop_subdivide(c.mesh, level);
      EXPECT_EQ(euler_characteristic(m), c.characteristic);
      EXPECT_EQ(m.triangles.size(), c.mesh.triangles.size() << (2 * level));
      EXPECT_EQ(m.normals.size(), m.positions.size());
    }
}

TEST(LoopSubdivision, limit_of_a_vertex_does_not_depend_on_the_level) {
  Stream r(1, 1);
  for (Mesh m : {octahedron(), icosahedron(), grid(5, true), grid(5, false)}) {
    for (Vec3f& p : m.positions) p = p + random_direction(r) * 0.3f;
    Mesh coarse = loop_subdivide(m, 0), fine = loop_subdivide(m, 4);
    // The vertices of a level keep their numbers in the next.
    for (std::size_t i = 0; i < m.positions.size(); ++i)
      EXPECT_LT(length(coarse.positions[i] - fine.positions[i]), 2e-6f) << i;
  }
}

TEST(LoopSubdivision, limit_of_an_octahedron_matches_the_closed_form) {
  // Valence four: the weight of a neighbour is 1 / (4 + 3 / (8 * 3 / 32)) = 1 / 8; the four neighbours cancel.
  Mesh m = loop_subdivide(octahedron(), 3);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(length(m.positions[i]), 0.5, 1e-6);
    // The normal lies on the axis, on the clockwise side: inward.
    EXPECT_NEAR(dot(m.normals[i], octahedron().positions[i]), -1, 1e-6);
  }
}

TEST(LoopSubdivision, limit_of_an_icosahedron_is_nearly_a_sphere) {
  Mesh m = loop_subdivide(icosahedron(), 4);
  double low = 1e9, high = 0, skew = 0;
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    double d = length(m.positions[i]);
    low = std::min(low, d), high = std::max(high, d);
    skew = std::max(skew, 1.0 + dot(m.normals[i], m.positions[i]) / d);
  }
  // The control mesh itself varies by 26 % from its corners to its faces.
  EXPECT_LT(high / low, 1.05);
  // Valence five: a neighbour's weight is 1 / (5 + 3 / (8 * 3 / 40)) = 1 / 10, and neighbours are at cos = 1 / sqrt(5).
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(length(m.positions[i]) / length(icosahedron().positions[i]), 0.5 + 0.5 / std::sqrt(5.0), 1e-6);
  EXPECT_LT(skew, 0.003);  // within four degrees of the radius
}

TEST(LoopSubdivision, is_affinely_invariant) {
  Transform map = rotate(30, 1, 2, 3) * scale(1, 3, 0.2) * translate(4, 5, 6);
  Mesh m = icosahedron(), moved = to_world(m, map, false).mesh;
  Mesh a = to_world(loop_subdivide(m, 3), map, false).mesh, b = loop_subdivide(moved, 3);
  for (std::size_t i = 0; i < a.positions.size(); ++i) EXPECT_LT(length(a.positions[i] - b.positions[i]), 2e-5f);
}

TEST(LoopSubdivision, boundary_is_the_cubic_b_spline_of_the_boundary_polygon) {
  // A fan around a centre; its rim is a closed polygon.
  Stream r(2, 2);
  const std::uint32_t n = 7;
  Mesh m;
  for (std::uint32_t i = 0; i < n; ++i) {
    SinCos<float> a = sin_cos_two_pi(float(i) / n);
    m.positions.push_back({a.cos, a.sin, 0.3f * r.next()});
    m.triangles.insert(m.triangles.end(), {n, i, (i + 1) % n});
  }
  m.positions.push_back({0, 0, 5});
  Mesh fine = loop_subdivide(m, 3);
  for (std::uint32_t i = 0; i < n; ++i) {
    Vec3f p = m.positions[i], before = m.positions[(i + n - 1) % n], after = m.positions[(i + 1) % n];
    EXPECT_LT(length(fine.positions[i] - (before + p * 4.0f + after) * (1.0f / 6)), 1e-6f);
  }
  // Nor does the inside move the rim.
  Mesh other = m;
  other.positions.back() = {1, 2, 30};
  Mesh moved = loop_subdivide(other, 3);
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(fine.positions[i].z, moved.positions[i].z);
}

TEST(LoopSubdivision, plane_stays_a_plane_with_its_normal_up_to_the_boundary) {
  Mesh m = loop_subdivide(grid(5, false), 2);
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    EXPECT_EQ(m.positions[i].z, 0);
    EXPECT_NEAR(m.normals[i].z, -1, 1e-6) << i;
  }
  EXPECT_LT(length(m.positions[12] - Vec3f{2, 2, 0}), 1e-6f);  // regular interior: linear functions are kept
}

TEST(LoopSubdivision, bears_edges_of_three_triangles_and_unused_vertices) {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {9, 9, 9}};
  m.triangles = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  Mesh fine = loop_subdivide(m, 2);
  EXPECT_EQ(fine.triangles.size(), 3u * 3 * 16);
  for (const Vec3f& p : fine.positions) EXPECT_TRUE(is_finite(p.x + p.y + p.z));
}

TEST(Tessellate, recognises_parallelograms) {
  EXPECT_TRUE(is_parallelogram({Vec3f{1, 1, 1}, Vec3f{3, 1, 2}, Vec3f{1, 5, 1}, Vec3f{3, 5, 2}}));
  EXPECT_FALSE(is_parallelogram({Vec3f{1, 1, 1}, Vec3f{3, 1, 2}, Vec3f{1, 5, 1}, Vec3f{3, 5, 2.001f}}));
  EXPECT_FALSE(
      is_parallelogram({Vec3f{0, 0, 0}, Vec3f{2, 0, 0}, Vec3f{0, 1, 0}, Vec3f{1, 1, 0}}));  // flat, a trapezium
}

TEST(Tessellate, split_quads_have_the_points_and_texture_of_their_patch) {
  Mesh m;
  m.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {2, 3, 0}, {4, 0, 1}, {4, 3, 2}};
  m.quads = {0, 1, 2, 3, 1, 4, 3, 5};
  for (bool with_uv : {false, true}) {
    if (with_uv) m.uvs = {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 2}, {1, 2}};
    SplitMesh s = split_affine_quads(m);
    ASSERT_EQ(s.triangles.triangles.size(), 6u);
    ASSERT_EQ(s.patches.quads.size(), 4u);
    BilinearPatch whole = patch_of(m, 0, false);
    for (std::size_t k = 0; k < 6; ++k) {
      std::uint32_t i = s.triangles.triangles[k];
      Vec3f p = s.triangles.positions[i];
      SurfacePoint<float> q = surface_point(whole, Vec2f{p.x / 2, p.y / 3});
      EXPECT_EQ(s.triangles.uvs[i].x, q.uv.x);
      EXPECT_EQ(s.triangles.uvs[i].y, q.uv.y);
    }
    const auto& t = s.triangles.triangles;
    for (std::size_t k : {0u, 3u}) {
      const auto& p = s.triangles.positions;
      EXPECT_EQ(cross(p[t[k + 1]] - p[t[k]], p[t[k + 2]] - p[t[k]]).z, 6);  // twice the area, on the patch's side
    }
    BilinearPatch before = patch_of(m, 1, false), after = patch_of(s.patches, 0, false);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(before.p[k].x, after.p[k].x);
      EXPECT_EQ(before.uv[k].y, after.uv[k].y);
    }
  }
}

TEST(Tessellate, drops_and_counts_degenerate_triangles_only) {
  Mesh m;
  m.positions = {{0, 0, 0}, {1e-12f, 0, 0}, {0, 1e-12f, 0}, {2e-12f, 0, 0}, {std::nanf(""), 0, 0}};
  m.triangles = {0, 1, 2, 0, 1, 3, 0, 0, 2, 0, 1, 4, 2, 1, 0};
  RepairedMesh r = drop_degenerate_triangles(m);
  EXPECT_EQ(r.dropped, 3u);
  EXPECT_EQ(r.mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 0}));
}

TEST(Tessellate, world_meshes_carry_a_flip_and_transformed_normals) {
  Mesh m = octahedron();
  m.normals = m.positions;
  WorldMesh plain = to_world(m, scale(1, 2, 1), false), mirrored = to_world(m, scale(1, -2, 1), false),
            reversed = to_world(m, scale(1, -2, 1), true);
  EXPECT_FALSE(plain.flip_normal);
  EXPECT_TRUE(mirrored.flip_normal);
  EXPECT_FALSE(reversed.flip_normal);
  EXPECT_EQ(mirrored.mesh.positions[2].y, -2);
  EXPECT_EQ(mirrored.mesh.normals[2].y, -1);
  EXPECT_EQ(reversed.mesh.normals[2].y, 1);
  EXPECT_EQ(mirrored.mesh.triangles, m.triangles);
}

}  // namespace
}  // namespace montelux
