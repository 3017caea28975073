// Loop subdivision on an array of half-edges: half-edge h of triangle h / 3 runs from corner h to the next corner.
#include <algorithm>
#include <numbers>

#include "geometry/double3.h"
#include "geometry/tessellate.h"

namespace montelux {

namespace {

using Index = std::uint32_t;
constexpr Index none = 0xffffffffu;

Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }

struct LoopMesh {
  std::vector<Vec3d> positions;
  std::vector<Index> triangles;  // the vertex where each half-edge starts
  std::vector<Index> opposite;   // the same edge in the neighbouring triangle, or none at the boundary
  std::vector<Index> first;      // a half-edge that leaves each vertex, the most clockwise one at the boundary; or none

  Index from(Index h) const { return triangles[h]; }
  Index to(Index h) const { return triangles[next(h)]; }
};

// Pairs half-edges of opposite direction; each direction of an edge occurs once.
std::vector<Index> pair_edges(const std::vector<Index>& triangles) {
  struct Edge {
    Index low, high, half_edge;
    bool ascending;
  };
  std::vector<Edge> edges(triangles.size());
  for (Index h = 0; h < triangles.size(); ++h) {
    Index a = triangles[h], b = triangles[next(h)];
    edges[h] = {std::min(a, b), std::max(a, b), h, a < b};
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.half_edge < b.half_edge;
  });
  std::vector<Index> opposite(triangles.size(), none);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    if (end - i == 2 && edges[i].ascending != edges[i + 1].ascending) {
      opposite[edges[i].half_edge] = edges[i + 1].half_edge;
      opposite[edges[i + 1].half_edge] = edges[i].half_edge;
    }
    i = end;
  }
  return opposite;
}

LoopMesh connect(std::vector<Vec3d> positions, std::vector<Index> triangles) {
  LoopMesh m{std::move(positions), std::move(triangles), {}, {}};
  m.opposite = pair_edges(m.triangles);
  m.first.assign(m.positions.size(), none);
  for (Index h = 0; h < m.triangles.size(); ++h) {
    Index v = m.from(h);
    if (m.first[v] == none || m.opposite[h] == none) m.first[v] = h;
  }
  return m;
}

// The neighbours of a vertex in counter-clockwise order; at the boundary from one end to the other.
struct Ring {
  std::vector<Vec3d> points;
  bool boundary = false;
};

void walk_ring(const LoopMesh& m, Index v, Ring& ring) {
  ring.points.clear();
  Index start = m.first[v], h = start;
  ring.boundary = m.opposite[start] == none;
  do {
    ring.points.push_back(m.positions[m.to(h)]);
    Index incoming = previous(h);
    h = m.opposite[incoming];
    if (h == none) {
      ring.boundary = true;
      ring.points.push_back(m.positions[m.from(incoming)]);
    }
  } while (h != none && h != start);
}

// (1 - n w) p + w sum of the ring.
Vec3d weigh(Vec3d p, const Ring& ring, double w) {
  Vec3d sum{0, 0, 0};
  for (Vec3d q : ring.points) sum += q;
  return p * (1 - double(ring.points.size()) * w) + sum * w;
}
Vec3d weigh_ends(Vec3d p, const Ring& ring, double w) {
  return p * (1 - 2 * w) + (ring.points.front() + ring.points.back()) * w;
}

// Weight of a neighbour at a vertex of the given valence (Warren's choice of Loop's beta).
double beta(std::size_t valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8 * double(valence)); }
double limit_weight(std::size_t valence) { return 1 / (double(valence) + 3 / (8 * beta(valence))); }

