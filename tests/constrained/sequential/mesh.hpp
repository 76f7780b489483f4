// A triangulation into which constraint edges are inserted one by one.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/mesh.hpp"
#include "geometry/predicates.hpp"
#include "tests/constrained/sequential/polygon.hpp"

namespace flaunay::sequential {

/// The triangles that a segment crosses between two vertices on it, and what bounds them on its left and on
/// its right, both from the first vertex to the last one.
struct Cavity {
  struct Border {
    std::vector<std::int32_t> vertices;
    std::vector<std::int32_t> sides;  ///< the half-edges of the crossed triangles on it
  };
  std::vector<std::int32_t> rows;
  Border left, right;
};

/// How a segment leaves one of its ends: along an edge, to the vertex at its other end, or by crossing a
/// half-edge of a triangle at the end.
struct Departure {
  std::int32_t halfedge = -1;
  std::int32_t vertex = -1;  ///< -1 if it crosses
};

class ConstrainedMesh {
 public:
  /// delaunay: the canonical Delaunay triangulation of the points, with neighbours.
  ConstrainedMesh(const geometry::Predicates& predicates, const geometry::Point* points,
                  std::size_t point_count, const Triangulation& delaunay);

  /// Finds how the segment between two vertices leaves the first one.
  Departure depart_from(std::int32_t from, std::int32_t to) const;

  /// Follows the segment from a departure that crosses to the next vertex on it, and returns that. crossed:
  /// the constraints that it crosses are added. O(number of crossed edges).
  std::int32_t follow(std::int32_t from, std::int32_t to, std::int32_t halfedge, Cavity& cavity,
                      std::vector<std::int32_t>& crossed) const;

  /// Replaces the triangles of a cavity that crosses no constraints by those of the canonical triangulation
  /// with the edge from its first to its last vertex, which becomes a constraint.
  void retriangulate(const Cavity& cavity, std::int32_t constraint);

 private:
  class StarSearch;
  // A side of a cavity, with what is to be joined to the triangle inside of it.
  struct Side {
    std::int32_t twin, constraint;
    std::int32_t halfedge = -1;  // inside, new
  };

  void read_sides(const Cavity::Border& border);
  std::int32_t fill(const std::vector<std::int32_t>& chain, std::int32_t first_side, int step,
                    const std::int32_t*& row);
  std::int32_t put(std::int32_t row, std::int32_t a, std::int32_t b, std::int32_t c);
  void join(std::int32_t a, std::int32_t b);

  geometry::Predicates predicates_;
  const geometry::Point* points_;
  std::vector<std::int32_t> triangles_, twins_;
  std::vector<std::int32_t> constraints_;  // per half-edge
  std::vector<std::int32_t> out_;          // per vertex, a half-edge from it
  PolygonTriangulator polygons_;

  // Of retriangulate: sides of the left border, then of the right one; per half-edge the side, or -1.
  std::vector<Side> sides_;
  std::vector<std::int32_t> side_of_;
  std::vector<std::int32_t> chain_;
  struct Open {
    std::int32_t from, to, beyond;
  };
  std::vector<Open> open_;
};

}  // namespace flaunay::sequential
