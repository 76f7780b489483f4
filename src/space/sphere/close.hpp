// The triangles around the south pole, which a triangulation of places in the plane lacks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::sphere {

using geometry::Point;

/// The hull of one set of points in the plane.
struct PlanarSet {
  std::vector<std::int32_t> hull;  ///< its vertices, counter-clockwise; collinear points in their order
  std::vector<Point> places;       ///< of these
  std::int32_t pole;               ///< the point at the south pole, or -1
};

/// An edge that has a triangle on one side only. at: 3 t + the corner opposite, of triangle t.
struct OpenEdge {
  std::int32_t from, to, at;
};

/// The triangles of a set beyond its hull in the plane.
struct Cap {
  std::vector<std::array<std::int32_t, 3>> triangles;
  /// Triangle `beyond` is opposite to corner `at`, 3 t + k.
  struct Link {
    std::int32_t at, beyond;
  };
  std::vector<Link> links;  ///< among these, and between these and the plane's
};

/// Makes a cap. open: the edges of the hull. triangles: how many the set has in the plane, behind which those
/// of the cap are numbered. Expected O(h log h) for h vertices of the hull.
Cap close(const PlanarSet& set, std::vector<OpenEdge> open, std::size_t triangles);

}  // namespace flaunay::sphere
