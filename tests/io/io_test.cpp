#include <gtest/gtest.h>
#ifndef _WIN32
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "app/files/formats.hpp"
#include "app/files/generate.hpp"
#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "app/files/region.hpp"
#include "files/output.hpp"
#include "files/printable.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "tests/io/folder.hpp"
#include "tests/support/paths.hpp"

namespace flaunay::io {
namespace {

using Values = std::vector<double>;
using Indices = std::vector<std::int32_t>;

// Each of these writes one file, and commits it.
void write_points(const std::string& path, const Points& points) {
  Outputs outputs;
  write_points(outputs, path, points);
  outputs.commit();
}
void write_mesh(const std::string& path, const Points& points, const Triangulation& mesh) {
  Outputs outputs;
  write_mesh(outputs, path, {points, mesh});
  outputs.commit();
}
void write_npy_indices(const std::string& path, const Indices& values, std::size_t columns) {
  Outputs outputs;
  io::write_npy(outputs, path, values, columns);
  outputs.commit();
}
void write_region(const std::string& stem, const Points& points, const research::Region& region) {
  Outputs outputs;
  write_region(outputs, stem, points, region);
  outputs.commit();
}
void write_partition_svg(const std::string& path, const Points& points,
                         const research::Partition& partition) {
  Outputs outputs;
  write_partition_svg(outputs, path, points, partition);
  outputs.commit();
}

class IoTest : public FolderTest {
 protected:
  /// Reading points from a file of these bytes must fail with these parts in the message.
  void expect_bad_points(const std::string& name, const std::string& bytes,
                         const std::vector<std::string>& parts) {
    SCOPED_TRACE(name + ": " + bytes.substr(0, 60));
    const std::string file = write(name, bytes);
    expect_error(ErrorKind::input, file + ": ", parts, [&] { read_points(file); });
  }
  void expect_bad_triangles(const std::string& name, const std::string& bytes,
                            const std::vector<std::string>& parts) {
    SCOPED_TRACE(name + ": " + bytes.substr(0, 60));
    const std::string file = write(name, bytes);
    expect_error(ErrorKind::input, file + ": ", parts, [&] { read_triangles(file); });
  }
  Values points_of(const std::string& name, const std::string& bytes) {
    return read_points(write(name, bytes)).coordinates;
  }
};

std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  const std::string header = dictionary + "\n";
  const auto length = static_cast<std::uint32_t>(header.size());
  bytes.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
  return bytes + header + data;
}
std::string npy_header(const std::string& descr, const std::string& shape,
                       const std::string& fortran = "False") {
  return "{'descr': '" + descr + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}

const Values kSquare = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5};

/// The unit square with its centre.
Triangulation square_mesh() {
  Triangulation mesh;
  mesh.triangles = {0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3};
  mesh.hull = {0, 1, 2, 3};
  mesh.representatives = {0, 1, 2, 3, 4};
  mesh.triangle_offsets = {0, 4};
  mesh.hull_offsets = {0, 4};
  return mesh;
}

/// cells x cells squares, each cut in two.
std::pair<Points, Triangulation> grid_mesh(std::int32_t cells) {
  Points points;
  Triangulation mesh;
  const std::int32_t width = cells + 1;
  for (std::int32_t y = 0; y < width; ++y) {
    for (std::int32_t x = 0; x < width; ++x) {
      points.coordinates.insert(points.coordinates.end(), {double(x), double(y)});
      mesh.representatives.push_back(y * width + x);
      if (x == cells || y == cells) continue;
      const std::int32_t a = y * width + x, b = a + 1, c = a + width, d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {a, b, d, a, d, c});
    }
  }
  for (std::int32_t i = 0; i < cells; ++i) mesh.hull.push_back(i);
  for (std::int32_t i = 0; i < cells; ++i) mesh.hull.push_back(i * width + cells);
  for (std::int32_t i = cells; i > 0; --i) mesh.hull.push_back(cells * width + i);
  for (std::int32_t i = cells; i > 0; --i) mesh.hull.push_back(i * width);
  mesh.triangle_offsets = {0, mesh.triangles.size() / 3};
  mesh.hull_offsets = {0, mesh.hull.size()};
  return {points, mesh};
}

// ---- text ----

TEST_F(IoTest, TextTakesCommasBlanksCommentsAndAllLineEnds) {
  EXPECT_EQ(points_of("a.xy", "1 2\n3\t4\n"), (Values{1, 2, 3, 4}));
  EXPECT_EQ(points_of("b.csv", "1,2\r\n3 , 4\r\n"), (Values{1, 2, 3, 4}));
  EXPECT_EQ(points_of("c.TXT", "# first\n\n  1 2 # at the end\n#\n \t\n+3e0,-.5e+1#close\n5. 6"),
            (Values{1, 2, 3, -5, 5, 6}));
  EXPECT_EQ(points_of("d.xy",
                      "\xEF\xBB\xBF"
                      "1 2\n"),
            (Values{1, 2}));
}

TEST_F(IoTest, TextHeaderLineIsOptional) {
  EXPECT_EQ(points_of("a.csv", "x,y\n1,2\n"), (Values{1, 2}));
  EXPECT_EQ(points_of("b.csv", "# comment\n\n\"easting\" \"northing\"\n1,2\n"), (Values{1, 2}));
  EXPECT_EQ(points_of("c.csv", "only, a header\n"), Values{});
  EXPECT_EQ(points_of("d.csv", "# only a comment\n"), Values{});
  expect_bad_points("e.csv", "x,y\nx,y\n1,2\n", {"line 2, column 1", "point 0", "'x'"});
  // A mistyped first line is no header.
  expect_bad_points("f.csv", "1.0,2.O\n1,2\n", {"line 1, column 5", "'2.O'"});
  expect_bad_points("g.csv", "nan,nan\n", {"line 1, column 1", "point 0", "'nan'"});
}

TEST_F(IoTest, TextHeadersOfOtherPrograms) {
  for (const char* header :
       {"lon,lat", "\"lon\",\"lat\"", "X_1,Y_1", "x1 y1", "x y z", "E,N", "l,b", "I J",
        "longitude (deg),latitude (deg)", "\"easting, in m\",\"northing, in m\"", "\"the \"\"x\"\"\",y",
        "L\xc3\xa4nge,Breite", "\xe7\xbb\x8f\xe5\xba\xa6,\xe7\xba\xac\xe5\xba\xa6", ",x,y", "\"x"}) {
    EXPECT_EQ(points_of("a.csv", std::string(header) + "\n1,2\n"), (Values{1, 2})) << header;
  }
}

TEST_F(IoTest, TextSkipsNoLineOfMistypedNumbers) {
  struct Mistyped {
    const char* line;
    const char* found;
  };
  for (const auto& [line, found] : std::vector<Mistyped>{
           {"e5,O", "'e5'"},
           {"O,O", "'O'"},
           {"o.5,-O.5", "'o.5'"},
           {"x1,2x", "'x1'"},
           {"0x10,0x20", "'0x10'"},
           {"$1 $2", "'$1'"},
           {"- -", "'-'"},
           {"\"1.5.2\",\"a\"", "'1.5.2'"},
           {"\"\",\"\"", "nothing"},
           // The minus sign of typography, a currency, and characters of full width.
           {"\xe2\x88\x92\x31,\xe2\x88\x92\x32", "'\xe2\x88\x92\x31'; byte 0xE2 is not part of a number"},
           {"\xc2\xa3\x31,\xc2\xa3\x32", "'\xc2\xa3\x31'"},
           {"\xef\xbc\x91,\xef\xbc\x92", "'\xef\xbc\x91'"},
           {"\xef\xbc\xb8,\xef\xbc\xb9", "'\xef\xbc\xb8'"},
       }) {
    expect_bad_points("a.csv", std::string("# comment\n") + line + "\n1,2\n",
                      {"line 2, column ", "point 0", found, "if this line is a header, begin it with '#'"});
  }
}

TEST_F(IoTest, TextNumbersMayBeQuoted) {
  EXPECT_EQ(points_of("a.csv", "\"0\",\"0\"\n\"1.5\" , 2\r\n\" -3 \"\t\"+4e0\"\n"),
            (Values{0, 0, 1.5, 2, -3, 4}));
  expect_bad_points("b.csv", "1,2\n\"3,4\"\n", {"line 2", "found 1", "semicolons"});
  expect_bad_points("c.csv", "1,2\n3,\"4\n", {"line 2, column 3", "'\"4'"});
  expect_bad_points("d.csv", "1,2\n3,\"4\"5\n", {"line 2, column 3", "'\"4\"5'"});
  expect_bad_points("e.csv", "1,2\n3,\"\"\n", {"line 2", "point 1", "nothing"});
  expect_bad_points("f.csv", "1,2\n3,\"\"\"4\"\"\"\n", {"line 2, column 4", "point 1"});
  // Only CSV has quotes.
  expect_bad_points("g.node", "1 2 0 0\n0 \"1\" 2\n", {"line 2, column 3", "'\"1\"'"});
}

