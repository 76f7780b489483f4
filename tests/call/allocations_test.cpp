// Calls whose allocations fail, one after the other: an error each time, nothing leaks, and afterwards the
// objects do what they did before.
#include "tests/support/allocations.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/dynamic.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "prove/delaunay_proof.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/updates/mirror.hpp"

namespace flaunay::testing {
namespace {

/// What a call returned, as one number.
class Fingerprint {
 public:
  template <typename T>
  Fingerprint& operator<<(const std::vector<T>& values) {
    const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t k = 0; k < values.size() * sizeof(T); ++k) value_ = (value_ ^ bytes[k]) * 0x100000001b3;
    return *this;
  }
  operator std::uint64_t() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

std::uint64_t of(const Triangulation& mesh) {
  return Fingerprint() << mesh.triangles << mesh.neighbors << mesh.hull << mesh.representatives
                       << mesh.triangle_offsets;
}

std::uint64_t of(const ConstrainedTriangulation& mesh) {
  return Fingerprint() << mesh.triangles << mesh.neighbors << mesh.added_points << mesh.constraint_edges
                       << mesh.piece_edges << mesh.regions << mesh.polygons;
}

using Call = std::function<std::uint64_t()>;

// Lets allocations of the call fail: each of the first ones, later ever fewer, unless
// FLAUNAY_EVERY_ALLOCATION is set.
void attack(const Call& call) {
  const bool every = std::getenv("FLAUNAY_EVERY_ALLOCATION") != nullptr;
  const std::uint64_t expected = call();
  ASSERT_EQ(call(), expected);
  const long live = live_allocations();
  std::size_t errors = 0;
  for (const Failing failing : {Failing::one, Failing::all}) {
    bool is_over = false;
    for (std::size_t first = 0; !is_over; first += every ? 1 : 1 + first / 24) {
      std::string problem;
      std::uint64_t found = expected;
      {
        const FailingAllocations failures(first, failing);
        try {
          found = call();
        } catch (const std::bad_alloc&) {
          ++errors;
        } catch (const std::exception& error) {
          problem = error.what();
        }
        is_over = !failures.reached();
      }
      ASSERT_EQ(problem, "") << "allocation " << first;
      ASSERT_EQ(found, expected) << "allocation " << first;
      if (first % 4 == 0) {
        ASSERT_EQ(call(), expected) << "after allocation " << first;
      }
    }
  }
  EXPECT_EQ(call(), expected);
  EXPECT_GT(errors, 1u);
  EXPECT_LE(live_allocations(), live) << "blocks of memory were not freed";
}

// Both an object that is made anew each time, and one that goes on after its calls failed.
template <typename Object>
void attack(const std::function<Object()>& make, const std::function<std::uint64_t(Object&)>& use) {
  attack([&] {
    Object object = make();
    return use(object);
  });
  Object object = make();
  attack([&] { return use(object); });
}

const std::function<Triangulator()> kHost = [] { return Triangulator("host"); };

class SmallAllocations : public ::testing::Test {
 private:
  ScopedEnvironment threads_{"FLAUNAY_THREADS", "3"};
};

TEST_F(SmallAllocations, OfTriangulations) {
  const Coordinates points = make_fixture("uniform", 3000, 5);
  attack<Triangulator>(kHost, [&](Triangulator& host) { return of(host.triangulate(points.data(), 3000)); });
  const std::vector<float> narrow(points.begin(), points.end());
  Triangulator free_to_choose;
  attack([&] { return of(free_to_choose.triangulate(narrow.data(), {0, 100, 100, 500})); });
}

TEST_F(SmallAllocations, OfModesOnTheHost) {
  const Coordinates points = make_fixture("grid", 400, 5);
  for (const research::Mode mode : {research::Mode::dwyer, research::Mode::recursive}) {
    research::Options options;
    options.mode = mode;
    options.threads = 3;
    attack([&] { return of(research::triangulate_on_host(points.data(), {0, 150, 400}, options)); });
  }
}

TEST_F(SmallAllocations, OfSegments) {
  const SegmentInput crossing = nasty_detail::diameters(60, 1), apart = nasty_detail::koch_rings(100, 1);
  for (const SegmentInput* input : {&crossing, &apart}) {
    Constraints constraints;
    constraints.segments = input->segments.data();
    constraints.segment_count = input->segments.size() / 2;
    ConstrainedOptions options;
    options.crossings = Crossings::split;
    options.labels = true;
    const std::vector<std::size_t> offsets = {0, input->points.size() / 2};
    attack<Triangulator>(kHost, [&](Triangulator& host) {
      return of(host.constrained(input->points.data(), offsets, constraints, options));
    });
  }
}

TEST_F(SmallAllocations, OfPolygons) {
  const Coordinates rings = {0, 0, 9, 0, 9, 9, 0, 9, 2, 2, 5, 2, 5, 5, 2, 5, 4, -1, 12, -1, 12, 7, 4, 7};
  Polygons polygons;
  polygons.coordinates = rings.data();
  polygons.ring_offsets = {0, 4, 8, 12};
  polygons.polygon_offsets = {0, 2, 3};
  PolygonOptions options;
  options.map = true;
  options.crossings = Crossings::split;
  attack<Triangulator>(kHost, [&](Triangulator& host) { return of(host.polygons(polygons, options)); });
}

// A batch that fails has changed nothing but rows, and the next one tells which ones are gone.
TEST_F(SmallAllocations, OfTriangulationsThatChange) {
  Triangulator host("host");
  // A point for the first number's place, one beside it, two on a constraint, and many.
  Coordinates points = {0, 0, 0, 0, 9, 0, 4, 7, 3, 0, 8, 8, 5, 5}, many = make_fixture("grid", 50, 5);
  for (double& x : many) x *= 9;
  const Coordinates grid = make_fixture("grid", 60, 6);
  for (const double x : grid) points.push_back(10 * x);
  const std::vector<std::int32_t> segments = {1, 2, 0, 3};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = 2;
  using Batch = std::function<Changes(DynamicTriangulation&)>;
  const std::vector<Batch> batches = {
      [](auto& mesh) {
        const Coordinates some = {1, 0, 2, 3, 1.5, 0, 8, 8};
        return mesh.insert(some.data(), 4);
      },
      [&](auto& mesh) { return mesh.insert(many.data(), 50); },
      [](auto& mesh) {
        const std::int32_t numbers[] = {1, 5, 30};
        return mesh.remove(numbers, 3);
      },
      [](auto& mesh) {
        const std::int32_t numbers[] = {5, 6, 31};
        const double places[] = {5, 5, 9, 0, 8, 1};
        return mesh.move(numbers, places, 3);
      },
  };
  const auto triangles_of = [](DynamicTriangulation& mesh) { return set_of(mesh.rows().triangles); };
  const auto state_of = [&](DynamicTriangulation& mesh) -> std::uint64_t {
    const LivingConstraints edges = mesh.constraints();
    std::vector<std::int32_t> corners;
    for (const Corners& row : triangles_of(mesh)) corners.insert(corners.end(), row.begin(), row.end());
    const Triangulation whole = mesh.triangulation();
    return Fingerprint() << corners << whole.representatives << whole.hull << edges.edges << edges.segments;
  };
  std::size_t errors = 0;
  for (const Batch& batch : batches) {
    for (const bool is_loaded : {false, true}) {
      const auto make = [&] {
        DynamicTriangulation mesh(host, points.data(), points.size() / 2, constraints);
        const double inside[] = {6.25, 3.5};
        if (is_loaded) mesh.insert(inside, 1);
        return mesh;
      };
      DynamicTriangulation untouched = make(), done = make();
      batch(done);
      const std::uint64_t before = state_of(untouched), after = state_of(done);
      bool is_over = false;
      for (std::size_t first = 0; !is_over; first += 1 + first / 8) {
        SCOPED_TRACE(first);
        DynamicTriangulation mesh = make();
        std::map<std::int32_t, Corners> rows = rows_of(mesh.rows());
        bool has_failed = false;
        {
          const FailingAllocations failures(first, Failing::one);
          try {
            batch(mesh);
          } catch (const std::bad_alloc&) {
            has_failed = true;
          }
          is_over = !failures.reached();
        }
        if (has_failed) {
          ++errors;
          if (first % 2 == 0) {
            ASSERT_EQ(state_of(mesh), before);
            ASSERT_EQ(mesh.rows().triangles.size(), 3 * mesh.row_count());
            ASSERT_EQ(mesh.triangle_count(), rows.size());
            rows = rows_of(mesh.rows());
          }
          const Changes changes = batch(mesh);
          for (const std::int32_t row : changes.removed) ASSERT_EQ(rows.erase(row), 1);
          for (std::size_t i = 0; i < changes.made.size(); ++i) {
            ASSERT_TRUE(rows.emplace(changes.made[i], rotated(&changes.made_corners[3 * i])).second);
          }
          ASSERT_EQ(rows_of(mesh.rows()), rows);
        }
        ASSERT_EQ(state_of(mesh), after);
      }
    }
  }
  EXPECT_GT(errors, 100u);
}

TEST_F(SmallAllocations, OfDiagramsAndQueries) {
  const std::size_t n = 500;
  const Coordinates points = make_fixture("uniform", n, 5), queries = make_fixture("uniform", 300, 6);
  const double corners[] = {0.1, 0.1, 0.8, 0.2, 0.4, 0.9};
  Triangulator host("host");
  const Triangulation mesh = host.triangulate(points.data(), n);
  attack([&] {
    const Voronoi dual = host.voronoi(points.data(), n, mesh);
    return Fingerprint() << dual.circumcentres << dual.cells << dual.cell_offsets;
  });
  attack([&] {
    const ClippedVoronoi cells = host.clipped_voronoi(points.data(), n, mesh, corners, 3);
    return Fingerprint() << cells.vertices << cells.offsets << cells.areas;
  });
  attack([&]() -> std::uint64_t { return Fingerprint() << host.relax(points.data(), n, corners, 3, 2); });
  attack<Locator>([&] { return Locator(host, points.data(), n, mesh); },
                  [&](Locator& locator) {
                    Fingerprint all;
                    all << locator.locate(queries.data(), 300) << locator.nearest(queries.data(), 300);
                    for (const Interpolation method : {Interpolation::clough_tocher, Interpolation::sibson}) {
                      InterpolationOptions options;
                      options.method = method;
                      options.fill = 0;
                      all << locator.interpolate(points.data(), queries.data(), 300, options);
                    }
                    return all;
                  });
}

TEST_F(SmallAllocations, OfChunks) {
  ChunkOptions options;
  options.devices = {"host", "host"};
  options.memory_bytes = std::uint64_t{1} << 30;
  // The larger chunks are finished by several threads.
  for (const std::size_t n : {4000, 24000}) {
    options.chunk_points = n / 2 - n / 11;
    const Coordinates points = make_fixture("uniform", n, 5);
    std::vector<std::int64_t> triangles(6 * n), neighbors(6 * n), hull(n), representatives(n);
    attack([&]() -> std::uint64_t {
      const ChunkStatistics done = triangulate_chunks(
          points.data(), n,
          MeshArrays<std::int64_t>{triangles.data(), neighbors.data(), hull.data(), representatives.data()},
          options);
      const std::vector<std::uint64_t> counts = {done.triangles, done.hull_vertices};
      triangles.resize(3 * done.triangles);
      const std::uint64_t found = Fingerprint() << counts << triangles << hull << representatives;
      triangles.resize(6 * n);
      return found;
    });
  }
}

TEST_F(SmallAllocations, OfTheExactCheck) {
  const Coordinates points = make_fixture("grid", 300, 5);
  const Triangulation mesh = Triangulator("host").triangulate(points.data(), 300);
  attack([&]() -> std::uint64_t { return verify(points.data(), 300, mesh.triangles, mesh.neighbors).ok; });
}

TEST_F(SmallAllocations, OfTheInterfaceForC) {
  const Coordinates points = make_fixture("uniform", 3000, 5);
  const auto check = [](flaunay_status status) {
    if (status == FLAUNAY_SUCCESS) return;
    if (status == FLAUNAY_ERROR_MEMORY && *flaunay_last_error() != '\0') throw std::bad_alloc();
    throw std::runtime_error(flaunay_last_error());
  };
  const std::int32_t segments[] = {0, 1};
  flaunay_constraints constraints{};
  constraints.segments = segments;
  constraints.segment_count = 1;
  constraints.crossings = FLAUNAY_CROSSINGS_SPLIT;
  attack([&]() -> std::uint64_t {
    flaunay_triangulator* triangulator = nullptr;
    flaunay_triangulation* mesh = nullptr;
    flaunay_triangulation* constrained = nullptr;
    std::uint64_t found = 0;
    const auto destroy = [&] {
      flaunay_triangulation_destroy(constrained);
      flaunay_triangulation_destroy(mesh);
      flaunay_triangulator_destroy(triangulator);
    };
    try {
      check(flaunay_triangulator_create("host", &triangulator));
      check(flaunay_triangulate(triangulator, points.data(), 3000, nullptr, 1, nullptr, &mesh));
      check(flaunay_triangulate_constrained(triangulator, points.data(), 3000, nullptr, 1, &constraints,
                                            nullptr, &constrained));
      found = flaunay_triangulation_mesh(mesh)->triangle_count +
              flaunay_triangulation_mesh(constrained)->triangle_count;
    } catch (...) {
      destroy();
      throw;
    }
    destroy();
    return found;
  });
}

}  // namespace
}  // namespace flaunay::testing
