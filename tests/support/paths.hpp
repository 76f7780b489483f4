// What tests find on disk: where the build has it, unless the environment names another place, for programs
// that were built on another machine (scripts/gpu.py --prebuilt).
#pragma once

#include <cstdlib>
#include <string>

namespace flaunay {

inline std::string path_or(const char* variable, const char* built) {
  const char* const named = std::getenv(variable);
  return named != nullptr && *named != '\0' ? named : built;
}

#ifdef FLAUNAY_TEST_DATA
/// The folder tests/data of the source tree.
inline std::string test_data() { return path_or("FLAUNAY_TEST_DATA", FLAUNAY_TEST_DATA); }
#endif
#ifdef FLAUNAY_EXECUTABLE
inline std::string flaunay_executable() { return path_or("FLAUNAY_EXECUTABLE", FLAUNAY_EXECUTABLE); }
#endif
#ifdef FLAUNAY_BENCH
inline std::string bench_executable() { return path_or("FLAUNAY_BENCH", FLAUNAY_BENCH); }
#endif
#ifdef FLAUNAY_PLOT
inline std::string plot_program() { return path_or("FLAUNAY_PLOT", FLAUNAY_PLOT); }
#endif

}  // namespace flaunay
