// Tables of measured materials against the closed forms that they were tabulated from.
#include "material/measured.h"

#include <gtest/gtest.h>

#include <random>

#include "color/sampled_spectrum.h"
#include "material/measured_file.h"
#include "measured_files.h"
#include "temporary_folder.h"

namespace montelux {
namespace {

using namespace test;

const ClosedLobe matte{0.7, 0.7, {0.8, 0.5, 0.2}, {}};
const ClosedLobe glossy{0.35, 0.35, {}, {0.9, 0.6, 0.3}};
const ClosedLobe brushed{0.3, 0.6, {0.1, 0.1, 0.1}, {0.7, 0.5, 0.3}};

MeasuredTable table_of(const ClosedLobe& lobe, const Tabulation& t) {
  Result<MeasuredData> data = read_measured_data(measured_file(lobe, t));
  if (!data) throw std::runtime_error(data.error());
  return MeasuredTable(std::move(data).value());
}

Vec3f single(Direction w) { return {float(w.x), float(w.y), float(w.z)}; }
Direction precise(Vec3f w) { return {double(w.x), double(w.y), double(w.z)}; }

// Pairs of directions above the surface, up to 75 degrees from the normal.
template <class Visit>
void for_pairs(int count, Visit visit) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> theta(0.05, 1.3), phi(-3.1, 3.1);
  for (int i = 0; i < count; ++i) {
    const double a = theta(random), b = phi(random), c = theta(random), d = phi(random);
    visit(single(direction_of(a, b)), single(direction_of(c, d)));
  }
}

// The mean difference of f cos from a closed form, over the mean of that; of the largest one among the channels.
double difference(const MeasuredTable& table, const ClosedLobe& truth) {
  std::array<double, 3> off{}, all{};
  for_pairs(4000, [&](Vec3f wo, Vec3f wi) {
    const BsdfValue<float> value = table.evaluate(wo, wi);
    const std::array<double, 3> expected = truth.f_cos(precise(wo), precise(wi));
    for (std::size_t c = 0; c < 3; ++c)
      off[c] += std::abs(double(value.f_cos[int(c)]) - expected[c]), all[c] += expected[c];
  });
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, off[c] / all[c]);
  return worst;
}

// Everything twice as fine.
Tabulation finer(Tabulation t) {
  t.elevations = 2 * t.elevations - 1, t.facets = 2 * t.facets - 1, t.values = 2 * t.values - 1;
  if (t.azimuths > 1) t.azimuths = 2 * t.azimuths - 1;
  return t;
}

// Interpolation is linear, so that its error falls with the square of the spacing.
TEST(MeasuredTable, approaches_what_was_tabulated_by_the_square_of_the_spacing) {
  struct Case {
    ClosedLobe lobe;
    Tabulation coarse;
  };
  const Case cases[] = {{matte, {.elevations = 7, .facets = 17, .values = 13}},
                        {glossy, {.elevations = 7, .facets = 17, .values = 13}},
                        {brushed, {.elevations = 5, .azimuths = 9, .facets = 17, .values = 9}}};
  for (const Case& c : cases) {
    const Tabulation middle = finer(c.coarse);
    const double a = difference(table_of(c.lobe, c.coarse), c.lobe), b = difference(table_of(c.lobe, middle), c.lobe),
                 d = difference(table_of(c.lobe, finer(middle)), c.lobe);
    EXPECT_LT(d, 0.01) << a << " " << b << " " << d;
    EXPECT_GT(a / b, 2.5) << a << " " << b << " " << d;
    EXPECT_GT(b / d, 2.5) << a << " " << b << " " << d;
    EXPECT_LT(b / d, 6) << a << " " << b << " " << d;
  }
}

const Tabulation fine{.elevations = 25, .facets = 65, .values = 49};

TEST(MeasuredTable, differs_from_other_closed_forms) {
  const MeasuredTable table = table_of(glossy, fine);
  const double own = difference(table, glossy);
  ClosedLobe rougher = glossy, brighter = glossy, turned = glossy;
  rougher.alpha_x = rougher.alpha_y = 0.37, brighter.glossy[1] *= 1.03;
  turned.glossy = {glossy.glossy[1], glossy.glossy[2], glossy.glossy[0]};
  for (const ClosedLobe& fault : {rougher, brighter, turned}) EXPECT_GT(difference(table, fault), 2.5 * own) << own;
}

TEST(MeasuredTable, has_the_azimuths_of_the_grain) {
  Tabulation t{.elevations = 13, .azimuths = 33, .facets = 49, .values = 25};
  const double own = difference(table_of(brushed, t), brushed);
  EXPECT_LT(own, 0.02);
  t.azimuth_fault = 0.1;
  EXPECT_GT(difference(table_of(brushed, t), brushed), 2.5 * own);
}

