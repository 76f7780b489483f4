// Maps and segments: what readers take from files, and what they say about files with errors.
#include "app/files/map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "files/output.hpp"
#include "flaunay/constrained.hpp"
#include "tests/io/folder.hpp"
#include "tests/support/paths.hpp"

namespace flaunay::io {
namespace {

using Values = std::vector<double>;
using Indices = std::vector<std::int32_t>;
using Offsets = std::vector<std::size_t>;

class MapTest : public FolderTest {
 protected:
  Map map_of(const std::string& name, const std::string& bytes) { return read_map(write(name, bytes)); }

  void expect_bad_map(const std::string& name, const std::string& bytes,
                      const std::vector<std::string>& parts) {
    SCOPED_TRACE(bytes.substr(0, 200));
    const std::string file = write(name, bytes);
    expect_error(ErrorKind::input, file + ": ", parts, [&] { read_map(file); });
  }
  void expect_bad_segments(const std::string& name, const std::string& bytes,
                           const std::vector<std::string>& parts) {
    SCOPED_TRACE(name + ": " + bytes.substr(0, 100));
    const std::string file = write(name, bytes);
    expect_error(ErrorKind::input, file + ": ", parts, [&] { read_segments(file, 5); });
  }
};

// -------------------------------------------------------------------------------------- Triangle's .poly
// files

constexpr const char* kTriangle = "3 2 0 0\n0 0 0\n1 4 0\n2 0 4\n";

TEST_F(MapTest, PolyFilesHaveAttributesMarkersHolesAndRegions) {
  const Map map = map_of("a.POLY",
                         "# a comment\n"
                         "4 2 2 1 # the header\n"
                         "1  0 0.5  7 8  1\n\n"
                         "2  4 0    7 8  1\n"
                         "3  4 4e0  7 8  0\n"
                         "4  0 +4   7 8  1\n"
                         "3 1\n"
                         "1  1 2  5\n"
                         "9  3 2  5\n"
                         "-1 4 4  0\n"
                         "2\n"
                         "1 0.5 -1\n"
                         "2 3 3\n"
                         "2\n"
                         "1 1 1 7 0.5\n"
                         "2 2 2 7\n");
  EXPECT_EQ(map.points.coordinates, (Values{0, 0.5, 4, 0, 4, 4, 0, 4}));
  EXPECT_EQ(map.segments, (Indices{0, 1, 2, 1, 3, 3}));
  EXPECT_EQ(map.holes, (Values{0.5, -1, 3, 3}));
  EXPECT_TRUE(map.lines.empty());
  EXPECT_EQ(map.polygon_count(), 0U);
  EXPECT_EQ(map.points.markers, (Indices{1, 1, 0, 1}));
  EXPECT_EQ(map.segment_markers, (Indices{5, 5, 0}));
  EXPECT_TRUE(map.points.notes.empty());
  ASSERT_EQ(map.regions.size(), 2U);
  EXPECT_EQ(map.regions[0].place[0], 1);
  EXPECT_EQ(map.regions[0].attribute, 7);
  EXPECT_EQ(map.regions[0].area, 0.5);
  EXPECT_FALSE(map.regions[1].area.has_value());
}

TEST_F(MapTest, PolyFilesWithoutVerticesReferToANodeFile) {
  const std::string poly = write("a.poly", "0 2 0 0\n2 0\n1 1 2\n2 3 2\n0\n");
  expect_error(ErrorKind::input, poly + ": ", {"no vertices", "a.node", "No such file"},
               [&] { read_map(poly); });
  write("a.node", "3 2 0 0\n1 5 6\n2 7 8\n3 9 1\n");
  const Map map = read_map(poly);
  EXPECT_EQ(map.points.coordinates, (Values{5, 6, 7, 8, 9, 1}));
  EXPECT_EQ(map.segments, (Indices{0, 1, 2, 1})) << "numbered as in the .node file, from 1";
  EXPECT_EQ(files_of_map(poly), (std::vector<std::string>{poly, path("a.node")}));
  EXPECT_EQ(read_points(poly).coordinates, map.points.coordinates);
}

TEST_F(MapTest, PolyFilesWithErrorsNameTheLine) {
  const std::string triangle = kTriangle;
  expect_bad_map("a.poly", "", {"empty", ".poly"});
  expect_bad_map("a.poly", "# nothing\n", {"no header"});
  expect_bad_map("a.poly", "3 3 0 0\n", {"line 1", "3 dimensions"});
  expect_bad_map("a.poly", "3 2 0 0\n0 0 0\n", {"line 1", "3 vertices", "after 1"});
  expect_bad_map("a.poly", "1 2 0 0\n0 nan 0\n", {"line 2, column 3", "'nan'"});
  expect_bad_map("a.poly", "1 2 0 0\n5 0 0\n", {"line 2", "0 or 1"});
  expect_bad_map("a.poly", triangle, {"ends before", "number of segments"});
  expect_bad_map("a.poly", triangle + "1 0\n", {"line 5", "1 segments", "after 0"});
  expect_bad_map("a.poly", triangle + "-1 0\n", {"line 5", "-1 segments"});
  expect_bad_map("a.poly", triangle + "1 2\n", {"line 5", "2 boundary markers"});
  expect_bad_map("a.poly", triangle + "1 0 0\n", {"line 5", "3 fields"});
  expect_bad_map("a.poly", triangle + "1 0\n0 0 3\n0\n", {"line 6", "vertex 3", "0 to 2"});
  expect_bad_map("a.poly", triangle + "1 0\n0 -1 1\n0\n", {"line 6", "vertex -1"});
  expect_bad_map("a.poly", triangle + "1 0\n0 0\n0\n", {"line 6", "3 fields", "found 2"});
  expect_bad_map("a.poly", triangle + "1 0\n0 0 1 1\n0\n", {"line 6", "3 fields", "found 4"});
  expect_bad_map("a.poly", triangle + "1 1\n0 0 x 1\n0\n", {"line 6, column 5", "'x'"});
  expect_bad_map("a.poly", triangle + "1 1\n0 0 1 x\n0\n", {"line 6, column 7", "marker", "'x'"});
  expect_bad_map("a.poly", "1 2 0 1\n0 0 0 2147483648\n", {"line 2, column 7", "2147483648", "out of range"});
  expect_bad_map("a.poly", triangle + "0\n0\n1\n0 1 1 x\n", {"line 8, column 7", "attribute", "'x'"});
  expect_bad_map("a.poly", triangle + "0\n", {"ends before", "holes"});
  expect_bad_map("a.poly", triangle + "0\n1\n", {"line 6", "1 holes", "after 0"});
  expect_bad_map("a.poly", triangle + "0\n1\n0 1 inf\n", {"line 7, column 5", "finite", "'inf'"});
  expect_bad_map("a.poly", triangle + "0\n1\n0 1\n", {"line 7", "hole number, x, y"});
  expect_bad_map("a.poly", triangle + "0\n0\n1\n0 1 1\n", {"line 8", "4 or 5 fields"});
  expect_bad_map("a.poly", triangle + "0\n0\n0\n1\n", {"line 8", "end of the file"});
}

TEST_F(MapTest, TheLetterOfTheTestsIsRead) {
  const Map map = read_map(test_data() + "/letter.poly");
  EXPECT_EQ(map.points.size(), 15U);
  EXPECT_EQ(map.segments.size(), 22U);
  EXPECT_EQ(map.holes, (Values{0.5, 0.55}));
}

// ------------------------------------------------------------------------------------------------------
// GeoJSON

std::string geometry(const std::string& type, const std::string& coordinates) {
  return "{\"type\": \"" + type + "\", \"coordinates\": " + coordinates + "}";
}

TEST_F(MapTest, RingsKeepTheirDirections) {
  // The border clockwise and the hole counter-clockwise, against the standard.
  const Map map =
      map_of("a.json", geometry("Polygon", "[[[0,0],[0,9],[9,9],[9,0],[0,0]],[[1,1],[2,1],[1,2],[1,1]]]"));
  EXPECT_EQ(map.points.coordinates, (Values{0, 0, 0, 9, 9, 9, 9, 0, 1, 1, 2, 1, 1, 2}));
  EXPECT_EQ(map.segments, (Indices{0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 4}));
  EXPECT_EQ(map.ring_offsets, (Offsets{0, 4, 7}));
  EXPECT_EQ(map.polygon_offsets, (Offsets{0, 2}));
  EXPECT_FALSE(map.has_others);
  EXPECT_EQ(map.part_offsets, (Offsets{0, 2}));
  EXPECT_TRUE(map.points.notes.empty());
}

TEST_F(MapTest, GeoJsonHasAllTypes) {
  const std::string triangle = "[[0,0,7],[1,0,7],[0,1,7],[0,0,7]]", other = "[[5,5],[6,5],[5,6],[5,5]]";
  const auto feature = [](const std::string& object) {
    return "{\"type\": \"Feature\", \"properties\": {\"type\": \"x\"}, \"geometry\": " + object + "}";
  };
  const Map map = map_of(
      "a.geojson",
      "\xEF\xBB\xBF{\"bbox\": [1], \"features\": [" + feature(geometry("Polygon", "[" + triangle + "]")) +
          "," + feature("null") + "," +
          feature(geometry("MultiPolygon", "[[" + triangle + "],[" + other + "],[]]")) + "," +
          feature("{\"type\": \"GeometryCollection\", \"geometries\": [" +
                  geometry("LineString", "[[1,1],[2,2],[3,1]]") + "," +
                  geometry("MultiLineString", "[[[1,1],[2,2]],[]]") + "," + geometry("Point", "[8,9]") + "," +
                  geometry("Point", "[]") + "," + geometry("MultiPoint", "[[1e1,-2],[3,4]]") + "]}") +
          "], \"type\": \"FeatureCollection\"}");
  EXPECT_EQ(map.points.coordinates, (Values{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 5, 5,  6,  5, 5,
                                            6, 1, 1, 2, 2, 3, 1, 1, 1, 2, 2, 8, 9, 10, -2, 3, 4}));
  EXPECT_EQ(map.segments, (Indices{0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 3, 6, 7, 7, 8, 8, 6}));
  EXPECT_EQ(map.lines, (Indices{9, 10, 10, 11, 12, 13}));
  EXPECT_EQ(map.ring_offsets, (Offsets{0, 3, 6, 9}));
  EXPECT_EQ(map.polygon_offsets, (Offsets{0, 1, 3})) << "the parts of a MultiPolygon are one";
  EXPECT_EQ(map.part_offsets, (Offsets{0, 1, 2, 3, 3}));
  EXPECT_TRUE(map.has_others);
}

TEST_F(MapTest, GeoJsonHasHeightsPropertiesAndASystem) {
  const std::string ring = "[[0,0,5],[1,0],[0,1,7],[0,0,5]]";
  const auto feature = [](const std::string& geometry, const std::string& properties) {
    return R"({"type": "Feature", "geometry": )" + geometry + R"(, "properties": )" + properties + "}";
  };
  const std::string polygon = geometry("Polygon", "[" + ring + "]");
  const std::string both =
      R"({"type": "GeometryCollection", "geometries": [)" + polygon + "," + polygon + "]}";
  const Map map =
      map_of("a.geojson", R"({"type": "FeatureCollection", "crs": {"type": "name", "properties":
      {"name": "urn:ogc:def:crs:EPSG::25832"}}, "features": [)" +
                              feature(both, R"({"b": [1, {"c": null}], "a": "\u00e4\""})") + "," +
                              feature(polygon, "null") + "," + feature(polygon, R"({"d": 2})") + "]}");
  EXPECT_EQ(map.points.crs, "EPSG:25832");
  const std::string first = "\"a\":\"\xc3\xa4\\\"\",\"b\":[1,{\"c\":null}]";
  EXPECT_EQ(map.properties, (std::vector<std::string>{first, first, "", "\"d\":2"}));
  ASSERT_EQ(map.points.heights.size(), 12U);
  EXPECT_EQ(map.points.heights[0], 5);
  EXPECT_TRUE(std::isnan(map.points.heights[1]));
  EXPECT_TRUE(map_of("b.geojson", geometry("LineString", "[[0,0],[1,1]]")).points.heights.empty());
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  expect_bad_map("c.geojson", feature(polygon, R"({"a": )" + deep + "}"), {"properties", "too deep"});
}

