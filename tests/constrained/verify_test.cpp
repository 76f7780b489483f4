// The checker of constrained triangulations must accept the canonical one and nothing else; and nasty
// segments, which it is tried on, must be triangulated right.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "prove/constrained_proof.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

using Ids = std::vector<std::int32_t>;

// A result, and what it is a result of.
struct Case {
  Coordinates points;
  Segments segments;
  Ids triangles, neighbors, edges, segment_edges;
  Outside outside = Outside::keep;
  FillRule fill_rule = FillRule::nesting;
  std::vector<double> holes;
  double min_angle = 0, max_area = 0;
  bool conforming = false;

  Case() = default;
  Case(Coordinates coordinates, Segments ends) : points(std::move(coordinates)), segments(std::move(ends)) {
    const std::vector<std::size_t> offsets = {0, points.size() / 2};
    const ConstrainedTriangulation result = insert(points, offsets, delaunay_of(points, offsets), segments);
    triangles = result.triangles;
    neighbors = result.neighbors;
    edges = result.constraint_edges;
    segment_edges = result.piece_edges;
  }

  VerifyReport verify() const {
    VerifyConstraints constraints = to_verify();
    constraints.edges = &edges;
    constraints.segment_edges = &segment_edges;
    return verify_constrained(points.data(), points.size() / 2, triangles, &neighbors, constraints);
  }
  // Of triangles that were changed.
  VerifyReport verify_triangles() const {
    return verify_constrained(points.data(), points.size() / 2, triangles, nullptr, to_verify());
  }
  VerifyConstraints to_verify() const {
    VerifyConstraints constraints;
    constraints.segments = &segments;
    constraints.outside = outside;
    constraints.fill_rule = fill_rule;
    if (!holes.empty()) constraints.holes = &holes;
    constraints.min_angle = min_angle;
    constraints.max_area = max_area;
    constraints.conforming = conforming;
    return constraints;
  }
  // Leaves out rows.
  void keep_if(const std::function<bool(const Ids& row)>& is_kept) {
    Ids kept;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      const auto first = triangles.begin() + static_cast<std::ptrdiff_t>(t);
      const Ids row(first, first + 3);
      if (is_kept(row)) kept.insert(kept.end(), row.begin(), row.end());
    }
    triangles = kept;
    neighbors = reference_neighbors(kept);
  }
  std::string problem() const { return verify_triangles().problem; }
  // What is wrong if all coordinates are times 2^power.
  std::string problem_at(int power) const {
    Case other = *this;
    for (double& x : other.points) x = std::ldexp(x, power);
    return other.problem();
  }
};

// Squares of coordinates are doubles at one of these scales only.
constexpr int kPowers[] = {-1020, -600, 0, 600, 1018};

// Exchanges the diagonal of the two triangles at a half-edge, opposite to a corner.
void flip(Ids& triangles, const Ids& neighbors, std::size_t corner) {
  const std::size_t t = corner - corner % 3, u = 3 * static_cast<std::size_t>(neighbors[corner]);
  const std::int32_t a = triangles[t + (corner + 1) % 3], b = triangles[t + (corner + 2) % 3];
  const std::int32_t c = triangles[corner];
  std::size_t opposite = u;
  while (triangles[opposite] == a || triangles[opposite] == b) ++opposite;
  const std::int32_t d = triangles[opposite];
  const Ids rows[] = {{c, a, d}, {c, d, b}};
  std::copy(rows[0].begin(), rows[0].end(), triangles.begin() + static_cast<std::ptrdiff_t>(t));
  std::copy(rows[1].begin(), rows[1].end(), triangles.begin() + static_cast<std::ptrdiff_t>(u));
}

