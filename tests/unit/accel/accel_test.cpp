#include "accel/accel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <type_traits>

#include "geometry_samples.h"
#include "mc/random.h"

namespace montelux {
namespace {

const OpacityTest opaque = [](const Hit<float>&, const Ray<float>&, RayUse) { return true; };

// A store that grows by one row at a time: first those of the world, then those of the objects.
struct StoreBuilder {
  GeometryStore store;

  std::uint32_t add(GeometryKind kind, std::size_t first, std::size_t count) {
    GeometryRow row;
    row.kind = kind, row.first = std::uint32_t(first), row.count = std::uint32_t(count);
    store.rows.push_back(row);
    return std::uint32_t(store.rows.size() - 1);
  }
  std::uint32_t triangle(Vec3f a, Vec3f b, Vec3f c) {
    auto n = std::uint32_t(store.vertices.size());
    for (const Vec3f& p : {a, b, c}) store.vertices.push_back({p});
    store.triangles.push_back({n, n + 1, n + 2});
    return add(GeometryKind::triangles, store.triangles.size() - 1, 1);
  }
  // The triangle (0,0,z), (1,0,z), (0,1,z), where u is x and v is y.
  std::uint32_t triangle_at(float z) { return triangle({0, 0, z}, {1, 0, z}, {0, 1, z}); }
  std::uint32_t shape(Shape s) {
    store.shapes.push_back(std::move(s));
    return add(GeometryKind::shape, store.shapes.size() - 1, 1);
  }
  std::uint32_t curve(CurveType type, std::vector<Vec3f> normals) {
    CurveDesc desc{{{-1, 0, 0}, {-1 / 3.0f, 0, 0}, {1 / 3.0f, 0, 0}, {1, 0, 0}}};
    desc.type = type, desc.normals = std::move(normals), desc.width0 = 0.2f, desc.width1 = 0.4f;
    store.curves.push_back(*make_curves(desc));
    return add(GeometryKind::curves, store.curves.size() - 1, 1);
  }
  void end_of_world() { store.world_rows = std::uint32_t(store.rows.size()); }
};

Ray<float> down(float x, float y, float height = 10) { return {{x, y, height}, {0, 0, -1}, ray_infinity}; }

struct Answer {
  bool found, occluded;
  Hit<float> hit;
};

// Every lane of F traces its own ray, except every third lane, which is off and must find nothing.
template <class F>
std::vector<Answer> ask(const Accel& accel, const std::vector<Ray<float>>& rays) {
  std::vector<Answer> answers;
  for (std::size_t next = 0; next < rays.size();) {
    Ray<F> pack{{F(0.0f), F(0.0f), F(0.0f)}, {F(0.0f), F(0.0f), F(1.0f)}, F(ray_infinity)};
    Uint<F> bits(0u);
    for (int k = 0; k < lanes_of<F>; ++k) {
      const Ray<float>& ray = rays[std::min(next, rays.size() - 1)];
      set_lane(pack.o, k, ray.o), set_lane(pack.d, k, ray.d), set_lane(pack.t_max, k, ray.t_max);
      if (next == rays.size() || k % 3 == 2) continue;
      set_lane(bits, k, 1u);
      ++next;
    }
    Mask<F> on = bits != Uint<F>(0u);
    const RayUse use = next % 2 == 0 ? RayUse::camera : RayUse::path;
    Accel::Trace<F> trace = accel.trace<F>(pack, on, use);
    Mask<F> occluded = accel.occluded<F>(pack, on);
    for (int k = 0; k < lanes_of<F>; ++k) {
      Hit<float> hit{lane(trace.hit.t, k),        lane(trace.hit.u, k),         lane(trace.hit.v, k),
                     lane(trace.hit.geometry, k), lane(trace.hit.primitive, k), lane(trace.hit.instance, k)};
      if (lane(on, k)) {
        answers.push_back({lane(trace.found, k), lane(occluded, k), hit});
      } else {
        EXPECT_FALSE(lane(trace.found, k));
        EXPECT_FALSE(lane(occluded, k));
      }
    }
  }
  return answers;
}

// For one ray at a time and for packs of them.
template <class F>
struct AccelFor : ::testing::Test {};
using RealTypes = ::testing::Types<float, NativeFloats>;
TYPED_TEST_SUITE(AccelFor, RealTypes);

// Rays aimed at known points of the plane of one triangle: most hit it, some pass by, some end before it.
struct AimedRays {
  struct Aim {
    float t, u, v;
    bool inside;
    double rounding;  // of t, relative
  };
  Vec3f a{-1, 0.5f, 2}, b{2, -1, 0}, c{0.3f, 2.5f, -1};
  std::vector<Ray<float>> rays;
  std::vector<Aim> aims;

