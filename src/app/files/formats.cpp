#include "app/files/formats.hpp"

#include <algorithm>
#include <array>

#include "app/files/geojson.hpp"
#include "app/files/las.hpp"
#include "app/files/mesh_formats.hpp"
#include "app/files/npy.hpp"
#include "app/files/poly.hpp"

namespace flaunay::io {
namespace {

constexpr std::string_view kPairsOfText = "two numbers a line";

constexpr std::array<Format, 17> kFormats = {{
    {.ending = ".npy",
     .content = "a NumPy array of shape (n, 2)",
     .records = npy_points,
     .segments = read_npy_segments,
     .triangles = read_npy_triangles,
     .points_out = &kNpyPoints,
     .mesh_out = write_npy_triangles},
    {.ending = ".node", .content = "Triangle's .node format", .text = node_text, .points_out = &kNodePoints},
    {.ending = ".xy", .content = kPairsOfText, .text = pair_text, .points_out = &kTextPoints},
    {.ending = ".txt",
     .content = kPairsOfText,
     .text = pair_text,
     .segments = read_text_segments,
     .points_out = &kTextPoints},
    {.ending = ".csv",
     .content = kPairsOfText,
     .text = pair_text,
     .segments = read_text_segments,
     .points_out = &kCsvPoints},
    {.ending = ".bin",
     .content = "pairs of little-endian float64",
     .records = binary_points,
     .points_out = &kBinaryPoints},
    {.ending = ".las", .content = "an uncompressed LAS file", .records = las_points},
    {.ending = ".laz", .refuse = refuse_compressed},
    {.ending = ".poly", .map = read_poly_map, .beside = ".node"},
    {.ending = ".geojson", .map = read_geojson, .mesh_out = write_geojson, .has_labels = true},
    {.ending = ".json", .map = read_geojson},
    {.ending = ".ele",
     .triangles = read_ele,
     .mesh_out = write_ele,
     .has_labels = true,
     .beside = ".node",
     .constraints_beside = ".poly"},
    {.ending = ".off", .triangles = read_off, .mesh_out = write_off},
    {.ending = ".obj", .triangles = read_obj, .mesh_out = write_obj},
    {.ending = ".ply", .triangles = read_ply, .mesh_out = write_ply},
    {.ending = ".vtu", .mesh_out = write_vtu, .has_labels = true},
    {.ending = ".svg", .mesh_out = write_svg, .has_labels = true},
}};

bool is_for(const Format& format, Use use) {
  switch (use) {
    case Use::read_points:
      return format.records != nullptr || format.text != nullptr || format.map != nullptr;
    case Use::read_records:
      return format.records != nullptr;
    case Use::read_map:
      return format.map != nullptr;
    case Use::read_segments:
      return format.segments != nullptr;
    case Use::read_triangles:
      return format.triangles != nullptr;
    case Use::write_points:
      return format.points_out != nullptr;
    case Use::write_mesh:
      return format.mesh_out != nullptr;
  }
  return false;
}

}  // namespace

const Format* find_format(const std::string& path, Use use) {
  const bool is_stream = path == "-" && (use == Use::read_points || use == Use::write_points);
  const std::string ending = is_stream ? ".txt" : ending_of(path);
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& format) { return format.ending == ending; });
  if (found == kFormats.end()) return nullptr;
  if (use == Use::read_points && found->refuse != nullptr) found->refuse(path);
  return is_for(*found, use) ? &*found : nullptr;
}

const Format& format_of(const std::string& path, Use use) {
  const Format* const found = find_format(path, use);
  if (found != nullptr) return *found;
  fail_ending(path, endings_for(use) + (use == Use::read_points    ? ", or \"-\" for standard input"
                                        : use == Use::write_points ? ", or \"-\" for standard output"
                                                                   : ""));
}

std::string endings_for(Use use) {
  std::string endings;
  for (const Format& format : kFormats) {
    if (is_for(format, use)) endings += (endings.empty() ? "" : ", ") + std::string(format.ending);
  }
  return endings;
}

}  // namespace flaunay::io
