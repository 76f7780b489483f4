// Whole triangulations: against the brute-force reference where n allows, else against the exact checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/files/generate.hpp"
#include "app/files/points.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "host/clock.hpp"
#include "prove/delaunay_proof.hpp"
#include "tests/constrained/check.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using research::Component;
using research::Cut;
using research::Hull;
using research::Mode;
using research::Options;

using ::testing::AssertionFailure;
using ::testing::AssertionResult;
using ::testing::AssertionSuccess;

/// The mode under test: FLAUNAY_TEST_MODE ("flattened") or the default one.
Options defaults() {
  Options options;
  const char* mode = std::getenv("FLAUNAY_TEST_MODE");
  if (mode != nullptr && std::string(mode) == to_string(Mode::flattened)) options.mode = Mode::flattened;
  return options;
}

using Offsets = std::vector<std::size_t>;

Options in_mode(Mode mode) {
  Options options;
  options.mode = mode;
  return options;
}

research::Triangulation triangulate(const Coordinates& points, const Options& options = defaults()) {
  return research::triangulate(triangulator(), points.data(), points.size() / 2, options);
}

research::Triangulation triangulate(const Coordinates& points, const std::vector<std::size_t>& offsets,
                                    const Options& options = defaults()) {
  return research::triangulate(triangulator(), points.data(), offsets, options);
}

Triangulator make_tuned(const char* tuning) {
  const ScopedEnvironment scope("FLAUNAY_TUNING", tuning);
  return Triangulator(testing::device_under_test());
}

std::size_t size_of(const Coordinates& points) { return points.size() / 2; }

std::pair<double, double> point(const Coordinates& points, std::size_t i) {
  return {points[2 * i], points[2 * i + 1]};
}

std::vector<std::size_t> lexicographic_order(const Coordinates& points) {
  std::vector<std::size_t> order(size_of(points));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return point(points, i) != point(points, j) ? point(points, i) < point(points, j) : i < j;
  });
  return order;
}

std::vector<std::int32_t> expected_representatives(const Coordinates& points) {
  std::vector<std::int32_t> result(size_of(points));
  std::size_t representative = 0;
  bool first = true;
  for (const std::size_t i : lexicographic_order(points)) {
    if (first || point(points, i) != point(points, representative)) representative = i;
    first = false;
    result[i] = static_cast<std::int32_t>(representative);
  }
  return result;
}

/// Distinct points in lexicographic order.
std::vector<std::int32_t> distinct_points(const Coordinates& points,
                                          const std::vector<std::int32_t>& representatives) {
  std::vector<std::int32_t> result;
  for (const std::size_t i : lexicographic_order(points)) {
    if (representatives[i] == static_cast<std::int32_t>(i)) result.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

/// The hull by the monotone chain, points on its edges included; counter-clockwise from the lexicographically
/// smallest. Collinear points: all of them in order.
std::vector<std::int32_t> expected_hull(const Coordinates& points) {
  const std::vector<std::int32_t> sorted = distinct_points(points, expected_representatives(points));
  const auto chain = [&](auto begin, auto end) {
    std::vector<std::int32_t> kept;
    for (auto i = begin; i != end; ++i) {
      while (kept.size() >= 2 && reference_orient2d(&points[2 * kept[kept.size() - 2]],
                                                    &points[2 * kept.back()], &points[2 * *i]) < 0) {
        kept.pop_back();
      }
      kept.push_back(*i);
    }
    return kept;
  };
  std::vector<std::int32_t> hull = chain(sorted.begin(), sorted.end());
  const std::vector<std::int32_t> upper = chain(sorted.rbegin(), sorted.rend());
  if (hull.size() == sorted.size() && upper.size() == sorted.size()) return sorted;  // collinear
  if (upper.size() > 2) hull.insert(hull.end(), upper.begin() + 1, upper.end() - 1);
  return hull;
}

/// The boundary of the triangles as a cycle from the lexicographically smallest point.
std::vector<std::int32_t> boundary(const Coordinates& points, const Triangulation& result) {
  std::map<std::int32_t, std::int32_t> next;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    if (result.neighbors[i] >= 0) continue;
    const std::size_t row = i / 3 * 3;
    next[result.triangles[row + (i + 1) % 3]] = result.triangles[row + (i + 2) % 3];
  }
  std::vector<std::int32_t> cycle;
  if (next.empty()) return cycle;
  std::int32_t begin = next.begin()->first;
  for (const auto& [from, to] : next) {
    if (point(points, from) < point(points, begin)) begin = from;
  }
  std::int32_t at = begin;
  do {
    cycle.push_back(at);
    at = next.at(at);
  } while (at != begin && cycle.size() <= next.size());
  return cycle;
}

/// Everything that is promised of the triangulation of one set, checked by other code than made it.
AssertionResult valid(const Coordinates& points, const Triangulation& result) {
  const std::size_t n = size_of(points);
  if (result.triangles.size() % 3 != 0) return AssertionFailure() << "not three indices per triangle";
  if (result.triangle_offsets != std::vector<std::size_t>{0, result.triangles.size() / 3}) {
    return AssertionFailure() << "triangle_offsets are wrong";
  }
  if (result.hull_offsets != std::vector<std::size_t>{0, result.hull.size()}) {
    return AssertionFailure() << "hull_offsets are wrong";
  }
  if (result.representatives != expected_representatives(points)) {
    return AssertionFailure() << "representatives are wrong for " << text_of(points);
  }
  const VerifyReport report = verify(points.data(), n, result.triangles, result.neighbors);
  if (!report.ok) return AssertionFailure() << report.problem << ", for " << text_of(points);
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const std::int32_t v = result.triangles[i];
    if (result.representatives[v] != v) return AssertionFailure() << "vertex " << v << " is a duplicate";
    if (v < result.triangles[i / 3 * 3]) {
      return AssertionFailure() << "row " << i / 3 << " does not begin with its smallest index";
    }
  }
  const std::vector<std::int32_t> hull =
      result.triangles.empty() ? distinct_points(points, result.representatives) : boundary(points, result);
  if (result.hull != hull) return AssertionFailure() << "the hull is wrong for " << text_of(points);
  // Where an empty circle passes through more than three points, their polygon must be a fan.
  const std::int32_t t = find_no_fan(points, result);
  if (t >= 0) return AssertionFailure() << "no fan: triangle " << t << ", for " << text_of(points);
  return AssertionSuccess();
}

