// The list of a launch's arguments, which OpenCL sets one by one and native kernels take as an array.
#pragma once

#include <cassert>
#include <cstddef>
#include <type_traits>

#include "host/launch/kernel_arguments.hpp"

namespace flaunay::host {

/// Pointers to the values of arguments, in their order. The value of an array is its cl_mem. The values must
/// outlive this.
class ArgumentList {
 public:
  ArgumentList() = default;
  ArgumentList(const ArgumentList&) = delete;
  ArgumentList& operator=(const ArgumentList&) = delete;

  template <typename T>
  void operator()(const Value<T>& value) {
    add(value.value);
  }
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T>>>
  void operator()(const T& value) {
    add(value);
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

  std::size_t size() const { return count_; }
  /// As native kernels take them.
  void* const* values() const { return values_; }
  std::size_t bytes(std::size_t k) const { return bytes_[k]; }
  /// The array passed as argument k; null if the argument is a value.
  cl_mem array(std::size_t k) const { return arrays_[k]; }

 private:
  static constexpr std::size_t kMost = 64;  // more than any kernel has

  template <typename T>
  void add(const T& value) {
    static_assert(sizeof value <= kLargestArgument && std::is_trivially_copyable_v<T>);
    assert(count_ < kMost);
    values_[count_] = const_cast<T*>(&value);
    bytes_[count_] = sizeof value;
    arrays_[count_++] = nullptr;
  }
  void add_array(cl_mem memory) {
    add(arrays_[count_]);
    arrays_[count_ - 1] = memory;
  }

  void* values_[kMost];
  std::size_t bytes_[kMost];
  cl_mem arrays_[kMost];
  std::size_t count_ = 0;
};

}  // namespace flaunay::host