// A half of the circle states the whole if the surface is the same after half a turn; a quarter, if it has two mirrors,
// which a slanting grain has not.
TEST(MeasuredTable, completes_a_half_and_a_quarter_of_the_circle) {
  Tabulation whole{.elevations = 9, .azimuths = 33, .facets = 33, .values = 17}, half = whole, quarter = whole;
  half.azimuths = 17, half.parts = 2, quarter.azimuths = 9, quarter.parts = 4;
  ClosedLobe slanting = brushed;
  slanting.grain = 0.5;
  for (const ClosedLobe& lobe : {brushed, slanting}) {
    const double own = difference(table_of(lobe, whole), lobe), of_quarter = difference(table_of(lobe, quarter), lobe);
    EXPECT_LT(difference(table_of(lobe, half), lobe), 1.2 * own);
    if (lobe.grain == 0)
      EXPECT_LT(of_quarter, 1.2 * own);
    else
      EXPECT_GT(of_quarter, 5 * own);
  }
}

TEST(MeasuredTable, may_hold_values_that_are_not_divided_by_the_facets) {
  Tabulation t = fine;
  t.divided = false;
  EXPECT_LT(difference(table_of(matte, t), matte), 0.01);
}

// ---- colour ---------------------------------------------------------------------------------------------------------

Rgb colour_of(const std::function<double(double)>& spectrum) {
  Tabulation t = fine;
  for (double w = 360; w <= 1000; w += 5) t.wavelengths.push_back(w);
  t.spectrum = spectrum;
  const ClosedLobe white{0.7, 0.7, {1, 1, 1}, {}};
  const BsdfValue<float> value = table_of(white, t).evaluate(single(direction_of(0.3, 1)), {0, 0, 1});
  return to_rgb(value.f_cos) * pi;
}

TEST(MeasuredColour, of_a_flat_spectrum_is_grey) {
  const Rgb grey = colour_of([](double) { return 0.4; });
  for (int c = 0; c < rgb_size; ++c) EXPECT_NEAR(grey[c], 0.4, 2e-3) << c;
  EXPECT_NEAR(grey[0], grey[2], 1e-5);
}

// A spectrum that is linear between its samples, in another sampling.
TEST(MeasuredColour, is_that_of_a_surface_with_the_reflectance) {
  const auto reflectance = [](double w) { return w < 450 ? 0.3 : w < 650 ? 0.3 + (w - 450) / 400 : 0.8; };
  const Rgb expected = to_rgb_reflectance({{360, 450, 650, 1000}, {0.3, 0.3, 0.8, 0.8}}),
            found = colour_of(reflectance);
  EXPECT_GT(expected[0] - expected[2], 0.3);
  for (int c = 0; c < rgb_size; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3) << c;
  const Rgb shifted = colour_of([&](double w) { return reflectance(w + 20); });
  EXPECT_GT(std::abs(shifted[1] - expected[1]), 0.02);
}

// Beyond the gamut of sRGB there is light of no negative component.
TEST(MeasuredColour, of_one_wavelength_is_not_negative) {
  const Rgb green = colour_of([](double w) { return std::abs(w - 510) < 6 ? 1.0 : 0.0; });
  EXPECT_EQ(green[0], 0);
  EXPECT_GT(green[1], 0.01);
}

// ---- the model ------------------------------------------------------------------------------------------------------

TEST(MeasuredModel, keeps_the_address_of_its_table) {
  const std::uint64_t all = ~std::uint64_t(0);
  for (const std::uint64_t address : {std::uint64_t(0), std::uint64_t(0x7ffd1234abcd5678), all, all - 0x400000}) {
    float slots[AddressSlots::size];
    put_address(reinterpret_cast<const MeasuredTable*>(std::uintptr_t(address)), slots);
    for (float slot : slots) EXPECT_TRUE(slot >= 0 && slot < float(1 << AddressSlots::bits));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(address_in<MeasuredTable>(slots)), address);
  }
}

TEST(MeasuredModel, reflects_alike_on_both_sides_and_transmits_nothing) {
  const MeasuredTable table = table_of(brushed, {.elevations = 5, .azimuths = 13});
  BsdfRow row;
  put_address(&table, row.v);
  const Measured<float> model(BsdfRows<float>{&row});
  for_pairs(200, [&](Vec3f wo, Vec3f wi) {
    const BsdfValue<float> above = model.evaluate(wo, wi, {}), below = model.evaluate(-wo, -wi, {});
    EXPECT_EQ(above.f_cos[1], below.f_cos[1]);
    EXPECT_EQ(above.density.value, below.density.value);
    EXPECT_EQ(model.evaluate(wo, -wi, {}).f_cos[1], 0);
    EXPECT_EQ(model.evaluate(wo, -wi, {}).density.value, 0);
  });
}

