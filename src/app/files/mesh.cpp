#include "app/files/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <set>
#include <string_view>

#include "app/files/formats.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/layers.hpp"
#include "app/files/node.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

constexpr long long kIndexLimit = std::numeric_limits<std::int32_t>::max();

void write_ele(OutputFile& file, const MeshContents& contents) {
  const ConstrainedTriangulation& constraints = contents.constraints();
  const std::vector<double>& attributes = constraints.triangle_attributes;
  const bool has_attributes = !attributes.empty(), has_labels = contents.has_labels();
  file.print("{} 3 {}\n", contents.triangle_count(), (has_attributes ? 1 : 0) + (has_labels ? 2 : 0));
  for (std::size_t t = 0; t < contents.triangle_count(); ++t) {
    const std::int32_t* corner = contents.corners(t);
    file.print("{} {} {} {}", t, corner[0], corner[1], corner[2]);
    if (has_attributes) file.print(" {}", attributes[t]);
    if (has_labels) file.print(" {} {}", constraints.regions[t], constraints.depths[t]);
    file.print("\n");
  }
}

void write_vertices_beside(OutputFile& file, const MeshContents& contents) {
  write_node(file, contents.points);
}

/// The constraint edges, whose vertices are in the .node file.
void write_poly_beside(OutputFile& file, const MeshContents& contents) {
  const ConstrainedTriangulation& mesh = contents.constraints();
  const std::vector<std::int32_t>& edges = mesh.constraint_edges;
  const Map& map = *contents.map;
  file.print("0 2 0 0\n{} 1\n", edges.size() / 2);
  for (std::size_t e = 0; e < edges.size() / 2; ++e) {
    file.print("{} {} {} {}\n", e, edges[2 * e], edges[2 * e + 1],
               mesh.edge_markers.empty() ? mesh.edge_segments[e] + 1LL : mesh.edge_markers[e]);
  }
  file.print("{}\n", map.holes.size() / 2);
  for (std::size_t k = 0; 2 * k < map.holes.size(); ++k) {
    file.print("{} {} {}\n", k, map.holes[2 * k], map.holes[2 * k + 1]);
  }
  if (!map.regions.empty()) file.print("{}\n", map.regions.size());
  for (std::size_t k = 0; k < map.regions.size(); ++k) {
    const PolyRegion& region = map.regions[k];
    file.print("{} {} {} {}{}\n", k, region.place[0], region.place[1], region.attribute,
               region.area ? fmt::format(" {}", *region.area) : "");
  }
}

/// In space, on lines that begin with the prefix.
void print_points(OutputFile& file, std::string_view prefix, const MeshContents& contents) {
  const std::vector<double>& coordinates = contents.points.coordinates;
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    file.print("{}{} {} {}\n", prefix, coordinates[2 * i], coordinates[2 * i + 1], contents.height(i));
  }
}

/// The first point has the number `base`.
void print_triangle(OutputFile& file, const std::int32_t* corner, long long base) {
  file.print("{} {} {}\n", corner[0] + base, corner[1] + base, corner[2] + base);
}

/// On lines that begin with the prefix.
void print_triangles(OutputFile& file, std::string_view prefix, const MeshContents& contents,
                     long long base) {
  for (std::size_t t = 0; t < contents.triangle_count(); ++t) {
    file.print("{}", prefix);
    print_triangle(file, contents.corners(t), base);
  }
}

void write_off(OutputFile& file, const MeshContents& contents) {
  file.print("OFF\n{} {} 0\n", contents.points.size(), contents.triangle_count());
  print_points(file, "", contents);
  print_triangles(file, "3 ", contents, 0);
}

void write_obj(OutputFile& file, const MeshContents& contents) {
  file.print("# {} vertices, {} triangles\n", contents.points.size(), contents.triangle_count());
  print_points(file, "v ", contents);
  print_triangles(file, "f ", contents, 1);
  const std::vector<std::int32_t>& edges = contents.constraints().constraint_edges;
  for (std::size_t e = 0; e < edges.size(); e += 2)
    file.print("l {} {}\n", edges[e] + 1LL, edges[e + 1] + 1LL);
}

