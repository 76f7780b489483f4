#include "app/files/mesh.hpp"

#include <cstring>
#include <limits>
#include <span>
#include <string_view>

#include "app/files/formats.hpp"
#include "app/files/mesh_formats.hpp"
#include "app/files/npy.hpp"
#include "app/files/poly.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

constexpr long long kIndexLimit = std::numeric_limits<std::int32_t>::max();

std::size_t triangle_count(const Triangulation& mesh) { return mesh.triangles.size() / 3; }

/// What a mesh with constraints has, and others do not.
struct ConstraintParts {
  std::span<const std::int32_t> edges;            ///< 2 points each
  std::span<const std::int32_t> segments;         ///< one per edge: the segment that has it
  std::span<const std::int32_t> markers;          ///< one per segment, or none
  std::span<const double> holes;                  ///< x and y each
  std::span<const PolyRegion> places;             ///< in regions
  std::span<const double> attributes;             ///< one per triangle, or none
  std::span<const std::int32_t> regions, depths;  ///< one per triangle, or none
  bool present = false;                           ///< whether the mesh has constraints, if only none of them

  std::size_t edge_count() const { return edges.size() / 2; }
  bool has_labels() const { return !regions.empty() && !depths.empty(); }
};

ConstraintParts constraints_of(const MeshContents& contents) {
  if (contents.constrained == nullptr) return {};
  const ConstrainedTriangulation& mesh = *contents.constrained;
  const Map& map = *contents.map;
  return {mesh.constraint_edges, mesh.edge_segments, map.segment_markers, map.holes, map.regions,
          contents.attributes,   mesh.regions,       mesh.depths,         true};
}

/// The constraint edges, whose vertices are in the .node file.
void write_poly(OutputFile& file, const ConstraintParts& constraints) {
  file.print("0 2 0 0\n{} 1\n", constraints.edge_count());
  for (std::size_t e = 0; e < constraints.edge_count(); ++e) {
    const std::int32_t segment = constraints.segments[e];
    file.print("{} {} {} {}\n", e, constraints.edges[2 * e], constraints.edges[2 * e + 1],
               constraints.markers.empty() ? segment + 1LL : constraints.markers[segment]);
  }
  file.print("{}\n", constraints.holes.size() / 2);
  for (std::size_t k = 0; 2 * k < constraints.holes.size(); ++k) {
    file.print("{} {} {}\n", k, constraints.holes[2 * k], constraints.holes[2 * k + 1]);
  }
  if (!constraints.places.empty()) file.print("{}\n", constraints.places.size());
  for (std::size_t k = 0; k < constraints.places.size(); ++k) {
    const PolyRegion& region = constraints.places[k];
    file.print("{} {} {} {}{}\n", k, region.place[0], region.place[1], region.attribute,
               region.area ? fmt::format(" {}", *region.area) : "");
  }
}

}  // namespace

void write_ele(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  const ConstraintParts constraints = constraints_of(contents);
  OutputFile& ele = outputs.open(path);
  print_node(outputs.open(path_beside(path, ".node")), points);
  if (constraints.present) write_poly(outputs.open(path_beside(path, ".poly")), constraints);
  const bool has_attributes = !constraints.attributes.empty();
  ele.print("{} 3 {}\n", triangle_count(mesh), (has_attributes ? 1 : 0) + (constraints.has_labels() ? 2 : 0));
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    const std::int32_t* corner = &mesh.triangles[3 * t];
    ele.print("{} {} {} {}", t, corner[0], corner[1], corner[2]);
    if (has_attributes) ele.print(" {}", constraints.attributes[t]);
    if (constraints.has_labels()) ele.print(" {} {}", constraints.regions[t], constraints.depths[t]);
    ele.print("\n");
  }
}

void write_off(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  OutputFile& file = outputs.open(path);
  file.print("OFF\n{} {} 0\n", points.size(), triangle_count(mesh));
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.print("{} {} 0\n", points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    const std::int32_t* corner = &mesh.triangles[3 * t];
    file.print("3 {} {} {}\n", corner[0], corner[1], corner[2]);
  }
}

void write_obj(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  const ConstraintParts constraints = constraints_of(contents);
  OutputFile& file = outputs.open(path);
  file.print("# {} vertices, {} triangles\n", points.size(), triangle_count(mesh));
  for (std::size_t i = 0; i < points.size(); ++i) {
    file.print("v {} {} 0\n", points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    const std::int32_t* corner = &mesh.triangles[3 * t];
    file.print("f {} {} {}\n", corner[0] + 1LL, corner[1] + 1LL, corner[2] + 1LL);
  }
  for (std::size_t e = 0; e < constraints.edge_count(); ++e) {
    file.print("l {} {}\n", constraints.edges[2 * e] + 1LL, constraints.edges[2 * e + 1] + 1LL);
  }
}

namespace {

/// The points as x, y, 0.
void write_spatial_points(OutputFile& file, const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double spatial[3] = {points.coordinates[2 * i], points.coordinates[2 * i + 1], 0};
    file.write(spatial, sizeof spatial);
  }
}

}  // namespace