// The value at wi that importance has is the value of radiance on the way back, at the same cosine.
TEST(MeasuredModel, scatters_importance_as_radiance_on_the_way_back) {
  const MeasuredTable table = table_of(brushed, {.elevations = 3, .azimuths = 7, .facets = 9, .values = 5});
  const BsdfContext<float> importance{TransportMode::importance, {}};
  BsdfRow row;
  put_address(&table, row.v);
  const Measured<float> model(BsdfRows<float>{&row});
  int differs = 0;
  for_pairs(200, [&](Vec3f wo, Vec3f wi) {
    const BsdfValue<float> there = model.evaluate(wo, wi, importance), back = model.evaluate(wi, wo, {});
    EXPECT_EQ(there.density.value, model.evaluate(wo, wi, {}).density.value);
    for (int c = 0; c < rgb_size; ++c)
      EXPECT_NEAR(there.f_cos[c] / wi.z, back.f_cos[c] / wo.z, 1e-5f * back.f_cos[c] / wo.z);
    differs += std::abs(there.f_cos[0] / model.evaluate(wo, wi, {}).f_cos[0] - 1) > 0.02f;
  });
  EXPECT_GT(differs, 50);  // so coarse a table is not reciprocal
}

TEST(MeasuredModel, is_black_without_a_table) {
  const BsdfRow row;
  const Measured<float> model(BsdfRows<float>{&row});
  EXPECT_EQ(model.evaluate({0, 0, 1}, {0, 0, 1}, {}).f_cos[0], 0);
  EXPECT_FALSE(model.sample({0, 0, 1}, 0.5f, {0.5f, 0.5f}, {}).valid);
}

// ---- files ----------------------------------------------------------------------------------------------------------

const Tabulation tiny{.elevations = 2, .azimuths = 3, .facets = 3, .values = 2};

// The error of such a file; an empty text if it is read.
std::string error_of(const std::string& bytes) {
  const Result<MeasuredData> data = read_measured_data(bytes);
  return data ? "" : data.error();
}

TEST(MeasuredFile, that_is_cut_short_is_an_error) {
  const std::string whole = measured_file(brushed, tiny);
  EXPECT_EQ(error_of(whole), "");
  for (std::size_t length = 0; length < whole.size(); length += length < 600 ? 1 : 16)
    EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
  EXPECT_NE(error_of(whole.substr(0, 40)).find("ends at byte 40"), std::string::npos);
  EXPECT_NE(error_of(whole.substr(0, whole.size() - 1)).find("field 'jacobian'"), std::string::npos);
}

// Whatever is read gives finite values.
TEST(MeasuredFile, that_is_damaged_is_an_error_or_a_table) {
  const std::string whole = measured_file(brushed, tiny);
  std::mt19937 random(3);
  int errors = 0, tables = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string bytes = whole;
    for (int k = 0; k <= i % 3; ++k) {
      // Mostly in the list of fields.
      const std::size_t at = random() % (i % 2 ? bytes.size() : 560);
      bytes[at] = i % 4 < 2 ? char(random() & 255) : char(bytes[at] ^ (1 << (random() & 7)));
    }
    Result<MeasuredData> data = read_measured_data(bytes);
    if (!data) {
      EXPECT_FALSE(data.error().empty());
      ++errors;
      continue;
    }
    ++tables;
    const MeasuredTable table(std::move(data).value());
    for (const Vec3f wo : {Vec3f{0, 0, 1}, single(direction_of(0.7, -2)), single(direction_of(1.57, 3))})
      for (const Vec2f u : {Vec2f{0, 0}, Vec2f{0.3f, 0.6f}, Vec2f{one_minus_epsilon, one_minus_epsilon}}) {
        const Vec3f wi = table.sample(wo, u).wi;
        ASSERT_NEAR(length(wi), 1, 1e-4f);
        if (!(wi.z > 0)) continue;
        const BsdfValue<float> value = table.evaluate(wo, wi);
        ASSERT_TRUE(is_finite(value.f_cos[0]) && is_finite(value.density.value) && value.density.value >= 0);
      }
  }
  EXPECT_GT(errors, 1000);
  EXPECT_GT(tables, 1000);
}

