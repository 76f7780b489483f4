#include <gts.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

struct Box {
  double left, bottom, side;
};

Box bounding_box(const Input& points) {
  double left = points.coordinates[0], right = left, bottom = points.coordinates[1], top = bottom;
  for (std::size_t i = 1; i < points.n; ++i) {
    left = std::min(left, points.coordinates[2 * i]);
    right = std::max(right, points.coordinates[2 * i]);
    bottom = std::min(bottom, points.coordinates[2 * i + 1]);
    top = std::max(top, points.coordinates[2 * i + 1]);
  }
  return {left, bottom, std::max(std::max(right - left, top - bottom), 1e-300)};
}

using Order = std::vector<std::size_t>::iterator;

/// Sorts indices of points along a Hilbert curve that halves their number instead of the plane, so that dense
/// places have as many steps of their own as others. axis: the one that is halved first; up, other_up:
/// whether the curve begins at small coordinates of it and of the other one.
void sort_by_hilbert(const Input& points, Order first, Order last, std::size_t axis = 0, bool up = true,
                     bool other_up = true) {
  constexpr std::ptrdiff_t kFew = 4;
  if (last - first <= kFew) return;
  const auto halve = [&](Order begin, Order end, std::size_t of, bool ascending) {
    const Order middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](std::size_t a, std::size_t b) {
      if (!ascending) std::swap(a, b);
      return points.coordinates[2 * a + of] < points.coordinates[2 * b + of];
    });
    return middle;
  };
  const Order middle = halve(first, last, axis, up);
  const Order quarter = halve(first, middle, 1 - axis, other_up);
  const Order three_quarters = halve(middle, last, 1 - axis, !other_up);
  sort_by_hilbert(points, first, quarter, 1 - axis, other_up, up);
  sort_by_hilbert(points, quarter, middle, axis, up, other_up);
  sort_by_hilbert(points, middle, three_quarters, axis, up, other_up);
  sort_by_hilbert(points, three_quarters, last, 1 - axis, !other_up, !up);
}

/// Random rounds, each twice as large as the one before and sorted along the curve. Random, so that the
/// expected number of flips is linear; along the curve, so that each point is near the one before.
std::vector<std::size_t> insertion_order(const Input& points) {
  constexpr std::size_t kFirstRound = 64;
  std::vector<std::size_t> order(points.n);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    last = std::min(order.size(), std::max(kFirstRound, 2 * first));
    sort_by_hilbert(points, order.begin() + static_cast<std::ptrdiff_t>(first),
                    order.begin() + static_cast<std::ptrdiff_t>(last));
  }
  return order;
}

/// A triangle so far out that no circle of three points that matters reaches its corners.
GtsFace* enclosing_face(const Box& box) {
  constexpr double kFar = 1e10;
  const double far = kFar * box.side, x = box.left + box.side / 2, y = box.bottom + box.side / 2;
  GtsVertex* corners[] = {gts_vertex_new(gts_vertex_class(), x - 2 * far, y - far, 0),
                          gts_vertex_new(gts_vertex_class(), x + 2 * far, y - far, 0),
                          gts_vertex_new(gts_vertex_class(), x, y + 2 * far, 0)};
  GtsEdge* edges[3];
  for (int k = 0; k < 3; ++k) edges[k] = gts_edge_new(gts_edge_class(), corners[k], corners[(k + 1) % 3]);
  return gts_face_new(gts_face_class(), edges[0], edges[1], edges[2]);
}

/// A face at the vertex, from where to look for the next.
GtsFace* face_at(GtsVertex* vertex, GtsSurface* surface) {
  for (GSList* item = vertex->segments; item != nullptr; item = item->next) {
    if (!GTS_IS_EDGE(item->data)) continue;
    if (GtsFace* face = gts_edge_has_parent_surface(GTS_EDGE(item->data), surface)) return face;
  }
  return nullptr;
}

void insert_all(const Input& points, GtsSurface* surface) {
  GtsFace* near = nullptr;
  for (const std::size_t i : insertion_order(points)) {
    GtsVertex* vertex =
        gts_vertex_new(gts_vertex_class(), points.coordinates[2 * i], points.coordinates[2 * i + 1], 0);
    // GTS gives back a vertex that could not be added, and null for one that was.
    if (gts_delaunay_add_vertex(surface, vertex, near) != nullptr) {
      gts_object_destroy(GTS_OBJECT(vertex));  // a duplicate
    } else {
      near = face_at(vertex, surface);
    }
  }
}

Outcome run_gts(const Input& points) {
  if (points.n == 0) return {0, 0};
  const Stopwatch watch;
  GtsSurface* surface =
      gts_surface_new(gts_surface_class(), gts_face_class(), gts_edge_class(), gts_vertex_class());
  GtsFace* enclosing = enclosing_face(bounding_box(points));
  GtsVertex* corners[3];
  gts_triangle_vertices(GTS_TRIANGLE(enclosing), &corners[0], &corners[1], &corners[2]);
  gts_surface_add_face(surface, enclosing);
  insert_all(points, surface);
  // With a corner go its edges, and with those their faces.
  for (GtsVertex* corner : corners) gts_object_destroy(GTS_OBJECT(corner));
  const double seconds = watch.seconds();
  const std::size_t triangles = gts_surface_face_number(surface);
  gts_object_destroy(GTS_OBJECT(surface));
  return {seconds, triangles};
}

const BuiltPeer kBuilt("gts", run_gts);

}  // namespace
}  // namespace flaunay::bench
