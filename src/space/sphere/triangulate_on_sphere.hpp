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

namespace flaunay::call {

/// Throws Error(usage) for arrays that are not those of a triangulation on the sphere, and for places that no
/// call has made.
void check_on_sphere(const Triangulation& mesh);

/// Answers queries on the sphere.
class SphereLocator : public SpaceLocator {
 public:
  SphereLocator(Triangulator& used, const Triangulation& triangulation);
  void set_coordinates(SphereCoordinates coordinates) override;
  std::vector<std::int32_t> locate(const double* queries, std::size_t m) override;
  std::vector<std::int32_t> nearest(const double* queries, std::size_t m) override;
  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m,
                                  const InterpolationOptions& options) override;
  /// The options have been checked.
  Neighbors nearest(const double* queries, std::size_t m, const NeighborOptions& options);

 private:
  using Ids = std::vector<std::int32_t>;

  Ids starts(const std::vector<double>& places, const Ids& order);
  template <typename T, typename Work>
  std::vector<T> answer(const double* queries, std::size_t m, std::size_t columns, T none, const Work& work);
  std::int32_t nearest_of_two(sphere::Point query) const;
  sphere::Found find(sphere::Point query, std::int32_t start) const;
  std::int32_t find_nearest(sphere::Point query, std::int32_t start) const;

  std::shared_ptr<Implementation> owner_;
  Triangulation mesh_;
  SphereCoordinates coordinates_;  // of queries
  std::optional<sphere::Walker> walker_;
  sphere::Plane plane_;
  std::optional<Locator> locator_;  // in the plane; none if all points are at the south pole
};

}  // namespace flaunay::call