TEST_F(MapTest, RingsThatAreNotClosedAreMended) {
  const Map map = map_of("a.json", geometry("Polygon", "[[[0,0],[1,0],[0,1]]]"));
  EXPECT_EQ(map.points.size(), 3U);
  EXPECT_EQ(map.segments, (Indices{0, 1, 1, 2, 2, 0}));
  ASSERT_EQ(map.points.notes.size(), 1U);
  EXPECT_NE(map.points.notes[0].find("a ring is not closed"), std::string::npos) << map.points.notes[0];
}

TEST_F(MapTest, GeoJsonWithErrorsNamesThePath) {
  const auto in_feature = [](const std::string& object) {
    return "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"geometry\":null},"
           "{\"type\":\"Feature\",\"geometry\":" +
           object + "}]}";
  };
  expect_bad_map("a.json", "", {"empty"});
  expect_bad_map("a.json", "{\n\"type\": \n!}", {"no valid JSON", "line 3"});
  expect_bad_map("a.json", "{\"type\": \"\xff\"}", {"no valid JSON", "UTF-8"});
  expect_bad_map("a.json", geometry("Point", "[NaN, 0]"), {"no valid JSON", "line 1"});
  expect_bad_map("a.json", geometry("Point", "[\n1, -1e400]"), {"line 2, column 4", "-1e400", "finite"});
  expect_bad_map("a.json", "[]", {"the document is []", "object"});
  expect_bad_map("a.json", "{}", {"the document has no member \"type\""});
  expect_bad_map("a.json", "{\"type\": 7}", {"type is 7"});
  expect_bad_map("a.json", "{\"type\": \"Topology\"}", {"type is \"Topology\"", "GeoJSON"});
  expect_bad_map("a.json", "{\"type\": \"Polygon\"}", {"no member \"coordinates\""});
  expect_bad_map("a.json", "{\"type\": \"FeatureCollection\", \"features\": {}}", {"features is an object"});
  expect_bad_map("a.json", in_feature("{\"type\":\"Curve\"}"), {"features[1].geometry.type is \"Curve\""});
  expect_bad_map("a.json", in_feature(geometry("MultiPolygon", "[[],[[[0,0],[1,0],[true,2]]]]")),
                 {"features[1].geometry.coordinates[1][0][2] is [true,2]", "[x, y]"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[[0,0],[1,0],[0]]]")),
                 {"features[1].geometry.coordinates[0][2] is [0]"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[0,0],[1,0],[0,1]]")),
                 {"coordinates[0][0] is 0", "[x, y]"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[[0,0],[1,0],[0,0]]]")),
                 {"coordinates[0] is a ring of 3 positions"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[]]")), {"a ring of 0 positions;"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[[0,0],[1,0]]]")),
                 {"coordinates[0] is a ring of 2 positions that is not closed"});
  expect_bad_map("a.json", in_feature(geometry("Polygon", "[[[[0,0]]]]")),
                 {"coordinates[0][0] is an array of 1 value; expected a position [x, y]"});
  expect_bad_map("a.json", in_feature(geometry("LineString", "[[0,0]]")), {"coordinates has one position"});
  expect_bad_map("a.json", in_feature(geometry("Point", "[\"0\",\"0\"]")), {"coordinates is [\"0\",\"0\"]"});
  expect_bad_map("a.json", in_feature("7"), {"features[1].geometry is 7"});
  expect_bad_map("a.json", "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\"}]}",
                 {"features[0] has no member \"geometry\""});
}

