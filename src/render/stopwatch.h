// How long work has taken.
#pragma once
#include <chrono>
#include <functional>

namespace montelux {

// A moment in seconds; only differences mean anything. An empty one stands for the machine's own clock.
using SecondsClock = std::function<double()>;

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