  AimedRays() {
    RandomStream<float> random(7, 0);
    while (rays.size() < 1000) {
      const float t = 0.5f + random.next(), u = 1.5f * random.next() - 0.25f, v = 1.5f * random.next() - 0.25f;
      const float edge = std::min({u, v, 1 - u - v});
      const Vec3f o{6 * random.next() - 3, 6 * random.next() - 3, 6 * random.next() - 3};
      const Vec3f to = interpolate(a, b, c, u, v) - o;
      const float slant = std::abs(dot(cross(b - a, c - a), to)) / length(to);
      if (std::abs(edge) < 1e-3f || slant < 0.3f || length(to) < 0.1f) continue;  // where rounding decides
      const Ray<float> ray{o, to / t, random.next() < 0.2f ? 0.99f * t : ray_infinity};
      // Coordinates of a few units are rounded, and seen at a slant.
      const double area = double(length(cross(b - a, c - a)));
      const double rounding = 8 * 6e-8 * 6 * area / (double(slant) * double(length(to)));
      rays.push_back(ray), aims.push_back({t, u, v, edge > 0 && ray.t_max > t, rounding});
    }
  }
};

// How many of the answers are not as aimed.
int wrong_answers(const AimedRays& aimed, const std::vector<Answer>& answers) {
  int wrong = 0;
  for (std::size_t i = 0; i < aimed.aims.size(); ++i) {
    const AimedRays::Aim& aim = aimed.aims[i];
    const Hit<float>& hit = answers[i].hit;
    bool right = answers[i].found == aim.inside && answers[i].occluded == aim.inside;
    if (right && aim.inside)
      right = std::abs(double(hit.t) - double(aim.t)) < aim.rounding * double(aim.t) &&
              std::abs(double(hit.u) - double(aim.u)) < aim.rounding * double(length(aimed.rays[i].d) * aim.t) &&
              std::abs(double(hit.v) - double(aim.v)) < aim.rounding * double(length(aimed.rays[i].d) * aim.t) &&
              hit.geometry == 0 && hit.instance == 0;
    wrong += right ? 0 : 1;
  }
  return wrong;
}

TYPED_TEST(AccelFor, a_triangle_is_met_where_the_ray_was_aimed_and_nowhere_else) {
  const AimedRays aimed;
  StoreBuilder builder;
  builder.triangle(aimed.a, aimed.b, aimed.c);
  builder.end_of_world();
  const Accel accel(builder.store, opaque);
  const std::vector<Answer> answers = ask<TypeParam>(accel, aimed.rays);
  ASSERT_EQ(answers.size(), aimed.rays.size());
  EXPECT_EQ(wrong_answers(aimed, answers), 0);
}

// The same with planted faults, each of which must be seen.
TYPED_TEST(AccelFor, wrong_distances_missed_primitives_and_rays_without_end_are_seen) {
  const AimedRays aimed;
  const auto wrong_with = [&](auto spoil) {
    StoreBuilder builder;
    builder.triangle(aimed.a, aimed.b, aimed.c);
    builder.end_of_world();
    std::vector<Ray<float>> rays = aimed.rays;
    if constexpr (std::is_invocable_v<decltype(spoil), StoreBuilder&>) spoil(builder);
    if constexpr (std::is_invocable_v<decltype(spoil), std::vector<Ray<float>>&>) spoil(rays);
    const Accel accel(builder.store, opaque);
    std::vector<Answer> answers = ask<TypeParam>(accel, rays);
    if constexpr (std::is_invocable_v<decltype(spoil), std::vector<Answer>&>) spoil(answers);
    return wrong_answers(aimed, answers);
  };
  const int hits = int(std::count_if(aimed.aims.begin(), aimed.aims.end(), [](const auto& a) { return a.inside; }));
  ASSERT_GT(hits, 100);
  // The hit is reported a thousandth too far away.
  EXPECT_GT(wrong_with([](std::vector<Answer>& all) {
              for (Answer& a : all) a.hit.t *= 1.001f;
            }),
            hits * 9 / 10);
  // The surface stands a thousandth of its size beside its place.
  EXPECT_GT(wrong_with([](StoreBuilder& b) {
              for (MeshVertex& v : b.store.vertices) v.position.z += 3e-3f;
            }),
            hits * 9 / 10);
  // The triangle is missed, and another one found behind it.
  EXPECT_GE(wrong_with([](StoreBuilder& b) {
              for (MeshVertex& v : b.store.vertices) v.position = 50.0f * v.position + Vec3f{0, 0, 500};
            }),
            hits);
  // Neither the nearest hit nor any hit heeds the end of the ray.
  EXPECT_GT(wrong_with([](std::vector<Ray<float>>& rays) {
              for (Ray<float>& ray : rays) ray.t_max = ray_infinity;
            }),
            30);
  // Any hit alone does not.
  EXPECT_GT(
      wrong_with([&](std::vector<Answer>& all) {
        for (std::size_t i = 0; i < all.size(); ++i)
          all[i].occluded |= std::min({aimed.aims[i].u, aimed.aims[i].v, 1 - aimed.aims[i].u - aimed.aims[i].v}) > 0;
      }),
      30);
  // u and v are exchanged.
  EXPECT_GT(wrong_with([](std::vector<Answer>& all) {
              for (Answer& a : all) std::swap(a.hit.u, a.hit.v);
            }),
            hits * 9 / 10);
}

TYPED_TEST(AccelFor, a_hit_names_its_row_primitive_and_instance) {
  StoreBuilder builder;
  GeometryStore& store = builder.store;
  builder.triangle_at(0);
  std::uint32_t world_sphere = builder.shape(Sphere{translate(5, 0, 0)});
  builder.end_of_world();
  // Object 0: two triangles in one row, and a disk. Object 1: a sphere.
  std::uint32_t pair = builder.triangle_at(0);
  builder.triangle({-1, 0, 0}, {0, 0, 0}, {-1, 1, 0});
  store.rows.pop_back();
  store.rows[pair].count = 2;
  std::uint32_t disk = builder.shape(Disk{translate(3, 0, 1)});
  std::uint32_t sphere = builder.shape(Sphere{});
  store.objects = {{pair, 2}, {sphere, 1}};
  store.instances = {{0, translate(10, 0, 0)}, {1, translate(20, 0, 0) * scale(2, 2, 2)}, {0, translate(30, 0, -1)}};
  Accel accel(store, opaque);

  struct Case {
    Ray<float> ray;
    float t;
    std::uint32_t geometry, primitive, instance;
  };
  std::vector<Case> cases = {{down(0.2f, 0.2f), 10, 0, 0, 0},        {down(5, 0), 9, world_sphere, 0, 0},
                             {down(10.2f, 0.2f), 10, pair, 0, 1},    {down(9.2f, 0.2f), 10, pair, 1, 1},
                             {down(13.2f, 0.2f), 9, disk, 0, 1},     {down(20, 0), 8, sphere, 0, 2},
                             {down(30.2f, 0.2f), 11, pair, 0, 3},    {down(29.2f, 0.2f), 11, pair, 1, 3},
                             {down(33.2f, 0.2f, 20), 20, disk, 0, 3}};
  std::vector<Ray<float>> rays;
  for (const Case& c : cases) rays.push_back(c.ray);
  rays.push_back(down(-5, -5));
  std::vector<Answer> answers = ask<TypeParam>(accel, rays);
  ASSERT_EQ(answers.size(), cases.size() + 1);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    ASSERT_TRUE(answers[i].found && answers[i].occluded) << i;
    EXPECT_NEAR(answers[i].hit.t, cases[i].t, 1e-4f) << i;
    EXPECT_EQ(answers[i].hit.geometry, cases[i].geometry) << i;
    EXPECT_EQ(answers[i].hit.primitive, cases[i].primitive) << i;
    EXPECT_EQ(answers[i].hit.instance, cases[i].instance) << i;
  }
  EXPECT_FALSE(answers.back().found || answers.back().occluded);
}

// The kernel would end the program.
TYPED_TEST(AccelFor, rays_that_the_kernel_cannot_take_meet_nothing) {
  constexpr float infinite = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();
  StoreBuilder alone, builder;
  alone.triangle_at(0), alone.end_of_world();
  const Accel world(alone.store, opaque);
  builder.triangle_at(0), builder.end_of_world();
  const std::uint32_t triangle = builder.triangle_at(0);
  builder.store.objects = {{triangle, 1}};
  builder.store.instances = {{0, scale(1e-9f, 1e-9f, 1e-9f)}};
  const Accel with_small_object(builder.store, opaque);

  std::vector<Ray<float>> rays{down(0.2f, 0.2f)};
  for (const float bad : {1e19f, infinite, -infinite, none}) {
    rays.push_back(down(0.2f, 0.2f, bad)), rays.push_back(down(bad, 0.2f));
    rays.push_back({{0.2f, 0.2f, 10}, {0, bad, -1}, ray_infinity});
  }
  rays.push_back({{0.2f, 0.2f, 10}, {0, 0, -1}, none});
  rays.push_back(down(0.2f, 0.2f));
  for (const Accel* accel : {&world, &with_small_object}) {
    const std::vector<Answer> answers = ask<TypeParam>(*accel, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool good = i == 0 || i + 1 == rays.size();
      EXPECT_EQ(answers[i].found, good) << i;
      EXPECT_EQ(answers[i].occluded, good) << i;
    }
  }
  // In the small object's space the origin is beyond what the kernel takes.
  const std::vector<Answer> far = ask<TypeParam>(with_small_object, {down(0.2f, 0.2f, 1e10f)});
  EXPECT_FALSE(far[0].found);
}

// A crowd of copies of a tent and a ball, once as instances and once as rows of the world, and bundles of rays that
// lead from neighbouring places to one point, as shadow rays do: both see the same.
TYPED_TEST(AccelFor, bundles_of_rays_see_instances_as_they_see_what_stands_in_the_world) {
  const Vec3f corners[] = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0.5f}, {0, 0, 1.5f}};
  const int faces[][3] = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  RandomStream<float> random(13, 0);
  std::vector<Transform> places;
  for (int i = 0; i < 150; ++i) {
    const Vec3f at{20 * random.next(), 20 * random.next(), 20 * random.next()};
    const Vec3f axis = test::random_direction(random);
    places.push_back(translate(at.x, at.y, at.z) * rotate(360 * random.next(), axis.x, axis.y, axis.z));
  }
  StoreBuilder instanced, flat;
  const auto add_copy = [&](StoreBuilder& to, const Transform& at) {
    for (const auto& f : faces) to.triangle(at.point(corners[f[0]]), at.point(corners[f[1]]), at.point(corners[f[2]]));
    return to.shape(Sphere{at * translate(0, 0, 2)});
  };
  for (const Transform& at : places) add_copy(flat, at);
  flat.end_of_world();
  instanced.end_of_world();
  const std::uint32_t last = add_copy(instanced, Transform());
  instanced.store.objects = {{0, last + 1}};
  for (const Transform& at : places) instanced.store.instances.push_back({0, at});

  std::vector<Ray<float>> rays;
  for (int bundle = 0; bundle < 400; ++bundle) {
    const Vec3f from{20 * random.next(), 20 * random.next(), 20 * random.next()};
    const Vec3f to{20 * random.next(), 20 * random.next(), 20 * random.next()};
    for (int i = 0; i < 16; ++i) {
      const Vec3f o = from + 0.2f * test::random_direction(random);
      rays.push_back({o, to - o, 0.999f});
    }
  }
  const std::vector<Answer> in_world = ask<TypeParam>(Accel(flat.store, opaque), rays);
  const auto met = std::ranges::count_if(in_world, &Answer::found);
  EXPECT_GT(met, std::ssize(rays) / 5);
  EXPECT_LT(met, std::ssize(rays) * 4 / 5);

  // Rays to which the instances answer otherwise.
  const auto apart = [&] {
    const std::vector<Answer> answers = ask<TypeParam>(Accel(instanced.store, opaque), rays);
    EXPECT_EQ(answers.size(), rays.size());
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Answer &a = answers[i], &b = in_world[i];
      EXPECT_EQ(a.found, a.occluded) << i;
      count += a.found != b.found || (a.found && std::abs(a.hit.t - b.hit.t) > 1e-4f);
    }
    return count;
  };
  constexpr int grazing = 2;  // rays along an edge, where roundings of the two decide
  EXPECT_LE(apart(), grazing);
  instanced.store.instances[0].object_to_world = translate(0.1f, 0, 0) * places[0];
  EXPECT_GT(apart(), grazing);  // one of them out of its place by a twentieth of its width
}

