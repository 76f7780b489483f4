#include "constrained/inside.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "blocks/block.h"
#include "blocks/rows.h"
#include "geometry/magnitudes.hpp"
#include "host/of_thread.hpp"
#include "mesh/rings.h"
#include "predicates/planar.h"

namespace flaunay::constrained {
namespace {

// A line sweeps over the points from left to right, by their lexicographic order. Between two neighbouring
// segments that it crosses, the inside left of it is triangulated, up to a *front*: a path of edges from one
// segment's left end to the other one's. A point makes triangles with all edges of the front that it sees
// from the end at which it joins, so that the front stays concave. Each new triangle is made Delaunay at
// once, by flips around the new point. Edges between two new triangles need none: the front was concave where
// they begin, so the triangles are no convex quadrilateral.
//
// Each point must be strictly between the segments right above and below. As long as none have crossed, these
// are right. Two that do are neighbours, and as nothing is between them from then on, they stay neighbours
// until one ends: at a point that is on the wrong side of the other.
//
// Vertices have numbers in the order of sets and, within these, in lexicographic order. A half-edge e has its
// triangle on the left; e ^ 1 is the other one. Segment s has 2 s, in its direction, and 2 s + 1.
class Inside {
 public:
  bool run(const double* coordinates, const std::vector<std::size_t>& offsets, const Constraints& constraints,
           const SmallRequest& request, ConstrainedTriangulation& result) {
    is_winding_ = request.rules.fill == FillRule::winding;
    segment_count_ = static_cast<int>(constraints.segment_count);
    segments_ = constraints.segments;
    result_ = &result;
    undecided_ = 0;
    const std::size_t sets = offsets.size() - 1, n = offsets.back();
    if (!find_leaving(n)) return false;
    steps_left_ = static_cast<std::int64_t>(request.most_steps * (n + constraints.segment_count));
    const geometry::SetScalings scalings =
        geometry::set_scalings(coordinates, offsets, [coordinates](std::size_t first, std::size_t last) {
          return geometry::inspect(coordinates, first, last);
        });
    bounds_ = scalings.bounds;
    reserve(n);
    result.triangle_offsets.assign(1, 0);
    result.hull_offsets.assign(1, 0);
    // One stage after the other takes less than one set after the other.
    sets_.clear();
    for (std::size_t s = 0; s < sets; ++s) {
      const int begin = static_cast<int>(offsets[s]), end_of_points = static_cast<int>(offsets[s + 1]);
      sets_.push_back(order(coordinates, begin, end_of_points, kernel::scale_of(scalings.shift(s))));
      if (!link(begin, end_of_points, sets_.back().end)) return false;
      vertex_count_ += static_cast<std::size_t>(sets_.back().end - begin);
    }
    for (std::size_t s = 0; s < sets; ++s) {
      const int begin = static_cast<int>(offsets[s]), end = sets_[s].end;
      errors_ = sets_[s].errors;
      if (!sweep(begin, end)) return false;
      write_rows(begin, end, request.neighbors);
      write_hull();
    }
    const std::size_t rows = 3 * result.triangle_offsets.back();
    result.triangles.assign(triangles_, triangles_ + rows);
    result.constrained.assign(constrained_, constrained_ + rows);
    if (request.neighbors) result.neighbors.assign(neighbors_, neighbors_ + rows);
    write_edges(n);
    result.added_offsets.assign(sets + 1, 0);
    Statistics& statistics = result.statistics;
    statistics.points = n;
    statistics.duplicates = n - vertex_count_;
    statistics.hull_vertices = result.hull.size();
    statistics.undecided = undecided_;
    statistics.device_bytes_peak = bytes();
    return true;
  }

 private:
  static constexpr int kNone = -1;

