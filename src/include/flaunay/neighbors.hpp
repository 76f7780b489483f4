// The nearest neighbours of places among points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "flaunay/export.h"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// The options of a query for nearest points.
struct NeighborOptions {
  std::size_t count = 1;  ///< how many points
  /// Points whose distance, rounded, is larger are left out.
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Nearest points: rows of NeighborOptions::count per query, the nearest first. Of points that are as near,
/// the first in the order of x, then y, then index is first.
struct Neighbors {
  std::vector<std::int32_t> points;  ///< -1 where there are no more points
  std::vector<double> distances;     ///< rounded; infinity where there are no more points
};

/// Finds the points that are nearest to queries, of which there may be several and with their distances. It
/// is a tree in host memory, which needs no triangulation and takes a fraction of its time. It shares threads
/// with its triangulator, so a call during another one of either throws Error(usage); it may outlive the
/// triangulator.
class FLAUNAY_API PointTree {
 public:
  /// Makes a tree of n points, x0 y0 x1 y1 ..., which may be equal. Throws Error(input) as a triangulation of
  /// them. O(n log n) work; 30 bytes per point.
  PointTree(Triangulator& triangulator, const double* coordinates, std::size_t n);
  /// Makes a tree of the places of one set of points on a torus, a cylinder or the sphere. On a torus and a
  /// cylinder it has their images up to half a period away: queries are any places of the plane, and each
  /// point counts once, as it lies nearest. On the sphere, queries are given as the points were, distances,
  /// also the largest one, are angles in radians, rounded, and of points that are as near the south pole is
  /// first, or else the one with the smallest place. Throws Error(usage) for several sets, for the plane, and
  /// for arrays that are none's. O(n log n) work.
  PointTree(Triangulator& triangulator, const Triangulation& triangulation);
  /// Releases its memory.
  ~PointTree();
  /// A tree that was moved from can only be destroyed or assigned to.
  PointTree(PointTree&&) noexcept;
  /// Releases the memory of the tree that is assigned to. The other can then only be destroyed or assigned
  /// to.
  PointTree& operator=(PointTree&&) noexcept;

  /// Makes later queries on the sphere be given so. Throws Error(usage) in other spaces.
  void set_coordinates(SphereCoordinates coordinates);
  /// Finds for each of m queries the nearest points, in their order by exact comparisons. Throws Error(usage)
  /// for no points per query and a distance that is NaN or negative; Error(input) as Locator. About
  /// O(log n + count log count) per query is expected, but all points that are exactly as near are looked at.
  Neighbors nearest(const double* queries, std::size_t m, const NeighborOptions& options = {});

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flaunay
