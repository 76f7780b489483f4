// Domains: the kernels, natively and on a device, against their definition and against their twin.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <numeric>
#include <string>
#include <vector>

#include "tests/constrained/domains.hpp"
#include "tests/constrained/sequential/domains.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using call::DomainRequest;
using Engines = SharedRuntimes<make_tuned_engine>;
[[maybe_unused]] ::testing::Environment* const kEngines = ::testing::AddGlobalTestEnvironment(new Engines);

constexpr FillRule kRules[] = {FillRule::nesting, FillRule::even_odd, FillRule::winding};
constexpr Outside kOutsides[] = {Outside::keep, Outside::hull, Outside::holes};

// The tuning that the environment names, or the device's and those of GPUs with groups of several sizes.
std::vector<std::string> tunings() {
  std::vector<std::string> names = {"own"};
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return names;
  names.emplace_back("small");
  for (const std::size_t group : kGroupsToTest) names.push_back("gpu:" + std::to_string(group));
  for (const std::string& tuning : fixed_point_tunings()) names.push_back(tuning);
  return names;
}

struct Case {
  Coordinates points;
  std::vector<std::size_t> offsets;
  Segments segments;
  std::vector<double> holes{};
  std::vector<std::size_t> hole_offsets{};

  Constraints constraints() const {
    Constraints result;
    result.segments = segments.data();
    result.segment_count = segments.size() / 2;
    result.holes = holes.data();
    result.hole_count = holes.size() / 2;
    result.hole_offsets = hole_offsets;
    return result;
  }
  ConstrainedTriangulation triangulate() const { return constrained_of(points, offsets, segments); }
};

ConstrainedTriangulation by_twin(const Case& input, ConstrainedTriangulation mesh,
                                 const DomainRequest& request) {
  sequential::apply_domains(input.points.data(), input.constraints(), request, mesh);
  return mesh;
}

// By kernels; holes are found natively where there are no doubles.
void apply_with(const std::string& tuning, const Case& input, const DomainRequest& request,
                ConstrainedTriangulation& mesh) {
  static call::Engine native(tuning_in_environment());
  call::Engine& engine = Engines::get(tuning);
  call::apply_domains_on(engine, engine.has_doubles() ? engine : native, input.points.data(), input.offsets,
                         input.constraints(), request, mesh);
}

ConstrainedTriangulation apply(const Case& input, ConstrainedTriangulation mesh,
                               const DomainRequest& request) {
  apply_with("own", input, request, mesh);
  return mesh;
}

void expect_same(const ConstrainedTriangulation& found, const ConstrainedTriangulation& expected) {
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.neighbors, expected.neighbors);
  EXPECT_EQ(found.constrained, expected.constrained);
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  EXPECT_EQ(found.depths, expected.depths);
  EXPECT_EQ(found.regions, expected.regions);
}

void expect_as_twin(const Case& input, const DomainRequest& request) {
  const ConstrainedTriangulation mesh = input.triangulate();
  const ConstrainedTriangulation expected = by_twin(input, mesh, request);
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE(tuning);
    ConstrainedTriangulation found = mesh;
    apply_with(tuning, input, request, found);
    expect_same(found, expected);
  }
}

// Numbers of regions by their first triangles, by going from number to number until nothing changes.
std::vector<std::int32_t> expected_regions(const ConstrainedTriangulation& mesh) {
  std::vector<std::int32_t> first(mesh.triangles.size() / 3), regions(first.size());
  std::iota(first.begin(), first.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t c = 0; c < mesh.neighbors.size(); ++c) {
      if (mesh.neighbors[c] < 0 || mesh.constrained[c] != 0) continue;
      if (first[mesh.neighbors[c]] < first[c / 3]) {
        first[c / 3] = first[mesh.neighbors[c]];
        changed = true;
      }
    }
  }
  std::int32_t count = 0;
  for (std::size_t t = 0; t < first.size(); ++t) {
    regions[t] = first[t] == static_cast<std::int32_t>(t) ? count++ : regions[first[t]];
  }
  return regions;
}

