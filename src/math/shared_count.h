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
  std::uint32_t take() { return count_.exchange(0, std::memory_order_relaxed); }

 private:
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace montelux
