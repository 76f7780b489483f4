// Segments on a device and natively, with sizes of all kinds: the same bytes and the same errors.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "tests/support/device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/same.hpp"

namespace flaunay::testing {
namespace {

using Engines = SharedRuntimes<make_tuned_engine>;
[[maybe_unused]] ::testing::Environment* const kEngines = ::testing::AddGlobalTestEnvironment(new Engines);

/// Under the tuning that the environment names alone, if it names one.
std::vector<std::string> tunings() {
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return {"own"};
  std::vector<std::string> all = {"own", "small", "gpu"};
  for (const std::string& tuning : fixed_point_tunings()) all.push_back(tuning);
  return all;
}

/// Whether the runtime computes in fixed point, and a set has more bits than that takes.
bool is_too_wide(const host::Runtime& runtime, const Coordinates& points,
                 const std::vector<std::size_t>& offsets) {
  constexpr int kMostBits = 62;
  if (!runtime.capabilities().fixed_point) return false;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const auto magnitudes = geometry::inspect(points.data(), offsets[s], offsets[s + 1]);
    if (geometry::bits_of(magnitudes) > kMostBits) return true;
  }
  return false;
}

struct Outcome {
  ConstrainedTriangulation result;
  std::string error;
};

template <typename Constrain>
Outcome outcome_of(const Constrain& constrain) {
  Outcome outcome;
  try {
    outcome.result = constrain();
  } catch (const Error& error) {
    outcome.error = error.what();
    EXPECT_NE(outcome.error, "");
  }
  return outcome;
}

/// The definition, and the same with every tuning. Returns whether there was an error, which must be the
/// same, too.
bool expect_right(const Coordinates& points, const std::vector<std::size_t>& offsets,
                  const Segments& segments) {
  const Triangulation delaunay = delaunay_of(points, offsets);
  const Outcome expected = outcome_of([&] { return insert(points, offsets, delaunay, segments); });
  if (expected.error.empty()) expect_canonical(points, delaunay, expected.result);
  Options options;
  options.halfedges = true;
  Triangulation halfedges;
  halfedges.neighbors = expected.result.neighbors;
  geometry::write_halfedges(options, halfedges);
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    call::Engine& engine = Engines::get(tuning);
    ConstrainedTriangulation used;
    static_cast<Triangulation&>(used) = delaunay;
    const auto constrain = [&] { return insert_on(engine, points, offsets, segments, true, used); };
    if (is_too_wide(engine.runtime, points, offsets)) {
      EXPECT_FALSE(constrain());
      EXPECT_TRUE(same(used.triangles, delaunay.triangles) && same(used.neighbors, delaunay.neighbors));
      continue;
    }
    const Outcome found = outcome_of([&] {
      *constrain();
      return used;
    });
    EXPECT_EQ(found.error, expected.error);
    EXPECT_TRUE(same(found.result.triangles, expected.result.triangles));
    EXPECT_TRUE(same(found.result.neighbors, expected.result.neighbors));
    EXPECT_TRUE(same(found.result.constrained, expected.result.constrained));
    EXPECT_TRUE(same(found.result.constraint_edges, expected.result.constraint_edges));
    EXPECT_TRUE(same(found.result.piece_edges, expected.result.piece_edges));
    EXPECT_TRUE(same(found.result.halfedges, halfedges.halfedges));
  }
  return !expected.error.empty();
}

bool expect_right(const Coordinates& points, const Segments& segments) {
  return expect_right(points, {0, points.size() / 2}, segments);
}

TEST(SmallInsertion, RandomSegmentsInSmallBoxes) {
  FixtureRandom random(1);
  int errors = 0;
  for (int round = 0; round < 100; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(0, 16));
    const int side = static_cast<int>(random.integer(1, 7));
    const Coordinates points = random_integer_points(n, side, static_cast<std::uint64_t>(round));
    const auto count = static_cast<std::size_t>(random.integer(0, 6));
    errors += expect_right(points, random_segments(random, n, count));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(errors, 10);
  EXPECT_LT(errors, 80);
}

