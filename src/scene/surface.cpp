#include "scene/surface.h"

#include "math/affine.h"
#include "math/row_gather.h"
#include "scene/placement.h"

namespace montelux {

namespace {

static_assert(sizeof(GeometryRow) == 4 * words_of_row);

// Positions of the members of GeometryRow, in words.
enum RowWord : std::uint32_t {
  kind,
  first,
  count,
  flags,
  material,
  first_light,
  alpha,
  object,
  poses,
  pose_vertices,
  inside,
  outside
};
static_assert(offsetof(GeometryRow, object) == 4 * RowWord::object &&
              offsetof(GeometryRow, pose_vertices) == 4 * RowWord::pose_vertices &&
              offsetof(GeometryRow, outside) == 4 * RowWord::outside &&
              offsetof(GeometryRow, flags) == 4 * RowWord::flags);

// The row of each lane, by its words.
template <class F>
struct RowOf {
  std::array<F, words_of_row> words;
  RowOf(const GeometryStore& store, Uint<F> number)
      : words(gather_rows<F>(reinterpret_cast<const float*>(store.rows.data()), number)) {}
  MONTELUX_INLINE Uint<F> operator[](RowWord i) const { return float_bits(words[i]); }
};

// The vertices of the triangle of each lane.
template <class F>
struct TriangleVertices {
  std::array<Vec3<F>, 3> position, normal;
  std::array<Vec2<F>, 3> uv;

