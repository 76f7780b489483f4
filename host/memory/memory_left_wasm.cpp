#include <limits>

#include "host/memory/system_memory.hpp"

namespace flaunay::host {

// Nothing tells a module how much it may have. Its memory grows until an allocation fails.
MemoryLeft memory_left(const MemoryFiles&) { return {std::numeric_limits<std::size_t>::max(), ""}; }

MemoryLeft address_space_left(const MemoryFiles& files) { return memory_left(files); }

std::size_t physical_memory() { return 0; }

}  // namespace flaunay::host
