// Each set is checked by the proof of constrained triangulations. Segments on which no point was added are
// given to it as they were; the others bend where points were rounded, so their edges take their place. These
// lead from one end of the segment to the other. Nothing else is known of such a segment between its edges,
// in accordance with the definition of splitting and refinement.
#include "prove/domain_proof.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "mesh/corners.hpp"
#include "prove/constrained_proof.hpp"
#include "prove/exact.hpp"
#include "prove/planar_proof.hpp"
#include "prove/rows.hpp"

namespace flaunay::prove {
namespace {

using Ids = std::vector<std::int32_t>;

class DomainProof {
 public:
  explicit DomainProof(const DomainClaim& claim)
      : mesh_(claim.mesh),
        constraints_(claim.constraints),
        options_(claim.options),
        offsets_(claim.offsets),
        points_(claim.points, claim.points + 2 * claim.offsets.back()),
        segments_of_(claim.offsets.size() - 1) {
    points_.insert(points_.end(), mesh_.added_points.begin(), mesh_.added_points.end());
    for (std::size_t s = 0; s < constraints_.segment_count; ++s)
      segments_of_[set_of(constraints_.segments[2 * s])].push_back(s);
  }

  void run() {
    check_flags();
    check_edge_segments();
    for (std::size_t s = 0; s + 1 < offsets_.size(); ++s) {
      const std::string problem = problem_of(s);
      require(problem.empty(), "set {}: {}", s, problem);
    }
    const Ids made = mesh_.neighbors.empty() ? neighbors_of(mesh_.triangles, points_.size() / 2) : Ids();
    check_halfedges_and_areas(points_.data(), mesh_, made.empty() ? mesh_.neighbors : made);
  }

 private:
  /// The points and the triangles of a set, numbered from 0.
  struct Part {
    std::vector<double> points;
    Ids triangles, neighbors, representatives;
    Ids segments;
    Rings rings;
    std::vector<double> holes;
    Ids edges, segment_edges, depths, regions, worse;
  };

  std::size_t given() const { return offsets_.back(); }
  std::size_t set_of(std::int32_t v) const {
    return static_cast<std::size_t>(
               std::upper_bound(offsets_.begin(), offsets_.end(), static_cast<std::size_t>(v)) -
               offsets_.begin()) -
           1;
  }
  static std::size_t at(const std::vector<std::size_t>& offsets, std::size_t s, std::size_t all) {
    return s < offsets.size() ? offsets[s] : s == 0 ? 0 : all;
  }
  std::size_t added_before(std::size_t s) const {
    return at(mesh_.added_offsets, s, points_.size() / 2 - given());
  }
  /// The number of a point in its set, behind whose points those follow that were added.
  std::int32_t number(std::size_t s, std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<std::int32_t>(
        i < given() ? i - offsets_[s] : i - given() - added_before(s) + offsets_[s + 1] - offsets_[s]);
  }
  const double* place(std::int32_t v) const { return &points_[2 * static_cast<std::size_t>(v)]; }

  /// The flags of triangles say which edges are constraints.
  void check_flags() const {
    if (mesh_.constrained.empty()) return;
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;
    for (std::size_t e = 0; e < mesh_.constraint_edges.size(); e += 2)
      edges.emplace_back(std::minmax(mesh_.constraint_edges[e], mesh_.constraint_edges[e + 1]));
    std::sort(edges.begin(), edges.end());
    for (std::size_t c = 0; c < mesh_.triangles.size(); ++c) {
      const auto [from, to] = mesh::edge_opposite(mesh_.triangles, c);
      const std::pair<std::int32_t, std::int32_t> edge = std::minmax(from, to);
      require(
          (mesh_.constrained[c] != 0) == std::binary_search(edges.begin(), edges.end(), edge),
          "triangle {} says the wrong thing of the edge opposite to corner {}: whether it is a constraint",
          c / 3, c % 3);
    }
  }

