// Each public call is one turn of its triangulator: calls of other threads never come in between.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "call/implementation.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/dynamic.hpp"
#include "flaunay/terrain.hpp"
#include "tests/spaces/spaces.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::spaces {
namespace {

// What a call needs is made before it.
class Turns : public ::testing::Test {
 protected:
  void expect_one(const std::string& name, const std::function<void()>& call) {
    const std::atomic<std::uint64_t>& turns = TriangulatorAccess::implementation(made_).turns;
    const std::uint64_t before = turns;
    call();
    EXPECT_EQ(before + 2, turns) << name;
  }

  static constexpr std::size_t kCount = 60;
  Triangulator& made_ = triangulator();
  const Numbers points_ = make_fixture("uniform", kCount, 3);
  const double* const at_ = points_.data();
};

TEST_F(Turns, TriangulationsTakeOne) {
  const std::vector<std::int32_t> segments = {0, 1};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = 1;
  ConstrainedOptions options;
  options.refinement.min_angle = 20;
  Polygons polygons;
  const Numbers square = {0, 0, 1, 0, 1, 1, 0, 1};
  polygons.coordinates = square.data();
  polygons.ring_offsets = {0, 4};
  polygons.polygon_offsets = {0, 1};
  const Numbers weights(kCount, 1);
  expect_one("triangulate", [&] { made_.triangulate(at_, kCount); });
  expect_one("sets", [&] { made_.triangulate(at_, {0, 20, 60}); });
  expect_one("constrained", [&] { made_.constrained(at_, kCount, constraints); });
  expect_one("refined", [&] { made_.constrained(at_, kCount, constraints, options); });
  expect_one("polygons", [&] { made_.polygons(polygons); });
  expect_one("weighted",
             [&] { made_.triangulate(at_, kCount, Space::plane().with_weights(weights.data())); });
  expect_one("weighted torus",
             [&] { made_.triangulate(at_, kCount, Space::torus({}).with_weights(weights.data())); });
  for (const Period& period : {Period{}, {1, HUGE_VAL}})
    expect_one("periodic", [&] { made_.triangulate(at_, {0, 20, 60}, Space::torus(period)); });
  // Few points need wider margins.
  expect_one("few periodic", [&] { made_.triangulate(at_, 3, Space::torus({})); });
  expect_one("sphere", [&] {
    made_.triangulate(at_, {0, 7, 60}, Space::sphere(SphereCoordinates::degrees));
  });
  expect_one("relax", [&] { made_.relax(at_, kCount, square.data(), 4, 3); });
  expect_one("relax on a torus", [&] { made_.relax(at_, kCount, Space::torus({}), 3); });
  DynamicTriangulation changing(made_, at_, kCount);
  const std::int32_t last = kCount - 1;
  expect_one("insert", [&] { changing.insert(square.data(), 4); });
  expect_one("remove", [&] { changing.remove(&last, 1); });
  expect_one("rows", [&] { changing.rows(); });
  expect_one("whole", [&] { changing.triangulation(); });
}

TEST_F(Turns, QueriesTakeOne) {
  Options with_neighbors;
  with_neighbors.neighbors = true;
  const Triangulation mesh = made_.triangulate(at_, kCount, with_neighbors);
  const std::vector<std::int32_t> segments = {0, 1};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = 1;
  const ConstrainedTriangulation constrained = made_.constrained(at_, kCount, constraints);
  const Triangulation torus = made_.triangulate(at_, kCount, Space::torus({}));
  const Triangulation sphere = made_.triangulate(at_, kCount, Space::sphere(SphereCoordinates::degrees));
  const Numbers box = {0, 0, 1, 0, 1, 1, 0, 1}, values(kCount, 1);
  InterpolationOptions smooth;
  smooth.method = Interpolation::sibson;
  NeighborOptions three;
  three.count = 3;
  expect_one("voronoi", [&] { made_.voronoi(at_, kCount, mesh); });
  expect_one("clipped", [&] { made_.clipped_voronoi(at_, kCount, mesh, box.data(), 4); });
  expect_one("cells of a torus", [&] { made_.clipped_voronoi(torus); });
  expect_one("cells of a sphere", [&] { made_.voronoi(sphere); });
  expect_one("a locator", [&] { Locator(made_, at_, kCount, mesh); });
  expect_one("a locator of a constrained mesh", [&] { Locator(made_, at_, kCount, constrained); });
  expect_one("a locator of a torus", [&] { Locator(made_, torus); });
  expect_one("a locator of a sphere", [&] { Locator(made_, sphere); });
  Locator locator(made_, at_, kCount, constrained);
  // The first one makes what answers it.
  expect_one("nearest", [&] { locator.nearest(at_, kCount); });
  expect_one("locate", [&] { locator.locate(at_, kCount); });
  expect_one("interpolate", [&] { locator.interpolate(values.data(), at_, kCount, smooth); });
  expect_one("weights", [&] { locator.natural_weights(at_, kCount, Interpolation::laplace); });
  expect_one("gradients", [&] { locator.gradients(values.data(), 1, {}); });
  Locator on_torus(made_, torus);
  expect_one("locate on a torus", [&] { on_torus.locate(at_, kCount); });
  expect_one("nearest on a torus", [&] { on_torus.nearest(at_, kCount); });
  expect_one("interpolate on a torus", [&] { on_torus.interpolate(values.data(), at_, kCount, smooth); });
  expect_one("weights on a torus", [&] { on_torus.natural_weights(at_, kCount); });
  Locator on_sphere(made_, sphere);
  expect_one("locate on a sphere", [&] { on_sphere.locate(at_, kCount); });
  expect_one("nearest on a sphere", [&] { on_sphere.nearest(at_, kCount); });
  expect_one("interpolate on a sphere", [&] { on_sphere.interpolate(values.data(), at_, kCount); });
  expect_one("weights on a sphere", [&] { on_sphere.natural_weights(at_, kCount); });
  expect_one("gradients on a sphere", [&] { on_sphere.gradients(values.data()); });
  smooth.method = Interpolation::clough_tocher;
  expect_one("smooth on a sphere", [&] { on_sphere.interpolate(values.data(), at_, kCount, smooth); });
  PointTree tree_on_sphere(made_, sphere);
  expect_one("several nearest on a sphere", [&] { tree_on_sphere.nearest(at_, kCount, three); });
  PointTree tree(made_, torus);
  expect_one("several nearest", [&] { tree.nearest(at_, kCount, three); });
}

}  // namespace
}  // namespace flaunay::testing::spaces
