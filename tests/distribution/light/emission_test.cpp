// Rays that start at lights, of every kind: they follow their densities, carry the power that is emitted, and light a
// surface as light samples do.
#include <gtest/gtest.h>

#include "light_cases.h"
#include "mc/triangle.h"
#include "statistics.h"

namespace montelux::test {
namespace {

using P = NativeFloats;
constexpr double R = 10;  // of the sphere around the scene of alone()
constexpr Vec3f nowhere{0, 0, 0};

struct EmissionCase {
  std::string name;
  LightKind kind;
  LightSet lights;
  std::function<LightPoint(double, double)> at;  // of surfaces: points; of lights with an image: directions
  std::function<Vec2f(Vec3f)> chart;             // its inverse; empty: directions are not charted by an image
  double power;                                  // emitted, first component
  Vec3f receiver;                                // a point that is lit
  double size = 1;                               // of a square there
};

double mean_of_image() { return double(test_image()->mean()[0]); }

EmissionCase of_surface(LightCase c) {
  double power = 0;
  const bool both = !is_black(c.lights.hit_radiance<float>(0, {0, 0, 1}, {0, 0}, {0, 0, 1}, true));
  power = (both ? 2 : 1) * double(pi) *
          integrate2(
              [&](double x, double y) {
                const LightPoint p = c.at(x, y);
                return p.jacobian * double(c.lights.hit_radiance<float>(0, p.n, p.uv, -p.n, true)[0]);
              },
              0, 1, 0, 1, 40);
  const Vec3f middle = c.at(0.4, 0.4).p;
  return {c.name, c.kind, c.lights, c.at, c.chart, power, c.reference, 0.7 * double(length(middle - c.reference))};
}

EmissionCase of_point(std::string name, LightKind kind, LightSetBuilder builder, double power) {
  return {std::move(name), kind, alone(std::move(builder)), {}, {}, power, {0.4f, 0.3f, 1}};
}

// With the map's pole along y, as goniometric lights have it.
EmissionCase goniometric_case(std::string name, const Transform& to_world, bool charted) {
  LightSetBuilder b;
  b.add_goniometric(to_world, {2, 1, 1}, test_image());
  EmissionCase c = of_point(std::move(name), LightKind::goniometric, std::move(b), 0);
  c.power = charted ? 2 * 4 * double(pi) * double(average(test_image()->mean())) : 0;
  c.receiver = {0.8f, 0.2f, 0.5f};
  if (!charted) return c;
  c.at = [=](double x, double y) {
    const Vec3f w = sphere_from_square(Vec2f{float(x), float(y)});
    const Vec3f d = to_world.direction(Vec3f{w.x, w.z, w.y});
    return LightPoint{normalize(d), d, {0, 0}, 4 * double(pi)};
  };
  c.chart = [=](Vec3f d) {
    const Vec3f w = normalize(to_world.inverted().direction(d));
    return square_from_sphere(Vec3f{w.x, w.z, w.y});
  };
  return c;
}

EmissionCase projection_case(std::string name, const Transform& to_world, bool charted) {
  LightSetBuilder b;
  const double fov = 70, tangent = std::tan(fov / 360 * double(pi));
  b.add_projection(to_world, float(fov), {2, 1, 1}, test_image());
  EmissionCase c = of_point(std::move(name), LightKind::projection, std::move(b), 0);
  const auto area = [=](double x, double y) {
    const double X = (2 * x - 1) * tangent, Y = (2 * y - 1) * tangent;
    return 4 * tangent * tangent * std::pow(1 + X * X + Y * Y, -1.5);
  };
  for (int i = 0; charted && i < 100; ++i)
    c.power += 2 * double(test_image()->texels[std::size_t(i)][0]) *
               integrate2(area, (i % 10) / 10.0, (i % 10 + 1) / 10.0, (i / 10) / 10.0, (i / 10 + 1) / 10.0, 1);
  if (!charted) return c;
  c.at = [=](double x, double y) {
    // The image's first row is at its upper edge.
    const Vec3f d = to_world.direction(normalize(Vec3f{float((2 * x - 1) * tangent), float((1 - 2 * y) * tangent), 1}));
    return LightPoint{normalize(d), d, {0, 0}, area(x, y)};
  };
  c.chart = [=](Vec3f d) {
    const Vec3f w = to_world.inverted().direction(d);
    return in_square(0.5 + 0.5 * double(w.x / w.z) / tangent, 0.5 - 0.5 * double(w.y / w.z) / tangent);
  };
  return c;
}

std::vector<EmissionCase> emission_cases(LightKind kind) {
  std::vector<EmissionCase> all;
  if (is_surface(kind))
    for (LightCase& c : light_cases(kind)) all.push_back(of_surface(std::move(c)));
  const Transform turned = rotate(50, 1, 2, 3), bent = turned * scale(1, 1.6, 0.7);
  switch (kind) {
    case LightKind::triangle: {
      TriangleShape t{{-1, -0.5f, 0}, {1.2f, -0.3f, 0.2f}, {0.1f, 1.1f, -0.3f}};
      all.push_back(of_surface(
          triangle_case("triangle with an image", t, {.two_sided = true, .image = test_image()}, {0.2f, 0.1f, 0.8f})));
      break;
    }
    case LightKind::point: {
      LightSetBuilder b;
      b.add_point({0.1f, 0, 0}, {3, 1, 1});
      all.push_back(of_point("point", kind, std::move(b), 3 * 4 * double(pi)));
      break;
    }
    case LightKind::spot: {
      for (const bool squared : {false, true}) {
        LightSetBuilder b;
        b.add_spot({0.1f, 0, 0}, {0.2f, 0.4f, 1}, {40, 15, squared}, {3, 1, 1});
        const double low = std::cos(40 * double(pi) / 180), high = std::cos(15 * double(pi) / 180);
        // The mean of a smooth step is a half, that of a square a third.
        const double edge = (high - low) * (squared ? 1.0 / 3 : 0.5);
        all.push_back(of_point(squared ? "spot with a squared edge" : "spot", kind, std::move(b),
                               3 * 2 * double(pi) * (1 - high + edge)));
      }
      break;
    }
    case LightKind::goniometric: {
      all.push_back(goniometric_case("goniometric, turned", turned, true));
      all.push_back(goniometric_case("goniometric, bent", bent, false));
      LightSetBuilder b;
      b.add_goniometric(turned, {2, 1, 1}, nullptr);
      all.push_back(of_point("goniometric without an image", kind, std::move(b), 2 * 4 * double(pi)));
      break;
    }
    case LightKind::projection: {
      const Transform at = translate(-0.2, 0, -0.5) * rotate(20, 1, 1, 0);
      all.push_back(projection_case("projection, turned", at, true));
      all.push_back(projection_case("projection, bent", at * scale(1, 1.6, 0.7), false));
      break;
    }
    case LightKind::distant: {
      LightSetBuilder b;
      b.add_distant({1, 1, 2}, {3, 1, 1});
      all.push_back(of_point("distant", kind, std::move(b), 3 * double(pi) * R * R));
      all.back().size = 8;
      break;
    }
    case LightKind::uniform_infinite: {
      LightCase c = uniform_infinite_case("uniform infinite", nowhere);
      all.push_back({c.name, kind, c.lights, c.at, c.chart, 2 * 4 * double(pi) * double(pi) * R * R, {1, 2, 1}, 8});
      break;
    }
    case LightKind::image_infinite: {
      LightCase c = image_infinite_case();
      const double power = 0.5 * mean_of_image() * 4 * double(pi) * double(pi) * R * R;
      all.push_back({c.name, kind, c.lights, c.at, c.chart, power, {1, 2, 1}, 8});
      break;
    }
    default:
      break;
  }
  return all;
}

std::vector<EmissionCase> all_emission_cases() {
  std::vector<EmissionCase> all;
  for (std::size_t k = 0; k < light_kind_names.size(); ++k)
    for (EmissionCase& c : emission_cases(LightKind(k))) all.push_back(std::move(c));
  return all;
}

LightEmission<float> drawn(const EmissionCase& c, RandomStream<float>& r) {
  const Vec2f u_point = r.next2();
  return c.lights.emit<float>(0, u_point, r.next2(), true);
}

// ---- places -----------------------------------------------------------------------------------------------------

Vec2f chart_of_place(const EmissionCase& c, RandomStream<float>& r) {
  const LightEmission<float> e = drawn(c, r);
  if (!e.valid) return {-1, -1};
  if (is_surface(c.kind)) return c.chart(e.p);
  // On the disk: the squared distance from its centre and the azimuth.
  const Vec3f q = LocalFrame<float>::from_normal(e.d).to_local(e.p) * float(1 / R);
  EXPECT_NEAR(q.z, -1, 1e-5f);
  return in_square(double(q.x * q.x + q.y * q.y), double(azimuth_fraction(q)));
}
double density_of_place(const EmissionCase& c, double x, double y) {
  if (!is_surface(c.kind))
    return double(pi) * R * R *
           double(c.lights.emission_densities<float>(0, nowhere, nowhere, {0, 0, 1}, true).position.value);
  const LightPoint at = c.at(x, y);
  return at.jacobian * double(c.lights.emission_densities<float>(0, at.p, at.n, at.n, true).position.value);
}

// ---- directions -------------------------------------------------------------------------------------------------

// A surface's own normal turns the chart of its directions.
Vec3f local_direction(const EmissionCase& c, RandomStream<float>& r) {
  const LightEmission<float> e = drawn(c, r);
  if (!e.valid) return nowhere;
  if (!is_surface(c.kind)) return e.d;
  const Vec2f at = c.chart(e.p);
  return LocalFrame<float>::from_normal(c.at(double(at.x), double(at.y)).n).to_local(e.d);
}
double density_of_direction(const EmissionCase& c, Vec3f local) {
  const LightPoint at = is_surface(c.kind) ? c.at(0.4, 0.3) : LightPoint{nowhere, {0, 0, 1}, {0, 0}, 1};
  const Vec3f d = is_surface(c.kind) ? LocalFrame<float>::from_normal(at.n).to_world(local) : local;
  return double(c.lights.emission_densities<float>(0, at.p, at.n, d, true).direction.value);
}
bool has_image_of_directions(const EmissionCase& c) { return !is_surface(c.kind) && bool(c.chart); }
// Of images: per unit of the square, whose cells lie within texels.
double density_on_image(const EmissionCase& c, double x, double y) {
  const LightPoint at = c.at(x, y);
  // Infinite lights are charted by the direction to them.
  return at.jacobian * density_of_direction(c, is_infinite(c.kind) ? -at.p : at.p);
}
Vec2f chart_on_image(const EmissionCase& c, RandomStream<float>& r) {
  const LightEmission<float> e = drawn(c, r);
  if (!e.valid) return {-1, -1};
  return c.chart(is_infinite(c.kind) ? -e.d : e.d);
}
// A spot's axis turns the chart about it, so that its edge lies on a ring of the chart.
LocalFrame<float> frame_of(const EmissionCase& c) {
  return LocalFrame<float>::from_normal(c.kind == LightKind::spot ? normalize(Vec3f{0.2f, 0.4f, 1}) : Vec3f{0, 0, 1});
}

TEST(EmittedRays, have_a_case_for_every_kind_of_light) {
  for (std::size_t k = 0; k < light_kind_names.size(); ++k)
    EXPECT_FALSE(emission_cases(LightKind(k)).empty()) << light_kind_names[k];
}

TEST(EmittedRays, start_at_places_that_follow_the_density_and_a_planted_fault_is_found) {
  const std::vector<EmissionCase> cases = all_emission_cases();
  const double level = sidak_level(family_level, double(2 * cases.size()));
  for (const EmissionCase& c : cases) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(1, 2);
    if (drawn(c, r).delta_position) {
      EXPECT_EQ(c.lights.emission_densities<float>(0, nowhere, nowhere, {0, 0, 1}, true).position.value, 1.0f);
      continue;
    }
    const auto place = [&](RandomStream<float>& stream) { return chart_of_place(c, stream); };
    const auto density = [&](double x, double y) { return density_of_place(c, x, y); };
    for (const Grid grid : {coarse_grid, fine_grid}) {
      const TestResult fit = chi_square_square(place, density, grid, 80000, 11);
      EXPECT_GT(fit.p_value, level) << fit.note;
    }
    const auto tilted = [&](double x, double y) { return density(x, y) * (1.08 - 0.16 * (y < 0.5 ? 1 : 0)); };
    EXPECT_LT(chi_square_square(place, tilted, coarse_grid, 80000, 11).p_value, level);
  }
}

TEST(EmittedRays, take_directions_that_follow_the_density_and_a_wrong_cosine_is_found) {
  const std::vector<EmissionCase> cases = all_emission_cases();
  const double level = sidak_level(family_level, double(2 * cases.size()));
  for (const EmissionCase& c : cases) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(1, 2);
    if (drawn(c, r).delta_direction) continue;
    if (has_image_of_directions(c)) {
      const auto direction = [&](RandomStream<float>& stream) { return chart_on_image(c, stream); };
      const auto density = [&](double x, double y) { return density_on_image(c, x, y); };
      for (const Grid grid : {Grid{10, 20}, Grid{40, 80}}) {
        const TestResult fit = chi_square_square(direction, density, grid, 80000, 13);
        EXPECT_GT(fit.p_value, level) << fit.note;
      }
      const auto tilted = [&](double x, double y) { return density(x, y) * (1.08 - 0.16 * (y < 0.5 ? 1 : 0)); };
      EXPECT_LT(chi_square_square(direction, tilted, coarse_grid, 80000, 13).p_value, level);
      continue;
    }
    // The texels of an image under a map that is no rotation have edges in no grid's favour.
    if (c.name.ends_with("bent")) continue;
    const LocalFrame<float> frame = frame_of(c);
    const auto direction = [&](RandomStream<float>& stream) { return local_direction(c, stream); };
    const auto density = [&](Vec3f w) { return density_of_direction(c, w); };
    for (const Grid grid : {coarse_grid, fine_grid}) {
      const TestResult fit = chi_square_sphere(direction, density, grid, 80000, 13, frame, 4);
      // The edge of a spot's cone runs through a ring of cells.
      if (c.kind == LightKind::spot) continue;
      EXPECT_GT(fit.p_value, level) << fit.note;
    }
    if (c.kind == LightKind::spot) {
      const double end = 0.5 + 0.5 * std::cos(40 * double(pi) / 180);
      const auto on_cone = [&](RandomStream<float>& stream) {
        const SpherePoint s = sphere_chart(frame, local_direction(c, stream));
        return SpherePoint{std::clamp((s.x - end) / (1 - end), 0.0, 1 - 1e-9), s.y};
      };
      const auto of_cone = [&](double x, double y) {
        return 4 * double(pi) * (1 - end) * density(sphere_from_chart(frame, end + x * (1 - end), y));
      };
      for (const Grid grid : {coarse_grid, fine_grid})
        EXPECT_GT(chi_square_square(on_cone, of_cone, grid, 80000, 13).p_value, level);
    }
    const auto wrong = [&](Vec3f w) {
      if (is_surface(c.kind)) return density(w) > 0 ? density(w) / double(pi) / double(abs(w.z)) / density(w) : 0.0;
      return density(w) * (dot(w, frame.s) > 0 ? 1.08 : 0.92);
    };
    EXPECT_LT(chi_square_sphere(direction, wrong, coarse_grid, 80000, 13, frame, 4).p_value, level);
  }
}

