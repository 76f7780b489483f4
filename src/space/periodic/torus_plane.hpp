// What a locator on a torus or a cylinder has besides the locator in the plane that answers it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "call/implementation.hpp"
#include "derived/locate/locator.hpp"
#include "space/periodic/torus.hpp"

namespace flaunay::call {

/// The sets of a triangulation on a torus or a cylinder, with images of points around their boxes, in the
/// plane. There queries are answered at their places, and answers are numbers of the plane.
class TorusPlane {
 public:
  /// Triangulates points and images in the plane; see coordinates() and planar(). weights: null, or of the
  /// points; those that are hidden are left out. It is the triangulator's turn. Throws Error(usage) for
  /// arrays that are not those of a triangulation on a torus or a cylinder with these weights.
  TorusPlane(Implementation& self, const Triangulation& given, const double* weights);

  /// The points and images of the sets, and their triangulation, until the release.
  const std::vector<double>& coordinates() const { return plane_.coordinates; }
  const std::vector<std::size_t>& offsets() const { return plane_.offsets; }
  const Triangulation& planar() const { return planar_; }
  /// To be called when the locator in the plane has been made.
  void release();

  /// Returns the places of queries. Throws Error(input) for one that is not finite.
  std::vector<double> places(host::Runtime& runtime, const double* queries, std::size_t m) const;
  /// Makes points of the points and images that a locator in the plane has, so that it answers with these,
  /// and takes their values. own: where the locator's buffers come from. Before the release. Waits.
  void number_points(host::Runtime& runtime, host::Arena& own, locate::Locator& locator) const;
  /// Makes triangles of triangles in the plane.
  void number_triangles(std::vector<std::int32_t>& found) const;
  /// Throws Error(input) for a set with queries for natural neighbors in which a circle without points is
  /// wider than a period. The natural neighbors of a place in the box are corners of triangles whose circles
  /// contain it, and no circle without points is wider than the gap. So if the margin, or the period, is as
  /// wide, these circles are the same in the plane as on the torus. On a cylinder, circles can be wider whose
  /// centre is beyond an end. But at the end they are at most a period wide, since images of its point are
  /// that far apart, and between the ends less than there: so all these corners are at most a period away
  /// from the place.
  void check_gaps(const std::vector<std::size_t>& offsets) const;

 private:
  /// The number of the point at a place of the plane, or of which an image is there.
  std::int32_t number(std::int32_t v) const;

  periodic::Lattice lattice_;
  std::vector<std::size_t> point_offsets_;  // of the mesh
  std::vector<std::int32_t> visible_;       // with weights, the mesh's numbers of the plane's points
  std::vector<double> gaps_;                // by set, the width of the widest circle without points, or more
  periodic::Plane plane_;
  Triangulation planar_;
  std::vector<std::int32_t> triangles_;  // per triangle in the plane, that of the mesh
};

}  // namespace flaunay::call
