// Mode::recursive against the brute-force reference, its hulls against brute-force hulls, and its counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/files/generate.hpp"
#include "geometry/mesh.hpp"
#include "modes/dwyer/dwyer.hpp"
#include "modes/partition/regions.hpp"
#include "modes/recursive/lower_hull.hpp"
#include "modes/recursive/run.hpp"
#include "tests/support/bounds.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing::recursion {
namespace {

using research::Component;
using research::Cut;
using research::Hull;
using research::kComponents;
using research::LevelStatistics;
using research::OperationCounts;
using research::Options;
using research::Triangulation;
using research::Work;
using statistics::Counter;

using recursive::HullPoint;
using recursive::HullPoints;
using recursive::Line;
using recursive::LowerHull;

constexpr Hull kVariants[] = {Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain};
constexpr Cut kCuts[] = {Cut::interquartile, Cut::alternate};

Triangulation triangulate(const Coordinates& points, const std::vector<std::size_t>& offsets,
                          const Options& options) {
  const geometry::PointSets sets = geometry::ingest(points.data(), offsets);
  Triangulation result;
  const auto solve_large = [&](const geometry::RegionArrays& region, research::Work& work) {
    return partition::solve_region(sets.predicates, sets.points.data(), region, 0, dwyer::triangulate, &work);
  };
  std::vector<std::int32_t> triangles = recursive::run(sets, options, solve_large, result);
  static_cast<flaunay::Triangulation&>(result) = geometry::finish(sets, std::move(triangles), {}, options);
  return result;
}

Triangulation triangulate(const Coordinates& points, const Options& options = {}) {
  return triangulate(points, {0, points.size() / 2}, options);
}

Options options_of(Hull hull, Cut cut, bool count = false) {
  Options options;
  options.hull = hull;
  options.cut = cut;
  options.count = count;
  return options;
}

std::string name_of(Hull hull, Cut cut) {
  const char* names[] = {"prune", "quickhull", "balanced", "monotone chain"};
  return std::string(names[static_cast<int>(hull)]) + (cut == Cut::alternate ? ", alternating" : "");
}

void expect_reference(const Coordinates& points) {
  const TriangleSet expected = reference_delaunay(points);
  for (const Cut cut : kCuts) {
    for (const Hull hull : kVariants) {
      const Triangulation result = triangulate(points, options_of(hull, cut));
      EXPECT_EQ(sorted_triangles(result.triangles), expected) << name_of(hull, cut);
    }
  }
}

// -----------------------------------------------------------------------------------------------------------
// Whole triangulations

TEST(Recursive, FewPoints) {
  const Coordinates all{0, 0, 1, 0, 0, 1, 1, 1, 3, 2};
  for (std::size_t n = 0; n <= 5; ++n) {
    SCOPED_TRACE(n);
    expect_reference(Coordinates(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(2 * n)));
  }
}

// Integers of a small square: collinear, cocircular, mirrored, doubled.
TEST(Recursive, SmallIntegers) {
  FixtureRandom random(1);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const std::int64_t reach = random.integer(1, 8);
    Coordinates points;
    for (std::int64_t k = random.integer(0, 40); k > 0; --k) {
      points.push_back(static_cast<double>(random.integer(-reach, reach)));
      points.push_back(static_cast<double>(random.integer(-reach, reach)));
    }
    expect_reference(points);
  }
}

TEST(Recursive, AllFixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {7, 60, 200}) {
      SCOPED_TRACE(fixture.name + " " + std::to_string(n));
      expect_reference(fixture.make(n, n));
    }
  }
}

TEST(Recursive, PerturbedFixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    expect_reference(perturbed(fixture.make(100, 3), 4));
  }
}

TEST(Recursive, VariantsAgreeOnManyPoints) {
  for (const char* name : {"kuzmin", "grid", "line"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 6000, 2);
    const Triangulation expected = triangulate(points);
    for (const Cut cut : kCuts) {
      for (const Hull hull : kVariants) {
        const Triangulation result = triangulate(points, options_of(hull, cut));
        EXPECT_EQ(sorted_triangles(result.triangles), sorted_triangles(expected.triangles))
            << name_of(hull, cut);
      }
    }
  }
}

