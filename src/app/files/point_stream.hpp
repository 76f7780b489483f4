// The points of a file in pieces. Only one piece is in memory at a time.
#pragma once

#include <memory>
#include <string>

#include "app/files/points.hpp"
#include "flaunay/chunks.hpp"

namespace flaunay::io {

/// Opens a file in one of the formats of read_points, and checks it as far as that needs no pass over all
/// points of the binary formats. They must be regular files. Text is read at once, into a file without a name
/// in `scratch` (empty: TMPDIR, or /tmp), 16 bytes per point; maps are kept in memory. Throws the errors of
/// read_points, except for points of the binary formats that are not finite; reading throws Error(input) if
/// the file became shorter.
std::unique_ptr<PointSource> open_point_stream(const std::string& path, const std::string& scratch,
                                               const Columns& columns = {});

/// About how many points read_points would read: exact but for text, where the beginning of the file tells
/// how long lines are. 0: not known, because the file is a pipe or a map. Throws Error(input) for a file that
/// cannot be opened, and for a binary file the errors of open_point_stream.
std::uint64_t estimate_points(const std::string& path, const Columns& columns = {});

}  // namespace flaunay::io
