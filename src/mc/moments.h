// Running mean and variance of the realisations of a random variable.
#pragma once
#include <cmath>
#include <cstdint>

namespace montelux {

// An estimate of an expectation: the standard error is that of the mean. Non-finite realisations are counted and
// excluded; if there are any, the mean is not reliable.
struct Estimate {
  double mean = 0, standard_error = 0;
  std::uint64_t count = 0, non_finite = 0;
};

// Count, mean and sum of squared deviations, without cancellation (Welford 1962; merged after Chan et al. 1979).
struct Moments {
  std::uint64_t count = 0, non_finite = 0;
  double mean = 0, m2 = 0;

  void add(double x) {
    if (!std::isfinite(x)) {
      ++non_finite;
      return;
    }
    ++count;
    const double before = x - mean;
    mean += before / double(count);
    m2 += before * (x - mean);
  }
  // The same as adding the other's realisations here.
  void merge(const Moments& other) {
    non_finite += other.non_finite;
    if (other.count == 0) return;
    const double n = double(count), k = double(other.count), distance = other.mean - mean;
    mean += distance * k / (n + k);
    m2 += other.m2 + distance * distance * n * k / (n + k);
    count += other.count;
  }
  // The variance of one realisation, unbiased; 0 for fewer than two.
  double variance() const { return count < 2 ? 0.0 : m2 / double(count - 1); }
  double standard_error() const { return count < 2 ? 0.0 : std::sqrt(variance() / double(count)); }
  Estimate estimate() const { return {mean, standard_error(), count, non_finite}; }
};

}  // namespace montelux
