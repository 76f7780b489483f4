#include "host/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "host/error.hpp"

namespace flaunay::host {
namespace {

// So far an edge leads at most, as a rule: 3 pairs a point.
constexpr std::size_t kPairsOfABlock = 3 * kBlockPoints;
constexpr std::size_t kPointsOfASmallBlock = 6;
constexpr std::size_t kLargestNamedGroup = 1024;

/// Of the sort's kernels, which count digits by work-item.
std::size_t sort_table_bytes(const Tuning& tuning) {
  return (tuning.sort_group << tuning.sort_bits) * sizeof(cl_uint);
}

Tuning cpu_tuning(const boost::compute::device& device) {
  const std::size_t cores = std::max<std::size_t>(1, device.compute_units());
  Tuning tuning;
  // A work-item walks a long chunk: a core each, with a few to spare for balance.
  tuning.map_group = 256;
  tuning.chunk_group = 1;
  tuning.chunk_least = 1024;
  tuning.chunks_most = 8 * cores;
  // Wide digits, since a core's first-level cache holds the counters.
  tuning.sort_bits = 8;
  tuning.sort_group = 1;
  tuning.list_workers = 16 * cores;
  tuning.block_workers = 2 * cores;
  tuning.block_group = 1;
  tuning.fetch_ahead = kPairsOfABlock;
  tuning.in_host_memory = true;
  return tuning;
}

Tuning gpu_tuning() {
  // Many short chunks; the sort's counters live in local memory.
  Tuning tuning;
  tuning.map_group = 256;
  tuning.chunk_group = 64;
  tuning.chunk_least = 32;
  tuning.sort_bits = 4;
  tuning.sort_group = 128;
  tuning.sort_items = 16;
  tuning.list_workers = 16384;
  tuning.block_workers = 16384;
  tuning.block_group = 32;
  return tuning;
}

Tuning small_tuning() {
  // Odd sizes that make every boundary occur on small inputs, and buffers that show every access beyond them.
  Tuning tuning;
  tuning.map_group = 3;
  tuning.chunk_group = 2;
  tuning.chunk_least = 5;
  tuning.sort_bits = 3;
  tuning.sort_group = 4;
  tuning.sort_items = 3;
  tuning.list_workers = 7;
  tuning.block_workers = 3;
  tuning.block_group = 2;
  tuning.sorted_queries_least = 4;
  tuning.separate_buffers = true;
  return tuning;
}

/// The N of "gpu:N"; 0 if it is none.
std::size_t named_group(const std::string& name) {
  const std::string prefix = "gpu:";
  if (name.compare(0, prefix.size(), prefix) != 0) return 0;
  const std::string digits = name.substr(prefix.size());
  if (digits.empty() || digits.size() > 4 || digits.find_first_not_of("0123456789") != std::string::npos)
    return 0;
  const std::size_t group = std::stoul(digits);
  return group <= kLargestNamedGroup ? group : 0;
}

Tuning tuning_named(const std::string& name, const boost::compute::device& device) {
  if (name == "cpu") return cpu_tuning(device);
  if (name == "gpu") return gpu_tuning();
  if (name == "small") return small_tuning();
  if (name == "small-blocks") {
    Tuning tuning = small_tuning();
    tuning.block_points = kPointsOfASmallBlock;
    return tuning;
  }
  if (const std::size_t group = named_group(name); group != 0) {
    Tuning tuning = gpu_tuning();
    tuning.map_group = tuning.chunk_group = tuning.sort_group = tuning.block_group = group;
    return tuning;
  }
  throw DeviceError(
      fmt::format("FLAUNAY_TUNING is '{}'; it can be cpu, gpu, gpu:N with groups of N work-items (1 to {}), "
                  "small, or small-blocks",
                  name, kLargestNamedGroup));
}

}  // namespace

std::size_t Tuning::chunk(std::size_t n) const {
  if (chunks_most == 0) return chunk_least;
  return std::max(chunk_least, (n + chunks_most - 1) / chunks_most);
}

DeviceLimits limits_of(const boost::compute::device& device) {
  DeviceLimits limits{device.max_work_group_size(),
                      static_cast<std::size_t>(device.get_info<cl_ulong>(CL_DEVICE_LOCAL_MEM_SIZE))};
  // A group's first dimension may be limited further.
  const auto sizes = device.get_info<std::vector<std::size_t>>(CL_DEVICE_MAX_WORK_ITEM_SIZES);
  if (!sizes.empty()) limits.work_group = std::min(limits.work_group, sizes.front());
  return limits;
}

Tuning fitted(Tuning tuning, const DeviceLimits& limits) {
  const std::size_t most = std::max<std::size_t>(1, limits.work_group);
  for (std::size_t* group :
       {&tuning.map_group, &tuning.chunk_group, &tuning.sort_group, &tuning.block_group}) {
    *group = std::min(*group, most);
  }
  while (sort_table_bytes(tuning) > limits.local_memory && tuning.sort_group > 1) tuning.sort_group /= 2;
  while (sort_table_bytes(tuning) > limits.local_memory && tuning.sort_bits > 1) --tuning.sort_bits;
  return tuning;
}

Tuning tuning_for(const boost::compute::device& device) {
  const char* const name = std::getenv("FLAUNAY_TUNING");
  const bool is_cpu = (device.type() & CL_DEVICE_TYPE_CPU) != 0;
  const Tuning tuning = name != nullptr && *name != '\0' ? tuning_named(name, device)
                        : is_cpu                         ? cpu_tuning(device)
                                                         : gpu_tuning();
  return fitted(tuning, limits_of(device));
}

}  // namespace flaunay::host
