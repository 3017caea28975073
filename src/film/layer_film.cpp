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
  // Welford's recurrence for each layer, and for its product with all light (Bennett et al. 2009, eq. 5.1), whose
  // deviation is taken from its mean before this pass.
  const double n = counts.passes;
  for (int c = 0; c < spectrum_size; ++c) {
    const double all_off = sums[0].c[c].value() / samples - spreads_[first].mean[c];
    for (std::size_t i = 0; i < sums.size(); ++i) {
      LayerSpread& s = spreads_[first + i];
      const double value = sums[i].c[c].value() / samples, off = value - s.mean[c];
      s.mean[c] += off / n;
      s.m2[c] += off * (value - s.mean[c]);
      s.co_moment[c] += all_off * (value - s.mean[c]);
    }
  }
}

void LayerFilm::merge(const LayerFilm& other) {
  if (!(bounds_ == other.bounds_) || count_ != other.count_ || has_spread() != other.has_spread())
    throw std::invalid_argument("films of different layers cannot be merged");
  const std::size_t stride = std::size_t(count_) + 1;
  for (std::size_t p = 0; p < counts_.size(); ++p) {
    Counts& counts = counts_[p];
    const Counts& more = other.counts_[p];
    for (std::size_t i = p * stride; i < (p + 1) * stride; ++i) sums_[i] += other.sums_[i];
    if (has_spread() && more.passes > 0) {
      const double n = double(counts.passes) + double(more.passes), share = double(more.passes) / n,
                   product = double(counts.passes) * share;
      for (int c = 0; c < spectrum_size; ++c) {
        const double all_off = other.spreads_[p * stride].mean[c] - spreads_[p * stride].mean[c];
        for (std::size_t i = p * stride; i < (p + 1) * stride; ++i) {
          LayerSpread& a = spreads_[i];
          const LayerSpread& b = other.spreads_[i];
          const double off = b.mean[c] - a.mean[c];
          a.mean[c] += off * share;
          a.m2[c] += b.m2[c] + off * off * product;
          a.co_moment[c] += b.co_moment[c] + off * all_off * product;
        }
      }
    }
    counts.samples += more.samples, counts.passes += more.passes;
  }
}

double LayerFilm::variance_of_mean(int x, int y, int number, int channel) const {
  const int n = passes(x, y);
  if (n < 2) return std::numeric_limits<double>::infinity();
  return spread(x, y, number).m2[channel] / (n - 1.0) / n;
}

}  // namespace montelux