// How far the numbers of a ray are from those that emit() drew it with, and the ray that they give from that ray.
struct RoundTrip {
  double numbers = 0;
  double ray = 0;
};
// `fault`: a factor of the first number of each pair.
RoundTrip round_trip(const EmissionCase& c, Vec2f u_point, Vec2f u_direction, float fault = 1) {
  const LightEmission<float> e = c.lights.emit<float>(0, u_point, u_direction, true);
  if (!e.valid) return {};
  EmissionNumbers<float> u = c.lights.emission_numbers<float>(0, e.p, e.n, e.d, true);
  u.point.x *= fault, u.direction.x *= fault;
  const LightEmission<float> again = c.lights.emit<float>(0, u.point, u.direction, true);
  RoundTrip r;
  const auto widen = [&](Vec2f a, Vec2f b) {
    r.numbers = std::max({r.numbers, double(std::abs(a.x - b.x)), double(std::abs(a.y - b.y))});
  };
  if (!e.delta_position) widen(u.point, u_point);
  if (!e.delta_direction) widen(u.direction, u_direction);
  r.ray = std::max(double(length(again.p - e.p)), double(length(again.d - e.d)));
  return r;
}

// Rounding of directions near poles and of points near the ends of charts is multiplied there: nearly all numbers are
// found to five digits, and all rays.
TEST(EmittedRays, are_led_back_to_their_numbers) {
  for (const EmissionCase& c : all_emission_cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(5, 6);
    int exact = 0, off = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const Vec2f u_point = r.next2(), u_direction = r.next2();
      const RoundTrip trip = round_trip(c, u_point, u_direction);
      EXPECT_LT(trip.ray, is_infinite(c.kind) || c.kind == LightKind::distant ? 2e-3 : 1e-3)
          << u_point.x << " " << u_point.y << " " << u_direction.x << " " << u_direction.y;
      exact += trip.numbers < 1e-4;
      off += round_trip(c, u_point, u_direction, 0.99f).numbers > 1e-4;
    }
    EXPECT_GT(exact, 0.97 * n);
    EXPECT_GT(off, 0.9 * n) << "numbers that are a hundredth too small";
  }
}

