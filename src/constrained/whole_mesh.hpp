// Meshes with constraints, filled up to the convex hull, as locators need them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "flaunay/constrained.hpp"

namespace flaunay::constrained {

/// A mesh up to the convex hull of its points. It begins with the triangles of another mesh, in their order.
struct WholeMesh {
  std::vector<double> coordinates;
  Triangulation mesh;
  /// Three per triangle of the other mesh: whether the edge opposite to the corner is a constraint.
  std::vector<std::uint8_t> constrained;
};

/// Triangulates points with constraints, of one set. The result has neighbours, and the depths of the
/// even-odd rule.
using Constrain =
    std::function<ConstrainedTriangulation(const std::vector<double>& coordinates, const Constraints&)>;

/// Fills the holes of a mesh with constraints, and the area between its border and the convex hull. The mesh
/// has one set of n points, and the points that it added. Throws Error(usage) for several sets and for arrays
/// of wrong lengths, Error(input) if the mesh is no constrained triangulation of these points. If the mesh is
/// convex, O(n); otherwise the points on its border and those in no triangle are triangulated, too.
WholeMesh fill(const double* coordinates, std::size_t n, const ConstrainedTriangulation& mesh,
               const Constrain& constrain);

}  // namespace flaunay::constrained
