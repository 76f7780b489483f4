// Whether this program runs with the address sanitizer, which is slower and has memory of its own. The
// objects of tests may be those of a build without it.
#pragma once

#ifdef __ELF__
extern "C" void __asan_init() __attribute__((weak));
#endif

namespace flaunay::testing {

inline bool is_sanitized() {
#ifdef __ELF__
  return __asan_init != nullptr;
#else
  return false;
#endif
}

}  // namespace flaunay::testing
