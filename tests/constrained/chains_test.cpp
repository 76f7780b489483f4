// The triangulation of chains on a device beside PolygonTriangulator, on the cavities of real segments and on
// chains that are made to be hard.
//
// Suites named Small... have tiny inputs, for slow simulators: tests/oclgrind.sh.
#include "constrained/chains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "constrained/mesh.hpp"
#include "constrained/polygon.hpp"
#include "flaunay/research.hpp"
#include "geometry/magnitudes.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {
namespace {

using host::Runtime;
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

std::vector<std::int32_t> device_triangles(Runtime& runtime, const Case& input) {
  host::Arena::Scope scope(runtime.arena());
  std::vector<cl_double2> points;
  for (const Point p : input.points) points.push_back({{p.x, p.y}});
  std::vector<cl_int> offsets{0}, all;
  for (const Chain& chain : input.chains) {
    all.insert(all.end(), chain.begin(), chain.end());
    offsets.push_back(static_cast<cl_int>(all.size()));
  }
  DeviceChains chains;
  chains.count = input.chains.size();
  chains.vertices = all.size();
  chains.circle_bound = input.predicates.bounds.circle;
  chains.points = upload(runtime, points);
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
  return {"own", "small", "gpu:1", "gpu:32", "gpu:64", "gpu:256"};
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
