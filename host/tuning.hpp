// Every tuning value, in one place, by kind of device and fitted to what the device can do.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>

namespace flaunay::host {

struct Tuning {
  /// Work-group size of kernels with one work-item per element.
  std::size_t map_group;
  /// Work-group size of kernels where each work-item walks a contiguous chunk.
  std::size_t chunk_group;
  /// A chunk has at least this many elements...
  std::size_t chunk_least;
  /// ...and there are no more than this many chunks (0: no limit).
  std::size_t chunks_most;
  /// Radix sort: bits a pass, work-group size, and elements per work-item (0: as chunks).
  int sort_bits;
  std::size_t sort_group;
  std::size_t sort_items;
  /// Corners of a region that one work-item triangulates in private memory. The order of rows depends on it,
  /// so it is the same for every device; only tests change it.
  int small_region;
  /// Work-items that share a list whose length only the device knows.
  std::size_t list_workers;
  /// Whether arrays are buffers of their own; see Arena::separate_buffers.
  bool separate_buffers = false;

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

/// The values for a device, fitted. FLAUNAY_TUNING overrides the kind, for tests: "cpu", "gpu", "small", or
/// "gpu:N", a GPU's with groups of N work-items (1 to 1024) everywhere.
Tuning tuning_for(const boost::compute::device& device);

}  // namespace flaunay::host