// Triangles that are connected with the outside over edges that are no constraints are removed.
Case without_outside(Case input) {
  std::set<Edge> constraints;
  for (std::size_t e = 0; e < input.edges.size(); e += 2) {
    constraints.insert(unordered(input.edges[e], input.edges[e + 1]));
  }
  std::vector<char> is_outside(input.triangles.size() / 3, 0);
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t c = 0; c < input.triangles.size(); ++c) {
      const std::size_t t = c - c % 3;
      if (is_outside[c / 3] != 0) continue;
      if (input.neighbors[c] >= 0 && is_outside[input.neighbors[c]] == 0) continue;
      if (constraints.count(unordered(input.triangles[t + (c + 1) % 3], input.triangles[t + (c + 2) % 3])) !=
          0) {
        continue;
      }
      is_outside[c / 3] = 1;
      changes = true;
    }
  }
  Ids kept;
  for (std::size_t c = 0; c < input.triangles.size(); ++c) {
    if (is_outside[c / 3] == 0) kept.push_back(input.triangles[c]);
  }
  input.triangles = kept;
  input.neighbors = reference_neighbors(kept);
  input.outside = Outside::hull;
  return input;
}

// Two nested squares with points inside, outside and between; the outer one has a point on a side.
Case nested_squares() {
  return {{0, 0, 8, 0, 8, 8, 0, 8, 2, 2, 6, 2, 6, 6, 2, 6, 4, 4, 4, 0, -5, 4, 12, 5, 1, 4},
          {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4}};
}

TEST(SmallVerifyConstrained, NamesWhatIsWrong) {
  // A square whose diagonals are both Delaunay, and a point beside it.
  const Coordinates square = {0, 0, 2, 0, 2, 2, 0, 2, 5, 1};
  Case right(square, {0, 2});
  EXPECT_EQ(right.verify().problem, "");
  EXPECT_EQ(right.verify().constraint_edges, 1u);
  Case changed = right;
  changed.segments = {1, 3};
  EXPECT_EQ(
      changed.problem(),
      "segment 0 from point 1 at (2, 0) to point 3 at (0, 2) is no chain of edges: the edge from point 3 at "
      "(0, 2) to point 1 at (2, 0) is missing");
  // Without the segment, the diagonal from the smallest corner is still right; the other one is not.
  changed.segments = {};
  EXPECT_EQ(changed.problem(), "");
  changed = Case(square, {1, 3});
  changed.segments = {};
  EXPECT_NE(changed.problem().find("does not begin at point 0 at (0, 0), the lexicographically smallest"),
            std::string::npos)
      << changed.problem();
  changed.segments = {1, 3, 2, 5};
  EXPECT_EQ(changed.problem(), "segment 1 has an end 5, which is not the index of one of the 5 points");
  changed.segments = {1, 3, 2};
  EXPECT_EQ(changed.problem(), "the segments are 3 indices, which is not a multiple of 2");
  changed.segments = {1, 3, 0, 2};
  EXPECT_EQ(changed.problem(),
            "segment 1 from point 0 at (0, 0) to point 2 at (2, 2) and segment 0 from point 1 at (2, 0) to "
            "point 3 at "
            "(0, 2) cross at a place that is no point");
  changed = right;
  changed.triangles.resize(6);
  EXPECT_NE(changed.problem().find("which is neither on the hull nor a constraint"), std::string::npos)
      << changed.problem();
  changed.triangles.clear();
  EXPECT_EQ(
      changed.problem(),
      "segment 0 from point 0 at (0, 0) to point 2 at (2, 2) is no chain of edges: the edge from point 0 at "
      "(0, 0) to point 2 at (2, 2) is missing");
  changed.segments.clear();
  EXPECT_EQ(
      changed.problem(),
      "there is no triangle on the right of the edge from point 0 at (0, 0) to point 3 at (0, 2), which is "
      "inside");
}

TEST(SmallVerifyConstrained, SegmentsAreChains) {
  const Case through({0, 0, 1, 1, 4, 4, 0, 4, 4, 0}, {2, 0, 0, 1});
  EXPECT_EQ(through.verify().problem, "");
  EXPECT_EQ(through.verify().constraint_edges, 2u);
  Case changed = through;
  std::swap(changed.edges[0], changed.edges[1]);
  EXPECT_EQ(changed.verify().problem,
            "constraint edge 0 from point 1 to point 0 is no part of a segment, or is the wrong way round");
  changed = through;
  changed.edges = {0, 1, 0, 1};
  EXPECT_EQ(changed.verify().problem, "constraint edge 1 from point 0 to point 1 is listed twice");
  changed.edges = {0, 1};
  EXPECT_EQ(changed.verify().problem,
            "there are 2 indices in the constraint edges, but the segments are made of 2 edges");
  changed = through;
  changed.segment_edges = {0, 2, 1, 2};
  EXPECT_EQ(changed.verify().problem,
            "the edges [1, 2) are not those of segment 1 from point 0 at (0, 0) to point 1 at (1, 1)");
  changed = through;
  std::swap(changed.neighbors[0], changed.neighbors[1]);
  EXPECT_NE(changed.verify().problem.find(" has neighbor "), std::string::npos);
}