// Rays that begin near and far, outside of it and within, and end far before the shape, just before it, behind it.
TYPED_TEST(AccelFor, a_shape_is_met_by_the_rays_that_its_own_equation_says_and_no_others) {
  for (const float scale : {1e-3f, 1.0f, 1e4f})
    for (const test::NamedShape& k : test::shapes_at(scale)) {
      StoreBuilder builder;
      builder.shape(k.shape);
      builder.end_of_world();
      const Accel accel(builder.store, opaque);
      RandomStream<float> random(11, 0);
      std::vector<Ray<float>> rays;
      for (int i = 0; i < 3000; ++i) {
        const Vec3f target = surface_point(k.shape, random.next2()).p;
        const float distance = k.size * (i % 3 == 0 ? 0.3f : i % 3 == 1 ? 3.0f : 100.0f);
        const Vec3f from = target + test::random_direction(random) * distance;
        const float ends[] = {0.5f, 1 - 1e-4f, 1 + 1e-4f, 1e30f};
        const Vec3f past = test::random_direction(random) * (i % 5 == 0 ? k.size * random.next() : 0.0f);
        rays.push_back({from, (target + past - from) / distance, distance * ends[std::size_t(random.next() * 4)]});
      }
      const std::vector<Answer> answers = ask<TypeParam>(accel, rays);
      int met = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool meets = intersect(k.shape, rays[i], 0).has_value();
        met += meets;
        ASSERT_EQ(answers[i].found, meets) << k.name << " at scale " << scale << ", ray " << i;
        ASSERT_EQ(answers[i].occluded, meets) << k.name << " at scale " << scale << ", ray " << i;
      }
      EXPECT_GT(met, 1000) << k.name;
      EXPECT_LT(met, 2500) << k.name;
    }
}

