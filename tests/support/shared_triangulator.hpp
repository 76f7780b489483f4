// One Triangulator for all tests of a program.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "flaunay/flaunay.hpp"

namespace flaunay::testing {

/// One per process: building its programs takes longer than most tests. It ends with the tests and not among
/// the process's statics, since some OpenCL implementations (oclgrind) have destroyed theirs by then.
class SharedTriangulator : public ::testing::Environment {
 public:
  static Triangulator& get() {
    if (!instance()) instance() = std::make_unique<Triangulator>();
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
