// Triangulations that live: points are inserted, removed and moved in batches. docs/updates.md explains them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// The changes that a batch has made.
struct Changes {
  std::size_t first_point = 0;  ///< the number of the first point that was inserted; the others follow it
  /// One per point that was inserted or moved: the smallest number of a point in its place, which is the one
  /// that triangles have.
  std::vector<std::int32_t> representatives;
  /// The rows whose triangles are gone, each once. Rows, and their order, are the same on every device.
  std::vector<std::int32_t> removed;
  /// The rows that have new triangles, each once. A row may be in both lists: it is used again. So may a
  /// triangle be that was taken away for a while.
  std::vector<std::int32_t> made;
  std::vector<std::int32_t> made_corners;  ///< 3 per row of `made`: the corners, counter-clockwise
  bool is_anew = false;                    ///< whether all points were triangulated anew: all rows are listed
  double seconds = 0;                      ///< how long the call took
};

/// The triangles of a DynamicTriangulation by their rows.
struct TriangleRows {
  /// 3 per row: the corners, counter-clockwise, from any of them on; -1, all of them, in a row without a
  /// triangle.
  std::vector<std::int32_t> triangles;
  /// 3 per row: the row of the triangle opposite to each corner, -1 beyond the hull and in rows without a
  /// triangle.
  std::vector<std::int32_t> neighbors;
};

/// The edges that segments are made of now, in ascending order of the smaller numbers of their points, and of
/// the larger ones.
struct LivingConstraints {
  std::vector<std::int32_t> edges;     ///< 2 points per edge, the lexicographically smaller one first
  std::vector<std::int32_t> segments;  ///< one per edge: the smallest index of a segment that has it
};

/// A triangulation to which batches of points are inserted, removed and moved, each in one call. After every
/// call, its triangles are those of a call of Triangulator on all points that it has.
///
/// Points have numbers: those it is made from come first, then those inserted, in their order. A number stays
/// the same as long as the point is there, and is not used again. Of points in one place, the one with the
/// smallest number is in triangles.
///
/// Triangles are in rows of an array, some of which have none. A triangle stays in its row as long as nothing
/// changes it. Rows are the same on every device, for the same calls.
///
/// Bad input throws an error, which names it, and changes nothing: Error(input) for a coordinate that is not
/// finite, coordinates whose magnitudes differ too much from those of the other points, a number that no
/// point has, and one that is there twice. If a call fails for another reason, such as lack of memory or a
/// progress callback that throws, points, triangles and constraints are what they were before, but triangles
/// may be in other rows, which rows() tells. It shares device and memory with its triangulator, which it may
/// outlive: calls of either during another one throw Error(usage).
class FLAUNAY_API DynamicTriangulation {
 public:
  /// Triangulates n points, which may be none, like Triangulator::triangulate. The options hold for
  /// triangulation(), too.
  DynamicTriangulation(Triangulator& triangulator, const double* coordinates, std::size_t n,
                       const Options& options = {});
  /// Triangulates points in device memory. They are copied.
  DynamicTriangulation(Triangulator& triangulator, const DevicePoints& points, const Options& options = {});
  /// Triangulates n points with segments as edges, like Triangulator::constrained. If crossing segments are
  /// split, the points that this adds come after the n. Nothing is left out and nothing refined: Error(usage)
  /// for holes, seeds, rings, labels, refinement and Outside other than keep.
  DynamicTriangulation(Triangulator& triangulator, const double* coordinates, std::size_t n,
                       const Constraints& constraints, const ConstrainedOptions& options = {});
  ~DynamicTriangulation();
  /// A triangulation that was moved from can only be destroyed or assigned to.
  DynamicTriangulation(DynamicTriangulation&&) noexcept;
  /// Releases what is assigned to. The other can then only be destroyed or assigned to.
  DynamicTriangulation& operator=(DynamicTriangulation&&) noexcept;

  /// Inserts m points, x0 y0 x1 y1 ... One that lies on a constraint splits it, and both parts keep its
  /// segment.
  Changes insert(const double* coordinates, std::size_t m);
  /// Inserts points in device memory, of one set.
  Changes insert(const DevicePoints& points);
  /// Removes the points of these m numbers. Error(input) for a vertex of a constraint.
  Changes remove(const std::int32_t* points, std::size_t m);
  /// Moves the points of these m numbers to these places, all at once. Error(input) for a vertex of a
  /// constraint.
  Changes move(const std::int32_t* points, const double* coordinates, std::size_t m);

  std::size_t numbers() const noexcept;         ///< one more than the largest number that a point has had
  std::size_t point_count() const noexcept;     ///< the points that there are, with duplicates
  std::size_t triangle_count() const noexcept;  ///< the triangles that there are
  std::size_t row_count() const noexcept;       ///< the rows that there are, with those that have no triangle
  /// Whether there is a point of this number. O(1).
  bool has_point(std::size_t number) const noexcept;

  /// x and y per number; NaN of points that were removed.
  std::vector<double> coordinates() const;
  /// All rows. O(rows).
  TriangleRows rows();
  /// Writes all rows and coordinates, also of numbers without a point, to device memory: result.points is
  /// numbers(), and result.triangle_offsets ends with row_count(), r, for which the caller's buffers of
  /// triangles and neighbors need 12 r bytes each. The work is enqueued like that of
  /// Triangulator::triangulate, with the same errors. O(rows).
  void rows(DeviceTriangulation& result, const Enqueue& enqueue = {});
  /// The result of a call on all points, with these numbers: triangles in the order of their rows, which have
  /// the smallest number first. Representatives of points that were removed are -1. O(rows).
  Triangulation triangulation();
  /// The edges that segments are made of; empty if there are no constraints.
  LivingConstraints constraints();

 private:
  struct FLAUNAY_LOCAL Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flaunay