/// Equality with the reference, to the last index.
AssertionResult matches_reference(const Coordinates& points, const Triangulation& result) {
  if (sorted_triangles(result.triangles) != reference_delaunay(points)) {
    return AssertionFailure() << "not the reference's triangles for " << text_of(points);
  }
  if (result.neighbors != reference_neighbors(result.triangles)) {
    return AssertionFailure() << "not the reference's neighbours for " << text_of(points);
  }
  if (result.hull != expected_hull(points))
    return AssertionFailure() << "not the hull of " << text_of(points);
  return valid(points, result);
}

AssertionResult same_bytes(const Triangulation& a, const Triangulation& b) {
  if (a.triangles != b.triangles) return AssertionFailure() << "triangles differ";
  if (a.neighbors != b.neighbors) return AssertionFailure() << "neighbours differ";
  if (a.hull != b.hull) return AssertionFailure() << "hulls differ";
  if (a.representatives != b.representatives) return AssertionFailure() << "representatives differ";
  if (a.triangle_offsets != b.triangle_offsets) return AssertionFailure() << "triangle offsets differ";
  if (a.hull_offsets != b.hull_offsets) return AssertionFailure() << "hull offsets differ";
  return AssertionSuccess();
}

/// What belongs to set s, as if it had been alone.
Triangulation slice(const Triangulation& all, const std::vector<std::size_t>& offsets, std::size_t s) {
  const auto first_point = static_cast<std::int32_t>(offsets[s]);
  const auto first_triangle = static_cast<std::int32_t>(all.triangle_offsets[s]);
  const auto cut = [](const std::vector<std::int32_t>& values, std::size_t begin, std::size_t end,
                      std::int32_t shift) {
    std::vector<std::int32_t> part(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                   values.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::int32_t& value : part) value -= value < 0 ? 0 : shift;
    return part;
  };
  Triangulation result;
  const std::size_t rows = 3 * all.triangle_offsets[s], rows_end = 3 * all.triangle_offsets[s + 1];
  result.triangles = cut(all.triangles, rows, rows_end, first_point);
  result.neighbors = cut(all.neighbors, rows, rows_end, first_triangle);
  result.hull = cut(all.hull, all.hull_offsets[s], all.hull_offsets[s + 1], first_point);
  result.representatives = cut(all.representatives, offsets[s], offsets[s + 1], first_point);
  result.triangle_offsets = {0, result.triangles.size() / 3};
  result.hull_offsets = {0, result.hull.size()};
  return result;
}

/// The offsets' own consistency; then slice may be used.
AssertionResult well_formed(const Triangulation& all, std::size_t n, std::size_t sets) {
  for (const auto* offsets : {&all.triangle_offsets, &all.hull_offsets}) {
    if (offsets->size() != sets + 1 || offsets->front() != 0 ||
        !std::is_sorted(offsets->begin(), offsets->end())) {
      return AssertionFailure() << "offsets are not offsets";
    }
  }
  if (3 * all.triangle_offsets.back() != all.triangles.size())
    return AssertionFailure() << "triangle_offsets' end";
  if (all.hull_offsets.back() != all.hull.size()) return AssertionFailure() << "hull_offsets' end";
  if (all.neighbors.size() != all.triangles.size()) return AssertionFailure() << "number of neighbours";
  if (all.representatives.size() != n) return AssertionFailure() << "number of representatives";
  return AssertionSuccess();
}

Coordinates slice(const Coordinates& points, const std::vector<std::size_t>& offsets, std::size_t s) {
  return Coordinates(points.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s]),
                     points.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s + 1]));
}

/// Several sets in the making.
struct Sets {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  void add(const Coordinates& set) {
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(size_of(points));
  }
  std::size_t count() const { return offsets.size() - 1; }
  Coordinates set(std::size_t s) const { return slice(points, offsets, s); }
};

// ---------------------------------------------------------------------------------------------------------------
// Small: a representative set, for devices and sanitizers.

TEST(SmallTriangulation, Tiny) {
  for (const Coordinates& points : std::vector<Coordinates>{{},
                                                            {3, 4},
                                                            {3, 4, 1, 2},
                                                            {1, 1, 1, 1, 1, 1},
                                                            {0, 0, 2, 2, 1, 1, 3, 3},
                                                            {0, 0, 1, 0, 0, 1},
                                                            {0, 0, 0, 1, 1, 0},
                                                            {0, 0, 1, 0, 1, 1, 0, 1},
                                                            {0, 0, 4, 0, 0, 4, 1, 1, 1, 1}}) {
    EXPECT_TRUE(matches_reference(points, triangulate(points)));
  }
}

TEST(SmallTriangulation, EqualsReference) {
  // A circle has more border vertices than one work-item handles alone.
  const std::pair<const char*, std::size_t> inputs[] = {
      {"uniform", 40},        {"grid", 25},   {"rotated-grid", 25}, {"half-duplicates", 30},
      {"integer-circle", 36}, {"circle", 60}, {"star", 24}};
  for (const auto& [name, n] : inputs) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, n, 1);
    const Triangulation result = triangulate(points);
    EXPECT_TRUE(matches_reference(points, result));
    if (name == std::string("rotated-grid")) {
      EXPECT_GT(result.statistics.undecided, 0U) << "the exact kernels were to run";
    }
  }
}

TEST(SmallTriangulation, Sets) {
  Sets sets;
  sets.add(io::generate("uniform", 12, 3).coordinates);
  sets.add({});
  sets.add({0, 0, 1, 1, 2, 2});
  sets.add(io::generate("small-integers", 14, 3).coordinates);
  const Triangulation all = triangulate(sets.points, sets.offsets);
  ASSERT_TRUE(well_formed(all, size_of(sets.points), sets.count()));
  for (std::size_t s = 0; s < sets.count(); ++s) {
    EXPECT_TRUE(matches_reference(sets.set(s), slice(all, sets.offsets, s))) << "set " << s;
  }
}

/// What other modes and hull variants launch, and the kernels that count.
TEST(SmallTriangulation, OtherExecutions) {
  for (const char* const name : {"uniform", "grid", "integer-circle"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 40, 5);
    for (const Hull hull : {Hull::prune, Hull::quickhull, Hull::balanced}) {
      Options options = in_mode(Mode::flattened);
      options.hull = hull;
      options.cut = hull == Hull::prune ? Cut::alternate : Cut::interquartile;
      EXPECT_TRUE(valid(points, triangulate(points, options))) << to_string(hull);
    }
    for (const Mode mode : {Mode::flattened, Mode::recursive_device, Mode::partition}) {
      Options options = in_mode(mode);
      options.partition_levels = 2;
      EXPECT_TRUE(valid(points, triangulate(points, options))) << to_string(mode);
    }
    Options options = in_mode(Mode::flattened);
    options.count = true;
    const research::Triangulation counted = triangulate(points, options);
    EXPECT_TRUE(valid(points, counted));
    EXPECT_GT(counted.work.start[static_cast<std::size_t>(Component::hull)].operations(), 100u);
  }
}

