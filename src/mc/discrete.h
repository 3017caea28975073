// Choice of one of many elements by weight: by cumulative sums, or in constant time by an alias table.
#pragma once
#include <span>
#include <vector>

#include "mc/density.h"

namespace montelux {

template <class F>
struct DiscreteSample {
  Uint<F> index;
  Mass<F> mass;
  F remapped;  // the remainder of the random number, uniform in [0, 1) again
};

// The last i in [0, n) with ascending[base + i] <= x, in every lane; ascending[base] <= x. n may differ between lanes
// and is at most `most`.
template <class F>
MONTELUX_INLINE Uint<F> find_interval(const float* ascending, Uint<F> base, Uint<F> n, std::uint32_t largest, F x) {
  using U = Uint<F>;
  U low = 0u;
  for (std::uint32_t step = std::bit_floor(largest); step != 0; step /= 2) {
    U middle = low + U(step);
    U safe = min(middle, n - U(1u));
    Mask<F> go = (middle < n) & (gather(ascending, U(base + safe)) <= x);
    low = select(go, middle, low);
  }
  return low;
}
template <class F>
MONTELUX_INLINE Uint<F> find_interval(const float* ascending, Uint<F> base, std::uint32_t n, F x) {
  return find_interval<F>(ascending, base, Uint<F>(n), n, x);
}

// Finds intervals in rows of n + 1 ascending numbers from 0 to 1, as find_interval does, in constant time on average: a
// table of equal parts of [0, 1) says where to begin (Chen and Asau 1974, "On Generating Random Variates from an
// Empirical Distribution").
class IntervalIndex {
 public:
  // `sums`: all rows, one after the other.
  IntervalIndex(std::span<const float> sums, std::uint32_t n);

  template <class F>
  MONTELUX_INLINE Uint<F> find(const float* sums, Uint<F> row, F x) const {
    using U = Uint<F>;
    const U part = row * U(parts_ + 1u) + min(to_uint(x * float(parts_)), U(parts_ - 1u));
    const U base = row * U(n_ + 1u);
    U low = gather(first_.data(), part), high = gather(first_.data() + 1, part);
    while (any(low < high)) {
      const U middle = (low + high + U(1u)) >> 1;
      const Mask<F> go = gather(sums, U(base + middle)) <= x;
      const U below = middle - U(1u);
      const Mask<F> open = low < high;
      high = select(open & !go, below, high);
      low = select(open & go, middle, low);
    }
    return low;
  }

 private:
  std::uint32_t n_, parts_;           // parts_ is a power of two, so that x * parts_ is exact
  std::vector<std::uint32_t> first_;  // parts_ + 1 for each row: the interval in which a part begins
};

// The weights' running sums from 0 to exactly 1, n + 1 numbers. Negative and non-finite weights, or none at all, throw
// std::invalid_argument; where all are zero the sums are those of equal weights.
std::vector<float> cumulative_sums(std::span<const double> weights);

// Inversion of the cumulative distribution function, O(log n). An element of weight zero is never chosen; one of less
// than 2^-24 of the total may be missed.
class DiscreteCdf {
 public:
  explicit DiscreteCdf(std::span<const double> weights) : sums_(cumulative_sums(weights)) {}

  std::uint32_t size() const { return std::uint32_t(sums_.size() - 1); }

  template <class F>
  DiscreteSample<F> sample(F u) const {
    Uint<F> i = find_interval<F>(sums_.data(), Uint<F>(0u), size(), u);
    F low = gather(sums_.data(), i), width = gather(sums_.data() + 1, i) - low;
    return {i, {width}, min((u - low) / width, F(one_minus_epsilon))};
  }
  template <class F>
  Mass<F> mass(Uint<F> index) const {
    return {gather(sums_.data() + 1, index) - gather(sums_.data(), index)};
  }
  // The u that `sample` maps to this element and this remapped number.
  template <class F>
  F invert(Uint<F> index, F remapped) const {
    F low = gather(sums_.data(), index);
    return min(low + remapped * (gather(sums_.data() + 1, index) - low), F(one_minus_epsilon));
  }

 private:
  std::vector<float> sums_;
};

// The same in constant time (Walker 1977; built after Vose 1991). Throws and treats zeros like cumulative_sums.
class AliasTable {
 public:
  explicit AliasTable(std::span<const double> weights);

  std::uint32_t size() const { return std::uint32_t(mass_.size()); }

  template <class F>
  DiscreteSample<F> sample(F u) const {
    F scaled = u * float(size());
    Uint<F> bin = min(to_uint(scaled), Uint<F>(size() - 1u));
    F rest = scaled - to_float(bin);
    F share = gather(share_.data(), bin);
    Mask<F> own = rest < share;
    Uint<F> index = select(own, bin, gather(alias_.data(), bin));
    F remapped = select(own, rest / max(share, F(1e-30f)), (rest - share) / max(F(1.0f) - share, F(1e-30f)));
    return {index, {gather(mass_.data(), index)}, min(remapped, F(one_minus_epsilon))};
  }
  template <class F>
  Mass<F> mass(Uint<F> index) const {
    return {gather(mass_.data(), index)};
  }
  // A u that `sample` maps to this element, whose mass must not be zero: for v from 0 to 1 first the numbers
  // of the element's own bin, then those of the bins that it fills up, linearly within each bin; uniform if v is. An
  // interval of u that is narrower than 2^-24 may be missed.
  template <class F>
  F invert(Uint<F> index, F v) const {
    const Uint<F> first = gather(first_part_.data(), index), end = gather(first_part_.data() + 1, index);
    const Uint<F> part = first + find_interval<F>(part_start_.data(), first, end - first, max_parts_, v);
    const Uint<F> bin = gather(part_bin_.data(), part);
    const Mask<F> own = bin == index;
    const F share = gather(share_.data(), bin), n = float(size());
    const F low = select(own, F(0.0f), share), high = select(own, share, F(1.0f));
    // From a share of the element's mass to a share of the bin's.
    const F inside = (v - gather(part_start_.data(), part)) * gather(mass_.data(), index) * n;
    const F u = min((to_float(bin) + min(low + inside, high)) / n, F(one_minus_epsilon));
    // Rounding at an edge must not lead into the next bin: move a few units in the last place towards the middle.
    const F to_middle = (to_float(bin) + F(0.5f) * (low + high)) / n - u;
    return select(sample(u).index == index, u, u + min(max(to_middle, F(-0x1p-22f)), F(0x1p-22f)));
  }

 private:
  void list_parts();

  std::vector<float> mass_;
  std::vector<float> share_;          // the part of each bin that belongs to its own element
  std::vector<std::uint32_t> alias_;  // the element that has the rest of the bin
  // For the inverse: the bins of element i, its own first, are parts first_part_[i] to first_part_[i + 1]; part_start_
  // is the share of its mass in the preceding bins.
  std::vector<std::uint32_t> first_part_, part_bin_;
  std::vector<float> part_start_;
  std::uint32_t max_parts_ = 0;  // maximum number of parts of one element
};

}  // namespace montelux
