// Proofs of results as users call them: each right result is right, and each array that is changed is found.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/verify.hpp"
#include "tests/constrained/nasty_domains.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay {
namespace {

using testing::Coordinates;
using testing::Segments;
using testing::triangulator;

// What is wrong with a copy that `change` has changed: what the proof says, or that arrays do not fit.
template <typename Result, typename Change, typename Verify>
std::string problem_after(Result copy, const Change& change, const Verify& verify) {
  change(copy);
  try {
    return verify(copy);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
    return error.what();
  }
}

// Changes each number of each of these arrays, by one in either direction.
template <typename Result, typename Verify, typename... Arrays>
void expect_each_number_to_count(const Result& right, const Verify& verify, Arrays... arrays) {
  ASSERT_EQ(verify(right), "");
  int number = 0;
  const auto change_all = [&](auto array) {
    const std::size_t size = (right.*array).size();
    EXPECT_GT(size, 0u) << "array " << number;
    for (std::size_t i = 0; i < size; ++i) {
      for (const int step : {-1, 1}) {
        EXPECT_NE(problem_after(
                      right, [&](Result& wrong) { (wrong.*array)[i] += step; }, verify),
                  "")
            << "array " << number << ", entry " << i << ", step " << step;
      }
    }
    ++number;
  };
  (change_all(arrays), ...);
}

Options all_arrays() {
  Options options;
  options.neighbors = options.halfedges = options.areas = true;
  return options;
}

TEST(ResultProof, FindsWhatIsWrongWithPlainTriangulations) {
  // A grid with duplicates, points on a line, none, one, and others.
  Coordinates points = testing::grid_points(3, 4);
  std::vector<std::size_t> offsets{0};
  const auto add = [&](const Coordinates& more) {
    points.insert(points.end(), more.begin(), more.end());
    offsets.push_back(points.size() / 2);
  };
  add({0, 0, 1, 1, 2, 3});
  add({0, 0, 4, 2, 2, 1, 0, 0});
  add({});
  add({5, 5});
  add(testing::random_integer_points(12, 6, 1));
  const Triangulation right = triangulator().triangulate(points.data(), offsets, all_arrays());
  const auto verify_it = [&](const Triangulation& mesh) { return verify(points.data(), offsets, mesh); };
  expect_each_number_to_count(right, verify_it, &Triangulation::triangles, &Triangulation::neighbors,
                              &Triangulation::halfedges, &Triangulation::hull,
                              &Triangulation::representatives, &Triangulation::areas,
                              &Triangulation::triangle_offsets, &Triangulation::hull_offsets);
  Triangulation plain = right;
  plain.neighbors.clear();
  plain.halfedges.clear();
  plain.areas.clear();
  EXPECT_EQ(verify_it(plain), "");
  // The other diagonal of a square of the grid is Delaunay, too, but not canonical.
  const Coordinates square = {0, 0, 1, 0, 1, 1, 0, 1};
  Triangulation other = triangulator().triangulate(square.data(), 4);
  ASSERT_EQ(verify(square.data(), {0, 4}, other), "");
  other.triangles = {0, 1, 3, 1, 2, 3};
  EXPECT_NE(verify(square.data(), {0, 4}, other), "");
  points[1] = NAN;
  EXPECT_THROW(verify_it(right), Error);
}

struct Asked {
  Coordinates points;
  std::vector<std::size_t> offsets;
  Segments segments;
  Constraints constraints;
  ConstrainedOptions options;

  Asked(const testing::SegmentInput& input)
      : points(input.points), offsets{0, input.points.size() / 2}, segments(input.segments) {
    constraints.segments = segments.data();
    constraints.segment_count = segments.size() / 2;
    options.labels = options.neighbors = options.halfedges = options.areas = true;
  }
  ConstrainedTriangulation result() const {
    return triangulator().constrained(points.data(), offsets, constraints, options);
  }
  std::string problem_of(const ConstrainedTriangulation& mesh) const {
    return verify(points.data(), offsets, constraints, options, mesh);
  }
};

TEST(ResultProof, FindsWhatIsWrongWithConstraints) {
  testing::SegmentInput input;
  input.points = testing::grid_points(4, 4);
  for (const auto& [a, b] : {std::pair(0, 15), std::pair(3, 0), std::pair(1, 7), std::pair(0, 2)})
    input.segment(a, b);
  Asked asked(input);
  using Mesh = ConstrainedTriangulation;
  expect_each_number_to_count(
      asked.result(), [&](const Mesh& mesh) { return asked.problem_of(mesh); }, &Mesh::triangles,
      &Mesh::neighbors, &Mesh::halfedges, &Mesh::hull, &Mesh::representatives, &Mesh::areas,
      &Mesh::constraint_edges, &Mesh::edge_segments, &Mesh::piece_edges, &Mesh::piece_offsets, &Mesh::depths,
      &Mesh::regions, &Mesh::triangle_offsets);
  const Mesh right = asked.result();
  for (std::size_t c = 0; c < right.constrained.size(); ++c) {
    EXPECT_NE(problem_after(
                  right, [&](Mesh& wrong) { wrong.constrained[c] ^= 1; },
                  [&](const Mesh& mesh) { return asked.problem_of(mesh); }),
              "");
  }
  // The right result of other segments, and of another domain.
  Asked other = asked;
  other.segments[1] = 14;
  other.constraints.segments = other.segments.data();
  EXPECT_NE(other.problem_of(right), "");
  asked.options.outside = Outside::hull;
  EXPECT_NE(asked.problem_of(right), "");
}

TEST(ResultProof, AcceptsNastySegmentsSplitOrNot) {
  for (const testing::NastySegments& nasty : testing::nasty_segments()) {
    SCOPED_TRACE(nasty.name);
    Asked asked(nasty.make(60, 3));
    for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
      asked.options.outside = outside;
      EXPECT_EQ(asked.problem_of(asked.result()), "");
    }
    // Segments that cross these.
    const auto n = static_cast<std::int64_t>(asked.points.size() / 2);
    testing::FixtureRandom random(7);
    for (int k = 0; k < 10; ++k)
      asked.segments.push_back(static_cast<std::int32_t>(random.integer(0, n - 1)));
    asked.constraints.segments = asked.segments.data();
    asked.constraints.segment_count = asked.segments.size() / 2;
    asked.options.crossings = Crossings::split;
    asked.options.outside = Outside::keep;
    EXPECT_EQ(asked.problem_of(asked.result()), "");
  }
}