void write_ply(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  const ConstraintParts constraints = constraints_of(contents);
  OutputFile& file = outputs.open(path);
  file.print(
      "ply\nformat binary_little_endian 1.0\ncomment flaunay\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element face {}\nproperty list uchar int vertex_indices\n",
      points.size(), triangle_count(mesh));
  if (constraints.present) {
    file.print("element edge {}\nproperty int vertex1\nproperty int vertex2\n", constraints.edge_count());
  }
  file.print("end_header\n");
  write_spatial_points(file, points);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    file.write_value(std::uint8_t{3});
    file.write(&mesh.triangles[3 * t], 3 * sizeof(std::int32_t));
  }
  file.write(constraints.edges.data(), constraints.edges.size_bytes());
}

void write_vtu(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  const ConstraintParts constraints = constraints_of(contents);
  constexpr std::uint8_t kVtkTriangle = 5;
  const std::uint64_t point_bytes = points.size() * 3 * sizeof(double);
  const std::uint64_t corner_bytes = mesh.triangles.size() * sizeof(std::int32_t);
  const std::uint64_t end_bytes = triangle_count(mesh) * sizeof(std::int64_t);
  const std::uint64_t type_bytes = triangle_count(mesh);

  // In the appended data, each array is preceded by its size in bytes.
  const std::uint64_t prefix = sizeof(std::uint64_t);
  const std::uint64_t corners_at = prefix + point_bytes;
  const std::uint64_t ends_at = corners_at + prefix + corner_bytes;
  const std::uint64_t types_at = ends_at + prefix + end_bytes;
  const std::uint64_t regions_at = types_at + prefix + type_bytes;
  const std::uint64_t label_bytes = constraints.regions.size_bytes();

  OutputFile& file = outputs.open(path);
  file.print(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      points.size(), triangle_count(mesh));
  file.print(
      "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" "
      "offset=\"0\"/>\n</Points>\n");
  file.print(
      "<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"appended\" offset=\"{}\"/>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"appended\" offset=\"{}\"/>\n"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"{}\"/>\n</Cells>\n",
      corners_at, ends_at, types_at);
  if (constraints.has_labels()) {
    file.print(
        "<CellData Scalars=\"region\">\n<DataArray type=\"Int32\" Name=\"region\" format=\"appended\" "
        "offset=\"{}\"/>\n<DataArray type=\"Int32\" Name=\"depth\" format=\"appended\" offset=\"{}\"/>\n"
        "</CellData>\n",
        regions_at, regions_at + prefix + label_bytes);
  }
  file.print("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  file.write_value(point_bytes);
  write_spatial_points(file, points);
  file.write_value(corner_bytes);
  file.write(mesh.triangles.data(), corner_bytes);
  file.write_value(end_bytes);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t)
    file.write_value(static_cast<std::int64_t>(3 * (t + 1)));
  file.write_value(type_bytes);
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) file.write_value(kVtkTriangle);
  if (constraints.has_labels()) {
    for (const auto& labels : {constraints.regions, constraints.depths}) {
      file.write_value(label_bytes);
      file.write(labels.data(), label_bytes);
    }
  }
  file.print("\n</AppendedData>\n</VTKFile>\n");
}

void write_geojson(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  const Points& points = contents.points;
  const Triangulation& mesh = contents.mesh;
  const ConstraintParts constraints = constraints_of(contents);
  OutputFile& file = outputs.open(path);
  file.print("{{\"type\":\"FeatureCollection\",\"features\":[");
  for (std::size_t t = 0; t < triangle_count(mesh); ++t) {
    file.print("{}\n{{\"type\":\"Feature\",\"properties\":{{\"triangle\":{}", t == 0 ? "" : ",", t);
    if (constraints.has_labels()) {
      file.print(",\"region\":{},\"depth\":{}", constraints.regions[t], constraints.depths[t]);
    }
    file.print("}},\"geometry\":{{\"type\":\"Polygon\",\"coordinates\":[[");
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corner = static_cast<std::size_t>(mesh.triangles[3 * t + k % 3]);
      file.print("{}[{},{}]", k == 0 ? "" : ",", points.coordinates[2 * corner],
                 points.coordinates[2 * corner + 1]);
    }
    file.print("]]}}}}");
  }
  file.print("\n]}}\n");
}

