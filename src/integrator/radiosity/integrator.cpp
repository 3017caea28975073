#include "integrator/radiosity/integrator.h"

#include <fmt/format.h>

#include <algorithm>

#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "mc/hemisphere.h"
#include "transport/visibility.h"

namespace montelux {

namespace {

using F = NativeFloats;
using U = Uint<F>;
using M = Mask<F>;

// What every stage of a series shares.
struct Radiosity {
  const Scene& scene;
  const Accel& accel;
  const RadiositySettings& settings;
  const ElementMesh& mesh;
};

// Irradiance of both sides of every element, the side of the geometric normal first; by frame, W / m^2.
using Irradiance = std::vector<Spectrum<float>>;
std::size_t side_of_element(std::uint32_t element, bool behind) { return 2 * std::size_t(element) + (behind ? 1 : 0); }

// A surface point, the side from which it is looked at, and how that reflects.
struct DiffusePoint {
  SurfaceHit<F> x;
  Vec3<F> n;           // geometric normal on the side that is looked at
  Spectrum<F> albedo;  // 0 where nothing is reflected
};

DiffusePoint diffuse_point(const Radiosity& r, const Ray<F>& ray, const Hit<F>& hit, const RandomStream<F>& own, M on) {
  const Vertex<F> v(r.scene, {ray, hit, no_media<F>()}, {on, on}, {TransportMode::radiance, own});
  const Vec3<F> middle{F(0.5f), F(0.5f), F(0.5f)};  // any direction has the same weight
  return {v.x, face_forward(v.x.point.ng, -v.d), sampled_albedo<F>(v, middle, on)};
}

// The radiosity of the elements that were hit, by the albedo of the very points.
Spectrum<F> reflected(const Radiosity& r, const Irradiance& irradiance, const DiffusePoint& at, const Hit<F>& hit,
                      M on) {
  Spectrum<F> e = gray(F(0.0f));
  for_each_lane(on, [&](int k) {
    const Hit<float> one{0, lane(hit.u, k), lane(hit.v, k), lane(hit.geometry, k), lane(hit.primitive, k), 0};
    const bool behind = dot(lane(at.n, k), lane(at.x.point.ng, k)) < 0;
    set_lane(e, k, irradiance[side_of_element(r.mesh.element_of(one), behind)]);
  });
  return e * at.albedo;
}

// One sample of the irradiance at x on the side of n: a point of a light, and a direction to another element.
Spectrum<F> irradiance_sample(const Radiosity& r, const Irradiance& known, const SurfacePoint<F>& x, const Vec3<F>& n,
                              const NumberSource<F> auto& numbers, RayCounts& counts, M on) {
  namespace plan = element_dimension;
  const LightSample<F> light =
      r.scene.lights.sample<F>(x.p, n, numbers.get1(U(plan::light_choice)), numbers.get2(U(plan::light_point)), on);
  const F cos = dot(light.wi, n);
  const M queries = on & light.valid & (cos > F(0.0f));
  const M lit = unblocked<F>(r.accel, shadow_ray(x.p, x.p_error, x.ng, light.wi, light.distance, F(0.0f)), queries,
                             counts.shadow);
  Spectrum<F> sum = select(lit, light.radiance * (cos / light.density), gray(F(0.0f)));

  const Vec3<F> wi = LocalFrame<F>::from_normal(n).to_world(sample_cosine_hemisphere(numbers.get2(U(plan::direction))));
  const Vec3<F> from = offset_origin(x.p, x.p_error, x.ng, wi);
  counts.scattered += std::uint64_t(count(on));
  const auto [found, hit] = r.accel.trace<F>({from, wi, F(ray_infinity)}, on);
  if (!any(found)) return sum;
  const DiffusePoint other = diffuse_point(r, {from, wi, F(ray_infinity)}, hit, numbers.stream(U(plan::own)), found);
  return sum + select(found, reflected(r, known, other, hit, found), gray(F(0.0f)));
}

// Sides of elements in one unit of work.
constexpr std::size_t sides_per_unit = 32;

class RadiositySeries final : public FrameSeries {
 public:
  RadiositySeries(const Radiosity& shared, const SeriesPass& pass) : shared_(shared), pass_(pass) {
    for (Irradiance& i : irradiance_) i.assign(2 * shared.mesh.size(), gray(0.0f));
  }

  std::optional<std::size_t> units(const SeriesStep& step) const override {
    if (step.stage > 0) return std::nullopt;
    return (irradiance_[0].size() + sides_per_unit - 1) / sides_per_unit;
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override { return transport(step.frame, unit); }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return show(step.frame, tile, out);
  }

 private:
  // The points of the rays of elements: independent in every frame.
  PointSet points(int frame) const {
    PointSet p = pass_.points;
    p.kind = PointSetKind::padded_sobol, p.samples_per_pass = std::uint32_t(shared_.settings.rays);
    p.seed = mix_bits(p.seed ^ mix_bits(std::uint32_t(frame) + 0x51ed270bu));
    return p;
  }
  const Irradiance& before(int frame) const { return irradiance_[std::size_t(frame) & 1]; }
  Irradiance& after(int frame) { return irradiance_[std::size_t(frame + 1) & 1]; }

  // The irradiance of some sides of elements.
  RayCounts transport(int frame, std::size_t unit) {
    RayCounts counts;
    const PointSet set = points(frame);
    const std::size_t first = unit * sides_per_unit;
    const std::size_t end = std::min(first + sides_per_unit, before(frame).size());
    for (std::size_t side = first; side < end; ++side)
      after(frame)[side] = irradiance_of(side, before(frame), set, counts);
    return counts;
  }