  /// Segments claim their edges in ascending order, and skip those that have been claimed.
  void check_edge_segments() const {
    const std::size_t edges = mesh_.edge_segments.size();
    std::vector<std::size_t> next(edges + 1);
    std::iota(next.begin(), next.end(), 0);
    const auto unclaimed = [&](std::size_t e) {
      while (next[e] != e) e = next[e] = next[next[e]];
      return e;
    };
    for (std::size_t s = 0; s + 1 < mesh_.piece_offsets.size(); ++s) {
      for (auto p = static_cast<std::size_t>(mesh_.piece_offsets[s]);
           p < static_cast<std::size_t>(mesh_.piece_offsets[s + 1]); ++p) {
        const auto end = static_cast<std::size_t>(mesh_.piece_edges[2 * p + 1]);
        for (std::size_t e = unclaimed(static_cast<std::size_t>(mesh_.piece_edges[2 * p])); e < end;
             e = unclaimed(e)) {
          require(mesh_.edge_segments[e] == static_cast<std::int32_t>(s),
                  "constraint edge {} is said to be a part of segment {} first, but it is one of segment {}",
                  e, mesh_.edge_segments[e], s);
          next[e] = e + 1;
        }
      }
    }
    require(unclaimed(0) == edges, "constraint edge {} is a part of no segment", unclaimed(0));
  }

  /// The hull is that of the points, with those on its edges; or where refinement has split these, the border
  /// of the triangles, if all are there.
  void check_hull(std::size_t s, const Part& part) const {
    Ids hull;
    for (std::size_t k = mesh_.hull_offsets[s]; k < mesh_.hull_offsets[s + 1]; ++k)
      hull.push_back(number(s, mesh_.hull[k]));
    const auto n = static_cast<std::int32_t>(part.representatives.size());
    const bool is_here =
        std::all_of(hull.begin(), hull.end(), [n](std::int32_t v) { return v >= 0 && v < n; });
    require(is_here, "the hull has a point of another set");
    if (mesh_.refinement.added_points == 0) {
      require(hull == hull_of(part), "the hull is not that of the points");
      return;
    }
    if (options_.outside != Outside::keep || !part.holes.empty() || options_.refinement.mesh.count > 0)
      return;
    const Ids beyond = neighbors_of(part.triangles, part.points.size() / 2);
    Ids next(part.points.size() / 2, -1);
    std::size_t open = 0;
    for (std::size_t c = 0; c < beyond.size(); ++c) {
      if (beyond[c] >= 0) continue;
      const auto [from, to] = mesh::edge_opposite(part.triangles, c);
      next[static_cast<std::size_t>(from)] = to;
      ++open;
    }
    require(open == hull.size(), "the hull has {} points, but the border of the triangles has {}",
            hull.size(), open);
    for (std::size_t k = 0; k < hull.size(); ++k) {
      require(next[static_cast<std::size_t>(hull[k])] == hull[(k + 1) % hull.size()],
              "the hull is not the border of the triangles at point {}", hull[k]);
    }
  }
  /// Andrew's chains (1979), from the lexicographically smallest point on. If all points are collinear, they
  /// are returned in lexicographic order.
  static Ids hull_of(const Part& part) {
    const auto place = [&](std::int32_t v) { return &part.points[2 * static_cast<std::size_t>(v)]; };
    Ids order;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(part.representatives.size()); ++v) {
      if (part.representatives[static_cast<std::size_t>(v)] == v) order.push_back(v);
    }
    std::sort(order.begin(), order.end(),
              [&](std::int32_t a, std::int32_t b) { return comes_before(place(a), place(b)); });
    ExactPredicates predicates;
    const auto is_straight = [&](std::int32_t v) {
      return predicates.orient2d(place(order.front()), place(order.back()), place(v)) == 0;
    };
    if (std::all_of(order.begin(), order.end(), is_straight)) return order;
    Ids hull;
    for (int side = 0; side < 2; ++side) {
      Ids chain;
      for (const std::int32_t v : order) {
        while (chain.size() > 1 &&
               predicates.orient2d(place(chain[chain.size() - 2]), place(chain.back()), place(v)) < 0)
          chain.pop_back();
        chain.push_back(v);
      }
      hull.insert(hull.end(), chain.begin(), chain.end() - 1);
      std::reverse(order.begin(), order.end());
    }
    return hull;
  }

