// Proofs of results: one function for all kinds of triangulations.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/periodic.hpp"
#include "flaunay/sphere.hpp"
#include "flaunay/weighted.hpp"

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

/// Checks a regular triangulation in the same way, and its hidden points.
FLAUNAY_API std::string verify(const double* coordinates, const double* weights,
                               const std::vector<std::size_t>& offsets,
                               const WeightedTriangulation& triangulation);

/// Checks a constrained triangulation, refined or not, by the definitions in docs/constrained.md: that
/// segments are edges or chains of edges; that other edges are Delaunay, and canonical; that just those
/// triangles are there which constraints and options ask for, with depths, regions and other arrays that fit.
/// Of a refined mesh it checks the smallest angle and the largest area, except of triangles that the result
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

/// Checks a triangulation on a torus or a cylinder: that its places are in the period and rounded, and that
/// it is the canonical Delaunay triangulation of all of their images.
FLAUNAY_API std::string verify(const PeriodicTriangulation& triangulation);
/// Checks a regular triangulation there, and that just those points are hidden which are. weights: one per
/// point.
FLAUNAY_API std::string verify(const double* weights, const WeightedPeriodicTriangulation& triangulation);

/// Checks a triangulation on the sphere: that places are those of the points, that triangles and neighbours
/// are those of the hull, with the canonical choice at ties, and that its other arrays fit. Places are
/// computed as those of triangulate_sphere are.
FLAUNAY_API std::string verify(const double* points, const std::vector<std::size_t>& offsets,
                               SphereCoordinates coordinates, const SphericalTriangulation& triangulation);

}  // namespace flaunay
