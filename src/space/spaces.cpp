// The public calls that triangulate and verify: each hands its points to the calls of their space.
#include "space/spaces.hpp"

#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "space/triangulate.hpp"

namespace flaunay {
namespace {

void check_weights(const Space& space, bool has_weights) {
  call::expect(!has_weights || space.kind != SpaceKind::sphere, "points on the sphere have no weights");
}

// One of wide and narrow is null.
Triangulation checked_call(call::Implementation& self, const double* wide, const float* narrow,
                           const std::vector<std::size_t>& offsets, const Options& options) {
  return call::take_turn(self, [&] {
    return call::triangulate(self, call::checked_points(wide, narrow, offsets), offsets, options);
  });
}

}  // namespace

Triangulation Triangulator::triangulate(const double* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const float* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  return checked_call(*implementation_, coordinates, nullptr, offsets, options);
}

Triangulation Triangulator::triangulate(const float* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  return checked_call(*implementation_, nullptr, coordinates, offsets, options);
}

Triangulation Triangulator::triangulate(const double* points, std::size_t n, const Space& space,
                                        const Options& options) {
  return triangulate(points, std::vector<std::size_t>{0, n}, space, options);
}

Triangulation Triangulator::triangulate(const double* points, const std::vector<std::size_t>& offsets,
                                        const Space& space, const Options& options) {
  call::Implementation& self = *implementation_;
  return call::take_turn(self, [&] {
    check_offsets(offsets);
    check_enumerator(space.kind);
    check_weights(space, space.weights != nullptr);
    const call::HostPoints given{points, nullptr, offsets.back()};
    if (space.kind == SpaceKind::plane && space.weights != nullptr)
      return call::triangulate_with_weights(self, given, space.weights, offsets, options);
    if (space.kind == SpaceKind::plane)
      return call::triangulate(self, call::checked_points(points, nullptr, offsets), offsets, options);
    call::expect(!options.halfedges && !options.areas,
                 "triangulations on a torus, a cylinder or the sphere have neither half-edges nor areas");
    return space.kind == SpaceKind::torus
               ? call::triangulate_on_torus(self, given, space.weights, offsets, space.period)
               : call::triangulate_on_sphere(self, points, offsets, space.coordinates);
  });
}

void Triangulator::triangulate(const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                               const Enqueue& enqueue) {
  call::Implementation& self = *implementation_;
  call::take_turn(self, enqueue, [&] {
    check_enumerator(points.space.kind);
    call::expect(points.space.weights == nullptr, "points in device memory have weights there");
    check_weights(points.space, points.weights != nullptr);
    result.space = points.space;
    result.hidden_count = 0;
    if (points.space.kind == SpaceKind::torus) {
      call::triangulate_on_torus(self, points, result, enqueue);
    } else if (points.space.kind == SpaceKind::sphere) {
      call::triangulate_on_sphere(self, points, result, enqueue);
    } else if (points.weights != nullptr) {
      call::triangulate_with_weights(self, points, result, parts, enqueue);
    } else {
      call::triangulate(self, points, result, parts, enqueue);
    }
  });
}

std::string verify(const double* points, const std::vector<std::size_t>& offsets, const Space& space,
                   const Triangulation& mesh) {
  check_offsets(offsets);
  check_enumerator(space.kind);
  check_weights(space, space.weights != nullptr);
  call::expect(space.kind == mesh.space.kind, "the triangulation is one in another space");
  if (space.kind == SpaceKind::torus) return call::problem_on_torus(points, offsets, space, mesh);
  if (space.kind == SpaceKind::sphere)
    return call::problem_on_sphere(points, offsets, space.coordinates, mesh);
  return space.weights != nullptr ? call::problem_with_weights(points, space.weights, offsets, mesh)
                                  : verify(points, offsets, mesh);
}

ClippedVoronoi Triangulator::clipped_voronoi(const Triangulation& mesh, const double* weights) {
  return call::cells_on_torus(*implementation_, weights, mesh);
}

void call::SpaceLocator::set_coordinates(SphereCoordinates) {
  throw Error(ErrorKind::usage, "queries have coordinates of the sphere on the sphere alone");
}

std::unique_ptr<call::SpaceLocator> call::make_locator_in_space(Triangulator& triangulator,
                                                                const Triangulation& triangulation) {
  expect(triangulation.space.kind != SpaceKind::plane,
         "queries in the plane need the coordinates of the points, too");
  expect(triangulation.hidden.empty(), "points with weights have no such queries on a torus or a cylinder");
  return triangulation.space.kind == SpaceKind::torus ? make_locator_on_torus(triangulator, triangulation)
                                                      : make_locator_on_sphere(triangulator, triangulation);
}

}  // namespace flaunay