  Spectrum<float> irradiance_of(std::size_t side, const Irradiance& known, const PointSet& set, RayCounts& counts) {
    Spectrum<float> sum = gray(0.0f);
    const auto rays = std::uint32_t(shared_.settings.rays);
    for (std::uint32_t first = 0; first < rays; first += std::uint32_t(lanes_of<F>)) {
      const U index = lane_index<F>() + U(first);
      const M on = index < U(rays);
      const auto numbers = numbers_of<F>(set, PathSite<F>{U(std::uint32_t(side)), U(0u), select(on, index, U(0u))});
      const Vec2<F> u = numbers.get2(U(element_dimension::place));
      Hit<F> hit{};
      Vec3<F> o{};
      F weight = F(0.0f);
      for_each_lane(on, [&](int k) {
        const ElementPoint p = shared_.mesh.place(std::uint32_t(side / 2), {lane(u.x, k), lane(u.y, k)});
        set_lane(hit.u, k, p.hit.u), set_lane(hit.v, k, p.hit.v);
        set_lane(hit.geometry, k, p.hit.geometry), set_lane(hit.primitive, k, p.hit.primitive);
        set_lane(o, k, p.o), set_lane(weight, k, p.weight);
      });
      const Vec3<F> up{F(0.0f), F(0.0f), F(1.0f)};
      const SurfacePoint<F> x = surface<F>(shared_.scene.geometry, {o, up, F(0.0f)}, hit, on).point;
      const Vec3<F> n = side % 2 == 1 ? -x.ng : x.ng;
      const Spectrum<F> one = irradiance_sample(shared_, known, x, n, numbers, counts, on) * weight;
      for_each_lane(on, [&](int k) { sum += lane(one, k); });
    }
    return sum * (1 / float(rays));
  }

  // One sample a pixel: what is emitted, and the reflected part of the irradiance.
  RayCounts show(int frame, const PixelBounds& tile, std::span<PixelSample> out) {
    const TilePass pass{tile, pass_.points, pass_.shutter, std::uint32_t(frame), {}, pass_.grid};
    const Irradiance& known = after(frame);
    FirstHits<F> first_hits(shared_.scene, shared_.accel, pass, out);
    RayCounts counts;
    counts.camera = first_hits.rays();
    PathState<F> path{};
    for (M on = first_hits.refill(path, M(false)); any(on); on = first_hits.refill(path, M(false))) {
      const auto sampler = numbers_of(pass.points, path);
      const U first = U(path_dimension::first_vertex), own = U(path_dimension::own);
      const NextVertex<F> at =
          first_vertex<F>(shared_.scene, shared_.accel, path, on, sampler.stream(first + own), counts);
      const DiffusePoint point = diffuse_point(shared_, ray_of(path), path.hit,
                                               sampler.stream(first + own + U(path_dimension::per_vertex)), on);
      Spectrum<F> leaves = reflected(shared_, known, point, path.hit, on);
      if (shared_.settings.gather)
        leaves = point.albedo * irradiance_sample(shared_, known, point.x.point, point.n,
                                                  numbers_of(gathering_points(pass.points), path), counts, on);
      const Spectrum<F> radiance = (at.emitted + leaves * (1 / pi)) * path.weight;
      for_each_lane(on, [&](int k) { out[lane(path.output, k)].radiance = to_rgb(lane(radiance, k)); });
      write_features(at, point.albedo, path, on, out);
    }
    return counts;
  }
  static PointSet gathering_points(PointSet points) {
    points.seed = mix_bits(points.seed ^ 0x2545f491u);
    return points;
  }

  Radiosity shared_;
  SeriesPass pass_;
  Irradiance irradiance_[2];
};

// What keeps a scene from being one of diffuse surfaces.
std::optional<std::string> not_diffuse(const Scene& scene) {
  for (const GeometryRow& row : scene.geometry.rows) {
    const Material& m = scene.materials[row.material];
    if (m.is_interface) return "a surface is an interface of media";
    if (m.mixture) return "a material is a mixture";
    if (m.has_normal_map()) return "a material has a normal map";
    if (m.kind != kind_of<Diffuse>) return "a material is not \"diffuse\"";
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<RadiosityIntegrator>> RadiosityIntegrator::make(const Scene& scene, const Accel& accel,
                                                                       const RadiositySettings& settings) {
  if (const auto reason = not_diffuse(scene))
    return Failure{
        fmt::format("radiosity is only for scenes of diffuse surfaces, but {}; \"path\" supports all", *reason)};
  const float diagonal = scene.bounds.is_empty() ? 1.0f : length(scene.bounds.high - scene.bounds.low);
  if (scene.geometry.moves()) return Failure{"radiosity is only for scenes without motion; \"path\" supports all"};
  auto mesh = ElementMesh::cut(scene, settings.element_size * diagonal);
  if (!mesh) return mesh.failure();
  return std::unique_ptr<RadiosityIntegrator>(new RadiosityIntegrator(scene, accel, settings, *std::move(mesh)));
}

std::unique_ptr<FrameSeries> RadiosityIntegrator::begin(const SeriesPass& pass) const {
  return std::make_unique<RadiositySeries>(Radiosity{scene_, accel_, settings_, mesh_}, pass);
}

}  // namespace montelux
