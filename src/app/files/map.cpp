#include "app/files/map.hpp"

#include "app/files/formats.hpp"

namespace flaunay::io {

bool is_map(const std::string& path) { return find_format(path, Use::read_map) != nullptr; }

Map read_map(const std::string& path) { return format_of(path, Use::read_map).map(path); }

std::vector<std::string> files_of_map(const std::string& path) {
  const Format& format = format_of(path, Use::read_map);
  if (format.beside.ending.empty()) return {path};
  return {path, path_beside(path, format.beside.ending)};
}

std::vector<std::int32_t> read_segments(const std::string& path, std::size_t points) {
  return format_of(path, Use::read_segments).segments(path, points);
}

void check_segments_ending(const std::string& path) { format_of(path, Use::read_segments); }

}  // namespace flaunay::io
