// Launches of native kernels on the calling thread, without a runtime, for calls that take microseconds.
#pragma once

#include <cstddef>
#include <vector>

#include "host/launch/argument_list.hpp"

namespace flaunay::host {

template <typename T>
Here<T> here(T* values) {
  return {values};
}
template <typename T>
Here<T> here(std::vector<T>& values) {
  return {values.data()};
}

/// Runs all work-items of a kernel. leading: the arguments that its launcher does not have; see Form.
template <typename Kernel, typename... Leading>
void run_natively(std::size_t work_items, const Kernel& kernel, const Leading&... leading) {
  ArgumentList arguments;
  (arguments(leading), ...);
  kernel.for_each_argument([&arguments](const auto& argument) { arguments(argument); });
  Kernel::kernel_name.native({0, work_items, work_items}, arguments.values());
}

/// Runs a kernel with one work-item per element.
template <typename Kernel>
void map_natively(std::size_t n, const Kernel& kernel) {
  static_assert(Kernel::form == Form::PerElement);
  run_natively(n, kernel, Value<cl_int>(n));
}

/// Runs a kernel with all elements as one chunk.
template <typename Kernel>
void run_chunk_natively(std::size_t n, const Kernel& kernel) {
  static_assert(Kernel::form == Form::PerChunk);
  run_natively(1, kernel, Value<cl_int>(n), Value<cl_int>(n));
}

}  // namespace flaunay::host
