#include "app/command/terrain_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/command/errors.hpp"
#include "app/command/heights.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {
namespace {

// Lines between points with heights, NaN where there are none.
struct HardLines {
  io::Points points;
  std::vector<std::int32_t> segments;

  void add(const io::Map& map) {
    const auto first = static_cast<std::int32_t>(points.size());
    points.coordinates.insert(points.coordinates.end(), map.points.coordinates.begin(),
                              map.points.coordinates.end());
    points.heights.insert(points.heights.end(), map.points.heights.begin(), map.points.heights.end());
    points.heights.resize(points.size(), std::numeric_limits<double>::quiet_NaN());
    for (const auto* of_map : {&map.segments, &map.lines}) {
      for (const std::int32_t end : *of_map) segments.push_back(first + end);
    }
  }
};

// Cuts segments where they cross, with the height of the first one.
void split_crossings(Triangulator& triangulator, io::Points& points, std::vector<std::int32_t>& segments) {
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  ConstrainedOptions options;
  options.crossings = Crossings::split;
  const ConstrainedTriangulation mesh =
      triangulator.constrained(points.coordinates.data(), points.size(), constraints, options);
  add_points(triangulator, segments, mesh, points);
  segments = mesh.constraint_edges;
}

// Gives ends of lines without a height that of the points around them.
void complete_heights(Triangulator& triangulator, const TerrainMesh& points, HardLines& lines) {
  std::vector<std::size_t> missing;
  std::vector<double> places, &heights = lines.points.heights;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!std::isnan(heights[i])) continue;
    missing.push_back(i);
    places.insert(places.end(), {lines.points.coordinates[2 * i], lines.points.coordinates[2 * i + 1]});
  }
  const std::vector<double> found = heights_at(triangulator, points.coordinates, points.heights, {}, places);
  for (std::size_t k = 0; k < missing.size(); ++k) heights[missing[k]] = found[k];
}

// Gives the shores of lakes one height for each part of a polygon: that of the first point of its border, or
// if it has none, since water lies no higher than its shore, the lowest height along its rings.
void flatten(Triangulator& triangulator, const TerrainMesh& points, io::Map& lakes) {
  lakes.points.heights.resize(lakes.points.size(), std::numeric_limits<double>::quiet_NaN());
  const std::vector<double> around =
      heights_at(triangulator, points.coordinates, points.heights, {}, lakes.points.coordinates);
  const auto point_of = [&](std::size_t segment) {
    return static_cast<std::size_t>(lakes.segments[2 * segment]);
  };
  for (std::size_t part = 0; part + 1 < lakes.part_offsets.size(); ++part) {
    const std::size_t first = lakes.ring_offsets[lakes.part_offsets[part]];
    const std::size_t last = lakes.ring_offsets[lakes.part_offsets[part + 1]];
    if (first == last) continue;
    double level = lakes.points.heights[point_of(first)];
    if (std::isnan(level)) {
      level = std::numeric_limits<double>::infinity();
      for (std::size_t s = first; s < last; ++s) level = std::min(level, around[point_of(s)]);
    }
    for (std::size_t s = first; s < last; ++s) lakes.points.heights[point_of(s)] = level;
  }
}

// Leaves the points that lie in no lake and on no shore.
void leave_dry(Triangulator& triangulator, const io::Map& lakes, Crossings crossings, TerrainMesh& points) {
  Constraints constraints;
  constraints.segments = lakes.segments.data();
  constraints.segment_count = lakes.segments.size() / 2;
  constraints.rings = {lakes.ring_offsets, lakes.part_offsets, lakes.polygon_offsets};
  ConstrainedOptions options;
  options.neighbors = true;
  options.outside = Outside::hull;
  options.fill_rule = FillRule::even_odd;
  options.crossings = crossings;
  const ConstrainedTriangulation water =
      triangulator.constrained(lakes.points.coordinates.data(), lakes.points.size(), constraints, options);
  Locator locator(triangulator, lakes.points.coordinates.data(), lakes.points.size(), water);
  const std::vector<std::int32_t> found = locator.locate(points.coordinates.data(), points.heights.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] >= 0) continue;
    std::copy_n(&points.coordinates[2 * i], 2, &points.coordinates[2 * kept]);
    points.heights[kept++] = points.heights[i];
  }
  points.coordinates.resize(2 * kept);
  points.heights.resize(kept);
}