LoopMesh refine(const LoopMesh& m) {
  std::vector<Vec3d> positions(m.positions.size());
  Ring ring;
  for (Index v = 0; v < m.positions.size(); ++v) {
    Vec3d p = m.positions[v];
    if (m.first[v] != none) {
      walk_ring(m, v, ring);
      p = ring.boundary ? weigh_ends(p, ring, 1.0 / 8) : weigh(p, ring, beta(ring.points.size()));
    }
    positions[v] = p;
  }
  // One new vertex for each edge.
  std::vector<Index> middle(m.triangles.size());
  for (Index h = 0; h < m.triangles.size(); ++h) {
    Index o = m.opposite[h];
    if (o != none && o < h) {
      middle[h] = middle[o];
      continue;
    }
    Vec3d ends = m.positions[m.from(h)] + m.positions[m.to(h)];
    Vec3d p = ends * 0.5;
    if (o != none) p = ends * 0.375 + (m.positions[m.from(previous(h))] + m.positions[m.from(previous(o))]) * 0.125;
    middle[h] = Index(positions.size());
    positions.push_back(p);
  }
  std::vector<Index> triangles;
  triangles.reserve(4 * m.triangles.size());
  for (Index h = 0; h < m.triangles.size(); h += 3) {
    // Every child keeps its old corner, if any, in the same position: default texture coordinates depend on it.
    Index m0 = middle[h], m1 = middle[h + 1], m2 = middle[h + 2];
    triangles.insert(triangles.end(), {m.from(h), m0, m2, m0, m.from(h + 1), m1, m2, m1, m.from(h + 2), m0, m1, m2});
  }
  return connect(std::move(positions), std::move(triangles));
}

// The normal of the limit surface on its clockwise side, from two tangents; not unit.
Vec3d limit_normal(Vec3d p, const Ring& ring) {
  const auto& q = ring.points;
  const std::size_t n = q.size();
  Vec3d s{0, 0, 0}, t{0, 0, 0};
  if (!ring.boundary) {
    for (std::size_t k = 0; k < n; ++k) {
      double angle = 2 * std::numbers::pi * double(k) / double(n);
      s += q[k] * std::cos(angle), t += q[k] * std::sin(angle);
    }
    return cross(t, s);
  }
  // Along the boundary, and across it into the surface (Hoppe et al. 1994).
  s = q.front() - q.back();
  if (n == 2) {
    t = q[0] + q[1] - p * 2.0;
  } else if (n == 3) {
    t = q[1] - p;
  } else if (n == 4) {
    t = (q[1] + q[2] - p) * 2.0 - q[0] - q[3];
  } else {
    double angle = std::numbers::pi / double(n - 1);
    t = (q.front() + q.back()) * -std::sin(angle);
    for (std::size_t k = 1; k + 1 < n; ++k) t += q[k] * ((2 - 2 * std::cos(angle)) * std::sin(double(k) * angle));
  }
  return cross(t, s);
}

}  // namespace

Mesh loop_subdivide(const Mesh& control, int levels) {
  std::vector<Vec3d> positions;
  for (Vec3f p : control.positions) positions.push_back(to_double(p));
  LoopMesh m = connect(std::move(positions), control.triangles);
  for (int i = 0; i < levels; ++i) m = refine(m);

  // Limit positions first, all from the same level; the tangents then come from the rings of limit positions.
  std::vector<Vec3d> limit = m.positions;
  Ring ring;
  for (Index v = 0; v < m.positions.size(); ++v) {
    if (m.first[v] == none) continue;
    walk_ring(m, v, ring);
    limit[v] = ring.boundary ? weigh_ends(m.positions[v], ring, 1.0 / 6)
                             : weigh(m.positions[v], ring, limit_weight(ring.points.size()));
  }
  m.positions = limit;
  Mesh r;
  for (Index v = 0; v < m.positions.size(); ++v) {
    Vec3d normal{0, 0, 0};
    if (m.first[v] != none) {
      walk_ring(m, v, ring);
      normal = unit(limit_normal(m.positions[v], ring));
    }
    r.positions.push_back(to_float(m.positions[v]));
    r.normals.push_back(to_float(normal));
  }
  r.triangles = std::move(m.triangles);
  return r;
}

}  // namespace montelux
