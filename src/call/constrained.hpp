// Constrained triangulations of points in host memory, in steps.
#pragma once

#include <cstddef>
#include <vector>

#include "call/implementation.hpp"
#include "constrained/domains/map.hpp"
#include "constrained/insertion/insert.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::call {

/// Moves what inserting segments has made to the result, which has the Delaunay triangulation. Each segment
/// is one piece, and no points were added.
void take(constrained::Result&& made, ConstrainedTriangulation& result);

/// Triangulates sets with segments. All triangles are kept, without labels; there are neighbours, but no
/// half-edges.
ConstrainedTriangulation constrain(Implementation& self, const double* coordinates,
                                   const std::vector<std::size_t>& offsets, const Constraints& constraints,
                                   const ConstrainedOptions& options);

/// Labels a triangulation by the polygons that curves bound, says for each triangle the first polygon, and
/// leaves out what the options and the holes say.
void leave_polygons(const double* coordinates, const std::vector<std::size_t>& offsets,
                    const Constraints& constraints, const constrained::Curves& curves,
                    const ConstrainedOptions& options, Overlaps overlaps, ConstrainedTriangulation& result);

/// Implements Triangulator::constrained, with rings that are checked. are_closed: whether segments are known
/// to be closed curves.
ConstrainedTriangulation constrain_and_leave(Implementation& self, const double* coordinates,
                                             const std::vector<std::size_t>& offsets,
                                             const Constraints& constraints,
                                             const ConstrainedOptions& options, bool are_closed);

/// The coordinates of n points and of those that splitting added. Empty if there are none of these.
std::vector<double> with_added(const double* coordinates, std::size_t n, const std::vector<double>& added);

/// Makes half-edges and areas, or leaves out neighbours, as the options say, and counts the triangles of n
/// points and those that splitting added.
void finish(const double* coordinates, std::size_t n, const Options& options,
            ConstrainedTriangulation& result);

/// Adds a phase that began at this time to the statistics.
void end_phase(const char* name, double begin, Statistics& statistics);

}  // namespace flaunay::call
