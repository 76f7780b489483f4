#include "app/files/points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "app/files/formats.hpp"
#include "app/files/text.hpp"
#include "files/file.hpp"
#include "host/system/pages.hpp"

namespace flaunay::io {
namespace {

/// For the binary formats. The readers of text check each number, because their messages name the line.
void check_finite(const std::string& path, const Points& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.coordinates[2 * i], y = points.coordinates[2 * i + 1];
    if (!std::isfinite(x) || !std::isfinite(y)) {
      fail(path, "point {} is ({}, {}); expected finite numbers", i, x, y);
    }
  }
}

Points read_text(const std::string& path, const Format& format, const Columns& columns) {
  const std::string text = read_file(path, format.content);
  Points points;
  const std::unique_ptr<PointText> parser = format.text(path, columns);
  parser->parse(text, points.coordinates, &points.heights);
  parser->finish();
  points.fields = parser->fields();
  return points;
}

Points read_records(const std::string& path, const Format& format, const Columns& columns,
                    bool with_heights) {
  InputFile file(path, format.content);
  file.first(1);  // throws if the file cannot be read
  const PointRecords records = format.records(path, file, columns);
  Points points;
  points.crs = records.crs;
  points.coordinates.reserve(2 * records.size);
  system::prefer_huge_pages(points.coordinates.data(), 2 * records.size * sizeof(double));
  points.coordinates.resize(2 * records.size);
  if (records.decode == nullptr) {
    records.read(file, 0, records.size, points.coordinates.data());
  } else {
    const bool has_heights = with_heights && records.decode_heights != nullptr;
    if (has_heights) points.heights.resize(records.size);
    records.for_pieces(file, 0, records.size, [&](const char* some, std::size_t count, std::size_t before) {
      records.decode(some, count, &points.coordinates[2 * before]);
      if (has_heights) records.decode_heights(some, count, &points.heights[before]);
      if (records.count_withheld != nullptr) points.withheld += records.count_withheld(some, count);
    });
  }
  check_finite(path, points);
  return points;
}

// ---- pairs of doubles ----

PointRecords binary_points(const std::string& path, InputFile& file, const Columns&) {
  constexpr std::uint64_t kPair = 2 * sizeof(double);
  file.load_pipe();
  const auto bytes = static_cast<std::uint64_t>(file.size());
  if (bytes % kPair != 0) {
    fail(path, "has {} bytes, {} after the last whole pair; expected a multiple of 16 (float64 pairs)", bytes,
         bytes % kPair);
  }
  return {bytes / kPair};
}

void begin_binary(OutputFile& file, std::uint64_t n, bool) {
  if (n > 0) return;
  fail(file.path(),
       "a .bin of no points would be an empty file, which no one can tell from a failed write; "
       "expected points, or another ending");
}

}  // namespace

const Format kBin = {.ending = ".bin",
                     .content = "pairs of little-endian float64",
                     .records = binary_points,
                     .begin_points = begin_binary,
                     .write_points = write_pairs,
                     .least_bytes = 2 * sizeof(double)};

void write_pairs(OutputFile& file, const double* coordinates, const std::int32_t*, std::uint64_t,
                 std::size_t count) {
  file.write(coordinates, 2 * count * sizeof(double));
}

void PointRecords::read(const InputFile& file, std::uint64_t first, std::size_t count,
                        double* coordinates) const {
  if (decode == nullptr) return file.read_at(begin + first * bytes, count * bytes, coordinates);
  for_pieces(file, first, count, [&](const char* records, std::size_t some, std::size_t before) {
    decode(records, some, coordinates + 2 * before);
  });
}

void PointRecords::for_pieces(const InputFile& file, std::uint64_t first, std::size_t count,
                              const UsePiece& use) const {
  constexpr std::size_t kPiece = std::size_t{1} << 15;
  std::vector<char> records(std::min(count, kPiece) * bytes);
  for (std::size_t done = 0; done < count; done += kPiece) {
    const std::size_t piece = std::min(count - done, kPiece);
    file.read_at(begin + (first + done) * bytes, piece * bytes, records.data());
    use(records.data(), piece, done);
  }
}

bool is_column_text(const std::string& path) {
  return format_of(path, Use::read_points).text == column_text_of_points;
}

double number_of(const FieldValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  const auto* number = std::get_if<double>(&value);
  return number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN();
}

void check_numbers(const Points& points, const std::string& path) {
  const auto is_text = [](const FieldValue& value) { return std::holds_alternative<std::string>(value); };
  for (const auto& [name, values, first_text] : points.fields) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(first_text);
    const auto found = std::find_if(first, values.end(), is_text);
    if (found == values.end()) continue;
    fail(path,
         "the field '{}' is no number: point {} has {}; expected numbers, of which triangles have means",
         name, found - values.begin(), io::quoted(std::get<std::string>(*found)));
  }
}

void check_columns(const std::string& path, const Columns& columns) {
  if (columns.names.empty() || is_column_text(path)) return;
  if (&format_of(path, Use::read_points) == &kNpy) return;
  throw Error(
      ErrorKind::usage,
      printable(fmt::format("{}: has no columns; --columns goes with .npy and text (.csv, .txt, .xy, .xyz)",
                            shown_path(path))));
}

Points read_points(const std::string& path, const Columns& columns, bool with_heights) {
  const Format& format = format_of(path, Use::read_points);
  check_columns(path, columns);
  if (format.map != nullptr) {
    Map map = format.map(path, columns);
    map.check_height_field(path, columns.heights);
    return std::move(map.points);
  }
  return format.text != nullptr ? read_text(path, format, columns)
                                : read_records(path, format, columns, with_heights);
}

PointWriter::PointWriter(Outputs& outputs, const std::string& path, std::uint64_t n, bool has_markers)
    : format_(format_of(path, Use::write_points)), file_(outputs.open(path)) {
  format_.begin_points(file_, n, has_markers);
}

void PointWriter::write(const double* coordinates, std::size_t count, const std::int32_t* markers) {
  format_.write_points(file_, coordinates, markers, written_, count);
  written_ += count;
}

void write_points(Outputs& outputs, const std::string& path, const Points& points) {
  const bool has_markers = !points.markers.empty();
  PointWriter(outputs, path, points.size(), has_markers)
      .write(points.coordinates.data(), points.size(), has_markers ? points.markers.data() : nullptr);
}

std::uint64_t least_bytes(const std::string& path, std::uint64_t n) {
  const std::uint64_t point = format_of(path, Use::write_points).least_bytes;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  return n > kMost / point ? kMost : n * point;
}

}  // namespace flaunay::io
