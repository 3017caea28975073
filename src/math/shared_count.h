// Counts to which many threads add at once.
#pragma once
#include <atomic>
#include <cstdint>

namespace montelux {

class SharedCount {
 public:
  // Adds one; gives the count before. Every value is given once.
  std::uint32_t next() { return count_.fetch_add(1, std::memory_order_relaxed); }
  // The count so far, which begins at zero again. Only while nobody adds.
  std::uint32_t take() {
    const std::uint32_t count = count_.load(std::memory_order_relaxed);
    count_.store(0, std::memory_order_relaxed);  // not exchange(), which takes as long as an addition among threads
    return count;
  }

 private:
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace montelux