// The least numbers of constraints on the way from outside, improved until nothing changes.
std::vector<std::int32_t> expected_nesting(const ConstrainedTriangulation& mesh) {
  std::vector<std::int32_t> depths(mesh.triangles.size() / 3,
                                   static_cast<std::int32_t>(mesh.triangles.size()));
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t c = 0; c < mesh.neighbors.size(); ++c) {
      const std::int32_t before = mesh.neighbors[c] < 0 ? 0 : depths[mesh.neighbors[c]];
      const std::int32_t depth = before + (mesh.constrained[c] != 0 ? 1 : 0);
      if (depth >= depths[c / 3]) continue;
      depths[c / 3] = depth;
      changed = true;
    }
  }
  return depths;
}

std::vector<std::int32_t> expected_depths(const Case& input, const ConstrainedTriangulation& mesh,
                                          FillRule rule) {
  if (rule == FillRule::nesting) return expected_nesting(mesh);
  std::vector<std::int32_t> depths;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Around found = around(input.points, input.segments, 0, input.segments.size() / 2,
                                centroid(input.points, &mesh.triangles[t]));
    depths.push_back(rule == FillRule::winding ? found.winding : found.crossings % 2);
  }
  return depths;
}

bool is_expected(std::int32_t depth, FillRule rule, Outside outside) {
  if (outside == Outside::keep) return true;
  if (outside == Outside::holes && rule == FillRule::nesting) return depth % 2 == 1;
  return depth != 0;
}

// All of a result by definition.
void expect_right(const Case& input) {
  const ConstrainedTriangulation mesh = input.triangulate();
  const std::vector<std::int32_t> regions = expected_regions(mesh);
  for (const FillRule rule : kRules) {
    const std::vector<std::int32_t> depths = expected_depths(input, mesh, rule);
    for (const Outside outside : kOutsides) {
      SCOPED_TRACE(std::to_string(static_cast<int>(rule)) + std::to_string(static_cast<int>(outside)));
      const ConstrainedTriangulation found = apply(input, mesh, {{rule, outside, false}, true});
      std::vector<std::int32_t> triangles, left_depths, numbers, left_regions;
      std::vector<std::int32_t> number_of(mesh.triangles.size() / 3 + 1, -1);
      std::int32_t count = 0;
      std::vector<std::size_t> offsets = {0};
      for (std::size_t t = 0, s = 1; t < depths.size(); ++t) {
        for (; mesh.triangle_offsets[s] == t; ++s) offsets.push_back(left_depths.size());
        if (!is_expected(depths[t], rule, outside)) continue;
        triangles.insert(triangles.end(), &mesh.triangles[3 * t], &mesh.triangles[3 * t] + 3);
        left_depths.push_back(depths[t]);
        std::int32_t& number = number_of[regions[t]];
        if (number < 0) number = count++;
        left_regions.push_back(number);
      }
      while (offsets.size() < mesh.triangle_offsets.size()) offsets.push_back(left_depths.size());
      EXPECT_EQ(found.triangles, triangles);
      EXPECT_EQ(found.neighbors, reference_neighbors(triangles));
      EXPECT_EQ(found.depths, left_depths);
      EXPECT_EQ(found.regions, left_regions);
      EXPECT_EQ(found.triangle_offsets, offsets);
    }
  }
}

Case random_case(FixtureRandom& random, std::uint64_t round) {
  Case input;
  const auto n = static_cast<std::size_t>(random.integer(0, 14));
  input.points = random_integer_points(n, static_cast<int>(random.integer(1, 6)), round);
  input.offsets = {0, n};
  const Segments base = edges_of_stretched(input.points, 0.25, 3, round);
  input.segments = random_curves(constrained_of(input.points, input.offsets, base), random,
                                 static_cast<int>(random.integer(1, 4)));
  return input;
}

// Several sets, of which some are empty or on a line.
Case random_sets(FixtureRandom& random, std::uint64_t round, int sets) {
  Case input;
  input.offsets = {0};
  for (int s = 0; s < sets; ++s) {
    const Case set = random_case(random, 100 * round + static_cast<std::uint64_t>(s));
    const auto first = static_cast<std::int32_t>(input.offsets.back());
    input.points.insert(input.points.end(), set.points.begin(), set.points.end());
    input.offsets.push_back(input.points.size() / 2);
    for (const std::int32_t v : set.segments) input.segments.push_back(first + v);
  }
  return input;
}

TEST(SmallDomains, AsDefined) {
  FixtureRandom random(1);
  for (std::uint64_t round = 0; round < 400; ++round) {
    expect_right(random_case(random, round));
    if (HasFailure()) return;
  }
}