/// The points as x, y and height.
void write_spatial_points(OutputFile& file, const MeshContents& contents) {
  const std::vector<double>& coordinates = contents.points.coordinates;
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    const double spatial[3] = {coordinates[2 * i], coordinates[2 * i + 1], contents.height(i)};
    file.write(spatial, sizeof spatial);
  }
}

/// The constraint edges are comments: meshio and others refuse any element but vertices and faces.
void write_ply(OutputFile& file, const MeshContents& contents) {
  const std::vector<std::int32_t>& edges = contents.constraints().constraint_edges;
  file.print("ply\nformat binary_little_endian 1.0\ncomment flaunay\n");
  for (std::size_t e = 0; e < edges.size(); e += 2)
    file.print("comment edge {} {}\n", edges[e], edges[e + 1]);
  file.print(
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      contents.points.size(), contents.triangle_count());
  write_spatial_points(file, contents);
  for (std::size_t t = 0; t < contents.triangle_count(); ++t) {
    file.write_value(std::uint8_t{3});
    file.write(contents.corners(t), 3 * sizeof(std::int32_t));
  }
}

void write_vtu(OutputFile& file, const MeshContents& contents) {
  constexpr std::uint8_t kVtkTriangle = 5;
  const std::size_t triangles = contents.triangle_count();
  const std::uint64_t point_bytes = contents.points.size() * 3 * sizeof(double);
  const std::uint64_t index_bytes = triangles * sizeof(std::int32_t);
  // The arrays follow the text, each after its size in bytes.
  std::uint64_t offset = 0;
  const auto declare = [&](const char* type, const char* attributes, std::uint64_t bytes) {
    file.print("<DataArray type=\"{}\" {} format=\"appended\" offset=\"{}\"/>\n", type, attributes, offset);
    offset += sizeof bytes + bytes;
  };
  file.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
      contents.points.size(), triangles);
  declare("Float64", "Name=\"Points\" NumberOfComponents=\"3\"", point_bytes);
  file.print("</Points>\n<Cells>\n");
  declare("Int32", "Name=\"connectivity\"", 3 * index_bytes);
  declare("Int64", "Name=\"offsets\"", 2 * index_bytes);
  declare("UInt8", "Name=\"types\"", triangles);
  file.print("</Cells>\n");
  if (contents.has_labels()) {
    file.print("<CellData Scalars=\"region\">\n");
    declare("Int32", "Name=\"region\"", index_bytes);
    declare("Int32", "Name=\"depth\"", index_bytes);
    file.print("</CellData>\n");
  }
  file.print("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  file.write_value(point_bytes);
  write_spatial_points(file, contents);
  file.write_value(3 * index_bytes);
  file.write(contents.mesh.triangles.data(), 3 * index_bytes);
  file.write_value(2 * index_bytes);
  for (std::size_t t = 1; t <= triangles; ++t) file.write_value(static_cast<std::int64_t>(3 * t));
  file.write_value(std::uint64_t{triangles});
  for (std::size_t t = 0; t < triangles; ++t) file.write_value(kVtkTriangle);
  if (contents.has_labels()) {
    for (const auto* labels : {&contents.constraints().regions, &contents.constraints().depths}) {
      file.write_value(index_bytes);
      file.write(labels->data(), index_bytes);
    }
  }
  file.print("\n</AppendedData>\n</VTKFile>\n");
}

/// The group of each triangle, as a number from 1 on: its attribute if all attributes are integers,
/// otherwise its polygon or its region.
std::vector<std::int64_t> physical_numbers(const MeshContents& contents) {
  const ConstrainedTriangulation& mesh = contents.constraints();
  const auto is_number = [](double attribute) {
    return attribute == std::floor(attribute) && std::fabs(attribute) <= static_cast<double>(kIndexLimit);
  };
  const std::vector<double>& attributes = mesh.triangle_attributes;
  if (!attributes.empty() && std::all_of(attributes.begin(), attributes.end(), is_number)) {
    return {attributes.begin(), attributes.end()};
  }
  std::vector<std::int64_t> numbers(contents.triangle_count(), 1);
  const std::vector<std::int32_t>& owners = mesh.polygons.empty() ? mesh.regions : mesh.polygons;
  for (std::size_t t = 0; t < owners.size(); ++t) numbers[t] = owners[t] + 1LL;
  return numbers;
}

