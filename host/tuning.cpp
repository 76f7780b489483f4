#include "host/tuning.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "host/error.hpp"

namespace flaunay::host {
namespace {

constexpr int kSmallRegion = 48;

}  // namespace

std::size_t Tuning::chunk(std::size_t n) const {
  if (chunks_most == 0) return chunk_least;
  return std::max(chunk_least, (n + chunks_most - 1) / chunks_most);
}

Tuning tuning_for(const boost::compute::device& device) {
  // A CPU's work-item walks a long chunk: a core each, with a few to spare for balance. Wide digits, since a
  // core's first-level cache holds the counters.
  const std::size_t cores = std::max<std::size_t>(1, device.compute_units());
  const Tuning cpu{256, 1, 1024, 8 * cores, 8, 1, 0, kSmallRegion, 16 * cores};
  // A GPU wants many short chunks; its counters live in local memory.
  const Tuning gpu{256, 64, 32, 0, 4, 128, 16, kSmallRegion, 16384};
  // Odd sizes that make every boundary occur on small inputs, and buffers that show every access beyond them.
  const Tuning small{3, 2, 5, 0, 3, 4, 3, kSmallRegion, 7, true};

  if (const char* kind = std::getenv("FLAUNAY_TUNING"); kind != nullptr && *kind != '\0') {
    if (std::string(kind) == "cpu") return cpu;
    if (std::string(kind) == "gpu") return gpu;
    if (std::string(kind) == "small") return small;
    throw DeviceError("FLAUNAY_TUNING is '" + std::string(kind) + "'; it can be cpu, gpu or small");
  }
  return (device.type() & CL_DEVICE_TYPE_CPU) ? cpu : gpu;
}

}  // namespace flaunay::host
