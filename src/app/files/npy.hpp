// NumPy's array files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/npy_header.hpp"

namespace flaunay::io {

/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

/// Reads an array of s x 2 indices of `points` points, of any type of integers.
std::vector<std::int32_t> read_npy_segments(const std::string& path, std::size_t points);

}  // namespace flaunay::io
