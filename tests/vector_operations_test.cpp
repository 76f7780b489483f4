// The vector operations against plain loops, under every kind of tuning; and what they stand on: memory,
// errors, the choice of the device, the accounts.
//
// Suites named Small... have tiny inputs and make no OpenCL call fail: tests/oclgrind.sh runs them in a
// simulator.
#include "host/vector_operations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/device.hpp"
#include "tests/support/paths.hpp"

namespace flaunay {
namespace {

using host::Arena;
using host::Buffer;
using host::DeviceError;
using host::Runtime;
using testing::download;
using testing::guarded;
using testing::ScopedEnvironment;
using testing::TemporaryFolder;
using testing::upload;

using Random = std::mt19937_64;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// "own": what the device would get, or what the environment names, and then no other; the others are for
/// boundaries.
const char* const kTunings[] = {"own", "small", "gpu"};

host::Tuning tuning_named(const std::string& name) {
  const auto device = host::find_device("");
  if (name == "own") return host::tuning_for(device);
  const ScopedEnvironment kind("FLAUNAY_TUNING", name.c_str());
  return host::tuning_for(device);
}

/// One runtime for each tuning, destroyed before the OpenCL implementation leaves.
class Runtimes : public ::testing::Environment {
 public:
  void TearDown() override { runtimes().clear(); }
  static Runtime& get(const std::string& tuning) {
    std::unique_ptr<Runtime>& runtime = runtimes()[tuning];
    if (!runtime) {
      runtime = std::make_unique<Runtime>(host::find_device(""));
      runtime->set_tuning(tuning_named(tuning));
    }
    return *runtime;
  }

 private:
  static std::map<std::string, std::unique_ptr<Runtime>>& runtimes() {
    static std::map<std::string, std::unique_ptr<Runtime>> all;
    return all;
  }
};
[[maybe_unused]] ::testing::Environment* const kRuntimes = ::testing::AddGlobalTestEnvironment(new Runtimes);

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

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// ---------------------------------------------------------------------------------------------------------
// Segmented input

struct Shape {
  std::string name;
  std::vector<cl_int> segment;  ///< of each element
  std::vector<cl_int> offsets;  ///< where each segment begins, and the end
  std::size_t size() const { return segment.size(); }
  std::size_t segments() const { return offsets.size() - 1; }
  std::size_t length(std::size_t s) const { return static_cast<std::size_t>(offsets[s + 1] - offsets[s]); }
};

Shape shape_of(const std::string& name, const std::vector<std::size_t>& lengths) {
  Shape shape{name, {}, {0}};
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    shape.segment.insert(shape.segment.end(), lengths[s], static_cast<cl_int>(s));
    shape.offsets.push_back(static_cast<cl_int>(shape.segment.size()));
  }
  return shape;
}

std::vector<Shape> small_shapes() {
  return {
      shape_of("no segments", {}),
      shape_of("empty segments only", {0, 0, 0}),
      shape_of("one element", {1}),
      shape_of("two in one", {2}),
      shape_of("two in two", {1, 1}),
      shape_of("one element among empty segments", {0, 0, 1, 0, 0}),
      shape_of("empty at begin, middle and end", {0, 0, 3, 0, 4, 0, 0, 0, 1, 0}),
      shape_of("one chunk of the small tuning", {5}),
      shape_of("one more", {6}),
      shape_of("ends at chunk ends", {5, 5, 10, 0, 5}),
      shape_of("over many chunks", {2, 31, 2}),
      shape_of("one segment", {40}),
      shape_of("one-element segments", std::vector<std::size_t>(23, 1)),
      shape_of("two long ones, the second begins within a chunk", {18, 0, 19}),
  };
}

std::vector<Shape> random_shapes(Random& random) {
  std::vector<Shape> shapes;
  for (int k = 0; k < 24; ++k) {
    const std::size_t size = random() % 5000 + 1;
    const std::size_t longest = std::size_t{1} << random() % 13;
    std::vector<std::size_t> lengths(random() % 3, 0);
    for (std::size_t left = size; left > 0;) {
      const std::size_t length = random() % 4 == 0 ? 0 : std::min(left, random() % longest + 1);
      lengths.push_back(length);
      left -= length;
    }
    lengths.resize(lengths.size() + random() % 3, 0);
    shapes.push_back(shape_of("random shape " + std::to_string(k), lengths));
  }
  return shapes;
}

/// Lengths that are multiples of no tuning's chunk.
std::vector<Shape> large_shapes(Random& random) {
  std::vector<std::size_t> tiny(700001);
  for (std::size_t& length : tiny) length = random() % 4;
  return {
      shape_of("a huge segment", {1000003}),
      shape_of("a huge segment among small ones", {0, 3, 0, 900001, 1, 0, 70000, 0}),
      shape_of("a million one-element segments", std::vector<std::size_t>(1000003, 1)),
      shape_of("a million elements in segments of 0 to 3", tiny),
  };
}

/// Every way to cut n elements in segments.
template <typename Check>
void for_all_cuts(std::size_t n, const Check& check) {
  for (std::size_t cuts = 0; cuts < std::size_t{1} << (n - 1); ++cuts) {
    std::vector<std::size_t> lengths{1};
    for (std::size_t i = 1; i < n; ++i) {
      if (cuts >> (i - 1) & 1) {
        lengths.push_back(1);
      } else {
        ++lengths.back();
      }
    }
    check(shape_of("cuts " + std::to_string(cuts), lengths));
    if (::testing::Test::HasFailure()) return;
  }
}

// ---------------------------------------------------------------------------------------------------------
// Scans

template <typename T>
using Components = std::array<cl_uint, sizeof(T) / sizeof(cl_uint)>;

template <typename T>
std::vector<T> plain_scan(const std::vector<T>& input) {
  std::vector<T> output(input.size() + 1);
  Components<T> sum{};
  for (std::size_t i = 0; i <= input.size(); ++i) {
    std::memcpy(&output[i], &sum, sizeof sum);
    if (i == input.size()) break;
    Components<T> value;
    std::memcpy(&value, &input[i], sizeof value);
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += value[c];
  }
  return output;
}

/// All 32 bits of the values vary, so the sums wrap around.
template <typename T>
std::vector<T> random_values(std::size_t n, Random& random) {
  std::vector<T> values(n);
  for (T& value : values) {
    Components<T> parts;
    for (cl_uint& part : parts) part = static_cast<cl_uint>(random());
    std::memcpy(&value, &parts, sizeof value);
  }
  return values;
}

template <typename T>
void check_scan(Runtime& runtime, std::size_t n, Random& random) {
  SCOPED_TRACE("n = " + std::to_string(n));
  const Arena::Scope scope(runtime.arena());
  const std::vector<T> values = random_values<T>(n, random);
  const std::vector<T> expected = plain_scan(values);

  const auto input = upload(runtime, values);
  const auto output = guarded<T>(runtime, n + 1);
  host::exclusive_scan(runtime, input, n, output);
  expect_same(download(runtime, output, n + 1), expected, "scan");
  expect_same(download(runtime, input, n), values, "the scan's input");

  const auto in_place = guarded<T>(runtime, n + 1);
  runtime.write(in_place, 0, n, values.data());
  host::exclusive_scan(runtime, in_place, n, in_place);
  expect_same(download(runtime, in_place, n + 1), expected, "scan in place");
}

template <typename T>
class SmallScan : public ::testing::Test {};
template <typename T>
class Scan : public ::testing::Test {};
using ScanTypes = ::testing::Types<cl_uint, cl_uint2, cl_uint8>;
TYPED_TEST_SUITE(SmallScan, ScanTypes);
TYPED_TEST_SUITE(Scan, ScanTypes);

TYPED_TEST(SmallScan, IsThePlainLoop) {
  Random random(1);
  under_each_tuning([&](Runtime& runtime) {
    for (const std::size_t n : {0, 1, 2, 4, 5, 6, 10, 25, 26, 32, 33, 40}) {
      check_scan<TypeParam>(runtime, n, random);
    }
  });
}

TYPED_TEST(Scan, IsThePlainLoop) {
  Random random(2);
  under_each_tuning([&](Runtime& runtime) {
    for (std::size_t n = 0; n < 140; ++n) check_scan<TypeParam>(runtime, n, random);
    for (int k = 0; k < 20; ++k) check_scan<TypeParam>(runtime, random() % 5000, random);
    check_scan<TypeParam>(runtime, 1000003, random);
  });
}

// ---------------------------------------------------------------------------------------------------------
// Pack

std::vector<cl_int> plain_positions(const std::vector<cl_uchar>& flags, int wanted) {
  std::vector<cl_int> positions;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == wanted) positions.push_back(static_cast<cl_int>(i));
  }
  return positions;
}

