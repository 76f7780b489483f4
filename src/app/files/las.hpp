// Points of LAS files, in which laser scans come.
//
// The format: American Society for Photogrammetry and Remote Sensing, "LAS Specification 1.4 - R15", 2019,
// and those of versions 1.0 (2003) to 1.3 (2010), whose headers are the beginning of this one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "app/files/points.hpp"
#include "files/file.hpp"

namespace flaunay::io {

/// Where the points of a file are, and what their integers mean.
struct LasPoints {
  std::uint64_t size = 0;
  std::uint64_t data_begin = 0;
  std::size_t record_bytes = 0;
  std::array<double, 2> scale{}, offset{};  ///< of x and y

  /// Converts point records: coordinate = integer * scale + offset.
  void decode(const char* records, std::size_t count, double* coordinates) const;
};

constexpr const char* kLasFile = "an uncompressed LAS file";

/// Reads the header, and checks it against the size of the file, which must be regular.
LasPoints find_las_points(const std::string& path, InputFile& file);
Points read_las_points(const std::string& path);

/// Throws Error(input) that says how to decompress a LAZ file.
[[noreturn]] void fail_compressed(const std::string& path);

}  // namespace flaunay::io
