#include "scene/surface.h"

namespace montelux {

namespace {

constexpr std::uint32_t row_words = sizeof(GeometryRow) / 4;

// Places of the members of GeometryRow, in words.
enum RowWord : std::uint32_t {
  kind,
  first,
  count,
  normal_shift,
  uv_shift,
  flags,
  material,
  first_light,
  alpha,
  object
};
static_assert(offsetof(GeometryRow, object) == 4 * RowWord::object &&
              offsetof(GeometryRow, flags) == 4 * RowWord::flags);

const std::uint32_t* words_of(const GeometryStore& store) {
  return reinterpret_cast<const std::uint32_t*>(store.rows.data());
}

template <class F>
Vec3<F> gather_vec3(const std::vector<Vec3f>& from, Uint<F> i) {
  return gather3<F>(&from.data()->x, Uint<F>(i * Uint<F>(3u)));
}
template <class F>
Vec2<F> gather_vec2(const std::vector<Vec2f>& from, Uint<F> i) {
  return gather2<F>(&from.data()->x, Uint<F>(i * Uint<F>(2u)));
}

// Numbers of the three corners; those of triangle 0 in idle lanes.
template <class F>
std::array<Uint<F>, 3> corner_numbers(const GeometryStore& store, Uint<F> triangle) {
  const std::uint32_t* index = store.triangles.data()->data();
  Uint<F> i = triangle * Uint<F>(3u);
  return {gather(index, i), gather(index + 1, i), gather(index + 2, i)};
}

template <class F>
SurfacePoint<F> triangles_point(const GeometryStore& store, const Hit<F>& hit, Uint<F> row, Mask<F> on) {
  using U = Uint<F>;
  const std::uint32_t* words = words_of(store);
  const U triangle = select(on, gather(words + RowWord::first, row) + hit.primitive, U(0u));
  const auto [i0, i1, i2] = corner_numbers<F>(store, triangle);
  const U flag = gather(words + RowWord::flags, row);
  auto has = [&](std::uint32_t bit) -> Mask<F> { return on & ((flag & U(bit)) != U(0u)); };
  TriangleCorners<F> corners{gather_vec3<F>(store.positions, i0), gather_vec3<F>(store.positions, i1),
                             gather_vec3<F>(store.positions, i2)};
  if (Mask<F> uvs = has(GeometryRow::has_uvs); any(uvs)) {
    U shift = gather(words + RowWord::uv_shift, row);
    auto uv = [&](U i, Vec2<F> otherwise) {
      return select<F>(uvs, gather_vec2<F>(store.uvs, select(uvs, i + shift, U(0u))), otherwise);
    };
    corners.uv0 = uv(i0, corners.uv0), corners.uv1 = uv(i1, corners.uv1), corners.uv2 = uv(i2, corners.uv2);
  }
  const Vec3<F> zero{F(0.0f), F(0.0f), F(0.0f)};
  TriangleNormals<F> normals{zero, zero, zero, has(GeometryRow::has_normals)};
  if (any(normals.present)) {
    U shift = gather(words + RowWord::normal_shift, row);
    auto normal = [&](U i) { return gather_vec3<F>(store.normals, select(normals.present, i + shift, U(0u))); };
    normals.n0 = normal(i0), normals.n1 = normal(i1), normals.n2 = normal(i2);
  }
  return triangle_point<F>(corners, normals, has(GeometryRow::flip_normal), hit.u, hit.v);
}

// Rows of three floats and an offset: as Transform applies them, in every lane.
template <class F>
struct GatheredTransform {
  F m[12];
  GatheredTransform(const float* base, Uint<F> at) {
    for (int i = 0; i < 12; ++i) m[i] = gather(base + i, at);
  }
  Vec3<F> direction(const Vec3<F>& d) const {
    return {m[0] * d.x + m[1] * d.y + m[2] * d.z, m[4] * d.x + m[5] * d.y + m[6] * d.z,
            m[8] * d.x + m[9] * d.y + m[10] * d.z};
  }
  Vec3<F> transposed(const Vec3<F>& n) const {
    return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
            m[2] * n.x + m[6] * n.y + m[10] * n.z};
  }
  Vec3<F> offset() const { return {m[3], m[7], m[11]}; }
  Vec3<F> absolute(const Vec3<F>& d) const {
    return {abs(m[0]) * d.x + abs(m[1]) * d.y + abs(m[2]) * d.z, abs(m[4]) * d.x + abs(m[5]) * d.y + abs(m[6]) * d.z,
            abs(m[8]) * d.x + abs(m[9]) * d.y + abs(m[10]) * d.z};
  }
};

// A point of an instanced object, brought to the world.
template <class F>
void place_instances(const GeometryStore& store, const Hit<F>& hit, SurfacePoint<F>& s, Mask<F> on) {
  using U = Uint<F>;
  const Mask<F> placed = on & (hit.instance != U(0u));
  if (!any(placed)) return;
  const float* table = store.instance_rows.data()->data();
  const U at = select(placed, hit.instance - U(1u), U(0u)) * U(24u);
  const GatheredTransform<F> to_world(table, at), to_object(table + 12, at);
  // Rounding of the product and its sums adds to the error that the point brings (Pharr et al. 2023, eq. 6.30).
  constexpr float gamma3 = 3 * 0x1p-24f / (1 - 3 * 0x1p-24f);
  Vec3<F> p = to_world.direction(s.p) + to_world.offset();
  Vec3<F> error =
      to_world.absolute(s.p_error) * (1.0f + gamma3) + (to_world.absolute(abs(s.p)) + abs(to_world.offset())) * gamma3;
  s.p = select<F>(placed, p, s.p);
  s.p_error = select<F>(placed, error, s.p_error);
  s.ng = select<F>(placed, normalize(to_object.transposed(s.ng)), s.ng);
  s.ns = select<F>(placed, normalize(to_object.transposed(s.ns)), s.ns);
  s.dpdu = select<F>(placed, to_world.direction(s.dpdu), s.dpdu);
}

// A ray as the instance's own space sees it.
Ray<float> to_object_space(const GeometryStore& store, std::uint32_t instance, Ray<float> ray) {
  if (instance == 0) return ray;
  Transform to_object = store.instances[instance - 1].object_to_world.inverted();
  return {to_object.point(ray.o), to_object.direction(ray.d), ray.t_max};
}

SurfacePoint<float> other_point(const GeometryStore& store, const Hit<float>& hit, const Ray<float>& ray) {
  const GeometryRow& row = store.rows[hit.geometry];
  const Ray<float> local = to_object_space(store, hit.instance, ray);
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

template <class F>
SurfaceHit<F> surface(const GeometryStore& store, const Vec3<F>& o, const Vec3<F>& d, const Hit<F>& hit, Mask<F> on) {
  using U = Uint<F>;
  const std::uint32_t* words = words_of(store);
  const U row = select(on, hit.geometry, U(0u)) * U(row_words);
  const Mask<F> triangles = on & (gather(words + RowWord::kind, row) == U(std::uint32_t(GeometryKind::triangles)));
  SurfaceHit<F> s;
  if (any(triangles))
    s.point = triangles_point<F>(store, hit, row, triangles);
  else
    s.point = {};
  for_each_lane(on & !triangles, [&](int k) {
    Hit<float> one{lane(hit.t, k),        lane(hit.u, k),         lane(hit.v, k),
                   lane(hit.geometry, k), lane(hit.primitive, k), lane(hit.instance, k)};
    set_lane(s.point, k, other_point(store, one, {lane(o, k), lane(d, k), one.t}));
  });
  place_instances<F>(store, hit, s.point, on);
  s.material = gather(words + RowWord::material, row);
  U first_light = gather(words + RowWord::first_light, row);
  s.light = select(on & (first_light != U(0u)), first_light + hit.primitive, U(0u));
  s.object = gather(words + RowWord::object, row);
  return s;
}

Vec2f surface_uv(const GeometryStore& store, const Hit<float>& hit) {
  const GeometryRow& row = store.rows[hit.geometry];
  if (row.kind == GeometryKind::shape) return surface_point(store.shapes[row.first], Vec2f{hit.u, hit.v}).uv;
  if (row.kind == GeometryKind::curves) return {hit.u, 0.5f * (1.0f + hit.v)};
  Vec2f uv[3] = {default_triangle_uv[0], default_triangle_uv[1], default_triangle_uv[2]};
  if (row.flags & GeometryRow::has_uvs)
    for (int i = 0; i < 3; ++i)
      uv[i] = store.uvs[store.triangles[row.first + hit.primitive][std::size_t(i)] + row.uv_shift];
  return uv[0] * (1.0f - hit.u - hit.v) + uv[1] * hit.u + uv[2] * hit.v;
}

template SurfaceHit<float> surface(const GeometryStore&, const Vec3f&, const Vec3f&, const Hit<float>&, bool);
template SurfaceHit<NativeFloats> surface(const GeometryStore&, const Vec3<NativeFloats>&, const Vec3<NativeFloats>&,
                                          const Hit<NativeFloats>&, Mask<NativeFloats>);

}  // namespace montelux