TEST(Recursive, SeveralSets) {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  TriangleSet expected;
  const char* names[] = {"uniform", "collinear", "grid", "integer-circle", "kuzmin"};
  for (const std::size_t n : {50, 0, 1, 2, 3, 40, 64, 30, 80}) {
    const Coordinates set = make_fixture(names[offsets.size() % 5], n, n);
    for (auto triangle : reference_delaunay(set)) {
      for (std::int32_t& corner : triangle) corner += static_cast<std::int32_t>(offsets.back());
      expected.push_back(triangle);
    }
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(offsets.back() + n);
  }
  for (const Hull hull : kVariants) {
    const Triangulation result = triangulate(points, offsets, options_of(hull, Cut::interquartile));
    EXPECT_EQ(sorted_triangles(result.triangles), sorted_triangles(flat_triangles(expected)));
  }
}

// -----------------------------------------------------------------------------------------------------------
// Hulls

// The strict lower hull, from one vertex to the next: of the points after it, the one below whose chord none
// lies; of several on one chord the last, of several in one column the lowest.
std::vector<std::int32_t> brute_force_hull(const std::vector<HullPoint>& points, const Line& line) {
  const auto is_below = [&](const HullPoint& a, const HullPoint& b, const HullPoint& p) {
    return kernel::hull_depth_sign(a.place, b.place, p.place, line.q, line.planar()) > 0;
  };
  std::vector<std::int32_t> ids;
  const HullPoint *at = nullptr, *next = &points[0];
  for (; next != nullptr; at = next) {
    if (at != nullptr) next = nullptr;
    for (const HullPoint& p : points) {
      if (at != nullptr && !(at->u() < p.u())) continue;
      if (next == nullptr || (p.u() == next->u()  ? line.is_lower(p, *next)
                              : at == nullptr     ? p.u() < next->u()
                              : p.u() < next->u() ? is_below(*at, *next, p)
                                                  : !is_below(*at, p, *next)))
        next = &p;
    }
    if (next != nullptr) ids.push_back(next->id);
  }
  return ids;
}

// Takes some points, both ends among them, as a border in any order, and each of these twice.
HullPoints hull_points(std::vector<HullPoint> points, const Line& line, FixtureRandom& random) {
  const auto before = [&](const HullPoint& a, const HullPoint& b) {
    return a.u() != b.u() ? a.u() < b.u() : line.is_lower(a, b);
  };
  std::sort(points.begin(), points.end(), before);
  HullPoints result{line, points.front(), points.back(), {}, {}};
  for (const HullPoint& p : points) {
    if (p.u() == points.back().u() && line.is_lower(p, result.last)) result.last = p;
  }
  for (const HullPoint& p : points) {
    const bool is_end = p.u() == result.first.u() || p.u() == result.last.u();
    if (is_end || random.integer(0, 3) == 0) {
      result.corners.insert(result.corners.end(), 2, p);
    } else {
      result.internal.push_back(p);
    }
  }
  random.shuffle(result.corners);
  if (random.integer(0, 1) == 0) std::reverse(result.internal.begin(), result.internal.end());
  return result;
}

void expect_hulls(const std::vector<HullPoint>& points, const Line& line, const geometry::Bounds& bounds,
                  FixtureRandom& random) {
  const HullPoints task = hull_points(points, line, random);
  if (task.first.u() == task.last.u()) return;
  const std::vector<std::int32_t> expected = brute_force_hull(points, line);
  for (const Hull variant : kVariants) {
    Counter counter;
    LevelStatistics statistics;
    const geometry::Predicates predicates{bounds};
    const LowerHull hull = lower_hull(predicates, task, variant, counter, statistics);
    std::vector<std::int32_t> ids;
    for (const HullPoint& p : hull.path) ids.push_back(p.id);
    EXPECT_EQ(ids, expected) << name_of(variant, Cut::interquartile);
    for (std::size_t i = 0; i < task.corners.size(); ++i) {
      const bool on = std::count(expected.begin(), expected.end(), task.corners[i].id) > 0;
      EXPECT_FALSE(on && hull.corners[i] == recursive::Kept::no);
    }
  }
}

std::vector<HullPoint> placed(const geometry::PointSets& sets, const Line& line) {
  std::vector<HullPoint> points;
  for (std::size_t id = 0; id < sets.points.size(); ++id) {
    points.push_back(line.at(static_cast<std::int32_t>(id), line.place(sets.points[id])));
  }
  return points;
}

