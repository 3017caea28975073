// A number that threads find out on their own, and all alike.
#pragma once
#include <atomic>
#include <cstdint>

namespace montelux {

// Each thread may read and write it at any time; what one writes others read at some time. Orders nothing else.
class SharedByte {
 public:
  std::uint8_t get() const { return value_.load(std::memory_order_relaxed); }
  void set(std::uint8_t value) { value_.store(value, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint8_t> value_{0};
};

}  // namespace montelux
