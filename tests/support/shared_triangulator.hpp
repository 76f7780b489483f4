// One Triangulator for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include "flaunay/flaunay.hpp"
#include "tests/support/environment.hpp"

namespace flaunay::testing {

/// The name of the device that tests use. It is a device of OpenCL unless FLAUNAY_TEST_DEVICE names another
/// one, which can be "host", or "" for the triangulator's own choice.
inline std::string device_under_test() {
  if (const char* device = std::getenv("FLAUNAY_TEST_DEVICE")) return device;
  const char* const named = std::getenv("FLAUNAY_DEVICE");
  return named != nullptr && *named != '\0' ? named : "#0";
}

/// One per process and tuning: building its programs takes longer than most tests. They end with the tests
/// and not among the process's statics, since some OpenCL implementations (oclgrind) have destroyed theirs by
/// then.
class SharedTriangulators : public ::testing::Environment {
 public:
  /// tuning: as FLAUNAY_TUNING has it; "": the one that the environment names, or else the device's.
  static Triangulator& get(const std::string& tuning) {
    std::unique_ptr<Triangulator>& triangulator = all()[tuning];
    if (!triangulator) {
      const char* const before = std::getenv("FLAUNAY_TUNING");
      const ScopedEnvironment kind("FLAUNAY_TUNING", tuning.empty() ? before : tuning.c_str());
      triangulator = std::make_unique<Triangulator>(device_under_test());
    }
    return *triangulator;
  }
  void TearDown() override { all().clear(); }

 private:
  static std::map<std::string, std::unique_ptr<Triangulator>>& all() {
    static std::map<std::string, std::unique_ptr<Triangulator>> triangulators;
    return triangulators;
  }
};
[[maybe_unused]] inline ::testing::Environment* const kSharedTriangulators =
    ::testing::AddGlobalTestEnvironment(new SharedTriangulators);

/// Whether a triangulator has the sizes that suit a GPU, by its device or by the environment.
inline bool has_gpu_sizes(const Triangulator& made) {
  const char* const tuning = std::getenv("FLAUNAY_TUNING");
  return made.device().type == "GPU" || (tuning != nullptr && std::string(tuning).rfind("gpu", 0) == 0);
}

inline Triangulator& triangulator() { return SharedTriangulators::get(""); }
inline Triangulator& triangulator_with(const std::string& tuning) { return SharedTriangulators::get(tuning); }

}  // namespace flaunay::testing
