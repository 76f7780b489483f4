// What the parts of the extension module share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::python {

namespace py = pybind11;

/// A triangulator that Python's threads take in turns: while one works, the others wait without the
/// interpreter's lock.
class SharedTriangulator {
 public:
  explicit SharedTriangulator(const std::string& device);
  SharedTriangulator(cl_context context, cl_device_id device);
  /// Waits for queues of the caller, without the interpreter's lock: what they wait for may be a thread's.
  ~SharedTriangulator();
  SharedTriangulator(const SharedTriangulator&) = delete;
  SharedTriangulator& operator=(const SharedTriangulator&) = delete;

  /// work(triangulator); it must touch no Python object.
  template <typename Work>
  auto run(const Work& work) {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return work(*triangulator_);
  }

  /// Those that never change need no turn.
  std::uintptr_t context() const { return reinterpret_cast<std::uintptr_t>(triangulator_->context()); }
  std::uintptr_t device() const { return reinterpret_cast<std::uintptr_t>(triangulator_->device_id()); }
  std::uintptr_t queue() const { return reinterpret_cast<std::uintptr_t>(triangulator_->queue()); }

 private:
  std::optional<Triangulator> triangulator_;
  std::mutex mutex_;
};

using Points64 = py::array_t<double, py::array::c_style>;
using Points32 = py::array_t<float, py::array::c_style>;
using Offsets = py::array_t<std::int64_t, py::array::c_style>;
using Indices = py::array_t<std::int32_t, py::array::c_style>;

/// Names of arrays of a triangulation.
using Names = std::set<std::string>;

/// An array that owns the vector's memory: nothing is copied.
template <typename T, typename Element = T>
py::array_t<Element> to_array(std::vector<T>&& values, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(T) == sizeof(Element), "the same bytes, seen as another type");
  auto owner = std::make_unique<std::vector<T>>(std::move(values));
  auto* const data = reinterpret_cast<Element*>(owner->data());
  const py::capsule keeper(owner.get(), [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
  owner.release();
  return py::array_t<Element>(std::move(shape), data, keeper);
}

template <typename T>
py::array_t<T> to_array(std::vector<T>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return to_array(std::move(values), {size});
}

/// As rows of so many.
template <typename T>
py::array_t<T> to_rows(std::vector<T>&& values, py::ssize_t columns) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return to_array(std::move(values), {size / columns, columns});
}

inline py::array_t<std::int64_t> to_offsets(std::vector<std::size_t>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return to_array<std::size_t, std::int64_t>(std::move(values), {size});
}

/// The sets' offsets for n points; none means one set. Throws Error(usage) if they do not end with n; that
/// they begin with 0 and do not decrease, the library checks.
std::vector<std::size_t> to_offsets(const std::optional<Offsets>& offsets, std::size_t n);

/// Throws Error(usage) unless the array has two dimensions, the second of size 2.
std::size_t count_points(const py::array& points);

/// Users can change arrays in place, at any time: what is checked must be a copy of their indices.
std::vector<std::int32_t> copy_of(const Indices& array);

/// Throws Error(usage), which names the array, if an index is not in lowest to n - 1. Needs no lock of the
/// interpreter. what: that of which there are n.
void check_indices(const std::vector<std::int32_t>& indices, std::int32_t lowest, std::size_t n,
                   const char* name, const char* what);

/// The seconds of each phase by its name.
py::dict phases_to_dict(const std::vector<PhaseStatistics>& phases);
py::dict to_dict(const Statistics& statistics);

void bind_host(py::module_& module);
void bind_device(py::module_& module);
void bind_queries(py::module_& module);
void bind_chunks(py::module_& module);

}  // namespace flaunay::python
