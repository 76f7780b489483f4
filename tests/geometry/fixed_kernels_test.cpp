// The predicates in fixed point on a device, which needs no double precision, against GMP; and the same bits
// as on the host where arithmetic is exact or rounded as IEEE 754 says. Both ways to convert differences.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/support/device.hpp"
#include "tests/support/fixed_cases.hpp"
#include "tests/support/fixed_point.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/test_kernels.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::testing {
namespace {

std::unique_ptr<host::Runtime> make_runtime(const std::string&) {
  static const TestKernels kernels;
  const auto device = host::find_device("");
  return std::make_unique<host::Runtime>(device, settings_for(device));
}
using TestRuntimes = SharedRuntimes<make_runtime>;
[[maybe_unused]] ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new TestRuntimes);

class SmallFixedKernels : public ::testing::Test {
 protected:
  SmallFixedKernels() : scope_(runtime_.arena()) {}
  template <typename... Arguments>
  void run(const char* kernel, std::size_t n, const Arguments&... arguments) {
    map_unchecked(runtime_, "fixed_predicates", kernel, n, arguments...);
  }

  host::Runtime& runtime_ = TestRuntimes::get("own");
  host::Arena::Scope scope_;
  std::mt19937_64 random_{20};
};
constexpr int kUndecided = 2, kNotAsked = 3;

TEST_F(SmallFixedKernels, SignsAreExact) {
  // Points of orientations, and a fourth one.
  std::vector<Class> classes = circle_classes();
  for (const Class& of : orientation_classes()) {
    classes.push_back({of.name,
                       [of](std::mt19937_64& random, Integer* p) {
                         of.make(random, p);
                         random_points(random, p + 6, 1, between(random, 0, 61));
                       },
                       0});
  }
  for (const Class& of : classes) {
    const std::size_t n = 20000;
    std::vector<cl_long> cases(8 * n);
    for (std::size_t i = 0; i < n; ++i) {
      Integer p[8];
      of.make(random_, p);
      std::copy(p, p + 8, &cases[8 * i]);
    }
    const auto signs = guarded<cl_char>(runtime_, 8 * n);
    run("fixed_signs", n, upload(runtime_, cases), signs);
    const auto found = download(runtime_, signs, 8 * n);
    std::size_t orientations = 0, circles = 0, angles = 0;
    for (std::size_t i = 0; i < n; ++i) {
      Integer p[8];
      std::copy(&cases[8 * i], &cases[8 * i + 8], p);
      const int side = sgn(orientation(p)), circle = sgn(in_circle(p)),
                turn = sgn(cross(p, p + 2, p + 4, p + 6));
      const cl_char* const s = &found[8 * i];
      const auto is_right = [](int sign, int expected) { return sign == expected || sign == kUndecided; };
      ASSERT_TRUE(is_right(s[0], side) && is_right(s[1], side) && is_right(s[2], circle) &&
                  is_right(s[3], circle))
          << of.name << ": " << text_of(p, 8) << ": " << +s[0] << " " << +s[1] << " " << +s[2] << " "
          << +s[3];
      ASSERT_TRUE(s[4] == side && s[5] == turn && s[6] == circle) << of.name << ": " << text_of(p, 8);
      const bool is_asked = s[2] == kUndecided || s[3] == kUndecided;
      ASSERT_EQ(s[7], is_asked ? circle : kNotAsked) << of.name << ": " << text_of(p, 8);
      orientations += s[0] == kUndecided;
      circles += s[2] == kUndecided;
      angles += s[3] == kUndecided;
    }
    std::printf("  %-18s undecided: orientation %zu, circle %zu, angle %zu of %zu\n", of.name, orientations,
                circles, angles, n);
  }
}