std::vector<std::int32_t> read_ele(const std::string& path) {
  const std::string text = read_file(path, "Triangle's .ele format");
  Lines lines(path, text, Lines::Separator::blanks);
  if (!lines.next()) fail(path, "has no header line; expected \"triangles 3 attributes\"");
  const std::size_t header_line = lines.number();
  const std::size_t header_fields = lines.count_fields();
  const long long count = lines.integer("the number of triangles");
  const long long corners = header_fields > 1 ? lines.integer("the number of nodes per triangle") : 3;
  const long long attributes = header_fields > 2 ? attribute_count(lines) : 0;
  if (count < 0) lines.fail_line("{} triangles; expected 0 or more", count);
  if (corners != 3) lines.fail_line("{} nodes per triangle; expected 3", corners);

  std::vector<std::int32_t> triangles;
  long long base = 0, read = 0;
  for (; lines.next(); ++read) {
    if (read == count)
      lines.fail_line("more triangles than the {} of the header (line {})", count, header_line);
    const std::size_t fields = lines.count_fields();
    if (fields != static_cast<std::size_t>(4 + attributes)) {
      lines.fail_line("expected {} fields (triangle number, 3 vertices, {} attributes), found {}",
                      4 + attributes, attributes, fields);
    }
    const long long number = lines.integer("a triangle number");
    if (read == 0) {
      if (number != 0 && number != 1)
        lines.fail_line("expected triangle number 0 or 1 first, found {}", number);
      base = number;
    }
    if (number != base + read) lines.fail_line("expected triangle number {}, found {}", base + read, number);
    for (int corner = 0; corner < 3; ++corner) {
      triangles.push_back(
          checked_index(lines, "vertex", lines.integer("a vertex number"), base, kIndexLimit));
    }
  }
  if (read != count) {
    fail(path, "line {}: the header says {} triangles, but the file ends after {}", header_line, count, read);
  }
  return triangles;
}

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

namespace {

/// Bytes of one of PLY's scalar types; 0 for an unknown name.
std::size_t ply_type_bytes(std::string_view type) {
  if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
  if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
  if (type == "int" || type == "uint" || type == "int32" || type == "uint32") return 4;
  if (type == "float" || type == "float32") return 4;
  if (type == "double" || type == "float64") return 8;
  return 0;
}

}  // namespace

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
  std::string_view element;
  std::size_t vertex_bytes = 0, edge_bytes = 0;
  long long vertices = -1, faces = -1, edges = -1;
  bool binary = false, corner_list = false;
  while (lines.next()) {
    std::string_view word[5];
    std::size_t words = 0;
    while (words < 5 && lines.field(word[words])) ++words;
    if (word[0] == "format") {
      binary = word[1] == "binary_little_endian" && word[2] == "1.0";
    } else if (word[0] == "element") {
      lines.rewind();
      lines.field(word[0]);
      lines.field(element);
      const long long count = lines.integer("the number of elements");
      if (count < 0) lines.fail_line("{} elements; expected 0 or more", count);
      if (element == "vertex" && vertices < 0 && faces < 0) {
        vertices = count;
      } else if (element == "face" && vertices >= 0 && faces < 0) {
        faces = count;
      } else if (element == "edge" && faces >= 0 && edges < 0) {
        edges = count;
      } else {
        lines.fail_line("element {}; expected vertex, then face, and perhaps edge", quoted(element));
      }
    } else if (word[0] == "property" && (element == "vertex" || element == "edge")) {
      const std::size_t size = ply_type_bytes(word[1]);
      if (size == 0) lines.fail_line("{} property of type {}; expected a number's", element, quoted(word[1]));
      (element == "vertex" ? vertex_bytes : edge_bytes) += size;
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

void write_npy_triangles(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  write_npy(outputs, path, contents.mesh.triangles, 3);
}

void write_mesh(Outputs& outputs, const std::string& path, const MeshContents& contents) {
  format_of(path, Use::write_mesh).mesh_out(outputs, path, contents);
}

std::vector<std::string> mesh_files(const std::string& path, bool with_constraints) {
  const Format& format = format_of(path, Use::write_mesh);
  std::vector<std::string> files = {path};
  if (!format.beside.empty()) files.push_back(path_beside(path, format.beside));
  if (with_constraints && !format.constraints_beside.empty()) {
    files.push_back(path_beside(path, format.constraints_beside));
  }
  return files;
}

bool shows_labels(const std::string& path) {
  return !path.empty() && format_of(path, Use::write_mesh).has_labels;
}

std::vector<std::int32_t> read_triangles(const std::string& path) {
  return format_of(path, Use::read_triangles).triangles(path);
}

}  // namespace flaunay::io