  std::string problem_of(std::size_t s) {
    Part part;
    const auto copy = [&](std::size_t first, std::size_t last) {
      part.points.insert(part.points.end(), points_.begin() + static_cast<std::ptrdiff_t>(2 * first),
                         points_.begin() + static_cast<std::ptrdiff_t>(2 * last));
      for (std::size_t i = first; i < last; ++i)
        part.representatives.push_back(number(s, mesh_.representatives[i]));
    };
    copy(offsets_[s], offsets_[s + 1]);
    copy(given() + added_before(s), given() + added_before(s + 1));
    const std::size_t begin = mesh_.triangle_offsets[s], end = mesh_.triangle_offsets[s + 1];
    for (std::size_t c = 3 * begin; c < 3 * end; ++c) {
      part.triangles.push_back(number(s, mesh_.triangles[c]));
      if (mesh_.neighbors.empty()) continue;
      part.neighbors.push_back(
          mesh_.neighbors[c] < 0 ? -1 : mesh_.neighbors[c] - static_cast<std::int32_t>(begin));
    }
    Representatives(part.points, part.representatives, part.triangles).run();
    list_holes(s, part);
    check_hull(s, part);

    VerifyConstraints asked;
    asked.outside = options_.outside;
    asked.fill_rule = options_.fill_rule;
    const std::vector<std::size_t> positions = list_segments(s, part);
    if (options_.refinement.mesh.count > 0) {
      use_own_border(s, part);
      asked.outside = Outside::hull;
      asked.fill_rule = FillRule::winding;
      part.holes.clear();
    } else if (!constraints_.rings.segment_offsets.empty()) {
      list_rings(s, positions, part);
    }
    asked.segments = &part.segments;
    if (!part.rings.segment_offsets.empty()) asked.rings = &part.rings;
    if (!part.holes.empty()) asked.holes = &part.holes;
    const auto some = [&](const Ids& all, Ids& to) {
      to.assign(all.begin() + static_cast<std::ptrdiff_t>(begin),
                all.begin() + static_cast<std::ptrdiff_t>(end));
      return &to;
    };
    if (!mesh_.depths.empty() && options_.refinement.mesh.count == 0)
      asked.depths = some(mesh_.depths, part.depths);
    if (!mesh_.regions.empty()) {
      asked.regions = some(mesh_.regions, part.regions);
      std::int32_t next = regions_;
      for (std::int32_t& region : part.regions) {
        next = std::max(next, region + 1);
        region -= regions_;
      }
      regions_ = next;
    }
    if (!part.segment_edges.empty()) {
      asked.edges = &part.edges;
      asked.segment_edges = &part.segment_edges;
    }
    ask_for_quality(begin, end, part, asked);
    return verify_constrained(part.points.data(), part.points.size() / 2, part.triangles,
                              mesh_.neighbors.empty() ? nullptr : &part.neighbors, asked)
        .problem;
  }

  /// The first of several equal points must represent them all, and corners themselves.
  class Representatives : RowsProof {
   public:
    Representatives(const std::vector<double>& points, const Ids& representatives, const Ids& triangles)
        : RowsProof({triangles, triangles, representatives, points_of_, triangles_of_}),
          places_(points),
          points_of_{0, representatives.size()},
          triangles_of_{0, triangles.size() / 3} {}
    void run() {
      enter(0);
      check_representatives([&](std::size_t i) { return std::pair(places_[2 * i], places_[2 * i + 1]); });
      for (std::size_t c = 0; c < rows_.triangles.size(); ++c) check_vertex(rows_.triangles[c], c / 3);
    }

   private:
    const std::vector<double>& places_;
    std::vector<std::size_t> points_of_, triangles_of_;
  };

