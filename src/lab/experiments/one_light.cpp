// B: one light of varying size, by uniform, cosine and light sampling.
#include <cmath>
#include <numbers>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/hemisphere.h"

namespace montelux::lab {

namespace {

using std::numbers::pi;

// A disk of radiance 1 straight above, at height 1, seen under the half angle alpha.
struct Disk {
  double cos;
  double sin2() const { return (1 - cos) * (1 + cos); }
  double irradiance() const { return pi * sin2(); }
};

// The planted fault takes the density 1/pi for uniform directions, as the text prints it.
double by_uniform(const Disk& disk, Vec2f u, bool fault) {
  const double z = double(sample_hemisphere(u).z);
  return z < disk.cos ? 0 : z * (fault ? pi : 2 * pi);
}
double by_cosine(const Disk& disk, Vec2f u, bool) { return double(sample_cosine_hemisphere(u).z) < disk.cos ? 0 : pi; }
double by_solid_angle(const Disk& disk, Vec2f u, bool) {
  const float below = float(1 - disk.cos);
  return double(sample_cone(below, u).z) / double(cone_density(below).value);
}
double by_area(const Disk& disk, Vec2f u, bool) {
  const double tan2 = disk.sin2() / (disk.cos * disk.cos), d2 = 1 + tan2 * double(u.x);
  return pi * tan2 / (d2 * d2);
}

// The second moment of one sample: the integral of (cos)^2 / p over the directions to the light.
double uniform_moment(const Disk& d) { return 4 * pi * pi / 3 * (1 - std::pow(d.cos, 3)); }
double cosine_moment(const Disk& d) { return pi * pi * d.sin2(); }
double solid_angle_moment(const Disk& d) { return 4 * pi * pi / 3 * (1 - d.cos) * (1 - std::pow(d.cos, 3)); }
double area_moment(const Disk& d) {
  const double tan2 = d.sin2() / (d.cos * d.cos);
  return pi * pi * tan2 / 3 * (1 - std::pow(1 + tan2, -3));
}

struct Technique {
  const char* name;
  double (*sample)(const Disk&, Vec2f, bool);
  double (*second_moment)(const Disk&);
};
constexpr Technique techniques[]{{"uniform directions", by_uniform, uniform_moment},
                                 {"directions by the cosine", by_cosine, cosine_moment},
                                 {"directions to the light", by_solid_angle, solid_angle_moment},
                                 {"points of the light", by_area, area_moment}};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Figure figure{"variance",
                "Variance of one sample, relative to the squared irradiance, against the half angle of the "
                "light. Lines: theory.",
                {"half angle of the light (degrees)", true, {}, {}},
                {"relative variance", true, 1e-5, 1e4},
                {},
                false};
  Findings findings;
  std::uint32_t purpose = 1;
  for (const Technique& technique : techniques) {
    Curve curve{technique.name, Mark::points, {}, {}, {}, {}};
    std::vector<double> z_mean, z_variance;
    const auto theory = [&](double degrees) {
      const Disk disk{std::cos(degrees * pi / 180)};
      return technique.second_moment(disk) / std::pow(disk.irradiance(), 2) - 1;
    };
    for (double degrees : {5.0, 10.0, 20.0, 35.0, 50.0, 65.0, 80.0}) {
      const Disk disk{std::cos(degrees * pi / 180)};
      const Spread s = spread_of(realisations(setup, purpose++, samples, [&](auto& stream) {
        return technique.sample(disk, stream.next2(), setup.fault()) / disk.irradiance();
      }));
      curve.x.push_back(degrees), curve.y.push_back(s.variance);
      curve.low.push_back(s.variance - s.variance_error), curve.high.push_back(s.variance + s.variance_error);
      z_mean.push_back((s.mean - 1) / s.mean_error),
          z_variance.push_back((s.variance - theory(degrees)) / s.variance_error);
    }
    figure.curves.push_back(curve);
    add_expected(figure, function_curve("theory", Mark::line, theory, 4, 85, true, 80));
    findings.checks.push_back(deviations_check("Unbiased at every size: " + std::string(technique.name) + ".", z_mean));
    findings.checks.push_back(
        deviations_check("The variance is that of theory: " + std::string(technique.name) + ".", z_variance));
  }
  findings.sections = {figure};
  return findings;
}

}  // namespace

const Experiment one_light{
    .name = "one-light",
    .title = "One light of varying size",
    .group = group_b,
    .question =
        "The irradiance of one light can be estimated by uniform directions, by directions after the cosine, or by "
        "sampling the light, in area or in solid angle. For small lights most directions miss; for large ones the area "
        "form suffers from its geometry factor. How do their variances compare as the light grows?",
    .formula =
        R"(E = \int_{H}L_i\cos\theta\,d\omega = \pi\sin^2\alpha,\qquad V = \int\frac{\cos^2\theta}{p(\omega)}\,d\omega - E^2,\qquad p = \frac1{2\pi},\;\frac{\cos\theta}\pi,\;\frac1{\Omega},\;\frac{d^2}{A\cos\theta'})",
    .source = "Bulant, Monte Carlo integrování, estimators of irradiance (whose uniform density is 1/(2π), not 1/π)",
    .fault = "uniform directions with the density 1/pi that the text prints",
    .knobs = {{{"samples", 60000, "samples of each technique and size"}}},
    .checks = 8,
    .run = run};

}  // namespace montelux::lab
