// The kernels that flaunay-bench device times: what they compute, beside plain loops.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "launchers/call/probe.cl.hpp"
#include "tests/support/runtimes.hpp"

namespace flaunay::testing {
namespace {

class Probe : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (tests_native()) GTEST_SKIP() << "the kernels need an OpenCL device";
    runtime_ = make_tuned_runtime(GetParam());
  }
  template <typename T>
  std::vector<T> read(const host::Buffer<T>& buffer, std::size_t n) {
    std::vector<T> values(n);
    runtime_->read(buffer, 0, n, values.data());
    return values;
  }
  std::unique_ptr<host::Runtime> runtime_;
};

constexpr std::size_t kSizes[] = {1, 31, 300};

TEST_P(Probe, ChainsAreFollowed) {
  for (const std::size_t n : kSizes) {
    // From each place to one that is further on, around the end.
    std::vector<cl_int> next;
    for (std::size_t i = 0; i < n; ++i) next.push_back(static_cast<cl_int>((i * i + 7) % n));
    for (const int steps : {0, 1, 10}) {
      std::vector<cl_int> expected;
      for (std::size_t i = 0; i < n; ++i) {
        auto place = static_cast<cl_int>(i);
        for (int k = 0; k < steps; ++k) place = next[static_cast<std::size_t>(place)];
        expected.push_back(place);
      }
      const auto ends = runtime_->arena().allocate<cl_int>(n);
      runtime_->map(n, kernels::follow_chain{
                           .steps = steps, .next = runtime_->upload(runtime_->arena(), next), .ends = ends});
      EXPECT_EQ(read(ends, n), expected) << n << " places, " << steps << " steps";
    }
  }
}

TEST_P(Probe, OperationsAreRoundedOneByOne) {
  constexpr double kFactor = 1.0 / 3;
  constexpr int kSteps = 20;
  for (const std::size_t n : kSizes) {
    std::vector<cl_double> expected;
    for (std::size_t i = 0; i < n; ++i) {
      auto x = static_cast<double>(i);
      for (int k = 0; k < kSteps; ++k) {
        const volatile double product = x * kFactor;
        x = product + 1.0;
      }
      expected.push_back(x);
    }
    const auto results = runtime_->arena().allocate<cl_double>(n);
    runtime_->map(n, kernels::compute_chain{.steps = kSteps, .factor = kFactor, .results = results});
    EXPECT_EQ(read(results, n), expected);
  }
}

TEST_P(Probe, NothingIsDoneOnce) {
  for (const std::size_t n : kSizes) {
    std::vector<cl_int> expected;
    for (std::size_t i = 0; i < n; ++i) expected.push_back(static_cast<cl_int>(i));
    const auto ends = runtime_->arena().allocate<cl_int>(n);
    runtime_->map(n, kernels::do_nothing{.ends = ends});
    EXPECT_EQ(read(ends, n), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, Probe, ::testing::Values("own", "gpu:1", "gpu:32", "gpu:64", "gpu:256"));

}  // namespace
}  // namespace flaunay::testing
