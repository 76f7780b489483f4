// The choice between double precision and fixed point: the rate of a device as its times say, what is
// remembered of it, and what follows from it.
#include "tuning/arithmetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "host/opencl/device.hpp"
#include "launchers/call/rates.cl.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::tuning {
namespace {

namespace fs = std::filesystem;
using testing::ScopedEnvironment;
using testing::TemporaryFolder;

// A device that computes so many steps a second, at full clock.
struct FakeDevice {
  double single_rate, double_rate;
  double launch = 30e-6;
  double first = 0;       // what the first launch of each kernel takes more, to compile it
  double idle_clock = 1;  // of the full clock, from which it rises
  double rise = 5e-3;     // seconds of work until it is full
  double worked = 0;      // seconds
  int launches = 0;
  std::map<Precision, int> by_precision = {};

  double run(Precision precision, std::size_t steps) {
    ++launches;
    const double clock = std::min(1.0, idle_clock + (1 - idle_clock) * worked / rise);
    const double rate = clock * (precision == Precision::float64 ? double_rate : single_rate);
    const double seconds =
        launch + (by_precision[precision]++ == 0 ? first : 0) + static_cast<double>(steps) / rate;
    worked += seconds;
    return seconds;
  }
  double slowness() {
    return slowness_of_fp64([this](Precision precision, std::size_t steps) { return run(precision, steps); });
  }
};

TEST(SmallArithmetic, TheRateIsFoundFromTimes) {
  for (const double single_rate : {1e3, 1e6, 1e8, 1e10}) {
    for (const double slowness : {0.5, 1.0, 2.0, 16.0, 64.0}) {
      FakeDevice device{single_rate, single_rate / slowness};
      device.first = 0.3;
      EXPECT_NEAR(device.slowness() / slowness, 1.0, 0.05) << single_rate << " / " << slowness;
    }
  }
}

TEST(SmallArithmetic, TheRateIsFoundWhileClocksRise) {
  for (const double slowness : {2.0, 64.0}) {
    FakeDevice device{1e7, 1e7 / slowness};
    device.idle_clock = 0.1;
    EXPECT_NEAR(std::log2(device.slowness() / slowness), 0.0, 0.5);
  }
}

// Steps a second of all lanes together: 77 million on a GPU of 2.5 GHz whose units compute 128 results a
// clock.
TEST(SmallArithmetic, MeasuringTakesMilliseconds) {
  for (const double single_rate : {2e6, 2e7, 8e7, 2e8}) {
    for (const double slowness : {2.0, 64.0}) {
      FakeDevice device{single_rate, single_rate / slowness};
      device.slowness();
      EXPECT_LT(device.worked, 0.02) << single_rate << " / " << slowness;
      EXPECT_LT(device.launches, 50);
    }
  }
}

TEST(SmallArithmetic, AClockThatStandsStillEndsTheMeasurement) {
  int launches = 0;
  const double slowness = slowness_of_fp64([&](Precision, std::size_t) {
    ++launches;
    return 0.0;
  });
  EXPECT_FALSE(slowness >= 1);
  EXPECT_LT(launches, 50);
}

// ---- What is remembered

constexpr const char* kKey = "device\ndriver 1";

struct CountedMeasurement {
  double result = 64;
  int calls = 0;
  std::function<double()> function() {
    return [this] {
      ++calls;
      return result;
    };
  }
};

TEST(SmallArithmetic, TheRateIsMeasuredOncePerKey) {
  const TemporaryFolder folder;
  const host::ProgramCache cache(folder.path());
  CountedMeasurement first{63.75}, second{2}, other{3};
  EXPECT_EQ(remembered_slowness(cache, kKey, first.function()), 63.75);
  EXPECT_EQ(remembered_slowness(host::ProgramCache(folder.path()), kKey, second.function()), 63.75);
  EXPECT_EQ(second.calls, 0);
  EXPECT_EQ(remembered_slowness(cache, "device\ndriver 2", other.function()), 3);
  EXPECT_EQ(other.calls, 1);
}

TEST(SmallArithmetic, DamagedFilesAreMeasuredAgain) {
  const TemporaryFolder folder;
  const host::ProgramCache cache(folder.path());
  const auto damage = [&](const std::string& text) {
    for (const auto& file : fs::directory_iterator(folder.path())) std::ofstream(file.path()) << text;
  };
  for (const char* const text : {"", "64", "flaunay program 1\n"}) {
    CountedMeasurement again{32}, then{16};
    cache.store(kKey, "");
    damage(text);
    EXPECT_EQ(remembered_slowness(cache, kKey, again.function()), 32) << text;
    EXPECT_EQ(remembered_slowness(cache, kKey, then.function()), 32) << text;
  }
  // Whole files whose content is none of ours.
  for (const char* const text : {"", "x", "-1", "0", "nan", "inf", "1e300"}) {
    cache.store(kKey, text);
    CountedMeasurement again{32};
    EXPECT_EQ(remembered_slowness(cache, kKey, again.function()), 32) << text;
    EXPECT_EQ(again.calls, 1) << text;
  }
}

TEST(SmallArithmetic, WhatNoDeviceHasIsNotRemembered) {
  const TemporaryFolder folder;
  const host::ProgramCache cache(folder.path());
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    CountedMeasurement measurement{wrong};
    remembered_slowness(cache, kKey, measurement.function());
    EXPECT_FALSE(cache.load(kKey)) << wrong;
  }
}

