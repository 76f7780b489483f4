// The arguments of native kernels; and launches on the calling thread, without a runtime, for calls that take
// microseconds.
#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "host/launch/kernel_arguments.hpp"

namespace flaunay::host {

template <typename T>
Here<T> here(T* values) {
  return {values};
}
template <typename T>
Here<T> here(std::vector<T>& values) {
  return {values.data()};
}

/// Pointers to the values of arguments, as native kernels take them. The values must outlive this.
class NativeArguments {
 public:
  template <typename T>
  void operator()(const Value<T>& value) {
    add(&value.value);
  }
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T>>>
  void operator()(const T& value) {
    add(&value);
  }
  template <typename T>
  void operator()(const Buffer<T>& array) {
    add_array(array.memory());
  }
  template <typename T>
  void operator()(const In<T>& array) {
    add_array(array.memory);
  }
  template <typename T>
  void operator()(const Out<T>& array) {
    add_array(array.memory);
  }
  void* const* get() const { return values_; }

 private:
  static constexpr std::size_t kMost = 64;  // more than any kernel has

  void add(const void* value) {
    assert(count_ < kMost);
    values_[count_++] = const_cast<void*>(value);
  }
  void add_array(cl_mem memory) {
    arrays_[count_] = memory;
    add(&arrays_[count_]);
  }

  void* values_[kMost];
  cl_mem arrays_[kMost];
  std::size_t count_ = 0;
};

/// Runs all work-items of a kernel. leading: the arguments that its launcher does not have; see Form.
template <typename Kernel, typename... Leading>
void run_natively(std::size_t work_items, const Kernel& kernel, const Leading&... leading) {
  NativeArguments arguments;
  (arguments(leading), ...);
  kernel.for_each_argument([&arguments](const auto& argument) { arguments(argument); });
  Kernel::kernel_name.native({0, work_items, work_items}, arguments.get());
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
