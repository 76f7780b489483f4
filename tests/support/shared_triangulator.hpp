// One Triangulator for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "flaunay/flaunay.hpp"

namespace flaunay::testing {

/// The name of the device that tests use. It is a device of OpenCL unless FLAUNAY_TEST_DEVICE names another
/// one, which can be "host", or "" for the triangulator's own choice.
inline std::string device_under_test() {
  if (const char* given = std::getenv("FLAUNAY_TEST_DEVICE")) return given;
  const char* const named = std::getenv("FLAUNAY_DEVICE");
  return named != nullptr && *named != '\0' ? named : "#0";
}

/// One per process: building its programs takes longer than most tests. It ends with the tests and not among
/// the process's statics, since some OpenCL implementations (oclgrind) have destroyed theirs by then.
class SharedTriangulator : public ::testing::Environment {
 public:
  static Triangulator& get() {
    if (!instance()) instance() = std::make_unique<Triangulator>(device_under_test());
    return *instance();
  }
  void TearDown() override { instance().reset(); }

 private:
  static std::unique_ptr<Triangulator>& instance() {
    static std::unique_ptr<Triangulator> triangulator;
    return triangulator;
  }
};
[[maybe_unused]] inline ::testing::Environment* const kSharedTriangulator =
    ::testing::AddGlobalTestEnvironment(new SharedTriangulator);

inline Triangulator& triangulator() { return SharedTriangulator::get(); }

}  // namespace flaunay::testing
