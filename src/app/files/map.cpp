#include "app/files/map.hpp"

#include <utility>

#include "app/files/formats.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
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

Map read_poly_map(const std::string& path) {
  PolyFile file = read_poly(path);
  Map map;
  map.has_others = true;
  map.points = std::move(file.points);
  map.segments = std::move(file.segments);
  map.holes = std::move(file.holes);
  map.segment_markers = std::move(file.markers);
  map.regions = std::move(file.regions);
  return map;
}

bool is_map(const std::string& path) { return find_format(path, Use::read_map) != nullptr; }

Map read_map(const std::string& path) { return format_of(path, Use::read_map).map(path); }

std::vector<std::string> files_of_map(const std::string& path) {
  const Format& format = format_of(path, Use::read_map);
  if (format.beside.empty()) return {path};
  return {path, path_beside(path, format.beside)};
}

std::vector<std::int32_t> read_segments(const std::string& path, std::size_t points) {
  return format_of(path, Use::read_segments).segments(path, points);
}

void check_segments_ending(const std::string& path) { format_of(path, Use::read_segments); }

}  // namespace flaunay::io
