// Threads of oneTBB, without its types. Internal to the scheduler.
#pragma once
#include <memory>

namespace montelux {

class Arena {
 public:
  explicit Arena(int threads);
  ~Arena();

  // Calls body(data, worker) for each worker in [0, workers), in parallel if there are enough threads; the calling
  // thread is one of them. Returns after all calls. The body must not throw, and no call may wait for another one.
  void run(int workers, void (*body)(void* data, int worker), void* data);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace montelux
