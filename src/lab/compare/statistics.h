// Estimates of a figure from a few independent repeats.
#pragma once
#include <string>
#include <vector>

namespace montelux::lab {

// A mean over repeats with its interval (Student's t). With one repeat the interval is infinite. Values that are not
// finite (a figure that a repeat does not have) are excluded; `count` is the number of the others.
struct Measured {
  double mean = 0, low = 0, high = 0;
  double standard_error = 0;
  int count = 0;
};
Measured measured(const std::vector<double>& values, double confidence);

// "540 ± 100", with half of the interval; "541.1 (one repeat)" for one value; "not known" for none.
std::string text_of(const Measured& m);

// The geometric mean of paired ratios a[i] / b[i] of positive values, with its interval: the mean of the logarithms
// and Student's t. Pairs with a value that is not positive are excluded.
Measured measured_ratio(const std::vector<double>& a, const std::vector<double>& b, double confidence);

// The ratio of two sums over repeats, sum a / sum b, with the jackknife interval over repeats
// (Efron and Stein 1981).
Measured measured_ratio_of_sums(const std::vector<double>& a, const std::vector<double>& b, double confidence);

// The slope of log y against log x by least squares.
double log_slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace montelux::lab
