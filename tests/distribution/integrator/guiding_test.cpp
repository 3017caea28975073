// The field of path guiding draws directions with the density that it states, for one lane and for a pack.
#include <gtest/gtest.h>

#include "light/direction_field.h"
#include "statistics.h"

namespace montelux::test {
namespace {

// Tables as training makes them: a bright cell, dark ones, and one that is even.
GuideField field_of_three() {
  std::vector<GuideField::Table> tables(3);
  RandomStream<float> r(5, 1);
  for (std::uint32_t c = 0; c < GuideField::cells; ++c) {
    const float u = r.next();
    tables[0].weights[c] = u < 0.3f ? 0.0f : u * u;
    tables[1].weights[c] = c == 77 ? 40.0f : c == 78 ? 15.0f : 0.02f;
  }
  for (std::size_t i = 0; i < 3; ++i) tables[i].share = 0.25f * float(i + 1);
  return GuideField(PlaceTree{}, tables);
}

FieldSite<float> site(const GuideField& field, std::uint32_t table) { return {table, field.share(table)}; }

// Chi-square of what a table draws, on cells half as wide as its own, against a density.
template <class DensityFunction>
double p_value(const GuideField& field, std::uint32_t table, DensityFunction density) {
  constexpr int side = 2 * int(GuideField::side), count = 400000;
  std::vector<double> observed(side * side), expected(side * side);
  RandomStream<float> r(3, 11 + table);
  for (int i = 0; i < count; ++i) {
    const Vec2f at = square_from_sphere(field.sample(site(field, table), r.next2()).wi);
    const auto part = [](float x) { return std::min(int(x * float(side)), side - 1); };
    observed[std::size_t(part(at.y) * side + part(at.x))] += 1;
  }
  for (int i = 0; i < side * side; ++i) {
    const Vec2f middle{(float(i % side) + 0.5f) / float(side), (float(i / side) + 0.5f) / float(side)};
    expected[std::size_t(i)] =
        count * 4 * std::numbers::pi / (side * side) * double(density(sphere_from_square(middle)));
  }
  // The map may round a direction at the border of an empty cell into it.
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (expected[i] == 0 && observed[i] <= 2) observed[i] = 0;
  return chi_square_test(observed, expected, false).p_value;
}

TEST(GuideField, sample_matches_density_and_another_density_is_found) {
  const GuideField field = field_of_three();
  const double level = sidak_level(family_level, 3);
  for (std::uint32_t t = 0; t < 3; ++t) {
    SCOPED_TRACE(t);
    const auto density = [&](Vec3f w) { return field.density(site(field, t), w).value; };
    EXPECT_GT(p_value(field, t, density), level);
    if (t != 1) {  // which draws nearly all from two cells
      EXPECT_LT(p_value(field, t, [&](Vec3f w) { return density(w) * (1 + 0.05f * w.z); }), level);
    }
    if (t < 2) {
      EXPECT_LT(p_value(field, t, [&](Vec3f w) { return density({w.y, w.x, w.z}); }), level);
    }
  }
}

// The mean of 1 / density is the solid angle of the sphere, whatever the table: a wrong Jacobian is found.
TEST(GuideField, densities_are_per_steradian) {
  const GuideField field = field_of_three();
  for (std::uint32_t t : {1u, 2u}) {
    RandomStream<float> r(6, t);
    std::vector<double> inverse;
    for (int i = 0; i < 100000; ++i)
      inverse.push_back(1 / double(field.sample(site(field, t), r.next2()).density.value));
    const auto p_value = [&](double truth) {
      const SampleSummary s = summarize(inverse);
      return std::abs(s.mean - truth) < 1e-5 * truth ? 1.0 : t_test(s, truth).p_value;
    };
    EXPECT_GT(p_value(4 * std::numbers::pi), family_level / 2);
    EXPECT_LT(p_value(2 * std::numbers::pi), family_level / 2);
  }
}

TEST(GuideField, densities_integrate_to_one) {
  const GuideField field = field_of_three();
  constexpr auto n = GuideField::side;
  for (std::uint32_t t = 0; t < 3; ++t) {
    double sum = 0;
    for (std::uint32_t c = 0; c < GuideField::cells; ++c) {
      const Vec2f middle{(float(c % n) + 0.5f) / float(n), (float(c / n) + 0.5f) / float(n)};
      const Vec3f w = sphere_from_square(middle);
      EXPECT_EQ(GuideField::cell_of(w), c);
      sum += double(field.density(site(field, t), w).value) * 4 * std::numbers::pi / GuideField::cells;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

TEST(GuideField, states_the_density_of_what_it_draws) {
  const GuideField field = field_of_three();
  RandomStream<float> r(9, 2);
  int at_borders = 0;
  for (int i = 0; i < 100000; ++i) {
    const FieldSite<float> at = site(field, std::uint32_t(i % 3));
    const FieldDirection<float> drawn = field.sample(at, r.next2());
    EXPECT_GT(drawn.density.value, 0);
    // Rounding may move a direction into the next cell.
    at_borders += field.density(at, drawn.wi).value != drawn.density.value;
  }
  EXPECT_LT(at_borders, 20);
}

TEST(GuideField, draws_the_same_in_every_lane_as_alone) {
  using F = NativeFloats;
  const GuideField field = field_of_three();
  RandomStream<float> r(2, 7);
  for (int i = 0; i < 2000; ++i) {
    FieldSite<F> at{Uint<F>(0u), F(0.0f)};
    Vec2<F> u{F(0.0f), F(0.0f)};
    for (int k = 0; k < lanes_of<F>; ++k) {
      set_lane(at.table, k, std::uint32_t(r.next() * 3)), set_lane(at.share, k, 0.5f);
      set_lane(u.x, k, r.next()), set_lane(u.y, k, r.next());
    }
    const FieldDirection<F> drawn = field.sample(at, u);
    const Density<SolidAngle, F> density = field.density(at, drawn.wi);
    for (int k = 0; k < lanes_of<F>; ++k) {
      const FieldSite<float> alone{lane(at.table, k), 0.5f};
      const FieldDirection<float> one = field.sample(alone, {lane(u.x, k), lane(u.y, k)});
      EXPECT_EQ(one.wi.x, lane(drawn.wi.x, k));
      EXPECT_EQ(one.wi.y, lane(drawn.wi.y, k));
      EXPECT_EQ(one.wi.z, lane(drawn.wi.z, k));
      EXPECT_EQ(one.density.value, lane(drawn.density.value, k));
      EXPECT_EQ(field.density(alone, one.wi).value, lane(density.value, k));
    }
  }
}

}  // namespace
}  // namespace montelux::test