TEST(SmallVerifyConstrained, Domains) {
  const Case all = nested_squares();
  EXPECT_EQ(all.verify().problem, "");
  const Case inside = without_outside(all);
  EXPECT_LT(inside.triangles.size(), all.triangles.size());
  EXPECT_EQ(inside.verify().problem, "");
  Case changed = inside;
  changed.outside = Outside::keep;
  EXPECT_NE(changed.problem(), "");
  changed = all;
  changed.outside = Outside::hull;
  EXPECT_NE(changed.problem().find(" is outside, on the "), std::string::npos) << changed.problem();
  changed.outside = Outside::holes;
  EXPECT_NE(changed.problem().find(" is outside, on the "), std::string::npos) << changed.problem();

  // The inner square is a hole; its middle is in no triangle then.
  Case ring = inside;
  ring.keep_if([](const Ids& row) { return std::find(row.begin(), row.end(), 8) == row.end(); });
  EXPECT_EQ(ring.triangles.size() + 12, inside.triangles.size());
  EXPECT_NE(ring.problem(), "");
  ring.outside = Outside::holes;
  EXPECT_EQ(ring.verify().problem, "");
  ring.fill_rule = FillRule::even_odd;
  EXPECT_EQ(ring.verify().problem, "");
  // Both squares run the same way round, so the inner one is no hole.
  ring.fill_rule = FillRule::winding;
  EXPECT_NE(ring.problem(), "");
  for (const std::size_t k : {8, 10, 12, 14}) std::swap(ring.segments[k], ring.segments[k + 1]);
  EXPECT_EQ(ring.problem(), "");
  // A segment in a hole need not be an edge, but must not cross another one.
  Case changed_ring = ring;
  changed_ring.fill_rule = FillRule::nesting;
  changed_ring.segments.insert(changed_ring.segments.end(), {4, 8});
  EXPECT_EQ(changed_ring.problem(), "");
  changed_ring.fill_rule = FillRule::even_odd;
  EXPECT_EQ(changed_ring.problem(),
            "the segments are no closed curves: at point 4 at (2, 2), an odd number of them ends");
  changed_ring.fill_rule = FillRule::winding;
  EXPECT_EQ(changed_ring.problem(),
            "the segments are no closed curves: at point 4 at (2, 2), not as many begin as end");
  changed_ring.segments.insert(changed_ring.segments.end(), {8, 12});
  EXPECT_NE(changed_ring.problem().find(" cross at a place that is no point"), std::string::npos)
      << changed_ring.problem();
  // Nothing is inside.
  Case open = all;
  open.segments = {0, 1, 1, 2, 2, 3};
  open.triangles.clear();
  open.outside = Outside::hull;
  EXPECT_EQ(open.problem(), "");
}

TEST(SmallVerifyConstrained, Holes) {
  const Case all = nested_squares();
  Case ring = all;
  ring.keep_if([](const Ids& row) { return std::find(row.begin(), row.end(), 8) == row.end(); });
  EXPECT_NE(ring.problem(), "");
  // At a point and elsewhere, in any face.
  for (const std::vector<double>& holes : {std::vector<double>{4, 4}, {3.5, 4.25}, {3, 3, 5, 5, 3, 3}}) {
    ring.holes = holes;
    EXPECT_EQ(ring.problem(), "");
  }
  ring.holes = {2, 4};
  EXPECT_EQ(ring.problem(), "hole 0 at (2, 4) is on a segment");
  ring.holes = {4, 4, 2, 2};
  EXPECT_EQ(ring.problem(), "hole 1 at (2, 2) is on a segment");
  ring.holes = {4, 4, -4, 8};
  EXPECT_EQ(ring.problem(), "hole 1 at (-4, 8) is outside of the convex hull");
  ring.holes = {4, NAN};
  EXPECT_EQ(ring.problem(), "hole 0 is not finite");
  // What is outside, by a place on an edge of the hull that is no constraint.
  Case inside = without_outside(all);
  inside.outside = Outside::keep;
  EXPECT_NE(inside.problem(), "");
  inside.holes = {-5, 4, 12, 5};
  EXPECT_EQ(inside.problem(), "");
  const Case square({0, 0, 4, 0, 4, 4, 0, 4, 1, 1}, {1, 3});
  Case half = square;
  half.keep_if([](const Ids& row) { return std::find(row.begin(), row.end(), 2) == row.end(); });
  for (const std::vector<double>& hole : {std::vector<double>{4, 3}, {1, 4}, {4, 4}, {3, 3}}) {
    half.holes = hole;
    EXPECT_EQ(half.problem(), "");
  }
  half.holes = {0, 1};
  EXPECT_NE(half.problem(), "");
}

