// The device's predicates against GMP: what a filter decides is right, what the exact versions say is always
// right, and the depth below a chord is monotone as quickhull needs it. Each class of input prints how much
// its filter leaves.
#include "geometry/predicates.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "points/query_range.hpp"
#include "predicates/nearness.h"
#include "tests/support/bounds.hpp"
#include "tests/support/device.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/test_kernels.hpp"
#include "tuning/tuning.hpp"

namespace flaunay {
namespace {

using host::Arena;
using host::Runtime;
using testing::download;
using testing::guarded;
using testing::reference_incircle;
using testing::reference_orient2d;
using testing::upload;

constexpr int kUndecided = UNDECIDED;

// What the library accepts: multiples of 2^-255 below 2^250.
constexpr int kLowestExponent = kernel::LOWEST_EXPONENT;
constexpr int kLargestExponent = kernel::LARGEST_EXPONENT;
static_assert(kLowestExponent == -255 && kLargestExponent == 249, "as docs/exactness.md proves");

constexpr int kAxisX = kernel::AXIS_X, kAxisY = kernel::AXIS_Y;
constexpr int kPlanarLower = kernel::AXIS_PLANAR_LOWER, kPlanarUpper = kernel::AXIS_PLANAR_UPPER;
constexpr int kAxes[] = {kAxisX, kAxisY, kPlanarLower, kPlanarUpper};
const char* const kAxisNames[] = {"x", "y", "planar lower", "planar upper"};
bool is_planar(int axis) { return axis >= kPlanarLower; }

/// A runtime whose kernel files are those of tests/kernels, too; destroyed before the OpenCL
/// implementation leaves.
class PredicateRuntime : public ::testing::Environment {
 public:
  void TearDown() override { state().reset(); }
  static Runtime& get() {
    if (!state()) state() = std::make_unique<State>();
    return state()->runtime;
  }

 private:
  struct State {
    testing::TestKernels kernels;
    Runtime runtime{host::find_device(""), settings_for(host::find_device(""))};
  };
  static std::unique_ptr<State>& state() {
    static std::unique_ptr<State> one;
    return one;
  }
};
[[maybe_unused]] ::testing::Environment* const kRuntime =
    ::testing::AddGlobalTestEnvironment(new PredicateRuntime);

// ---------------------------------------------------------------------------------------------------------
// Numbers to make cases of

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  /// From 0 to n - 1.
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  bool coin() { return (engine_() & 1) != 0; }
  double sign() { return coin() ? 1.0 : -1.0; }
  /// In [0, 1), a multiple of 2^-53.
  double unit() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }
  /// An integer of at most `count` bits, of either sign.
  double integer(int count) {
    return sign() * static_cast<double>(engine_() & ((std::uint64_t{1} << count) - 1));
  }
  /// Any supported number: all exponents are equally likely, and all lengths of the mantissa.
  double wide() { return wide(kLowestExponent, kLargestExponent); }
  double wide(int low, int high) {
    if (below(16) == 0) return 0.0;
    const int top = between(low, high);
    const int length = between(1, std::min(53, top - kLowestExponent + 1));
    const std::uint64_t leading = std::uint64_t{1} << (length - 1);
    return sign() * std::ldexp(static_cast<double>(leading | (engine_() & (leading - 1))), top - length + 1);
  }

 private:
  std::mt19937_64 engine_;
};

/// An integer of up to so many bits, of which it has 53 at most: at either end.
double spanning(Random& random, int bits) {
  const int held = std::min(bits, 53);
  return std::ldexp(random.integer(held), random.coin() ? bits - held : 0);
}

/// Integers next to the limits of what kernels/arithmetic/integer_arithmetic.h takes: coordinates or
/// differences as large as they can be, a unit off, or 0.
void fill_largest(Random& random, int count, double* c) {
  const int all_bits[] = {24, 25, 26, 27, 29, 30, 31, 32, 33, 40, 41, 42, 43, 52, 53, 60, 61, 62, 63, 64};
  const int bits = all_bits[random.below(std::size(all_bits))];
  for (int k = 0; k < count; ++k) {
    const double largest = std::ldexp(1, bits) - std::ldexp(random.below(3), std::max(0, bits - 53));
    c[k] = random.below(3) == 0 ? random.below(2) : random.sign() * largest;
  }
}

/// The nearest supported number: the identity unless x is tiny.
double supported(double x) { return std::ldexp(std::nearbyint(std::ldexp(x, 255)), -255); }

/// x moved by some units in the last place, up to `most`.
double nudged(double x, int most, Random& random) {
  const int steps = random.between(-most, most);
  for (int k = 0; k < std::abs(steps); ++k) x = std::nextafter(x, steps < 0 ? -HUGE_VAL : HUGE_VAL);
  return supported(x);
}

/// Points on the circle of radius 65 about 0; some have a coordinate 0.
std::array<double, 2> on_circle(Random& random) {
  static constexpr int kPoints[][2] = {{0, 65}, {16, 63}, {25, 60}, {33, 56}, {39, 52}};
  const auto& p = kPoints[random.below(5)];
  const bool turned = random.coin();
  return {random.sign() * p[turned], random.sign() * p[!turned]};
}

/// As an integer, in units of 2^-255.
void set_scaled(mpz_class& to, double x) { mpz_set_d(to.get_mpz_t(), std::ldexp(x, 255)); }

std::string text_of(const double* values, std::size_t count) {
  std::string text;
  char number[40];
  for (std::size_t i = 0; i < count; ++i) {
    std::snprintf(number, sizeof number, "%s%a", i ? ", " : "", values[i]);
    text += number;
  }
  return text;
}

// ---------------------------------------------------------------------------------------------------------
// Running cases

/// What is known of a class of cases, so that it stays what it is meant to be.
struct Class {
  const char* name;
  bool is_fine = true;  ///< else coarse: the filter's bound is 0, and it decides all
  double undecided_least = 0;
  double undecided_most = 1;
  double zeros_least = 0;
  bool misleads = false;  ///< some signs are wrong without a bound
};

struct Tally {
  std::size_t cases = 0, undecided = 0, zeros = 0, misled = 0;
  double share(std::size_t part) const { return static_cast<double>(part) / static_cast<double>(cases); }
};

std::size_t total_cases = 0;

void report(const std::string& predicate, const Class& of, const Tally& tally) {
  total_cases += tally.cases;
  std::printf("  %-24s %-38s %8zu cases, undecided %7.3f%%, zero %7.3f%%, wrong without bound %7.3f%%\n",
              predicate.c_str(), of.name, tally.cases, 100 * tally.share(tally.undecided),
              100 * tally.share(tally.zeros), 100 * tally.share(tally.misled));
  EXPECT_GE(tally.share(tally.undecided), of.undecided_least) << of.name;
  EXPECT_LE(tally.share(tally.undecided), of.undecided_most) << of.name;
  EXPECT_GE(tally.share(tally.zeros), of.zeros_least) << of.name;
  if (of.misleads) {
    EXPECT_GT(tally.misled, 0u) << of.name << ": too easy";
  }
}

