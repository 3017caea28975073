// What experiments measure with: spreads, histograms, fits, and checks of them against closed forms.
#pragma once
#include <functional>
#include <span>

#include "lab/experiments/experiment.h"

namespace montelux::lab {

// Mean and variance of independent values, each with its standard error (that of the variance from the fourth central
// moment).
struct Spread {
  double mean = 0, mean_error = 0, variance = 0, variance_error = 0, count = 0;
};
Spread spread_of(std::span<const double> values);

// `count` values of realise(stream), each from a stream of its own.
std::vector<double> realisations(const Setup& setup, std::uint32_t purpose, std::uint32_t count,
                                 const std::function<double(RandomStream<float>&)>& realise);

// ---- checks ---------------------------------------------------------------------------------------------------------

// Two-sided: is the value `truth`, where its standard error is known?
Check z_check(std::string claim, double value, double error, double truth);
Check mean_check(std::string claim, const Spread& spread, double truth);
Check variance_check(std::string claim, const Spread& spread, double truth);
// Are all of these standardised deviations normal with variance one? Sum of squares against chi-square.
Check deviations_check(std::string claim, std::span<const double> z);
// Is each of these standardised deviations, which may be correlated, normal with variance one? The largest is tested at
// the level of all (Bonferroni). `what`: what there is one of for each of them.
Check largest_deviation_check(std::string claim, std::span<const double> z, std::string_view what);
// Pearson's test of counts against probabilities; cells that expect less than 5 are pooled.
Check counts_check(std::string claim, std::span<const double> counts, std::span<const double> probabilities);
// A statistic that is chi-square with so many degrees of freedom.
Check chi_square_check(std::string claim, double chi_square, double degrees);
// A claim without chance.
Check exact_check(std::string claim, bool good, std::string why);
// The claim that this check's hypothesis is false.
Check rejected(Check check);

// ---- histograms and curves ------------------------------------------------------------------------------------------

// Counts of values in equal cells of [low, high); what lies outside is counted in the nearest cell.
std::vector<double> counts_in_cells(std::span<const double> values, double low, double high, std::size_t cells);
// The probability of each cell under a cumulative distribution function.
std::vector<double> cell_probabilities(const std::function<double(double)>& cdf, double low, double high,
                                       std::size_t cells);
// Bars of density with error bars of one standard deviation.
Curve histogram(std::string name, std::span<const double> counts, double low, double high);
// A function on a grid: equal steps, or equal ratios where `logarithmic`.
Curve function_curve(std::string name, Mark mark, const std::function<double(double)>& f, double low, double high,
                     bool logarithmic = false, int points = 160);

// Puts what is expected of the curve before it beside it: in its colour, without a name of its own.
void add_expected(Figure& figure, Curve expected);

// ---- fits -----------------------------------------------------------------------------------------------------------

struct LineFit {
  double slope, slope_error, intercept;
};
// log y against log x by least squares weighted with the relative errors of y.
LineFit fit_power_law(std::span<const double> x, std::span<const double> y, std::span<const double> errors);

// The integral of f over [a, b] by panels of eight Gauss-Legendre nodes.
double quadrature(const std::function<double(double)>& f, double a, double b, int panels = 16);

// "0.9987(12)": a value with its standard error in units of the last digits.
std::string with_error(double value, double error);

}  // namespace montelux::lab
