// Slow and obviously correct answers to compare with, in exact GMP arithmetic. Shares no code with src/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::testing {

/// Triangles in a form that is equal for equal sets: each rotated so that its smallest index is first (the
/// orientation stays), the list sorted.
using TriangleSet = std::vector<std::array<std::int32_t, 3>>;

/// The canonical Delaunay triangulation of n points (x0 y0 x1 y1 ..., finite): duplicates are represented by
/// their smallest index; every Delaunay cell (polygon whose corners are all points on an empty circle) is
/// triangulated as a fan from its lexicographically smallest corner; counter-clockwise. Empty if the points
/// are all collinear. O(n^2): some milliseconds for 300 points.
TriangleSet reference_delaunay(const double* coordinates, std::size_t n);
TriangleSet reference_delaunay(const std::vector<double>& coordinates);

/// A result, 3 indices per triangle, as a TriangleSet.
TriangleSet sorted_triangles(const std::vector<std::int32_t>& triangles);

/// The triangles one after the other, as Triangulation::triangles has them.
std::vector<std::int32_t> flat_triangles(const TriangleSet& triangles);

/// For each triangle the triangles opposite to its corners, -1 for none: as Triangulation::neighbors.
/// Every directed edge must occur at most once.
std::vector<std::int32_t> reference_neighbors(const std::vector<std::int32_t>& triangles);
/// For each edge of a triangle its twin, -1 for none: as Triangulation::halfedges. The same holds.
std::vector<std::int32_t> reference_halfedges(const std::vector<std::int32_t>& triangles);

/// Sorted triangles, each with the places of its neighbours in this list: equal for triangulations that
/// differ in the order of rows alone.
std::vector<std::int32_t> linked_rows(const std::vector<std::int32_t>& triangles,
                                      const std::vector<std::int32_t>& neighbors);

/// Triangulation::areas: each the double next to the exact area.
std::vector<double> reference_areas(const std::vector<double>& coordinates,
                                    const std::vector<std::int32_t>& triangles);

/// Exact signs for any finite doubles; points are pointers to x, y. +1: a, b, c turn left.
int reference_orient2d(const double* a, const double* b, const double* c);
/// +1: d is inside the circle of the counter-clockwise a, b, c.
int reference_incircle(const double* a, const double* b, const double* c, const double* d);

}  // namespace flaunay::testing
