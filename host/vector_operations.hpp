// The data-parallel vocabulary: the operations on whole arrays that everything else is made of.
//
// All enqueue on the runtime's in-order queue and do not wait, unless they say so. Results depend on the
// input alone, never on scheduling, chunk sizes or work-group sizes. Temporary device memory comes from the
// arena and is released on return; sizes are below 2^31. Work is O(n) unless stated; depth on c chunks is O(n
// / c + c). A "segment" array gives each element's segment, without descent; segments may be empty.
#pragma once

#include "host/runtime.hpp"

namespace flaunay::host {

/// Exclusive prefix sums, n values, and the total at output[n]; output may be input. T: cl_uint, cl_uint2
/// (componentwise), cl_uint8. Temporary: a few values per chunk.
template <typename T>
void exclusive_scan(Runtime& runtime, const Buffer<T>& input, std::size_t n, const Buffer<T>& output);

/// The positions i < n with flags[i] == wanted, ascending, into positions; their number into count[0], which
/// has one element. positions must have room for all.
void pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags, std::size_t n, int wanted,
                    const Buffer<cl_int>& positions, const Buffer<cl_uint>& count);
/// The same, but waits, and allocates in the caller's arena scope: the positions and how many there are.
std::pair<Buffer<cl_int>, std::size_t> pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags,
                                                      std::size_t n, int wanted);

/// Stable sort of keys (as unsigned numbers) with their payloads, in place. Digits in which no two keys
/// differ are skipped; waits once to find them. Temporary: 12 n bytes. O(n) per digit that varies.
void sort_by_key(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& payloads,
                 std::size_t n);

/// One pass of a segmented arg-reduce after another, until nothing reaches beyond a chunk; for kernels made
/// by shared/segmented_arg_reduce.h. result must hold a negative value for every segment.
template <typename... Extra>
void segmented_arg_reduce(Runtime& runtime, const char* file, const char* kernel,
                          const Buffer<cl_int>& segment, std::size_t n, const Buffer<cl_int>& result,
                          const Extra&... extra) {
  if (n == 0) return;
  Arena::Scope scope(runtime.arena());
  Buffer<cl_int> segments = segment;
  Buffer<cl_int> candidates = segment;  // not read by the first pass
  for (bool first = true;; first = false) {
    const std::size_t chunk = runtime.tuning().chunk(n);
    const std::size_t chunk_count = (n + chunk - 1) / chunk;
    const auto partial_segments = runtime.arena().allocate<cl_int>(2 * chunk_count);
    const auto partial_candidates = runtime.arena().allocate<cl_int>(2 * chunk_count);
    runtime.chunks(file, kernel, n, chunk, static_cast<cl_int>(first), segments, candidates, partial_segments,
                   partial_candidates, result, extra...);
    if (chunk_count == 1) return;
    segments = partial_segments;
    candidates = partial_candidates;
    n = 2 * chunk_count;
  }
}

/// The index of each segment's smallest (greatest) value, the first of them if there are several; -1 for an
/// empty segment. result: one per segment.
void segmented_arg_min(Runtime& runtime, const Buffer<cl_double>& values, const Buffer<cl_int>& segment,
                       std::size_t n, std::size_t segments, const Buffer<cl_int>& result);
void segmented_arg_max(Runtime& runtime, const Buffer<cl_double>& values, const Buffer<cl_int>& segment,
                       std::size_t n, std::size_t segments, const Buffer<cl_int>& result);

/// Inclusive prefix sums within each segment, and each segment's sum (0 for an empty one).
void segmented_sum(Runtime& runtime, const Buffer<cl_long>& values, const Buffer<cl_int>& segment,
                   std::size_t n, std::size_t segments, const Buffer<cl_long>& scanned,
                   const Buffer<cl_long>& total);

/// The new position of each element when every segment is split stably into side 0, then side 1; -1 for other
/// sides. offsets: segments + 1 positions at which segments begin. Temporary: 8 n bytes.
void segmented_split(Runtime& runtime, const Buffer<cl_uchar>& side, const Buffer<cl_int>& segment,
                     const Buffer<cl_int>& offsets, std::size_t n, const Buffer<cl_int>& places);

/// moved[places[i]] = values[i] for places[i] >= 0.
void permute(Runtime& runtime, const Buffer<cl_int>& places, const Buffer<cl_int>& values, std::size_t n,
             const Buffer<cl_int>& moved);

/// The key of rank rank[s] (from 0) of each non-empty segment of unsorted keys, into found; rank is used up.
/// The median of a segment of m keys is the one of rank m / 2. 64 rounds of O(n). Temporary: 16 n bytes.
void segmented_select(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& segment,
                      std::size_t n, std::size_t segments, const Buffer<cl_long>& rank,
                      const Buffer<cl_ulong>& found);

}  // namespace flaunay::host