TEST_F(MapTest, CollectionsThatAreTooDeepAreAnError) {
  std::string deep;
  constexpr int kLevels = 100'000;
  for (int i = 0; i < kLevels; ++i) deep += "{\"type\":\"GeometryCollection\",\"geometries\":[";
  for (int i = 0; i < kLevels; ++i) deep += "]}";
  expect_bad_map("a.json", deep, {"too deep"});
}

TEST_F(MapTest, ValuesOfAnyDepthAreReadOrAnError) {
  constexpr std::size_t kLevels = 200'000;
  const std::string open(kLevels, '['), close(kLevels, ']');
  for (const char* type : {"Point", "LineString", "MultiPolygon", "FeatureCollection", "Curve"}) {
    expect_bad_map("a.json", geometry(type, open + close), {});
  }
  expect_bad_map("a.json", geometry("Polygon", open + close), {"[0][0] is an array of 1 value"});
  expect_bad_map("a.json", open + close, {"the document is an array of 1 value"});
  expect_bad_map("a.json", open, {"no valid JSON"});
  expect_bad_map("a.json", "{\"type\": " + open + close + "}", {"type is an array of 1 value"});
  // What is not needed is not looked at.
  const Map map = map_of("a.json", "{\"type\": \"Feature\", \"properties\": " + open + close +
                                       ", \"geometry\": " + geometry("Point", "[1, 2]") + "}");
  EXPECT_EQ(map.points.coordinates, (Values{1, 2}));
}

