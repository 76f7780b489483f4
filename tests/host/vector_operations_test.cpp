// The vector operations against plain loops, under every kind of tuning.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "host/launch/vector_operations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "host/error.hpp"
#include "launchers/operations/pack.cl.hpp"
#include "launchers/operations/pack_tiles.cl.hpp"
#include "launchers/operations/scan_tiles.cl.hpp"
#include "launchers/operations/sort.cl.hpp"
#include "launchers/segmented.cl.hpp"
#include "tests/host/support.hpp"
#include "tests/support/test_kernels.hpp"

namespace flaunay::host {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
  exclusive_scan(runtime, input, n, output);
  expect_same(download(runtime, output, n + 1), expected, "scan");
  expect_same(download(runtime, input, n), values, "the scan's input");

  const auto in_place = guarded<T>(runtime, n + 1);
  runtime.write(in_place, 0, n, values.data());
  exclusive_scan(runtime, in_place, n, in_place);
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

/// Runs the check with the tuning of GPUs, but with work-groups of this size and tiles and spans so small
/// that little input has many.
template <typename Check>
void with_small_spans(std::size_t group, const Check& check) {
  SCOPED_TRACE("groups of " + std::to_string(group));
  Runtime runtime(find_device(""), settings_for(find_device("")));
  Tuning tuning = tuning_named("gpu");
  tuning.tile_group = std::min(group, limits_of(find_device("")).work_group);
  for (const auto& [items, alone, groups] : {std::array<std::size_t, 3>{1, 1, 3}, {3, 2, 5}, {8, 4, 1}}) {
    tuning.scan_items = items;
    tuning.scan_tiles_alone = alone;
    tuning.scan_groups = groups;
    runtime.set_sizes(std::make_shared<Tuning>(tuning));
    check(runtime);
  }
}

TYPED_TEST(SmallScan, BySpansIsThePlainLoop) {
  Random random(12);
  for (const std::size_t group : {1, 3}) {
    with_small_spans(group, [&](Runtime& runtime) {
      for (const std::size_t n : {1, 2, 3, 9, 10, 17, 18, 19, 40}) check_scan<TypeParam>(runtime, n, random);
    });
  }
}

TYPED_TEST(Scan, BySpansIsThePlainLoop) {
  Random random(13);
  for (const std::size_t group : {1, 32, 64, 256}) {
    with_small_spans(group, [&](Runtime& runtime) {
      for (const std::size_t n : {group - 1, group, group + 1, 3 * group, 8 * group, 24 * group + 1}) {
        check_scan<TypeParam>(runtime, n, random);
      }
      for (int k = 0; k < 5; ++k) check_scan<TypeParam>(runtime, random() % 20000, random);
    });
  }
}

/// There are such groups if the device runs a kernel in smaller groups than it was told.
TEST(SmallSpans, GroupsBehindTheLastSpanDoNothing) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  const Arena::Scope scope(runtime.arena());
  const std::vector<cl_uint> values{5, 1, 0, 7, 2, 3, 9};
  const std::size_t n = values.size(), span = 4, spans = 2, groups = 5, group = 3;
  const auto input = upload(runtime, values);
  const auto sums = guarded<cl_uint>(runtime, spans);
  const auto output = guarded<cl_uint>(runtime, n + 1);
  runtime.launch(groups * group, group, n,
                 kernels::scan_span_sums_uint{.spans = spans, .span = span, .input = input, .sums = sums});
  expect_same(download(runtime, sums, spans), {13, 14}, "sums");
  runtime.launch(
      groups * group, group, n,
      kernels::scan_spans_uint{
          .spans = spans, .span = span, .items = 1, .sums = sums, .input = input, .output = output});
  expect_same(download(runtime, output, n + 1), plain_scan(values), "scan");

  const auto flags = upload(runtime, std::vector<cl_uchar>{1, 1, 0, 1, 0, 1, 0});
  runtime.launch(
      groups * group, group, n,
      kernels::pack_span_counts{.spans = spans, .span = span, .flags = flags, .wanted = 1, .counts = sums});
  expect_same(download(runtime, sums, spans), {3, 1}, "counts");
  const auto positions = guarded<cl_int>(runtime, 4);
  const auto total = guarded<cl_uint>(runtime, 1);
  runtime.launch(groups * group, group, n,
                 kernels::pack_spans{.spans = spans,
                                     .span = span,
                                     .items = 1,
                                     .flags = flags,
                                     .wanted = 1,
                                     .counts = sums,
                                     .positions = positions,
                                     .total = total});
  expect_same(download(runtime, positions, 4), {0, 1, 3, 5}, "positions");
  expect_same(download(runtime, total, 1), {4}, "number of positions");
}

