// What must hold of the edge rings that the stage `divide` makes.
#pragma once

#include <CL/cl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/records.h"
#include "prove/exact.hpp"
#include "tests/support/distribute_twin.hpp"

namespace flaunay::testing {

constexpr cl_int kNone = -1;
constexpr std::size_t kEdgesPerPoint = 6;

/// blocks::Blocks and blocks::Rings as read from the device, after divide().
struct HostRings {
  std::vector<cl_int> set_blocks, offsets;
  std::vector<cl_int> spans;  ///< by block: behind the last block that it was joined with
  std::vector<cl_double2> vertices;
  std::vector<cl_int> source;
  std::vector<kernel::ring_edge> edges;
  std::vector<cl_int> vertex_edge;
  std::vector<kernel::hull_ends> block_ends;
  std::vector<cl_int> distinct;

  std::size_t sets() const { return set_blocks.size() - 1; }
  const kernel::ring_edge& edge(cl_int e) const { return edges[static_cast<std::size_t>(e)]; }
  cl_int to(cl_int e) const { return edge(e).to; }
  cl_int from(cl_int e) const { return edge(e ^ 1).to; }
  bool used(cl_int e) const { return to(e) != kNone; }
  /// The next edge of the face left of e.
  cl_int along_face(cl_int e) const { return edge(e ^ 1).previous; }
  /// The next edge of the face right of e, which is the hull's if e is counter-clockwise on it.
  cl_int along_hull(cl_int e) const { return edge(e ^ 1).next; }
  const cl_double2& point(cl_int v) const { return vertices[static_cast<std::size_t>(v)]; }
  cl_int edge_of(cl_int v) const { return vertex_edge[static_cast<std::size_t>(v)]; }

  /// The distinct points of blocks [first, last).
  std::vector<cl_int> vertices_of(cl_int first, cl_int last) const {
    std::vector<cl_int> all;
    for (auto b = static_cast<std::size_t>(first); b < static_cast<std::size_t>(last); ++b) {
      for (cl_int k = 0; k < distinct[b]; ++k) all.push_back(offsets[b] + k);
    }
    return all;
  }
};

inline std::array<cl_int, 4> numbers_of(const kernel::hull_ends& ends) {
  return {ends.first_x, ends.last_x, ends.first_y, ends.last_y};
}

/// First x, last x, first y, last y.
inline std::array<cl_int, 4> ends_twin(const HostRings& g, const std::vector<cl_int>& vertices) {
  if (vertices.empty()) return {kNone, kNone, kNone, kNone};
  std::array<cl_int, 4> ends{};
  for (const int axis : {0, 1}) {
    const auto [first, last] = std::minmax_element(vertices.begin(), vertices.end(), [&](cl_int v, cl_int w) {
      return comes_first(g.point(v), g.point(w), axis);
    });
    ends[static_cast<std::size_t>(2 * axis)] = *first;
    ends[static_cast<std::size_t>(2 * axis + 1)] = *last;
  }
  return ends;
}

/// Points in the order in which a block numbers them: cut in halves across the longer interquartile range
/// down to leaves of at most four, each in the order of x. Part j of 2^depth begins at (j * count) / 2^depth.
inline std::vector<cl_double2> leaves_twin(const std::vector<cl_double2>& points) {
  const std::size_t count = points.size();
  int depth = 0;
  for (std::size_t room = 4; room < count; room *= 2) ++depth;
  const auto begin_of = [count](int d, std::size_t j) { return j * count >> d; };
  std::vector<cl_double2> order = points;
  const auto sort = [&](std::size_t begin, std::size_t end, int axis) {
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
              order.begin() + static_cast<std::ptrdiff_t>(end),
              [axis](const auto& p, const auto& q) { return comes_first(p, q, axis); });
  };
  for (int d = 0; d <= depth; ++d) {
    for (std::size_t j = 0; j < std::size_t{1} << d && count > 0; ++j) {
      const std::size_t begin = begin_of(d, j), end = begin_of(d, j + 1);
      const std::vector<cl_double2> part(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                         order.begin() + static_cast<std::ptrdiff_t>(end));
      // Sorting is cutting: the next depth's parts are runs of this order.
      sort(begin, end, d < depth && interquartile_range(part, 1) > interquartile_range(part, 0));
    }
  }
  return order;
}

