// Reads arrays of the caller's back to the host.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "host/runtime.hpp"

namespace flaunay::points {

/// Returns `count` values from `first` on. On a device they are copied there first, because the caller's
/// buffer may not permit the host to read it. Waits.
template <typename T>
std::vector<T> download(host::Runtime& runtime, const host::Buffer<T>& from, std::size_t first,
                        std::size_t count) {
  std::vector<T> values(count);
  if (runtime.is_native()) {
    runtime.read(from, first, count, values.data());
    return values;
  }
  const host::Buffer<T> copy(
      host::allocate_memory(runtime.memory(), std::max<std::size_t>(1, count) * sizeof(T)), count);
  runtime.copy(from, first, copy, 0, count);
  runtime.read(copy, 0, count, values.data());
  return values;
}

/// Returns the first `count` values.
template <typename T>
std::vector<T> download(host::Runtime& runtime, const host::Buffer<T>& from, std::size_t count) {
  return download(runtime, from, 0, count);
}

}  // namespace flaunay::points