constexpr std::size_t kBatch = 1 << 14;

/// Compares, batch by batch. make fills a case; filter and exact run a batch; reference is GMP's sign of a
/// case. bound says what the library hands to the filter for an input of these magnitudes.
struct Predicate {
  std::string name;
  std::size_t width;
  std::function<void(const host::Buffer<cl_double>&, std::size_t, cl_float, const host::Buffer<cl_char>&)>
      filter;
  std::function<void(const host::Buffer<cl_double>&, std::size_t, const host::Buffer<cl_char>&)> exact;
  std::function<int(const double*)> on_host;  // the same text, read as C++
  std::function<int(const double*)> reference;
  std::function<cl_float(const geometry::Magnitudes&)> bound;
};

/// A class' cases may be coarse themselves; a fine class has them beside others that are not.
cl_float bound_of(const Predicate& predicate, const Class& of, const std::vector<double>& cases) {
  const geometry::Magnitudes magnitudes = testing::magnitudes_of(cases);
  const cl_float bound = predicate.bound(of.is_fine ? testing::beside_fine_ones(magnitudes) : magnitudes);
  EXPECT_EQ(bound != 0, of.is_fine) << predicate.name << ", " << of.name;
  return bound;
}

void check(const Predicate& predicate, const Class& of, std::size_t count, Random& random,
           const std::function<void(Random&, double*)>& make) {
  Runtime& runtime = PredicateRuntime::get();
  // With a tuning, which changes products alone, half of the cases will do.
  if (std::getenv("FLAUNAY_TUNING") != nullptr) count /= 2;
  Tally tally;
  int failures = 0;
  for (std::size_t done = 0; done < count;) {
    const std::size_t n = std::min(kBatch, count - done);
    done += n;
    std::vector<cl_double> cases(predicate.width * n);
    for (std::size_t i = 0; i < n; ++i) make(random, &cases[predicate.width * i]);

    const Arena::Scope scope(runtime.arena());
    const auto device_cases = upload(runtime, cases);
    const auto filtered = guarded<cl_char>(runtime, n);
    const auto bare = guarded<cl_char>(runtime, n);
    const auto exact = guarded<cl_char>(runtime, n);
    predicate.filter(device_cases, n, bound_of(predicate, of, cases), filtered);
    predicate.filter(device_cases, n, 0, bare);
    predicate.exact(device_cases, n, exact);
    const auto filtered_signs = download(runtime, filtered, n);
    const auto bare_signs = download(runtime, bare, n);
    const auto exact_signs = download(runtime, exact, n);
    for (std::size_t i = 0; i < n; ++i) {
      const double* const c = &cases[predicate.width * i];
      const int expected = predicate.reference(c);
      ++tally.cases;
      tally.zeros += expected == 0;
      tally.undecided += filtered_signs[i] == kUndecided;
      tally.misled += bare_signs[i] != expected;
      const int host_sign = predicate.on_host(c);
      const bool right = exact_signs[i] == expected && host_sign == expected &&
                         (filtered_signs[i] == expected || (of.is_fine && filtered_signs[i] == kUndecided));
      if (right || ++failures > 3) continue;
      ADD_FAILURE() << predicate.name << ", " << of.name << ": the sign is " << expected
                    << ", the filter says " << +filtered_signs[i] << ", the exact version " << +exact_signs[i]
                    << " and on the host " << host_sign << "\n"
                    << text_of(c, predicate.width);
    }
  }
  EXPECT_EQ(failures, 0) << predicate.name << ", " << of.name;
  report(predicate.name, of, tally);
}

// ---------------------------------------------------------------------------------------------------------
// Depth below a chord

/// In the frame: s across the cut, u along it; and the cut.
struct Chord {
  double as, au, bs, bu, ps, pu, q;
};

/// From the frame to the plane.
std::array<double, 2> from_frame(double s, double u, int axis) {
  switch (axis) {
    case kAxisX:
      return {s, u};
    case kAxisY:
      return {-u, s};
    case kPlanarLower:
      return {u, s};
    default:
      return {-u, -s};
  }
}

void write_case(const Chord& chord, int axis, double* out) {
  const auto a = from_frame(chord.as, chord.au, axis);
  const auto b = from_frame(chord.bs, chord.bu, axis);
  const auto p = from_frame(chord.ps, chord.pu, axis);
  const double all[] = {a[0], a[1], b[0], b[1], p[0], p[1], chord.q};
  std::copy(all, all + 7, out);
}

/// The sign by its definition: whether p's projection (u, (s - q)^2 + u^2), or (u, s), is below the chord.
class HullReference {
 public:
  explicit HullReference(int axis) : axis_(axis) {}
  int operator()(const double* c) {
    for (int k = 0; k < 3; ++k) {
      const double x = c[2 * k], y = c[2 * k + 1];
      switch (axis_) {
        case kAxisX:
          set_scaled(s_, x), set_scaled(u_[k], y);
          break;
        case kAxisY:
          set_scaled(s_, y), set_scaled(u_[k], -x);
          break;
        case kPlanarLower:
          set_scaled(s_, y), set_scaled(u_[k], x);
          break;
        default:
          set_scaled(s_, -y), set_scaled(u_[k], -x);
      }
      w_[k] = s_;
      if (!is_planar(axis_)) {
        set_scaled(q_, c[6]);
        s_ -= q_;
        w_[k] = s_ * s_;
        w_[k] += u_[k] * u_[k];
      }
    }
    left_ = (u_[1] - u_[0]) * (w_[2] - w_[0]);
    right_ = (w_[1] - w_[0]) * (u_[2] - u_[0]);
    return sgn(right_ - left_);
  }

 private:
  int axis_;
  mpz_class s_, q_, u_[3], w_[3], left_, right_;
};

void sort_along(Chord& c) {
  if (c.au > c.bu) std::swap(c.au, c.bu);
  if (c.pu < c.au) std::swap(c.pu, c.au);
  if (c.pu > c.bu) std::swap(c.pu, c.bu);
}

/// The s (on a side of q) at which p is on the chord, as well as floating point finds it.
double s_on_chord(const Chord& c, bool planar, double side) {
  const long double to_b = static_cast<long double>(c.bu) - c.pu;
  const long double from_a = static_cast<long double>(c.pu) - c.au;
  const long double length = static_cast<long double>(c.bu) - c.au;
  if (length == 0) return c.as;
  if (planar) return static_cast<double>((c.as * to_b + c.bs * from_a) / length);
  const long double as = static_cast<long double>(c.as) - c.q;
  const long double bs = static_cast<long double>(c.bs) - c.q;
  const long double height = (as * as * to_b + bs * bs * from_a) / length + from_a * to_b;
  return static_cast<double>(c.q + side * std::sqrt(height));
}