void expect_hulls(const Coordinates& coordinates, FixtureRandom& random) {
  const geometry::PointSets sets = geometry::ingest(coordinates.data(), {0, coordinates.size() / 2});
  if (sets.points.size() < 2) return;
  for (const int axis :
       {kernel::AXIS_X, kernel::AXIS_Y, kernel::AXIS_PLANAR_LOWER, kernel::AXIS_PLANAR_UPPER}) {
    SCOPED_TRACE(axis);
    const std::size_t median = sets.points.size() / 2;
    const Line line{axis, Line{axis, 0}.place(sets.points[median]).x};
    expect_hulls(placed(sets, line), line, sets.predicates.bounds, random);
  }
}

TEST(RecursiveHull, SmallIntegers) {
  FixtureRandom random(2);
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const std::int64_t reach = random.integer(1, 6);
    Coordinates points;
    for (std::int64_t k = random.integer(2, 50); k > 0; --k) {
      points.push_back(static_cast<double>(random.integer(-reach, reach)));
      points.push_back(static_cast<double>(random.integer(-2 * reach, 2 * reach)));
    }
    expect_hulls(points, random);
  }
}

TEST(RecursiveHull, Fixtures) {
  FixtureRandom random(3);
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    expect_hulls(fixture.make(120, 5), random);
    expect_hulls(perturbed(fixture.make(60, 6), 7), random);
  }
}

// Points in pairs of mirror images, of which the one with the smaller s is the vertex; all of them on the
// line; all of them on a circle about a point of the line, whose projections are straight.
TEST(RecursiveHull, TiesInTheProjection) {
  FixtureRandom random(4);
  const Line line{kernel::AXIS_X, 0};
  std::vector<HullPoint> mirrored, on_line, on_circle;
  for (int k = 0; k < 40; ++k) {
    const double s = static_cast<double>(random.integer(0, 9)), u = static_cast<double>(2 * k + k % 2);
    mirrored.push_back(line.at(2 * k, {s, u}));
    if (s != 0) mirrored.push_back(line.at(2 * k + 1, {-s, u}));
    on_line.push_back(line.at(k, {0, u}));
  }
  const double legs[][2] = {{63, 16}, {60, 25}, {56, 33}, {52, 39}, {39, 52}, {33, 56}, {25, 60}, {16, 63}};
  for (const auto& leg : legs) {
    for (const double s : {leg[0], -leg[0]}) {
      for (const double u : {leg[1], -leg[1]}) {
        on_circle.push_back(line.at(static_cast<std::int32_t>(on_circle.size()), {s, u}));
      }
    }
  }
  for (const auto& points : {mirrored, on_line, on_circle}) {
    for (const geometry::Bounds& bounds : {geometry::Bounds{}, usual_bounds()}) {
      expect_hulls(points, line, bounds, random);
    }
  }
}

// Doubling steps: the deepest point is next to an end each time, so that quickhull alone would take a round
// for each point, and quadratic work with more exponents than a double has.
TEST(RecursiveHull, BalanceEndsBadRounds) {
  std::vector<HullPoint> points;
  const Line line{kernel::AXIS_PLANAR_LOWER, 0};
  for (int i = 0; i < 400; ++i) {
    const double u = std::ldexp(1.0 + i % 2 * 0.5, i / 2 - 100);
    points.push_back(line.at(i, {u * u, u}));
  }
  FixtureRandom random(5);
  const HullPoints task = hull_points(points, line, random);
  const geometry::Predicates predicates{usual_bounds()};
  for (const Hull variant : {Hull::quickhull, Hull::balanced}) {
    Counter counter;
    LevelStatistics statistics;
    const LowerHull hull = lower_hull(predicates, task, variant, counter, statistics);
    EXPECT_EQ(hull.path.size(), points.size());
    EXPECT_LT(statistics.hull_rounds, variant == Hull::balanced ? 40 : 100);
  }
}

// -----------------------------------------------------------------------------------------------------------
// Counts

std::uint64_t operations(const Work& work, Component component) {
  const auto k = static_cast<std::size_t>(component);
  std::uint64_t sum = work.start[k].operations();
  for (const Work::Components& level : work.levels) sum += level[k].operations();
  return sum;
}