  /// Lists the segments of a set, or if some of them bend, the edges of all in their place. Returns where in
  /// the list each segment begins, and its end.
  std::vector<std::size_t> list_segments(std::size_t s, Part& part) const {
    std::vector<Ids> chains;
    bool bends = added_before(s) < added_before(s + 1);
    for (const std::size_t segment : segments_of_[s]) {
      chains.push_back(chain_of(segment));
      bends = bends || mesh_.piece_offsets[segment + 1] > mesh_.piece_offsets[segment] + 1 ||
              (options_.crossings == Crossings::split && !is_straight(chains.back()));
    }
    std::vector<std::size_t> positions;
    std::int32_t first_edge = std::numeric_limits<std::int32_t>::max(), end_edge = 0;
    const auto add = [&](std::int32_t a, std::int32_t b) {
      part.segments.insert(part.segments.end(), {number(s, a), number(s, b)});
    };
    for (std::size_t i = 0; i < chains.size(); ++i) {
      const std::size_t segment = segments_of_[s][i];
      positions.push_back(part.segments.size() / 2);
      if (!bends || chains[i].empty()) {
        add(constraints_.segments[2 * segment], constraints_.segments[2 * segment + 1]);
      } else {
        for (std::size_t k = 1; k < chains[i].size(); ++k) add(chains[i][k - 1], chains[i][k]);
      }
      const bool has_none = mesh_.piece_offsets[segment] == mesh_.piece_offsets[segment + 1];
      constexpr std::int32_t kNoEdges[] = {0, 0};
      const std::int32_t* const range =
          has_none ? kNoEdges
                   : &mesh_.piece_edges[2 * static_cast<std::size_t>(mesh_.piece_offsets[segment])];
      part.segment_edges.insert(part.segment_edges.end(), {range[0], range[1]});
      if (range[0] == range[1]) continue;
      first_edge = std::min(first_edge, range[0]);
      end_edge = std::max(end_edge, range[1]);
    }
    positions.push_back(part.segments.size() / 2);
    if (bends) part.segment_edges.clear();
    for (std::int32_t& e : part.segment_edges) e = std::max(e - first_edge, 0);
    for (std::int32_t e = first_edge; e < end_edge; ++e) {
      for (std::int32_t k = 2 * e; k < 2 * e + 2; ++k)
        part.edges.push_back(number(s, mesh_.constraint_edges[k]));
    }
    return positions;
  }

  /// The points that a segment's edges lead through, in its direction. Empty if its ends have one place.
  Ids chain_of(std::size_t segment) const {
    Ids chain;
    const std::int32_t* const ends = &constraints_.segments[2 * segment];
    const std::int32_t a = mesh_.representatives[ends[0]], b = mesh_.representatives[ends[1]];
    for (std::int32_t p = mesh_.piece_offsets[segment]; p < mesh_.piece_offsets[segment + 1]; ++p) {
      for (std::int32_t e = mesh_.piece_edges[2 * p]; e < mesh_.piece_edges[2 * p + 1]; ++e) {
        const std::int32_t* const edge = &mesh_.constraint_edges[2 * e];
        require(chain.empty() || chain.back() == edge[0],
                "the edges of segment {} do not follow each other at edge {}", segment, e);
        if (chain.empty()) chain.push_back(edge[0]);
        chain.push_back(edge[1]);
      }
    }
    if (chain.empty()) {
      require(a == b, "segment {} has no edges", segment);
      return chain;
    }
    if (chain.front() == b) std::reverse(chain.begin(), chain.end());
    require(chain.front() == a && chain.back() == b,
            "the edges of segment {} do not lead from one end to the other", segment);
    const bool has_added = std::any_of(
        chain.begin(), chain.end(), [&](std::int32_t v) { return static_cast<std::size_t>(v) >= given(); });
    require(has_added || options_.crossings == Crossings::split || is_straight(chain),
            "the edges of segment {} do not lie on it", segment);
    return chain;
  }
  bool is_straight(const Ids& chain) const {
    ExactPredicates predicates;
    return std::all_of(chain.begin(), chain.end(), [&](std::int32_t v) {
      return predicates.orient2d(place(chain.front()), place(chain.back()), place(v)) == 0;
    });
  }

  void list_holes(std::size_t s, Part& part) const {
    const std::size_t first = at(constraints_.hole_offsets, s, constraints_.hole_count),
                      last = at(constraints_.hole_offsets, s + 1, constraints_.hole_count);
    if (first < last) part.holes.assign(constraints_.holes + 2 * first, constraints_.holes + 2 * last);
  }