TEST(ResultProof, AcceptsRefinedDomains) {
  for (const testing::NastyDomain& nasty : testing::nasty_domains()) {
    SCOPED_TRACE(nasty.name);
    const testing::DomainToRefine domain = nasty.make(40, 5);
    Asked asked(domain);
    asked.options.outside = domain.outside;
    asked.constraints.holes = domain.holes.data();
    asked.constraints.hole_count = domain.holes.size() / 2;
    asked.options.refinement.min_angle = 25;
    asked.options.refinement.most_points = 2000;
    const ConstrainedTriangulation right = asked.result();
    EXPECT_EQ(asked.problem_of(right), "");
    // A mesh that is refined further, and one that is not what was asked for.
    Asked further(testing::SegmentInput{asked.points, right.constraint_edges});
    further.points.insert(further.points.end(), right.added_points.begin(), right.added_points.end());
    further.offsets[1] = further.points.size() / 2;
    further.options.refinement.mesh.triangles = right.triangles.data();
    further.options.refinement.mesh.count = right.triangles.size() / 3;
    further.options.refinement.min_angle = 20;
    further.options.refinement.most_points = 100;
    if (right.triangles.empty()) continue;
    EXPECT_EQ(further.problem_of(further.result()), "");
    if (!right.refinement.bad_triangles.empty()) continue;
    asked.options.refinement.max_area = 1e-9 * right.areas[0];
    EXPECT_NE(asked.problem_of(right), "");
  }
}

TEST(ResultProof, AcceptsPolygonsAndMaps) {
  // Two squares, one with a hole, that share a side; and one that lies over both.
  const Coordinates points = {0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 1, 2, 2, 2, 2,
                              1, 4, 0, 8, 0, 8, 4, 4, 4, 3, 3, 5, 3, 4, 5};
  Polygons polygons;
  polygons.coordinates = points.data();
  polygons.ring_offsets = {0, 4, 8, 12, 15};
  polygons.polygon_offsets = {0, 2, 3, 4};
  for (const bool map : {false, true}) {
    for (const bool has_parts : {false, true}) {
      for (const FillRule rule : {FillRule::even_odd, FillRule::winding, FillRule::nesting}) {
        if (map && rule == FillRule::nesting) continue;
        polygons.part_offsets = has_parts ? std::vector<std::size_t>{0, 2, 3, 4} : std::vector<std::size_t>();
        PolygonOptions options;
        options.labels = true;
        options.map = map;
        options.fill_rule = rule;
        options.crossings = Crossings::split;
        for (const double area : {0.0, 0.1}) {
          options.refinement.max_area = area;
          ConstrainedTriangulation mesh = triangulator().polygons(polygons, options);
          EXPECT_EQ(verify(polygons, options, mesh), "") << map << has_parts << static_cast<int>(rule);
          mesh.triangles.resize(mesh.triangles.size() - 3);
          EXPECT_NE(
              problem_after(
                  mesh, [](auto&) {}, [&](const auto& wrong) { return verify(polygons, options, wrong); }),
              "");
        }
      }
    }
  }
}

// A triangle that is too large by less than a rounding was waited for at a level of areas, without end.
TEST(ResultProof, AcceptsAreasThatAreNearlyRight) {
  const Coordinates points = {5, 3, 4, 5, 2, 3, 1, 5, 0, 4};
  Polygons polygons;
  polygons.coordinates = points.data();
  polygons.ring_offsets = {0, 5};
  polygons.polygon_offsets = {0, 1};
  PolygonOptions options;
  options.crossings = Crossings::split;
  options.refinement.max_area = 1;
  EXPECT_EQ(verify(polygons, options, triangulator().polygons(polygons, options)), "");
}

}  // namespace
}  // namespace flaunay