void check_pack(Runtime& runtime, const std::vector<cl_uchar>& flags, int wanted) {
  SCOPED_TRACE("n = " + std::to_string(flags.size()) + ", wanted " + std::to_string(wanted));
  const Arena::Scope scope(runtime.arena());
  const std::vector<cl_int> expected = plain_positions(flags, wanted);
  const auto input = upload(runtime, flags);

  // Room for all that are wanted, and not for one more.
  const auto positions = guarded<cl_int>(runtime, expected.size());
  const auto count = guarded<cl_uint>(runtime, 1);
  host::pack_positions(runtime, input, flags.size(), wanted, positions, count);
  EXPECT_EQ(download(runtime, count, 1)[0], expected.size());
  expect_same(download(runtime, positions, expected.size()), expected, "positions");

  const auto [packed, size] = host::pack_positions(runtime, input, flags.size(), wanted);
  ASSERT_EQ(size, expected.size());
  ASSERT_EQ(packed.size(), expected.size());
  std::vector<cl_int> read(size);
  runtime.read(packed, 0, size, read.data());
  expect_same(read, expected, "allocated positions");
}

std::vector<cl_uchar> random_flags(std::size_t n, int kinds, Random& random) {
  std::vector<cl_uchar> flags(n);
  for (cl_uchar& flag : flags) flag = static_cast<cl_uchar>(random() % kinds);
  return flags;
}

TEST(SmallPack, IsThePlainLoop) {
  Random random(3);
  under_each_tuning([&](Runtime& runtime) {
    for (const std::size_t n : {0, 1, 2, 5, 6, 31, 40}) check_pack(runtime, random_flags(n, 3, random), 1);
  });
}

TEST(Pack, IsThePlainLoop) {
  Random random(4);
  under_each_tuning([&](Runtime& runtime) {
    for (int k = 0; k < 20; ++k) {
      std::vector<cl_uchar> flags = random_flags(random() % 5000, 4, random);
      for (const int wanted : {0, 1, 2, 3}) check_pack(runtime, flags, wanted);
    }
    check_pack(runtime, random_flags(1000003, 2, random), 1);
    check_pack(runtime, random_flags(1000003, 256, random), 255);
  });
}

TEST(Pack, FindsAllNoneFirstAndLast) {
  under_each_tuning([&](Runtime& runtime) {
    for (const std::size_t n : {1, 2, 5, 6, 1000, 4999}) {
      check_pack(runtime, std::vector<cl_uchar>(n, 1), 1);
      check_pack(runtime, std::vector<cl_uchar>(n, 1), 0);
      std::vector<cl_uchar> flags(n, 0);
      flags.front() = 7;
      check_pack(runtime, flags, 7);
      std::swap(flags.front(), flags.back());
      check_pack(runtime, flags, 7);
    }
  });
}

// ---------------------------------------------------------------------------------------------------------
// Sort

/// The payloads tell equal keys apart, so an unstable sort shows.
void check_sort(Runtime& runtime, const std::vector<cl_ulong>& keys, const std::string& what) {
  SCOPED_TRACE(what + ", n = " + std::to_string(keys.size()));
  const Arena::Scope scope(runtime.arena());
  std::vector<cl_int> order(keys.size());
  std::iota(order.begin(), order.end(), 0);
  const auto device_keys = upload(runtime, keys);
  const auto payloads = upload(runtime, order);
  host::sort_by_key(runtime, device_keys, payloads, keys.size());

  std::stable_sort(order.begin(), order.end(), [&](cl_int i, cl_int j) { return keys[i] < keys[j]; });
  std::vector<cl_ulong> sorted(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) sorted[i] = keys[order[i]];
  expect_same(download(runtime, device_keys, keys.size()), sorted, "keys");
  expect_same(download(runtime, payloads, keys.size()), order, "payloads");
}

struct Pattern {
  const char* name;
  cl_ulong varying;  ///< the bits that are random
  cl_ulong fixed;
};
const Pattern kPatterns[] = {
    {"all bits vary", ~0ull, 0},
    {"all keys equal", 0, 0x8123456789abcdefull},
    {"few keys, many equal", 0x8000000000000005ull, 0},
    {"digits in the middle", 0x00000ff000fff000ull, 0xf00000000000000full},
    {"the top bit alone", 0x8000000000000000ull, 0x7fffffffffffffffull},
    {"the lowest bit alone", 1, 0xfffffffffffffffeull},
    {"the lower word alone", 0xffffffffull, 0xabcdull << 32},
    {"the upper word alone", 0xffffffffull << 32, 0xabcdull},
};

std::vector<cl_ulong> random_keys(std::size_t n, const Pattern& pattern, Random& random) {
  std::vector<cl_ulong> keys(n);
  for (cl_ulong& key : keys) key = (random() & pattern.varying) | (pattern.fixed & ~pattern.varying);
  return keys;
}

TEST(SmallSort, IsTheStableSort) {
  Random random(5);
  under_each_tuning([&](Runtime& runtime) {
    check_sort(runtime, random_keys(40, kPatterns[0], random), kPatterns[0].name);
    // Few digits vary: few passes.
    for (const std::size_t n : {0, 1, 2, 3, 12, 13, 40}) {
      check_sort(runtime, random_keys(n, kPatterns[2], random), kPatterns[2].name);
    }
  });
}

TEST(Sort, IsTheStableSort) {
  Random random(6);
  under_each_tuning([&](Runtime& runtime) {
    for (const Pattern& pattern : kPatterns) {
      for (int k = 0; k < 5; ++k) {
        check_sort(runtime, random_keys(random() % 5000, pattern, random), pattern.name);
      }
    }
    for (std::size_t n = 0; n < 30; ++n) check_sort(runtime, random_keys(n, kPatterns[2], random), "short");
  });
}

TEST(Sort, IsTheStableSortOfAMillion) {
  Random random(7);
  under_each_tuning([&](Runtime& runtime) {
    check_sort(runtime, random_keys(1000003, kPatterns[0], random), kPatterns[0].name);
    check_sort(runtime, random_keys(1000003, kPatterns[2], random), kPatterns[2].name);
  });
}

TEST(Sort, KeepsWhatIsSortedAndTurnsWhatIsReversed) {
  under_each_tuning([&](Runtime& runtime) {
    std::vector<cl_ulong> keys(4321);
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = i / 3 * 0x0001000100010001ull;
    check_sort(runtime, keys, "sorted");
    std::reverse(keys.begin(), keys.end());
    check_sort(runtime, keys, "reversed");
  });
}

