#include "recursive/endgame.hpp"

#include <algorithm>
#include <utility>

namespace flaunay::recursive {
namespace {

// The border's corners linked by its directed edges: cycles, each simple and around a part of the region.
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

  // Part (low, high) is the polygon of vertices low..high: its last edge, from high to low, has its
  // triangle's apex between them, and what remains is a part on either side.
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
  // The vertex left of the edge whose circle holds no other vertex left of it. No orientation is needed to
  // know which are: the circle through a Delaunay edge and its apex is empty, so to the edge's right any
  // circle through the edge and a vertex on its left holds nothing, and the sign that says "inside" of a
  // circle through a vertex on the right says that what is to the left goes before it.
  std::size_t apex_of(std::size_t low, std::size_t high) {
    std::size_t apex = low + 1;
    bool tied = false;
    for (std::size_t v = low + 2; v < high; ++v) {
      const int inside = circle(high, low, apex, v);
      if (inside > 0 || (inside == 0 && orient(high, low, apex) <= 0)) {
        apex = v;
        tied = false;
      } else if (inside == 0) {
        tied |= orient(high, low, v) > 0;
      }
    }
    return tied ? visible_apex(low, high, apex) : apex;
  }

  // Of several vertices on one circle some may hide behind an edge that is a chord of it: one that no such
  // edge separates from the edge at hand.
  std::size_t visible_apex(std::size_t low, std::size_t high, std::size_t any) {
    std::vector<std::size_t> on_circle{low};
    for (std::size_t v = low + 1; v < high; ++v) {
      if (v == any || (circle(high, low, any, v) == 0 && orient(high, low, v) > 0)) on_circle.push_back(v);
    }
    on_circle.push_back(high);
    for (std::size_t k = 1; k + 1 < on_circle.size(); ++k) {
      if (is_visible(low, high, on_circle[k], on_circle)) return on_circle[k];
    }
    throw Error(ErrorKind::internal, "a region's border does not enclose it; please report the input");
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

void large_region_triangles(const Predicates& predicates, const std::vector<Point>& points,
                            const Border& border, std::vector<std::int32_t>& triangles, Counter& counter) {
  for (std::vector<std::int32_t>& cycle : cycles_of(border)) {
    Polygon(predicates, points, std::move(cycle), counter).append_triangles(triangles);
  }
}

}  // namespace

void region_triangles(const Predicates& predicates, const std::vector<Point>& points, const Border& border,
                      std::vector<std::int32_t>& triangles, Counter& counter) {
  if (border.size() == 3) {
    triangles.insert(triangles.end(), {border[0].vertex, border[0].after, border[0].before});
  } else if (border.size() > kSmallRegion) {
    large_region_triangles(predicates, points, border, triangles, counter);
  } else {
    for (std::vector<std::int32_t>& cycle : cycles_of(border)) {
      Polygon(predicates, points, std::move(cycle), counter).append_triangles(triangles);
    }
  }
  counter.sequential();
}

}  // namespace flaunay::recursive