/// What is wrong with a block's vertices, or "": they are its distinct points, each by its least index, in
/// the order of leaves. before: with vertices and source as the stage before left them.
inline std::string broken_vertices(const HostRings& g, std::size_t block, const HostRings& before) {
  const auto first = static_cast<std::size_t>(g.offsets[block]),
             last = static_cast<std::size_t>(g.offsets[block + 1]);
  std::map<std::pair<double, double>, cl_int> source;
  std::vector<cl_double2> distinct;
  for (std::size_t i = first; i < last; ++i) {
    const cl_double2& p = before.vertices[i];
    const auto [place, is_new] = source.insert({{p.s[0], p.s[1]}, before.source[i]});
    if (is_new) distinct.push_back(p);
    place->second = std::min(place->second, before.source[i]);
  }
  if (static_cast<std::size_t>(g.distinct[block]) != distinct.size()) {
    return fmt::format("block {}: {} distinct points instead of {}", block, g.distinct[block],
                       distinct.size());
  }
  const std::vector<cl_double2> expected = leaves_twin(distinct);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const cl_double2& p = g.vertices[first + k];
    if (p.s[0] != expected[k].s[0] || p.s[1] != expected[k].s[1] ||
        g.source[first + k] != source.at({p.s[0], p.s[1]})) {
      return fmt::format("block {}: vertex {} is another point", block, k);
    }
  }
  return "";
}

/// What is wrong with the rings of a set, or "". They are to be the canonical Delaunay triangulation: one
/// planar component, with each vertex's edges in counter-clockwise order, a convex hull around triangles, and
/// across each edge nothing in the circle of the other side; of four points of a circle the diagonal leaves
/// the first, unless is_canonical is false. Points on a line: the path along it.
class RingCheck {
 public:
  RingCheck(const HostRings& g, std::size_t set, bool is_canonical = true)
      : g_(g),
        first_block_(g.set_blocks[set]),
        last_block_(g.set_blocks[set + 1]),
        first_(g.offsets[static_cast<std::size_t>(first_block_)]),
        last_(g.offsets[static_cast<std::size_t>(last_block_)]),
        first_edge_(static_cast<cl_int>(kEdgesPerPoint) * first_),
        last_edge_(static_cast<cl_int>(kEdgesPerPoint) * last_),
        vertices_(g.vertices_of(first_block_, last_block_)),
        is_canonical_(is_canonical) {}

  std::string run() {
    for (const auto step : {&RingCheck::edges, &RingCheck::free_edges, &RingCheck::rings, &RingCheck::ends,
                            &RingCheck::hull, &RingCheck::faces, &RingCheck::circles}) {
      (this->*step)();
      if (!what_.empty()) break;
    }
    return what_;
  }

  /// As the reference has them, with indices of the input; after run() that found nothing.
  std::vector<std::int32_t> triangles() const {
    std::vector<std::int32_t> all;
    for (cl_int e = first_edge_; e < last_edge_; ++e) {
      if (!g_.used(e) || outside(e) || !owns(e)) continue;
      for (const cl_int corner : {e, g_.along_face(e), g_.along_face(g_.along_face(e))}) {
        all.push_back(g_.source[static_cast<std::size_t>(g_.from(corner))]);
      }
    }
    return all;
  }

 private:
  template <typename... Values>
  void fail(const char* what, const Values&... values) {
    if (what_.empty()) what_ = fmt::format(fmt::runtime(what), values...);
  }
  int orient(cl_int a, cl_int b, cl_int c) {
    return exact_.orient2d(g_.point(a).s, g_.point(b).s, g_.point(c).s);
  }
  bool outside(cl_int e) const { return outside_[static_cast<std::size_t>(e - first_edge_)]; }
  bool owns(cl_int e) const {
    const cl_int next = g_.along_face(e);
    return e < next && e < g_.along_face(next);
  }
  /// 0: from 0 to below half a turn.
  int half(cl_int from, cl_int to) const { return comes_first(g_.point(from), g_.point(to), 1) ? 0 : 1; }
  bool is_vertex(cl_int v) const { return std::binary_search(vertices_.begin(), vertices_.end(), v); }

