#include "host/launch/vector_operations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "launchers/operations/pack.cl.hpp"
#include "launchers/operations/pack_tiles.cl.hpp"
#include "launchers/operations/scan.cl.hpp"
#include "launchers/operations/scan_tiles.cl.hpp"
#include "launchers/operations/sort.cl.hpp"

namespace flaunay::host {
namespace {

template <typename T>
struct ScanKernels;
template <>
struct ScanKernels<cl_uint> {
  using Reduce = kernels::scan_reduce_uint;
  using Write = kernels::scan_write_uint;
  using SpanSums = kernels::scan_span_sums_uint;
  using Spans = kernels::scan_spans_uint;
};
template <>
struct ScanKernels<cl_uint2> {
  using Reduce = kernels::scan_reduce_uint2;
  using Write = kernels::scan_write_uint2;
  using SpanSums = kernels::scan_span_sums_uint2;
  using Spans = kernels::scan_spans_uint2;
};
template <>
struct ScanKernels<cl_uint8> {
  using Reduce = kernels::scan_reduce_uint8;
  using Write = kernels::scan_write_uint8;
  using SpanSums = kernels::scan_span_sums_uint8;
  using Spans = kernels::scan_spans_uint8;
};

std::size_t divided_up(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

// How n elements are divided among work-groups: `count` spans, each a whole number of tiles.
struct Spans {
  std::size_t length, count;
};

Spans spans_of(const Sizes& sizes, std::size_t n) {
  const std::size_t tile = sizes.tile_group * sizes.scan_items;
  const std::size_t tiles = divided_up(n, tile);
  const std::size_t most = tiles <= sizes.scan_tiles_alone ? 1 : sizes.scan_groups;
  const std::size_t length = divided_up(tiles, most) * tile;
  return {length, divided_up(n, length)};
}

template <typename Kernel>
void launch_spans(Runtime& runtime, const Spans& spans, std::size_t n, const Kernel& kernel) {
  runtime.launch(spans.count * runtime.sizes().tile_group, runtime.sizes().tile_group, n, kernel);
}

// In at most two launches.
template <typename T>
void scan_by_spans(Runtime& runtime, const Buffer<T>& input, std::size_t n, const Buffer<T>& output) {
  const Spans spans = spans_of(runtime.sizes(), n);
  Arena::Scope scope(runtime.arena());
  const auto sums = runtime.arena().allocate<T>(spans.count);
  using Kernels = ScanKernels<T>;
  if (spans.count > 1) {
    launch_spans(
        runtime, spans, n,
        typename Kernels::SpanSums{.spans = spans.count, .span = spans.length, .input = input, .sums = sums});
  }
  launch_spans(runtime, spans, n,
               typename Kernels::Spans{.spans = spans.count,
                                       .span = spans.length,
                                       .items = runtime.sizes().scan_items,
                                       .sums = sums,
                                       .input = input,
                                       .output = output});
}

// Flags. The indices of flags that equal `wanted` are packed.
struct Flags {
  const Buffer<cl_uchar>& values;
  std::size_t count;
  int wanted;
};

void count_in_spans(Runtime& runtime, const Spans& spans, const Flags& flags, const Buffer<cl_uint>& counts) {
  launch_spans(runtime, spans, flags.count,
               kernels::pack_span_counts{.spans = spans.count,
                                         .span = spans.length,
                                         .flags = flags.values,
                                         .wanted = flags.wanted,
                                         .counts = counts});
}

void pack_by_spans(Runtime& runtime, const Spans& spans, const Flags& flags, const Buffer<cl_uint>& counts,
                   const Buffer<cl_int>& positions, const Buffer<cl_uint>& total) {
  launch_spans(runtime, spans, flags.count,
               kernels::pack_spans{.spans = spans.count,
                                   .span = spans.length,
                                   .items = runtime.sizes().scan_items,
                                   .flags = flags.values,
                                   .wanted = flags.wanted,
                                   .counts = counts,
                                   .positions = positions,
                                   .total = total});
}

}  // namespace

template <typename T>
void exclusive_scan(Runtime& runtime, const Buffer<T>& input, std::size_t n, const Buffer<T>& output) {
  if (n == 0) {
    runtime.fill(output, 1, T{});
    return;
  }
  if (runtime.sizes().tile_group != 0) {
    scan_by_spans(runtime, input, n, output);
    return;
  }
  const std::size_t chunk = runtime.sizes().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  using Write = typename ScanKernels<T>::Write;
  if (chunk_count == 1) {
    runtime.chunks(n, chunk, Write{.has_prefix = false, .prefix = output, .input = input, .output = output});
    return;
  }
  Arena::Scope scope(runtime.arena());
  const auto sums = runtime.arena().allocate<T>(chunk_count + 1);
  runtime.chunks(n, chunk, typename ScanKernels<T>::Reduce{.input = input, .sums = sums});
  exclusive_scan(runtime, sums, chunk_count, sums);
  runtime.chunks(n, chunk, Write{.has_prefix = true, .prefix = sums, .input = input, .output = output});
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
  if (runtime.sizes().tile_group != 0) {
    const Spans spans = spans_of(runtime.sizes(), n);
    const auto counts = runtime.arena().allocate<cl_uint>(spans.count);
    if (spans.count > 1) count_in_spans(runtime, spans, {flags, n, wanted}, counts);
    pack_by_spans(runtime, spans, {flags, n, wanted}, counts, positions, count);
    return;
  }
  const std::size_t chunk = runtime.sizes().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  const auto counts = runtime.arena().allocate<cl_uint>(chunk_count + 1);
  runtime.chunks(n, chunk, kernels::pack_count{.flags = flags, .wanted = wanted, .counts = counts});
  exclusive_scan(runtime, counts, chunk_count, counts);
  runtime.chunks(
      n, chunk,
      kernels::pack_write{.flags = flags, .wanted = wanted, .prefix = counts, .positions = positions});
  runtime.copy(counts, chunk_count, count, 0, 1);
}

std::pair<Buffer<cl_int>, std::size_t> pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags,
                                                      std::size_t n, int wanted) {
  if (n == 0) return {runtime.arena().allocate<cl_int>(0), 0};
  Arena& arena = runtime.arena();
  if (runtime.sizes().tile_group != 0) {
    const Spans spans = spans_of(runtime.sizes(), n);
    const auto counts = arena.allocate<cl_uint>(spans.count);
    count_in_spans(runtime, spans, {flags, n, wanted}, counts);
    std::vector<cl_uint> found(spans.count);
    runtime.read(counts, 0, spans.count, found.data());
    const std::size_t total = std::accumulate(found.begin(), found.end(), std::size_t{0});
    const auto positions = arena.allocate<cl_int>(total);
    if (total > 0) {
      pack_by_spans(runtime, spans, {flags, n, wanted}, counts, positions, arena.allocate<cl_uint>(1));
    }
    return {positions, total};
  }
  const std::size_t chunk = runtime.sizes().chunk(n);
  const std::size_t chunk_count = (n + chunk - 1) / chunk;
  const auto counts = arena.allocate<cl_uint>(chunk_count + 1);
  runtime.chunks(n, chunk, kernels::pack_count{.flags = flags, .wanted = wanted, .counts = counts});
  exclusive_scan(runtime, counts, chunk_count, counts);
  const std::size_t total = runtime.read_one(counts, chunk_count);
  const auto positions = arena.allocate<cl_int>(total);
  if (total > 0)
    runtime.chunks(
        n, chunk,
        kernels::pack_write{.flags = flags, .wanted = wanted, .prefix = counts, .positions = positions});
  return {positions, total};
}

void count_flags(Runtime& runtime, const Buffer<cl_uchar>& flags, std::size_t n, int wanted,
                 const Buffer<cl_uint>& counts) {
  runtime.map(n, kernels::flag_counts{.wanted = wanted, .flags = flags, .counts = counts});
}

void add_count(Runtime& runtime, const Buffer<cl_uint>& count, const Buffer<cl_uint>& sum) {
  runtime.launch(1, 1, kernels::add_count{.count = count, .sum = sum});
}

namespace {

/// Reduces the sort's group size until the device supports it. The sort's kernels are compiled for one size.
void fit_sort_group(Runtime& runtime) {
  for (const KernelName* const kernel :
       {&kernels::sort_count::kernel_name, &kernels::sort_scatter::kernel_name}) {
    for (;;) {
      const std::size_t largest = runtime.largest_group(*kernel);
      const std::size_t group = runtime.sizes().sort_group;
      if (group <= largest) break;
      if (group == 1) {
        throw DeviceError(
            fmt::format("the device has not the local memory for any work-group of kernel {}; use another "
                        "(FLAUNAY_DEVICE)",
                        kernel->name));
      }
      const std::shared_ptr<Sizes> smaller = runtime.sizes().copy();
      smaller->sort_group = group / 2;
      runtime.set_sizes(smaller);
    }
  }
}

// Each element moves to before those that are greater.
void insert_sorted(cl_ulong* keys, cl_int* payloads, std::size_t n) {
  for (std::size_t i = 1; i < n; ++i) {
    const auto place = std::upper_bound(keys, keys + i, keys[i]) - keys;
    std::rotate(keys + place, keys + i, keys + i + 1);
    std::rotate(payloads + place, payloads + i, payloads + i + 1);
  }
}

}  // namespace

void sort_by_key(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& payloads,
                 std::size_t n) {
  if (n < 2) return;
  // Counting digits would take longer.
  constexpr std::size_t kFew = 48;
  if (runtime.is_native() && !runtime.counts_only() && n <= kFew) {
    return insert_sorted(reinterpret_cast<cl_ulong*>(address_of(keys.memory())),
                         reinterpret_cast<cl_int*>(address_of(payloads.memory())), n);
  }
  fit_sort_group(runtime);
  Arena::Scope scope(runtime.arena());
  const Sizes& sizes = runtime.sizes();
  const auto varying = runtime.arena().allocate<cl_uint>(2);
  runtime.fill(varying, 2, cl_uint{0});
  runtime.chunks(n, sizes.chunk(n), kernels::sort_varying{.keys = keys, .varying = varying});
  cl_uint bits[2];
  runtime.read(varying, 0, 2, bits);
  const cl_ulong differing = bits[0] | static_cast<cl_ulong>(bits[1]) << 32;

  const std::size_t items = sizes.sort_items != 0 ? sizes.sort_items : sizes.chunk(n);
  const std::size_t work_items = (n + items - 1) / items;
  const std::size_t groups = (work_items + sizes.sort_group - 1) / sizes.sort_group;
  const std::size_t entries = groups << sizes.sort_bits;
  const auto table = runtime.arena().allocate<cl_uint>(entries + 1);
  Buffer<cl_ulong> from_keys = keys;
  Buffer<cl_int> from_payloads = payloads;
  auto to_keys = runtime.arena().allocate<cl_ulong>(n);
  auto to_payloads = runtime.arena().allocate<cl_int>(n);
  bool in_place = true;
  const cl_ulong digit_mask = (cl_ulong{1} << sizes.sort_bits) - 1;
  for (std::size_t shift = 0; shift < 64; shift += sizes.sort_bits) {
    if (((differing >> shift) & digit_mask) == 0) continue;
    runtime.launch(work_items, sizes.sort_group, n,
                   kernels::sort_count{.items = items, .shift = shift, .keys = from_keys, .table = table});
    exclusive_scan(runtime, table, entries, table);
    runtime.launch(work_items, sizes.sort_group, n,
                   kernels::sort_scatter{.items = items,
                                         .shift = shift,
                                         .keys = from_keys,
                                         .payloads = from_payloads,
                                         .table = table,
                                         .sorted_keys = to_keys,
                                         .sorted_payloads = to_payloads});
    std::swap(from_keys, to_keys);
    std::swap(from_payloads, to_payloads);
    in_place = !in_place;
  }
  if (!in_place) {
    runtime.copy(from_keys, 0, keys, 0, n);
    runtime.copy(from_payloads, 0, payloads, 0, n);
  }
}

}  // namespace flaunay::host
