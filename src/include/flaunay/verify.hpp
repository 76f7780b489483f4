// Proofs of results: one function for all kinds of triangulations.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Checks exactly that a triangulation is the canonical Delaunay triangulation of each of its sets, and that
/// its other arrays fit: neighbours, half-edges, hull, representatives and areas, as far as it has them.
/// Returns what is wrong, the first that is found; nothing if all is right. Its arithmetic and its predicates
/// are its own, so that an error in those that make triangulations cannot hide itself. It needs no device,
/// and runs on the calling thread. coordinates, offsets: what was triangulated; set s has points [offsets[s],
/// offsets[s + 1]). Throws Error(usage) for arrays whose sizes or indices do not fit each other, and
/// Error(input) for coordinates that are not finite. O(n log n).
FLAUNAY_API std::string verify(const double* coordinates, const std::vector<std::size_t>& offsets,
                               const Triangulation& triangulation);

/// Checks a triangulation of points of any space in the same way, with the space of the call: of weighted
/// points also which are hidden; on a torus, a cylinder and the sphere also that places are those of the
/// points. Their places are computed as those of Triangulator::triangulate are.
FLAUNAY_API std::string verify(const double* points, const std::vector<std::size_t>& offsets,
                               const Space& space, const Triangulation& triangulation);

/// Checks a constrained triangulation, refined or not, by the definitions in docs/constrained.md: that
/// segments are edges or chains of edges; that other edges are Delaunay, and canonical; that just those
/// triangles are there which constraints and options ask for, with depths, regions and other arrays that fit.
/// For a refined mesh it checks the smallest angle and the largest area, except of triangles that the result
/// lists as worse, and whether it is conforming if it has none of these; areas by seeds, triangles and
/// functions are not checked, nor is the hull where triangles are left out. A mesh that was refined from
/// given triangles must cover as much as these. constraints, options: those of the call. Errors as above.
/// O((n + s) log (n + s)) for s segments.
FLAUNAY_API std::string verify(const double* coordinates, const std::vector<std::size_t>& offsets,
                               const Constraints& constraints, const ConstrainedOptions& options,
                               const ConstrainedTriangulation& triangulation);

/// Checks the triangulation of polygons in the same way. Of a map, it does not check which of several
/// polygons a triangle is given to.
FLAUNAY_API std::string verify(const Polygons& polygons, const PolygonOptions& options,
                               const ConstrainedTriangulation& triangulation);

}  // namespace flaunay
