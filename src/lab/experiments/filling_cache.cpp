// A cache of irradiance that fills: where its records lie, and how the error falls with their spacing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrator/irradiance_cache/cache.h"
#include "lab/experiments/floor_scene.h"
#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"

namespace montelux::lab {

namespace {

// Irradiance on the plane y = 0, with its derivatives along x and z: what a record states, exactly.
struct Irradiance {
  double value, dx, dz;
};
using Field = Irradiance (*)(double x, double z);

// Of a small ball above the middle, at height 1: 1 / (1 + x^2 + z^2)^(3/2).
Irradiance under_a_ball(double x, double z) {
  const double s = 1 + x * x + z * z, value = std::pow(s, -1.5);
  return {value, -3 * x * value / s, -3 * z * value / s};
}
// Polynomials, whose errors are powers of the spacing without any rest.
Irradiance linear(double x, double z) { return {100 + x + 0.5 * z, 1, 0.5}; }
Irradiance quadratic(double x, double z) { return {100 + x + 0.5 * z + 0.5 * (x * x + z * z), 1 + x, 0.5 + z}; }

CacheRecord record_at(Field field, double x, double z, double distance, double gradient_sign) {
  const Irradiance e = field(x, z);
  CacheRecord record;
  record.at = {{float(x), 0, float(z)}, {0, 1, 0}};
  record.distance = float(distance);
  for (std::size_t c = 0; c < spectrum_size; ++c) {
    record.irradiance[int(c)] = float(e.value);
    record.gradients.translational[c] = {float(gradient_sign * e.dx), 0, float(gradient_sign * e.dz)};
  }
  return record;
}
CacheQuery query_at(double x, double z) { return {{float(x), 0, float(z)}, {0, 1, 0}}; }
CacheRules rules_of(double accuracy, bool gradients) { return {float(accuracy), 1e-4f, 1e4f, gradients, true}; }

// The root of the mean square error of a cache that has been filled, on a plane where all records have the same
// distance 1 and the field is a polynomial. The square is as wide as 14 radii, and errors count in its middle, so that
// spacings differ by their scale alone.
double error_of(const Setup& setup, Field field, double accuracy, bool gradients, std::uint32_t run) {
  const double half = 7 * accuracy, sign = setup.fault() ? -1 : 1;
  IrradianceCache cache(rules_of(accuracy, gradients));
  RandomStream<float> stream = setup.stream(gradients ? 1 : 2, run);
  const auto place = [&](double reach) { return reach * (2 * double(stream.next()) - 1); };
  for (int i = 0; i < 6000; ++i)
    if (const double x = place(half), z = place(half); !cache.covers(query_at(x, z)))
      cache.insert(record_at(field, x, z, 1, sign));
  double sum = 0;
  constexpr int looks = 1000;
  int counted = 0;
  for (int i = 0; i < looks; ++i) {
    const double x = place(half - 2 * accuracy), z = place(half - 2 * accuracy);
    const auto found = cache.irradiance(query_at(x, z));
    if (!found) continue;
    const double error = double((*found)[0]) - field(float(x), float(z)).value;
    sum += error * error, ++counted;
  }
  return std::sqrt(sum / counted);
}

constexpr std::array<double, 5> accuracies{0.1, 0.2, 0.4, 0.8, 1.6};

// Errors by spacing over independent runs, and the fitted exponent. Runs are independent for each spacing.
struct Rates {
  Curve curve;
  LineFit fit{};
};
Rates rates_of(const Setup& setup, Field field, bool gradients, std::string name) {
  Rates rates{{std::move(name), Mark::points, {}, {}, {}, {}}};
  std::vector<double> errors_of_means;
  const std::uint32_t runs = setup.count("runs");
  for (std::size_t a = 0; a < accuracies.size(); ++a) {
    std::vector<double> errors;
    for (std::uint32_t run = 0; run < runs; ++run)
      errors.push_back(error_of(setup, field, accuracies[a], gradients, std::uint32_t(a) * runs + run));
    const Spread s = spread_of(errors);
    rates.curve.x.push_back(accuracies[a]), rates.curve.y.push_back(s.mean);
    rates.curve.low.push_back(s.mean - s.mean_error), rates.curve.high.push_back(s.mean + s.mean_error);
    errors_of_means.push_back(s.mean_error);
  }
  rates.fit = fit_power_law(rates.curve.x, rates.curve.y, errors_of_means);
  return rates;
}

// A floor under a ball whose cache is filled pixel by pixel in a random order: the picture after some of them, from the
// records so far.
void show_filling(const Setup& setup, Images& images, Figure& places) {
  constexpr int size = 64;
  constexpr double half = 2.5, accuracy = 0.25;
  IrradianceCache cache(rules_of(accuracy, true));
  RandomStream<float> stream = setup.stream(3);
  const auto middle = [](int i) { return half * ((2 * i + 1.0) / size - 1); };
  const auto show = [&](std::string caption) {
    std::vector<double> values;
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        const auto found = cache.irradiance(query_at(middle(column), middle(row)));
        values.push_back(found ? double((*found)[0]) : 0);
      }
    images.pictures.push_back(gray_picture(values, size, 1));
    images.pictures.back().caption = std::move(caption);
  };
  std::vector<int> order(size * size);
  for (int i = 0; i < size * size; ++i) order[std::size_t(i)] = i;
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[std::min(std::size_t(double(stream.next()) * double(i)), i - 1)]);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double x = middle(order[i] % size), z = middle(order[i] / size);
    // The harmonic mean of the distances to the surfaces around grows with the distance from the ball.
    if (!cache.covers(query_at(x, z))) cache.insert(record_at(under_a_ball, x, z, std::sqrt(1 + x * x + z * z), 1));
    if (i == 9 || i == 39 || i == 159 || i + 1 == order.size())
      show(fmt::format("{} pixels queried, {} records", i + 1, cache.size()));
  }
  std::vector<double> exact;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) exact.push_back(under_a_ball(middle(column), middle(row)).value);
  images.pictures.push_back(gray_picture(exact, size, 1));
  images.pictures.back().caption = "closed form";
  Curve records{"records", Mark::points, {}, {}, {}, {}};
  for (const CacheRecord& record : cache.records())
    records.x.push_back(double(record.at.p.x)), records.y.push_back(double(record.at.p.z));
  places.curves = {records};
}

