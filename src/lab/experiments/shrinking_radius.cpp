// Photons gathered within a radius that shrinks from frame to frame: bias and variance, both in closed form.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "integrator/photons/lookup.h"
#include "integrator/photons/sppm.h"
#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

// The density of photons on the unit square, (1 + 12 (x - 1/2)^2) / 2: it is estimated in the middle, where it is 1/2.
constexpr double truth = 0.5;
// By inversion: with v = x - 1/2 its distribution function is (1 + v + 4 v^3) / 2, and 4 s^3 + 3 s = sinh(3 asinh(s)).
double photon_place(double u) {
  return std::sinh(std::asinh(3 * std::numbers::sqrt3 * (2 * u - 1)) / 3) / std::numbers::sqrt3;
}

// Of one frame of so many photons by Epanechnikov's kernel, within a radius below 1/2. The density is quadratic, so
// that both are exact: the kernel's second moment along x is r^2 / 6, times half the second derivative, 6; the mean of
// the square is 2 / (3 pi r^2) + 1 / pi.
double bias_of_frame(double radius) { return radius * radius; }
double variance_of_frame(double radius, double photons) {
  const double square = 2 / (3 * std::numbers::pi * radius * radius) + std::numbers::inv_pi;
  const double mean = truth + bias_of_frame(radius);
  return (square - mean * mean) / photons;
}

constexpr double first_radius = 0.4;

// The radii of the first frames.
class Radii {
 public:
  Radii(double alpha, int frames) {
    for (int i = 0; i < frames; ++i) radii_.push_back(sppm_radius(first_radius, alpha, i));
  }
  double at(int frame) const { return radii_[std::size_t(frame)]; }

 private:
  std::vector<double> radii_;
};

double estimate_of_frame(RandomStream<float>& stream, double radius, std::uint32_t photons) {
  const auto squared = float(radius * radius);
  double sum = 0;
  for (std::uint32_t i = 0; i < photons; ++i) {
    const auto x = float(photon_place(double(stream.next()))), y = stream.next() - 0.5f;
    if (const float distance = x * x + y * y; distance < squared)
      sum += double(kernel_weight<float>(PhotonKernel::epanechnikov, distance, squared));
  }
  return sum / photons;
}

// The mean over the first n frames, for n = 1, 2, 4, ... up to `frames`, in each of the runs.
struct Means {
  std::vector<double> n;
  std::vector<std::vector<double>> values;  // by n, then by run
};
Means means_over_frames(const Setup& setup, std::uint32_t purpose, const Radii& radii) {
  Means means;
  const int frames = int(setup.count("frames"));
  for (int n = 1; n <= frames; n *= 2) means.n.push_back(n);
  means.values.resize(means.n.size());
  for (std::uint32_t run = 0; run < setup.count("runs"); ++run) {
    RandomStream<float> stream = setup.stream(purpose, run);
    double sum = 0;
    std::size_t look = 0;
    for (int frame = 0; frame < frames; ++frame) {
      sum += estimate_of_frame(stream, radii.at(frame), setup.count("photons"));
      if (look < means.n.size() && frame + 1 == int(means.n[look])) means.values[look++].push_back(sum / (frame + 1));
    }
  }
  return means;
}

struct Expected {
  double bias = 0, variance = 0;
};
Expected expected_over_frames(const Radii& radii, double frames, double photons) {
  Expected e;
  for (int i = 0; i < int(frames); ++i)
    e.bias += bias_of_frame(radii.at(i)) / frames,
        e.variance += variance_of_frame(radii.at(i), photons) / (frames * frames);
  return e;
}