TEST(ScanLaunches, BySpansTakesTwo) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  runtime.set_sizes(std::make_shared<Tuning>(tuning_named("gpu")));
  const std::size_t group = runtime.sizes().tile_group;
  ASSERT_NE(group, 0u);
  const std::size_t alone = group * runtime.sizes().scan_items * runtime.sizes().scan_tiles_alone;
  for (const std::size_t n : {std::size_t{1}, alone, alone + 1, std::size_t{5000000}}) {
    const Arena::Scope scope(runtime.arena());
    const auto values = runtime.arena().allocate<cl_uint>(n + 1);
    runtime.fill(values, n, cl_uint{1});
    const std::size_t before = runtime.accounts().launches;
    exclusive_scan(runtime, values, n, values);
    EXPECT_EQ(runtime.accounts().launches - before, n <= alone ? 1u : 2u) << n;
    EXPECT_EQ(runtime.read_one(values, n), n);
  }
}

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
  pack_positions(runtime, input, flags.size(), wanted, positions, count);
  EXPECT_EQ(download(runtime, count, 1)[0], expected.size());
  expect_same(download(runtime, positions, expected.size()), expected, "positions");

  const auto [packed, size] = pack_positions(runtime, input, flags.size(), wanted);
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

TEST(SmallPack, BySpansIsThePlainLoop) {
  Random random(14);
  for (const std::size_t group : {1, 3}) {
    with_small_spans(group, [&](Runtime& runtime) {
      for (const std::size_t n : {1, 2, 3, 9, 10, 18, 19, 40}) {
        check_pack(runtime, random_flags(n, 3, random), 1);
      }
    });
  }
}

TEST(Pack, BySpansIsThePlainLoop) {
  Random random(15);
  for (const std::size_t group : {1, 32, 64, 256}) {
    with_small_spans(group, [&](Runtime& runtime) {
      for (const std::size_t n : {group, 3 * group, 8 * group, 24 * group + 1, random() % 20000}) {
        const std::vector<cl_uchar> flags = random_flags(n + 1, 3, random);
        for (const int wanted : {0, 2, 3}) check_pack(runtime, flags, wanted);
      }
    });
  }
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

/// The payloads tell equal keys apart, so an unstable sort shows.
void check_sort(Runtime& runtime, const std::vector<cl_ulong>& keys, const std::string& what) {
  SCOPED_TRACE(what + ", n = " + std::to_string(keys.size()));
  const Arena::Scope scope(runtime.arena());
  std::vector<cl_int> order(keys.size());
  std::iota(order.begin(), order.end(), 0);
  const auto device_keys = upload(runtime, keys);
  const auto payloads = upload(runtime, order);
  sort_by_key(runtime, device_keys, payloads, keys.size());

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
  const auto check = [&](Runtime& runtime) {
    check_sort(runtime, random_keys(40, kPatterns[0], random), kPatterns[0].name);
    // Few digits vary: few passes.
    for (const std::size_t n : {0, 1, 2, 3, 12, 13, 40}) {
      check_sort(runtime, random_keys(n, kPatterns[2], random), kPatterns[2].name);
    }
  };
  under_each_tuning(check);
  Runtime native(native_tuning());
  check(native);
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
    const int bits = runtime.sizes().sort_bits;
    const auto passes = [&](cl_ulong a, cl_ulong b) {
      const Arena::Scope scope(runtime.arena());
      const auto keys = upload(runtime, std::vector<cl_ulong>{b, a, b});
      const auto payloads = upload(runtime, std::vector<cl_int>{0, 1, 2});
      runtime.reset_accounts();
      sort_by_key(runtime, keys, payloads, 3);
      EXPECT_EQ(runtime.accounts().waits, 1u);  // documented: once, to find the digits
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
  for (const auto& result : {least, greatest}) runtime.fill(result, shape.segments(), cl_int{-1});
  segmented_arg_reduce(
      runtime, shape.size(),
      kernels::segmented_arg_min{.segment = segment, .result = least, .values = device_values});
  segmented_arg_reduce(
      runtime, shape.size(),
      kernels::segmented_arg_max{.segment = segment, .result = greatest, .values = device_values});
  expect_same(download(runtime, least, shape.segments()),
              plain_arg_best(shape, [&](std::size_t i, std::size_t j) { return values[i] < values[j]; }),
              "arg-min");
  expect_same(download(runtime, greatest, shape.segments()),
              plain_arg_best(shape, [&](std::size_t i, std::size_t j) { return values[i] > values[j]; }),
              "arg-max");
}

TEST(SmallSegmentedArg, IsThePlainLoop) {
  const testing::TestKernels kernels;
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
  const testing::TestKernels kernels;
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
  const testing::TestKernels kernels;
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
  const testing::TestKernels kernels;
  Random random(11);
  for_all_cuts(11, [&](const Shape& shape) {
    check_arg(Runtimes::get("small"), shape, random_doubles(shape.size(), Values::tied, random));
  });
}

// The skeleton with elements that are no candidates, as quickhull uses it: whole chunks may have none.
TEST(SegmentedArg, PassesOverElementsThatAreNoCandidates) {
  const testing::TestKernels kernels;
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
      segmented_arg_reduce(
          runtime, shape.size(),
          kernels::least_positive{.segment = segment, .result = result, .values = device_values});
      expect_same(download(runtime, result, shape.segments()), expected, "least positive");
    }
  });
}

