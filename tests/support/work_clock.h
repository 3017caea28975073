// A clock that work itself moves on: nobody waits, and the machine's load plays no part.
#pragma once
#include <atomic>

#include "render/stopwatch.h"

namespace montelux::test {

// The seconds that all work has taken by its own account. Exact while they are sums of powers of two.
class WorkClock {
 public:
  void pass(double seconds) { seconds_ += seconds; }
  SecondsClock clock() const {
    return [this] { return seconds_.load(); };
  }

 private:
  std::atomic<double> seconds_{0};
};

}  // namespace montelux::test
