#include "host/vector_operations.hpp"

#include <fmt/format.h>

namespace flaunay::host {
namespace {

template <typename T>
struct ScanKernels;
template <>
struct ScanKernels<cl_uint> {
  static constexpr const char* reduce = "scan_reduce_uint";
  static constexpr const char* write = "scan_write_uint";
};
template <>
struct ScanKernels<cl_uint2> {
  static constexpr const char* reduce = "scan_reduce_uint2";
  static constexpr const char* write = "scan_write_uint2";
};
template <>
struct ScanKernels<cl_uint8> {
  static constexpr const char* reduce = "scan_reduce_uint8";
  static constexpr const char* write = "scan_write_uint8";
};

}  // namespace

template <typename T>
void exclusive_scan(Runtime& runtime, const Buffer<T>& input, std::size_t n, const Buffer<T>& output) {
  if (n == 0) {
    runtime.fill(output, 1, T{});
    return;
  }
  const std::size_t chunk = runtime.tuning().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  if (chunk_count == 1) {
    runtime.chunks("scan", ScanKernels<T>::write, n, chunk, cl_int{0}, output, input, output);
    return;
  }
  Arena::Scope scope(runtime.arena());
  const auto sums = runtime.arena().allocate<T>(chunk_count + 1);
  runtime.chunks("scan", ScanKernels<T>::reduce, n, chunk, input, sums);
  exclusive_scan(runtime, sums, chunk_count, sums);
  runtime.chunks("scan", ScanKernels<T>::write, n, chunk, cl_int{1}, sums, input, output);
}
template void exclusive_scan(Runtime&, const Buffer<cl_uint>&, std::size_t, const Buffer<cl_uint>&);
template void exclusive_scan(Runtime&, const Buffer<cl_uint2>&, std::size_t, const Buffer<cl_uint2>&);
template void exclusive_scan(Runtime&, const Buffer<cl_uint8>&, std::size_t, const Buffer<cl_uint8>&);

void pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags, std::size_t n, int wanted,
                    const Buffer<cl_int>& positions, const Buffer<cl_uint>& count) {
  if (n == 0) {
    runtime.fill(count, 1, cl_uint{0});
    return;
  }
  Arena::Scope scope(runtime.arena());
  const std::size_t chunk = runtime.tuning().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  const auto counts = runtime.arena().allocate<cl_uint>(chunk_count + 1);
  runtime.chunks("pack", "pack_count", n, chunk, flags, cl_int{wanted}, counts);
  exclusive_scan(runtime, counts, chunk_count, counts);
  runtime.chunks("pack", "pack_write", n, chunk, flags, cl_int{wanted}, counts, positions);
  runtime.copy(counts, chunk_count, count, 0, 1);
}

std::pair<Buffer<cl_int>, std::size_t> pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags,
                                                      std::size_t n, int wanted) {
  if (n == 0) return {runtime.arena().allocate<cl_int>(0), 0};
  Arena& arena = runtime.arena();
  const std::size_t chunk = runtime.tuning().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  const auto counts = arena.allocate<cl_uint>(chunk_count + 1);
  runtime.chunks("pack", "pack_count", n, chunk, flags, cl_int{wanted}, counts);
  exclusive_scan(runtime, counts, chunk_count, counts);
  const std::size_t total = runtime.read_one(counts, chunk_count);
  const auto positions = arena.allocate<cl_int>(total);
  if (total > 0) runtime.chunks("pack", "pack_write", n, chunk, flags, cl_int{wanted}, counts, positions);
  return {positions, total};
}

namespace {

/// Makes the sort's groups so small that the device takes them: its kernels are built for one size.
void fit_sort_group(Runtime& runtime) {
  for (const char* const kernel : {"sort_count", "sort_scatter"}) {
    for (;;) {
      const std::size_t largest = runtime.largest_group("sort", kernel);
      Tuning tuning = runtime.tuning();
      if (tuning.sort_group <= largest) break;
      if (tuning.sort_group == 1) {
        throw DeviceError(
            fmt::format("the device has not the local memory for any work-group of kernel {}; use another "
                        "(FLAUNAY_DEVICE)",
                        kernel));
      }
      tuning.sort_group /= 2;
      runtime.set_tuning(tuning);
    }
  }
}

}  // namespace