TEST_F(IoTest, TextHasDecimalCommasWhereSemicolonsSeparate) {
  EXPECT_EQ(points_of("a.csv", "x;y\n1,4;2,7\n-3 ; \"0,5\"\n"), (Values{1.4, 2.7, -3, 0.5}));
  EXPECT_EQ(points_of("b.csv", "1.5;2\n3;4e1\n"), (Values{1.5, 2, 3, 40}));
  for (const char* line : {"1,4 2,7 1,7", "1,4 2,7", "1,4\t2,7", "1,5 2", "1 2,5", "1 2 3,5", "1, 4 2, 7"}) {
    expect_bad_points("c.xyz", std::string("1 2\n") + line + "\n",
                      {"line 2", "commas and white space", "semicolons"});
    expect_bad_points("d.csv", std::string(line) + "\n", {"line 1", "commas and white space", "semicolons"});
  }
  expect_bad_points("e.csv", "\"1,5\" \"2,5\"\n", {"line 1, column 2", "separate columns by semicolons"});
  expect_bad_points("f.csv", "1,5;2\n3;4.5\n", {"line 2, column 3", "'4.5' has a decimal point"});
  expect_bad_points("g.csv", "1.000,5;2\n", {"line 1, column 1", "one decimal comma"});
  expect_bad_points("h.csv", "1;2\n3,4\n", {"line 2", "no semicolons"});
  expect_bad_points("i.csv", "1,2\n3;4\n", {"line 2", "has semicolons"});
}

TEST_F(IoTest, TextMayHaveHeightsAndNamedColumns) {
  const Points points = read_points(write("a.csv", "lon,lat,elevation\n1,2,3\n4,5,-6.5\n"));
  EXPECT_EQ(points.coordinates, (Values{1, 2, 4, 5}));
  EXPECT_EQ(points.heights, (Values{3, -6.5}));
  const std::string table = write("b.csv", "name;z;lat;lon\nNew York, NY;3,5;2;1\n");
  EXPECT_EQ(read_points(table, {{"lon", "lat", "z"}}).coordinates, (Values{1, 2}));
  EXPECT_EQ(read_points(table, {{"3", "lat", "1"}}).heights, Values{3.5});
  EXPECT_TRUE(read_points(table, {{"3", "2"}}).heights.empty());
  EXPECT_EQ(read_points(write("c.txt", "7 1 2 8\n"), {{"1", "2"}}).coordinates, (Values{1, 2}));
  const auto expect_bad_columns = [&](const Columns& columns, const std::vector<std::string>& parts) {
    expect_error(ErrorKind::input, table + ": line 2", parts, [&] { read_points(table, columns); });
  };
  expect_bad_columns({{"lon", "latitude"}}, {"no column 'latitude'", "name, z, lat, lon"});
  expect_bad_columns({{"lon", "4"}}, {"no column '4'"});
  expect_bad_columns({{"lon", "3"}}, {"twice"});
  expect_bad_columns({{"name", "lat"}}, {"'New York, NY'"});
  expect_bad_points("d.csv", "1,2,3\n4,5\n", {"line 2", "three numbers", "found 2"});
  expect_bad_points("e.csv", "1,2,3,4\n", {"line 1", "found 4", "--columns"});
  for (const char* header : {"id,x,y", "lat,lon,z", ",X,Y", "northing,easting,height"})
    expect_bad_points("f.csv", std::string(header) + "\n1,2,3\n", {"line 2", "--columns"});
  expect_bad_points("g.csv", "x,y,name\n1,2,house\n", {"line 2, column 5", "a height of point 0", "'house'"});
  write("h.bin", std::string(16, '\0'));
  expect_error(ErrorKind::usage, path("h.bin"), {"--columns"}, [&] {
    read_points(path("h.bin"), {{"0", "1"}});
  });
}

