#include "app/files/node.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <string_view>

#include "app/files/formats.hpp"

namespace flaunay::io {
namespace {

/// Reads a vertex's first attribute as an index.
std::int32_t read_index_attribute(Lines& lines) {
  constexpr long long kMostIndices = std::numeric_limits<std::int32_t>::max();
  return checked_index(lines, "index", lines.integer("the index of a point"), 0, kMostIndices);
}

}  // namespace

long long attribute_count(Lines& lines) {
  constexpr long long kMost = std::numeric_limits<std::int32_t>::max();  // far more than a line holds
  const long long attributes = lines.integer("the number of attributes");
  if (attributes < 0 || attributes > kMost) {
    lines.fail_line("{} attributes; expected 0 to {}", attributes, kMost);
  }
  return attributes;
}

long long marker_count(Lines& lines) {
  const long long markers = lines.integer("the number of boundary markers");
  if (markers != 0 && markers != 1) lines.fail_line("{} boundary markers; expected 0 or 1", markers);
  return markers;
}

std::int32_t boundary_marker(const Lines& lines, std::string_view text) {
  using Limits = std::numeric_limits<std::int32_t>;
  const long long marker = lines.whole_number(text, "a boundary marker");
  if (marker < Limits::min() || marker > Limits::max()) {
    lines.fail_field(text, "boundary marker {} is out of range; expected {} to {}", marker, Limits::min(),
                     Limits::max());
  }
  return static_cast<std::int32_t>(marker);
}

void NodeVertices::read_header(Lines& lines) {
  const std::size_t fields = lines.count_fields();
  if (fields > 4) {
    lines.fail_line("the header has {} fields; expected up to 4: vertices, 2, attributes, markers", fields);
  }
  // As in Triangle, the defaults of a short header are two dimensions, no attributes and no markers.
  vertices_ = lines.integer("the number of vertices");
  const long long dimensions = fields > 1 ? lines.integer("the number of dimensions") : 2;
  attributes_ = fields > 2 ? attribute_count(lines) : 0;
  markers_ = fields > 3 ? marker_count(lines) : 0;
  if (vertices_ < 0) lines.fail_line("{} vertices; expected 0 or more", vertices_);
  if (dimensions != 2) lines.fail_line("{} dimensions; expected 2", dimensions);
  if (indices_ != nullptr && attributes_ == 0) lines.fail_line("no attributes; expected one, an index");
  header_line_ = lines.number();
}

void NodeVertices::read_vertex(Lines& lines, std::vector<double>& coordinates) {
  if (read_ == vertices_) {
    lines.fail_line("more vertices than the {} of the header (line {})", vertices_, header_line_);
  }
  const long long number = lines.integer("a vertex number");
  if (read_ == 0) {
    if (number != 0 && number != 1) lines.fail_line("expected vertex number 0 or 1 first, found {}", number);
    base_ = number;
  }
  if (number != base_ + read_) {
    lines.fail_line("expected vertex number {}, found {}", base_ + read_, number);
  }
  std::string_view x, y, extra;
  const bool complete = lines.field(x) && lines.field(y);
  if (complete && indices_ != nullptr) indices_->push_back(read_index_attribute(lines));
  while (complete && lines.field(extra)) {
  }
  const auto expected_fields = static_cast<std::size_t>(3 + attributes_ + markers_);
  if (!complete || lines.fields_taken() != expected_fields) {
    lines.fail_line("expected {} fields (vertex number, x, y, {} attributes, {} markers), found {}",
                    expected_fields, attributes_, markers_, lines.fields_taken());
  }
  const auto point = static_cast<std::size_t>(read_);
  coordinates.push_back(lines.coordinate(x, point));
  coordinates.push_back(lines.coordinate(y, point));
  if (marked_ != nullptr && markers_ == 1) marked_->push_back(boundary_marker(lines, extra));
  ++read_;
}

void NodeVertices::check_complete(const std::string& path) const {
  if (!has_header()) fail(path, "has no header line; expected \"vertices 2 attributes markers\"");
  if (read_ != vertices_) {
    fail(path, "line {}: the header says {} vertices, but the file ends after {}", header_line_, vertices_,
         read_);
  }
}

namespace {

class NodeText : public PointText {
 public:
  NodeText(const std::string& path, std::vector<std::int32_t>* indices, std::vector<std::int32_t>* markers)
      : path_(path), lines_(path, Lines::Separator::blanks), vertices_(indices, markers) {}

  void parse(std::string_view text, std::vector<double>& coordinates, std::vector<double>*) override {
    lines_.go_on(text);
    if (!vertices_.has_header() && lines_.next()) vertices_.read_header(lines_);
    if (!vertices_.has_header()) return;
    coordinates.reserve(coordinates.size() + 2 * std::min(vertices_.left(), lines_.lines_left()));
    while (lines_.next()) vertices_.read_vertex(lines_, coordinates);
  }

  void finish() override { vertices_.check_complete(path_); }

  long long base() const { return vertices_.base(); }

 private:
  std::string path_;
  Lines lines_;
  NodeVertices vertices_;
};

std::unique_ptr<PointText> node_text(const std::string& path, const Columns&) {
  return std::make_unique<NodeText>(path, nullptr, nullptr);
}

void begin_node(OutputFile& file, std::uint64_t n, bool has_markers) {
  file.print("{} 2 0 {}\n", n, has_markers ? 1 : 0);
}

void write_vertices(OutputFile& file, const double* coordinates, const std::int32_t* markers,
                    std::uint64_t first, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    file.print("{} {} {}", first + i, coordinates[2 * i], coordinates[2 * i + 1]);
    if (markers != nullptr) file.print(" {}", markers[i]);
    file.print("\n");
  }
}

}  // namespace

const Format kNode = {.ending = ".node",
                      .content = "Triangle's .node format",
                      .text = node_text,
                      .begin_points = begin_node,
                      .write_points = write_vertices,
                      .least_bytes = 4};

void write_node(OutputFile& file, const Points& points) {
  const bool has_markers = !points.markers.empty();
  begin_node(file, points.size(), has_markers);
  write_vertices(file, points.coordinates.data(), has_markers ? points.markers.data() : nullptr, 0,
                 points.size());
}

NodeFile read_node(const std::string& path, bool with_indices) {
  const std::string text = read_file(path, kNode.content);
  NodeFile file;
  NodeText parser(path, with_indices ? &file.indices : nullptr, &file.points.markers);
  parser.parse(text, file.points.coordinates, nullptr);
  parser.finish();
  file.base = parser.base();
  return file;
}

}  // namespace flaunay::io
