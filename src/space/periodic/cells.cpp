#include "space/periodic/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "arithmetic/exact_arithmetic.h"
#include "derived/voronoi/mend.hpp"
#include "derived/voronoi/moments.hpp"
#include "geometry/arguments.hpp"
#include "geometry/for_each.hpp"
#include "space/periodic/torus.hpp"
#include "space/weighted/centre.hpp"

namespace flaunay::periodic {
namespace {

using geometry::for_each;
using geometry::Point;
using Ids = std::vector<std::int32_t>;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
std::int32_t turned(std::int32_t corner, int steps) { return corner - corner % 3 + (corner + steps) % 3; }

// a b' - a' b, with about an ulp's error.
double determinant(double a, double b, double a2, double b2) {
  const kernel::double2 first = kernel::two_product(a, b2), second = kernel::two_product(a2, b);
  return (first.x - second.x) + (first.y - second.y);
}

// Corners of triangles, 3 t + k, and what is around them.
class Corners {
 public:
  Corners(const Triangulation& mesh, const Lattice& lattice, const double* weights)
      : mesh_(mesh), lattice_(lattice), weights_(weights) {}

  std::int32_t point(std::int32_t c) const { return mesh_.triangles[index(c)]; }
  // The same point's corner in the next triangle, counter-clockwise; -1 if the arrays are no triangulation's.
  // A point can have several corners of a triangle, but an edge has other offsets than any other.
  std::int32_t next(std::int32_t c) const {
    const std::int32_t t = mesh_.neighbors[index(turned(c, 1))], end = turned(c, 2);
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t at = 3 * t + k, to = turned(at, 1);
      if (point(at) == point(c) && point(to) == point(end) && step(at, to, 0) == step(c, end, 0) &&
          step(at, to, 1) == step(c, end, 1))
        return at;
    }
    return -1;
  }
  // The centre of the corner's triangle, from which its corners have the same power, when the corner is at
  // its place, as seen from there.
  Point centre(std::int32_t c) const {
    const std::int32_t next = turned(c, 1), last = turned(c, 2);
    const Point a = seen(c, next), b = seen(c, last);
    if (!are_alike(c, next, last))
      return weighted::power_centre({0, 0}, a, b, {weight(c), weight(next), weight(last)});
    const double twice = 2 * determinant(a.x, a.y, b.x, b.y);
    const double a_square = a.x * a.x + a.y * a.y, b_square = b.x * b.x + b.y * b.y;
    return {determinant(a_square, a.y, b_square, b.y) / twice,
            determinant(a.x, a_square, b.x, b_square) / twice};
  }
  Point place(std::int32_t v) const { return {mesh_.places[2 * index(v)], mesh_.places[2 * index(v) + 1]}; }

 private:
  // So many vectors of the lattice from one corner of a triangle to another one.
  int step(std::int32_t from, std::int32_t to, std::size_t axis) const {
    return mesh_.corner_offsets[2 * index(to) + axis] - mesh_.corner_offsets[2 * index(from) + axis];
  }
  Point seen(std::int32_t from, std::int32_t to) const {
    const Point p = place(point(from)), q = place(point(to));
    return kernel::moved(q, step(from, to, 0), step(from, to, 1), &lattice_) - p;
  }

  double weight(std::int32_t c) const { return weights_[point(c)]; }
  bool are_alike(std::int32_t c, std::int32_t d, std::int32_t e) const {
    return weights_ == nullptr || (weight(c) == weight(d) && weight(d) == weight(e));
  }

  const Triangulation& mesh_;
  const Lattice& lattice_;
  const double* weights_;
};

}  // namespace

ClippedVoronoi make_cells(host::Runtime& runtime, const Triangulation& mesh, const double* weights) {
  const std::size_t n = mesh.places.size() / 2;
  ClippedVoronoi cells;
  cells.areas.assign(n, 0);
  cells.centroids.assign(2 * n, NAN);
  cells.offsets.assign(n + 1, 0);
  Ids first(n, -1);
  for (std::size_t c = mesh.triangles.size(); c-- > 0;) {
    ++cells.offsets[index(mesh.triangles[c]) + 1];
    first[index(mesh.triangles[c])] = static_cast<std::int32_t>(c);
  }
  std::partial_sum(cells.offsets.begin(), cells.offsets.end(), cells.offsets.begin());
  cells.vertices.resize(2 * mesh.triangles.size());
  const Lattice lattice = lattice_of(mesh.space.period);
  const Corners corners(mesh, lattice, weights);
  // Within the period and rounded to its units, so that images are exact and cells have the same corners.
  // From the first corner by place, whatever the order of the points.
  std::vector<Point> centres(mesh.triangles.size() / 3);
  for_each(runtime, centres.size(), [&](std::size_t t) {
    auto lowest = static_cast<std::int32_t>(3 * t);
    for (const std::int32_t c : {lowest + 1, lowest + 2}) {
      if (kernel::comes_before(corners.place(corners.point(c)), corners.place(corners.point(lowest))))
        lowest = c;
    }
    const Point p = corners.place(corners.point(lowest)), q = corners.centre(lowest);
    centres[t] = kernel::place_in({p.x + q.x, p.y + q.y}, &lattice);
  });
  // In the order of corners, those of a cell are near each other in memory.
  for_each(runtime, mesh.triangles.size(), [&](std::size_t at) {
    const auto begin = static_cast<std::int32_t>(at);
    const std::int32_t v = corners.point(begin);
    if (first[index(v)] != begin) return;
    const Point p = corners.place(v);
    std::vector<Point> polygon;
    std::int32_t c = begin;
    for (std::int32_t i = cells.offsets[index(v)]; i < cells.offsets[index(v) + 1] && c >= 0; ++i) {
      const Point q = corners.centre(c);
      polygon.push_back(q);
      const Point vertex = voronoi::image_near({p.x + q.x, p.y + q.y}, centres[index(c / 3)], lattice);
      cells.vertices[2 * index(i)] = vertex.x;
      cells.vertices[2 * index(i) + 1] = vertex.y;
      c = corners.next(c);
    }
    expect(c == begin, "the arrays are not those of a triangulation on a torus or a cylinder");
    const voronoi::Moments moments = voronoi::moments_of(polygon);
    cells.areas[index(v)] = moments.area;
    cells.centroids[2 * index(v)] = p.x + moments.centroid.x;
    cells.centroids[2 * index(v) + 1] = p.y + moments.centroid.y;
  });
  voronoi::Cells rounded{std::move(cells.offsets), std::move(cells.vertices)};
  voronoi::mend(runtime, mesh.point_offsets, mesh.places.data(), {}, lattice, rounded);
  cells.offsets = std::move(rounded.offsets);
  cells.vertices = std::move(rounded.vertices);
  return cells;
}

}  // namespace flaunay::periodic
