// Threads of oneTBB, without its types. Inside the scheduler only.
#pragma once
#include <memory>

namespace montelux {

class Arena {
 public:
  explicit Arena(int threads);
  ~Arena();

  // Calls body(data, worker) for each worker in [0, workers), side by side as far as there are threads; the calling
  // thread is one of them. Returns when all calls have. The body must not throw, and no call may wait for another.
  void run(int workers, void (*body)(void* data, int worker), void* data);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace montelux
