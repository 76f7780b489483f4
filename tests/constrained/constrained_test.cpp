// The constrained triangulation, natively: everything against its definition, and the errors.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "constrained/crossings/first_crossing.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/paths.hpp"

namespace flaunay::testing {
namespace {

std::string text_of(const Coordinates& points, const Segments& segments) {
  std::string text;
  for (std::size_t i = 0; i < points.size() && points.size() <= 80; ++i) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%s%.17g", i % 2 ? " " : "\n  ", points[i]);
    text += buffer;
  }
  for (std::size_t i = 0; i < segments.size() && points.size() <= 80; ++i) {
    text += (i % 2 ? "-" : "\n  ") + std::to_string(segments[i]);
  }
  return text;
}

struct Sets {
  Coordinates points;
  std::vector<std::size_t> offsets;
  Triangulation delaunay;

  explicit Sets(Coordinates coordinates) : Sets(coordinates, {0, coordinates.size() / 2}) {}
  Sets(Coordinates coordinates, std::vector<std::size_t> ends)
      : points(std::move(coordinates)), offsets(std::move(ends)), delaunay(delaunay_of(points, offsets)) {}

  ConstrainedTriangulation constrain(const Segments& segments) const {
    return insert(points, offsets, delaunay, segments);
  }
};

// Compares with the definition; if segments cross, leaves out those that the error names, one after the
// other. Returns how many were left out.
int expect_right(const Sets& sets, Segments segments) {
  SCOPED_TRACE(text_of(sets.points, segments));
  Plane plane(sets.points);
  for (int left_out = 0;; ++left_out) {
    const auto edges = expected_edges(sets.points, sets.offsets, sets.delaunay, segments);
    const Edge crossing = expected_crossing(sets.offsets, edges, plane);
    if (crossing.first < 0) {
      const ConstrainedTriangulation result = sets.constrain(segments);
      expect_edges(edges, result);
      expect_canonical(sets.points, sets.delaunay, result);
      return left_out;
    }
    const std::string message = error_of(ErrorKind::input, [&] { sets.constrain(segments); });
    EXPECT_EQ(message.rfind("segments " + std::to_string(crossing.first) + " (", 0), 0u) << message;
    EXPECT_NE(message.find(" and " + std::to_string(crossing.second) + " (points "), std::string::npos)
        << message;
    segments.erase(segments.begin() + 2 * crossing.second, segments.begin() + 2 * crossing.second + 2);
  }
}

TEST(SmallConstrained, RandomSegmentsInSmallBoxes) {
  FixtureRandom random(1);
  int crossings = 0;
  for (int round = 0; round < 4000; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(0, 16));
    const int side = static_cast<int>(random.integer(1, 7));
    const Sets sets(random_integer_points(n, side, static_cast<std::uint64_t>(round)));
    const auto count = static_cast<std::size_t>(random.integer(0, 12));
    crossings += expect_right(sets, random_segments(random, n, count));
    if (HasFailure()) return;
  }
  EXPECT_GT(crossings, 1000);
}

TEST(SmallConstrained, SegmentsAlongGrids) {
  FixtureRandom random(2);
  for (int round = 0; round < 200; ++round) {
    const int columns = static_cast<int>(random.integer(1, 7)), rows = static_cast<int>(random.integer(1, 7));
    const Sets sets(grid_points(columns, rows));
    Segments segments;
    for (int k = 0; k < 8; ++k) {
      const auto y = random.integer(0, rows - 1);
      segments.push_back(static_cast<std::int32_t>(y * columns + random.integer(0, columns - 1)));
      // Overlaps within the row or the column, or any place.
      const auto last = random.integer(0, 2);
      const auto place = last == 0   ? y * columns + random.integer(0, columns - 1)
                         : last == 1 ? random.integer(0, rows - 1) * columns + segments.back() % columns
                                     : random.integer(0, columns * rows - 1);
      segments.push_back(static_cast<std::int32_t>(place));
    }
    expect_right(sets, segments);
    if (HasFailure()) return;
  }
}

// One circle, which constraints cut into cells.
TEST(SmallConstrained, CocircularPoints) {
  const Coordinates points = {5,  0, 4,  3,  3,  4,  0, 5,  -3, 4,  -4, 3,
                              -5, 0, -4, -3, -3, -4, 0, -5, 3,  -4, 4,  -3};
  const Sets sets(points);
  FixtureRandom random(3);
  for (int round = 0; round < 300; ++round) {
    expect_right(sets,
                 random_segments(random, points.size() / 2, static_cast<std::size_t>(random.integer(1, 8))));
    if (HasFailure()) return;
  }
}

