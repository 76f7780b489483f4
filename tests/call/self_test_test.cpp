// The self test of a device's arithmetic: passes here, and fails where bits are others.
#include "tuning/self_test.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "arithmetic/exact_arithmetic.h"
#include "flaunay/flaunay.hpp"
#include "launchers/call/self_test.cl.hpp"
#include "launchers/call/self_test_fixed.cl.hpp"
#include "tests/points/support.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tests/support/test_kernels.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::tuning {
namespace {

TEST(SmallSelfTest, PassesHereAndFailsOnOtherBits) {
  host::Runtime& runtime = points::Runtimes::get("own");
  const host::Arena::Scope scope(runtime.arena());
  EXPECT_EQ(self_test_failure(runtime), "");
  const std::vector<cl_double> operands{
      1 + 0x1p-30,          1 - 0x1p-30,         -1.0, 0x1p-1060, 0x1.5555555555555p-2, 0x1.0000000000001p+60,
      0x1.123456789abcdp+3, 0x1.fedcba9876543p-2};
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
  const mpq_class of_long = mpq_class(operands[6]) * mpq_class(operands[7]);
  const std::vector<cl_ulong> right{
      bits(0.0),                                                           // 1 rounded, less 1
      bits(rounded(mpq_class(operands[0]) * mpq_class(operands[1]) - 1)),  // fma
      bits(0x1p-1061),                                                     // a subnormal number, halved
      bits(sum),
      bits(product),
      bits(rounded(third + large - mpq_class(sum))),                   // two_sum
      bits(rounded(third * third - mpq_class(product))),               // two_product
      bits(0.0),                                                       // (large + third) - large
      1,                                                               // what many turns of a loop begin with
      bits(rounded(of_long - mpq_class(operands[6] * operands[7])))};  // two_product, of long factors
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
#ifdef SPLIT_PRODUCTS
  const cl_uint of_fma = testing::tests_native() ? 0 : 2;  // without that instruction, the host uses no fma
#else
  const cl_uint of_fma = 2;
#endif
  const cl_uint checks[] = {1 | 512 | 1024, of_fma, 4, 8 | 32, 16 | 64 | 128, 32, 64, 256, 2048, 64};
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
  const testing::ChangedKernels inexact("arithmetic/language.h", with_inexact_fma);
  const auto runtime = testing::make_tuned_runtime("own");
  EXPECT_FALSE(runtime->capabilities().split_products);
  EXPECT_EQ(self_test_failure(*runtime), "");
  EXPECT_TRUE(runtime->capabilities().split_products);
  Triangulator without_fma(testing::device_under_test());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    EXPECT_EQ(without_fma.triangulate(inputs[k].data(), inputs[k].size() / 2).triangles, expected[k])
        << fixtures[k];
  }
}

/// The lowest bits of an integer in two's complement, 64 at a time.
std::vector<cl_ulong> words_of(const mpz_class& value, std::size_t count) {
  std::vector<cl_ulong> words;
  for (std::size_t k = 0; k < count; ++k) {
    mpz_class word;
    mpz_fdiv_q_2exp(word.get_mpz_t(), value.get_mpz_t(), 64 * k);
    mpz_fdiv_r_2exp(word.get_mpz_t(), word.get_mpz_t(), 64);
    words.push_back(word.get_ui());
  }
  return words;
}

/// Of a positive number, the bits of the float nearest to it.
cl_uint float_bits_of(const mpq_class& value) {
  const float below = std::nextafter(static_cast<float>(value.get_d()), 0.0F);
  float nearest = below;
  for (float next = below; mpq_class(next) <= 2 * value; next = std::nextafter(next, HUGE_VALF)) {
    if (abs(mpq_class(next) - value) > abs(mpq_class(nearest) - value)) break;
    nearest = next;
  }
  cl_uint bits = 0;
  std::memcpy(&bits, &nearest, sizeof bits);
  return bits;
}

std::unique_ptr<host::Runtime> make_fixed_runtime() { return testing::make_tuned_runtime("fixed_point=1"); }

