// Whether this program runs with the address sanitizer, which is slower and has memory of its own. The
// objects of tests may be those of a build without it.
#pragma once

extern "C" void __asan_init() __attribute__((weak));

namespace flaunay::testing {

inline bool is_sanitized() { return __asan_init != nullptr; }

}  // namespace flaunay::testing
