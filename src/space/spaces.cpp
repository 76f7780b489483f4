// The public calls that triangulate and verify: each hands its points to the calls of their space.
#include "space/spaces.hpp"

#include <iterator>

#include "flaunay/sphere.hpp"
#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "space/triangulate.hpp"

namespace flaunay {

const call::SpaceCalls call::kInPlane{
    .triangulate =
        [](call::Implementation& self, const call::HostPoints& points,
           const std::vector<std::size_t>& offsets, const Space&, const Options& options) {
          return call::triangulate(self, call::checked_points(points.wide, nullptr, offsets), offsets,
                                   options);
        },
    .triangulate_on_device = call::triangulate,
    .find_problem = [](const double* points, const std::vector<std::size_t>& offsets, const Space&,
                       const Triangulation& mesh) { return verify(points, offsets, mesh); },
    .cells = call::cells_in_plane,
    .dual = call::dual_in_plane};

const call::SpaceCalls& call::calls_in(SpaceKind kind, bool has_weights) {
  static_assert(std::size(kByKind) == names_of_enumerators<SpaceKind>().size());
  check_enumerator(kind);
  if (kind == SpaceKind::plane && has_weights) return kWithWeights;
  const SpaceCalls& calls = *kByKind[static_cast<std::size_t>(kind)];
  expect(!has_weights || calls.refusal_of_weights == nullptr, calls.refusal_of_weights);
  return calls;
}

bool call::do_arrays_fit(const Triangulation& mesh, std::int32_t least) {
  const std::size_t n = mesh.representatives.size(), triangles = mesh.triangles.size() / 3;
  return mesh.places.size() == 2 * n && mesh.triangles.size() == 3 * triangles &&
         mesh.neighbors.size() == 3 * triangles && !mesh.point_offsets.empty() &&
         are_offsets(mesh.point_offsets, mesh.point_offsets.size() - 1, n) &&
         are_offsets(mesh.triangle_offsets, mesh.point_offsets.size() - 1, triangles) &&
         are_indices(mesh.triangles, n) && are_indices(mesh.neighbors, triangles, least);
}

Triangulation Triangulator::triangulate(const double* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const float* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  return triangulate(coordinates, offsets, Space::plane(), options);
}

Triangulation Triangulator::triangulate(const float* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  call::Implementation& self = *implementation_;
  return call::take_turn(self, [&] {
    return call::triangulate(self, call::checked_points(nullptr, coordinates, offsets), offsets, options);
  });
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
    const call::SpaceCalls& calls = call::calls_in(space.kind, space.weights != nullptr);
    call::expect(space.kind == SpaceKind::plane || (!options.halfedges && !options.areas),
                 "triangulations in other spaces than the plane have neither half-edges nor areas");
    Triangulation mesh = calls.triangulate(self, {points, nullptr, offsets.back()}, offsets, space, options);
    mesh.is_weighted = space.weights != nullptr;
    return mesh;
  });
}

void Triangulator::triangulate(const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                               const Enqueue& enqueue) {
  call::Implementation& self = *implementation_;
  call::take_turn(self, enqueue, [&] {
    const call::SpaceCalls& calls = call::calls_in(points.space.kind, points.weights != nullptr);
    call::expect(points.space.weights == nullptr, "points in device memory have weights there");
    call::reset(points.space, result);
    result.is_weighted = points.weights != nullptr;
    calls.triangulate_on_device(self, points, result, parts, enqueue);
  });
}

std::vector<double> places_of(const double* points, std::size_t n, const Space& space) {
  check_points(points, n);
  const call::SpaceCalls& calls = call::calls_in(space.kind, false);
  if (calls.places == nullptr) return {points, points + 2 * n};
  return calls.places(call::Engine::of_thread().runtime, points, n, space, "point");
}

std::string verify(const double* points, const std::vector<std::size_t>& offsets, const Space& space,
                   const Triangulation& mesh) {
  check_offsets(offsets);
  const call::SpaceCalls& calls = call::calls_in(space.kind, space.weights != nullptr);
  call::expect(space.kind == mesh.space.kind, "the triangulation is one in another space");
  call::expect(space.weights != nullptr || !call::has_weights(mesh),
               "the triangulation is one of points with weights, which are needed");
  return calls.find_problem(points, offsets, space, mesh);
}

}  // namespace flaunay
