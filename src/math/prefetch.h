// Loads that are started before they are needed, so that many are under way at the same time.
#pragma once
#include "math/lanes.h"

namespace montelux {

// Starts to load what is at this place. It only saves time: no value depends on it.
template <class T>
MONTELUX_INLINE void prefetch(const T* place) {
  const char* first = reinterpret_cast<const char*>(place);
#if defined(__x86_64__)
  asm volatile("prefetcht0 %0" : : "m"(*first));  // g++ 12 removes its own function here
#else
  __builtin_prefetch(first);
#endif
}
// The same for base[i] in every lane that is on.
template <class T, int N>
MONTELUX_INLINE void prefetch(const T* base, Uints<N> i, Bools<N> on) {
  for_each_lane(on, [&](int k) { prefetch(base + lane(i, k)); });
}
// A single lane waits for one value at a time in any case.
template <class T>
MONTELUX_INLINE void prefetch(const T*, std::uint32_t, bool) {}

}  // namespace montelux
