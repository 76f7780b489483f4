// Types for triangulations in which given segments are edges. docs/constrained.md defines the results.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/refinement.hpp"

namespace flaunay {

/// What becomes of two segments that cross where no point is.
enum class Crossings {
  error,  ///< Error(input), which names both segments and the place
  split,  ///< both are split there; the place is rounded and becomes a point of its own
};

/// Which triangles a result has.
enum class Outside {
  keep,   ///< all, up to the convex hull
  hull,   ///< without those outside: of depth 0
  holes,  ///< without those outside and those in holes
};

/// How it is decided what is outside and what is a hole. A path from beyond the hull to a triangle, through
/// no point, crosses segments. Where segments lie on each other, each counts.
enum class FillRule {
  /// The depth of a triangle is the least number of constraint edges that such a path crosses. Holes have an
  /// even depth. This is defined for any segments; those that end without closing a curve do not count.
  nesting,
  /// The depth is 1 if the path crosses an odd number of segments, otherwise 0. Segments must form closed
  /// curves: an even number ends at each point.
  even_odd,
  /// The depth is the winding number of the directed segments: those that the path crosses from their right
  /// to their left, less those from left to right. Only a depth of 0 is outside, and there are no other
  /// holes. Segments must form closed curves: as many begin as end at each point.
  winding,
};

/// Which segments are the borders and the holes of polygons.
struct Rings {
  /// rings + 1 values: ring r has segments [segment_offsets[r], segment_offsets[r + 1]), which are a closed
  /// curve of any direction. Segments after the last ring bound nothing.
  std::vector<std::size_t> segment_offsets;
  /// parts + 1 values: part q has rings [part_offsets[q], part_offsets[q + 1]). The first one is its border,
  /// the others are its holes.
  std::vector<std::size_t> part_offsets;
  /// polygons + 1 values: polygon p has rings [polygon_offsets[p], polygon_offsets[p + 1]), those of its
  /// parts.
  std::vector<std::size_t> polygon_offsets;
};

/// Segments that are to be edges, what is to be left out, and what is known of segments, points and regions.
/// The arrays belong to the caller.
struct Constraints {
  const std::int32_t* segments = nullptr;  ///< 2 indices of points of the same set per segment
  std::size_t segment_count = 0;           ///< number of segments
  /// x and y per hole: what is connected to this place without crossing a constraint is left out, whatever
  /// ConstrainedOptions::outside says.
  const double* holes = nullptr;
  std::size_t hole_count = 0;  ///< number of holes
  /// sets + 1 values: set s has holes [hole_offsets[s], hole_offsets[s + 1]). May be empty if there is one
  /// set.
  std::vector<std::size_t> hole_offsets;
  /// Unless segment_offsets is empty, the fill rule, which must not be nesting, decides for each ring alone
  /// what is inside of it. A part is what is inside of its border and of none of its holes, and a polygon is
  /// all of its parts. The depth is the number of polygons that a triangle is in.
  Rings rings;
  /// One per segment, or null. If there are some, ConstrainedTriangulation::edge_markers are computed.
  const std::int32_t* segment_markers = nullptr;
  /// One per point, or null. If there are some, ConstrainedTriangulation::vertex_markers are computed.
  const std::int32_t* point_markers = nullptr;
  /// x and y per seed: the region that this place is in has an attribute. If there are some,
  /// ConstrainedTriangulation::triangle_attributes are computed. As for holes, it is an error if a place is
  /// on a constraint, or in no triangle of the convex hull.
  const double* seeds = nullptr;
  const double* seed_attributes = nullptr;  ///< one per seed; may be null if there are seed_areas
  std::size_t seed_count = 0;               ///< number of seeds
  /// sets + 1 values: set s has seeds [seed_offsets[s], seed_offsets[s + 1]). May be empty if there is one
  /// set.
  std::vector<std::size_t> seed_offsets;
};

/// The options of one constrained triangulation.
struct ConstrainedOptions : Options {
  Crossings crossings = Crossings::error;  ///< what becomes of segments that cross
  Outside outside = Outside::keep;         ///< which triangles the result has
  FillRule fill_rule = FillRule::nesting;  ///< what is outside, and what is a hole
  bool labels = false;                     ///< compute ConstrainedTriangulation::depths and regions
  Refinement refinement;                   ///< what the triangles that are left are refined to
};

/// What becomes of places that are in several polygons of a map.
enum class Overlaps {
  first,  ///< they belong to the polygon with the smallest index
  error,  ///< Error(input), which names a triangle and two of its polygons
};

/// Polygons with holes, as rings with offsets, in the layout of GeoArrow. A ring may repeat its first point
/// at its end, and may have any orientation. Rings without area, such as those of fewer than 3 points, have
/// no triangles. A polygon may have several outer rings, or several parts.
struct Polygons {
  const double* coordinates = nullptr;  ///< x and y per point; the array belongs to the caller
  /// rings + 1 values: ring r has points [ring_offsets[r], ring_offsets[r + 1]). It has a segment from each
  /// of its points to the next one, and from the last one to the first. Segment i begins at point i.
  std::vector<std::size_t> ring_offsets;
  /// polygons + 1 values: polygon p has rings [polygon_offsets[p], polygon_offsets[p + 1]).
  std::vector<std::size_t> polygon_offsets;
  /// If it is known which rings are holes: parts + 1 values. Part q has rings
  /// [part_offsets[q], part_offsets[q + 1]), the first one its border, the others its holes; each polygon
  /// begins with a part. Then insides are those of Constraints::rings, and depths are numbers of polygons,
  /// unless the fill rule is nesting. If it is empty, the fill rule counts all rings of a polygon alike.
  std::vector<std::size_t> part_offsets = {};
};

/// The options of a triangulation of polygons. Unlike for segments, only what is inside is kept, and insides
/// are those of the even-odd rule, unless these options say otherwise.
struct PolygonOptions : ConstrainedOptions {
  /// Triangles that are inside by the even-odd rule are kept.
  PolygonOptions() {
    outside = Outside::holes;
    fill_rule = FillRule::even_odd;
  }
  /// Makes one map of all polygons: a single set, in which polygons share the edges of common borders.
  /// ConstrainedTriangulation::polygons says which triangle is in which polygon. The fill rule decides for
  /// each polygon what is inside of it, and must not be nesting. Depths are numbers of polygons.
  bool map = false;
  Overlaps overlaps = Overlaps::first;  ///< what becomes of places that are in several polygons of a map
};

/// The triangulations of one or more point sets with constraints. If triangles are left out, neighbours and
/// half-edges are -1 there; the hull remains that of the points. Refinement splits edges of the hull that are
/// left: it then has the points added on them, too, and turns there by rounding.
struct ConstrainedTriangulation : Triangulation {
  /// x and y of the points that splitting added, and then those of refinement. The k-th one has the index
  /// n + k. Points of a set follow each other, set by set.
  std::vector<double> added_points;
  /// sets + 1 values: set s has added points [added_offsets[s], added_offsets[s + 1]).
  std::vector<std::size_t> added_offsets;
  /// The edges that segments are made of, each once: 2 points per edge, the lexicographically smaller one
  /// first. Edges that follow each other on a segment follow each other here. Those that refinement has split
  /// an edge into have its direction.
  std::vector<std::int32_t> constraint_edges;
  /// One per constraint edge: the smallest index of a segment that has it.
  std::vector<std::int32_t> edge_segments;
  /// segments + 1 values: segment s has pieces [piece_offsets[s], piece_offsets[s + 1]), which lie on it from
  /// its lexicographically smaller end to the other one. Without splitting, each segment is one piece.
  std::vector<std::int32_t> piece_offsets;
  /// 2 per piece: it has edges [first, second) of constraint_edges, from its lexicographically smaller end to
  /// the other one. 0, 0 if its ends have the same coordinates.
  std::vector<std::int32_t> piece_edges;
  /// 3 per triangle: 1 if the edge opposite to this corner is a constraint, otherwise 0.
  std::vector<std::uint8_t> constrained;
  /// One per triangle: its depth by ConstrainedOptions::fill_rule. Empty unless ConstrainedOptions::labels.
  std::vector<std::int32_t> depths;
  /// One per triangle: a region is what is connected without crossing a constraint. Regions are numbered from
  /// 0 by their first triangles, over all sets. Empty unless ConstrainedOptions::labels.
  std::vector<std::int32_t> regions;
  /// One per triangle: the polygon that it is in; -1 if it is in none. Empty unless PolygonOptions::map.
  std::vector<std::int32_t> polygons;
  /// One per constraint edge: the marker of its segment in edge_segments.
  std::vector<std::int32_t> edge_markers;
  /// One per point: those of the input as they were given, and for each point that was added the marker of
  /// the segment with the smallest index that has it; 0 if none has it or segments have no markers.
  std::vector<std::int32_t> vertex_markers;
  /// One per triangle: the attribute of its region; of several seeds in one region the last one counts, and
  /// where there is none it is 0. Seeds on a constraint, and those in no triangle, count for nothing.
  std::vector<double> triangle_attributes;
  RefinementReport refinement;  ///< how refinement went; of all sets together
};

}  // namespace flaunay
