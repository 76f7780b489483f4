// The regions of a partition: files that other programs read, and a picture.
#pragma once

#include <string>

#include "app/files/points.hpp"
#include "files/output.hpp"
#include "flaunay/research.hpp"

namespace flaunay::io {

/// Writes, numbered from 0, stem.node with the region's points (attribute: the index of the input point;
/// marker 1: on the border) and stem.poly with its border as segments, the region on the left. points: the
/// input's. Throws Error(input) naming the file and the system's reason.
void write_region(Outputs& outputs, const std::string& stem, const Points& points,
                  const research::Region& region);

/// Writes a picture (SVG) of the regions, one colour each, with their points and borders.
void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition);

struct StoredRegion {
  Points points;
  research::Region region;
};

/// Reads the files of write_region, for this many points and border edges. Throws Error(input) that names the
/// file and the line.
StoredRegion read_region(const std::string& stem, std::size_t points, std::size_t border_edges);

}  // namespace flaunay::io