TEST_F(IoTest, TextHoldsNoControlCharactersAndIsUtf8) {
  expect_bad_points("a.csv", std::string(100'000, '\0'), {"line 1, column 1", "byte 0x00", "control"});
  // Long enough for whole blocks of plain characters before and after.
  std::string text;
  for (int line = 0; line < 1000; ++line) text += "1 2\n";
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string changed = text;
    return changed.replace(at, bytes.size(), bytes);
  };
  for (const std::string bytes : {"\x01", "\x08", "\x0e", "\x1b", "\x1f", "\x7f", "\xc2\x9b"}) {
    expect_bad_points("b.xy", with(2001, bytes), {"line 501, column 2", "control character", "UTF-8"});
  }
  // A byte that begins nothing, an end missing, forms that are too long, a surrogate, a value too large.
  for (const std::string bytes :
       {"\x80", "\xff", "\xc3\x28", "\xe2\x88", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\xaf", "\xed\xa0\x80",
        "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80"}) {
    expect_bad_points("c.xy", with(400, bytes), {"line 101, column 1", "not valid UTF-8"});
  }
  expect_bad_points("d.xy", "1 2\n3 4 # \xe2\x82", {"line 2, column 7", "byte 0xe2", "not valid UTF-8"});
  expect_bad_points("e.node", "1 2 0 0 # \xe9t\xe9\n0 1 2\n", {"line 1, column 11", "byte 0xe9"});
  // What is no control character, in comments: two, three and four bytes, and the largest.
  EXPECT_EQ(points_of("f.xy", "# \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80 \xf4\x8f\xbf\xbf\n\f1\v2\t\r\n"),
            (Values{1, 2}));
  expect_bad_triangles("g.off", std::string("OFF\n\0", 5), {"line 2, column 1", "byte 0x00"});
  expect_bad_triangles("h.obj", "v 0 0 0\n# \xff\n", {"line 2, column 3", "byte 0xff"});
}

TEST_F(IoTest, TextNamesTheRaggedLine) {
  expect_bad_points("a.xy", "1 2\n\n# c\n3\n", {"line 4", "two numbers", "found 1"});
  expect_bad_points("b.xy", "1 2\n3 4 5\n", {"line 2", "two numbers", "found 3"});
  expect_bad_points("c.csv", "1,2\n3,4,\n", {"line 2", "two numbers", "found 3"});
  expect_bad_points("d.xy", "1\n", {"line 1", "two numbers", "found 1"});
}

TEST_F(IoTest, TextNamesTheUnreadableNumber) {
  expect_bad_points("a.xy", "1 2\r\n3  4x\r\n", {"line 2, column 4", "number", "point 1", "'4x'"});
  expect_bad_points("b.csv", "1,2\n3,4\n,6\n", {"line 3, column 1", "point 2", "nothing"});
  expect_bad_points("c.xy", "1 2\n+-3 4\n", {"line 2, column 1", "'+-3'"});
  // Digits of full width, and those of Arabic.
  expect_bad_points("f.xy", "1 2\n\xef\xbc\x91 2\n", {"'\xef\xbc\x91'", "byte 0xEF"});
  expect_bad_points("g.node", "1 2 0 0\n\xd9\xa1 1 2\n", {"'\xd9\xa1'", "byte 0xD9"});
  expect_bad_points("d.xy", "1 2\n3 0x10\n", {"line 2, column 3", "'0x10'"});
  expect_bad_points("e.xy", "1 2\n3 " + std::string(100, 'z') + "\n", {"'zzzzzzzz", "zzz...'"});
}

TEST_F(IoTest, TextNamesWhatIsNotFinite) {
  expect_bad_points("a.xy", "# c\n1 2\n3 1e400\n", {"line 3, column 3", "point 1", "'1e400'", "infinity"});
  expect_bad_points("b.xy", "1 2\n-1e999999999999999999999 3\n", {"line 2, column 1", "infinity"});
  expect_bad_points("c.xy", "1 2\n3 4\n5 nan\n", {"line 3, column 3", "point 2", "'nan'", "finite"});
  expect_bad_points("d.xy", "1 2\n-inf 4\n", {"line 2, column 1", "point 1", "'-inf'", "finite"});
  expect_bad_points("e.xy", "1 2\n3 " + std::string(400, '9') + "\n", {"line 2, column 3", "infinity"});
}

TEST_F(IoTest, TextRoundsNumbersTooSmallToZero) {
  const Values values = points_of("a.xy", "1e-400 -1e-400\n0.000" + std::string(400, '0') + "1 3e-324\n" +
                                              "1e-99999999999999999999 1e-310\n");
  EXPECT_EQ(values, (Values{0, 0, 0, std::numeric_limits<double>::denorm_min(), 0, 1e-310}));
  EXPECT_TRUE(std::signbit(values[1]));
}

TEST_F(IoTest, ReadsTheFixtures) {
  const std::string data = flaunay::test_data();
  for (const auto& [name, count] : std::vector<std::pair<const char*, std::size_t>>{{"issue43.xy", 5},
                                                                                    {"robustness1.xy", 79},
                                                                                    {"robustness4.xy", 36},
                                                                                    {"issue44.xy", 2828},
                                                                                    {"ukraine.xy", 874}}) {
    EXPECT_EQ(read_points(data + "/" + name).size(), count) << name;
  }
  const Points issue13 = read_points(data + "/issue13.xy");
  EXPECT_EQ(issue13.coordinates[0], 4.0);
  EXPECT_EQ(issue13.coordinates[3], 2.0837249985614585);
}

// ---- .node ----

TEST_F(IoTest, NodeTakesBothIndexBases) {
  const Values expected{105, 39.5, 106.5, 40, 242.99308981350001, 405.49308981349998};
  EXPECT_EQ(points_of("one.node",
                      "3  2  0  1\n   1    105  39.5    1\n   2    106.5  40    1\n"
                      "   3    242.99308981350001  405.49308981349998    0\n"),
            expected);

  // write_points counts from 0.
  write_points(path("zero.node"), read_points(path("one.node")));
  EXPECT_EQ(read(path("zero.node")).substr(0, 32), "3 2 0 0\n0 105 39.5\n1 106.5 40\n2 ");
  EXPECT_EQ(read_points(path("zero.node")).coordinates, expected);
}

TEST_F(IoTest, NodeSkipsCommentsAttributesAndMarkers) {
  EXPECT_EQ(points_of("a.node",
                      "# made by hand\r\n2 2 2 1 # header\r\n\r\n1 5 6 0.1 0.2 1\r\n2 7 8 0.3 x 0 # end\r\n"),
            (Values{5, 6, 7, 8}));
  EXPECT_EQ(points_of("b.node", "1\n0 5 6\n"), (Values{5, 6}));
  EXPECT_EQ(points_of("c.node", "0 2 0 0\n"), Values{});
}

TEST_F(IoTest, NodeNamesWhatDoesNotFit) {
  expect_bad_points("a.node", "# nothing\n", {"no header line", "expected"});
  expect_bad_points("b.node", "x 2 0 0\n", {"line 1, column 1", "number of vertices", "'x'"});
  expect_bad_points("c.node", "1 3 0 0\n0 1 2 3\n", {"line 1", "3 dimensions", "expected 2"});
  expect_bad_points("d.node", "-1 2 0 0\n", {"line 1", "-1 vertices"});
  expect_bad_points("e.node", "1 2 0 2\n0 1 2 3 4\n", {"line 1", "2 boundary markers", "0 or 1"});
  expect_bad_points("f.node", "1 2 0 0 0\n0 1 2\n", {"line 1", "5 fields"});
  expect_bad_points("g.node", "#\n3 2 0 0\n0 1 2\n1 3 4\n", {"line 2", "3 vertices", "after 2"});
  expect_bad_points("h.node", "1 2 0 0\n0 1 2\n#\n1 3 4\n", {"line 4", "more vertices than the 1", "line 1"});
  expect_bad_points("i.node", "2 2 0 0\n0 1 2\n2 3 4\n", {"line 3", "expected vertex number 1", "found 2"});
  expect_bad_points("j.node", "2 2 0 0\n2 1 2\n3 3 4\n", {"line 2", "vertex number 0 or 1", "found 2"});
  expect_bad_points("k.node", "1 2 0 0\n0.5 1 2\n", {"line 2, column 1", "vertex number", "'0.5'"});
  expect_bad_points("l.node", "1 2 1 1\n0 1 2 3\n",
                    {"line 2", "expected 5 fields", "1 attributes", "found 4"});
  expect_bad_points("m.node", "1 2 0 0\n0 1\n", {"line 2", "expected 3 fields", "found 2"});
  expect_bad_points("n.node", "2 2 0 0\n1 1 2\n2 3 4y\n", {"line 3, column 5", "point 1", "'4y'"});
  expect_bad_points("o.node", "2 2 0 0\n1 1 2\n2 1e309 4\n", {"line 3, column 3", "point 1", "infinity"});
  expect_bad_points("p.node", "1 2 0 0\n1 1 nan\n", {"line 2, column 5", "point 0", "'nan'"});
  expect_bad_points("q.node", "9000000000000000000 2 0 0\n1 1 2\n", {"line 1", "after 1"});
  expect_bad_points("r.node", "1 2 9223372036854775807 1\n1 1 2\n",
                    {"line 1", "9223372036854775807 attributes", "expected 0 to 2147483647"});
  expect_bad_points("s.node", "1 2 -1 0\n1 1 2\n", {"line 1", "-1 attributes"});
}

// ---- .bin ----

TEST_F(IoTest, BinaryPairs) {
  EXPECT_EQ(points_of("a.bin", raw<double>({1, 2, -3, 1e300})), (Values{1, 2, -3, 1e300}));
  expect_bad_points("b.bin", raw<double>({1, 2, 3}), {"24 bytes", "multiple of 16"});
  expect_bad_points("c.bin", raw<double>({1, 2, 3, NAN}), {"point 1", "nan", "finite"});
  expect_bad_points("d.bin", raw<double>({1, 2, 3, 4, -INFINITY, 6}), {"point 2", "-inf", "finite"});
}

// ---- .npy ----

TEST_F(IoTest, NpyTakesBothFloatsAndAllVersions) {
  const std::string data = raw<double>({1, 2, 3, 4.5});
  for (const int version : {1, 2, 3}) {
    EXPECT_EQ(points_of("a.npy", npy(npy_header("<f8", "(2, 2)"), data, version)), (Values{1, 2, 3, 4.5}))
        << version;
  }
  EXPECT_EQ(points_of("b.npy", npy(npy_header("<f4", "(2, 2)"), raw<float>({1, 2, 3, 0.1f}))),
            (Values{1, 2, 3, double(0.1f)}));
  EXPECT_EQ(points_of("c.npy", npy(npy_header("<f8", "(0, 2)"), "")), Values{});
  // Another order, other quotes, other spacing, a Python 2 long.
  EXPECT_EQ(
      points_of("d.npy", npy("{\"shape\":(2L,2) ,\"fortran_order\":False,  \"descr\":\"<f8\"}   ", data)),
      (Values{1, 2, 3, 4.5}));
}

TEST_F(IoTest, NpyNamesWhatDoesNotFit) {
  const std::string data = raw<double>({1, 2, 3, 4});
  const std::string good = npy(npy_header("<f8", "(2, 2)"), data);
  expect_bad_points("a.npy", npy(npy_header("<f8", "(2, 2)", "True"), data),
                    {"Fortran order", "expected C order"});
  expect_bad_points("b.npy", npy(npy_header("<i8", "(2, 2)"), data),
                    {"dtype '<i8'", "expected '<f8' or '<f4'"});
  expect_bad_points("c.npy", npy(npy_header(">f8", "(2, 2)"), data),
                    {"big-endian", "'>f8'", "expected '<f8'"});
  expect_bad_points("d.npy", npy(npy_header("<f8", "(4,)"), data), {"shape (4,)", "expected (n, 2)"});
  expect_bad_points("e.npy", npy(npy_header("<f8", "(1, 4)"), data), {"shape (1, 4)", "expected (n, 2)"});
  expect_bad_points("f.npy", npy(npy_header("<f8", "()"), data), {"shape ()", "expected (n, 2)"});
  expect_bad_points("g.npy", good.substr(0, good.size() - 5), {"truncated", "32 bytes", "found 27"});
  expect_bad_points("h.npy", good + "abc", {"3 bytes too many", "32 bytes", "found 35"});
  expect_bad_points("h2.npy", npy(npy_header("<f8", "(1000000000000, 2)"), data),
                    {"truncated", "16000000000000 bytes", "found 32"});
  expect_bad_points("i.npy", good.substr(0, 40), {"truncated in the .npy header"});
  expect_bad_points("j.npy", good.substr(0, 9), {"truncated in the .npy header"});
  expect_bad_points("k.npy", good.substr(0, 7), {"truncated in the .npy header"});
  expect_bad_points("l.npy", "1 2\n3 4\n", {"no .npy file", "NUMPY"});
  expect_bad_points("m.npy", npy(npy_header("<f8", "(2, 2)"), data, 4), {"version 4", "expected 1, 2 or 3"});
  expect_bad_points("n.npy", npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2,)}", data),
                    {"structured dtype"});
  expect_bad_points("o.npy", npy("{'descr': '<f8', 'shape': (2, 2)}", data), {"malformed", "fortran_order"});
  expect_bad_points("p.npy", npy("{'descr': '<f8', 'fortran_order': 0, 'shape': (2, 2)}", data),
                    {"malformed", "True or False"});
  expect_bad_points("q.npy", npy("{'descr': '<f8", data), {"malformed", "string without end"});
  expect_bad_points("r.npy", npy(npy_header("<f8", "(99999999999999999999999, 2)"), data),
                    {"malformed", "too large"});
  expect_bad_points("s.npy", npy(npy_header("<f8", "(9223372036854775807, 2)"), data), {"shape", "memory"});
  expect_bad_points("t.npy", npy(npy_header("<f8", "(2, 2)"), raw<double>({1, 2, INFINITY, 4})),
                    {"point 1", "inf"});
  expect_bad_points("u.npy", npy(npy_header("<f4", "(1, 2)"), raw<float>({1, NAN})), {"point 0", "nan"});
  for (const std::string& after : std::vector<std::string>{"x", "}", {'\0'}, {' ', '\0', ' ', '}'}}) {
    expect_bad_points("v.npy", npy(npy_header("<f8", "(2, 2)") + after, data), {"malformed", "after '}'"});
  }
  expect_bad_points("w.npy", npy(npy_header("<f8", "(2, 2)") + std::string(1 << 16, ' '), data, 2),
                    {"header of 65", "at most 65536"});
}

