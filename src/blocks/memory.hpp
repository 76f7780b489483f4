// The device memory that mode blocks needs, found by a run that counts allocations and executes nothing.
#pragma once

#include <cstddef>

#include "host/runtime.hpp"

namespace flaunay::blocks {

struct WorkspaceBytes {
  std::size_t persistent, scratch;
};

/// Upper bounds for any n points in this many sets, including a copy of the points and their representatives.
WorkspaceBytes workspace_bytes(const host::Runtime& runtime, std::size_t n, std::size_t sets);

}  // namespace flaunay::blocks