  // The ends of segments at a vertex: half-edges that leave it, and the vertices at which these arrive.
  struct Corner {
    int edges[2], others[2], count;
  };
  // The end of a set's vertices, and the largest errors of predicates on them.
  struct Set {
    int end;
    kernel::largest_errors errors;
  };
  struct HalfEdge {
    int to, next;  // next: within the triangle; kNone if the triangle is not made, or outside
  };
  // A vertex of a front. edge: from this one to the next one below, with the untriangulated area on its left.
  struct Node {
    int vertex, up, down, edge;
  };
  // A segment that the line crosses, and the area between it and the segment above.
  struct Crossed {
    int above, below;
    int left, right, edge;  // the ends, and the half-edge from the left one
    int depth;
    int low, top, last;  // the ends of the front and its rightmost node, unless the depth is 0
  };

  // ---------------------------------------------------------------------------------------------------------
  // Vertices

  template <typename T>
  static T* sized(std::vector<T>& array, std::size_t size) {
    if (array.size() < size) array.resize(size);
    return array.data();
  }

  std::size_t bytes() const {
    const auto sum = [](const auto&... arrays) {
      return (... + (arrays.capacity() * sizeof(*arrays.data())));
    };
    return sum(all_points, given, all_leaving, all_source, all_leaf, all_vertex_of, given_source, all_open,
               all_places, all_rows, all_triangles, all_neighbors, all_constrained, ranks, axes, all_corners,
               all_crossed, all_nodes, all_edges);
  }

  // The half-edges that leave each point. Returns false if these are not two everywhere; compared to the
  // rest, that takes no time.
  bool find_leaving(std::size_t n) {
    if (static_cast<std::size_t>(segment_count_) != n) return false;
    int* const counts = sized(all_places, n);
    leaving_ = sized(all_leaving, 2 * n);
    std::fill(counts, counts + n, 0);
    for (std::size_t e = 0; e < 2 * n; ++e) {
      const auto i = static_cast<std::size_t>(segments_[e]);
      if (i >= n || counts[i] == 2) return false;
      leaving_[2 * i + static_cast<std::size_t>(counts[i]++)] = static_cast<int>(e);
    }
    return true;
  }

  void reserve(std::size_t n) {
    auto& representatives = result_->representatives;
    representatives.resize(n);
    std::iota(representatives.begin(), representatives.end(), 0);
    points_ = sized(all_points, n);
    source_ = sized(all_source, n);
    leaf_ = sized(all_leaf, n);
    vertex_of_ = sized(all_vertex_of, n);
    corners_ = sized(all_corners, n);
    sized(given, n);
    sized(given_source, n);
    sized(ranks, 3 * n);
    sized(axes, 2 * n);
    // At most two triangles per point.
    triangles_ = sized(all_triangles, 6 * n);
    neighbors_ = sized(all_neighbors, 6 * n);
    constrained_ = sized(all_constrained, 6 * n);
    vertex_count_ = 0;
  }

  // Orders the points of a set.
  Set order(const double* coordinates, int begin, int end, kernel::scaling scale) {
    double lowest = 0, highest = 0;
    for (int i = begin; i < end; ++i) {
      const kernel::double2 p = kernel::scaled_point(i, coordinates, scale);
      given[i] = p;
      given_source[i] = i;
      lowest = i == begin || p.y < lowest ? p.y : lowest;
      highest = i == begin || p.y > highest ? p.y : highest;
    }
    kernel::block_scratch scratch =
        kernel::scratch_from(0, end - begin, points_ + begin, source_ + begin, ranks.data(), axes.data());
    const int distinct = kernel::order_block(begin, end - begin, nullptr, &scratch, given.data(),
                                             given_source.data(), result_->representatives.data());
    for (int k = 0; k < distinct; ++k) {
      vertex_of_[source_[begin + k]] = begin + k;
      leaf_[begin + kernel::own_rank(scratch.by_x[k])] = k;
    }
    const double width = distinct > 0 ? points_[begin + distinct - 1].x - points_[begin].x : 0;
    return {begin + distinct, kernel::errors_within(std::max(width, highest - lowest), bounds_)};
  }

