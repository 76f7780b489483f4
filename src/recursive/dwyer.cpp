// Guibas and Stolfi's divide and conquer (ACM Transactions on Graphics 4, 1985) with Dwyer's alternating cuts
// (Algorithmica 2, 1987).
//
// Points are numbered anew, as vertices, in the order of the leaves of the recursion, so that what a merge
// touches lies together in memory. A merge across the cut y = q is a merge across x = q in the frame
// (s, u) = (y, -x): only the order of the points along the axis differs, which is by (s, u).
#include "recursive/dwyer.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "recursive/counter.hpp"
#include "recursive/sort.hpp"

namespace flaunay::recursive {
namespace {

// What one node of the recursion does.
template <bool kCounting>
struct NodeCounts {
  void comparison(std::uint64_t) {}
  void orientation() {}
  void circle() {}
};

template <>
struct NodeCounts<true> {
  OperationCounts counts;
  void comparison(std::uint64_t n) { counts.arithmetic += n; }
  void orientation() { ++counts.orientations; }
  void circle() { ++counts.circles; }
};

OperationCounts& of(Work::Components& components, Component component) {
  return components[static_cast<std::size_t>(component)];
}

// Nodes of a level work at the same time: their counts add up, the longest path is the level's.
void add(OperationCounts& level, OperationCounts node, std::uint64_t critical_path) {
  node.critical_path = critical_path;
  add_beside(level, node);
}

// Directed edges out of each vertex in a ring; edge e and its reverse e ^ 1 (quad-edges without the dual).
struct Edge {
  std::int32_t to;        // destination, or kFree
  std::int32_t next;      // counter-clockwise about the origin; of a free edge the next free one
  std::int32_t previous;  // clockwise
};
constexpr std::int32_t kFree = -1;
constexpr std::int32_t kNone = -1;

enum Axis { kX = 0, kY = 1 };
constexpr Axis other(Axis axis) { return axis == kX ? kY : kX; }

// A point's places in the orders (x, y) and (y, -x).
struct Ranks {
  std::int32_t along[2];
};

// The first and last vertices of a node along each axis. They are corners of its hull, strictly convex.
struct Extremes {
  std::int32_t first[2];
  std::int32_t last[2];
};

template <bool kCounting>
class Builder {
 public:
  Builder(const Predicates& predicates, const Point* points, std::size_t n, Work* work)
      : bounds_(predicates.bounds),
        points_(points),
        n_(static_cast<std::int32_t>(n)),
        work_(work),
        vertices_(new Point[n]),
        hull_edge_(new std::int32_t[n]),
        edges_(new Edge[6 * n]),
        scratch_(new Ranks[n]) {
    for (std::unique_ptr<Ranks[]>& order : orders_) order.reset(new Ranks[n]);
  }

  Mesh run() {
    if (n_ < 3) return {};
    sort();
    const Extremes extremes = solve(0, n_, kX, 0);
    return extract(extremes.first[kX]);
  }

 private:
  using Counts = NodeCounts<kCounting>;

  // Ids are ranks in (x, y).
  void sort() {
    std::vector<Keyed> by_y(n_);
    for (std::int32_t i = 0; i < n_; ++i) {
      const std::int32_t id = n_ - 1 - i;  // of equal y, the larger x comes first: the smaller u
      by_y[i] = {sort_key(points_[id].y), id};
    }
    sort_by_key(by_y);
    for (std::int32_t rank = 0; rank < n_; ++rank) {
      const Ranks ranks{{by_y[rank].index, rank}};
      orders_[kY][rank] = orders_[kX][ranks.along[kX]] = ranks;
    }
    if constexpr (kCounting) {
      OperationCounts counts;
      counts.arithmetic = comparisons_to_sort(n_);
      add(of(work_->start, Component::cut), counts, depth_of_sort(n_));
    }
  }

  // The Delaunay triangulation of vertices begin..end-1, cut across the axis if they are more than three.
  // Their ranks are in orders_[axis][begin..end), each in its order.
  Extremes solve(std::int32_t begin, std::int32_t end, Axis axis, std::size_t depth) {
    Counts counts;
    Extremes extremes;
    if (end - begin <= 3) {
      extremes = leaf(begin, end, counts);
    } else {
      const std::int32_t middle = begin + (end - begin) / 2;
      cut(begin, middle, end, axis, depth);
      const Extremes low = solve(begin, middle, other(axis), depth + 1);
      const Extremes high = solve(middle, end, other(axis), depth + 1);
      merge(low.last[axis], high.first[axis], counts);
      extremes = joined(low, high, axis, counts);
    }
    if constexpr (kCounting) record(depth, Component::merge, counts.counts, counts.counts.operations());
    return extremes;
  }

  void record(std::size_t depth, Component component, const OperationCounts& counts,
              std::uint64_t critical_path) {
    if (work_->levels.size() <= depth) work_->levels.resize(depth + 1);
    add(of(work_->levels[depth], component), counts, critical_path);
  }

