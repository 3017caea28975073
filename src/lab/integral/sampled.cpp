#include "lab/integral/sampled.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "mc/sobol.h"

namespace montelux::lab {
namespace {

constexpr std::uint32_t training_purpose = 0x7ea1u;  // the key of training points: no pass has this number
constexpr std::uint32_t uniform_purpose = 0x0a11u;   // the key of the uniform share
// The number of mapped points for each uniform one.
constexpr std::uint64_t points_per_uniform = 16;

// How far a point is outside the map, by the density of the map there: nearly 1 where the map has fewer points than
// the uniform share; decreases with the fourth power of the density (a power heuristic, Veach and Guibas 1995).
double outside_share(double density) {
  const double ratio = density * double(points_per_uniform), square = ratio * ratio;
  return 1 / (1 + square * square);
}

// Adds terms and their magnitudes; values that are not finite count as 0.
void add_terms(std::span<const double> terms, double& sum, double& magnitude) {
  std::array<double, 8> sums{}, magnitudes{};  // in parallel, for the vector units
  std::size_t i = 0;
  for (; i + 8 <= terms.size(); i += 8)
    for (std::size_t k = 0; k < 8; ++k) sums[k] += terms[i + k], magnitudes[k] += std::abs(terms[i + k]);
  for (; i < terms.size(); ++i) sums[0] += terms[i], magnitudes[0] += std::abs(terms[i]);
  double all = 0, all_magnitudes = 0;
  for (std::size_t k = 0; k < 8; ++k) all += sums[k], all_magnitudes += magnitudes[k];
  if (std::isfinite(all_magnitudes)) {
    sum += all, magnitude += all_magnitudes;
    return;
  }
  for (double x : terms)
    if (std::isfinite(x)) sum += x, magnitude += std::abs(x);
}

// Buffers of one part: points by coordinate, and the values at them.
struct Batch {
  std::size_t dimension, capacity;
  std::vector<double> points, values, jacobian, control;

  Batch(std::size_t d, std::uint64_t count)
      : dimension(d),
        capacity(std::size_t(std::min<std::uint64_t>(batch_size(d), count))),
        points(d * capacity),
        values(capacity) {}
  std::span<double> coordinates(std::size_t n) { return std::span(points).first(dimension * n); }
};

class Sampled final : public Technique {
 public:
  Sampled(const Problem& problem, const Method& method, const MapTraining* training)
      : integrand_(problem.integrand),
        control_(problem.control),
        method_(method),
        points_(cube_fill(method.points).value()) {
    if (method.kind != MethodKind::qmc || !method.adapt || training == nullptr) return;
    map_ = training->map();
    training_evaluations_ = training->evaluations();
  }

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    const bool correlated = method_.kind == MethodKind::qmc || method_.kind == MethodKind::stratified;
    t.passes = correlated ? 6 : 32;  // if lengths are powers of two, up to twice as many
    t.training_evaluations = training_evaluations_;
    if (method_.kind == MethodKind::antithetic) t.min_samples = 2;
    if (map_) t.min_samples = points_per_uniform, t.cost = 1 + 1 / double(points_per_uniform);
    return t;
  }

  std::uint64_t fitting(std::uint64_t samples) const override {
    if (method_.kind == MethodKind::qmc && points_.by_powers_of_two) return std::bit_floor(samples);
    if (map_) return samples / points_per_uniform * points_per_uniform;
    if (method_.kind == MethodKind::antithetic) return samples / 2 * 2;
    if (method_.kind == MethodKind::stratified && method_.strata == Strata::grid)
      return GridShape::of(integrand_.dimension, samples).boxes;
    return samples;
  }

