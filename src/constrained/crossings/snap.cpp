#include "constrained/crossings/snap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "constrained/crossings/crossing.hpp"
#include "constrained/crossings/point_tree.hpp"
#include "flaunay/flaunay.hpp"
#include "predicates/planar.h"

namespace flaunay::constrained {
using namespace geometry;

namespace {

using Ids = std::vector<std::int32_t>;

// The interval of values that are rounded to a number. It includes its ends if the number is even.
struct Interval {
  double below, above;  // distances of the ends from the number
  bool is_closed;

  Interval(double number, double unit) {
    const double next = std::nextafter(number, HUGE_VAL), last = std::nextafter(number, -HUGE_VAL);
    above = 0.5 * std::max(next - number, unit);
    below = 0.5 * std::max(number - last, unit);
    // Below a power of two the step is smaller, but the number is even by either.
    is_closed = static_cast<std::int64_t>(number / (2 * above)) % 2 == 0;
  }
  // Whether it has a number of [low, high], where low and high are doubles.
  bool meets(double number, double low, double high) const {
    const double from_below = low - number, from_above = number - high;  // exact where they matter
    return is_closed ? from_below <= above && from_above <= below : from_below < above && from_above < below;
  }
};

// The side of a-b on which vertex + (dx, dy) is, exactly.
int side_of_corner(const Line& edge, Point vertex, double dx, double dy) {
  const auto [a, b] = edge;
  const auto left = (b.x - a.x) * (vertex.y - a.y + dy), right = (b.y - a.y) * (vertex.x - a.x + dx);
  // Each factor is rounded at most twice, each product once, and the difference once.
  if (std::fabs(left - right) > 0x1p-49 * (std::fabs(left) + std::fabs(right))) return left > right ? 1 : -1;
  const auto product = [](double from, double to, double low, double high, double step) {
    const kernel::double2 along = kernel::two_sum(to, -from), across = kernel::two_sum(high, -low);
    kernel::expansion result;
    result.size = 0;
    for (const double part : {step, across.y, across.x}) kernel::expansion_add(&result, part);
    const double factor[2] = {along.x, along.y};
    kernel::expansion_multiply(&result, factor, 2);
    return result;
  };
  kernel::expansion difference = product(a.x, b.x, a.y, vertex.y, dy);
  const kernel::expansion second = product(a.y, b.y, a.x, vertex.x, dx);
  for (int k = 0; k < second.size; ++k) kernel::expansion_add(&difference, -second.part[k]);
  return kernel::expansion_sign(&difference);
}

class Snapping {
 public:
  Snapping(const Predicates& predicates, const std::vector<Point>& points, const std::vector<Piece>& edges,
           double unit)
      : predicates_(predicates), points_(points), edges_(edges), unit_(unit) {}

  Chains run(SplitLimits& limits) {
    double largest = 0;
    for (const Point p : points_) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
    // Nothing is rounded by more than this, in each coordinate.
    const double most = 0.5 * std::max(std::nextafter(largest, HUGE_VAL) - largest, unit_);
    Ids all(points_.size());
    std::iota(all.begin(), all.end(), 0);
    const PointTree tree(points_.data(), std::move(all), largest);
    Chains chains;
    chains.offsets.push_back(0);
    for (const Piece edge : edges_) {
      on_edge_.clear();
      beside_.clear();
      tree.visit_near(line(edge), most, [&](std::int32_t v) {
        if (v != edge.from && v != edge.to)
          (meets_cell(line(edge), points_[v]) ? on_edge_ : beside_).push_back(v);
      });
      add_chain(edge, chains.vertices);
      chains.offsets.push_back(chains.vertices.size());
      check_pieces(chains.vertices.size(), limits);
    }
    return chains;
  }

 private:
  Line line(Piece edge) const { return {points_[edge.from], points_[edge.to]}; }

  // Whether a segment has a place that is rounded to a vertex.
  bool meets_cell(const Line& edge, Point vertex) const {
    const auto [a, b] = edge;
    const Interval x(vertex.x, unit_), y(vertex.y, unit_);
    if (!x.meets(vertex.x, a.x, b.x) || !y.meets(vertex.y, std::min(a.y, b.y), std::max(a.y, b.y)))
      return false;
    if (a.x == b.x || a.y == b.y) return true;
    const double dx = std::fabs(b.x - a.x), dy = std::fabs(b.y - a.y);
    const double left = (b.x - a.x) * (vertex.y - a.y), right = (b.y - a.y) * (vertex.x - a.x);
    if (std::fabs(left - right) >
        0x1p-50 * (std::fabs(left) + std::fabs(right)) + 2 * (dx * y.above + dy * x.above)) {
      return false;
    }
    // The cell is on one side if all of its corners are. Only if it has all of its border may one be on the
    // line.
    bool is_left = false, is_right = false;
    for (const double to_x : {-x.below, x.above}) {
      for (const double to_y : {-y.below, y.above}) {
        const int side = side_of_corner(edge, vertex, to_x, to_y);
        is_left |= side > 0 || (side == 0 && x.is_closed && y.is_closed);
        is_right |= side < 0 || (side == 0 && x.is_closed && y.is_closed);
      }
    }
    return is_left && is_right;
  }

