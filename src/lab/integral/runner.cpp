#include "lab/integral/runner.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

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
    // In the order of the units, whoever did them: the same bits for any number of threads.
    for (const Unit& unit : units) sums[unit.pass - begin].merge(unit.sums);
  }
  for (std::uint32_t pass = begin; pass < end; ++pass) enter(pass, sums[pass - begin]);
  return true;
}

bool Runner::run_all(std::span<Unit> units) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (std::size_t i; !stopped && (i = next.fetch_add(1)) < units.size();) {
        Unit& unit = units[i];
        unit.sums = technique_.run(unit.part);
        if (execution_.stop) {
          std::scoped_lock lock(mutex);
          if (execution_.stop()) stopped = true;
        }
      }
    } catch (...) {
      std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      stopped = true;
    }
  };
  std::uint64_t samples = 0;
  for (const Unit& unit : units) samples += unit.part.count;
  // A thread costs tens of microseconds to start: not for less than a few thousand samples each.
  const int wanted = execution_.threads > 0 ? execution_.threads : int(std::thread::hardware_concurrency());
  const int threads = int(std::clamp<std::uint64_t>(samples / 16384, 1, std::uint64_t(std::max(1, wanted))));
  {
    std::vector<std::jthread> pool;
    for (int i = 1; i < threads; ++i) pool.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return next >= units.size() && !stopped;
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

// The passes of a run stand one after the other, in the order of their numbers; a merged state may hold others.
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
