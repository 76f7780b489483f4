#include "tuning/self_test.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "launchers/call/self_test.cl.hpp"
#include "launchers/call/self_test_fixed.cl.hpp"

namespace flaunay::tuning {
namespace {

constexpr const char* kChecksInFixedPoint[] = {
    "products of integers are whole", "integers are shifted as they should be",
    "integers of 256 bits are exact", "integers are converted to floats",
    "floats are exact to one unit",   "quotients of floats are exact to three units",
    "floats of 2^-110 are kept",      "loops run to their ends"};

constexpr const char* kChecks[] = {"contraction is off",
                                   "fma rounds once",
                                   "subnormal numbers are kept",
                                   "sums round to nearest",
                                   "products round to nearest",
                                   "two_sum is exact",
                                   "two_product is exact",
                                   "vectors round as scalars",
                                   "sums are not reordered",
                                   "contraction is off in vectors",
                                   "contraction is off in inlined functions",
                                   "loops run to their ends"};
// The checks that need fma: its own, and two_product's.
constexpr cl_uint kFmaChecks = 2 | 64;
// That of loops, for doubles and in fixed point.
constexpr cl_uint kLoopCheck = 2048, kLoopCheckInFixedPoint = 128;

// The bits of the checks that fail.
cl_uint failed_checks(host::Runtime& runtime) {
  // Operands as in kernels/call/self_test.cl, and their results, which were computed with rational
  // arithmetic.
  const cl_double operands[] = {
      1 + 0x1p-30,          1 - 0x1p-30,         -1.0, 0x1p-1060, 0x1.5555555555555p-2, 0x1.0000000000001p+60,
      0x1.123456789abcdp+3, 0x1.fedcba9876543p-2};
  const cl_ulong expected[] = {0x0000000000000000, 0xbc30000000000000, 0x0000000000002000,
                               0x43b0000000000001, 0x3fbc71c71c71c71c, 0x3fd5555555555555,
                               0xbc5c71c71c71c71c, 0x0000000000000000, 1,
                               0x3ca476595fab5e9c};
  host::Arena::Scope scope(runtime.arena());
  const auto device_operands = runtime.arena().allocate<cl_double>(std::size(operands));
  const auto device_expected = runtime.arena().allocate<cl_ulong>(std::size(expected));
  const auto failed = runtime.arena().allocate<cl_uint>(1);
  runtime.write(device_operands, 0, std::size(operands), operands);
  runtime.write(device_expected, 0, std::size(expected), expected);
  runtime.launch(
      1, 1, kernels::self_test{.operands = device_operands, .expected = device_expected, .failed = failed});
  return runtime.read_one(failed, 0);
}

// The bits of the checks of fixed point that fail.
cl_uint failed_checks_in_fixed_point(host::Runtime& runtime) {
  // Operands as in kernels/call/self_test_fixed.cl, and their results, which were computed with rational
  // arithmetic.
  const cl_long operands[] = {0x3fffffffffffffff, -0x2aaaaaaaaaaaaaab, 0x123456789abcdef1, 0, 1};
  const cl_float reals[] = {0x1.555556p-2f, 0x1.00008p+20f, 0x1p-55f};
  const cl_ulong expected[] = {0x6aaaaaaaaaaaaaab, 0xf555555555555555, 0xca4ab582281edee1, 0x014b66dc33f6acdc,
                               0xffaaaaaaaaaaaaaa, 0x01aaaaaaaaaaaaaa, 0x5a6bf6646095ae57, 0xc598153d0f8cb488,
                               0xac71c71c71c71c71, 0x00205d0b811316e1};
  const cl_uint floats[] = {0x4e000000, 0x4daaaaab, 0x4d11a2b4, 0x49800043,
                            0x4980003d, 0x3de38e3a, 0x34aaaa56};
  host::Arena::Scope scope(runtime.arena());
  const auto failed = runtime.arena().allocate<cl_uint>(1);
  const auto upload = [&runtime](const auto& values) {
    const auto buffer = runtime.arena().allocate<std::decay_t<decltype(values[0])>>(std::size(values));
    runtime.write(buffer, 0, std::size(values), values);
    return buffer;
  };
  runtime.launch(1, 1,
                 kernels::self_test_fixed{.operands = upload(operands),
                                          .reals = upload(reals),
                                          .expected = upload(expected),
                                          .floats = upload(floats),
                                          .failed = failed});
  return runtime.read_one(failed, 0);
}

template <std::size_t N>
std::string describe_failure(cl_uint bits, const char* const (&checks)[N]) {
  std::string failure;
  for (std::size_t k = 0; k < N; ++k) {
    if (bits >> k & 1)
      failure += fmt::format("{}it does not hold that {}", failure.empty() ? "" : "; ", checks[k]);
  }
  return failure;
}

void note(host::Runtime& runtime, bool host::Capabilities::*what) {
  host::Capabilities capabilities = runtime.capabilities();
  capabilities.*what = true;
  runtime.set_capabilities(capabilities);
}

// If loops end early, calls are limited to so few points that no loop does.
cl_uint without_loop_check(host::Runtime& runtime, cl_uint bits, cl_uint check) {
  if ((bits & check) != 0) note(runtime, &host::Capabilities::loops_end_early);
  return bits & ~check;
}

}  // namespace

std::string self_test_failure(host::Runtime& runtime) {
  if (runtime.capabilities().fixed_point) {
    const cl_uint bits = failed_checks_in_fixed_point(runtime);
    return describe_failure(without_loop_check(runtime, bits, kLoopCheckInFixedPoint), kChecksInFixedPoint);
  }
  cl_uint bits = without_loop_check(runtime, failed_checks(runtime), kLoopCheck);
  if (bits != 0 && (bits & ~kFmaChecks) == 0) {
    note(runtime, &host::Capabilities::split_products);
    bits = failed_checks(runtime);
  }
  return describe_failure(bits, kChecks);
}

std::string make_exact(host::Runtime& runtime) {
  const std::string failure = self_test_failure(runtime);
  if (failure.empty() || runtime.is_native() || runtime.capabilities().fixed_point) return failure;
  note(runtime, &host::Capabilities::fixed_point);
  const std::string failure_of_fixed = self_test_failure(runtime);
  return failure_of_fixed.empty() ? "" : failure + "; " + failure_of_fixed;
}

}  // namespace flaunay::tuning
