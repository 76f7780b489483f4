// NumPy's array files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/output.hpp"
#include "io/points.hpp"

namespace flaunay::io {

Points read_npy_points(const std::string& path);
void write_npy_points(Outputs& outputs, const std::string& path, const Points& points);
/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

}  // namespace flaunay::io
