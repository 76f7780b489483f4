// Heights of points that have none: of places between others, and of points that were added to a mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::cli {

/// The heights of places between points, linear in the triangles of the points in which segments are edges,
/// and beyond them that of the nearest point. heights: one per point.
std::vector<double> heights_at(Triangulator& triangulator, const std::vector<double>& coordinates,
                               const std::vector<double>& heights, const std::vector<std::int32_t>& segments,
                               const std::vector<double>& places);

/// Appends the points that were added to a mesh to its points. If these have heights (NaN: unknown), so have
/// all points afterwards: on a segment between two known heights linear, on several that of the first one,
/// and otherwise as of heights_at.
void add_points(Triangulator& triangulator, const std::vector<std::int32_t>& segments,
                const ConstrainedTriangulation& mesh, io::Points& points);

/// A line that says where heights come from, or that the file of a mesh has none; empty without heights or a
/// mesh.
std::string heights_note(const std::string& input, const std::string& mesh, const io::Points& points);

}  // namespace flaunay::cli
