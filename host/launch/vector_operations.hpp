// Data-parallel operations on whole arrays, which the stages share.
//
// They enqueue work on the runtime's in-order queue and do not wait, unless stated otherwise. Results depend
// on the input alone, never on scheduling, chunk sizes or work-group sizes. Temporary device memory comes
// from the arena and is released on return. Sizes are below 2^31. Work is O(n) unless stated otherwise; depth
// on c chunks is O(n / c + c). A "segment" array holds the segment of each element, in ascending order;
// segments may be empty.
#pragma once

#include "host/runtime.hpp"

namespace flaunay::host {

/// Writes the n exclusive prefix sums, and the total at output[n]. output may be input. T: cl_uint, cl_uint2
/// or cl_uint8, which are added componentwise. Temporary memory: a few values per chunk. If work-groups take
/// tiles (Sizes::tile_group), at most two launches.
template <typename T>
void exclusive_scan(Runtime& runtime, const Buffer<T>& input, std::size_t n, const Buffer<T>& output);

/// Writes the positions i < n with flags[i] == wanted, ascending, to positions, and their number to count[0].
/// positions must have room for all of them. At most two launches where a scan takes as many.
void pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags, std::size_t n, int wanted,
                    const Buffer<cl_int>& positions, const Buffer<cl_uint>& count);
/// Returns the positions i < n with flags[i] == wanted, ascending, and their number. The positions are
/// allocated in the caller's arena scope. Waits once.
std::pair<Buffer<cl_int>, std::size_t> pack_positions(Runtime& runtime, const Buffer<cl_uchar>& flags,
                                                      std::size_t n, int wanted);

/// Writes counts[i] = 1 if flags[i] == wanted, otherwise 0, as input of exclusive_scan.
void count_flags(Runtime& runtime, const Buffer<cl_uchar>& flags, std::size_t n, int wanted,
                 const Buffer<cl_uint>& counts);

/// Computes sum[0] += count[0].
void add_count(Runtime& runtime, const Buffer<cl_uint>& count, const Buffer<cl_uint>& sum);

/// Sorts keys, as unsigned numbers, with their payloads, in place and stably. Digits in which no two keys
/// differ are skipped; waits once to find them. Temporary memory: 12 n bytes. O(n) per digit that is sorted.
void sort_by_key(Runtime& runtime, const Buffer<cl_ulong>& keys, const Buffer<cl_int>& payloads,
                 std::size_t n);

/// Finds the best element of each segment by a kernel that is made with operations/segmented_arg_reduce.h.
/// Passes are repeated until a single chunk is left. The kernel's result must hold a negative value for every
/// segment before. Temporary memory: a few values per chunk.
template <typename Kernel>
void segmented_arg_reduce(Runtime& runtime, std::size_t n, const Kernel& kernel) {
  if (n == 0) return;
  Arena::Scope scope(runtime.arena());
  In<cl_int> segments = kernel.segment;
  In<cl_int> candidates = kernel.segment;  // any buffer: the first pass does not read it
  Buffer<cl_int> read_segments, read_candidates;
  for (bool first = true;; first = false) {
    const std::size_t chunk = runtime.sizes().chunk(n);
    const std::size_t chunk_count = (n + chunk - 1) / chunk;
    const auto partial_segments = runtime.arena().allocate<cl_int>(2 * chunk_count);
    const auto partial_candidates = runtime.arena().allocate<cl_int>(2 * chunk_count);
    runtime.arg_reduce(n, chunk, first, segments, candidates, partial_segments, partial_candidates, kernel);
    if (chunk_count == 1) return;
    segments = read_segments = partial_segments;
    candidates = read_candidates = partial_candidates;
    n = 2 * chunk_count;
  }
}

}  // namespace flaunay::host