// ---------------------------------------------------------------------------------------------------------------
// Every n from 0 to 300, against the reference: up to 60 of every distribution, then of each in turn.

class EverySize : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySize, EqualsReference) {
  for (std::size_t n = 0; n <= 300; ++n) {
    if (n > 60 && n % 3 != GetParam().size() % 3) continue;
    const std::uint64_t seeds = n <= 10 ? 8 : n <= 50 ? 2 : 1;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Coordinates points = make_fixture(GetParam(), n, 1000 * n + seed);
      ASSERT_EQ(size_of(points), n);
      ASSERT_TRUE(matches_reference(points, triangulate(points)))
          << GetParam() << ", seed " << 1000 * n + seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Distributions, EverySize,
                         ::testing::Values("uniform", "small-integers", "grid", "integer-circle", "kuzmin",
                                           "collinear", "columns", "star", "thirty-lines"),
                         instance_name);

TEST(Triangulation, EverySizePerturbed) {
  const std::vector<std::string> names = {"grid", "integer-circle", "columns", "ladder", "apex"};
  for (std::size_t n = 1; n <= 300; ++n) {
    const std::string& name = names[n % names.size()];
    const Coordinates points = perturbed(make_fixture(name, n, n), n);
    ASSERT_TRUE(matches_reference(points, triangulate(points))) << name << ", seed " << n;
  }
}

/// All 65,536 subsets of a 4 x 4 grid, as sets of one call.
TEST(Triangulation, EverySubsetOfAGrid) {
  Sets sets;
  for (unsigned bits = 0; bits < 65536; ++bits) {
    Coordinates points;
    for (unsigned k = 0; k < 16; ++k) {
      if (bits >> k & 1U) fixtures_detail::add(points, std::int64_t{k % 4}, std::int64_t{k / 4});
    }
    sets.add(points);
  }
  const Triangulation all = triangulate(sets.points, sets.offsets);
  ASSERT_TRUE(well_formed(all, size_of(sets.points), sets.count()));
  for (std::size_t s = 0; s < sets.count(); ++s) {
    ASSERT_TRUE(matches_reference(sets.set(s), slice(all, sets.offsets, s))) << "subset " << s;
  }
}

/// Each subset of a 3 x 3 grid in a call of its own.
TEST(Triangulation, EverySubsetOfASmallGridAlone) {
  for (unsigned bits = 0; bits < 512; ++bits) {
    Coordinates points;
    for (unsigned k = 0; k < 9; ++k) {
      if (bits >> k & 1U) fixtures_detail::add(points, std::int64_t{k % 3}, std::int64_t{k / 3});
    }
    ASSERT_TRUE(matches_reference(points, triangulate(points))) << "subset " << bits;
  }
}

TEST(Triangulation, CollinearHasNoTriangles) {
  struct Case {
    Coordinates points;
    std::vector<std::int32_t> hull;
  };
  const std::vector<Case> cases = {{{}, {}},
                                   {{5, 5}, {0}},
                                   {{5, 5, 5, 5, 5, 5}, {0}},
                                   {{1, 0, 0, 0}, {1, 0}},
                                   {{0, 1, 0, 0, 0, 1, 0, -1}, {3, 1, 0}},
                                   {{3, 0, 1, 0, 2, 0, 1, 0, 0, 0}, {4, 1, 2, 0}},
                                   {{-1, 1, 1, -1, 0, 0, -0.0, 0.0}, {0, 2, 1}}};
  for (const Case& c : cases) {
    const Triangulation result = triangulate(c.points);
    EXPECT_TRUE(result.triangles.empty());
    EXPECT_TRUE(result.neighbors.empty());
    EXPECT_EQ(result.hull, c.hull) << text_of(c.points);
    EXPECT_TRUE(valid(c.points, result));
  }
  Coordinates equal;
  for (int i = 0; i < 20000; ++i) fixtures_detail::add(equal, 0.1, -0.7);
  const Triangulation result = triangulate(equal);
  EXPECT_TRUE(result.triangles.empty());
  EXPECT_EQ(result.hull, std::vector<std::int32_t>{0});
  EXPECT_EQ(result.representatives, std::vector<std::int32_t>(20000, 0));
  EXPECT_EQ(result.statistics.duplicates, 19999U);
}

/// A line whose points' coordinates are rounded, so that nothing but exact orientations tells it from others.
TEST(Triangulation, OnALineOrNextToIt) {
  FixtureRandom random(16);
  for (const std::size_t n : {3, 4, 40, 700}) {
    Coordinates points;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = random.unit();
      fixtures_detail::add(points, x, x);
    }
    const Triangulation line = triangulate(points);
    EXPECT_TRUE(line.triangles.empty());
    EXPECT_EQ(line.hull.size(), n);
    EXPECT_TRUE(valid(points, line));
    points.back() = std::nextafter(points.back(), 2);
    const Triangulation beside = triangulate(points);
    EXPECT_FALSE(beside.triangles.empty());
    EXPECT_TRUE(matches_reference(points, beside));
  }
}

/// All points on the hull, whose edges but one go from smaller to larger numbers: no other input has as many
/// edges without a neighbour.
TEST(Triangulation, ParabolasOfManySizes) {
  for (std::size_t n = 350; n < 6000; n += n / 2) {
    const Coordinates points = make_fixture("parabola", n, 1);
    const Triangulation result = triangulate(points);
    EXPECT_EQ(result.triangles.size() / 3, n - 2) << n;
    EXPECT_EQ(result.hull.size(), n) << n;
  }
}

