#include "image/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "image/display.h"

namespace montelux {
namespace {

// The constants of the paper: exponents and knee of the colour difference, width and exponent of the feature one.
constexpr double qc = 0.7, pc = 0.4, pt = 0.95, gw = 0.082, qf = 0.5;

struct Triple {
  double v[3];
};

// Linear sRGB to XYZ as in the paper's own code, with white D65.
constexpr double to_xyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double from_xyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                   {-0.969224334, 1.875930071, 0.041554224},
                                   {0.055639423, -0.204011202, 1.057148933}};
constexpr Triple white = {
    {(10135552.0 + 8788810 + 4435075) / 24577794, 1.0, (1425312.0 + 8788810 + 70074185) / 73733382}};

Triple transform(const double (&m)[3][3], const Triple& a) {
  Triple r;
  for (int i = 0; i < 3; ++i) r.v[i] = m[i][0] * a.v[0] + m[i][1] * a.v[1] + m[i][2] * a.v[2];
  return r;
}

// The opponent space YCxCz in which the blur of the eye is applied.
Triple to_opponent(const Triple& rgb) {
  Triple xyz = transform(to_xyz, rgb);
  double x = xyz.v[0] / white.v[0], y = xyz.v[1] / white.v[1], z = xyz.v[2] / white.v[2];
  return {{116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)}};
}

Triple from_opponent(const Triple& a) {
  double y = (a.v[0] + 16.0) / 116.0, x = a.v[1] / 500.0 + y, z = y - a.v[2] / 200.0;
  return transform(from_xyz, {{x * white.v[0], y * white.v[1], z * white.v[2]}});
}

// CIELAB with the chroma scaled by lightness (Hunt effect).
Triple to_hunt_lab(const Triple& rgb) {
  Triple xyz = transform(to_xyz, rgb);
  double f[3];
  for (int i = 0; i < 3; ++i) {
    constexpr double delta = 6.0 / 29.0;
    double t = xyz.v[i] / white.v[i];
    f[i] = t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
  }
  double lightness = 116.0 * f[1] - 16.0;
  return {{lightness, 0.01 * lightness * 500.0 * (f[0] - f[1]), 0.01 * lightness * 200.0 * (f[1] - f[2])}};
}

double hyab(const Triple& a, const Triple& b) {
  return std::fabs(a.v[0] - b.v[0]) + std::hypot(a.v[1] - b.v[1], a.v[2] - b.v[2]);
}

struct Plane {
  int width, height;
  std::vector<double> values;

  double at(int x, int y) const { return values[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
};

using Kernel = std::vector<double>;

// Correlation with the kernels along x and along y; border pixels are repeated beyond the border.
Plane convolve(const Plane& in, const Kernel& along_x, const Kernel& along_y) {
  Plane middle = in, out = in;
  int rx = int(along_x.size()) / 2, ry = int(along_y.size()) / 2;
  std::size_t i = 0;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x) {
      double sum = 0.0;
      for (int k = -rx; k <= rx; ++k)
        sum += along_x[std::size_t(k + rx)] * in.at(std::clamp(x + k, 0, in.width - 1), y);
      middle.values[i++] = sum;
    }
  i = 0;
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x) {
      double sum = 0.0;
      for (int k = -ry; k <= ry; ++k)
        sum += along_y[std::size_t(k + ry)] * middle.at(x, std::clamp(y + k, 0, in.height - 1));
      out.values[i++] = sum;
    }
  return out;
}

// One Gaussian term of a contrast sensitivity function.
struct SensitivityTerm {
  double a, b;
};

