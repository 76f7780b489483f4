// What public calls ask a kind of space, for points with weights or without.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "call/frame.hpp"
#include "derived/nearest/point_tree.hpp"
#include "derived/voronoi/clip_polygon.hpp"
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

/// A mesh whose cells are computed, and in the plane its points and the polygon to which cells are clipped.
struct CellInput {
  HostPoints points;
  Space space;
  const Triangulation& mesh;
  voronoi::ClipPolygon polygon;
};

/// The functions of public calls in a kind of space. It is the triangulator's turn; offsets have been
/// checked. What a space does not have is null; all can triangulate and verify.
struct SpaceCalls {
  const char* refusal_of_weights = nullptr;   ///< what a call with weights says, if points have none
  const char* refusal_of_polygons = nullptr;  ///< what a call with a polygon says, if cells have none
  Triangulation (*triangulate)(Implementation& self, const HostPoints& points,
                               const std::vector<std::size_t>& offsets, const Space& space,
                               const Options& options);
  void (*triangulate_on_device)(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                                const Parts& parts, const Enqueue& enqueue);
  /// See verify.
  std::string (*find_problem)(const double* points, const std::vector<std::size_t>& offsets,
                              const Space& space, const Triangulation& mesh);
  /// How many numbers a point has.
  std::size_t (*width)(const Space& space) = [](const Space&) -> std::size_t { return 2; };
  /// x and y per point; see Triangulation::places. what: the name of a point. Null: points are places.
  std::vector<double> (*places)(host::Runtime& runtime, const double* points, std::size_t n,
                                const Space& space, const char* what) = nullptr;
  bool returns_places = false;  ///< relaxed points are returned as places
  /// Throws Error(usage) for a space whose cells have no end. Null: all have.
  void (*check_cells)(const Space& space) = nullptr;
  ClippedVoronoi (*cells)(Implementation& self, const CellInput& input) = nullptr;
  Voronoi (*dual)(Implementation& self, const CellInput& input) = nullptr;
  /// Per point the centroid of its cell, as points are given; NaN if it has none. Null: as `cells` says.
  std::vector<double> (*centroids)(Implementation& self, const CellInput& input) = nullptr;
  std::unique_ptr<nearest::Tree> (*tree)(Triangulator& triangulator, const Triangulation& mesh) = nullptr;
};
extern const SpaceCalls kInPlane, kWithWeights, kOnTorus, kOnSphere;  // with weights: in the plane
constexpr const SpaceCalls* kByKind[] = {&kInPlane, &kOnTorus, &kOnSphere};
/// The cells of points without weights in the plane, and their dual.
ClippedVoronoi cells_in_plane(Implementation& self, const CellInput& input);
Voronoi dual_in_plane(Implementation& self, const CellInput& input);

/// Throws Error(usage) for a number that is no kind, and for weights in a space without.
const SpaceCalls& calls_in(SpaceKind kind, bool has_weights);

/// Whether the arrays that triangulations in all spaces but the plane have fit each other. Neighbours are not
/// below `least`.
bool do_arrays_fit(const Triangulation& mesh, std::int32_t least);
/// Throws Error(usage) for arrays that are not those of a triangulation of these points with weights.
void check_with_hidden(const double* points, const std::vector<std::size_t>& offsets,
                       const Triangulation& mesh);

}  // namespace flaunay::call
