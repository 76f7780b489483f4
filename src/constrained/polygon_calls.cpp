// The public calls for triangulations of polygons.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "constrained/crossings/first_crossing.hpp"
#include "constrained/domains/map.hpp"
#include "constrained/stages.hpp"
#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "space/triangulate.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

void check(const Polygons& polygons, const PolygonOptions& options) {
  call::expect(!polygons.ring_offsets.empty() && !polygons.polygon_offsets.empty(),
               "polygons need offsets of rings and of polygons, which begin with 0");
  check_offsets(polygons.ring_offsets);
  check_offsets(polygons.polygon_offsets);
  call::expect(polygons.polygon_offsets.back() == polygons.ring_offsets.size() - 1,
               "the offsets of polygons do not end with the number of rings");
  check_points(polygons.coordinates, polygons.ring_offsets.back());
  check_enumerator(options.overlaps);
  call::expect(!options.map || options.fill_rule != FillRule::nesting,
               "the polygons of a map need the fill rule even-odd or winding");
}

// The points of each polygon.
std::vector<std::size_t> points_of(const Polygons& polygons) {
  std::vector<std::size_t> offsets;
  offsets.reserve(polygons.polygon_offsets.size());
  for (const std::size_t ring : polygons.polygon_offsets) offsets.push_back(polygons.ring_offsets[ring]);
  return offsets;
}

// A segment from each point to the next one of its ring.
Ids segments_of(const Polygons& polygons) {
  Ids segments(2 * polygons.ring_offsets.back());
  for (std::size_t r = 0; r + 1 < polygons.ring_offsets.size(); ++r) {
    const auto first = static_cast<std::int32_t>(polygons.ring_offsets[r]),
               end = static_cast<std::int32_t>(polygons.ring_offsets[r + 1]);
    for (std::int32_t i = first; i < end; ++i) {
      segments[2 * static_cast<std::size_t>(i)] = i;
      segments[2 * static_cast<std::size_t>(i) + 1] = i + 1 < end ? i + 1 : first;
    }
  }
  return segments;
}

Constraints constraints_of(const Ids& segments) {
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  return constraints;
}

std::size_t polygon_of(const std::vector<std::size_t>& points, std::size_t segment) {
  return static_cast<std::size_t>(std::upper_bound(points.begin(), points.end(), segment) - points.begin()) -
         1;
}

bool has_single_rings(const Polygons& polygons) {
  const std::vector<std::size_t>& offsets = polygons.polygon_offsets;
  return std::adjacent_find(offsets.begin(), offsets.end(), [](std::size_t first, std::size_t end) {
           return end > first + 1;
         }) == offsets.end();
}

// Runs a call on the segments of polygons. If some cross, names their polygons, too.
template <typename Work>
auto with_names(const std::vector<std::size_t>& points, const Work& work) {
  try {
    return work();
  } catch (const constrained::CrossingError& error) {
    const std::size_t first = polygon_of(points, static_cast<std::size_t>(error.crossed)),
                      second = polygon_of(points, static_cast<std::size_t>(error.segment));
    throw Error(ErrorKind::input, first == second
                                      ? fmt::format("polygon {}: {}", first, error.what())
                                      : fmt::format("polygons {} and {}: {}", first, second, error.what()));
  }
}

ConstrainedTriangulation compute(call::Implementation& self, const Polygons& polygons,
                                 const PolygonOptions& options) {
  check(polygons, options);
  const std::vector<std::size_t> points = points_of(polygons);
  const Ids segments = segments_of(polygons);
  const Constraints constraints = constraints_of(segments);
  call::DomainRequest request = call::request_of(options, true);
  request.polygons = options.map;
  if (options.map) request.overlaps = options.overlaps;
  const bool has_parts = !polygons.part_offsets.empty() && options.fill_rule != FillRule::nesting;
  constrained::Curves curves;
  if (has_parts) {
    const Rings rings = {polygons.ring_offsets, polygons.part_offsets, polygons.polygon_offsets};
    constrained::check_rings(rings, constraints.segment_count, options.fill_rule);
    curves = constrained::curves_of(rings);
  } else if (options.map) {
    curves = constrained::curves_of_polygons(points);
  }
  // Single rings are what the fill rule counts, too.
  if (options.map || (has_parts && !has_single_rings(polygons))) request.curves = &curves;
  return with_names(points, [&] {
    ConstrainedTriangulation result = call::constrain_and_leave(
        self, polygons.coordinates, options.map ? std::vector<std::size_t>{0, points.back()} : points,
        constraints, options, request);
    // The rule has counted how often the only ring of a polygon goes around a triangle.
    if (has_parts && !options.map) {
      for (std::int32_t& depth : result.depths) depth = depth != 0 ? 1 : 0;
    }
    return result;
  });
}

}  // namespace

ConstrainedTriangulation Triangulator::polygons(const Polygons& polygons, const PolygonOptions& options) {
  return call::take_turn(*implementation_, [&] { return compute(*implementation_, polygons, options); });
}

std::string verify(const Polygons& polygons, const PolygonOptions& options,
                   const ConstrainedTriangulation& triangulation) {
  check(polygons, options);
  const std::vector<std::size_t> points = points_of(polygons);
  const Ids segments = segments_of(polygons);
  Constraints constraints = constraints_of(segments);
  if (!polygons.part_offsets.empty() && options.fill_rule != FillRule::nesting) {
    constraints.rings = {polygons.ring_offsets, polygons.part_offsets, polygons.polygon_offsets};
    constrained::check_rings(constraints.rings, constraints.segment_count, options.fill_rule);
  } else if (options.map) {
    // The rings of a polygon count alike, as if they were one.
    std::vector<std::size_t> numbers(points.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    constraints.rings = {points, numbers, numbers};
  }
  return verify(polygons.coordinates, options.map ? std::vector<std::size_t>{0, points.back()} : points,
                constraints, options, triangulation);
}

ConstrainedTriangulation Triangulator::polygons(const Polygons& polygons) {
  return this->polygons(polygons, {});
}

}  // namespace flaunay
