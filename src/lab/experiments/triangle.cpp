// H, "Sampling a Triangle": the second coordinate given the first.
#include "mc/triangle.h"

#include <cmath>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

// The planted fault takes the first coordinate without the root.
Vec2f point(const Setup& setup, RandomStream<float>& stream) {
  const Vec2f u = stream.next2();
  return setup.fault() ? Vec2f{1 - u.x, u.x * u.y} : sample_triangle(u);
}

// Which of 8 x 8 congruent triangles: squares of the grid, cut by their diagonals.
std::size_t small_triangle(Vec2f p) {
  const double x = 8 * double(p.x), y = 8 * double(p.y);
  const double i = std::min(7.0, std::floor(x)), j = std::min(7.0, std::floor(y));
  const bool upper = x - i + (y - j) > 1 && i + j < 7;
  const auto row = std::size_t(std::min(i + j, 7.0));
  // Row r = i + j of the grid holds r + 1 lower and, below the hypotenuse, r + 1 upper triangles.
  return upper ? 36 + row * (row + 1) / 2 + std::size_t(i)
               : row * (row + 1) / 2 + std::size_t(std::min(i, double(row)));
}

Findings run(const Setup& setup) {
  const std::uint32_t samples = setup.count("samples");
  Figure scatter{"points",
                 "Points of the triangle $u, v \\ge 0$, $u + v \\le 1$.",
                 {"$u$", false, -0.03, 1.03},
                 {"$v$", false, -0.03, 1.03},
                 {},
                 true};
  Curve points{"points", Mark::points, {}, {}, {}, {}};
  std::vector<double> first, conditional, counts(64);
  for (std::uint32_t i = 0; i < samples; ++i) {
    RandomStream<float> stream = setup.stream(1, i);
    const Vec2f p = point(setup, stream);
    if (i < 1500) points.x.push_back(double(p.x)), points.y.push_back(double(p.y));
    first.push_back(double(p.x)), conditional.push_back(double(p.y) / std::max(1e-12, 1 - double(p.x)));
    counts[small_triangle(p)] += 1;
  }
  scatter.curves = {points};
  const auto u = counts_in_cells(first, 0, 1, 40), v = counts_in_cells(conditional, 0, 1, 40);
  Figure marginal{"marginal",
                  "The first coordinate, and the second as a part of what the first leaves.",
                  {"$u$, $v/(1-u)$", false, 0, 1},
                  {"density", false, {}, {}},
                  {},
                  false};
  marginal.curves = {histogram("$u$", u, 0, 1), histogram("$v/(1-u)$", v, 0, 1),
                     function_curve(
                         "$2(1-u)$", Mark::line, [](double x) { return 2 * (1 - x); }, 0, 1, false, 2)};
  Findings findings;
  findings.sections = {scatter, marginal};
  findings.checks = {counts_check("The first coordinate has the density $2(1-u)$.", u,
                                  cell_probabilities([](double x) { return x * (2 - x); }, 0, 1, 40)),
                     counts_check("The second is uniform in what is left.", v, std::vector<double>(40, 1.0 / 40)),
                     counts_check("64 congruent triangles are hit alike.", counts, std::vector<double>(64, 1.0 / 64))};
  return findings;
}

}  // namespace

const Experiment triangle{
    .name = "triangle",
    .title = "Points of a triangle",
    .group = group_h,
    .question =
        "The two coordinates of a uniform point of a triangle depend on each other. The first is drawn by its "
        "marginal density, the second by its density given the first. Are the points uniform?",
    .formula =
        R"(p(u) = 2\int_0^{1-u}dv = 2(1-u)\;\Rightarrow\;u = 1-\sqrt{U_1},\qquad p(v\,|\,u) = \frac1{1-u}\;\Rightarrow\;v = \sqrt{U_1}\,U_2)",
    .source = "CS348B lecture 6, Sampling a Triangle",
    .fault = "the first coordinate without the root",
    .knobs = {{{"samples", 200000, "points"}}},
    .checks = 3,
    .run = run};

}  // namespace montelux::lab
