// Reading points from files. Formats by the file's ending; see read_points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "files/output.hpp"

namespace flaunay::io {

/// Points as read: x0 y0 x1 y1 ...
struct Points {
  std::vector<double> coordinates;
  std::vector<std::int32_t> markers = {};  ///< of the vertices of .poly files that have some
  std::size_t size() const { return coordinates.size() / 2; }
};

/// Reads points from path, by its ending (any case):
///   .npy             NumPy array, n x 2, C order, little-endian float64 or float32 (format versions 1 to 3)
///   .node            Triangle's format: comments, attributes, boundary markers, first index 0 or 1
///   .xy .txt .csv    UTF-8: two numbers per line, which may be quoted, separated by comma or white space;
///                    '#' comments, blank lines, and one optional header line
///   .bin             raw little-endian float64 pairs
///   .las             LAS 1.0 to 1.4, uncompressed: x and y of each point record
///   .poly .geojson .json   the points of a map, see read_map
///   "-"              text from standard input
/// Zero points are valid only where the format says so (an .npy of shape (0, 2), a .node of 0 points, or a
/// text file with only comments or a header); a file of zero bytes is an error.
/// Throws Error(input) that names the file and the place: line and column for text, byte or index for binary;
/// NaN and infinity are errors that name the index of the point.
Points read_points(const std::string& path);

/// Throws Error(usage) that lists the endings if read_points does not know the ending of path.
void check_points_ending(const std::string& path);
/// The same for write_points.
void check_points_output(const std::string& path);

enum class PointFormat { npy, node, text, binary, las, map };
/// The format in which read_points reads path. Throws what check_points_ending throws.
PointFormat point_format(const std::string& path);
/// How many points a .bin file of this many bytes has. Throws Error(input) if it is no whole number.
std::uint64_t count_pairs(const std::string& path, std::uint64_t bytes);
constexpr const char* kPairs = "pairs of little-endian float64";

/// Writes points in the format of path's ending (.npy float64, .node, .xy/.txt/.csv, .bin), or text to
/// standard output for "-"; numbers in text are the shortest that read back to the same double. Throws
/// Error(input) if path cannot be written.
void write_points(Outputs& outputs, const std::string& path, const Points& points);

/// Writes the same file in pieces.
class PointWriter {
 public:
  /// n: how many points will be written.
  PointWriter(Outputs& outputs, const std::string& path, std::uint64_t n);
  /// The next points: x0 y0 x1 y1 ...
  void write(const double* coordinates, std::size_t count);

 private:
  PointFormat format_;
  char separator_;  // in text
  OutputFile* file_ = nullptr;
  std::uint64_t written_ = 0;
};

}  // namespace flaunay::io
