// Every tuning value, in one place, by kind of device.
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

/// The values for a device; FLAUNAY_TUNING ("cpu", "gpu", "small") overrides the kind, for tests.
Tuning tuning_for(const boost::compute::device& device);

}  // namespace flaunay::host