  // The order along the axis falls apart by position, the other one by a stable split.
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
    if constexpr (kCounting) {
      OperationCounts counts;
      counts.arithmetic = end - begin;
      record(depth, Component::cut, counts, 1 + 2 * log2_ceiling(end - begin));
    }
  }

  Extremes joined(const Extremes& low, const Extremes& high, Axis axis, Counts& counts) const {
    const Axis along = other(axis);
    const auto rank = [&](std::int32_t vertex) { return orders_[kX][vertex].along[along]; };
    Extremes extremes;
    extremes.first[axis] = low.first[axis];
    extremes.last[axis] = high.last[axis];
    extremes.first[along] =
        rank(low.first[along]) < rank(high.first[along]) ? low.first[along] : high.first[along];
    extremes.last[along] =
        rank(low.last[along]) > rank(high.last[along]) ? low.last[along] : high.last[along];
    counts.comparison(2);
    return extremes;
  }

  // Two or three vertices, in the order of x.
  Extremes leaf(std::int32_t begin, std::int32_t end, Counts& counts) {
    Extremes extremes{{begin, begin}, {end - 1, begin}};
    for (std::int32_t v = begin; v < end; ++v) {
      const Ranks ranks = orders_[kX][v];
      vertices_[v] = points_[ranks.along[kX]];
      if (ranks.along[kY] < orders_[kX][extremes.first[kY]].along[kY]) extremes.first[kY] = v;
      if (ranks.along[kY] > orders_[kX][extremes.last[kY]].along[kY]) extremes.last[kY] = v;
    }
    counts.comparison(end - begin == 2 ? 1 : 3);
    const std::int32_t a = make_edge(begin, begin + 1);
    hull_edge_[begin] = a;
    hull_edge_[begin + 1] = a ^ 1;
    if (end - begin == 3) triangle(a, begin, counts);
    return extremes;
  }

  // The third vertex of a leaf, whose first two are joined by edge a.
  void triangle(std::int32_t a, std::int32_t first, Counts& counts) {
    const std::int32_t b = make_edge(first + 1, first + 2);
    insert_after(b, a ^ 1);
    hull_edge_[first + 2] = b ^ 1;
    const bool left = turns_left(vertices_[first], vertices_[first + 1], vertices_[first + 2], counts);
    if (!left && !turns_left(vertices_[first], vertices_[first + 2], vertices_[first + 1], counts)) return;
    const std::int32_t c = make_edge(first + 2, first);
    insert_after(c, b ^ 1);
    insert_after(c ^ 1, a);
    if (left) {
      hull_edge_[first + 1] = b;
      hull_edge_[first + 2] = c;
    } else {
      hull_edge_[first] = c ^ 1;
    }
  }

  // Guibas and Stolfi's merge of two triangulations that the cut separates, named as if it were vertical.
  // Given are the last vertex of the left one and the first of the right one.
  void merge(std::int32_t left_last, std::int32_t right_first, Counts& counts) {
    std::int32_t base =
        lower_tangent(edges_[hull_edge_[left_last]].previous, hull_edge_[right_first], counts);
    std::int32_t left = edges_[base].to, right = edges_[base ^ 1].to;
    hull_edge_[left] = base ^ 1;
    Point left_point = vertices_[left], right_point = vertices_[right];
    while (true) {
      // Either side's candidate: the next edge that rises above the base, but for those that its circle
      // rules out.
      std::int32_t left_edge = edges_[base ^ 1].next, right_edge = edges_[base].previous;
      Point left_apex = vertices_[edges_[left_edge].to], right_apex = vertices_[edges_[right_edge].to];
      const bool left_rises = turns_left(left_apex, left_point, right_point, counts);
      const bool right_rises = turns_left(right_apex, left_point, right_point, counts);
      if (!left_rises && !right_rises) break;
      if (left_rises) {
        for (std::int32_t then = edges_[left_edge].next; then != (base ^ 1); then = edges_[left_edge].next) {
          const Point beyond = vertices_[edges_[then].to];
          if (!in_circle(left_point, right_point, left_apex, beyond, counts)) break;
          remove(left_edge);
          left_edge = then;
          left_apex = beyond;
        }
      }
      if (right_rises) {
        for (std::int32_t then = edges_[right_edge].previous; then != base;
             then = edges_[right_edge].previous) {
          const Point beyond = vertices_[edges_[then].to];
          if (!in_circle(left_point, right_point, right_apex, beyond, counts)) break;
          remove(right_edge);
          right_edge = then;
          right_apex = beyond;
        }
      }
      const bool take_right =
          !left_rises || (right_rises && in_circle(left_point, right_point, left_apex, right_apex, counts));
      if (take_right) {
        right = edges_[right_edge].to;
        right_point = right_apex;
        const std::int32_t crossing = make_edge(right, left);
        insert_before(crossing, right_edge ^ 1);
        insert_after(crossing ^ 1, base ^ 1);
        base = crossing;
      } else {
        left = edges_[left_edge].to;
        left_point = left_apex;
        const std::int32_t crossing = make_edge(right, left);
        insert_before(crossing, base);
        insert_after(crossing ^ 1, left_edge ^ 1);
        base = crossing;
      }
    }
    hull_edge_[right] = base;
  }