  // Finds the corners of curves at the vertices of a set. Returns false if there is not one at each.
  bool link(int begin, int end_of_points, int end) {
    const std::int32_t* const representatives = result_->representatives.data();
    for (int v = begin; v < end; ++v) corners_[v].count = 0;
    for (int i = begin; i < end_of_points; ++i) {
      const int v = vertex_of_[representatives[i]];
      Corner& at = corners_[v];
      for (const int e : {leaving_[2 * i], leaving_[2 * i + 1]}) {
        const std::int32_t to = segments_[e ^ 1];
        if (to < begin || to >= end_of_points) return false;
        const int other = vertex_of_[representatives[to]];
        if (other == v) continue;
        if (at.count == 2) return false;
        at.edges[at.count] = e;
        at.others[at.count++] = other;
      }
    }
    return std::all_of(corners_ + begin, corners_ + end, [](const Corner& at) { return at.count == 2; });
  }

  // ---------------------------------------------------------------------------------------------------------
  // The sweep

  int side(int a, int b, int c) {
    const kernel::double2 p = points_[a], q = points_[b], r = points_[c];
    const double det = (p.x - r.x) * (q.y - r.y) - (p.y - r.y) * (q.x - r.x);
    return det > errors_.side ? 1 : det < -errors_.side ? -1 : side_exactly(a, b, c);
  }
  OUT_OF_LINE int side_exactly(int a, int b, int c) {
    const int sign = kernel::orient_filtered(points_[a], points_[b], points_[c], bounds_.orient);
    if (sign != UNDECIDED) return sign;
    ++undecided_;
    return kernel::orient_exact(points_[a], points_[b], points_[c]);
  }
  int side(const Crossed& of, int v) { return side(of.left, of.right, v); }
  // Whether a vertex is strictly between two segments, or beyond all. Then it may be on the hull.
  bool is_between(int below, int above, int v) {
    if (below == segment_count_) {
      add_to_lower(v);
    } else if (side(crossed_[below], v) <= 0) {
      return false;
    }
    if (above == kNone) {
      add_to_upper(v);
      return true;
    }
    return side(crossed_[above], v) < 0;
  }
  void link(int below, int above) {
    crossed_[below].above = above;
    if (above != kNone) crossed_[above].below = below;
  }

  // The depth right above a segment, from the depth right below. edge: the half-edge from its left end.
  int depth_above(int depth, int edge) const {
    return !is_winding_ ? depth ^ 1 : (edge & 1) == 0 ? depth + 1 : depth - 1;
  }

  bool sweep(int begin, int end) {
    const int bottom = segment_count_;
    const auto n = static_cast<std::size_t>(end - begin);
    crossed_ = sized(all_crossed, segment_count_ + 1);
    // Each of at most two fronts gets a node per vertex, and a front that is cut one more.
    nodes_ = sized(all_nodes, 3 * n);
    edges_ = sized(all_edges, 2 * (segment_count_ + 4 * n));
    open_ = sized(all_open, 2 * (segment_count_ + 4 * n));
    node_count_ = 0;
    edge_count_ = 2 * segment_count_;
    crossed_[bottom].above = kNone;
    crossed_[bottom].depth = 0;
    lower_.clear();
    upper_.clear();
    for (int v = begin; v < end; ++v) {
      const Corner& at = corners_[v];
      if (is_winding_ && ((at.edges[0] ^ at.edges[1]) & 1) == 0) return false;
      const bool first_ends = at.others[0] < v, second_ends = at.others[1] < v;
      if (!(first_ends != second_ends ? pass(v, at, first_ends) : first_ends ? finish(v, at) : start(v, at)))
        return false;
    }
    return true;
  }

  void cross(int edge, int from, int to, int depth) {
    Crossed& made = crossed_[edge >> 1];
    made.left = from;
    made.right = to;
    made.edge = edge;
    made.depth = depth;
    edges_[edge] = {to, kNone};
    edges_[edge ^ 1] = {from, kNone};
  }