TEST(RecursiveCounts, NoneUnlessAskedFor) {
  const Triangulation result = triangulate(make_fixture("uniform", 100, 1));
  EXPECT_TRUE(result.work.levels.empty());
  EXPECT_TRUE(result.work.endgame_sizes.empty());
  EXPECT_FALSE(result.levels.empty());
}

void expect_equal(const OperationCounts& a, const OperationCounts& b) {
  EXPECT_EQ(a.arithmetic, b.arithmetic);
  EXPECT_EQ(a.depths, b.depths);
  EXPECT_EQ(a.orientations, b.orientations);
  EXPECT_EQ(a.circles, b.circles);
  EXPECT_EQ(a.critical_path, b.critical_path);
}

TEST(RecursiveCounts, AreRepeatableAndAdditive) {
  const Coordinates one = make_fixture("uniform", 700, 1);
  Coordinates two = one;
  two.insert(two.end(), one.begin(), one.end());
  for (const Hull hull : kVariants) {
    SCOPED_TRACE(name_of(hull, Cut::interquartile));
    const Options options = options_of(hull, Cut::interquartile, true);
    const Triangulation first = triangulate(one, options), again = triangulate(one, options);
    const Triangulation both = triangulate(two, {0, 700, 1400}, options);
    const Work &a = first.work, &b = both.work;
    ASSERT_EQ(a.levels.size(), first.levels.size());
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (std::size_t l = 0; l < a.levels.size(); ++l) {
      for (std::size_t k = 0; k < kComponents; ++k) {
        expect_equal(a.levels[l][k], again.work.levels[l][k]);
        OperationCounts sum = a.levels[l][k];
        statistics::add_beside(sum, a.levels[l][k]);
        expect_equal(sum, b.levels[l][k]);
      }
      EXPECT_EQ(2 * first.levels[l].survivors, both.levels[l].survivors);
      EXPECT_EQ(first.levels[l].hull_rounds, both.levels[l].hull_rounds);
    }
    ASSERT_EQ(a.endgame_sizes.size(), b.endgame_sizes.size());
    for (std::size_t k = 0; k < a.endgame_sizes.size(); ++k) {
      EXPECT_EQ(2 * a.endgame_sizes[k], b.endgame_sizes[k]);
    }
  }
}

// By hand: one internal point in a square, cut by both of its sides in one path.
TEST(RecursiveCounts, OfOneInternalPoint) {
  const Coordinates points{0, 0, 8, 0, 8, 9, 0, 9, 3, 4};
  const Triangulation result = triangulate(points, options_of(Hull::monotone_chain, Cut::alternate, true));
  EXPECT_EQ(result.triangles.size(), 12U);
  ASSERT_EQ(result.levels.size(), 1U);
  EXPECT_EQ(result.levels[0].regions, 1U);
  EXPECT_EQ(result.levels[0].internal_points, 1U);
  EXPECT_EQ(result.levels[0].corners, 4U);
  EXPECT_EQ(result.levels[0].path_vertices, 3U);
  const Work::Components& work = result.work.levels[0];
  EXPECT_EQ(work[static_cast<std::size_t>(Component::cut)].operations(), 0U);
  EXPECT_EQ(work[static_cast<std::size_t>(Component::split)].operations(), 0U);
  // A region of three corners left of the path, one of five right of it.
  const std::vector<std::uint64_t> sizes{0, 0, 0, 1, 0, 1};
  EXPECT_EQ(result.work.endgame_sizes, sizes);
}

TEST(RecursiveCounts, PruneSavesOnKuzmin) {
  const Coordinates points = make_fixture("kuzmin", 20000, 1);
  for (const Cut cut : kCuts) {
    const Work pruned = triangulate(points, options_of(Hull::prune, cut, true)).work;
    const Work all = triangulate(points, options_of(Hull::quickhull, cut, true)).work;
    EXPECT_LT(operations(pruned, Component::hull), operations(all, Component::hull));
    EXPECT_EQ(operations(pruned, Component::split), operations(all, Component::split));
    EXPECT_EQ(operations(pruned, Component::endgame), operations(all, Component::endgame));
  }
}

}  // namespace
}  // namespace flaunay::testing::recursion
