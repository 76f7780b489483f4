// Reading points from files. Formats by the file's ending; see read_points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "files/file.hpp"
#include "files/output.hpp"

namespace flaunay::io {

/// A value of a feature or of a line of text: nothing where it has none.
using FieldValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// A value per point that a file has besides coordinates.
struct PointField {
  std::string name;
  std::vector<FieldValue> values;
  std::size_t first_text = 0;  ///< the value that makes it one of text; 0, too, where each value has a type
};

/// Points as read: x0 y0 x1 y1 ...
struct Points {
  std::vector<double> coordinates;
  std::vector<std::int32_t> markers = {};  ///< of the vertices of .poly files that have some
  std::vector<double> heights = {};        ///< of points in space: NaN for one that has none; empty: all 0
  std::uint64_t withheld = 0;              ///< how many are marked as not to be used, as in .las files
  std::string crs =
      {};  ///< the system of the coordinates: "EPSG:n", WKT, or a name; empty if the file has none
  std::vector<PointField> fields = {};  ///< those that were asked for, of points in the file
  std::vector<std::string> notes = {};  ///< a sentence for each thing that was left out or mended
  std::size_t size() const { return coordinates.size() / 2; }
};

/// Points as records of one size in a binary file.
struct PointRecords {
  std::uint64_t size = 0;   ///< how many
  std::uint64_t begin = 0;  ///< of the first one, in bytes
  std::size_t bytes = 2 * sizeof(double);
  std::string crs = {};  ///< as of Points
  using Decode = std::function<void(const char* records, std::size_t count, double* numbers)>;
  Decode decode = nullptr;          ///< to coordinates; empty if they are x and y as doubles
  Decode decode_heights = nullptr;  ///< empty without heights
  /// How many records are marked as not to be used; empty if none can be.
  std::function<std::size_t(const char* records, std::size_t count)> count_withheld = nullptr;

  /// Reads points [first, first + count) of the file.
  void read(const InputFile& file, std::uint64_t first, std::size_t count, double* coordinates) const;
  /// Calls use(records, count, how many were before) for the records of points [first, first + count), in
  /// pieces.
  using UsePiece = std::function<void(const char* records, std::size_t count, std::size_t before)>;
  void for_pieces(const InputFile& file, std::uint64_t first, std::size_t count, const UsePiece& use) const;
};

/// Reads the points of a text that comes in pieces of whole lines. Throws Error(input) that names the line
/// and the column in the file.
class PointText {
 public:
  virtual ~PointText() = default;
  /// Appends the points of the next lines. heights: where those go, if there are some; null for none.
  virtual void parse(std::string_view lines, std::vector<double>& coordinates,
                     std::vector<double>* heights = nullptr) = 0;
  /// After the last piece: checks that nothing is missing.
  virtual void finish() {}
  /// After the last piece: the fields that were asked for.
  virtual std::vector<PointField> fields() { return {}; }
};

/// What is read of a file that has more.
struct Columns {
  /// Which columns of a text have x, y and, if there are three, a further number: names of the header, or
  /// numbers from 0. Empty: the first columns.
  std::vector<std::string> names = {};
  /// Fields of layers and GeoJSON that have heights, of which the first one that is there counts; of what has
  /// none of them, heights are those of positions.
  std::vector<std::string> heights = {};
  std::vector<std::string> fields = {};  ///< of layers, GeoJSON and text, that points keep
};

/// The columns of a text of numbers. third: what a further number is ("a height"), if each line must have
/// one; otherwise lines may have two or three numbers.
std::unique_ptr<PointText> column_text(const std::string& path, const Columns& columns,
                                       std::string_view third = "");

/// Reads points from path, by its ending (any case):
///   .npy             NumPy array, n x 2, C order, little-endian float64 or float32 (format versions 1 to 3)
///   .node            Triangle's format: comments, attributes, boundary markers, first index 0 or 1
///   .xy .xyz .txt .csv   UTF-8: two numbers per line, and perhaps a height, which may be quoted, separated
///   by
///                    commas, semicolons or white space; '#' comments, blank lines, an optional header line
///   .bin             raw little-endian float64 pairs
///   .las             LAS 1.0 to 1.4, uncompressed: x, y and height of each point record
///   .poly .geojson .json   the points of a map, see read_map
///   "-"              text from standard input
/// Zero points are valid only where the format says so (an .npy of shape (0, 2), a .node of 0 points, or a
/// text file with only comments or a header); a file of zero bytes is an error.
/// Throws Error(input) that names the file and the place: line and column for text, byte or index for binary;
/// NaN and infinity are errors that name the index of the point. with_heights: whether heights of binary
/// files are read, too. Throws Error(usage) for columns of a file that has none.
Points read_points(const std::string& path, const Columns& columns = {}, bool with_heights = false);
/// Whether path is a text that has columns.
bool is_column_text(const std::string& path);
/// The number of a field; NaN if it has none.
double number_of(const FieldValue& value);
/// Throws Error(input) that names a field and a point if a field has other values than numbers.
void check_numbers(const Points& points, const std::string& path);
/// Throws Error(usage) unless there are no columns, or path is a text that has columns.
void check_columns(const std::string& path, const Columns& columns);

/// Writes points as pairs of doubles, for Format::write_points.
void write_pairs(OutputFile& file, const double* coordinates, const std::int32_t* markers,
                 std::uint64_t first, std::size_t count);

/// The least bytes that n points take in a file.
std::uint64_t least_bytes(const std::string& path, std::uint64_t n);

/// Writes points in the format of path's ending (.npy float64, .node, .xy/.txt/.csv, .bin), or text to
/// standard output for "-"; numbers in text are the shortest that read back to the same double. Throws
/// Error(input) if path cannot be written.
void write_points(Outputs& outputs, const std::string& path, const Points& points);

struct Format;
/// Writes the same files as write_points, in pieces.
class PointWriter {
 public:
  /// n: how many points will be written.
  PointWriter(Outputs& outputs, const std::string& path, std::uint64_t n, bool has_markers = false);
  /// The next points: x0 y0 x1 y1 ...
  void write(const double* coordinates, std::size_t count, const std::int32_t* markers = nullptr);

 private:
  const Format& format_;
  OutputFile& file_;
  std::uint64_t written_ = 0;
};

}  // namespace flaunay::io