TEST(SmallSort, SkipsDigitsInWhichNoKeysDiffer) {
  under_each_tuning([&](Runtime& runtime) {
    runtime.set_profiling(true);
    const int bits = runtime.tuning().sort_bits;
    const auto passes = [&](cl_ulong a, cl_ulong b) {
      const Arena::Scope scope(runtime.arena());
      const auto keys = upload(runtime, std::vector<cl_ulong>{b, a, b});
      const auto payloads = upload(runtime, std::vector<cl_int>{0, 1, 2});
      runtime.reset_accounts();
      host::sort_by_key(runtime, keys, payloads, 3);
      EXPECT_EQ(runtime.waits(), 1u);  // documented: once, to find the digits
      return runtime.kernel_times()["sort_scatter"].launches;
    };
    EXPECT_EQ(passes(7, 7), 0u);
    EXPECT_EQ(passes(0, 1), 1u);
    EXPECT_EQ(passes(0, cl_ulong{1} << 63), 1u);
    EXPECT_EQ(passes(1, cl_ulong{1} << 63), 2u);
    EXPECT_EQ(passes(0, ~cl_ulong{0}), static_cast<std::size_t>((64 + bits - 1) / bits));
    runtime.set_profiling(false);
  });
}

// ---------------------------------------------------------------------------------------------------------
// Segmented arg-min and arg-max

enum class Values { random, tied, infinite, rising, falling };
constexpr Values kAllValues[] = {Values::random, Values::tied, Values::infinite, Values::rising,
                                 Values::falling};

std::vector<cl_double> random_doubles(std::size_t n, Values kind, Random& random) {
  // Zeros of either sign are equal: the first of them counts.
  const double tied[] = {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 0x1p-1074, 0x1p1023};
  const bool positive = random() % 2;
  std::vector<cl_double> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    switch (kind) {
      case Values::random:
        values[i] = std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -60);
        break;
      case Values::tied:
        values[i] = tied[random() % 8];
        break;
      case Values::infinite:
        values[i] = positive ? kInfinity : -kInfinity;
        break;
      case Values::rising:
        values[i] = static_cast<double>(i);
        break;
      case Values::falling:
        values[i] = -static_cast<double>(i);
        break;
    }
  }
  return values;
}

/// better(i, j): whether element i is to be preferred to the earlier j.
template <typename Better>
std::vector<cl_int> plain_arg_best(const Shape& shape, const Better& better) {
  std::vector<cl_int> best(shape.segments(), -1);
  for (std::size_t i = 0; i < shape.size(); ++i) {
    cl_int& j = best[shape.segment[i]];
    if (j < 0 || better(i, static_cast<std::size_t>(j))) j = static_cast<cl_int>(i);
  }
  return best;
}

void check_arg(Runtime& runtime, const Shape& shape, const std::vector<cl_double>& values) {
  SCOPED_TRACE(shape.name);
  const Arena::Scope scope(runtime.arena());
  const auto segment = upload(runtime, shape.segment);
  const auto device_values = upload(runtime, values);
  const auto least = guarded<cl_int>(runtime, shape.segments());
  const auto greatest = guarded<cl_int>(runtime, shape.segments());
  host::segmented_arg_min(runtime, device_values, segment, shape.size(), shape.segments(), least);
  host::segmented_arg_max(runtime, device_values, segment, shape.size(), shape.segments(), greatest);
  expect_same(download(runtime, least, shape.segments()),
              plain_arg_best(shape, [&](std::size_t i, std::size_t j) { return values[i] < values[j]; }),
              "arg-min");
  expect_same(download(runtime, greatest, shape.segments()),
              plain_arg_best(shape, [&](std::size_t i, std::size_t j) { return values[i] > values[j]; }),
              "arg-max");
}

TEST(SmallSegmentedArg, IsThePlainLoop) {
  Random random(8);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : small_shapes()) {
      for (const Values kind : {Values::tied, Values::falling}) {
        check_arg(runtime, shape, random_doubles(shape.size(), kind, random));
      }
    }
  });
}

TEST(SegmentedArg, IsThePlainLoop) {
  Random random(9);
  under_each_tuning([&](Runtime& runtime) {
    for (const auto& shapes : {small_shapes(), random_shapes(random)}) {
      for (const Shape& shape : shapes) {
        for (const Values kind : kAllValues) {
          check_arg(runtime, shape, random_doubles(shape.size(), kind, random));
        }
      }
    }
  });
}

TEST(SegmentedArg, IsThePlainLoopForHugeAndTinySegments) {
  Random random(10);
  const std::vector<Shape> shapes = large_shapes(random);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : shapes) {
      for (const Values kind : {Values::random, Values::tied}) {
        check_arg(runtime, shape, random_doubles(shape.size(), kind, random));
      }
    }
  });
}

// 11 elements are 3 chunks of the small tuning's 5, and need three passes.
TEST(SegmentedArg, IsThePlainLoopForAllCutsOf11) {
  Random random(11);
  for_all_cuts(11, [&](const Shape& shape) {
    check_arg(Runtimes::get("small"), shape, random_doubles(shape.size(), Values::tied, random));
  });
}

// The skeleton with elements that are no candidates, as quickhull uses it: whole chunks may have none.
TEST(SegmentedArg, PassesOverElementsThatAreNoCandidates) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() + "/shared");
  for (const char* const header : {"/shared/segmented_arg_reduce.h", "/shared/counting.h"}) {
    std::filesystem::copy_file(test_data() + "/../../kernels" + header, folder.path() + header);
  }
  folder.write("kept.cl",
               "#include \"shared/segmented_arg_reduce.h\"\n"
               "#define KEPT(i) values[i] > 0 ? i : -1\n"
               "#define SMALLER(run, i, j) (values[i] < values[j] || (values[i] == values[j] && i < j))\n"
               "SEGMENTED_ARG_REDUCE(least_positive, KEPT, SMALLER, global const int* restrict values)\n");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  Random random(12);
  std::vector<Shape> shapes = small_shapes();
  for (Shape& shape : random_shapes(random)) shapes.push_back(std::move(shape));
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : shapes) {
      SCOPED_TRACE(shape.name);
      const Arena::Scope scope(runtime.arena());
      std::vector<cl_int> values(shape.size());
      const cl_int share = static_cast<cl_int>(random() % 40);
      for (cl_int& value : values) value = static_cast<cl_int>(random() % 43) - share;
      std::vector<cl_int> expected(shape.segments(), -1);
      for (std::size_t i = 0; i < shape.size(); ++i) {
        cl_int& best = expected[shape.segment[i]];
        if (values[i] > 0 && (best < 0 || values[i] < values[best])) best = static_cast<cl_int>(i);
      }
      const auto segment = upload(runtime, shape.segment);
      const auto device_values = upload(runtime, values);
      const auto result = upload(runtime, std::vector<cl_int>(shape.segments(), -1));
      host::segmented_arg_reduce(runtime, "kept", "least_positive", segment, shape.size(), result,
                                 device_values);
      expect_same(download(runtime, result, shape.segments()), expected, "least positive");
    }
  });
}

// ---------------------------------------------------------------------------------------------------------
// Segmented sums

void check_sum(Runtime& runtime, const Shape& shape, Random& random) {
  SCOPED_TRACE(shape.name);
  const Arena::Scope scope(runtime.arena());
  std::vector<cl_long> values(shape.size());
  for (cl_long& value : values) value = static_cast<cl_long>(random()) >> 22;  // a million stay below 2^63
  std::vector<cl_long> scanned(shape.size());
  std::vector<cl_long> total(shape.segments(), 0);
  for (std::size_t i = 0; i < shape.size(); ++i) scanned[i] = total[shape.segment[i]] += values[i];

  const auto segment = upload(runtime, shape.segment);
  const auto device_values = upload(runtime, values);
  const auto device_scanned = guarded<cl_long>(runtime, shape.size());
  const auto device_total = guarded<cl_long>(runtime, shape.segments());
  host::segmented_sum(runtime, device_values, segment, shape.size(), shape.segments(), device_scanned,
                      device_total);
  expect_same(download(runtime, device_scanned, shape.size()), scanned, "sums");
  expect_same(download(runtime, device_total, shape.segments()), total, "totals");
  expect_same(download(runtime, device_values, shape.size()), values, "the sums' input");

  // In place, as segmented_select does.
  const auto again = guarded<cl_long>(runtime, shape.segments());
  host::segmented_sum(runtime, device_values, segment, shape.size(), shape.segments(), device_values, again);
  expect_same(download(runtime, device_values, shape.size()), scanned, "sums in place");
  expect_same(download(runtime, again, shape.segments()), total, "totals in place");
}

