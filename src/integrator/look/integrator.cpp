#include "integrator/look/integrator.h"

#include <algorithm>

#include "integrator/branches.h"
#include "integrator/first_vertex.h"
#include "integrator/path/first_hits.h"
#include "mc/hemisphere.h"
#include "parameter/fields.h"
#include "transport/connection.h"

namespace montelux {

namespace {

using F = NativeFloats;
using U = Uint<F>;
using M = Mask<F>;

struct View {
  const Scene& scene;
  const Accel& accel;
  const LookSettings& settings;
  const NextVertex<F>& at;
  const Branches<F>& numbers;
  RayCounts& counts;

  Vec3<F> normal() const { return face_forward(at.bsdf.frame.n, -at.d); }

  M is_open(const Ray<F>& ray, M on) const { return unblocked<F>(accel, ray, on, counts.shadow); }

  Spectrum<F> openness(std::uint32_t sample) const {
    const Vec2<F> u = numbers.get2(sample, path_dimension::direction);
    const Vec3<F> local = settings.by_cosine ? sample_cosine_hemisphere(u) : sample_hemisphere(u);
    const Vec3<F> wi = LocalFrame<F>::from_normal(normal()).to_world(local);
    // The density that is wanted over the one that was drawn by.
    const F weight =
        settings.by_cosine ? F(1.0f) : cosine_hemisphere_density(local.z).value / hemisphere_density(local.z).value;
    return gray(select(is_open(at.ray_toward(wi, F(settings.distance)), at.found), weight, F(0.0f)));
  }

  Spectrum<F> irradiance(std::uint32_t sample) const {
    const LightSample<F> light =
        scene.lights.sample<F>(at.x.point.p, normal(), numbers.get1(sample, path_dimension::light_choice),
                               numbers.get2(sample, path_dimension::light_point), at.found);
    const F cos = dot(light.wi, normal());
    const M queries = at.found & light.valid & (cos > F(0.0f));
    const Arriving<F> seen = arriving_from<F>(scene, accel, at, light.wi, light.distance, queries,
                                              at.context.random.fork(U(vertex_stream::shadow)), counts.shadow);
    return select(seen.on, light.radiance * seen.left * (cos / light.density), gray(F(0.0f)));
  }

  Spectrum<F> albedo(std::uint32_t sample) const {
    const Vec2<F> u = numbers.get2(sample, path_dimension::direction);
    const BsdfSample<F> next = montelux::sample<F>(
        at.bsdf.lanes(at.found), at.wo, Vec3<F>{numbers.get1(sample, path_dimension::lobe), u.x, u.y}, at.context);
    return select(next.valid, next.weight, gray(F(0.0f)));
  }

  Spectrum<F> value(std::uint32_t sample) const {
    switch (settings.look) {
      case Look::ambient_occlusion:
        return openness(sample);
      case Look::irradiance:
        return irradiance(sample);
      case Look::albedo:
        return albedo(sample);
      case Look::depth:
        return gray(at.distance);
      case Look::normal:
        break;
    }
    const Vec3<F> n = normal();
    return {{0.5f * (n.x + F(1.0f)), 0.5f * (n.y + F(1.0f)), 0.5f * (n.z + F(1.0f))}};
  }
};

}  // namespace

RayCounts LookIntegrator::trace(const TilePass& pass, std::span<PixelSample> out) const {
  std::fill(out.begin(), out.end(), PixelSample{});
  FirstHits<F> first_hits(scene_, accel_, pass, out);
  // Where nothing is met, everything is open, and there is nothing else to see.
  const float beyond = settings_.look == Look::ambient_occlusion ? 1.0f : 0.0f;
  for (PixelSample& sample : out) sample.radiance = gray_rgb(beyond);
  RayCounts counts;
  counts.camera = first_hits.rays();
  PathState<F> path{};
  const U first = U(path_dimension::first_vertex);
  const auto n = std::uint32_t(settings_.samples);
  for (;;) {
    const M on = first_hits.refill(path, M(false));
    if (!any(on)) return counts;
    const auto sampler = numbers_of(pass.points, path);
    const NextVertex<F> at =
        first_vertex<F>(scene_, accel_, path, on, sampler.stream(first + U(path_dimension::own)), counts);
    const Branches<F> numbers(pass, {path.x, path.y, path.index}, first, U(0u), n);
    const View view{scene_, accel_, settings_, at, numbers, counts};
    Spectrum<F> sum = gray(F(0.0f));
    for (std::uint32_t i = 0; i < n; ++i) sum += view.value(i);
    const Spectrum<F> radiance =
        select(at.found, sum * (1.0f / float(n)), gray(F(beyond))) * (path.weight / scene_.imaging_ratio);
    for_each_lane(on, [&](int k) { out[lane(path.output, k)].radiance = to_rgb(lane(radiance, k)); });
    write_features(at, sampler, path, out);
  }
}

namespace {

struct LookRow {
  std::string_view name;
  Look look;
  std::string_view meaning;
  bool has_samples = true;
};
constexpr LookRow look_rows[] = {
    {"ao", Look::ambient_occlusion, "the share of open directions (no image of light)"},
    {"normal", Look::normal, "shading normals as colours (no image of light)", false},
    {"albedo", Look::albedo, "reflected light under uniform unit radiance (no image of light)"},
    {"depth", Look::depth, "distance from the camera (no image of light)", false},
    {"irradiance", Look::irradiance, "direct light incident on surfaces (no image of light)"}};

Fields<LookSettings> look_fields(const LookRow& row) {
  Fields<LookSettings> fields;
  if (row.has_samples) fields.integer("samples", &LookSettings::samples, "of each camera ray", 1, 4096);
  if (row.look != Look::ambient_occlusion) return fields;
  fields.number("distance", &LookSettings::distance, "maximum distance of occluders; 1e30: unlimited", 1e-6, 1e30)
      .boolean("cossample", &LookSettings::by_cosine, "directions are cosine-weighted, with less noise");
  return fields;
}

}  // namespace

std::vector<EntitySpec> look_specs() {
  std::vector<EntitySpec> all;
  for (const LookRow& row : look_rows) all.push_back({row.name, row.meaning, look_fields(row).specs({})});
  return all;
}

LookSettings look_settings(std::string_view name, const ParameterList& list) {
  LookSettings s;
  for (const LookRow& row : look_rows) {
    if (row.name != name) continue;
    s.look = row.look;
    // None of the rows can fail: their values have been checked.
    (void)look_fields(row).read(list, s);
  }
  return s;
}

}  // namespace montelux
