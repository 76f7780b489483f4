// The public calls for triangulations with constraints.
#include "call/constrained.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "call/areas.hpp"
#include "call/domains.hpp"
#include "call/insert_segments.hpp"
#include "call/triangulate.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/split.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "host/memory/system_memory.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

Ids checked_segments(const Constraints& constraints) {
  call::expect(constraints.segments != nullptr || constraints.segment_count == 0, "the segments are null");
  call::expect(constraints.holes != nullptr || constraints.hole_count == 0, "the holes are null");
  call::expect(
      (constraints.seeds != nullptr && constraints.seed_attributes != nullptr) || constraints.seed_count == 0,
      "the seeds or their attributes are null");
  return {constraints.segments, constraints.segments + 2 * constraints.segment_count};
}

ConstrainedTriangulation constrain_split(call::Implementation& self, const double* coordinates,
                                         const std::vector<std::size_t>& offsets,
                                         const Constraints& constraints, const ConstrainedOptions& options);

}  // namespace

std::vector<double> call::with_added(const double* coordinates, std::size_t n,
                                     const std::vector<double>& added) {
  std::vector<double> all;
  if (added.empty()) return all;
  all.assign(coordinates, coordinates + 2 * n);
  all.insert(all.end(), added.begin(), added.end());
  return all;
}

void call::take(constrained::Result&& made, ConstrainedTriangulation& result) {
  const std::size_t segments = made.segment_edges.size() / 2, sets = result.triangle_offsets.size() - 1;
  result.triangles = std::move(made.triangles);
  result.neighbors = std::move(made.neighbors);
  result.halfedges = std::move(made.halfedges);
  result.constrained = std::move(made.constrained);
  result.constraint_edges = std::move(made.constraint_edges);
  result.piece_edges = std::move(made.segment_edges);
  result.piece_offsets.resize(segments + 1);
  std::iota(result.piece_offsets.begin(), result.piece_offsets.end(), 0);
  result.edge_segments = constrained::first_pieces(result.constraint_edges.size() / 2, result.piece_edges);
  result.added_offsets.assign(sets + 1, 0);
}

ConstrainedTriangulation call::constrain(Implementation& self, const double* coordinates,
                                         const std::vector<std::size_t>& offsets,
                                         const Constraints& constraints, const ConstrainedOptions& options) {
  geometry::check_offsets(offsets);
  geometry::check_coordinates(coordinates, offsets.back());
  if (options.crossings == Crossings::split) {
    return constrain_split(self, coordinates, offsets, constraints, options);
  }
  const Ids segments = checked_segments(constraints);
  Options plain = options;
  plain.neighbors = true;
  plain.halfedges = plain.areas = false;
  ConstrainedTriangulation result;
  static_cast<Triangulation&>(result) =
      call::triangulate(self, {coordinates, nullptr, offsets.back()}, offsets, plain);

  const double begin = host::now();
  constrained::Result edges = call::insert_segments(self, coordinates, offsets, result, segments, options);
  take(std::move(edges), result);
  end_phase("constrain", begin, result.statistics);
  return result;
}

namespace {

// Triangulates all points with the pieces as segments, and then numbers the added points after all others.
ConstrainedTriangulation constrain_split(call::Implementation& self, const double* coordinates,
                                         const std::vector<std::size_t>& offsets,
                                         const Constraints& constraints, const ConstrainedOptions& options) {
  // What splitting and triangulating take for each piece; there are two for a segment and a place on it.
  constexpr std::size_t kBytesPerPiece = 320;
  const double begin = host::now();
  constrained::SplitLimits limits;
  limits.pieces = std::min(limits.pieces, host::memory_left().bytes / kBytesPerPiece);
  constrained::Split split = constrained::split(coordinates, offsets, checked_segments(constraints), limits);
  ConstrainedOptions without = options;
  without.crossings = Crossings::error;
  ConstrainedTriangulation result;
  const auto end_split = [&](double seconds) {
    result.statistics.seconds += seconds;
    result.statistics.phases.insert(result.statistics.phases.begin(), {"split", seconds});
  };
  if (split.is_as_it_was()) {
    const double seconds = host::now() - begin;
    result = call::constrain(self, coordinates, offsets, constraints, without);
    end_split(seconds);
    return result;
  }
  const constrained::AllPoints all = constrained::join_added(coordinates, offsets, split);
  for (std::int32_t& v : split.pieces) v = all.place[v];
  const double seconds = host::now() - begin;

  Constraints pieces = constraints;
  pieces.segments = split.pieces.data();
  pieces.segment_count = split.pieces.size() / 2;
  result = call::constrain(self, all.coordinates.data(), all.offsets, pieces, without);
  for (Ids* vertices : {&result.triangles, &result.hull, &result.constraint_edges, &result.representatives}) {
    for (std::int32_t& v : *vertices) v = all.index[v];
  }
  Ids representatives(result.representatives.size());
  for (std::size_t i = 0; i < representatives.size(); ++i) {
    representatives[all.index[i]] = result.representatives[i];
  }
  result.representatives.swap(representatives);
  result.piece_offsets = std::move(split.piece_offsets);
  Ids segment_of(result.piece_edges.size() / 2);
  for (std::size_t s = 0; s + 1 < result.piece_offsets.size(); ++s) {
    std::fill(segment_of.begin() + result.piece_offsets[s], segment_of.begin() + result.piece_offsets[s + 1],
              static_cast<std::int32_t>(s));
  }
  for (std::int32_t& piece : result.edge_segments) piece = segment_of[piece];
  result.added_points = std::move(split.added_points);
  result.added_offsets = std::move(split.added_offsets);
  end_split(seconds);
  return result;
}

// Edges have the markers of their segments, and so have points that splitting added.
void carry_markers(const Constraints& constraints, std::size_t n, ConstrainedTriangulation& result) {
  const std::int32_t* const of_segments = constraints.segment_markers;
  if (of_segments != nullptr) {
    for (const std::int32_t segment : result.edge_segments) {
      result.edge_markers.push_back(of_segments[segment]);
    }
  }
  if (constraints.point_markers == nullptr) return;
  result.vertex_markers.assign(constraints.point_markers, constraints.point_markers + n);
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  Ids first(result.added_points.size() / 2, kNone);
  for (std::size_t i = 0; i < result.constraint_edges.size(); ++i) {
    const auto v = static_cast<std::size_t>(result.constraint_edges[i]);
    if (v >= n) first[v - n] = std::min(first[v - n], result.edge_segments[i / 2]);
  }
  for (const std::int32_t segment : first) {
    result.vertex_markers.push_back(of_segments != nullptr && segment != kNone ? of_segments[segment] : 0);
  }
}

}  // namespace

