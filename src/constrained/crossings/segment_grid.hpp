// A grid of cells that list the segments in them, which finds nearby segments fast if segments are spread
// evenly, or if most of them cross.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

/// Segments in cells about as large as they are. Segments are padded by 2^-40 of the largest magnitude. O(s)
/// to build, and O(s) memory.
class SegmentGrid {
 public:
  /// lines: each with its lexicographically smaller end first.
  explicit SegmentGrid(const std::vector<Line>& lines);

  /// Calls `found` once with each pair of segments that cross, until it says no, and returns true. Returns
  /// false before all are found if too many pairs in cells do not cross: it takes O(s + k) for k pairs that
  /// are found.
  bool find_crossings(const geometry::Predicates& predicates, const FoundPair& found) const;

  /// Calls `found` with all pairs of a segment and a point whose distance is at most `distance` in both
  /// coordinates, and with some whose distance is a little larger, and returns true. Returns false if `found`
  /// says no, or if there are too many pairs in cells. distance: at most 2^-45 of the largest magnitude.
  bool find_near(const std::vector<geometry::Point>& points, double distance, const FoundPair& found) const;

 private:
  struct Axis {
    double low, step;
    std::int32_t cells;
    std::int32_t cell(double x) const;
  };

  template <typename Visit>
  void visit_cells(const Line& line, const Visit& visit) const;
  std::size_t cells() const {
    return static_cast<std::size_t>(x_.cells) * static_cast<std::size_t>(y_.cells);
  }
  std::size_t cell_at(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(x_.cells) +
           static_cast<std::size_t>(column);
  }
  std::size_t cell_of(geometry::Point p) const { return cell_at(x_.cell(p.x), y_.cell(p.y)); }
  bool is_elsewhere(const Line& p, const Line& q, std::size_t cell) const;

  const std::vector<Line>& lines_;
  Axis x_{}, y_{};
  double padding_ = 0;
  std::vector<std::uint32_t> offsets_;  // cells + 1 values: cell c has segments [offsets[c], offsets[c + 1])
  std::vector<std::int32_t> segments_;  // by cells, ascending
};

/// Calls `found` with the pairs of pieces that cross, as find_crossings of pairs.hpp does, by a grid where
/// that suffices.
void find_crossings_by_place(const geometry::Predicates& predicates, const geometry::Point* points,
                             const std::vector<Piece>& pieces, const FoundPair& found);

/// The lines of pieces.
std::vector<Line> lines_of(const geometry::Point* points, const std::vector<Piece>& pieces);

}  // namespace flaunay::constrained