  // One segment ends at a vertex, the other one begins.
  bool pass(int v, const Corner& at, bool first_ends) {
    const int leaves = at.edges[first_ends], ended = at.edges[!first_ends] >> 1, begun = leaves >> 1;
    const Crossed old = crossed_[ended];
    if (!is_between(old.below, old.above, v)) return false;
    crossed_[begun] = old;
    cross(leaves, v, at.others[first_ends], old.depth);
    link(old.below, begun);
    link(begun, old.above);
    Crossed &above = crossed_[begun], &below = crossed_[old.below];
    if (above.depth != 0) above.low = above.last = join_below(above.low, old.edge, v);
    if (below.depth != 0) below.top = below.last = join_above(below.top, old.edge ^ 1, v);
    return true;
  }

  bool start(int v, const Corner& at) {
    int under = segment_count_;
    for (int next = crossed_[under].above; next != kNone; next = crossed_[under].above) {
      const int at_next = side(crossed_[next], v);
      if (at_next == 0 || --steps_left_ < 0) return false;
      if (at_next < 0) break;
      under = next;
    }
    if (under == segment_count_) add_to_lower(v);
    if (crossed_[under].above == kNone) add_to_upper(v);
    const int turn = side(v, at.others[0], at.others[1]);
    if (turn == 0) return false;
    const int first = turn < 0, low = at.edges[first], high = at.edges[!first];
    Crossed &below = crossed_[under], &lower = crossed_[low >> 1], &upper = crossed_[high >> 1];
    cross(low, v, at.others[first], depth_above(below.depth, low));
    cross(high, v, at.others[!first], below.depth);
    link(high >> 1, below.above);
    link(low >> 1, high >> 1);
    link(under, low >> 1);
    if (lower.depth != 0) lower.low = lower.top = lower.last = make_node(v, kNone, kNone, kNone);
    if (below.depth == 0) return true;
    // The front is cut at its rightmost node, to which there is an edge with both parts on its sides.
    const int cut = below.last, from = nodes_[cut].vertex, up = nodes_[cut].up;
    const int copy = make_node(from, up, kNone, kNone), edge = make_edge(from, v);
    if (up != kNone) nodes_[up].down = copy;
    nodes_[cut].up = kNone;
    upper.top = below.top == cut ? copy : below.top;
    upper.low = upper.last = join_below(copy, edge, v);
    below.top = below.last = join_above(cut, edge ^ 1, v);
    return true;
  }

  // Both segments end.
  bool finish(int v, const Corner& at) {
    int low = at.edges[0] >> 1, high = at.edges[1] >> 1;
    if (crossed_[low].above != high) std::swap(low, high);
    if (crossed_[low].above != high) return false;
    const Crossed &lower = crossed_[low], &upper = crossed_[high];
    if (!is_between(lower.below, upper.above, v)) return false;
    link(lower.below, upper.above);
    if (lower.depth != 0 && !close(lower.low, lower.edge, upper.edge ^ 1, v)) return false;
    Crossed& below = crossed_[lower.below];
    if (below.depth == 0) return true;
    const int node = join_above(below.top, lower.edge ^ 1, v);
    const int up = nodes_[join_below(upper.low, upper.edge, v)].up;
    nodes_[node].up = up;
    nodes_[up].down = node;
    below.top = upper.top;
    below.last = node;
    return true;
  }

  int make_node(int vertex, int up, int down, int edge) {
    nodes_[node_count_] = {vertex, up, down, edge};
    return node_count_++;
  }
  int make_edge(int from, int to) {
    edges_[edge_count_] = {to, kNone};
    edges_[edge_count_ + 1] = {from, kNone};
    edge_count_ += 2;
    return edge_count_ - 2;
  }
  // Makes a triangle over an edge of a front.
  void add_triangle(int base, int second, int third) {
    edges_[base].next = second;
    edges_[second].next = third;
    edges_[third].next = base;
    flip_around(base);
  }

