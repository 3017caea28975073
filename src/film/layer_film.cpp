#include "film/layer_film.h"

#include <limits>
#include <stdexcept>

namespace montelux {

LayerFilm::LayerFilm(PixelBounds bounds, int count, bool spread, bool halves)
    : bounds_(bounds),
      count_(count),
      counts_(std::size_t(bounds.area())),
      sums_(counts_.size() * (std::size_t(count) + 1)),
      spreads_(spread ? sums_.size() : 0),
      half_samples_(halves ? counts_.size() : 0),
      half_sums_(half_samples_.size() * std::size_t(count)) {}

void LayerFilm::add(int x, int y, int samples, std::span<const ExactRgb> sums, bool in_first_half) {
  Counts& counts = counts_[index(x, y)];
  counts.samples += std::uint64_t(samples);
  ++counts.passes;
  const std::size_t first = first_sum(x, y);
  for (std::size_t i = 0; i < sums.size(); ++i) sums_[first + i] += sums[i];
  if (has_halves() && in_first_half) {
    half_samples_[index(x, y)] += std::uint64_t(samples);
    for (std::size_t i = 1; i < sums.size(); ++i) half_sums_[first_half_sum(x, y) + i - 1] += sums[i];
  }
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
  if (!(bounds_ == other.bounds_) || count_ != other.count_ || has_spread() != other.has_spread() ||
      has_halves() != other.has_halves())
    throw std::invalid_argument("films of different layers cannot be merged");
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
  for (std::size_t i = 0; i < spreads_.size(); ++i)
    for (int c = 0; c < rgb_size; ++c) {
      spreads_[i].own[c].merge(other.spreads_[i].own[c]);
      spreads_[i].with_all[c] += other.spreads_[i].with_all[c];
    }
  for (std::size_t i = 0; i < half_samples_.size(); ++i) half_samples_[i] += other.half_samples_[i];
  for (std::size_t i = 0; i < half_sums_.size(); ++i) half_sums_[i] += other.half_sums_[i];
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

std::array<LayerHalf, 2> LayerFilm::halves(int x, int y, int number) const {
  const std::uint64_t all = counts_[index(x, y)].samples, first = half_samples_[index(x, y)];
  const ExactRgb &whole = layer(x, y, number), &part = half_sums_[first_half_sum(x, y) + std::size_t(number)];
  std::array<LayerHalf, 2> halves{};
  for (std::size_t c = 0; c < rgb_size; ++c) {
    if (first == 0 || first == all) {
      halves[0][c] = halves[1][c] = over_samples(x, y, whole.c[c]);
      continue;
    }
    ExactSum rest = whole.c[c];
    rest -= part.c[c];
    halves[0][c] = part.c[c].value() / double(first), halves[1][c] = rest.value() / double(all - first);
  }
  return halves;
}

double LayerFilm::variance_of_mean(int x, int y, int number, int channel) const {
  const auto n = std::uint32_t(passes(x, y));
  if (n < 2) return std::numeric_limits<double>::infinity();
  return spreads_[first_sum(x, y) + std::size_t(number + 1)].own[channel].moments(n).variance() / n;
}

}  // namespace montelux