TEST(Triangulation, NegativeZeroIsZero) {
  const Coordinates points = {0.0, 0.0, 1, 0, 0, 1, -0.0, 0.0, -0.0, -0.0, 1, -0.0};
  const Triangulation result = triangulate(points);
  EXPECT_EQ(result.triangles, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(result.representatives, (std::vector<std::int32_t>{0, 1, 2, 0, 0, 1}));
}

/// Hand-made: the square's diagonal leaves its lexicographically smallest corner; rows begin with the
/// smallest index.
TEST(Triangulation, CanonicalSquare) {
  const Coordinates points = {1, 1, 0, 1, 1, 0, 0, 0};
  EXPECT_EQ(sorted_triangles(triangulate(points).triangles), (TriangleSet{{0, 1, 3}, {0, 3, 2}}));
  EXPECT_EQ(triangulate(points).hull, (std::vector<std::int32_t>{3, 2, 0, 1}));
}

// ---------------------------------------------------------------------------------------------------------------
// The fixtures, each as it is, perturbed by one unit in the last place, and at extreme scales.

class OnFixture : public ::testing::TestWithParam<std::string> {};

TEST_P(OnFixture, IsValid) {
  for (const std::size_t n : {1000, 4000, 20000}) {
    SCOPED_TRACE(GetParam() + ", n = " + std::to_string(n) + ", seed 7");
    const Coordinates points = make_fixture(GetParam(), n, 7);
    EXPECT_TRUE(valid(points, triangulate(points)));
    const Coordinates moved = perturbed(points, n);
    EXPECT_TRUE(valid(moved, triangulate(moved))) << "perturbed";
    if (n > 4000) continue;
    for (const double factor : {1e-150, 1e150}) {
      const Coordinates far = scaled(points, factor);
      EXPECT_TRUE(valid(far, triangulate(far))) << "times " << factor;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fixtures, OnFixture, ::testing::ValuesIn(fixture_names()), instance_name);

/// The set of triangles is a function of the set of points.
TEST(Triangulation, ShuffledIsTheSame) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates points = fixture.make(1500, 3);
    const Triangulation result = triangulate(points);
    std::vector<std::size_t> permutation(size_of(points));
    std::iota(permutation.begin(), permutation.end(), std::size_t{0});
    FixtureRandom(5).shuffle(permutation);
    const Coordinates shuffled = permuted(points, permutation);
    Triangulation mapped = triangulate(shuffled);
    EXPECT_EQ(mapped.representatives, expected_representatives(shuffled));
    for (auto* indices : {&mapped.triangles, &mapped.hull}) {
      for (std::int32_t& i : *indices) i = result.representatives[permutation[i]];
    }
    EXPECT_EQ(sorted_triangles(mapped.triangles), sorted_triangles(result.triangles));
    EXPECT_EQ(mapped.hull, result.hull);
  }
}

/// Again, and after other work; with profiling; without neighbours.
TEST(Determinism, SameInputSameBytes) {
  const Coordinates other = io::generate("normal", 3000, 11).coordinates;
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates points = fixture.make(1500, 11);
    const Triangulation first = triangulate(points);
    EXPECT_TRUE(same_bytes(triangulate(points), first)) << "again";
    triangulate(other);
    EXPECT_TRUE(same_bytes(triangulate(points), first)) << "after other work";

    Options options = defaults();
    options.profile = true;
    EXPECT_TRUE(same_bytes(triangulate(points, options), first)) << "profiled";
    options = defaults();
    options.neighbors = false;
    const Triangulation without = triangulate(points, options);
    EXPECT_EQ(without.triangles, first.triangles);
    EXPECT_EQ(without.hull, first.hull);
    EXPECT_TRUE(without.neighbors.empty());
  }
}

/// Other blocks make another order of rows, but the same triangles: blocks of a few points on every input.
TEST(Determinism, SmallBlocksSameTriangles) {
  Triangulator tuned = make_tuned("small-blocks");
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {5, 20, 100, 1500}) {
      SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n));
      const Coordinates points = fixture.make(n, 13);
      const Triangulation found = tuned.triangulate(points.data(), size_of(points));
      EXPECT_TRUE(valid(points, found));
      EXPECT_EQ(sorted_triangles(found.triangles), sorted_triangles(triangulate(points).triangles));
    }
  }
}

/// Work-group sizes, chunk sizes and the like change nothing.
class EveryTuning : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryTuning, SameInputSameBytes) {
  Triangulator tuned = make_tuned(GetParam().c_str());
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {3, 10, 100, 1500}) {
      SCOPED_TRACE(fixture.name + ", n = " + std::to_string(n));
      const Coordinates points = fixture.make(n, 11);
      EXPECT_TRUE(same_bytes(research::triangulate(tuned, points.data(), size_of(points), defaults()),
                             triangulate(points)));
    }
  }
  const Coordinates many = io::generate("kuzmin", 30000, 1).coordinates;
  EXPECT_TRUE(
      same_bytes(research::triangulate(tuned, many.data(), size_of(many), defaults()), triangulate(many)));

  Sets sets;
  for (std::uint64_t s = 0; s < 300; ++s) {
    sets.add(make_fixture(s % 2 ? "uniform" : "small-integers", s % 30, s));
  }
  EXPECT_TRUE(same_bytes(research::triangulate(tuned, sets.points.data(), sets.offsets, defaults()),
                         triangulate(sets.points, sets.offsets)));
}

INSTANTIATE_TEST_SUITE_P(Determinism, EveryTuning,
                         ::testing::Values("cpu", "gpu", "gpu:32", "gpu:256", "small"), instance_name);

class OnFile : public ::testing::TestWithParam<std::string> {};

TEST_P(OnFile, IsValidAtEveryScale) {
  const Coordinates points = io::read_points(test_data() + "/" + GetParam()).coordinates;
  ASSERT_GT(points.size(), 0U);
  const Triangulation result = triangulate(points);
  EXPECT_TRUE(valid(points, result));
  if (size_of(points) <= 400) {
    EXPECT_TRUE(matches_reference(points, result));
  }
  for (const double factor : {1e-9, 1e9}) {
    const Coordinates far = scaled(points, factor);
    EXPECT_TRUE(valid(far, triangulate(far))) << "times " << factor;
  }
  // A power of two changes nothing at all.
  EXPECT_TRUE(same_bytes(triangulate(scaled(points, 0x1p-400)), result));
  const Coordinates moved = perturbed(points, 1);
  EXPECT_TRUE(valid(moved, triangulate(moved))) << "perturbed";
}

INSTANTIATE_TEST_SUITE_P(Files, OnFile, ::testing::ValuesIn(data_files()), instance_name);

TEST(Triangulation, AHundredThousand) {
  for (const char* name : {"normal", "line", "grid", "integer-circle", "nested-circles", "columns",
                           "clusters", "spiral", "circle-few-inside"}) {
    const Coordinates points = make_fixture(name, 100000, 1);
    EXPECT_TRUE(valid(points, triangulate(points))) << name;
  }
}