  // An edge from the right triangulation to the left one that has both above it. Given are the clockwise hull
  // edge out of the left one's last vertex and the counter-clockwise one out of the right one's first.
  std::int32_t lower_tangent(std::int32_t left_edge, std::int32_t right_edge, Counts& counts) {
    std::int32_t left = edges_[left_edge ^ 1].to, right = edges_[right_edge ^ 1].to;
    while (true) {
      if (turns_left(vertices_[right], vertices_[left], vertices_[edges_[left_edge].to], counts)) {
        left = edges_[left_edge].to;
        left_edge = edges_[left_edge ^ 1].previous;
      } else if (turns_left(vertices_[left], vertices_[edges_[right_edge].to], vertices_[right], counts)) {
        right = edges_[right_edge].to;
        right_edge = edges_[right_edge ^ 1].next;
      } else {
        break;
      }
    }
    const std::int32_t base = make_edge(right, left);
    insert_before(base, right_edge);
    insert_after(base ^ 1, left_edge);
    return base;
  }

  bool turns_left(Point a, Point b, Point c, Counts& counts) const {
    counts.orientation();
    return kernel::orient_sign(a, b, c, bounds_.orient) > 0;
  }

  // Is d inside of the circle through a, b, c (counter-clockwise)?
  bool in_circle(Point a, Point b, Point c, Point d, Counts& counts) const {
    counts.circle();
    return kernel::circle_sign(a, b, c, d, bounds_.circle) > 0;
  }

  std::int32_t make_edge(std::int32_t from, std::int32_t to) {
    std::int32_t e = free_;
    if (e == kNone) {
      e = used_;
      used_ += 2;
    } else {
      free_ = edges_[e].next;
    }
    edges_[e] = {to, e, e};
    edges_[e ^ 1] = {from, e ^ 1, e ^ 1};
    return e;
  }

  // Puts edge e, alone so far, into the ring of f.
  void insert_after(std::int32_t e, std::int32_t f) {
    const std::int32_t next = edges_[f].next;
    edges_[e].previous = f;
    edges_[e].next = next;
    edges_[f].next = edges_[next].previous = e;
  }
  void insert_before(std::int32_t e, std::int32_t f) { insert_after(e, edges_[f].previous); }

  void remove(std::int32_t e) {
    for (const std::int32_t half : {e, e ^ 1}) {
      const Edge edge = edges_[half];
      edges_[edge.previous].next = edge.next;
      edges_[edge.next].previous = edge.previous;
      edges_[half].to = kFree;
    }
    e &= ~1;
    edges_[e].next = free_;
    free_ = e;
  }

  // The triangles left of all edges that are not on the hull's outside, where `corner` is a vertex.
  Mesh extract(std::int32_t corner) const {
    constexpr std::int32_t kOutside = -1, kUnseen = -2;
    std::vector<std::int32_t> halfedges(used_, kUnseen);
    const std::int32_t start = hull_edge_[corner];
    std::int32_t e = start;
    std::size_t sides = used_;
    do {
      halfedges[e ^ 1] = kOutside;
      --sides;
      e = edges_[e ^ 1].next;
    } while (e != start);
    for (std::int32_t free = free_; free != kNone; free = edges_[free].next) sides -= 2;

    Mesh mesh;
    mesh.triangles.resize(sides);
    mesh.twins.resize(sides);
    std::int32_t count = 0;
    for (std::int32_t seed = 0; seed < used_; ++seed) {
      if (edges_[seed].to == kFree || halfedges[seed] != kUnseen) continue;
      e = seed;
      for (int k = 0; k < 3; ++k) {
        halfedges[e] = count;
        mesh.triangles[count++] = orders_[kX][edges_[e ^ 1].to].along[kX];
        e = edges_[e ^ 1].previous;
      }
    }
    for (std::int32_t f = 0; f < used_; ++f) {
      if (halfedges[f] >= 0) mesh.twins[halfedges[f]] = halfedges[f ^ 1];
    }
    return mesh;
  }

  const Bounds bounds_;
  const Point* const points_;
  const std::int32_t n_;
  Work* const work_;
  std::unique_ptr<Ranks[]> orders_[2];
  const std::unique_ptr<Point[]> vertices_;
  // The counter-clockwise hull edge out of each strict corner of a node's hull.
  const std::unique_ptr<std::int32_t[]> hull_edge_;
  const std::unique_ptr<Edge[]> edges_;  // a planar graph has less than 3n
  std::int32_t used_ = 0;
  std::int32_t free_ = kNone;
  const std::unique_ptr<Ranks[]> scratch_;
};

}  // namespace

Mesh dwyer(const Predicates& predicates, const Point* points, std::size_t n, Work* work) {
  if (work == nullptr) return Builder<false>(predicates, points, n, nullptr).run();
  return Builder<true>(predicates, points, n, work).run();
}

}  // namespace flaunay::recursive