TEST_F(SmallFixedKernels, DifferencesAreThoseOfTheHost) {
  const FixedPredicates& on_host = fixed_predicates();
  std::vector<cl_long> cases;
  for (std::size_t i = 0; i < 50000; ++i) {
    // Doubles of at most 53 bits below 2^62.
    for (int k = 0; k < 2; ++k)
      cases.push_back(number(random_, between(random_, 0, 53)) * (1L << between(random_, 0, 9)));
  }
  const Integer largest = (1L << 62) - (1L << 9);
  for (const Integer a : {largest, -largest, Integer{0}, Integer{1}}) {
    for (const Integer b : {largest, -largest, Integer{0}, Integer{-1}}) cases.insert(cases.end(), {a, b});
  }
  const std::size_t n = cases.size() / 2;
  const auto rounded = guarded<cl_long>(runtime_, n);
  const auto floats = guarded<cl_uint>(runtime_, n);
  run("fixed_differences", n, upload(runtime_, cases), rounded, floats);
  const auto found = download(runtime_, rounded, n);
  const auto found_floats = download(runtime_, floats, n);
  for (std::size_t i = 0; i < n; ++i) {
    const Integer a = cases[2 * i], b = cases[2 * i + 1];
    ASSERT_EQ(found[i], static_cast<Integer>(static_cast<double>(a) - static_cast<double>(b)))
        << a << " - " << b;
    const float expected = on_host.real_of(a - b);
    cl_uint bits = 0;
    std::memcpy(&bits, &expected, sizeof bits);
    ASSERT_EQ(found_floats[i], bits) << a << " - " << b << ": " << expected;
  }
}

TEST_F(SmallFixedKernels, NumbersOfTheCallerAreReadExactly) {
  const FixedPredicates& on_host = fixed_predicates();
  std::vector<cl_uint> floats;
  std::vector<cl_int> shifts;
  for (std::size_t i = 0; i < 50000; ++i) {
    auto bits = static_cast<cl_uint>(random_());
    if (i % 4 == 0) bits &= 0x807fffffU;   // subnormal
    if (i % 16 == 1) bits |= 0x7f800000U;  // infinite or no number
    if (i % 64 == 2) bits &= 0x80000000U;
    floats.push_back(bits);
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    // So that it becomes an integer below 2^62.
    const bool is_number = std::isfinite(value) && value != 0;
    shifts.push_back(is_number ? between(random_, 23, 61) - std::ilogb(value) : 0);
    if (!std::isfinite(value)) floats.back() &= 0xff800000U;
  }
  const std::size_t n = floats.size();
  const auto doubles = guarded<cl_ulong>(runtime_, n);
  const auto integers = guarded<cl_long>(runtime_, n);
  run("fixed_numbers", n, upload(runtime_, floats), upload(runtime_, shifts), doubles, integers);
  const auto found_doubles = download(runtime_, doubles, n);
  const auto found = download(runtime_, integers, n);
  for (std::size_t i = 0; i < n; ++i) {
    ASSERT_EQ(found_doubles[i], on_host.widened_bits(floats[i])) << floats[i];
    float value = 0;
    std::memcpy(&value, &floats[i], sizeof value);
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(found[i], static_cast<Integer>(std::ldexp(double{value}, shifts[i])))
        << value << " by " << shifts[i];
  }
}

TEST_F(SmallFixedKernels, CertificatesAreNeverWrong) {
  const std::size_t n = 20000;
  std::vector<cl_long> cases;
  for (std::size_t i = 0; i < n; ++i) {
    Integer p[6];
    three_points(random_, p);
    const FixedFrame f = frame_around(random_, p);
    cases.insert(cases.end(), p, p + 6);
    for (const auto& corner : {f.low, f.high, f.all_low, f.all_high})
      cases.insert(cases.end(), corner, corner + 2);
  }
  const auto answers = guarded<cl_char>(runtime_, 2 * n);
  run("fixed_certificates", n, upload(runtime_, cases), answers);
  const auto found = download(runtime_, answers, 2 * n);
  std::size_t said = 0, free = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Integer p[6];
    std::copy(&cases[14 * i], &cases[14 * i + 6], p);
    FixedFrame f{};
    Integer* const corners[] = {f.low, f.high, f.all_low, f.all_high};
    for (std::size_t k = 0; k < 4; ++k)
      std::copy(&cases[14 * i + 6 + 2 * k], &cases[14 * i + 8 + 2 * k], corners[k]);
    const bool circle = circle_is_free(f, p);
    ASSERT_TRUE(circle || found[2 * i] == 0) << text_of(p, 6);
    ASSERT_TRUE(half_plane_is_free(f, p) || found[2 * i + 1] == 0) << text_of(p, 6);
    said += found[2 * i] != 0;
    free += circle;
  }
  EXPECT_GT(2 * said, free);
  EXPECT_GT(free, n / 10);
}

}  // namespace
}  // namespace flaunay::testing
