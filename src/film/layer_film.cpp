#include "film/layer_film.h"

#include <limits>
#include <stdexcept>

namespace montelux {

LayerFilm::LayerFilm(PixelBounds bounds, int count, bool spread)
    : bounds_(bounds),
      count_(count),
      counts_(std::size_t(bounds.area())),
      sums_(counts_.size() * (std::size_t(count) + 1)),
      spreads_(spread ? sums_.size() : 0) {}

void LayerFilm::add(int x, int y, int samples, std::span<const ExactRgb> sums) {
  Counts& counts = counts_[index(x, y)];
  counts.samples += std::uint64_t(samples);
  ++counts.passes;
  const std::size_t first = first_sum(x, y);
  for (std::size_t i = 0; i < sums.size(); ++i) sums_[first + i] += sums[i];
  if (!has_spread()) return;
  for (int c = 0; c < rgb_size; ++c) {
    const ExactSum all(sums[0].c[c].value() / samples);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      SpreadSums& s = spreads_[first + i];
      const double value = sums[i].c[c].value() / samples;
      s.own[c].add(value);
      s.with_all[c].add(ExactSum(value), all);
    }
  }
}

void LayerFilm::merge(const LayerFilm& other) {
  if (!(bounds_ == other.bounds_) || count_ != other.count_ || has_spread() != other.has_spread())
    throw std::invalid_argument("films of different layers cannot be merged");
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
  for (std::size_t i = 0; i < spreads_.size(); ++i)
    for (int c = 0; c < rgb_size; ++c) {
      spreads_[i].own[c].merge(other.spreads_[i].own[c]);
      spreads_[i].with_all[c] += other.spreads_[i].with_all[c];
    }
  for (std::size_t i = 0; i < counts_.size(); ++i)
    counts_[i].samples += other.counts_[i].samples, counts_[i].passes += other.counts_[i].passes;
}

LayerSpread LayerFilm::spread(int x, int y, int number) const {
  const std::size_t first = first_sum(x, y);
  const SpreadSums &all = spreads_[first], &sums = spreads_[first + std::size_t(number + 1)];
  const auto n = std::uint32_t(passes(x, y));
  LayerSpread s;
  for (int c = 0; c < rgb_size; ++c) {
    s.mean[c] = sums.own[c].mean(n), s.m2[c] = sums.own[c].m2(n);
    s.co_moment[c] = sums.with_all[c].co_moment(n, sums.own[c].sum(), all.own[c].sum());
  }
  return s;
}

double LayerFilm::variance_of_mean(int x, int y, int number, int channel) const {
  const auto n = std::uint32_t(passes(x, y));
  if (n < 2) return std::numeric_limits<double>::infinity();
  return spreads_[first_sum(x, y) + std::size_t(number + 1)].own[channel].moments(n).variance() / n;
}

}  // namespace montelux
