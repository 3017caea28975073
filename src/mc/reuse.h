// Reuse of resampled samples between domains: a sample of one domain serves the integral over another (Bitterli et
// al. 2020, "Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting"; Lin et al.
// 2022, "Generalized Resampled Importance Sampling").
//
// A reservoir holds one sample y and a weight W with E[h(y) W] = integral of h, for every h that is 0 where the target
// of its domain is. Any combination of such reservoirs that has the same property is unbiased, whether or not
// they depend on each other: expectations are linear.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "mc/mis.h"
#include "mc/resampling.h"

namespace montelux {

// `weight` is the unbiased contribution weight W, `target` the domain's own target at `value`. The confidence is the
// relative weight of the sample: any number that does not depend on the samples' values. Without a reservoir it is 0,
// and values that are not a number or above largest_reuse_confidence count as 0. A reservoir that found nothing has
// weight 0 and its confidence.
template <class T, class F>
struct Reservoir {
  T value;
  F weight, confidence, target;
};

// How the samples of several domains share the integral over the first.
enum class ReuseWeights : std::uint8_t { naive, unbiased, pairwise, generalised };

struct NamedReuseWeights {
  std::string_view name;
  ReuseWeights weights;
  std::string_view description;
};
inline constexpr std::array<NamedReuseWeights, 4> reuse_weight_names{{
    {"naive", ReuseWeights::naive, "by confidence, as if every domain could make every sample: biased"},
    {"unbiased", ReuseWeights::unbiased, "by confidence, among the domains that could have made the chosen sample"},
    {"pairwise", ReuseWeights::pairwise, "balance heuristic between the first domain and each other one in turn"},
    {"generalised", ReuseWeights::generalised, "balance heuristic over the targets of all domains"},
}};

inline std::optional<ReuseWeights> reuse_weights_named(std::string_view name) {
  for (const NamedReuseWeights& entry : reuse_weight_names)
    if (entry.name == name) return entry.weights;
  return std::nullopt;
}

// A sample of another domain as the first domain sees it.
template <class T, class F>
struct Shifted {
  T value;     // its image
  F jacobian;  // of the map there: image over preimage
  F target;    // of the first domain at the image; 0 if there is no image
};

template <class T, class F>
MONTELUX_INLINE Shifted<T, F> select(Mask<F> m, const Shifted<T, F>& a,
                                     const Shifted<T, F>& b) requires(lanes_of<F> > 1) {
  return {select(m, a.value, b.value), select(m, a.jacobian, b.jacobian), select(m, a.target, b.target)};
}

// What a combination requires of the domains; the result is for domain number 0:
//   Shifted<T, F> shift(int from, const T& value, Mask<F> on)   the image of a sample of domain `from`; may be derived
//   F target_at(int to, const T& value, Mask<F> on)             the target of domain `to` at the preimage there of a
//                                                               value of domain 0, times the Jacobian preimage / image
// Each map is one to one on the samples for which its targets are not 0.
template <class D, class T, class F>
concept ReuseDomains = requires(const D& domains, const T& value, Mask<F> on) {
  { domains.shift(1, value, on) } -> std::convertible_to<Shifted<T, F>>;
  { domains.target_at(1, value, on) } -> std::same_as<F>;
};

// Resampling weights above this count as non-finite: their sums would leave the range of a float.
inline constexpr float largest_reuse_weight = 1e36f;

template <class F>
MONTELUX_INLINE F usable_weight(F w) {
  return select((w > F(0.0f)) & (w < F(largest_reuse_weight)), w, F(0.0f));
}

// Confidences above this count as 0: their products with targets would leave the range of a float.
inline constexpr float largest_reuse_confidence = 1e12f;

template <class F>
MONTELUX_INLINE F usable_confidence(F c) {
  return select((c > F(0.0f)) & (c <= F(largest_reuse_confidence)), c, F(0.0f));
}

// The weights of multiple importance sampling of one combination; `inputs` are the reservoirs of the domains.
template <class T, class F, class Domains>
class ReuseShares {
 public:
  ReuseShares(ReuseWeights weights, std::span<const Reservoir<T, F>> inputs, const Domains& domains)
      : weights_(weights), inputs_(inputs), domains_(domains) {
    others_ = F(0.0f);
    for (std::size_t i = 1; i < inputs.size(); ++i) others_ = others_ + confidence(i);
    all_ = others_ + confidence(0);
  }
  F all() const { return all_; }
  F confidence(std::size_t i) const { return usable_confidence(inputs_[i].confidence); }