TEST(SmallVerifyRefined, AnglesAndAreas) {
  const auto refined = [](Case mesh, double angle, double area) {
    mesh.min_angle = angle;
    mesh.max_area = area;
    return mesh.verify();
  };
  const Coordinates rectangle = {0, 0, 4, 0, 4, 1, 0, 1};
  const Case plain(rectangle, {});
  EXPECT_EQ(refined(plain, 14.03, 2).problem, "");
  EXPECT_EQ(refined(plain, 14.03, 2).excused_triangles, 0u);
  const std::string row = "triangle 0 with points 0, 1, 2 at (0, 0), (4, 0), (4, 1)";
  EXPECT_EQ(refined(plain, 0, std::nextafter(2, 0)).problem,
            row + " has the area 2, which is above 1.9999999999999998");
  EXPECT_EQ(refined(plain, 14.04, 0).problem,
            row + " has an angle of 14.036243467926477 degrees at point 0, which is below 14.04");
  // Between constraints, of which the border is one.
  const VerifyReport excused = refined(Case(rectangle, {0, 2}), 30, 2);
  EXPECT_EQ(excused.problem, "");
  EXPECT_EQ(excused.excused_triangles, 2u);
  EXPECT_NE(refined(Case(rectangle, {0, 2}), 30, 1).problem, "");
  EXPECT_THROW(refined(plain, 35, 0), Error);
}

TEST(SmallVerifyRefined, EncroachedEdges) {
  // The widest angle is 141.4 degrees, or 138.9.
  for (const double y : {0.7, 0.75}) {
    for (const Segments& segments : {Segments{}, Segments{1, 0}}) {
      Case mesh({0, 0, 4, 0, 2, y, 2, -5}, segments);
      if (!segments.empty()) mesh = Case({0, 0, 4, 0, 2, y, 2, -5, 2, 5}, segments);
      mesh.max_area = 100;
      const std::string problem = mesh.problem();
      const bool is_encroached = y == 0.7 && !segments.empty();
      EXPECT_EQ(problem.empty(), !is_encroached) << problem;
      if (is_encroached) {
        EXPECT_EQ(
            problem.rfind("the edge from point 0 at (0, 0) to point 1 at (4, 0) is encroached: point 2 at "
                          "(2, 0.7) of triangle ",
                          0),
            0u)
            << problem;
      }
    }
  }
}

// Right angles are not obtuse.
TEST(SmallVerifyRefined, ConformingMeshes) {
  for (const double y : {1.5, 2.0, 2.5}) {
    Case mesh({0, 0, 4, 0, 2, y, 2, -5}, {1, 0});
    EXPECT_EQ(mesh.problem(), "");
    mesh.conforming = true;
    EXPECT_EQ(mesh.problem().find("is encroached") != std::string::npos, y < 2)
        << y << ": " << mesh.problem();
  }
}

