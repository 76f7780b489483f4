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

/// Finds the points of an array, float64 or float32.
PointRecords npy_points(const std::string& path, InputFile& file);
extern const PointFormat kNpyPoints;

/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

/// Reads an array of s x 2 indices of `points` points, of any type of integers.
std::vector<std::int32_t> read_npy_segments(const std::string& path, std::size_t points);

}  // namespace flaunay::io
