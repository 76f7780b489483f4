// The self test of a device's arithmetic: passes here, and fails where bits are others.
#include "call/self_test.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "launchers/call/self_test.cl.hpp"
#include "tests/points/support.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tests/support/test_kernels.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

TEST(SmallSelfTest, PassesHereAndFailsOnOtherBits) {
  host::Runtime& runtime = points::Runtimes::get("own");
  const host::Arena::Scope scope(runtime.arena());
  EXPECT_EQ(self_test_failure(runtime), "");
  const std::vector<cl_double> operands{1 + 0x1p-30, 1 - 0x1p-30,          -1.0,
                                        0x1p-1060,   0x1.5555555555555p-2, 0x1.0000000000001p+60};
  const auto bits = [](double value) {
    cl_ulong result = 0;
    std::memcpy(&result, &value, sizeof result);
    return result;
  };
  // The results, worked out with rational numbers; mpq_class rounds towards zero, so only exact ones are
  // converted.
  const auto rounded = [](const mpq_class& value) {
    const double truncated = value.get_d();
    const double away = std::nextafter(truncated, value > 0 ? HUGE_VAL : -HUGE_VAL);
    const mpq_class below = abs(value - mpq_class(truncated)), above = abs(mpq_class(away) - value);
    if (below == above) throw std::logic_error("a tie");
    return below < above ? truncated : away;
  };
  const mpq_class third(operands[4]), large(operands[5]);
  const double sum = rounded(third + large), product = rounded(third * third);
  const std::vector<cl_ulong> right{
      bits(0.0),                                                           // 1 rounded, less 1
      bits(rounded(mpq_class(operands[0]) * mpq_class(operands[1]) - 1)),  // fma
      bits(0x1p-1061),                                                     // a subnormal number, halved
      bits(sum),
      bits(product),
      bits(rounded(third + large - mpq_class(sum))),      // two_sum
      bits(rounded(third * third - mpq_class(product))),  // two_product
      bits(0.0)};                                         // (large + third) - large
  const auto failed_bits = [&](const std::vector<cl_double>& with, const std::vector<cl_ulong>& expected) {
    const auto failed = testing::upload(runtime, std::vector<cl_uint>{0xffffffff});
    runtime.launch(1, 1,
                   kernels::self_test{.operands = testing::upload(runtime, with),
                                      .expected = testing::upload(runtime, expected),
                                      .failed = failed});
    return testing::download(runtime, failed, 1)[0];
  };
  EXPECT_EQ(failed_bits(operands, right), 0u);
  // Which checks rest on which expected value.
  const cl_uint checks[] = {1 | 512 | 1024, 2, 4, 8 | 32, 16 | 64 | 128, 32, 64, 256};
  for (std::size_t k = 0; k < right.size(); ++k) {
    std::vector<cl_ulong> wrong = right;
    wrong[k] ^= 1;
    EXPECT_EQ(failed_bits(operands, wrong), checks[k]) << "expected value " << k;
  }
  // As a device would fail that flushes subnormal numbers to 0.
  std::vector<cl_double> flushed = operands;
  flushed[3] = 0.0;
  EXPECT_EQ(failed_bits(flushed, right), 4u);
}

/// An fma that rounds twice, as that of Mesa's rusticl does.
std::string with_inexact_fma(const std::string& language) {
  return language + "\n#undef fma\n#define fma(a, b, c) ((a) * (b) + (c))\n";
}

// Points on lines and circles, and others whose predicates need expansions.
TEST(SelfTest, ADeviceWhoseFmaRoundsTwiceDoesWithoutIt) {
  if (testing::tests_native()) GTEST_SKIP() << "the host's fma is exact";
  const char* const fixtures[] = {"two-lines", "log-spiral", "integer-star"};
  std::vector<testing::Coordinates> inputs;
  std::vector<std::vector<std::int32_t>> expected;
  for (const char* const fixture : fixtures) {
    inputs.push_back(testing::perturbed(testing::make_fixture(fixture, 900, 2), 3));
    const auto mesh = testing::triangulator().triangulate(inputs.back().data(), inputs.back().size() / 2);
    EXPECT_GT(mesh.statistics.undecided, 0u) << fixture;
    expected.push_back(mesh.triangles);
  }
  const testing::ChangedKernels inexact("shared/language.h", with_inexact_fma);
  const auto runtime = testing::make_tuned_runtime("own");
  EXPECT_EQ(tuning_of(*runtime).split_products, 0u);
  EXPECT_EQ(self_test_failure(*runtime), "");
  EXPECT_EQ(tuning_of(*runtime).split_products, 1u);
  Triangulator without_fma(testing::device_under_test());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    EXPECT_EQ(without_fma.triangulate(inputs[k].data(), inputs[k].size() / 2).triangles, expected[k])
        << fixtures[k];
  }
}

}  // namespace
}  // namespace flaunay::call
