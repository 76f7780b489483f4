// Guibas and Stolfi's divide and conquer (ACM Transactions on Graphics 4, 1985) with Dwyer's alternating cuts
// (Algorithmica 2, 1987). The merge is that of the kernels (mesh/rings.h), compiled as C++.
//
// Points are numbered again, as vertices, in the order of the leaves of the recursion, so that the vertices
// of a merge are near each other in memory. A merge across the cut y = q is a merge across x = q in the
// coordinates (s, u) = (y, -x): only the order of the points differs, which is that of (s, u).
#include "modes/dwyer/dwyer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "geometry/sort.hpp"
#include "mesh/limits.h"
#include "statistics/counter.hpp"

// Among edges of cocircular points, the merge keeps those that it meets first. geometry::finish makes the
// canonical result.
#define RINGS_TIE(a, b, c, d, bounds) 0
#include "mesh/rings.h"

namespace flaunay::dwyer {
using namespace geometry;
using namespace statistics;

namespace {

enum Axis { kX = 0, kY = 1 };
constexpr Axis other(Axis axis) { return axis == kX ? kY : kX; }

// The ranks of a point in the orders of (x, y) and (y, -x).
struct Ranks {
  std::int32_t along[2];
};

class Builder {
 public:
  /// work: if not null, the work is added to it.
  Builder(const Predicates& predicates, const Point* points, std::size_t n, Work* work)
      : points_(points),
        n_(static_cast<std::int32_t>(n)),
        work_(work),
        vertices_(new Point[n]),
        vertex_edge_(new std::int32_t[n]),
        edges_(new kernel::ring_edge[kernel::EDGES_PER_VERTEX * n]),
        scratch_(new Ranks[n]),
        rings_(kernel::rings_on(edges_.get(), vertices_.get(), vertex_edge_.get(), predicates.bounds)) {
    for (std::unique_ptr<Ranks[]>& order : orders_) order.reset(new Ranks[n]);
    rings_.unused = 0;
  }

  Mesh run() {
    if (n_ < 3) return {};
    sort();
    return extract(solve(0, n_, kX, 0).first_x);
  }

 private:
  // Ids are ranks in the order of (x, y).
  void sort() {
    std::vector<Keyed> by_y(n_);
    for (std::int32_t i = 0; i < n_; ++i) {
      const std::int32_t id = n_ - 1 - i;  // for equal y, the larger x comes first, as u = -x
      by_y[i] = {sort_key(points_[id].y), id};
    }
    sort_by_key(by_y);
    for (std::int32_t rank = 0; rank < n_; ++rank) {
      const Ranks ranks{{by_y[rank].index, rank}};
      orders_[kY][rank] = orders_[kX][ranks.along[kX]] = ranks;
    }
    if (work_ != nullptr) {
      OperationCounts counts;
      counts.arithmetic = comparisons_to_sort(n_);
      counts.critical_path = depth_of_sort(n_);
      add_beside(part_of(work_->start, Component::cut), counts);
    }
  }

  // Computes the Delaunay triangulation of vertices begin..end-1, cut across the axis if there are more than
  // three. orders_[axis][begin..end) has their ranks in the order of the axis, for both axes.
  kernel::hull_ends solve(std::int32_t begin, std::int32_t end, Axis axis, std::size_t depth) {
    if (end - begin <= 3) return leaf(begin, end, depth);
    const std::int32_t middle = begin + (end - begin) / 2;
    cut(begin, middle, end, axis, depth);
    const kernel::hull_ends low = solve(begin, middle, other(axis), depth + 1);
    const kernel::hull_ends high = solve(middle, end, other(axis), depth + 1);
    CLEAR_TALLY(rings_);
    const kernel::hull_ends ends = kernel::merge_triangulations(&rings_, low, high, axis);
    record_node(2, depth);  // two comparisons for the ends
    return ends;
  }

  // Records comparisons, and the operations that the rings have counted since their counters were 0.
  void record_node(std::uint64_t comparisons, std::size_t depth) {
    if (work_ == nullptr) return;
    OperationCounts counts;
    counts.arithmetic = comparisons;
    counts.orientations = rings_.counted.orientations;
    counts.circles = rings_.counted.circles;
    counts.critical_path = counts.operations();
    record(depth, Component::merge, counts);
  }

  void record(std::size_t depth, Component component, const OperationCounts& counts) {
    if (work_->levels.size() <= depth) work_->levels.resize(depth + 1);
    add_beside(part_of(work_->levels[depth], component), counts);
  }

  // Splits both orders: that of the axis by position, the other one by a stable split.
  void cut(std::int32_t begin, std::int32_t middle, std::int32_t end, Axis axis, std::size_t depth) {
    const std::int32_t threshold = orders_[axis][middle].along[axis];
    Ranks* const order = orders_[other(axis)].get();
    Ranks* const above = scratch_.get();
    std::int32_t low = begin, high = 0;
    for (std::int32_t i = begin; i < end; ++i) {
      const Ranks ranks = order[i];
      const bool is_low = ranks.along[axis] < threshold;
      order[low] = ranks;  // low <= i
      above[high] = ranks;
      low += is_low;
      high += !is_low;
    }
    std::copy(above, above + high, order + low);
    if (work_ != nullptr) {
      OperationCounts counts;
      counts.arithmetic = end - begin;
      counts.critical_path = 1 + 2 * log2_ceiling(end - begin);
      record(depth, Component::cut, counts);
    }
  }

