// The settings of a runtime: the capabilities of its device, and the sizes of launches and vector operations.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>
#include <memory>
#include <string>

#include "operations/limits.h"

namespace flaunay {

/// All sizes, including sizes of the user of Runtime, who defines this struct.
struct Tuning;

namespace host {

/// The capabilities of a device, from its properties and its self-test. Kernels are compiled for them.
struct Capabilities {
  /// Kernels compute in fixed point: the device has no doubles, or they fail the self-test, or are too slow.
  bool fixed_point = false;
  /// Kernels compute the errors of products without fma, which is not exact.
  bool split_products = false;
  /// Kernels use atomic operations to read data that other work-groups may change meanwhile.
  bool atomic_reads = false;
  /// The device ends loops after some ten thousand turns of a work-item.
  bool loops_end_early = false;

  /// The compiler options of the kernels: "-DNAME=VALUE ...".
  std::string build_options() const;
};

/// The sizes that suit one device. Tuning derives from this struct.
struct Sizes {
  /// Work-group size of kernels with one work-item per element.
  std::size_t map_group = 1;
  /// Work-group size of kernels with one work-item per element that have large private arrays.
  std::size_t private_group = 1;
  /// Work-group size of kernels where each work-item walks a contiguous chunk.
  std::size_t chunk_group = 1;
  /// A chunk has at least this many elements; at least 2.
  std::size_t chunk_least = 2;
  /// There are at most this many chunks; 0: no limit.
  std::size_t chunks_most = 0;
  /// Radix sort: bits per pass, work-group size, and elements per work-item (0: as many as a chunk has).
  std::size_t sort_bits = 1;
  std::size_t sort_group = 1;
  std::size_t sort_items = 0;
  /// Work-group size of kernels where each work-group takes a tile of elements; 0: a work-item per chunk does
  /// the work instead. At most kernel::LARGEST_TILE_GROUP.
  std::size_t tile_group = 0;
  /// The local memory that kernels which take tiles are built for: a power of two, from
  /// kernel::LEAST_LOCAL_BYTES to kernel::DEFAULT_LOCAL_BYTES.
  std::size_t local_bytes = kernel::DEFAULT_LOCAL_BYTES;
  /// A scan by work-groups: elements per work-item of a tile, how many tiles a single group may scan alone,
  /// and the largest number of groups. All are at least 1.
  std::size_t scan_items = 1;
  std::size_t scan_tiles_alone = 1;
  std::size_t scan_groups = 1;
  /// Other than 0: kernels read and write the caller's host memory instead of copies.
  std::size_t in_host_memory = 0;
  /// Large transfers between host and device go through pinned memory, in chunks of this size; 0: none do.
  std::size_t staging_bytes = 0;
  /// How arrays get memory: a value of ArrayMemory.
  std::size_t separate_buffers = 0;

  virtual ~Sizes() = default;
  Sizes() = default;
  Sizes(const Sizes&) = default;
  Sizes& operator=(const Sizes&) = default;

  /// The tuning values that include these sizes.
  virtual const Tuning& tuning() const = 0;
  /// Returns a copy of all tuning values.
  virtual std::shared_ptr<Sizes> copy() const = 0;
  /// The number of elements per chunk if there are n elements.
  std::size_t chunk(std::size_t n) const;
  /// The compiler options of the kernels: "-DNAME=VALUE ...".
  virtual std::string build_options() const;
};

/// The settings with which a runtime on a device is made.
struct Settings {
  std::shared_ptr<const Sizes> sizes;  ///< not null
  Capabilities capabilities{};
};

/// The limits of a device.
struct DeviceLimits {
  std::size_t work_group;    ///< largest number of work-items per group
  std::size_t local_memory;  ///< bytes of local memory per group
};
DeviceLimits limits_of(const boost::compute::device& device);

/// Reduces group sizes, the sort's bits per pass and the sizes of tiles to the limits. A single kernel may
/// support only smaller groups; Runtime reduces those when it launches the kernel.
void fit(Sizes& sizes, const DeviceLimits& limits);

}  // namespace host

}  // namespace flaunay