  void edges() {
    std::set<std::pair<cl_int, cl_int>> all;
    for (cl_int e = first_edge_; e < last_edge_; ++e) {
      const kernel::ring_edge& edge = g_.edge(e);
      // Also of free edges, since passes over all edges follow it.
      if (edge.previous < first_edge_ || edge.previous >= last_edge_)
        return fail("edge {} is before none", e);
      if (g_.used(e) != g_.used(e ^ 1)) return fail("edge {} is half used", e);
      if (!g_.used(e)) continue;
      ++used_;
      if (!is_vertex(edge.to)) return fail("edge {} leads to no vertex, {}", e, edge.to);
      if (edge.to == g_.from(e)) return fail("edge {} is a loop", e);
      if (!all.insert({g_.from(e), edge.to}).second) return fail("edge {} is there twice", e);
      for (const cl_int other : {edge.next, edge.previous}) {
        if (other < first_edge_ || other >= last_edge_ || !g_.used(other))
          return fail("edge {} is beside none", e);
        if (g_.from(other) != g_.from(e)) return fail("edge {} is in the ring of another vertex", e);
      }
      if (g_.edge(edge.next).previous != e) return fail("the edge after {} does not point back", e);
    }
  }

  // All in one list, by the even one of each pair.
  void free_edges() {
    std::set<cl_int> free, followers;
    for (cl_int e = first_edge_; e < last_edge_; e += 2) {
      if (g_.used(e)) continue;
      free.insert(e);
      if (g_.edge(e).next != kNone && !followers.insert(g_.edge(e).next).second)
        return fail("free lists join at {}", e);
    }
    std::vector<cl_int> heads;
    std::set_difference(free.begin(), free.end(), followers.begin(), followers.end(),
                        std::back_inserter(heads));
    if (free.empty()) return;
    if (heads.size() != 1) return fail("{} free lists", heads.size());
    std::size_t length = 0;
    for (cl_int e = heads[0]; e != kNone; e = g_.edge(e).next) {
      if (free.count(e) == 0) return fail("edge {} is in the free list", e);
      ++length;
    }
    if (length != free.size()) fail("{} of {} free edges are in the list", length, free.size());
  }

  void rings() {
    std::map<cl_int, std::size_t> degree;
    for (cl_int e = first_edge_; e < last_edge_; ++e) degree[g_.used(e) ? g_.from(e) : kNone] += g_.used(e);
    for (cl_int v = first_; v < last_; ++v) {
      const cl_int start = g_.edge_of(v);
      if (degree[v] == 0) {
        if (start != kNone) return fail("vertex {} has an edge, but there is none", v);
        continue;
      }
      if (start < first_edge_ || start >= last_edge_ || !g_.used(start) || g_.from(start) != v) {
        return fail("vertex {} has the edge of another", v);
      }
      std::size_t size = 0, turns = 0;
      cl_int e = start;
      do {
        const cl_int next = g_.edge(e).next;
        const int here = half(v, g_.to(e)), there = half(v, g_.to(next));
        const bool ascends = here != there ? here < there : orient(v, g_.to(e), g_.to(next)) > 0;
        turns += !ascends;
        ++size;
        e = next;
      } while (e != start && size <= degree[v]);
      if (size != degree[v]) return fail("the ring of vertex {} has {} of {} edges", v, size, degree[v]);
      if (turns != 1) return fail("the ring of vertex {} turns {} times", v, turns);
    }
  }

  void ends() {
    for (cl_int b = first_block_; b < last_block_; ++b) {
      const auto block = static_cast<std::size_t>(b);
      const auto expected = ends_twin(g_, g_.vertices_of(b, g_.spans[block]));
      for (std::size_t k = 0; k < 4; ++k) {
        if (numbers_of(g_.block_ends[block])[k] != expected[k]) return fail("end {} of block {}", k, b);
      }
    }
  }

  void hull() {
    outside_.assign(static_cast<std::size_t>(last_edge_ - first_edge_), false);
    if (vertices_.size() < 2) return;
    const cl_int start = g_.edge_of(ends_twin(g_, vertices_)[0]);
    if (start == kNone) return fail("no edge at the first vertex");
    cl_int e = start;
    std::size_t turns = 0, size = 0;
    do {
      const cl_int next = g_.along_hull(e);
      outside_[static_cast<std::size_t>((e ^ 1) - first_edge_)] = true;
      const int turn = orient(g_.from(e), g_.to(e), g_.to(next));
      if (turn < 0) return fail("the hull turns right at vertex {}", g_.to(e));
      if (turn > 0 && g_.edge_of(g_.to(e)) != next)
        return fail("the hull's corner {} has another edge", g_.to(e));
      turns += half(g_.from(e), g_.to(e)) > half(g_.to(e), g_.to(next));
      flat_ &= turn == 0;
      e = next;
    } while (e != start && ++size <= used_);
    if (e != start) return fail("the hull does not close");
    if (turns != 1) fail("the hull turns {} times", turns);
  }

