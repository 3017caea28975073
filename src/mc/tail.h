// The largest terms of a sum, and what they say of the tail of the terms' distribution.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

// The magnitudes of the largest terms seen, `capacity` of them once there were as many.
class LargestTerms {
 public:
  // What a small part of a run keeps, and what a whole run does.
  static constexpr std::size_t of_part = 64, of_run = 1024;

  explicit LargestTerms(std::size_t capacity = of_part) : capacity_(capacity) {}

  void add(double magnitude);
  void add(std::span<const double> terms);  // their magnitudes
  void merge(const LargestTerms& other);
  double max() const;  // 0 where there is none
  // In falling order.
  std::vector<double> sorted() const;
  static LargestTerms from(std::span<const double> magnitudes, std::size_t capacity);

 private:
  // Twice the capacity is gathered before the lesser half is dropped, so that a term costs little.
  void drop_least();

  std::size_t capacity_;
  std::vector<double> kept_;
  double threshold_ = -1;  // what is not above it is not among the largest
};

// A power law fitted to the tail: P(|X| > x) falls like x^-index. The variance is infinite for an index up to 2, the
// mean does not exist for one up to 1. The index is infinite where there is no tail to speak of.
struct TailFit {
  double index;
  std::size_t terms = 0;  // that the fit rests on, the threshold apart
  // The end of the one-sided interval below the index: of independent terms, it lies above the index in `level` of the
  // fits at most (the estimate's relative standard deviation is 1 / sqrt(terms)).
  double lower_bound(double level = 0.01) const;
};

// Hill's estimate (1975) from the largest terms in falling order, the last of them being the threshold; infinite for
// fewer than 10 terms or where all are alike.
double hill_index(std::span<const double> largest);

// Hill's estimate from as many of the largest of `count` terms as follow a power law: at most sqrt(count), which keeps
// the bias of what is not tail yet below the noise, and fewer, by halves, as long as their logarithms are spread less
// than exponentially, as those of a bounded peak are.
TailFit fit_tail(std::span<const double> largest, std::uint64_t count);

}  // namespace montelux
