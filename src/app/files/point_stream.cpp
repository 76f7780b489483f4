#include "app/files/point_stream.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "app/files/las.hpp"
#include "app/files/npy.hpp"
#include "app/files/point_text.hpp"
#include "app/files/points.hpp"
#include "files/file.hpp"
#include "files/scratch.hpp"

namespace flaunay::io {
namespace {

constexpr std::size_t kPair = 2 * sizeof(double);

/// The points of a binary file, as records of one size.
class RecordFile : public PointSource {
 public:
  explicit RecordFile(const std::string& path)
      : path_(path), format_(point_format(path)), file_(path, expected()) {
    file_.first(1);  // an error if there is none
    if (file_.size() < 0) {
      fail(path, "is no regular file; expected one, because points in chunks are not read in order");
    }
    if (format_ == PointFormat::npy) {
      const NpyPoints found = find_npy_points(path, file_);
      size_ = found.size;
      begin_ = found.data_begin;
      is_float_ = !found.is_double;
      record_bytes_ = is_float_ ? 2 * sizeof(float) : kPair;
    } else if (format_ == PointFormat::las) {
      las_ = find_las_points(path, file_);
      size_ = las_.size;
      begin_ = las_.data_begin;
      record_bytes_ = las_.record_bytes;
    } else {
      size_ = count_pairs(path, static_cast<std::uint64_t>(file_.size()));
    }
  }

  std::uint64_t size() const override { return size_; }

  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    if (first > size_ || count > size_ - first)
      throw Error(ErrorKind::internal, "read beyond the last point");
    if (format_ != PointFormat::las && !is_float_) {
      file_.read_at(place_of(first), count * kPair, coordinates);
      return;
    }
    constexpr std::size_t kPiece = std::size_t{1} << 15;
    buffer_.resize(std::min(count, kPiece) * record_bytes_);
    for (std::size_t done = 0; done < count;) {
      const std::size_t piece = std::min(count - done, kPiece);
      file_.read_at(place_of(first + done), piece * record_bytes_, buffer_.data());
      convert(piece, coordinates + 2 * done);
      done += piece;
    }
  }

 private:
  const char* expected() const {
    if (format_ == PointFormat::npy) return kPointArray;
    return format_ == PointFormat::las ? kLasFile : kPairs;
  }
  std::uint64_t place_of(std::uint64_t point) const { return begin_ + point * record_bytes_; }
  void convert(std::size_t count, double* coordinates) const {
    if (format_ == PointFormat::las) return las_.decode(buffer_.data(), count, coordinates);
    for (std::size_t i = 0; i < 2 * count; ++i) {
      float value;
      std::memcpy(&value, &buffer_[i * sizeof value], sizeof value);
      coordinates[i] = value;
    }
  }

  std::string path_;
  PointFormat format_;
  InputFile file_;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // of the first record, in bytes
  std::size_t record_bytes_ = kPair;
  bool is_float_ = false;
  LasPoints las_;
  std::vector<char> buffer_;
};

/// Points that were read from a text.
class TextFile : public PointSource {
 public:
  TextFile(const std::string& path, const std::string& scratch) : file_(scratch) {
    LinePieces pieces(path);
    const std::unique_ptr<PointText> parser = parse_points(path);
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
  explicit ReadPoints(const std::string& path) : points_(read_points(path)) {}

  std::uint64_t size() const override { return points_.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    std::memcpy(coordinates, points_.coordinates.data() + 2 * first, count * kPair);
  }

 private:
  const Points points_;
};

bool is_text(PointFormat format) { return format == PointFormat::text || format == PointFormat::node; }

}  // namespace

std::unique_ptr<PointSource> open_point_stream(const std::string& path, const std::string& scratch) {
  const PointFormat format = point_format(path);
  if (format == PointFormat::map) return std::make_unique<ReadPoints>(path);
  if (is_text(format)) return std::make_unique<TextFile>(path, scratch);
  return std::make_unique<RecordFile>(path);
}

std::uint64_t estimate_points(const std::string& path) {
  constexpr std::size_t kBeginning = std::size_t{1} << 16;
  const PointFormat format = point_format(path);
  if (format == PointFormat::map) return 0;
  // A pipe is not opened, since it can be read only once.
  struct stat status {};
  if (path == "-" || (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))) return 0;
  if (!is_text(format)) return RecordFile(path).size();
  InputFile file(path, expected_text(path));
  const std::string_view beginning = file.first(kBeginning);
  const auto lines = std::count(beginning.begin(), beginning.end(), '\n') + 1;
  return static_cast<std::uint64_t>(static_cast<double>(file.size()) * static_cast<double>(lines) /
                                    static_cast<double>(beginning.size()));
}

}  // namespace flaunay::io
