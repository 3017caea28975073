// Files of measured materials, tabulated from a closed form: a Lambertian part and a lobe of GGX facets. In double
// precision, and with a warp of its own (by bisection), so that nothing here depends on what reads such files.
#pragma once
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace montelux::test {

struct Direction {
  double x, y, z;
};
inline Direction direction_of(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}
inline double dot(Direction a, Direction b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct ClosedLobe {
  double alpha_x = 0.4, alpha_y = 0.4;  // of the facets, by which the table is also parametrised
  std::array<double, 3> diffuse{}, glossy{};
  std::array<std::complex<double>, 3>
      index{};       // eta + i k, whose Fresnel reflectance is a factor of glossy; zero: none
  double grain = 0;  // azimuth of the direction of alpha_x

  // Walter et al. 2007, and Heitz 2014 for the two roughnesses and the masking.
  double ndf(Direction w) const {
    const Direction m = along_grain(w);
    const double x = m.x / alpha_x, y = m.y / alpha_y, s = x * x + y * y + m.z * m.z;
    return 1 / (std::numbers::pi * alpha_x * alpha_y * s * s);
  }
  // The projected area of the facets: the cosine times 1 + Lambda.
  double sigma(Direction v) const {
    const Direction w = along_grain(v);
    const double x = alpha_x * w.x, y = alpha_y * w.y;
    return 0.5 * (std::abs(w.z) + std::sqrt(w.z * w.z + x * x + y * y));
  }
  Direction along_grain(Direction w) const {
    const double c = std::cos(grain), s = std::sin(grain);
    return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
  }
  // f cos over D / (4 sigma): of the facets that are seen, the part that is lit, and the Lambertian part.
  std::array<double, 3> value(Direction wo, Direction wi, Direction m) const {
    const double o = sigma(wo) / std::max(std::abs(wo.z), 1e-9), i = sigma(wi) / std::max(std::abs(wi.z), 1e-9);
    const double lit = o / (o + i - 1);
    const double flat = std::max(wi.z, 0.0) / std::numbers::pi * 4 * sigma(wo) / ndf(m);
    std::array<double, 3> all{};
    for (std::size_t c = 0; c < 3; ++c) all[c] = glossy[c] * fresnel(dot(wo, m), index[c]) * lit + diffuse[c] * flat;
    return all;
  }
  static double fresnel(double cosine, std::complex<double> eta) {
    if (eta == 0.0) return 1;
    const std::complex<double> inside = std::sqrt(1.0 - (1 - cosine * cosine) / (eta * eta));
    return 0.5 * (std::norm((cosine - eta * inside) / (cosine + eta * inside)) +
                  std::norm((eta * cosine - inside) / (eta * cosine + inside)));
  }
  // f cos, for directions above the surface.
  std::array<double, 3> f_cos(Direction wo, Direction wi) const {
    Direction m{wo.x + wi.x, wo.y + wi.y, wo.z + wi.z};
    const double length = std::sqrt(dot(m, m));
    m = {m.x / length, m.y / length, m.z / length};
    std::array<double, 3> all = value(wo, wi, m);
    for (double& x : all) x *= ndf(m) / (4 * sigma(wo));
    return all;
  }
};

// A tensor file, field by field.
class TensorFile {
 public:
  void add(const std::string& name, const std::vector<std::uint64_t>& sizes, const std::vector<float>& values) {
    add(name, 10, sizes, std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
  }
  void add(const std::string& name, std::uint8_t type, const std::vector<std::uint64_t>& sizes, std::string data) {
    fields_.push_back({name, type, sizes, std::move(data)});
  }
  std::string bytes() const {
    std::size_t offset = 18;
    for (const Field& f : fields_) offset += 13 + f.name.size() + 8 * f.sizes.size();
    std::string text("tensor_file\0\1\0", 14);
    put(text, std::uint32_t(fields_.size()));
    for (const Field& f : fields_) {
      put(text, std::uint16_t(f.name.size()));
      text += f.name;
      put(text, std::uint16_t(f.sizes.size())), put(text, f.type), put(text, std::uint64_t(offset));
      for (std::uint64_t size : f.sizes) put(text, size);
      offset += f.data.size();
    }
    for (const Field& f : fields_) text += f.data;
    return text;
  }

 private:
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::uint64_t> sizes;
    std::string data;
  };
  template <class T>
  static void put(std::string& text, T x) {
    text.append(reinterpret_cast<const char*>(&x), sizeof x);
  }
  std::vector<Field> fields_;
};

// The map from uniform numbers to a density that is bilinear between the points of a grid: y by its marginal, then x.
class GridWarp {
 public:
  GridWarp(std::vector<double> f, int width, int height) : f_(std::move(f)), width_(width), height_(height) {
    for (int j = 0; j < height; ++j) {
      double sum = 0;
      for (int i = 0; i + 1 < width; ++i) sum += 0.5 * (at(i, j) + at(i + 1, j));
      rows_.push_back(sum);
    }
  }

  std::pair<double, double> operator()(double u, double v) const {
    const double y = solve(height_, v, [&](int j) { return rows_[std::size_t(j)]; });
    const int j = std::min(int(y * (height_ - 1)), height_ - 2);
    const double t = y * (height_ - 1) - j;
    const double x = solve(width_, u, [&](int i) { return (1 - t) * at(i, j) + t * at(i, j + 1); });
    return {x, y};
  }

 private:
  double at(int i, int j) const { return f_[std::size_t(j * width_ + i)]; }
  // The place below which there is the part u of the integral of a function that is linear between n points.
  template <class Values>
  static double solve(int n, double u, Values values) {
    std::vector<double> f, below{0};
    for (int i = 0; i < n; ++i) f.push_back(values(i));
    for (int i = 0; i + 1 < n; ++i) below.push_back(below.back() + 0.5 * (f[std::size_t(i)] + f[std::size_t(i) + 1]));
    double low = 0, high = n - 1;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const auto i = std::min(std::size_t(middle), std::size_t(n - 2));
      const double t = middle - double(i), part = f[i] * t + 0.5 * (f[i + 1] - f[i]) * t * t;
      (below[i] + part < u * below.back() ? low : high) = middle;
    }
    return low / (n - 1);
  }

  std::vector<double> f_, rows_;
  int width_, height_;
};

struct Tabulation {
  int elevations = 9, azimuths = 1;                     // of the outgoing direction
  int facets = 32, values = 24;                         // points along each side of the grids
  int parts = 1;                                        // 2 or 4: the azimuths are a half or a quarter of the circle
  bool divided = true;                                  // what the field "jacobian" states
  std::vector<double> wavelengths{};                    // instead of RGB: the first channel times `spectrum`
  std::function<double(double wavelength)> spectrum{};  // at a wavelength in nm
  double azimuth_fault = 0;                             // planted: by how much the stated azimuths are off
};

inline std::string measured_file(const ClosedLobe& lobe, const Tabulation& t) {
  constexpr double pi = std::numbers::pi;
  const auto place = [](int i, int n) { return double(i) / (n - 1); };
  const auto half_vector = [&](double x, double y, double zero) {
    return direction_of(x * x * pi / 2, (2 * y - 1) * pi + zero);
  };
  std::vector<float> theta, phi;
  for (int e = 0; e < t.elevations; ++e)
    theta.push_back(float(t.elevations > 1 ? 0.99 * pi / 2 * place(e, t.elevations) : 0.0));
  for (int a = 0; a < t.azimuths; ++a)
    phi.push_back(float(t.azimuths > 1 ? -pi + 2 * pi / t.parts * place(a, t.azimuths) : 0.0));

  std::vector<float> ndf, sigma, vndf, luminance, values;
  for (int j = 0; j < t.facets; ++j)
    for (int i = 0; i < t.facets; ++i) {
      const Direction m = half_vector(place(i, t.facets), place(j, t.facets), 0);
      ndf.push_back(float(lobe.ndf(m))), sigma.push_back(float(lobe.sigma(m)));
    }
  const std::size_t channels = t.spectrum ? t.wavelengths.size() : 3;
  for (const float azimuth : phi)
    for (const float elevation : theta) {
      const double zero = t.azimuths > 1 ? 0.0 : double(azimuth);
      const Direction wo = direction_of(double(elevation), double(azimuth) + t.azimuth_fault);
      std::vector<double> seen;
      for (int j = 0; j < t.facets; ++j)
        for (int i = 0; i < t.facets; ++i) {
          const double x = place(i, t.facets);
          const Direction m = half_vector(x, place(j, t.facets), zero);
          seen.push_back(lobe.ndf(m) * std::max(0.0, dot(wo, m)) * x * std::sin(x * x * pi / 2));
          vndf.push_back(float(seen.back()));
          seen.back() = double(vndf.back());
        }
      const GridWarp warp(std::move(seen), t.facets, t.facets);
      std::vector<std::array<double, 3>> grid;
      for (int j = 0; j < t.values; ++j)
        for (int i = 0; i < t.values; ++i) {
          const auto [x, y] = warp(place(i, t.values), place(j, t.values));
          const Direction m = half_vector(x, y, zero);
          const double c = 2 * dot(wo, m);
          const Direction wi{c * m.x - wo.x, c * m.y - wo.y, c * m.z - wo.z};
          std::array<double, 3> v = lobe.value(wo, wi, m);
          if (!t.divided)
            for (double& one : v) one *= lobe.ndf(m) / (4 * lobe.sigma(wo));
          grid.push_back(v);
          luminance.push_back(float((v[0] + v[1] + v[2]) / 3));
        }
      for (std::size_t channel = 0; channel < channels; ++channel)
        for (const auto& v : grid)
          values.push_back(float(t.spectrum ? v[0] * t.spectrum(t.wavelengths[channel]) : v[channel]));
    }

  const auto facets = std::uint64_t(t.facets), side = std::uint64_t(t.values);
  const std::uint64_t a = phi.size(), e = theta.size();
  TensorFile file;
  file.add("description", 1, {4}, "test");
  file.add("theta_i", {e}, theta), file.add("phi_i", {a}, phi);
  file.add("ndf", {facets, facets}, ndf), file.add("sigma", {facets, facets}, sigma);
  file.add("vndf", {a, e, facets, facets}, vndf), file.add("luminance", {a, e, side, side}, luminance);
  if (t.spectrum) file.add("wavelengths", {channels}, {t.wavelengths.begin(), t.wavelengths.end()});
  file.add(t.spectrum ? "spectra" : "rgb", {a, e, channels, side, side}, values);
  file.add("jacobian", 1, {1}, std::string(1, t.divided ? '\1' : '\0'));
  return file.bytes();
}

}  // namespace montelux::test
