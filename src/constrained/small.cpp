#include "constrained/small.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "blocks/rows.h"
#include "constrained/fill_rules.h"
#include "host/of_thread.hpp"
#include "mesh/limits.h"
#include "mesh/rings.h"
#include "predicates/order.h"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;
using kernel::NO_EDGE;

constexpr std::int32_t kNoIndex = -1;

// Works on the directed edges of mesh/rings.h. Rings are walked clockwise, since `previous` is never
// complemented.
class Small {
 public:
  bool run(const points::SmallRings& rings, const std::vector<std::size_t>& offsets,
           const Constraints& constraints, const SmallRequest& request, ConstrainedTriangulation& result) {
    rings_ = rings;
    edges_ = rings.edges;
    offsets_ = &offsets;
    constraints_ = &constraints;
    request_ = &request;
    backward_weight_ = request.rules.fill == FillRule::winding ? -1 : 1;
    result_ = &result;
    const bool is_counted = request.has_depths && request.curves == nullptr &&
                            request.rules.fill != FillRule::nesting && !request.rules.are_closed;
    if (!insert_all() || (is_counted && !are_closed())) return false;
    number_edges();
    visit_all();
    holes_.clear();
    if (request.with_holes != nullptr && !find_holes()) return false;
    leave();
    write_rows();
    return true;
  }

 private:
  // Data that both directions of a constraint edge share. weight: the number of its segments, or if
  // directions count, of segments in the direction of the first half minus the others. number: its own, later
  // the region's number if a region is entered over it.
  struct Pair {
    std::int32_t segment = kNoIndex;  // the first one that has it
    std::int32_t weight = 0;
    std::int32_t next = NO_EDGE;  // the edge that follows on a segment
    std::int32_t number = kNoIndex;
    bool follows = false;  // whether there is an edge before it on a segment
  };
  struct Region {
    std::int32_t from, level, potential;  // from: the region it is entered from, or none
    std::int32_t edge;                    // over which it is entered, and which it has on its left
  };
  // A constraint edge from its lexicographically smaller end, and its ends.
  struct Low {
    std::int32_t from, to, edge;
  };
  // A triangle, on the left of an edge.
  struct Face {
    std::int32_t edge, region;
  };

  kernel::uchar& is_constraint(int e) { return is_constraint_[static_cast<std::size_t>(e >> 1)]; }
  Pair& pair(int e) { return pairs_[static_cast<std::size_t>(e >> 1)]; }
  int origin(int e) const { return edges_[e ^ 1].to; }
  std::int32_t id_at(int vertex) const { return rings_.source[vertex]; }
  int precedes(int v, int w) const { return kernel::precedes(rings_.points[v], rings_.points[w], 0); }
  int side(int from, int to, int v) const {
    return v == to ? 0
                   : kernel::orient_sign(rings_.points[from], rings_.points[to], rings_.points[v],
                                         rings_.bounds.orient);
  }
  // The other edges of the triangle left of an edge, counter-clockwise.
  std::pair<int, int> after(int e) const {
    const int last = edges_[e].next ^ 1;
    return {edges_[last].next ^ 1, last};
  }

  // ---------------------------------------------------------------------------------------------------------
  // Insertion

  bool insert_all() {
    const std::size_t n = rings_.vertices, count = constraints_->segment_count;
    steps_left_ = static_cast<std::int64_t>(request_->most_steps * (n + count));
    is_constraint_.assign(kernel::PAIRS_PER_VERTEX * n, 0);
    if (pairs_.size() < is_constraint_.size()) pairs_.resize(is_constraint_.size());
    vertex_of_.resize(n);
    lows_.clear();
    covers_.clear();
    for (std::size_t v = 0; v < n; ++v) {
      if (rings_.vertex_edge[v] != NO_EDGE) vertex_of_[id_at(static_cast<int>(v))] = static_cast<int>(v);
    }
    result_->piece_edges.resize(2 * count);
    std::size_t first = 0, end = 0;  // of the points of a set
    for (std::size_t s = 0; s < count; ++s) {
      const auto a = static_cast<std::size_t>(constraints_->segments[2 * s]),
                 b = static_cast<std::size_t>(constraints_->segments[2 * s + 1]);
      if (a >= n || b >= n) return false;
      if (a < first || a >= end) {
        const auto above = std::upper_bound(offsets_->begin(), offsets_->end(), a);
        first = above[-1];
        end = *above;
      }
      if (b < first || b >= end ||
          !insert(static_cast<std::int32_t>(s), result_->representatives[a], result_->representatives[b])) {
        return false;
      }
    }
    return true;
  }

