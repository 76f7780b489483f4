#include "prove/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/arguments.hpp"

namespace flaunay::prove {
namespace {

using Ids = std::vector<std::int32_t>;

// count: of the points, with those that were added.
void check_sizes(std::size_t count, std::size_t sets, const Triangulation& mesh) {
  const std::size_t corners = mesh.triangles.size(), triangles = corners / 3;
  const auto fits = [&](const std::vector<std::int32_t>& links, std::size_t end) {
    return links.empty() || (links.size() == corners && are_indices(links, end, -1));
  };
  expect(corners % 3 == 0 && are_indices(mesh.triangles, count) && are_indices(mesh.hull, count) &&
             mesh.representatives.size() == count && are_indices(mesh.representatives, count) &&
             are_offsets(mesh.triangle_offsets, sets, triangles) &&
             are_offsets(mesh.hull_offsets, sets, mesh.hull.size()) && fits(mesh.neighbors, triangles) &&
             fits(mesh.halfedges, corners) && (mesh.areas.empty() || mesh.areas.size() == triangles),
         "the triangulation is not one of these points");
}

// Throws Error(input) for one that is not finite.
void check_coordinates(const double* coordinates, std::size_t n) {
  for (std::size_t i = 0; i < 2 * n; ++i) {
    if (!std::isfinite(coordinates[i])) {
      throw Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", i / 2,
                                                coordinates[i - i % 2], coordinates[i - i % 2 + 1]));
    }
  }
}

void check_ranges(const Ids& ranges, std::size_t size, const char* name) {
  bool fits = true;
  for (std::size_t i = 0; i + 1 < ranges.size(); i += 2)
    fits &= 0 <= ranges[i] && ranges[i] <= ranges[i + 1] && static_cast<std::size_t>(ranges[i + 1]) <= size;
  expect(ranges.size() % 2 == 0 && fits,
         [&] { return fmt::format("{} are not those of the segments", name); });
}

}  // namespace

void check_arrays(const double* points, const std::vector<std::size_t>& offsets, const Triangulation& mesh) {
  check_offsets(offsets);
  check_points(points, offsets.back());
  check_coordinates(points, offsets.back());
  check_sizes(offsets.back(), offsets.size() - 1, mesh);
}

void check_arrays(const DomainClaim& claim) {
  check_offsets(claim.offsets);
  check_points(claim.points, claim.offsets.back());
  check_coordinates(claim.points, claim.offsets.back());
  const ConstrainedTriangulation& mesh = claim.mesh;
  const Constraints& given = claim.constraints;
  const std::size_t sets = claim.offsets.size() - 1, added = mesh.added_points.size() / 2,
                    count = claim.offsets.back() + added, triangles = mesh.triangles.size() / 3;
  check_sizes(count, sets, mesh);
  check_coordinates(mesh.added_points.data(), added);
  const auto has_one_each = [&](const auto& values, std::size_t size) {
    return values.empty() || values.size() == size;
  };
  const auto cuts = [&](const std::vector<std::size_t>& offsets, std::size_t size) {
    return offsets.empty() ? sets == 1 || size == 0 : are_offsets(offsets, sets, size);
  };
  const std::size_t edges = mesh.constraint_edges.size() / 2;
  expect(mesh.added_points.size() % 2 == 0 && cuts(mesh.added_offsets, added) &&
             mesh.constraint_edges.size() % 2 == 0 && are_indices(mesh.constraint_edges, count) &&
             mesh.edge_segments.size() == edges && has_one_each(mesh.constrained, 3 * triangles) &&
             has_one_each(mesh.depths, triangles) && has_one_each(mesh.regions, triangles) &&
             std::is_sorted(mesh.refinement.bad_triangles.begin(), mesh.refinement.bad_triangles.end()),
         "the arrays are not those of a triangulation with constraints");
  expect(mesh.piece_offsets.size() >= given.segment_count + 1 &&
             std::is_sorted(mesh.piece_offsets.begin(), mesh.piece_offsets.end()) &&
             mesh.piece_offsets.front() == 0 &&
             static_cast<std::size_t>(mesh.piece_offsets.back()) <= mesh.piece_edges.size() / 2,
         "the triangulation was made of other segments");
  check_ranges(mesh.piece_edges, edges, "the edges of pieces");
  check_array(given.segments, given.segment_count, "segments", kMostIndexed / 2);
  check_array(given.holes, given.hole_count, "holes", kMostIndexed / 2);
  expect(cuts(given.hole_offsets, given.hole_count), "the offsets of holes are not those of the sets");
  const Ids segments(given.segments, given.segments + 2 * given.segment_count);
  expect(are_indices(segments, claim.offsets.back()), "a segment has an end that is none of the points");
}

}  // namespace flaunay::prove
