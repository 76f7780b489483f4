// Functions that calls for points on a sphere share, and the locator there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "flaunay/neighbors.hpp"
#include "space/spaces.hpp"
#include "space/sphere/places.hpp"
#include "space/sphere/plane.hpp"
#include "space/sphere/walk.hpp"

namespace flaunay::sphere {

/// See Triangulator::voronoi.
Voronoi make_dual(call::Implementation& self, const call::CellInput& input);
/// Per point the direction of the centroid of its cell: see Triangulator::relax. NaN for points that another
/// one represents, for a point alone, and for cells that are too small to have one. The mesh is one that a
/// call made. O(t).
std::vector<double> centroids(call::Implementation& self, const call::CellInput& input);

}  // namespace flaunay::sphere

namespace flaunay::call {

/// Throws Error(usage) for arrays that are not those of a triangulation on the sphere, and for places that no
/// call has made.
void check_on_sphere(const Triangulation& mesh);

/// Answers queries on the sphere, each in a turn. Set s of the triangulation has queries [offsets[s],
/// offsets[s + 1]). Members are virtual so that a linker leaves them out where nothing makes a locator.
class SphereLocator : public nearest::Tree {
 public:
  SphereLocator(Triangulator& used, const Triangulation& triangulation);
  // Members refer to others.
  SphereLocator(const SphereLocator&) = delete;
  SphereLocator& operator=(const SphereLocator&) = delete;
  void set_coordinates(SphereCoordinates coordinates) override;
  virtual std::vector<std::int32_t> locate(const double* queries, const std::vector<std::size_t>& offsets);
  virtual std::vector<std::int32_t> nearest(const double* queries, const std::vector<std::size_t>& offsets);
  virtual std::vector<double> interpolate(const double* values, const double* queries,
                                          const std::vector<std::size_t>& offsets,
                                          const InterpolationOptions& options);
  virtual std::vector<double> gradients(const double* values, std::size_t columns,
                                        const GradientOptions& options);
  /// For one set.
  virtual NaturalWeights natural_weights(const double* queries, std::size_t m, Interpolation method);
  /// For one set.
  Neighbors nearest(const double* queries, std::size_t m, const NeighborOptions& options) override;

 private:
  using Ids = std::vector<std::int32_t>;

  Ids starts(const std::vector<double>& places, const Ids& order, const std::vector<std::size_t>& offsets);
  template <typename T, typename Work>
  std::vector<T> answer(const double* queries, const std::vector<std::size_t>& offsets, std::size_t columns,
                        T none, const Work& work);

  std::shared_ptr<Implementation> owner_;
  Triangulation mesh_;
  SphereCoordinates coordinates_;  // of queries
  std::optional<sphere::Walker> walker_;
  sphere::Plane plane_;
  std::optional<Locator> locator_;  // in the plane
};

}  // namespace flaunay::call