TEST(Triangulation, HundredsOfThousands) {
  Triangulator fresh;  // whose memory is of this size only
  const std::size_t n = 300000;
  for (const char* name : {"uniform", "kuzmin"}) {
    const Coordinates points = make_fixture(name, n, 1);
    const Triangulation result = fresh.triangulate(points.data(), n);
    EXPECT_TRUE(valid(points, result)) << name;
    EXPECT_GT(result.statistics.device_bytes_peak, 0U);
    // In rounds, buffers are a little larger than what is asked for.
    const std::size_t most = result.statistics.rounds > 0 ? 320 : 300;
    EXPECT_LE(result.statistics.device_bytes_peak, most * n) << name;
  }
}

/// Subnormal numbers and the largest doubles are numbers like any others.
TEST(Triangulation, EndsOfTheRange) {
  const Coordinates integers = io::generate("small-integers", 300, 5).coordinates;
  const TriangleSet expected = reference_delaunay(integers);
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  for (const double factor : {kLeast, 0x1p-1050, 0x1p1015}) {
    const Coordinates points = scaled(integers, factor);
    ASSERT_TRUE(std::isfinite(*std::max_element(points.begin(), points.end())));
    EXPECT_EQ(sorted_triangles(triangulate(points).triangles), expected) << factor;
  }
  constexpr double kMost = std::numeric_limits<double>::max();
  const Coordinates huge = {-kMost, -kMost, kMost, -kMost, kMost, kMost, -kMost, kMost, 0, 0, kMost, 0};
  EXPECT_TRUE(matches_reference(huge, triangulate(huge)));
  const Coordinates tiny = {-kLeast, 0, kLeast, 0, 0, 3 * kLeast, 0, kLeast, 0, -kLeast};
  EXPECT_TRUE(matches_reference(tiny, triangulate(tiny)));
}

// ---------------------------------------------------------------------------------------------------------------
// Nested input: many sets in one call.

/// Every set as the reference has it, or as it is alone.
void check_sets(const Sets& sets) {
  const Triangulation all = triangulate(sets.points, sets.offsets);
  ASSERT_TRUE(well_formed(all, size_of(sets.points), sets.count()));
  EXPECT_EQ(all.statistics.points, size_of(sets.points));
  EXPECT_EQ(all.statistics.triangles, all.triangles.size() / 3);
  EXPECT_EQ(all.statistics.hull_vertices, all.hull.size());
  for (std::size_t s = 0; s < sets.count(); ++s) {
    const Coordinates points = sets.set(s);
    const Triangulation part = slice(all, sets.offsets, s);
    if (size_of(points) <= 60) {
      ASSERT_TRUE(matches_reference(points, part)) << "set " << s;
    } else {
      ASSERT_TRUE(valid(points, part)) << "set " << s;
      const Triangulation alone = triangulate(points);
      ASSERT_EQ(sorted_triangles(part.triangles), sorted_triangles(alone.triangles)) << "set " << s;
      ASSERT_EQ(part.hull, alone.hull) << "set " << s;
    }
  }
  EXPECT_TRUE(same_bytes(triangulate(sets.points, sets.offsets), all)) << "again";
}

TEST(Nested, OneSetIsTheSameAsNone) {
  const Coordinates points = io::generate("half-duplicates", 2000, 4).coordinates;
  EXPECT_TRUE(same_bytes(triangulate(points, Offsets{0, 2000}), triangulate(points)));
}

TEST(Nested, NoSetsAndEmptySets) {
  const Triangulation none = triangulate({}, std::vector<std::size_t>{0});
  EXPECT_EQ(none.triangle_offsets, std::vector<std::size_t>{0});
  EXPECT_EQ(none.hull_offsets, std::vector<std::size_t>{0});
  const Triangulation empty = triangulate({}, std::vector<std::size_t>{0, 0, 0});
  EXPECT_EQ(empty.triangle_offsets, (std::vector<std::size_t>{0, 0, 0}));
  EXPECT_EQ(empty.hull_offsets, (std::vector<std::size_t>{0, 0, 0}));
  EXPECT_TRUE(empty.triangles.empty() && empty.hull.empty() && empty.representatives.empty());
}

TEST(Nested, TwoSets) {
  for (const std::string first : {"uniform", "grid", "collinear"}) {
    for (const std::string second : {"kuzmin", "circle", "small-integers"}) {
      SCOPED_TRACE(first + " and " + second);
      Sets sets;
      sets.add(make_fixture(first, 500, 1));
      sets.add(make_fixture(second, 700, 2));
      check_sets(sets);
    }
  }
}

/// Sets of every kind and size, the empty ones first, last and in between.
TEST(Nested, AllFixturesAtOnce) {
  Sets sets;
  sets.add({});
  std::uint64_t seed = 0;
  for (const Fixture& fixture : all_fixtures()) {
    if (fixture.name == "slender" || fixture.name == "log-spiral") continue;  // too far apart for one call
    for (const std::size_t n : {1, 7, 60, 400, 2000}) sets.add(fixture.make(n, ++seed));
    sets.add({});
  }
  sets.add({});
  check_sets(sets);
}

TEST(Nested, TenThousandSmallSets) {
  FixtureRandom random(8);
  Sets sets;
  const std::vector<std::string> names = {"uniform",        "small-integers", "collinear", "half-duplicates",
                                          "integer-circle", "grid",           "columns",   "star"};
  for (std::uint64_t s = 0; s < 10000; ++s) {
    const auto n =
        static_cast<std::size_t>(random.integer(0, 3) == 0 ? random.integer(0, 3) : random.integer(0, 20));
    Coordinates points = make_fixture(names[s % names.size()], n, s);
    if (s % 11 == 0) points = Coordinates(2 * n, 0.5);  // all equal
    sets.add(points);
  }
  check_sets(sets);
}

TEST(Nested, TenThousandSinglePoints) {
  Sets sets;
  for (int s = 0; s < 10000; ++s) sets.add({0.5, static_cast<double>(s % 3)});
  const Triangulation all = triangulate(sets.points, sets.offsets);
  EXPECT_TRUE(all.triangles.empty());
  std::vector<std::int32_t> every(10000);
  std::iota(every.begin(), every.end(), 0);
  EXPECT_EQ(all.hull, every);
  EXPECT_EQ(all.representatives, every) << "a point of another set is no duplicate";
  EXPECT_EQ(all.statistics.duplicates, 0U);
}

