// Which materials may be mirrors or smooth glass, by what the models state of themselves.
#include "scene/smoothness.h"

#include <gtest/gtest.h>

#include <map>

namespace montelux {
namespace {

// What holds of the materials of a set of one.
struct Smoothness {
  bool any, partly, plain;
  bool operator==(const Smoothness&) const = default;
};
Smoothness smoothness_of(const Material& material) {
  const MaterialSet set({material}, nullptr);
  return {may_be_smooth(set, 0), may_be_partly_smooth(set, 0), is_plain_specular(set, 0)};
}

// A material of the kind whose parameters all have the value.
Material made_of(BsdfKind kind, float value) {
  Material material;
  material.kind = kind;
  std::fill_n(material.row.v, bsdf_row_size, value);
  if (kind == kind_of<Measured>) put_address<MeasuredTable>(nullptr, material.row.v + MeasuredSlots::table);
  return material;
}

constexpr Smoothness rough{false, false, false};

TEST(Smoothness, is_that_of_each_model_with_and_without_roughness) {
  constexpr Smoothness mirror{true, false, true}, partly{true, true, false};
  // Of materials whose parameters are all zero; others are rough.
  const std::map<std::string_view, Smoothness> expected{
      {"conductor", mirror},         {"dielectric", mirror},
      {"tinteddielectric", mirror},  {"thindielectric", mirror},
      {"coateddiffuse", partly},     {"coatedconductor", {true, false, false}},  // a mirror under smooth glass
      {"metallicroughness", partly}, {"coatedmetallicroughness", partly}};
  for (std::size_t i = 0; i < bsdf_kind_count; ++i) {
    const auto kind = BsdfKind(i);
    const auto listed = expected.find(name(kind));
    EXPECT_EQ(smoothness_of(made_of(kind, 0)), listed == expected.end() ? rough : listed->second) << name(kind);
    EXPECT_EQ(smoothness_of(made_of(kind, 0.3f)), rough) << name(kind);
  }
}

TEST(Smoothness, of_textured_roughness_is_that_of_no_roughness) {
  Material metal = made_of(kind_of<Conductor>, 0.3f);
  metal.bindings.push_back({ConductorSlots::alpha_y, RowEncoding::plain, false, 0, 1});
  EXPECT_TRUE(smoothness_of(metal).any);
  metal.bindings.front().slot = ConductorSlots::k;
  EXPECT_FALSE(smoothness_of(metal).any);
}

TEST(Smoothness, of_facets_under_a_rough_coat_does_not_matter_unless_the_coat_has_no_index) {
  Material metal = made_of(kind_of<CoatedConductor>, 0.3f);
  metal.row.v[LayeredSlots::eta] = 1.5f;
  metal.row.v[CoatedConductorSlots::conductor_alpha_x] = metal.row.v[CoatedConductorSlots::conductor_alpha_y] = 0;
  for (int i = 0; i < spectrum_size; ++i) metal.row.v[LayeredSlots::albedo + i] = 0;
  EXPECT_EQ(smoothness_of(metal), rough);
  metal.row.v[LayeredSlots::eta] = 1;
  EXPECT_EQ(smoothness_of(metal), (Smoothness{true, false, false}));
}

TEST(Smoothness, a_normal_map_makes_a_mirror_that_is_not_plain) {
  Material mirror = made_of(kind_of<Conductor>, 0);
  mirror.normal_texture = SpectrumTextureId{};
  EXPECT_EQ(smoothness_of(mirror), (Smoothness{true, false, false}));
}

TEST(Parameters, of_a_surface_matter_where_u_and_v_differ) {
  for (std::size_t i = 0; i < bsdf_kind_count; ++i)
    if (BsdfKind(i) != kind_of<CoatedMetallicRoughness>) {
      EXPECT_FALSE(uses_parameters(made_of(BsdfKind(i), 0.3f))) << name(BsdfKind(i));
    }
  Material brushed = made_of(kind_of<CoatedConductor>, 0.3f);
  brushed.row.v[CoatedConductorSlots::conductor_alpha_y] = 0.1f;
  EXPECT_TRUE(uses_parameters(brushed));
  EXPECT_TRUE(uses_parameters(made_of(kind_of<CoatedMetallicRoughness>, 0.3f)));
}

}  // namespace
}  // namespace montelux