  // A vertex joins a front below its lowest node, from which an edge leads to it. Returns its node.
  int join_below(int low, int edge, int v) {
    for (int up = nodes_[low].up; up != kNone; up = nodes_[low].up) {
      if (side(nodes_[up].vertex, nodes_[low].vertex, v) <= 0) break;
      const int made = make_edge(v, nodes_[up].vertex);
      add_triangle(nodes_[up].edge, edge, made);
      edge = made ^ 1;
      low = up;
    }
    nodes_[low].edge = edge;
    return nodes_[low].down = make_node(v, low, kNone, kNone);
  }
  // Above its top node, to which an edge leads from it.
  int join_above(int top, int edge, int v) {
    for (int down = nodes_[top].down; down != kNone; down = nodes_[top].down) {
      if (side(nodes_[top].vertex, nodes_[down].vertex, v) <= 0) break;
      const int made = make_edge(nodes_[down].vertex, v);
      add_triangle(nodes_[top].edge, made, edge);
      edge = made ^ 1;
      top = down;
    }
    return nodes_[top].up = make_node(v, kNone, top, edge);
  }
  // A vertex at which a front ends sees all of it.
  bool close(int low, int edge, int last, int v) {
    for (int up = nodes_[low].up; up != kNone; up = nodes_[low].up) {
      if (side(nodes_[up].vertex, nodes_[low].vertex, v) <= 0) return false;
      const int made = nodes_[up].up == kNone ? last : make_edge(v, nodes_[up].vertex);
      add_triangle(nodes_[up].edge, edge, made);
      edge = made ^ 1;
      low = up;
    }
    return edge == (last ^ 1);
  }

  // Whether a vertex is inside of the circle through an edge and the apex on its left, or on it and tied so.
  bool is_inside(int from, int to, int apex, int v) {
    const auto at = [this](int w) { return kernel::load_pair(&points_[w]); };
    const auto seen = [&](int w) { return kernel::angle_products(at(w), at(from), at(to)); };
    const double wider = kernel::angle_difference(seen(v), seen(apex));
    if (wider > errors_.angle) return true;
    return wider >= -errors_.angle && is_inside_exactly(from, to, apex, v);
  }
  OUT_OF_LINE bool is_inside_exactly(int from, int to, int apex, int v) {
    const kernel::double2 a = points_[from], b = points_[to], c = points_[apex], d = points_[v];
    int sign = kernel::circle_filtered(a, b, c, d, bounds_.circle);
    if (sign == UNDECIDED) {
      ++undecided_;
      sign = kernel::circle_undecided(a, b, c, d, bounds_.circle);
    }
    return (sign != 0 ? sign : kernel::canonical_tie(a, b, c, d, bounds_.circle)) > 0;
  }

  // Flips the edge on whose left a new triangle is, if need be, and then those beyond it.
  void flip_around(int base) {
    HalfEdge* const edges = edges_;
    int *const open = open_, *top = open;
    const int inner = 2 * segment_count_;
    *top++ = base;
    while (top != open) {
      const int e = *--top, twin = e ^ 1;
      if (e < inner || edges[twin].next == kNone) continue;
      const int e1 = edges[e].next, t1 = edges[twin].next, apex = edges[e1].to, beyond = edges[t1].to;
      if (!is_inside(edges[twin].to, edges[e].to, apex, beyond)) continue;
      const int e2 = edges[e1].next, t2 = edges[t1].next;
      edges[e] = {apex, e2};
      edges[e2].next = t1;
      edges[t1].next = e;
      edges[twin] = {beyond, t2};
      edges[t2].next = e1;
      edges[e1].next = twin;
      *top++ = t1;
      *top++ = t2;
    }
  }

  // ---------------------------------------------------------------------------------------------------------
  // Results