TEST(SmallInsertion, EdgesOfOtherTriangulations) {
  for (int round = 0; round < 8; ++round) {
    const Coordinates points = random_integer_points(40, 3 + 8 * round, static_cast<std::uint64_t>(round));
    expect_right(points, edges_of_stretched(points, std::ldexp(1.0, round - 4), 1 + round % 3, 1));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

// Cavities of cocircular points that are not coarse: floating point decides some, but not all.
TEST(SmallInsertion, CavitiesThatStop) {
  Coordinates points = random_integer_points(80, 12, 1);
  for (double& c : points) c += 0x1p40;
  const Segments segments = edges_of_stretched(points, 8, 1, 1);
  expect_right(points, segments);
  if (tests_native() || tunings().size() == 1) return;
  call::Engine& engine = Engines::get("small");
  const std::vector<std::size_t> offsets = {0, points.size() / 2};
  ConstrainedTriangulation mesh;
  static_cast<Triangulation&>(mesh) = delaunay_of(points, offsets);
  *insert_on(engine, points, offsets, segments, false, mesh, true);
  EXPECT_EQ(engine.runtime.kernel_times().count("fill_filtered"), 1u);
}

// One segment with a long walk, and what is left of those beside it.
TEST(SmallInsertion, LongWalks) {
  FixtureRandom random(2);
  for (int round = 0; round < 4; ++round) {
    Coordinates points = {-1, 0, 101, 0};
    for (int i = 0; i < 100; ++i) {
      const double y = std::ldexp(double(random.integer(1, 64)), static_cast<int>(random.integer(-8, 0)));
      points.insert(points.end(), {static_cast<double>(random.integer(0, 100)), i % 2 ? y : -y});
    }
    Segments segments = edges_of_stretched(points, std::ldexp(1.0, 4 * round - 8), 2, 1);
    segments.insert(segments.begin(), {0, 1});
    expect_right(points, segments);
    expect_right(points, {1, 0});
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

TEST(SmallInsertion, SegmentsThroughPoints) {
  FixtureRandom random(3);
  for (int round = 0; round < 12; ++round) {
    const int columns = static_cast<int>(random.integer(2, 9)), rows = static_cast<int>(random.integer(1, 7));
    Segments segments;
    for (int k = 0; k < 8; ++k) {
      const auto y = random.integer(0, rows - 1);
      segments.push_back(static_cast<std::int32_t>(y * columns + random.integer(0, columns - 1)));
      const auto place = random.integer(0, 1)
                             ? y * columns + random.integer(0, columns - 1)
                             : random.integer(0, rows - 1) * columns + segments.back() % columns;
      segments.push_back(static_cast<std::int32_t>(place));
    }
    expect_right(grid_points(columns, rows), segments);
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

// Sets with and without triangles, and of very different magnitudes.
TEST(SmallInsertion, SeveralSets) {
  // Without segments in sets on lines, no segment has several edges.
  for (const bool with_lines : {true, false}) {
    const SetsWithSegments all = several_sets(20, with_lines);
    EXPECT_FALSE(expect_right(all.points, all.offsets, all.segments));
  }
}

TEST(SmallInsertion, AllMagnitudes) {
  FixtureRandom random(7);
  for (const double factor : {0x1p-1000, 0x1p-600, 0x1p600, 0x1p1000}) {
    const Coordinates points = scaled(random_integer_points(30, 9, 1), factor);
    expect_right(points, edges_of_stretched(points, 4, 2, 1));
    expect_right(points, random_segments(random, 30, 3));
  }
}

/// Random integers below 2^bits, of as many bits as a double has, and some small ones. The first has the most
/// bits, and another one is odd.
Coordinates wide_points(FixtureRandom& random, std::size_t n, int bits) {
  Coordinates points = {std::ldexp(1.0, bits - 1), 0, 0, 1};
  while (points.size() < 2 * n) {
    const int up = random.integer(0, 1) ? 0 : bits - 53;
    points.push_back(std::ldexp(static_cast<double>(random.integer(0, (std::int64_t{1} << 53) - 1)), up));
  }
  return points;
}

// As many bits as fixed point takes, and one more.
TEST(SmallInsertion, SpansOfFixedPoint) {
  FixtureRandom random(8);
  for (const int bits : {54, 61, 62, 63}) {
    for (const double factor : {0x1p-500, 1.0, 0x1p500}) {
      SCOPED_TRACE(std::to_string(bits) + " bits, times " + std::to_string(factor));
      const Coordinates points = scaled(wide_points(random, 40, bits), factor);
      ASSERT_EQ(geometry::bits_of(geometry::inspect(points.data(), 0, 40)), bits);
      expect_right(points, edges_of_stretched(points, 0x1p-4, 2, 1));
      expect_right(points, random_segments(random, 40, 3));
    }
  }
}

TEST(SmallInsertion, Errors) {
  const Coordinates points = {0, 0, 4, 4, 0, 4, 4, 0, 10, 10};
  EXPECT_TRUE(expect_right(points, {4, 4, 3, 2, 0, 1}));
  EXPECT_TRUE(expect_right(points, {0, 1, 2, 5}));
  EXPECT_TRUE(expect_right(points, {0, 2, -1, 3}));
  const Coordinates two = {0, 0, 1, 0, 0, 1, 5, 5, 6, 5, 5, 6};
  EXPECT_TRUE(expect_right(two, {0, 3, 6}, {0, 1, 2, 3}));
  EXPECT_FALSE(expect_right(two, {0, 3, 6}, {0, 2, 3, 5}));
  EXPECT_FALSE(expect_right({}, {}));
}

TEST(Insertion, RandomSegmentsInSmallBoxes) {
  FixtureRandom random(11);
  // Devices run the same text with all tunings, and take ten times as long.
  const int rounds = tests_native() ? 3000 : 600;
  for (int round = 0; round < rounds; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(0, 24));
    const int side = static_cast<int>(random.integer(1, 9));
    const Coordinates points = random_integer_points(n, side, static_cast<std::uint64_t>(round));
    expect_right(points, random_segments(random, n, static_cast<std::size_t>(random.integer(0, 8))));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

TEST(Insertion, EdgesOfOtherTriangulations) {
  std::vector<double> factors{0x1p-6, 0x1p6};
  if (tests_native()) factors.push_back(0.5);
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {100, 1000}) {
      for (const double factor : factors) {
        SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n) + ", factor " + std::to_string(factor));
        const Coordinates points = fixture.make(n, 2);
        EXPECT_FALSE(expect_right(points, edges_of_stretched(points, factor, 1, n)));
        EXPECT_FALSE(expect_right(points, edges_of_stretched(points, factor, 5, n)));
        ASSERT_FALSE(HasFailure());
      }
    }
  }
}

TEST(Insertion, Files) {
  for (const std::string& file : data_files()) {
    SCOPED_TRACE(file);
    const Coordinates points = io::read_points(test_data() + "/" + file).coordinates;
    EXPECT_FALSE(expect_right(points, edges_of_stretched(points, 16, 2, 1)));
  }
}

// One segment that crosses 100,000 edges.
TEST(Insertion, OneSegmentThroughEverything) {
  FixtureRandom random(8);
  const int n = 100000;
  Coordinates points = {-1, 0, n, 0};
  for (int i = 0; i < n; ++i) {
    const double height = 1 + random.unit();
    points.insert(points.end(), {i + 0.25 * random.unit(), i % 2 ? height : -height});
  }
  EXPECT_FALSE(expect_right(points, {0, 1}));
}

TEST(Insertion, StarsAndOverlaps) {
  const std::int32_t n = 30000;
  Coordinates star = {0, 0}, line;
  Segments rays, spans, few;
  for (std::int32_t i = 1; i <= n; ++i) {
    const double angle = 2 * M_PI * i / n, radius = i % 2 ? 1 : 2;
    star.insert(star.end(), {radius * std::cos(angle), radius * std::sin(angle)});
    rays.insert(rays.end(), {0, i});
    line.insert(line.end(), {double(i), double(i)});
    spans.insert(spans.end(), {(i - 1) / 2, n - 1 - (i - 1) / 3});
    few.insert(few.end(), {i - 1, std::min(n - 1, i + 9)});
  }
  EXPECT_FALSE(expect_right(star, rays));
  for (const bool with_others : {false, true}) {
    if (with_others) line.insert(line.end(), {0, double(n), double(n), 0});
    EXPECT_FALSE(expect_right(line, spans));
    EXPECT_FALSE(expect_right(line, few));
  }
}

// Segments to one point from everywhere around it, of which most cross many triangles.
TEST(Insertion, StarAcrossTriangles) {
  FixtureRandom random(9);
  const std::int32_t n = 30000;
  Coordinates points = {0, 0};
  Segments rays;
  for (std::int32_t i = 1; i <= n; ++i) {
    const double angle = 2 * M_PI * random.unit(), radius = 1 + random.unit();
    points.insert(points.end(), {radius * std::cos(angle), radius * std::sin(angle)});
    rays.insert(rays.end(), {0, i});
  }
  EXPECT_FALSE(expect_right(points, rays));
}

}  // namespace
}  // namespace flaunay::testing
