// K, figure 14.3; H, rejection methods: samples under a curve, and what they cost.
#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/rejection.h"

namespace montelux::lab {

namespace {

double parabola(double x) { return 6 * x * (1 - x); }

Figure proposals(const Setup& setup) {
  Figure figure{"proposals",
                "Points of the box; those below the curve are kept.",
                {"$x$", false, 0, 1},
                {"$y$", false, 0, 1.5},
                {},
                false};
  Curve kept{"accepted", Mark::points, {}, {}, {}, {}}, left{"rejected", Mark::points, {}, {}, {}, {}};
  RandomStream<float> stream = setup.stream(1);
  for (int i = 0; i < 700; ++i) {
    const Vec2f u = stream.next2();
    Curve& curve = 1.5 * double(u.y) < parabola(double(u.x)) ? kept : left;
    curve.x.push_back(double(u.x)), curve.y.push_back(1.5 * double(u.y));
  }
  figure.curves = {kept, left, function_curve("$6x(1-x)$", Mark::line, parabola, 0, 1, false, 60)};
  return figure;
}

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Curve measured{"measured", Mark::points, {}, {}, {}, {}};
  std::vector<double> z, counts;
  std::uint32_t purpose = 2;
  for (double bound : {1.5, 2.0, 3.0, 4.5, 6.0, 9.0}) {
    // The planted fault takes a box that the curve sticks out of.
    const float box = float(setup.fault() && bound == 1.5 ? 1.2 : bound);
    AcceptanceRate rate;
    const auto values = realisations(setup, purpose++, samples, [&](auto& stream) {
      const auto x = sample_under_curve([](float t) { return float(parabola(double(t))); }, box, stream);
      rate.add(x);
      return double(x.value);
    });
    if (counts.empty()) counts = counts_in_cells(values, 0, 1, 40);
    measured.x.push_back(bound), measured.y.push_back(rate.efficiency());
    measured.low.push_back(rate.efficiency() - rate.standard_error());
    measured.high.push_back(rate.efficiency() + rate.standard_error());
    z.push_back((rate.efficiency() - 1 / bound) / rate.standard_error());
  }
  Figure density{
      "density", "The accepted abscissae against the density.", {"$x$", false, {}, {}}, {"density", false, {}, {}}, {},
      false};
  density.curves = {histogram("samples", counts, 0, 1),
                    function_curve("$6x(1-x)$", Mark::line, parabola, 0, 1, false, 60)};
  Figure efficiency{"efficiency",
                    "The share of proposals that are accepted, against the height of the box.",
                    {"height of the box", true, {}, {}},
                    {"efficiency", true, {}, {}},
                    {},
                    false};
  efficiency.curves = {measured,
                       function_curve(
                           "area over area of the box", Mark::line, [](double h) { return 1 / h; }, 1.5, 9, true, 2)};
  Findings findings;
  findings.sections = {proposals(setup), density, efficiency};
  findings.checks = {counts_check("What is accepted has the density of the curve.", counts,
                                  cell_probabilities([](double x) { return x * x * (3 - 2 * x); }, 0, 1, 40)),
                     deviations_check("The efficiency is the area under the curve over that of the box.", z)};
  return findings;
}

}  // namespace

const Experiment rejection_sampling{
    .name = "rejection",
    .title = "Sampling by rejection",
    .group = group_k,
    .question =
        "Where a distribution function has no inverse, points of a box are drawn and those below the curve kept. "
        "What comes out, and how much is thrown away?",
    .formula =
        R"(\text{accept } U_1 \text{ if } h\,U_2 < p(U_1),\qquad \text{efficiency} = \frac{\int_0^1 p(x)\,dx}{h})",
    .source = "Rendering, figure 14.3; CS348B lecture 6, rejection methods",
    .fault = "a box that is too low for the curve",
    .knobs = {{{"samples", 100000, "accepted samples of each box"}}},
    .checks = 2,
    .run = run};

}  // namespace montelux::lab
