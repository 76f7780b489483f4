// An exact, independent check of a constrained Delaunay triangulation on the host, by the definition in
// docs/constrained.md. Shares no code with src/constrained and the kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/constrained.hpp"
#include "prove/delaunay_proof.hpp"

namespace flaunay {

/// The input of a constrained triangulation, against which it is checked.
struct VerifyConstraints {
  /// 2 indices of points per segment. Required.
  const std::vector<std::int32_t>* segments = nullptr;
  Outside outside = Outside::keep;
  FillRule fill_rule = FillRule::nesting;
  /// If given: the rings of polygons, which the rule is about; see Constraints::rings.
  const Rings* rings = nullptr;
  /// If given: x and y of each place whose face is left out, too.
  const std::vector<double>* holes = nullptr;
  /// If given: the edges that segments are made of, 2 points per edge, and per segment the first of its edges
  /// and the one after its last.
  const std::vector<std::int32_t>* edges = nullptr;
  const std::vector<std::int32_t>* segment_edges = nullptr;
  /// The goals of a refined mesh, in degrees and as an area; 0: none.
  double min_angle = 0, max_area = 0;
  bool conforming = false;  ///< whether it has been asked to be Delaunay without constraints, too
  /// If given: triangles that may be worse, ascending. The angles at which corners see edges are unchecked
  /// then.
  const std::vector<std::int32_t>* worse = nullptr;
  /// If given: per triangle its depth by the fill rule, and the number of its region.
  const std::vector<std::int32_t>*depths = nullptr, *regions = nullptr;
};

/// Checks, exactly and for any finite input: the properties of triangles, edges and points that `verify`
/// checks; that every segment is an edge, or a chain of edges if points are on it; that every other edge is
/// locally Delaunay; that triangles with a common circle that no constraint divides are a fan from their
/// lexicographically smallest vertex; and that the triangles tile the convex hull without the faces between
/// constraints that must be left out, so every edge with one triangle is on the hull or a constraint.
/// neighbors: null, or 3 per triangle. Segments that cross where no point is are an error, as are open curves
/// if the fill rule needs closed ones, and holes that are on a constraint or outside of the hull. With a
/// smallest angle or a largest area, no triangle may be worse than that, except triangles whose angle the
/// input makes unavoidable: either their smallest angle lies between two constraints, or their shortest edge
/// is no constraint and joins points on two constraints, equally far from where these meet at less than 60
/// degrees, with triangles all the way between. No corner may see an edge of its triangle that is a
/// constraint or on the border at 180 degrees less twice the smallest angle (or less 40) or more; in
/// conforming meshes, at more than 90 degrees. Slivers between such edges and the hull need no triangle,
/// because points on edges are rounded. O((n + s) log (n + s)) for n points and s segments, whatever overlaps
/// or meets at a point.
VerifyReport verify_constrained(const double* coordinates, std::size_t n,
                                const std::vector<std::int32_t>& triangles,
                                const std::vector<std::int32_t>* neighbors,
                                const VerifyConstraints& constraints);

}  // namespace flaunay