/// A thousand times the same set, cocircular points and duplicates in it: a thousand times the same result.
TEST(Nested, EqualSets) {
  const Coordinates set = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 1, 0, 2, 2, 2, 3, 3, 2, 3, 3};
  const TriangleSet expected = reference_delaunay(set);
  Sets sets;
  for (int s = 0; s < 1000; ++s) sets.add(set);
  const Triangulation all = triangulate(sets.points, sets.offsets);
  ASSERT_TRUE(well_formed(all, size_of(sets.points), sets.count()));
  const Triangulation first = slice(all, sets.offsets, 0);
  EXPECT_EQ(sorted_triangles(first.triangles), expected);
  for (std::size_t s = 0; s < sets.count(); ++s) {
    ASSERT_TRUE(matches_reference(set, slice(all, sets.offsets, s))) << "set " << s;
  }
}

/// One set much larger than all others, as the first, one in the middle, or the last.
TEST(Nested, OneLargeSet) {
  for (const std::size_t large : {0, 150, 299}) {
    Sets sets;
    for (std::size_t s = 0; s < 300; ++s) sets.add(make_fixture("uniform", s == large ? 20000 : s % 5, s));
    check_sets(sets);
  }
}

/// Each set has its own scale.
TEST(Nested, ManyScales) {
  Sets sets;
  for (int s = -60; s <= 60; s += 5) {
    sets.add(scaled(io::generate("uniform", 50, static_cast<std::uint64_t>(s + 100)).coordinates,
                    std::pow(10.0, s)));
    sets.add(scaled(io::generate("grid", 50, 1).coordinates, std::pow(10.0, -s)));
  }
  check_sets(sets);
}

/// No scaling is right for all sets: a batch accepts whatever its sets alone are accepted with.
TEST(Nested, EveryScale) {
  Sets sets;
  for (int s = -320; s <= 305; s += 25) {
    const auto seed = static_cast<std::uint64_t>(s + 400);
    sets.add(scaled(io::generate("uniform", 50, seed).coordinates, std::pow(10.0, s)));
    sets.add(scaled(io::generate("integer-circle", 50, seed).coordinates, std::pow(10.0, std::min(s, 290))));
    sets.add({});
    sets.add({0, 0});
  }
  sets.add(scaled(io::generate("uniform", 5000, 1).coordinates, 0x1p-900));
  sets.add(io::generate("uniform", 5000, 2).coordinates);
  check_sets(sets);
}

// ---------------------------------------------------------------------------------------------------------------
// Errors; after each, the triangulator works as before.

class Errors : public ::testing::Test {
 protected:
  void TearDown() override {
    EXPECT_TRUE(same_bytes(triangulate(points_), expected_)) << "not usable any more";
  }

  Coordinates points_ = io::generate("half-duplicates", 500, 21).coordinates;
  Triangulation expected_ = triangulate(points_);
};

TEST_F(Errors, NotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, -kNan, kInfinity, -kInfinity}) {
    for (const std::size_t index : {0, 317, 499}) {
      for (const std::size_t coordinate : {0, 1}) {
        Coordinates points = points_;
        points[2 * index + coordinate] = bad;
        points[2 * 499 + 1] = bad;  // the first is named
        const std::string text = error_of(ErrorKind::input, [&] { triangulate(points); });
        EXPECT_NE(text.find("point " + std::to_string(index) + " "), std::string::npos) << text;
      }
    }
  }
  Coordinates points = points_;
  points[2 * 400] = kNan;
  const std::string text = error_of(ErrorKind::input, [&] {
    triangulate(points, std::vector<std::size_t>{0, 100, 450, 500});
  });
  EXPECT_NE(text.find("point 400 "), std::string::npos) << text;
  expect_error(ErrorKind::input, {}, [&] { triangulate({kNan, 0}); });
}

TEST_F(Errors, RangeOfMagnitudes) {
  for (const auto& [large, small] : std::vector<std::pair<double, double>>{
           {1e300, 1e-300}, {-1e300, -1e-300}, {1e200, 5e-324}, {1.7e308, 1}}) {
    Coordinates points(2 * 30, 0.0);
    points[2 * 11 + 1] = small;
    points[2 * 23] = large;
    const std::string text = error_of(ErrorKind::input, [&] { triangulate(points); });
    EXPECT_NE(text.find("point 11 "), std::string::npos) << text;
    EXPECT_NE(text.find("point 23 "), std::string::npos) << text;
  }
}

TEST_F(Errors, RangeOfMagnitudesOfASet) {
  const Coordinates points = {0, 0, 1, 0, 0, 1, 1e-300, 0, 1e300, 1e299, 5, 6, 0x1p-1074, 0, 1, 2};
  const Offsets offsets{0, 3, 5, 6, 6, 7, 8};
  const std::string text = error_of(ErrorKind::input, [&] { triangulate(points, offsets); });
  EXPECT_NE(text.find("point 3 "), std::string::npos) << text;
  EXPECT_NE(text.find("point 4 "), std::string::npos) << text;
}

/// The range that the error states is the range that is accepted, at any scale, and exact to its end.
TEST_F(Errors, RangeOfMagnitudesIsAsStated) {
  const std::string text = error_of(ErrorKind::input, [&] { triangulate({1e300, 1e-300}); });
  const std::size_t end = text.rfind(" are supported");
  ASSERT_NE(end, std::string::npos) << text;
  const std::size_t begin = text.find_last_not_of("0123456789", end - 1) + 1;
  const int places = std::stoi(text.substr(begin, end - begin));
  ASSERT_GT(places, 400);
  for (const int lowest : {-1074, -700, -places / 2, 0, 1023 - places}) {
    // Integers from 1 to 2^(places - 1): their bits span as many places. Slivers whose signs only the lowest
    // bits decide, and a square with a point just beside its centre.
    const double one = std::ldexp(1.0, lowest), most = std::ldexp(1.0, lowest + places - 1);
    Coordinates points = {0,        0,        most, 0,   most,     most, 0,        most, most / 2,
                          most / 2, most / 2, one,  one, most / 2, most, most / 2, one,  one};
    EXPECT_TRUE(matches_reference(points, triangulate(points))) << "lowest bit " << lowest;
    fixtures_detail::add(points, 2 * most, 0.0);
    expect_error(ErrorKind::input, {}, [&] { triangulate(points); });
  }
}