  /// Lists the rings of polygons with segments in the set. positions: of the set's segments in the part's
  /// list.
  void list_rings(std::size_t s, const std::vector<std::size_t>& positions, Part& part) const {
    const Rings& all = constraints_.rings;
    const std::vector<std::size_t>& own = segments_of_[s];
    const auto position = [&](std::size_t segment) {
      return positions[static_cast<std::size_t>(std::lower_bound(own.begin(), own.end(), segment) -
                                                own.begin())];
    };
    part.rings = {{0}, {0}, {0}};
    for (std::size_t p = 0, q = 0; p + 1 < all.polygon_offsets.size(); ++p) {
      const std::size_t first = all.segment_offsets[all.polygon_offsets[p]],
                        last = all.segment_offsets[all.polygon_offsets[p + 1]];
      const bool is_here = first < last && std::binary_search(own.begin(), own.end(), first);
      for (std::size_t r = all.polygon_offsets[p]; is_here && r < all.polygon_offsets[p + 1]; ++r)
        part.rings.segment_offsets.push_back(position(all.segment_offsets[r + 1]));
      for (; q + 1 < all.part_offsets.size() && all.part_offsets[q] < all.polygon_offsets[p + 1]; ++q) {
        if (is_here) {
          part.rings.part_offsets.push_back(part.rings.part_offsets.back() + all.part_offsets[q + 1] -
                                            all.part_offsets[q]);
        }
      }
      if (is_here) part.rings.polygon_offsets.push_back(part.rings.segment_offsets.size() - 1);
    }
  }

  /// The area of a given mesh is inside of its triangles' own border: the border is a ring, and all edges of
  /// segments are on it. The total area must be that of the given mesh.
  void use_own_border(std::size_t s, Part& part) const {
    const Ids made = neighbors_of(part.triangles, part.points.size() / 2);
    part.segments.clear();
    part.segment_edges.clear();
    for (std::size_t c = 0; c < part.triangles.size(); ++c) {
      if (made[c] >= 0) continue;
      const auto [from, to] = mesh::edge_opposite(part.triangles, c);
      part.segments.insert(part.segments.end(), {from, to});
    }
    part.rings = {{0, part.segments.size() / 2}, {0, 1}, {0, 1}};
    for (std::size_t e = 0; e < mesh_.constraint_edges.size(); e += 2) {
      const std::int32_t* const ends = &mesh_.constraint_edges[e];
      if (is_of_set(s, ends[0]))
        part.segments.insert(part.segments.end(), {number(s, ends[0]), number(s, ends[1])});
    }
    if (!part.holes.empty()) return;
    const GivenTriangles& before = options_.refinement.mesh;
    double given_area = 0, area = 0;
    for (std::size_t t = 0; t < before.count; ++t) {
      if (is_of_set(s, before.triangles[3 * t]))
        given_area += std::fabs(area_of(points_.data(), before.triangles + 3 * t));
    }
    for (std::size_t c = 0; c < part.triangles.size(); c += 3)
      area += area_of(part.points.data(), &part.triangles[c]);
    constexpr double kSlack = 1e-6;  // points on the border are rounded
    require(std::fabs(area - given_area) <= kSlack * given_area,
            "the triangles have the area {}, but those that they were made from {}", area, given_area);
  }
  bool is_of_set(std::size_t s, std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return i < given() ? offsets_[s] <= i && i < offsets_[s + 1]
                       : added_before(s) <= i - given() && i - given() < added_before(s + 1);
  }
  static double area_of(const double* points, const std::int32_t* v) {
    const double *const a = points + 2 * v[0], *const b = points + 2 * v[1], *const c = points + 2 * v[2];
    return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }

  void ask_for_quality(std::size_t begin, std::size_t end, Part& part, VerifyConstraints& asked) const {
    const Refinement& wanted = options_.refinement;
    if (!wanted.is_wanted() && mesh_.refinement.added_points == 0) return;
    asked.min_angle = wanted.min_angle;
    // Infinite if only other areas are asked for, so that it is known to be refined.
    asked.max_area = wanted.max_area > 0 ? wanted.max_area : HUGE_VAL;
    asked.conforming = wanted.conforming;
    const Ids& worse = mesh_.refinement.bad_triangles;
    for (const std::int32_t t : worse) {
      const auto i = static_cast<std::size_t>(t);
      if (begin <= i && i < end) part.worse.push_back(static_cast<std::int32_t>(i - begin));
    }
    if (!wanted.conforming || !worse.empty()) asked.worse = &part.worse;
  }

  const ConstrainedTriangulation& mesh_;
  const Constraints& constraints_;
  const ConstrainedOptions& options_;
  const std::vector<std::size_t>& offsets_;
  std::vector<double> points_;                         // and those that were added
  std::vector<std::vector<std::size_t>> segments_of_;  // of each set
  std::int32_t regions_ = 0;                           // of the sets before
};

}  // namespace

std::string find_problem(const DomainClaim& claim) {
  return problem_in([&] { DomainProof(claim).run(); });
}

}  // namespace flaunay::prove