// Each lane its own ray, as in one lane.
TEST(EmittedRays, are_led_back_in_lanes) {
  for (const EmissionCase& c : all_emission_cases()) {
    SCOPED_TRACE(c.name);
    const RandomStream<P> r(Uint<P>(7u), lane_index<P>());
    RandomStream<P> stream = r;
    const Vec2<P> u_point = stream.next2(), u_direction = stream.next2();
    const Uint<P> light(0u);
    const LightEmission<P> e = c.lights.emit<P>(light, u_point, u_direction, Mask<P>(true));
    const EmissionNumbers<P> u = c.lights.emission_numbers<P>(light, e.p, e.n, e.d, e.valid);
    for_each_lane(e.valid, [&](int k) {
      const EmissionNumbers<float> one =
          c.lights.emission_numbers<float>(0, lane(e.p, k), lane(e.n, k), lane(e.d, k), true);
      EXPECT_NEAR(lane(u.point.x, k), one.point.x, 1e-5f);
      EXPECT_NEAR(lane(u.point.y, k), one.point.y, 1e-5f);
      EXPECT_NEAR(lane(u.direction.x, k), one.direction.x, 1e-5f);
      EXPECT_NEAR(lane(u.direction.y, k), one.direction.y, 1e-5f);
    });
  }
}

