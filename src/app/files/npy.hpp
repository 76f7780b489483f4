// NumPy's array files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "files/file.hpp"
#include "files/npy_header.hpp"
#include "files/output.hpp"

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

/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

/// Reads an array of s x 2 indices of `points` points, of any type of integers.
std::vector<std::int32_t> read_npy_segments(const std::string& path, std::size_t points);

}  // namespace flaunay::io
