// H, "Sampling a Circle": wrong, right, and by rejection.
#include <cmath>
#include <numbers>

#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/disk.h"
#include "mc/rejection.h"

namespace montelux::lab {

namespace {

using Map = Vec2f (*)(RandomStream<float>&);

Vec2f wrong(RandomStream<float>& stream) {
  const Vec2f u = stream.next2();
  const SinCos<float> azimuth = sin_cos_two_pi(u.x);
  return {u.y * azimuth.cos, u.y * azimuth.sin};
}
Vec2f polar(RandomStream<float>& stream) { return sample_disk_polar(stream.next2()); }
Vec2f concentric(RandomStream<float>& stream) { return sample_disk_concentric(stream.next2()); }
Vec2f by_rejection(RandomStream<float>& stream) { return sample_disk_by_rejection(stream).value; }

Figure scatter(const Setup& setup, const char* name, const char* caption, Map map, std::uint32_t purpose) {
  Figure figure{name, caption, {"$x$", false, -1.05, 1.05}, {"$y$", false, -1.05, 1.05}, {}, true};
  Curve points{"points", Mark::points, {}, {}, {}, {}};
  RandomStream<float> stream = setup.stream(purpose);
  for (int i = 0; i < 1500; ++i) {
    const Vec2f p = map(stream);
    points.x.push_back(double(p.x)), points.y.push_back(double(p.y));
  }
  figure.curves = {points};
  return figure;
}

// Counts in 8 rings and 12 sectors of equal area.
std::vector<double> cells_of_disk(const Setup& setup, std::uint32_t purpose, Map map) {
  std::vector<double> counts(96);
  RandomStream<float> stream = setup.stream(purpose);
  for (std::uint32_t i = 0; i < setup.count("samples"); ++i) {
    const Vec2f p = map(stream);
    const double r2 = double(p.x) * double(p.x) + double(p.y) * double(p.y);
    const double turn = std::atan2(double(p.y), double(p.x)) / (2 * std::numbers::pi) + 0.5;
    const auto ring = std::min<std::size_t>(7, std::size_t(8 * r2));
    counts[12 * ring + std::min<std::size_t>(11, std::size_t(12 * turn))] += 1;
  }
  return counts;
}

Curve radii(const Setup& setup, const char* name, Map map, std::uint32_t purpose) {
  const auto values = realisations(setup, purpose, setup.count("samples"), [&](auto& stream) {
    const Vec2f p = map(stream);
    return std::sqrt(double(p.x) * double(p.x) + double(p.y) * double(p.y));
  });
  return histogram(name, counts_in_cells(values, 0, 1, 40), 0, 1);
}

Findings run(const Setup& setup) {
  const Map right = setup.fault() ? wrong : polar;
  const std::vector<double> equal(96, 1.0 / 96);
  AcceptanceRate rate;
  for (std::uint32_t i = 0; i < setup.count("samples"); ++i) {
    RandomStream<float> stream = setup.stream(9, i);
    rate.add(sample_disk_by_rejection(stream));
  }
  Findings findings;
  findings.sections = {scatter(setup, "wrong", "Wrong: $r = U_2$ crowds the centre.", wrong, 1),
                       scatter(setup, "right", "Right: $r = \\sqrt{U_2}$ gives equal areas equal shares.", right, 2),
                       Figure{"radius",
                              "The radius: its density must grow as the circumference does.",
                              {"$r$", false, 0, 1},
                              {"density", false, {}, {}},
                              {radii(setup, "$r = U_2$", wrong, 3), radii(setup, "$r = \\sqrt{U_2}$", right, 4),
                               function_curve(
                                   "$2r$", Mark::line, [](double r) { return 2 * r; }, 0, 1, false, 2)},
                              false}};
  findings.checks = {
      rejected(counts_check("The map $r = U_2$ is not uniform.", cells_of_disk(setup, 5, wrong), equal)),
      counts_check("The map $r = \\sqrt{U_2}$ is uniform.", cells_of_disk(setup, 6, right), equal),
      counts_check("The concentric map is uniform.", cells_of_disk(setup, 7, concentric), equal),
      counts_check("Rejection from the square is uniform.", cells_of_disk(setup, 8, by_rejection), equal),
      z_check("Its efficiency is $\\pi/4$.", rate.efficiency(), rate.standard_error(), std::numbers::pi / 4)};
  return findings;
}

}  // namespace

const Experiment circle{
    .name = "circle",
    .title = "Points of a circle",
    .group = group_h,
    .question =
        "A uniform radius and a uniform angle do not make uniform points of a disk. The root of the random number "
        "does, the concentric map does, and so does rejection from the square about the disk.",
    .formula =
        R"(A = \int_0^{2\pi}\!\!\int_0^1 r\,dr\,d\theta = \pi,\qquad p(r) = 2r,\; P(r) = r^2 \;\Rightarrow\; r = \sqrt{U_2},\;\theta = 2\pi U_1)",
    .source = "CS348B lecture 6, Sampling a Circle",
    .fault = "the wrong map is taken for the right one",
    .knobs = {{{"samples", 100000, "points of each map"}}},
    .checks = 5,
    .run = run};

}  // namespace montelux::lab
