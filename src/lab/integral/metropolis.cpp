#include "mc/metropolis.h"

#include <algorithm>
#include <cmath>

#include "lab/integral/whole_pass.h"

namespace montelux::lab {
namespace {

constexpr double large_step_share = 0.3;
constexpr std::uint32_t start_purpose = 1, choice_purpose = 2, step_purpose = 3, size_purpose = 4, accept_purpose = 5;

// Independent chains, computed together. Each starts at a point resampled from uniform ones by the target, with the
// mean target of these as its weight, so it is unbiased from its first step, and the integral of the target is not
// needed (Veach 1997, section 11.3.1). The starts use half of the samples of a pass.
class Metropolis final : public Technique {
 public:
  Metropolis(const Problem& problem, const Method& method)
      : integrand_(problem.integrand), target_(problem.target), step_(method.step) {}

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.passes = 32, t.unit = 0, t.min_samples = 8;
    return t;
  }

  BatchFunction support() const override { return target_ ? *target_ : BatchFunction{}; }

  TermSums run(const PassPart& part) const override {
    const CubeKey key = part.key.fork(std::uint32_t(part.block_first));
    const std::size_t chains =
        std::size_t(std::clamp<std::uint64_t>(part.count / 128, std::min<std::uint64_t>(4, part.count / 4), 64));
    const std::uint64_t each = std::max<std::uint64_t>(2, part.count / chains), starts = each / 2,
                        steps = each - starts;
    TermSums sums(LargestTerms::of_run);
    // The terms are those of the starts, target over uniform density; the chains themselves have none.
    std::vector<Chain> state = start(key, chains, std::size_t(starts), sums);
    for (std::uint64_t k = 0; k < steps; ++k) step(key, k, state, sums);

    Moments over_chains;
    for (const Chain& c : state) over_chains.add(c.weight * c.sum / double(steps));
    return sums_of_estimate(over_chains.mean, over_chains.variance() / double(chains), part.count, sums);
  }

 private:
  struct Chain {
    std::vector<double> x;
    double target = 0, ratio = 0;  // of the integrand to the target at x
    double weight = 0, sum = 0;    // sum over the steps of the expected ratio
  };
  struct Values {
    std::vector<double> targets, ratios;
  };

  // Target and integrand at points; values that are not finite count as 0.
  Values evaluate(const std::vector<double>& points, std::size_t n, TermSums& sums) const {
    Values v{std::vector<double>(n), std::vector<double>(n)};
    std::vector<double> f(n);
    const PointBatch batch{points, integrand_.dimension, n};
    integrand_.evaluate(batch, f);
    sums.evaluations += n;
    if (target_) (*target_)(batch, v.targets);
    for (std::size_t i = 0; i < n; ++i) {
      if (!target_) v.targets[i] = std::abs(f[i]);
      if (!std::isfinite(v.targets[i]) || !std::isfinite(f[i])) v.targets[i] = f[i] = 0, ++sums.non_finite;
      v.targets[i] = std::max(0.0, v.targets[i]);
      v.ratios[i] = v.targets[i] > 0 ? f[i] / v.targets[i] : 0;
    }
    return v;
  }

  std::vector<Chain> start(CubeKey key, std::size_t chains, std::size_t candidates, TermSums& sums) const {
    const std::size_t dimension = integrand_.dimension;
    std::vector<Chain> state(chains);
    std::vector<double> points(dimension * candidates), u(chains);
    fill_independent(key.fork(choice_purpose), {1, 0, chains, u.data()});
    for (std::size_t c = 0; c < chains; ++c) {
      fill_independent(key.fork(start_purpose), {dimension, c * candidates, candidates, points.data()});
      const Values v = evaluate(points, candidates, sums);
      double total = 0, reached = 0;
      for (double g : v.targets) total += g;
      std::size_t chosen = 0;
      for (std::size_t i = 0; i < candidates; ++i) {
        if (v.targets[i] > 0) chosen = i;
        reached += v.targets[i];
        if (reached > u[c] * total) break;
      }
      for (std::size_t d = 0; d < dimension; ++d) state[c].x.push_back(points[d * candidates + chosen]);
      state[c].target = v.targets[chosen], state[c].ratio = v.ratios[chosen];
      state[c].weight = total / double(candidates);
      std::vector<double> terms = v.targets;
      sums.add(terms);
    }
    return state;
  }

  // One step of every chain: anywhere, or nearby on the torus; both are symmetric. The sum receives the expectation
  // over acceptance.
  void step(CubeKey key, std::uint64_t k, std::vector<Chain>& state, TermSums& sums) const {
    const std::size_t dimension = integrand_.dimension, n = state.size();
    std::vector<double> points(dimension * n), kind(n), accept(n);
    fill_independent(key.fork(step_purpose), {dimension, k * n, n, points.data()});
    fill_independent(key.fork(size_purpose), {1, k * n, n, kind.data()});
    fill_independent(key.fork(accept_purpose), {1, k * n, n, accept.data()});
    for (std::size_t c = 0; c < n; ++c) {
      if (kind[c] < large_step_share) continue;
      // Steps on many scales, because the right one is unknown (Kelemen et al. 2002).
      const double size = step_ * std::exp(-5 * (kind[c] - large_step_share) / (1 - large_step_share));
      for (std::size_t d = 0; d < dimension; ++d) {
        double& x = points[d * n + c];
        x = state[c].x[d] + size * (2 * x - 1);
        x -= std::floor(x);
        x = std::min(x, std::nextafter(1.0, 0.0));
      }
    }
    const Values v = evaluate(points, n, sums);
    for (std::size_t c = 0; c < n; ++c) {
      Chain& chain = state[c];
      const double chance = metropolis_acceptance(chain.target, v.targets[c]);
      chain.sum += chance * v.ratios[c] + (1 - chance) * chain.ratio;
      ++sums.proposed;
      if (accept[c] >= chance) continue;
      ++sums.accepted;
      chain.target = v.targets[c], chain.ratio = v.ratios[c];
      for (std::size_t d = 0; d < dimension; ++d) chain.x[d] = points[d * n + c];
    }
  }

  Integrand integrand_;
  std::optional<BatchFunction> target_;
  double step_;
};

}  // namespace

std::unique_ptr<Technique> make_metropolis(const Problem& problem, const Method& method) {
  return std::make_unique<Metropolis>(problem, method);
}

}  // namespace montelux::lab
