// H, "Examples": the floor under a square light behind a blocker, by every pattern of sampling that the lecture shows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/experiments/floor_scene.h"
#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/moments.h"

namespace montelux::lab {

namespace {

struct Case {
  const char* name;
  Pattern pattern;
  std::uint32_t eye_rays, shadow_rays;
  Sampling sampling = Sampling::area;
  bool biased = false;  // known to be
};

constexpr Case cases[]{{"fixed", Pattern::fixed, 4, 1, Sampling::area, true},
                       {"random", Pattern::random, 4, 1},
                       {"uniform grid", Pattern::grid, 4, 16, Sampling::area, true},
                       {"stratified", Pattern::stratified, 4, 16},
                       {"quasi-random", Pattern::quasi_random, 4, 16},
                       {"random", Pattern::random, 4, 16},
                       {"uniform grid", Pattern::grid, 4, 64, Sampling::area, true},
                       {"stratified", Pattern::stratified, 4, 64},
                       {"uniform grid", Pattern::grid, 4, 100, Sampling::area, true},
                       {"stratified", Pattern::stratified, 4, 100},
                       {"projected solid angle, random", Pattern::random, 4, 100, Sampling::projected_solid_angle},
                       {"area, random", Pattern::random, 4, 100},
                       {"solid angle, random", Pattern::random, 4, 100, Sampling::solid_angle},
                       {"quasi-random", Pattern::quasi_random, 4, 100},
                       {"random", Pattern::random, 64, 1}};

// What the passes of one case come to.
struct Outcome {
  double mse = 0, efficiency = 0;
  Spread error;  // of the mean over the picture, a value for each pixel
  Spread bias2;  // the squared bias of a pixel, estimated without bias
  Picture picture;
};

Outcome measure(const Setup& setup, const Case& c, const FloorScene& scene, const std::vector<double>& truth,
                std::uint32_t number) {
  const std::uint32_t passes = std::max(2u, setup.count("passes")), size = scene.size;
  std::vector<double> first(truth.size());
  std::vector<Moments> pixels(truth.size());
  Outcome outcome;
  const FloorSettings settings{c.pattern, c.sampling, c.eye_rays, c.shadow_rays, setup.fault()};
  for (std::uint32_t pass = 0; pass < passes; ++pass)
    for (std::uint32_t i = 0; i < truth.size(); ++i) {
      const double value = scene.pixel(settings, i, setup.seed() + 1000 * number, pass);
      if (pass == 0) first[i] = value;
      pixels[i].add(value);
      outcome.mse += (value - truth[i]) * (value - truth[i]) / double(truth.size() * passes);
    }
  std::vector<double> errors, squares;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    errors.push_back(pixels[i].mean - truth[i]);
    squares.push_back(errors.back() * errors.back() - pixels[i].variance() / passes);
  }
  outcome.error = spread_of(errors), outcome.bias2 = spread_of(squares);
  outcome.efficiency = 1 / (outcome.mse * c.eye_rays * (1 + c.shadow_rays));
  const double highest = *std::max_element(truth.begin(), truth.end());
  outcome.picture = gray_picture(first, int(size), highest);
  outcome.picture.caption = fmt::format("{}\nE = {}, S = {}\nMSE {:.2e}, efficiency {:.0f}", c.name, c.eye_rays,
                                        c.shadow_rays, outcome.mse, outcome.efficiency);
  return outcome;
}

Findings run(const Setup& setup) {
  const FloorScene scene{setup.count("pixels")};
  const std::vector<double> truth = scene.reference();
  Images images{"floor",
                "The floor seen from above, brightest where it sees the whole light. E eye rays a pixel, S shadow "
                "rays for each; the mean square error is against the closed form, the efficiency one over error "
                "times rays.",
                4,
                {}};
  images.pictures.push_back(gray_picture(truth, int(scene.size), *std::max_element(truth.begin(), truth.end())));
  images.pictures.back().caption = "closed form";
  Table table{"errors",
              "Errors over all passes; irradiance is in units of the light's radiance.",
              {"pattern", "E", "S", "MSE", "mean error", "efficiency"},
              {}};
  Findings findings;
  std::uint32_t number = 0;
  for (const Case& c : cases) {
    Outcome outcome = measure(setup, c, scene, truth, number++);
    table.rows.push_back({c.name, double(c.eye_rays), double(c.shadow_rays), outcome.mse,
                          with_error(outcome.error.mean, outcome.error.mean_error), outcome.efficiency});
    images.pictures.push_back(std::move(outcome.picture));
    const std::string counts = " (E = " + std::to_string(c.eye_rays) + ", S = " + std::to_string(c.shadow_rays) + ")";
    if (!c.biased)
      findings.checks.push_back(mean_check("Unbiased: " + std::string(c.name) + counts + ".", outcome.error, 0));
    else if (c.pattern == Pattern::fixed)
      findings.checks.push_back(
          rejected(mean_check("One fixed point of the light is biased" + counts + ".", outcome.bias2, 0)));
  }
  findings.sections = {images, table};
  return findings;
}

}  // namespace

const Experiment square_light{
    .name = "square-light",
    .title = "A square light behind a blocker",
    .group = group_h,
    .question =
        "The lecture shows the soft shadow of a square light by fixed, gridded, random and stratified points on it, by "
        "area and by projected solid angle, with many shadow rays or many eye rays. How large is the error of each, "
        "and what does it cost? A grid shows bands, which look worse than their mean square error says.",
    .formula =
        R"(E(x) = \int_\Omega L\cos\theta\,d\omega = \int_A L\,\frac{\cos\theta\cos\theta'}{|x-x'|^2}\,V(x,x')\,dA(x'))",
    .source = "CS348B lecture 6, Direct Lighting and Examples",
    .fault = "directions uniform in solid angle with the factor pi that the lecture prints",
    .knobs = {{{"passes", 6, "pictures of each pattern"}, {"pixels", 64, "pixels along a side"}}},
    .checks = 12,
    .run = run};

}  // namespace montelux::lab