  // Each triangle belongs to its middle vertex, as in blocks/mesh.cl.
  void write_rows(int begin, int end, bool with_neighbors) {
    const auto count = static_cast<std::size_t>(end - begin);
    int* const places = sized(all_places, 2 * count + 1);
    int* const rows = sized(all_rows, static_cast<std::size_t>(edge_count_));
    std::fill(places, places + 2 * count, kNone);
    const HalfEdge* const edges = edges_;
    const int *const leaf = leaf_, *const source = source_;
    const int inner = 2 * segment_count_, edge_count = edge_count_, unused = 2 * static_cast<int>(count);
    const auto put = [&](int e, int from, HalfEdge edge) {
      const int v = edge.to, is_second = static_cast<int>(v < edges[edge.next].to);
      // Without a branch, since it could not be predicted.
      const int is_middle = static_cast<int>(from < v) ^ is_second ^ 1;
      places[unused ^ ((unused ^ (2 * leaf[v] + is_second)) & -is_middle)] = e;
    };
    for (int v = begin; v < end; ++v) {
      for (const int e : corners_[v].edges) {
        rows[e] = kNone;
        if (edges[e].next != kNone) put(e, v, edges[e]);
      }
    }
    for (int e = inner; e < edge_count; e += 2) {
      const HalfEdge one = edges[e], other = edges[e + 1];
      put(e, other.to, one);
      put(e + 1, one.to, other);
    }
    int row = static_cast<int>(result_->triangle_offsets.back());
    const int first_row = row;
    int kept = 0;
    for (std::size_t k = 0; k < 2 * count; ++k) {
      const int e = places[k];
      places[kept] = e;
      kept += e != kNone;
    }
    for (int k = 0; k < kept; ++k, ++row) {
      const int e = places[k], second = edges[e].next;
      rows[e] = rows[second] = rows[edges[second].next] = row;
    }
    result_->triangle_offsets.push_back(static_cast<std::size_t>(row));
    std::int32_t *const triangles = triangles_, *const neighbors = with_neighbors ? neighbors_ : nullptr;
    std::uint8_t* const constrained = constrained_;
    for (int k = 0, corner = 3 * first_row; k < kept; ++k, corner += 3) {
      const int e = places[k], e1 = edges[e].next, e2 = edges[e1].next;
      const std::int32_t v = source[edges[e].to], a = source[edges[e1].to], b = source[edges[e2].to];
      const kernel::row_places at = kernel::places_in_row(v, a, b);
      const auto write = [&](std::int32_t to, std::int32_t id, int opposite) {
        triangles[to] = id;
        constrained[to] = opposite < inner;
        if (neighbors != nullptr) neighbors[to] = rows[opposite ^ 1];
      };
      write(corner + at.v, v, e2);
      write(corner + at.a, a, e);
      write(corner + at.b, b, e1);
    }
  }

  // The hull has all vertices on its edges. Only those with no segment below may be on its lower part.
  void add_to_lower(int v) {
    while (lower_.size() > 1 && side(lower_[lower_.size() - 2], lower_.back(), v) < 0) lower_.pop_back();
    lower_.push_back(v);
  }
  void add_to_upper(int v) {
    while (upper_.size() > 1 && side(upper_[upper_.size() - 2], upper_.back(), v) > 0) upper_.pop_back();
    upper_.push_back(v);
  }
  void write_hull() {
    std::vector<std::int32_t>& hull = result_->hull;
    for (const int v : lower_) hull.push_back(source_[v]);
    for (std::size_t k = upper_.size(); k > 2; --k) hull.push_back(source_[upper_[k - 2]]);
    result_->hull_offsets.push_back(hull.size());
  }