  // The share of domain i > 0 at the image y of its sample. `own` is its own target there and `first` that of domain 0,
  // in the measure of domain 0.
  F share(std::size_t i, const T& y, F own, F first, Mask<F> on) const {
    const F c = confidence(i);
    switch (weights_) {
      case ReuseWeights::naive:
      case ReuseWeights::unbiased:
        return c;
      // Lin et al. 2022, eq. 38, with confidences.
      case ReuseWeights::pairwise:
        return c / all_ * balance_weight(F(others_ * own), F(confidence(0) * first));
      case ReuseWeights::generalised:
        break;
    }
    return balance_weight(F(c * own), confidence(0) * first + others_at(y, i, on));
  }
  // The share of domain 0 at its own sample.
  F share_of_first(Mask<F> on) const {
    const Reservoir<T, F>& own = inputs_[0];
    const F c = confidence(0);
    switch (weights_) {
      case ReuseWeights::naive:
      case ReuseWeights::unbiased:
        return c;
      case ReuseWeights::generalised:
        return balance_weight(F(c * own.target), others_at(own.value, 0, on));
      case ReuseWeights::pairwise:
        break;
    }
    F sum = c;
    for (std::size_t i = 1; i < inputs_.size(); ++i) {
      const Mask<F> there = on & (confidence(i) > F(0.0f));
      const F other = target_at(i, own.value, there);
      sum = sum + select(there, confidence(i) * balance_weight(F(c * own.target), F(others_ * other)), F(0.0f));
    }
    return sum / all_;
  }
  // The divisor of the sum of all weights once y from domain `from` is chosen (0: from the first itself).
  F normalisation(const T& y, F target, Uint<F> from, Mask<F> on) const {
    if (weights_ == ReuseWeights::naive) return all_;
    if (weights_ != ReuseWeights::unbiased) return F(1.0f);
    F could = select(target > F(0.0f), confidence(0), F(0.0f));
    for (std::size_t i = 1; i < inputs_.size(); ++i) {
      const Mask<F> made = from == Uint<F>(std::uint32_t(i));
      const Mask<F> queries = on & (confidence(i) > F(0.0f)) & !made;
      const Mask<F> can = made | (target_at(i, y, queries) > F(0.0f));
      could = could + select(can, confidence(i), F(0.0f));
    }
    return could;
  }

 private:
  F target_at(std::size_t i, const T& y, Mask<F> on) const {
    return any(on) ? select(on, domains_.target_at(int(i), y, on), F(0.0f)) : F(0.0f);
  }
  // Confidence times target, summed over all domains except the first and `left_out`.
  F others_at(const T& y, std::size_t left_out, Mask<F> on) const {
    F sum = 0.0f;
    for (std::size_t j = 1; j < inputs_.size(); ++j) {
      if (j == left_out) continue;
      const Mask<F> there = on & (confidence(j) > F(0.0f));
      sum = sum + select(there, confidence(j) * target_at(j, y, there), F(0.0f));
    }
    return sum;
  }

  ReuseWeights weights_;
  std::span<const Reservoir<T, F>> inputs_;
  const Domains& domains_;
  F others_, all_;
};

// Whether the shares sum to one for every sample, and not only once a sample is chosen.
constexpr bool shares_sum_to_one(ReuseWeights weights) {
  return weights == ReuseWeights::pairwise || weights == ReuseWeights::generalised;
}

// For combine(): the default `each`, which does nothing.
struct NoEach {};

// Combines the reservoirs of all domains to one for the first domain. T as for WeightedReservoir. Lanes that are off
// return the first reservoir.
//
// Where shares_sum_to_one, the sum of h(y_i) w_i over all inputs estimates the integral of h over the first domain,
// with less variance than the one sample that is chosen: its mean over the choice (Rao and Blackwell). For such sums
// each.own(w, on) receives the weight of the first domain's own sample, and each.other(image, w, on) those of the
// others with the results of domains.shift().
template <class T, class F, class Domains, class Each = NoEach>
Reservoir<T, F> combine(ReuseWeights weights, std::span<const Reservoir<T, F>> inputs, const Domains& domains,
                        RandomStream<F>& stream, Mask<F> on,
                        [[maybe_unused]] Each&& each = {}) requires ReuseDomains<Domains, T, F> {
  constexpr bool reports = !std::is_same_v<std::remove_cvref_t<Each>, NoEach>;
  const ReuseShares<T, F, Domains> shares(weights, inputs, domains);
  const Reservoir<T, F>& first = inputs[0];
  WeightedReservoir<T, F> chosen;
  chosen.value = first.value;
  F target = first.target;
  Uint<F> from = Uint<F>(0u);
  const Mask<F> own = on & (first.weight > F(0.0f)) & (shares.confidence(0) > F(0.0f));
  const F own_share = shares.share_of_first(own);
  const F own_weight = select(own, usable_weight<F>(own_share * first.target * first.weight), F(0.0f));
  chosen.add(first.value, own_weight, stream.next());
  if constexpr (reports) each.own(F(own_share * first.weight), Mask<F>(own_weight > F(0.0f)));
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    const F u = stream.next();
    const Reservoir<T, F>& input = inputs[i];
    const Mask<F> live = on & (input.weight > F(0.0f)) & (shares.confidence(i) > F(0.0f));
    if (!any(live)) continue;
    const auto image = domains.shift(int(i), input.value, live);
    const Mask<F> counts = live & (image.target > F(0.0f)) & (image.jacobian > F(0.0f));
    const F own_target = input.target / image.jacobian;
    const F per_target = shares.share(i, image.value, own_target, image.target, counts) * input.weight * image.jacobian;
    const F w = select(counts, usable_weight<F>(per_target * image.target), F(0.0f));
    const Mask<F> taken = chosen.add(image.value, w, u);
    if constexpr (reports) each.other(image, per_target, Mask<F>(w > F(0.0f)));
    target = select(taken, image.target, target);
    from = select(taken, Uint<F>(std::uint32_t(i)), from);
  }
  const Mask<F> found = on & (chosen.weight_sum > F(0.0f));
  const F divisor = shares.normalisation(chosen.value, target, from, found) * target;
  Reservoir<T, F> result{chosen.value, F(0.0f), shares.all(), target};
  result.weight = select(found & (divisor > F(0.0f)), usable_weight<F>(chosen.weight_sum / divisor), F(0.0f));
  if constexpr (lanes_of<F> == 1) {
    return on ? result : first;
  } else {
    return {select(on, result.value, first.value), select(on, result.weight, first.weight),
            select(on, result.confidence, first.confidence), select(on, result.target, first.target)};
  }
}

}  // namespace montelux