/// Gmsh's format 2.2, which many programs read. The constraint edges are lines. Physical groups are edges of
/// one marker, and triangles of one attribute, polygon or region; elementary entities are edges of one marker
/// and triangles of one region.
void write_msh(OutputFile& file, const MeshContents& contents) {
  constexpr int kLine = 1, kTriangle = 2;
  const ConstrainedTriangulation& mesh = contents.constraints();
  const std::size_t edges = mesh.constraint_edges.size() / 2, triangles = contents.triangle_count();
  file.print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", contents.points.size());
  for (std::size_t i = 0; i < contents.points.size(); ++i) {
    file.print("{} {} {} {}\n", i + 1, contents.points.coordinates[2 * i],
               contents.points.coordinates[2 * i + 1], contents.height(i));
  }
  file.print("$EndNodes\n$Elements\n{}\n", edges + triangles);
  const std::vector<std::int32_t>& markers = mesh.edge_markers;
  const std::set<std::int32_t> distinct(markers.begin(), markers.end());
  for (std::size_t e = 0; e < edges; ++e) {
    const std::int32_t marker = markers.empty() ? 1 : markers[e];
    const auto rank = markers.empty() ? 0 : std::distance(distinct.begin(), distinct.find(marker));
    file.print("{} {} 2 {} {} {} {}\n", e + 1, kLine, marker, rank + 1, mesh.constraint_edges[2 * e] + 1LL,
               mesh.constraint_edges[2 * e + 1] + 1LL);
  }
  const std::vector<std::int64_t> physical = physical_numbers(contents);
  for (std::size_t t = 0; t < triangles; ++t) {
    file.print("{} {} 2 {} {} ", edges + t + 1, kTriangle, physical[t],
               contents.has_labels() ? mesh.regions[t] + 1LL : 1LL);
    print_triangle(file, contents.corners(t), 1);
  }
  file.print("$EndElements\n");
}

// Lines that a header counts, numbered from 0 or 1.
class NumberedLines {
  std::string path_, text_;

 public:
  NumberedLines(const std::string& path, const char* format, const char* header)
      : path_(path), text_(read_file(path, format)), lines(path, text_, Lines::Separator::blanks) {
    if (!lines.next()) fail(path, "has no header line; expected \"{}\"", header);
    header_line_ = lines.number();
    header_fields = lines.count_fields();
    count_ = lines.integer("the number of triangles");
    if (count_ < 0) lines.fail_line("{} triangles; expected 0 or more", count_);
  }

  NumberedLines(const NumberedLines&) = delete;
  NumberedLines& operator=(const NumberedLines&) = delete;

  Lines lines;
  std::size_t header_fields = 0;
  long long base = 0;  // the number of the first line

  /// Goes to the next line, behind its number; false at the end. fields: how many fields follow the number;
  /// columns: their names.
  bool next(std::size_t fields, const std::string& columns) {
    if (!lines.next()) {
      if (read_ == count_) return false;
      fail(path_, "line {}: the header says {} triangles, but the file ends after {}", header_line_, count_,
           read_);
    }
    if (read_ == count_)
      lines.fail_line("more triangles than the {} of the header (line {})", count_, header_line_);
    const std::size_t found = lines.count_fields();
    if (found != fields + 1) {
      lines.fail_line("expected {} fields (triangle number, {}), found {}", fields + 1, columns, found);
    }
    const long long number = lines.integer("a triangle number");
    if (read_ == 0) {
      if (number != 0 && number != 1)
        lines.fail_line("expected triangle number 0 or 1 first, found {}", number);
      base = number;
    }
    if (number != base + read_)
      lines.fail_line("expected triangle number {}, found {}", base + read_, number);
    ++read_;
    return true;
  }

 private:
  std::size_t header_line_ = 0;
  long long count_ = 0, read_ = 0;
};

double finite_number(Lines& lines, const char* what) {
  std::string_view text;
  double value = 0;
  if (!lines.field(text) || parse_number(text, value) != ParsedNumber::fine || !std::isfinite(value))
    lines.fail_field(text, "expected {} (a number), found {}", what, quoted_number(text));
  return value;
}

