// The scheduler: every unit once, in order, side by side; stops and exceptions.
#include "work/scheduler.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace montelux::test {
namespace {

TEST(Scheduler, runs_each_unit_once) {
  for (int threads : {1, 2, 3, 16}) {
    Scheduler scheduler(threads);
    EXPECT_EQ(scheduler.threads(), threads);
    for (std::size_t count : {0, 1, 2, 1000}) {
      std::vector<int> runs(count, 0);  // a unit's own element: no lock
      EXPECT_EQ(scheduler.run(count, [&](std::size_t unit, int) { ++runs[unit]; }), count);
      EXPECT_EQ(runs, std::vector<int>(count, 1));
    }
  }
}

TEST(Scheduler, has_all_threads_of_the_machine_by_default) {
  EXPECT_EQ(Scheduler().threads(), int(std::thread::hardware_concurrency()));
}

TEST(Scheduler, runs_as_many_units_at_once_as_there_are_threads) {
  // More than the machine has, too.
  constexpr int threads = 6;
  Scheduler scheduler(threads);
  std::atomic<int> met{0};
  const auto since = std::chrono::steady_clock::now();
  scheduler.run(threads, [&](std::size_t, int) {
    ++met;
    while (met < threads && std::chrono::steady_clock::now() - since < std::chrono::seconds(30))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  EXPECT_LT(std::chrono::steady_clock::now() - since, std::chrono::seconds(30));
}

TEST(Scheduler, gives_units_at_the_same_time_different_workers) {
  constexpr int threads = 4;
  Scheduler scheduler(threads);
  std::vector<std::atomic<int>> busy(threads);
  std::atomic<int> clashes{0};
  scheduler.run(400, [&](std::size_t, int worker) {
    if (++busy[std::size_t(worker)] != 1) ++clashes;
    std::this_thread::sleep_for(std::chrono::microseconds(50));
    --busy[std::size_t(worker)];
  });
  EXPECT_EQ(clashes, 0);
}

TEST(Scheduler, keeps_to_the_threads_of_a_stage) {
  Scheduler scheduler(8);
  std::atomic<int> running{0}, largest{0};
  scheduler.run(100,
                [&](std::size_t, int worker) {
                  const int now = ++running;
                  int seen = largest;
                  while (seen < now && !largest.compare_exchange_weak(seen, now)) {
                  }
                  EXPECT_LT(worker, 2);
                  std::this_thread::sleep_for(std::chrono::microseconds(100));
                  --running;
                },
                {.threads = 2});
  EXPECT_LE(largest, 2);
}

TEST(Scheduler, sees_what_the_stage_before_has_written) {
  Scheduler scheduler(4);
  std::vector<std::uint64_t> values(64, 1);
  for (int stage = 0; stage < 50; ++stage) {
    std::vector<std::uint64_t> next(values.size());
    scheduler.run(values.size(), [&](std::size_t i, int) { next[i] = values[i] + values[(i + 1) % values.size()]; });
    values = next;
  }
  EXPECT_EQ(values, std::vector<std::uint64_t>(64, std::uint64_t{1} << 50));
}

TEST(Scheduler, stops_after_a_first_part_of_the_units) {
  Scheduler scheduler(3);
  std::vector<int> runs(1000, 0);
  std::atomic<int> done{0};
  const std::size_t run = scheduler.run(runs.size(),
                                        [&](std::size_t unit, int) {
                                          ++runs[unit];
                                          ++done;
                                        },
                                        {.stop = [&] { return done >= 10; }});
  EXPECT_GE(run, 10u);
  EXPECT_LT(run, 20u);
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i], i < run ? 1 : 0) << i;
}

TEST(Scheduler, throws_what_the_lowest_unit_has_thrown) {
  Scheduler scheduler(4);
  std::atomic<int> started{0};
  try {
    scheduler.run(1000, [&](std::size_t unit, int) {
      ++started;
      // All of the first four are in work before one of them throws.
      while (unit < 4 && started < 4) std::this_thread::yield();
      if (unit > 0) throw std::runtime_error("unit " + std::to_string(unit));
    });
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "unit 1");
  }
  EXPECT_LT(started, 100);
  // It continues to work.
  EXPECT_EQ(scheduler.run(10, [](std::size_t, int) {}), 10u);
}

TEST(Scheduler, can_be_used_within_a_unit) {
  Scheduler scheduler(3);
  std::vector<std::size_t> sums(20, 0);
  scheduler.run(sums.size(), [&](std::size_t unit, int) {
    std::vector<std::size_t> parts(50, 0);
    Scheduler inner(2);
    inner.run(parts.size(), [&](std::size_t i, int) { parts[i] = i * unit; });
    sums[unit] = std::accumulate(parts.begin(), parts.end(), std::size_t{0});
  });
  for (std::size_t unit = 0; unit < sums.size(); ++unit) EXPECT_EQ(sums[unit], 1225 * unit);
}

}  // namespace
}  // namespace montelux::test