  // Writes the edge of the first piece of a segment, and the number of pieces, to its place in piece_edges.
  bool insert(std::int32_t s, std::int32_t a, std::int32_t b) {
    std::int32_t* const range = &result_->piece_edges[2 * static_cast<std::size_t>(s)];
    range[0] = range[1] = 0;
    if (a == b) return true;
    int from = vertex_of_[a], to = vertex_of_[b];
    bool is_turned = false;
    int e = edge_between(from, to, is_turned);
    if (e != NO_EDGE) {
      const int low = precedes(from, to) != 0 ? e : e ^ 1;
      cover(s, low, low != e);
      range[0] = low;
      range[1] = 1;
      return true;
    }
    if (is_turned) std::swap(from, to);
    const bool ascends = precedes(from, to) != 0, is_backward = is_turned == ascends;
    for (int before = NO_EDGE; from != to; ++range[1]) {
      if (before != NO_EDGE) e = edge_between(from, to, is_turned);
      if (e == NO_EDGE) e = next_piece(from, to);
      if (e == NO_EDGE) return false;
      const int low = ascends ? e : e ^ 1;
      cover(s, low, is_backward);
      if (before == NO_EDGE || !ascends) range[0] = low;
      if (before != NO_EDGE) link(ascends ? before : low, ascends ? low : before);
      before = low;
      from = edges_[e].to;
    }
    return true;
  }

  // low: the edge from its first end. is_backward: whether the segment goes the other way.
  void cover(std::int32_t s, int low, bool is_backward) {
    Pair& covered = pair(low);
    if (!is_constraint(low)) {
      covered = {.segment = s};
      is_constraint(low) = 1;
      lows_.push_back({id_at(origin(low)), id_at(edges_[low].to), low});
    }
    const int along = is_backward ? low ^ 1 : low;
    covered.weight += (along & 1) != 0 ? backward_weight_ : 1;
    if (request_->curves != nullptr) covers_.emplace_back(s, along);
  }
  void link(int low, int next) {
    pair(low).next = next;
    pair(next).follows = true;
  }

  // The edge from one vertex to another, or NO_EDGE: looks around both, as long as around the one with fewer
  // edges. is_second: whether that is the second one.
  int edge_between(int from, int to, bool& is_second) const {
    const int first = rings_.vertex_edge[from], second = rings_.vertex_edge[to];
    for (int e = first, f = second;;) {
      if (edges_[e].to == to) return e;
      if (edges_[f].to == from) return f ^ 1;
      e = edges_[e].previous;
      f = edges_[f].previous;
      if (e == first) return NO_EDGE;
      is_second = f == second;
      if (is_second) return NO_EDGE;
    }
  }

  // The first piece of the remaining part of a segment: an existing edge along it, or a new one. NO_EDGE if
  // it crosses a constraint, or takes too many steps.
  int next_piece(int from, int to) {
    const int first = rings_.vertex_edge[from];
    int e = first, at = side(from, to, edges_[e].to);
    do {
      const int before = edges_[e].previous, at_before = side(from, to, edges_[before].to);
      if (at == 0 && precedes(from, edges_[e].to) == precedes(from, to)) return e;
      if (at > 0 && at_before < 0) return cross(before, e, to);
      e = before;
      at = at_before;
    } while (e != first);
    return NO_EDGE;
  }

