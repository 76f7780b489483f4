// Meshes that are refined further: their borders as segments, and the triangles inside of these.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/constrained.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::constrained {

/// The triangles of Refinement::mesh, and the segments of a call with those that they need.
class GivenMesh {
 public:
  /// For n points. Throws Error(usage) for triangles of other points, and for options that a given mesh does
  /// not allow; Error(input), which names triangles, if triangles are flat or overlap.
  GivenMesh(const double* coordinates, std::size_t n, const Constraints& constraints,
            const ConstrainedOptions& options);
  // The arrays of the constraints are its own.
  GivenMesh(const GivenMesh&) = delete;
  GivenMesh& operator=(const GivenMesh&) = delete;

  const Constraints& constraints() const { return constraints_; }
  const ConstrainedOptions& options() const { return options_; }

  /// Leaves the triangles of a result of these constraints that the mesh covers, with its attributes.
  /// coordinates: of all points, those that splitting added, too. seeds: per triangle, or empty. Returns for
  /// each triangle that is left the area that it may have, 0 for any; nothing if there are no areas.
  std::vector<double> leave(const double* coordinates, ConstrainedTriangulation& result,
                            std::vector<std::int32_t>& seeds) const;

 private:
  using Ids = std::vector<std::int32_t>;

  void check(std::size_t n);
  void turn_left();
  void find_neighbors();
  void add_segments(const Constraints& constraints);
  Ids labels_of(const double* coordinates, const ConstrainedTriangulation& result) const;
  std::int32_t triangle_with(geometry::Point place, std::int32_t vertex) const;
  double area_for(const double* coordinates, const std::int32_t* corners) const;
  bool have_same_attributes(std::int32_t t, std::int32_t u) const {
    return given_.attributes == nullptr || given_.attributes[t] == given_.attributes[u];
  }
  geometry::Point point(const double* coordinates, std::int32_t v) const;

  GivenTriangles given_;
  ConstrainedOptions options_;
  Constraints constraints_;
  geometry::Scaling scaling_;
  std::vector<geometry::Point> points_;  // scaled
  Ids triangles_;                        // counter-clockwise
  Ids neighbors_;                        // opposite to each corner, or -1
  Ids first_corner_, corners_at_;        // of each point its corners in triangles
  // The arrays of the constraints, if there are some.
  Ids segments_, markers_;
  std::vector<std::uint8_t> kept_;
  Ids border_;  // per further segment: the corner opposite to it
};

}  // namespace flaunay::constrained
