#include "host/launch/sizes.hpp"

#include <CL/cl.h>
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "operations/limits.h"

namespace flaunay::host {
namespace {

/// The local memory of the sort's kernels, which count digits per work-item.
std::size_t sort_table_bytes(const Sizes& sizes) {
  return (sizes.sort_group << sizes.sort_bits) * sizeof(cl_uint);
}

}  // namespace

std::string Capabilities::build_options() const {
  return fmt::format("-DATOMIC_READS={:d}{}{}", atomic_reads, split_products ? " -DSPLIT_PRODUCTS" : "",
                     fixed_point ? " -DFIXED_POINT" : "");
}

std::size_t Sizes::chunk(std::size_t n) const {
  if (chunks_most == 0) return chunk_least;
  return std::max(chunk_least, (n + chunks_most - 1) / chunks_most);
}

std::string Sizes::build_options() const {
  return fmt::format("-DSORT_BITS={} -DSORT_GROUP={} -DLOCAL_BYTES={}", sort_bits, sort_group, local_bytes);
}

DeviceLimits limits_of(const boost::compute::device& device) {
  DeviceLimits limits{device.max_work_group_size(),
                      static_cast<std::size_t>(device.get_info<cl_ulong>(CL_DEVICE_LOCAL_MEM_SIZE))};
  // The first dimension of a group may have a smaller limit.
  const auto sizes = device.get_info<std::vector<std::size_t>>(CL_DEVICE_MAX_WORK_ITEM_SIZES);
  if (!sizes.empty()) limits.work_group = std::min(limits.work_group, sizes.front());
  return limits;
}

void fit(Sizes& sizes, const DeviceLimits& limits) {
  const std::size_t most = std::max<std::size_t>(1, limits.work_group);
  for (std::size_t* group :
       {&sizes.map_group, &sizes.private_group, &sizes.chunk_group, &sizes.sort_group, &sizes.tile_group}) {
    *group = std::min(*group, most);
  }
  sizes.tile_group = std::min<std::size_t>(sizes.tile_group, kernel::LARGEST_TILE_GROUP);
  sizes.local_bytes = kernel::DEFAULT_LOCAL_BYTES;
  while (sizes.local_bytes > limits.local_memory && sizes.local_bytes > kernel::LEAST_LOCAL_BYTES) {
    sizes.local_bytes /= 2;
  }
  if (limits.local_memory < sizes.local_bytes) sizes.tile_group = 0;
  for (std::size_t* size : {&sizes.scan_items, &sizes.scan_tiles_alone, &sizes.scan_groups}) {
    *size = std::max<std::size_t>(1, *size);
  }
  while (sort_table_bytes(sizes) > limits.local_memory && sizes.sort_group > 1) sizes.sort_group /= 2;
  while (sort_table_bytes(sizes) > limits.local_memory && sizes.sort_bits > 1) --sizes.sort_bits;
}

}  // namespace flaunay::host