Chord random_chord(Random& random) {
  Chord c{random.unit(), random.unit(), random.unit(), random.unit(), random.unit(), random.unit(), 0};
  sort_along(c);
  c.q = random.coin() ? random.unit() : random.coin() ? c.as : c.ps;
  return c;
}

/// Three points whose projections are on one line exactly: on a circle about a point of the cut, or
/// collinear. Integers: up to 1830 times `multiple`, and an origin of the given bits.
Chord straight_chord(Random& random, bool planar, int origin_bits, double multiple = 1) {
  const double q = random.integer(origin_bits), u = random.integer(origin_bits);
  Chord c{};
  c.q = q;
  if (planar) {
    const double ds = multiple * random.integer(5), du = multiple * (1 + random.below(31));
    int steps[] = {random.below(60), random.below(60), random.below(60)};
    std::sort(steps, steps + 3);
    c.as = q + ds * steps[0], c.au = u + du * steps[0];
    c.ps = q + ds * steps[1], c.pu = u + du * steps[1];
    c.bs = q + ds * steps[2], c.bu = u + du * steps[2];
    return c;
  }
  std::array<double, 2> points[] = {on_circle(random), on_circle(random), on_circle(random)};
  for (auto& point : points) point[0] *= multiple, point[1] *= multiple;
  std::sort(points, points + 3, [](const auto& a, const auto& b) { return a[1] < b[1]; });
  c.as = q + points[0][0], c.au = u + points[0][1];
  c.ps = q + points[1][0], c.pu = u + points[1][1];
  c.bs = q + points[2][0], c.bu = u + points[2][1];
  return c;
}

void scale(Chord& c, int exponent) {
  for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) *x = std::ldexp(*x, exponent);
}

void nudge_one(Chord& c, int most, Random& random) {
  double* const all[] = {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q};
  double* const x = all[random.below(7)];
  *x = nudged(*x, most, random);
}

Predicate hull_predicate(int axis) {
  Runtime& runtime = PredicateRuntime::get();
  Predicate predicate;
  predicate.name = std::string("hull depth, ") + kAxisNames[axis];
  predicate.width = 7;
  predicate.filter = [&runtime, axis](const auto& cases, std::size_t n, cl_float bound, const auto& signs) {
    const Arena::Scope scope(runtime.arena());
    const auto depth = guarded<cl_double>(runtime, n);
    testing::map_unchecked(runtime, "predicates", "hull_filtered", n, cl_int{axis}, bound, cases, depth,
                           signs);
  };
  predicate.exact = [&runtime, axis](const auto& cases, std::size_t n, const auto& signs) {
    testing::map_unchecked(runtime, "predicates", "hull_exact", n, cl_int{axis}, cases, signs);
  };
  predicate.on_host = [axis](const double* c) {
    using namespace kernel;
    return hull_depth_sign(to_frame({c[0], c[1]}, axis), to_frame({c[2], c[3]}, axis),
                           to_frame({c[4], c[5]}, axis), c[6], is_planar(axis));
  };
  predicate.reference = HullReference(axis);
  predicate.bound = [](const auto& magnitudes) { return testing::bounds_for(magnitudes).hull; };
  return predicate;
}

class HullDepth : public ::testing::TestWithParam<int> {
 protected:
  void check_class(const Class& of, std::size_t count, const std::function<Chord(Random&)>& make) {
    check(predicate_, of, count, random_,
          [&](Random& random, double* out) { write_case(make(random), axis_, out); });
  }
  int axis_ = GetParam();
  bool planar_ = is_planar(axis_);
  Predicate predicate_ = hull_predicate(axis_);
  Random random_{static_cast<std::uint64_t>(100 + axis_)};
};
INSTANTIATE_TEST_SUITE_P(Axes, HullDepth, ::testing::ValuesIn(kAxes));

TEST_P(HullDepth, OfRandomPoints) { check_class({"random", true, 0, 0.001}, 20000, random_chord); }

TEST_P(HullDepth, OfPointsThatAreNearlyOnTheChord) {
  check_class({"nearly on the chord", true, 0.1, 1, 0, true}, 20000, [&](Random& random) {
    Chord c = random_chord(random);
    c.ps = nudged(s_on_chord(c, planar_, random.sign()), 3, random);
    return c;
  });
  // Differences that are not exact: coordinates of 53 bits about 0, of all exponents down to 2^-30.
  check_class({"nearly on it, mixed magnitudes", true, 0.1, 1, 0, true}, 20000, [&](Random& random) {
    Chord c{};
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.pu, &c.q}) {
      *x = random.sign() * std::ldexp(1 + random.unit(), -random.below(30));
    }
    sort_along(c);
    c.ps = nudged(s_on_chord(c, planar_, random.sign()), 2, random);
    return c;
  });
}

TEST_P(HullDepth, OfPointsThatAreNearlyMirrored) {
  check_class({"nearly mirrored", true, 0.1, 1, 0.01, true}, 15000, [&](Random& random) {
    Chord c = random_chord(random);
    const bool at_b = random.coin();
    c.pu = nudged(at_b ? c.bu : c.au, 2, random);
    const double s = at_b ? c.bs : c.as;
    c.ps = nudged(planar_ ? s : 2 * c.q - s, 2, random);
    return c;
  });
  check_class({"equal along the cut", true, 0.1, 1, 0.01, true}, 15000, [&](Random& random) {
    Chord c = random_chord(random);
    const bool at_b = random.coin();
    c.pu = at_b ? c.bu : c.au;
    const double s = at_b ? c.bs : c.as;
    if (random.coin()) c.ps = nudged(planar_ || random.coin() ? s : 2 * c.q - s, 2, random);
    return c;
  });
}

TEST_P(HullDepth, OfDegeneratePoints) {
  check_class({"grid", true, 0.02, 1, 0.02}, 15000, [](Random& random) {
    Chord c{};
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) *x = random.below(8);
    sort_along(c);
    return c;
  });
  check_class({"straight", true, 1, 1, 1}, 15000, [&](Random& random) {
    Chord c = straight_chord(random, planar_, random.below(46));
    scale(c, random.between(-100, 100));
    return c;
  });
  check_class({"straight but for some ulps", true, 0.02, 1, 0.001, true}, 20000, [&](Random& random) {
    Chord c = straight_chord(random, planar_, random.below(46));
    nudge_one(c, 2, random);
    return c;
  });
}

TEST_P(HullDepth, OfExtremeMagnitudes) {
  check_class({"extreme", true, 0.01, 0.5, 0, true}, 15000, [](Random& random) {
    Chord c{};
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) *x = random.wide();
    sort_along(c);
    return c;
  });
  check_class({"extreme, nearly on the chord", true, 0.5, 1, 0, true}, 15000, [&](Random& random) {
    Chord c{};
    const int top = random.between(-150, 240);
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.pu, &c.q}) {
      *x = random.below(3) ? random.wide(top - 40, top) : random.wide(kLowestExponent, top);
    }
    sort_along(c);
    c.ps = nudged(s_on_chord(c, planar_, random.sign()), 2, random);
    return c;
  });
  check_class({"extreme, straight or next to it", true, 0.5, 1, 0.05, true}, 15000, [&](Random& random) {
    Chord c = straight_chord(random, planar_, 0);
    const int exponent = random.between(-200, 239);
    scale(c, exponent);
    // A coordinate of 0 may become a tiny number: hundreds of binary places below the others.
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) {
      if (*x == 0 && random.coin())
        *x = random.wide(kLowestExponent, std::max(kLowestExponent, exponent - 60));
    }
    return c;
  });
}