  void faces() {
    const std::size_t v = vertices_.size();
    if (flat_) return path();
    std::vector<bool> seen(outside_.size(), false);
    std::size_t count = 0;
    for (cl_int start = first_edge_; start < last_edge_; ++start) {
      if (!g_.used(start) || seen[static_cast<std::size_t>(start - first_edge_)]) continue;
      ++count;
      std::size_t size = 0;
      for (cl_int e = start; !seen[static_cast<std::size_t>(e - first_edge_)]; e = g_.along_face(e)) {
        seen[static_cast<std::size_t>(e - first_edge_)] = true;
        if (outside(e) != outside(start)) return fail("the face of edge {} is inside and outside", start);
        ++size;
      }
      if (outside(start)) continue;
      if (size != 3) return fail("the face of edge {} has {} corners", start, size);
      if (orient(g_.from(start), g_.to(start), g_.to(g_.along_face(start))) <= 0) {
        return fail("the triangle of edge {} is not counter-clockwise", start);
      }
    }
    if (v + count != used_ / 2 + 2) return fail("{} vertices, {} edges, {} faces", v, used_ / 2, count);
    connected();
  }

  void path() {
    if (vertices_.size() < 2) {
      if (used_ != 0) fail("{} edges of {} vertices", used_, vertices_.size());
      return;
    }
    std::vector<cl_int> sorted = vertices_;
    std::sort(sorted.begin(), sorted.end(),
              [this](cl_int v, cl_int w) { return comes_first(g_.point(v), g_.point(w), 0); });
    if (used_ != 2 * (sorted.size() - 1)) return fail("{} edges on a line of {}", used_, sorted.size());
    for (std::size_t k = 0; k + 1 < sorted.size(); ++k) {
      const cl_int e = g_.edge_of(sorted[k]);
      if (g_.to(e) != sorted[k + 1] && g_.to(g_.edge(e).next) != sorted[k + 1]) {
        return fail("vertices {} and {} of a line are not joined", sorted[k], sorted[k + 1]);
      }
      if (orient(sorted[0], sorted[k], sorted[k + 1]) != 0) return fail("vertex {} is on no line", sorted[k]);
    }
  }

  void connected() {
    std::set<cl_int> reached{vertices_[0]};
    std::vector<cl_int> open{vertices_[0]};
    while (!open.empty()) {
      const cl_int start = g_.edge_of(open.back());
      open.pop_back();
      if (start == kNone) continue;
      cl_int e = start;
      do {
        if (reached.insert(g_.to(e)).second) open.push_back(g_.to(e));
        e = g_.edge(e).next;
      } while (e != start);
    }
    if (reached.size() != vertices_.size())
      fail("{} of {} vertices hang together", reached.size(), vertices_.size());
  }

  void circles() {
    for (cl_int e = first_edge_; e < last_edge_; e += 2) {
      if (!g_.used(e) || outside(e) || outside(e ^ 1)) continue;
      const cl_int a = g_.from(e), b = g_.to(e), c = g_.to(g_.along_face(e)), d = g_.to(g_.along_face(e ^ 1));
      const int side = exact_.incircle(g_.point(a).s, g_.point(b).s, g_.point(c).s, g_.point(d).s);
      if (side > 0) return fail("vertex {} is in the circle across edge {}", d, e);
      if (side < 0 || !is_canonical_) continue;
      const cl_int first = ends_twin(g_, {a, b, c, d})[0];
      if (first != a && first != b) return fail("edge {} is not the canonical diagonal", e);
    }
  }

  const HostRings& g_;
  cl_int first_block_, last_block_, first_, last_, first_edge_, last_edge_;
  std::vector<cl_int> vertices_;
  ExactPredicates exact_;
  bool is_canonical_;
  std::size_t used_ = 0;
  std::vector<bool> outside_;
  bool flat_ = true;
  std::string what_;
};

}  // namespace flaunay::testing
