#include "work/scheduler.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "work/arena.h"

namespace montelux {

struct Scheduler::Threads {
  explicit Threads(int count) : arena(count) {}
  Arena arena;
};

namespace {

class Stage {
 public:
  Stage(std::size_t count, const UnitWork& work, const StageLimits& limits)
      : count_(count), work_(work), limits_(limits) {}

  void run(int worker) {
    // Together with `publish`: units see what was written before the stage, and code after the stage sees their writes.
    published_.load(std::memory_order_acquire);
    for (std::size_t unit; take(unit);) {
      try {
        work_(unit, worker);
      } catch (...) {
        fail(unit);
      }
    }
    published_.fetch_add(1, std::memory_order_acq_rel);
  }
  void publish() { published_.fetch_add(1, std::memory_order_acq_rel); }

  std::size_t result() {
    publish();
    if (failure_) std::rethrow_exception(failure_);
    return next_;
  }

 private:
  bool take(std::size_t& unit) {
    const std::scoped_lock lock(mutex_);
    if (over_ || next_ == count_) return false;
    if (limits_.stop && limits_.stop()) {
      over_ = true;
      return false;
    }
    unit = next_++;
    return true;
  }
  void fail(std::size_t unit) {
    const std::scoped_lock lock(mutex_);
    over_ = true;
    if (failure_ && failed_ < unit) return;
    failure_ = std::current_exception(), failed_ = unit;
  }

  const std::size_t count_;
  const UnitWork& work_;
  const StageLimits& limits_;
  std::atomic<int> published_{0};
  std::mutex mutex_;  // guards what follows
  std::size_t next_ = 0;
  bool over_ = false;
  std::exception_ptr failure_;
  std::size_t failed_ = 0;
};

}  // namespace

Scheduler::Scheduler(int threads)
    : threads_(threads > 0 ? threads : int(std::max(1u, std::thread::hardware_concurrency()))),
      pool_(std::make_unique<Threads>(threads_)) {}
Scheduler::~Scheduler() = default;

std::size_t Scheduler::run(std::size_t count, const UnitWork& work, const StageLimits& limits) {
  Stage stage(count, work, limits);
  const int max_workers = limits.threads > 0 ? std::min(limits.threads, threads_) : threads_;
  const int workers = int(std::min(std::size_t(max_workers), count));
  stage.publish();
  if (workers <= 1)
    stage.run(0);
  else
    pool_->arena.run(
        workers, [](void* data, int worker) { static_cast<Stage*>(data)->run(worker); }, &stage);
  return stage.result();
}

}  // namespace montelux
