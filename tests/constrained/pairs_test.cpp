// Pairs of pieces that cross, and vertices inside of pieces, against all pairs; and the rounding of
// crossings.
#include "constrained/crossings/pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/point_tree.hpp"
#include "constrained/crossings/segment_grid.hpp"
#include "tests/constrained/check.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {
namespace {

using constrained::Pairs;
using constrained::Piece;
using geometry::Point;

struct Pieces {
  std::vector<Point> points;
  std::vector<std::int32_t> vertices;  // in lexicographic order: as their numbers are
  std::vector<Piece> pieces;
};

// Distinct points, and distinct pieces between some of them.
Pieces make_pieces(FixtureRandom& random, const std::vector<std::pair<Point, Point>>& lines) {
  const auto before = [](Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  Pieces result;
  for (const auto& [a, b] : lines) result.points.insert(result.points.end(), {a, b});
  std::sort(result.points.begin(), result.points.end(), before);
  const auto equal = [](Point a, Point b) { return a.x == b.x && a.y == b.y; };
  result.points.erase(std::unique(result.points.begin(), result.points.end(), equal), result.points.end());
  for (std::size_t v = 0; v < result.points.size(); ++v)
    result.vertices.push_back(static_cast<std::int32_t>(v));
  std::set<std::pair<std::int32_t, std::int32_t>> ends;
  for (const auto& [a, b] : lines) {
    const auto vertex = [&](Point p) {
      return static_cast<std::int32_t>(
          std::lower_bound(result.points.begin(), result.points.end(), p, before) - result.points.begin());
    };
    const auto [from, to] = std::minmax({vertex(a), vertex(b)});
    if (from != to) ends.emplace(from, to);
  }
  for (const auto& [from, to] : ends) result.pieces.push_back({from, to});
  random.shuffle(result.pieces);
  return result;
}

// That a grid and a tree find all points near lines, and none that is twice as far away, on scaled
// coordinates.
void expect_near(const std::vector<Point>& points, const std::vector<constrained::Line>& lines,
                 const constrained::SegmentGrid& grid) {
  double largest = 0;
  for (const Point p : points) largest = std::max({largest, std::fabs(p.x), std::fabs(p.y)});
  const double distance = 0x1p-46 * largest;
  std::vector<std::int32_t> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0);
  const constrained::PointTree tree(points.data(), ids, largest);
  // Per line and point.
  const std::size_t n = points.size();
  std::vector<char> by_tree(lines.size() * n), by_grid(lines.size() * n);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    tree.visit_near(lines[k], distance, [&](std::int32_t v) { by_tree[k * n + v] = 1; });
  }
  const bool is_complete = grid.find_near(points, distance, [&](std::int32_t e, std::int32_t v) {
    by_grid[e * n + v] = 1;
    return true;
  });
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (const std::int32_t v : ids) {
      // By distances that are rounded far less than the differences looked for.
      const auto [a, b] = lines[k];
      const auto near = [&, p = points[v]](long double reach) {
        long double low = 0, high = 1;
        const auto clip = [&](long double from, long double to, long double at) {
          if (from == to) {
            if (std::fabs(from - at) > reach) high = -1;
            return;
          }
          const long double first = (at - reach - from) / (to - from),
                            last = (at + reach - from) / (to - from);
          low = std::max(low, std::min(first, last));
          high = std::min(high, std::max(first, last));
        };
        clip(a.x, b.x, p.x);
        clip(a.y, b.y, p.y);
        return low <= high;
      };
      const bool is_found = by_tree[k * n + v] != 0;
      if (is_complete && by_grid[k * n + v] != is_found) {
        // Only one of them has it, so it is neither near nor far.
        if (near(0.999L * distance) || !near(4 * distance)) ADD_FAILURE() << "line " << k << ", point " << v;
      } else if (is_found ? !near(4 * distance) : near(0.999L * distance)) {
        ADD_FAILURE() << "line " << k << ", point " << v;
      }
    }
  }
}

