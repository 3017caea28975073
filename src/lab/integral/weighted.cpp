#include "lab/integral/weighted.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lab/integral/density_sampler.h"
#include "mc/mis.h"

namespace montelux::lab {
namespace {

constexpr std::uint32_t choice_purpose = 0xc401ceu;

class Importance final : public Technique {
 public:
  explicit Importance(const Problem& problem)
      : integrand_(problem.integrand), sampler_(problem.densities.front(), problem.integrand.dimension) {}

  TechniqueTraits traits() const override { return {}; }
  BatchFunction support() const override {
    return [this](PointBatch points, std::span<double> values) { sampler_.density(points, values); };
  }
  TermSums run(const PassPart& part) const override {
    const std::size_t dimension = integrand_.dimension, batch = batch_size(dimension);
    std::vector<double> points(dimension * batch), values(batch), density(batch);
    TermSums sums;
    for (std::uint64_t done = 0; done < part.count;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch, part.count - done));
      const std::span<double> x = std::span(points).first(dimension * n), v = std::span(values).first(n);
      sums.proposed += sampler_.sample(part.key, part.first + done, n, x).proposed;
      integrand_.evaluate({x, dimension, n}, v);
      sampler_.density({x, dimension, n}, std::span(density).first(n));
      for (std::size_t i = 0; i < n; ++i) v[i] /= density[i];
      sums.add(v);
      sums.evaluations += n, sums.accepted += n;
      done += n;
    }
    if (sampler_.sampling() != DensitySampling::rejection) sums.proposed = sums.accepted = 0;
    return sums;
  }

 private:
  Integrand integrand_;
  DensitySampler sampler_;
};

// Every technique makes as many samples as every other: sample i is by technique i modulo their number, so a part with
// whole rounds of them is a multi-sample estimator (Veach and Guibas 1995).
class MultipleImportance final : public Technique {
 public:
  MultipleImportance(const Problem& problem, MisHeuristic heuristic)
      : integrand_(problem.integrand), heuristic_(heuristic) {
    for (const UserDensity& density : problem.densities) samplers_.emplace_back(density, integrand_.dimension);
  }

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.min_samples = samplers_.size();
    t.unit = t.unit / samplers_.size() * samplers_.size();
    return t;
  }
  std::uint64_t fitting(std::uint64_t samples) const override { return samples / samplers_.size() * samplers_.size(); }

  BatchFunction support() const override {
    return [this](PointBatch points, std::span<double> values) {
      std::vector<double> own(values.size());
      std::fill(values.begin(), values.end(), 0.0);
      for (const DensitySampler& sampler : samplers_) {
        sampler.density(points, own);
        for (std::size_t i = 0; i < own.size(); ++i) values[i] += own[i];
      }
    };
  }

  TermSums run(const PassPart& part) const override {
    const std::uint64_t techniques = samplers_.size(), rounds = part.count / techniques;
    const std::size_t batch = std::max<std::size_t>(16, batch_size(integrand_.dimension) / techniques);
    TermSums sums;
    for (std::uint64_t done = 0; done < rounds;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch, rounds - done));
      for (std::size_t k = 0; k < techniques; ++k) run_technique(part, k, part.first / techniques + done, n, sums);
      done += n;
    }
    return sums;
  }

 private:
  void run_technique(const PassPart& part, std::size_t k, std::uint64_t first, std::size_t n, TermSums& sums) const {
    const std::size_t dimension = integrand_.dimension, techniques = samplers_.size();
    std::vector<double> points(dimension * n), values(n), densities(techniques * n);
    const auto drawn = samplers_[k].sample(part.key.fork(std::uint32_t(k)), first, n, points);
    const PointBatch batch{points, dimension, n};
    integrand_.evaluate(batch, values);
    for (std::size_t j = 0; j < techniques; ++j) samplers_[j].density(batch, std::span(densities).subspan(j * n, n));
    std::vector<float> products(techniques);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < techniques; ++j) products[j] = float(densities[j * n + i]);
      const double weight = double(mis_weight<float>(heuristic_, products, k));
      values[i] = weight == 0 ? 0 : double(techniques) * weight * values[i] / densities[k * n + i];
    }
    sums.add(values);
    sums.evaluations += n;
    if (samplers_[k].sampling() == DensitySampling::rejection) sums.proposed += drawn.proposed, sums.accepted += n;
  }

  Integrand integrand_;
  MisHeuristic heuristic_;
  std::vector<DensitySampler> samplers_;
};