// -----------------------------------------------------------------------------------------------------
// segments

template <typename Value>
std::string npy_of(const std::string& dtype, const std::string& shape, const std::vector<Value>& values,
                   const std::string& fortran = "False") {
  std::string header =
      "{'descr': '" + dtype + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }\n";
  const auto length = static_cast<std::uint16_t>(header.size());
  return std::string("\x93NUMPY\x01\x00", 8) + raw(std::vector<std::uint16_t>{length}) + header + raw(values);
}

TEST_F(MapTest, SegmentsAreOfAnyTypeOfIntegers) {
  const Indices expected = {0, 4, 3, 3};
  const auto check = [&](const std::string& dtype, auto zero) {
    using Value = decltype(zero);
    const std::string file = write("s.npy", npy_of<Value>(dtype, "(2, 2)", {0, 4, 3, 3}));
    EXPECT_EQ(read_segments(file, 5), expected) << dtype;
    EXPECT_TRUE(read_segments(write("s.npy", npy_of<Value>(dtype, "(0, 2)", {})), 0).empty());
    expect_bad_segments("s.npy", npy_of<Value>(dtype, "(2, 2)", {0, 4, 5, 3}), {"segment 1 has index 5"});
    expect_bad_segments("s.npy", npy_of<Value>(dtype, "(1, 2)", {0, std::numeric_limits<Value>::max()}),
                        {"segment 0 has index " + std::to_string(std::numeric_limits<Value>::max())});
    if (std::numeric_limits<Value>::is_signed) {
      expect_bad_segments("s.npy", npy_of<Value>(dtype, "(1, 2)", {static_cast<Value>(-1), 0}),
                          {"segment 0 has index -1"});
    }
  };
  check("|i1", std::int8_t{});
  check("|u1", std::uint8_t{});
  check("<i2", std::int16_t{});
  check("<u2", std::uint16_t{});
  check("<i4", std::int32_t{});
  check("<u4", std::uint32_t{});
  check("<i8", std::int64_t{});
  check("<u8", std::uint64_t{});
}

