#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Coordinates below 2^250 that are multiples of 2^-255: no product of four overflows, and none underflows.
// See docs/exactness.md.
constexpr int kLargestExponent = 249;
constexpr int kLowestExponent = -255;
// Coordinates of so many bits make the filters exact: 3k + 4, 2k + 3 and 4k + 8 bits within 53.
constexpr int kCoarseHullBits = 16;
constexpr int kCoarseOrientBits = 25;
constexpr int kCoarseCircleBits = 11;

// As in the kernels' headers.
constexpr double kRoundoff = 0x1p-53;
constexpr double kHullBound = 10.0 * kRoundoff;
constexpr double kOrientBound = (3.0 + 16.0 * kRoundoff) * kRoundoff;
constexpr double kCircleBound = (10.0 + 96.0 * kRoundoff) * kRoundoff;

struct Accounts {
  cl_int largest = -10000;
  cl_int lowest = 10000;
  cl_int bad = std::numeric_limits<cl_int>::max();
};

// Exponent of the lowest set bit.
int lowest_bit(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::fabs(fraction), 53));
  int low = exponent - 53;
  while ((mantissa & 1) == 0) {
    mantissa >>= 1;
    ++low;
  }
  return low;
}

[[noreturn]] void throw_range(const double* coordinates, std::size_t n, const Accounts& accounts) {
  std::size_t largest = 0, finest = 0;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double x = coordinates[i];
    if (x == 0) continue;
    if (std::ilogb(x) == accounts.largest) largest = i;
    if (lowest_bit(x) == accounts.lowest) finest = i;
  }
  throw Error(
      ErrorKind::input,
      fmt::format(
          "the coordinates' magnitudes differ too much to be exact: point {} has {} = {:.17g} and point "
          "{} has {} = {:.17g}, whose bits span {} binary places; {} are supported",
          largest / 2, largest % 2 ? "y" : "x", coordinates[largest], finest / 2, finest % 2 ? "y" : "x",
          coordinates[finest], accounts.largest - accounts.lowest + 1,
          kLargestExponent - kLowestExponent + 1));
}

}  // namespace

PointTable ingest(Workspace& work, const double* coordinates, const std::vector<std::size_t>& offsets,
                  std::int32_t* representatives) {
  host::Runtime& runtime = work.runtime;
  const std::size_t n = offsets.back();
  const std::size_t sets = offsets.size() - 1;
  PointTable table;
  table.input_count = n;
  table.sets = sets;
  Arena::Scope scope(work.scratch());
  Arena& scratch = work.scratch();

  const auto input = scratch.allocate<cl_double2>(n);
  runtime.write(input, 0, n, reinterpret_cast<const cl_double2*>(coordinates));
  std::vector<cl_int> input_offsets(offsets.begin(), offsets.end());
  const auto device_offsets = scratch.allocate<cl_int>(sets + 1);
  runtime.write(device_offsets, 0, sets + 1, input_offsets.data());

  Accounts accounts;
  const auto device_accounts = scratch.allocate<cl_int>(3);
  runtime.write(device_accounts, 0, 3, &accounts.largest);
  runtime.chunks("ingest", "inspect", n, runtime.tuning().chunk(n), input, device_accounts);
  runtime.read(device_accounts, 0, 3, &accounts.largest);
  if (accounts.bad < static_cast<cl_int>(n)) {
    const double x = coordinates[2 * accounts.bad];
    const double y = coordinates[2 * accounts.bad + 1];
    throw Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", accounts.bad, x, y));
  }
  int shift = 0;
  int bits = 0;
  if (accounts.lowest <= accounts.largest) {
    bits = accounts.largest - accounts.lowest + 1;
    if (accounts.largest > kLargestExponent) shift = kLargestExponent - accounts.largest;
    if (accounts.lowest < kLowestExponent) shift = kLowestExponent - accounts.lowest;
    if (bits > kLargestExponent - kLowestExponent + 1) throw_range(coordinates, n, accounts);
  }
  work.bounds.hull = bits <= kCoarseHullBits ? 0 : kHullBound;
  work.bounds.orient = bits <= kCoarseOrientBits ? 0 : kOrientBound;
  work.bounds.circle = bits <= kCoarseCircleBits ? 0 : kCircleBound;
  const cl_double s0 = std::ldexp(1.0, shift / 3);
  const cl_double s1 = std::ldexp(1.0, (shift - shift / 3) / 2);
  const cl_double s2 = std::ldexp(1.0, shift - shift / 3 - (shift - shift / 3) / 2);

  // Sort by y, with dense ranks; then stably by x, and by set.
  const auto keys = scratch.allocate<cl_ulong>(n);
  const auto order = scratch.allocate<cl_int>(n);
  const auto counts = scratch.allocate<cl_uint>(n + 1);
  const auto y_rank = scratch.allocate<cl_uint>(n);
  runtime.map("ingest", "keys_y", n, input, s0, s1, s2, keys, order);
  host::sort_by_key(runtime, keys, order, n);
  runtime.map("ingest", "change_flags", n, keys, counts);
  host::exclusive_scan(runtime, counts, n, counts);
  runtime.map("ingest", "write_ranks", n, order, counts, y_rank);
  runtime.map("ingest", "keys_x", n, input, s0, s1, s2, order, keys);
  host::sort_by_key(runtime, keys, order, n);
  const auto set_count = static_cast<cl_int>(sets);
  if (sets > 1) {
    runtime.map("ingest", "keys_set", n, set_count, device_offsets, order, keys);
    host::sort_by_key(runtime, keys, order, n);
  }

  runtime.map("ingest", "distinct_flags", n, set_count, device_offsets, input, order, counts);
  host::exclusive_scan(runtime, counts, n, counts);
  table.count = n == 0 ? 0 : runtime.read_one(counts, n);
  table.points = work.persistent.allocate<cl_double2>(table.count);
  table.source = work.persistent.allocate<cl_int>(table.count);
  table.side = work.persistent.allocate<cl_uchar>(table.count);
  table.set_of_id = work.persistent.allocate<cl_int>(table.count);
  table.set_offsets = work.persistent.allocate<cl_int>(sets + 1);
  table.y_order = work.persistent.allocate<cl_int>(table.count);
  runtime.map("ingest", "distinct_write", n, input, s0, s1, s2, order, counts, y_rank, table.points,
              table.source, keys);
  runtime.map("ingest", "set_offsets", sets + 1, device_offsets, counts, table.set_offsets);
  const Buffer<cl_int> representative = scratch.allocate<cl_int>(n);
  runtime.map("ingest", "representatives", n, order, counts, table.source, representative);
  runtime.read(representative, 0, n, representatives);

  runtime.map("ingest", "keys_y_order", table.count, set_count, table.set_offsets, keys, table.y_order);
  host::sort_by_key(runtime, keys, table.y_order, table.count);
  runtime.map("border", "sets_of_ids", table.count, set_count, table.set_offsets, table.set_of_id);
  runtime.fill(table.side, table.count, cl_uchar{0});
  return table;
}

}  // namespace flaunay::flattened
