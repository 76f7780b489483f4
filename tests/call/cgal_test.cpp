// Beside CGAL: equal counts on every fixture, and equal triangles where the triangulation is unique.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/flaunay.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;

Delaunay cgal_delaunay(const Coordinates& points) {
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> input;
  for (std::size_t i = 0; i < points.size() / 2; ++i) {
    input.emplace_back(Kernel::Point_2(points[2 * i], points[2 * i + 1]), static_cast<std::int32_t>(i));
  }
  return Delaunay(input.begin(), input.end());
}

/// Points on hull edges included; of collinear points, all.
std::size_t hull_size(const Delaunay& delaunay) {
  if (delaunay.dimension() < 2) return delaunay.number_of_vertices();
  std::size_t size = 0;
  auto vertex = delaunay.incident_vertices(delaunay.infinite_vertex());
  const auto begin = vertex;
  do ++size;
  while (++vertex != begin);
  return size;
}

class Cgal : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { triangulator_ = std::make_unique<Triangulator>(); }
  static void TearDownTestSuite() { triangulator_.reset(); }

  static Triangulation triangulate(const Coordinates& points) {
    return triangulator_->triangulate(points.data(), points.size() / 2);
  }

  static void compare_counts(const Coordinates& points) {
    const Delaunay expected = cgal_delaunay(points);
    const Triangulation result = triangulate(points);
    EXPECT_EQ(result.triangles.size() / 3, expected.dimension() < 2 ? 0 : expected.number_of_faces());
    EXPECT_EQ(result.hull.size(), hull_size(expected));
    EXPECT_EQ(result.statistics.points - result.statistics.duplicates, expected.number_of_vertices());
  }

  static std::unique_ptr<Triangulator> triangulator_;
};
std::unique_ptr<Triangulator> Cgal::triangulator_;

TEST_F(Cgal, CountsOnFixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {0, 1, 2, 3, 10, 100, 1000, 10000}) {
      SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n));
      const Coordinates points = fixture.make(n, 2);
      compare_counts(points);
      compare_counts(perturbed(points, 2));
    }
  }
}

TEST_F(Cgal, CountsOnFiles) {
  for (const std::string& file : data_files()) {
    const Coordinates points = io::read_points(test_data() + "/" + file).coordinates;
    for (const double factor : {1.0, 1e-9, 1e9}) {
      SCOPED_TRACE(file + " times " + std::to_string(factor));
      compare_counts(scaled(points, factor));
    }
  }
}

/// Random points in general position have one Delaunay triangulation.
TEST_F(Cgal, SameTriangles) {
  for (const char* name : {"uniform", "normal", "kuzmin", "line", "clusters"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 50000, 3);
    const Delaunay expected = cgal_delaunay(points);
    std::vector<std::int32_t> triangles;
    for (const auto& face : expected.finite_face_handles()) {
      for (int corner = 0; corner < 3; ++corner) triangles.push_back(face->vertex(corner)->info());
    }
    EXPECT_EQ(sorted_triangles(triangulate(points).triangles), sorted_triangles(triangles));
  }
}

}  // namespace
}  // namespace flaunay::testing
