// What the tests of the flattened stages share: runtimes, the state of a call, points.
#pragma once

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "modes/flattened/stages.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"

namespace flaunay::flattened {

using namespace geometry;
using namespace statistics;

using host::Runtime;
using testing::Coordinates;
using testing::FixtureRandom;
using testing::make_fixture;
using testing::same;

/// Odd, tiny sizes, with small regions so small that many others count as large.
constexpr const char* kSmallTuning = "small,small_region=4";

using Runtimes = testing::SharedRuntimes<testing::make_tuned_runtime>;
[[maybe_unused]] inline ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Under the tuning that the environment names alone, if it names one.
template <typename Check>
void under_each_tuning(const Check& check) {
  for (const char* const tuning : {"own", kSmallTuning}) {
    if (tuning == kSmallTuning && std::getenv("FLAUNAY_TUNING") != nullptr) continue;
    SCOPED_TRACE(tuning);
    check(Runtimes::get(tuning));
  }
}

/// Bounds under which no filter decides anything: all goes to the exact kernels.
constexpr Bounds kUndecided{2, 2, 2};

/// What triangulator.cpp sets up around the stages; state is never released before the end.
class Call {
 public:
  explicit Call(Runtime& used)
      : runtime(used),
        persistent_(used.memory()),
        state_(used.memory()),
        scope_(used.arena()),
        work{used, persistent_, levels_} {
    work.children = &state_;
    work.broken = persistent_.allocate<cl_int>(1);
    work.list_length = persistent_.allocate<cl_uint>(1);
    work.undecided = persistent_.allocate<cl_uint>(1);
    work.largest = persistent_.allocate<cl_int>(kMostLevels);
    runtime.fill(work.broken, 1, cl_int{0});
    runtime.fill(work.undecided, 1, cl_uint{0});
    runtime.fill(work.largest, kMostLevels, cl_int{0});
  }

  template <typename T>
  std::vector<T> read(const Buffer<T>& buffer, std::size_t count) {
    std::vector<T> values(count);
    runtime.read(buffer, 0, count, values.data());
    return values;
  }
  cl_int broken() { return runtime.read_one(work.broken, 0); }

  Runtime& runtime;

 private:
  Arena persistent_, state_;
  Arena::Scope scope_;
  std::vector<LevelStatistics> levels_;

 public:
  Workspace work;
};

/// Few values of coordinates, so that points coincide and line up.
inline Coordinates coarse_points(std::size_t n, int values, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const auto value = static_cast<double>(random.integer(-values, values));
    points.push_back(value == 0 && random.integer(0, 1) == 0 ? -0.0 : value);
  }
  return points;
}

/// Sizes of sets, some of them 0, as offsets.
inline std::vector<std::size_t> random_offsets(std::size_t sets, std::int64_t largest,
                                               FixtureRandom& random) {
  std::vector<std::size_t> offsets{0};
  for (std::size_t s = 0; s < sets; ++s) {
    const std::int64_t size = random.integer(0, 2) == 0 ? 0 : random.integer(0, largest);
    offsets.push_back(offsets.back() + static_cast<std::size_t>(size));
  }
  return offsets;
}

}  // namespace flaunay::flattened