TEST_F(MapTest, SegmentsOfTextMayHaveAHeader) {
  EXPECT_EQ(read_segments(write("s.csv", "from,to\n0, 4\n# more\n\"3\",3\n"), 5), (Indices{0, 4, 3, 3}));
  EXPECT_EQ(read_segments(write("s.TXT", "0 4\n"), 5), (Indices{0, 4}));
  EXPECT_TRUE(read_segments(write("s.txt", "# none\n"), 5).empty());
}

TEST_F(MapTest, SegmentsWithErrorsNameThePlace) {
  expect_bad_segments("s.txt", "", {"empty", "two indices"});
  expect_bad_segments("s.txt", "0 1\n2\n", {"line 2", "two indices", "found 1"});
  expect_bad_segments("s.csv", "0,1,2\n", {"line 1", "found 3"});
  expect_bad_segments("s.txt", "0 5\n", {"line 1", "index 5", "0 to 4"});
  expect_bad_segments("s.txt", "-1 0\n", {"line 1", "index -1"});
  expect_bad_segments("s.txt", "0 1\n2 1.0\n", {"line 2, column 3", "'1.0'", "whole number"});
  const std::vector<std::int32_t> six = {0, 1, 2, 3, 4, 0};
  expect_bad_segments("s.npy", npy_of("<i4", "(2, 3)", six), {"(2, 3)", "(s, 2)"});
  expect_bad_segments("s.npy", npy_of("<i4", "(6,)", six), {"(6,)", "(s, 2)"});
  expect_bad_segments("s.npy", npy_of("<i4", "(4, 2)", six), {"truncated"});
  expect_bad_segments("s.npy", npy_of("<i4", "(2, 2)", six), {"too many"});
  expect_bad_segments("s.npy", npy_of(">i4", "(3, 2)", six), {"big-endian", "'<i4'"});
  expect_bad_segments("s.npy", npy_of("<f4", "(3, 2)", six), {"'<f4'", "'<i4', '<i8'", "or '|u1'"});
  expect_bad_segments("s.npy", npy_of("<i4", "(3, 2)", six, "True"), {"Fortran"});
  expect_bad_segments("none/s.npy", "", {"No such file"});
  expect_error(ErrorKind::usage, "s.obj: ", {".npy, .txt, .csv"}, [] { check_segments_ending("s.obj"); });
}