  // Makes the edge to the next vertex on a segment, which leaves between two edges. lefts_ and rights_: the
  // sides of the polygons on either side, each edge on its way back to the origin of the polygon's base.
  int cross(int right, int left, int to) {
    const int from = origin(left);
    lefts_.assign({NO_EDGE, left ^ 1});
    rights_.assign(1, right);
    crossed_.clear();
    int goal = kNoIndex;
    for (int e = after(right).first; goal == kNoIndex;) {
      if (is_constraint(e) || --steps_left_ < 0) return NO_EDGE;
      crossed_.push_back(e);
      const int to_right = edges_[e].previous, to_left = edges_[e ^ 1].next ^ 1;
      const int apex = edges_[to_right].to, at = side(from, to, apex);
      if (at >= 0) lefts_.push_back(to_left);
      if (at <= 0) rights_.push_back(to_right);
      if (at == 0) goal = apex;
      e = at > 0 ? to_right : to_left;
    }
    rights_.push_back(NO_EDGE);
    std::reverse(rights_.begin(), rights_.end());
    kernel::rings g = kernel::rings_on(edges_, rings_.points, rings_.vertex_edge, rings_.bounds);
    for (const int e : crossed_) kernel::remove_edge(&g, e);
    const int last = static_cast<int>(lefts_.size()) - 1;
    const int base = make_chord(g, lefts_, 0, last);
    return fill(g, lefts_) && fill(g, rights_) ? base : NO_EDGE;
  }

  // Makes the edge between two vertices of a polygon, into which it goes on their sides.
  int make_chord(kernel::rings& g, const Ids& sides, int i, int k) {
    const int before = sides[k], behind = sides[i + 1] ^ 1;
    const int e = kernel::make_edge(&g, origin(behind), origin(before));
    kernel::insert_before(&g, e, behind);
    kernel::insert_after(&g, e ^ 1, before);
    return e;
  }

  // Gift-wraps a polygon, whose vertices are left of its base, from the first one to the last one. The
  // circles through the ends of a chord and one of the vertices between are nested; it takes the smallest.
  // Returns false if it takes too many steps.
  bool fill(kernel::rings& g, const Ids& sides) {
    const auto point = [&](int k) { return rings_.points[k == 0 ? edges_[sides[1]].to : origin(sides[k])]; };
    chords_.assign({{0, static_cast<int>(sides.size()) - 1}});
    while (!chords_.empty()) {
      const auto [i, k] = chords_.back();
      chords_.pop_back();
      if (k - i < 2) continue;
      steps_left_ -= k - i;
      if (steps_left_ < 0) return false;
      int apex = i + 1;
      for (int j = apex + 1; j < k; ++j) {
        if (kernel::circle_canonical(point(i), point(k), point(apex), point(j), rings_.bounds.circle) > 0)
          apex = j;
      }
      if (apex - i > 1) make_chord(g, sides, i, apex);
      if (k - apex > 1) make_chord(g, sides, apex, k);
      chords_.insert(chords_.end(), {{i, apex}, {apex, k}});
    }
    return true;
  }

  // Whether at each point as many segments begin as end, or an even number of them does either.
  bool are_closed() {
    const bool is_winding = request_->rules.fill == FillRule::winding;
    counts_.assign(rings_.vertices, 0);
    for (std::size_t k = 0; k < 2 * constraints_->segment_count; ++k) {
      counts_[result_->representatives[constraints_->segments[k]]] += is_winding && k % 2 != 0 ? -1 : 1;
    }
    return std::none_of(counts_.begin(), counts_.end(), [is_winding](std::int32_t balance) {
      return is_winding ? balance != 0 : balance % 2 != 0;
    });
  }

