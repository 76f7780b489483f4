// LAS files, in which laser scans come, uncompressed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "files/file.hpp"

namespace flaunay::io {

/// coordinate = integer * scale + offset, in decimal numbers: if scale and offset are the doubles next to
/// such numbers, so is the coordinate. Then equal places are equal in files of other offsets, too.
class LasAxis {
 public:
  LasAxis() = default;
  LasAxis(double scale, double offset) : scale_(scale), offset_(offset) {
    const double whole = scale > 0 ? std::nearbyint(1 / scale) : 0, first = std::nearbyint(offset * whole);
    if (!(whole >= 1 && whole < kMostExact) || 1 / whole != scale || first / whole != offset) return;
    if (std::fabs(first) >= kMostExact) return;
    whole_ = whole;
    first_ = first;
  }

  double operator()(std::int32_t stored) const {
    const double sum = stored + first_;
    return std::fabs(sum) < kMostExact && whole_ != 0 ? sum / whole_ : stored * scale_ + offset_;
  }

 private:
  static constexpr double kMostExact = 0x1p53;

  double scale_ = 1, offset_ = 0;
  double whole_ = 0, first_ = 0;  // 1 / scale and offset / scale if these are whole numbers, or else 0
};

/// The contents of a file's header.
struct LasHeader {
  std::uint64_t size = 0;   ///< of point records
  std::uint64_t begin = 0;  ///< of the first one, in bytes
  std::size_t record_bytes = 0;
  int format = 0;
  std::array<LasAxis, 3> axes;
  std::array<double, 4> box{};  ///< least x and y, largest x and y
  std::string crs;              ///< WKT or "EPSG:n"; empty if the file does not say

  /// Writes the coordinates of each record on some axes: of x, y and z, `columns` from `first` on.
  template <std::size_t columns, std::size_t first = 0>
  void decode(const char* records, std::size_t count, double* coordinates) const {
    for (std::size_t i = 0; i < count; ++i, records += record_bytes) {
      std::int32_t stored[columns];  // every point format begins with X, Y and Z
      std::memcpy(stored, records + first * sizeof stored[0], sizeof stored);
      for (std::size_t axis = 0; axis < columns; ++axis) {
        coordinates[columns * i + axis] = axes[first + axis](stored[axis]);
      }
    }
  }
  /// Whether the point counts as deleted.
  bool is_withheld(const char* record) const { return (record[15] & (format < 6 ? 0x80 : 4)) != 0; }
  int class_of(const char* record) const {
    constexpr int kMostOfOldFormats = 31;
    return format < 6 ? record[15] & kMostOfOldFormats : static_cast<unsigned char>(record[16]);
  }
  /// Counted from 1.
  int return_number(const char* record) const { return record[14] & (format < 6 ? 7 : 15); }
  int returns(const char* record) const {
    const int byte = static_cast<unsigned char>(record[14]);
    return format < 6 ? byte >> 3 & 7 : byte >> 4;
  }
};

/// Reads the header, and checks it against the size of the file. Throws Error(input).
LasHeader read_las_header(const std::string& path, InputFile& file);

}  // namespace flaunay::io
