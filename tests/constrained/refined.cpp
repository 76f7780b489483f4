#include "tests/constrained/refined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "constrained/refinement/bounds.hpp"
#include "geometry/magnitudes.hpp"
#include "prove/exact.hpp"
#include "tests/constrained/check.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

using constrained::MeshToRefine;
using constrained::RefinedMesh;
using Index = std::int32_t;

/// The squared cosine of the angle below which segments are at an apex: 60 degrees less 6e-8.
constexpr double kSharp = 0.25 + 0x1p-30;
/// Of lengths along segments, which are compared without being exact.
constexpr double kLengthSlack = 1e-6;
/// Vertices on a segment may be off it by this part of the largest coordinate, and by some of the smallest
/// double.
constexpr double kOff = 4 * 0x1p-53, kSmallestOff = 4;
/// Triangles whose heights are below this part of the largest coordinate, or so many of the smallest double,
/// are near to what rounding can tell apart.
constexpr double kCoarse = 0x1p-40, kSmallestCoarse = 0x1p13;

std::size_t after(std::size_t c) { return c % 3 == 2 ? c - 2 : c + 1; }

class Check {
 public:
  Check(const MeshToRefine& mesh, const RefinedMesh& refined, const Refinement& wanted)
      : mesh_(mesh),
        refined_(refined),
        wanted_(wanted),
        bounds_(constrained::quality_bounds(wanted.min_angle)) {
    points_.assign(mesh.coordinates, mesh.coordinates + 2 * mesh.points);
    points_.insert(points_.end(), refined.added.begin(), refined.added.end());
    // Scaled, so that products of lengths are doubles.
    scale_ = geometry::scaling_for(geometry::inspect(mesh.coordinates, 0, mesh.points)).shift;
    for (double& x : points_) x = std::ldexp(x, scale_);
    double low[2] = {0, 0}, high[2] = {0, 0};
    for (std::size_t i = 0; i < 2 * mesh.points; ++i) {
      const double value = points_[i];
      largest_ = std::max(largest_, std::fabs(value));
      low[i % 2] = i < 2 ? value : std::min(low[i % 2], value);
      high[i % 2] = i < 2 ? value : std::max(high[i % 2], value);
    }
    extent_ = std::max(high[0] - low[0], high[1] - low[1]);
    min_edge_ = wanted.min_edge >= 0 ? std::ldexp(wanted.min_edge, scale_)
                                     : std::max(0x1p-40 * extent_, 0x1p-48 * largest_);
    const double smallest = std::ldexp(std::numeric_limits<double>::denorm_min(), scale_);
    off_ = std::max(kOff * largest_, kSmallestOff * smallest);
    coarse_ = std::max(kCoarse * largest_, kSmallestCoarse * smallest);
  }

  std::string run() {
    check_sizes();
    if (!is_wanted() && !refined_.added.empty()) wrong("points were added that nobody asked for");
    if (problem_.empty()) check_triangles();
    if (problem_.empty()) check_chains();
    if (problem_.empty()) check_lengths();
    if (problem_.empty()) check_parents();
    if (problem_.empty()) check_quality();
    if (problem_.empty()) check_encroachment();
    return problem_;
  }

 private:
  void wrong(const std::string& what) {
    if (problem_.empty()) problem_ = what;
  }
  bool is_wanted() const { return wanted_.is_wanted() || !mesh_.largest_areas.empty(); }
  const double* at(Index v) const { return &points_[2 * static_cast<std::size_t>(v)]; }
  const double* corner(std::size_t c) const { return at(refined_.triangles[c]); }
  double length(Index a, Index b) const { return std::hypot(at(a)[0] - at(b)[0], at(a)[1] - at(b)[1]); }
  bool is_kept(Index edge) const { return !mesh_.kept_edges.empty() && mesh_.kept_edges[edge] != 0; }
  std::string place(Index v) const { return fmt::format("{} ({}, {})", v, at(v)[0], at(v)[1]); }

