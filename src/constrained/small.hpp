// Segments and domains of small sets on the calling thread, one after the other: the rings of mode blocks are
// changed before triangles are written, where insertion and domains make passes over arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "constrained/domains/domain.hpp"
#include "constrained/domains/map.hpp"
#include "flaunay/constrained.hpp"
#include "points/rings.hpp"

namespace flaunay::constrained {

/// The options of a call for small sets.
struct SmallRequest {
  DepthRules rules{};
  bool has_depths = false;  ///< whether regions have depths, by which they are left or not
  bool labels = false;      ///< whether to write depths and regions
  bool neighbors = false;   ///< whether to write neighbours
  /// How many steps there may be per point and segment: edges that are crossed, and vertices beside them, as
  /// often as each is looked at.
  std::size_t most_steps = 0;
  /// The curves that bound polygons, if depths are numbers of those.
  const Curves* curves = nullptr;
  /// x and y of the points of the one set, whose holes are left out. No products of them and the holes
  /// overflow.
  const double* with_holes = nullptr;
};

/// Makes segments edges of the rings, and writes the kept part of the triangulation and the arrays of
/// constraints, each segment as one piece: the same bytes as constrain, find_depths and label_map. result: as
/// written by blocks::small_rings. Returns false, with the rings and the result half changed, if segments are
/// wrong, cross, are no closed curves, or take too many steps, or if a hole may be on an edge or outside. O(n
/// + m) as a rule for m segments; a segment takes O(the smaller of the numbers of edges of its ends), a hole
/// O(n).
bool constrain_small(const points::SmallRings& rings, const std::vector<std::size_t>& offsets,
                     const Constraints& constraints, const SmallRequest& request,
                     ConstrainedTriangulation& result);

}  // namespace flaunay::constrained
