// The triangulation of chains on a device beside PolygonTriangulator, on the cavities of real segments and on
// chains that are made to be hard.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "constrained/insertion/chains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/magnitudes.hpp"
#include "tests/constrained/sequential/mesh.hpp"
#include "tests/constrained/sequential/polygon.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/scaled_points.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

using geometry::Point;
using geometry::Predicates;
using host::Runtime;
using sequential::Cavity;
using sequential::ChainTriangle;
using sequential::ConstrainedMesh;
using sequential::Departure;
using sequential::PolygonTriangulator;
using testing::Coordinates;
using testing::download;
using testing::FixtureRandom;
using testing::guarded;
using testing::make_fixture;
using testing::upload;

using Runtimes = testing::SharedRuntimes<testing::make_tuned_runtime>;
[[maybe_unused]] ::testing::Environment* const kRuntimes = ::testing::AddGlobalTestEnvironment(new Runtimes);

using Chain = std::vector<std::int32_t>;

/// Scaled points and chains of them.
struct Case {
  std::vector<Point> points;
  Predicates predicates;
  std::vector<Chain> chains;

  explicit Case(const Coordinates& coordinates) {
    const geometry::Magnitudes magnitudes = geometry::inspect(coordinates.data(), 0, coordinates.size() / 2);
    const geometry::Scaling scaling = geometry::scaling_for(magnitudes);
    predicates.bounds = scaling.bounds;
    for (std::size_t i = 0; i < coordinates.size(); i += 2) {
      points.push_back({std::ldexp(coordinates[i], scaling.shift) + 0.0,
                        std::ldexp(coordinates[i + 1], scaling.shift) + 0.0});
    }
  }
};

std::vector<std::int32_t> expected_triangles(const Case& input) {
  PolygonTriangulator triangulator(input.predicates, input.points.data());
  std::vector<std::int32_t> all;
  for (const Chain& chain : input.chains) {
    for (const ChainTriangle& t : triangulator.triangulate(chain)) all.insert(all.end(), t.begin(), t.end());
  }
  return all;
}

Coordinates coordinates_of(const Case& input) {
  Coordinates coordinates;
  for (const Point p : input.points) coordinates.insert(coordinates.end(), {p.x, p.y});
  return coordinates;
}

/// Whether the runtime's kernels can compute with the points.
bool takes(Runtime& runtime, const Case& input) {
  const Coordinates coordinates = coordinates_of(input);
  return !runtime.capabilities().fixed_point ||
         geometry::fits_fixed_point(geometry::inspect(coordinates.data(), 0, input.points.size()));
}

std::vector<std::int32_t> device_triangles(Runtime& runtime, const Case& input) {
  host::Arena::Scope scope(runtime.arena());
  const testing::ScaledPoints points = testing::upload_points(runtime, coordinates_of(input));
  std::vector<cl_int> offsets{0}, all;
  for (const Chain& chain : input.chains) {
    all.insert(all.end(), chain.begin(), chain.end());
    offsets.push_back(static_cast<cl_int>(all.size()));
  }
  DeviceChains chains;
  chains.count = input.chains.size();
  chains.vertices = all.size();
  chains.circle_bound = points.bounds.circle;
  chains.points = points.coordinates.as<cl_double2>();
  chains.offsets = upload(runtime, offsets);
  chains.chain = upload(runtime, all);
  const std::size_t size = 3 * (chains.vertices - 2 * chains.count);
  const auto triangles = guarded<cl_int>(runtime, size);
  triangulate_chains(runtime, chains, triangles);
  return download(runtime, triangles, size);
}

void expect_right(const Case& input, const std::vector<std::string>& tunings) {
  const std::vector<std::int32_t> expected = expected_triangles(input);
  for (const std::string& tuning : tunings) {
    if (!takes(Runtimes::get(tuning), input)) continue;
    const std::vector<std::int32_t> found = device_triangles(Runtimes::get(tuning), input);
    ASSERT_EQ(found.size(), expected.size());
    const auto differs = std::mismatch(found.begin(), found.end(), expected.begin()).first - found.begin();
    ASSERT_EQ(differs, static_cast<std::ptrdiff_t>(expected.size()))
        << "of " << input.chains.size() << " chains";
  }
}

/// Under the tuning that the environment names alone, if it names one.
std::vector<std::string> tunings() {
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return {"own"};
  std::vector<std::string> all = {"own", "small", "gpu:1", "gpu:32", "gpu:64", "gpu:256"};
  for (const std::string& tuning : testing::fixed_point_tunings()) all.push_back(tuning);
  return all;
}

