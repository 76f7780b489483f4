#include "modes/recursive/endgame.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "flattened/limits.h"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

// Links the corners of a border by its directed edges. Returns simple cycles, each around a part of the
// region.
std::vector<std::vector<std::int32_t>> cycles_of(const Border& border) {
  const auto comes_before = [](const Corner& a, const Corner& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.before < b.before;
  };
  Border sorted = border;
  std::sort(sorted.begin(), sorted.end(), comes_before);
  std::vector<char> done(sorted.size(), 0);
  std::vector<std::vector<std::int32_t>> cycles;
  for (const Corner& start : border) {
    const auto place_of = [&](const Corner& c) {
      return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), c, comes_before) -
                                      sorted.begin());
    };
    std::size_t at = place_of(start);
    if (done[at]) continue;
    cycles.emplace_back();
    while (!done[at]) {
      done[at] = 1;
      const Corner corner = sorted[at];
      cycles.back().push_back(corner.vertex);
      at = place_of({corner.vertex, corner.after, 0});
      if (at == sorted.size() || sorted[at].vertex != corner.after || sorted[at].before != corner.vertex) {
        throw Error(ErrorKind::internal, "a region's border is not closed; please report the input");
      }
    }
  }
  return cycles;
}

// A simple counter-clockwise cycle of Delaunay edges with no point inside.
class Polygon {
 public:
  Polygon(const Predicates& predicates, const std::vector<Point>& points, std::vector<std::int32_t> cycle,
          Counter& counter)
      : predicates_(predicates), cycle_(std::move(cycle)), counter_(counter) {
    for (const std::int32_t id : cycle_) places_.push_back(points[id]);
  }

  // Part (low, high) is the polygon of vertices low..high. The triangle at its last edge, from high to low,
  // has its apex among the vertices between them; the rest is one part on either side of the triangle.
  void append_triangles(std::vector<std::int32_t>& triangles) {
    std::vector<std::pair<std::size_t, std::size_t>> parts{{0, cycle_.size() - 1}};
    while (!parts.empty()) {
      const auto [low, high] = parts.back();
      parts.pop_back();
      if (high - low < 2) continue;
      const std::size_t apex = apex_of(low, high);
      for (const std::size_t v : {low, apex, high}) triangles.push_back(cycle_[v]);
      parts.push_back({apex, high});
      parts.push_back({low, apex});
    }
  }

 private:
  // The vertex left of the edge from `high` to `low` that sees the edge under the widest angle. The circle
  // through it and the edge contains no other vertex.
  std::size_t apex_of(std::size_t low, std::size_t high) {
    if (high - low == 2) return low + 1;
    const Point a = places_[high], b = places_[low];
    std::size_t apex = low;  // none
    kernel::angle widest{};
    bool tied = false;
    for (std::size_t v = low + 1; v < high; ++v) {
      const kernel::angle seen = kernel::angle_at(places_[v], a, b);
      counter_.arithmetic(kernel::DOT_OPERATIONS);
      if (side(seen, high, low, v) <= 0) continue;
      int wider = 1;
      if (apex != low) {
        counter_.arithmetic(kernel::ANGLE_OPERATIONS);
        wider = predicates_.wider_angle(a, b, places_[v], seen, places_[apex], widest);
      }
      if (wider > 0) {
        apex = v;
        widest = seen;
        tied = false;
      } else if (wider == 0) {
        tied = true;
      }
    }
    if (apex == low) fail();
    return tied ? visible_apex(low, high, apex) : apex;
  }

  // If several vertices are on one circle, some may be hidden behind an edge that is a chord of that circle.
  // Chooses a vertex that no such edge separates from the current edge.
  std::size_t visible_apex(std::size_t low, std::size_t high, std::size_t any) {
    std::vector<std::size_t> on_circle{low};
    for (std::size_t v = low + 1; v < high; ++v) {
      if (v == any || (orient(high, low, v) > 0 && circle(high, low, any, v) == 0)) on_circle.push_back(v);
    }
    on_circle.push_back(high);
    for (std::size_t k = 1; k + 1 < on_circle.size(); ++k) {
      if (is_visible(low, high, on_circle[k], on_circle)) return on_circle[k];
    }
    fail();
  }

  bool is_visible(std::size_t low, std::size_t high, std::size_t v,
                  const std::vector<std::size_t>& on_circle) {
    for (std::size_t k = 0; k + 1 < on_circle.size(); ++k) {
      const std::size_t c = on_circle[k], d = on_circle[k + 1];
      if (d != c + 1 || c == v || d == v) continue;
      if (orient(c, d, v) * orient(c, d, c == low ? high : low) < 0) return false;
    }
    return true;
  }

  [[noreturn]] static void fail() {
    throw Error(ErrorKind::internal, "a region's border does not enclose it; please report the input");
  }

  // The side of the edge from a to b on which vertex v lies. seen: the angle under which v sees the edge.
  int side(const kernel::angle& seen, std::size_t a, std::size_t b, std::size_t v) {
    counter_.orientation();
    const int sign = kernel::angle_side(seen, predicates_.bounds.orient);
    return sign == UNDECIDED ? kernel::orient_exact(places_[a], places_[b], places_[v]) : sign;
  }
  int orient(std::size_t a, std::size_t b, std::size_t c) {
    counter_.orientation();
    return predicates_.orient(places_[a], places_[b], places_[c]);
  }
  int circle(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    counter_.circle();
    return predicates_.circle(places_[a], places_[b], places_[c], places_[d]);
  }

  const Predicates& predicates_;
  std::vector<std::int32_t> cycle_;
  std::vector<Point> places_;
  Counter& counter_;
};

void large_region(const Border& border, const SolveRegion& solve_large, std::vector<std::int32_t>& triangles,
                  Counter& counter) {
  RegionArrays region;
  region.point_offsets = {0, 0};
  region.corner_offsets = {0, static_cast<std::int32_t>(border.size())};
  for (const auto& [before, vertex, after] : border) {
    region.corners.insert(region.corners.end(), {before, vertex, after});
  }
  Work work;
  try {
    const std::vector<std::int32_t> inside = solve_large(region, work);
    triangles.insert(triangles.end(), inside.begin(), inside.end());
  } catch (const Error& error) {
    throw Error(ErrorKind::internal, std::string("a region: ") + error.what() + "; please report the input");
  }
  counter.add(sum_of(work));
}

}  // namespace

void end_game(const Predicates& predicates, const std::vector<Point>& points, const Border& border,
              const SolveRegion& solve_large, std::vector<std::int32_t>& triangles, Counter& counter) {
  if (border.size() == 3) {
    triangles.insert(triangles.end(), {border[0].vertex, border[0].after, border[0].before});
  } else if (border.size() > kernel::DEFAULT_SMALL_REGION) {
    large_region(border, solve_large, triangles, counter);
  } else {
    for (std::vector<std::int32_t>& cycle : cycles_of(border)) {
      Polygon(predicates, points, std::move(cycle), counter).append_triangles(triangles);
    }
    counter.sequential();
  }
}

}  // namespace flaunay::recursive
