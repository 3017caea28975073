// The processor's treatment of numbers too small to be normal, while a thread renders.
#pragma once
#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace montelux {

// Denormals count as zero in this thread for the life of the object: the ray-tracing kernel wants it so for speed.
class FlushDenormals {
 public:
#if defined(__SSE__)
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~FlushDenormals() { _mm_setcsr(before_); }
#else
  FlushDenormals() = default;
#endif
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_ = 0;
};

}  // namespace montelux
