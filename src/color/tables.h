// The compiled tables of data/. The files state sources and licences; tools/check_data verifies that both agree.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace montelux {

// Wavelength (nm) and the colour-matching functions x, y and z of the CIE 1931 observer: 360 to 830 nm at 5 nm.
std::span<const std::array<double, 4>> observer_table();
// Wavelength (nm) and the CIE components S0, S1 and S2 of daylight: 300 to 830 nm at 10 nm.
std::span<const std::array<double, 4>> daylight_table();
// Wavelength (nm) and the relative power of the CIE illuminants F1 to F12: 380 to 780 nm at 5 nm.
std::span<const std::array<double, 13>> fluorescent_table();

struct MetalTable {
  std::string_view name;
  // Wavelength (nm), eta and k.
  std::span<const std::array<double, 3>> rows;
};
std::span<const MetalTable> metal_tables();

struct GlassRow {
  std::string_view name;
  // B1 C1 B2 C2 B3 C3 of Sellmeier's formula (micrometres) and the index at 587.6 nm that the catalogue states.
  std::array<double, 7> values;
};
std::span<const GlassRow> glass_table();

struct OxideRow {
  std::string_view name;
  // eta^2 = A + B / (w^2 - C) + D w^2, w in micrometres.
  std::array<double, 4> values;
};
std::span<const OxideRow> oxide_table();

}  // namespace montelux
