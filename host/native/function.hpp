// Kernels that are compiled as C++, for calls on the host without OpenCL.
#pragma once

#include <cstddef>

namespace flaunay::host {

/// Work-items [begin, end) of a launch that has `total` of them.
struct WorkItems {
  std::size_t begin, end, total;
};

/// Runs work-items of a kernel on the calling thread. arguments: a pointer to each argument's value; an
/// array's value is the pointer to its first element.
using NativeFunction = void (*)(WorkItems items, void* const* arguments);

}  // namespace flaunay::host