/// Too large for memory, but with holes, so that it takes no room on the disk.
#ifndef _WIN32  // where the standard library makes no file larger than 2 GiB
TEST_F(IoTest, LargeFilesAreRefusedByTheirBeginning) {
  const auto enlarged = [&](const std::string& name, const std::string& beginning) {
    const std::string file = write(name, beginning);
    std::filesystem::resize_file(file, std::uintmax_t{1} << 40);
    return file;
  };
  const auto expect_refused = [&](const std::string& file, const std::string& reason,
                                  const std::function<void()>& action) {
    expect_error(ErrorKind::input, file + ": ", {reason}, action);
  };
  for (const auto& [beginning, reason] : std::vector<std::pair<std::string, std::string>>{
           {"x,y\n", "no .npy file"},
           {std::string("\x93NUMPY\x04\0", 8), "version 4"},
           {std::string("\x93NUMPY\x02\0\xff\xff\xff\xff", 12), "header of 4294967295 bytes"},
           {npy("{'descr'", ""), "malformed"},
           {npy(npy_header("<f2", "(2, 2)"), ""), "'<f2'"}}) {
    const std::string file = enlarged("a.npy", beginning);
    expect_refused(file, reason, [&] { read_points(file); });
    expect_refused(file, reason, [&] { read_triangles(file); });
  }
  const std::string ply = enlarged("a.ply", "plx\n");
  expect_refused(ply, "no PLY file", [&] { read_triangles(ply); });
}
#endif

// ---- any file of points ----

TEST_F(IoTest, UnreadableFilesSayWhy) {
  for (const char* ending : {".xy", ".node", ".npy", ".bin"}) {
    const std::string missing = path(std::string("missing") + ending);
    expect_error(ErrorKind::input, missing + ": ", {"No such file", "expected"},
                 [&] { read_points(missing); });
    const std::string folder = path(std::string("folder") + ending);
    std::filesystem::create_directory(folder);
    expect_error(ErrorKind::input, folder + ": ", {"Is a directory", "expected"},
                 [&] { read_points(folder); });
    expect_bad_points(std::string("empty") + ending, "", {"empty", "expected"});
  }
}

TEST_F(IoTest, UnknownEndingsListTheKnown) {
  for (const char* name : {"points.vtk", "points", "folder.npy/points", "points.npy.gz"}) {
    for (const auto& action :
         std::vector<std::function<void()>>{[&] { format_of(name, Use::read_points); },
                                            [&] { read_points(name); }, [&] { write_points(name, {}); }}) {
      expect_error(ErrorKind::usage, std::string(name) + ": ",
                   {".npy, .node, .xy, ", ".txt, .csv, .bin", "\"-\""}, action);
    }
  }
  for (const char* name : {"-", "a.npy", "a.NODE", "b.c/a.xy", "a.Txt", "a.csv", ".bin"}) {
    EXPECT_NO_THROW(format_of(name, Use::read_points)) << name;
  }
}

TEST_F(IoTest, PointsReadBackAsWritten) {
  Points points = generate("normal", 3000, 4);
  for (const double value : {0.1, -0.0, 5e-324, -1.7976931348623157e308, 1.0 / 3, 123456789012345680.0}) {
    points.coordinates.push_back(value);
  }
  for (const char* name : {"a.npy", "a.node", "a.xy", "a.txt", "a.csv", "a.bin"}) {
    write_points(path(name), points);
    const Points back = read_points(path(name));
    EXPECT_EQ(raw(back.coordinates), raw(points.coordinates)) << name;  // to the bit: -0.0 is not 0.0
  }
  EXPECT_EQ(names(), (std::set<std::string>{"a.npy", "a.node", "a.xy", "a.txt", "a.csv", "a.bin"}));
  for (const char* name : {"0.npy", "0.node", "0.xy", "0.csv"}) {
    write_points(path(name), {});
    EXPECT_EQ(read_points(path(name)).size(), 0u) << name;
  }
  expect_error(ErrorKind::input, path("0.bin"), {"no points"}, [&] { write_points(path("0.bin"), {}); });
  EXPECT_FALSE(std::filesystem::exists(path("0.bin")));
}

TEST_F(IoTest, TextNumbersAreTheShortest) {
  write_points(path("a.xy"), {{0.1, 1, -2.5, 1e22}});
  EXPECT_EQ(read(path("a.xy")), "# x y\n0.1 1\n-2.5 1e+22\n");
  write_points(path("a.csv"), {{0.1, 1}});
  EXPECT_EQ(read(path("a.csv")), "x,y\n0.1,1\n");
}

// ---- outputs ----

TEST_F(IoTest, OutputsThatCannotBeCreatedSayWhy) {
  const Points points{kSquare};
  const Triangulation mesh = square_mesh();
  std::filesystem::create_directory(path("folder.off"));
  write("file", "");
  const std::vector<std::tuple<std::string, std::string>> cases = {
      {path("folder.off"), "Is a directory"},
      {path("nowhere/a.off"), "No such file or directory"},
#ifndef _WIN32  // which says only that there is no such file
      {path("file/a.off"), "Not a directory"},
      {path(std::string(300, 'n') + ".off"), "name too long"},
#endif
  };
  for (const auto& [target, reason] : cases) {
    expect_error(ErrorKind::input, target + ": ", {reason}, [&, t = target] { Outputs().announce(t); });
    expect_error(ErrorKind::input, target + ": ", {reason}, [&, t = target] { write_mesh(t, points, mesh); });
  }
  // The .node beside an .ele counts too.
  std::filesystem::create_directory(path("b.node"));
  expect_error(ErrorKind::input, path("b.node: "), {"Is a directory"},
               [&] { write_mesh(path("b.ele"), points, mesh); });
  EXPECT_EQ(names(), (std::set<std::string>{"folder.off", "file", "b.node"}));
}

TEST_F(IoTest, AnnouncedFilesAreGoneUnlessTheyAreWritten) {
  const std::string kept = write("kept.off", "kept");
  for (const char* name : {"a.npy", "kept.off"}) {
    Outputs outputs;
    outputs.announce(path(name));
    EXPECT_EQ(names().size(), 2u) << "a partial file";
  }
  EXPECT_EQ(names(), std::set<std::string>{"kept.off"});
  Outputs outputs;
  for (const char* name : {"a.npy", "b.npy", "kept.off"}) outputs.announce(path(name));
  outputs.open(path("b.npy")).print("written");
  outputs.commit();
  EXPECT_EQ(names(), (std::set<std::string>{"b.npy", "kept.off"}));
  EXPECT_EQ(read(kept), "kept");
}

