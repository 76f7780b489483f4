// The types of kernel arguments in launchers. A launcher is a struct with one member per argument of its
// kernel, generated from the kernel's signature (cmake/launchers.cmake); Runtime launches it. Members have no
// defaults, so code with a missing argument, or with one of another type, does not compile.
#pragma once

#include <CL/cl.h>

#include <cassert>
#include <cstddef>
#include <type_traits>

#include "host/memory/arena.hpp"
#include "host/native/function.hpp"

namespace flaunay::host {

/// The largest number of bytes of one argument: every device takes 256 in all.
constexpr std::size_t kLargestArgument = 256;

/// A kernel's program and name. The program is the kernel's file in kernels/, or the file that includes it.
/// Runtime finds kernels by the address of this struct.
struct KernelName {
  const char* program;
  const char* name;
  NativeFunction native = nullptr;    ///< the kernel compiled for the host; null if it is not
  NativeFunction counting = nullptr;  ///< the same with counters; null if it counts nothing
};

/// The first arguments of a kernel, which the launch sets and the launcher does not have.
enum class Form {
  Plain,       ///< no such arguments
  PerElement,  ///< the number of elements; there is one work-item per element
  PerChunk,    ///< the number of elements and the chunk size; there is one work-item per chunk
  ArgReduce,   ///< the arguments of kernels/operations/segmented_arg_reduce.h
};

/// An array of the host itself, for native kernels that are launched without a runtime
/// (host/native/launch.hpp).
template <typename T>
struct Here {
  T* values;
};

/// An array that a kernel reads. It must outlive the launch: a launcher that is named must not be made of
/// buffers that are not.
template <typename T>
struct In {
  In(const Buffer<T>& buffer) : memory(buffer.memory()) {}
  In(Here<T> here) : memory(handle_of(here.values)) {}
  cl_mem memory;
};

/// An array that a kernel writes, or reads and writes. It must outlive the launch.
template <typename T>
struct Out {
  Out(const Buffer<T>& buffer) : memory(buffer.memory()) {}
  Out(Here<T> here) : memory(handle_of(here.values)) {}
  cl_mem memory;
};

/// A number or a struct. Numbers of elements fit into the kernels' 32-bit integers: callers have checked
/// that.
template <typename T>
struct Value {
  template <typename U>
  Value(U given) : value(static_cast<T>(given)) {
    static_assert(
        std::is_same_v<T, U> || (std::is_integral_v<T> && (std::is_integral_v<U> || std::is_enum_v<U>)),
        "no conversion from or to floating point");
    if constexpr (!std::is_same_v<T, U>) assert(static_cast<U>(value) == given);
  }
  T value;
};

}  // namespace flaunay::host
