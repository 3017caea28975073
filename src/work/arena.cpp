#include "work/arena.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <thread>
#include <vector>

namespace montelux {

struct Arena::State {
  explicit State(int count) : threads(count) {}
  const int threads;
  int size = 0;  // of the arena
  std::optional<tbb::task_arena> arena;

  void resize(int wanted) {
    if (size != wanted) arena.emplace(wanted);
    size = wanted;
  }
};

Arena::Arena(int threads) : state_(std::make_unique<State>(threads)) {}
Arena::~Arena() = default;

void Arena::run(int workers, void (*body)(void* data, int worker), void* data) {
  using tbb::global_control;
  // The limit applies to the process: that of the machine, or a lower one that a device of Embree has set. Workers
  // beyond it are separate threads, so that a stage has as many workers as requested.
  const auto allowed = int(global_control::active_value(global_control::max_allowed_parallelism));
  state_->resize(std::min(state_->threads, allowed));
  const int shared = std::min(workers, state_->size);
  std::vector<std::jthread> more;
  for (int worker = shared; worker < workers; ++worker) more.emplace_back([=] { body(data, worker); });
  state_->arena->execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, shared, 1),
        [&](const tbb::blocked_range<int>& some) {
          for (int worker = some.begin(); worker < some.end(); ++worker) body(data, worker);
        },
        tbb::simple_partitioner());
  });
}

}  // namespace montelux
