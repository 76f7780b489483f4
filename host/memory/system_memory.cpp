#include "host/memory/system_memory.hpp"

#include <CL/cl.h>
#include <fmt/format.h>

#include "host/error.hpp"

namespace flaunay::host {

// Memory that an allocation must leave to the OpenCL implementation.
constexpr std::size_t kSpare = 32 * kMebibyte;

std::string mebibytes(std::size_t bytes) { return fmt::format("{} MiB", bytes / kMebibyte); }

void require_memory(std::size_t bytes, const std::string& what) {
  const MemoryLeft left = memory_left();
  if (left.bytes >= kSpare && left.bytes - kSpare >= bytes) return;
  throw DeviceError(fmt::format("{} needs {}, and the driver {} besides, but {} leaves {}; use fewer points, "
                                "or provide more memory",
                                what, mebibytes(bytes + kMebibyte - 1), mebibytes(kSpare), left.limit,
                                mebibytes(left.bytes)),
                    CL_MEM_OBJECT_ALLOCATION_FAILURE);
}

}  // namespace flaunay::host