TEST(SmallSegmentedSum, IsThePlainLoop) {
  Random random(13);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : small_shapes()) check_sum(runtime, shape, random);
  });
}

TEST(SegmentedSum, IsThePlainLoop) {
  Random random(14);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : random_shapes(random)) check_sum(runtime, shape, random);
  });
}

TEST(SegmentedSum, IsThePlainLoopForHugeAndTinySegments) {
  Random random(15);
  const std::vector<Shape> shapes = large_shapes(random);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : shapes) check_sum(runtime, shape, random);
  });
}

TEST(SegmentedSum, IsThePlainLoopForAllCutsOf11) {
  Random random(16);
  for_all_cuts(11, [&](const Shape& shape) { check_sum(Runtimes::get("small"), shape, random); });
}

// ---------------------------------------------------------------------------------------------------------
// Segmented split, and permute

void check_split(Runtime& runtime, const Shape& shape, int sides, Random& random) {
  SCOPED_TRACE(shape.name + ", " + std::to_string(sides) + " sides");
  const Arena::Scope scope(runtime.arena());
  const std::vector<cl_uchar> side = random_flags(shape.size(), sides, random);
  std::vector<cl_int> values(shape.size());
  for (cl_int& value : values) value = static_cast<cl_int>(random());
  std::vector<cl_int> places(shape.size(), -1);
  std::vector<cl_int> moved;
  for (std::size_t s = 0; s < shape.segments(); ++s) {
    for (const cl_uchar wanted : {0, 1}) {
      for (cl_int i = shape.offsets[s]; i < shape.offsets[s + 1]; ++i) {
        if (side[i] != wanted) continue;
        places[i] = static_cast<cl_int>(moved.size());
        moved.push_back(values[i]);
      }
    }
  }

  const auto device_side = upload(runtime, side);
  const auto segment = upload(runtime, shape.segment);
  const auto offsets = upload(runtime, shape.offsets);
  const auto device_values = upload(runtime, values);
  const auto device_places = guarded<cl_int>(runtime, shape.size());
  const auto device_moved = guarded<cl_int>(runtime, moved.size());
  host::segmented_split(runtime, device_side, segment, offsets, shape.size(), device_places);
  expect_same(download(runtime, device_places, shape.size()), places, "places");
  host::permute(runtime, device_places, device_values, shape.size(), device_moved);
  expect_same(download(runtime, device_moved, moved.size()), moved, "moved");
}

TEST(SmallSegmentedSplit, IsThePlainLoop) {
  Random random(17);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : small_shapes()) check_split(runtime, shape, 3, random);
  });
}

// One side: all stay, 2: nothing is dropped, 4: half are dropped, 200: nearly all.
TEST(SegmentedSplit, IsThePlainLoop) {
  Random random(18);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : random_shapes(random)) {
      for (const int sides : {1, 2, 4, 200}) check_split(runtime, shape, sides, random);
    }
  });
}

TEST(SegmentedSplit, IsThePlainLoopForHugeAndTinySegments) {
  Random random(19);
  const std::vector<Shape> shapes = large_shapes(random);
  under_each_tuning([&](Runtime& runtime) {
    for (const Shape& shape : shapes) check_split(runtime, shape, 3, random);
  });
}

TEST(SmallPermute, MovesAndLeavesOut) {
  under_each_tuning([&](Runtime& runtime) {
    const auto places = upload(runtime, std::vector<cl_int>{3, -1, 0, 5, -7, 1});
    const auto values = upload(runtime, std::vector<cl_int>{10, 11, 12, 13, 14, 15});
    const auto moved = upload(runtime, std::vector<cl_int>(6, 99));
    host::permute(runtime, places, values, 6, moved);
    expect_same(download(runtime, moved, 6), std::vector<cl_int>{12, 15, 99, 10, 99, 13}, "moved");
    host::permute(runtime, places, values, 0, moved);  // nothing to do
    expect_same(download(runtime, moved, 6), std::vector<cl_int>{12, 15, 99, 10, 99, 13}, "moved");
  });
}

TEST(Permute, IsThePlainLoop) {
  Random random(20);
  under_each_tuning([&](Runtime& runtime) {
    for (const std::size_t n : {1, 2, 4999, 1000003}) {
      const Arena::Scope scope(runtime.arena());
      std::vector<cl_int> places(n), values(n), expected(n);
      std::iota(places.begin(), places.end(), 0);
      std::shuffle(places.begin(), places.end(), random);
      for (std::size_t i = 0; i < n; ++i) {
        values[i] = static_cast<cl_int>(random());
        expected[places[i]] = values[i];
      }
      const auto device_places = upload(runtime, places);
      const auto device_values = upload(runtime, values);
      const auto moved = guarded<cl_int>(runtime, n);
      host::permute(runtime, device_places, device_values, n, moved);
      expect_same(download(runtime, moved, n), expected, "moved");
    }
  });
}

// ---------------------------------------------------------------------------------------------------------
// Segmented selection

enum class Rank { first, median, last, random };

void check_select(Runtime& runtime, const Shape& shape, const Pattern& pattern, Rank which, Random& random) {
  SCOPED_TRACE(shape.name + ", " + pattern.name);
  const Arena::Scope scope(runtime.arena());
  const std::vector<cl_ulong> keys = random_keys(shape.size(), pattern, random);
  std::vector<cl_long> rank(shape.segments(), 0);
  std::vector<cl_ulong> expected(shape.segments(), 0);
  std::vector<cl_ulong> scratch = keys;
  for (std::size_t s = 0; s < shape.segments(); ++s) {
    const std::size_t length = shape.length(s);
    if (length == 0) continue;
    const std::size_t r = which == Rank::first    ? 0
                          : which == Rank::median ? length / 2
                          : which == Rank::last   ? length - 1
                                                  : random() % length;
    rank[s] = static_cast<cl_long>(r);
    const auto begin = scratch.begin() + shape.offsets[s];
    std::nth_element(begin, begin + rank[s], scratch.begin() + shape.offsets[s + 1]);
    expected[s] = begin[rank[s]];
  }

  const auto device_keys = upload(runtime, keys);
  const auto segment = upload(runtime, shape.segment);
  const auto device_rank = upload(runtime, rank);
  const auto found = guarded<cl_ulong>(runtime, shape.segments());
  host::segmented_select(runtime, device_keys, segment, shape.size(), shape.segments(), device_rank, found);
  std::vector<cl_ulong> selected = download(runtime, found, shape.segments());
  for (std::size_t s = 0; s < shape.segments(); ++s) {
    if (shape.length(s) == 0) selected[s] = 0;  // means nothing
  }
  expect_same(selected, expected, "selected keys");
}

TEST(SmallSegmentedSelect, IsNthElement) {
  Random random(21);
  under_each_tuning([&](Runtime& runtime) {
    const std::vector<Shape> shapes = small_shapes();
    for (const std::size_t k : {1, 4, 6}) {
      check_select(runtime, shapes.at(k), kPatterns[k % 3], k % 2 ? Rank::median : Rank::random, random);
    }
  });
}

TEST(SegmentedSelect, IsNthElement) {
  Random random(22);
  under_each_tuning([&](Runtime& runtime) {
    for (const auto& shapes : {small_shapes(), random_shapes(random)}) {
      for (const Shape& shape : shapes) {
        for (const Rank rank : {Rank::first, Rank::median, Rank::last, Rank::random}) {
          check_select(runtime, shape, kPatterns[random() % 3], rank, random);
        }
      }
    }
  });
}