  TriangleVertices(const GeometryStore& store, const std::array<Uint<F>, 3>& corner) {
    static_assert(sizeof(MeshVertex) == 4 * words_of_short_row && offsetof(MeshVertex, normal) == 12 &&
                  offsetof(MeshVertex, uv) == 24);
    const auto words = gather_short_rows<F>(&store.vertices.data()->position.x, corner);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& w = words[c];
      position[c] = {w[0], w[1], w[2]}, normal[c] = {w[3], w[4], w[5]}, uv[c] = {w[6], w[7]};
    }
  }
};

// Indices of the three corners; those of triangle 0 in idle lanes.
template <class F>
std::array<Uint<F>, 3> corner_numbers(const GeometryStore& store, Uint<F> triangle) {
  const std::uint32_t* index = store.triangles.data()->data();
  Uint<F> i = triangle * Uint<F>(3u);
  return {gather(index, i), gather(index + 1, i), gather(index + 2, i)};
}

// The position of a time between times evenly spaced over [0, 1].
template <class F>
struct TimeStep {
  Uint<F> first;  // index of the preceding time
  F fraction;     // of the interval to the next
};
// `keys` >= 2. The kernel uses the same operations.
template <class F>
TimeStep<F> time_step(F time, Uint<F> keys) {
  const F steps = to_float(Uint<F>(keys - Uint<F>(1u)));
  const F scaled = time * steps;
  const F first = min(max(floor(scaled), F(0.0f)), steps - F(1.0f));
  return {to_uint(first), scaled - first};
}

// The poses of meshes before and after a time, as offsets to the vertex indices; both 0 for rigid meshes.
template <class F>
struct PosePair {
  Uint<F> before, after;
  F fraction;
};
template <class F>
PosePair<F> pose_pair(const RowOf<F>& row, F time) {
  using U = Uint<F>;
  const U poses = row[RowWord::poses], stride = row[RowWord::pose_vertices];
  const TimeStep<F> step = time_step<F>(time, select(poses > U(1u), poses, U(2u)));
  const U before = step.first * stride;
  return {before, before + stride, step.fraction};
}

// Positions and normals at the time of each lane. Used only for scenes with deforming meshes.
template <class F>
void pose_triangles(const GeometryStore& store, const std::array<Uint<F>, 3>& corner, const PosePair<F>& pose,
                    TriangleVertices<F>& vertices) {
  const auto at = [&](Uint<F> offset) {
    return TriangleVertices<F>(store,
                               {Uint<F>(corner[0] + offset), Uint<F>(corner[1] + offset), Uint<F>(corner[2] + offset)});
  };
  const TriangleVertices<F> before = at(pose.before), after = at(pose.after);
  const auto between = [&](const Vec3<F>& a, const Vec3<F>& b) {
    return a * (F(1.0f) - pose.fraction) + b * pose.fraction;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    vertices.position[c] = between(before.position[c], after.position[c]);
    vertices.normal[c] = between(before.normal[c], after.normal[c]);
  }
}

template <class F>
SurfacePoint<F> triangles_point(const GeometryStore& store, const Hit<F>& hit, F time, const RowOf<F>& row,
                                Mask<F> on) {
  using U = Uint<F>;
  const U triangle = select(on, row[RowWord::first] + hit.primitive, U(0u));
  const std::array<U, 3> corner = corner_numbers<F>(store, triangle);
  TriangleVertices<F> vertices(store, corner);
  if (store.deforms) pose_triangles<F>(store, corner, pose_pair<F>(row, time), vertices);
  const U flag = row[RowWord::flags];
  auto has = [&](std::uint32_t bit) -> Mask<F> { return on & ((flag & U(bit)) != U(0u)); };
  const auto& [p, n, uv] = vertices;
  TriangleCorners<F> corners{p[0], p[1], p[2]};
  const Mask<F> with_uvs = has(GeometryRow::has_uvs);
  corners.uv0 = select<F>(with_uvs, uv[0], corners.uv0), corners.uv1 = select<F>(with_uvs, uv[1], corners.uv1);
  corners.uv2 = select<F>(with_uvs, uv[2], corners.uv2);
  const TriangleNormals<F> normals{n[0], n[1], n[2], has(GeometryRow::has_normals)};
  SurfacePoint<F> s = triangle_point<F>(corners, normals, has(GeometryRow::flip_normal), hit.u, hit.v);
  if (!store.deforms) return s;
  // The interpolated corners are rounded, too.
  s.p_error = s.p_error * 2.0f;
  return s;
}

template <class F>
Affine<F> gather_affine(const float* base, Uint<F> at) {
  Affine<F> r;
  for (int i = 0; i < 12; ++i) r.m[i] = gather(base + i, at);
  return r;
}

// A point of an instanced object, transformed to the world.
template <class F>
struct Placing {
  Affine<F> to_world;
  F rounding;  // relative rounding error of an entry of to_world
};

// The rounding of the product and its sums adds to the error of the point (Pharr et al. 2023, eq. 6.30), and so
// does that of the map itself if it moves.
template <class F>
void place_point(const Placing<F>& placing, SurfacePoint<F>& s, Mask<F> placed) {
  const Affine<F>& to_world = placing.to_world;
  Vec3<F> p = to_world.point(s.p);
  Vec3<F> error = to_world.absolute(s.p_error) * (F(1.0f) + placing.rounding) +
                  (to_world.absolute(abs(s.p)) + abs(to_world.offset())) * placing.rounding;
  s.p = select<F>(placed, p, s.p);
  s.p_error = select<F>(placed, error, s.p_error);
  s.dpdu = select<F>(placed, to_world.direction(s.dpdu), s.dpdu);
}

constexpr float gamma(int n) { return float(n) * 0x1p-24f / (1 - float(n) * 0x1p-24f); }

// The map of each lane's instance at its time.
template <class F>
Placing<F> moving_place(const GeometryStore& store, Uint<F> instance, F time) {
  using U = Uint<F>;
  const std::uint32_t* ranges = &store.instance_motion.data()->first;
  const U range = instance * U(2u);
  const U first = gather(ranges, range), count = gather(ranges + 1, range);
  const Mask<F> moves = count > U(1u);
  const TimeStep<F> step = time_step<F>(time, select(moves, count, U(2u)));
  const float* keys = store.instance_keys.data()->data();
  const U at = select(moves, first + step.first, U(0u)) * U(12u);
  const Affine<F> moved =
      lerp(step.fraction, gather_affine<F>(keys, at), gather_affine<F>(keys, select(moves, at + U(12u), U(0u))));
  const Affine<F> still = gather_affine<F>(store.instance_rows.data()->data(), instance * U(24u));
  Placing<F> r{still, select(moves, F(gamma(12)), F(gamma(3)))};
  for (int i = 0; i < 12; ++i) r.to_world.m[i] = select(moves, moved.m[i], still.m[i]);
  return r;
}

template <class F>
void place_instances(const GeometryStore& store, const Hit<F>& hit, F time, SurfacePoint<F>& s, Mask<F> on) {
  using U = Uint<F>;
  const Mask<F> placed = on & (hit.instance != U(0u));
  if (!any(placed)) return;
  const U instance = select(placed, hit.instance - U(1u), U(0u));
  if (!store.instance_keys.empty()) {
    const Placing<F> placing = moving_place<F>(store, instance, time);
    place_point(placing, s, placed);
    s.ng = select<F>(placed, normalize(placing.to_world.normal(s.ng)), s.ng);
    s.ns = select<F>(placed, normalize(placing.to_world.normal(s.ns)), s.ns);
    return;
  }
  const float* table = store.instance_rows.data()->data();
  const U at = instance * U(24u);
  const Affine<F> to_object = gather_affine<F>(table + 12, at);
  place_point<F>({gather_affine<F>(table, at), F(gamma(3))}, s, placed);
  s.ng = select<F>(placed, normalize(to_object.transposed(s.ng)), s.ng);
  s.ns = select<F>(placed, normalize(to_object.transposed(s.ns)), s.ns);
}

// A ray in the space of the instance.
Ray<float> to_object_space(const GeometryStore& store, std::uint32_t instance, Ray<float> ray) {
  if (instance == 0) return ray;
  const Transform to_object = place_at(store, instance - 1, ray.time).inverted();
  return {to_object.point(ray.o), to_object.direction(ray.d), ray.t_max, ray.time};
}

// The surface point of a primitive other than a triangle, in the space of its instance.
SurfacePoint<float> other_point(const GeometryStore& store, const Hit<float>& hit, const Ray<float>& local) {
  const GeometryRow& row = store.rows[hit.geometry];
  if (row.kind == GeometryKind::shape)
    return surface_point(store.shapes[row.first], local, ShapeHit{hit.t, {hit.u, hit.v}});
  return curve_point(store.curves[row.first], hit.primitive, hit.u, local, hit.t);
}

template <class F>
void set_lane(SurfacePoint<F>& s, int k, const SurfacePoint<float>& x) {
  set_lane(s.p, k, x.p), set_lane(s.p_error, k, x.p_error), set_lane(s.ng, k, x.ng), set_lane(s.ns, k, x.ns);
  set_lane(s.dpdu, k, x.dpdu), set_lane(s.uv, k, x.uv);
}

}  // namespace