  // Constraint edges in the order of their lower ends, and then of the others.
  void write_edges(std::size_t n) {
    // Entries written for upper ends are overwritten, and the last ones are cut off.
    result_->constraint_edges.resize(2 * vertex_count_ + 2);
    result_->edge_segments.resize(vertex_count_ + 1);
    std::int32_t *const ends = result_->constraint_edges.data(), *const of = result_->edge_segments.data();
    std::int32_t number = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (result_->representatives[i] != static_cast<std::int32_t>(i)) continue;
      const int v = vertex_of_[i];
      const Corner& at = corners_[v];
      const int first = static_cast<int>(source_[at.others[0]] > source_[at.others[1]]);
      for (const int k : {first, 1 - first}) {
        ends[2 * number] = static_cast<std::int32_t>(i);
        ends[2 * number + 1] = source_[at.others[k]];
        of[number] = at.edges[k] >> 1;
        number += static_cast<std::int32_t>(v < at.others[k]);
      }
    }
    result_->constraint_edges.resize(2 * vertex_count_);
    result_->edge_segments.resize(vertex_count_);
    result_->piece_edges.assign(2 * static_cast<std::size_t>(segment_count_), 0);
    for (std::int32_t edge = 0; edge < number; ++edge) {
      result_->piece_edges[2 * of[edge]] = edge;
      result_->piece_edges[2 * of[edge] + 1] = edge + 1;
    }
    result_->piece_offsets.resize(segment_count_ + 1);
    std::iota(result_->piece_offsets.begin(), result_->piece_offsets.end(), 0);
  }

  bool is_winding_ = false;
  int segment_count_ = 0;
  const std::int32_t* segments_ = nullptr;
  ConstrainedTriangulation* result_ = nullptr;
  kernel::filter_bounds bounds_{};
  std::size_t undecided_ = 0, vertex_count_ = 0;
  std::int64_t steps_left_ = 0;
  std::vector<Set> sets_;
  kernel::largest_errors errors_{};  // of the set that is being swept
  std::vector<int> lower_, upper_;   // the hull of the swept points

  // Arrays, which are kept for later calls, and pointers into them for this call.
  std::vector<kernel::double2> all_points, given;
  std::vector<int> all_leaving, all_source, all_leaf, all_vertex_of, given_source, all_open, all_places,
      all_rows;
  std::vector<std::int32_t> all_triangles, all_neighbors;
  std::vector<std::uint8_t> all_constrained;
  std::vector<kernel::uint64> ranks;
  std::vector<kernel::uchar> axes;
  std::vector<Corner> all_corners;
  std::vector<Crossed> all_crossed;
  std::vector<Node> all_nodes;
  std::vector<HalfEdge> all_edges;
  kernel::double2* points_ = nullptr;
  int *source_ = nullptr, *leaf_ = nullptr;        // by vertex
  int *vertex_of_ = nullptr, *leaving_ = nullptr;  // by point; leaving_: two for each
  int* open_ = nullptr;
  std::int32_t *triangles_ = nullptr, *neighbors_ = nullptr;
  std::uint8_t* constrained_ = nullptr;
  Corner* corners_ = nullptr;
  Crossed* crossed_ = nullptr;  // by segment, and the bottom
  Node* nodes_ = nullptr;
  HalfEdge* edges_ = nullptr;
  int node_count_ = 0, edge_count_ = 0;
};

}  // namespace

bool triangulate_inside(const double* coordinates, const std::vector<std::size_t>& offsets,
                        const Constraints& constraints, const SmallRequest& request,
                        ConstrainedTriangulation& result) {
  const DepthRules& rules = request.rules;
  // Regions at odd levels of nested curves are inside by either rule.
  const bool is_by_parity = rules.fill == FillRule::even_odd ||
                            (rules.fill == FillRule::nesting && rules.outside == Outside::holes);
  if (rules.outside == Outside::keep || request.labels || request.curves != nullptr ||
      request.with_holes != nullptr || !(is_by_parity || rules.fill == FillRule::winding)) {
    return false;
  }
  return host::of_thread<Inside>().run(coordinates, offsets, constraints, request, result);
}

}  // namespace flaunay::constrained
