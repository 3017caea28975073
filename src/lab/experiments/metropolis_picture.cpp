// A Metropolis chain that walks on a picture: with small steps alone it stays where it began.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "lab/experiments/floor_scene.h"
#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "mc/metropolis.h"

namespace montelux::lab {

namespace {

// Two spots on the unit square: a wide dim one and a narrow bright one, which nothing connects.
struct Spot {
  double x, y, sigma, height;
  double at(double px, double py) const {
    return height * std::exp(-((px - x) * (px - x) + (py - y) * (py - y)) / (2 * sigma * sigma));
  }
  double integral(double x0, double x1, double y0, double y1) const {
    const auto part = [&](double low, double high, double middle) {
      const double scale = 1 / (sigma * std::numbers::sqrt2);
      return sigma * std::sqrt(std::numbers::pi / 2) *
             (std::erf((high - middle) * scale) - std::erf((low - middle) * scale));
    };
    return height * part(x0, x1, x) * part(y0, y1, y);
  }
};
constexpr std::array<Spot, 2> spots{{{0.3, 0.62, 0.1, 1}, {0.78, 0.25, 0.035, 6}}};

double target(double x, double y) {
  double sum = 0;
  for (const Spot& spot : spots) sum += spot.at(x, y);
  return sum;
}
// The integral over the cells of a grid, row by row; the first row is at y = 1.
std::vector<double> cell_integrals(int cells) {
  std::vector<double> values;
  for (int row = cells - 1; row >= 0; --row)
    for (int column = 0; column < cells; ++column) {
      double sum = 0;
      for (const Spot& spot : spots)
        sum += spot.integral(double(column) / cells, double(column + 1) / cells, double(row) / cells,
                             double(row + 1) / cells);
      values.push_back(sum);
    }
  return values;
}
double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum;
}
std::size_t cell_of(double x, double y, int cells) {
  return std::size_t(cells - 1 - int(y * cells)) * std::size_t(cells) + std::size_t(x * cells);
}

// Kelemen's moves: both coordinates by a small step, or with the probability `large` to a fresh point. The planted
// fault accepts every move.
struct Chain {
  RandomStream<float> stream;
  double large;
  bool fault;
  double x = 0, y = 0, value = 0;

  void step() {
    const bool far = double(stream.next()) < large;
    const auto move = [&](double at) {
      const float u = stream.next();
      return double(far ? u : moved(float(at), u, 1.0f / 1024, 1.0f / 16));
    };
    const double to_x = move(x), to_y = move(y), to = target(to_x, to_y);
    if (const double u = double(stream.next()); fault || u < metropolis_acceptance(value, to))
      x = to_x, y = to_y, value = to;
  }
  // From one of some uniform points, chosen in proportion to the target; gives their mean target, the weight of the
  // chain, with which it is without bias at every step.
  double start(int candidates) {
    double sum = 0;
    for (int i = 0; i < candidates; ++i) {
      const double cx = double(stream.next()), cy = double(stream.next()), c = target(cx, cy);
      sum += c;
      if (double(stream.next()) * sum < c) x = cx, y = cy, value = c;
    }
    return sum / candidates;
  }
};

// Mean square error of the picture of single chains, by their number of steps.
Curve errors_by_steps(const Setup& setup, double large, std::uint32_t purpose, int cells) {
  const std::vector<double> truth = cell_integrals(cells);
  const double all = sum_of(truth);
  Curve curve{"", Mark::points, {}, {}, {}, {}};
  constexpr int chains = 64;
  const std::uint32_t last = setup.count("steps");
  std::vector<std::vector<double>> errors;
  for (int i = 0; i < chains; ++i) {
    Chain chain{setup.stream(purpose, std::uint32_t(i)), large, setup.fault()};
    chain.start(64);
    std::vector<double> counts(truth.size(), 0.0);
    std::size_t look = 0;
    for (std::uint32_t n = 1; n <= last; ++n) {
      chain.step();
      counts[cell_of(chain.x, chain.y, cells)] += 1;
      if (n < 256 || (n & (n - 1)) != 0) continue;
      double error = 0;
      for (std::size_t c = 0; c < counts.size(); ++c) {
        const double difference = counts[c] / n - truth[c] / all;
        error += difference * difference * double(counts.size());
      }
      if (errors.size() == look) errors.emplace_back(), curve.x.push_back(n);
      errors[look++].push_back(error);
    }
  }
  for (const std::vector<double>& at : errors) {
    const Spread s = spread_of(at);
    curve.y.push_back(s.mean), curve.low.push_back(std::max(s.mean - s.mean_error, 0.1 * s.mean));
    curve.high.push_back(s.mean + s.mean_error);
  }
  return curve;
}

// One chain: its first states, and how often it has been in each cell.
void show_walk(const Setup& setup, Figure& walk, Images& images) {
  constexpr int cells = 48;
  const double large = setup["large"];
  const std::vector<double> truth = cell_integrals(cells);
  const double all = sum_of(truth), white = 0.5 * *std::ranges::max_element(truth) / all;
  const auto show = [&](const std::vector<double>& values, double scale, std::string caption) {
    std::vector<double> scaled;
    for (double value : values) scaled.push_back(value * scale);
    images.pictures.push_back(gray_picture(scaled, cells, white));
    images.pictures.back().caption = std::move(caption);
  };
  Chain chain{setup.stream(3), large, setup.fault()};
  chain.start(64);
  std::vector<double> counts(truth.size(), 0.0);
  Curve states{"the first 400 states", Mark::line, {}, {}, {}, {}};
  for (int n = 1; n <= 1 << 18; ++n) {
    chain.step();
    counts[cell_of(chain.x, chain.y, cells)] += 1;
    if (n <= 400) states.x.push_back(chain.x), states.y.push_back(chain.y);
    if (n == 1 << 9 || n == 1 << 12 || n == 1 << 15 || n == 1 << 18) show(counts, 1.0 / n, fmt::format("{} steps", n));
  }
  show(truth, 1 / all, "the target");
  walk.curves = {states};
}

Findings run(const Setup& setup) {
  constexpr int cells = 8;
  const double large = setup["large"];
  const std::uint32_t count = setup.count("chains");
  constexpr int steps = 128;
  const std::vector<double> truth = cell_integrals(cells);
  const double all = sum_of(truth);

  // Many chains, each with a start of its own; and chains of small steps alone that all begin in the wide spot.
  std::vector<double> states(truth.size(), 0.0), weights;
  double left_behind = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    Chain chain{setup.stream(1, i), large, setup.fault()};
    weights.push_back(chain.start(64));
    Chain captive{setup.stream(2, i), 0, setup.fault(), spots[0].x, spots[0].y, target(spots[0].x, spots[0].y)};
    for (int n = 0; n < steps; ++n) chain.step(), captive.step();
    states[cell_of(chain.x, chain.y, cells)] += 1;
    left_behind += spots[0].at(captive.x, captive.y) > spots[1].at(captive.x, captive.y) ? 1 : 0;
  }
  const Spread normalisation = spread_of(weights);
  std::vector<double> probabilities;
  for (double value : truth) probabilities.push_back(value / all);

