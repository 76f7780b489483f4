#include "app/files/formats.hpp"

#include <algorithm>

namespace flaunay::io {
namespace {

/// In the order of messages.
constexpr const Format* kFormats[] = {&kNpy, &kNode, &kXy,   &kXyz,     &kTxt,  &kCsv, &kBin,
                                      &kLas, &kLaz,  &kPoly, &kGeoJson, &kJson, &kEle, &kOff,
                                      &kObj, &kPly,  &kMsh,  &kVtu,     &kSvg};

}  // namespace

const Format* find_format(const std::string& path, Use::Test use) {
  std::string ending = ending_of(path);
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