  void check_sizes() {
    const std::size_t added = refined_.added.size() / 2, corners = refined_.triangles.size();
    const RefinementReport& report = refined_.report;
    if (refined_.added_edges.size() != added || refined_.added_places.size() != added ||
        report.added_points != added || refined_.neighbors.size() != corners ||
        refined_.edges.size() != corners || refined_.parents.size() != corners / 3 ||
        report.bad_triangles.size() != report.excuses.size()) {
      return wrong("sizes of arrays");
    }
    const auto on_edges = std::count_if(refined_.added_edges.begin(), refined_.added_edges.end(),
                                        [](Index e) { return e >= 0; });
    if (report.split_points != static_cast<std::size_t>(on_edges)) wrong("number of points on constraints");
    if (added > wanted_.most_points) wrong("more points than allowed");
    if (report.rounds > wanted_.most_rounds) wrong("more rounds than allowed");
    const std::set<Index> listed(report.bad_triangles.begin(), report.bad_triangles.end());
    if (listed.size() != report.bad_triangles.size() ||
        !std::is_sorted(report.bad_triangles.begin(), report.bad_triangles.end()))
      wrong("bad triangles are not ascending");
    if (!std::all_of(points_.begin(), points_.end(), [](double x) { return std::isfinite(x); }))
      wrong("a point is not finite");
  }