// A change of tuning in a living runtime has to rebuild what depends on it.
TEST(SmallTuning, MayChangeInALivingRuntime) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  Random random(25);
  for (const char* const tuning : {"small", "gpu", "small"}) {
    SCOPED_TRACE(tuning);
    runtime.set_sizes(std::make_shared<Tuning>(tuning_named(tuning)));
    check_sort(runtime, random_keys(40, kPatterns[0], random), tuning);
    check_scan<cl_uint>(runtime, 33, random);
  }
}

// Sizes that fit no device: the runtime has to find smaller ones, by kernel.
TEST(Tuning, GroupsThatAKernelDoesNotTakeBecomeSmaller) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  Tuning tuning = tuning_named("gpu");
  tuning.map_group = tuning.chunk_group = std::size_t{1} << 20;
  // As many as the local memory has tables for: some compilers refuse larger ones.
  tuning.sort_bits = 1;
  tuning.sort_group = 1;
  const std::size_t table = sizeof(cl_uint) << tuning.sort_bits;
  while (2 * tuning.sort_group * table <= host::limits_of(runtime.device()).local_memory)
    tuning.sort_group *= 2;
  runtime.set_sizes(std::make_shared<Tuning>(tuning));
  EXPECT_GT(runtime.largest_group(kernels::pack_count::kernel_name), 0u);
  EXPECT_LT(runtime.largest_group(kernels::pack_count::kernel_name), tuning.map_group);
  Random random(26);
  check_sort(runtime, random_keys(5000, kPatterns[0], random), "groups too large");
  check_scan<cl_uint>(runtime, 3003, random);
  EXPECT_LT(runtime.sizes().sort_group, tuning.sort_group);
  EXPECT_LE(runtime.sizes().sort_group, runtime.largest_group(kernels::sort_scatter::kernel_name));
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
  const testing::TestKernels kernels;
  under_each_tuning([&](Runtime& runtime) {
    const std::size_t n = 33;
    const auto uints = upload(runtime, std::vector<cl_uint>(n + 1, 1));
    const auto keys = upload(runtime, std::vector<cl_ulong>{5, 3, 9, 1});
    const auto ints = upload(runtime, std::vector<cl_int>(n, 0));
    const auto doubles = upload(runtime, std::vector<cl_double>(n, 1.5));
    const auto count = upload(runtime, std::vector<cl_uint>(1));
    const auto flags = upload(runtime, std::vector<cl_uchar>(n, 1));
    const auto result = upload(runtime, std::vector<cl_int>(n, 0));
    const auto before = next_place(runtime);
    exclusive_scan(runtime, uints, n, uints);
    EXPECT_EQ(next_place(runtime), before) << "exclusive_scan";
    pack_positions(runtime, flags, n, 1, result, count);
    EXPECT_EQ(next_place(runtime), before) << "pack_positions";
    sort_by_key(runtime, keys, result, 4);
    EXPECT_EQ(next_place(runtime), before) << "sort_by_key";
    segmented_arg_reduce(runtime, n,
                         kernels::segmented_arg_min{.segment = ints, .result = result, .values = doubles});
    EXPECT_EQ(next_place(runtime), before) << "segmented_arg_reduce";
  });
}

}  // namespace
}  // namespace flaunay::host
