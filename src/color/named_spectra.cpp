#include "color/named_spectra.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "color/illuminant.h"
#include "color/tables.h"

namespace montelux {
namespace {

constexpr std::string_view names[] = {
    "glass-BAF10",  "glass-BK7",      "glass-F10",    "glass-F11",     "glass-F5",      "glass-FK51A",
    "glass-LASF9",  "glass-SF10",     "glass-SF11",   "glass-SF5",     "illum-acesD60", "metal-Ag-eta",
    "metal-Ag-k",   "metal-Al-eta",   "metal-Al-k",   "metal-Au-eta",  "metal-Au-k",    "metal-Cu-eta",
    "metal-Cu-k",   "metal-CuZn-eta", "metal-CuZn-k", "metal-MgO-eta", "metal-MgO-k",   "metal-TiO2-eta",
    "metal-TiO2-k", "stdillum-A",     "stdillum-D50", "stdillum-D65",  "stdillum-F1",   "stdillum-F10",
    "stdillum-F11", "stdillum-F12",   "stdillum-F2",  "stdillum-F3",   "stdillum-F4",   "stdillum-F5",
    "stdillum-F6",  "stdillum-F7",    "stdillum-F8",  "stdillum-F9"};

// Removes the prefix from the text if it is present.
bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (text.substr(0, prefix.size()) != prefix) return false;
  text.remove_prefix(prefix.size());
  return true;
}

bool take_suffix(std::string_view& text, std::string_view suffix) {
  if (text.size() < suffix.size() || text.substr(text.size() - suffix.size()) != suffix) return false;
  text.remove_suffix(suffix.size());
  return true;
}

double sellmeier(const GlassRow& glass, double wavelength) {
  double w2 = wavelength * wavelength * 1e-6, square = 1.0;
  for (std::size_t i = 0; i < 6; i += 2) square += glass.values[i] * w2 / (w2 - glass.values[i + 1]);
  return std::sqrt(square);
}

std::optional<SampledSpectrum> glass_index(std::string_view name) {
  // The format omits the S of the dense flints.
  if (name == "F5") name = "SF5";
  if (name == "F10") name = "SF10";
  if (name == "F11") name = "SF11";
  for (const GlassRow& glass : glass_table())
    if (glass.name == name) return sample_spectrum([&](double w) { return sellmeier(glass, w); });
  return std::nullopt;
}

double oxide_index(const OxideRow& oxide, double wavelength) {
  const auto& [a, b, c, d] = oxide.values;
  double w2 = wavelength * wavelength * 1e-6;
  return std::sqrt(a + b / (w2 - c) + d * w2);
}

std::optional<SampledSpectrum> metal_constant(std::string_view name) {
  bool is_eta = take_suffix(name, "-eta");
  if (!is_eta && !take_suffix(name, "-k")) return std::nullopt;
  for (const MetalTable& metal : metal_tables()) {
    if (metal.name != name) continue;
    SampledSpectrum s;
    for (const std::array<double, 3>& row : metal.rows) {
      s.wavelengths.push_back(row[0]);
      s.values.push_back(is_eta ? row[1] : row[2]);
    }
    return s;
  }
  for (const OxideRow& oxide : oxide_table())
    if (oxide.name == name) return sample_spectrum([&](double w) { return is_eta ? oxide_index(oxide, w) : 0.0; });
  return std::nullopt;
}

std::optional<SampledSpectrum> fluorescent(std::string_view number) {
  std::size_t column = 0;
  auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), column);
  if (error != std::errc() || end != number.data() + number.size() || column < 1 || column > 12) return std::nullopt;
  SampledSpectrum s;
  for (const std::array<double, 13>& row : fluorescent_table()) {
    s.wavelengths.push_back(row[0]);
    s.values.push_back(row[column]);
  }
  return s;
}

std::optional<SampledSpectrum> standard_illuminant(std::string_view name) {
  if (name == "A") return standard_a();
  if (name == "D50") return standard_d50();
  if (name == "D65") return standard_d65();
  if (take_prefix(name, "F")) return fluorescent(name);
  return std::nullopt;
}

std::optional<SampledSpectrum> illuminant(std::string_view name) {
  if (name == "illum-acesD60") return standard_d60();
  if (take_prefix(name, "stdillum-")) return standard_illuminant(name);
  return std::nullopt;
}

}  // namespace

std::optional<SampledSpectrum> named_spectrum(std::string_view name) {
  if (!std::binary_search(std::begin(names), std::end(names), name)) return std::nullopt;
  if (take_prefix(name, "glass-")) return glass_index(name);
  if (take_prefix(name, "metal-")) return metal_constant(name);
  std::optional<SampledSpectrum> light = illuminant(name);
  if (light) light = scaled(*light, photometric_scale(*light));
  return light;
}

std::vector<std::string_view> named_spectra() { return {std::begin(names), std::end(names)}; }

}  // namespace montelux