// The fields of a tiny table of an isotropic surface, of which one is replaced.
std::string tiny_file(const std::string& changed, const std::vector<std::uint64_t>& sizes,
                      const std::vector<float>& values) {
  TensorFile file;
  const auto add = [&](const std::string& name, const std::vector<std::uint64_t>& usual, float value) {
    std::size_t count = 1;
    for (std::uint64_t size : usual) count *= size;
    if (name == changed)
      file.add(name, sizes, values);
    else
      file.add(name, usual, std::vector<float>(count, value));
  };
  add("theta_i", {1}, 0), add("phi_i", {1}, 0), add("ndf", {2, 2}, 1), add("sigma", {2, 2}, 1);
  add("vndf", {1, 1, 2, 2}, 1), add("luminance", {1, 1, 2, 2}, 1), add("rgb", {1, 1, 3, 2, 2}, 1);
  file.add("jacobian", 1, {1}, "\1");
  return file.bytes();
}

TEST(MeasuredFile, states_which_field_is_wrong) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(tiny_file("", {}, {})), "");
  const auto error = [](const std::string& name, const std::vector<std::uint64_t>& sizes,
                        const std::vector<float>& values) { return error_of(tiny_file(name, sizes, values)); };
  EXPECT_EQ(error("theta_i", {2}, {0.5f, 0.5f}), "field 'theta_i' does not increase at element 1");
  EXPECT_EQ(error("theta_i", {1}, {2}), "element 0 of field 'theta_i' is 2; it should be from 0 to 1.572");
  EXPECT_EQ(error("ndf", {2, 2}, {1, 1, nan, 1}), "element 2 of field 'ndf' is nan");
  EXPECT_EQ(error("sigma", {2, 2}, {1e10f, 1, 1, 1}), "element 0 of field 'sigma' is 10000000000");
  EXPECT_EQ(error("sigma", {0, 2}, {}), "field 'sigma' is empty");
  EXPECT_EQ(error("ndf", {4}, {1, 1, 1, 1}), "field 'ndf' should have 2 dimensions; it has 1");
  EXPECT_EQ(error("vndf", {1, 2, 2, 1}, {1, 1, 1, 1}),
            "field 'vndf' is 1 x 2 x 2 x 1; it should be 1 x 1 x height x width");
  EXPECT_EQ(error("vndf", {1, 1, 4, 1}, {1, 1, 1, 1}),
            "field 'vndf' is 1 x 1 x 4 x 1; a grid should have at least 2 x 2 points");
  EXPECT_EQ(error("luminance", {1, 1, 2, 3}, {1, 1, 1, 1, 1, 1}),
            "the grids of fields 'rgb' and 'luminance' differ: 1 x 1 x 3 x 2 x 2 and 1 x 1 x 2 x 3");
  EXPECT_EQ(error("ndf", {1, 65537}, std::vector<float>(65537)),
            "field 'ndf' is 1 x 65537; at most 65536 points along a side are read");
  // A part of the circle that is none of the three, and the whole circle from elsewhere.
  for (const std::vector<float>& azimuths :
       {std::vector<float>{0, 1, 2}, {0, pi, 2 * pi}, {-pi, -0.9f * pi, -0.8f * pi}})
    EXPECT_NE(error("phi_i", {3}, azimuths).find("it should begin at -pi and be the whole circle"), std::string::npos);
}

TEST(MeasuredFile, of_a_huge_stated_size_is_an_error) {
  for (const std::uint64_t size :
       {std::uint64_t(1) << 20, std::uint64_t(1) << 40, std::uint64_t(1) << 62, ~std::uint64_t(0)})
    for (const std::vector<std::uint64_t>& sizes :
         {std::vector<std::uint64_t>{size}, {size, size}, {2, size}, {size, size, size, size, size}})
      EXPECT_NE(error_of(tiny_file("theta_i", sizes, {0, 1})).find("goes beyond the end of the file"),
                std::string::npos);
}

TEST(MeasuredFile, is_named_by_the_error) {
  const TemporaryFolder folder;
  const std::string file = folder.write("cut.bsdf", measured_file(brushed, tiny).substr(0, 40));
  const auto table = read_measured_table(file);
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().find("cut.bsdf' is not a table of a measured material: the file ends at byte 40"),
            std::string::npos)
      << table.error();
  EXPECT_FALSE(read_measured_table(folder.path() + "/none.bsdf"));
  EXPECT_FALSE(read_measured_table(folder.path()));
  EXPECT_TRUE(read_measured_table(folder.write("whole.bsdf", measured_file(brushed, tiny))));
}

}  // namespace
}  // namespace montelux
