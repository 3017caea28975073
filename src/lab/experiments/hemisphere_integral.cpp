// K, equations 14.12 to 14.17; the slips of K, H and B about the same integral.
#include <cmath>
#include <numbers>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/hemisphere.h"

namespace montelux::lab {

namespace {

using std::numbers::pi;

// One sample of the integral of cos over the hemisphere, from two random numbers.
struct Technique {
  const char* name;
  double (*sample)(Vec2f u);
  double variance;
};

double by_angles(Vec2f u) {
  const double theta = 0.5 * pi * double(u.x);
  return std::cos(theta) * std::sin(theta) * (0.5 * pi) * (2 * pi);
}
double by_solid_angle(Vec2f u) {
  const Vec3f w = sample_hemisphere(u);
  return double(w.z) / double(hemisphere_density(w.z).value);
}
double by_cosine(Vec2f u) {
  // At the rim of the disk both vanish, and their ratio is the same still.
  const float z = max(sample_cosine_hemisphere(u).z, 1e-20f);
  return double(z) / double(cosine_hemisphere_density(z).value);
}
double as_printed(Vec2f u) { return double(sample_hemisphere(u).z) * pi; }

const Technique techniques[]{{"uniform in $(\\theta, \\phi)$, $p = 1/\\pi^2$", by_angles, pi* pi* pi* pi / 8 - pi* pi},
                             {"uniform in solid angle, $p = 1/(2\\pi)$", by_solid_angle, pi* pi / 3},
                             {"uniform in projected solid angle, $p = \\cos\\theta/\\pi$", by_cosine, 0},
                             {"as printed: uniform directions with the factor $\\pi$", as_printed, pi* pi / 12}};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Table table{"techniques", "Mean and variance of one sample.", {"directions", "mean", "variance", "expected"}, {}};
  Figure running{"running",
                 "One realisation of each estimator against the number of samples.",
                 {"samples $N$", true, {}, {}},
                 {"estimate", false, 0, 5},
                 {},
                 false};
  std::vector<Spread> spreads;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const auto sample = setup.fault() && k == 1 ? as_printed : techniques[k].sample;
    const auto values = realisations(setup, k, samples, [&](auto& stream) { return sample(stream.next2()); });
    const Spread s = spread_of(values);
    spreads.push_back(s);
    table.rows.push_back({techniques[k].name, with_error(s.mean, s.mean_error),
                          with_error(s.variance, s.variance_error), techniques[k].variance});
    Curve curve{techniques[k].name, Mark::line, {}, {}, {}, {}};
    double sum = 0, next = 1;
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 20000); ++i) {
      sum += values[i];
      if (double(i + 1) < next) continue;
      curve.x.push_back(double(i + 1)), curve.y.push_back(sum / double(i + 1));
      next = std::max(next + 1, next * 1.04);
    }
    running.curves.push_back(curve);
  }
  running.curves.push_back(function_curve(
      "$\\pi$", Mark::dashes, [](double) { return pi; }, 1, 20000, true, 2));
  Findings findings;
  findings.sections = {running, table};
  // Of the cosine only the rounding of single precision is left.
  findings.checks = {mean_check("Uniform angles give $\\pi$.", spreads[0], pi),
                     variance_check("Their variance is $\\pi^4/8 - \\pi^2$.", spreads[0], techniques[0].variance),
                     mean_check("Uniform directions give $\\pi$.", spreads[1], pi),
                     variance_check("Their variance is $\\pi^2/3$.", spreads[1], techniques[1].variance),
                     exact_check("Directions by the cosine give $\\pi$ with every sample.",
                                 std::abs(spreads[2].mean - pi) < 1e-6 && spreads[2].variance < 1e-12,
                                 "to the rounding of single precision"),
                     rejected(mean_check("Uniform directions with the factor $\\pi$, as printed, do not give $\\pi$.",
                                         spreads[3], pi)),
                     rejected(mean_check("The integral is not 1, as printed beside equation 14.16.", spreads[0], 1))};
  return findings;
}

}  // namespace

const Experiment hemisphere_integral{
    .name = "hemisphere-integral",
    .title = "An integral over the hemisphere",
    .group = group_k,
    .question =
        "The irradiance under a uniform sky of radiance 1 is $\\pi$. Which directions estimate it best? Three slips of "
        "the documents meet here: the integral of $\\cos\\theta\\sin\\theta$ is $\\pi$ and not 1 (which is why the "
        "density carries $1/\\pi$); uniform directions have the density $1/(2\\pi)$ and not $1/\\pi$; so their "
        "estimator carries the factor $2\\pi$ and not $\\pi$, which belongs to the projected solid angle.",
    .formula =
        R"(\int_0^{2\pi}\!\!\int_0^{\pi/2}\cos\theta\,\sin\theta\,d\theta\,d\phi = \pi,\qquad \hat I = \frac1N\sum_{i=1}^N\frac{\cos\theta_i\,\sin\theta_i}{p(\theta_i,\phi_i)})",
    .source = "Rendering, equations 14.12 to 14.17; CS348B lecture 6, directional sampling; Bulant, uniform density",
    .fault = "uniform directions with the factor pi that the lecture prints",
    .knobs = {{{"samples", 200000, "samples of each technique"}}},
    .checks = 7,
    .run = run};

}  // namespace montelux::lab