bool is_one(double integral) { return std::abs(integral - 1) < 2e-3; }

TEST(EmittedRays, have_densities_of_integral_one_and_one_percent_more_is_found) {
  for (const EmissionCase& c : all_emission_cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(1, 2);
    const LightEmission<float> e = drawn(c, r);
    if (!e.delta_position) {
      const double places = integrate2([&](double x, double y) { return density_of_place(c, x, y); }, 0, 1, 0, 1, 40);
      EXPECT_TRUE(is_one(places)) << places;
      EXPECT_FALSE(is_one(1.01 * places));
    }
    if (e.delta_direction) continue;
    double directions = 0;
    if (has_image_of_directions(c)) {
      directions = integrate2([&](double x, double y) { return density_on_image(c, x, y); }, 0, 1, 0, 1, 10);
    } else {
      const double low = c.kind == LightKind::spot ? std::cos(40 * double(pi) / 180) : -1;
      directions = integrate_sphere([&](Vec3f w) { return density_of_direction(c, w); }, frame_of(c),
                                    c.name.ends_with("bent") ? 400 : 32, low);
    }
    EXPECT_TRUE(is_one(directions)) << directions;
    EXPECT_FALSE(is_one(1.01 * directions));
  }
}

TEST(EmittedRays, state_the_densities_that_are_requested_of_a_ray) {
  for (const EmissionCase& c : all_emission_cases()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(3, 4);
    int valid = 0, off = 0;
    for (int i = 0; i < 2000; ++i) {
      const LightEmission<float> e = drawn(c, r);
      if (!e.valid) continue;
      ++valid;
      EXPECT_NEAR(length(e.d), 1, 1e-5f);
      EXPECT_NEAR(length(e.n), 1, 1e-5f);
      EXPECT_GT(dot(e.n, e.d), 0);
      const EmissionDensities<float> d = c.lights.emission_densities<float>(0, e.p, e.n, e.d, true);
      EXPECT_NEAR(d.position.value / e.position.value, 1, 1e-3f);
      EXPECT_EQ(d.delta_position, e.delta_position);
      EXPECT_EQ(d.delta_direction, e.delta_direction);
      // A direction on the edge of two texels may be looked up in either; the cosine of a grazing one is rounded.
      off += std::abs(d.direction.value / e.direction.value - 1) > 2e-3f;
    }
    EXPECT_GT(valid, 1900);
    EXPECT_LE(off, 4);
  }
}

