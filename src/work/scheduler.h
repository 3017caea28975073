// Distributes numbered units of work to threads, stage by stage.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace montelux {

// Work on one unit of a stage. `worker` is in [0, threads()); calls that run at the same time have different workers,
// so that each worker can have its own memory.
using UnitWork = std::function<void(std::size_t unit, int worker)>;

struct StageLimits {
  int threads = 0;                  // at most, in this stage; 0: all of the scheduler
  std::function<bool()> stop = {};  // queried before each unit, by one thread at a time: true ends the stage
};

// One scheduler for pixels, integrals and experiments. A stage is a call of run(): units are handed out in the order of
// their numbers, so a result that depends only on the unit, or is combined in their order, has the same bits for any
// number of threads. Stages run one after the other. A unit may call run() of a scheduler of its own.
class Scheduler {
 public:
  explicit Scheduler(int threads = 0);  // 0: all of the machine
  ~Scheduler();

  int threads() const { return threads_; }

  // Runs the units [0, count) and returns how many were run, always the first ones: fewer than `count` only if the
  // stage was stopped. If a unit throws, no more are handed out, and after the units in work have ended the exception
  // of the lowest one is thrown. The calling thread works, too.
  std::size_t run(std::size_t count, const UnitWork& work, const StageLimits& limits = {});

 private:
  struct Threads;
  int threads_;
  std::unique_ptr<Threads> pool_;
};

}  // namespace montelux