void call::end_phase(const char* name, double begin, Statistics& statistics) {
  const double seconds = host::now() - begin;
  statistics.seconds += seconds;
  statistics.phases.push_back({name, seconds});
}

void call::finish(const double* coordinates, std::size_t n, const Options& options,
                  ConstrainedTriangulation& result) {
  // Otherwise all triangles were kept.
  if (result.halfedges.size() != result.triangles.size()) geometry::write_halfedges(options, result);
  if (!options.neighbors) result.neighbors.clear();
  if (options.areas) {
    const std::vector<double> all = with_added(coordinates, n, result.added_points);
    write_areas({all.empty() ? coordinates : all.data(), nullptr, result.representatives.size()}, options,
                result);
  }
  result.statistics.triangles = result.triangles.size() / 3;
}

void call::leave_polygons(const double* coordinates, const std::vector<std::size_t>& offsets,
                          const Constraints& constraints, const constrained::Curves& curves,
                          const ConstrainedOptions& options, Overlaps overlaps,
                          ConstrainedTriangulation& result) {
  const std::vector<double> added = with_added(coordinates, offsets.back(), result.added_points);
  const double* const all = added.empty() ? coordinates : added.data();
  constrained::HostRegions regions = constrained::find_regions_on_host(result);
  constrained::MapLabels labels =
      constrained::label_map(all, result, regions.of_triangles, regions.left.size(), constraints.segments,
                             curves, options.fill_rule, overlaps);
  if (options.outside != Outside::keep) {
    for (std::size_t r = 0; r < regions.left.size(); ++r) regions.left[r] = labels.polygons[r] >= 0 ? 1 : 0;
  }
  regions.depths = std::move(labels.depths);
  result.polygons.resize(regions.of_triangles.size());
  for (std::size_t t = 0; t < result.polygons.size(); ++t) {
    result.polygons[t] = labels.polygons[regions.of_triangles[t]];
  }
  constrained::leave_on_host(all, offsets, constraints, options.labels, regions, result);
}

ConstrainedTriangulation call::constrain_and_leave(Implementation& self, const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options, bool are_closed) {
  const Rings& rings = constraints.rings;
  ConstrainedTriangulation result = constrain(self, coordinates, offsets, constraints, options);
  const double begin = host::now();
  carry_markers(constraints, offsets.back(), result);
  const std::vector<double> added = with_added(coordinates, offsets.back(), result.added_points);
  const double* const all = added.empty() ? coordinates : added.data();
  const constrained::DomainRequest request = request_of(options, are_closed);
  if (!rings.segment_offsets.empty() && request.needs_depths()) {
    leave_polygons(coordinates, offsets, constraints, constrained::curves_of(rings), options, Overlaps::first,
                   result);
    result.polygons.clear();
  } else {
    apply_domains(self, all, offsets, constraints, request, result);
  }
  write_attributes(self, all, offsets, constraints, result);
  finish(coordinates, offsets.back(), options, result);
  end_phase("domains", begin, result.statistics);
  return result;
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options) {
  return call::take_turn(*implementation_, [&] {
    if (!constraints.rings.segment_offsets.empty()) {
      constrained::check_rings(constraints.rings, constraints.segment_count, options.fill_rule);
    }
    return call::constrain_and_leave(*implementation_, coordinates, offsets, constraints, options, false);
  });
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints) {
  return constrained(coordinates, offsets, constraints, {});
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates, std::size_t n,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options) {
  return constrained(coordinates, std::vector<std::size_t>{0, n}, constraints, options);
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates, std::size_t n,
                                                   const Constraints& constraints) {
  return constrained(coordinates, n, constraints, {});
}

}  // namespace flaunay