// Whether the border is made of segments or not.
TEST(SmallVerifyRefined, SliversAtTheHull) {
  for (const double off : {0x1p-53, 1e-9}) {
    for (const Segments& segments :
         {Segments{0, 1, 1, 4, 4, 2, 2, 3, 3, 0}, Segments{0, 4}, Segments{3, 0}}) {
      for (const double x : {1, 0}) {
        Case mesh({1 - x, 0, x, 0, x, 1, 1 - x, 1, std::fabs(x - off), 0.5}, segments);
        mesh.max_area = 1;
        mesh.keep_if([](const Ids& row) {
          return std::find(row.begin(), row.end(), 0) != row.end() ||
                 std::find(row.begin(), row.end(), 3) != row.end();
        });
        EXPECT_EQ(mesh.triangles.size(), 9u);
        EXPECT_EQ(mesh.verify().problem.empty(), off < 1e-9) << mesh.verify().problem;
        mesh.max_area = HUGE_VAL;
        for (const int power : kPowers)
          EXPECT_EQ(mesh.problem_at(power).empty(), off < 1e-9) << power << ": " << mesh.problem_at(power);
        mesh.max_area = 0;
        EXPECT_NE(mesh.problem(), "");
      }
    }
  }
}

// Two segments meet at 22.6 degrees, and are split where they are equally far from there.
TEST(SmallVerifyRefined, Apexes) {
  const auto problem = [](double factor, double bend, int power) {
    Case mesh({0, 0, 6.5, 0, 13, 0, 26, 0, 24, 10, 12 * factor, 5 * factor, 6, 2.5 + bend},
              {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 0});
    mesh = without_outside(mesh);
    mesh.min_angle = 20.7;
    return mesh.problem_at(power);
  };
  for (const int power : kPowers) {
    EXPECT_EQ(problem(1, 0, power), "");
    EXPECT_EQ(problem(1.001, 0, power), "");
    EXPECT_NE(problem(1.01, 0, power).find(" has an angle of 19."), std::string::npos);
    // The upper segment's first part is not on one line with the others.
    EXPECT_NE(problem(1, 1e-9, power).find(" has an angle of "), std::string::npos);
  }
}

// Two segments meet at 14.3 degrees, and their other ends, equally far away, are two corners of a triangle
// of 14.3 degrees.
TEST(SmallVerifyRefined, AnglesThatAreNotExcused) {
  const auto problem = [](const Segments& inside, Outside outside) {
    Segments segments = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 0, 0, 6, 0, 7};
    segments.insert(segments.end(), inside.begin(), inside.end());
    Case mesh({0, 0, 0, 8, 16, 8, 16, 0, 16, -8, 0, -8, 8, 1, 8, -1, 7.5, 0}, segments);
    mesh.outside = outside;
    const auto is_hole = [&](const Ids& row) { return row[0] == 0 && row[1] > 5 && row[2] > 5; };
    if (outside == Outside::holes) mesh.keep_if([&](const Ids& row) { return !is_hole(row); });
    mesh.min_angle = 14.5;
    return mesh.problem();
  };
  const Segments dent = {6, 8, 8, 7}, across = {6, 7, 6, 8, 8, 7, 0, 8};
  EXPECT_EQ(problem({0, 8}, Outside::keep), "");
  for (const auto& [inside, outside] : {std::pair(dent, Outside::holes), std::pair(across, Outside::keep)}) {
    EXPECT_NE(problem(inside, outside).find("angle of 14.25"), std::string::npos) << problem(inside, outside);
  }
}

