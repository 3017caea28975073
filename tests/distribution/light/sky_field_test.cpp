// A light from infinity that is sampled by a learned field: samples follow the stated density, whatever was learned.
#include "light/sky_field.h"

#include <gtest/gtest.h>

#include "light_cases.h"
#include "statistics.h"

namespace montelux::test {
namespace {

// Cells of this grid lie in one texel of the test image and in one cell of the field.
constexpr Grid finest{160, 160};

// The first class of orientations is divided at x = 0 of a cube from -1 to 1: leaf 0 is below. The others are leaf 2.
PlaceTree tree_of_three() {
  PlaceTree tree{.low = {-1, -1, -1}, .size = 2, .nodes = {PlaceTree::classes}};
  tree.nodes.resize(PlaceTree::classes, PlaceTree::leaf | 2u);
  tree.nodes.insert(tree.nodes.end(), {PlaceTree::leaf | 0u, PlaceTree::leaf | 1u});
  return tree;
}

// What a window shows, what is found here and there, and nothing.
std::vector<SkyDirections::Table> three_tables() {
  std::vector<SkyDirections::Table> tables(3);
  RandomStream<float> r(8, 3);
  for (std::uint32_t c = 0; c < SkyDirections::cells; ++c) {
    tables[0].weights[c] = c / SkyDirections::side < 6 ? 2.0f : 0.0f;
    const float u = r.next();
    tables[1].weights[c] = u < 0.5f ? 0.0f : u * u;
  }
  return tables;
}

LightSet with_field(const LightSet& lights) {
  return lights.with(std::make_shared<SkyField>(lights.sky_light().value(), tree_of_three(), three_tables()));
}

struct Place {
  Vec3f p, n;
};
const std::vector<Place> places{{{-0.5f, 0, 0}, {1, 0, 0}}, {{0.5f, 0, 0}, {1, 0, 0}}, {{0.5f, 0, 0}, {0, 0, 0}}};

// Every light from infinity, with the field.
std::vector<LightCase> cases_with_field() {
  std::vector<LightCase> all = light_cases(LightKind::image_infinite);
  for (LightCase& c : light_cases(LightKind::uniform_infinite)) {
    // On the square of which the cells of the field are parts.
    c.at = [](double x, double y) {
      const Vec3f w = sphere_from_square(Vec2f{float(x), float(y)});
      return LightPoint{w, -w, {0, 0}, 4 * double(pi)};
    };
    c.chart = [](Vec3f w) { return square_from_sphere(w); };
    all.push_back(std::move(c));
  }
  for (LightCase& c : all) c.lights = with_field(c.lights);
  return all;
}

TEST(SkyField, samples_follow_the_density_and_that_of_another_place_is_found) {
  const std::vector<LightCase> cases = cases_with_field();
  const double level = sidak_level(family_level, double(places.size() * cases.size()));
  for (LightCase c : cases)
    for (std::size_t i = 0; i < places.size(); ++i) {
      SCOPED_TRACE(testing::Message() << c.name << ", place " << i);
      c.reference = places[i].p, c.n = places[i].n;
      const auto sample = [&](RandomStream<float>& r) {
        const float choice = r.next();
        const LightSample<float> s = c.lights.sample<float>(c.reference, c.n, choice, r.next2(), true);
        return s.valid ? c.chart(s.wi) : Vec2f{-1, -1};
      };
      const auto fit = [&](const LightCase& of) {
        return chi_square_square(
            sample, [&](double x, double y) { return chart_density(of, x, y); }, finest, 1000000, 5);
      };
      const TestResult right = fit(c);
      EXPECT_GT(right.p_value, level) << right.note;
      LightCase other = c;
      other.reference = places[(i + 1) % 3].p, other.n = places[(i + 1) % 3].n;
      EXPECT_LT(fit(other).p_value, level);
    }
}

// The light of the whole sphere, by the mean of the image, which no table of ours has a part in.
TEST(SkyField, estimates_the_light_of_the_sphere) {
  const auto image = test_image();
  Rgb truth{};
  for (const Rgb& texel : image->texels) truth += texel * (0.5f * 4 * pi / float(image->texels.size()));
  const LightCase c = [] {
    LightCase with = image_infinite_case();
    with.lights = with_field(with.lights);
    return with;
  }();
  const double level = sidak_level(family_level, 3.0 * double(places.size()));
  for (const Place& place : places) {
    std::array<std::vector<double>, rgb_size> found;
    RandomStream<float> r(31, 4);
    for (int i = 0; i < 200000; ++i) {
      const LightSample<float> s = c.lights.sample_light<float>(0, place.p, place.n, r.next2(), true);
      const Rgb value = s.valid ? to_rgb(s.radiance * (1 / s.density.value)) : Rgb{};
      for (std::size_t k = 0; k < rgb_size; ++k) found[k].push_back(double(value.c[k]));
    }
    for (std::size_t k = 0; k < rgb_size; ++k) {
      EXPECT_GT(t_test(summarize(found[k]), double(truth.c[k])).p_value, level);
      EXPECT_LT(t_test(summarize(found[k]), 1.1 * double(truth.c[k])).p_value, level);
    }
  }
}

TEST(SkyField, is_the_same_in_every_lane_as_alone_and_for_a_ray_as_for_a_sample) {
  using F = NativeFloats;
  for (const LightCase& c : cases_with_field()) {
    SCOPED_TRACE(c.name);
    RandomStream<float> r(12, 7);
    for (int i = 0; i < 500; ++i) {
      Vec3<F> p, n;
      Vec2<F> u;
      for (int k = 0; k < lanes_of<F>; ++k) {
        const Place& at = places[std::size_t(r.next() * 3)];
        set_lane(p, k, at.p), set_lane(n, k, at.n), set_lane(u, k, r.next2());
      }
      const Mask<F> on(true);
      const LightSample<F> all = c.lights.sample_light<F>(Uint<F>(0u), p, n, u, on);
      const LightHit<F> met = c.lights.escaped<F>(0, p, n, all.wi, on);
      const Density<SolidAngle, F> density = c.lights.sampling_density<F>(Uint<F>(0u), p, n, p, all.wi, on);
      for (int k = 0; k < lanes_of<F>; ++k) {
        const LightSample<float> one = c.lights.sample_light<float>(0, lane(p, k), lane(n, k), lane(u, k), true);
        EXPECT_EQ(one.valid, lane(all.valid, k));
        if (!one.valid) continue;
        EXPECT_EQ(length_squared(one.wi - lane(all.wi, k)), 0);
        EXPECT_EQ(one.density.value, lane(all.density.value, k));
        EXPECT_EQ(one.density.value, lane(met.density.value, k));
        EXPECT_EQ(one.density.value, lane(density.value, k));
        for (int x = 0; x < spectrum_size; ++x) EXPECT_EQ(one.radiance[x], lane(met.radiance, k)[x]);
      }
    }
  }
}

// Where nothing was learned, and in a set without lights from infinity.
TEST(SkyField, is_the_light_itself_where_nothing_is_known) {
  const LightCase plain = image_infinite_case();
  const LightSet known = with_field(plain.lights);
  RandomStream<float> r(2, 2);
  const Place& place = places[2];
  for (int i = 0; i < 1000; ++i) {
    const Vec3f wi = sample_sphere(r.next2());
    const float own = plain.lights.escaped<float>(0, place.p, place.n, wi, true).density.value;
    EXPECT_NEAR(known.escaped<float>(0, place.p, place.n, wi, true).density.value, own, 1e-4f * own);
  }
  EXPECT_FALSE(light_cases(LightKind::disk)[0].lights.sky_light().has_value());
}

}  // namespace
}  // namespace montelux::test
