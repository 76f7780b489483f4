// The stage `quickhull` on the host: paths that grow by the deepest points below their chords.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "modes/recursive/line.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// A point below the chord of its segment.
struct Below {
  HullPoint point;
  double rank;           ///< its depth; the point with the greatest becomes a vertex
  std::size_t position;  ///< its position among all points of the segment
  bool dropped = false;
};
/// Per path vertex: the points below the chord from this vertex to the next one.
using BelowChords = std::vector<std::vector<Below>>;

/// Computes lower hulls in the projection of one line.
class Quickhull {
 public:
  /// Segments are split at their deepest points before round `balanced_from`, and by the rule of Chan,
  /// Snoeyink and Yap from then on.
  Quickhull(const geometry::Predicates& predicates, const Line& line, std::size_t balanced_from,
            statistics::Counter& counter)
      : predicates_(predicates), line_(line), balanced_from_(balanced_from), counter_(counter) {}

  /// Computes a path from `first` to `last` over `points`, which may contain the ends, and points more than
  /// once. Every vertex of the strict hull is on the path; strict() removes the others. rounds: set to the
  /// number of rounds. Expected O(n log n) work and O(balanced_from + log n) rounds.
  Path run(const HullPoint& first, const HullPoint& last, const std::vector<HullPoint>& points, int& rounds);

  /// Extends a path, whose vertices stay on it. below: all points below its chords, with their depths, so
  /// that the first round need not compute these.
  Path go_on(const Path& path, BelowChords below, int& rounds);

  /// Removes vertices on or above the segment between their neighbours, and the higher one of two neighbours
  /// of equal u, until no such vertex is left.
  void strict(Path& path);

 private:
  void extend(const HullPoint& a, const HullPoint& b, const std::vector<HullPoint>& points,
              std::size_t round);
  void split(const HullPoint& a, const HullPoint& b, std::vector<Below> below, std::size_t points,
             std::size_t round);
  void note_segment(std::size_t points, std::size_t round);
  Path take_path(bool first_is_known, int& rounds);
  std::vector<Below> points_below(const HullPoint& a, const HullPoint& b,
                                  const std::vector<HullPoint>& points);
  HullPoint deepest(const std::vector<Below>& below);
  void tilt(double origin, std::size_t points, std::vector<Below>& below);
  void drop_hidden(const HullPoint& e, std::vector<Below>& below);
  bool is_strict(const HullPoint& before, const HullPoint& p, const HullPoint& after);

  const geometry::Predicates& predicates_;
  const Line& line_;
  const std::size_t balanced_from_;
  statistics::Counter& counter_;
  Path path_;                             // the finished part
  std::vector<std::size_t> round_sizes_;  // per round: points in all segments
};

}  // namespace flaunay::recursive