// attributes: where the first attribute of each triangle goes, if there are some; null for none.
std::vector<std::int32_t> read_ele_with(const std::string& path, std::vector<double>* first_attributes) {
  NumberedLines rows(path, "Triangle's .ele format", "triangles 3 attributes");
  Lines& lines = rows.lines;
  const long long corners = rows.header_fields > 1 ? lines.integer("the number of nodes per triangle") : 3;
  const long long attributes = rows.header_fields > 2 ? attribute_count(lines) : 0;
  if (corners != 3) lines.fail_line("{} nodes per triangle; expected 3", corners);
  std::vector<std::int32_t> triangles;
  while (rows.next(static_cast<std::size_t>(3 + attributes),
                   fmt::format("3 vertices, {} attributes", attributes))) {
    for (int corner = 0; corner < 3; ++corner) {
      triangles.push_back(
          checked_index(lines, "vertex", lines.integer("a vertex number"), rows.base, kIndexLimit));
    }
    if (attributes > 0 && first_attributes != nullptr)
      first_attributes->push_back(finite_number(lines, "an attribute"));
  }
  return triangles;
}

std::vector<std::int32_t> read_ele(const std::string& path) { return read_ele_with(path, nullptr); }

std::vector<std::int32_t> read_off(const std::string& path) {
  const std::string text = read_file(path, "the OFF format");
  Lines lines(path, text, Lines::Separator::blanks);
  std::string_view keyword;
  if (!lines.next()) fail(path, "has no first line; expected OFF");
  if (!lines.field(keyword) || keyword != "OFF") lines.fail_line("expected OFF, found {}", quoted(keyword));
  // The counts may stand on the keyword's line.
  if (lines.count_fields() == 1 && !lines.next()) fail(path, "has no line of counts after OFF");
  lines.rewind();
  if (lines.field(keyword) && keyword != "OFF") lines.rewind();
  const long long vertices = lines.integer("the number of vertices");
  const long long faces = lines.integer("the number of faces");
  if (vertices < 0 || faces < 0)
    lines.fail_line("{} vertices and {} faces; expected 0 or more", vertices, faces);

  for (long long i = 0; i < vertices; ++i) {
    if (!lines.next()) fail(path, "expected {} vertices, but the file ends after {}", vertices, i);
  }
  std::vector<std::int32_t> triangles;
  for (long long t = 0; t < faces; ++t) {
    if (!lines.next()) fail(path, "expected {} faces, but the file ends after {}", faces, t);
    const long long corners = lines.integer("the number of corners");
    if (corners != 3) lines.fail_line("a face of {} corners; expected 3", corners);
    for (int corner = 0; corner < 3; ++corner) {
      triangles.push_back(checked_index(lines, "vertex", lines.integer("a vertex number"), 0, vertices));
    }
  }
  if (lines.next()) lines.fail_line("text after the {} faces of the header", faces);
  return triangles;
}

std::vector<std::int32_t> read_obj(const std::string& path) {
  const std::string text = read_file(path, "the OBJ format");
  std::string_view keyword;
  long long vertices = 0;
  const Lines from_the_start(path, text, Lines::Separator::blanks);
  for (Lines lines = from_the_start; lines.next();) {
    if (lines.field(keyword) && keyword == "v") ++vertices;
  }
  std::vector<std::int32_t> triangles;
  long long vertices_so_far = 0;
  for (Lines lines = from_the_start; lines.next();) {
    const std::size_t fields = lines.count_fields();
    lines.field(keyword);
    if (keyword == "v") ++vertices_so_far;
    if (keyword != "f") continue;
    if (fields != 4) lines.fail_line("a face of {} corners; expected 3", fields - 1);
    std::string_view corner;
    while (lines.field(corner)) {
      // "7/2/5" is vertex 7 with a texture and a normal; negative numbers count back from the latest vertex.
      const std::string_view digits = corner.substr(0, corner.find('/'));
      long long number = 0;
      const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
      if (error != std::errc() || stop != digits.data() + digits.size()) {
        lines.fail_field(corner, "expected a vertex number, found {}", quoted(corner));
      }
      if (number < 0) number += vertices_so_far + 1;
      triangles.push_back(checked_index(lines, "vertex", number, 1, vertices));
    }
  }
  return triangles;
}