TEST_P(HullDepth, AtTheLimitsOfIntegers) {
  check_class({"straight of any span or next to it", true, 0, 1, 0.1}, 30000, [&](Random& random) {
    Chord c = straight_chord(random, planar_, random.between(1, 52), random.integer(random.between(1, 40)));
    if (c.au > c.bu) std::swap(c.au, c.bu), std::swap(c.as, c.bs);
    if (random.coin()) nudge_one(c, 1, random);
    sort_along(c);
    return c;
  });
  check_class({"the largest", true, 0, 1, 0.05}, 30000, [](Random& random) {
    double values[7];
    fill_largest(random, 7, values);
    Chord c{values[0], values[1], values[2], values[3], values[4], values[5], values[6]};
    sort_along(c);
    return c;
  });
}

TEST_P(HullDepth, OfCoarsePointsIsDecidedByTheFilter) {
  for (const int exponent : {0, -255, 230, -17}) {
    check_class({"coarse, 16 bits", false, 0, 0}, 5000, [&](Random& random) {
      Chord c{};
      for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) *x = random.integer(16);
      sort_along(c);
      scale(c, exponent);
      return c;
    });
    check_class({"coarse, the largest", false, 0, 0, 0.001}, 5000, [&](Random& random) {
      Chord c{};
      for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.ps, &c.pu, &c.q}) {
        *x = random.sign() * (65535 - random.below(3));
      }
      sort_along(c);
      scale(c, exponent);
      return c;
    });
    check_class({"coarse, nearly on the chord", false, 0, 0}, 5000, [&](Random& random) {
      Chord c{};
      do {
        for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.pu, &c.q}) *x = random.integer(15);
        sort_along(c);
        c.ps = std::nearbyint(s_on_chord(c, planar_, random.sign()));
      } while (std::fabs(c.ps) > 65535);
      scale(c, exponent);
      return c;
    });
    check_class({"coarse, straight", false, 0, 0, 1}, 5000, [&](Random& random) {
      // Up to 2^15 each, 2^16 together.
      Chord c = straight_chord(random, planar_, 15, 1 + random.below(planar_ ? 17 : 504));
      scale(c, exponent);
      return c;
    });
  }
  // Some bits more, and the cases of the last class need the bound: they are hard enough.
  check_class({"not coarse, straight", true, 0.9, 1, 1, true}, 5000, [&](Random& random) {
    return planar_ ? straight_chord(random, true, 30, random.integer(20))
                   : straight_chord(random, false, 20, random.integer(14));
  });
}

// Of points with equal u, none lower has a smaller depth, and mirror images have the same: quickhull drops
// what shares its u with the deepest point. And is_lower, which says which of them is lower.
class HullHeight : public ::testing::TestWithParam<int> {
 protected:
  static constexpr std::size_t kColumn = 24;  // points that share u

  void check_columns(const char* name, std::size_t chords,
                     const std::function<void(Random&, Chord&, double*)>& make) {
    Runtime& runtime = PredicateRuntime::get();
    const int axis = GetParam();
    Random random(static_cast<std::uint64_t>(200 + axis));
    std::vector<Chord> column_chord(chords);
    std::vector<double> s(chords * kColumn);
    std::vector<cl_double> cases(7 * s.size()), pairs(5 * s.size());
    for (std::size_t k = 0; k < chords; ++k) make(random, column_chord[k], &s[k * kColumn]);
    for (std::size_t i = 0; i < s.size(); ++i) {
      Chord c = column_chord[i / kColumn];
      c.ps = s[i];
      write_case(c, axis, &cases[7 * i]);
      const auto p = from_frame(s[i], c.pu, axis);
      const auto v = from_frame(s[partner(i)], c.pu, axis);
      const double pair[] = {p[0], p[1], v[0], v[1], c.q};
      std::copy(pair, pair + 5, &pairs[5 * i]);
    }

    const Arena::Scope scope(runtime.arena());
    const auto device_cases = upload(runtime, cases);
    const auto device_pairs = upload(runtime, pairs);
    const auto device_depth = guarded<cl_double>(runtime, s.size());
    const auto signs = guarded<cl_char>(runtime, s.size());
    const auto device_lower = guarded<cl_char>(runtime, s.size());
    testing::map_unchecked(runtime, "predicates", "hull_filtered", s.size(), cl_int{axis},
                           testing::usual_bounds().hull, device_cases, device_depth, signs);
    testing::map_unchecked(runtime, "predicates", "lower_cases", s.size(), cl_int{axis}, device_pairs,
                           device_lower);
    const auto depth = download(runtime, device_depth, s.size());
    const auto lower = download(runtime, device_lower, s.size());

    std::size_t mirrored = 0, equal_depth = 0;
    std::vector<mpz_class> height(s.size());
    mpz_class q;
    for (std::size_t i = 0; i < s.size(); ++i) {
      set_scaled(height[i], s[i]);
      if (is_planar(axis)) continue;
      set_scaled(q, column_chord[i / kColumn].q);
      height[i] = abs(height[i] - q);
    }
    for (std::size_t i = 0; i < s.size(); ++i) {
      const double cut = column_chord[i / kColumn].q;
      const std::size_t j = partner(i);
      const bool expected = height[i] != height[j] ? height[i] < height[j] : s[i] < s[j];
      ASSERT_EQ(lower[i] != 0, expected) << name << ": is_lower of s = " << text_of(&s[i], 1) << " and "
                                         << text_of(&s[j], 1) << " for the cut " << text_of(&cut, 1);
      // All pairs of the column.
      for (std::size_t k = i / kColumn * kColumn; k < i; ++k) {
        const int order = cmp(height[k], height[i]);
        const bool fine = order < 0   ? depth[k] >= depth[i]
                          : order > 0 ? depth[k] <= depth[i]
                                      : depth[k] == depth[i];
        ASSERT_TRUE(fine) << name << ": depths " << text_of(&depth[k], 1) << " and " << text_of(&depth[i], 1)
                          << "\n"
                          << text_of(&cases[7 * k], 7) << "\n"
                          << text_of(&cases[7 * i], 7);
        mirrored += order == 0 && s[k] != s[i];
        equal_depth += order != 0 && depth[k] == depth[i];
      }
    }
    std::printf("  %-24s %-38s %8zu points in columns of %zu; %zu mirrored pairs, %zu of equal depth\n",
                (std::string("hull height, ") + kAxisNames[axis]).c_str(), name, s.size(), kColumn, mirrored,
                equal_depth);
    if (!is_planar(axis)) {
      EXPECT_GT(mirrored, s.size() / 50) << name;
    }
    EXPECT_GT(equal_depth, 0u) << name << ": no two heights were near enough to be rounded to one depth";
    total_cases += s.size();
  }