TEST(SmallConstrained, ResultDoesNotDependOnTheOrderOfSegments) {
  FixtureRandom random(4);
  for (int round = 0; round < 50; ++round) {
    const Sets sets(random_integer_points(60, 12, static_cast<std::uint64_t>(round)));
    const Segments segments = edges_of_stretched(sets.points, 8, 2, static_cast<std::uint64_t>(round));
    const ConstrainedTriangulation expected = sets.constrain(segments);
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < segments.size() / 2; ++s) order.push_back(s);
    random.shuffle(order);
    Segments others;
    for (const std::size_t s : order) {
      const auto turned = static_cast<std::size_t>(random.integer(0, 1));
      others.insert(others.end(), {segments[2 * s + turned], segments[2 * s + 1 - turned]});
    }
    const ConstrainedTriangulation result = sets.constrain(others);
    EXPECT_EQ(result.triangles, expected.triangles);
    EXPECT_EQ(result.neighbors, expected.neighbors);
    EXPECT_EQ(result.constraint_edges, expected.constraint_edges);
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_EQ(result.piece_edges[2 * k], expected.piece_edges[2 * order[k]]);
      EXPECT_EQ(result.piece_edges[2 * k + 1], expected.piece_edges[2 * order[k] + 1]);
    }
  }
}

// Several sets, with and without triangles, in one call: as each on its own.
TEST(SmallConstrained, SeveralSets) {
  const SetsWithSegments all = several_sets(30, true);
  EXPECT_EQ(expect_right(Sets(all.points, all.offsets), all.segments), 0);
}

// Vertices outside of the row of a segment's cavity more than once, and edges that end inside of it.
TEST(SmallConstrained, CombsAndSpirals) {
  FixtureRandom random(6);
  for (int round = 0; round < 100; ++round) {
    Coordinates points = {-1, 0, 101, 0};
    for (int i = 0; i < 60; ++i) {
      const double y =
          std::ldexp(static_cast<double>(random.integer(1, 64)), static_cast<int>(random.integer(-8, 0)));
      points.insert(points.end(), {static_cast<double>(random.integer(0, 100)), i % 2 ? y : -y});
    }
    Segments segments = edges_of_stretched(points, std::ldexp(1, static_cast<int>(random.integer(-8, 8))), 2,
                                           static_cast<std::uint64_t>(round));
    segments.insert(segments.begin(), {0, 1});
    expect_right(Sets(points), segments);
    if (HasFailure()) return;
  }
}

TEST(SmallConstrained, AllMagnitudes) {
  FixtureRandom random(7);
  for (const double factor : {0x1p-1000, 0x1p-600, 0x1p600, 0x1p1000}) {
    const Coordinates points = scaled(random_integer_points(30, 9, 1), factor);
    expect_right(Sets(points), random_segments(random, 30, 12));
  }
  // Points of very different magnitudes.
  for (int round = 0; round < 100; ++round) {
    Coordinates points;
    for (int i = 0; i < 30; ++i) {
      const double scale = std::ldexp(1, static_cast<int>(random.integer(-200, 200)));
      points.insert(points.end(), {(random.unit() - 0.5) * scale, (random.unit() - 0.5) * scale});
    }
    expect_right(Sets(points), random_segments(random, 15, 10));
    if (HasFailure()) return;
  }
}

TEST(SmallConstrained, CrossingsNameThePlace) {
  const Sets sets({0, 0, 4, 4, 0, 4, 4, 0, 10, 10});
  EXPECT_EQ(error_of(ErrorKind::input,
                     [&] {
                       sets.constrain({4, 4, 3, 2, 0, 1});
                     }),
            "segments 1 (points 3 and 2) and 2 (points 0 and 1) cross near (2, 2)");
  // At a point they do not cross.
  EXPECT_EQ(expect_right(Sets({0, 0, 4, 4, 0, 4, 4, 0, 2, 2}), {0, 1, 2, 3}), 0);
}

// What is found by comparing the first segments is what inserting all of them finds.
TEST(SmallConstrained, FirstSegmentsThatCross) {
  FixtureRandom random(11);
  int found = 0, left = 0;
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    const auto n = static_cast<std::size_t>(random.integer(4, 40));
    Coordinates points =
        random_integer_points(n, round % 2 == 0 ? 9 : 1000, static_cast<std::uint64_t>(round));
    for (double& c : points) c = std::ldexp(c, round % 3 == 0 ? -700 : round % 3 == 1 ? 0 : 700);
    const Sets sets(points);
    const Segments segments = random_segments(random, n, static_cast<std::size_t>(random.integer(2, 30)));
    const std::string first = error_of(ErrorKind::input, [&] {
      constrained::check_first_segments(points.data(), sets.offsets, segments.data(), segments.size() / 2);
    });
    const std::string any = error_of(ErrorKind::input, [&] { sets.constrain(segments); });
    const bool is_found = first != "no error";
    if (is_found) {
      EXPECT_EQ(first, any);
    }
    found += is_found;
    left += !is_found && any != "no error";
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(left, 10);  // with a point where they cross, as it may be one, or among later segments
}

