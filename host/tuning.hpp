// Every tuning value, in one place, by kind of device and fitted to what the device can do.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>

namespace flaunay::host {

/// Corners of a region that one work-item triangulates in private memory.
constexpr int kSmallRegion = 48;
/// Points of a block of Mode::hybrid, at most: with what its solution needs, it stays in a core's
/// second-level cache.
constexpr std::size_t kBlockPoints = 2048;
/// From so many queries on, sorting them saves more than it takes.
constexpr std::size_t kSortedQueries = 16384;

struct Tuning {
  /// Work-group size of kernels with one work-item per element.
  std::size_t map_group = 1;
  /// Work-group size of kernels where each work-item walks a contiguous chunk.
  std::size_t chunk_group = 1;
  /// A chunk has at least this many elements, 2 or more...
  std::size_t chunk_least = 2;
  /// ...and there are no more than this many chunks (0: no limit).
  std::size_t chunks_most = 0;
  /// Radix sort: bits a pass, work-group size, and elements per work-item (0: as chunks).
  int sort_bits = 1;
  std::size_t sort_group = 1;
  std::size_t sort_items = 0;
  /// Work-items that share a list whose length only the device knows.
  std::size_t list_workers = 1;
  /// Work-items that share the blocks, and the size of their work-groups.
  std::size_t block_workers = 1;
  std::size_t block_group = 1;
  /// Pairs of edges that are fetched into the cache before they are needed; 0: none.
  std::size_t fetch_ahead = 0;
  /// So many queries of a locator, and more, are answered in the order of the plane.
  std::size_t sorted_queries_least = kSortedQueries;
  /// Whether kernels read and write the caller's memory in place of copies.
  bool in_host_memory = false;
  /// Whether arrays are buffers of their own; see Arena::separate_buffers.
  bool separate_buffers = false;
  /// The order of rows depends on these, so they are the same for every device; only tests change them.
  int small_region = kSmallRegion;
  std::size_t block_points = kBlockPoints;

  /// Elements per chunk for n elements.
  std::size_t chunk(std::size_t n) const;
};

/// What a device allows.
struct DeviceLimits {
  std::size_t work_group;    ///< work-items
  std::size_t local_memory;  ///< bytes
};
DeviceLimits limits_of(const boost::compute::device& device);

/// The same with groups as small, and sorting by as few bits at a time, as the limits demand. A kernel may
/// take less than its device: Runtime sees to that.
Tuning fitted(Tuning tuning, const DeviceLimits& limits);

/// The values for a device, fitted. FLAUNAY_TUNING overrides the kind, for tests: "cpu", "gpu", "small",
/// "small-blocks", or "gpu:N", a GPU's with groups of N work-items (1 to 1024) everywhere.
Tuning tuning_for(const boost::compute::device& device);

}  // namespace flaunay::host
