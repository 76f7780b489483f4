#include "host/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "host/error.hpp"

namespace flaunay::host {
namespace {

constexpr int kSmallRegion = 48;
constexpr std::size_t kLargestNamedGroup = 1024;

/// Of the sort's kernels, which count digits by work-item.
std::size_t sort_table_bytes(const Tuning& tuning) {
  return (tuning.sort_group << tuning.sort_bits) * sizeof(cl_uint);
}

Tuning cpu_tuning(const boost::compute::device& device) {
  // A CPU's work-item walks a long chunk: a core each, with a few to spare for balance. Wide digits, since a
  // core's first-level cache holds the counters.
  const std::size_t cores = std::max<std::size_t>(1, device.compute_units());
  return {256, 1, 1024, 8 * cores, 8, 1, 0, kSmallRegion, 16 * cores};
}

Tuning gpu_tuning() {
  // A GPU wants many short chunks; its counters live in local memory.
  return {256, 64, 32, 0, 4, 128, 16, kSmallRegion, 16384};
}

Tuning small_tuning() {
  // Odd sizes that make every boundary occur on small inputs, and buffers that show every access beyond them.
  return {3, 2, 5, 0, 3, 4, 3, kSmallRegion, 7, true};
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
  if (const std::size_t group = named_group(name); group != 0) {
    Tuning tuning = gpu_tuning();
    tuning.map_group = tuning.chunk_group = tuning.sort_group = group;
    return tuning;
  }
  throw DeviceError(fmt::format(
      "FLAUNAY_TUNING is '{}'; it can be cpu, gpu, gpu:N with groups of N work-items (1 to {}), or "
      "small",
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
  for (std::size_t* group : {&tuning.map_group, &tuning.chunk_group, &tuning.sort_group}) {
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