// The mask lets through where u > 1/2. For a disk u is the azimuth, so its half y < 0 is cut out.
TYPED_TEST(AccelFor, an_alpha_mask_cuts_holes_and_sees_the_hit_it_decides) {
  StoreBuilder builder;
  GeometryStore& store = builder.store;
  std::uint32_t cut = builder.triangle_at(1), whole = builder.triangle_at(0);
  std::uint32_t cut_disk = builder.shape(Disk{translate(5, 0, 1)});
  builder.end_of_world();
  std::uint32_t placed = builder.triangle_at(1);
  for (std::uint32_t row : {cut, cut_disk, placed}) store.rows[row].alpha = 1;
  store.objects = {{placed, 1}};
  store.instances = {{0, translate(10, 0, 0)}};
  std::atomic<int> wrong{0};
  Accel accel(store, [&](const Hit<float>& hit, const Ray<float>& ray, RayUse) {
    bool right =
        std::abs(hit.t - 9) < 1e-4f && (hit.geometry == cut || hit.geometry == cut_disk || hit.geometry == placed);
    wrong += right && ray.d.z == -1 ? 0 : 1;
    return hit.u < 0.5f;
  });

  std::vector<Answer> a = ask<TypeParam>(
      accel, {down(0.2f, 0.2f), down(0.7f, 0.2f), down(5, 0.5f), down(5, -0.5f), down(10.2f, 0.2f), down(10.7f, 0.2f)});
  ASSERT_EQ(a.size(), 6u);
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(a[0].found && a[0].occluded && a[0].hit.geometry == cut);
  EXPECT_TRUE(a[1].found && a[1].occluded && a[1].hit.geometry == whole);
  EXPECT_NEAR(a[1].hit.t, 10, 1e-5f);
  EXPECT_TRUE(a[2].found && a[2].occluded && a[2].hit.geometry == cut_disk);
  EXPECT_FALSE(a[3].found || a[3].occluded);
  EXPECT_TRUE(a[4].found && a[4].occluded && a[4].hit.geometry == placed && a[4].hit.instance == 1);
  EXPECT_FALSE(a[5].found || a[5].occluded);
}