TEST(SegmentedSelect, IsNthElementForHugeAndTinySegments) {
  Random random(23);
  const std::vector<Shape> shapes = large_shapes(random);
  under_each_tuning([&](Runtime& runtime) {
    // 64 rounds each: one pattern and rank for each shape.
    check_select(runtime, shapes[0], kPatterns[0], Rank::median, random);
    check_select(runtime, shapes[1], kPatterns[2], Rank::random, random);
    check_select(runtime, shapes[3], kPatterns[0], Rank::random, random);
  });
}

TEST(SegmentedSelect, IsNthElementForAllCutsOf7) {
  Random random(24);
  for_all_cuts(7, [&](const Shape& shape) {
    check_select(Runtimes::get("small"), shape, kPatterns[2], Rank::random, random);
  });
}

// ---------------------------------------------------------------------------------------------------------
// All operations

// A change of tuning in a living runtime has to rebuild what depends on it.
TEST(SmallTuning, MayChangeInALivingRuntime) {
  Runtime runtime(host::find_device(""));
  Random random(25);
  for (const char* const tuning : {"small", "gpu", "small"}) {
    SCOPED_TRACE(tuning);
    runtime.set_tuning(tuning_named(tuning));
    check_sort(runtime, random_keys(40, kPatterns[0], random), tuning);
    check_sum(runtime, shape_of(tuning, {3, 0, 30}), random);
  }
}

/// Where the arena's next buffer would be.
std::pair<cl_mem, std::size_t> next_place(Runtime& runtime) {
  const Arena::Scope scope(runtime.arena());
  const auto buffer = runtime.arena().allocate<cl_uchar>(1);
  cl_mem block = nullptr;
  std::size_t offset = 0;
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_ASSOCIATED_MEMOBJECT, sizeof block, &block, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_OFFSET, sizeof offset, &offset, nullptr));
  return {block, offset};
}

TEST(SmallMemory, OperationsReleaseTheirOwn) {
  under_each_tuning([&](Runtime& runtime) {
    const std::size_t n = 33;
    const auto uints = upload(runtime, std::vector<cl_uint>(n + 1, 1));
    const auto keys = upload(runtime, std::vector<cl_ulong>{5, 3, 9, 1});
    const auto ints = upload(runtime, std::vector<cl_int>(n, 0));
    const auto doubles = upload(runtime, std::vector<cl_double>(n, 1.5));
    const auto longs = upload(runtime, std::vector<cl_long>(n, 1));
    const auto sums = upload(runtime, std::vector<cl_long>(n, 1));
    const auto total = upload(runtime, std::vector<cl_long>(1));
    const auto rank = upload(runtime, std::vector<cl_long>(1));
    const auto count = upload(runtime, std::vector<cl_uint>(1));
    const auto flags = upload(runtime, std::vector<cl_uchar>(n, 1));
    const auto offsets = upload(runtime, std::vector<cl_int>{0, static_cast<cl_int>(n)});
    const auto result = upload(runtime, std::vector<cl_int>(n, 0));
    const auto found = upload(runtime, std::vector<cl_ulong>(1));
    const auto before = next_place(runtime);
    host::exclusive_scan(runtime, uints, n, uints);
    EXPECT_EQ(next_place(runtime), before) << "exclusive_scan";
    host::pack_positions(runtime, flags, n, 1, result, count);
    EXPECT_EQ(next_place(runtime), before) << "pack_positions";
    host::sort_by_key(runtime, keys, result, 4);
    EXPECT_EQ(next_place(runtime), before) << "sort_by_key";
    host::segmented_arg_min(runtime, doubles, ints, n, 1, result);
    EXPECT_EQ(next_place(runtime), before) << "segmented_arg_min";
    host::segmented_sum(runtime, longs, ints, n, 1, sums, total);
    EXPECT_EQ(next_place(runtime), before) << "segmented_sum";
    host::segmented_split(runtime, flags, ints, offsets, n, result);
    EXPECT_EQ(next_place(runtime), before) << "segmented_split";
    host::segmented_select(runtime, keys, ints, 4, 1, rank, found);
    EXPECT_EQ(next_place(runtime), before) << "segmented_select";
  });
}

// ---------------------------------------------------------------------------------------------------------
// Copies

TEST(SmallCopies, ReadWriteCopyAndFillPartsOfArrays) {
  Runtime& runtime = Runtimes::get("own");
  const Arena::Scope scope(runtime.arena());
  const auto a = upload(runtime, std::vector<cl_int>{0, 1, 2, 3, 4, 5});
  const cl_int two[] = {20, 30};
  runtime.write(a, 2, 2, two);
  runtime.write(a, 0, 0, two);
  EXPECT_EQ(download(runtime, a, 6), (std::vector<cl_int>{0, 1, 20, 30, 4, 5}));
  EXPECT_EQ(runtime.read_one(a, 3), 30);
  const auto b = upload(runtime, std::vector<cl_int>(6, -1));
  runtime.copy(a, 1, b, 3, 2);
  runtime.copy(a, 0, b, 0, 0);
  EXPECT_EQ(download(runtime, b, 6), (std::vector<cl_int>{-1, -1, -1, 1, 20, -1}));
  runtime.fill(b, 4, cl_int{8});
  runtime.fill(b, 0, cl_int{9});
  EXPECT_EQ(download(runtime, b, 6), (std::vector<cl_int>{8, 8, 8, 8, 20, -1}));
}

// ---------------------------------------------------------------------------------------------------------
// The arena

struct Place {
  cl_mem block;
  std::size_t begin, end;
};

template <typename T>
Place place_of(const Buffer<T>& buffer) {
  Place place{};
  std::size_t size = 0;
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_ASSOCIATED_MEMOBJECT, sizeof place.block,
                                &place.block, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_OFFSET, sizeof place.begin, &place.begin, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_SIZE, sizeof size, &size, nullptr));
  place.end = place.begin + size;
  return place;
}

class SmallArena : public ::testing::Test {
 protected:
  SmallArena() : runtime_(host::find_device("")) {}
  Runtime runtime_;
  // Not the runtime's, which may be told to keep buffers apart.
  Arena arena_{runtime_.context(), runtime_.device()};
};

