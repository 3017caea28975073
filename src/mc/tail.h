// The largest terms of a sum, and what they say of the tail of the terms' distribution.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace montelux {

// The magnitudes of the largest terms seen, `capacity` of them once there were as many.
class LargestTerms {
 public:
  static constexpr std::size_t capacity = 64;

  void add(double magnitude);
  void add(std::span<const double> terms);  // their magnitudes
  void merge(const LargestTerms& other);
  // In falling order.
  std::vector<double> sorted() const;
  static LargestTerms from(std::span<const double> magnitudes);

 private:
  // Twice the capacity is gathered before the lesser half is dropped, so that a term costs little.
  void drop_least();

  std::vector<double> kept_;
  double threshold_ = -1;  // what is not above it is not among the largest
};

// Hill's estimate of the tail index: P(|X| > x) falls like x^-index. `largest` in falling order, k of them above the
// threshold largest[k]; infinite where there is no tail to speak of (fewer than 10 terms, or all alike). Below 2 the
// variance is infinite (Hill 1975).
double hill_index(std::span<const double> largest);

}  // namespace montelux