// Rectangles along the lines of a grid, which lie on each other and go through other points. Those that cross
// others are left out.
TEST(SmallDomains, RectanglesAsDefined) {
  FixtureRandom random(2);
  for (int round = 0; round < 40; ++round) {
    Case input;
    input.points = grid_points(6, 6);
    input.offsets = {0, 36};
    for (int i = 0; i < 8; ++i) {
      const auto x = random.integer(0, 4), y = random.integer(0, 4), right = random.integer(x + 1, 5),
                 top = random.integer(y + 1, 5);
      std::vector<std::int64_t> corners = {6 * y + x, 6 * y + right, 6 * top + right, 6 * top + x};
      if (random.integer(0, 1) != 0) std::reverse(corners.begin(), corners.end());
      const Segments before = input.segments;
      for (std::size_t k = 0; k < 4; ++k) {
        input.segments.push_back(static_cast<std::int32_t>(corners[k]));
        input.segments.push_back(static_cast<std::int32_t>(corners[(k + 1) % 4]));
      }
      try {
        input.triangulate();
      } catch (const Error&) {
        input.segments = before;
      }
    }
    expect_right(input);
    expect_as_twin(input, {{FillRule::winding, Outside::hull, false}, true});
    if (HasFailure()) return;
  }
}

TEST(SmallDomains, KernelsAsTwin) {
  FixtureRandom random(3);
  for (std::uint64_t round = 0; round < 10; ++round) {
    const Case input = random_sets(random, round, 8);
    for (const FillRule rule : kRules) {
      for (const Outside outside : kOutsides) {
        SCOPED_TRACE(std::to_string(static_cast<int>(rule)) + std::to_string(static_cast<int>(outside)));
        expect_as_twin(input, {{rule, outside, false}, true});
        if (HasFailure()) return;
      }
    }
  }
}

// Segments that end anywhere: nesting is defined, the other rules name the first point that is wrong.
TEST(SmallDomains, OpenSegments) {
  FixtureRandom random(4);
  for (std::uint64_t round = 0; round < 30; ++round) {
    Case input;
    input.points = random_integer_points(14, 6, round);
    input.offsets = {0, 14};
    input.segments = edges_of_stretched(input.points, 0.25, 2, round);
    expect_as_twin(input, {{FillRule::nesting, Outside::holes, false}, true});
    EXPECT_EQ(apply(input, input.triangulate(), {{}, true}).depths, expected_nesting(input.triangulate()));
    if (HasFailure()) return;
  }
}

TEST(SmallDomains, CurvesThatAreNotClosed) {
  // A square whose last side is missing, or turned.
  Case input{{0, 0, 4, 0, 4, 4, 0, 4, 0, 0}, {0, 5}, {4, 1, 1, 2, 2, 3, 3, 0}};
  const auto message = [&](FillRule rule, const std::string& tuning) -> std::string {
    ConstrainedTriangulation mesh = input.triangulate();
    const DomainRequest request{{rule, Outside::keep, false}, true};
    try {
      apply_with(tuning, input, request, mesh);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "";
  };
  for (const std::string& tuning : tunings()) {
    input.segments = {4, 1, 1, 2, 2, 3, 3, 0};
    for (const FillRule rule : kRules) EXPECT_EQ(message(rule, tuning), "");
    input.segments = {4, 1, 1, 2, 2, 3, 0, 3};
    EXPECT_EQ(message(FillRule::even_odd, tuning), "");
    EXPECT_EQ(message(FillRule::winding, tuning),
              "segments are no closed curves at point 0 (0, 0): not as many begin there as end");
    input.segments = {1, 2, 2, 3, 3, 4};
    EXPECT_EQ(message(FillRule::even_odd, tuning),
              "segments are no closed curves at point 0 (0, 0): an odd number of them ends there");
    EXPECT_EQ(message(FillRule::nesting, tuning), "");
  }
}

// Holes at random places of a grid's cells: where they are is known.
TEST(SmallDomains, Holes) {
  FixtureRandom random(5);
  for (std::uint64_t round = 0; round < 20; ++round) {
    Case input = random_sets(random, round, 5);
    const ConstrainedTriangulation mesh = input.triangulate();
    // In the middle of some triangles.
    input.hole_offsets = {0};
    for (std::size_t s = 0; s + 1 < mesh.triangle_offsets.size(); ++s) {
      for (std::size_t t = mesh.triangle_offsets[s]; t < mesh.triangle_offsets[s + 1]; ++t) {
        if (random.integer(0, 5) != 0) continue;
        for (int c = 0; c < 2; ++c) {
          double sum = 0;
          for (int k = 0; k < 3; ++k) {
            sum += input.points[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k]) + c];
          }
          input.holes.push_back(sum / 3);
        }
      }
      input.hole_offsets.push_back(input.holes.size() / 2);
    }
    for (const Outside outside : {Outside::keep, Outside::holes}) {
      expect_as_twin(input, {{FillRule::even_odd, outside, false}, true});
      expect_as_twin(input, {{FillRule::nesting, outside, false}, false});
    }
    if (HasFailure()) return;
  }
}

