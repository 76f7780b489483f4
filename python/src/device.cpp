// Triangulations of points in device memory. Handles cross as integers, as pyopencl has them.
#include "bindings.hpp"
#include "call/result_arrays.hpp"
#include "flaunay/device_memory.hpp"

namespace flaunay::python {
namespace {

// A triangulation in device memory, with the triangulator that made it.
struct DeviceResult {
  std::shared_ptr<SharedTriangulator> triangulator;
  DeviceTriangulation triangulation;
};

// The event is the caller's to release.
Enqueue to_enqueue(std::uintptr_t queue, const std::vector<std::uintptr_t>& wait_for, cl_event* event) {
  Enqueue enqueue;
  enqueue.queue = reinterpret_cast<cl_command_queue>(queue);
  for (const std::uintptr_t other : wait_for) enqueue.wait_for.push_back(reinterpret_cast<cl_event>(other));
  enqueue.event = event;
  return enqueue;
}

// wanted: the names of the arrays to compute.
py::object triangulate(const std::shared_ptr<SharedTriangulator>& shared, const DevicePoints& points,
                       const Names& wanted, std::uintptr_t queue,
                       const std::vector<std::uintptr_t>& wait_for) {
  auto result = std::make_shared<DeviceResult>();
  result->triangulator = shared;
  Parts parts;
  for (const call::ResultArray& array : call::kResultArrays) {
    parts.*array.part = wanted.count(array.name) > 0;
  }
  cl_event event = nullptr;
  const Enqueue enqueue = to_enqueue(queue, wait_for, &event);
  shared->run([&](Triangulator& triangulator) {
    triangulator.triangulate(points, result->triangulation, parts, enqueue);
  });
  return py::make_tuple(result, reinterpret_cast<std::uintptr_t>(event));
}

// For each array by its name: the handle of its buffer and its shape, or None if it was not computed.
py::dict arrays_of(const DeviceResult& self) {
  const DeviceTriangulation& triangulation = self.triangulation;
  py::dict result;
  for (const call::ResultArray& array : call::kResultArrays) {
    if (!(triangulation.parts.*array.part)) {
      result[array.name] = py::none();
      continue;
    }
    const auto handle = reinterpret_cast<std::uintptr_t>((triangulation.*array.buffer).memory());
    const std::size_t rows = call::rows(triangulation, array.row), columns = call::columns(array.row);
    py::tuple shape = py::make_tuple(rows);
    if (columns > 1) shape = py::make_tuple(rows, columns);
    result[array.name] = py::make_tuple(handle, shape);
  }
  return result;
}

py::array_t<std::int64_t> copy_of(std::vector<std::size_t> offsets) { return to_offsets(std::move(offsets)); }

}  // namespace

void bind_device(py::module_& module) {
  py::class_<DevicePoints>(module, "DevicePoints")
      .def(py::init([](std::uintptr_t memory, std::size_t count, bool single, std::size_t first,
                       const std::optional<Offsets>& segments, std::uintptr_t device_segments,
                       std::size_t sets) {
             DevicePoints points;
             points.memory = reinterpret_cast<cl_mem>(memory);
             points.count = count;
             points.precision = single ? Precision::float32 : Precision::float64;
             points.first = first;
             if (segments) points.offsets = to_offsets(segments, count);
             points.device_offsets = reinterpret_cast<cl_mem>(device_segments);
             points.sets = sets;
             return points;
           }),
           py::arg("memory"), py::arg("count"), py::arg("single"), py::arg("first"),
           py::arg("segments") = py::none(), py::arg("device_segments") = 0, py::arg("sets") = 0);
  py::class_<DeviceResult, std::shared_ptr<DeviceResult>>(module, "DeviceResult")
      .def("arrays", arrays_of)
      .def_property_readonly(
          "triangle_offsets",
          [](const DeviceResult& self) { return copy_of(self.triangulation.triangle_offsets); })
      .def_property_readonly(
          "hull_offsets", [](const DeviceResult& self) { return copy_of(self.triangulation.hull_offsets); })
      .def_property_readonly("statistics",
                             [](const DeviceResult& self) { return to_dict(self.triangulation.statistics); });
  module.def("triangulate_device", triangulate, py::arg("triangulator"), py::arg("points"), py::arg("wanted"),
             py::arg("queue"), py::arg("wait_for"));
}

}  // namespace flaunay::python
