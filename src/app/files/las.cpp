// Points of LAS files, in which laser scans come.
//
// The format: American Society for Photogrammetry and Remote Sensing, "LAS Specification 1.4 - R15", 2019,
// and those of versions 1.0 (2003) to 1.3 (2010), whose headers are the beginning of this one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "app/files/formats.hpp"

namespace flaunay::io {
namespace {

// Where the header of the specification has what is read here.
constexpr std::size_t kVersionMajor = 24, kVersionMinor = 25, kHeaderSize = 94, kDataBegin = 96,
                      kFormat = 104, kRecordBytes = 105, kLegacyCount = 107, kScale = 131, kOffset = 155,
                      kCount = 247;
/// The size of the header of versions 1.0 to 1.2, of 1.3, and of 1.4.
constexpr std::array<std::size_t, 5> kHeaderBytes = {227, 227, 227, 235, 375};
/// The size of a record of point formats 0 to 10. Records may be longer, by bytes that each user defines.
constexpr std::array<std::size_t, 11> kLeastRecordBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
/// LASzip sets one of the highest bits of the point format of a compressed file.
constexpr int kCompressedBits = 0xc0;

template <typename Value>
Value value_at(std::string_view bytes, std::size_t place) {
  Value value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

/// Checks signature and version. Returns the minor version.
std::size_t check_beginning(const std::string& path, std::string_view header) {
  constexpr std::string_view kSignature = "LASF";
  if (header.substr(0, kSignature.size()) != kSignature) {
    fail(path, "is no LAS file; expected it to begin with LASF");
  }
  if (header.size() < kHeaderBytes[0]) {
    fail(path, "is truncated in the LAS header: {} bytes, expected at least {}", header.size(),
         kHeaderBytes[0]);
  }
  const int major = value_at<std::uint8_t>(header, kVersionMajor);
  const std::size_t minor = value_at<std::uint8_t>(header, kVersionMinor);
  if (major != 1 || minor >= kHeaderBytes.size()) {
    fail(path, "has LAS version {}.{}; expected 1.0 to 1.4", major, minor);
  }
  return minor;
}

/// Says how to decompress a LAZ file.
[[noreturn]] void refuse_compressed(const std::string& path) {
  fail(path,
       "is compressed (LAZ); expected an uncompressed LAS file: decompress it first, for example with "
       "\"laszip -i "
       "IN.laz -o OUT.las\" or \"pdal translate IN.laz OUT.las\"");
}

void check_format(const std::string& path, int format, std::size_t record_bytes) {
  if ((format & kCompressedBits) != 0) refuse_compressed(path);
  if (static_cast<std::size_t>(format) >= kLeastRecordBytes.size()) {
    fail(path, "has LAS point format {}; expected 0 to {}", format, kLeastRecordBytes.size() - 1);
  }
  const std::size_t least = kLeastRecordBytes[static_cast<std::size_t>(format)];
  if (record_bytes < least) {
    fail(path, "has LAS point records of {} bytes; expected at least {} in point format {}", record_bytes,
         least, format);
  }
}

void check_size(const std::string& path, const PointRecords& points, std::uint64_t bytes) {
  const std::uint64_t found = bytes - std::min(bytes, points.begin);
  // What follows the points, such as further records of variable length, is not read.
  if (points.size > found / points.bytes) {
    fail(path, "is truncated: {} points of {} bytes from byte {} on, but the file has {} bytes", points.size,
         points.bytes, points.begin, bytes);
  }
}

/// coordinate = integer * scale + offset
struct Decode {
  std::size_t record_bytes;
  std::array<double, 2> scale{}, offset{};  ///< of x and y

  void operator()(const char* records, std::size_t count, double* coordinates) const {
    for (std::size_t i = 0; i < count; ++i, records += record_bytes) {
      std::int32_t stored[2];  // every point format begins with X and Y
      std::memcpy(stored, records, sizeof stored);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        coordinates[2 * i + axis] = stored[axis] * scale[axis] + offset[axis];
      }
    }
  }
};

/// Reads the header, and checks it against the size of the file.
PointRecords las_points(const std::string& path, InputFile& file) {
  const std::string_view header = file.first(kHeaderBytes.back());
  const std::size_t minor = check_beginning(path, header);
  const std::size_t header_bytes = value_at<std::uint16_t>(header, kHeaderSize);
  if (header_bytes < kHeaderBytes[minor] || header.size() < kHeaderBytes[minor]) {
    fail(path, "has a LAS header of {} bytes; expected at least {} in version 1.{}",
         std::min(header_bytes, header.size()), kHeaderBytes[minor], minor);
  }
  PointRecords points;
  points.bytes = value_at<std::uint16_t>(header, kRecordBytes);
  check_format(path, value_at<std::uint8_t>(header, kFormat), points.bytes);
  points.begin = value_at<std::uint32_t>(header, kDataBegin);
  if (points.begin < header_bytes) {
    fail(path, "has its LAS points from byte {} on, within the header of {} bytes", points.begin,
         header_bytes);
  }
  points.size =
      minor == 4 ? value_at<std::uint64_t>(header, kCount) : value_at<std::uint32_t>(header, kLegacyCount);
  Decode decode{points.bytes};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    decode.scale[axis] = value_at<double>(header, kScale + axis * sizeof(double));
    decode.offset[axis] = value_at<double>(header, kOffset + axis * sizeof(double));
    if (!std::isfinite(decode.scale[axis]) || decode.scale[axis] == 0 ||
        !std::isfinite(decode.offset[axis])) {
      fail(path, "has LAS scale {} and offset {} for {}; expected finite numbers, and a scale that is not 0",
           decode.scale[axis], decode.offset[axis], axis == 0 ? 'x' : 'y');
    }
  }
  file.load_pipe();
  check_size(path, points, static_cast<std::uint64_t>(file.size()));
  points.decode = decode;
  return points;
}

}  // namespace

const Format kLas = {.ending = ".las", .content = "an uncompressed LAS file", .records = las_points};
const Format kLaz = {.ending = ".laz", .refuse = refuse_compressed};

}  // namespace flaunay::io