// A ball's two sides, each of which may be open.
TYPED_TEST(AccelFor, is_requested_both_sides_of_a_ball) {
  StoreBuilder builder;
  builder.shape(Sphere{translate(0, 0, 5)});
  builder.shape(Sphere{translate(5, 0, 5)});
  builder.shape(Sphere{translate(10, 0, 5)});
  builder.end_of_world();
  for (GeometryRow& row : builder.store.rows) row.alpha = 1;
  // The first is open at its near side, the second at the far one, the third at both.
  Accel accel(builder.store, [](const Hit<float>& hit, const Ray<float>&, RayUse) {
    return hit.geometry == 2 ? false : hit.geometry == hit.primitive ? false : true;
  });
  const std::vector<Answer> a = ask<TypeParam>(accel, {down(0, 0), down(5, 0), down(10, 0)});
  EXPECT_TRUE(a[0].found && a[0].occluded);
  EXPECT_NEAR(a[0].hit.t, 6, 1e-5f);
  EXPECT_TRUE(a[1].found && a[1].occluded);
  EXPECT_NEAR(a[1].hit.t, 4, 1e-5f);
  EXPECT_FALSE(a[2].found || a[2].occluded);
}

TYPED_TEST(AccelFor, what_shadow_rays_do_not_see_is_traced_and_does_not_occlude) {
  StoreBuilder builder;
  builder.triangle_at(0);
  builder.shape(Disk{translate(5, 0, 0)});
  builder.curve(CurveType::flat, {});
  builder.end_of_world();
  for (GeometryRow& row : builder.store.rows) row.flags = GeometryRow::invisible_to_shadow_rays;
  Accel accel(builder.store, opaque);
  for (const Answer& a : ask<TypeParam>(accel, {down(0.3f, 0.3f), down(5, 0), down(-0.5f, 0)})) {
    EXPECT_TRUE(a.found);
    EXPECT_FALSE(a.occluded);
  }
}