  // Counter-clockwise, neighbours, rows, all points used, and constrained Delaunay with canonical ties.
  void check_triangles() {
    const std::vector<Index>& rows = refined_.triangles;
    std::set<Index> used(rows.begin(), rows.end()), expected(mesh_.triangles.begin(), mesh_.triangles.end());
    for (std::size_t k = 0; k < refined_.added.size() / 2; ++k)
      expected.insert(static_cast<Index>(mesh_.points + k));
    if (used != expected) return wrong("points in triangles are not those of the mesh and those added");
    try {
      if (reference_neighbors(rows) != refined_.neighbors) return wrong("neighbours");
    } catch (const std::logic_error& error) {
      return wrong(error.what());
    }
    const auto before = [this](Index a, Index b) {
      return std::pair(at(a)[0], at(a)[1]) < std::pair(at(b)[0], at(b)[1]);
    };
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const std::size_t t = c / 3, b = after(c), d = after(b);
      const std::string name = "triangle " + std::to_string(t) + " at " + place(rows[3 * t]);
      if (c % 3 == 0) {
        if (exact_.orient2d(at(rows[c]), at(rows[b]), at(rows[d])) <= 0)
          return wrong(name + " is not counter-clockwise");
        if (rows[c] >= rows[b] || rows[c] >= rows[d])
          return wrong(name + " does not begin with its smallest index");
      }
      const Index beyond = refined_.neighbors[c], edge = refined_.edges[c];
      if (beyond < 0) {
        if (edge < 0) return wrong(name + " has a border that is no edge");
        continue;
      }
      auto opposite = 3 * static_cast<std::size_t>(beyond);
      while (rows[opposite] == rows[b] || rows[opposite] == rows[d]) ++opposite;
      if (refined_.edges[opposite] != edge) return wrong(name + " and its neighbour have different edges");
      if (edge >= 0) continue;
      const int side = exact_.incircle(at(rows[c]), at(rows[b]), at(rows[d]), at(rows[opposite]));
      if (side > 0) return wrong(name + " is not locally Delaunay");
      const Index first = std::min({rows[c], rows[b], rows[d], rows[opposite]}, before);
      if (side == 0 && first != rows[b] && first != rows[d]) return wrong(name + " is not in a fan");
    }
  }

  // Each edge is a chain from end to end, with triangles on the sides on which the mesh has some.
  void check_chains() {
    const std::size_t count = mesh_.edge_ends.size() / 2;
    // The directed sides of each edge: bit 0 from its first end to its second, bit 1 back.
    sides_.assign(count, 0);
    inputs_.assign(2 * count, -1);
    for (std::size_t c = 0; c < mesh_.edges.size(); ++c) {
      if (mesh_.edges[c] < 0) continue;
      const auto e = static_cast<std::size_t>(mesh_.edges[c]);
      const bool is_back = mesh_.triangles[after(c)] != mesh_.edge_ends[2 * e];
      sides_[e] |= is_back ? 2 : 1;
      inputs_[2 * e + is_back] = static_cast<Index>(c / 3);
    }
    std::vector<std::map<Index, Index>> forward(count), back(count);
    const auto along = [&](std::size_t e, Index v) {
      const double *a = at(mesh_.edge_ends[2 * e]), *b = at(mesh_.edge_ends[2 * e + 1]), *p = at(v);
      return (p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1]);
    };
    backward_.assign(refined_.edges.size(), 0);
    for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
      if (refined_.edges[c] < 0) continue;
      const auto e = static_cast<std::size_t>(refined_.edges[c]);
      if (e >= count) return wrong("an edge that the mesh does not have");
      const Index u = refined_.triangles[after(c)], v = refined_.triangles[after(after(c))];
      backward_[c] = along(e, u) > along(e, v);
      auto& links = backward_[c] ? back[e] : forward[e];
      if (!links.emplace(backward_[c] ? v : u, backward_[c] ? u : v).second)
        return wrong("an edge that branches");
    }
    std::vector<std::size_t> pieces(count, 0);
    for (std::size_t e = 0; e < count; ++e) {
      const std::string name = "edge " + std::to_string(e) + " from " + place(mesh_.edge_ends[2 * e]);
      for (const int side : {1, 2}) {
        auto& links = side == 1 ? forward[e] : back[e];
        if ((sides_[e] & side) == 0) {
          if (!links.empty()) return wrong(name + " has triangles on a side that had none");
          continue;
        }
        Index v = mesh_.edge_ends[2 * e];
        std::size_t steps = 0;
        for (auto next = links.find(v); next != links.end(); next = links.find(v), ++steps) {
          v = next->second;
          const auto k = static_cast<std::size_t>(v) - mesh_.points;
          const bool is_end = v == mesh_.edge_ends[2 * e + 1];
          if (!is_end && (static_cast<std::size_t>(v) < mesh_.points ||
                          refined_.added_edges[k] != static_cast<Index>(e)))
            return wrong(name + " has the vertex " + place(v) + " of something else");
          if (!is_end) check_on_edge(e, v);
        }
        if (v != mesh_.edge_ends[2 * e + 1] || steps != links.size()) return wrong(name + " is no chain");
        pieces[e] = std::max(pieces[e], steps);
      }
      if ((sides_[e] == 3) && forward[e] != back[e])
        return wrong(name + " has different pieces on its sides");
      if (is_kept(static_cast<Index>(e)) && pieces[e] > 1) return wrong(name + " should be kept");
    }
    std::vector<std::size_t> points(count, 0);
    for (const Index e : refined_.added_edges) {
      if (e >= 0) ++points[e];
    }
    for (std::size_t e = 0; e < count; ++e) {
      if (sides_[e] != 0 && points[e] + 1 != pieces[e])
        wrong("edge " + std::to_string(e) + " does not have its points");
    }
  }

  void check_on_edge(std::size_t e, Index v) {
    const double *a = at(mesh_.edge_ends[2 * e]), *b = at(mesh_.edge_ends[2 * e + 1]), *p = at(v);
    // Differences of such numbers are exact, or nearly so.
    using Exact = long double;
    const Exact ux = Exact{b[0]} - a[0], uy = Exact{b[1]} - a[1], vx = Exact{p[0]} - a[0],
                vy = Exact{p[1]} - a[1];
    if (std::fabs(ux * vy - uy * vx) / std::hypot(ux, uy) > off_)
      wrong("point " + place(v) + " is not on edge " + std::to_string(e));
  }

  // No point is put nearer to another one than the smallest edge. The nearest one that it sees is a
  // neighbour.
  void check_lengths() {
    for (std::size_t c = 0; c < refined_.triangles.size(); ++c) {
      const Index u = refined_.triangles[c], v = refined_.triangles[after(c)];
      if (static_cast<std::size_t>(std::max(u, v)) >= mesh_.points &&
          length(u, v) < min_edge_ * (1 - 0x1p-48))
        return wrong("points " + place(u) + " and " + place(v) + " are nearer than the smallest edge");
    }
  }

  void check_parents() {
    const std::vector<Index> before = regions_of(mesh_.neighbors, mesh_.edges);
    const std::vector<Index> now = regions_of(refined_.neighbors, refined_.edges);
    std::map<Index, Index> region_of;
    for (std::size_t t = 0; t < now.size(); ++t) {
      const Index parent = refined_.parents[t];
      if (parent < 0 || static_cast<std::size_t>(parent) >= before.size())
        return wrong("a parent is no triangle");
      if (region_of.emplace(now[t], before[parent]).first->second != before[parent])
        return wrong("parents of a region are in different regions");
      for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
        if (refined_.edges[c] < 0) continue;
        const Index beside = inputs_[2 * static_cast<std::size_t>(refined_.edges[c]) + backward_[c]];
        if (before[beside] != before[parent])
          return wrong("the parent of triangle " + std::to_string(t) + " is in another region");
      }
      if (mesh_.largest_areas.empty()) continue;
      // If areas differ within a region, the parent has the centroid in it, which is rounded.
      const auto own = 3 * static_cast<std::size_t>(refined_.parents[t]);
      for (std::size_t c = own; c < own + 3; ++c) {
        const Index beyond = mesh_.neighbors[c];
        if (mesh_.edges[c] >= 0 || mesh_.largest_areas[c / 3] == mesh_.largest_areas[beyond]) continue;
        const double *a = at(mesh_.triangles[after(c)]), *b = at(mesh_.triangles[after(after(c))]);
        const double x = (corner(3 * t)[0] + corner(3 * t + 1)[0] + corner(3 * t + 2)[0]) / 3 - a[0],
                     y = (corner(3 * t)[1] + corner(3 * t + 1)[1] + corner(3 * t + 2)[1]) / 3 - a[1];
        const double ux = b[0] - a[0], uy = b[1] - a[1];
        if ((ux * y - uy * x) / std::hypot(ux, uy) < -off_)
          return wrong("the centroid of triangle " + std::to_string(t) + " is not in its parent");
      }
    }
  }

  double largest_area(std::size_t t) const {
    const double of_parent = mesh_.largest_areas.empty() ? 0 : mesh_.largest_areas[refined_.parents[t]];
    if (of_parent > 0 && wanted_.max_area > 0) return std::min(of_parent, wanted_.max_area);
    return of_parent > 0 ? of_parent : wanted_.max_area;
  }
  /// As coordinates are scaled. An area that is too small for that is one, too.
  double scaled_area(double area) const {
    return area > 0 ? std::max(std::ldexp(area, 2 * scale_), std::numeric_limits<double>::min()) : 0;
  }

  /// The corners whose opposite edges are shortest.
  std::vector<std::size_t> smallest_angles(std::size_t t) {
    std::vector<std::size_t> smallest;
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      const double *a = corner(c), *b = corner(after(c)), *d = corner(after(after(c)));
      if (exact_.compare_lengths(b, d, a) <= 0 && exact_.compare_lengths(d, b, a) <= 0) smallest.push_back(c);
    }
    return smallest;
  }

  bool is_thin(std::size_t t) {
    const std::vector<std::size_t> smallest = smallest_angles(t);
    return std::any_of(smallest.begin(), smallest.end(), [this](std::size_t c) {
      return exact_.compare_sine(corner(c), corner(after(c)), corner(after(after(c))), bounds_.squared_sine) <
             0;
    });
  }

  bool is_larger(std::size_t t, double area) {
    return area > 0 && exact_.compare_area(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2), area) > 0;
  }

  /// Whether the angle at a corner encroaches the edge opposite to it.
  bool sees_flat(std::size_t c) {
    const double *p = corner(c), *a = corner(after(c)), *b = corner(after(after(c)));
    return wanted_.conforming ? exact_.compare_cosine(p, a, b, 0) < 0
                              : exact_.compare_cosine(p, a, b, -bounds_.squared_cosine) <= 0;
  }
  /// Whether a triangle has to be better for a conforming mesh.
  bool encroaches(std::size_t t) {
    for (std::size_t c = 3 * t; wanted_.conforming && c < 3 * t + 3; ++c) {
      if (refined_.edges[c] >= 0 && sees_flat(c)) return true;
    }
    return false;
  }

  // Exactly the triangles that are bad are listed, each with a reason that holds.
  void check_quality() {
    const RefinementReport& report = refined_.report;
    std::size_t next = 0;
    for (std::size_t t = 0; t < refined_.triangles.size() / 3; ++t) {
      double by_place = 0;
      if (wanted_.areas_at) {
        double middle[2];
        for (int k = 0; k < 2; ++k)
          middle[k] =
              std::ldexp((corner(3 * t)[k] + corner(3 * t + 1)[k] + corner(3 * t + 2)[k]) / 3, -scale_);
        wanted_.areas_at(middle, 1, &by_place);
        by_place = std::isfinite(by_place) ? scaled_area(by_place) : 0;
      }
      // The place is rounded, so the area that it may have is too: between places as far apart as the extent,
      // areas differ by no more than this times the smallest one.
      constexpr double kRange = 100;
      const double slack = 1 + 1e-3 + kRange * off_ / extent_;
      const bool is_large = is_larger(t, scaled_area(largest_area(t))) || is_larger(t, by_place * slack);
      const bool may_be_large = is_large || is_larger(t, by_place / slack);
      const bool has_small_angle = is_thin(t);
      const std::string name = "triangle " + std::to_string(t) + " at " + place(refined_.triangles[3 * t]);
      const bool is_listed =
          next < report.bad_triangles.size() && report.bad_triangles[next] == static_cast<Index>(t);
      if (!is_listed) {
        if (has_small_angle) return wrong(name + " has a smaller angle and no excuse");
        if (is_large) return wrong(name + " is larger and has no excuse");
        if (encroaches(t)) return wrong(name + " encroaches an edge and has no excuse");
        continue;
      }
      if (!has_small_angle && !may_be_large && !encroaches(t)) return wrong(name + " is not bad, but listed");
      const Excuse excuse = report.excuses[next++];
      if (is_large && (excuse == Excuse::input_angle || excuse == Excuse::near_apex))
        return wrong(name + " is larger, which no angle excuses");
      const std::string problem = what_is_wrong_with(excuse, t);
      if (!problem.empty()) return wrong(name + ": " + problem);
    }
    if (next != report.bad_triangles.size()) wrong("bad triangles that there are not");
  }

  std::string what_is_wrong_with(Excuse excuse, std::size_t t) {
    switch (excuse) {
      case Excuse::input_angle:
        return is_input_angle(t) ? "" : "its smallest angle is not between segments";
      case Excuse::near_apex:
        return is_near_apex(t) ? "" : "it is not near an apex";
      case Excuse::min_edge:
        return is_short(t) ? "" : "nothing near it is short";
      case Excuse::kept:
        return std::count(mesh_.kept_edges.begin(), mesh_.kept_edges.end(), 1) > 0 ? "" : "no edge is kept";
      case Excuse::frozen:
        return has_coarse_piece() || has_flat_piece() ? "" : "rounding would allow a split";
      case Excuse::most_points:
        return refined_.report.added_points == wanted_.most_points ? "" : "more points were allowed";
      case Excuse::most_rounds:
        return refined_.report.rounds == wanted_.most_rounds ? "" : "more rounds were allowed";
    }
    return "no such excuse";
  }

  bool is_input_angle(std::size_t t) {
    const auto smallest = smallest_angles(t);
    return std::any_of(smallest.begin(), smallest.end(), [&](std::size_t c) {
      return static_cast<std::size_t>(refined_.triangles[c]) < mesh_.points &&
             refined_.edges[after(c)] >= 0 && refined_.edges[after(after(c))] >= 0;
    });
  }

  /// The edges that a vertex is on.
  std::vector<Index> edges_at(Index v) {
    if (static_cast<std::size_t>(v) >= mesh_.points) {
      const Index e = refined_.added_edges[static_cast<std::size_t>(v) - mesh_.points];
      return e < 0 ? std::vector<Index>() : std::vector<Index>(1, e);
    }
    if (ending_.empty()) {
      ending_.resize(mesh_.points);
      for (std::size_t i = 0; i < mesh_.edge_ends.size(); ++i)
        ending_[mesh_.edge_ends[i]].push_back(static_cast<Index>(i / 2));
    }
    return ending_[v];
  }

  /// Whether two edges that end at a point are at less than 60 degrees there, by more than rounding makes of
  /// 60, with triangles of the mesh all the way between them.
  bool are_sharp_inside(Index v, Index e, Index f) {
    if (exact_.orient2d(at(v), at(other_end(e, v)), at(other_end(f, v))) < 0) std::swap(e, f);
    if (exact_.compare_cosine(at(v), at(other_end(e, v)), at(other_end(f, v)), kSharp) <= 0) return false;
    for (std::size_t c = 0; c < mesh_.triangles.size(); ++c) {
      if (mesh_.triangles[c] != v || mesh_.edges[after(after(c))] != e) continue;
      for (std::size_t side = after(c); mesh_.edges[side] != f;) {
        const Index beyond = mesh_.neighbors[side];
        if (beyond < 0) return false;
        side = 3 * static_cast<std::size_t>(beyond);
        while (mesh_.triangles[after(after(side))] != v) ++side;
      }
      return true;
    }
    return false;
  }
  Index other_end(Index e, Index v) const {
    const Index first = mesh_.edge_ends[2 * static_cast<std::size_t>(e)];
    return first != v ? first : mesh_.edge_ends[2 * static_cast<std::size_t>(e) + 1];
  }

  bool is_near_apex(std::size_t t) {
    for (const std::size_t c : smallest_angles(t)) {
      if (refined_.edges[c] >= 0) continue;
      const Index p = refined_.triangles[after(c)], q = refined_.triangles[after(after(c))];
      for (const Index e : edges_at(p)) {
        for (const Index f : edges_at(q)) {
          if (e == f) continue;
          for (std::size_t k = 2 * static_cast<std::size_t>(e); k < 2 * static_cast<std::size_t>(e) + 2;
               ++k) {
            const Index apex = mesh_.edge_ends[k];
            const auto other = 2 * static_cast<std::size_t>(f);
            if (mesh_.edge_ends[other] != apex && mesh_.edge_ends[other + 1] != apex) continue;
            const double first = length(apex, p), second = length(apex, q);
            const double most = 1e-3 * (1 + kLengthSlack) * first + 2 * off_;
            if (std::fabs(first - second) <= most && are_sharp_inside(apex, e, f)) return true;
          }
        }
      }
    }
    return false;
  }

  /// Whether the triangle, or a piece of an edge nearby, is so short that no point is put there.
  bool is_short(std::size_t t) {
    const std::vector<Index>& rows = refined_.triangles;
    double shortest = length(rows[3 * t], rows[3 * t + 1]);
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c)
      shortest = std::min(shortest, length(rows[c], rows[after(c)]));
    // Where coordinates are coarse, points would be put on others.
    if (shortest <= 4 * min_edge_ || is_coarse(t)) return true;
    return shortest_piece() <= 2 * min_edge_ * (1 + kLengthSlack) || has_crowded_piece();
  }

  /// Whether a point that splits a piece of an edge may be nearer to a vertex than the smallest edge: it is
  /// between a third and two thirds of the piece.
  bool is_crowded(std::size_t c) const {
    if (min_edge_ == 0) return false;
    const double *a = corner(after(c)), *b = corner(after(after(c)));
    const double ux = b[0] - a[0], uy = b[1] - a[1], square = ux * ux + uy * uy;
    for (std::size_t v = 0; v < points_.size() / 2; ++v) {
      const double *p = at(static_cast<Index>(v)), x = p[0] - a[0], y = p[1] - a[1];
      const double part = std::clamp((x * ux + y * uy) / square, 1.0 / 3, 2.0 / 3);
      if (std::hypot(x - part * ux, y - part * uy) <= min_edge_ * (1 + kLengthSlack) + off_) return true;
    }
    return false;
  }
  bool has_crowded_piece() const {
    for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
      if (refined_.edges[c] >= 0 && is_crowded(c)) return true;
    }
    return false;
  }

  /// Whether a corner is nearer to the piece of an edge opposite to it than points may be to each other.
  bool is_flat_above(std::size_t c) const {
    const double *p = corner(c), *a = corner(after(c)), *b = corner(after(after(c)));
    const double cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    return std::fabs(cross) <= min_edge_ * (1 + kLengthSlack) * std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  bool is_piece_flat(std::size_t c) const {
    if (is_flat_above(c)) return true;
    if (refined_.neighbors[c] < 0) return false;
    auto opposite = 3 * static_cast<std::size_t>(refined_.neighbors[c]);
    while (refined_.neighbors[opposite] != static_cast<Index>(c / 3)) ++opposite;
    return is_flat_above(opposite);
  }
  bool has_flat_piece() const {
    for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
      if (refined_.edges[c] >= 0 && is_piece_flat(c)) return true;
    }
    return false;
  }

  double shortest_piece() {
    if (shortest_piece_ < 0) {
      shortest_piece_ = HUGE_VAL;
      for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
        if (refined_.edges[c] < 0) continue;
        const Index u = refined_.triangles[after(c)], v = refined_.triangles[after(after(c))];
        shortest_piece_ = std::min(shortest_piece_, length(u, v));
      }
    }
    return shortest_piece_;
  }

  /// Whether a triangle is so small, or so flat, that rounding may not allow to split its sides.
  bool is_coarse(std::size_t t) const {
    const double *a = corner(3 * t), *b = corner(3 * t + 1), *c = corner(3 * t + 2);
    const long double cross =
        (static_cast<long double>(b[0]) - a[0]) * (static_cast<long double>(c[1]) - a[1]) -
        (static_cast<long double>(b[1]) - a[1]) * (static_cast<long double>(c[0]) - a[0]);
    const auto& rows = refined_.triangles;
    const double longest =
        std::max({length(rows[3 * t], rows[3 * t + 1]), length(rows[3 * t + 1], rows[3 * t + 2]),
                  length(rows[3 * t + 2], rows[3 * t])});
    return static_cast<double>(cross) / longest <= coarse_;
  }
  /// Whether rounding may not allow to split a piece of an edge, opposite to a corner: a triangle there is
  /// coarse, or was so; or its circle reaches beyond the piece no farther than points are rounded.
  bool is_piece_coarse(std::size_t c) {
    if (is_at_coarse_.empty()) {
      is_at_coarse_.assign(points_.size() / 2, false);
      for (std::size_t k = 0; k < refined_.triangles.size(); ++k)
        if (is_coarse(k / 3)) is_at_coarse_[refined_.triangles[k]] = true;
    }
    const Index u = refined_.triangles[after(c)], v = refined_.triangles[after(after(c))];
    if (is_at_coarse_[u] || is_at_coarse_[v] || reach(c) <= off_) return true;
    if (refined_.neighbors[c] < 0) return false;
    auto opposite = 3 * static_cast<std::size_t>(refined_.neighbors[c]);
    while (refined_.triangles[opposite] == u || refined_.triangles[opposite] == v) ++opposite;
    return reach(opposite) <= off_;
  }
  /// How far a triangle's circle reaches beyond the side opposite to a corner: half the side, times the
  /// tangent of half the angle there.
  double reach(std::size_t c) const {
    const double *p = corner(c), *a = corner(after(c)), *b = corner(after(after(c)));
    const double ux = a[0] - p[0], uy = a[1] - p[1], vx = b[0] - p[0], vy = b[1] - p[1];
    const double cosine = ux * vx + uy * vy, sine = ux * vy - uy * vx;
    return std::hypot(b[0] - a[0], b[1] - a[1]) / 2 * sine /
           (std::hypot(ux, uy) * std::hypot(vx, vy) + cosine);
  }
  bool has_coarse_piece() {
    for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
      if (refined_.edges[c] >= 0 && is_piece_coarse(c)) return true;
    }
    return false;
  }

  // Unless there were too few points or rounds.
  void check_encroachment() {
    const RefinementReport& report = refined_.report;
    if (!is_wanted() || report.rounds == wanted_.most_rounds || report.added_points == wanted_.most_points)
      return;
    for (std::size_t c = 0; c < refined_.edges.size(); ++c) {
      if (refined_.edges[c] < 0 || is_kept(refined_.edges[c])) continue;
      const Index u = refined_.triangles[after(c)], v = refined_.triangles[after(after(c))];
      if (length(u, v) <= 2 * min_edge_ * (1 + kLengthSlack) || is_piece_coarse(c) || is_piece_flat(c))
        continue;
      if (sees_flat(c) && !is_crowded(c))
        return wrong("the piece of edge " + std::to_string(refined_.edges[c]) + " from " + place(u) + " to " +
                     place(v) + " is encroached by " + place(refined_.triangles[c]));
    }
  }

  const MeshToRefine& mesh_;
  const RefinedMesh& refined_;
  const Refinement& wanted_;
  Coordinates points_;
  int scale_ = 0;  // the power of two by which the points are multiplied, and lengths with them
  double largest_ = 0, extent_ = 0, min_edge_ = 0, off_ = 0, coarse_ = 0, shortest_piece_ = -1;
  const constrained::QualityBounds bounds_;
  ExactPredicates exact_;
  std::vector<std::uint8_t> sides_;         // per edge
  std::vector<Index> inputs_;               // per directed edge: its triangle in the mesh
  std::vector<bool> is_at_coarse_;          // per point: whether it is a corner of a coarse triangle
  std::vector<std::uint8_t> backward_;      // per corner: whether the edge opposite goes back along its own
  std::vector<std::vector<Index>> ending_;  // per point: the edges that end there
  std::string problem_;
};

}  // namespace

