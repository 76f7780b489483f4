#include "app/files/formats.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/files/layers.hpp"

namespace flaunay::io {
namespace {

/// In the order of messages.
constexpr const Format* kFormats[] = {&kNpy, &kNode, &kXy,      &kXyz,  &kTxt, &kCsv, &kBin,    &kLas,
                                      &kLaz, &kPoly, &kGeoJson, &kJson, &kEle, &kOff, &kObj,    &kPly,
                                      &kMsh, &kVtu,  &kSvg,     &kGpkg, &kShp, &kFgb, &kParquet};

}  // namespace

const Format* find_format(const std::string& path, Use::Test use) {
  const bool is_read = use == Use::read_points || use == Use::read_map;
  std::string ending = ending_of(is_read ? without_layer(path) : path);
  if (path == "-" && (use == Use::read_points || use == Use::write_points)) ending = ".txt";
  if (path == "-" && (use == Use::write_mesh || use == Use::has_heights)) ending = ".off";
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format* format) { return format->ending == ending; });
  if (found == std::end(kFormats)) return nullptr;
  if (use == Use::read_points && (*found)->refuse != nullptr) (*found)->refuse(path);
  return use(**found) ? *found : nullptr;
}

const Format& format_of(const std::string& path, Use::Test use) {
  const Format* const found = find_format(path, use);
  if (found != nullptr) return *found;
  fail_ending(path, endings_for(use) + (use == Use::read_points ? ", or \"-\" for standard input"
                                        : use == Use::write_points || use == Use::write_mesh
                                            ? ", or \"-\" for standard output"
                                            : ""));
}

std::string endings_for(Use::Test use) {
  std::string endings;
  for (const Format* format : kFormats) {
    if (use(*format)) endings += (endings.empty() ? "" : ", ") + std::string(format->ending);
  }
  return endings;
}

std::string path_beside(const std::string& path, std::string_view ending) {
  return path.substr(0, path.size() - ending_of(path).size()).append(ending);
}

void Map::add_line(std::size_t first) {
  for (std::size_t i = first + 1; i < points.size(); ++i)
    lines.insert(lines.end(), {static_cast<std::int32_t>(i - 1), static_cast<std::int32_t>(i)});
  has_others = true;
}

bool Map::add_ring(std::size_t first) {
  std::vector<double>& coordinates = points.coordinates;
  std::size_t end = points.size();
  const bool is_closed = end - first > 1 && coordinates[2 * first] == coordinates[2 * end - 2] &&
                         coordinates[2 * first + 1] == coordinates[2 * end - 1];
  if (is_closed) {
    coordinates.resize(2 * --end);
    points.heights.resize(std::min(points.heights.size(), end));
  }
  for (std::size_t i = first; i < end; ++i) {
    const std::size_t next = i + 1 < end ? i + 1 : first;
    segments.insert(segments.end(), {static_cast<std::int32_t>(i), static_cast<std::int32_t>(next)});
  }
  ring_offsets.push_back(segments.size() / 2);
  return is_closed;
}

void Map::complete_heights(const std::string& path) {
  std::vector<double>& heights = points.heights;
  const auto unknown = std::count_if(heights.begin(), heights.end(), [](double z) { return std::isnan(z); });
  const bool has_none = unknown == static_cast<std::ptrdiff_t>(heights.size());
  if (unknown > 0 && !has_none && has_height_field)
    points.notes.push_back(
        fmt::format("{}: {} of {} positions have no height", path, unknown, heights.size()));
  if (has_none) heights = {};
}

std::string Map::known_fields() const {
  return field_names.empty() ? "it has no fields"
                             : fmt::format("its fields are {}", fmt::join(field_names, ", "));
}

void Map::check_height_field(const std::string& path, const std::vector<std::string>& fields,
                             std::string_view option) const {
  if (fields.empty()) return;
  const std::string names = fmt::format("{}", fmt::join(fields, " or "));
  if (!has_height_field) fail(path, "has no field {}, of {}; {}", names, option, known_fields());
  if (points.heights.empty()) fail(path, "has no value in the field {}, of {}", names, option);
}

bool is_map(const std::string& path) { return find_format(path, Use::read_map) != nullptr; }

Map read_map(const std::string& path, const Columns& columns) {
  return format_of(path, Use::read_map).map(path, columns);
}

Map read_lines(const std::string& path, const Columns& columns, const std::vector<std::string>& heights) {
  Map map = read_map(path, {{}, heights.empty() ? columns.heights : heights, {}});
  map.check_height_field(path, heights, "--line-height");
  return map;
}

bool has_fields(const std::string& path) {
  const Format* const format = find_format(path, Use::read_map);
  return format != nullptr && (Use::write_layer(*format) || format->map == kGeoJson.map);
}

std::string without_layer(const std::string& path) {
  for (std::size_t colon = path.find(':'); colon != std::string::npos; colon = path.find(':', colon + 1)) {
    const std::string file = path.substr(0, colon), ending = ending_of(file);
    const auto is_it = [&](const Format* each) { return Use::write_layer(*each) && each->ending == ending; };
    if (std::any_of(std::begin(kFormats), std::end(kFormats), is_it)) return file;
  }
  return path;
}

std::vector<std::string> files_of_map(const std::string& path) {
  const Format& format = format_of(path, Use::read_map);
  if (format.beside.ending.empty()) return {without_layer(path)};
  return {path, path_beside(path, format.beside.ending)};
}

std::vector<std::int32_t> read_segments(const std::string& path, std::size_t points) {
  return format_of(path, Use::read_segments).segments(path, points);
}

void check_segments_ending(const std::string& path) { format_of(path, Use::read_segments); }

}  // namespace flaunay::io
