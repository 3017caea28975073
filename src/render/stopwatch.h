// How long work has taken.
#pragma once
#include <chrono>
#include <ctime>
#include <functional>

namespace montelux {

// A moment in seconds; only differences mean anything. An empty one stands for the machine's own clock.
using SecondsClock = std::function<double()>;

// A clock that counts the time that processors spend on this program, over all its threads: the same on a machine that
// others use, too. Time that threads wait for each other is none.
inline double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

class Stopwatch {
 public:
  explicit Stopwatch(SecondsClock clock = {}) : clock_(std::move(clock)), start_(now()) {}
  // Since it was made.
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
