// Which polygons of a map the regions of a triangulation are in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/constrained.hpp"

namespace flaunay::constrained {

/// Labels of regions.
struct MapLabels {
  std::vector<std::int32_t> polygons;  ///< the smallest polygon that it is in, or -1
  std::vector<std::int32_t> depths;    ///< the number of polygons that it is in
};

/// Goes through all regions from outside, each time over one edge, whose segments lead into polygons or out
/// of them. mesh: of one set, complete. regions: by triangle; count: their number. segments: 2 points per
/// segment; polygons: the polygon of each segment, whose segments are closed curves. Throws Error(input) for
/// the first region in several polygons if that is an error. coordinates: of all points. O(n +
/// log p) per segment on an edge over which it goes, where p polygons are around; usually there is one such
/// edge per segment at most.
MapLabels label_map(const double* coordinates, const ConstrainedTriangulation& mesh,
                    const std::vector<std::int32_t>& regions, std::size_t count,
                    const std::vector<std::int32_t>& segments, const std::vector<std::int32_t>& polygons,
                    FillRule rule, Overlaps overlaps);

}  // namespace flaunay::constrained
