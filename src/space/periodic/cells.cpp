// Voronoi cells on a torus.
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "arithmetic/exact_arithmetic.h"
#include "derived/voronoi/mend.hpp"
#include "derived/voronoi/moments.hpp"
#include "derived/voronoi/stars.hpp"
#include "geometry/arguments.hpp"
#include "space/periodic/torus.hpp"
#include "space/periodic/triangulate_on_torus.hpp"
#include "space/triangulate.hpp"
#include "space/weighted/centre.hpp"

namespace flaunay::periodic {
namespace {

using geometry::Point;
using mesh::next_corner;
using voronoi::Stars;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

// a b' - a' b, with about an ulp's error.
double determinant(double a, double b, double a2, double b2) {
  const kernel::double2 first = kernel::two_product(a, b2), second = kernel::two_product(a2, b);
  return (first.x - second.x) + (first.y - second.y);
}

// The centres of triangles, as seen from their corners.
class Views {
 public:
  Views(const Triangulation& mesh, const Stars& stars, const Lattice& lattice, const double* weights)
      : mesh_(mesh), stars_(stars), lattice_(lattice), weights_(weights) {}

  Point place(std::int32_t c) const {
    const std::size_t v = index(stars_.point(c));
    return {mesh_.places[2 * v], mesh_.places[2 * v + 1]};
  }
  // The centre of the corner's triangle, from which its corners have the same power, when the corner is at
  // its place, as seen from there.
  Point centre(std::int32_t c) const {
    const std::int32_t next = next_corner(c), last = next_corner(next);
    const Point a = seen(c, next), b = seen(c, last);
    if (!are_alike(c, next, last))
      return weighted::power_centre({0, 0}, a, b, {weight(c), weight(next), weight(last)});
    const double twice = 2 * determinant(a.x, a.y, b.x, b.y);
    const double a_square = a.x * a.x + a.y * a.y, b_square = b.x * b.x + b.y * b.y;
    return {determinant(a_square, a.y, b_square, b.y) / twice,
            determinant(a.x, a_square, b.x, b_square) / twice};
  }

 private:
  Point seen(std::int32_t from, std::int32_t to) const {
    return kernel::moved(place(to), stars_.step(from, to, 0), stars_.step(from, to, 1), &lattice_) -
           place(from);
  }
  double weight(std::int32_t c) const { return weights_[stars_.point(c)]; }
  bool are_alike(std::int32_t c, std::int32_t d, std::int32_t e) const {
    return weights_ == nullptr || (weight(c) == weight(d) && weight(d) == weight(e));
  }

  const Triangulation& mesh_;
  const Stars& stars_;
  const Lattice& lattice_;
  const double* weights_;
};

}  // namespace

void check_cells(const Space& space) {
  call::check(space.period);
  expect(std::isfinite(space.period.x) && std::isfinite(space.period.y), "cells on a cylinder have no end");
}

ClippedVoronoi make_cells(call::Implementation& self, const call::CellInput& input) {
  const Triangulation& mesh = input.mesh;
  const double* const weights = input.space.weights;
  call::check_with_places(mesh);
  check_cells(mesh.space);
  expect(weights != nullptr || !call::has_weights(mesh), "cells of points with weights need these");
  host::Runtime& runtime = self.native().runtime;
  const std::size_t n = mesh.places.size() / 2;
  const Stars stars(mesh, n);
  const Lattice lattice = lattice_of(mesh.space.period);
  const Views views(mesh, stars, lattice, weights);
  const auto fetch = [&](std::size_t v) { kernel::fetch(&mesh.places[2 * v]); };
  // Within the period and rounded to its units, so that images are exact and cells have the same corners.
  // From the first corner by place, whatever the order of the points.
  std::vector<Point> centres(mesh.triangles.size() / 3);
  voronoi::for_each_triangle(runtime, mesh, fetch, [&](std::size_t t) {
    auto lowest = static_cast<std::int32_t>(3 * t);
    for (const std::int32_t c : {lowest + 1, lowest + 2}) {
      if (kernel::comes_before(views.place(c), views.place(lowest))) lowest = c;
    }
    const Point p = views.place(lowest), q = views.centre(lowest);
    centres[t] = kernel::place_in({p.x + q.x, p.y + q.y}, &lattice);
  });
  ClippedVoronoi cells;
  cells.areas.assign(n, 0);
  cells.centroids.assign(2 * n, NAN);
  voronoi::Cells rounded{stars.offsets(), std::vector<double>(2 * mesh.triangles.size())};
  stars.for_each(runtime, fetch, [&](std::int32_t v, std::int32_t first) {
    const Point p = views.place(first);
    std::vector<Point> polygon;
    std::int32_t c = first;
    for (std::int32_t i = rounded.offsets[index(v)]; i < rounded.offsets[index(v) + 1] && c >= 0; ++i) {
      const Point q = views.centre(c);
      polygon.push_back(q);
      const Point vertex = voronoi::image_near({p.x + q.x, p.y + q.y}, centres[index(c / 3)], lattice);
      rounded.vertices[2 * index(i)] = vertex.x;
      rounded.vertices[2 * index(i) + 1] = vertex.y;
      c = stars.next(c);
    }
    expect(c == first, "the arrays are not those of a triangulation on a torus or a cylinder");
    const voronoi::Moments moments = voronoi::moments_of(polygon);
    cells.areas[index(v)] = moments.area;
    cells.centroids[2 * index(v)] = p.x + moments.centroid.x;
    cells.centroids[2 * index(v) + 1] = p.y + moments.centroid.y;
  });
  voronoi::mend(runtime, mesh.point_offsets, mesh.places.data(), {}, lattice, rounded);
  cells.offsets = std::move(rounded.offsets);
  cells.vertices = std::move(rounded.vertices);
  return cells;
}

}  // namespace flaunay::periodic