  TermSums run(const PassPart& part) const override {
    Batch batch(integrand_.dimension, part.count);
    const GridShape shape = method_.kind == MethodKind::stratified && method_.strata == Strata::grid
                                ? GridShape::of(integrand_.dimension, part.block_count)
                                : GridShape{};
    TermSums sums;
    if (map_) add_uniform_share(part, batch, sums);
    for (std::uint64_t done = 0; done < part.count;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch.capacity, part.count - done));
      fill(part, shape, {integrand_.dimension, part.first + done, n, batch.points.data()});
      evaluate(batch, n, sums);
      done += n;
    }
    return sums;
  }

 private:
  void fill(const PassPart& part, const GridShape& shape, CubeBlock block) const {
    switch (method_.kind) {
      case MethodKind::antithetic:
        return fill_antithetic(part.key, block);
      case MethodKind::stratified: {
        const CubeKey key = part.key.fork(std::uint32_t(part.block_first));
        block.first -= part.block_first;
        if (method_.strata == Strata::latin) return fill_latin(key, part.block_count, block);
        return fill_grid(key, shape, block);
      }
      case MethodKind::qmc:
        return fill_points(part.key, block);
      default:
        return fill_independent(part.key, block);
    }
  }

  void fill_points(CubeKey key, CubeBlock block) const {
    points_.fill(key, block);
    if (method_.baker) fold({block.out, block.dimension * block.count});
  }

  // What the uniform points of a part find outside the map.
  void add_uniform_share(const PassPart& part, Batch& batch, TermSums& sums) const {
    const CubeKey key = part.key.fork(uniform_purpose);
    const std::uint64_t first = part.first / points_per_uniform, all = part.count / points_per_uniform;
    std::vector<double> density(batch.capacity);
    for (std::uint64_t done = 0; done < all;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch.capacity, all - done));
      fill_points(key, {integrand_.dimension, first + done, n, batch.points.data()});
      map_->density(batch.coordinates(n), std::span(density).first(n));
      const std::span<double> values = std::span(batch.values).first(n);
      integrand_.evaluate({batch.coordinates(n), integrand_.dimension, n}, values);
      for (std::size_t i = 0; i < n; ++i) values[i] *= double(points_per_uniform) * outside_share(density[i]);
      add_terms(values, sums.outside.uniform, sums.outside.uniform_magnitude);
      done += n;
    }
    sums.evaluations += all;
  }

  void evaluate(Batch& batch, std::size_t n, TermSums& sums) const {
    const std::span<double> values = std::span(batch.values).first(n);
    if (map_) {
      batch.jacobian.assign(n, 1.0);
      map_->apply(batch.coordinates(n), batch.jacobian);
    }
    const PointBatch points{batch.coordinates(n), integrand_.dimension, n};
    integrand_.evaluate(points, values);
    if (map_) {
      std::vector<double>& outside = batch.control;  // free: no method has both a map and a control variate
      outside.resize(n);
      for (std::size_t i = 0; i < n; ++i) {
        values[i] *= batch.jacobian[i];
        outside[i] = values[i] * outside_share(1 / batch.jacobian[i]);
      }
      add_terms(outside, sums.outside.map, sums.outside.map_magnitude);
      double sum = 0;
      add_terms(values, sum, sums.magnitude);
    }
    sums.evaluations += n;
    if (method_.kind == MethodKind::control) add_control(batch, points, values, sums);
    sums.add(values);
  }

  void add_control(Batch& batch, PointBatch points, std::span<const double> values, TermSums& sums) const {
    batch.control.resize(points.count);
    control_->evaluate(points, batch.control);
    for (std::size_t i = 0; i < points.count; ++i) {
      const double c = batch.control[i] - control_->integral;
      if (!std::isfinite(c) || !std::isfinite(values[i])) {
        sums.non_finite += std::isfinite(values[i]) ? 1 : 0;
        continue;
      }
      sums.control_sum += c, sums.control_squares += c * c, sums.control_products += c * values[i];
    }
  }

  Integrand integrand_;
  std::optional<ControlVariate> control_;
  Method method_;
  CubeFill points_;  // of qmc
  std::optional<AdaptiveMap> map_;
  std::uint64_t training_evaluations_ = 0;
};

