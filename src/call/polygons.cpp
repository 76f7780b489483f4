// The public calls for triangulations of polygons.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "call/constrained.hpp"
#include "call/device_mesh.hpp"
#include "constrained/crossing_error.hpp"
#include "constrained/domain_on_host.hpp"
#include "constrained/map.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

void check(const Polygons& polygons, const PolygonOptions& options) {
  call::expect(!polygons.ring_offsets.empty() && !polygons.polygon_offsets.empty(),
               "polygons need offsets of rings and of polygons, which begin with 0");
  geometry::check_offsets(polygons.ring_offsets);
  geometry::check_offsets(polygons.polygon_offsets);
  call::expect(polygons.polygon_offsets.back() == polygons.ring_offsets.size() - 1,
               "the offsets of polygons do not end with the number of rings");
  geometry::check_coordinates(polygons.coordinates, polygons.ring_offsets.back());
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

std::size_t polygon_of(const std::vector<std::size_t>& points, std::size_t segment) {
  return static_cast<std::size_t>(std::upper_bound(points.begin(), points.end(), segment) - points.begin()) -
         1;
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

// All polygons as one set.
ConstrainedTriangulation make_map(call::Implementation& self, const Polygons& polygons,
                                  const std::vector<std::size_t>& points, const Ids& segments,
                                  const Constraints& constraints, const PolygonOptions& options) {
  ConstrainedTriangulation result =
      call::constrain(self, polygons.coordinates, {0, points.back()}, constraints, options);
  const double begin = host::now();
  Ids polygon_of_segment;
  polygon_of_segment.reserve(points.back());
  for (std::size_t p = 0; p + 1 < points.size(); ++p) {
    polygon_of_segment.resize(points[p + 1], static_cast<std::int32_t>(p));
  }
  const std::vector<double> all = call::with_added(polygons.coordinates, points.back(), result.added_points);
  constrained::HostRegions regions = constrained::find_regions_on_host(result);
  constrained::MapLabels labels = constrained::label_map(
      all.empty() ? polygons.coordinates : all.data(), result, regions.of_triangles, regions.left.size(),
      segments, polygon_of_segment, options.fill_rule, options.overlaps);
  if (options.outside != Outside::keep) {
    for (std::size_t r = 0; r < regions.left.size(); ++r) regions.left[r] = labels.polygons[r] >= 0 ? 1 : 0;
  }
  regions.depths = std::move(labels.depths);
  Ids left;
  for (std::size_t r = 0; r < regions.left.size(); ++r) {
    if (regions.left[r] != 0) left.push_back(labels.polygons[r]);
  }
  constrained::leave_on_host(result, regions);
  result.polygons.resize(regions.of_triangles.size());
  for (std::size_t t = 0; t < result.polygons.size(); ++t) {
    result.polygons[t] = left[static_cast<std::size_t>(regions.of_triangles[t])];
  }
  if (options.labels) constrained::label_on_host(regions, result);
  call::finish(options, result);
  call::end_phase("domains", begin, result.statistics);
  return result;
}

ConstrainedTriangulation compute(call::Implementation& self, const Polygons& polygons,
                                 const PolygonOptions& options) {
  check(polygons, options);
  const std::vector<std::size_t> points = points_of(polygons);
  const Ids segments = segments_of(polygons);
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  return with_names(points, [&] {
    return options.map
               ? make_map(self, polygons, points, segments, constraints, options)
               : call::constrain_and_leave(self, polygons.coordinates, points, constraints, options, true);
  });
}

}  // namespace

ConstrainedTriangulation Triangulator::polygons(const Polygons& polygons, const PolygonOptions& options) {
  return call::take_turn(*implementation_, [&] { return compute(*implementation_, polygons, options); });
}

ConstrainedTriangulation Triangulator::polygons(const Polygons& polygons) {
  return this->polygons(polygons, {});
}

}  // namespace flaunay
