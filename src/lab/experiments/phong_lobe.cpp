// F, "BRDF Importance Sampling": the lobe of Phong about the mirror direction.
#include "mc/phong_lobe.h"

#include <cmath>
#include <numbers>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

constexpr std::array<float, 3> exponents{1, 10, 100};

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Figure figure{"lobes",
                "The angle to the mirror direction, for three exponents. Lines: $(n+1)\\cos^n\\alpha\\,\\sin\\alpha$.",
                {"$\\alpha$ (degrees)", false, {}, {}},
                {"density per degree", false, {}, {}},
                {},
                false};
  Findings findings;
  for (std::uint32_t k = 0; k < exponents.size(); ++k) {
    const float n = exponents[k];
    const std::string lobe = "$n = " + std::to_string(int(n)) + "$";
    std::vector<double> angles, turns;
    for (std::uint32_t i = 0; i < samples; ++i) {
      RandomStream<float> stream = setup.stream(k + 1, i);
      // The planted fault takes the root that belongs to the normalisation of the scattered light, n + 2.
      const Vec3f w = sample_phong_lobe(setup.fault() ? n + 1 : n, stream.next2());
      angles.push_back(std::acos(std::min(1.0, double(w.z))) * 180 / std::numbers::pi);
      turns.push_back(double(azimuth_fraction(w)));
    }
    const double widest = n > 50 ? 30 : n > 5 ? 75 : 90;
    const auto cdf = [&](double degrees) {
      return degrees >= widest ? 1 : 1 - std::pow(std::cos(degrees * std::numbers::pi / 180), double(n) + 1);
    };
    const auto counts = counts_in_cells(angles, 0, widest, 30);
    figure.curves.push_back(histogram(lobe, counts, 0, widest));
    add_expected(figure, function_curve(
                             "density, " + lobe, Mark::line,
                             [&](double degrees) {
                               const double alpha = degrees * std::numbers::pi / 180;
                               return (double(n) + 1) * std::pow(std::cos(alpha), double(n)) * std::sin(alpha) *
                                      std::numbers::pi / 180;
                             },
                             0, widest, false, 100));
    findings.checks.push_back(counts_check("The angle has the density of the lobe, " + lobe + ".", counts,
                                           cell_probabilities(cdf, 0, widest, 30)));
    findings.checks.push_back(counts_check("The azimuth is uniform, " + lobe + ".", counts_in_cells(turns, 0, 1, 24),
                                           std::vector<double>(24, 1.0 / 24)));
  }
  findings.sections = {figure};
  return findings;
}

}  // namespace

const Experiment phong_lobe{
    .name = "phong-lobe",
    .title = "Sampling the lobe of Phong",
    .group = group_f,
    .question =
        "A specular lobe $\\cos^n\\alpha$ about the mirror direction is sampled by inversion. Do the directions have "
        "its "
        "density for blunt and for sharp lobes? The lobe is sampled with the constant $(n+1)/2\\pi$; the $(n+2)/2\\pi$ "
        "of the "
        "scattering function normalises it with a cosine more.",
    .formula =
        R"(p(\alpha,\phi) = \frac{n+1}{2\pi}\cos^n\alpha\,\sin\alpha\;\Rightarrow\;\alpha = \cos^{-1}\bigl(z^{1/(n+1)}\bigr),\quad \phi = 2\pi u)",
    .source = "COS 526, BRDF Importance Sampling; Lafortune and Willems 1994",
    .fault = "the root n + 2 in place of n + 1",
    .knobs = {{{"samples", 100000, "directions of each lobe"}}},
    .checks = 6,
    .run = run};

}  // namespace montelux::lab