// Each term is one resampled estimate (Talbot, Cline and Egbert 2005): N points chosen out of M candidates by target
// over source density.
class Resampled final : public Technique {
 public:
  Resampled(const Problem& problem, const Method& method)
      : integrand_(problem.integrand),
        target_(problem.target),
        candidates_(std::uint32_t(method.candidates)),
        resamples_(std::uint32_t(method.resamples)) {
    if (!problem.densities.empty()) source_.emplace(problem.densities.front(), integrand_.dimension);
  }

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.cost = double(target_ ? candidates_ + resamples_ : candidates_);
    t.unit = std::max<std::uint64_t>(1, t.unit / candidates_);
    return t;
  }
  BatchFunction support() const override {
    if (!target_ && !source_) return {};
    return [this](PointBatch points, std::span<double> values) {
      std::vector<double> density(values.size(), 1.0);
      std::fill(values.begin(), values.end(), 1.0);
      if (target_) (*target_)(points, values);
      if (source_) source_->density(points, density);
      for (std::size_t i = 0; i < density.size(); ++i) values[i] *= density[i];
    };
  }
  TermSums run(const PassPart& part) const override {
    const std::uint64_t batch = std::max<std::uint64_t>(1, batch_size(integrand_.dimension) / candidates_);
    TermSums sums;
    for (std::uint64_t done = 0; done < part.count;) {
      const std::uint64_t n = std::min(batch, part.count - done);
      estimates(part.key, part.first + done, std::size_t(n), sums);
      done += n;
    }
    return sums;
  }

 private:
  void estimates(CubeKey key, std::uint64_t first, std::size_t n, TermSums& sums) const {
    const std::size_t dimension = integrand_.dimension, total = n * candidates_, chosen = n * resamples_;
    std::vector<double> points(dimension * total), weights(total), targets(total), density(total, 1.0);
    const PointBatch batch{points, dimension, total};
    if (source_) {
      source_->sample(key, first * candidates_, total, points);
      source_->density(batch, density);
    } else {
      fill_independent(key, {dimension, first * candidates_, total, points.data()});
    }
    std::vector<double> integrand_values;
    if (target_) {
      (*target_)(batch, targets);
    } else {
      integrand_.evaluate(batch, targets);
      integrand_values = targets;
      for (double& g : targets) g = std::abs(g);
    }
    for (std::size_t i = 0; i < total; ++i) weights[i] = targets[i] / density[i];

    std::vector<double> u(chosen), mean_weights(n);
    std::vector<std::size_t> choice(chosen);
    fill_independent(key.fork(choice_purpose), {1, first * resamples_, chosen, u.data()});
    for (std::size_t e = 0; e < n; ++e) mean_weights[e] = choose(weights, u, e, choice);

    // The integrand at the chosen points: known already where it is the target.
    std::vector<double> values(chosen);
    if (target_) {
      std::vector<double> at(dimension * chosen);
      for (std::size_t d = 0; d < dimension; ++d)
        for (std::size_t i = 0; i < chosen; ++i) at[d * chosen + i] = points[d * total + choice[i]];
      integrand_.evaluate({at, dimension, chosen}, values);
    } else {
      for (std::size_t i = 0; i < chosen; ++i) values[i] = integrand_values[choice[i]];
    }
    std::vector<double> terms(n);
    for (std::size_t e = 0; e < n; ++e) {
      for (std::size_t r = 0; r < resamples_; ++r) {
        const std::size_t i = e * resamples_ + r;
        if (mean_weights[e] != 0) terms[e] += values[i] / targets[choice[i]] * mean_weights[e] / double(resamples_);
      }
    }
    sums.add(terms);
    sums.evaluations += target_ ? total + chosen : total;
  }

  // Chooses for estimate e; the mean of its weights, 0 where nothing can be chosen, not finite where a weight is not.
  double choose(std::span<const double> weights, std::span<const double> u, std::size_t e,
                std::span<std::size_t> choice) const {
    const std::span<const double> own = weights.subspan(e * candidates_, candidates_);
    double sum = 0;
    for (double w : own) sum += w;
    for (std::size_t r = 0; r < resamples_; ++r) {
      const double wanted = u[e * resamples_ + r] * sum;
      double reached = 0;
      std::size_t k = 0, last = 0;
      for (; k < own.size(); ++k) {
        if (own[k] > 0) last = k;
        reached += own[k];
        if (reached > wanted && own[k] > 0) break;
      }
      choice[e * resamples_ + r] = e * candidates_ + (k < own.size() ? k : last);
    }
    return sum / double(candidates_);
  }

  Integrand integrand_;
  std::optional<BatchFunction> target_;
  std::optional<DensitySampler> source_;
  std::size_t candidates_, resamples_;
};

void need_density(const Problem& problem, const char* method) {
  if (problem.densities.empty()) throw std::invalid_argument(std::string("the method ") + method + " needs a density");
}

}  // namespace

std::unique_ptr<Technique> make_importance(const Problem& problem) {
  need_density(problem, "importance");
  return std::make_unique<Importance>(problem);
}
std::unique_ptr<Technique> make_mis(const Problem& problem, const Method& method) {
  need_density(problem, "mis");
  return std::make_unique<MultipleImportance>(problem, method.heuristic);
}
std::unique_ptr<Technique> make_ris(const Problem& problem, const Method& method) {
  return std::make_unique<Resampled>(problem, method);
}

}  // namespace montelux::lab
