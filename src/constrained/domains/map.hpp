// Which polygons of a map the regions of a triangulation are in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "flaunay/constrained.hpp"

namespace flaunay::constrained {

/// Labels of regions.
struct MapLabels {
  std::vector<std::int32_t> polygons;  ///< the smallest polygon that it is in, or -1
  std::vector<std::int32_t> depths;    ///< the number of polygons that it is in
};

/// Closed curves and the parts that they bound: a part of a polygon is the area inside of one of its borders
/// and outside of all its holes.
struct Curves {
  std::vector<std::int32_t> of_segments;  ///< by segment; segments after the last one bound nothing
  std::vector<std::int32_t> parts;        ///< by curve: the part that it bounds
  std::vector<char> are_holes;            ///< by curve
  std::vector<std::int32_t> polygons;     ///< by part
};
/// Throws Error(usage) if offsets do not fit each other or the number of segments, or if the rule is nesting.
void check_rings(const Rings& rings, std::size_t segments, FillRule rule);
/// A curve for each ring.
Curves curves_of(const Rings& rings);
/// The curves of the segments [first, end). Curves must be in the order of their segments.
Curves part_of(const Curves& curves, std::size_t first, std::size_t end);
/// For each polygon one curve that has all of its segments. offsets: of polygons.
Curves curves_of_polygons(const std::vector<std::size_t>& offsets);

/// How often segments of a curve are crossed from right to left, minus crossings from left to right.
struct Step {
  std::int32_t curve, amount;
};
/// Regions that are entered one after the other, each from another one or from outside, over one edge.
struct Entrances {
  std::vector<std::int32_t> from;     ///< by region: the one it is entered from; -1: the outside
  std::vector<std::int32_t> order;    ///< all regions, each after the one it is entered from
  std::vector<std::int32_t> offsets;  ///< region r is entered by the steps [offsets[r], offsets[r + 1])
  std::vector<Step> steps{};
};
/// Adds steps, each with the region that it leads into.
void group_steps(const std::vector<std::pair<std::int32_t, Step>>& all, Entrances& into);
/// The first region in several polygons, or the number of regions, and two of these polygons.
struct Overlap {
  std::int32_t region = 0;
  std::pair<std::int32_t, std::int32_t> polygons{};
};
/// Goes through the regions, and labels each by the polygons around it. rule: of the inside of a curve.
MapLabels label_regions(const Entrances& into, const Curves& curves, FillRule rule, Overlap& overlap);

/// Goes through all regions from outside, each time over one edge, whose segments lead into polygons or out
/// of them. mesh: complete. regions: by triangle; count: their number. segments: 2 points per segment. rule:
/// of the inside of a curve. Throws Error(input) for the first region in several polygons if that is an
/// error. coordinates: of all points. O(n + log p) per segment on an edge over which it goes, where p
/// polygons are around; usually there is one such edge per segment at most.
MapLabels label_map(const double* coordinates, const ConstrainedTriangulation& mesh,
                    const std::vector<std::int32_t>& regions, std::size_t count, const std::int32_t* segments,
                    const Curves& curves, FillRule rule, Overlaps overlaps);

}  // namespace flaunay::constrained