TEST_F(SmallArena, GivesAlignedBuffersThatDoNotOverlap) {
  const std::size_t base = runtime_.device().get_info<cl_uint>(CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8;
  const std::size_t sizes[] = {1, 0, 127, 128, 129, 1000, 3, 0, 2000000, 5, 4000001, 1};
  std::vector<Place> places;
  for (const std::size_t size : sizes) {
    const auto buffer = arena_.allocate<cl_uchar>(size);
    EXPECT_EQ(buffer.size(), size);
    const Place place = place_of(buffer);
    EXPECT_GE(place.end - place.begin, std::max<std::size_t>(size, 1));
    EXPECT_EQ(place.begin % std::max<std::size_t>(base, 128), 0u);
    for (const Place& other : places) {
      EXPECT_TRUE(place.block != other.block || place.begin >= other.end || other.begin >= place.end);
    }
    places.push_back(place);
  }
}

TEST_F(SmallArena, GivesMemoryThatHoldsItsContents) {
  std::vector<Buffer<cl_uint>> buffers;
  for (cl_uint k = 0; k < 12; ++k) {
    buffers.push_back(arena_.allocate<cl_uint>(10 + k * 10000));
    runtime_.fill(buffers.back(), buffers.back().size(), k);
  }
  for (cl_uint k = 0; k < 12; ++k) {
    std::vector<cl_uint> values(buffers[k].size());
    runtime_.read(buffers[k], 0, values.size(), values.data());
    EXPECT_EQ(values, std::vector<cl_uint>(values.size(), k));
  }
}

TEST_F(SmallArena, ReleasesByScopes) {
  const auto outer = arena_.allocate<cl_int>(10);
  Place first{};
  {
    const Arena::Scope scope(arena_);
    first = place_of(arena_.allocate<cl_int>(100));
    {
      const Arena::Scope inner(arena_);
      EXPECT_GE(place_of(arena_.allocate<cl_int>(7)).begin, first.end);
    }
    // What the inner scope had is free, what the outer one has is not.
    EXPECT_EQ(place_of(arena_.allocate<cl_int>(9)).begin, first.end);
  }
  const Place again = place_of(arena_.allocate<cl_int>(3));
  EXPECT_EQ(again.block, first.block);
  EXPECT_EQ(again.begin, first.begin);
  EXPECT_GE(again.begin, place_of(outer).end);
}

TEST_F(SmallArena, GrowsByBlocksAndKeepsThem) {
  const auto work = [&] {
    const Arena::Scope scope(arena_);
    arena_.allocate<cl_uchar>(1000);
    const Arena::Scope inner(arena_);
    arena_.allocate<cl_uchar>(3000000);
    arena_.allocate<cl_uchar>(9000000);
    arena_.allocate<cl_uchar>(100);
  };
  EXPECT_EQ(arena_.held_bytes(), 0u);
  work();
  const std::size_t blocks = arena_.block_allocations();
  const std::size_t held = arena_.held_bytes();
  EXPECT_GE(blocks, 2u);
  EXPECT_LE(blocks, 4u);
  EXPECT_GE(held, 12000000u);
  for (int k = 0; k < 3; ++k) work();
  EXPECT_EQ(arena_.block_allocations(), blocks);
  EXPECT_EQ(arena_.held_bytes(), held);
}

TEST_F(SmallArena, MakesFewBlocksForManySmallBuffers) {
  for (int k = 0; k < 3000; ++k) arena_.allocate<cl_uchar>(10000);
  EXPECT_GE(arena_.held_bytes(), 30000000u);
  EXPECT_LE(arena_.held_bytes(), 60000000u);  // not much in vain
  EXPECT_LE(arena_.block_allocations(), 25u);
}

TEST_F(SmallArena, ReservesOneBlock) {
  arena_.reserve(20000000);
  EXPECT_GE(arena_.held_bytes(), 20000000u);
  EXPECT_EQ(arena_.block_allocations(), 1u);
  arena_.reserve(10000000);  // is there already
  EXPECT_EQ(arena_.block_allocations(), 1u);
  {
    const Arena::Scope scope(arena_);
    const Place a = place_of(arena_.allocate<cl_uchar>(9000000));
    const Place b = place_of(arena_.allocate<cl_uchar>(9000000));
    EXPECT_EQ(a.block, b.block);
    EXPECT_EQ(arena_.block_allocations(), 1u);
    arena_.reserve(40000000);  // too late: something is allocated
    EXPECT_EQ(arena_.block_allocations(), 1u);
  }
  arena_.reserve(40000000);
  EXPECT_EQ(arena_.block_allocations(), 2u);
  EXPECT_GE(arena_.held_bytes(), 40000000u);
  EXPECT_LT(arena_.held_bytes(), 60000000u);  // instead of the smaller one
}

TEST_F(SmallArena, KnowsItsPeak) {
  arena_.reserve(4000000);
  EXPECT_EQ(arena_.peak_bytes(), 0u);
  {
    const Arena::Scope scope(arena_);
    arena_.allocate<cl_uchar>(1 << 20);
    arena_.allocate<cl_uchar>(1 << 19);
    EXPECT_EQ(arena_.peak_bytes(), 3u << 19);
  }
  const Arena::Scope scope(arena_);
  arena_.allocate<cl_uchar>(1 << 18);
  EXPECT_EQ(arena_.peak_bytes(), 3u << 19);
  arena_.reset_peak();
  EXPECT_EQ(arena_.peak_bytes(), 0u);
  arena_.allocate<cl_uchar>(1 << 17);
  EXPECT_EQ(arena_.peak_bytes(), 3u << 17);  // with what was there before
  arena_.allocate<cl_uchar>(8 << 20);        // in another block
  EXPECT_GE(arena_.peak_bytes(), (3u << 17) + (8u << 20));
  EXPECT_LE(arena_.peak_bytes(), arena_.held_bytes());
}

TEST_F(SmallArena, SaysWhatIsTooLarge) {
  const std::size_t largest = runtime_.device().max_memory_alloc_size();
  const std::size_t wanted = largest / 4096 * 4096 + 4096;
  const std::string message = message_of([&] { arena_.allocate<cl_uchar>(wanted); }, CL_INVALID_BUFFER_SIZE);
  EXPECT_TRUE(contains(message, std::to_string(wanted))) << message;
  EXPECT_TRUE(contains(message, std::to_string(largest))) << message;
  EXPECT_EQ(arena_.block_allocations(), 0u);
  // And goes on.
  const auto buffer = arena_.allocate<cl_int>(1);
  const cl_int value = 5;
  runtime_.write(buffer, 0, 1, &value);
  EXPECT_EQ(runtime_.read_one(buffer, 0), 5);
}

// ---------------------------------------------------------------------------------------------------------
// Errors

TEST(SmallError, NamesCallCodeKernelAndRemedy) {
  EXPECT_EQ(host::error_name(CL_SUCCESS), "CL_SUCCESS");
  EXPECT_EQ(host::error_name(-5), "CL_OUT_OF_RESOURCES");
  EXPECT_EQ(host::error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
  EXPECT_EQ(host::error_name(-1234), "unknown OpenCL error -1234");
  EXPECT_TRUE(contains(host::error_advice(CL_OUT_OF_RESOURCES), "FLAUNAY_DEVICE"));
  EXPECT_EQ(host::error_advice(CL_INVALID_KERNEL_NAME), "");
  EXPECT_NO_THROW(host::check_call(CL_SUCCESS, "clFinish"));
  const std::string message =
      message_of([] { host::check_call(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clThing", "scan_it"); },
                 CL_MEM_OBJECT_ALLOCATION_FAILURE);
  for (const char* const part :
       {"CL_MEM_OBJECT_ALLOCATION_FAILURE", "-4", "clThing", "kernel scan_it", "out of memory"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST(Error, ShowsTheCallsOwnText) {
  const std::string message = message_of([] { FLAUNAY_CL(clFinish(nullptr)); }, CL_INVALID_COMMAND_QUEUE);
  EXPECT_TRUE(contains(message, "CL_INVALID_COMMAND_QUEUE")) << message;
  EXPECT_TRUE(contains(message, "-36")) << message;
  EXPECT_TRUE(contains(message, "clFinish(nullptr)")) << message;
}

class LaunchError : public ::testing::Test {
 protected:
  LaunchError() : runtime_(host::find_device("")), kernel_path_("FLAUNAY_KERNEL_PATH", nullptr) {
    buffer_ = runtime_.arena().allocate<cl_int>(10);
  }
  Runtime runtime_;
  ScopedEnvironment kernel_path_;
  Buffer<cl_int> buffer_;
};

TEST_F(LaunchError, UnknownKernel) {
  const std::string message =
      message_of([&] { runtime_.map("scan", "no_such_kernel", 10, buffer_); }, CL_INVALID_KERNEL_NAME);
  for (const char* const part :
       {"CL_INVALID_KERNEL_NAME", "-46", "clCreateKernel", "scan.cl: no_such_kernel"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, UnknownFile) {
  const std::string message =
      message_of([&] { runtime_.map("no_such_file", "kernel", 10, buffer_); }, CL_SUCCESS);
  EXPECT_TRUE(contains(message, "no_such_file.cl")) << message;
}

TEST_F(LaunchError, TooFewArguments) {
  const std::string message =
      message_of([&] { runtime_.map("split", "permute_int", 10, buffer_, buffer_); }, CL_INVALID_KERNEL_ARGS);
  for (const char* const part :
       {"CL_INVALID_KERNEL_ARGS", "-52", "clEnqueueNDRangeKernel", "kernel permute_int"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, TooManyArguments) {
  const std::string message =
      message_of([&] { runtime_.map("split", "permute_int", 10, buffer_, buffer_, buffer_, cl_int{4}); },
                 CL_INVALID_ARG_INDEX);
  for (const char* const part : {"CL_INVALID_ARG_INDEX", "-49", "clSetKernelArg", "kernel permute_int"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, ArgumentOfAnotherSize) {
  const std::string message =
      message_of([&] { runtime_.map("pack", "pack_count", 10, cl_double{1}, buffer_, cl_int{4}, buffer_); },
                 CL_INVALID_ARG_SIZE);
  for (const char* const part : {"CL_INVALID_ARG_SIZE", "-51", "clSetKernelArg", "kernel pack_count"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, TheRuntimeGoesOn) {
  EXPECT_THROW(runtime_.map("scan", "no_such_kernel", 10, buffer_), DeviceError);
  EXPECT_THROW(runtime_.map("split", "permute_int", 10, buffer_, buffer_), DeviceError);
  Random random(26);
  check_split(runtime_, shape_of("after errors", {7, 0, 9}), 3, random);
}

TEST(KernelPath, ABuildFailureNamesTheFileAndShowsTheLog) {
  const TemporaryFolder folder;
  folder.write("broken.cl",
               "#include \"shared/fine.h\"\n\nkernel void f(global int* a) { a[0] = nonesuch; }\n");
  folder.write("shared/fine.h", "// nothing\n");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  Runtime runtime(host::find_device(""));
  const auto buffer = runtime.arena().allocate<cl_int>(1);
  const std::string message =
      message_of([&] { runtime.map("broken", "f", 1, buffer); }, CL_BUILD_PROGRAM_FAILURE);
  for (const char* const part :
       {"CL_BUILD_PROGRAM_FAILURE", "clBuildProgram", "kernels/broken.cl", "nonesuch"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
  // The line of the file, in spite of what was put in place before it.
  EXPECT_TRUE(contains(message, "broken.cl:3:")) << message;
}

TEST(KernelPath, AMissingFileIsNamed) {
  const TemporaryFolder folder;
  folder.write("lonely.cl", "#include \"shared/missing.h\"\n");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  for (const auto& [file, missing] : std::map<std::string, std::string>{
           {"absent", folder.path() + "/absent.cl"}, {"lonely", folder.path() + "/shared/missing.h"}}) {
    const std::string message = message_of([f = file] { host::kernel_source(f); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, missing)) << message;
    EXPECT_TRUE(contains(message, "FLAUNAY_KERNEL_PATH")) << message;
  }
}

TEST(KernelPath, IncludesArePutInPlaceOnce) {
  const TemporaryFolder folder;
  folder.write("a.cl", "#include \"shared/b.h\"\n#include \"shared/c.h\"\nlast\n");
  folder.write("shared/b.h", "in b\n#include \"shared/c.h\"\n");
  folder.write("shared/c.h", "in c");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  EXPECT_EQ(host::kernel_source("a"),
            "#line 1 \"a.cl\"\n#line 1 \"shared/b.h\"\nin b\n#line 1 \"shared/c.h\"\nin c\n"
            "#line 3 \"shared/b.h\"\n#line 2 \"a.cl\"\n#line 3 \"a.cl\"\nlast\n");
}

TEST(KernelPath, WithoutItTheKernelsAreEmbedded) {
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", nullptr);
  EXPECT_TRUE(contains(host::kernel_source("scan"), "scan_reduce_"));
  EXPECT_TRUE(contains(host::kernel_source("segmented"), "define SEGMENTED_ARG_REDUCE"));
}

// ---------------------------------------------------------------------------------------------------------
// The choice of the device and of its tuning

std::string changed_case(std::string text, int (*change)(int)) {
  for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
  return text;
}

class SmallFindDevice : public ::testing::Test {
 protected:
  SmallFindDevice() : environment_("FLAUNAY_DEVICE", nullptr), devices_(host::all_devices()) {}
  /// For a name that must not be found.
  void expect_listing(const std::string& wanted, const std::string& shown) {
    const std::string message = message_of([&] { host::find_device(wanted); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, shown)) << message;
    for (std::size_t k = 0; k < devices_.size(); ++k) {
      EXPECT_TRUE(contains(message, "#" + std::to_string(k) + " " + devices_[k].name())) << message;
      EXPECT_TRUE(contains(message, devices_[k].platform().name())) << message;
    }
  }
  ScopedEnvironment environment_;
  std::vector<boost::compute::device> devices_;
};

TEST_F(SmallFindDevice, ByNumber) {
  ASSERT_FALSE(devices_.empty());
  for (std::size_t k = 0; k < devices_.size(); ++k) {
    EXPECT_EQ(host::find_device("#" + std::to_string(k)).id(), devices_[k].id());
  }
  for (const char* const wanted : {"#99", "#", "#x", "#0x", "#-1", "#18446744073709551616"}) {
    expect_listing(wanted, wanted);
  }
  expect_listing("#" + std::to_string(devices_.size()), "#" + std::to_string(devices_.size()));
}

TEST_F(SmallFindDevice, ByPartOfANameInAnyCase) {
  const auto& device = devices_.front();
  for (const std::string& name : {device.name(), device.platform().name()}) {
    const std::string part = name.substr(1);
    EXPECT_EQ(host::find_device(name).id(), device.id());
    EXPECT_EQ(host::find_device(changed_case(part, std::toupper)).id(), device.id());
    EXPECT_EQ(host::find_device(changed_case(part, std::tolower)).id(), device.id());
  }
}

TEST_F(SmallFindDevice, AnUnknownNameListsWhatThereIs) { expect_listing("no such device", "no such device"); }

TEST_F(SmallFindDevice, WithoutANameOneWithDoubles) {
  EXPECT_TRUE(host::has_fp64(host::find_device("")));
  const ScopedEnvironment empty("FLAUNAY_DEVICE", "");
  EXPECT_TRUE(host::has_fp64(host::find_device("")));
}

TEST_F(SmallFindDevice, ByTheEnvironment) {
  const std::string last = "#" + std::to_string(devices_.size() - 1);
  const ScopedEnvironment environment("FLAUNAY_DEVICE", last.c_str());
  EXPECT_EQ(host::find_device("").id(), devices_.back().id());
  EXPECT_EQ(host::find_device("#0").id(), devices_.front().id());
  const ScopedEnvironment wrong("FLAUNAY_DEVICE", "Nonesuch 9000");
  expect_listing("", "Nonesuch 9000");
  expect_listing("", "FLAUNAY_DEVICE");
  EXPECT_EQ(host::find_device("#0").id(), devices_.front().id());  // a name given goes first
}

TEST(SmallTuning, IsNamedByTheEnvironment) {
  const auto device = host::find_device("");
  EXPECT_NE(tuning_named("small").map_group, tuning_named("gpu").map_group);
  EXPECT_NE(tuning_named("cpu").chunk_group, tuning_named("gpu").chunk_group);
  {
    const ScopedEnvironment unset("FLAUNAY_TUNING", nullptr);
    const bool cpu = (device.type() & CL_DEVICE_TYPE_CPU) != 0;
    EXPECT_EQ(host::tuning_for(device).map_group, tuning_named(cpu ? "cpu" : "gpu").map_group);
  }
  for (const char* const name : {"fast", "gpu:", "gpu:0", "gpu:1025", "gpu:x", "gpu:-1", "gpu:32 ",
                                 "gpu:032x", "gpu:99999999999999999999", "cpu:32", "GPU"}) {
    const ScopedEnvironment wrong("FLAUNAY_TUNING", name);
    const std::string message = message_of([&] { host::tuning_for(device); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, std::string("'") + name + "'")) << message;
  }
}

TEST(SmallTuning, GroupsOfAGivenSize) {
  const std::size_t most = host::limits_of(host::find_device("")).work_group;
  for (const std::size_t group : {1, 32, 256}) {
    if (group > most) continue;
    const host::Tuning tuning = tuning_named("gpu:" + std::to_string(group));
    EXPECT_EQ(tuning.map_group, group);
    EXPECT_EQ(tuning.chunk_group, group);
    EXPECT_EQ(tuning.sort_group, group);
    EXPECT_EQ(tuning.sort_bits, tuning_named("gpu").sort_bits);
  }
}

TEST(SmallTuning, FitsTheDevice) {
  const std::size_t kilobyte = 1024;
  const host::Tuning gpu = host::fitted(tuning_named("gpu"), {1024, 64 * kilobyte});
  host::Tuning fitted = host::fitted(gpu, {64, 64 * kilobyte});
  EXPECT_EQ(fitted.map_group, 64u);
  EXPECT_EQ(fitted.chunk_group, 64u);
  EXPECT_EQ(fitted.sort_group, 64u);
  fitted = host::fitted(gpu, {1, 64 * kilobyte});
  EXPECT_EQ(fitted.map_group, 1u);
  EXPECT_EQ(fitted.sort_group, 1u);
  // The sort's tables: a counter of 4 bytes for each digit and work-item.
  for (const std::size_t bytes :
       {32 * kilobyte, 4 * kilobyte, 1000 * std::size_t{1}, 64 * std::size_t{1}, 8 * std::size_t{1}}) {
    fitted = host::fitted(gpu, {1024, bytes});
    EXPECT_LE(4 * fitted.sort_group << fitted.sort_bits, bytes);
    EXPECT_GE(fitted.sort_bits, 1);
    EXPECT_GE(fitted.sort_group, 1u);
    EXPECT_EQ(fitted.map_group, gpu.map_group);
  }
}

// Sizes that fit no device: the runtime has to find smaller ones, by kernel.
TEST(Tuning, GroupsThatAKernelDoesNotTakeBecomeSmaller) {
  Runtime runtime(host::find_device(""));
  host::Tuning tuning = tuning_named("gpu");
  tuning.map_group = tuning.chunk_group = std::size_t{1} << 20;
  tuning.sort_group = std::size_t{1} << 15;
  runtime.set_tuning(tuning);
  EXPECT_GT(runtime.largest_group("split", "split_flags"), 0u);
  EXPECT_LT(runtime.largest_group("split", "split_flags"), tuning.map_group);
  Random random(26);
  check_sort(runtime, random_keys(5000, kPatterns[0], random), "groups too large");
  check_sum(runtime, shape_of("groups too large", {3, 0, 3000}), random);
  EXPECT_LT(runtime.tuning().sort_group, tuning.sort_group);
  EXPECT_LE(runtime.tuning().sort_group, runtime.largest_group("sort", "sort_scatter"));
}

TEST(Tuning, AGroupThatAKernelCannotHaveIsAnErrorWithItsName) {
  Runtime runtime(host::find_device(""));
  host::Tuning tuning = tuning_named("gpu");
  // Tables that are larger than any device's local memory, even for groups of one.
  tuning.sort_bits = 26;
  tuning.sort_group = 2;
  runtime.set_tuning(tuning);
  const auto keys = upload(runtime, std::vector<cl_ulong>{3, 1, 2});
  const auto payloads = upload(runtime, std::vector<cl_int>{0, 1, 2});
  const std::string message = message_of([&] { host::sort_by_key(runtime, keys, payloads, 3); }, CL_SUCCESS);
  EXPECT_TRUE(contains(message, "kernel sort_count")) << message;
}

TEST(SmallTuning, ChunksAreNeitherTooSmallNorTooMany) {
  host::Tuning tuning = tuning_named("small");
  tuning.chunk_least = 10;
  tuning.chunks_most = 0;
  for (const std::size_t n : {0, 1, 10, 11, 1000}) EXPECT_EQ(tuning.chunk(n), 10u);
  tuning.chunks_most = 4;
  for (std::size_t n = 0; n < 200; ++n) {
    EXPECT_GE(tuning.chunk(n), 10u);
    EXPECT_LE((n + tuning.chunk(n) - 1) / tuning.chunk(n), 4u);
    if (n <= 40) {
      EXPECT_EQ(tuning.chunk(n), 10u);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------
// The accounts

TEST(SmallAccounts, CountLaunchesAndWaits) {
  Runtime runtime(host::find_device(""));
  const auto a = upload(runtime, std::vector<cl_uchar>(10));
  const auto b = upload(runtime, std::vector<cl_uint2>(10));
  runtime.reset_accounts();
  EXPECT_EQ(runtime.launches(), 0u);
  EXPECT_EQ(runtime.waits(), 0u);
  EXPECT_EQ(runtime.build_seconds(), 0.0);
  for (int k = 0; k < 3; ++k) runtime.map("split", "split_flags", 10, a, b);
  runtime.map("split", "split_flags", 0, a, b);  // nothing to launch
  EXPECT_EQ(runtime.launches(), 3u);
  EXPECT_EQ(runtime.waits(), 0u);
  EXPECT_GT(runtime.build_seconds(), 0.0);
  runtime.finish();
  runtime.read_one(b, 1);
  EXPECT_EQ(runtime.waits(), 2u);
  EXPECT_TRUE(runtime.kernel_times().empty());  // profiling is off
  runtime.reset_accounts();
  runtime.map("split", "split_flags", 10, a, b);
  EXPECT_EQ(runtime.launches(), 1u);
  EXPECT_EQ(runtime.build_seconds(), 0.0);  // built already
}

TEST(Accounts, ProfilingCountsEachKernel) {
  Runtime runtime(host::find_device(""));
  const auto places = upload(runtime, std::vector<cl_int>(10, -1));
  const auto a = upload(runtime, std::vector<cl_uchar>(10));
  const auto b = upload(runtime, std::vector<cl_uint2>(10));
  runtime.set_profiling(true);
  // More than the events that are gathered at a time.
  for (int k = 0; k < 4100; ++k) runtime.map("split", "permute_int", 10, places, places, places);
  for (int k = 0; k < 2; ++k) runtime.map("split", "split_flags", 10, a, b);
  auto times = runtime.kernel_times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times["permute_int"].launches, 4100u);
  EXPECT_EQ(times["split_flags"].launches, 2u);
  EXPECT_GE(times["permute_int"].seconds, 0.0);
  runtime.map("split", "split_flags", 10, a, b);
  EXPECT_EQ(runtime.kernel_times()["split_flags"].launches, 3u);  // since the last reset

  runtime.set_profiling(false);
  runtime.map("split", "split_flags", 10, a, b);
  EXPECT_EQ(runtime.kernel_times()["split_flags"].launches, 3u);
  runtime.reset_accounts();
  EXPECT_TRUE(runtime.kernel_times().empty());
}

TEST(Accounts, ProfilingMeasuresTheTimeOfTheDevice) {
  Runtime runtime(host::find_device(""));
  const std::size_t n = 1000000;
  const auto a = upload(runtime, std::vector<cl_uchar>(n));
  const auto b = guarded<cl_uint2>(runtime, n);
  runtime.map("split", "split_flags", n, a, b);  // compiled on first use
  runtime.set_profiling(true);
  runtime.reset_accounts();
  for (int k = 0; k < 10; ++k) runtime.map("split", "split_flags", n, a, b);
  const double seconds = runtime.kernel_times()["split_flags"].seconds;
  EXPECT_GT(seconds, 1e-6);
  EXPECT_LT(seconds, 10.0);
}

}  // namespace
}  // namespace flaunay