  /// Another point of the column.
  static std::size_t partner(std::size_t i) { return i / kColumn * kColumn + (i + 1) % kColumn; }
};
INSTANTIATE_TEST_SUITE_P(Axes, HullHeight, ::testing::ValuesIn(kAxes));

/// Heights about some base, a few ulps apart, on either side; mirror images of each other as far as they can
/// be.
void fill_column(Random& random, const Chord& c, double base, std::size_t count, double* s) {
  for (std::size_t k = 0; k < count; ++k) {
    switch (k == 0 ? 0 : random.below(4)) {
      case 0:
        s[k] = nudged(base, 4, random);
        break;
      case 1:
        s[k] = supported(2 * c.q - s[random.below(static_cast<int>(k))]);
        break;
      case 2:
        s[k] = nudged(s[random.below(static_cast<int>(k))], 2, random);
        break;
      default:
        s[k] = nudged(2 * c.q - base, 4, random);
    }
  }
}

TEST_P(HullHeight, DepthIsMonotoneForUnitCoordinates) {
  check_columns("unit", 3000, [](Random& random, Chord& c, double* s) {
    c = random_chord(random);
    fill_column(random, c, random.coin() ? random.unit() : nudged(c.q, 3, random), kColumn, s);
  });
}

TEST_P(HullHeight, DepthIsMonotoneForExtremeMagnitudes) {
  check_columns("extreme", 3000, [](Random& random, Chord& c, double* s) {
    for (double* x : {&c.as, &c.au, &c.bs, &c.bu, &c.pu, &c.q}) *x = random.wide();
    sort_along(c);
    // Below 2^249, so that mirror images are below 2^250 and a cut too.
    c.q = random.wide(kLowestExponent, 247);
    fill_column(random, c, random.wide(kLowestExponent, 247), kColumn, s);
    for (std::size_t k = 0; k < kColumn; k += 5)
      s[k] = random.coin() ? c.q : random.wide(kLowestExponent, 247);
  });
}

TEST_P(HullHeight, DepthIsMonotoneForIntegersWithALongChord) {
  check_columns("integers", 3000, [](Random& random, Chord& c, double* s) {
    c = {random.integer(30), -random.unit(), random.integer(30), random.unit(), 0, 0, random.integer(20)};
    if (c.au == c.bu) c.bu = 1;
    c.pu = c.au + (c.bu - c.au) * 0.5;
    const double base = random.integer(20);
    for (std::size_t k = 0; k < kColumn; ++k) {
      s[k] = random.coin() ? base + random.below(5) : 2 * c.q - base - random.below(5);
      if (random.below(3) == 0) s[k] = nudged(s[k], 3, random);
    }
  });
}

// ---------------------------------------------------------------------------------------------------------
// Orientation

class Orientation : public ::testing::Test {
 protected:
  Orientation() {
    Runtime& runtime = PredicateRuntime::get();
    predicate_.name = "orientation";
    predicate_.width = 6;
    predicate_.filter = [&runtime](const auto& cases, std::size_t n, cl_float bound, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", "orient_filtered_cases", n, bound, cases, signs);
    };
    predicate_.exact = [&runtime](const auto& cases, std::size_t n, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", "orient_exact_cases", n, cases, signs);
    };
    predicate_.on_host = [](const double* c) {
      return kernel::orient_exact({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]});
    };
    predicate_.reference = [](const double* c) { return reference_orient2d(c, c + 2, c + 4); };
    predicate_.bound = [](const auto& magnitudes) { return testing::bounds_for(magnitudes).orient; };
  }
  Predicate predicate_;
  Random random_{300};
};

/// Points in any order: to which one the others are translated must not matter.
void permute_points(Random& random, double* c, int points) {
  for (int k = points - 1; k > 0; --k) {
    const int j = random.below(k + 1);
    std::swap(c[2 * k], c[2 * j]);
    std::swap(c[2 * k + 1], c[2 * j + 1]);
  }
}

TEST_F(Orientation, OfRandomPoints) {
  check(predicate_, {"random", true, 0, 0.001}, 100000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 6; ++k) c[k] = random.unit();
  });
}

TEST_F(Orientation, OfNearlyCollinearPoints) {
  check(predicate_, {"nearly collinear", true, 0.1, 1, 0, true}, 150000, random_,
        [](Random& random, double* c) {
          for (int k = 0; k < 4; ++k) c[k] = random.unit();
          const double t = 3 * random.unit() - 1;
          for (int k = 0; k < 2; ++k) c[4 + k] = nudged(c[k] + t * (c[2 + k] - c[k]), 2, random);
          permute_points(random, c, 3);
        });
  // Kettner et al. (2008): the floating-point sign is a patchwork here.
  check(predicate_, {"ulps about (0.5, 0.5)", true, 0.5, 1, 0.001, true}, 100000, random_,
        [](Random& random, double* c) {
          const double points[] = {
              0.5 + 0x1p-53 * random.below(256), 0.5 + 0x1p-53 * random.below(256), 12, 12, 24, 24};
          std::copy(points, points + 6, c);
          permute_points(random, c, 3);
        });
  check(predicate_, {"nearly collinear, mixed magnitudes", true, 0.1, 1, 0, true}, 100000, random_,
        [](Random& random, double* c) {
          for (int k = 0; k < 4; ++k) c[k] = random.sign() * std::ldexp(1 + random.unit(), -random.below(40));
          const double t = 3 * random.unit() - 1;
          for (int k = 0; k < 2; ++k) c[4 + k] = nudged(c[k] + t * (c[2 + k] - c[k]), 2, random);
          permute_points(random, c, 3);
        });
}

TEST_F(Orientation, OfDegeneratePoints) {
  check(predicate_, {"grid", true, 0, 1, 0.1}, 100000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 6; ++k) c[k] = random.below(6);
  });
  check(predicate_, {"collinear", true, 0.1, 1, 1}, 100000, random_, [](Random& random, double* c) {
    const int exponent = random.between(-150, 150);
    for (int axis = 0; axis < 2; ++axis) {
      const double origin = random.integer(50), step = random.integer(40);
      for (int k = 0; k < 3; ++k) c[2 * k + axis] = std::ldexp(origin + k * step, exponent);
    }
    permute_points(random, c, 3);
  });
  check(predicate_, {"equal points or coordinates", true, 0, 1, 0.5}, 100000, random_,
        [](Random& random, double* c) {
          for (int k = 0; k < 6; ++k) c[k] = random.wide();
          if (random.coin()) {
            c[4] = c[0], c[5] = c[1];
          } else {
            c[0] = c[2] = c[4];
          }
          permute_points(random, c, 3);
        });
}

