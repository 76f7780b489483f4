// A k-d tree for exact nearest neighbours (Bentley, "Multidimensional binary search trees used for
// associative searching", 1975; Friedman, Bentley and Finkel, "An algorithm for finding best matches in
// logarithmic expected time", 1977), and the trees of all spaces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "flaunay/neighbors.hpp"
#include "points/query_range.hpp"

namespace flaunay::nearest {

class PointTree {
 public:
  /// Throws Error(input) for points that are not accepted for triangulation. O(n log n).
  PointTree(const double* coordinates, std::size_t n);

  const points::PointRange& range() const { return range_; }
  /// Writes the rows of the queries [first, last). scaling: of all queries.
  void find(const double* queries, std::size_t first, std::size_t last, const points::QueryScaling& scaling,
            const NeighborOptions& options, Neighbors& result) const;

 private:
  friend class Search;
  /// A scaled point, and its index.
  struct Entry {
    double x, y;
    std::int32_t point;
  };
  /// The entries [first, last), cut at a coordinate into two halves. The lower half's node is the next one.
  struct Node {
    double cut;
    std::int32_t first, last;
    std::int32_t upper;  ///< the upper half's node; 0 for a leaf
    std::int32_t axis;
  };

  void make_nodes(std::int32_t first, std::int32_t last);

  points::PointRange range_;
  std::vector<Entry> entries_;
  std::vector<Node> nodes_;
};

/// What answers the queries of a flaunay::PointTree in a space.
class Tree {
 public:
  virtual ~Tree() = default;
  /// Throws Error(usage) but on the sphere.
  virtual void set_coordinates(SphereCoordinates coordinates);
  virtual Neighbors nearest(const double* queries, std::size_t m, const NeighborOptions& options) = 0;
};

/// For a space in which two points are as far from each other as the place of one is from the nearest of the
/// other's place and its images in the plane. coordinates: of points, and behind them of images, those of a
/// point in a row; originals: per image, its point.
std::unique_ptr<Tree> tree_of_images(Triangulator& triangulator, const std::vector<double>& coordinates,
                                     std::vector<std::int32_t> originals, const Space& space);

}  // namespace flaunay::nearest