// Rectangles along the lines of a grid, which overlap: depths by counting the rectangles around a triangle.
TEST(SmallVerifyConstrained, FillRules) {
  FixtureRandom random(2);
  int same = 0, others = 0;
  for (int round = 0; round < 200; ++round) {
    const int side = static_cast<int>(random.integer(2, 7));
    struct Rectangle {
      std::int64_t left, right, bottom, top, turn;
    };
    std::vector<Rectangle> rectangles;
    SegmentInput input;
    input.points = grid_points(side, side);
    const auto at = [side](std::int64_t x, std::int64_t y) {
      return static_cast<std::int32_t>(y * side + x);
    };
    for (auto left_over = random.integer(1, 5); left_over > 0; --left_over) {
      Rectangle r{random.integer(0, side - 2), 0, random.integer(0, side - 2), 0,
                  random.integer(0, 1) * 2 - 1};
      r.right = random.integer(r.left + 1, side - 1);
      r.top = random.integer(r.bottom + 1, side - 1);
      Ids ring = {at(r.left, r.bottom), at(r.right, r.bottom), at(r.right, r.top), at(r.left, r.top)};
      if (r.turn < 0) std::reverse(ring.begin(), ring.end());
      for (std::size_t k = 0; k < 4; ++k) input.segment(ring[k], ring[(k + 1) % 4]);
      rectangles.push_back(r);
    }
    const Case all(input.points, input.segments);
    const auto depth = [&](const Ids& row, FillRule rule) {
      double x = 0, y = 0;
      for (const std::int32_t v : row) {
        x += input.points[2 * static_cast<std::size_t>(v)];
        y += input.points[2 * static_cast<std::size_t>(v) + 1];
      }
      std::int64_t sum = 0;
      for (const Rectangle& r : rectangles) {
        const bool is_in = x > 3 * r.left && x < 3 * r.right && y > 3 * r.bottom && y < 3 * r.top;
        if (is_in) sum += rule == FillRule::winding ? r.turn : 1;
      }
      return rule == FillRule::winding ? sum : sum % 2;
    };
    std::vector<Case> results;
    for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
      Case result = all;
      result.keep_if([&](const Ids& row) { return depth(row, rule) != 0; });
      result.outside = random.integer(0, 1) == 0 ? Outside::hull : Outside::holes;
      result.fill_rule = rule;
      EXPECT_EQ(result.verify().problem, "");
      results.push_back(result);
    }
    results.push_back(without_outside(all));
    EXPECT_EQ(results.back().verify().problem, "");
    // Each is right by another rule only if that has the same result.
    for (const Case& one : results) {
      for (const Case& other : results) {
        Case changed = one;
        changed.fill_rule = other.fill_rule;
        changed.outside = other.outside;
        const bool is_same = one.triangles == other.triangles;
        EXPECT_EQ(changed.problem().empty(), is_same);
        ++(is_same ? same : others);
      }
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(same, 600);
  EXPECT_GT(others, 200);
}

TEST(SmallVerifyConstrained, DegenerateSets) {
  for (int n = 0; n < 4; ++n) {
    Coordinates line;
    for (int i = 0; i < n; ++i) line.insert(line.end(), {double(i), -2.0 * i});
    Segments segments;
    if (n > 1) segments = {0, n - 1, 1, 0};
    const Case collinear(line, segments);
    EXPECT_EQ(collinear.verify().problem, "") << n;
    EXPECT_EQ(collinear.verify().constraint_edges, n > 1 ? static_cast<std::size_t>(n - 1) : 0u);
  }
  const Case equal({1, 1, 1, 1, 1, 1}, {0, 2});
  EXPECT_EQ(equal.verify().problem, "");
}

// Exactly the canonical result is right: all that changes it is found.
TEST(SmallVerifyConstrained, FindsEveryChange) {
  FixtureRandom random(1);
  int changed_results = 0;
  for (int round = 0; round < 400; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(4, 24));
    const Coordinates points =
        random_integer_points(n, static_cast<int>(random.integer(2, 9)), static_cast<std::uint64_t>(round));
    const Segments segments = edges_of_stretched(
        points, std::ldexp(1, static_cast<int>(random.integer(-3, 3))), 2, static_cast<std::uint64_t>(round));
    const Case right(points, segments);
    ASSERT_EQ(right.verify().problem, "");
    const Ids representatives = delaunay_of(points, {0, n}).representatives;
    const TriangleSet expected = sorted_triangles(right.triangles);
    // Any of several equal points may stand for them, but only one.
    const auto count = [](const Ids& ids) { return std::set<std::int32_t>(ids.begin(), ids.end()).size(); };
    const auto expect_wrong_if_other = [&](const Case& changed) {
      Ids triangles = changed.triangles;
      for (std::int32_t& v : triangles) v = representatives[v];
      const bool is_same =
          sorted_triangles(triangles) == expected && count(changed.triangles) == count(right.triangles);
      EXPECT_EQ(changed.problem().empty(), is_same) << changed.problem();
      changed_results += !is_same;
    };
    for (std::size_t c = 0; c < right.triangles.size(); ++c) {
      Case changed = right;
      if (right.neighbors[c] >= 0) {
        flip(changed.triangles, right.neighbors, c);
        expect_wrong_if_other(changed);
      }
      changed = right;
      changed.triangles[c] = static_cast<std::int32_t>(random.integer(0, static_cast<std::int64_t>(n) - 1));
      expect_wrong_if_other(changed);
      if (c % 3 != 0) continue;
      const auto row = static_cast<std::ptrdiff_t>(c);
      changed = right;
      changed.triangles.erase(changed.triangles.begin() + row, changed.triangles.begin() + row + 3);
      expect_wrong_if_other(changed);
      changed = right;
      const Ids twice(right.triangles.begin() + row, right.triangles.begin() + row + 3);
      changed.triangles.insert(changed.triangles.end(), twice.begin(), twice.end());
      EXPECT_NE(changed.problem(), "");
    }
    // With fewer or more segments, the same triangles are right only if they are the result of those.
    Case fewer = right;
    for (std::size_t s = 0; s < segments.size(); s += 2) {
      fewer.segments = segments;
      const auto at = fewer.segments.begin() + static_cast<std::ptrdiff_t>(s);
      fewer.segments.erase(at, at + 2);
      const Case other(points, fewer.segments);
      EXPECT_EQ(fewer.problem().empty(), sorted_triangles(other.triangles) == expected);
      Case more = other;
      more.segments = segments;
      EXPECT_EQ(more.problem().empty(), sorted_triangles(other.triangles) == expected);
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(changed_results, 10000);
}

// The place where two segments cross, compared with a point by rational numbers: points near it and at it, of
// all magnitudes.
TEST(SmallVerifyConstrained, ComparesPointsWithCrossings) {
  using Number = mpq_class;
  const auto area = [](const double* a, const double* b, const double* c) -> Number {
    return (Number(a[0]) - c[0]) * (Number(b[1]) - c[1]) - (Number(a[1]) - c[1]) * (Number(b[0]) - c[0]);
  };
  FixtureRandom random(9);
  ExactPredicates exact;
  int signs[3] = {0, 0, 0}, crossings = 0;
  while (crossings < 20000) {
    double at[5][2];
    const int kind = static_cast<int>(random.integer(0, 3));
    const auto range = random.integer(1, 12);
    for (auto& place : at) {
      for (double& value : place) {
        value = kind == 0 ? random.unit() : static_cast<double>(random.integer(-range, range));
        if (kind == 2) value = std::ldexp(value, static_cast<int>(random.integer(-400, 400)));
        if (kind == 3) value = std::ldexp(value, -1070);
      }
    }
    const Number before = area(at[2], at[3], at[0]), after = area(at[2], at[3], at[1]);
    if (sgn(before) * sgn(after) >= 0) continue;
    if (sgn(area(at[0], at[1], at[2])) * sgn(area(at[0], at[1], at[3])) >= 0) continue;
    ++crossings;
    Number place[2];
    for (int axis = 0; axis < 2; ++axis) {
      place[axis] = at[0][axis] + before / (before - after) * (Number(at[1][axis]) - at[0][axis]);
      if (random.integer(0, 3) > 0) at[4][axis] = place[axis].get_d();
      if (random.integer(0, 3) == 0)
        at[4][axis] = std::nextafter(at[4][axis], random.unit() < 0.5 ? -HUGE_VAL : HUGE_VAL);
    }
    const int x = cmp(Number(at[4][0]), place[0]), y = cmp(Number(at[4][1]), place[1]);
    const int expected = x != 0 ? (x > 0) - (x < 0) : (y > 0) - (y < 0);
    ASSERT_EQ(exact.compare_with_crossing(at[0], at[1], at[2], at[3], at[4]), expected);
    ++signs[expected + 1];
  }
  for (const int count : signs) EXPECT_GT(count, 500);
}

// -----------------------------------------------------------------------------------------------------------
// Nasty segments

SegmentInput moved(SegmentInput input, double factor) {
  input.points = scaled(std::move(input.points), factor);
  return input;
}

// The library, the brute-force definition and the checker agree.
void expect_right(const SegmentInput& input) {
  const std::vector<std::size_t> offsets = {0, input.points.size() / 2};
  const Triangulation delaunay = delaunay_of(input.points, offsets);
  const ConstrainedTriangulation result = insert(input.points, offsets, delaunay, input.segments);
  expect_edges(expected_edges(input.points, offsets, delaunay, input.segments), result);
  expect_canonical(input.points, delaunay, result);
  EXPECT_EQ(Case(input.points, input.segments).verify().problem, "");
}

TEST(SmallNastySegments, AreRight) {
  for (const NastySegments& nasty : nasty_segments()) {
    for (const int n : {3, 10, 30, 150}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(nasty.name + ", n = " + std::to_string(n) + ", seed " + std::to_string(seed));
        const SegmentInput input = nasty.make(n, seed);
        expect_right(input);
        expect_right(turned(duplicated(input, seed)));
        expect_right(moved(input, 0x1p-900));
        expect_right(moved(turned(input), 0x1p900));
        if (HasFailure()) return;
      }
    }
  }
}

TEST(NastySegments, AreRight) {
  for (const NastySegments& nasty : nasty_segments()) {
    for (const int n : {3000, 30000}) {
      SCOPED_TRACE(nasty.name + ", n = " + std::to_string(n));
      const SegmentInput input = nasty.make(n, 1);
      EXPECT_GT(input.segments.size(), n == 3000 && nasty.name == "circle-with-chords" ? 20u : 40u);
      EXPECT_EQ(Case(input.points, input.segments).verify().problem, "");
      if (n > 3000) continue;
      expect_right(input);
      const SegmentInput twice = turned(duplicated(input, 1));
      EXPECT_EQ(Case(twice.points, twice.segments).verify().problem, "");
    }
  }
}

// All of them as sets of one call.
TEST(NastySegments, AsSetsOfOneCall) {
  SegmentInput all;
  std::vector<std::size_t> offsets = {0};
  std::vector<SegmentInput> inputs;
  for (const NastySegments& nasty : nasty_segments()) {
    inputs.push_back(moved(nasty.make(400, 2), inputs.size() % 2 == 0 ? 0x1p-700 : 0x1p700));
    all.add(inputs.back());
    offsets.push_back(all.points.size() / 2);
  }
  const Triangulation delaunay = delaunay_of(all.points, offsets);
  const ConstrainedTriangulation result = insert(all.points, offsets, delaunay, all.segments);
  std::size_t edge = 0;
  for (std::size_t s = 0; s < inputs.size(); ++s) {
    Case alone(inputs[s].points, inputs[s].segments);
    ASSERT_EQ(alone.verify().problem, "");
    const auto first = static_cast<std::int32_t>(offsets[s]);
    for (std::int32_t& v : alone.triangles) v += first;
    for (std::int32_t& v : alone.edges) v += first;
    const auto begin =
        result.triangles.begin() + static_cast<std::ptrdiff_t>(3 * delaunay.triangle_offsets[s]);
    const auto end =
        result.triangles.begin() + static_cast<std::ptrdiff_t>(3 * delaunay.triangle_offsets[s + 1]);
    EXPECT_EQ(Ids(begin, end), alone.triangles);
    const auto edges = result.constraint_edges.begin() + static_cast<std::ptrdiff_t>(edge);
    EXPECT_EQ(Ids(edges, edges + static_cast<std::ptrdiff_t>(alone.edges.size())), alone.edges);
    edge += alone.edges.size();
  }
  EXPECT_EQ(edge, result.constraint_edges.size());
}

// The fixtures that others made, with rings through them.
TEST(NastySegments, RingsThroughFiles) {
  for (const std::string& file : data_files()) {
    SCOPED_TRACE(file);
    const SegmentInput input = rings_through(io::read_points(test_data() + "/" + file).coordinates, 3);
    EXPECT_EQ(Case(input.points, input.segments).verify().problem, "");
    if (input.size() < 10000) expect_right(input);
    EXPECT_EQ(without_outside(Case(input.points, input.segments)).verify().problem, "");
  }
}

// Stars, diameters and overlaps must not take the checker a square number of steps.
TEST(NastySegments, TakeLittleTimeToCheck) {
  for (const char* const name : {"star", "diameters", "overlaps", "spirals", "brush", "koch-rings"}) {
    for (const NastySegments& nasty : nasty_segments()) {
      if (nasty.name != name) continue;
      SCOPED_TRACE(name);
      const SegmentInput input = nasty.make(100000, 1);
      const Case right(input.points, input.segments);
      const auto start = std::chrono::steady_clock::now();
      EXPECT_EQ(right.verify().problem, "");
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      RecordProperty(std::string("seconds_") + name, std::to_string(time.count()));
    }
  }
}

}  // namespace
}  // namespace flaunay::testing