TEST_F(IoTest, WrongOutputEndingsAreUsageErrors) {
  for (const char* name : {"a.stl", "a", "a.node"}) {
    expect_error(ErrorKind::usage, std::string(name) + ": ",
                 {".npy, .geojson, .ele, .off, .obj, .ply, .msh, .vtu, .svg"}, [&] { mesh_files(name); });
    expect_error(ErrorKind::usage, std::string(name) + ": ", {".svg"}, [&] { write_mesh(name, {}, {}); });
  }
  EXPECT_EQ(mesh_files("-"), std::vector<std::string>{"-"});  // .off on standard output
  expect_error(ErrorKind::usage, "a.npy: ", {"'.npy'", "expected .json"},
               [] { check_ending("a.npy", ".json"); });
}

TEST_F(IoTest, NamesMayBeAsLongAsTheSystemPermits) {
  const std::string name(255, 'n'), other = name.substr(0, 254) + 'm';
  Outputs outputs;
  outputs.open(path(name)).print("one");
  outputs.open(path(other)).print("other");
  outputs.commit();
  EXPECT_EQ(read(path(name)) + read(path(other)), "oneother");
}

TEST_F(IoTest, OutputsAreCommittedTogether) {
  write("old", "old");
  Outputs outputs;
  outputs.open(path("old")).print("new");
  outputs.open(path("second")).print("second");
  outputs.write_out();
  EXPECT_EQ(read(path("old")), "old");
  EXPECT_FALSE(std::filesystem::exists(path("second")));
  outputs.commit();
  EXPECT_EQ(read(path("old")), "new");
  EXPECT_EQ(read(path("second")), "second");
  EXPECT_EQ(names(), (std::set<std::string>{"old", "second"}));
}

TEST_F(IoTest, IfOneOutputFailsAllStayAsTheyWere) {
  write("old", "old");
  write("removed", "old");
  Outputs outputs;
  outputs.open(path("old")).print("other");
  outputs.open(path("new")).print("other");
  outputs.remove(path("removed"));
  outputs.open(path("folder")).print("other");
  // In the way of an output that was well when it was opened.
  std::filesystem::create_directory(path("folder"));
  expect_error(ErrorKind::input, path("folder"), {"Is a directory", "all outputs are as they were"},
               [&] { outputs.commit(); });
  outputs = Outputs();
  EXPECT_EQ(names(), (std::set<std::string>{"old", "folder", "removed"}));
  EXPECT_EQ(read(path("old")) + read(path("removed")), "oldold");
}

TEST_F(IoTest, OldFilesAreRemovedWithTheCommit) {
  write("removed", "old");
  write("replaced", "old");
  Outputs outputs;
  outputs.remove(path("removed"));
  outputs.open(path("replaced")).print("new");
  outputs.close();
  outputs.open(path("last")).print("last");
  outputs.write_out();
  EXPECT_EQ(read(path("replaced")) + read(path("removed")), "oldold");
  outputs.commit();
  EXPECT_EQ(names(), (std::set<std::string>{"replaced", "last"}));
  EXPECT_EQ(read(path("replaced")) + read(path("last")), "newlast");
}

TEST(PrintableTest, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("a\nb\tc\rd\x1b[31m\x7f"), "a\\nb\\tc\\rd\\x1b[31m\\x7f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m")
      << "CSI of one character";
  EXPECT_EQ(printable("caf\xc3\xa9 \xc2\xb7 C:\\new"), "caf\xc3\xa9 \xc2\xb7 C:\\new");
  EXPECT_EQ(printable(printable("\n")), "\\n");
}

// ---- meshes ----

TEST_F(IoTest, TrianglesReadBackAsWritten) {
  for (const auto& [points, mesh] :
       {std::pair{Points{kSquare}, square_mesh()}, grid_mesh(70), {Points{}, {}}}) {
    for (const char* name : {"a.ele", "a.off", "a.ply", "a.obj", "a.npy"}) {
      write_mesh(path(name), points, mesh);
      EXPECT_EQ(read_triangles(path(name)), mesh.triangles) << name;
    }
    EXPECT_EQ(read_points(path("a.node")).coordinates, points.coordinates);
  }
  EXPECT_EQ(names(), (std::set<std::string>{"a.ele", "a.node", "a.off", "a.ply", "a.obj", "a.npy"}));
}

TEST_F(IoTest, MeshFormatsAreAsTheirReadersExpect) {
  const Points points{kSquare};
  const Triangulation mesh = square_mesh();
  write_mesh(path("a.ele"), points, mesh);
  EXPECT_EQ(read(path("a.ele")), "4 3 0\n0 0 1 4\n1 1 2 4\n2 2 3 4\n3 0 4 3\n");
  EXPECT_EQ(read(path("a.node")), "5 2 0 0\n0 0 0\n1 1 0\n2 1 1\n3 0 1\n4 0.5 0.5\n");
  write_mesh(path("a.off"), points, mesh);
  EXPECT_EQ(read(path("a.off")),
            "OFF\n5 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 0 4 3\n");
  write_mesh(path("a.obj"), points, mesh);
  EXPECT_EQ(read(path("a.obj")),
            "# 5 vertices, 4 triangles\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nf 1 2 5\nf 2 3 5\nf "
            "3 4 5\nf 1 5 4\n");

  write_mesh(path("a.ply"), points, mesh);
  const std::string ply = read(path("a.ply"));
  EXPECT_EQ(ply.compare(0, 36, "ply\nformat binary_little_endian 1.0\n"), 0);
  EXPECT_NE(ply.find("\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n"),
            std::string::npos);
  const std::string end = "end_header\n";
  const std::string data = ply.substr(ply.find(end) + end.size());
  ASSERT_EQ(data.size(), 5 * 24u + 4 * 13u);
  EXPECT_EQ(data.substr(0, 48), raw<double>({0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(data.substr(5 * 24, 13), "\x03" + raw<std::int32_t>({0, 1, 4}));
}

TEST_F(IoTest, VtuArraysAreWhereTheHeaderSays) {
  const Points points{kSquare};
  const Triangulation mesh = square_mesh();
  write_mesh(path("a.vtu"), points, mesh);
  const std::string vtu = read(path("a.vtu"));
  EXPECT_EQ(vtu.compare(0, 22, "<?xml version=\"1.0\"?>\n"), 0);
  for (const char* part :
       {"byte_order=\"LittleEndian\" header_type=\"UInt64\"", "NumberOfPoints=\"5\" NumberOfCells=\"4\"",
        "<AppendedData encoding=\"raw\">", "</AppendedData>\n</VTKFile>\n"}) {
    EXPECT_NE(vtu.find(part), std::string::npos) << part;
  }
  const std::size_t base = vtu.find("\n_") + 2;
  const auto array = [&](const std::string& name) {
    const std::size_t element = vtu.find("Name=\"" + name + "\""), offset = vtu.find("offset=\"", element);
    const std::size_t begin = base + std::stoul(vtu.substr(offset + 8));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, vtu.data() + begin, sizeof bytes);
    return vtu.substr(begin + sizeof bytes, bytes);
  };
  EXPECT_EQ(array("Points"), raw<double>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 0}));
  EXPECT_EQ(array("connectivity"), raw(mesh.triangles));
  EXPECT_EQ(array("offsets"), raw<std::int64_t>({3, 6, 9, 12}));
  EXPECT_EQ(array("types"), "\x05\x05\x05\x05");
}

TEST_F(IoTest, NpyIsAsNumpyWritesIt) {
  write_npy_indices(path("a.npy"), {1, 2, 3, 4, 5, 6}, 3);
  std::string expected = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + npy_header("<i4", "(2, 3)");
  expected.resize(127, ' ');
  EXPECT_EQ(read(path("a.npy")), expected + "\n" + raw<std::int32_t>({1, 2, 3, 4, 5, 6}));
  write_npy_indices(path("b.npy"), {7, 8}, 0);
  EXPECT_NE(read(path("b.npy")).find("'shape': (2,)"), std::string::npos);
  EXPECT_EQ(read(path("b.npy")).size(), 128u + 8u);
  expect_error(ErrorKind::internal, path("c.npy"), {"rows of 3"}, [&] {
    write_npy_indices(path("c.npy"), {1, 2}, 3);
  });
}