// Gives the representatives of equal points the common height, but for those of breaklines, which are the
// first `fixed` points.
void merge_heights(TerrainMesh& terrain, std::size_t fixed, Duplicates duplicates) {
  std::vector<std::pair<std::int32_t, double>> equal;
  for (std::size_t i = fixed; i < terrain.heights.size(); ++i) {
    const std::int32_t of = terrain.mesh.representatives[i];
    if (static_cast<std::size_t>(of) >= fixed) equal.emplace_back(of, terrain.heights[i]);
  }
  std::sort(equal.begin(), equal.end());
  for (std::size_t first = 0, last = 0; first < equal.size(); first = last) {
    double sum = 0;
    for (; last < equal.size() && equal[last].first == equal[first].first; ++last) sum += equal[last].second;
    terrain.heights[static_cast<std::size_t>(equal[first].first)] =
        duplicates == Duplicates::lowest    ? equal[first].second
        : duplicates == Duplicates::highest ? equal[last - 1].second
                                            : sum / static_cast<double>(last - first);
  }
}

}  // namespace

HardEdges::HardEdges(const std::string& breaklines, const std::string& flat, const io::Columns& columns,
                     const std::vector<std::string>& line_heights, Crossings at_crossings)
    : path(breaklines.empty() ? flat
           : flat.empty()     ? breaklines
                              : breaklines + " and " + flat),
      crossings(at_crossings) {
  if (!breaklines.empty()) {
    lines = io::read_lines(breaklines, columns, line_heights);
    segments = lines.segments;
    segments.insert(segments.end(), lines.lines.begin(), lines.lines.end());
    if (segments.empty()) io::fail(breaklines, "has neither lines nor polygons");
    has_height_field = line_heights.empty() && lines.has_height_field;
  }
  if (!flat.empty()) {
    lakes = io::read_map(flat, columns);
    has_height_field = has_height_field || lakes.has_height_field;
    if (lakes.polygon_count() == 0 || lakes.has_others) io::fail(flat, "must have polygons and nothing else");
  }
}

void HardEdges::split(Triangulator& triangulator) {
  if (crossings == Crossings::split && !segments.empty())
    split_crossings(triangulator, lines.points, segments);
}

bool HardEdges::has_heights() const {
  const std::vector<double>& heights = lines.points.heights;
  return heights.size() == lines.points.size() &&
         std::none_of(heights.begin(), heights.end(), [](double z) { return std::isnan(z); });
}

Breaklines HardEdges::view() const {
  return {lines.points.coordinates.data(), lines.points.heights.data(), lines.points.size(), segments.data(),
          segments.size() / 2};
}

TerrainMesh triangulate_scan(Triangulator& triangulator, io::Scan& scan, HardEdges& edges,
                             Duplicates duplicates) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max() / 4;
  if (scan.size() > kMost) {
    throw Error(ErrorKind::input,
                fmt::format("{} points are too many for breaklines, lakes or a file of triangles, for which "
                            "they are in memory at once; at most {} are possible",
                            scan.size(), kMost));
  }
  const auto n = static_cast<std::size_t>(scan.size());
  TerrainMesh terrain;
  terrain.coordinates.resize(2 * n);
  terrain.heights.resize(n);
  constexpr std::size_t kPiece = std::size_t{1} << 18;
  for (std::size_t first = 0; first < n; first += kPiece) {
    const std::size_t count = std::min(kPiece, n - first);
    scan.read(first, count, terrain.coordinates.data() + 2 * first);
    scan.read_values(first, count, terrain.heights.data() + first);
  }
  std::size_t fixed = 0;
  naming_files({{"segment", edges.path}}, [&] {
    HardLines lines;
    lines.add(edges.lines);
    if (edges.lakes.polygon_count() > 0) {
      flatten(triangulator, terrain, edges.lakes);
      leave_dry(triangulator, edges.lakes, edges.crossings, terrain);
    }
    if (!terrain.heights.empty()) complete_heights(triangulator, terrain, lines);
    const auto of_lines = static_cast<std::ptrdiff_t>(lines.segments.size());
    lines.add(edges.lakes);
    if (edges.crossings == Crossings::split) {
      // Lakes come first, since they stay flat.
      std::rotate(lines.segments.begin(), lines.segments.begin() + of_lines, lines.segments.end());
      split_crossings(triangulator, lines.points, lines.segments);
    }
    const std::vector<double>&coordinates = lines.points.coordinates, &heights = lines.points.heights;
    fixed = heights.size();
    terrain.coordinates.insert(terrain.coordinates.begin(), coordinates.begin(), coordinates.end());
    terrain.heights.insert(terrain.heights.begin(), heights.begin(), heights.end());
    Constraints constraints;
    constraints.segments = lines.segments.data();
    constraints.segment_count = lines.segments.size() / 2;
    terrain.mesh = triangulator.constrained(terrain.coordinates.data(), terrain.heights.size(), constraints);
  });
  merge_heights(terrain, fixed, duplicates);
  return terrain;
}

}  // namespace flaunay::cli
