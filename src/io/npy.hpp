// NumPy's array files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/file.hpp"
#include "io/output.hpp"
#include "io/points.hpp"

namespace flaunay::io {

Points read_npy_points(const std::string& path);

constexpr const char* kPointArray = "a NumPy array of shape (n, 2)";

/// Where the points of a file are: float64, or float32.
struct NpyPoints {
  std::uint64_t size = 0;
  std::uint64_t data_begin = 0;
  bool is_double = false;
};
/// Reads the header, and checks the size of the file, which must be regular.
NpyPoints find_npy_points(const std::string& path, InputFile& file);

/// The beginning of a file. descr: the dtype, such as "<f8"; columns 0: an array of one dimension, `rows`
/// long. It is as long as NumPy's own, and NumPy's have this size for any number of rows.
std::string npy_header(const std::string& descr, std::uint64_t rows, std::size_t columns);
constexpr std::size_t kNpyHeaderBytes = 128;

inline const char* descr_of(IndexType type) { return type == IndexType::int32 ? "<i4" : "<i8"; }

/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

}  // namespace flaunay::io