/// Bytes of one of PLY's scalar types; 0 for an unknown name.
std::size_t ply_type_bytes(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32") return 4;
  if (type == "float" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

std::vector<std::int32_t> read_ply(const std::string& path) {
  constexpr std::string_view kBegin = "ply\n", kEnd = "\nend_header\n";
  InputFile file(path, "the PLY format");
  if (file.first(kBegin.size()) != kBegin)
    fail(path, "is no PLY file; expected its first line to be \"ply\"");
  const std::string bytes = file.all();
  const std::size_t header_end = bytes.find(kEnd);
  if (header_end == std::string::npos)
    fail(path, "has no end of its PLY header; expected a line \"end_header\"");

  Lines lines(path, std::string_view(bytes).substr(0, header_end), Lines::Separator::blanks);
  lines.next();
  constexpr std::string_view kElements[] = {"vertex", "face", "edge"};
  long long counts[] = {-1, -1, -1};
  std::size_t element_bytes[] = {0, 0, 0};
  std::size_t elements = 0;  // so far
  bool binary = false, corner_list = false;
  while (lines.next()) {
    std::string_view word[5];
    std::size_t words = 0;
    while (words < 5 && lines.field(word[words])) ++words;
    const std::string_view element = elements > 0 ? kElements[elements - 1] : "";
    if (word[0] == "format") {
      binary = word[1] == "binary_little_endian" && word[2] == "1.0";
    } else if (word[0] == "element") {
      lines.rewind();
      for (int k = 0; k < 2; ++k) lines.field(word[k]);
      const long long count = lines.integer("the number of elements");
      if (count < 0) lines.fail_line("{} elements; expected 0 or more", count);
      if (elements == std::size(kElements) || word[1] != kElements[elements]) {
        lines.fail_line("element {}; expected vertex, then face, and perhaps edge", quoted(word[1]));
      }
      counts[elements++] = count;
    } else if (word[0] == "property" && (element == "vertex" || element == "edge")) {
      const std::size_t size = ply_type_bytes(word[1]);
      if (size == 0) lines.fail_line("{} property of type {}; expected a number's", element, quoted(word[1]));
      element_bytes[elements - 1] += size;
    } else if (word[0] == "property" && element == "face") {
      const bool known = word[1] == "list" && ply_type_bytes(word[2]) == 1 && ply_type_bytes(word[3]) == 4 &&
                         word[3] != "float" && word[3] != "float32";
      if (!known || corner_list)
        lines.fail_line("expected the one face property \"list uchar int vertex_indices\"");
      corner_list = true;
    } else if (word[0] != "comment" && word[0] != "obj_info") {
      lines.fail_line("expected a PLY header line, found {}", quoted(word[0]));
    }
  }
  const auto [vertices, faces, edges] = counts;
  const std::size_t vertex_bytes = element_bytes[0], edge_bytes = element_bytes[2];
  if (!binary) fail(path, "expected PLY of format binary_little_endian 1.0");
  if (vertices < 0 || faces < 0 || !corner_list) fail(path, "expected PLY elements vertex and face");

  constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t);
  const std::size_t data_begin = header_end + kEnd.size();
  const std::size_t found = bytes.size() - data_begin;
  // Divided instead of multiplied, because the counts come from a header and their product could overflow.
  const auto vertex_count = static_cast<std::size_t>(vertices), face_count = static_cast<std::size_t>(faces);
  if (vertex_bytes > 0 && vertex_count > found / vertex_bytes) {
    fail(path, "is truncated: {} vertices need {} bytes each after the header, found {} bytes", vertices,
         vertex_bytes, found);
  }
  const std::size_t faces_begin = data_begin + vertex_count * vertex_bytes;
  const std::size_t face_room = bytes.size() - faces_begin;
  std::vector<std::int32_t> triangles;
  triangles.reserve(3 * std::min(face_count, face_room / kFaceBytes));
  for (std::size_t t = 0; t < face_count; ++t) {
    if (face_room / kFaceBytes <= t)
      fail(path, "is truncated: {} faces expected, the file ends in face {}", faces, t);
    const std::size_t at = faces_begin + t * kFaceBytes;
    const int corners = static_cast<unsigned char>(bytes[at]);
    if (corners != 3) fail(path, "byte {}: face {} has {} corners; expected 3", at, t, corners);
    std::int32_t corner[3];
    std::memcpy(corner, bytes.data() + at + 1, sizeof corner);
    for (const std::int32_t v : corner) {
      if (v < 0 || v >= vertices) {
        fail(path, "byte {}: face {} has vertex {}; expected 0 to {}", at, t, v, vertices - 1);
      }
      triangles.push_back(v);
    }
  }
  // Edges are not read, but they must be there.
  const std::size_t rest = face_room - face_count * kFaceBytes;
  const auto edge_count = static_cast<std::size_t>(std::max(edges, 0LL));
  if (edge_bytes > 0 ? rest % edge_bytes != 0 || rest / edge_bytes != edge_count : rest != 0) {
    fail(path, "has {} bytes after its {} faces; expected {}", rest, faces,
         edges < 0 ? "none" : fmt::format("{} edges of {} bytes", edges, edge_bytes));
  }
  return triangles;
}

}  // namespace