std::vector<std::int32_t> regions_of(const std::vector<Index>& neighbors, const std::vector<Index>& edges) {
  std::vector<Index> region(neighbors.size() / 3, -1);
  std::vector<Index> open;
  for (std::size_t t = 0; t < region.size(); ++t) {
    if (region[t] >= 0) continue;
    open.assign(1, static_cast<Index>(t));
    region[t] = static_cast<Index>(t);
    while (!open.empty()) {
      const auto u = 3 * static_cast<std::size_t>(open.back());
      open.pop_back();
      for (std::size_t c = u; c < u + 3; ++c) {
        const Index next = neighbors[c];
        if (next < 0 || edges[c] >= 0 || region[next] >= 0) continue;
        region[next] = static_cast<Index>(t);
        open.push_back(next);
      }
    }
  }
  return region;
}

MeshToRefine mesh_to_refine(const DomainToRefine& domain) {
  static Triangulator triangulator("host");
  Constraints constraints;
  constraints.segments = domain.segments.data();
  constraints.segment_count = domain.segments.size() / 2;
  constraints.holes = domain.holes.data();
  constraints.hole_count = domain.holes.size() / 2;
  ConstrainedOptions options;
  options.neighbors = true;
  options.outside = domain.outside;
  const std::size_t count = domain.points.size() / 2;
  ConstrainedTriangulation found =
      triangulator.constrained(domain.points.data(), {0, count}, constraints, options);
  MeshToRefine mesh;
  mesh.coordinates = domain.points.data();
  mesh.points = count;
  mesh.triangles = std::move(found.triangles);
  mesh.neighbors = std::move(found.neighbors);
  mesh.edges.assign(mesh.triangles.size(), -1);
  std::map<Edge, Index> edge_of;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    if (found.constrained[c] == 0 && mesh.neighbors[c] >= 0) continue;
    const Edge edge = unordered(mesh.triangles[after(c)], mesh.triangles[after(after(c))]);
    const auto [place, is_new] = edge_of.emplace(edge, static_cast<Index>(edge_of.size()));
    if (is_new) mesh.edge_ends.insert(mesh.edge_ends.end(), {edge.first, edge.second});
    mesh.edges[c] = place->second;
  }
  return mesh;
}