// A channel blurred according to its contrast sensitivity: a normalised sum of separable Gaussians.
Plane filter_channel(const Plane& in, const std::vector<SensitivityTerm>& terms, double pixels_per_degree) {
  constexpr double square_pi = 9.8696044010893586;
  // The widest Gaussian of all channels determines one radius for all.
  int radius = int(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * square_pi)) * pixels_per_degree));
  Plane out{in.width, in.height, std::vector<double>(in.values.size())};
  double total = 0.0;
  for (const SensitivityTerm& term : terms) {
    Kernel kernel;
    double sum = 0.0;
    for (int k = -radius; k <= radius; ++k) {
      double x = double(k) / pixels_per_degree;
      kernel.push_back(std::exp(-square_pi * x * x / term.b));
      sum += kernel.back();
    }
    double weight = term.a * std::sqrt(3.14159265358979324 / term.b);
    total += weight * sum * sum;
    Plane part = convolve(in, kernel, kernel);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] += weight * part.values[i];
  }
  for (double& value : out.values) value /= total;
  return out;
}

// Kernels that respond to edges and to points: derivatives of a Gaussian, both signs scaled to sum to one.
struct FeatureKernels {
  Kernel gaussian, edge, point;
};

void balance(Kernel& kernel) {
  double positive = 0.0, negative = 0.0;
  for (double w : kernel) (w > 0.0 ? positive : negative) += w;
  for (double& w : kernel) w /= w > 0.0 ? positive : -negative;
}

FeatureKernels feature_kernels(double pixels_per_degree) {
  double deviation = 0.5 * gw * pixels_per_degree;
  int radius = int(std::ceil(3.0 * deviation));
  FeatureKernels kernels;
  double sum = 0.0;
  for (int k = -radius; k <= radius; ++k) {
    double g = std::exp(-0.5 * k * k / (deviation * deviation));
    sum += g;
    kernels.gaussian.push_back(g);
    kernels.edge.push_back(-k * g);
    kernels.point.push_back((k * k / (deviation * deviation) - 1.0) * g);
  }
  for (double& w : kernels.gaussian) w /= sum;
  balance(kernels.edge);
  balance(kernels.point);
  return kernels;
}