const Format kEle = {.ending = ".ele",
                     .triangles = read_ele,
                     .write_mesh = write_ele,
                     .has_labels = true,
                     .beside = {".node", write_vertices_beside},
                     .constraints_beside = {".poly", write_poly_beside}};
const Format kOff = {.ending = ".off", .triangles = read_off, .write_mesh = write_off, .is_spatial = true};
const Format kObj = {.ending = ".obj", .triangles = read_obj, .write_mesh = write_obj, .is_spatial = true};
const Format kPly = {.ending = ".ply", .triangles = read_ply, .write_mesh = write_ply, .is_spatial = true};
const Format kMsh = {.ending = ".msh", .write_mesh = write_msh, .has_labels = true, .is_spatial = true};
const Format kVtu = {.ending = ".vtu", .write_mesh = write_vtu, .has_labels = true, .is_spatial = true};

const ConstrainedTriangulation& MeshContents::constraints() const {
  static const ConstrainedTriangulation none;
  return constrained != nullptr ? *constrained : none;
}

bool MeshContents::has_labels() const {
  return !constraints().regions.empty() && !constraints().depths.empty();
}

void write_mesh(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Format& format = format_of(path, Use::write_mesh);
  if (format.write_layer != nullptr) return format.write_layer(outputs, path, contents);
  format.write_mesh(outputs.open(path), contents);
  if (Use::write_features(format)) note_crs(outputs, path, contents.points.crs);
  const auto write_beside = [&](const Format::Beside& beside) {
    if (beside.write != nullptr) beside.write(outputs.open(path_beside(path, beside.ending)), contents);
  };
  write_beside(format.beside);
  if (contents.constrained != nullptr) write_beside(format.constraints_beside);
}

std::vector<std::string> mesh_files(const std::string& path, bool with_constraints) {
  const Format& format = format_of(path, Use::write_mesh);
  if (format.write_layer != nullptr) require_gdal(path);
  std::vector<std::string> files = {path};
  for (const std::string_view ending : format.sidecars) {
    if (!ending.empty()) files.push_back(path_beside(path, ending));
  }
  const auto add = [&](const Format::Beside& beside) {
    if (beside.write != nullptr) files.push_back(path_beside(path, beside.ending));
  };
  add(format.beside);
  if (with_constraints) add(format.constraints_beside);
  return files;
}

bool shows_labels(const std::string& path) {
  return !path.empty() && format_of(path, Use::write_mesh).has_labels;
}

std::vector<std::int32_t> read_triangles(const std::string& path) {
  return format_of(path, Use::read_triangles).triangles(path);
}

std::vector<double> read_triangle_attributes(const std::string& path) {
  std::vector<double> attributes;
  if (ending_of(path) == ".ele") read_ele_with(path, &attributes);
  return attributes;
}

std::vector<double> read_areas(const std::string& path) {
  NumberedLines rows(path, "Triangle's .area format", "triangles");
  std::vector<double> areas;
  // As in Triangle, a negative area means no limit.
  while (rows.next(1, "area")) areas.push_back(std::max(finite_number(rows.lines, "an area"), 0.0));
  return areas;
}

}  // namespace flaunay::io
