#include "accel/callbacks.h"

#include <array>

#include "accel/packet.h"

namespace montelux {

namespace {

Ray<float> ray_of(RTCRayN* rays, unsigned n, unsigned i) {
  return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          RTCRayN_tfar(rays, n, i),
          RTCRayN_time(rays, n, i)};
}

bool may_be_open_to_shadow_rays(const GeometryRow& row) {
  return row.alpha != 0 || (row.flags & GeometryRow::open_to_some_shadow_rays) != 0;
}

bool is_queried_by(const GeometryRow& row, RayUse use) {
  return use == RayUse::shadow ? may_be_open_to_shadow_rays(row) : row.alpha != 0;
}

// Whether a ray hits the back of a triangle. The kernel's normal is that of the winding.
bool meets_back(const GeometryRow& row, RTCRayN* rays, RTCHitN* hits, unsigned n, unsigned i) {
  const Vec3f d{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  const Vec3f ng{RTCHitN_Ng_x(hits, n, i), RTCHitN_Ng_y(hits, n, i), RTCHitN_Ng_z(hits, n, i)};
  return (dot(d, ng) > 0.0f) != ((row.flags & GeometryRow::flip_normal) != 0);
}

const GeometryContext& context_of(void* user) { return *static_cast<const GeometryContext*>(user); }

// The numbering of instances in Hit.
std::uint32_t instance_number(const GeometryContext& context, std::uint32_t kernel_number) {
  return kernel_number == RTC_INVALID_GEOMETRY_ID ? 0 : kernel_number - context.store->world_rows + 1;
}

bool is_of_camera(RTCRayN* rays, unsigned n, unsigned i) {
  return RTCRayN_id(rays, n, i) == std::uint32_t(RayUse::camera);
}

// The kernel's filter: rejects hits where the surface does not exist for the ray.
template <RayUse use>
void reject_open(const RTCFilterFunctionNArguments* a) {
  const GeometryContext& context = context_of(a->geometryUserPtr);
  const GeometryRow& row = context.store->rows[context.row];
  const bool one_sided = use == RayUse::path && (row.flags & GeometryRow::one_sided) != 0;
  const bool queries = is_queried_by(row, use);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    if (one_sided && is_of_camera(a->ray, a->N, i) && meets_back(row, a->ray, a->hit, a->N, i)) a->valid[i] = 0;
    if (!queries || a->valid[i] == 0) continue;
    Hit<float> hit{RTCRayN_tfar(a->ray, a->N, i),   RTCHitN_u(a->hit, a->N, i),
                   RTCHitN_v(a->hit, a->N, i),      context.row,
                   RTCHitN_primID(a->hit, a->N, i), instance_number(context, a->context->instID[0])};
    if (!(*context.is_opaque)(hit, ray_of(a->ray, a->N, i), use)) a->valid[i] = 0;
  }
}

// Surfaces that exist only for camera rays and scattered rays.
void reject_all(const RTCFilterFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i) a->valid[i] = 0;
}

void shape_bounds(const RTCBoundsFunctionArguments* a) {
  const GeometryContext& context = context_of(a->geometryUserPtr);
  Bounds3 b = bounds(context.store->shapes[context.store->rows[context.row].first]);
  a->bounds_o->lower_x = b.low.x, a->bounds_o->lower_y = b.low.y, a->bounds_o->lower_z = b.low.z;
  a->bounds_o->upper_x = b.high.x, a->bounds_o->upper_y = b.high.y, a->bounds_o->upper_z = b.high.z;
}

constexpr unsigned max_rays = 16;  // of a packet, in any kernel

// Which of the kernel's rays enter the ball around a shape before they end: far fewer than enter its box, in particular
// of those that end on it. Rounding can only add rays. F has as many lanes as there are rays.
template <class F>
std::uint32_t rays_into(const Ball& ball, RTCRayN* rays) {
  constexpr unsigned n = lanes_of<F>;
  const Vec3<F> o = Vec3<F>{load_lanes<F>(&RTCRayN_org_x(rays, n, 0)), load_lanes<F>(&RTCRayN_org_y(rays, n, 0)),
                            load_lanes<F>(&RTCRayN_org_z(rays, n, 0))} -
                    splat<F>(ball.centre);
  const Vec3<F> d{load_lanes<F>(&RTCRayN_dir_x(rays, n, 0)), load_lanes<F>(&RTCRayN_dir_y(rays, n, 0)),
                  load_lanes<F>(&RTCRayN_dir_z(rays, n, 0))};
  const F squared = dot(d, d), nearest = -dot(o, d) / squared, end = load_lanes<F>(&RTCRayN_tfar(rays, n, 0));
  const F t = select(nearest < F(0.0f), F(0.0f), select(nearest < end, nearest, end));
  const Vec3<F> p = o + d * t;
  const F reach = F(ball.radius) + F(0x1p-19f) * (abs(o.x) + abs(o.y) + abs(o.z));
  return ~bits((squared > F(1e-30f)) & (dot(p, p) > reach * reach));
}
std::uint32_t rays_into(const Ball& ball, RTCRayN* rays, unsigned n) {
  switch (n) {
    case 16:
      return rays_into<Floats<16>>(ball, rays);
    case 8:
      return rays_into<Floats<8>>(ball, rays);
    case 4:
      return rays_into<Floats<4>>(ball, rays);
    default:
      return rays_into<float>(ball, rays);
  }
}

// The kernel's rays that may meet a shape, and where each meets it.
struct ShapeQuery {
  std::array<Ray<float>, max_rays> rays;
  std::array<unsigned, max_rays> number;  // of the ray in the kernel's packet
  std::array<std::optional<ShapeHit>, max_rays> hits;
  std::size_t count = 0;
};