// ------------------------------------------------------------------------------------------ meshes with
// constraints

/// A square whose diagonal is a constraint, with a hole at its lower side.
ConstrainedTriangulation square() {
  ConstrainedTriangulation mesh;
  mesh.triangles = {0, 1, 2, 0, 2, 3};
  mesh.neighbors = {-1, 1, -1, -1, -1, 0};
  mesh.hull = {0, 1, 2, 3};
  mesh.representatives = {0, 1, 2, 3};
  mesh.constraint_edges = {0, 2};
  mesh.edge_segments = {6};
  mesh.regions = {0, 1};
  mesh.depths = {0, 1};
  return mesh;
}

class ConstrainedMeshTest : public FolderTest {
 protected:
  std::string write_square(const std::string& name, const ConstrainedTriangulation& mesh) {
    Map map;
    map.points.coordinates = {0, 0, 2, 0, 2, 2, 0, 2};
    map.holes = {0.5, 0.25};
    return write_map(name, map, mesh);
  }
  std::string write_map(const std::string& name, const Map& map, const ConstrainedTriangulation& mesh) {
    Outputs outputs;
    write_mesh(outputs, path(name), {map.points, mesh, &mesh, &map, FillRule::nesting});
    outputs.commit();
    return read(path(name));
  }
};

TEST_F(ConstrainedMeshTest, TrianglesFormatHasLabelsAndEdges) {
  EXPECT_EQ(write_square("a.ele", square()), "2 3 2\n0 0 1 2 0 0\n1 0 2 3 1 1\n");
  EXPECT_EQ(read(path("a.poly")), "0 2 0 0\n1 1\n0 0 2 7\n1\n0 0.5 0.25\n");
  EXPECT_EQ(read_triangles(path("a.ele")), (Indices{0, 1, 2, 0, 2, 3}));
  const Map map = read_map(path("a.poly"));
  EXPECT_EQ(map.points.size(), 4U);
  EXPECT_EQ(map.segments, (Indices{0, 2}));
  EXPECT_EQ(map.holes, (Values{0.5, 0.25}));
  EXPECT_EQ(mesh_files(path("a.ele"), true),
            (std::vector<std::string>{path("a.ele"), path("a.node"), path("a.poly")}));
  EXPECT_EQ(mesh_files("a.ele", false), (std::vector<std::string>{"a.ele", "a.node"}));
}