// A straight band along x whose half width grows from 0.1 to 0.2, seen face on.
TYPED_TEST(AccelFor, a_curve_is_as_wide_as_stated) {
  for (CurveType type : {CurveType::flat, CurveType::ribbon}) {
    StoreBuilder builder;
    builder.curve(type, type == CurveType::ribbon ? std::vector<Vec3f>{{0, 0, 1}, {0, 0, 1}} : std::vector<Vec3f>{});
    builder.end_of_world();
    Accel accel(builder.store, opaque);
    std::vector<Ray<float>> rays;
    for (float u : {0.1f, 0.3f, 0.5f, 0.9f}) {
      float half = 0.1f + 0.1f * u;
      for (float y : {-1.05f, -0.95f, 0.2f, 0.95f, 1.05f}) rays.push_back(down(2 * u - 1, y * half));
    }
    std::vector<Answer> answers = ask<TypeParam>(accel, rays);
    ASSERT_EQ(answers.size(), rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      bool inside = i % 5 != 0 && i % 5 != 4;
      ASSERT_EQ(answers[i].found, inside) << i;
      ASSERT_EQ(answers[i].occluded, inside) << i;
      if (!inside) continue;
      // Roundings: the curve is straight, and its parameter linear in x.
      EXPECT_NEAR(answers[i].hit.t, 10, 1e-5f) << i;
      EXPECT_NEAR(answers[i].hit.u, 0.5f * (rays[i].o.x + 1), 1e-6f) << i;
    }
  }
}

TEST(Accel, counts_its_memory_and_names_its_kernel) {
  StoreBuilder builder;
  builder.triangle_at(0);
  builder.end_of_world();
  Accel accel(builder.store, opaque);
  EXPECT_GT(accel.memory(), 0u);
  EXPECT_EQ(Accel::kernel_version().find_first_of("34"), 0u);
}

}  // namespace
}  // namespace montelux