// Whether what is found is what all pairs give. grids: how often a grid has found it. Returns the number of
// crossings.
std::size_t expect_pairs(const Pieces& input, int& grids) {
  Coordinates coordinates;
  for (const Point p : input.points) coordinates.insert(coordinates.end(), {p.x, p.y});
  Plane plane(coordinates);
  geometry::Predicates predicates;
  predicates.bounds.orient = ORIENT_BOUND;
  const auto lines =
      constrained::cut_at_vertices(predicates, input.points.data(), input.pieces, input.vertices);
  std::set<Edge> expected, found;
  EXPECT_EQ(lines.ranges.size(), 2 * input.pieces.size());
  for (std::size_t p = 0; p < input.pieces.size(); ++p) {
    const Piece piece = input.pieces[p];
    std::int32_t last = piece.from;
    std::int32_t e = lines.ranges[2 * p];
    for (const std::int32_t v : input.vertices) {
      if (v <= piece.from || v > piece.to || !plane.on_segment(piece.from, piece.to, v)) continue;
      expected.emplace(last, v);
      if (e >= lines.ranges[2 * p + 1] || lines.edges[e].from != last || lines.edges[e].to != v) {
        ADD_FAILURE() << "edge " << last << "-" << v << " of piece " << p;
        return 0;
      }
      ++e;
      last = v;
    }
    EXPECT_EQ(e, lines.ranges[2 * p + 1]);
  }
  for (const Piece& edge : lines.edges) EXPECT_TRUE(found.emplace(edge.from, edge.to).second);
  EXPECT_EQ(found, expected);

  Pairs all;
  for (std::int32_t f = 0; f < static_cast<std::int32_t>(lines.edges.size()); ++f) {
    for (std::int32_t e = 0; e < f; ++e) {
      const Piece p = lines.edges[e], q = lines.edges[f];
      if (plane.cross(p.from, p.to, q.from, q.to)) all.emplace_back(e, f);
    }
  }
  std::sort(all.begin(), all.end());
  Pairs pairs;
  constrained::find_crossings(predicates, input.points.data(), lines.edges,
                              [&pairs](std::int32_t e, std::int32_t f) {
                                pairs.emplace_back(e, f);
                                return true;
                              });
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  EXPECT_EQ(pairs, all);
  // A grid finds these pairs too, if it takes few comparisons.
  std::vector<constrained::Line> grid_lines;
  for (const Piece& edge : lines.edges)
    grid_lines.push_back({input.points[edge.from], input.points[edge.to]});
  const constrained::SegmentGrid grid(grid_lines);
  Pairs by_grid;
  if (grid.find_crossings(predicates, [&by_grid](std::int32_t e, std::int32_t f) {
        by_grid.emplace_back(std::min(e, f), std::max(e, f));
        return true;
      })) {
    std::sort(by_grid.begin(), by_grid.end());
    by_grid.erase(std::unique(by_grid.begin(), by_grid.end()), by_grid.end());
    EXPECT_EQ(by_grid, all);
    ++grids;
  }
  expect_near(input.points, grid_lines, grid);
  std::size_t calls = 0;
  constrained::find_crossings(predicates, input.points.data(), lines.edges,
                              [&calls](std::int32_t, std::int32_t) { return ++calls < 3; });
  EXPECT_GE(calls, std::min<std::size_t>(3, all.size()));
  EXPECT_LE(calls, 3u);
  return all.size();
}

TEST(CrossingPairs, AllKindsOfSegments) {
  FixtureRandom random(1);
  std::size_t crossings = 0;
  int grids = 0;
  for (int round = 0; round < 240; ++round) {
    SCOPED_TRACE(round);
    const int kind = round % 8;
    const auto number = [&](int low, int high) { return static_cast<double>(random.integer(low, high)); };
    std::vector<std::pair<Point, Point>> lines;
    const int count = static_cast<int>(random.integer(20, 250));
    for (int k = 0; k < count; ++k) {
      Point a{}, b{};
      if (kind == 0) {  // anywhere on a small grid
        a = {number(0, 12), number(0, 12)};
        b = {number(0, 12), number(0, 12)};
      } else if (kind == 1) {  // short
        a = {random.unit(), random.unit()};
        b = {a.x + 0.1 * (random.unit() - 0.5), a.y + 0.1 * (random.unit() - 0.5)};
      } else if (kind == 2) {  // along the axes and the diagonals of a grid
        const double steps = number(-9, 9);
        a = {number(0, 20), number(0, 20)};
        const int direction = k % 4;
        b = {a.x + (direction == 1 ? 0 : steps), a.y + (direction == 0   ? 0
                                                        : direction == 3 ? -steps
                                                                         : steps)};
      } else if (kind == 3) {  // through nearly one place
        const double angle = 3 * random.unit(), length = 1 + random.unit();
        a = {length * std::cos(angle), length * std::sin(angle)};
        b = {-length * std::cos(angle), 1e-3 * random.unit() - length * std::sin(angle)};
      } else if (kind == 4) {  // a fan, and what crosses it
        a = k % 3 == 0 ? Point{random.unit(), random.unit()} : Point{0, 0};
        b = {random.unit(), random.unit()};
      } else if (kind == 5) {  // nearly parallel and close, with common ends and touches
        a = {1 + number(0, 5) * 0x1p-52, 1 + number(0, 5) * 0x1p-52};
        b = {1 + number(20, 60) * 0x1p-52, 1 + number(20, 60) * 0x1p-52};
      } else if (kind == 6) {  // long ones, in steps of a half, across each other
        a = {0, 0.5 * number(0, 40)};
        b = {20, 0.5 * number(0, 40)};
        if (k % 2 != 0) a = {0.5 * number(0, 40), 0.5 * number(0, 40)};
      } else {  // very different lengths
        const double length = std::ldexp(1, static_cast<int>(random.integer(-60, 0)));
        a = {length * random.unit(), length * random.unit()};
        b = {a.x + length * random.unit(), a.y - length * random.unit()};
      }
      lines.emplace_back(a, b);
    }
    crossings += expect_pairs(make_pieces(random, lines), grids);
    if (HasFailure()) return;
  }
  EXPECT_GT(crossings, 100000u);
  EXPECT_GT(grids, 100);
}

}  // namespace
}  // namespace flaunay::testing
