#include "app/files/map.hpp"

#include <string_view>
#include <utility>

#include "app/files/geojson.hpp"
#include "app/files/npy.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

constexpr std::string_view kSegmentEndings = ".npy, .txt or .csv";

bool is_poly(const std::string& path) { return ending_of(path) == ".poly"; }

std::vector<std::int32_t> read_text_segments(const std::string& path, std::size_t points) {
  const std::string text = read_file(path, "two indices a line");
  Lines lines(path, text, Lines::Separator::blanks_or_comma);
  bool more = lines.next();
  if (more && is_header(lines)) more = lines.next();
  std::vector<std::int32_t> segments;
  for (; more; more = lines.next()) {
    const std::size_t fields = lines.count_fields();
    if (fields != 2) lines.fail_line("expected two indices (the ends of a segment), found {}", fields);
    for (int end = 0; end < 2; ++end) {
      segments.push_back(checked_index(lines, "index", lines.integer("the index of a point"), 0,
                                       static_cast<long long>(points)));
    }
  }
  return segments;
}

Map map_of(PolyFile file) {
  Map map;
  map.has_others = true;
  map.points = std::move(file.points);
  map.segments = std::move(file.segments);
  map.holes = std::move(file.holes);
  map.segment_markers = std::move(file.markers);
  map.regions = std::move(file.regions);
  return map;
}

}  // namespace

bool is_map(const std::string& path) {
  const std::string ending = ending_of(path);
  return ending == ".poly" || ending == ".geojson" || ending == ".json";
}

Map read_map(const std::string& path) { return is_poly(path) ? map_of(read_poly(path)) : read_geojson(path); }

std::vector<std::string> files_of_map(const std::string& path) {
  if (!is_poly(path)) return {path};
  return {path, path_beside(path, ".node")};
}

std::vector<std::int32_t> read_segments(const std::string& path, std::size_t points) {
  check_segments_ending(path);
  return ending_of(path) == ".npy" ? read_npy_segments(path, points) : read_text_segments(path, points);
}

void check_segments_ending(const std::string& path) {
  const std::string ending = ending_of(path);
  if (ending != ".npy" && ending != ".txt" && ending != ".csv") fail_ending(path, kSegmentEndings);
}

}  // namespace flaunay::io
