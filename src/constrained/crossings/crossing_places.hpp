// The vertices and crossings of one set of segments that are split, in scaled coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/crossing.hpp"
#include "constrained/crossings/pairs.hpp"
#include "constrained/crossings/snap.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {

using Ids = std::vector<std::int32_t>;

/// Points of one set, scaled so that the largest exponent is that of the predicates' range: then all of the
/// range is below it.
struct Vertices {
  Vertices(const double* coordinates, const geometry::PointSets& sets, std::size_t set);

  geometry::Point unscaled(geometry::Point p) const {
    return {std::ldexp(p.x, -shift), std::ldexp(p.y, -shift)};
  }
  bool is_added(std::int32_t v) const { return static_cast<std::size_t>(v) >= given; }

  /// Returns the vertices at these distinct places, in lexicographic order. Adds vertices where none exist.
  Ids find_or_add(const std::vector<geometry::Point>& places);

  std::vector<geometry::Point> points;
  Ids sorted;             ///< all, in lexicographic order
  std::size_t given = 0;  ///< the number of the caller's points, which come first
  int shift = 0;
  double unit = 0;
};

/// Scaled coordinates are below the first of these. The second is half the distance of the largest ones:
/// rounding moves no place by more than that, in each coordinate, unless the unit of Vertices is larger.
constexpr double kLargest = 0x1p250;
constexpr double kHalfSpacing = 0x1p-54 * kLargest;
static_assert(kernel::LARGEST_EXPONENT == 249);

/// Crossings of edges, merged where they are rounded to one place.
class CrossingPlaces {
 public:
  /// patience: a factor for the number of pairs that hubs may have.
  CrossingPlaces(const Vertices& vertices, const geometry::Predicates& predicates,
                 const std::vector<Piece>& edges, SplitLimits& limits, std::size_t patience)
      : vertices_(vertices), predicates_(predicates), edges_(edges), limits_(limits), patience_(patience) {}

  /// Adds two edges that cross. Returns whether to go on: not if many pairs cross at places that are hubs.
  bool add(std::int32_t e, std::int32_t f);

  bool empty() const { return all_.empty(); }

  /// Places at which many edges cross exactly, in lexicographic order.
  std::vector<geometry::Point> hubs() const;

  /// Makes vertices of the places. Rounding keeps the order of each coordinate. So along an edge, x does not
  /// decrease after rounding, and where it is equal, y is still in its order. are_apart: whether no two
  /// vertices that follow each other are so near that something else may be between them.
  Chains chains(Vertices& vertices, bool& are_apart);

 private:
  // A place is a hub if this many pairs of edges cross there exactly and come soon after each other.
  static constexpr std::uint32_t kPairsOfHub = 64;
  static constexpr std::size_t kRecent = 256;
  // Edges are cut at hubs, and searched again, if hubs have more pairs than these, edges and places together.
  static constexpr std::size_t kFirstPairs = 10000;
  static constexpr std::size_t kFirstMerge = 1 << 22;

  // Edges that meet a place. The second is -1 if an odd number does.
  struct Crossing {
    geometry::Point at;
    double reach;  // see reach() of two lines
    std::int32_t e, f;
  };
  struct Recent {
    geometry::Point at;
    std::uint32_t pairs;
    bool is_hub;
  };

  Line line(std::int32_t e) const;
  bool are_exactly_there(const Line& p, const Line& q, geometry::Point at) const;

  // In lexicographic order of places.
  std::vector<geometry::Keyed> sorted() const;

  // An edge meets a place only once, however many it crosses there.
  void merge();

  const Vertices& vertices_;
  const geometry::Predicates& predicates_;
  const std::vector<Piece>& edges_;
  SplitLimits& limits_;
  std::size_t patience_;
  std::vector<Crossing> all_;
  std::size_t merge_at_ = kFirstMerge;
  std::size_t places_ = 0;  // as of the last merge
  std::vector<Recent> recent_ = std::vector<Recent>(kRecent);
  std::vector<geometry::Point> hubs_;
  std::size_t pairs_of_hubs_ = 0;
};

}  // namespace flaunay::constrained