TEST(EmittedRays, carry_the_power_of_the_light_and_one_percent_more_is_found) {
  const std::vector<EmissionCase> cases = all_emission_cases();
  const double level = sidak_level(family_level, double(cases.size()));
  for (const EmissionCase& c : cases) {
    if (c.power == 0) continue;
    SCOPED_TRACE(c.name);
    RandomStream<float> r(5, 6);
    Moments flux;
    for (int i = 0; i < 400000; ++i) {
      const LightEmission<float> e = drawn(c, r);
      flux.add(e.valid ? double(e.flux[0]) : 0.0);
      // By the definition.
      const double cos = is_surface(c.kind) ? double(dot(e.n, e.d)) : 1.0;
      if (e.valid && cos > 0.1) {
        const double defined = double(e.radiance[0]) * cos / double(e.position.value) / double(e.direction.value);
        ASSERT_NEAR(defined, double(e.flux[0]), 1e-4 * defined);
      }
    }
    const double error = std::sqrt(flux.variance() / 400000);
    if (error < 1e-5 * c.power) {
      EXPECT_NEAR(flux.mean / c.power, 1, 5e-4);
      EXPECT_GT(std::abs(1.01 * flux.mean / c.power - 1), 5e-4);
      continue;
    }
    EXPECT_GT(z_test(flux.mean, error, c.power).p_value, level) << flux.mean << " for " << c.power;
    EXPECT_LT(z_test(1.01 * flux.mean, 1.01 * error, c.power).p_value, level) << error / c.power;
  }
}