TEST_F(Errors, BadOffsets) {
  const std::vector<std::vector<std::size_t>> all = {{}, {1, 500}, {0, 300, 200, 500}, {500, 0}, {5}};
  for (const std::vector<std::size_t>& offsets : all) {
    expect_error(ErrorKind::usage, {}, [&] { triangulate(points_, offsets); });
  }
}

TEST_F(Errors, TooManyPoints) {
  // Twice as many, because the memory that is free changes.
  const std::size_t capacity = 2 * triangulator().capacity();
  EXPECT_GE(capacity, 2000000U);
  try {
    triangulator().triangulate(points_.data(), capacity);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_TRUE(error.kind() == ErrorKind::input || error.kind() == ErrorKind::device);
    EXPECT_NE(std::string(error.what()).find(std::to_string(capacity)), std::string::npos) << error.what();
  }
}

TEST_F(Errors, UnknownDevice) {
  for (const char* name : {"no such device", "#99", "#", "#x", "#99999999999999999999999"}) {
    const std::string text = error_of(ErrorKind::device, [&] { Triangulator{name}; });
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_NE(text.find("#0 "), std::string::npos) << "does not say what there is: " << text;
  }
  const ScopedEnvironment scope("FLAUNAY_TUNING", "no such tuning");
  EXPECT_NE(
      error_of(ErrorKind::device, [] { Triangulator(testing::device_under_test()); }).find("no such tuning"),
      std::string::npos);
}

/// An exception of the caller's own passes through, at any point of the work.
TEST_F(Errors, ThrowingProgress) {
  struct Cancelled {};
  for (int when = 0;; ++when) {
    int calls = 0;
    Options options = defaults();
    options.progress = [&](const std::string&, int, double) {
      if (calls++ == when) throw Cancelled{};
    };
    try {
      triangulate(points_, options);
      EXPECT_EQ(calls, when);
      EXPECT_GT(calls, 3);
      break;
    } catch (const Cancelled&) {
    }
    ASSERT_TRUE(same_bytes(triangulate(points_), expected_)) << "cancelled at report " << when;
  }
}

TEST(Triangulator, ChoosesDevices) {
  const std::vector<DeviceInfo> devices = list_devices(true);
  ASSERT_FALSE(devices.empty());
  const std::string name = triangulator().device().name;
  EXPECT_TRUE(
      std::any_of(devices.begin(), devices.end(), [&](const DeviceInfo& d) { return d.name == name; }));
  EXPECT_EQ(Triangulator(name).device().name, name);
  for (std::size_t k = 0; k < devices.size(); ++k) {
    if (!devices[k].fp64) continue;
    EXPECT_TRUE(devices[k].self_test_passed) << devices[k].self_test_failure;
    EXPECT_EQ(Triangulator("#" + std::to_string(k)).device().name, devices[k].name);
  }
}

TEST(Triangulator, MovesWithItsState) {
  const Coordinates points = io::generate("uniform", 300, 2).coordinates;
  Triangulator first;
  const Triangulation expected = first.triangulate(points.data(), 300);
  Triangulator second = std::move(first);
  EXPECT_TRUE(same_bytes(second.triangulate(points.data(), 300), expected));
}

// ---------------------------------------------------------------------------------------------------------------
// What is reported beside the result.

TEST(Statistics, CountsAreConsistent) {
  for (const char* name : {"uniform", "kuzmin", "half-duplicates", "line", "star", "grid", "apex"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 20000, 2);
    Options options = defaults();
    options.profile = true;
    options.finish = research::Finish::levels;
    const research::Triangulation result = triangulate(points, options);
    const Statistics& statistics = result.statistics;
    const std::size_t distinct = statistics.points - statistics.duplicates;
    EXPECT_EQ(statistics.points, 20000U);
    EXPECT_EQ(distinct, distinct_points(points, result.representatives).size());
    EXPECT_EQ(statistics.triangles, result.triangles.size() / 3);
    EXPECT_EQ(statistics.hull_vertices, result.hull.size());
    EXPECT_EQ(statistics.triangles, 2 * distinct - 2 - statistics.hull_vertices);
    EXPECT_EQ(statistics.device, triangulator().device().name);
    EXPECT_EQ(statistics.host_waits > 0, statistics.device != "host");
    EXPECT_GT(statistics.kernel_launches, 0U);
    EXPECT_GT(statistics.seconds, 0);

    std::size_t internal = distinct - statistics.hull_vertices;
    std::size_t regions = 1;
    for (std::size_t l = 0; l < result.levels.size(); ++l) {
      SCOPED_TRACE(l);
      const research::LevelStatistics& level = result.levels[l];
      if (l == 0) {
        EXPECT_EQ(level.internal_points, internal);
        EXPECT_EQ(level.corners, statistics.hull_vertices);
      } else {
        EXPECT_LT(level.internal_points, internal) << "a path takes at least one point";
      }
      EXPECT_GE(level.regions, 1U);
      EXPECT_LE(level.regions, regions);
      EXPECT_LE(level.regions, level.internal_points);
      EXPECT_LE(level.largest_region, level.internal_points - (level.regions - 1));
      EXPECT_GE(level.largest_region * level.regions, level.internal_points);
      EXPECT_GE(level.corners, 3 * level.regions);
      EXPECT_GE(level.path_vertices, level.regions);
      internal = level.internal_points;
      regions = 2 * level.regions;
    }
    if (defaults().mode != Mode::flattened) {
      EXPECT_TRUE(result.levels.empty());
    } else {
      EXPECT_EQ(result.levels.empty(), distinct == statistics.hull_vertices || statistics.triangles == 0);
    }

    std::size_t launches = 0;
    double kernel_seconds = 0;
    for (const KernelStatistics& kernel : statistics.kernels) {
      EXPECT_FALSE(kernel.name.empty());
      EXPECT_GT(kernel.launches, 0U);
      launches += kernel.launches;
      kernel_seconds += kernel.seconds;
    }
    EXPECT_GT(launches, 0U);
    EXPECT_LE(launches, statistics.kernel_launches);
    EXPECT_GT(kernel_seconds, 0);
    double phase_seconds = 0;
    for (const PhaseStatistics& phase : statistics.phases) phase_seconds += phase.seconds;
    EXPECT_GT(phase_seconds, 0);
    EXPECT_LE(phase_seconds, statistics.seconds + 1e-9) << "but for rounding";
  }
  EXPECT_TRUE(triangulate({0, 0, 1, 0, 0, 1}).statistics.kernels.empty()) << "profile was not asked for";
}