  // Constraint edges by their ends, those that follow each other on segments after the first of them.
  void number_edges() {
    counts_.assign(rings_.vertices + 1, 0);
    for (const Low& low : lows_) ++counts_[low.from + 1];
    std::partial_sum(counts_.begin(), counts_.end(), counts_.begin());
    sorted_.resize(lows_.size());
    for (const Low& low : lows_) sorted_[counts_[low.from]++] = low;
    const auto is_less = [](const Low& one, const Low& other) { return one.to < other.to; };
    for (auto first = sorted_.begin(), end = first; first != sorted_.end(); first = end) {
      while (end != sorted_.end() && end->from == first->from) ++end;
      if (end - first == 2 && is_less(first[1], first[0])) std::swap(first[0], first[1]);
      if (end - first > 2) std::sort(first, end, is_less);
    }
    result_->constraint_edges.resize(2 * lows_.size());
    result_->edge_segments.resize(lows_.size());
    std::int32_t* ends = result_->constraint_edges.data();
    std::int32_t number = 0;
    const auto add = [&](std::int32_t from, std::int32_t to, Pair& numbered) {
      *ends++ = from;
      *ends++ = to;
      result_->edge_segments[number] = numbered.segment;
      numbered.number = number++;
      return numbered.next;
    };
    for (const Low& first : sorted_) {
      if (pair(first.edge).follows) continue;
      int low = add(first.from, first.to, pair(first.edge));
      while (low != NO_EDGE) low = add(id_at(origin(low)), id_at(edges_[low].to), pair(low));
    }
    Ids& ranges = result_->piece_edges;
    for (std::size_t k = 0; k < ranges.size(); k += 2) {
      ranges[k] = ranges[k + 1] == 0 ? 0 : pair(ranges[k]).number;
      ranges[k + 1] += ranges[k];
    }
    result_->piece_offsets.resize(constraints_->segment_count + 1);
    std::iota(result_->piece_offsets.begin(), result_->piece_offsets.end(), 0);
    result_->added_offsets.assign(offsets_->size(), 0);
  }

  // ---------------------------------------------------------------------------------------------------------
  // Domains

  // Visits all triangles from outside, region by region in the order of levels.
  void visit_all() {
    const std::size_t rows = result_->triangle_offsets.back();
    faces_.resize(rows);
    open_.resize(3 * rows + 1);
    regions_.clear();
    for (std::size_t set = 0; set + 1 < offsets_->size(); ++set) {
      if (result_->triangle_offsets[set] == result_->triangle_offsets[set + 1]) continue;
      const std::size_t hull = result_->hull_offsets[set];
      const int first = rings_.vertex_edge[vertex_of_[result_->hull[hull]]];
      entries_.clear();
      for (const bool constraints : {false, true}) {
        int e = first;
        do {
          if (is_constraint(e) == constraints) entries_.push_back({e, kNoIndex});
          e = ~edges_[e ^ 1].next;
        } while (e != first);
      }
      for (std::size_t i = 0; i < entries_.size(); ++i) enter(entries_[i]);
    }
  }

  // A visited edge has the complement of its triangle's row in place of `previous`.
  bool is_visited(int e) const { return edges_[e].previous < 0; }
  void enter(Face entry) {
    if (is_visited(entry.edge)) return;
    Region region{entry.region, 0, 0, entry.edge};
    if (entry.region != kNoIndex) {
      region.level = regions_[entry.region].level;
      region.potential = regions_[entry.region].potential;
    }
    if (is_constraint(entry.edge)) {
      ++region.level;
      Pair& entrance = pair(entry.edge);
      region.potential += (entry.edge & 1) != 0 ? -entrance.weight : entrance.weight;
      entrance.number = static_cast<std::int32_t>(regions_.size());
    }
    regions_.push_back(region);
    visit(entry.edge);
  }

  // Visits the triangles of the last region, from the one left of an edge on. A triangle's row is at its
  // middle vertex along x; see blocks/mesh.cl. Pointers that are read again and again are kept in registers.
  void visit(int first) {
    kernel::ring_edge* const edges = edges_;
    const auto* const points = rings_.points;
    const auto* const first_rows = rings_.first_rows;
    const auto* const is_constraint = is_constraint_.data();
    Face* const faces = faces_.data();
    const auto region = static_cast<std::int32_t>(regions_.size()) - 1;
    int* const open = open_.data();
    int* top = open;
    *top++ = first;
    while (top != open) {
      const int e = *--top;
      if (edges[e].previous < 0) continue;
      const int third = edges[e].next ^ 1, second = edges[third].next ^ 1;
      const int v = edges[third].to, a = edges[e].to, b = edges[second].to;
      const auto precedes = [points](int one, int other) {
        const kernel::double2 p = points[one], q = points[other];
        return static_cast<int>(p.x != q.x ? p.x < q.x : p.y < q.y);
      };
      const int v_first = precedes(v, a), a_first = precedes(a, b), b_first = precedes(b, v);
      const int middle = v_first == b_first   ? v
                         : v_first == a_first ? a
                                              : b,
                goes_right = v_first == b_first   ? v_first
                             : a_first == v_first ? a_first
                                                  : b_first;
      const kernel::uint begin = first_rows[middle];
      const int is_second = static_cast<int>(first_rows[middle + 1] - begin == 2) & goes_right;
      const std::int32_t row = static_cast<std::int32_t>(begin) + is_second;
      faces[row] = {e, region};
      edges[e].previous = ~row;
      // Beyond the first side it is visited, or outside.
      for (const int side : {second, third}) {
        edges[side].previous = ~row;
        const int twin = side ^ 1;
        if ((edges[twin].next | edges[twin].previous) < 0) continue;
        if (is_constraint[side >> 1] != 0) {
          entries_.push_back({twin, region});
        } else {
          *top++ = twin;
        }
      }
    }
  }

