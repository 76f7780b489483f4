// Triangulations, proofs and queries in other spaces than the plane, and of points with weights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "call/frame.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::call {

/// The arrays of triangulations in device memory in another space than the plane.
constexpr Parts kPartsInSpace{true, true, false, false, true, false};

/// Counts the points and triangles of a result, and not those in the plane.
template <typename Result>
void write_counts(std::size_t duplicates, Result& result) {
  Statistics& statistics = result.statistics;
  statistics.points = result.point_offsets.back();
  statistics.duplicates = duplicates;
  statistics.triangles = result.triangle_offsets.back();
  statistics.hull_vertices = 0;
}

// It is the triangulator's turn, and offsets have been checked.
// weights: null if points have none.
Triangulation triangulate_on_torus(Implementation& self, const HostPoints& points, const double* weights,
                                   const std::vector<std::size_t>& offsets, const Period& period);
void triangulate_on_torus(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                          const Enqueue& enqueue);
Triangulation triangulate_on_sphere(Implementation& self, const double* points,
                                    const std::vector<std::size_t>& offsets, SphereCoordinates coordinates);
void triangulate_on_sphere(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                           const Enqueue& enqueue);
Triangulation triangulate_with_weights(Implementation& self, const HostPoints& points, const double* weights,
                                       const std::vector<std::size_t>& offsets, const Options& options);
void triangulate_with_weights(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                              const Parts& parts, const Enqueue& enqueue);

/// See Triangulator::clipped_voronoi. Takes a turn.
ClippedVoronoi cells_on_torus(Implementation& self, const double* weights, const Triangulation& mesh);

// See verify. Offsets have been checked.
std::string problem_on_torus(const double* points, const std::vector<std::size_t>& offsets,
                             const Space& space, const Triangulation& mesh);
std::string problem_on_sphere(const double* points, const std::vector<std::size_t>& offsets,
                              SphereCoordinates coordinates, const Triangulation& mesh);
std::string problem_with_weights(const double* points, const double* weights,
                                 const std::vector<std::size_t>& offsets, const Triangulation& mesh);

/// Answers queries on one set of points in a space that is not the plane; see Locator. Each query is a turn
/// of the triangulator.
class SpaceLocator {
 public:
  virtual ~SpaceLocator() = default;
  virtual void set_coordinates(SphereCoordinates coordinates);
  virtual std::vector<std::int32_t> locate(const double* queries, std::size_t m) = 0;
  virtual std::vector<std::int32_t> nearest(const double* queries, std::size_t m) = 0;
  virtual std::vector<double> interpolate(const double* values, const double* queries, std::size_t m,
                                          const InterpolationOptions& options) = 0;
};

/// Makes a locator in the space of a triangulation. Throws Error(usage) for the plane and for several sets.
std::unique_ptr<SpaceLocator> make_locator_in_space(Triangulator& triangulator,
                                                    const Triangulation& triangulation);
std::unique_ptr<SpaceLocator> make_locator_on_torus(Triangulator& triangulator,
                                                    const Triangulation& triangulation);
std::unique_ptr<SpaceLocator> make_locator_on_sphere(Triangulator& triangulator,
                                                     const Triangulation& triangulation);

}  // namespace flaunay::call
