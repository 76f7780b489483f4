// Points of LAS files, in which laser scans come.
//
// The format: American Society for Photogrammetry and Remote Sensing, "LAS Specification 1.4 - R15", 2019,
// and those of versions 1.0 (2003) to 1.3 (2010), whose headers are the beginning of this one.
#pragma once

#include <string>

#include "app/files/points.hpp"
#include "files/file.hpp"

namespace flaunay::io {

/// Reads the header, and checks it against the size of the file.
PointRecords las_points(const std::string& path, InputFile& file);

/// Throws Error(input) that says how to decompress a LAZ file.
[[noreturn]] void refuse_compressed(const std::string& path);

}  // namespace flaunay::io
