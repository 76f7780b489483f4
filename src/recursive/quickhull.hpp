// The host's twin of the stage `quickhull`: paths that grow from two ends.
#pragma once

#include <cstddef>
#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"

namespace flaunay::recursive {

/// Rounds of quickhull before balanced splits: what Hull::balanced starts with, and after how many quickhull
/// gives up on the deepest points. No input has been seen to take so many that was not made to.
constexpr std::size_t kRoundsBeforeBalance = 4;
constexpr std::size_t kMostQuickhullRounds = 64;

/// Lower hulls in the projection of one line.
class Quickhull {
 public:
  Quickhull(const Predicates& predicates, const Line& line, Counter& counter)
      : predicates_(predicates), line_(line), counter_(counter) {}

  /// The path from `first` to `last` over `points`, which may hold the ends and points more than once. From
  /// round `balanced_from` on segments split by Chan, Snoeyink and Yap's rule, else at their deepest points.
  /// Every vertex of the strict hull is on the path; what rounding has put there besides, strict() drops.
  /// Expected O(n log n) work; rounds: how many it took, O(balanced_from + log n) expected.
  Path run(const HullPoint& first, const HullPoint& last, const std::vector<HullPoint>& points,
           std::size_t balanced_from, int& rounds);

  /// Drops what is on or above the segment of its neighbours, until nothing is.
  void strict(Path& path);

 private:
  struct Below;  // a point below the chord of its segment
  void extend(const HullPoint& a, const HullPoint& b, const std::vector<HullPoint>& points,
              std::size_t round);
  std::vector<Below> points_below(const HullPoint& a, const HullPoint& b,
                                  const std::vector<HullPoint>& points);
  HullPoint deepest(const std::vector<Below>& below);
  void tilt(double origin, std::vector<Below>& below);
  void drop_hidden(const HullPoint& e, std::vector<Below>& below);

  const Predicates& predicates_;
  const Line& line_;
  Counter& counter_;
  std::size_t balanced_from_ = 0;
  Path path_;                             // what is done of it
  std::vector<std::size_t> round_sizes_;  // points in all segments, by round
};

}  // namespace flaunay::recursive