TEST_F(Orientation, OfExtremeMagnitudes) {
  check(predicate_, {"extreme", true, 0.01, 0.5, 0, true}, 100000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 6; ++k) c[k] = random.wide();
  });
  check(predicate_, {"extreme, collinear or next to it", true, 0.3, 1, 0.05, true}, 100000, random_,
        [](Random& random, double* c) {
          const double d[] = {random.integer(8), random.integer(8)};
          const int e1 = random.between(-190, 240), e2 = random.between(-190, 240);
          for (int axis = 0; axis < 2; ++axis) {
            c[axis] = random.coin() ? 0 : random.wide(kLowestExponent, std::max(e1, e2));
            c[2 + axis] = std::ldexp(d[axis], e1);
            c[4 + axis] = std::ldexp(d[axis], e2);
            for (double* x : {&c[2 + axis], &c[4 + axis]}) {
              if (random.below(4) == 0)
                *x += std::copysign(std::ldexp(1.0, std::max(std::ilogb(*x) - 50, -255)), *x);
              if (!(std::fabs(*x) < 0x1p250)) *x = 0;
            }
          }
          permute_points(random, c, 3);
        });
}

TEST_F(Orientation, AtTheLimitsOfIntegers) {
  check(predicate_, {"collinear of any span or next to it", true, 0, 1, 0.2}, 100000, random_,
        [](Random& random, double* c) {
          const int bits = random.between(1, 53);
          const double x = random.integer(bits), y = random.integer(bits);
          for (int k = 0; k < 3; ++k) {
            const int exponent = random.between(0, 64 - bits);
            const double sign = random.sign();
            c[2 * k] = sign * std::ldexp(x, exponent);
            c[2 * k + 1] = sign * std::ldexp(y, exponent);
          }
          if (random.coin()) c[random.below(6)] += random.sign();
        });
  check(predicate_, {"the largest", true, 0, 1, 0.05}, 100000, random_,
        [](Random& random, double* c) { fill_largest(random, 6, c); });
}

/// Integers of so many bits, whose differences have one bit more; a triangle of twice the area 1.
void fill_flat_triangle(Random& random, int bits, int exponent, double* c) {
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  std::int64_t x = 0, y = 0, r = 1, s = 0;
  // x and y without common divisor, and r, s with x s - y r = 1 or -1, from Euclid's algorithm.
  do {
    x = 2 * most - random.below(1 << 20);
    y = 1 + static_cast<std::int64_t>(random.bits() % static_cast<std::uint64_t>(x - 1));
    std::int64_t a = x, b = y, r0 = 1, r1 = 0, s0 = 0, s1 = 1;
    while (b != 0) {
      const std::int64_t quotient = a / b;
      std::tie(a, b) = std::make_pair(b, a - quotient * b);
      std::tie(r0, r1) = std::make_pair(r1, r0 - quotient * r1);
      std::tie(s0, s1) = std::make_pair(s1, s0 - quotient * s1);
    }
    r = a == 1 ? -s0 : 0, s = r0;  // x r0 + y s0 = 1
  } while (r == 0);
  if (r < 0) r += x, s += y;
  const bool mirrored = random.coin(), turned = random.coin();
  const std::int64_t points[] = {-most, -most, x - most, y - most, r - most, s - most};
  for (int k = 0; k < 6; ++k) {
    const std::int64_t value = points[turned ? k ^ 1 : k];
    c[k] = std::ldexp(static_cast<double>(mirrored && k % 2 ? -value : value), exponent);
  }
  permute_points(random, c, 3);
}

TEST_F(Orientation, OfCoarsePointsIsDecidedByTheFilter) {
  for (const int exponent : {0, -255, 220, -31}) {
    check(predicate_, {"coarse, 25 bits", false, 0, 0}, 25000, random_, [&](Random& random, double* c) {
      for (int k = 0; k < 6; ++k) c[k] = std::ldexp(random.integer(25), exponent);
    });
    check(predicate_, {"coarse, the largest", false, 0, 0, 0.01}, 25000, random_,
          [&](Random& random, double* c) {
            for (int k = 0; k < 6; ++k)
              c[k] = std::ldexp(random.sign() * (0x1p25 - 1 - random.below(4)), exponent);
          });
    check(predicate_, {"coarse, as near to collinear as can be", false, 0, 0}, 25000, random_,
          [&](Random& random, double* c) { fill_flat_triangle(random, 25, exponent, c); });
  }
  // Some bits more, and the last class needs the bound: its cases are hard enough.
  check(predicate_, {"not coarse, the same of 29 bits", true, 0.9, 1, 0, true}, 25000, random_,
        [&](Random& random, double* c) { fill_flat_triangle(random, 29, 0, c); });
}

// ---------------------------------------------------------------------------------------------------------
// In-circle, by the determinant and by the comparison of angles

class InCircle : public ::testing::TestWithParam<const char*> {
 protected:
  InCircle() {
    Runtime& runtime = PredicateRuntime::get();
    predicate_.name = GetParam();
    predicate_.width = 8;
    predicate_.filter = [&runtime](const auto& cases, std::size_t n, cl_float bound, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", GetParam(), n, bound, cases, signs);
    };
    predicate_.exact = [&runtime](const auto& cases, std::size_t n, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", "circle_exact_cases", n, cases, signs);
    };
    predicate_.on_host = [](const double* c) {
      return kernel::circle_exact({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]});
    };
    predicate_.reference = [](const double* c) { return reference_incircle(c, c + 2, c + 4, c + 6); };
    predicate_.bound = [](const auto& magnitudes) { return testing::bounds_for(magnitudes).circle; };
  }
  /// Some cases mislead the determinant without its bound, but not the angles.
  static bool by_determinant() { return GetParam() == std::string("circle_filtered_cases"); }
  Predicate predicate_;
  Random random_{400};
};

INSTANTIATE_TEST_SUITE_P(Filters, InCircle,
                         ::testing::Values("circle_filtered_cases", "angle_compared_cases"));

/// The corners of a rectangle are cocircular whatever their coordinates are.
void fill_rectangle(const double* x, const double* y, double* c) {
  const double corners[] = {x[0], y[0], x[1], y[0], x[1], y[1], x[0], y[1]};
  std::copy(corners, corners + 8, c);
}

TEST_P(InCircle, OfRandomPoints) {
  check(predicate_, {"random", true, 0, 0.001}, 30000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 8; ++k) c[k] = random.unit();
  });
}

TEST_P(InCircle, OfNearlyCocircularPoints) {
  check(predicate_, {"nearly cocircular", true, 0.1, 1, 0, true}, 40000, random_,
        [](Random& random, double* c) {
          const double x = random.unit(), y = random.unit(), radius = random.unit();
          for (int k = 0; k < 4; ++k) {
            const double angle = 7 * random.unit();
            c[2 * k] = nudged(x + radius * std::cos(angle), 1, random);
            c[2 * k + 1] = nudged(y + radius * std::sin(angle), 1, random);
          }
        });
  check(predicate_, {"rectangles but for some ulps", true, 0.5, 1, 0.01, true}, 30000, random_,
        [](Random& random, double* c) {
          const double x[] = {random.unit(), random.unit()}, y[] = {random.unit(), random.unit()};
          fill_rectangle(x, y, c);
          double& moved = c[random.below(8)];
          moved = nudged(moved, 2, random);
          permute_points(random, c, 4);
        });
}

