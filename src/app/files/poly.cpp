// Triangle's .poly files: vertices, segments, holes and regions.
#include <string_view>
#include <utility>

#include "app/files/formats.hpp"
#include "app/files/node.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

/// Reads the sections of a file in their order.
class PolyReader {
 public:
  PolyReader(const std::string& path, std::string_view text, const NodeFile* nodes)
      : path_(path), lines_(path, text, Lines::Separator::blanks), nodes_(nodes) {
    map_.has_others = true;
  }

  Map read() {
    read_vertices();
    read_segments();
    read_holes();
    read_regions();
    if (lines_.next()) lines_.fail_line("expected the end of the file after the regions");
    return std::move(map_);
  }

 private:
  /// A section: how many lines it has, and the line that says so.
  struct Section {
    long long size = 0;
    std::size_t header_line = 0;
  };

  void read_vertices() {
    NodeVertices vertices(nullptr, &map_.points.markers);
    if (lines_.next()) vertices.read_header(lines_);
    if (vertices.has_header() && vertices.size() == 0) return take_vertices_of_node_file();
    while (vertices.left() > 0 && lines_.next()) vertices.read_vertex(lines_, map_.points.coordinates);
    vertices.check_complete(path_);
    base_ = vertices.base();
    vertices_ = static_cast<long long>(vertices.size());
  }

  void take_vertices_of_node_file() {
    if (nodes_ != nullptr) {
      base_ = nodes_->base;
      vertices_ = static_cast<long long>(nodes_->points.size());
      return;
    }
    const std::string path = path_beside(path_, ".node");
    if (!system::is_readable(path)) {
      fail(path_, "has no vertices, and {} cannot be opened: {}", path, system_reason(errno));
    }
    NodeFile own = read_node(path, false);
    base_ = own.base;
    vertices_ = static_cast<long long>(own.points.size());
    map_.points = std::move(own.points);
  }

  /// The first number of a section's header, whose other fields are left.
  Section read_header(std::string_view what) {
    if (!lines_.next()) fail(path_, "ends before the line with the number of {}", what);
    const long long size = lines_.integer(fmt::format("the number of {}", what));
    if (size < 0) lines_.fail_line("{} {}; expected 0 or more", size, what);
    return {size, lines_.number()};
  }

  /// Goes to the next line of a section. read: the lines read so far.
  void next_row(const Section& section, long long read, std::string_view what) {
    if (!lines_.next()) {
      fail(path_, "line {}: {} {} expected, but the file ends after {}", section.header_line, section.size,
           what, read);
    }
  }

  void check_fields(std::size_t least, std::size_t most, std::string_view names) {
    const std::size_t found = lines_.count_fields();
    if (found >= least && found <= most) return;
    const std::string number = least == most ? std::to_string(least) : fmt::format("{} or {}", least, most);
    lines_.fail_line("expected {} fields ({}), found {}", number, names, found);
  }

  void read_segments() {
    const Section section = read_header("segments");
    const std::size_t header_fields = lines_.count_fields();
    if (header_fields > 2) {
      lines_.fail_line("the header has {} fields; expected up to 2: segments, markers", header_fields);
    }
    lines_.integer("the number of segments");
    const bool has_markers = header_fields > 1 && marker_count(lines_) == 1;
    for (long long k = 0; k < section.size; ++k) {
      next_row(section, k, "segments");
      check_fields(
          3, has_markers ? 4 : 3,
          has_markers ? "segment number, 2 vertices, 1 marker" : "segment number, 2 vertices, 0 markers");
      // As in Triangle, the order of the lines counts, and not how they are numbered.
      lines_.integer("a segment number");
      for (int end = 0; end < 2; ++end) {
        map_.segments.push_back(
            checked_index(lines_, "vertex", lines_.integer("a vertex number"), base_, vertices_));
      }
      if (std::string_view marker; has_markers) {
        map_.segment_markers.push_back(lines_.field(marker) ? boundary_marker(lines_, marker) : 0);
      }
    }
  }

  /// The next field, one that is there.
  double read_number(std::string_view what) {
    std::string_view text;
    lines_.field(text);
    double value = 0;
    if (parse_number(text, value) != ParsedNumber::fine || !std::isfinite(value)) {
      lines_.fail_field(text, "expected a finite number ({}), found {}", what, quoted(text));
    }
    return value;
  }

  void read_holes() {
    const Section section = read_header("holes");
    for (long long k = 0; k < section.size; ++k) {
      next_row(section, k, "holes");
      check_fields(3, 3, "hole number, x, y");
      lines_.integer("a hole number");
      for (int axis = 0; axis < 2; ++axis) map_.holes.push_back(read_number("a coordinate of a hole"));
    }
  }

  void read_regions() {
    if (!lines_.next()) return;
    const long long regions = lines_.integer("the number of regions");
    if (regions < 0) lines_.fail_line("{} regions; expected 0 or more", regions);
    const Section section = {regions, lines_.number()};
    for (long long k = 0; k < regions; ++k) {
      next_row(section, k, "regions");
      check_fields(4, 5, "region number, x, y, attribute, largest area");
      const bool has_area = lines_.count_fields() == 5;
      lines_.integer("a region number");
      PolyRegion region;
      for (double& coordinate : region.place) coordinate = read_number("a coordinate of a region");
      region.attribute = read_number("the attribute of a region");
      if (has_area) region.area = read_number("the largest area of a region");
      map_.regions.push_back(region);
    }
  }

  const std::string& path_;
  Lines lines_;
  const NodeFile* nodes_;
  Map map_;
  long long base_ = 0, vertices_ = 0;
};

Map read_poly_map(const std::string& path, const Columns&) { return read_poly(path, nullptr); }

}  // namespace

const Format kPoly = {.ending = ".poly", .map = read_poly_map, .beside = {".node"}};

Map read_poly(const std::string& path, const NodeFile* nodes) {
  const std::string text = read_file(path, "Triangle's .poly format");
  return PolyReader(path, text, nodes).read();
}

}  // namespace flaunay::io
