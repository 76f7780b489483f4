// Points of LAS files.
//
// The format: American Society for Photogrammetry and Remote Sensing, "LAS Specification 1.4 - R15", 2019,
// and versions 1.0 (2003) to 1.3 (2010), whose headers are the beginning of this one.
#include "app/files/las.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "app/files/formats.hpp"

namespace flaunay::io {
namespace {

// Offsets in the header of the fields read here.
constexpr std::size_t kVersionMajor = 24, kVersionMinor = 25, kHeaderSize = 94, kDataBegin = 96,
                      kFormat = 104, kRecordBytes = 105, kLegacyCount = 107, kScale = 131, kOffset = 155,
                      kBox = 179, kCount = 247, kVariableCount = 100;
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
  fail(
      path,
      "is compressed (LAZ); expected an uncompressed LAS file: decompress it first, for example with "
      "\"laszip -i IN.laz -o OUT.las\" or \"pdal translate IN.laz OUT.las\"; flaunay.terrain in Python reads "
      "it (pip install flaunay[terrain])");
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

void check_size(const std::string& path, const LasHeader& points, std::uint64_t bytes) {
  // Data after the points, such as further records of variable length, is not read.
  if (points.begin > bytes || points.size > (bytes - points.begin) / points.record_bytes) {
    fail(path, "is truncated: {} points of {} bytes from byte {} on, but the file has {} bytes", points.size,
         points.record_bytes, points.begin, bytes);
  }
}

/// The coordinate system in records of variable length, which lie between the header and the points: WKT, or
/// else the number of EPSG in the keys of GeoTIFF. Other records are passed by, however large they are.
std::string find_crs(const InputFile& file, std::string_view header, std::uint64_t end) {
  constexpr std::size_t kRecordHeader = 54, kId = 18, kLength = 20;
  constexpr int kWkt = 2112, kGeoKeys = 34735;
  constexpr std::array kEpsgKeys = {3072, 2048};  // of projected systems, and of others
  constexpr int kUserDefined = 32767;
  std::string wkt;
  std::array<int, kEpsgKeys.size()> codes{};
  std::uint64_t next = value_at<std::uint16_t>(header, kHeaderSize);
  for (auto left = value_at<std::uint32_t>(header, kVariableCount); left > 0 && end - next >= kRecordHeader;
       --left) {
    std::array<char, kRecordHeader> bytes{};
    file.read_at(next, bytes.size(), bytes.data());
    next += kRecordHeader;
    const std::string_view record(bytes.data(), bytes.size());
    const int id = value_at<std::uint16_t>(record, kId);
    const std::uint64_t length =
        std::min<std::uint64_t>(end - next, value_at<std::uint16_t>(record, kLength));
    std::string content(id == kWkt || id == kGeoKeys ? length : 0, '\0');
    file.read_at(next, content.size(), content.data());
    next += length;
    if (id == kWkt) wkt = content.substr(0, content.find('\0'));
    for (std::size_t key = 8; id == kGeoKeys && key + 8 <= content.size(); key += 8) {
      const int code = value_at<std::uint16_t>(content, key + 6);
      const bool is_value = value_at<std::uint16_t>(content, key + 2) == 0 && code > 0 && code < kUserDefined;
      for (std::size_t k = 0; k < kEpsgKeys.size(); ++k) {
        if (is_value && value_at<std::uint16_t>(content, key) == kEpsgKeys[k] && codes[k] == 0)
          codes[k] = code;
      }
    }
  }
  if (!wkt.empty()) return wkt;
  const int code = codes[0] != 0 ? codes[0] : codes[1];
  return code != 0 ? fmt::format("EPSG:{}", code) : "";
}

PointRecords las_points(const std::string& path, InputFile& file, const Columns&) {
  const LasHeader header = read_las_header(path, file);
  return {header.size,
          header.begin,
          header.record_bytes,
          header.crs,
          [header](const char* records, std::size_t count, double* coordinates) {
            header.decode<2>(records, count, coordinates);
          },
          [header](const char* records, std::size_t count, double* heights) {
            header.decode<1, 2>(records, count, heights);
          },
          [header](const char* records, std::size_t count) {
            std::size_t withheld = 0;
            for (std::size_t k = 0; k < count; ++k)
              withheld += header.is_withheld(records + k * header.record_bytes);
            return withheld;
          }};
}

}  // namespace

LasHeader read_las_header(const std::string& path, InputFile& file) {
  const std::string header(file.first(kHeaderBytes.back()));
  const std::size_t minor = check_beginning(path, header);
  const std::size_t header_bytes = value_at<std::uint16_t>(header, kHeaderSize);
  if (header_bytes < kHeaderBytes[minor] || header.size() < kHeaderBytes[minor]) {
    fail(path, "has a LAS header of {} bytes; expected at least {} in version 1.{}",
         std::min(header_bytes, header.size()), kHeaderBytes[minor], minor);
  }
  LasHeader found;
  found.record_bytes = value_at<std::uint16_t>(header, kRecordBytes);
  found.format = value_at<std::uint8_t>(header, kFormat);
  check_format(path, found.format, found.record_bytes);
  found.begin = value_at<std::uint32_t>(header, kDataBegin);
  if (found.begin < header_bytes) {
    fail(path, "has its LAS points from byte {} on, within the header of {} bytes", found.begin,
         header_bytes);
  }
  found.size =
      minor == 4 ? value_at<std::uint64_t>(header, kCount) : value_at<std::uint32_t>(header, kLegacyCount);
  for (std::size_t axis = 0; axis < found.axes.size(); ++axis) {
    const auto scale = value_at<double>(header, kScale + axis * sizeof(double));
    const auto offset = value_at<double>(header, kOffset + axis * sizeof(double));
    if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset)) {
      fail(path, "has LAS scale {} and offset {} for {}; expected finite numbers, and a scale that is not 0",
           scale, offset, "xyz"[axis]);
    }
    found.axes[axis] = LasAxis(scale, offset);
  }
  // Largest and least x, then y.
  for (std::size_t k = 0; k < 4; ++k) {
    constexpr std::array<std::size_t, 4> kPlaces = {1, 3, 0, 2};
    found.box[k] = value_at<double>(header, kBox + kPlaces[k] * sizeof(double));
  }
  file.load_pipe();
  check_size(path, found, static_cast<std::uint64_t>(file.size()));
  found.crs = find_crs(file, header, found.begin);
  return found;
}

const Format kLas = {.ending = ".las", .content = "an uncompressed LAS file", .records = las_points};
const Format kLaz = {.ending = ".laz", .refuse = refuse_compressed};

}  // namespace flaunay::io