TEST_P(InCircle, OfDegeneratePoints) {
  check(predicate_, {"grid", true, 0, 1, 0.1}, 30000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 8; ++k) c[k] = random.below(5);
  });
  check(predicate_, {"rectangles", true, 0.5, 1, 1, by_determinant()}, 30000, random_,
        [](Random& random, double* c) {
          const double x[] = {random.unit(), random.unit()}, y[] = {random.unit(), random.unit()};
          fill_rectangle(x, y, c);
          permute_points(random, c, 4);
        });
  check(predicate_, {"on a circle of integers", true, 1, 1, 1}, 30000, random_,
        [](Random& random, double* c) {
          const int bits = random.below(46), exponent = random.between(-100, 100);
          const double x = random.integer(bits), y = random.integer(bits);
          for (int k = 0; k < 4; ++k) {
            const auto p = on_circle(random);
            c[2 * k] = std::ldexp(x + p[0], exponent);
            c[2 * k + 1] = std::ldexp(y + p[1], exponent);
          }
        });
  check(predicate_, {"collinear or equal points", true, 0, 1, 0.4}, 30000, random_,
        [](Random& random, double* c) {
          for (int k = 0; k < 8; ++k) c[k] = random.unit();
          if (random.coin()) {
            c[0] = c[2] = c[4];
            if (random.coin()) c[6] = nudged(c[0], 1, random);
          } else {
            c[6] = c[0], c[7] = c[1];
          }
          permute_points(random, c, 4);
        });
}

TEST_P(InCircle, OfExtremeMagnitudes) {
  check(predicate_, {"extreme", true, 0.01, 0.5, 0, true}, 20000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 8; ++k) c[k] = random.wide();
  });
  check(predicate_, {"extreme rectangles or next to them", true, 0.3, 1, 0.3, true}, 20000, random_,
        [](Random& random, double* c) {
          const double x[] = {random.wide(), random.wide()}, y[] = {random.wide(), random.wide()};
          fill_rectangle(x, y, c);
          if (random.coin()) {
            double& moved = c[random.below(8)];
            moved = nudged(moved, 1, random);
            if (!(std::fabs(moved) < 0x1p250)) moved = x[0];
          }
          permute_points(random, c, 4);
        });
  check(predicate_, {"extreme, on a circle or next to it", true, 0.5, 1, 0.05, true}, 20000, random_,
        [](Random& random, double* c) {
          const int exponent = random.between(-200, 240);
          for (int k = 0; k < 4; ++k) {
            const auto p = on_circle(random);
            for (int axis = 0; axis < 2; ++axis) {
              double& x = c[2 * k + axis] = std::ldexp(p[axis], exponent);
              if (x == 0 && random.coin())
                x = random.wide(kLowestExponent, std::max(kLowestExponent, exponent - 60));
            }
          }
        });
}

TEST_P(InCircle, AtTheLimitsOfIntegers) {
  check(predicate_, {"rectangles of any span or next to them", true, 0, 1, 0.3}, 30000, random_,
        [](Random& random, double* c) {
          const int bits = random.between(20, 70);
          const double x[] = {spanning(random, bits), spanning(random, bits)};
          const double y[] = {spanning(random, bits), spanning(random, bits)};
          fill_rectangle(x, y, c);
          if (random.coin()) c[random.below(8)] += random.sign();
          permute_points(random, c, 4);
        });
  check(predicate_, {"circles of any span or next to them", true, 0, 1, 0.3}, 30000, random_,
        [](Random& random, double* c) {
          const double multiple = random.integer(random.between(1, 46));
          const int bits = random.between(1, 60);
          const double x = spanning(random, bits), y = spanning(random, bits);
          for (int k = 0; k < 4; ++k) {
            const auto p = on_circle(random);
            c[2 * k] = x + multiple * p[0];
            c[2 * k + 1] = y + multiple * p[1];
          }
          if (random.coin()) c[random.below(8)] += random.sign();
        });
  check(predicate_, {"the largest", true, 0, 1, 0.05}, 30000, random_,
        [](Random& random, double* c) { fill_largest(random, 8, c); });
}

/// On a circle of a radius of up to 65 times `multiple`, or one point next to it. The origin is 0 or makes
/// the coordinates no larger.
void fill_integer_circle(Random& random, int multiple, int exponent, double* c) {
  const int m = 1 + random.below(multiple);
  const int room = 65 * (multiple - m);
  const double x = random.between(-room, room), y = random.between(-room, room);
  for (int k = 0; k < 4; ++k) {
    const auto p = on_circle(random);
    c[2 * k] = x + m * p[0];
    c[2 * k + 1] = y + m * p[1];
  }
  if (random.coin()) c[random.below(8)] += random.sign();
  for (int k = 0; k < 8; ++k) c[k] = std::ldexp(c[k], exponent);
}

TEST_P(InCircle, OfCoarsePointsIsDecidedByTheFilter) {
  for (const int exponent : {0, -255, 239, -31}) {
    check(predicate_, {"coarse, 11 bits", false, 0, 0}, 6000, random_, [&](Random& random, double* c) {
      for (int k = 0; k < 8; ++k) c[k] = std::ldexp(random.integer(11), exponent);
    });
    check(predicate_, {"coarse, the largest", false, 0, 0, 0.01}, 6000, random_,
          [&](Random& random, double* c) {
            for (int k = 0; k < 8; ++k) c[k] = std::ldexp(random.sign() * (2047 - random.below(4)), exponent);
          });
    check(predicate_, {"coarse, on a circle or next to it", false, 0, 0, 0.1}, 6000, random_,
          [&](Random& random, double* c) { fill_integer_circle(random, 31, exponent, c); });
  }
  // Some bits more, and the last class needs the bound: its cases are hard enough.
  check(predicate_, {"not coarse, the same of 15 bits", true, 0.5, 1, 0.1, by_determinant()}, 6000, random_,
        [&](Random& random, double* c) { fill_integer_circle(random, 500, 0, c); });
}

