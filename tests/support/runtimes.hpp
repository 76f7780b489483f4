// Runtimes that the tests of a program share.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"
#include "host/runtime.hpp"
#include "tests/support/device.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::testing {

/// The sizes of work-groups that a test of kernels goes through.
constexpr std::size_t kGroupsToTest[] = {1, 2, 32, 64, 256};

/// Whether tests run kernels natively, on the host, and not on a device.
inline bool tests_native() {
  const char* const device = std::getenv("FLAUNAY_TEST_DEVICE");
  return device != nullptr && device == std::string(host::kHostName);
}

/// Tunings of devices that compute in fixed point, with a CPU's sizes and with a GPU's. None natively, since
/// the host has doubles.
inline std::vector<std::string> fixed_point_tunings() {
  if (tests_native()) return {};
  return {"fixed_point=1", "gpu,fixed_point=1"};
}

/// "own": the tuning that the environment names, or else the device's.
inline std::unique_ptr<host::Runtime> make_tuned_runtime(const std::string& tuning) {
  const char* const before = std::getenv("FLAUNAY_TUNING");
  const ScopedEnvironment kind("FLAUNAY_TUNING", tuning == "own" ? before : tuning.c_str());
  if (tests_native()) return std::make_unique<host::Runtime>(native_tuning());
  const auto device = host::find_device("");
  return std::make_unique<host::Runtime>(device, settings_for(device));
}

/// A runtime, or an engine, for each name, made by `make` when it is first needed. They end with the tests,
/// before the OpenCL implementation leaves, if an object of this is one of the program's global environments.
template <auto make>
class SharedRuntimes : public ::testing::Environment {
  using Made = decltype(make(std::string()));

 public:
  void TearDown() override { all().clear(); }

  static auto& get(const std::string& name) {
    Made& entry = all()[name];
    if (!entry) entry = make(name);
    return *entry;
  }

 private:
  static std::map<std::string, Made>& all() {
    static std::map<std::string, Made> all;
    return all;
  }
};

}  // namespace flaunay::testing
