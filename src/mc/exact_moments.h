// Mean and variance of a random variable's realisations that do not depend on the order in which these come.
#pragma once
#include "math/exact_sum.h"
#include "mc/moments.h"

namespace montelux {

// Sums of realisations and of their squares, without rounding: realisations may be added, and sums merged, in any order
// and grouping, and the moments are the same bits. The number of realisations is stored by the owner, because many of
// these objects share it. Realisations are below ExactSum::largest in absolute value and are cut to its grid.
class ExactMoments {
 public:
  void add(double x) {
    const ExactSum exact(x);
    sum_ += exact;
    squares_.add(exact, exact);
  }
  void merge(const ExactMoments& other) { sum_ += other.sum_, squares_ += other.squares_; }
  bool operator==(const ExactMoments&) const = default;

  double mean(std::uint32_t count) const { return count == 0 ? 0 : sum_.value() / count; }
  // The sum of squared deviations from the mean.
  double m2(std::uint32_t count) const { return squares_.co_moment(count, sum_, sum_); }
  Moments moments(std::uint32_t count) const { return {count, 0, mean(count), m2(count)}; }

  const ExactSum& sum() const { return sum_; }
  const ExactProducts& squares() const { return squares_; }
  static ExactMoments of(const ExactSum& sum, const ExactProducts& squares) {
    ExactMoments moments;
    moments.sum_ = sum, moments.squares_ = squares;
    return moments;
  }

 private:
  ExactSum sum_;
  ExactProducts squares_;
};

}  // namespace montelux
