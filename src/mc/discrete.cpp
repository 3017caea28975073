#include "mc/discrete.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace montelux {

namespace {

double checked_total(std::span<const double> weights) {
  if (weights.empty()) throw std::invalid_argument("a discrete distribution needs at least one weight");
  double total = 0;
  for (double w : weights) {
    if (!(w >= 0) || !std::isfinite(w)) throw std::invalid_argument("a weight must be finite and not negative");
    total += w;
  }
  if (!std::isfinite(total)) throw std::invalid_argument("the sum of the weights must be finite");
  return total;
}

}  // namespace

IntervalIndex::IntervalIndex(std::span<const float> sums, std::uint32_t n) : n_(n), parts_(std::bit_floor(n)) {
  if (parts_ > 4) parts_ /= 4;
  const std::size_t rows = sums.size() / (std::size_t(n) + 1);
  first_.reserve(rows * (std::size_t(parts_) + 1));
  for (std::size_t row = 0; row < rows; ++row) {
    const float* ascending = sums.data() + row * (std::size_t(n) + 1);
    std::uint32_t i = 0;
    for (std::uint32_t part = 0; part <= parts_; ++part) {
      const float start = float(part) / float(parts_);
      while (i + 1 < n && ascending[i + 1] <= start) ++i;
      first_.push_back(i);
    }
  }
}

std::vector<float> cumulative_sums(std::span<const double> weights) {
  const double total = checked_total(weights);
  std::vector<float> sums{0.0f};
  double running = 0;
  for (double w : weights) {
    running += w;
    sums.push_back(total > 0 ? float(running / total) : float(double(sums.size()) / double(weights.size())));
  }
  return sums;
}

AliasTable::AliasTable(std::span<const double> weights) {
  const double total = checked_total(weights);
  const std::size_t n = weights.size();
  std::vector<double> scaled(n);
  std::vector<std::uint32_t> poor, rich;
  alias_.resize(n), share_.resize(n), mass_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = total > 0 ? weights[i] / total : 1 / double(n);
    mass_[i] = float(mass);
    scaled[i] = mass * double(n);
    (scaled[i] < 1 ? poor : rich).push_back(std::uint32_t(i));
  }
  // Each underfull bin is filled up by an overfull element, which may become underfull itself.
  while (!poor.empty() && !rich.empty()) {
    const std::uint32_t low = poor.back(), high = rich.back();
    poor.pop_back();
    share_[low] = float(scaled[low]);
    alias_[low] = high;
    scaled[high] -= 1 - scaled[low];
    if (scaled[high] < 1) rich.pop_back(), poor.push_back(high);
  }
  // Elements that remain because of rounding fill their own bins; an element of weight zero never does.
  for (std::uint32_t i : rich) share_[i] = 1, alias_[i] = i;
  std::uint32_t heaviest = 0;
  for (std::uint32_t i = 0; i < n; ++i)
    if (mass_[i] > mass_[heaviest]) heaviest = i;
  for (std::uint32_t i : poor) {
    share_[i] = mass_[i] > 0 ? 1.0f : 0.0f;
    alias_[i] = heaviest;
  }
  list_parts();
}

void AliasTable::list_parts() {
  std::vector<std::vector<std::uint32_t>> bins(size());
  for (std::uint32_t i = 0; i < size(); ++i)
    if (share_[i] > 0) bins[i].push_back(i);
  for (std::uint32_t i = 0; i < size(); ++i)
    if (share_[i] < 1 && alias_[i] != i) bins[alias_[i]].push_back(i);
  first_part_ = {0};
  for (std::uint32_t i = 0; i < size(); ++i) {
    double before = 0;
    for (std::uint32_t bin : bins[i]) {
      part_bin_.push_back(bin);
      part_start_.push_back(std::min(float(before / (double(mass_[i]) * size())), one_minus_epsilon));
      before += bin == i ? double(share_[bin]) : 1 - double(share_[bin]);
    }
    first_part_.push_back(std::uint32_t(part_bin_.size()));
    max_parts_ = std::max(max_parts_, first_part_[i + 1] - first_part_[i]);
  }
}

}  // namespace montelux