TEST_F(ConstrainedMeshTest, MarkersAndAttributesAreWrittenThrough) {
  Map map;
  map.points = {{0, 0, 2, 0, 2, 2, 0, 2}, {3, -4, 0, 5}};
  map.regions = {{{1.5, 0.5}, 0.25, 0.125}, {{0.5, 1.5}, 1e300, {}}};
  ConstrainedTriangulation mesh = square();
  mesh.edge_markers = {-7};
  mesh.triangle_attributes = {0.25, 1e300};
  EXPECT_EQ(write_map("a.ele", map, mesh), "2 3 3\n0 0 1 2 0.25 0 0\n1 0 2 3 1e+300 1 1\n");
  EXPECT_EQ(read(path("a.node")), "4 2 0 1\n0 0 0 3\n1 2 0 -4\n2 2 2 0\n3 0 2 5\n");
  EXPECT_EQ(read(path("a.poly")), "0 2 0 0\n1 1\n0 0 2 -7\n0\n2\n0 1.5 0.5 0.25 0.125\n1 0.5 1.5 1e+300\n");
  const Map again = read_map(path("a.poly"));
  EXPECT_EQ(again.points.markers, map.points.markers);
  EXPECT_EQ(again.segment_markers, (Indices{-7}));
  EXPECT_EQ(again.regions.size(), 2U);
  EXPECT_TRUE(read_points(path("a.node")).markers.empty()) << "of .poly files alone";
  Outputs outputs;
  write_points(outputs, path("p.node"), map.points);
  outputs.commit();
  EXPECT_EQ(read(path("p.node")), read(path("a.node")));
}

TEST_F(ConstrainedMeshTest, EdgesAreInObjAndPly) {
  const std::string obj = write_square("a.obj", square());
  EXPECT_NE(obj.find("\nl 1 3\n"), std::string::npos) << obj;
  EXPECT_EQ(read_triangles(path("a.obj")), (Indices{0, 1, 2, 0, 2, 3}));
  const std::string ply = write_square("a.ply", square());
  EXPECT_NE(ply.find("\ncomment edge 0 2\n"), std::string::npos);
  EXPECT_EQ(read_triangles(path("a.ply")), (Indices{0, 1, 2, 0, 2, 3}));
  // Of other programs.
  std::string with_edge = ply;
  with_edge.insert(ply.find("end_header"), "element edge 1\nproperty int vertex1\nproperty int vertex2\n");
  with_edge += raw(Indices{0, 2});
  EXPECT_EQ(read_triangles(write("edge.ply", with_edge)), (Indices{0, 1, 2, 0, 2, 3}));
  const std::string cut = write("cut.ply", with_edge.substr(0, with_edge.size() - 4));
  expect_error(ErrorKind::input, cut + ": ", {"4 bytes after its 2 faces", "1 edges of 8 bytes"},
               [&] { read_triangles(cut); });
}

TEST_F(ConstrainedMeshTest, GmshHasEdgesAndGroups) {
  const std::string nodes =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n$EndNodes\n";
  const auto expect_elements = [&](const ConstrainedTriangulation& mesh, const std::string& elements) {
    EXPECT_EQ(write_square("a.msh", mesh), nodes + "$Elements\n" + elements + "$EndElements\n");
  };
  ConstrainedTriangulation mesh = square();
  expect_elements(mesh, "3\n1 1 2 1 1 1 3\n2 2 2 1 1 1 2 3\n3 2 2 2 2 1 3 4\n");
  mesh.constraint_edges = {0, 2, 0, 3};
  mesh.edge_markers = {9, 4};
  mesh.triangle_attributes = {5, 7};
  const std::string edges = "4\n1 1 2 9 2 1 3\n2 1 2 4 1 1 4\n";
  expect_elements(mesh, edges + "3 2 2 5 1 1 2 3\n4 2 2 7 2 1 3 4\n");
  mesh.triangle_attributes = {0.5, 7};
  expect_elements(mesh, edges + "3 2 2 1 1 1 2 3\n4 2 2 2 2 1 3 4\n");
  mesh.polygons = {3, -1};
  expect_elements(mesh, edges + "3 2 2 4 1 1 2 3\n4 2 2 0 2 1 3 4\n");
}