Findings run(const Setup& setup) {
  constexpr double alpha = 2.0 / 3;
  const int frames = int(setup.count("frames"));
  const Radii shrinking(alpha, frames), constant(1, frames), used = setup.fault() ? constant : shrinking;
  const double photons = setup.count("photons");
  const Means means = means_over_frames(setup, 1, used), fixed = means_over_frames(setup, 2, constant);

  Figure figure{"error",
                "The estimate in the middle after $n$ frames: its bias and its standard deviation, and what theory "
                "says. Where the radius shrinks both fall, where it does not the bias stays.",
                {"frames", true, {}, {}},
                {"error", true, {}, {}},
                {},
                false};
  Table table{"errors",
              "Bias and standard deviation, measured and expected.",
              {"frames", "radius", "bias", "expected", "standard deviation", "expected"},
              {}};
  Curve bias{"bias, radius that shrinks", Mark::points, {}, {}, {}, {}},
      deviation{"standard deviation, radius that shrinks", Mark::points, {}, {}, {}, {}},
      stays{"bias, constant radius", Mark::points, {}, {}, {}, {}};
  const auto add = [](Curve& curve, double n, double value, double error) {
    curve.x.push_back(n), curve.y.push_back(value);
    curve.low.push_back(std::max(value - error, 0.1 * value)), curve.high.push_back(value + error);
  };
  std::vector<double> z_bias, z_variance, z_constant;
  for (std::size_t i = 0; i < means.n.size(); ++i) {
    const double n = means.n[i];
    const Spread s = spread_of(means.values[i]), f = spread_of(fixed.values[i]);
    const Expected e = expected_over_frames(shrinking, n, photons), c = expected_over_frames(constant, n, photons);
    z_bias.push_back((s.mean - truth - e.bias) / s.mean_error);
    z_variance.push_back((s.variance - e.variance) / s.variance_error);
    z_constant.push_back((f.mean - truth - c.bias) / f.mean_error);
    add(bias, n, s.mean - truth, s.mean_error), add(stays, n, f.mean - truth, f.mean_error);
    add(deviation, n, std::sqrt(s.variance), s.variance_error / (2 * std::sqrt(s.variance)));
    table.rows.push_back({n, used.at(int(n) - 1), with_error(s.mean - truth, s.mean_error), e.bias,
                          std::sqrt(s.variance), std::sqrt(e.variance)});
  }
  const auto expected_curve = [&](const Radii& radii, auto value) {
    Curve curve{"", Mark::line, means.n, {}, {}, {}};
    for (double n : means.n) curve.y.push_back(value(expected_over_frames(radii, n, photons)));
    return curve;
  };
  const auto bias_of = [](const Expected& e) { return e.bias; };
  figure.curves.push_back(bias), add_expected(figure, expected_curve(shrinking, bias_of));
  figure.curves.push_back(deviation),
      add_expected(figure, expected_curve(shrinking, [](const Expected& e) { return std::sqrt(e.variance); }));
  figure.curves.push_back(stays), add_expected(figure, expected_curve(constant, bias_of));

  const Spread last = spread_of(means.values.back());
  const double ratio = std::max(2, frames / 16);
  const Expected a = expected_over_frames(shrinking, std::floor(frames / ratio), photons),
                 b = expected_over_frames(shrinking, frames, photons);
  Findings findings;
  findings.sections = {figure, table,
                       Table{"rates",
                             "The exponents of theory: between 16 frames and all of them, and in the limit of many.",
                             {"quantity", "exponent", "limit"},
                             {{"bias", std::log(b.bias / a.bias) / std::log(ratio), alpha - 1},
                              {"variance", std::log(b.variance / a.variance) / std::log(ratio), -alpha}}}};
  findings.checks = {
      largest_deviation_check("With a radius that shrinks the bias falls as theory says.", z_bias, "numbers of frames"),
      largest_deviation_check("So does the variance.", z_variance, "numbers of frames"),
      largest_deviation_check("With a constant radius the bias stays.", z_constant, "numbers of frames"),
      rejected(mean_check("After all frames the smaller bias is not that of the constant radius.", last,
                          truth + bias_of_frame(first_radius)))};
  return findings;
}

}  // namespace

const Experiment shrinking_radius{
    .name = "shrinking-radius",
    .title = "A radius that shrinks",
    .group = group_t,
    .question =
        "Photon maps count the photons within a radius: a large one is biased, a small one noisy. Progressive photon "
        "mapping lets the radius shrink from frame to frame and takes the mean over all frames. How fast do bias and "
        "variance fall?",
    .formula =
        R"(r_{i+1}^2 = r_i^2\,\frac{i+\alpha}{i+1},\qquad \text{bias} = \frac1n\sum_i r_i^2 \sim n^{\alpha-1},\qquad V \approx \frac1{n^2}\sum_i \frac{2}{3\pi r_i^2 m} \sim n^{-\alpha})",
    .source = "Hachisuka and Jensen 2009; Knaus and Zwicker 2011",
    .fault = "the radius stays as it is in the first frame",
    .knobs = {{{"runs", 400, "independent runs"},
               {"frames", 512, "of each run"},
               {"photons", 16, "photons on the unit square in each frame"}}},
    .checks = 4,
    .run = run};

}  // namespace montelux::lab
