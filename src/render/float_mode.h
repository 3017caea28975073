// How the processor treats denormal numbers while a thread renders.
#pragma once
#if defined(__SSE__)
#include <immintrin.h>
#endif

namespace montelux {

// Denormals are zero in this thread during the life of the object: the ray-tracing kernel requires this for speed.
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
