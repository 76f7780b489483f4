// Beside CGAL's constrained Delaunay triangulation: equal triangles where it is unique, equally many edges
// elsewhere.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "constrained/crossings/split.hpp"
#include "prove/constrained_proof.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using ConstrainedStructure =
    CGAL::Triangulation_data_structure_2<Vertex, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, ConstrainedStructure,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

Constrained cgal_constrained(const Coordinates& points, const Triangulation& delaunay,
                             const Segments& segments) {
  Constrained result;
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> input;
  for (std::size_t i = 0; i < points.size() / 2; ++i) {
    input.emplace_back(Kernel::Point_2(points[2 * i], points[2 * i + 1]), delaunay.representatives[i]);
  }
  result.insert(input.begin(), input.end());
  std::vector<Constrained::Vertex_handle> vertices(input.size());
  for (const auto v : result.finite_vertex_handles()) vertices[v->info()] = v;
  for (std::size_t s = 0; s < segments.size(); s += 2) {
    const auto a = vertices[delaunay.representatives[segments[s]]],
               b = vertices[delaunay.representatives[segments[s + 1]]];
    if (a != b) result.insert_constraint(a, b);
  }
  return result;
}

std::size_t constrained_edges(const Constrained& triangulation) {
  std::size_t count = 0;
  for (const auto& edge : triangulation.finite_edges()) count += triangulation.is_constrained(edge) ? 1 : 0;
  return count;
}

TEST(ConstrainedCgal, CountsOnFixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {0, 1, 2, 3, 10, 100, 3000}) {
      SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n));
      const Coordinates points = fixture.make(n, 2);
      const Triangulation delaunay = delaunay_of(points, {0, points.size() / 2});
      const Segments segments = edges_of_stretched(points, 16, 3, n);
      const auto result = insert(points, {0, points.size() / 2}, delaunay, segments);
      const Constrained expected = cgal_constrained(points, delaunay, segments);
      EXPECT_EQ(result.triangles.size() / 3, expected.dimension() < 2 ? 0 : expected.number_of_faces());
      EXPECT_EQ(result.constraint_edges.size() / 2, constrained_edges(expected));
    }
  }
}

std::vector<std::int32_t> triangles_of(const Constrained& triangulation) {
  std::vector<std::int32_t> triangles;
  if (triangulation.dimension() < 2) return triangles;
  for (const auto& face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner) triangles.push_back(face->vertex(corner)->info());
  }
  return triangles;
}

// Triangles are equal wherever no four points on a circle leave a choice.
TEST(ConstrainedCgal, NastySegments) {
  int unique = 0;
  for (const NastySegments& nasty : nasty_segments()) {
    for (const int n : {3, 10, 100, 3000}) {
      SCOPED_TRACE(nasty.name + ", n = " + std::to_string(n));
      const SegmentInput input = nasty.make(n, 1);
      const Triangulation delaunay = delaunay_of(input.points, {0, input.points.size() / 2});
      const auto result = insert(input.points, {0, input.points.size() / 2}, delaunay, input.segments);
      const Constrained expected = cgal_constrained(input.points, delaunay, input.segments);
      const std::vector<std::int32_t> triangles = triangles_of(expected);
      EXPECT_EQ(result.triangles.size(), triangles.size());
      EXPECT_EQ(result.constraint_edges.size() / 2, constrained_edges(expected));
      VerifyConstraints constraints;
      constraints.segments = &input.segments;
      const VerifyReport report = verify_constrained(input.points.data(), input.points.size() / 2,
                                                     result.triangles, &result.neighbors, constraints);
      EXPECT_EQ(report.problem, "");
      if (report.cocircular_edges > 0) continue;
      ++unique;
      EXPECT_EQ(sorted_triangles(result.triangles), sorted_triangles(triangles));
    }
  }
  EXPECT_GT(unique, 20);
}

TEST(ConstrainedCgal, SameTriangles) {
  for (const char* name : {"uniform", "normal", "kuzmin", "line", "clusters"}) {
    for (const double factor : {0x1p-7, 0.25, 2.0}) {
      SCOPED_TRACE(name + std::to_string(factor));
      const Coordinates points = make_fixture(name, 20000, 3);
      const Triangulation delaunay = delaunay_of(points, {0, points.size() / 2});
      const Segments segments = edges_of_stretched(points, factor, 5, 3);
      const auto result = insert(points, {0, points.size() / 2}, delaunay, segments);
      const Constrained expected = cgal_constrained(points, delaunay, segments);
      EXPECT_EQ(sorted_triangles(result.triangles), sorted_triangles(triangles_of(expected)));
    }
  }
}

// Where crossings are integers, nothing is rounded: lines along the axes and the diagonals, at even places.
TEST(SplitCgal, CountsWhereNothingIsRounded) {
  using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
  using Exact = CGAL::Constrained_triangulation_plus_2<
      CGAL::Constrained_Delaunay_triangulation_2<ExactKernel, CGAL::Default, CGAL::Exact_intersections_tag>>;
  FixtureRandom random(1);
  for (int round = 0; round < 20; ++round) {
    Coordinates points;
    Segments segments;
    for (std::int32_t s = 0; s < 200; ++s) {
      const auto x = 2 * random.integer(0, 100), y = 2 * random.integer(0, 100),
                 steps = 2 * random.integer(1, 30);
      const auto kind = random.integer(0, 3);
      points.insert(points.end(), {double(x), double(y), double(x + (kind == 0 ? 0 : steps)),
                                   double(y + (kind == 1   ? 0
                                               : kind == 2 ? -steps
                                                           : steps))});
      segments.insert(segments.end(), {2 * s, 2 * s + 1});
    }
    Exact expected;
    const auto exact = [&points](std::int32_t i) {
      return ExactKernel::Point_2(points[2 * i], points[2 * i + 1]);
    };
    for (std::size_t s = 0; s < segments.size(); s += 2) {
      expected.insert_constraint(exact(segments[s]), exact(segments[s + 1]));
    }
    const constrained::Split split = constrained::split(points.data(), {0, points.size() / 2}, segments);
    const constrained::AllPoints all = constrained::join_added(points.data(), {0, points.size() / 2}, split);
    const Triangulation delaunay = delaunay_of(all.coordinates, all.offsets);
    const auto result = insert(all.coordinates, all.offsets, delaunay, split.pieces);
    EXPECT_FALSE(split.is_snapped);
    const std::set<std::int32_t> vertices(result.triangles.begin(), result.triangles.end());
    EXPECT_EQ(vertices.size(), expected.number_of_vertices());
    EXPECT_EQ(result.triangles.size() / 3, expected.number_of_faces());
    EXPECT_EQ(result.constraint_edges.size() / 2, expected.number_of_subconstraints());
  }
}

}  // namespace
}  // namespace flaunay::testing