/// Both sides of the cavities of random segments, of which every `kept`-th becomes a constraint, so that
/// later chains have sides that are constraints, and vertices several times. Others that cross a constraint
/// are left out.
Case walks(const Coordinates& coordinates, std::size_t segments, std::size_t kept, std::uint64_t seed) {
  Case input(coordinates);
  const std::size_t n = input.points.size();
  research::Options options;
  options.mode = research::Mode::dwyer;
  options.neighbors = true;
  const Triangulation delaunay = research::triangulate_on_host(coordinates.data(), {0, n}, options);
  if (delaunay.triangles.empty()) return input;
  ConstrainedMesh mesh(input.predicates, input.points.data(), n, delaunay);
  FixtureRandom random(seed);
  for (std::size_t s = 0; s < segments; ++s) {
    const auto any = [&] {
      return delaunay.representatives[random.integer(0, static_cast<std::int64_t>(n) - 1)];
    };
    std::int32_t from = any();
    const std::int32_t to = any();
    while (from != to) {
      const Departure departure = mesh.depart_from(from, to);
      if (departure.vertex >= 0) {
        from = departure.vertex;
        continue;
      }
      Cavity cavity;
      std::vector<std::int32_t> crossed;
      from = mesh.follow(from, to, departure.halfedge, cavity, crossed);
      if (!crossed.empty()) break;
      input.chains.push_back(cavity.left.vertices);
      input.chains.emplace_back(cavity.right.vertices.rbegin(), cavity.right.vertices.rend());
      if (s % kept == 0) mesh.retriangulate(cavity, static_cast<std::int32_t>(s));
    }
  }
  return input;
}

/// The chain of all points.
Chain in_order(std::size_t vertices) {
  Chain chain(vertices);
  std::iota(chain.begin(), chain.end(), 0);
  return chain;
}

/// Points at random heights above a long base, by x: visible from it along verticals.
/// Of 30 binary places, so that any chain of them fits into fixed point.
double short_unit(FixtureRandom& random) {
  return std::ldexp(std::floor(std::ldexp(random.unit(), 30)), -30);
}

Coordinates random_heights(std::size_t vertices, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points{0, 0};
  const auto width = static_cast<double>(vertices);
  for (std::size_t k = 1; k + 1 < vertices; ++k) {
    points.push_back(static_cast<double>(k) + 0.5 * short_unit(random));
    points.push_back(1 + 10 * short_unit(random));
  }
  points.insert(points.end(), {width, 0});
  return points;
}

/// On a parabola that opens downwards, so that the chain is convex.
Coordinates convex_arc(std::size_t vertices) {
  Coordinates points;
  const auto width = static_cast<double>(vertices - 1);
  for (std::size_t k = 0; k < vertices; ++k) {
    const auto x = static_cast<double>(k);
    points.insert(points.end(), {x, x * (width - x)});
  }
  return points;
}

enum class Hub { base, end, arc };

/// An arc whose vertices all have an edge to one of them, the hub: one near the middle of the base, at its
/// end, or on the arc, a little nearer to the centre than the others.
Coordinates fan(std::size_t vertices, Hub hub, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points;
  const auto last = static_cast<double>(vertices - 1);
  for (std::size_t k = 0; k < vertices; ++k) {
    const double angle = M_PI * (hub == Hub::end ? 0.5 : 1) * (1 - static_cast<double>(k) / last);
    const double radius =
        1 + 1e-9 * random.unit() / last - (hub == Hub::arc && k == vertices / 3 ? 1e-3 / last : 0);
    points.insert(points.end(), {radius * std::cos(angle), radius * std::sin(angle)});
  }
  points[1] = points[points.size() - 1] = 0;
  if (hub == Hub::end) points[0] = 0;
  if (hub == Hub::base) {
    points[vertices / 2 * 2] = 0;
    points[vertices / 2 * 2 + 1] = 0.5 / last;
  }
  return points;
}

/// Integers exactly on the upper half of a circle, or on several, by x.
Coordinates cocircular(std::size_t vertices, std::uint64_t seed) {
  const Coordinates all = io::generate("integer-circle", 2 * vertices, seed).coordinates;
  std::vector<std::pair<double, double>> upper;
  const double width = *std::max_element(all.begin(), all.end());
  for (std::size_t i = 0; i < all.size(); i += 2) {
    if (all[i + 1] > 0 && std::fabs(all[i]) < width) upper.emplace_back(all[i], all[i + 1]);
  }
  std::sort(upper.begin(), upper.end());
  upper.erase(std::unique(upper.begin(), upper.end()), upper.end());
  Coordinates points{-width, 0};
  for (const auto& [x, y] : upper) points.insert(points.end(), {x, y});
  points.insert(points.end(), {width, 0});
  return points;
}