TEST_F(IoTest, TrianglesOfOtherPrograms) {
  const auto triangles = [&](const char* name, const std::string& bytes) {
    return read_triangles(write(name, bytes));
  };
  EXPECT_EQ(triangles("a.ele", "# c\n2 3 1\n1 1 2 3 0.5\n2 2 4 3 0.5 # c\n"), (Indices{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(triangles("b.off", "# c\nOFF 3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n"), (Indices{0, 1, 2}));
  EXPECT_EQ(
      triangles("c.obj", "# c\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3\nf -3 -2 -1\n"),
      (Indices{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(triangles("d.npy", npy(npy_header("<i8", "(1, 3)"), raw<std::int64_t>({0, 1, 2}))),
            (Indices{0, 1, 2}));
  EXPECT_EQ(triangles("e.ply",
                      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty uchar red\nelement face 1\n"
                      "property list uint8 uint32 vertex_index\nend_header\n" +
                          std::string(27, 'v') + "\x03" + raw<std::int32_t>({2, 0, 1})),
            (Indices{2, 0, 1}));
}

TEST_F(IoTest, BadTrianglesNameThePlace) {
  expect_bad_triangles("a.ele", "2 3 0\n0 0 1 2\n", {"line 1", "2 triangles", "after 1"});
  expect_bad_triangles("b.ele", "1 3 0\n0 0 1 2\n1 0 1 2\n", {"line 3", "more triangles than the 1"});
  expect_bad_triangles("c.ele", "1 6 0\n0 0 1 2 3 4 5\n", {"line 1", "6 nodes", "expected 3"});
  expect_bad_triangles("d.ele", "1 3 0\n1 0 1 2\n", {"line 2", "vertex 0", "out of range", "1 to"});
  expect_bad_triangles("e.ele", "1 3 0\n0 0 1\n", {"line 2", "expected 4 fields", "found 3"});
  expect_bad_triangles("f.ele", "1 3 0\n0 0 1 b\n", {"line 2, column 7", "vertex number", "'b'"});
  expect_bad_triangles("g.ele", "2 3 0\n0 0 1 2\n5 0 1 2\n",
                       {"line 3", "expected triangle number 1", "found 5"});
  expect_bad_triangles("g2.ele", "1 3 9223372036854775807\n0 0 1 2\n",
                       {"line 1", "9223372036854775807 attributes", "expected 0 to 2147483647"});
  expect_bad_triangles("h.off", "3 1 0\n", {"line 1", "expected OFF", "'3'"});
  expect_bad_triangles("i.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n3 0 1 2\n", {"line 5", "vertex 2", "0 to 1"});
  expect_bad_triangles("j.off", "OFF\n1 1 0\n0 0 0\n4 0 0 0 0\n", {"line 4", "4 corners", "expected 3"});
  expect_bad_triangles("k.off", "OFF\n2 1 0\n0 0 0\n", {"2 vertices", "after 1"});
  expect_bad_triangles("l.off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n", {"2 faces", "after 1"});
  expect_bad_triangles("m.off", "OFF\n1 0 0\n0 0 0\n3 0 0 0\n", {"line 4", "after the 0 faces"});
  expect_bad_triangles("n.obj", "v 0 0 0\nf 1 1 2\n", {"line 2", "vertex 2", "1 to 1"});
  expect_bad_triangles("o.obj", "v 0 0 0\nf 1 1 1 1\n", {"line 2", "4 corners"});
  expect_bad_triangles("p.obj", "v 0 0 0\nf 1 x 1\n", {"line 2, column 5", "'x'"});
  expect_bad_triangles("q.npy", npy(npy_header("<f8", "(1, 3)"), raw<double>({0, 1, 2})),
                       {"'<f8'", "expected '<i4' or '<i8'"});
  expect_bad_triangles("r.npy", npy(npy_header("<i4", "(2, 3)"), raw<std::int32_t>({0, 1, 2, 3, -4, 5})),
                       {"triangle 1", "vertex -4"});
  expect_bad_triangles("s.npy", npy(npy_header("<i8", "(1, 3)"), raw<std::int64_t>({0, 1, 1LL << 31})),
                       {"triangle 0", "vertex 2147483648"});
  expect_bad_triangles("t.npy", npy(npy_header("<i4", "(3,)"), raw<std::int32_t>({0, 1, 2})),
                       {"shape (3,)", "(m, 3)"});
  for (const char* ending : {".npy", ".ele", ".off", ".obj", ".ply"}) {
    expect_bad_triangles(std::string("empty") + ending, "", {"empty", "expected"});
  }
  expect_error(ErrorKind::usage, "a.svg: ", {".npy, .ele, .off, .obj, .ply"},
               [] { read_triangles("a.svg"); });
}

TEST_F(IoTest, NeighborsReadBackAsWritten) {
  const Indices neighbors = {1, 3, -1, 2, 0, -1};
  write_npy_indices(path("a.npy"), neighbors, 3);
  EXPECT_EQ(read_neighbors(path("a.npy")), neighbors);
  const std::string bad =
      write("b.npy", npy(npy_header("<i8", "(2, 3)"), raw<std::int64_t>({0, 1, -1, 0, -2, 1})));
  expect_error(ErrorKind::input, bad + ": ", {"triangle 1", "-2", "expected -1 to"},
               [&] { read_neighbors(bad); });
  expect_error(ErrorKind::usage, "a.ele: ", {"expected .npy"}, [] { read_neighbors("a.ele"); });
}

TEST_F(IoTest, BadPlyNamesThePlace) {
  write_mesh(path("good.ply"), {kSquare}, square_mesh());
  const std::string good = read(path("good.ply"));
  const std::size_t data = good.find("end_header\n") + 11;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos);
    return bytes.replace(at, from.size(), to);
  };
  expect_bad_triangles("a.ply", "plx\n", {"no PLY file"});
  expect_bad_triangles("b.ply", good.substr(0, 100), {"end_header"});
  expect_bad_triangles("c.ply", good.substr(0, data + 30), {"truncated", "5 vertices"});
  expect_bad_triangles("d.ply", good.substr(0, good.size() - 1), {"truncated", "4 faces", "face 3"});
  expect_bad_triangles("e.ply", good + "x", {"1 bytes after", "4 faces"});
  expect_bad_triangles("f.ply", replaced("binary_little_endian", "binary_big_endian"),
                       {"binary_little_endian"});
  expect_bad_triangles("g.ply", replaced("element vertex 5", "element vertex -5"), {"line 4", "-5 elements"});
  expect_bad_triangles("h.ply", replaced("list uchar int", "list uchar float"), {"line 9", "list uchar int"});
  expect_bad_triangles("i.ply", replaced("element vertex 5", "element vertex 9223372036854775807"),
                       {"truncated"});
  std::string corners = good, vertex = good;
  corners[data + 5 * 24 + 13] = 4;
  expect_bad_triangles("j.ply", corners,
                       {"face 1", "4 corners", "byte " + std::to_string(data + 5 * 24 + 13)});
  vertex[data + 5 * 24 + 1] = 5;
  expect_bad_triangles("k.ply", vertex, {"face 0", "vertex 5", "0 to 4"});
}

// ---- .svg ----

/// Whether tags are balanced and attributes quoted. Enough of XML for what write_mesh writes.
testing::AssertionResult is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return testing::AssertionFailure() << "tag without end at byte " << at;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    at = end;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0)
      return testing::AssertionFailure() << "quotes in " << tag;
    if (tag[0] == '?') continue;
    const std::string name = tag.substr(tag[0] == '/', tag.find_first_of(" \n", 1) - (tag[0] == '/'));
    if (tag[0] == '/') {
      if (open.empty() || open.back() != name)
        return testing::AssertionFailure() << "unexpected </" << name << ">";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  if (!open.empty()) return testing::AssertionFailure() << "<" << open.back() << "> is not closed";
  return testing::AssertionSuccess();
}

using Corner = std::pair<long, long>;
struct Decoded {
  std::set<std::pair<Corner, Corner>> segments;  // smaller end first
  std::size_t steps = 0, closed = 0;
  std::vector<Corner> moves;
};

/// Follows the data of all path elements whose start tag contains `mark`.
Decoded decode_paths(const std::string& svg, const std::string& mark) {
  Decoded result;
  for (std::size_t at = svg.find("<path "); at != std::string::npos; at = svg.find("<path ", at + 1)) {
    const std::size_t begin = svg.find(" d=\"", at) + 4, end = svg.find('"', begin);
    if (svg.substr(at, begin - at).find(mark) == std::string::npos) continue;
    const std::string data = svg.substr(begin, end - begin);
    const char* c = data.c_str();
    Corner pen{0, 0}, start{0, 0};
    bool move = false;
    while (*c) {
      if (*c == 'm') {
        move = true;
        ++c;
      } else if (*c == 'z') {
        pen = start;
        ++result.closed;
        ++c;
      } else if (*c == 'h') {
        c += 2;  // h0, the dot of a point
      } else {
        char* next = nullptr;
        const long dx = std::strtol(c, &next, 10), dy = std::strtol(next, &next, 10);
        if (next == c) {
          ADD_FAILURE() << "unexpected path data " << std::string(c).substr(0, 20);
          return result;
        }
        c = next;
        const Corner to{pen.first + dx, pen.second + dy};
        if (move) {
          start = to;
          result.moves.push_back(to);
        } else {
          ++result.steps;
          result.segments.insert(std::minmax(pen, to));
        }
        pen = to;
        move = false;
      }
    }
  }
  return result;
}

std::string svg_of(const std::string& file, const Points& points, const Triangulation& mesh) {
  write_mesh(file, points, mesh);
  std::ostringstream bytes;
  bytes << std::ifstream(file).rdbuf();
  return bytes.str();
}

TEST_F(IoTest, SvgDrawsEveryTriangleAndEveryEdgeOnce) {
  for (const std::int32_t cells : {1, 7, 60}) {
    const auto [points, mesh] = grid_mesh(cells);
    const std::string svg = svg_of(path("a.svg"), points, mesh);
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(decode_paths(svg, "fill=\"#").closed, mesh.triangles.size() / 3);
    const Decoded edges = decode_paths(svg, "id=\"edges"), hull = decode_paths(svg, "id=\"hull");
    EXPECT_EQ(hull.steps, mesh.hull.size());
    EXPECT_EQ(edges.steps, edges.segments.size());
    std::set<std::pair<Corner, Corner>> all = edges.segments;
    all.insert(hull.segments.begin(), hull.segments.end());
    EXPECT_EQ(all.size(), static_cast<std::size_t>(3 * cells * cells + 2 * cells));
  }
}

TEST_F(IoTest, SvgHasItsYAxisUpwardsAndACaption) {
  Triangulation mesh = square_mesh();
  Points points{kSquare};
  points.coordinates.insert(points.coordinates.end(), {1, 1});
  mesh.representatives.push_back(2);
  const std::string svg = svg_of(path("a.svg"), points, mesh);
  EXPECT_NE(svg.find(">6 points · 4 triangles · 4 on the hull · 1 duplicate<"), std::string::npos);
  const std::vector<Corner> dots = decode_paths(svg, "id=\"points").moves;
  ASSERT_EQ(dots.size(), 6u);
  EXPECT_EQ(dots[0].first, 0);
  EXPECT_GT(dots[0].second, 0);
  EXPECT_EQ(dots[2], Corner(dots[0].second, 0));  // aspect kept
  EXPECT_EQ(dots[3], Corner(0, 0));
}

TEST_F(IoTest, SvgOfManyPointsHasThousandsAndNoDots) {
  const auto [points, mesh] = grid_mesh(120);
  const std::string svg = svg_of(path("a.svg"), points, mesh);
  EXPECT_NE(svg.find(">14,641 points · 28,800 triangles · 480 on the hull<"), std::string::npos);
  EXPECT_EQ(svg.find("id=\"points\""), std::string::npos);
  EXPECT_EQ(svg.find("centre"), std::string::npos);
  EXPECT_LT(svg.size(), 40 * 28800u);
}

TEST_F(IoTest, SvgShowsTheCentreWhenOutliersWouldShrinkIt) {
  auto [points, mesh] = grid_mesh(20);
  // One corner far out.
  points.coordinates[points.coordinates.size() - 2] = 1e6;
  points.coordinates[points.coordinates.size() - 1] = 1e6;
  const std::string svg = svg_of(path("a.svg"), points, mesh);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("only the centre is shown, with "), std::string::npos);
  // Nothing is drawn far outside, and the centre keeps its triangles.
  const Decoded triangles = decode_paths(svg, "fill=\"#"), edges = decode_paths(svg, "id=\"edges");
  EXPECT_GT(triangles.closed, 500u);
  for (const auto& [from, to] : edges.segments) {
    for (const Corner& corner : {from, to}) {
      EXPECT_GE(std::min(corner.first, corner.second), 0);
      EXPECT_LE(std::max(corner.first, corner.second), 40'000);
    }
  }
}

TEST_F(IoTest, SvgOfDegenerateInputs) {
  Triangulation line;
  line.hull = {0, 1, 2};
  line.representatives = {0, 1, 2};
  line.hull_offsets = {0, 3};
  line.triangle_offsets = {0, 0};
  Triangulation one;
  one.hull = {0};
  one.representatives = {0, 0};
  one.hull_offsets = {0, 1};
  one.triangle_offsets = {0, 0};
  const std::vector<std::tuple<Points, Triangulation, std::size_t>> cases = {
      {Points{}, Triangulation{}, 0},
      {Points{{3, 4, 3, 4}}, one, 0},
      {Points{{0, 0, 0, 1, 0, 2}}, line, 3},
      {Points{{-1.7e308, 0, 0, 0, 1.7e308, 0}}, line, 3},
      {Points{{0, 0, 1e-310, 1e-310, 2e-310, 2e-310}}, line, 3},
  };
  for (const auto& [points, mesh, segments] : cases) {
    const std::string svg = svg_of(path("a.svg"), points, mesh);
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(decode_paths(svg, "id=\"hull").segments.size(), segments);
    EXPECT_EQ(decode_paths(svg, "id=\"points").moves.size(), points.size());
    for (const char* bad : {"nan", "inf"}) EXPECT_EQ(svg.find(bad), std::string::npos) << bad;
  }
}

// ------------------------------------------------------------------------------------------------ regions

/// A pinched region: two triangles that touch in point 2, with a point inside each.
struct Pinched {
  Points points{{0, 0, 4, 0, 2, 2, 4, 4, 0, 4, 2, 0.1, 1e-300, 1e300, 2, 3.9}};
  research::Region region{{0, 1, 2, 3, 4, 5, 7}, {0, 1, 1, 2, 2, 0, 2, 3, 3, 4, 4, 2}};
};

TEST_F(IoTest, ARegionReadsBackExactly) {
  const Pinched pinched;
  write_region(path("r"), pinched.points, pinched.region);
  EXPECT_EQ(names(), (std::set<std::string>{"r.node", "r.poly"}));
  const StoredRegion stored = read_region(path("r"), 7, 6);
  EXPECT_EQ(stored.region.points, pinched.region.points);
  EXPECT_EQ(stored.region.border, pinched.region.border);
  EXPECT_EQ(stored.points.coordinates, (Values{0, 0, 4, 0, 2, 2, 4, 4, 0, 4, 2, 0.1, 2, 3.9}));
  // Any reader of points takes the .node.
  EXPECT_EQ(read_points(path("r.node")).coordinates, stored.points.coordinates);
}

TEST_F(IoTest, ARegionMayBeNumberedFromOne) {
  write("r.node", "# from elsewhere\n3 2 2 1\n1 0 0 7 0.5 1\n2 1 0 5 0.5 1\n3 0 1 6 0.5 1\n");
  write("r.poly", "0 2 1 1\n3 1\n1 1 2 9\n2 2 3 9\n3 3 1 9\n0\n");
  const StoredRegion stored = read_region(path("r"), 3, 3);
  EXPECT_EQ(stored.region.points, (Indices{7, 5, 6}));
  EXPECT_EQ(stored.region.border, (Indices{0, 1, 1, 2, 2, 0}));
}

TEST_F(IoTest, APartitionsPictureWindsAroundEachRegionOnce) {
  const Pinched pinched;
  Points points = pinched.points;
  points.coordinates[13] = 1;  // no outlier
  research::Partition partition;
  partition.regions = {pinched.region};
  partition.triangles = {1, 3, 2};
  write_partition_svg(path("a.svg"), points, partition);
  const std::string svg = read(path("a.svg"));
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("8 points · 1 region · 1 finished triangle (grey)"), std::string::npos) << svg;
  const Decoded border = decode_paths(svg, "id=\"region-0\"");
  EXPECT_EQ(border.closed, 2u);
  EXPECT_EQ(border.segments.size(), 4u) << "the last of each walk closes it";

  for (const Points& degenerate : {Points{}, Points{{1, 2}}, Points{{-1.7e308, 0, 0, 0, 1.7e308, 0}}}) {
    write_partition_svg(path("b.svg"), degenerate, research::Partition{});
    EXPECT_TRUE(is_well_formed(read(path("b.svg"))));
  }
}

#ifndef _WIN32
// ---- pipes, links, permissions and limits as POSIX has them ----

TEST_F(IoTest, StandardInputIsText) {
  const std::string file = write("input", "x y\n1 2\n3 4\n"), bad = write("bad", "1 2\n3 q\n"),
                    none = write("none", "");
  const int saved = dup(STDIN_FILENO);
  ASSERT_GE(saved, 0);
  const auto from = [](const std::string& name, const std::function<void()>& action) {
    const int input = open(name.c_str(), O_RDONLY);
    dup2(input, STDIN_FILENO);
    close(input);
    action();
  };
  from(file, [] { EXPECT_EQ(read_points("-").coordinates, (Values{1, 2, 3, 4})); });
  from(bad, [] {
    expect_error(ErrorKind::input, "- (standard input): ", {"line 2, column 3", "'q'"},
                 [] { read_points("-"); });
  });
  from(none,
       [] { expect_error(ErrorKind::input, "- (standard input): ", {"empty"}, [] { read_points("-"); }); });
  dup2(saved, STDIN_FILENO);
  close(saved);
}

TEST_F(IoTest, ReadsPipesLongerThanOneBuffer) {
  const std::string fifo = path("pipe.xy");
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const Points points = generate("uniform", 20000, 1);
  const std::string file = path("file.xy");
  write_points(file, points);
  // "cat" as the other end.
  ASSERT_EQ(std::system(("cat '" + file + "' > '" + fifo + "' &").c_str()), 0);
  EXPECT_EQ(read_points(fifo).coordinates, points.coordinates);
}

TEST_F(IoTest, ReadsArraysFromPipesAsFromFiles) {
  const std::string fifo = path("pipe.npy"), file = path("file.npy");
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  const Points points = generate("uniform", 300000, 1);
  write_points(file, points);
  const auto feed = [&](const std::string& command) {
    ASSERT_EQ(std::system((command + " '" + file + "' > '" + fifo + "' &").c_str()), 0);
  };
  feed("cat");
  EXPECT_EQ(read_points(fifo).coordinates, points.coordinates);
  EXPECT_EQ(read_points(file).coordinates, points.coordinates);
  feed("head -c -8");
  expect_error(ErrorKind::input, fifo, {"truncated", "4800000 bytes", "found 4799992"},
               [&] { read_points(fifo); });
}

TEST_F(IoTest, UnwritableFolderSaysWhy) {
  std::filesystem::create_directory(path("closed"));
  write("kept.off", "kept");
  ASSERT_EQ(chmod(path("closed").c_str(), 0500), 0);
  ASSERT_EQ(chmod(path("kept.off").c_str(), 0400), 0);
  ASSERT_EQ(chmod(folder_.c_str(), 0755), 0);
  constexpr uid_t kNobody = 65534;
  const uid_t user = geteuid();
  if (user == 0) {
    ASSERT_EQ(seteuid(kNobody), 0);  // root may write anywhere
  }
  for (const char* name : {"closed/a.off", "kept.off"}) {
    expect_error(ErrorKind::input, path(name) + ": ", {"Permission denied"},
                 [&] { Outputs().announce(path(name)); });
    expect_error(ErrorKind::input, path(name) + ": ", {"Permission denied"},
                 [&] { write_mesh(path(name), {kSquare}, square_mesh()); });
  }
  ASSERT_EQ(seteuid(user), 0);
  EXPECT_EQ(read(path("kept.off")), "kept");
}

TEST_F(IoTest, FullDeviceIsAnError) {
  std::filesystem::create_symlink("/dev/full", path("full.off"));
  EXPECT_NO_THROW(Outputs().announce(path("full.off")));
  expect_error(ErrorKind::input, path("full.off: "), {"No space left"},
               [&] { write_mesh(path("full.off"), {kSquare}, square_mesh()); });
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(IoTest, FailedWriteKeepsTheOldFile) {
  const std::vector<const char*> targets = {"a.ele", "a.off", "a.ply", "a.msh",
                                            "a.vtu", "a.obj", "a.npy", "a.svg"};
  std::set<std::string> before = {"a.node"};
  write("a.node", "old");
  for (const char* name : targets) {
    write(name, "old");
    before.insert(name);
  }
  const auto [points, mesh] = grid_mesh(60);
  // A limit on the size of files fails like a full disk: in the middle of the writing.
  rlimit saved{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &saved), 0);
  const auto old_handler = signal(SIGXFSZ, SIG_IGN);
  for (const char* name : targets) {
    std::string message;
    rlimit small = saved;
    small.rlim_cur = 3000;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    try {
      write_mesh(path(name), points, mesh);
    } catch (const Error& error) {
      message = error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &saved), 0);
    EXPECT_NE(message.find("File too large"), std::string::npos) << name << ": " << message;
  }
  signal(SIGXFSZ, old_handler);
  EXPECT_EQ(names(), before);
  for (const std::string& name : before) EXPECT_EQ(read(path(name)), "old") << name;
}

TEST_F(IoTest, ReplacingKeepsModeAndSymbolicLink) {
  const std::string real = write("real.off", "old");
  ASSERT_EQ(chmod(real.c_str(), 0640), 0);
  std::filesystem::create_symlink("real.off", path("link.off"));
  write_mesh(path("link.off"), {kSquare}, square_mesh());
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.off")));
  EXPECT_EQ(read_triangles(real), square_mesh().triangles);
  struct stat status {};
  ASSERT_EQ(stat(real.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(names(), (std::set<std::string>{"real.off", "link.off"}));
}

TEST_F(IoTest, ADanglingLinkIsFollowed) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_symlink("folder/second.off", path("first.off"));
  std::filesystem::create_symlink("../real.off", path("folder/second.off"));
  EXPECT_NO_THROW(Outputs().announce(path("first.off")));
  EXPECT_FALSE(std::filesystem::exists(path("real.off")));
  write_mesh(path("first.off"), {kSquare}, square_mesh());
  EXPECT_TRUE(std::filesystem::is_symlink(path("first.off")));
  EXPECT_TRUE(std::filesystem::is_symlink(path("folder/second.off")));
  EXPECT_EQ(read_triangles(path("real.off")), square_mesh().triangles);

  std::filesystem::create_symlink("b.off", path("a.off"));
  std::filesystem::create_symlink("a.off", path("b.off"));
  expect_error(ErrorKind::input, path("a.off"), {"symbolic links"},
               [&] { Outputs().announce(path("a.off")); });
  std::filesystem::create_symlink("nowhere/c.off", path("c.off"));
  expect_error(ErrorKind::input, path("c.off"), {"No such file"}, [&] { Outputs().announce(path("c.off")); });
}

TEST_F(IoTest, ALinkIsRemovedAndNotWhereItLeads) {
  write("linked", "old");
  std::filesystem::create_symlink("linked", path("link"));
  Outputs outputs;
  outputs.remove(path("link"));
  outputs.commit();
  EXPECT_EQ(names(), (std::set<std::string>{"linked"}));
  EXPECT_EQ(read(path("linked")), "old");
}

TEST_F(IoTest, TwoOutputsOfOnePathAreRefusedHoweverItIsWritten) {
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_directory_symlink("folder", path("link"));
  std::filesystem::create_symlink("folder/a", path("dangling"));
  std::filesystem::create_symlink("/dev/null", path("null"));
  for (const std::string state : {"new", "existing"}) {
    SCOPED_TRACE(state);
    for (const char* other : {"folder/a", "./folder//a", "link/a", "folder/../folder/a", "dangling"}) {
      Outputs outputs;
      outputs.announce(path("folder/a"));
      expect_error(ErrorKind::usage, path(other), {"same path"}, [&] { outputs.announce(path(other)); });
    }
    Outputs outputs;
    outputs.announce(path("folder/a"));
    for (const char* other : {"a", "folder/b", "folder/\xc3\xa4", "null"}) outputs.announce(path(other));
    expect_error(ErrorKind::usage, "/dev/null", {"same path"}, [&] { outputs.announce("/dev/null"); });
    write("folder/a", "");
  }
}

#endif

}  // namespace
}  // namespace flaunay::io
