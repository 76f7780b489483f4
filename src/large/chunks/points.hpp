// The points of a chunk, and the open edges that are handed on with them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "arithmetic/language.h"

namespace flaunay::chunks {

/// kernel::open_edge beyond one device: an edge out of a chunk's point. The triangle on one side is written,
/// the one on the other side is missing. Its other end may be in another chunk.
struct OpenEdge {
  std::int64_t to;        ///< the other end's number in the input
  double x, y;            ///< its coordinates
  std::int64_t corner;    ///< the entry of `neighbors` that waits for the missing triangle; -1: it has no row
  std::int64_t begins;    ///< whether the missing side begins at the edge, counter-clockwise: 1 or 0
  std::int64_t opposite;  ///< the number of the written triangle's third corner
};

/// Points in ascending order of their numbers in the input. The first round has duplicates and no open edges;
/// later rounds have open edges and no duplicates.
struct ChunkPoints {
  std::vector<double> coordinates;        ///< x0 y0 x1 y1 ...
  std::vector<std::int64_t> ids;          ///< their numbers in the input
  std::vector<double> values = {};        ///< one per point, or none
  std::vector<std::size_t> edge_offsets;  ///< size() + 1; empty in the first round
  std::vector<OpenEdge> edges;            ///< point i has [edge_offsets[i], edge_offsets[i + 1])

  std::size_t size() const { return ids.size(); }
  bool is_first_round() const { return edge_offsets.empty(); }
  kernel::double2 point(std::size_t i) const { return {coordinates[2 * i], coordinates[2 * i + 1]}; }
  std::size_t edge_count(std::size_t i) const {
    return is_first_round() ? 0 : edge_offsets[i + 1] - edge_offsets[i];
  }
  bool has_values() const { return !values.empty(); }
  /// Appends a point with its open edges, but for its value.
  void add(kernel::double2 p, std::int64_t id, const OpenEdge* its_edges, std::size_t count);
  /// Sorts the points by their numbers.
  void sort();
};

}  // namespace flaunay::chunks