TEST(SmallArithmetic, FoldersThatCannotBeWrittenAreMeasuredEveryTime) {
  const TemporaryFolder folder;
  folder.write("file", "");
  // Below a file there is no folder, not even for root.
  for (const std::string& unusable : {std::string(), folder.path() + "/file/below"}) {
    CountedMeasurement measurement;
    for (int k = 1; k <= 2; ++k) {
      EXPECT_EQ(remembered_slowness(host::ProgramCache(unusable), kKey, measurement.function()), 64);
      EXPECT_EQ(measurement.calls, k);
    }
  }
}

TEST(SmallArithmetic, SeveralMeasureAtOnce) {
  const TemporaryFolder folder;
  std::vector<std::thread> threads;
  std::vector<double> results(8);
  for (std::size_t k = 0; k < results.size(); ++k) {
    threads.emplace_back([&, k] {
      for (int i = 0; i < 50; ++i) {
        results[k] = remembered_slowness(host::ProgramCache(folder.path()), kKey, [] { return 64.0; });
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double result : results) EXPECT_EQ(result, 64);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "no unfinished files";
}

// ---- What follows

bool chosen(const char* tuning, const std::function<double()>& slowness) {
  const auto runtime = testing::make_tuned_runtime(tuning);
  choose_arithmetic(*runtime, slowness);
  return runtime->capabilities().fixed_point;
}

TEST(SmallArithmetic, SlowFp64IsAvoided) {
  if (testing::tests_native()) GTEST_SKIP() << "the host has no other arithmetic";
  const std::size_t least = tuning_of(*testing::make_tuned_runtime("gpu")).fixed_point_from;
  ASSERT_GT(least, 2u) << "H100 and MI300X compute in double precision";
  ASSERT_LE(least, 32u) << "consumers' cards do not";
  const auto rate = [](double value) { return [value] { return value; }; };
  EXPECT_FALSE(chosen("gpu", rate(2)));
  EXPECT_FALSE(chosen("gpu", rate(static_cast<double>(least) - 0.1)));
  EXPECT_TRUE(chosen("gpu", rate(static_cast<double>(least))));
  EXPECT_TRUE(chosen("gpu", rate(64)));
  EXPECT_FALSE(chosen("gpu", rate(std::nan(""))));
  EXPECT_FALSE(chosen("gpu", []() -> double { throw std::runtime_error("no memory"); }));
}

TEST(SmallArithmetic, NothingIsMeasuredWhereItDecidesNothing) {
  CountedMeasurement measurement;
  for (const char* const tuning : {"cpu", "small", "gpu,fixed_point=0", "gpu,fixed_point_from=0"}) {
    EXPECT_FALSE(chosen(tuning, measurement.function())) << tuning;
  }
  if (!testing::tests_native()) {
    EXPECT_TRUE(chosen("gpu,fixed_point=1", measurement.function()));
    EXPECT_TRUE(chosen("cpu,fixed_point=1", measurement.function()));
  }
  EXPECT_EQ(measurement.calls, 0);
}

TEST(SmallArithmetic, CPUsAreNotMeasured) {
  const auto runtime = testing::make_tuned_runtime("gpu");
  if (!runtime->is_native() && (runtime->device().type() & CL_DEVICE_TYPE_CPU) == 0) GTEST_SKIP() << "a GPU";
  choose_arithmetic(*runtime);
  EXPECT_EQ(runtime->accounts().launches, 0u);
  EXPECT_FALSE(runtime->capabilities().fixed_point);
}

TEST(SmallArithmetic, TheDeviceIsMeasured) {
  const auto runtime = testing::make_tuned_runtime("own");
  if (runtime->is_native()) GTEST_SKIP() << "without a device";
  const double slowness = measured_slowness_of_fp64(*runtime);
  EXPECT_GT(slowness, 0.05);
  EXPECT_LT(slowness, 1000);
}

// Chains that pass below zero write what a plain loop computes.
TEST(SmallArithmetic, KernelsComputeTheirChains) {
  const auto runtime = testing::make_tuned_runtime("own");
  if (runtime->is_native()) GTEST_SKIP() << "without a device";
  const host::Arena::Scope scope(runtime->arena());
  for (const int steps : {1, 3, 16, 37}) {
    float x = 0;
    double y = 0;
    for (int k = 0; k < steps; ++k) {
      x = x * -3.0F + 1.0F;
      y = y * -3.0 + 1.0;
    }
    const auto in_single = testing::upload(*runtime, std::vector<cl_float>{7});
    const auto in_double = testing::upload(*runtime, std::vector<cl_double>{7});
    runtime->launch(1, 1, kernels::compute_in_single{.steps = steps, .factor = -3.0F, .result = in_single});
    runtime->launch(1, 1, kernels::compute_in_double{.steps = steps, .factor = -3.0, .result = in_double});
    EXPECT_EQ(testing::download(*runtime, in_single, 1)[0], x < 0 ? x : 7) << steps;
    EXPECT_EQ(testing::download(*runtime, in_double, 1)[0], y < 0 ? y : 7) << steps;
  }
}

}  // namespace
}  // namespace flaunay::tuning
