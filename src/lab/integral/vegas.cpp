#include <algorithm>
#include <cmath>

#include "lab/integral/sampled.h"
#include "lab/integral/whole_pass.h"

namespace montelux::lab {
namespace {

constexpr double allocation_exponent = 0.75;  // beta of Lepage 2021
constexpr std::uint64_t max_boxes = 1u << 14;
constexpr std::uint32_t spread_pass =
    0xfffff000u;  // the pass that measures the boxes: no pass of a run has this number

struct BoxSums {
  double mean = 0, variance = 0;  // of the terms in the box
};

// VEGAS with adaptive stratification (Lepage 2021): the cube of the mapped coordinates is cut into equal boxes, and
// each gets samples by how much the mapped integrand varied in it. Map and shares are fixed before the passes begin, so
// each pass is unbiased and passes are alike.
class Vegas final : public Technique {
 public:
  Vegas(const Problem& problem, std::uint64_t seed, const MapTraining& training)
      : integrand_(problem.integrand), map_(training.map()), training_evaluations_(training.evaluations()) {
    // As many samples again measure the boxes, four or more in each.
    const std::uint64_t measured = training.evaluations();
    shape_ = GridShape::of(integrand_.dimension, std::clamp<std::uint64_t>(measured / 4, 1, max_boxes));
    spread_.assign(shape_.boxes, 1.0);
    if (shape_.boxes == 1 || measured < 4) return;
    TermSums sums;
    const std::vector<std::uint64_t> even(shape_.boxes, measured / shape_.boxes);
    const std::vector<BoxSums> boxes = sample_boxes(CubeKey::of(seed, spread_pass), even, sums);
    training_evaluations_ += sums.evaluations;
    double total = 0;
    for (std::size_t b = 0; b < spread_.size(); ++b)
      total += spread_[b] = std::pow(boxes[b].variance, 0.5 * allocation_exponent);
    for (double& s : spread_) s = total > 0 ? s / total * double(spread_.size()) : 1;
  }

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.passes = 8, t.unit = 0, t.min_samples = 2;
    t.training_evaluations = training_evaluations_;
    return t;
  }

  TermSums run(const PassPart& part) const override {
    TermSums sums(LargestTerms::of_run);
    const CubeKey key = part.key.fork(std::uint32_t(part.block_first));
    // Too few samples for two in each box: no boxes.
    const bool plain = part.count < 4 * shape_.boxes;
    const std::vector<std::uint64_t> samples = plain ? std::vector<std::uint64_t>{part.count} : allocate(part.count);
    const std::vector<BoxSums> boxes = sample_boxes(key, samples, sums);
    double mean = 0, variance = 0;
    const double volume = 1 / double(boxes.size());
    for (std::size_t b = 0; b < boxes.size(); ++b)
      mean += volume * boxes[b].mean, variance += volume * volume * boxes[b].variance / double(samples[b]);
    return sums_of_estimate(mean, variance, part.count, sums);
  }

 private:
  // Two samples in each box, and the others by the spread that was measured.
  std::vector<std::uint64_t> allocate(std::uint64_t count) const {
    std::vector<std::uint64_t> samples(shape_.boxes, 2);
    const double rest = double(count - 2 * shape_.boxes);
    double cumulated = 0;
    std::uint64_t given = 0;
    for (std::size_t b = 0; b < samples.size(); ++b) {
      cumulated += spread_[b] / double(shape_.boxes);
      const std::uint64_t up_to = b + 1 == samples.size()
                                      ? std::uint64_t(rest)
                                      : std::min(std::uint64_t(rest), std::uint64_t(cumulated * rest));
      samples[b] += up_to - given;
      given = up_to;
    }
    return samples;
  }

  // Uniform samples in the boxes, as many as stated, in the order of the boxes.
  std::vector<BoxSums> sample_boxes(CubeKey key, std::span<const std::uint64_t> samples, TermSums& sums) const {
    const std::size_t dimension = integrand_.dimension, batch = batch_size(dimension);
    std::vector<double> points(dimension * batch), values(batch), jacobian(batch);
    std::vector<std::uint32_t> box_of(batch);
    std::vector<Moments> boxes(samples.size());
    std::uint64_t total = 0, left = samples[0];
    for (std::uint64_t n : samples) total += n;
    std::size_t box = 0;
    for (std::uint64_t done = 0; done < total;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(batch, total - done));
      for (std::size_t i = 0; i < n; ++i) {
        while (left == 0) left = samples[++box];
        box_of[i] = std::uint32_t(box), --left;
      }
      fill_independent(key, {dimension, done, n, points.data()});
      if (samples.size() > 1) place_in_boxes(std::span(points).first(dimension * n), std::span(box_of).first(n));
      const std::span<double> j = std::span(jacobian).first(n), v = std::span(values).first(n);
      std::fill(j.begin(), j.end(), 1.0);
      map_.apply(std::span(points).first(dimension * n), j);
      integrand_.evaluate({std::span(points).first(dimension * n), dimension, n}, v);
      for (std::size_t i = 0; i < n; ++i) v[i] *= j[i];
      sums.add(v);
      for (std::size_t i = 0; i < n; ++i) boxes[box_of[i]].add(v[i]);
      done += n;
    }
    sums.evaluations += total;
    std::vector<BoxSums> result;
    for (const Moments& m : boxes) result.push_back({m.mean, m.variance()});
    return result;
  }

  void place_in_boxes(std::span<double> points, std::span<const std::uint32_t> box_of) const {
    const std::size_t n = box_of.size();
    std::vector<std::uint32_t> rest(box_of.begin(), box_of.end());
    for (std::size_t d = 0; d < integrand_.dimension; ++d) {
      const std::uint32_t parts = shape_.parts[d];
      if (parts == 1) continue;
      for (std::size_t i = 0; i < n; ++i) {
        points[d * n + i] = (double(rest[i] % parts) + points[d * n + i]) / double(parts);
        rest[i] /= parts;
      }
    }
  }

  Integrand integrand_;
  AdaptiveMap map_;
  std::uint64_t training_evaluations_;
  GridShape shape_;
  std::vector<double> spread_;  // of each box, with mean 1
};

}  // namespace

std::unique_ptr<Technique> make_vegas(const Problem& problem, std::uint64_t seed, const MapTraining& training) {
  return std::make_unique<Vegas>(problem, seed, training);
}

}  // namespace montelux::lab