OwnedMesh shuffled(const MeshToRefine& mesh, std::uint64_t seed) {
  FixtureRandom random(seed);
  const auto order_of = [&random](std::size_t count) {
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), 0);
    random.shuffle(order);
    return order;
  };
  const std::vector<Index> points = order_of(mesh.points), triangles = order_of(mesh.triangles.size() / 3),
                           edges = order_of(mesh.edge_ends.size() / 2);
  const auto mapped = [](const std::vector<Index>& to, Index i) { return i < 0 ? i : to[i]; };
  OwnedMesh other;
  other.points.resize(2 * mesh.points);
  for (std::size_t i = 0; i < other.points.size(); ++i)
    other.points[2 * static_cast<std::size_t>(points[i / 2]) + i % 2] = mesh.coordinates[i];
  MeshToRefine& to = other.mesh;
  to = mesh;
  to.coordinates = other.points.data();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto turn = static_cast<std::size_t>(random.integer(0, 2));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = 3 * t + k, c = 3 * static_cast<std::size_t>(triangles[t]) + (k + turn) % 3;
      to.triangles[c] = points[mesh.triangles[from]];
      to.neighbors[c] = mapped(triangles, mesh.neighbors[from]);
      to.edges[c] = mapped(edges, mesh.edges[from]);
    }
    if (!mesh.largest_areas.empty()) to.largest_areas[triangles[t]] = mesh.largest_areas[t];
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto turn = static_cast<std::size_t>(random.integer(0, 1));
    for (std::size_t k = 0; k < 2; ++k)
      to.edge_ends[2 * static_cast<std::size_t>(edges[e]) + (k + turn) % 2] =
          points[mesh.edge_ends[2 * e + k]];
    if (!mesh.kept_edges.empty()) to.kept_edges[edges[e]] = mesh.kept_edges[e];
  }
  return other;
}