void sort_by_key(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& payloads,
                 std::size_t n) {
  if (n < 2) return;
  fit_sort_group(runtime);
  Arena::Scope scope(runtime.arena());
  const Tuning& tuning = runtime.tuning();
  const auto varying = runtime.arena().allocate<cl_uint>(2);
  runtime.fill(varying, 2, cl_uint{0});
  runtime.chunks("sort", "sort_varying", n, tuning.chunk(n), keys, varying);
  cl_uint bits[2];
  runtime.read(varying, 0, 2, bits);
  const cl_ulong differing = bits[0] | static_cast<cl_ulong>(bits[1]) << 32;

  const std::size_t items = tuning.sort_items != 0 ? tuning.sort_items : tuning.chunk(n);
  const std::size_t work_items = (n + items - 1) / items;
  const std::size_t groups = (work_items + tuning.sort_group - 1) / tuning.sort_group;
  const std::size_t entries = groups << tuning.sort_bits;
  const auto table = runtime.arena().allocate<cl_uint>(entries + 1);
  Buffer<cl_ulong> from_keys = keys;
  Buffer<cl_int> from_payloads = payloads;
  auto to_keys = runtime.arena().allocate<cl_ulong>(n);
  auto to_payloads = runtime.arena().allocate<cl_int>(n);
  bool in_place = true;
  const cl_ulong digit_mask = (cl_ulong{1} << tuning.sort_bits) - 1;
  for (int shift = 0; shift < 64; shift += tuning.sort_bits) {
    if (((differing >> shift) & digit_mask) == 0) continue;
    const cl_int n_argument = static_cast<cl_int>(n);
    const cl_int items_argument = static_cast<cl_int>(items);
    runtime.launch("sort", "sort_count", work_items, tuning.sort_group, n_argument, items_argument,
                   cl_int{shift}, from_keys, table);
    exclusive_scan(runtime, table, entries, table);
    runtime.launch("sort", "sort_scatter", work_items, tuning.sort_group, n_argument, items_argument,
                   cl_int{shift}, from_keys, from_payloads, table, to_keys, to_payloads);
    std::swap(from_keys, to_keys);
    std::swap(from_payloads, to_payloads);
    in_place = !in_place;
  }
  if (!in_place) {
    runtime.copy(from_keys, 0, keys, 0, n);
    runtime.copy(from_payloads, 0, payloads, 0, n);
  }
}

void segmented_arg_min(Runtime& runtime, const Buffer<cl_double>& values, const Buffer<cl_int>& segment,
                       std::size_t n, std::size_t segments, const Buffer<cl_int>& result) {
  runtime.fill(result, segments, cl_int{-1});
  segmented_arg_reduce(runtime, "segmented", "segmented_arg_min", segment, n, result, values);
}

void segmented_arg_max(Runtime& runtime, const Buffer<cl_double>& values, const Buffer<cl_int>& segment,
                       std::size_t n, std::size_t segments, const Buffer<cl_int>& result) {
  runtime.fill(result, segments, cl_int{-1});
  segmented_arg_reduce(runtime, "segmented", "segmented_arg_max", segment, n, result, values);
}

void segmented_sum(Runtime& runtime, const Buffer<cl_long>& values, const Buffer<cl_int>& segment,
                   std::size_t n, std::size_t segments, const Buffer<cl_long>& scanned,
                   const Buffer<cl_long>& total) {
  runtime.fill(total, segments, cl_long{0});
  if (n == 0) return;
  Arena::Scope scope(runtime.arena());
  const std::size_t chunk = runtime.tuning().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  const auto sums = runtime.arena().allocate<cl_long>(chunk_count);
  const auto begins = runtime.arena().allocate<cl_int>(chunk_count);
  const auto carry = runtime.arena().allocate<cl_long>(chunk_count);
  runtime.chunks("segmented", "segmented_sum_reduce", n, chunk, segment, values, sums, begins);
  runtime.launch("segmented", "segmented_sum_carry", 1, 1, static_cast<cl_int>(chunk_count), sums, begins,
                 carry);
  runtime.chunks("segmented", "segmented_sum_write", n, chunk, segment, values, carry, scanned, total);
}

void segmented_split(Runtime& runtime, const Buffer<cl_uchar>& side, const Buffer<cl_int>& segment,
                     const Buffer<cl_int>& offsets, std::size_t n, const Buffer<cl_int>& places) {
  if (n == 0) return;
  Arena::Scope scope(runtime.arena());
  const auto counts = runtime.arena().allocate<cl_uint2>(n + 1);
  runtime.map("split", "split_flags", n, side, counts);
  exclusive_scan(runtime, counts, n, counts);
  runtime.map("split", "split_places", n, side, segment, offsets, counts, places);
}

void permute(Runtime& runtime, const Buffer<cl_int>& places, const Buffer<cl_int>& values, std::size_t n,
             const Buffer<cl_int>& moved) {
  runtime.map("split", "permute_int", n, places, values, moved);
}

void segmented_select(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& segment,
                      std::size_t n, std::size_t segments, const Buffer<cl_long>& rank,
                      const Buffer<cl_ulong>& found) {
  runtime.fill(found, segments, cl_ulong{0});
  Arena::Scope scope(runtime.arena());
  const auto flags = runtime.arena().allocate<cl_long>(n);
  const auto zeros = runtime.arena().allocate<cl_long>(segments);
  for (int bit = 63; bit >= 0 && n > 0; --bit) {
    runtime.map("select", "select_flags", n, cl_int{bit}, segment, keys, found, flags);
    segmented_sum(runtime, flags, segment, n, segments, flags, zeros);
    runtime.map("select", "select_step", segments, cl_int{bit}, zeros, rank, found);
  }
}

}  // namespace flaunay::host