// The nearest surface of the shape that exists for each ray: through one side of a ball it may hit the other. For the
// test, `primitive` is the number of surfaces passed, so that each is decided independently.
void meet_shape(const GeometryContext& context, RTCRayN* rays, const int* valid, unsigned n, RayUse use,
                std::uint32_t instance, ShapeQuery& query) {
  const GeometryRow& row = context.store->rows[context.row];
  const Shape& shape = context.store->shapes[row.first];
  const std::uint32_t near = rays_into(context.ball, rays, n);
  for (unsigned i = 0; i < n; ++i) {
    if (valid[i] == 0 || (near >> i & 1u) == 0) continue;
    query.rays[query.count] = ray_of(rays, n, i);
    query.number[query.count++] = i;
  }
  if (query.count == 0) return;
  intersect(shape, std::span(query.rays).first(query.count), std::span(query.hits).first(query.count));
  if (!is_queried_by(row, use)) return;
  for (std::size_t k = 0; k < query.count; ++k) {
    std::optional<ShapeHit>& found = query.hits[k];
    for (std::uint32_t passed = 0; found; ++passed) {
      const Hit<float> hit{found->t, found->uv.x, found->uv.y, context.row, passed, instance};
      if ((*context.is_opaque)(hit, query.rays[k], use)) break;
      found = intersect(shape, query.rays[k], found->t);
    }
  }
}

void intersect_shape(const RTCIntersectFunctionNArguments* a) {
  const GeometryContext& context = context_of(a->geometryUserPtr);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  ShapeQuery query;
  meet_shape(context, rays, a->valid, a->N, RayUse::path, instance_number(context, a->context->instID[0]), query);
  for (std::size_t k = 0; k < query.count; ++k) {
    const std::optional<ShapeHit>& found = query.hits[k];
    if (!found) continue;
    const unsigned i = query.number[k];
    RTCRayN_tfar(rays, a->N, i) = found->t;
    RTCHitN_u(hits, a->N, i) = found->uv.x;
    RTCHitN_v(hits, a->N, i) = found->uv.y;
    RTCHitN_geomID(hits, a->N, i) = a->geomID;
    RTCHitN_primID(hits, a->N, i) = a->primID;
    RTCHitN_instID(hits, a->N, i, 0) = a->context->instID[0];
  }
}

void occlude_by_shape(const RTCOccludedFunctionNArguments* a) {
  const GeometryContext& context = context_of(a->geometryUserPtr);
  if (context.store->rows[context.row].flags & GeometryRow::invisible_to_shadow_rays) return;
  ShapeQuery query;
  meet_shape(context, a->ray, a->valid, a->N, RayUse::shadow, instance_number(context, a->context->instID[0]), query);
  for (std::size_t k = 0; k < query.count; ++k)
    if (query.hits[k]) RTCRayN_tfar(a->ray, a->N, query.number[k]) = -std::numeric_limits<float>::infinity();
}

RTCGeometry make_triangles(RTCDevice device, const GeometryStore& store, const GeometryRow& row) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // The poses of a deforming mesh are consecutive in memory; each buffer begins at the offset of its pose.
  if (row.poses > 1) rtcSetGeometryTimeStepCount(geometry, row.poses);
  const std::size_t behind_first = std::size_t(row.poses - 1) * row.pose_vertices;
  for (std::uint32_t pose = 0; pose < row.poses; ++pose)
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, pose, RTC_FORMAT_FLOAT3, store.vertices.data(),
                               std::size_t(pose) * row.pose_vertices * sizeof(MeshVertex), sizeof(MeshVertex),
                               store.vertices.size() - behind_first);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, store.triangles.data(),
                             std::size_t(row.first) * sizeof(store.triangles[0]), sizeof(store.triangles[0]),
                             row.count);
  return geometry;
}

RTCGeometry make_curves(RTCDevice device, const CurveSet& curves) {
  const bool ribbon = curves.type == CurveType::ribbon;
  RTCGeometry geometry = rtcNewGeometry(
      device, ribbon ? RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE : RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, curves.controls.data(), 0,
                             sizeof(CurveControl), curves.controls.size());
  if (ribbon)
    // The kernel reads normals four floats at a time: it gets a copy with padding at the end.
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                        curves.normals.size()),
                curves.normals.data(), curves.normals.size() * sizeof(Vec3f));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, curves.first.data(), 0,
                             sizeof(std::uint32_t), curves.first.size());
  return geometry;
}

RTCGeometry make_shape(RTCDevice device) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryBoundsFunction(geometry, shape_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_by_shape);
  return geometry;
}

}  // namespace

RTCGeometry make_geometry(RTCDevice device, const GeometryStore& store, const GeometryRow& row,
                          GeometryContext* context) {
  RTCGeometry geometry = nullptr;
  switch (row.kind) {
    case GeometryKind::triangles:
      geometry = make_triangles(device, store, row);
      break;
    case GeometryKind::shape:
      geometry = make_shape(device);
      break;
    case GeometryKind::curves:
      geometry = make_curves(device, store.curves[row.first]);
      break;
  }
  rtcSetGeometryUserData(geometry, context);
  if (row.kind == GeometryKind::shape) return geometry;  // tested in their own functions
  const bool one_sided = (row.flags & GeometryRow::one_sided) != 0;
  if (one_sided || is_queried_by(row, RayUse::path))
    rtcSetGeometryIntersectFilterFunction(geometry, reject_open<RayUse::path>);
  if (is_queried_by(row, RayUse::shadow)) rtcSetGeometryOccludedFilterFunction(geometry, reject_open<RayUse::shadow>);
  if (row.flags & GeometryRow::invisible_to_shadow_rays) rtcSetGeometryOccludedFilterFunction(geometry, reject_all);
  return geometry;
}

}  // namespace montelux
