// How much memory the stages take.
#pragma once

#include <cstddef>

#include "host/runtime.hpp"

namespace flaunay::hybrid {

struct WorkspaceBytes {
  std::size_t persistent, scratch;
};

/// Bounds for any n points in so many sets, a copy of the points and their representatives included.
WorkspaceBytes workspace_bytes(const host::Runtime& runtime, std::size_t n, std::size_t sets);

}  // namespace flaunay::hybrid