ByCoordinates::ByCoordinates(const MeshToRefine& mesh, const RefinedMesh& refined)
    : rounds(refined.report.rounds) {
  const auto place = [&](Index v) {
    const auto i = static_cast<std::size_t>(v);
    const double* const p =
        i < mesh.points ? mesh.coordinates + 2 * i : &refined.added[2 * (i - mesh.points)];
    return std::array<double, 2>{p[0], p[1]};
  };
  for (std::size_t t = 0; t < refined.triangles.size(); t += 3) {
    std::array<std::array<double, 2>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = place(refined.triangles[t + k]);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(
        {corners[0][0], corners[0][1], corners[1][0], corners[1][1], corners[2][0], corners[2][1], 0});
  }
  for (std::size_t i = 0; i < refined.report.bad_triangles.size(); ++i)
    triangles[refined.report.bad_triangles[i]][6] = static_cast<double>(refined.report.excuses[i]);
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t i = 0; i < refined.added_edges.size(); ++i) {
    const Index e = refined.added_edges[i];
    std::array<std::array<double, 2>, 2> ends{};
    for (std::size_t k = 0; e >= 0 && k < 2; ++k)
      ends[k] = place(mesh.edge_ends[2 * static_cast<std::size_t>(e) + k]);
    std::sort(ends.begin(), ends.end());
    added.push_back({refined.added[2 * i], refined.added[2 * i + 1], refined.added_places[i], ends[0][0],
                     ends[0][1], ends[1][0], ends[1][1]});
  }
  std::sort(added.begin(), added.end());
}

std::string what_is_wrong(const MeshToRefine& mesh, const RefinedMesh& refined, const Refinement& wanted) {
  return Check(mesh, refined, wanted).run();
}

}  // namespace flaunay::testing
