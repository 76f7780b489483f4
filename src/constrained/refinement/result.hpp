// Between the result of a call and the mesh that is refined: the arrays of triangles move there and back,
// edges that must stay are numbered, and parts of split edges get the properties of the whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/refinement/refine.hpp"

namespace flaunay::constrained {

/// The constraint edges and borders that the triangles of a result have. They are numbered anew.
struct FixedEdges {
  std::vector<std::int32_t> of_corners;      ///< as in MeshToRefine
  std::vector<std::int32_t> ends;            ///< 2 per edge; of constraint edges in their order
  std::vector<std::uint8_t> is_border;       ///< per edge
  std::vector<std::int32_t> of_constraints;  ///< per constraint edge: its number here, or -1
  std::vector<std::int32_t> of_hull;  ///< per hull vertex: the number of the edge to the next one, or -1
};

/// Where the triangles and added points of each set begin after refinement, and the end.
struct RefinedOffsets {
  std::vector<std::size_t> triangles{0}, added{0};
};

/// Takes the triangles of a result, which must have neighbours. coordinates: of this many points, including
/// points that splitting added; seeds: per triangle the seed of its region, or -1, or empty; areas: per
/// triangle its largest area, 0 for any, or empty. edges: set to the edges of the mesh. O(t).
MeshToRefine take_mesh(host::Runtime& threads, const double* coordinates, std::size_t points,
                       const Refinement& wanted, const std::vector<std::int32_t>& seeds,
                       const std::vector<double>& areas, ConstrainedTriangulation& result, FixedEdges& edges);

/// Estimates how many points some triangles will have after refinement. The estimate only decides where the
/// work is done, and only matters if it is far larger than the present number.
std::size_t expected_points(const MeshToRefine& mesh, std::size_t first, std::size_t end);

/// Writes the refined mesh to the result from which its mesh was taken: all arrays but half-edges, areas and
/// markers. n: the number of points of the caller. O(t).
void write_mesh(host::Runtime& threads, const FixedEdges& edges, std::size_t n, const RefinedOffsets& sets,
                RefinedMesh& mesh, ConstrainedTriangulation& result);

/// Reports the angles of a result. coordinates: of the n points of the caller. with_mean: also their mean.
void measure_angles(host::Runtime& threads, const double* coordinates, std::size_t n, bool with_mean,
                    ConstrainedTriangulation& result);

}  // namespace flaunay::constrained
