// The host's twin of the stage `quickhull`: paths that grow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"

namespace flaunay::recursive {

/// Rounds of quickhull before balanced splits: what Hull::balanced starts with, and after how many quickhull
/// gives up on the deepest points. No input has been seen to take so many that was not made to.
constexpr std::size_t kRoundsBeforeBalance = 4;
constexpr std::size_t kMostQuickhullRounds = 64;

/// A point below the chord of its segment.
struct Below {
  HullPoint point;
  double rank;           ///< how far below; the greatest becomes a vertex
  std::size_t position;  ///< in the segment, of all of its points
  bool dropped = false;
};
/// By path vertex: what is below the chord from there to the next one.
using BelowChords = std::vector<std::vector<Below>>;

/// Lower hulls in the projection of one line.
class Quickhull {
 public:
  /// From round `balanced_from` on segments split by Chan, Snoeyink and Yap's rule, else at their deepest
  /// points.
  Quickhull(const Predicates& predicates, const Line& line, std::size_t balanced_from, Counter& counter)
      : predicates_(predicates), line_(line), balanced_from_(balanced_from), counter_(counter) {}

  /// The path from `first` to `last` over `points`, which may hold the ends and points more than once. Every
  /// vertex of the strict hull is on the path; what else there is, strict() drops. Expected O(n log n) work;
  /// rounds: how many it took, O(balanced_from + log n) expected.
  Path run(const HullPoint& first, const HullPoint& last, const std::vector<HullPoint>& points, int& rounds);

  /// The same, but grows a path: its vertices stay on it, and nothing else is below its chords. What its
  /// first round needs to know of them is known.
  Path go_on(const Path& path, BelowChords below, int& rounds);

  /// Drops what is on or above the segment of its neighbours, and of two neighbours of equal u the one that
  /// is not the lower, until nothing is.
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

  const Predicates& predicates_;
  const Line& line_;
  const std::size_t balanced_from_;
  Counter& counter_;
  Path path_;                             // what is done of it
  std::vector<std::size_t> round_sizes_;  // points in all segments, by round
};

}  // namespace flaunay::recursive