// A square about the receiver's place that faces some point of the light.
struct Receiver {
  Vec3f p, n, s, t;
  float half;
  // Where a ray from the front meets it.
  bool meets(Vec3f o, Vec3f d) const {
    const float cos = dot(n, d);
    if (cos >= 0) return false;
    const float way = dot(n, p - o) / cos;
    const Vec3f q = o + d * way - p;
    return way > 0 && std::abs(dot(q, s)) < half && std::abs(dot(q, t)) < half;
  }
};
Receiver receiver_of(const EmissionCase& c) {
  RandomStream<float> r(7, 8);
  const LightSample<float> s = c.lights.sample<float>(c.receiver, nowhere, 0.5f, {0.4f, 0.45f}, true);
  EXPECT_TRUE(s.valid);
  const LocalFrame<float> frame = LocalFrame<float>::from_normal(s.valid ? s.wi : Vec3f{0, 0, 1});
  return {c.receiver, frame.n, frame.s, frame.t, 0.5f * float(c.size)};
}

// The flux onto the receiver by rays from the light, and by light samples at its points.
Moments by_rays(const EmissionCase& c, const Receiver& receiver, double fault, bool with_cosine = true) {
  RandomStream<float> r(9, 10);
  Moments m;
  for (int i = 0; i < 600000; ++i) {
    const LightEmission<float> e = drawn(c, r);
    const bool hits = e.valid && receiver.meets(e.p, e.d);
    m.add(hits ? fault * double(e.flux[0]) / (with_cosine ? 1 : double(dot(e.n, e.d))) : 0.0);
  }
  return m;
}
Moments by_samples(const EmissionCase& c, const Receiver& receiver) {
  RandomStream<float> r(11, 12);
  Moments m;
  const double area = 4 * double(receiver.half) * double(receiver.half);
  for (int i = 0; i < 300000; ++i) {
    const Vec2f u = r.next2() * 2.0f - Vec2f{1, 1};
    const Vec3f p = receiver.p + receiver.s * (u.x * receiver.half) + receiver.t * (u.y * receiver.half);
    const float choice = r.next();
    const LightSample<float> s = c.lights.sample<float>(p, nowhere, choice, r.next2(), true);
    m.add(s.valid ? area * double(s.radiance[0] * max(dot(s.wi, receiver.n), 0.0f) / s.density.value) : 0.0);
  }
  return m;
}
double standard_error(const Moments& m) { return std::sqrt(m.variance() / double(m.count)); }
double p_value(const Moments& a, const Moments& b) {
  const auto summary = [](const Moments& m) { return SampleSummary{m.mean, m.variance(), double(m.count)}; };
  return welch_test(summary(a), summary(b)).p_value;
}

TEST(EmittedRays, light_a_square_as_light_samples_do_and_planted_faults_are_found) {
  const std::vector<EmissionCase> cases = all_emission_cases();
  const double level = sidak_level(family_level, double(cases.size()));
  for (const EmissionCase& c : cases) {
    SCOPED_TRACE(c.name);
    const Receiver receiver = receiver_of(c);
    const Moments samples = by_samples(c, receiver), rays = by_rays(c, receiver, 1);
    EXPECT_GT(samples.mean, 0);
    EXPECT_GT(p_value(rays, samples), level) << rays.mean << " by rays, " << samples.mean << " by samples";
    const double error = std::hypot(standard_error(rays), standard_error(samples)) / samples.mean;
    EXPECT_LT(error, 0.03);
    EXPECT_LT(p_value(by_rays(c, receiver, 1 + 9 * error), samples), level) << error;
    if (is_surface(c.kind)) {
      EXPECT_LT(p_value(by_rays(c, receiver, 1, false), samples), level);
    }
  }
}