  // Orders vertices along the direction of an edge, which is ascending in x.
  bool is_ahead(bool descends, std::int32_t u, std::int32_t v) const {
    const Point p = points_[u], q = points_[v];
    return p.x != q.x ? p.x < q.x : descends ? p.y > q.y : p.y < q.y;
  }

  void add_chain(Piece edge, Ids& chain) {
    const bool descends = points_[edge.to].y < points_[edge.from].y;
    const auto ahead = [this, descends](std::int32_t u, std::int32_t v) { return is_ahead(descends, u, v); };
    std::sort(on_edge_.begin(), on_edge_.end(), ahead);
    std::sort(beside_.begin(), beside_.end(), ahead);
    on_edge_.push_back(edge.to);
    std::int32_t from = edge.from;
    auto first = beside_.begin();
    for (const std::int32_t to : on_edge_) {
      first = std::partition_point(first, beside_.end(), [&](std::int32_t v) { return ahead(v, from); });
      const auto last =
          std::partition_point(first, beside_.end(), [&](std::int32_t v) { return ahead(v, to); });
      add_around(edge, from, to, {first, last}, chain);
      if (to != edge.to) chain.push_back(to);
      from = to;
      first = last;
    }
  }

  // Adds the vertices around which the shortest path between two vertices bends: the farthest vertex on the
  // wrong side of the chord, and recursively the vertices around which the two parts bend.
  void add_around(Piece edge, std::int32_t from, std::int32_t to,
                  std::pair<Ids::iterator, Ids::iterator> beside, Ids& chain) {
    struct Part {
      std::int32_t from, to;
      Ids::iterator begin, end;
    };
    std::vector<Part> parts{{from, to, beside.first, beside.second}};
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      const auto farthest = find_farthest(line(edge), line({part.from, part.to}), part.begin, part.end);
      if (farthest == part.end) {
        if (part.to != to) chain.push_back(part.to);
        continue;
      }
      parts.push_back({*farthest, part.to, farthest + 1, part.end});
      parts.push_back({part.from, *farthest, part.begin, farthest});
    }
  }

  // The farthest from a chord, on one side, of the vertices that lie on different sides of chord and edge.
  // Their cells do not meet the edge, so all places rounded to such a vertex are on the vertex's side.
  Ids::iterator find_farthest(const Line& edge, const Line& chord, Ids::iterator begin,
                              Ids::iterator end) const {
    auto farthest = end;
    int wrong_side = 0;
    for (auto v = begin; v != end; ++v) {
      const Point p = points_[*v];
      const int side = predicates_.orient(chord.a, chord.b, p);
      if (side == 0 || (wrong_side != 0 && side != wrong_side)) continue;
      if (farthest != end && kernel::cross_sign(chord.a, chord.b, points_[*farthest], p) * side <= 0)
        continue;
      if (predicates_.orient(edge.a, edge.b, p) * side > 0) continue;
      farthest = v;
      wrong_side = side;
    }
    return farthest;
  }

  const Predicates& predicates_;
  const std::vector<Point>& points_;
  const std::vector<Piece>& edges_;
  double unit_;
  Ids on_edge_, beside_;  // the vertices near an edge
};

}  // namespace

Chains snap(const Predicates& predicates, const std::vector<Point>& points, const std::vector<Piece>& edges,
            double unit, SplitLimits& limits) {
  return Snapping(predicates, points, edges, unit).run(limits);
}

void check_pieces(std::size_t pieces, SplitLimits& limits) {
  if (pieces > limits.pieces && limits.more) limits.pieces = std::exchange(limits.more, nullptr)();
  if (pieces <= limits.pieces) return;
  throw Error(
      ErrorKind::input,
      fmt::format("splitting segments makes more than {} pieces, for which memory or 32-bit indices do "
                  "not suffice",
                  limits.pieces));
}

}  // namespace flaunay::constrained
