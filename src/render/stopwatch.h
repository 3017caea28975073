// Measures how long work takes.
#pragma once
#include <chrono>
#include <ctime>
#include <functional>

namespace montelux {

// Returns the time in seconds from any origin. Empty: the clock of the machine.
using SecondsClock = std::function<double()>;

// The processor time of this program, summed over its threads. It does not depend on the load of the machine, and
// excludes the time in which threads wait.
inline double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

class Stopwatch {
 public:
  explicit Stopwatch(SecondsClock clock = {}) : clock_(std::move(clock)), start_(now()) {}
  // Since the construction.
  double seconds() const { return now() - start_; }

 private:
  double now() const {
    if (clock_) return clock_();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  SecondsClock clock_;
  double start_;
};

}  // namespace montelux