Case one_chain(const Coordinates& points) {
  Case input(points);
  input.chains.push_back(in_order(points.size() / 2));
  return input;
}

std::vector<std::pair<std::string, Coordinates>> hard_chains(std::size_t vertices) {
  return {{"random heights", random_heights(vertices, 3)},    {"convex arc", convex_arc(vertices)},
          {"fan from the base", fan(vertices, Hub::base, 5)}, {"fan from an end", fan(vertices, Hub::end, 6)},
          {"fan from the arc", fan(vertices, Hub::arc, 7)},   {"cocircular", cocircular(vertices, 8)}};
}

TEST(SmallChains, NoneAndTiny) {
  Case input(Coordinates{0, 0, 4, 0, 1, 1, 3, 1, 2, 3});
  expect_right(input, {"own"});
  input.chains = {{0, 1}};
  expect_right(input, {"own"});
  input.chains = {{0, 2, 1}, {0, 1}, {0, 1}, {0, 2, 4, 3, 1}, {0, 3, 1}};
  expect_right(input, {"own"});
}

TEST(SmallChains, HardOnes) {
  for (const auto& [name, points] : hard_chains(40)) {
    SCOPED_TRACE(name);
    expect_right(one_chain(points), {"own"});
  }
}

TEST(Chains, HardOnes) {
  for (const std::size_t vertices : {7, 26, 130, 1500}) {
    for (const auto& [name, points] : hard_chains(vertices)) {
      SCOPED_TRACE(name + ", " + std::to_string(vertices));
      expect_right(one_chain(points), tunings());
    }
  }
}

// Chains of all sizes beside each other, so that those for one work-item and those for many alternate.
TEST(Chains, ManyOfMixedSizes) {
  FixtureRandom random(9);
  Case input(random_heights(40000, 10));
  for (std::size_t first = 0; first < 39000;) {
    const auto most = std::int64_t{1} << random.integer(1, 10);
    const auto size = static_cast<std::size_t>(random.integer(2, most));
    input.chains.push_back(in_order(size));
    for (std::int32_t& v : input.chains.back()) v += static_cast<std::int32_t>(first);
    input.points[first].y = input.points[first + size - 1].y = 0;
    first += size;
  }
  expect_right(input, tunings());
}

// What follows the last chain is not looked at, and chains without vertices are only counted.
TEST(SmallChains, RoomForMore) {
  Runtime& runtime = Runtimes::get("own");
  host::Arena::Scope scope(runtime.arena());
  DeviceChains chains;
  chains.count = 4;
  chains.vertices = 9;
  chains.points = upload(runtime, std::vector<cl_double2>{{{0, 0}}, {{4, 0}}, {{2, 1}}});
  chains.offsets = upload(runtime, std::vector<cl_int>{0, 3, 6, 6, 6});
  chains.chain = upload(runtime, std::vector<cl_int>{0, 2, 1, 0, 2, 1, -1, -1, -1});
  const auto triangles = guarded<cl_int>(runtime, 6);
  triangulate_chains(runtime, chains, triangles);
  EXPECT_EQ(download(runtime, triangles, 6), (std::vector<cl_int>{0, 1, 2, 0, 1, 2}));
}

// A vertex with all the others for neighbours is not inserted where that would take a walk along all of them.
TEST(Chains, HubsAreInsertedEarly) {
  if (testing::tests_native()) GTEST_SKIP() << "a work-item triangulates a chain alone";
  Runtime& runtime = Runtimes::get("gpu,chain_walk_most=200");
  runtime.record_launches({kernel::COUNTERS_LENGTH, kernel::COUNTER_STEPS, kernel::STEP_COUNTERS});
  runtime.reset_accounts();
  expect_right(one_chain(fan(3000, Hub::arc, 11)), {"gpu,chain_walk_most=200"});
  std::size_t passes = 0;
  for (const host::Launch& launch : runtime.recorded_launches()) {
    EXPECT_LE(launch.counted.empty() ? 0 : launch.counted[0], 202u) << launch.kernel;
    if (launch.kernel == "start_lists") ++passes;
  }
  runtime.stop_recording();
  EXPECT_EQ(passes, 2u);
}

TEST(SmallChains, CavitiesOfSegments) {
  for (const char* const name : {"uniform", "grid", "integer-circle", "one-ulp", "nearly-cocircular"}) {
    SCOPED_TRACE(name);
    expect_right(walks(make_fixture(name, 40, 1), 20, 3, 2), {"own"});
  }
}

TEST(Chains, CavitiesOfSegmentsInAllFixtures) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    expect_right(walks(fixture.make(3000, 5), 300, 4, 6), tunings());
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace flaunay::constrained