TEST(SmallDomains, HolesAtPlaces) {
  // A square with a square and a segment in it.
  Case input{{0, 0, 8, 0, 8, 8, 0, 8, 2, 2, 4, 2, 4, 4, 2, 4, 5, 6, 7, 6},
             {0, 10},
             {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 8, 9}};
  const auto area = [&](const std::string& tuning) {
    ConstrainedTriangulation mesh = input.triangulate();
    apply_with(tuning, input, {}, mesh);
    double doubled = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
      const double* p[3];
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = &input.points[2 * static_cast<std::size_t>(mesh.triangles[t + k])];
      doubled += (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    }
    return doubled / 2;
  };
  const auto message = [&](const std::string& tuning) -> std::string {
    try {
      area(tuning);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "";
  };
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE(tuning);
    input.holes = {3, 3};
    EXPECT_EQ(area(tuning), 60);
    // Anywhere outside of it is the same region, on an edge too.
    for (const Coordinates& hole : {Coordinates{1, 1}, {7, 7}, {2, 5}, {7.5, 1e-200}}) {
      input.holes = hole;
      EXPECT_EQ(area(tuning), 4) << hole[0];
    }
    input.holes = {3, 3, 1, 1, 3.5, 2.5};
    EXPECT_EQ(area(tuning), 0);
    input.holes = {3, 3, 9, 1};
    EXPECT_EQ(message(tuning), "hole 1 at (9, 1) is in no triangle");
    input.holes = {3, 3, -1e300, 1, 1e300, 2};
    EXPECT_EQ(message(tuning), "hole 1 at (-1.0000000000000001e+300, 1) is in no triangle");
    input.holes = {3, 2};
    EXPECT_EQ(message(tuning), "hole 0 at (3, 2) is on a constraint");
    input.holes = {1, 1, 5, 6};
    EXPECT_EQ(message(tuning), "hole 1 at (5, 6) is on a constraint");
    input.holes = {0, 5};
    EXPECT_EQ(message(tuning), "hole 0 at (0, 5) is on a constraint");
    input.holes = {1, NAN};
    EXPECT_EQ(message(tuning), "hole 0 is not finite: (1, nan)");
    input.holes = {};
    EXPECT_EQ(area(tuning), 64);
  }
}

