// Triangulations of points in host memory, the modes, and tables made from the triangles.
#include <algorithm>

#include "bindings.hpp"
#include "call/result_arrays.hpp"
#include "flaunay/research.hpp"

namespace flaunay::python {
namespace {

const research::ModeInfo& find_mode(const std::string& name) {
  std::string names;
  for (const research::ModeInfo& mode : research::list_modes()) {
    if (name == mode.name) return mode;
    names += std::string(names.empty() ? "" : ", ") + mode.name;
  }
  throw Error(ErrorKind::usage, "there is no mode '" + name + "'; there are " + names);
}

py::list modes() {
  py::list result;
  for (const research::ModeInfo& mode : research::list_modes()) {
    py::dict row;
    row["name"] = mode.name;
    row["description"] = mode.description;
    row["on_host"] = mode.on_host;
    result.append(row);
  }
  return result;
}

// wanted: the names of the optional arrays to compute.
research::Options make_options(const std::string& mode, const Names& wanted) {
  research::Options options;
  options.mode = find_mode(mode).mode;
  for (const call::ResultArray& array : call::kResultArrays) {
    if (array.option != nullptr) options.*array.option = wanted.count(array.name) > 0;
  }
  return options;
}

py::dict arrays_of(Triangulation&& triangulation, const Options& options) {
  py::dict result;
  for (const call::ResultArray& array : call::kResultArrays) {
    if (array.option != nullptr && !(options.*array.option)) {
      result[array.name] = py::none();
      continue;
    }
    std::vector<std::int32_t>& values = triangulation.*array.values;
    const std::size_t columns = call::columns(array.row);
    result[array.name] = columns == 1 ? to_array(std::move(values)) : to_rows(std::move(values), columns);
  }
  result["triangle_offsets"] = to_offsets(std::move(triangulation.triangle_offsets));
  result["hull_offsets"] = to_offsets(std::move(triangulation.hull_offsets));
  result["statistics"] = to_dict(triangulation.statistics);
  return result;
}

template <typename Points>
py::dict triangulate(SharedTriangulator& shared, const Points& points, const std::optional<Offsets>& segments,
                     const std::string& mode, const Names& wanted) {
  const research::Options options = make_options(mode, wanted);
  const auto* const coordinates = points.data();
  const std::vector<std::size_t> offsets = to_offsets(segments, count_points(points));
  return arrays_of(shared.run([&](Triangulator& triangulator) {
    return research::triangulate(triangulator, coordinates, offsets, options);
  }),
                   options);
}

py::dict triangulate_without_device(const Points64& points, const std::optional<Offsets>& segments,
                                    const std::string& mode, const Names& wanted) {
  const research::Options options = make_options(mode, wanted);
  const double* const coordinates = points.data();
  const std::vector<std::size_t> offsets = to_offsets(segments, count_points(points));
  Triangulation triangulation = [&] {
    const py::gil_scoped_release release;
    return research::triangulate_on_host(coordinates, offsets, options);
  }();
  return arrays_of(std::move(triangulation), options);
}

std::vector<std::int32_t> corners_of(const Indices& triangles) {
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) {
    throw Error(ErrorKind::usage, "simplices must have the shape (nsimplex, 3)");
  }
  return copy_of(triangles);
}

// For each point its neighbours in the mesh, in increasing order: those of point i are
// indices[starts[i]] to indices[starts[i + 1]].
py::tuple vertex_neighbors(const Indices& triangles, const Indices& hull, std::size_t n) {
  const std::vector<std::int32_t> corners = corners_of(triangles), ring = copy_of(hull);
  std::vector<std::int32_t> starts, neighbors;
  {
    const py::gil_scoped_release release;
    check_indices(corners, 0, n, "simplices", "points");
    check_indices(ring, 0, n, "hull", "points");
    const std::size_t corner_count = corners.size();
    const std::size_t ring_size = corner_count == 0 ? 0 : ring.size();
    starts.resize(n + 1);
    neighbors.resize(corner_count + ring_size);
    // Each edge from each of its ends: a triangle has its edges one way round, and what has no triangle
    // beyond is on the hull.
    const auto for_each_edge = [&](const auto& visit) {
      for (std::size_t t = 0; t < corner_count; t += 3) {
        for (std::size_t k = 0; k < 3; ++k) visit(corners[t + k], corners[t + (k + 1) % 3]);
      }
      for (std::size_t i = 0; i < ring_size; ++i) visit(ring[(i + 1) % ring_size], ring[i]);
    };
    for_each_edge([&](std::int32_t from, std::int32_t) { ++starts[from + 1]; });
    for (std::size_t i = 0; i < n; ++i) starts[i + 1] += starts[i];
    std::vector<std::int32_t> next(starts.begin(), starts.end() - 1);
    for_each_edge([&](std::int32_t from, std::int32_t to) { neighbors[next[from]++] = to; });
    for (std::size_t i = 0; i < n; ++i) {
      std::sort(neighbors.begin() + starts[i], neighbors.begin() + starts[i + 1]);
    }
  }
  return py::make_tuple(to_array(std::move(starts)), to_array(std::move(neighbors)));
}

// For each point the first triangle that has it, -1 where there is none.
py::array_t<std::int32_t> first_triangles(const Indices& triangles, std::size_t n) {
  const std::vector<std::int32_t> corners = corners_of(triangles);
  std::vector<std::int32_t> first(n, -1);
  {
    const py::gil_scoped_release release;
    check_indices(corners, 0, n, "simplices", "points");
    for (std::size_t i = corners.size(); i-- > 0;) first[corners[i]] = static_cast<std::int32_t>(i / 3);
  }
  return to_array(std::move(first));
}

}  // namespace

void bind_host(py::module_& module) {
  py::class_<SharedTriangulator, std::shared_ptr<SharedTriangulator>>(module, "Triangulator")
      .def(py::init<const std::string&>(), py::arg("device"), py::call_guard<py::gil_scoped_release>())
      .def_static(
          "from_handles",
          [](std::uintptr_t context, std::uintptr_t device) {
            const py::gil_scoped_release release;
            return std::make_shared<SharedTriangulator>(reinterpret_cast<cl_context>(context),
                                                        reinterpret_cast<cl_device_id>(device));
          },
          py::arg("context"), py::arg("device"))
      .def_property_readonly("context", &SharedTriangulator::context)
      .def_property_readonly("device", &SharedTriangulator::device)
      .def_property_readonly("queue", &SharedTriangulator::queue)
      .def("capacity",
           [](SharedTriangulator& shared) {
             return shared.run([](Triangulator& triangulator) { return triangulator.capacity(); });
           })
      .def("triangulate", &triangulate<Points64>, py::arg("points").noconvert(), py::arg("segments"),
           py::arg("mode"), py::arg("wanted"))
      .def("triangulate", &triangulate<Points32>, py::arg("points").noconvert(), py::arg("segments"),
           py::arg("mode"), py::arg("wanted"));
  module.def("modes", modes);
  module.def("triangulate_without_device", triangulate_without_device, py::arg("points").noconvert(),
             py::arg("segments"), py::arg("mode"), py::arg("wanted"));
  module.def("vertex_neighbors", vertex_neighbors, py::arg("triangles"), py::arg("hull"), py::arg("n"));
  module.def("first_triangles", first_triangles, py::arg("triangles"), py::arg("n"));
}

}  // namespace flaunay::python
