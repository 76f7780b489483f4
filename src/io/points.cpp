#include "io/points.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "io/file.hpp"
#include "io/npy.hpp"
#include "io/text.hpp"

namespace flaunay::io {
namespace {

constexpr std::string_view kEndings = ".npy, .node, .xy, .txt, .csv, .bin, or \"-\" for standard input";

enum class Format { npy, node, text, binary };

Format format_of(const std::string& path) {
  if (path == "-") return Format::text;
  const std::string ending = ending_of(path);
  if (ending == ".npy") return Format::npy;
  if (ending == ".node") return Format::node;
  if (ending == ".xy" || ending == ".txt" || ending == ".csv") return Format::text;
  if (ending == ".bin") return Format::binary;
  fail_ending(path, kEndings);
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
  const std::string text = read_file(path, "two numbers a line");
  Lines lines(shown_path(path), text, Lines::Separator::blanks_or_comma);
  Points points;
  bool more = lines.next();
  std::string_view hint = "; if this line is a header, begin it with '#'";
  if (more && is_header(lines)) {
    more = lines.next();
    hint = "";
  }
  if (more) points.coordinates.reserve(2 * lines.lines_left());
  for (std::size_t point = 0; more; more = lines.next(), ++point) {
    std::string_view x, y, extra;
    if (!lines.field(x) || !lines.field(y) || lines.field(extra)) {
      lines.fail_line("expected two numbers (x and y), found {}", lines.count_fields());
    }
    points.coordinates.push_back(lines.coordinate(x, point, hint));
    points.coordinates.push_back(lines.coordinate(y, point, hint));
    hint = "";
  }
  return points;
}

/// Reads a vertex's first attribute as an index.
std::int32_t read_index_attribute(Lines& lines) {
  constexpr long long kMostIndices = std::numeric_limits<std::int32_t>::max();
  return checked_index(lines, "index", lines.integer("the index of a point"), 0, kMostIndices);
}

}  // namespace

NodeFile read_node(const std::string& path, bool with_indices) {
  const std::string text = read_file(path, "Triangle's .node format");
  Lines lines(path, text, Lines::Separator::blanks);
  if (!lines.next()) fail(path, "has no header line; expected \"vertices 2 attributes markers\"");
  const std::size_t header_line = lines.number();
  const std::size_t header_fields = lines.count_fields();
  if (header_fields > 4) {
    lines.fail_line("the header has {} fields; expected up to 4: vertices, 2, attributes, markers",
                    header_fields);
  }
  // As in Triangle, the defaults of a short header are two dimensions, no attributes and no markers.
  const long long vertices = lines.integer("the number of vertices");
  const long long dimensions = header_fields > 1 ? lines.integer("the number of dimensions") : 2;
  const long long attributes = header_fields > 2 ? attribute_count(lines) : 0;
  const long long markers = header_fields > 3 ? lines.integer("the number of boundary markers") : 0;
  if (vertices < 0) lines.fail_line("{} vertices; expected 0 or more", vertices);
  if (dimensions != 2) lines.fail_line("{} dimensions; expected 2", dimensions);
  if (markers != 0 && markers != 1) lines.fail_line("{} boundary markers; expected 0 or 1", markers);
  if (with_indices && attributes == 0) lines.fail_line("no attributes; expected one, an index");

  NodeFile file;
  Points& points = file.points;
  points.coordinates.reserve(2 * std::min(static_cast<std::size_t>(vertices), lines.lines_left()));
  long long read = 0;
  for (; lines.next(); ++read) {
    if (read == vertices) {
      lines.fail_line("more vertices than the {} of the header (line {})", vertices, header_line);
    }
    const long long number = lines.integer("a vertex number");
    if (read == 0) {
      if (number != 0 && number != 1)
        lines.fail_line("expected vertex number 0 or 1 first, found {}", number);
      file.base = number;
    }
    if (number != file.base + read) {
      lines.fail_line("expected vertex number {}, found {}", file.base + read, number);
    }
    std::string_view x, y, extra;
    const bool complete = lines.field(x) && lines.field(y);
    if (complete && with_indices) file.indices.push_back(read_index_attribute(lines));
    while (complete && lines.field(extra)) {
    }
    const auto expected_fields = static_cast<std::size_t>(3 + attributes + markers);
    if (!complete || lines.fields_taken() != expected_fields) {
      lines.fail_line("expected {} fields (vertex number, x, y, {} attributes, {} markers), found {}",
                      expected_fields, attributes, markers, lines.fields_taken());
    }
    const auto point = static_cast<std::size_t>(read);
    points.coordinates.push_back(lines.coordinate(x, point));
    points.coordinates.push_back(lines.coordinate(y, point));
  }
  if (read != vertices) {
    fail(path, "line {}: the header says {} vertices, but the file ends after {}", header_line, vertices,
         read);
  }
  return file;
}

namespace {

Points read_binary(const std::string& path) {
  const std::string bytes = read_file(path, "pairs of little-endian float64");
  constexpr std::size_t kPair = 2 * sizeof(double);
  if (bytes.size() % kPair != 0) {
    fail(path, "has {} bytes, {} after the last whole pair; expected a multiple of 16 (float64 pairs)",
         bytes.size(), bytes.size() % kPair);
  }
  Points points;
  points.coordinates.resize(bytes.size() / sizeof(double));
  std::memcpy(points.coordinates.data(), bytes.data(), bytes.size());
  return points;
}

void write_text(Outputs& outputs, const std::string& path, const Points& points) {
  OutputFile& file = outputs.open(path);
  // Every reader skips this line. With it, a file of no points can be read back.
  const bool comma = ending_of(path) == ".csv";
  file.print("{}", comma ? "x,y\n" : "# x y\n");
  const char separator = comma ? ',' : ' ';
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.print("{}{}{}\n", points.coordinates[2 * i], separator, points.coordinates[2 * i + 1]);
  }
}

void write_node(Outputs& outputs, const std::string& path, const Points& points) {
  print_node(outputs.open(path), points);
}

void write_binary(Outputs& outputs, const std::string& path, const Points& points) {
  if (points.size() == 0) {
    fail(path,
         "a .bin of no points would be an empty file, which no one can tell from a failed write; "
         "expected points, or another ending");
  }
  OutputFile& file = outputs.open(path);
  file.write(points.coordinates.data(), 2 * points.size() * sizeof(double));
}

}  // namespace

void print_node(OutputFile& file, const Points& points) {
  file.print("{} 2 0 0\n", points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.print("{} {} {}\n", i, points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
}

void check_points_ending(const std::string& path) { format_of(path); }

Points read_points(const std::string& path) {
  switch (format_of(path)) {
    case Format::node:
      return read_node(path, false).points;
    case Format::text:
      return read_text(path);
    case Format::npy: {
      Points points = read_npy_points(path);
      check_finite(path, points);
      return points;
    }
    case Format::binary: {
      Points points = read_binary(path);
      check_finite(path, points);
      return points;
    }
  }
  throw Error(ErrorKind::internal, "read_points: a format without reader");
}

void write_points(Outputs& outputs, const std::string& path, const Points& points) {
  switch (format_of(path)) {
    case Format::node:
      return write_node(outputs, path, points);
    case Format::text:
      return write_text(outputs, path, points);
    case Format::npy:
      return write_npy_points(outputs, path, points);
    case Format::binary:
      return write_binary(outputs, path, points);
  }
}

}  // namespace flaunay::io
