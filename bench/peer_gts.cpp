#include <gts.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>

#include "flaunay/flaunay.hpp"
#include "peer.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

struct Box {
  double left, bottom, side;
};

Box bounding_box(const io::Points& points) {
  double left = points.coordinates[0], right = left, bottom = points.coordinates[1], top = bottom;
  for (std::size_t i = 1; i < points.size(); ++i) {
    left = std::min(left, points.coordinates[2 * i]);
    right = std::max(right, points.coordinates[2 * i]);
    bottom = std::min(bottom, points.coordinates[2 * i + 1]);
    top = std::max(top, points.coordinates[2 * i + 1]);
  }
  return {left, bottom, std::max(std::max(right - left, top - bottom), 1e-300)};
}

/// Where on a Hilbert curve of 2^20 steps a side through the box the point lies.
std::uint64_t hilbert_place(const Box& box, double px, double py) {
  constexpr int kBits = 20;
  constexpr double kCells = (1 << kBits) - 1;
  auto x = static_cast<std::uint32_t>(kCells * ((px - box.left) / box.side));
  auto y = static_cast<std::uint32_t>(kCells * ((py - box.bottom) / box.side));
  std::uint64_t place = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    const std::uint32_t in_x = x >> bit & 1, in_y = y >> bit & 1;
    place = place << 2 | ((3 * in_x) ^ in_y);
    if (in_y == 0) {
      if (in_x == 1) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

/// Random rounds, each twice as large as the one before and sorted along the curve. Random, so that the
/// expected number of flips is linear; along the curve, so that each point is near the one before.
std::vector<std::size_t> insertion_order(const io::Points& points) {
  constexpr std::size_t kFirstRound = 64;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937_64(1));
  const Box box = bounding_box(points);
  std::vector<std::uint64_t> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i] = hilbert_place(box, points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    last = std::min(order.size(), std::max(kFirstRound, 2 * first));
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first),
              order.begin() + static_cast<std::ptrdiff_t>(last),
              [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
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

void insert_all(const io::Points& points, GtsSurface* surface) {
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

}  // namespace

PeerRun run_gts(const io::Points& points) {
  if (points.size() == 0) return {0, 0};
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

}  // namespace flaunay::bench