  // The labels of regions by the polygons around them.
  MapLabels map_labels() {
    Entrances into;
    for (const Region& region : regions_) {
      into.order.push_back(static_cast<std::int32_t>(into.order.size()));
      into.from.push_back(region.from);
    }
    const Curves& curves = *request_->curves;
    std::vector<std::pair<std::int32_t, Step>> steps;
    for (const auto& [segment, edge] : covers_) {
      const auto region = static_cast<std::size_t>(pair(edge).number);
      if (static_cast<std::size_t>(segment) >= curves.of_segments.size() || region >= regions_.size())
        continue;
      const int entrance = regions_[region].edge;
      if (entrance >> 1 != edge >> 1) continue;
      steps.emplace_back(static_cast<std::int32_t>(region),
                         Step{curves.of_segments[segment], entrance == edge ? 1 : -1});
    }
    group_steps(steps, into);
    Overlap ignored;
    return label_regions(into, curves, request_->rules.fill, ignored);
  }

  // The regions of holes. Returns false unless each is in a triangle, farther from the edges than rounding
  // can tell.
  bool find_holes() {
    const auto is_left_of = [&](int e, const double* p) {
      const double *a = request_->with_holes + 2 * static_cast<std::size_t>(id_at(origin(e))),
                   *b = request_->with_holes + 2 * static_cast<std::size_t>(id_at(edges_[e].to));
      const double left = (b[0] - a[0]) * (p[1] - a[1]), right = (b[1] - a[1]) * (p[0] - a[0]);
      return left - right > 0x1p-50 * (std::fabs(left) + std::fabs(right)) + 0x1p-960;
    };
    for (std::size_t h = 0; h < constraints_->hole_count; ++h) {
      steps_left_ -= static_cast<std::int64_t>(faces_.size());
      if (steps_left_ < 0) return false;
      const double* const p = constraints_->holes + 2 * h;
      const auto found = std::find_if(faces_.begin(), faces_.end(), [&](const Face& face) {
        const auto [second, third] = after(face.edge);
        return is_left_of(face.edge, p) && is_left_of(second, p) && is_left_of(third, p);
      });
      if (found == faces_.end()) return false;
      holes_.push_back(found->region);
    }
    return true;
  }