// One step of training: the squared terms in the bins of each axis, and the variances of a sample.
struct StepSums {
  std::vector<double> squares;
  double gain = 1;    // variance of a uniform sample over that of one through the map
  bool flat = false;  // the terms do not vary: there is nothing to adapt to
};
StepSums squares_in_bins(const Integrand& integrand, const AdaptiveMap& map, CubeKey key, std::uint64_t samples) {
  const std::size_t dimension = integrand.dimension, bins = map.bins();
  Batch batch(dimension, samples);
  std::vector<double> sums(dimension * bins), uniform;
  double mean = 0, mapped_square = 0, plain_square = 0;
  for (std::uint64_t done = 0; done < samples;) {
    const std::size_t n = std::size_t(std::min<std::uint64_t>(batch.capacity, samples - done));
    fill_sobol(key, {dimension, done, n, batch.points.data()});
    uniform.assign(batch.points.begin(), batch.points.begin() + std::ptrdiff_t(dimension * n));
    batch.jacobian.assign(n, 1.0);
    map.apply(batch.coordinates(n), batch.jacobian);
    integrand.evaluate({batch.coordinates(n), dimension, n}, std::span(batch.values).first(n));
    for (std::size_t i = 0; i < n; ++i) {
      const double term = batch.values[i] * batch.jacobian[i], kept = std::isfinite(term) ? term : 0;
      mean += kept, mapped_square += kept * kept, plain_square += kept * kept / batch.jacobian[i];
      batch.values[i] = kept * kept;
    }
    for (std::size_t d = 0; d < dimension; ++d) {
      double* __restrict axis = sums.data() + d * bins;
      const double* y = uniform.data() + d * n;
      for (std::size_t i = 0; i < n; ++i) axis[std::size_t(y[i] * double(bins))] += batch.values[i];
    }
    done += n;
  }
  const double n = double(samples);
  mean /= n;
  const double mapped = mapped_square / n - mean * mean, plain = plain_square / n - mean * mean;
  const double rounding = 1e-13 * mean * mean;  // what differences of squares leave of a constant
  const bool flat = !(mapped > rounding);
  return {sums, flat || !(plain > rounding) ? 1.0 : plain / mapped, flat};
}

// The first step sees the integrand by uniform points and has many of them, so that it finds peaks that are far apart.
// Of the other steps, later ones have a better map and get more points.
constexpr std::array<double, MapTraining::steps> step_shares{0.4, 0.031, 0.047, 0.07, 0.105, 0.158, 0.236, 0.353};

// A power of two: the edges of the bins, where the map is not smooth, are then also edges of the strata of a Sobol'
// net, which reduces its error by a factor of tens.
std::size_t bins_for(std::uint64_t samples) {
  constexpr std::uint64_t min_bins = 8, max_bins = 128, samples_per_bin = 24;
  return std::size_t(std::bit_floor(std::clamp(samples / samples_per_bin, min_bins, max_bins)));
}

}  // namespace

MapTraining::MapTraining(const Integrand& integrand, std::uint64_t seed, std::uint64_t samples)
    : integrand_(integrand), seed_(seed), samples_(samples), map_(integrand.dimension, bins_for(samples_of(0))) {}

std::uint64_t MapTraining::samples_of(int step) const {
  const double share = step_shares[std::size_t(std::min(step, steps - 1))];
  return std::max<std::uint64_t>(16, std::uint64_t(double(samples_) * share));
}

void MapTraining::go_to(int step) {
  for (; step_ < step; ++step_) {
    const CubeKey key = CubeKey::of(seed_, ~0u - std::uint32_t(step_)).fork(training_purpose);
    const std::uint64_t n = samples_of(step_);
    const StepSums sums = squares_in_bins(integrand_, map_, key, n);
    evaluations_ += n;
    gain_ = sums.gain;
    if (!sums.flat) map_.refine(sums.squares, bins_for(samples_of(step_ + 1)));
  }
}

std::unique_ptr<Technique> make_sampled(const Problem& problem, const Method& method, const MapTraining* training) {
  if (method.kind == MethodKind::control && !problem.control)
    throw std::invalid_argument("the method control needs a control variate and its integral");
  return std::make_unique<Sampled>(problem, method, training);
}

}  // namespace montelux::lab
