#include "app/files/points.hpp"

#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "app/files/las.hpp"
#include "app/files/map.hpp"
#include "app/files/npy.hpp"
#include "app/files/point_text.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

constexpr std::string_view kPointInputEndings =
    ".npy, .node, .xy, .txt, .csv, .bin, .las, .poly, .geojson, .json, or \"-\" for standard input";
constexpr std::string_view kPointOutputEndings =
    ".npy, .node, .xy, .txt, .csv, .bin, or \"-\" for standard output";
/// The first line of a .node file.
constexpr const char kNodeHeader[] = "{} 2 0 {}\n";

PointFormat format_of(const std::string& path, std::string_view expected) {
  if (path == "-") return PointFormat::text;
  const std::string ending = ending_of(path);
  if (ending == ".npy") return PointFormat::npy;
  if (ending == ".node") return PointFormat::node;
  if (ending == ".xy" || ending == ".txt" || ending == ".csv") return PointFormat::text;
  if (ending == ".bin") return PointFormat::binary;
  if (ending == ".las") return PointFormat::las;
  if (is_map(path)) return PointFormat::map;
  fail_ending(path, expected);
}

PointFormat point_output_format(const std::string& path) {
  const PointFormat format = format_of(path, kPointOutputEndings);
  if (format == PointFormat::las || format == PointFormat::map) fail_ending(path, kPointOutputEndings);
  return format;
}

/// For the binary formats. The readers of text check each number, because their messages name the line.
void check_finite(const std::string& path, const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.coordinates[2 * i], y = points.coordinates[2 * i + 1];
    if (!std::isfinite(x) || !std::isfinite(y)) {
      fail(path, "point {} is ({}, {}); expected finite numbers", i, x, y);
    }
  }
}

Points read_text(const std::string& path) {
  const std::string text = read_file(path, expected_text(path));
  Points points;
  const std::unique_ptr<PointText> parser = parse_points(path);
  parser->parse(text, points.coordinates);
  parser->finish();
  return points;
}

Points read_binary(const std::string& path) {
  const std::string bytes = read_file(path, kPairs);
  Points points;
  points.coordinates.resize(2 * count_pairs(path, bytes.size()));
  std::memcpy(points.coordinates.data(), bytes.data(), bytes.size());
  return points;
}

}  // namespace

void print_node_points(OutputFile& file, const double* coordinates, std::uint64_t first, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    file.print("{} {} {}\n", first + i, coordinates[2 * i], coordinates[2 * i + 1]);
  }
}

void print_node(OutputFile& file, const Points& points) {
  file.print(kNodeHeader, points.size(), points.markers.empty() ? 0 : 1);
  if (points.markers.empty()) return print_node_points(file, points.coordinates.data(), 0, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.print("{} {} {} {}\n", i, points.coordinates[2 * i], points.coordinates[2 * i + 1],
               points.markers[i]);
  }
}

PointFormat point_format(const std::string& path) {
  if (ending_of(path) == ".laz") fail_compressed(path);
  return format_of(path, kPointInputEndings);
}
void check_points_ending(const std::string& path) { point_format(path); }
void check_points_output(const std::string& path) { point_output_format(path); }

std::uint64_t count_pairs(const std::string& path, std::uint64_t bytes) {
  constexpr std::uint64_t kPair = 2 * sizeof(double);
  if (bytes % kPair != 0) {
    fail(path, "has {} bytes, {} after the last whole pair; expected a multiple of 16 (float64 pairs)", bytes,
         bytes % kPair);
  }
  return bytes / kPair;
}

Points read_points(const std::string& path) {
  const PointFormat format = point_format(path);
  if (format == PointFormat::node || format == PointFormat::text) return read_text(path);
  if (format == PointFormat::map) return read_map(path).points;
  Points points = format == PointFormat::npy   ? read_npy_points(path)
                  : format == PointFormat::las ? read_las_points(path)
                                               : read_binary(path);
  check_finite(path, points);
  return points;
}

PointWriter::PointWriter(Outputs& outputs, const std::string& path, std::uint64_t n)
    : format_(point_output_format(path)), separator_(ending_of(path) == ".csv" ? ',' : ' ') {
  if (format_ == PointFormat::binary && n == 0) {
    fail(path,
         "a .bin of no points would be an empty file, which no one can tell from a failed write; "
         "expected points, or another ending");
  }
  file_ = &outputs.open(path);
  if (format_ == PointFormat::npy) {
    const std::string header = npy_header("<f8", n, 2);
    file_->write(header.data(), header.size());
  } else if (format_ == PointFormat::node) {
    file_->print(kNodeHeader, n, 0);
  } else if (format_ == PointFormat::text) {
    // Every reader skips this line. With it, a file of no points can be read back.
    file_->print("{}", separator_ == ',' ? "x,y\n" : "# x y\n");
  }
}

void PointWriter::write(const double* coordinates, std::size_t count) {
  if (format_ == PointFormat::node) {
    print_node_points(*file_, coordinates, written_, count);
  } else if (format_ == PointFormat::text) {
    for (std::size_t i = 0; i < count; ++i) {
      file_->print("{}{}{}\n", coordinates[2 * i], separator_, coordinates[2 * i + 1]);
    }
  } else {
    file_->write(coordinates, 2 * count * sizeof(double));
  }
  written_ += count;
}

void write_points(Outputs& outputs, const std::string& path, const Points& points) {
  if (!points.markers.empty() && point_output_format(path) == PointFormat::node) {
    return print_node(outputs.open(path), points);
  }
  PointWriter(outputs, path, points.size()).write(points.coordinates.data(), points.size());
}

}  // namespace flaunay::io
