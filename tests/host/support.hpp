// What the tests of src host share: runtimes of several tunings, arrays compared bit by bit, errors.
#pragma once

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "host/error.hpp"
#include "host/opencl/device.hpp"
#include "host/runtime.hpp"
#include "tests/support/device.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::host {

using testing::download;
using testing::guarded;
using testing::ScopedEnvironment;
using testing::TemporaryFolder;
using testing::upload;

using Random = std::mt19937_64;

/// "own": what the device would get, or what the environment names, and then no other; the others are for
/// boundaries.
const char* const kTunings[] = {"own", "small", "gpu"};

inline Tuning tuning_named(const std::string& name) {
  const auto device = find_device("");
  if (name == "own") return settings_for(device).sizes->tuning();
  const ScopedEnvironment kind("FLAUNAY_TUNING", name.c_str());
  return settings_for(device).sizes->tuning();
}

/// One runtime for each tuning, destroyed before the OpenCL implementation leaves.
class Runtimes : public ::testing::Environment {
 public:
  void TearDown() override { runtimes().clear(); }
  static Runtime& get(const std::string& tuning) {
    std::unique_ptr<Runtime>& runtime = runtimes()[tuning];
    if (!runtime) {
      runtime = std::make_unique<Runtime>(find_device(""), settings_for(find_device("")));
      runtime->set_sizes(std::make_shared<Tuning>(tuning_named(tuning)));
    }
    return *runtime;
  }

 private:
  static std::map<std::string, std::unique_ptr<Runtime>>& runtimes() {
    static std::map<std::string, std::unique_ptr<Runtime>> all;
    return all;
  }
};
[[maybe_unused]] inline ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Each tuning must give what the plain loop gives, so all give the same.
template <typename Check>
void under_each_tuning(const Check& check) {
  const bool chosen = std::getenv("FLAUNAY_TUNING") != nullptr;
  for (const char* const tuning : kTunings) {
    if (chosen && tuning != kTunings[0]) continue;
    SCOPED_TRACE(std::string("tuning ") + tuning);
    Runtime& runtime = Runtimes::get(tuning);
    const Arena::Scope scope(runtime.arena());
    check(runtime);
    if (::testing::Test::HasFailure()) return;
  }
}

/// Equality of long arrays, bit by bit; names the first difference.
template <typename T>
void expect_same(const std::vector<T>& actual, const std::vector<T>& expected, const std::string& what) {
  ASSERT_EQ(actual.size(), expected.size()) << what;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (std::memcmp(&actual[i], &expected[i], sizeof(T)) != 0) {
      if constexpr (std::is_arithmetic_v<T>) {
        FAIL() << what << ": element " << i << " of " << actual.size() << " is " << +actual[i] << ", not "
               << +expected[i];
      }
      FAIL() << what << ": element " << i << " of " << actual.size() << " differs";
    }
  }
}

/// The message of the DeviceError that a call must throw.
template <typename Call>
std::string message_of(const Call& call, cl_int code) {
  try {
    call();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no DeviceError";
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace flaunay::host
