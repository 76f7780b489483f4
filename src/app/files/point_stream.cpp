#include "app/files/point_stream.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "app/files/formats.hpp"
#include "app/files/line_pieces.hpp"
#include "app/files/points.hpp"
#include "files/file.hpp"
#include "files/scratch.hpp"

namespace flaunay::io {
namespace {

constexpr std::size_t kPair = 2 * sizeof(double);

/// The points of a binary file.
class RecordFile : public PointSource {
 public:
  RecordFile(const std::string& path, const Format& format, const Columns& columns)
      : file_(path, format.content) {
    file_.first(1);  // throws if the file cannot be read
    if (file_.size() < 0) {
      fail(path, "is no regular file; expected one, because points in chunks are not read in order");
    }
    records_ = format.records(path, file_, columns);
  }

  std::uint64_t size() const override { return records_.size; }

  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    if (first > size() || count > size() - first) {
      throw Error(ErrorKind::internal, "read beyond the last point");
    }
    records_.read(file_, first, count, coordinates);
  }

 private:
  InputFile file_;
  PointRecords records_;
};

/// Points that were read from a text.
class TextFile : public PointSource {
 public:
  TextFile(const std::string& path, const Format& format, const Columns& columns, const std::string& scratch)
      : file_(scratch) {
    LinePieces pieces(path, format.content);
    const std::unique_ptr<PointText> parser = format.text(path, columns);
    std::vector<double> coordinates;
    bool is_first = true;
    for (std::string_view lines; pieces.next(lines); is_first = false) {
      coordinates.clear();
      parser->parse(lines, coordinates);
      const std::size_t bytes = coordinates.size() * sizeof(double);
      if (is_first && pieces.file_size() > 0) {
        const double share = static_cast<double>(lines.size()) / static_cast<double>(pieces.file_size());
        const double needed = static_cast<double>(bytes) / share;
        file_.require_room(static_cast<std::uint64_t>(needed), "the points of " + path);
      }
      file_.append(coordinates.data(), bytes);
    }
    parser->finish();
  }

  std::uint64_t size() const override { return file_.size() / kPair; }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    file_.read_at(first * kPair, count * kPair, coordinates);
  }

 private:
  ScratchFile file_;
};

/// Points that were read at once.
class ReadPoints : public PointSource {
 public:
  ReadPoints(const std::string& path, const Columns& columns) : points_(read_points(path, columns)) {}

  std::uint64_t size() const override { return points_.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    std::memcpy(coordinates, points_.coordinates.data() + 2 * first, count * kPair);
  }

 private:
  const Points points_;
};

}  // namespace

std::unique_ptr<PointSource> open_point_stream(const std::string& path, const std::string& scratch,
                                               const Columns& columns) {
  const Format& format = format_of(path, Use::read_points);
  check_columns(path, columns);
  if (format.map != nullptr) return std::make_unique<ReadPoints>(path, columns);
  if (format.text != nullptr) return std::make_unique<TextFile>(path, format, columns, scratch);
  return std::make_unique<RecordFile>(path, format, columns);
}

std::uint64_t estimate_points(const std::string& path, const Columns& columns) {
  constexpr std::size_t kBeginning = std::size_t{1} << 16;
  const Format& format = format_of(path, Use::read_points);
  if (format.map != nullptr) return 0;
  // A pipe is not opened, since it can be read only once.
  const std::optional<system::FileStatus> status = path == "-" ? std::nullopt : system::status_of(path);
  if (path == "-" || (status && status->kind != system::FileKind::regular)) return 0;
  if (format.records != nullptr) return RecordFile(path, format, columns).size();
  InputFile file(path, format.content);
  const std::string_view beginning = file.first(kBeginning);
  const auto lines = std::count(beginning.begin(), beginning.end(), '\n') + 1;
  return static_cast<std::uint64_t>(static_cast<double>(file.size()) * static_cast<double>(lines) /
                                    static_cast<double>(beginning.size()));
}

}  // namespace flaunay::io