  // Triangulates two or three vertices, which are in the order of x.
  kernel::hull_ends leaf(std::int32_t begin, std::int32_t end, std::size_t depth) {
    std::int32_t first_y = begin, last_y = begin;
    for (std::int32_t v = begin; v < end; ++v) {
      const Ranks ranks = orders_[kX][v];
      vertices_[v] = points_[ranks.along[kX]];
      if (ranks.along[kY] < orders_[kX][first_y].along[kY]) first_y = v;
      if (ranks.along[kY] > orders_[kX][last_y].along[kY]) last_y = v;
    }
    CLEAR_TALLY(rings_);
    const std::int32_t a = kernel::make_edge(&rings_, begin, begin + 1);
    vertex_edge_[begin] = a;
    vertex_edge_[begin + 1] = a ^ 1;
    if (end - begin == 3) triangle(a, begin);
    record_node(end - begin == 2 ? 1 : 3, depth);
    return kernel::ends_of(begin, end - 1, first_y, last_y);
  }

  // Adds the third vertex of a leaf, whose first two vertices are joined by edge a.
  void triangle(std::int32_t a, std::int32_t first) {
    kernel::rings* const g = &rings_;
    const std::int32_t b = kernel::make_edge(g, first + 1, first + 2);
    kernel::insert_after(g, b, a ^ 1);
    vertex_edge_[first + 2] = b ^ 1;
    const bool left = kernel::turns_left(g, vertices_[first], vertices_[first + 1], vertices_[first + 2]);
    if (!left && !kernel::turns_left(g, vertices_[first], vertices_[first + 2], vertices_[first + 1])) return;
    const std::int32_t c = kernel::make_edge(g, first + 2, first);
    kernel::insert_after(g, c, b ^ 1);
    kernel::insert_after(g, c ^ 1, a);
    if (left) {
      vertex_edge_[first + 1] = b;
      vertex_edge_[first + 2] = c;
    } else {
      vertex_edge_[first] = c ^ 1;
    }
  }

  // Returns the triangles left of all edges except those whose left side is outside of the hull. corner: a
  // vertex of the hull.
  Mesh extract(std::int32_t corner) const {
    constexpr std::int32_t kOutside = -1, kUnseen = -2;
    const std::int32_t used = rings_.unused;
    std::vector<std::int32_t> halfedges(used, kUnseen);
    const std::int32_t start = vertex_edge_[corner];
    std::int32_t e = start;
    std::size_t sides = used;
    do {
      halfedges[e ^ 1] = kOutside;
      --sides;
      e = edges_[e ^ 1].next;
    } while (e != start);
    for (std::int32_t free = rings_.free_first; free != kernel::NO_EDGE; free = edges_[free].next) sides -= 2;

    Mesh mesh;
    mesh.triangles.resize(sides);
    mesh.twins.resize(sides);
    std::int32_t count = 0;
    for (std::int32_t seed = 0; seed < used; ++seed) {
      if (edges_[seed].to == kernel::NO_VERTEX || halfedges[seed] != kUnseen) continue;
      e = seed;
      for (int k = 0; k < 3; ++k) {
        halfedges[e] = count;
        mesh.triangles[count++] = orders_[kX][edges_[e ^ 1].to].along[kX];
        e = edges_[e ^ 1].previous;
      }
    }
    for (std::int32_t f = 0; f < used; ++f) {
      if (halfedges[f] >= 0) mesh.twins[halfedges[f]] = halfedges[f ^ 1];
    }
    return mesh;
  }

  const Point* const points_;
  const std::int32_t n_;
  Work* const work_;
  std::unique_ptr<Ranks[]> orders_[2];
  const std::unique_ptr<Point[]> vertices_;
  // One edge that leaves each vertex. For strict corners of a node's hull, it is the next edge of the hull,
  // counter-clockwise.
  const std::unique_ptr<std::int32_t[]> vertex_edge_;
  const std::unique_ptr<kernel::ring_edge[]> edges_;
  const std::unique_ptr<Ranks[]> scratch_;
  kernel::rings rings_;  // refers to these arrays
};

void append_set(Mesh&& set, std::int32_t first_id, Mesh& all) {
  if (all.triangles.empty() && first_id == 0) {
    all = std::move(set);
    return;
  }
  const auto first_halfedge = static_cast<std::int32_t>(all.triangles.size());
  for (const std::int32_t position : set.triangles) all.triangles.push_back(position + first_id);
  for (const std::int32_t twin : set.twins) all.twins.push_back(twin < 0 ? -1 : twin + first_halfedge);
}

}  // namespace

Mesh triangulate(const Predicates& predicates, const Point* points, std::size_t n, Work* work) {
  return Builder(predicates, points, n, work).run();
}

Mesh run(const PointSets& sets, const research::Options& options, const statistics::Phases& phases,
         research::Triangulation& result) {
  research::Work* const work = options.count ? &result.work : nullptr;
  Mesh all;
  const std::size_t count = sets.set_offsets.size() - 1;
  for (std::size_t s = 0; s < count; ++s) {
    const std::int32_t first = sets.set_offsets[s];
    append_set(
        triangulate(sets.predicates, sets.points.data() + first, sets.set_offsets[s + 1] - first, work),
        first, all);
    phases.progress("triangulate", statistics::kSorted + (statistics::kTriangulated - statistics::kSorted) *
                                                             static_cast<double>(s + 1) /
                                                             static_cast<double>(count));
  }
  return all;
}

}  // namespace flaunay::dwyer
