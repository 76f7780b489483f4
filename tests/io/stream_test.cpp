// Points that are read, and meshes that are written, in pieces; LAS files.
#ifndef _WIN32
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#endif

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>

#include "app/files/formats.hpp"
#include "app/files/generate.hpp"
#include "app/files/mesh.hpp"
#include "app/files/npy.hpp"
#include "app/files/point_stream.hpp"
#include "app/files/points.hpp"
#include "files/mesh_stream.hpp"
#include "files/output.hpp"
#include "files/scratch.hpp"
#include "tests/io/folder.hpp"

namespace flaunay::io::streams {
namespace {

using Values = std::vector<double>;

// ------------------------------------------------------------------------------------------------ LAS files

/// A LAS file as the specification has it.
struct LasFile {
  int minor = 4;
  int format = 6;
  std::size_t extra_bytes = 0;  ///< of each record, defined by the user
  std::size_t gap = 0;          ///< bytes between the header and the points, for records of variable length
  std::array<double, 3> scale = {0.01, 0.001, 1};
  std::array<double, 3> offset = {500000, -20, 0};
  std::vector<std::array<std::int32_t, 2>> points;
  std::uint64_t claimed = 0;  ///< more points that the header promises

  std::size_t header_bytes() const { return minor == 4 ? 375 : minor == 3 ? 235 : 227; }
  std::size_t record_bytes() const {
    constexpr std::array<std::size_t, 11> kBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    return kBytes[static_cast<std::size_t>(format) % kBytes.size()] + extra_bytes;
  }
  std::string bytes() const {
    std::string file(header_bytes() + gap, '\0');
    const auto put = [&file](std::size_t place, auto value) {
      std::memcpy(&file[place], &value, sizeof value);
    };
    file.replace(0, 4, "LASF");
    file[24] = 1;
    file[25] = static_cast<char>(minor);
    put(94, static_cast<std::uint16_t>(header_bytes()));
    put(96, static_cast<std::uint32_t>(file.size()));
    put(104, static_cast<std::uint8_t>(format));
    put(105, static_cast<std::uint16_t>(record_bytes()));
    const std::uint64_t count = points.size() + claimed;
    if (minor == 4) {
      put(247, count);  // and no legacy count
    } else {
      put(107, static_cast<std::uint32_t>(count));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      put(131 + 8 * axis, scale[axis]);
      put(155 + 8 * axis, offset[axis]);
    }
    for (const auto& point : points) {
      std::string record(record_bytes(), '\x55');
      std::memcpy(record.data(), point.data(), sizeof point);
      file += record;
    }
    return file;
  }
  /// The doubles next to the decimal numbers that scales and offsets, unless changed, give.
  Values coordinates() const {
    Values all;
    for (const auto& [x, y] : points) {
      all.push_back((x + 500000 * 100.0) / 100);
      all.push_back((y - 20 * 1000.0) / 1000);
    }
    return all;
  }
};

LasFile some_scan() {
  LasFile scan;
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  scan.points = {{0, 0}, {123456, -7}, {kLeast, std::numeric_limits<std::int32_t>::max()}, {3, 4}, {-1, 1}};
  return scan;
}

class LasTest : public FolderTest {
 protected:
  /// Both ways to read must refuse it, with one message.
  void expect_bad(const std::string& bytes, const std::vector<std::string>& parts) {
    const std::string file = write("bad.las", bytes);
    expect_error(ErrorKind::input, file + ": ", parts, [&] { read_points(file); });
    expect_error(ErrorKind::input, file + ": ", parts, [&] { open_point_stream(file, folder_); });
  }
};

TEST_F(LasTest, EveryVersionAndFormat) {
  constexpr std::array<int, 5> kLastFormat = {1, 1, 3, 5, 10};
  for (int minor = 0; minor <= 4; ++minor) {
    for (int format = 0; format <= kLastFormat[static_cast<std::size_t>(minor)]; ++format) {
      for (const std::size_t more : {0, 5}) {
        SCOPED_TRACE(std::to_string(minor) + " " + std::to_string(format) + " " + std::to_string(more));
        LasFile scan = some_scan();
        scan.minor = minor;
        scan.format = format;
        scan.extra_bytes = more;
        scan.gap = 13 * more;
        // What follows the points is no part of them.
        const std::string file = write("scan.las", scan.bytes() + std::string(more, 'x'));
        const Points points = read_points(file);
        EXPECT_EQ(raw(points.coordinates), raw(scan.coordinates()));
        EXPECT_EQ(estimate_points(file), scan.points.size());
        // Flags are 01010101, of which the highest or the third one counts.
        EXPECT_EQ(points.withheld, format < 6 ? 0 : scan.points.size());
      }
    }
  }
}

TEST_F(LasTest, NoPoints) { EXPECT_EQ(read_points(write("none.LAS", LasFile().bytes())).size(), 0u); }

TEST_F(LasTest, MorePointsThanAPieceHas) {
  LasFile scan;
  for (std::int32_t i = 0; i < 200'000; ++i) scan.points.push_back({i, 7 * i});
  EXPECT_EQ(raw(read_points(write("scan.las", scan.bytes())).coordinates), raw(scan.coordinates()));
}

TEST_F(LasTest, WrongFiles) {
  const std::string good = some_scan().bytes();
  const auto with = [&good](std::size_t place, const std::string& bytes) {
    std::string changed = good;
    changed.replace(place, bytes.size(), bytes);
    return changed;
  };
  expect_bad("", {"empty"});
  expect_bad(with(0, "LASX"), {"is no LAS file"});
  expect_bad("LA", {"is no LAS file"});
  expect_bad(good.substr(0, 200), {"truncated in the LAS header", "200 bytes"});
  expect_bad(good.substr(0, 300), {"header of 300 bytes", "at least 375"});
  expect_bad(with(25, "\x05"), {"version 1.5", "1.0 to 1.4"});
  expect_bad(with(24, "\x02"), {"version 2.4"});
  expect_bad(with(94, std::string("\xe3\x00", 2)), {"header of 227 bytes", "at least 375"});
  expect_bad(with(96, std::string("\x64\x00\x00\x00", 4)), {"from byte 100 on", "within the header"});
  expect_bad(with(104, "\x0b"), {"point format 11", "0 to 10"});
  expect_bad(with(104, "\x86"), {"compressed (LAZ)", "laszip"});
  expect_bad(with(104, "\x46"), {"compressed (LAZ)"});
  expect_bad(with(105, std::string("\x1d\x00", 2)), {"records of 29 bytes", "at least 30 in point format 6"});
  expect_bad(with(131, raw<double>({0})), {"scale 0", "for x"});
  expect_bad(with(139, raw<double>({NAN})), {"scale nan", "for y"});
  expect_bad(with(163, raw<double>({INFINITY})), {"offset inf", "for y"});
  expect_bad(good.substr(0, good.size() - 1), {"truncated", "5 points of 30 bytes from byte 375 on"});
  // The fuzzer found that a file without points got as much memory as its header said.
  for (const std::string& file : {good, LasFile().bytes()}) {
    std::string far = file;
    expect_bad(far.replace(96, 4, "\xff\xff\xff\xff"), {"truncated", "from byte 4294967295 on"});
  }
  for (const std::uint64_t claimed : {std::uint64_t{1}, std::uint64_t{1} << 60, ~std::uint64_t{5}}) {
    LasFile scan = some_scan();
    scan.claimed = claimed;
    expect_bad(scan.bytes(), {"truncated"});
  }
  // Read as it says, beyond the largest double.
  LasFile huge = some_scan();
  huge.scale[0] = 1e308;
  const std::string file = write("huge.las", huge.bytes());
  expect_error(ErrorKind::input, file + ": ", {"point 1 is (inf, "}, [&] { read_points(file); });
}

TEST_F(LasTest, CompressedFilesAreRefused) {
  const std::string laz = write("scan.laz", some_scan().bytes());
  expect_error(ErrorKind::input, laz + ": ", {"compressed (LAZ)", "pdal"}, [&] { read_points(laz); });
  expect_error(ErrorKind::input, laz + ": ", {"compressed (LAZ)"}, [&] { format_of(laz, Use::read_points); });
  expect_error(ErrorKind::usage, "out.las: ", {"unknown ending '.las'"},
               [] { format_of("out.las", Use::write_points); });
}

// ----------------------------------------------------------------------------------------- points in pieces

class PointStreamTest : public FolderTest {
 protected:
  /// Reads all points, `piece` at a time.
  static Values read_all(PointSource& source, std::size_t piece) {
    Values all(2 * source.size());
    for (std::uint64_t first = 0; first < source.size(); first += piece) {
      source.read(first, std::min<std::uint64_t>(piece, source.size() - first), all.data() + 2 * first);
    }
    return all;
  }
  void expect_same_points(const std::string& file) {
    SCOPED_TRACE(file);
    const Values expected = read_points(file).coordinates;
    const std::unique_ptr<PointSource> source = open_point_stream(file, folder_);
    ASSERT_EQ(2 * source->size(), expected.size());
    for (const std::size_t piece : {std::size_t{100}, std::size_t{70'001}, expected.size() + 1}) {
      EXPECT_EQ(raw(read_all(*source, piece)), raw(expected)) << piece;
    }
    double last[2] = {};
    source->read(source->size() - 1, 1, last);
    source->read(0, 0, nullptr);
    EXPECT_EQ(raw(Values(last, last + 2)), raw(Values(expected.end() - 2, expected.end())));
  }
  /// Reading in pieces fails as reading at once does.
  void expect_same_error(const std::string& file) {
    SCOPED_TRACE(file);
    std::string expected;
    try {
      read_points(file);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      expected = error.what();
    }
    expect_error(ErrorKind::input, expected, {}, [&] { open_point_stream(file, folder_); });
  }
  void write_points_to(const std::string& name, const Points& points) {
    Outputs outputs;
    write_points(outputs, path(name), points);
    outputs.commit();
  }
};

TEST_F(PointStreamTest, EveryFormatHasTheSamePoints) {
  const Points points = generate("normal", 150'000, 5);
  for (const char* name : {"a.npy", "a.bin", "a.xy", "a.csv", "a.txt", "a.node"}) {
    write_points_to(name, points);
    expect_same_points(path(name));
    const double estimated = static_cast<double>(estimate_points(path(name)));
    EXPECT_NEAR(estimated, 150'000, 10'000) << name;
  }
  const std::vector<float> narrow(points.coordinates.begin(), points.coordinates.end());
  expect_same_points(write("f.npy", npy_header("<f4", 150'000, 2) + raw(narrow)));
  LasFile scan;
  for (std::int32_t i = 0; i < 100'000; ++i) scan.points.push_back({i, i * 5 % 77});
  expect_same_points(write("a.las", scan.bytes()));
  EXPECT_EQ(estimate_points(path("a.npy")), 150'000u);
  EXPECT_EQ(estimate_points("-"), 0u);
}

TEST_F(PointStreamTest, TextIsCutAtLinesAlone) {
  // Comments and blanks that are longer than a piece, with a mark of the byte order and without a last line
  // end.
  std::string text = "\xEF\xBB\xBF# x y\nx,y\n1,2\n#" + std::string(9'000'000, '-') + "\n";
  for (int i = 0; i < 400'000; ++i)
    text += std::to_string(i) + ", \"" + std::to_string(i * 0.37) + "\" # end\r\n";
  text += std::string(5'000'000, '\n') + "7,8";
  expect_same_points(write("a.csv", text));
  EXPECT_EQ(names(), (std::set<std::string>{"a.csv"})) << "the scratch file has a name";
}

TEST_F(PointStreamTest, ErrorsInTextNameTheLineOfTheFile) {
  std::string lines, vertices = "500000 2 0 0\n";
  for (int i = 0; i < 400'000; ++i) lines += std::to_string(i) + " 0.12345\n";
  for (int i = 0; i < 400'000; ++i) vertices += std::to_string(i) + " 1.5 0.12345\n";
  expect_same_error(write("number.xy", lines + "1 2\n3 4x\n"));
  expect_same_error(write("fields.xy", lines + "\n1 2 3\n"));
  expect_same_error(write("nan.xy", lines + "1 nan"));
  expect_same_error(write("infinite.xy", lines + "1e999 0"));
  expect_same_error(write("utf8.xy", lines + "1 \xff\n"));
  expect_same_error(write("control.xy", lines + std::string(1, '\0')));
  expect_same_error(write("header.xy", "e1 e2\n" + lines));
  expect_same_error(write("late-header.xy", lines + "x y\n"));
  expect_same_error(write("early.node", vertices));
  expect_same_error(write("number.node", vertices + "400001 1 1\n"));
  expect_same_error(write("none.node", "# nothing\n"));
  expect_same_error(write("many.node", "1 2 0 0\n0 1 1\n1 2 2\n"));
  expect_same_error(write("empty.xy", ""));
  expect_same_error(path("missing.xy"));
  EXPECT_EQ(open_point_stream(write("none.xy", "# nothing\n"), folder_)->size(), 0u);
}

TEST_F(PointStreamTest, WrongBinaryFilesAreRefusedBeforeTheyAreRead) {
  const std::string eight = raw(Values{0, 0, 1, 0, 0, 1, 1, 1});
  expect_same_error(write("columns.npy", npy_header("<f8", 2, 4) + eight));
  expect_same_error(write("type.npy", npy_header("<i8", 4, 2) + eight));
  expect_same_error(write("short.npy", npy_header("<f8", 5, 2) + eight));
  expect_same_error(write("long.npy", npy_header("<f8", 3, 2) + eight));
  expect_same_error(write("huge.npy", npy_header("<f8", std::uint64_t{1} << 59, 2) + eight));
  expect_same_error(write("half.bin", eight.substr(0, 50)));
  for (const char* name : {"empty.npy", "empty.bin", "empty.las"}) expect_same_error(write(name, ""));
  for (const char* name : {"missing.npy", "missing.bin", "missing.las"}) expect_same_error(path(name));
  EXPECT_EQ(open_point_stream(write("none.npy", npy_header("<f8", 0, 2)), folder_)->size(), 0u);
}

TEST_F(PointStreamTest, AFileThatBecomesShorterIsAnError) {
  const Points points = generate("uniform", 5000, 1);
  LasFile scan;
  scan.points.resize(5000);
  write_points_to("a.npy", points);
  write_points_to("a.bin", points);
  write("a.las", scan.bytes());
  for (const char* name : {"a.npy", "a.bin", "a.las"}) {
    const std::unique_ptr<PointSource> source = open_point_stream(path(name), folder_);
    Values read(2 * 5000);
    source->read(0, 5000, read.data());
    std::filesystem::resize_file(path(name), 40'000);
    source->read(0, 1000, read.data());
    expect_error(ErrorKind::input, path(name) + ": ", {"ends after 40000 bytes", "became shorter"},
                 [&] { source->read(0, 5000, read.data()); });
  }
}

TEST_F(PointStreamTest, RoomForResultsAndScratchOnOneDisk) {
  // Points whose triangles and neighbours fit, 48 bytes a point, or their scratch, 24, but not both.
  const std::uint64_t n = free_bytes(folder_) / 60;
  const std::array<std::string, kMeshArrays> both = {path("t.npy"), path("n.npy"), "", ""};
  check_room({}, n, IndexType::int32, folder_);
  check_room(both, n / 2, IndexType::int32, folder_);
  expect_error(ErrorKind::input, path("t.npy") + ": the disk of ", {"has room for"},
               [&] { check_room(both, n, IndexType::int32, folder_); });
}

TEST_F(PointStreamTest, ScratchThatCannotBeWritten) {
  const std::string file = write("a.xy", "1 2\n");
  expect_error(ErrorKind::input, path("nowhere") + ": ", {"No such file"},
               [&] { open_point_stream(file, path("nowhere")); });
  const ScratchFile scratch(folder_);
  scratch.require_room(1, "a byte");
  expect_error(ErrorKind::input, folder_ + ": ",
               {"has room for", "the points of x", "another scratch folder"},
               [&] { scratch.require_room(std::uint64_t{1} << 62, "the points of x"); });
}

TEST_F(PointStreamTest, GeneratedPointsDoNotDependOnPieces) {
  for (const Distribution& distribution : distributions()) {
    Values pieces;
    std::size_t calls = 0;
    generate(distribution.name, 150'000, 3, [&](const double* coordinates, std::size_t count) {
      pieces.insert(pieces.end(), coordinates, coordinates + 2 * count);
      ++calls;
    });
    EXPECT_GT(calls, 1u);
    EXPECT_EQ(raw(pieces), raw(generate(distribution.name, 150'000, 3).coordinates)) << distribution.name;
  }
}

// ----------------------------------------------------------------------------------------- meshes in pieces

using Wide = std::vector<std::int64_t>;

class MeshStreamTest : public FolderTest {
 protected:
  std::array<std::string, kMeshArrays> paths() const {
    return {path("t.npy"), path("n.npy"), path("h.npy"), path("d.npy"), path("a.npy")};
  }
  static void write_all(MeshFiles& files, MeshArray array, const Wide& values, std::size_t piece) {
    // From the end to the beginning.
    for (std::size_t end = values.size(); end > 0;) {
      const std::size_t begin = end - std::min(end, piece);
      files.write(array, begin, values.data() + begin, end - begin);
      end = begin;
    }
  }
};

TEST_F(MeshStreamTest, EntriesInAnyOrder) {
  Wide values(300'000);
  std::iota(values.begin(), values.end(), -1);
  const std::vector<std::int32_t> narrow(values.begin(), values.end());
  const std::vector<double> areas(values.begin(), values.end());
  for (const IndexType type : {IndexType::int32, IndexType::int64}) {
    for (const std::size_t piece : {std::size_t{999}, values.size()}) {
      Outputs outputs;
      MeshFiles files(outputs, paths(), type);
      for (const MeshArray array :
           {MeshArray::triangles, MeshArray::neighbors, MeshArray::hull, MeshArray::representatives}) {
        EXPECT_TRUE(files.wants(array));
        write_all(files, array, values, piece);
      }
      const std::int64_t later = 5;
      files.write(MeshArray::neighbors, 17, &values[3], 1);
      files.write(MeshArray::neighbors, 17, &values[17], 1);
      files.write(MeshArray::hull, 4, &later, 1);
      files.write_doubles(MeshArray::areas, 5, &areas[5], areas.size() - 5);
      files.write_doubles(MeshArray::areas, 0, areas.data(), 5);
      files.finish();
      EXPECT_EQ(names().count("t.npy"), 0u) << "it has its name too early";
      outputs.commit();
      for (const auto& [name, columns] : {std::pair("t.npy", 3), {"n.npy", 3}, {"h.npy", 0}, {"d.npy", 0}}) {
        SCOPED_TRACE(name);
        std::vector<std::int32_t> expected = narrow;
        if (std::string(name) == "h.npy") expected[4] = 5;
        write_npy(outputs, path("expected.npy"), expected, static_cast<std::size_t>(columns), type);
        outputs.commit();
        EXPECT_EQ(read(path(name)), read(path("expected.npy")));
        std::filesystem::remove(path(name));
      }
      write_npy(outputs, path("expected.npy"), areas, 0, type);
      outputs.commit();
      EXPECT_EQ(read(path("a.npy")), read(path("expected.npy")));
      std::filesystem::remove(path("a.npy"));
      std::filesystem::remove(path("expected.npy"));
    }
  }
}

TEST_F(MeshStreamTest, LargeIndicesAndNumbersOfRows) {
  Outputs outputs;
  MeshFiles files(outputs, {path("t.npy"), "", "", ""}, IndexType::int64);
  EXPECT_FALSE(files.wants(MeshArray::neighbors));
  const Wide large = {std::int64_t{1} << 40, 1, 2};
  const std::uint64_t rows = 3'000'000'000;  // a hole before the last one
  files.write(MeshArray::triangles, 3 * (rows - 1), large.data(), 3);
  files.finish();
  outputs.commit();
  EXPECT_EQ(std::filesystem::file_size(path("t.npy")), kNpyHeaderBytes + rows * 24);
  std::ifstream file(path("t.npy"), std::ios::binary);
  std::string header(kNpyHeaderBytes, '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  EXPECT_EQ(header, npy_header("<i8", rows, 3));
  EXPECT_NE(header.find("'<i8', 'fortran_order': False, 'shape': (3000000000, 3), }"), std::string::npos);
  Wide last(3);
  file.seekg(-24, std::ios::end);
  file.read(reinterpret_cast<char*>(last.data()), 24);
  EXPECT_EQ(last, large);
  // Every header is as long.
  EXPECT_EQ(npy_header("<i8", std::numeric_limits<std::uint64_t>::max(), 3).size(), kNpyHeaderBytes);
}

TEST_F(MeshStreamTest, NoRows) {
  Outputs outputs;
  MeshFiles files(outputs, paths(), IndexType::int64);
  files.finish();
  outputs.commit();
  EXPECT_EQ(read(path("t.npy")), npy_header("<i8", 0, 3));
  EXPECT_EQ(read(path("h.npy")), npy_header("<i8", 0, 0));
  EXPECT_TRUE(read_triangles(path("t.npy")).empty());
}

TEST_F(MeshStreamTest, WhatIsBeyondTheLastTriangleIsDropped) {
  Outputs outputs;
  MeshFiles files(outputs, paths(), IndexType::int32, {}, path("o.npy"));
  const Wide values(90, 5);
  const std::vector<double> areas(30, 0.5);
  const std::vector<std::int8_t> offsets(180, -1);
  for (const MeshArray array : {MeshArray::triangles, MeshArray::hull, MeshArray::representatives})
    files.write(array, 0, values.data(), values.size());
  files.write(MeshArray::neighbors, 0, values.data(), 60);
  files.write_doubles(MeshArray::areas, 0, areas.data(), areas.size());
  files.write_corner_offsets(60, offsets.data(), 120);
  files.write_corner_offsets(0, offsets.data(), 60);
  files.keep_triangles(20);
  files.finish();
  outputs.commit();
  EXPECT_EQ(read(path("o.npy")), npy_header("|i1", 20, 6) + std::string(120, '\xff'));
  for (const auto& [name, bytes] : {std::pair("t.npy", 240), {"n.npy", 240}, {"h.npy", 360}, {"a.npy", 160}})
    EXPECT_EQ(read(path(name)).size(), kNpyHeaderBytes + static_cast<std::size_t>(bytes)) << name;
  EXPECT_EQ(read(path("t.npy")).substr(0, kNpyHeaderBytes), npy_header("<i4", 20, 3));
}

TEST_F(MeshStreamTest, AnIndexThatIsTooLargeForItsFileIsAnError) {
  Outputs outputs;
  MeshFiles files(outputs, paths(), IndexType::int32);
  const std::int64_t large = std::int64_t{1} << 31;
  expect_error(ErrorKind::internal, "index 2147483648", {},
               [&] { files.write(MeshArray::hull, 0, &large, 1); });
}

#ifndef _WIN32
// ------------------------------------------------------ pipes, permissions and limits as POSIX has them

TEST_F(LasTest, APipeIsReadAsAFile) {
  const std::string file = write("scan.las", some_scan().bytes()), pipe = path("pipe.las");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(std::system(("cat '" + file + "' > '" + pipe + "' &").c_str()), 0);
  EXPECT_EQ(read_points(pipe).coordinates, some_scan().coordinates());
}

TEST_F(PointStreamTest, BinaryPointsOfAPipeAreRefused) {
  ASSERT_EQ(mkfifo(path("pipe.npy").c_str(), 0600), 0);
  EXPECT_EQ(estimate_points(path("pipe.npy")), 0u) << "and it was not opened, which would wait";
  const std::string header = npy_header("<f8", 1, 2) + raw(Values{1, 2});
  // Open in both directions, so that nothing waits.
  std::fstream writer(path("pipe.npy"), std::ios::in | std::ios::out | std::ios::binary);
  writer << header << std::flush;
  expect_error(ErrorKind::input, path("pipe.npy") + ": ", {"no regular file"},
               [&] { open_point_stream(path("pipe.npy"), folder_); });
}

TEST_F(PointStreamTest, ScratchIsTheUsersAloneWhateverTheUmask) {
  const mode_t before = umask(0);
  const ScratchFile scratch(folder_);
  umask(before);
  EXPECT_TRUE(std::filesystem::is_empty(folder_)) << "it has no name that others could open";
  bool is_found = false;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code ignored;
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored);
    if (target.compare(0, folder_.size(), folder_) != 0) continue;
    struct stat status {};
    ASSERT_EQ(stat(entry.path().c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0600U) << target;
    is_found = true;
  }
  EXPECT_TRUE(is_found);
}

TEST_F(MeshStreamTest, PipesAreRefused) {
  ASSERT_EQ(mkfifo(path("n.npy").c_str(), 0600), 0);
  Outputs outputs;
  expect_error(ErrorKind::usage, path("n.npy") + ": ", {"no regular file"},
               [&] { MeshFiles(outputs, paths(), IndexType::int32); });
}

TEST_F(MeshStreamTest, AFailedWriteLeavesOldOutputs) {
  write("t.npy", "old");
  rlimit saved{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &saved), 0);
  const auto old_handler = signal(SIGXFSZ, SIG_IGN);
  rlimit small = saved;
  small.rlim_cur = 3000;  // fails like a full disk
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Wide values(3000);
  expect_error(ErrorKind::input, path("t.npy") + ": ", {"cannot be written", "File too large"}, [&] {
    Outputs outputs;
    MeshFiles files(outputs, {path("t.npy"), "", "", path("d.npy")}, IndexType::int32);
    files.write(MeshArray::triangles, 0, values.data(), values.size());
  });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &saved), 0);
  signal(SIGXFSZ, old_handler);
  EXPECT_EQ(names(), (std::set<std::string>{"t.npy"}));
  EXPECT_EQ(read(path("t.npy")), "old");
}

#endif

}  // namespace
}  // namespace flaunay::io::streams