// Against the host's reading of the same text, whose definition planar_test.cpp proves.
TEST(CircleCanonical, IsTheHostsOnTheDevice) {
  Runtime& runtime = PredicateRuntime::get();
  Random random(500);
  std::vector<cl_double> cases;
  while (cases.size() < 8 * kBatch) {
    double c[8];
    switch (random.below(3)) {
      case 0:
        for (double& x : c) x = random.below(5);
        break;
      case 1:
        fill_integer_circle(random, 500, random.between(-100, 100), c);
        break;
      default:
        const double x[] = {random.unit(), random.unit()}, y[] = {random.unit(), random.unit()};
        fill_rectangle(x, y, c);
        permute_points(random, c, 4);
    }
    bool different = true;
    for (int k = 0; k < 3; ++k) different &= c[6] != c[2 * k] || c[7] != c[2 * k + 1];
    const int turn = reference_orient2d(c, c + 2, c + 4);
    if (turn == 0 || !different) continue;
    if (turn < 0) std::swap_ranges(c, c + 2, c + 2);
    cases.insert(cases.end(), c, c + 8);
  }
  const Arena::Scope scope(runtime.arena());
  const auto device_cases = upload(runtime, cases);
  const auto device_signs = guarded<cl_char>(runtime, kBatch);
  const cl_float bound = testing::usual_bounds().circle;
  testing::map_unchecked(runtime, "predicates", "circle_canonical_cases", kBatch, bound, device_cases,
                         device_signs);
  const auto signs = download(runtime, device_signs, kBatch);
  std::size_t ties = 0;
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double* const c = &cases[8 * i];
    const int expected =
        kernel::circle_canonical({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]}, {c[6], c[7]}, bound);
    ASSERT_EQ(signs[i], expected) << text_of(c, 8);
    const int sign = reference_incircle(c, c + 2, c + 4, c + 6);
    ties += sign == 0;
    if (sign != 0) {
      ASSERT_EQ(expected, sign) << text_of(c, 8);
    }
  }
  EXPECT_GT(ties, kBatch / 4);
  total_cases += kBatch;
}

// ---------------------------------------------------------------------------------------------------------
// Nearness, of queries

/// Which of a and b is nearer to q, by its definition.
int reference_nearness(const double* c) {
  mpz_class x[6], distances[2];
  for (int k = 0; k < 6; ++k) mpz_set_d(x[k].get_mpz_t(), std::ldexp(c[k], -kernel::LOWEST_QUERY_EXPONENT));
  for (int k = 0; k < 2; ++k) {
    const mpz_class dx = x[2 * k] - x[4], dy = x[2 * k + 1] - x[5];
    distances[k] = dx * dx + dy * dy;
  }
  return sgn(distances[0] - distances[1]);
}

class Nearness : public ::testing::Test {
 protected:
  Nearness() {
    Runtime& runtime = PredicateRuntime::get();
    predicate_.name = "nearness";
    predicate_.width = 6;
    predicate_.filter = [&runtime](const auto& cases, std::size_t n, cl_float bound, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", "nearness_filtered_cases", n, bound, cases, signs);
    };
    predicate_.exact = [&runtime](const auto& cases, std::size_t n, const auto& signs) {
      testing::map_unchecked(runtime, "predicates", "nearness_exact_cases", n, cases, signs);
    };
    predicate_.on_host = [](const double* c) {
      return kernel::nearness_exact({c[0], c[1]}, {c[2], c[3]}, {c[4], c[5]});
    };
    predicate_.reference = reference_nearness;
    predicate_.bound = [](const auto& magnitudes) {
      return points::query_scaling(magnitudes, 0).nearness_bound;
    };
  }
  Predicate predicate_;
  Random random_{600};
};

/// The second point mirrors the first one in the query, or lies a quarter of a turn or half of one about it.
void fill_equidistant(Random& random, int bits, double* c) {
  const double x = random.integer(bits), y = random.integer(bits);
  const double turns[][2] = {{-x, -y}, {-y, x}, {y, -x}, {x, -y}, {-x, y}, {y, x}};
  const auto& other = turns[random.below(6)];
  for (int k = 4; k < 6; ++k) c[k] = random.integer(bits);
  c[0] = c[4] + x, c[1] = c[5] + y;
  c[2] = c[4] + other[0], c[3] = c[5] + other[1];
}

TEST_F(Nearness, OfRandomPoints) {
  check(predicate_, {"random", true, 0, 0.001}, 30000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 6; ++k) c[k] = random.unit();
  });
  check(predicate_, {"extreme", true, 0, 0.5}, 30000, random_, [](Random& random, double* c) {
    const int exponent = random.coin() ? 259 : -256;
    for (int k = 0; k < 6; ++k) c[k] = std::ldexp(random.wide(), exponent);
  });
}

TEST_F(Nearness, OfPointsThatAreNearlyAsNear) {
  check(predicate_, {"nearly as near", true, 0.1, 1, 0, true}, 30000, random_, [](Random& random, double* c) {
    for (int k = 0; k < 6; ++k) c[k] = random.unit();
    const double radius = std::hypot(c[0] - c[4], c[1] - c[5]), angle = 7 * random.unit();
    c[2] = nudged(c[4] + radius * std::cos(angle), 2, random);
    c[3] = nudged(c[5] + radius * std::sin(angle), 2, random);
  });
  check(predicate_, {"as near but for some ulps", true, 0.1, 1, 0.001, true}, 30000, random_,
        [](Random& random, double* c) {
          fill_equidistant(random, 50, c);
          double& one = c[random.below(6)];
          one = nudged(one, 2, random);
        });
  check(predicate_, {"as near", true, 1, 1, 1}, 15000, random_, [](Random& random, double* c) {
    fill_equidistant(random, random.between(1, 50), c);
    const int exponent = random.between(-200, 190);
    for (int k = 0; k < 6; ++k) c[k] = std::ldexp(c[k], exponent);
  });
}

TEST_F(Nearness, AtTheLimitsOfIntegers) {
  check(predicate_, {"the largest", true, 0, 1, 0.02}, 30000, random_,
        [](Random& random, double* c) { fill_largest(random, 6, c); });
}

TEST_F(Nearness, OfCoarsePointsIsDecidedByTheFilter) {
  for (const int exponent : {0, -511, 485, -31}) {
    const auto scale = [exponent](double* c) {
      for (int k = 0; k < 6; ++k) c[k] = std::ldexp(c[k], exponent);
    };
    check(predicate_, {"coarse, 24 bits", false, 0, 0}, 6000, random_, [&](Random& random, double* c) {
      for (int k = 0; k < 6; ++k) c[k] = random.integer(24);
      scale(c);
    });
    check(predicate_, {"coarse, the largest", false, 0, 0, 0.01}, 6000, random_,
          [&](Random& random, double* c) {
            for (int k = 0; k < 6; ++k) c[k] = random.sign() * (0xffffff - random.below(4));
            scale(c);
          });
    check(predicate_, {"coarse, as near", false, 0, 0, 1}, 6000, random_, [&](Random& random, double* c) {
      fill_equidistant(random, 22, c);
      scale(c);
    });
  }
}

// ---------------------------------------------------------------------------------------------------------

/// Prints how many cases there were in all.
class Total : public ::testing::Environment {
 public:
  void TearDown() override { std::printf("  %zu cases compared with GMP in all\n", total_cases); }
};
[[maybe_unused]] ::testing::Environment* const kTotal = ::testing::AddGlobalTestEnvironment(new Total);

}  // namespace
}  // namespace flaunay