Findings run(const Setup& setup) {
  const Rates plain = rates_of(setup, linear, false, "without gradients"),
              gradients = rates_of(setup, quadratic, true, "with gradients");
  Images images{"filling",
                "A floor under a ball. Pixels are queried in a random order; where no record counts a new one is "
                "made, elsewhere the records are interpolated. Black: no record yet.",
                5,
                {}};
  Figure places{"records",
                "Where the records lie in the end: closer together beneath the ball, where other surfaces are near.",
                {"$x$", false, -2.5, 2.5},
                {"$z$", false, -2.5, 2.5},
                {},
                true};
  show_filling(setup, images, places);
  Figure errors{"error",
                "The error of interpolation by the spacing of the records: of a linear irradiance without gradients, "
                "of a quadratic one with them, and lines with the exponents of theory.",
                {"accuracy $a$", true, {}, {}},
                {"root of the mean square error", true, {}, {}},
                {},
                false};
  const auto add = [&](const Rates& rates, double exponent) {
    errors.curves.push_back(rates.curve);
    const double middle = rates.curve.y[2] / std::pow(rates.curve.x[2], exponent);
    add_expected(errors, function_curve(
                             "", Mark::line, [&](double a) { return middle * std::pow(a, exponent); },
                             accuracies.front(), accuracies.back(), true, 2));
  };
  add(plain, 1), add(gradients, 2);
  Findings findings;
  findings.sections = {images, places, errors,
                       Table{"rates",
                             "The error over the spacing, fitted.",
                             {"interpolation", "exponent", "theory"},
                             {{"without gradients", with_error(plain.fit.slope, plain.fit.slope_error), 1.0},
                              {"with gradients", with_error(gradients.fit.slope, gradients.fit.slope_error), 2.0}}}};
  findings.checks = {
      z_check("Without gradients the error is in proportion to the spacing.", plain.fit.slope, plain.fit.slope_error,
              1),
      z_check("With gradients it is in proportion to its square.", gradients.fit.slope, gradients.fit.slope_error, 2)};
  return findings;
}

}  // namespace

const Experiment filling_cache{
    .name = "filling-cache",
    .title = "A cache that fills",
    .group = group_t,
    .question =
        "Indirect light changes slowly over a diffuse surface. A cache stores the irradiance of some points and "
        "interpolates it between them. Where do the records lie, and how large is the error of interpolation?",
    .formula =
        R"(E(x) \approx \frac{\sum_i w_i(x)\,\bigl(E_i + (x-x_i)\cdot\nabla E_i\bigr)}{\sum_i w_i(x)},\qquad w_i(x) = \frac{1}{|x-x_i|/R_i} - \frac1a > 0)",
    .source = "Ward, Rubinstein and Clear 1988; Ward and Heckbert 1992; Krivanek et al. 2006",
    .fault = "gradients with the wrong sign",
    .knobs = {{{"runs", 24, "independent fillings for each spacing"}}},
    .checks = 2,
    .run = run};

}  // namespace montelux::lab
