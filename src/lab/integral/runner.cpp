#include "lab/integral/runner.h"

#include <algorithm>

namespace montelux::lab {

bool Runner::add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count) {
  constexpr std::uint64_t max_units = 4096;  // at a time
  const std::uint64_t cut = traits_.unit == 0 ? std::max<std::uint64_t>(1, count) : traits_.unit;
  const std::uint64_t units_of_pass = (count + cut - 1) / cut, all = units_of_pass * (end - begin);
  std::vector<TermSums> sums(end - begin, TermSums(LargestTerms::of_run));
  for (std::uint64_t done = 0; done < all; done += max_units) {
    std::vector<Unit> units;
    for (std::uint64_t u = done; u < std::min(all, done + max_units); ++u) {
      const auto pass = begin + std::uint32_t(u / units_of_pass);
      const std::uint64_t from = u % units_of_pass * cut;
      units.push_back(
          {{CubeKey::of(state_.seed, pass), first + from, std::min(cut, count - from), first, count}, pass});
    }
    if (!run_all(units)) return false;
    // In the order of the units, whichever thread computed them: the same bits for any number of threads.
    for (const Unit& unit : units) sums[unit.pass - begin].merge(unit.sums);
  }
  for (std::uint32_t pass = begin; pass < end; ++pass) enter(pass, sums[pass - begin]);
  return true;
}

bool Runner::run_all(std::span<Unit> units) {
  std::uint64_t samples = 0;
  for (const Unit& unit : units) samples += unit.part.count;
  // To wake a thread takes tens of microseconds: not for less than a few thousand samples each.
  const auto useful = int(std::clamp<std::uint64_t>(samples / 16384, 1, std::uint64_t(scheduler_.threads())));
  const auto run = [&](std::size_t i, int) { units[i].sums = technique_.run(units[i].part); };
  return scheduler_.run(units.size(), run, {useful, execution_.stop}) == units.size();
}

void Runner::enter(std::uint32_t pass, const TermSums& own) {
  PassRecord* record = &record_of(pass);
  TermSums sums;
  sums.samples = record->samples, sums.sum = record->sum, sums.m2 = record->m2;
  sums.merge(own);
  record->samples = sums.samples, record->sum = sums.sum, record->m2 = sums.m2;
  record->own_variance += own.own_variance;
  record->control_sum += own.control_sum;
  record->control_squares += own.control_squares;
  record->control_products += own.control_products;
  record->outside.merge(own.outside);
  record->magnitude += own.magnitude;
  state_.evaluations += own.evaluations, state_.non_finite += own.non_finite;
  state_.proposed += own.proposed, state_.accepted += own.accepted;
  state_.largest.merge(own.largest);
}

// The passes of a run are stored in the order of their numbers; a merged state may contain others.
PassRecord& Runner::record_of(std::uint32_t pass) {
  std::vector<PassRecord>& all = state_.passes;
  const auto is_it = [&](std::size_t i) {
    return i < all.size() && all[i].index == pass && all[i].seed == state_.seed;
  };
  if (!is_it(last_) && is_it(last_ + 1)) ++last_;
  for (std::size_t i = 0; i < all.size() && !is_it(last_); ++i)
    if (is_it(i)) last_ = i;
  if (!is_it(last_)) {
    all.push_back({});
    last_ = all.size() - 1;
    all[last_].seed = state_.seed, all[last_].index = pass;
  }
  return all[last_];
}

}  // namespace montelux::lab