Transform place_at(const GeometryStore& store, std::uint32_t instance, float time) {
  const PlacedObject& placed = store.instances[instance];
  if (placed.keys.count < 2) return placed.object_to_world;
  const Affine<float> map = moving_place<float>(store, instance, time).to_world;
  Matrix4 m;
  for (std::size_t i = 0; i < 12; ++i) m.m[i / 4][i % 4] = double(map.m[i]);
  return from_matrix(m).value_or(placed.object_to_world);
}

PoseTime pose_time(const GeometryRow& row, float time) {
  if (row.poses < 2) return {};
  const TimeStep<float> step = time_step<float>(time, row.poses);
  return {step.first, step.first + 1, step.fraction};
}

template <class F>
SurfaceHit<F> surface(const GeometryStore& store, const Ray<F>& ray, const Hit<F>& hit, Mask<F> on) {
  return surface_at<F>(store, ray, hit, ray.time, on);
}

template <class F>
SurfaceHit<F> surface_at(const GeometryStore& store, const Ray<F>& ray, const Hit<F>& hit, F time, Mask<F> on) {
  using U = Uint<F>;
  const RowOf<F> row(store, select(on, hit.geometry, U(0u)));
  const Mask<F> triangles = on & (row[RowWord::kind] == U(std::uint32_t(GeometryKind::triangles)));
  SurfaceHit<F> s;
  if (any(triangles))
    s.point = triangles_point<F>(store, hit, time, row, triangles);
  else
    s.point = {};
  for_each_lane(on & !triangles, [&](int k) {
    Hit<float> one{lane(hit.t, k),        lane(hit.u, k),         lane(hit.v, k),
                   lane(hit.geometry, k), lane(hit.primitive, k), lane(hit.instance, k)};
    const Ray<float> world{lane(ray.o, k), lane(ray.d, k), one.t, lane(ray.time, k)};
    set_lane(s.point, k, other_point(store, one, to_object_space(store, one.instance, world)));
  });
  place_instances<F>(store, hit, time, s.point, on);
  s.distance = hit.t;
  s.material = row[RowWord::material];
  U first_light = row[RowWord::first_light];
  s.light = select(on & (first_light != U(0u)), first_light + hit.primitive, U(0u));
  s.object = row[RowWord::object];
  s.ray_facing = Mask<F>(false);
  if (!store.curves.empty()) s.ray_facing = on & ((row[RowWord::flags] & U(GeometryRow::ray_facing)) != U(0u));
  s.bounds_media = Mask<F>(false), s.inside = s.outside = U(0u);
  if (store.bounds_media) {
    s.bounds_media = on & ((row[RowWord::flags] & U(GeometryRow::bounds_media)) != U(0u));
    s.inside = row[RowWord::inside], s.outside = row[RowWord::outside];
  }
  return s;
}

