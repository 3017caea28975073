#include "color/sampled_spectrum.h"

#include <algorithm>
#include <cmath>

#include "color/illuminant.h"
#include "color/tables.h"

namespace montelux {
namespace {

constexpr double nanometre = 1.0;

// Calls f(wavelength, colour-matching functions there) at every nanometre.
template <class Function>
void for_each_nanometre(Function f) {
  for (double w = shortest_wavelength; w <= longest_wavelength; w += nanometre) f(w, color_matching(w));
}

// The response of red, green and blue to light of one wavelength.
Xyz primaries_response(const Matrix3& from_xyz, const Xyz& matching) { return from_xyz * matching; }

}  // namespace

double SampledSpectrum::at(double wavelength) const {
  if (wavelengths.empty() || wavelength < wavelengths.front() || wavelength > wavelengths.back()) return 0.0;
  return held_at(wavelength);
}

double SampledSpectrum::held_at(double wavelength) const {
  auto after = std::upper_bound(wavelengths.begin(), wavelengths.end(), wavelength);
  if (after == wavelengths.begin()) return values.front();
  if (after == wavelengths.end()) return values.back();
  std::size_t i = std::size_t(after - wavelengths.begin());
  double t = (wavelength - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
  return (1.0 - t) * values[i - 1] + t * values[i];
}

SampledSpectrum constant_spectrum(double value) { return {{shortest_wavelength, longest_wavelength}, {value, value}}; }

SampledSpectrum scaled(const SampledSpectrum& spectrum, double factor) {
  SampledSpectrum s = spectrum;
  for (double& value : s.values) value *= factor;
  return s;
}

Xyz color_matching(double wavelength) {
  std::span<const std::array<double, 4>> table = observer_table();
  if (wavelength < table.front()[0] || wavelength > table.back()[0]) return {};
  double place = (wavelength - table.front()[0]) / (table[1][0] - table[0][0]);
  std::size_t i = std::min(std::size_t(place), table.size() - 2);
  double t = place - double(i);
  auto between = [&](std::size_t column) { return (1.0 - t) * table[i][column] + t * table[i + 1][column]; };
  return {between(1), between(2), between(3)};
}

Xyz to_xyz(const SampledSpectrum& emission) {
  Xyz sum;
  for_each_nanometre([&](double w, const Xyz& matching) {
    double power = emission.at(w) / luminous_integral;
    sum.x += power * matching.x;
    sum.y += power * matching.y;
    sum.z += power * matching.z;
  });
  return sum;
}

Rgb to_rgb_emission(const SampledSpectrum& emission) { return to_srgb(to_xyz(emission)); }

float mean_luminance(const SampledSpectrum& emission) { return float(to_xyz(emission).y); }

double photometric_scale(const SampledSpectrum& emission) {
  double y = to_xyz(emission).y;
  return y > 0.0 ? 1.0 / y : 0.0;
}

// The colour of a reflectance under this light, relative to a perfect white.
static Rgb seen_under(const SampledSpectrum& light, const SampledSpectrum& reflectance) {
  Xyz white, seen;
  for_each_nanometre([&](double w, const Xyz& matching) {
    double power = light.at(w), reflected = power * reflectance.at(w);
    white = {white.x + power * matching.x, white.y + power * matching.y, white.z + power * matching.z};
    seen = {seen.x + reflected * matching.x, seen.y + reflected * matching.y, seen.z + reflected * matching.z};
  });
  Rgb color = to_srgb(seen), perfect = to_srgb(white);
  for (int i = 0; i < 3; ++i) color.c[i] /= perfect.c[i];
  return color;
}

Rgb to_rgb_reflectance(const SampledSpectrum& reflectance) {
  return per_component([](float x) { return std::clamp(x, 0.0f, 1.0f); }, seen_under(standard_d65(), reflectance));
}

std::vector<Rgb> reflectance_weights(const std::vector<double>& wavelengths) {
  const SampledSpectrum light = standard_d65();
  SampledSpectrum one{wavelengths, std::vector<double>(wavelengths.size())};
  std::vector<Rgb> weights;
  for (double& value : one.values) {
    value = 1;
    weights.push_back(seen_under(light, one));
    value = 0;
  }
  return weights;
}

Rgb to_rgb_unbounded(const SampledSpectrum& spectrum) {
  SampledSpectrum light = standard_d65();
  Matrix3 from_xyz = inverse(to_xyz(*color_space("srgb")));
  double sum[3] = {}, weight[3] = {};
  for_each_nanometre([&](double w, const Xyz& matching) {
    Xyz response = primaries_response(from_xyz, matching);
    double value = spectrum.held_at(w), power = light.at(w);
    double responses[3] = {response.x, response.y, response.z};
    for (int i = 0; i < 3; ++i) {
      double positive = power * std::max(responses[i], 0.0);
      sum[i] += positive * value;
      weight[i] += positive;
    }
  });
  Rgb mean;
  for (int i = 0; i < 3; ++i) mean.c[i] = float(sum[i] / weight[i]);
  return mean;
}

double normal_reflectance(double eta, double k) {
  return ((eta - 1.0) * (eta - 1.0) + k * k) / ((eta + 1.0) * (eta + 1.0) + k * k);
}

ConductorRgb conductor_rgb(const SampledSpectrum& eta, const SampledSpectrum& k) {
  SampledSpectrum reflectance =
      sample_spectrum([&](double w) { return normal_reflectance(eta.held_at(w), k.held_at(w)); }, 1.0);
  Rgb seen = to_rgb_reflectance(reflectance);
  ConductorRgb result{to_rgb_unbounded(eta), {}};
  for (int i = 0; i < 3; ++i) {
    double r = std::min(double(seen.c[i]), 0.9999), n = double(result.eta.c[i]);
    double square = (r * (n + 1.0) * (n + 1.0) - (n - 1.0) * (n - 1.0)) / (1.0 - r);
    // A real index that reflects more than that must be closer to one.
    if (square < 0.0) result.eta.c[i] = float((1.0 + std::sqrt(r)) / (1.0 - std::sqrt(r)));
    result.k.c[i] = float(std::sqrt(std::max(square, 0.0)));
  }
  return result;
}

}  // namespace montelux
