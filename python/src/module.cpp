// The extension module flaunay._flaunay: thin; what users see is the Python around it.
#include "bindings.hpp"

namespace flaunay::python {
namespace {

const char* class_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return "UsageError";
    case ErrorKind::input:
      return "InputError";
    case ErrorKind::device:
      return "DeviceError";
    case ErrorKind::internal:
      return "InternalError";
  }
  return "Error";
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const py::object type = py::module_::import("flaunay._errors").attr(class_of(error.kind()));
    const py::object exception = type(error.what(), error.code(), error.call());
    PyErr_SetObject(type.ptr(), exception.ptr());
  }
}

py::dict to_dict(const DeviceInfo& info) {
  py::dict result;
  result["name"] = info.name;
  result["platform"] = info.platform;
  result["vendor"] = info.vendor;
  result["driver"] = info.driver;
  result["version"] = info.version;
  result["type"] = info.type;
  result["compute_units"] = info.compute_units;
  result["clock_mhz"] = info.clock_mhz;
  result["memory_bytes"] = info.memory_bytes;
  result["available_bytes"] = info.available_bytes;
  result["largest_buffer_bytes"] = info.largest_buffer_bytes;
  result["local_memory_bytes"] = info.local_memory_bytes;
  result["work_group_size"] = info.work_group_size;
  result["fp64"] = info.fp64;
  return result;
}

py::list devices() {
  const std::vector<DeviceInfo> found = [] {
    const py::gil_scoped_release release;
    return list_devices();
  }();
  py::list result;
  for (const DeviceInfo& info : found) result.append(to_dict(info));
  return result;
}

}  // namespace

SharedTriangulator::SharedTriangulator(const std::string& device) : triangulator_(std::in_place, device) {}
SharedTriangulator::SharedTriangulator(cl_context context, cl_device_id device)
    : triangulator_(std::in_place, context, device) {}
SharedTriangulator::~SharedTriangulator() {
  const py::gil_scoped_release release;
  triangulator_.reset();
}

std::vector<std::size_t> to_offsets(const std::optional<Offsets>& offsets, std::size_t n) {
  if (!offsets) return {0, n};
  std::vector<std::size_t> result(static_cast<std::size_t>(offsets->size()));
  for (std::size_t s = 0; s < result.size(); ++s) {
    const std::int64_t offset = offsets->data()[s];
    if (offset < 0) throw Error(ErrorKind::usage, "segments must begin with 0 and not decrease");
    result[s] = static_cast<std::size_t>(offset);
  }
  if (result.empty()) throw Error(ErrorKind::usage, "segments need one offset at least, 0");
  if (result.back() != n) {
    throw Error(ErrorKind::usage, "segments end with " + std::to_string(result.back()) + ", but there are " +
                                      std::to_string(n) + " points");
  }
  return result;
}

std::size_t count_points(const py::array& points) {
  if (points.ndim() != 2 || points.shape(1) != 2) {
    throw Error(ErrorKind::usage, "points must be an array of shape (n, 2)");
  }
  return static_cast<std::size_t>(points.shape(0));
}

std::vector<std::int32_t> copy_of(const Indices& array) {
  return {array.data(), array.data() + array.size()};
}

void check_indices(const std::vector<std::int32_t>& indices, std::int32_t lowest, std::size_t n,
                   const char* name, const char* what) {
  for (const std::int32_t index : indices) {
    if (index < lowest || index >= static_cast<std::int64_t>(n)) {
      throw Error(ErrorKind::usage, std::string(name) + " were changed: " + std::to_string(index) +
                                        " is none of the " + std::to_string(n) + " " + what);
    }
  }
}

py::dict phases_to_dict(const std::vector<PhaseStatistics>& phases) {
  py::dict result;
  for (const PhaseStatistics& phase : phases) result[py::str(phase.name)] = phase.seconds;
  return result;
}

py::dict to_dict(const Statistics& statistics) {
  py::dict result;
  result["device"] = statistics.device;
  result["points"] = statistics.points;
  result["duplicates"] = statistics.duplicates;
  result["triangles"] = statistics.triangles;
  result["hull_vertices"] = statistics.hull_vertices;
  result["seconds"] = statistics.seconds;
  result["build_seconds"] = statistics.build_seconds;
  result["kernel_launches"] = statistics.kernel_launches;
  result["host_waits"] = statistics.host_waits;
  result["bytes_to_device"] = statistics.bytes_to_device;
  result["bytes_to_host"] = statistics.bytes_to_host;
  result["device_allocations"] = statistics.device_allocations;
  result["device_bytes_peak"] = statistics.device_bytes_peak;
  result["undecided"] = statistics.undecided;
  result["rounds"] = statistics.rounds;
  result["round_points"] = statistics.round_points;
  result["merged_points"] = statistics.merged_points;
  result["phases"] = phases_to_dict(statistics.phases);
  return result;
}

}  // namespace flaunay::python

PYBIND11_MODULE(_flaunay, module) {
  using namespace flaunay::python;
  py::register_local_exception_translator(translate);
  module.attr("__version__") = flaunay::version();
  module.def("devices", devices);
  bind_host(module);
  bind_device(module);
  bind_queries(module);
  bind_chunks(module);
}