// A hole on a point without constraints, and the offsets of holes.
TEST(SmallDomains, HolesOfSets) {
  Case input{{0, 0, 2, 0, 0, 2, 2, 2, 1, 1, 0, 0, 2, 0, 0, 2, 5, 5, 6, 6}, {0, 5, 5, 8, 10}, {}};
  input.holes = {1, 1, 0.5, 0.5};
  input.hole_offsets = {0, 1, 1, 2, 2};
  expect_as_twin(input, {});
  EXPECT_TRUE(apply(input, input.triangulate(), {}).triangles.empty());
  input.hole_offsets = {0, 0, 0, 1, 2};
  EXPECT_THROW(apply(input, input.triangulate(), {}), Error);
  for (const std::vector<std::size_t>& wrong :
       {std::vector<std::size_t>{}, {0, 1, 2}, {0, 1, 1, 1, 1}, {1, 1, 1, 2, 2}, {0, 2, 1, 2, 2}}) {
    input.hole_offsets = wrong;
    try {
      apply(input, input.triangulate(), {});
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Large input

// Of all processors together.
double seconds_of(const Case& input, const DomainRequest& request, ConstrainedTriangulation& mesh) {
  ConstrainedTriangulation warm = mesh;
  apply_with("own", input, request, warm);
  const std::clock_t start = std::clock();
  apply_with("own", input, request, mesh);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void expect_large(const Case& input, const char* name) {
  const ConstrainedTriangulation mesh = input.triangulate();
  for (const FillRule rule : kRules) {
    for (const Outside outside : {Outside::keep, Outside::holes}) {
      SCOPED_TRACE(static_cast<int>(rule));
      const DomainRequest request{{rule, outside, false}, true};
      ConstrainedTriangulation found = mesh;
      const double seconds = seconds_of(input, request, found);
      ::testing::Test::RecordProperty(std::string(name) + "_" + std::to_string(static_cast<int>(rule)) +
                                          std::to_string(static_cast<int>(outside)),
                                      std::to_string(seconds));
      if (std::getenv("FLAUNAY_TEST_TIMES") != nullptr) {
        std::printf("%s rule %d outside %d: %.1f ms, %zu triangles\n", name, static_cast<int>(rule),
                    static_cast<int>(outside), 1e3 * seconds, mesh.triangles.size() / 3);
      }
      expect_same(found, by_twin(input, mesh, request));
    }
  }
}

std::size_t large() {
  const char* count = std::getenv("FLAUNAY_TEST_POINTS");
  return count != nullptr ? std::stoul(count) : 100000;
}

// Squares around each other, of which a third goes the other way around.
// The answers of a locator, by exact signs of integers, with a point that splitting has added.
TEST(Domains, Queries) {
  const Coordinates points = {0, 0, 40, 0, 40, 40, 0, 40, 8, 8, 32, 32, 8, 32, 32, 8, 10, 20, 20, 34};
  const Segments segments = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 6, 7, 4, 6, 6, 5, 5, 7, 7, 4};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  const double hole[] = {30, 20};
  constraints.holes = hole;
  constraints.hole_count = 1;
  ConstrainedOptions options;
  options.crossings = Crossings::split;
  options.neighbors = true;
  Triangulator triangulator;
  const ConstrainedTriangulation mesh =
      triangulator.constrained(points.data(), points.size() / 2, constraints, options);
  ASSERT_EQ(mesh.added_points, (Coordinates{20, 20}));
  Coordinates all = points;
  all.insert(all.end(), mesh.added_points.begin(), mesh.added_points.end());
  Coordinates queries;
  std::vector<std::int32_t> expected;
  for (int x = -1; x <= 41; ++x) {
    for (int y = -1; y <= 41; ++y) {
      queries.insert(queries.end(), {static_cast<double>(x), static_cast<double>(y)});
      std::int32_t first = -1;
      for (std::size_t t = mesh.triangles.size() / 3; t-- > 0;) {
        bool is_inside = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const double* const a = &all[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
          const double* const b = &all[2 * static_cast<std::size_t>(mesh.triangles[3 * t + (k + 1) % 3])];
          is_inside &= (b[0] - a[0]) * (y - a[1]) >= (b[1] - a[1]) * (x - a[0]);
        }
        if (is_inside) first = static_cast<std::int32_t>(t);
      }
      expected.push_back(first);
    }
  }
  Locator locator(triangulator, points.data(), points.size() / 2, mesh);
  EXPECT_EQ(locator.locate(queries.data(), expected.size()), expected);
  EXPECT_EQ(expected[43 * 31 + 21], -1);
  const double middle[] = {21, 20};
  EXPECT_EQ(locator.nearest(middle, 1), std::vector<std::int32_t>{10});
  EXPECT_THROW(Locator(triangulator, all.data(), all.size() / 2, mesh), Error);
}

// Triangles that are none of these points: turned ones, the other diagonal, each twice, and a point in one.
TEST(SmallDomains, QueriesInOtherTriangles) {
  Coordinates points = {0, 0, 6, 0, 6, 5, 0, 4, 9, 2};
  const Segments segments = {1, 2};
  const double hole[] = {7, 2};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = constraints.hole_count = 1;
  constraints.holes = hole;
  ConstrainedOptions options;
  options.neighbors = true;
  Triangulator triangulator;
  const ConstrainedTriangulation right = triangulator.constrained(points.data(), 5, constraints, options);
  ASSERT_EQ(right.triangles, (std::vector<std::int32_t>{0, 1, 3, 1, 2, 3}));
  const auto expect_refused = [&](const ConstrainedTriangulation& wrong, const char* part) {
    testing::expect_error(ErrorKind::input, {part},
                          [&] { Locator(triangulator, points.data(), points.size() / 2, wrong); });
  };
  ConstrainedTriangulation wrong = right;
  std::swap(wrong.triangles[4], wrong.triangles[5]);
  expect_refused(wrong, "triangle 1 is not that of a constrained triangulation");
  wrong = right;
  wrong.triangles = {0, 1, 2, 0, 2, 3};
  wrong.neighbors = {-1, 1, -1, -1, -1, 0};
  expect_refused(wrong, "triangle 0 is not that of a constrained triangulation");
  wrong = right;
  for (std::size_t c = 0; c < 6; ++c) {
    wrong.triangles.push_back(right.triangles[c]);
    wrong.neighbors.push_back(right.neighbors[c] < 0 ? -1 : right.neighbors[c] + 2);
    wrong.constrained.push_back(right.constrained[c]);
  }
  expect_refused(wrong, "triangle 0 is not that of a constrained triangulation");
  wrong = right;
  points.insert(points.end(), {1, 1});
  wrong.representatives.push_back(5);
  expect_refused(wrong, "has a point in it");
}

TEST(Domains, NestedRings) {
  const auto rings = static_cast<std::int32_t>(large() / 4);
  Case input;
  for (std::int32_t r = 0; r < rings; ++r) {
    const double d = r + 1;
    input.points.insert(input.points.end(), {-d, -d, d, -d, d, d, -d, d});
    for (std::int32_t k = 0; k < 4; ++k) {
      input.segments.insert(input.segments.end(),
                            {4 * r + k, 4 * r + (r % 3 == 0 ? (k + 1) % 4 : (k + 3) % 4)});
    }
  }
  input.offsets = {0, input.points.size() / 2};
  expect_large(input, "nested");
}

TEST(Domains, OneRegion) {
  Case input;
  input.points = make_fixture("uniform", large(), 1);
  input.offsets = {0, large()};
  expect_large(input, "one");
}

TEST(Domains, ManyTriangles) {
  Case input;
  input.points = make_fixture("uniform", large(), 2);
  input.offsets = {0, large()};
  FixtureRandom random(6);
  input.segments = random_curves(delaunay_of(input.points, input.offsets), random, 3);
  expect_large(input, "triangles");
}

// Each a set: a ring of 80 points around one of 20.
TEST(Domains, ManySets) {
  Case input;
  input.offsets = {0};
  for (std::size_t s = 0; s < large() / 100; ++s) {
    const auto first = static_cast<std::int32_t>(input.points.size() / 2);
    for (std::int32_t i = 0; i < 100; ++i) {
      const bool is_inner = i >= 80;
      const double angle = 2 * M_PI * (is_inner ? -(i - 80) / 20.0 : i / 80.0);
      const double radius = (is_inner ? 1 : 3 + (i % 2)) + 0.1 * static_cast<double>(s % 7);
      input.points.insert(input.points.end(), {radius * std::cos(angle), radius * std::sin(angle)});
      input.segments.insert(input.segments.end(), {first + i, first + (i == 79 ? 0 : i == 99 ? 80 : i + 1)});
    }
    input.offsets.push_back(input.points.size() / 2);
  }
  expect_large(input, "sets");
}

// A fan of regions that all meet at one point.
TEST(Domains, Star) {
  const auto n = static_cast<std::int32_t>(large() / 2);
  Case input;
  input.points = {0, 0};
  for (std::int32_t i = 1; i <= n; ++i) {
    const double angle = 2 * M_PI * i / n;
    input.points.insert(input.points.end(), {std::cos(angle), std::sin(angle)});
    const std::int32_t next = i < n ? i + 1 : 1;
    if (i % 2 != 0) input.segments.insert(input.segments.end(), {0, i, i, next, next, 0});
  }
  input.offsets = {0, static_cast<std::size_t>(n) + 1};
  expect_large(input, "star");
}

// One long strip, whose triangles each have one neighbour before them.
TEST(Domains, Strip) {
  Case input;
  const std::size_t n = large() / 2;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i);
    input.points.insert(input.points.end(), {x, 0, x + 0.5, 1});
  }
  input.offsets = {0, 2 * n};
  const auto last = static_cast<std::int32_t>(2 * n - 1);
  input.segments = {0, last - 1, last - 1, last, last, 1, 1, 0};
  expect_large(input, "strip");
}

}  // namespace
}  // namespace flaunay::testing
