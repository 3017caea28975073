// Resampling: importance resampling (Talbot et al. 2005) and reservoirs, which choose from a stream in one pass.
#pragma once
#include <vector>

#include "mc/discrete.h"
#include "mc/estimate.h"

namespace montelux {

// N elements of a stream of unknown length, each kept with the same probability (Vitter 1985, algorithm R).
template <class T>
class UniformReservoir {
 public:
  explicit UniformReservoir(std::size_t capacity) : capacity_(capacity) {}

  void add(const T& element, RandomStream<float>& stream) {
    ++seen_;
    if (kept_.size() < capacity_) {
      kept_.push_back(element);
      return;
    }
    // 48 random bits: the stream may be long.
    const double high = double(stream.next());
    const auto place = std::uint64_t((high + 0x1p-24 * double(stream.next())) * double(seen_));
    if (place < capacity_) kept_[std::size_t(place)] = element;
  }
  const std::vector<T>& kept() const { return kept_; }
  std::uint64_t seen() const { return seen_; }

 private:
  std::size_t capacity_;
  std::uint64_t seen_ = 0;
  std::vector<T> kept_;
};

// One element of a stream, element i with probability w_i / sum of w (Chao 1982), in every lane. T is any type with
// `select(Mask<F>, T, T)`, or any type at all if F is float.
template <class T, class F = float>
struct WeightedReservoir {
  T value{};
  F weight_sum = 0.0f;
  F count = 0.0f;  // candidates seen, including those of weight zero

  // Takes one candidate of weight >= 0 if u in [0, 1) decides so. Returns where it was taken.
  Mask<F> add(const T& candidate, F weight, F u) { return take(candidate, weight, F(1.0f), u); }

  // The same as adding the other's stream here: adds its choice with the weight of its sum.
  Mask<F> merge(const WeightedReservoir& other, F u) { return take(other.value, other.weight_sum, other.count, u); }

 private:
  Mask<F> take(const T& candidate, F weight, F candidates, F u) {
    weight_sum = weight_sum + weight;
    count = count + candidates;
    Mask<F> taken = u * weight_sum < weight;
    if constexpr (lanes_of<F> == 1) {
      if (taken) value = candidate;
    } else {
      value = select(taken, candidate, value);
    }
    return taken;
  }
};

// The factor W that makes f(y) W an estimator of the integral of f, for y chosen by resampling with weights
// w_i = g(x_i) / p(x_i): the mean weight over g(y). g need not be normalised; 0 where g(y) is 0.
template <class F>
MONTELUX_INLINE F resampling_weight(F weight_sum, F count, F target) {
  return select(target > F(0.0f), weight_sum / max(count * target, F(1e-37f)), F(0.0f));
}

struct ResamplingCounts {
  std::uint32_t candidates = 1;  // M, from the source distribution
  std::uint32_t resampled = 1;   // N, chosen from them with replacement
};

// One realisation of the resampled estimator of the integral of f: unbiased for every M, N >= 1 where g > 0 wherever f
// is not 0. The choices are made by the cumulative sums of all candidates' weights.
template <class Function, class Target, class Distribution>
double resampled_estimate(Function f, Target g, const Distribution& source, ResamplingCounts counts,
                          RandomStream<float>& stream) {
  using X = decltype(source.sample(stream).x);
  std::vector<X> candidates;
  std::vector<double> weights;
  double sum = 0;
  for (std::uint32_t i = 0; i < counts.candidates; ++i) {
    const Draw<X> draw = source.sample(stream);
    candidates.push_back(draw.x);
    weights.push_back(double(g(draw.x)) / draw.density);
    sum += weights.back();
  }
  if (sum == 0) return 0;
  const DiscreteCdf choice(weights);
  double total = 0;
  for (std::uint32_t i = 0; i < counts.resampled; ++i) {
    const X& y = candidates[choice.sample(stream.next()).index];
    total += double(f(y)) / double(g(y));
  }
  return total / counts.resampled * (sum / counts.candidates);
}

// The same in one pass and constant memory: N reservoirs read one stream of candidates.
template <class Function, class Target, class Distribution>
double resampled_estimate_in_one_pass(Function f, Target g, const Distribution& source, ResamplingCounts counts,
                                      RandomStream<float>& stream) {
  using X = decltype(source.sample(stream).x);
  std::vector<WeightedReservoir<X>> reservoirs(counts.resampled);
  double sum = 0;
  for (std::uint32_t i = 0; i < counts.candidates; ++i) {
    const Draw<X> draw = source.sample(stream);
    const double weight = double(g(draw.x)) / draw.density;
    sum += weight;
    for (auto& reservoir : reservoirs) reservoir.add(draw.x, float(weight), stream.next());
  }
  if (sum == 0) return 0;
  double total = 0;
  for (const auto& reservoir : reservoirs) total += double(f(reservoir.value)) / double(g(reservoir.value));
  return total / counts.resampled * (sum / counts.candidates);
}

}  // namespace montelux