TEST(SmallSelfTest, InFixedPointPassesHereAndFailsOnOtherBits) {
  if (testing::tests_native()) GTEST_SKIP() << "the host computes in double precision";
  const auto runtime = make_fixed_runtime();
  const host::Arena::Scope scope(runtime->arena());
  EXPECT_EQ(self_test_failure(*runtime), "");
  const std::vector<cl_long> operands{0x3fffffffffffffff, -0x2aaaaaaaaaaaaaab, 0x123456789abcdef1, 0, 1};
  const std::vector<cl_float> reals{0x1.555556p-2F, 0x1.00008p+20F, 0x1p-55F};
  const mpz_class a = static_cast<long>(operands[0]), b = static_cast<long>(operands[1]),
                  c = static_cast<long>(operands[2]);
  // The results, by integers and rational numbers.
  std::vector<cl_ulong> right = words_of(a * b, 2);
  const auto add = [&right](const mpz_class& value, std::size_t count) {
    for (const cl_ulong word : words_of(value, count)) right.push_back(word);
  };
  mpz_class arithmetic, logical = b + (mpz_class(1) << 64);
  mpz_fdiv_q_2exp(arithmetic.get_mpz_t(), b.get_mpz_t(), 7);
  mpz_fdiv_q_2exp(logical.get_mpz_t(), logical.get_mpz_t(), 7);
  add(c * c, 2);
  add(arithmetic, 1);
  add(logical, 1);
  add(a * b * b * c, 4);
  const mpq_class third(reals[0]), large(reals[1]), unit(1, mpz_class(1) << 33);
  const std::vector<cl_uint> floats{float_bits_of(a * unit),      float_bits_of(-b * unit),
                                    float_bits_of(c * unit),      float_bits_of(large + third),
                                    float_bits_of(large - third), float_bits_of(third * third),
                                    float_bits_of(third / large)};
  const auto failed_bits = [&](const std::vector<cl_float>& with, const std::vector<cl_ulong>& expected,
                               const std::vector<cl_uint>& expected_floats) {
    const auto failed = testing::upload(*runtime, std::vector<cl_uint>{0xffffffff});
    runtime->launch(1, 1,
                    kernels::self_test_fixed{.operands = testing::upload(*runtime, operands),
                                             .reals = testing::upload(*runtime, with),
                                             .expected = testing::upload(*runtime, expected),
                                             .floats = testing::upload(*runtime, expected_floats),
                                             .failed = failed});
    return testing::download(*runtime, failed, 1)[0];
  };
  EXPECT_EQ(failed_bits(reals, right, floats), 0U);
  const cl_uint checks[] = {1, 1, 1, 1, 2, 2, 4, 4, 4, 4};
  for (std::size_t k = 0; k < right.size(); ++k) {
    std::vector<cl_ulong> wrong = right;
    wrong[k] ^= cl_ulong{1} << (7 * k);
    EXPECT_EQ(failed_bits(reals, wrong, floats), checks[k]) << "expected value " << k;
  }
  // One unit is allowed for, or of quotients three; more is not.
  const cl_uint float_checks[] = {8, 8, 8, 16, 16, 16, 32};
  for (std::size_t k = 0; k < floats.size(); ++k) {
    for (const int units : {-5, -1, 1, 5}) {
      std::vector<cl_uint> wrong = floats;
      wrong[k] += static_cast<cl_uint>(units);
      EXPECT_EQ(failed_bits(reals, right, wrong), std::abs(units) > 1 ? float_checks[k] : 0U)
          << "float " << k << ", " << units << " units off";
    }
  }
  // As a device would fail that flushes numbers which are not subnormal.
  std::vector<cl_float> flushed = reals;
  flushed[2] = 0;
  EXPECT_EQ(failed_bits(flushed, right, floats), 64U);
}

// Mesa's llvmpipe does so. On a tenth of what loops need there, results are right.
TEST(SelfTest, ADeviceWhoseLoopsEndEarlyIsForFewPoints) {
  if (testing::tests_native()) GTEST_SKIP() << "the host's loops do not";
  const testing::ChangedKernels changed("call/turns.h", [](std::string text) {
    const std::string condition = "k < MANY_TURNS";
    const std::size_t at = text.find(condition);
    if (at == std::string::npos) throw std::logic_error("no loop");
    return text.replace(at, condition.size(), "k < 65535");
  });
  for (const char* const tuning : {"fixed_point=0", "fixed_point=1"}) {
    const auto runtime = testing::make_tuned_runtime(tuning);
    EXPECT_EQ(self_test_failure(*runtime), "");
    EXPECT_TRUE(runtime->capabilities().loops_end_early);
  }
  Triangulator triangulator(testing::device_under_test());
  EXPECT_EQ(triangulator.capacity(), 4096U);
  const testing::Coordinates most = testing::make_fixture("uniform", 4096, 1);
  EXPECT_EQ(triangulator.triangulate(most.data(), 4096).triangles,
            testing::triangulator().triangulate(most.data(), 4096).triangles);
  const testing::Coordinates more = testing::make_fixture("uniform", 4097, 1);
  testing::expect_error(ErrorKind::device,
                        {"4097 points are too many", "4096 would fit", "its loops end early"},
                        [&] { triangulator.triangulate(more.data(), 4097); });
}