  // Numbers the rows that are left, and their regions.
  void leave() {
    const DepthRules& rules = request_->rules;
    Ids depths(regions_.size());
    Ids is_left(regions_.size(), 1);
    if (request_->curves != nullptr) {
      const MapLabels labels = map_labels();
      depths = labels.depths;
      for (std::size_t r = 0; r < regions_.size(); ++r)
        is_left[r] = rules.outside == Outside::keep || labels.polygons[r] >= 0;
    } else if (request_->has_depths) {
      for (std::size_t r = 0; r < regions_.size(); ++r) {
        depths[r] = kernel::depth_of(regions_[r].level, regions_[r].potential, static_cast<int>(rules.fill));
        is_left[r] =
            kernel::is_left(depths[r], static_cast<int>(rules.fill), static_cast<int>(rules.outside));
      }
    }
    for (const std::int32_t hole : holes_) is_left[hole] = 0;
    Ids numbers(regions_.size(), kNoIndex);
    std::int32_t count = 0, region_count = 0;
    rows_.resize(faces_.size());
    std::vector<std::size_t>& offsets = result_->triangle_offsets;
    for (std::size_t set = 0, row = 0; set + 1 < offsets.size(); ++set) {
      const auto first = static_cast<std::size_t>(count);
      for (const std::size_t end = offsets[set + 1]; row < end; ++row) {
        const std::int32_t is_there = is_left[faces_[row].region];
        rows_[row] = is_there != 0 ? count : kNoIndex;
        count += is_there;
      }
      offsets[set] = first;
    }
    offsets.back() = static_cast<std::size_t>(count);
    for (std::size_t row = 0; request_->labels && row < rows_.size(); ++row) {
      if (rows_[row] == kNoIndex) continue;
      std::int32_t& number = numbers[faces_[row].region];
      if (number == kNoIndex) number = region_count++;
      result_->regions.push_back(number);
      result_->depths.push_back(depths[faces_[row].region]);
    }
  }

  void write_rows() {
    const std::size_t corners = 3 * result_->triangle_offsets.back();
    result_->triangles.resize(corners);
    result_->constrained.resize(corners);
    if (request_->neighbors) result_->neighbors.resize(corners);
    const kernel::ring_edge* const edges = edges_;
    const auto* const source = rings_.source;
    const auto* const is_constraint = is_constraint_.data();
    const auto* const numbers = rows_.data();
    auto* const triangles = result_->triangles.data();
    auto* const constrained = result_->constrained.data();
    auto* const neighbors = request_->neighbors ? result_->neighbors.data() : nullptr;
    for (std::size_t row = 0; row < faces_.size(); ++row) {
      if (numbers[row] == kNoIndex) continue;
      const int e = faces_[row].edge;
      const int third = edges[e].next ^ 1, second = edges[third].next ^ 1;
      const std::int32_t v = source[edges[third].to], a = source[edges[e].to], b = source[edges[second].to];
      const kernel::row_places at = kernel::places_in_row(v, a, b);
      const auto write = [&](std::int32_t corner, std::int32_t id, int opposite) {
        triangles[corner] = id;
        constrained[corner] = is_constraint[opposite >> 1];
        if (neighbors == nullptr) return;
        const kernel::ring_edge twin = edges[opposite ^ 1];
        neighbors[corner] = twin.next < 0 ? -1 : numbers[~twin.previous];
      };
      const std::int32_t first = 3 * numbers[row];
      write(first + at.v, v, second);
      write(first + at.a, a, third);
      write(first + at.b, b, e);
    }
  }

  points::SmallRings rings_;
  kernel::ring_edge* edges_ = nullptr;
  const std::vector<std::size_t>* offsets_ = nullptr;
  const Constraints* constraints_ = nullptr;
  const SmallRequest* request_ = nullptr;
  ConstrainedTriangulation* result_ = nullptr;

  std::int32_t backward_weight_ = 1;  // of segments in the direction of the second half of a pair
  std::int64_t steps_left_ = 0;
  std::vector<kernel::uchar> is_constraint_;  // by pair of edges
  std::vector<Pair> pairs_;
  Ids vertex_of_;  // by point, if that is its own representative
  std::vector<Low> lows_, sorted_;
  // Segments and their edges, in their direction, if curves count.
  std::vector<std::pair<std::int32_t, std::int32_t>> covers_;
  Ids crossed_, lefts_, rights_;
  std::vector<std::pair<int, int>> chords_;
  Ids counts_;
  std::vector<Face> faces_;  // by row
  std::vector<Face> entries_;
  std::vector<Region> regions_;
  Ids open_, holes_;
  Ids rows_;  // by row its number if it is left
};

}  // namespace

bool constrain_small(const points::SmallRings& rings, const std::vector<std::size_t>& offsets,
                     const Constraints& constraints, const SmallRequest& request,
                     ConstrainedTriangulation& result) {
  return host::of_thread<Small>().run(rings, offsets, constraints, request, result);
}

}  // namespace flaunay::constrained
