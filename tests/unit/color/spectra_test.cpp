#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "color/illuminant.h"
#include "color/named_spectra.h"
#include "color/tables.h"

namespace montelux {
namespace {

void expect_chromaticity(const SampledSpectrum& light, double x, double y, double tolerance) {
  Chromaticity c = chromaticity(to_xyz(light));
  EXPECT_NEAR(c.x, x, tolerance);
  EXPECT_NEAR(c.y, y, tolerance);
}

TEST(Observer, integrals_are_the_published_ones) {
  // CIE 15:2004, sums of the table at 1 nm.
  double x = 0.0, y = 0.0, z = 0.0;
  for (double w = 360.0; w <= 830.0; w += 1.0) {
    Xyz m = color_matching(w);
    x += m.x;
    y += m.y;
    z += m.z;
  }
  EXPECT_NEAR(x / 106.865469, 1.0, 2e-5);
  EXPECT_NEAR(y / 106.856895, 1.0, 2e-5);
  EXPECT_NEAR(z / 106.892251, 1.0, 2e-5);
  EXPECT_EQ(color_matching(555.0).y, 1.0);
  EXPECT_EQ(color_matching(359.0).y, 0.0);
  EXPECT_NEAR(mean_luminance(constant_spectrum(1.0)), 1.0f, 1e-5f);
}

TEST(Illuminants, standard_tables_come_out_of_their_formulas) {
  struct Row {
    double wavelength, a, d50, d65;
  };
  // CIE 15:2004 tables T.1 and T.3.
  for (Row r :
       {Row{380, 9.79510, 24.488, 49.9755}, Row{400, 14.7080, 49.308, 82.7549}, Row{450, 33.0859, 87.247, 117.008},
        Row{500, 59.8611, 95.724, 109.354}, Row{560, 100.0, 100.0, 100.0}, Row{600, 129.043, 97.688, 90.0062},
        Row{700, 198.261, 91.604, 71.6091}, Row{780, 241.675, 78.274, 63.3828}}) {
    EXPECT_NEAR(standard_a().at(r.wavelength), r.a, 1e-3);
    EXPECT_NEAR(standard_d50().at(r.wavelength), r.d50, 0.06);
    EXPECT_NEAR(standard_d65().at(r.wavelength), r.d65, 1e-3);
  }
}

TEST(Illuminants, chromaticities_are_the_published_ones) {
  expect_chromaticity(standard_a(), 0.44757, 0.40745, 5e-5);
  expect_chromaticity(standard_d50(), 0.34567, 0.35850, 1e-4);
  expect_chromaticity(standard_d60(), 0.32168, 0.33767, 2e-4);
  expect_chromaticity(standard_d65(), 0.31272, 0.32903, 5e-5);
  expect_chromaticity(constant_spectrum(1.0), 1.0 / 3.0, 1.0 / 3.0, 5e-5);
  // CIE 15:2004 table T.7, illuminants F1 to F12.
  const double fluorescent[12][2] = {{0.3131, 0.3371}, {0.3721, 0.3751}, {0.4091, 0.3941}, {0.4402, 0.4031},
                                     {0.3138, 0.3452}, {0.3779, 0.3882}, {0.3129, 0.3292}, {0.3458, 0.3586},
                                     {0.3741, 0.3727}, {0.3458, 0.3588}, {0.3805, 0.3769}, {0.4370, 0.4042}};
  for (int i = 0; i < 12; ++i) {
    // As the standard sums them: over 5 nm, without interpolation.
    Xyz sum;
    for (const auto& row : fluorescent_table()) {
      Xyz m = color_matching(row[0]);
      double power = row[std::size_t(i) + 1];
      sum = {sum.x + power * m.x, sum.y + power * m.y, sum.z + power * m.z};
    }
    Chromaticity c = chromaticity(sum);
    EXPECT_NEAR(c.x, fluorescent[i][0], 6e-5) << i;
    EXPECT_NEAR(c.y, fluorescent[i][1], 6e-5) << i;
  }
}

TEST(Illuminants, d65_is_the_white_of_srgb) {
  SampledSpectrum light = standard_d65();
  Rgb white = to_rgb_emission(scaled(light, photometric_scale(light)));
  for (float c : white.c) EXPECT_NEAR(c, 1.0f, 5e-4f);
}

TEST(Blackbody, peak_follows_the_displacement_law_of_wien) {
  for (double kelvin : {1500.0, 3000.0, 6500.0, 20000.0}) {
    double peak = 2.897771955e-3 / kelvin * 1e9;
    double at_peak = planck_radiance(peak, kelvin);
    for (double factor : {0.9, 0.999, 1.001, 1.1}) EXPECT_LT(planck_radiance(peak * factor, kelvin), at_peak);
  }
  SampledSpectrum sun = blackbody(5000.0);
  EXPECT_NEAR(*std::max_element(sun.values.begin(), sun.values.end()), 1.0, 1e-5);
}

TEST(Blackbody, radiance_integrates_to_the_law_of_stefan_and_boltzmann) {
  double kelvin = 4000.0, sum = 0.0;
  // Substitution w = exp(u): smooth, and as good as zero at both ends.
  const double step = 0.01;
  for (double u = std::log(50.0); u < std::log(5e6); u += step) {
    double w = std::exp(u);
    sum += planck_radiance(w, kelvin) * w * 1e-9 * step;
  }
  EXPECT_NEAR(sum * 3.14159265358979324 / (5.670374419e-8 * std::pow(kelvin, 4)), 1.0, 1e-5);
}

TEST(Blackbody, chromaticities_lie_on_the_published_locus) {
  // Wyszecki and Stiles (1982), table 1(3.11), to four places on the scale c2 = 1.4388e-2.
  expect_chromaticity(blackbody(2000.0), 0.5267, 0.4133, 2e-4);
  expect_chromaticity(blackbody(5000.0), 0.3451, 0.3516, 2e-4);
  expect_chromaticity(blackbody(10000.0), 0.2807, 0.2884, 2e-4);
}

TEST(NamedSpectra, every_name_gives_a_finite_spectrum_and_no_other_name_does) {
  std::vector<std::string_view> names = named_spectra();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(names.size(), 40u);
  for (std::string_view name : names) {
    std::optional<SampledSpectrum> s = named_spectrum(name);
    ASSERT_TRUE(s) << name;
    ASSERT_EQ(s->wavelengths.size(), s->values.size());
    EXPECT_TRUE(std::is_sorted(s->wavelengths.begin(), s->wavelengths.end()));
    for (double value : s->values) EXPECT_TRUE(std::isfinite(value) && value >= 0.0) << name;
    bool light = name.find("illum") != name.npos;
    EXPECT_TRUE(!light || std::fabs(mean_luminance(*s) - 1.0f) < 1e-6f) << name;
  }
  for (const char* name : {"", "glass-", "metal-Fe-eta", "metal-Ag", "stdillum-F13", "stdillum-", "D65"})
    EXPECT_FALSE(named_spectrum(name)) << name;
}

TEST(NamedSpectra, glasses_have_the_index_of_the_catalogue) {
  const std::pair<const char*, double> table[] = {
      {"glass-BK7", 1.51680},   {"glass-BAF10", 1.67003},  {"glass-FK51A", 1.48656},
      {"glass-LASF9", 1.85025}, {"glass-F5", 1.67270},     {"glass-F10", 1.72825},
      {"glass-F11", 1.78472},   {"metal-MgO-eta", 1.7375}, {"metal-TiO2-eta", 2.6142}};
  for (auto [name, index] : table)
    EXPECT_NEAR(named_spectrum(name)->at(587.5618), index, std::string_view(name).find("glass") == 0 ? 5e-5 : 2e-4)
        << name;
  // Abbe numbers (Schott): dispersion between the lines F and C.
  auto abbe = [](const char* name) {
    SampledSpectrum s = *named_spectrum(name);
    return (s.at(587.5618) - 1.0) / (s.at(486.1327) - s.at(656.2725));
  };
  EXPECT_NEAR(abbe("glass-BK7"), 64.17, 0.1);
  EXPECT_NEAR(abbe("glass-F11"), 25.76, 0.05);
}

TEST(Conductor, metals_reflect_as_published_measurements_say) {
  struct Row {
    const char* metal;
    double wavelength, reflectance;
  };
  // Evaporated films at normal incidence: Hass in the American Institute of Physics Handbook (1972), table 6g. Copper's
  // absorption edge at 590 nm is left out, where samples differ.
  for (Row r : {Row{"Ag", 500, 0.979}, Row{"Ag", 700, 0.990}, Row{"Al", 500, 0.918}, Row{"Al", 600, 0.911},
                Row{"Au", 500, 0.477}, Row{"Au", 600, 0.919}, Row{"Au", 700, 0.970}, Row{"Cu", 500, 0.600},
                Row{"Cu", 650, 0.966}, Row{"Cu", 700, 0.975}}) {
    std::string name = std::string("metal-") + r.metal;
    double eta = named_spectrum(name + "-eta")->at(r.wavelength), k = named_spectrum(name + "-k")->at(r.wavelength);
    EXPECT_NEAR(normal_reflectance(eta, k), r.reflectance, 0.04) << name << ' ' << r.wavelength;
  }
}

TEST(Conductor, colors_of_metals_are_the_published_ones_at_normal_incidence) {
  struct Row {
    const char* metal;
    float r, g, b;
  };
  // Akenine-Moller et al., Real-Time Rendering (2018), table 9.2, linear; values above one are cut to one here.
  // Measured samples differ from each other by some hundredths, in blue most of all.
  for (Row row : {Row{"Ag", 0.972f, 0.960f, 0.915f}, Row{"Al", 0.913f, 0.922f, 0.924f}, Row{"Au", 1.0f, 0.782f, 0.344f},
                  Row{"Cu", 0.955f, 0.638f, 0.538f}}) {
    std::string name = std::string("metal-") + row.metal;
    ConductorRgb metal = conductor_rgb(*named_spectrum(name + "-eta"), *named_spectrum(name + "-k"));
    float truth[3] = {row.r, row.g, row.b};
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(normal_reflectance(metal.eta.c[i], metal.k.c[i]), truth[i], 0.065) << name << ' ' << i;
  }
}

TEST(Conductor, components_reflect_what_the_spectrum_does) {
  SampledSpectrum eta = *named_spectrum("metal-CuZn-eta"), k = *named_spectrum("metal-CuZn-k");
  Rgb seen = to_rgb_reflectance(
      sample_spectrum([&](double w) { return normal_reflectance(eta.held_at(w), k.held_at(w)); }, 1.0));
  ConductorRgb metal = conductor_rgb(eta, k);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(normal_reflectance(metal.eta.c[i], metal.k.c[i]), seen.c[i], 1e-5);
  EXPECT_GT(seen.c[0], seen.c[1]);
  EXPECT_GT(seen.c[1], seen.c[2]);
}

TEST(Conductor, constant_index_comes_back_as_it_is) {
  ConductorRgb metal = conductor_rgb(constant_spectrum(0.2), constant_spectrum(3.0));
  ConductorRgb clear = conductor_rgb(constant_spectrum(1.5), constant_spectrum(0.0));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(metal.eta.c[i], 0.2f, 1e-5f);
    EXPECT_NEAR(metal.k.c[i], 3.0f, 1e-3f);
    EXPECT_NEAR(clear.eta.c[i], 1.5f, 1e-4f);
    EXPECT_NEAR(clear.k.c[i], 0.0f, 2e-3f);
  }
}

TEST(SampledSpectrum, is_linear_between_samples_and_zero_or_held_outside) {
  SampledSpectrum s{{400.0, 500.0, 600.0}, {1.0, 3.0, 2.0}};
  EXPECT_DOUBLE_EQ(s.at(450.0), 2.0);
  EXPECT_DOUBLE_EQ(s.at(600.0), 2.0);
  EXPECT_EQ(s.at(399.9), 0.0);
  EXPECT_EQ(s.at(600.1), 0.0);
  EXPECT_DOUBLE_EQ(s.held_at(300.0), 1.0);
  EXPECT_DOUBLE_EQ(s.held_at(700.0), 2.0);
  EXPECT_DOUBLE_EQ((SampledSpectrum{{500.0}, {4.0}}.held_at(510.0)), 4.0);
  EXPECT_EQ(SampledSpectrum{}.at(500.0), 0.0);
}

TEST(SampledSpectrum, gray_reflectances_are_gray_and_saturated_ones_stay_in_range) {
  Rgb half = to_rgb_reflectance(constant_spectrum(0.5));
  for (float c : half.c) EXPECT_NEAR(c, 0.5f, 1e-6f);
  Rgb unbounded = to_rgb_unbounded(constant_spectrum(7.0));
  for (float c : unbounded.c) EXPECT_NEAR(c, 7.0f, 1e-5f);
  Rgb red = to_rgb_reflectance({{600.0, 601.0, 830.0}, {0.0, 1.0, 1.0}});
  EXPECT_GT(red.c[0], 0.5f);
  EXPECT_EQ(red.c[2], 0.0f);
  // Light is not cut: a laser line lies outside of sRGB.
  Rgb laser = to_rgb_emission({{519.0, 520.0, 521.0}, {0.0, 1.0, 0.0}});
  EXPECT_LT(laser.c[0], 0.0f);
}

// The sum of weights and values, for a spectrum that is linear between samples.
TEST(ReflectanceWeights, give_the_colour_of_the_reflectance) {
  std::vector<double> wavelengths, values;
  for (double w = 360; w <= 1000; w += 20) wavelengths.push_back(w), values.push_back(0.5 + 0.3 * std::sin(0.02 * w));
  const std::vector<Rgb> weights = reflectance_weights(wavelengths);
  ASSERT_EQ(weights.size(), wavelengths.size());
  const auto colour = [&](auto value) {
    Rgb sum{};
    for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * float(value(i));
    return sum;
  };
  const Rgb expected = to_rgb_reflectance({wavelengths, values}),
            found = colour([&](std::size_t i) { return values[i]; }), white = colour([](std::size_t) { return 3; }),
            shifted = colour([&](std::size_t i) { return values[i > 0 ? i - 1 : 0]; });
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found.c[c], expected.c[c], 1e-5f);
    EXPECT_NEAR(white.c[c], 3, 1e-5f);  // values above one are kept
  }
  EXPECT_GT(std::abs(shifted.c[0] - expected.c[0]), 0.01f);
}

}  // namespace
}  // namespace montelux
