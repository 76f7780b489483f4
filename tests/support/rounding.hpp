// How devices round floats, on the host.
#pragma once

#include <cfenv>

#ifdef __SSE2__
#include <pmmintrin.h>
#endif

namespace flaunay::testing {

/// How operations on floats round while this lives.
class Rounding {
 public:
  Rounding(int direction, bool flushes) : direction_(std::fegetround()) {
    std::fesetround(direction);
#ifdef __SSE2__
    flush(flushes);
#else
    static_cast<void>(flushes);
#endif
  }
  ~Rounding() {
    std::fesetround(direction_);
#ifdef __SSE2__
    flush(false);
#endif
  }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;

 private:
#ifdef __SSE2__
  static void flush(bool flushes) {
    _MM_SET_FLUSH_ZERO_MODE(flushes ? _MM_FLUSH_ZERO_ON : _MM_FLUSH_ZERO_OFF);
    _MM_SET_DENORMALS_ZERO_MODE(flushes ? _MM_DENORMALS_ZERO_ON : _MM_DENORMALS_ZERO_OFF);
  }
#endif
  int direction_;
};

struct Device {
  const char* name;
  int direction;
  bool flushes;
};

}  // namespace flaunay::testing
