// Voronoi diagrams of triangulations in host memory, and queries on them.
#include <optional>

#include "bindings.hpp"

namespace flaunay::python {
namespace {

Triangulation to_triangulation(std::size_t n, const Indices& triangles, const Indices& neighbors,
                               const Indices& hull, const Indices& representatives) {
  Triangulation result;
  result.triangles = copy_of(triangles);
  result.neighbors = copy_of(neighbors);
  result.hull = copy_of(hull);
  result.representatives = copy_of(representatives);
  result.triangle_offsets = {0, result.triangles.size() / 3};
  result.hull_offsets = {0, result.hull.size()};
  const py::gil_scoped_release release;
  check_indices(result.triangles, 0, n, "simplices", "points");
  check_indices(result.neighbors, -1, result.triangles.size() / 3, "neighbors", "simplices");
  check_indices(result.hull, 0, n, "hull", "points");
  check_indices(result.representatives, 0, n, "representatives", "points");
  return result;
}

py::tuple voronoi(SharedTriangulator& shared, const Points64& points, const Indices& triangles,
                  const Indices& neighbors, const Indices& hull, const Indices& representatives) {
  const std::size_t n = count_points(points);
  const double* const coordinates = points.data();
  const Triangulation triangulation = to_triangulation(n, triangles, neighbors, hull, representatives);
  Voronoi result = shared.run(
      [&](Triangulator& triangulator) { return triangulator.voronoi(coordinates, n, triangulation); });
  return py::make_tuple(to_rows(std::move(result.circumcentres), 2), to_array(std::move(result.cell_offsets)),
                        to_array(std::move(result.cells)), to_array(std::move(result.unbounded)));
}

/// A locator, which works in the turns of its triangulator.
class SharedLocator {
  template <typename Ask>
  auto answers(const Points64& queries, const Ask& ask) {
    const std::size_t m = count_points(queries);
    const double* const at = queries.data();
    return to_array(shared_->run([&](Triangulator&) { return ask(at, m); }));
  }

 public:
  SharedLocator(std::shared_ptr<SharedTriangulator> shared, const Points64& points, const Indices& triangles,
                const Indices& neighbors, const Indices& hull, const Indices& representatives)
      : shared_(std::move(shared)), point_count_(count_points(points)) {
    const std::size_t n = point_count_;
    const double* const coordinates = points.data();
    const Triangulation triangulation = to_triangulation(n, triangles, neighbors, hull, representatives);
    shared_->run(
        [&](Triangulator& triangulator) { locator_.emplace(triangulator, coordinates, n, triangulation); });
  }
  ~SharedLocator() {
    shared_->run([&](Triangulator&) { locator_.reset(); });
  }
  SharedLocator(const SharedLocator&) = delete;
  SharedLocator& operator=(const SharedLocator&) = delete;

  py::array_t<std::int32_t> locate(const Points64& queries) {
    return answers(queries, [&](const double* at, std::size_t m) { return locator_->locate(at, m); });
  }

  py::array_t<std::int32_t> nearest(const Points64& queries) {
    return answers(queries, [&](const double* at, std::size_t m) { return locator_->nearest(at, m); });
  }

  /// values: one for each point.
  py::array_t<double> interpolate(const Points64& values, const Points64& queries) {
    if (static_cast<std::size_t>(values.size()) != point_count_) {
      throw Error(ErrorKind::usage, "points were changed: there are " + std::to_string(values.size()) +
                                        " values for the " + std::to_string(point_count_) +
                                        " of the triangulation");
    }
    const double* const given = values.data();
    return answers(queries,
                   [&](const double* at, std::size_t m) { return locator_->interpolate(given, at, m); });
  }

 private:
  std::shared_ptr<SharedTriangulator> shared_;
  std::size_t point_count_;
  std::optional<Locator> locator_;
};

}  // namespace

void bind_queries(py::module_& module) {
  py::class_<SharedLocator>(module, "Locator")
      .def(py::init<std::shared_ptr<SharedTriangulator>, const Points64&, const Indices&, const Indices&,
                    const Indices&, const Indices&>(),
           py::arg("triangulator"), py::arg("points").noconvert(), py::arg("triangles"), py::arg("neighbors"),
           py::arg("hull"), py::arg("representatives"))
      .def("locate", &SharedLocator::locate, py::arg("queries").noconvert())
      .def("nearest", &SharedLocator::nearest, py::arg("queries").noconvert())
      .def("interpolate", &SharedLocator::interpolate, py::arg("values").noconvert(),
           py::arg("queries").noconvert());
  module.def("voronoi", voronoi, py::arg("triangulator"), py::arg("points").noconvert(), py::arg("triangles"),
             py::arg("neighbors"), py::arg("hull"), py::arg("representatives"));
}

}  // namespace flaunay::python
