// NumPy's array files of indices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "files/npy_header.hpp"

namespace flaunay::io {

/// An array of m x 3 indices that need not fit memory.
class RowSource {
 public:
  virtual ~RowSource() = default;
  /// The number of rows.
  virtual std::uint64_t size() const = 0;
  /// Reads the rows [first, first + count): 3 count values. Several threads may call it at a time. Throws
  /// Error(input) if it cannot.
  virtual void read(std::uint64_t first, std::size_t count, std::int64_t* values) = 0;
};

/// Opens an .npy file (int32 or int64, m x 3). Throws Error(input) that names the place; values are not
/// checked.
std::unique_ptr<RowSource> open_npy_rows(const std::string& path);

/// Finds the rows of an n x 3 array of float64 or float32, or three columns of a wider one. decode, if there
/// is one, gives 3 doubles per row.
PointRecords npy_triples(const std::string& path, InputFile& file, const Columns& columns);

/// Reads an array of m x 3 indices, int32 or int64.
std::vector<std::int32_t> read_npy_triangles(const std::string& path);

/// Reads an array of s x 2 indices of `points` points, of any type of integers.
std::vector<std::int32_t> read_npy_segments(const std::string& path, std::size_t points);

}  // namespace flaunay::io
