// Triangle's .poly files: vertices, segments, holes and regions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/points.hpp"
#include "app/files/text.hpp"

namespace flaunay::io {

/// A place in a region, and what the file says about the region.
struct PolyRegion {
  double place[2], attribute;
  std::optional<double> area;  ///< the largest one, for programs that add points
};

struct PolyFile {
  std::string path;
  Points points;                       ///< none if the vertices are in another file that was read before
  std::vector<std::int32_t> segments;  ///< 2 points each, counted from 0
  std::vector<double> holes;           ///< x and y each
  std::vector<std::int32_t> markers;   ///< of the segments, if there are some
  std::vector<PolyRegion> regions;
};

/// Reads a file. nodes: the vertices that one without its own refers to; null to read them from the .node
/// file beside it. Throws Error(input) that names the line.
PolyFile read_poly(const std::string& path, const NodeFile* nodes = nullptr);

/// x.poly to x.node: the path with another ending.
std::string path_beside(const std::string& path, std::string_view ending);

}  // namespace flaunay::io