TEST(SmallConstrained, WrongSegmentsAreErrors) {
  const Sets sets({0, 0, 1, 0, 0, 1, 5, 5, 6, 5, 5, 6}, {0, 3, 6});
  const auto message = [&sets](const Segments& segments) {
    return error_of(ErrorKind::usage, [&] { sets.constrain(segments); });
  };
  EXPECT_EQ(message({0, 1, 2, 6}), "segment 1 has point 6, but there are 6 points");
  EXPECT_EQ(message({-1, 1}), "segment 0 has point -1, but there are 6 points");
  EXPECT_EQ(message({0, 1, 2, 3}), "segment 1 joins points 2 and 3 of different sets");
  EXPECT_EQ(message({0, 2, 3, 5}), "no error");
}

TEST(Constrained, EdgesOfOtherTriangulations) {
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {100, 3000}) {
      for (const double factor : {0x1p-6, 0x1p6}) {
        for (const int one_in : {1, 5}) {
          SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n) + ", factor " + std::to_string(factor));
          const Sets sets(fixture.make(n, 2));
          const Segments segments = edges_of_stretched(sets.points, factor, one_in, n);
          const ConstrainedTriangulation result = sets.constrain(segments);
          expect_canonical(sets.points, sets.delaunay, result);
          EXPECT_EQ(result.constraint_edges.size(), segments.size());
          for (std::size_t s = 0; s < segments.size(); s += 2) {
            const std::int32_t e = result.piece_edges[s];
            EXPECT_EQ(result.piece_edges[s + 1], e + 1);
            EXPECT_EQ(unordered(result.constraint_edges[2 * e], result.constraint_edges[2 * e + 1]),
                      unordered(segments[s], segments[s + 1]));
          }
          if (HasFailure()) return;
        }
      }
    }
  }
}

TEST(Constrained, Files) {
  for (const std::string& file : data_files()) {
    SCOPED_TRACE(file);
    const Sets sets(io::read_points(test_data() + "/" + file).coordinates);
    const ConstrainedTriangulation result = sets.constrain(edges_of_stretched(sets.points, 16, 2, 1));
    expect_canonical(sets.points, sets.delaunay, result);
  }
}

// One segment that crosses everything: random points, and rows of points on curves whose polygons have
// triangles that all share a vertex. Gift-wrapping alone would take a square number of steps.
TEST(Constrained, OneSegmentThroughEverything) {
  FixtureRandom random(8);
  const int n = 100000;
  for (int shape = 0; shape < 4; ++shape) {
    SCOPED_TRACE(shape);
    Coordinates points = {-1, 0, n, 0};
    for (int i = 0; i < n; ++i) {
      const double x = i + (shape == 3 ? 0.0 : 0.25 * random.unit()), t = x / n;
      const double height = shape == 0   ? 1 + random.unit()
                            : shape == 1 ? 1 + t * t
                            : shape == 2 ? 1 + t * (1 - t) * n
                                         : 1;
      points.insert(points.end(), {x, i % 2 ? height : -height});
    }
    const Sets sets(points);
    const auto start = std::chrono::steady_clock::now();
    const ConstrainedTriangulation result = sets.constrain({0, 1});
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    RecordProperty("seconds_" + std::to_string(shape), std::to_string(time.count()));
    expect_canonical(points, sets.delaunay, result);
    expect_edges(expected_edges(points, sets.offsets, sets.delaunay, {0, 1}), result);
  }
}

// A star of segments on one point, and segments along a line that all overlap: neither may take a square
// number of steps.
TEST(Constrained, StarsAndOverlaps) {
  const std::int32_t n = 100000;
  Coordinates star = {0, 0}, line;
  Segments rays, spans;
  for (std::int32_t i = 1; i <= n; ++i) {
    const double angle = 2 * M_PI * i / n, radius = i % 2 ? 1 : 2;
    star.insert(star.end(), {radius * std::cos(angle), radius * std::sin(angle)});
    rays.insert(rays.end(), {0, i});
    line.insert(line.end(), {double(i), double(i)});
    spans.insert(spans.end(), {(i - 1) / 2, n - 1 - (i - 1) / 3});
  }
  const Sets stars(star);
  expect_canonical(star, stars.delaunay, stars.constrain(rays));
  for (const bool with_others : {false, true}) {
    if (with_others) line.insert(line.end(), {0, double(n), double(n), 0});
    const ConstrainedTriangulation result = Sets(line).constrain(spans);
    EXPECT_EQ(result.constraint_edges.size(), 2 * static_cast<std::size_t>(n - 1));
    for (std::int32_t s = 0; s < n; ++s) {
      ASSERT_EQ(result.piece_edges[2 * s], spans[2 * s]);
      ASSERT_EQ(result.piece_edges[2 * s + 1], spans[2 * s + 1]);
    }
  }
}

}  // namespace
}  // namespace flaunay::testing