TEST(EmittedRays, are_the_same_in_lanes) {
  LightSetBuilder b;
  Emission plain{.radiance = {1, 2, 3}}, picture{.two_sided = true, .image = test_image()};
  b.add(TriangleShape{{0, 0, 3}, {1, 0, 3}, {0, 1, 3}}, picture);
  b.add(PatchShape{{0, 0, -3}, {1, 0, -3}, {0, 1, -3}, {1, 1, -3}}, plain);
  b.add(PatchShape{{2, 0, -3}, {3, 0, -3}, {2, 1, -3}, {3, 1.5f, -2.5f}}, picture);
  b.add(DiskShape{translate(-3, 0, 0) * rotate(90, 0, 1, 0), 0.7f}, picture);
  b.add(SphereShape{translate(-3, 3, 0), 0.7f}, picture);
  b.add(CylinderShape{translate(0, -3, 0), 0.3f}, picture);
  b.add_point({0, 4, 0}, gray_rgb(2.0f));
  b.add_spot({4, 4, 0}, {-1, -1, 0}, {60, 20}, gray_rgb(2.0f));
  b.add_goniometric(translate(4, 0, 0), gray_rgb(1.0f), test_image());
  b.add_projection(translate(0, 0, -5), 90, gray_rgb(1.0f), test_image());
  b.add_distant({1, 1, 1}, gray_rgb(1.0f));
  b.add_uniform_infinite(gray_rgb(0.3f));
  b.add_image_infinite(rotate(30, 1, 0, 0), gray_rgb(0.3f), test_image());
  const LightSet lights = std::move(b).build({}, {1, 2, 3}, 8);
  ASSERT_EQ(lights.count(), light_kind_names.size());
  const AliasTable by_power = lights.by_power();
  RandomStream<float> r(13, 14);
  std::vector<int> chosen(lights.count());
  for (int i = 0; i < 400; ++i) {
    Vec2<P> u, v;
    P choice;
    const Mask<P> on = mask_of_bits<P>(mix_bits(std::uint32_t(i)));
    for (int k = 0; k < native_lanes; ++k)
      set_lane(u, k, r.next2()), set_lane(v, k, r.next2()), set_lane(choice, k, r.next());
    const Uint<P> light = i % 2 ? by_power.sample(choice).index : min(to_uint(choice * 13.0f), Uint<P>(12u));
    const LightEmission<P> e = lights.emit<P>(light, u, v, on);
    const EmissionDensities<P> densities = lights.emission_densities<P>(light, e.p, e.n, e.d, on & e.valid);
    for_each_lane(on, [&](int k) {
      const std::uint32_t one = lane(light, k);
      ++chosen[one];
      const LightEmission<float> f = lights.emit<float>(one, lane(u, k), lane(v, k), true);
      ASSERT_EQ(lane(e.valid, k), f.valid);
      if (!f.valid) return;
      const auto same = [&](Vec3f a, Vec3f b3) { EXPECT_TRUE(a.x == b3.x && a.y == b3.y && a.z == b3.z); };
      same(lane(e.p, k), f.p), same(lane(e.d, k), f.d), same(lane(e.n, k), f.n), same(lane(e.p_error, k), f.p_error);
      EXPECT_EQ(lane(e.flux, k)[1], f.flux[1]);
      EXPECT_EQ(lane(e.position.value, k), f.position.value);
      EXPECT_EQ(lane(e.direction.value, k), f.direction.value);
      EXPECT_EQ(lane(e.delta_position, k), f.delta_position);
      EXPECT_EQ(lane(e.delta_direction, k), f.delta_direction);
      const EmissionDensities<float> g = lights.emission_densities<float>(one, f.p, f.n, f.d, true);
      EXPECT_EQ(lane(densities.position.value, k), g.position.value);
      EXPECT_EQ(lane(densities.direction.value, k), g.direction.value);
    });
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) EXPECT_GT(chosen[k], 20) << light_kind_names[k];
}

}  // namespace
}  // namespace montelux::test
