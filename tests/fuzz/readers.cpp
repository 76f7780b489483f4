// Fuzzes the readers of files: whatever the bytes, a reader gives valid values or throws Error(input).
//
//   fuzz_readers --format=FORMAT [libFuzzer's options] [FOLDER...]
//
// libFuzzer ignores options that begin with two hyphens. The formats are the folders of tests/fuzz/seeds.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "app/files/region.hpp"
#include "files/output.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::fuzz {
namespace {

/// Ends the process such that libFuzzer keeps the input.
void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz_readers: violated: %s\n", what);
  std::abort();
}

/// Files of this process. The script lets TMPDIR be a folder in memory.
std::string scratch(const std::string& name) {
  static const std::string stem =
      (std::filesystem::temp_directory_path() / ("flaunay-fuzz-" + std::to_string(::getpid()))).string();
  return stem + name;
}

void write(const std::string& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

void read_points(const std::string& ending, std::string_view bytes) {
  const std::string path = scratch(ending);
  write(path, bytes);
  const io::Points points = io::read_points(path);
  require(points.coordinates.size() % 2 == 0, "points have two coordinates");
  for (const double value : points.coordinates) require(std::isfinite(value), "coordinates are finite");
  if (points.size() == 0) return;
  io::Outputs outputs;
  // LAS files are only read.
  const std::string copy = ending == ".las" ? scratch(".npy") : path;
  io::write_points(outputs, copy, points);
  outputs.commit();
  require(same_bits(io::read_points(copy).coordinates, points.coordinates), "points read back as written");
}

void check_indices(const std::vector<std::int32_t>& rows, std::int32_t lowest) {
  require(rows.size() % 3 == 0, "rows have three indices");
  for (const std::int32_t index : rows) require(index >= lowest, "indices are in range");
}

void read_triangles(const std::string& ending, std::string_view bytes) {
  const std::string path = scratch(ending);
  write(path, bytes);
  check_indices(io::read_triangles(path), 0);
}

void read_neighbors(std::string_view bytes) {
  const std::string path = scratch(".npy");
  write(path, bytes);
  check_indices(io::read_neighbors(path), -1);
}

void check_map(const io::Map& map) {
  const auto points = static_cast<std::int32_t>(map.points.size());
  for (const double value : map.points.coordinates) require(std::isfinite(value), "coordinates are finite");
  for (const double value : map.holes) require(std::isfinite(value), "holes are finite");
  for (const auto& segments : {map.segments, map.lines}) {
    require(segments.size() % 2 == 0, "segments have two ends");
    for (const std::int32_t point : segments) require(point >= 0 && point < points, "ends are points");
  }
  require(map.polygon_offsets.back() == map.ring_offsets.size() - 1, "each ring is of a polygon");
  require(map.has_others || map.ring_offsets.back() == map.points.size(), "each point is of a ring");
}

void read_map(const std::string& ending, std::string_view bytes) {
  const std::string path = scratch(ending);
  write(path, bytes);
  check_map(io::read_map(path));
}

void read_segments(const std::string& ending, std::string_view bytes) {
  constexpr std::size_t kPoints = 100;
  const std::string path = scratch(ending);
  write(path, bytes);
  const std::vector<std::int32_t> segments = io::read_segments(path, kPoints);
  require(segments.size() % 2 == 0, "segments have two ends");
  for (const std::int32_t point : segments) {
    require(point >= 0 && point < static_cast<std::int32_t>(kPoints), "ends are points");
  }
}

/// The bytes are a .node and a .poly with a line of hyphens between them, of 3 points and 3 border edges.
void read_region(std::string_view bytes) {
  constexpr std::string_view kBetween = "---\n";
  constexpr std::size_t kPoints = 3, kEdges = 3;
  const std::size_t between = bytes.find(kBetween);
  const std::string stem = scratch("-region");
  write(stem + ".node", bytes.substr(0, between));
  write(stem + ".poly", between == std::string_view::npos ? "" : bytes.substr(between + kBetween.size()));
  const io::StoredRegion stored = io::read_region(stem, kPoints, kEdges);
  require(stored.points.size() == kPoints && stored.region.points.size() == kPoints,
          "a region has its points");
  require(stored.region.border.size() == 2 * kEdges, "a region has its border");
  for (const std::int32_t index : stored.region.points) require(index >= 0, "indices of points are in range");
  for (const std::int32_t position : stored.region.border) {
    require(position >= 0 && position < static_cast<std::int32_t>(kPoints), "positions are in range");
  }
}

std::string format;

void read(std::string_view bytes) {
  const std::size_t dot = format.find('.');
  const std::string kind = format.substr(0, dot);
  const std::string ending = dot == std::string::npos ? "" : format.substr(dot);
  if (kind == "points") return read_points(ending, bytes);
  if (kind == "map") return read_map(ending, bytes);
  if (kind == "segments") return read_segments(ending, bytes);
  if (kind == "triangles") return read_triangles(ending, bytes);
  if (format == "neighbors.npy") return read_neighbors(bytes);
  if (format == "region") return read_region(bytes);
  std::fprintf(stderr, "fuzz_readers: --format is '%s'; expected a folder of tests/fuzz/seeds\n",
               format.c_str());
  std::exit(2);
}

/// Numbers at which readers may go wrong.
constexpr std::string_view kNumbers[] = {"0",
                                         "1",
                                         "-1",
                                         "3",
                                         "2147483647",
                                         "2147483648",
                                         "-2147483649",
                                         "4294967296",
                                         "9223372036854775807",
                                         "-9223372036854775808",
                                         "18446744073709551615",
                                         "99999999999999999999",
                                         "1e308",
                                         "1e309",
                                         "5e-324",
                                         "1e-400",
                                         "nan",
                                         "-inf",
                                         ".5"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The text with one of its numbers replaced.
std::string with_another_number(std::string text, std::minstd_rand& random) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_digit(text[i]) && (i == 0 || !is_digit(text[i - 1]))) begins.push_back(i);
  }
  if (begins.empty()) return text;
  const std::size_t begin = begins[random() % begins.size()];
  std::size_t end = begin;
  while (end < text.size() && is_digit(text[end])) ++end;
  return text.replace(begin, end - begin, kNumbers[random() % std::size(kNumbers)]);
}

}  // namespace
}  // namespace flaunay::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

/// libFuzzer changes single bytes, which hardly ever makes another valid number of a long one.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  std::minstd_rand random(seed);
  if (random() % 4 != 0) return LLVMFuzzerMutate(data, size, most);
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string changed = flaunay::fuzz::with_another_number(text, random);
  if (changed.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::copy(changed.begin(), changed.end(), data);
  return changed.size();
}

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  constexpr std::string_view kOption = "--format=";
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument.substr(0, kOption.size()) == kOption)
      flaunay::fuzz::format = argument.substr(kOption.size());
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    flaunay::fuzz::read({reinterpret_cast<const char*>(data), size});
  } catch (const flaunay::Error& error) {
    // Anything else ends the process, and so does an error of another kind.
    if (error.kind() != flaunay::ErrorKind::input) throw;
  }
  return 0;
}
