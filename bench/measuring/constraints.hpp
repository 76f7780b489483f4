// Points with segments that do not cross, for the subcommands constrained and refinement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/measuring/inputs.hpp"

namespace flaunay::bench {

/// Points and segments, in sets; or polygons with holes, each polygon a set.
struct ConstrainedInput {
  Input points;
  std::vector<std::int32_t> segments;             ///< 2 indices of points per segment, over all sets
  std::vector<std::size_t> segment_offsets;       ///< of the sets
  std::vector<std::size_t> ring_offsets = {};     ///< if all points are on rings of polygons
  std::vector<std::size_t> polygon_offsets = {};  ///< of rings

  std::size_t segment_count() const { return segments.size() / 2; }
  bool has_polygons() const { return !polygon_offsets.empty(); }
};

/// n uniform points, and n / 5 segments that do not cross, up to a few times as long as the distance of
/// neighbours: edges of the triangulation of the points stretched along x.
ConstrainedInput short_segments(std::size_t n);

/// About n points, all of them on the borders of a map: a square of cells, each a polygon of some 400 points,
/// whose borders are rough curves that neighbours share. on_integers: rounded to a grid of 2^26 steps.
ConstrainedInput map_of_cells(std::size_t n, bool on_integers);

/// About n points: islands of 700 points on a rough coast, each with a lake of 300.
ConstrainedInput islands(std::size_t n);

/// Polygons, each a set of its own: a rough ring with a hole, which has 3 of 10 points.
ConstrainedInput polygons_with_holes(std::size_t polygons, std::size_t points);

/// About n points: a ring of waves with nine such holes, whose angles between segments are large.
ConstrainedInput wavy_polygon(std::size_t n);

/// The unit square, as a polygon.
ConstrainedInput square();

}  // namespace flaunay::bench
