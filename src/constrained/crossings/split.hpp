// Splits segments where they cross. docs/constrained.md defines the result, and shows how far it can be from
// the segments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/snap.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::constrained {

struct Split {
  /// As in ConstrainedTriangulation.
  std::vector<double> added_points;
  std::vector<std::size_t> added_offsets;
  /// Pieces that do not cross: 2 points per piece. The pieces of a segment are consecutive, from its
  /// lexicographically smaller end to the other one; each has the direction of its segment. Added point k has
  /// the index n + k. Pieces can overlap, and go through points.
  std::vector<std::int32_t> pieces;
  /// segments + 1 values: segment s has the pieces [piece_offsets[s], piece_offsets[s + 1]).
  std::vector<std::int32_t> piece_offsets;
  /// Whether there is a set whose segments were led through all vertices whose cells they meet, because
  /// crossings alone would have made others.
  bool is_snapped = false;

  /// Whether no segment has become several pieces or another one.
  bool is_as_it_was() const {
    return added_points.empty() && pieces.size() == 2 * (piece_offsets.size() - 1);
  }
};

/// Splits segments where they cross. A segment that nothing crosses is one piece.
///
/// coordinates, offsets: as in Triangulator::triangulate. segments: 2 indices of points of the same set per
/// segment.
///
/// Throws Error(usage) for wrong segments as constrain() does; Error(input) as Triangulator::triangulate does
/// for points, and if there are more pieces than the limit, or more points than 32-bit indices allow.
Split split(const double* coordinates, const std::vector<std::size_t>& offsets,
            const std::vector<std::int32_t>& segments, SplitLimits limits = {});

/// A path whose pieces are split as segments are, and cut at the ends of others on them: so no two pieces
/// have a place in common that is inside of one of them, unless they are equal. The same path, if that is so
/// already. No two places in a row may be equal. If coordinates span more bits than points may, they are
/// first rounded to multiples of 2^(E - 504) where the largest is in [2^E, 2^(E + 1)). Throws Error(input)
/// for too many pieces.
std::vector<geometry::Point> noded(const std::vector<geometry::Point>& path);

/// The points of all sets, each set's added points after its own.
struct AllPoints {
  std::vector<double> coordinates;
  std::vector<std::size_t> offsets;
  std::vector<std::int32_t> index;  ///< per point: its index where added points come last
  std::vector<std::int32_t> place;  ///< the other way round
};
AllPoints join_added(const double* coordinates, const std::vector<std::size_t>& offsets, const Split& split);

}  // namespace flaunay::constrained
