// The largest terms of a sum, and what they indicate about the tail of the terms' distribution.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace montelux {

// The magnitudes of the largest terms seen so far, at most `capacity` of them.
class LargestTerms {
 public:
  // The capacities for a small part of a run and for a whole run.
  static constexpr std::size_t of_part = 64, of_run = 1024;

  explicit LargestTerms(std::size_t capacity = of_part) : capacity_(capacity) {}

  void add(double magnitude);
  void add(std::span<const double> terms);  // adds their magnitudes
  void merge(const LargestTerms& other);
  double max() const;  // 0 where there is none
  // In decreasing order.
  std::vector<double> sorted() const;
  static LargestTerms from(std::span<const double> magnitudes, std::size_t capacity);

 private:
  // Twice the capacity is collected before the smaller half is dropped, so that adding a term is cheap.
  void drop_least();

  std::size_t capacity_;
  std::vector<double> kept_;
  double threshold_ = -1;  // values not above it are not among the largest
};

// A power law fitted to the tail: P(|X| > x) is proportional to x^-index. The variance is infinite for an index up to
// 2; the mean does not exist for one up to 1. The index is infinite if there is no relevant tail.
struct TailFit {
  double index;
  std::size_t terms = 0;  // that the fit uses, without the threshold
  // The end of the one-sided interval below the index: for independent terms, it exceeds the true index in at most
  // `level` of the fits (the estimate's relative standard deviation is 1 / sqrt(terms)).
  double lower_bound(double level = 0.01) const;
};

// Hill's estimate (1975) from the largest terms in decreasing order, the last of them being the threshold; infinite for
// fewer than 10 terms or if all are equal.
double hill_index(std::span<const double> largest);

// Hill's estimate from as many of the largest of `count` terms as follow a power law: at most sqrt(count), which keeps
// the bias of terms outside the tail below the noise, and halved as long as their logarithms vary less
// than exponentially distributed ones, as those of a bounded peak do.
TailFit fit_tail(std::span<const double> largest, std::uint64_t count);

}  // namespace montelux
