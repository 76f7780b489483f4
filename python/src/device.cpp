// Triangulations of points in device memory. Handles cross as integers, as pyopencl has them.
#include "device.hpp"

#include "bindings.hpp"

namespace flaunay::python {
namespace {

py::object triangulate(const std::shared_ptr<SharedTriangulator>& shared, const DevicePoints& points,
                       const Parts& parts, std::uintptr_t queue,
                       const std::vector<std::uintptr_t>& wait_for) {
  auto result = std::make_shared<DeviceResult>();
  result->triangulator = shared;
  cl_event event = nullptr;
  const Enqueue enqueue = to_enqueue(queue, wait_for, &event);
  shared->run([&](Triangulator& triangulator) {
    triangulator.triangulate(points, result->triangulation, parts, enqueue);
  });
  return py::make_tuple(result, reinterpret_cast<std::uintptr_t>(event));
}

std::uintptr_t handle_of(const DeviceBuffer& buffer) {
  return reinterpret_cast<std::uintptr_t>(buffer.memory());
}

py::array_t<std::int64_t> copy_of(std::vector<std::size_t> offsets) { return to_offsets(std::move(offsets)); }

}  // namespace

Enqueue to_enqueue(std::uintptr_t queue, const std::vector<std::uintptr_t>& wait_for, cl_event* event) {
  Enqueue enqueue;
  enqueue.queue = reinterpret_cast<cl_command_queue>(queue);
  for (const std::uintptr_t other : wait_for) enqueue.wait_for.push_back(reinterpret_cast<cl_event>(other));
  enqueue.event = event;
  return enqueue;
}

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
  py::class_<Parts>(module, "Parts")
      .def(py::init([](bool neighbors, bool halfedges, bool hull, bool representatives) {
             return Parts{true, neighbors, halfedges, hull, representatives};
           }),
           py::arg("neighbors"), py::arg("halfedges"), py::arg("hull"), py::arg("representatives"));
  py::class_<DeviceResult, std::shared_ptr<DeviceResult>>(module, "DeviceResult")
      .def_property_readonly("triangles",
                             [](const DeviceResult& self) { return handle_of(self.triangulation.triangles); })
      .def_property_readonly("neighbors",
                             [](const DeviceResult& self) { return handle_of(self.triangulation.neighbors); })
      .def_property_readonly("halfedges",
                             [](const DeviceResult& self) { return handle_of(self.triangulation.halfedges); })
      .def_property_readonly("hull",
                             [](const DeviceResult& self) { return handle_of(self.triangulation.hull); })
      .def_property_readonly(
          "representatives",
          [](const DeviceResult& self) { return handle_of(self.triangulation.representatives); })
      .def_property_readonly(
          "triangle_offsets",
          [](const DeviceResult& self) { return copy_of(self.triangulation.triangle_offsets); })
      .def_property_readonly(
          "hull_offsets", [](const DeviceResult& self) { return copy_of(self.triangulation.hull_offsets); })
      .def_property_readonly("statistics",
                             [](const DeviceResult& self) { return to_dict(self.triangulation.statistics); });
  module.def("triangulate_device", triangulate, py::arg("triangulator"), py::arg("points"), py::arg("parts"),
             py::arg("queue"), py::arg("wait_for"));
}

}  // namespace flaunay::python