/// A device that computes otherwise, by a text that stands for it in the kernels; and what the self test
/// says.
struct WrongDevice {
  const char* file;
  const char* text;
  const char* instead;  ///< or "" for behind the file's text
  const char* failure;
};

TEST(SelfTest, InFixedPointFindsDevicesThatComputeOtherwise) {
  if (testing::tests_native()) GTEST_SKIP() << "the host computes in double precision";
  const char* const language = "arithmetic/language.h";
  const char* const kernel = "call/self_test_fixed.cl";
  const WrongDevice devices[] = {
      // Upper halves of products as those of unsigned numbers, without their last bit, and of upper halves.
      {language, "#undef high_product\n#define high_product(x, y) as_long(mul_hi(as_ulong(x), as_ulong(y)))",
       "", "products of integers"},
      {language, "#undef high_product\n#define high_product(x, y) (mul_hi((x), (y)) & ~1L)", "",
       "products of integers"},
      {language, "#undef high_product\n#define high_product(x, y) (((x) >> 32) * ((y) >> 32))", "",
       "products of integers"},
      {language, "ulong other(ulong x) { return clz(x) & 31; }\n#undef clz\n#define clz other", "",
       "integers are shifted"},
      {language, "ulong other(ulong x) { return clz(x) + 1; }\n#undef clz\n#define clz other", "",
       "integers are shifted"},
      // Conversions that keep 21 bits, that lose the sign, or that see 32 bits.
      {language,
       "float other(long x) { return as_float(as_uint((float)x) & ~7U); }\n"
       "#undef convert_float\n#define convert_float other",
       "", "converted to floats"},
      {language,
       "float other(long x) { return fabs((float)x); }\n#undef convert_float\n#define convert_float other",
       "", "converted to floats"},
      {language,
       "float other(long x) { return (float)(int)x; }\n#undef convert_float\n#define convert_float other", "",
       "converted to floats"},
      // Floats with fewer bits, in vectors alone, and quotients by a rough reciprocal.
      {kernel, "large + third, ", "(large + third) * 1.000001f, ", "exact to one unit"},
      {kernel, "large - third, ", "(large - third) * 0.999999f, ", "exact to one unit"},
      {kernel, "third * third, ", "third * third * 1.000001f, ", "exact to one unit"},
      {kernel, "products = both * thirds", "products = both * thirds * 1.000001f", "exact to one unit"},
      {kernel, "third / large, ", "third * (1 / large * 1.000001f), ", "exact to three units"},
      {kernel, "small * small ", "(small * small < 0x1p-100f ? 0 : small * small) ", "2^-110"},
      {kernel, "difference_256(product, product)", "difference_256(product, product_256(ab, ab))",
       "256 bits"}};
  for (const WrongDevice& device : devices) {
    std::size_t changes = 0;
    const testing::ChangedKernels changed(device.file, [&](std::string text) {
      if (*device.instead == 0) {
        ++changes;
        return text + "\n#ifndef __cplusplus\n" + device.text + "\n#endif\n";
      }
      for (std::size_t at = text.find(device.text); at != std::string::npos;
           at = text.find(device.text, at + std::strlen(device.instead))) {
        text.replace(at, std::strlen(device.text), device.instead);
        ++changes;
      }
      return text;
    });
    EXPECT_GT(changes, 0U) << device.text;
    const auto runtime = make_fixed_runtime();
    const std::string failure = self_test_failure(*runtime);
    EXPECT_NE(failure.find(device.failure), std::string::npos) << device.text << ": " << failure;
  }
}

}  // namespace
}  // namespace flaunay::tuning