SurfacePoint<float> point_of_local_ray(const GeometryStore& store, const Ray<float>& local, const Hit<float>& hit) {
  const bool is_mesh = store.rows[hit.geometry].kind == GeometryKind::triangles;
  SurfacePoint<float> s = is_mesh
                              ? triangles_point<float>(store, hit, local.time, RowOf<float>(store, hit.geometry), true)
                              : other_point(store, hit, local);
  place_instances<float>(store, hit, local.time, s, true);
  return s;
}

Vec2f surface_uv(const GeometryStore& store, const Hit<float>& hit) {
  const GeometryRow& row = store.rows[hit.geometry];
  if (row.kind == GeometryKind::shape) return surface_point(store.shapes[row.first], Vec2f{hit.u, hit.v}).uv;
  if (row.kind == GeometryKind::curves) return {hit.u, 0.5f * (1.0f + hit.v)};
  Vec2f uv[3] = {default_triangle_uv[0], default_triangle_uv[1], default_triangle_uv[2]};
  if (row.flags & GeometryRow::has_uvs)
    for (int i = 0; i < 3; ++i) uv[i] = store.vertices[store.triangles[row.first + hit.primitive][std::size_t(i)]].uv;
  return uv[0] * (1.0f - hit.u - hit.v) + uv[1] * hit.u + uv[2] * hit.v;
}

template SurfaceHit<float> surface(const GeometryStore&, const Ray<float>&, const Hit<float>&, bool);
template SurfaceHit<NativeFloats> surface(const GeometryStore&, const Ray<NativeFloats>&, const Hit<NativeFloats>&,
                                          Mask<NativeFloats>);
template SurfaceHit<float> surface_at(const GeometryStore&, const Ray<float>&, const Hit<float>&, float, bool);
template SurfaceHit<NativeFloats> surface_at(const GeometryStore&, const Ray<NativeFloats>&, const Hit<NativeFloats>&,
                                             NativeFloats, Mask<NativeFloats>);

}  // namespace montelux