TEST(Statistics, CompilingIsPartOfNoOtherTime) {
  const Coordinates points = make_fixture("uniform", 3000, 2);
  // Each compiles its own kernels.
  Triangulator fresh(testing::device_under_test());
  const double begin = host::now();
  const research::Triangulation result =
      research::triangulate(fresh, points.data(), points.size() / 2, defaults());
  const double passed = host::now() - begin;
  const Statistics& statistics = result.statistics;
  EXPECT_EQ(statistics.build_seconds > 0, statistics.device != "host");
  EXPECT_LE(statistics.seconds + statistics.build_seconds, passed);
  double phases = 0;
  for (const PhaseStatistics& phase : statistics.phases) phases += phase.seconds;
  EXPECT_NEAR(phases, statistics.seconds, 1e-6);
  double levels = 0;
  for (const research::LevelStatistics& level : result.levels) levels += level.seconds;
  EXPECT_LE(levels, statistics.seconds);
}

TEST(Statistics, UndecidedPredicatesAreCounted) {
  EXPECT_EQ(triangulate(io::generate("grid", 1000, 1).coordinates).statistics.undecided, 0U)
      << "small integers are exact in floating point";
  EXPECT_GT(triangulate(io::generate("rotated-grid", 1000, 1).coordinates).statistics.undecided, 0U);
}

TEST(Statistics, ProgressRises) {
  const Coordinates points = io::generate("uniform", 5000, 2).coordinates;
  double last = 0;
  int calls = 0, levels = 0;
  Options options = defaults();
  options.progress = [&](const std::string& stage, int level, double done) {
    EXPECT_FALSE(stage.empty());
    EXPECT_GE(done, last);
    EXPECT_LE(done, 1);
    last = done;
    ++calls;
    levels = std::max(levels, level + 1);
  };
  const research::Triangulation result = triangulate(points, options);
  EXPECT_GT(calls, levels);
  EXPECT_EQ(static_cast<std::size_t>(levels), result.levels.size());
  EXPECT_EQ(last, 1);
}

/// In every mode, and for a partition: from 0 to 1, and never back. Of equal points, which make a large
/// block, too.
TEST(Statistics, ProgressGoesFromBeginningToEnd) {
  Coordinates points = io::generate("uniform", 30000, 2).coordinates;
  points.resize(points.size() + 2 * 10000, 0.5);
  for (const research::ModeInfo& mode : research::list_modes()) {
    SCOPED_TRACE(mode.name);
    std::vector<double> reports;
    Options options;
    options.mode = mode.mode;
    options.partition_levels = 4;
    options.progress = [&](const std::string&, int, double done) { reports.push_back(done); };
    const auto check = [&] {
      ASSERT_GT(reports.size(), 3U);
      EXPECT_EQ(reports.front(), 0);
      EXPECT_EQ(reports.back(), 1);
      EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
      reports.clear();
    };
    research::triangulate(triangulator(), points.data(), points.size() / 2, options);
    check();
    if (mode.mode != Mode::flattened) continue;
    research::partition(triangulator(), points.data(), points.size() / 2, 3, options);
    check();
  }
}

/// In mode blocks, one launch after the other: no step is longer than the solution of some blocks.
TEST(Statistics, ProgressMovesInModeBlocks) {
  const ScopedEnvironment scope("FLAUNAY_TUNING", "cpu,block_workers=2");
  const std::size_t n = 400000;
  const Coordinates points = io::generate("uniform", n, 2).coordinates;
  Triangulator fresh;
  const std::vector<std::int32_t> expected = fresh.triangulate(points.data(), n).triangles;
  double last = 0, longest = 0;
  flaunay::Options options;
  options.progress = [&](const std::string&, int, double done) {
    longest = std::max(longest, done - last);
    last = done;
  };
  EXPECT_EQ(fresh.triangulate(points.data(), n, options).triangles, expected);
  EXPECT_LE(longest, 0.3);
}

/// At most 200 bytes a point of device memory (flattened: 300, with a GPU's sizes: 416), on degenerate input
/// too; each measured with a memory of its own.
TEST(Statistics, DeviceMemory) {
  for (const char* name :
       {"line", "grid", "circle", "star", "columns", "small-integers", "clusters", "apex"}) {
    const Coordinates points = make_fixture(name, 100000, 1);
    Triangulator fresh;
    const Triangulation result = research::triangulate(fresh, points.data(), 100000, defaults());
    const bool has_rounds = result.statistics.rounds > 0 || has_gpu_sizes(fresh);
    const std::size_t most = has_rounds ? 416 : defaults().mode == Mode::flattened ? 300 : 200;
    EXPECT_GT(result.statistics.device_bytes_peak, 0U) << name;
    EXPECT_LE(result.statistics.device_bytes_peak, most * 100000U) << name;
  }
}

/// A repeated call takes no more memory, where kernels work in place and where everything is copied; but for
/// a GPU's buffers, of which the second call may make some that suit it better.
TEST(Statistics, DeviceMemoryStaysWhatItWas) {
  const Coordinates points = io::generate("uniform", 50000, 3).coordinates;
  for (const char* tuning : {"cpu", "gpu"}) {
    Triangulator tuned = make_tuned(tuning);
    const std::size_t bytes =
        research::triangulate(tuned, points.data(), 50000, defaults()).statistics.device_bytes_peak;
    std::size_t largest = 0;
    for (int again = 0; again < 10; ++again) {
      const Triangulation result = research::triangulate(tuned, points.data(), 50000, defaults());
      largest = std::max(largest, result.statistics.device_bytes_peak);
      if (std::string(tuning) == "cpu") {
        ASSERT_EQ(result.statistics.device_bytes_peak, bytes) << "call " << again;
      }
      if (again > 2) {
        ASSERT_EQ(result.statistics.device_allocations, 0u) << tuning << ", call " << again;
      }
    }
    EXPECT_LE(largest, bytes * 11 / 10) << tuning;
  }
}

/// One large block, of points that are all the same, does not make the scratch of thousands of work-items
/// large.
TEST(Statistics, DeviceMemoryWithOneLargeBlock) {
  Sets sets;
  for (int s = 0; s < 3000; ++s) sets.add({0.5, static_cast<double>(s % 3)});
  sets.add(Coordinates(2 * 8192, 0.5));
  Triangulator tuned = make_tuned("gpu");
  const Triangulation result = research::triangulate(tuned, sets.points.data(), sets.offsets, defaults());
  EXPECT_LE(result.statistics.device_bytes_peak, std::size_t{32} << 20);
}

}  // namespace
}  // namespace flaunay::testing