TEST_F(ConstrainedMeshTest, LabelsAreInVtuAndGeoJson) {
  const std::string vtu = write_square("a.vtu", square());
  EXPECT_NE(vtu.find("Name=\"region\""), std::string::npos);
  const std::string labels = raw(std::vector<std::uint64_t>{8}) + raw(Indices{0, 1});
  const std::string end = "\n</AppendedData>\n</VTKFile>\n";
  EXPECT_EQ(vtu.substr(vtu.size() - end.size() - 2 * labels.size()), labels + labels + end);

  const auto features = nlohmann::json::parse(write_square("a.geojson", square()))["features"];
  ASSERT_EQ(features.size(), 2U);
  EXPECT_EQ(features[1]["properties"], (nlohmann::json{{"triangle", 1}, {"region", 1}, {"depth", 1}}));
  const Map map = read_map(path("a.geojson"));
  EXPECT_EQ(map.polygon_count(), 2U);
  EXPECT_EQ(map.points.coordinates, (Values{0, 0, 2, 0, 2, 2, 0, 0, 2, 2, 0, 2}));
  EXPECT_TRUE(map.points.notes.empty()) << "rings are closed";

  // Of polygons, their numbers and properties; the triangles' own ones give way to these.
  ConstrainedTriangulation owned = square();
  owned.polygons = {1, -1};
  Map names;
  names.properties = {"\"name\":\"x\"", "\"depth\":7,\"name\":{\"a\":[1]}"};
  Outputs outputs;
  const Points spatial{{0, 0, 2, 0, 2, 2, 0, 2}, {}, {5, 6, 7, 8}};
  write_mesh(outputs, path("a.geojson"), {spatial, owned, &owned, &names});
  outputs.commit();
  const auto named = nlohmann::json::parse(read(path("a.geojson")))["features"];
  EXPECT_EQ(named[0]["properties"].dump(),
            R"({"depth":7,"flaunay_depth":0,"name":{"a":[1]},"polygon":1,"region":0,"triangle":0})");
  EXPECT_EQ(named[1]["properties"].dump(), R"({"flaunay_depth":1,"polygon":-1,"region":1,"triangle":1})");
  EXPECT_EQ(named[0]["geometry"]["coordinates"][0][1].dump(), "[2,0,6]");

  ConstrainedTriangulation unlabelled = square();
  unlabelled.regions.clear(), unlabelled.depths.clear();
  EXPECT_EQ(write_square("a.vtu", unlabelled).find("region"), std::string::npos);
  EXPECT_EQ(write_square("a.geojson", unlabelled).find("region"), std::string::npos);
}

TEST_F(ConstrainedMeshTest, PicturesShowConstraintsAndWhatIsOutside) {
  const std::string svg = write_square("a.svg", square());
  EXPECT_NE(svg.find("id=\"constraints\" stroke=\"#c84c09\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("fill=\"#eeece6\""), std::string::npos) << "the first triangle is outside";
  EXPECT_EQ(svg.find("id=\"hull\""), std::string::npos) << "it need not be an edge of the mesh";
  EXPECT_EQ(svg.find("id=\"added\""), std::string::npos);
  EXPECT_NE(svg.find("1 constraint edge"), std::string::npos);
  ConstrainedTriangulation added = square();
  added.added_points = {0, 2};
  const std::string with_added = write_square("a.svg", added);
  EXPECT_NE(with_added.find("id=\"added\""), std::string::npos);
  EXPECT_NE(with_added.find("1 point added"), std::string::npos);
}

}  // namespace
}  // namespace flaunay::io