// The strength of a feature at each pixel: the length of its two directional responses.
std::vector<double> feature_strength(const Plane& gray, const Kernel& derivative, const Kernel& gaussian) {
  Plane x = convolve(gray, derivative, gaussian), y = convolve(gray, gaussian, derivative);
  for (std::size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
  return std::move(x.values);
}

// What the eye perceives of one image: blurred Hunt-adjusted colours, and edges and points of the unblurred lightness.
struct Percept {
  std::vector<Triple> colors;
  std::vector<double> edges, points;
};

Percept perceive(const PixelBuffer& image, double pixels_per_degree) {
  std::array<int, 3> channels = rgb_channels(image);
  Plane planes[3];
  for (Plane& plane : planes) plane = {image.width, image.height, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      Rgb color = rgb_at(image, channels, x, y);
      Triple rgb;
      for (int c = 0; c < 3; ++c) rgb.v[c] = double(apply_curve(ToneCurve::clip, color.c[c]));
      Triple opponent = to_opponent(rgb);
      for (int c = 0; c < 3; ++c) planes[c].values.push_back(opponent.v[c]);
    }

  Percept percept;
  Plane gray = planes[0];
  for (double& value : gray.values) value = (value + 16.0) / 116.0;
  FeatureKernels kernels = feature_kernels(pixels_per_degree);
  percept.edges = feature_strength(gray, kernels.edge, kernels.gaussian);
  percept.points = feature_strength(gray, kernels.point, kernels.gaussian);

  planes[0] = filter_channel(planes[0], {{1.0, 0.0047}}, pixels_per_degree);
  planes[1] = filter_channel(planes[1], {{1.0, 0.0053}}, pixels_per_degree);
  planes[2] = filter_channel(planes[2], {{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    Triple rgb = from_opponent({{planes[0].values[i], planes[1].values[i], planes[2].values[i]}});
    for (double& v : rgb.v) v = std::clamp(v, 0.0, 1.0);
    percept.colors.push_back(to_hunt_lab(rgb));
  }
  return percept;
}

// The colour difference in [0, 1], compressed so that large differences are close to each other.
double color_difference(const Triple& a, const Triple& b) {
  static const double largest = std::pow(hyab(to_hunt_lab({{0, 1, 0}}), to_hunt_lab({{0, 0, 1}})), qc);
  double d = std::pow(hyab(a, b), qc), knee = pc * largest;
  return d < knee ? d * pt / knee : pt + (d - knee) / (largest - knee) * (1.0 - pt);
}

double luminance_at(const PixelBuffer& image, const std::array<int, 3>& channels, int x, int y) {
  return double(luminance(rgb_at(image, channels, x, y)));
}

struct ExposureRange {
  double start, stop;
  int count;
};

// From the exposure that maps the brightest pixel of the reference to 0.85 on the display to the one that maps the
// median pixel there.
ExposureRange exposures(const PixelBuffer& reference) {
  std::array<int, 3> channels = rgb_channels(reference);
  std::vector<double> y;
  for (int j = 0; j < reference.height; ++j)
    for (int i = 0; i < reference.width; ++i) {
      double l = luminance_at(reference, channels, i, j);
      if (std::isfinite(l)) y.push_back(l);
    }
  if (y.empty()) return {0.0, 0.0, 1};
  std::sort(y.begin(), y.end());
  double brightest = y.back(), median = y[y.size() / 2];
  if (y.size() % 2 == 0) median = 0.5 * (median + y[y.size() / 2 - 1]);
  if (!(brightest > 0.0)) return {0.0, 0.0, 1};
  median = std::max(median, 1e-4 * brightest);

  // The root of curve(x) = 0.85, where the curve is a quotient of quadratics with its scale 0.6 included.
  double t = 0.85, a = 0.36 * (2.51 - t * 2.43), b = 0.6 * (0.03 - t * 0.59), c = -t * 0.14;
  double x = (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  double start = std::log2(x / brightest), stop = std::log2(x / median);
  return {start, stop, std::max(2, int(std::ceil(stop - start)))};
}

PixelBuffer expose(const PixelBuffer& image, double stops) {
  PixelBuffer out = make_pixel_buffer(image.width, image.height, {"R", "G", "B"});
  std::array<int, 3> channels = rgb_channels(image);
  float scale = 0.6f * float(std::exp2(stops));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      Rgb color = rgb_at(image, channels, x, y);
      for (int c = 0; c < 3; ++c) out.at(x, y, c) = apply_curve(ToneCurve::aces, color.c[c] * scale);
    }
  return out;
}

double mean_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (float value : values) sum += double(value);
  return sum / double(values.size());
}

}  // namespace

FlipResult ldr_flip(const PixelBuffer& test, const PixelBuffer& reference, const ViewingConditions& viewing) {
  assert(test.width == reference.width && test.height == reference.height);
  Percept a = perceive(test, viewing.pixels_per_degree), b = perceive(reference, viewing.pixels_per_degree);
  FlipResult result{0.0, make_pixel_buffer(test.width, test.height, {"flip"})};
  for (std::size_t i = 0; i < test.pixel_count(); ++i) {
    double color = color_difference(a.colors[i], b.colors[i]);
    double feature = std::max(std::fabs(a.edges[i] - b.edges[i]), std::fabs(a.points[i] - b.points[i]));
    feature = std::clamp(std::pow(feature * 0.70710678118654752, qf), 0.0, 1.0);
    result.map.values[i] = float(std::pow(color, 1.0 - feature));
  }
  result.mean = mean_of(result.map.values);
  return result;
}

FlipResult hdr_flip(const PixelBuffer& test, const PixelBuffer& reference, const ViewingConditions& viewing) {
  assert(test.width == reference.width && test.height == reference.height);
  ExposureRange range = exposures(reference);
  FlipResult result{0.0, make_pixel_buffer(test.width, test.height, {"flip"})};
  for (int i = 0; i < range.count; ++i) {
    double stops = range.count == 1 ? range.start : range.start + (range.stop - range.start) * i / (range.count - 1);
    FlipResult one = ldr_flip(expose(test, stops), expose(reference, stops), viewing);
    for (std::size_t k = 0; k < one.map.values.size(); ++k)
      result.map.values[k] = std::max(result.map.values[k], one.map.values[k]);
  }
  result.mean = mean_of(result.map.values);
  return result;
}

}  // namespace montelux
