// Triangle's .node and .poly files, which both have vertices: a header, and then a line per vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/points.hpp"
#include "app/files/text.hpp"
#include "files/output.hpp"

namespace flaunay::io {

/// Reads the lines one by one. Throws Error(input) that names the line.
class NodeVertices {
 public:
  /// indices: where the first attribute of each vertex goes, which must be an index; markers: where their
  /// boundary markers go, if there are some. Null for none.
  explicit NodeVertices(std::vector<std::int32_t>* indices = nullptr,
                        std::vector<std::int32_t>* markers = nullptr)
      : indices_(indices), marked_(markers) {}

  bool has_header() const { return header_line_ > 0; }
  void read_header(Lines& lines);
  /// Appends a vertex, which must be one of those that the header promises.
  void read_vertex(Lines& lines, std::vector<double>& coordinates);
  /// Throws unless there were as many vertices as the header says.
  void check_complete(const std::string& path) const;

  /// The number of the vertices, and how many of them were not read yet.
  std::size_t size() const { return static_cast<std::size_t>(vertices_); }
  std::size_t left() const { return static_cast<std::size_t>(vertices_ - read_); }
  /// The number of the first vertex, 0 or 1.
  long long base() const { return base_; }

 private:
  std::vector<std::int32_t>* indices_;
  std::vector<std::int32_t>* marked_;
  std::size_t header_line_ = 0;  // 0: not read yet
  long long vertices_ = 0, attributes_ = 0, markers_ = 0;
  long long base_ = 0;
  long long read_ = 0;  // vertices
};

/// The number of attributes and of boundary markers, 0 or 1, in a header of Triangle's formats.
long long attribute_count(Lines& lines);
long long marker_count(Lines& lines);
/// A field of the line as a boundary marker.
std::int32_t boundary_marker(const Lines& lines, std::string_view text);

struct NodeFile {
  Points points;
  long long base = 0;                 // the number of the first vertex, 0 or 1
  std::vector<std::int32_t> indices;  // the first attribute of each vertex, if asked for
};
NodeFile read_node(const std::string& path, bool with_indices);

/// Reads a .poly file. nodes: the vertices that one without its own refers to, which the map then does not
/// have; null to read them from the .node file beside it. Throws Error(input) that names the line.
Map read_poly(const std::string& path, const NodeFile* nodes);

/// Writes a .node file, numbered from 0, without attributes, and with markers if there are some.
void write_node(OutputFile& file, const Points& points);

}  // namespace flaunay::io
