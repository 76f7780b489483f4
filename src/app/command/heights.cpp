#include "app/command/heights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/files/formats.hpp"

namespace flaunay::cli {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Gives the vertices of segments without a height that between the segment's ends.
void complete_on_segments(const std::vector<std::int32_t>& segments, const ConstrainedTriangulation& mesh,
                          io::Points& points) {
  const auto at = [&](std::int32_t point) {
    return &points.coordinates[2 * static_cast<std::size_t>(point)];
  };
  const auto height = [&](std::int32_t point) -> double& {
    return points.heights[static_cast<std::size_t>(point)];
  };
  for (std::size_t s = 0; s < segments.size() / 2; ++s) {
    const std::int32_t a = segments[2 * s], b = segments[2 * s + 1];
    const double dx = at(b)[0] - at(a)[0], dy = at(b)[1] - at(a)[1], rise = height(b) - height(a);
    if (std::isnan(rise)) continue;
    const auto first = static_cast<std::size_t>(mesh.piece_offsets[s]);
    const auto last = static_cast<std::size_t>(mesh.piece_offsets[s + 1]);
    for (std::size_t piece = first; piece < last; ++piece) {
      for (std::int32_t end = 2 * mesh.piece_edges[2 * piece]; end < 2 * mesh.piece_edges[2 * piece + 1];
           ++end) {
        const std::int32_t v = mesh.constraint_edges[static_cast<std::size_t>(end)];
        if (!std::isnan(height(v))) continue;
        const double along = ((at(v)[0] - at(a)[0]) * dx + (at(v)[1] - at(a)[1]) * dy) / (dx * dx + dy * dy);
        height(v) = height(a) + along * rise;
      }
    }
  }
}

// Gives the others the heights between the points that have some.
void complete_between(Triangulator& triangulator, const ConstrainedTriangulation& mesh, io::Points& points) {
  std::vector<std::int32_t> number(points.size(), -1), segments;
  std::vector<double> coordinates, heights, places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_known = !std::isnan(points.heights[i]);
    if (is_known) {
      number[i] = static_cast<std::int32_t>(heights.size());
      heights.push_back(points.heights[i]);
    }
    std::vector<double>& to = is_known ? coordinates : places;
    to.insert(to.end(), &points.coordinates[2 * i], &points.coordinates[2 * i] + 2);
  }
  if (places.empty()) return;
  for (std::size_t end = 0; end < mesh.constraint_edges.size(); end += 2) {
    const std::int32_t a = number[static_cast<std::size_t>(mesh.constraint_edges[end])];
    const std::int32_t b = number[static_cast<std::size_t>(mesh.constraint_edges[end + 1])];
    if (a >= 0 && b >= 0) segments.insert(segments.end(), {a, b});
  }
  const std::vector<double> found = heights_at(triangulator, coordinates, heights, segments, places);
  std::size_t next = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] < 0) points.heights[i] = found[next++];
  }
}

}  // namespace

std::vector<double> heights_at(Triangulator& triangulator, const std::vector<double>& coordinates,
                               const std::vector<double>& heights, const std::vector<std::int32_t>& segments,
                               const std::vector<double>& places) {
  const std::size_t n = heights.size(), m = places.size() / 2;
  if (m == 0) return {};
  std::vector<double> found;
  std::vector<std::int32_t> nearest;
  const auto find_in = [&](const auto& mesh) {
    Locator locator(triangulator, coordinates.data(), n, mesh);
    found = locator.interpolate(heights.data(), places.data(), m);
    nearest = locator.nearest(places.data(), m);
  };
  if (segments.empty()) {
    find_in(triangulator.triangulate(coordinates.data(), n));
  } else {
    Constraints constraints;
    constraints.segments = segments.data();
    constraints.segment_count = segments.size() / 2;
    ConstrainedOptions options;
    options.neighbors = true;
    find_in(triangulator.constrained(coordinates.data(), n, constraints, options));
  }
  for (std::size_t k = 0; k < m; ++k) {
    if (std::isnan(found[k])) found[k] = heights[static_cast<std::size_t>(nearest[k])];
  }
  return found;
}

void add_points(Triangulator& triangulator, const std::vector<std::int32_t>& segments,
                const ConstrainedTriangulation& mesh, io::Points& points) {
  points.coordinates.insert(points.coordinates.end(), mesh.added_points.begin(), mesh.added_points.end());
  points.markers = mesh.vertex_markers;
  if (points.heights.empty()) return;
  points.heights.resize(points.size(), kUnknown);
  // The vertex of equal points is the first one.
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    double& height = points.heights[static_cast<std::size_t>(mesh.representatives[i])];
    if (std::isnan(height)) height = points.heights[i];
  }
  complete_on_segments(segments, mesh, points);
  complete_between(triangulator, mesh, points);
}

std::string heights_note(const std::string& input, const std::string& mesh, const io::Points& points) {
  if (points.heights.empty() || mesh.empty() || io::ending_of(mesh) == ".npy") return "";
  if (io::find_format(mesh, io::Use::has_heights) == nullptr) {
    return io::printable(fmt::format("note: {} has heights, which {} does not have; of meshes, {} have them",
                                     io::shown_path(input), mesh, io::endings_for(io::Use::has_heights))) +
           "\n";
  }
  const bool is_text = io::find_format(input, io::Use::read_points)->text != nullptr;
  return is_text ? "note: the third number of each line is the height; --columns chooses other columns\n"
                 : "";
}

}  // namespace flaunay::cli
