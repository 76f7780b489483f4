#include "app/command/terrain_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/command/errors.hpp"
#include "app/files/geotiff.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {
namespace {

// Lines between points with heights, NaN where there are none.
struct Breaklines {
  std::vector<double> coordinates, heights;
  std::vector<std::int32_t> segments;
};

Breaklines read_breaklines(const std::string& path) {
  io::Map map = io::read_map(path);
  Breaklines lines{std::move(map.points.coordinates), std::move(map.heights), std::move(map.segments)};
  lines.segments.insert(lines.segments.end(), map.lines.begin(), map.lines.end());
  if (lines.segments.empty()) io::fail(path, "has neither lines nor polygons");
  lines.heights.resize(lines.coordinates.size() / 2, std::numeric_limits<double>::quiet_NaN());
  return lines;
}

// Gives ends of lines without a height that of the points around them.
void complete_heights(Triangulator& triangulator, const TerrainMesh& points, Breaklines& lines) {
  std::vector<std::size_t> missing;
  std::vector<double> places;
  for (std::size_t i = 0; i < lines.heights.size(); ++i) {
    if (!std::isnan(lines.heights[i])) continue;
    missing.push_back(i);
    places.insert(places.end(), {lines.coordinates[2 * i], lines.coordinates[2 * i + 1]});
  }
  if (missing.empty()) return;
  const std::size_t n = points.heights.size();
  const Triangulation mesh = triangulator.triangulate(points.coordinates.data(), n);
  Locator locator(triangulator, points.coordinates.data(), n, mesh);
  const std::vector<double> found = locator.interpolate(points.heights.data(), places.data(), missing.size());
  const std::vector<std::int32_t> nearest = locator.nearest(places.data(), missing.size());
  for (std::size_t k = 0; k < missing.size(); ++k) {
    lines.heights[missing[k]] =
        std::isnan(found[k]) ? points.heights[static_cast<std::size_t>(nearest[k])] : found[k];
  }
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

TerrainMesh triangulate_scan(Triangulator& triangulator, io::Scan& scan, const std::string& breaklines,
                             Duplicates duplicates) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max() / 4;
  if (scan.size() > kMost) {
    throw Error(ErrorKind::input,
                fmt::format("{} points are too many for breaklines or contours, for which they are in "
                            "memory at once; at most {} are possible",
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
  Breaklines lines;
  if (!breaklines.empty()) {
    lines = read_breaklines(breaklines);
    complete_heights(triangulator, terrain, lines);
  }
  const std::size_t fixed = lines.heights.size();
  terrain.coordinates.insert(terrain.coordinates.begin(), lines.coordinates.begin(), lines.coordinates.end());
  terrain.heights.insert(terrain.heights.begin(), lines.heights.begin(), lines.heights.end());
  Constraints constraints;
  constraints.segments = lines.segments.data();
  constraints.segment_count = lines.segments.size() / 2;
  terrain.mesh = naming_files({{"segment", breaklines}}, [&] {
    return triangulator.constrained(terrain.coordinates.data(), terrain.heights.size(), constraints);
  });
  merge_heights(terrain, fixed, duplicates);
  return terrain;
}

std::vector<double> contour_heights(const std::vector<double>& given, const std::vector<double>& heights) {
  if (given.size() != 1 || heights.empty()) return given;
  const double step = given.front();
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  constexpr double kMost = 1e6;
  if ((*high - *low) / step > kMost) {
    throw Error(ErrorKind::usage,
                fmt::format("--contours {}: between {} and {} are more than a million", step, *low, *high));
  }
  std::vector<double> levels;
  for (double k = std::ceil(*low / step); k <= std::floor(*high / step); ++k) levels.push_back(k * step);
  return levels;
}

void write_contours(OutputFiles& outputs, const std::string& path, const Contours& contours,
                    const std::vector<double>& heights, const std::string& crs) {
  io::OutputFile& file = outputs.open(path);
  file.print("{{\"type\":\"FeatureCollection\",");
  const int code = io::epsg_code(crs);
  // As GDAL writes it. Without it, RFC 7946 says that coordinates are longitude and latitude.
  if (code != 0) {
    file.print("\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"urn:ogc:def:crs:EPSG::{}\"}}}},",
               code);
  }
  file.print("\"features\":[");
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    file.print(
        "{}\n{{\"type\":\"Feature\",\"properties\":{{\"height\":{}}},\"geometry\":{{\"type\":\"LineString\","
        "\"coordinates\":[",
        i == 0 ? "" : ",", heights[static_cast<std::size_t>(contours.heights[i])]);
    for (std::size_t p = contours.offsets[i]; p < contours.offsets[i + 1]; ++p) {
      file.print("{}[{},{}]", p == contours.offsets[i] ? "" : ",", contours.coordinates[2 * p],
                 contours.coordinates[2 * p + 1]);
    }
    file.print("]}}}}");
  }
  file.print("\n]}}\n");
}

}  // namespace flaunay::cli