  Figure walk{"walk",
              "A chain that walks on the picture: small steps within a spot, large ones between them.",
              {"$x$", false, 0, 1},
              {"$y$", false, 0, 1},
              {},
              true};
  Images images{"picture", "How often the chain has been in each pixel, and the target.", 5, {}};
  show_walk(setup, walk, images);
  Figure errors{"error",
                "The mean square error of the picture of one chain (relative to a flat picture). With large steps it "
                "falls as one over the number of steps; without them each chain knows one spot alone.",
                {"steps", true, {}, {}},
                {"mean square error", true, {}, {}},
                {},
                false};
  Curve with = errors_by_steps(setup, large, 4, cells), without = errors_by_steps(setup, 0, 5, cells);
  with.name = "with large steps", without.name = "small steps alone";
  std::vector<double> bars;
  // The first looks still remember the start.
  constexpr std::size_t early = 3;
  for (std::size_t i = early; i < with.y.size(); ++i) bars.push_back(with.high[i] - with.y[i]);
  const LineFit fit = fit_power_law(std::span(with.x).subspan(early), std::span(with.y).subspan(early), bars);
  errors.curves = {with, without};

  const double share = spots[0].integral(0, 1, 0, 1) / all;  // of the wide spot
  Findings findings;
  findings.sections = {walk, images, errors,
                       Table{"rate",
                             "The error of the picture over the number of steps, fitted.",
                             {"exponent", "its standard error"},
                             {{fit.slope, fit.slope_error}}}};
  findings.checks = {
      counts_check("Chains with large steps have the target's density.", states, probabilities),
      z_check("The mean target of the candidates of their starts recovers the integral of the target.",
              normalisation.mean, normalisation.mean_error, all),
      rejected(counts_check("Chains of small steps alone do not: they stay in the spot where they began.",
                            std::vector<double>{left_behind, count - left_behind},
                            std::vector<double>{share, 1 - share}))};
  return findings;
}

}  // namespace

const Experiment metropolis_picture{
    .name = "metropolis-picture",
    .title = "A Metropolis chain that walks on a picture",
    .group = group_t,
    .question =
        "Metropolis light transport lets a chain walk on the numbers of paths, and counts how often it is at each "
        "pixel. Here the picture itself is the target: two spots with darkness between them. How many steps show the "
        "picture, and what happens without large steps?",
    .formula =
        R"(a(x\to y) = \min\Bigl(1,\frac{f(y)}{f(x)}\Bigr),\qquad \hat I_j = \frac{b}{n}\,\#\{t : x_t \in \text{pixel } j\},\qquad b = E\Bigl[\frac1m\sum_{i=1}^m f(u_i)\Bigr] = \int f)",
    .source = "Veach and Guibas 1997; Kelemen et al. 2002",
    .fault = "every move is accepted",
    .knobs = {{{"chains", 20000, "independent chains, each of 128 steps"},
               {"steps", 65536, "of the chains whose error is shown"},
               {"large", 0.3, "probability of a fresh point"}}},
    .checks = 3,
    .run = run};

}  // namespace montelux::lab
