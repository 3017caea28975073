// The mean of independent values with weights that are known.
#pragma once
#include <cmath>
#include <cstddef>

namespace montelux {

struct WeightedMean {
  double mean = 0;
  double standard_error = 0;
  double degrees = 0;  // of freedom of Student's distribution; 0: the error is unknown
};

// The mean over i < count of value(i) with weight(i) >= 0, such as the number of samples of a pass. With equal weights
// its interval is Student's; with unequal ones the values count as fewer, 1 / sum of squared shares (Kish 1965).
template <class Weight, class Value>
WeightedMean weighted_mean(std::size_t count, Weight&& weight, Value&& value) {
  WeightedMean m;
  double total = 0, shares = 0, squares = 0;
  for (std::size_t i = 0; i < count; ++i) total += weight(i), m.mean += weight(i) * value(i);
  if (!(total > 0)) return {};
  m.mean /= total;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = weight(i) / total, distance = value(i) - m.mean;
    shares += share * share, squares += share * share * distance * distance;
  }
  m.degrees = 1 / shares - 1;
  if (m.degrees > 0) m.standard_error = std::sqrt(squares / shares / m.degrees);
  return m;
}

}  // namespace montelux
