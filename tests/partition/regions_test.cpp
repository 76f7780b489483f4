// Regions of partitions that are made here, from triangulations: solved, solved otherwise, solved wrongly,
// and put together again.
#include "modes/partition/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/mesh.hpp"
#include "geometry/point_sets.hpp"
#include "modes/dwyer/dwyer.hpp"
#include "prove/delaunay_proof.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing::regions {
namespace {

using research::Partition;
using research::Region;

using Ids = std::vector<std::int32_t>;
using Solutions = std::vector<Ids>;

Triangulation triangulate(const Coordinates& points) {
  research::Options options;
  options.mode = research::Mode::dwyer;
  return research::triangulate_on_host(points.data(), {0, points.size() / 2}, options);
}

std::int32_t next_of(std::int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// Flips every interior edge with probability 1/2 whose two triangles share a circle; several rounds.
void flip_ties(const Coordinates& points, Ids& triangles, FixtureRandom& random, int rounds = 2) {
  for (int round = 0; round < rounds; ++round) {
    const Ids twins = geometry::match_edges(triangles);
    std::set<std::int32_t> touched;
    for (std::int32_t h = 0; h < static_cast<std::int32_t>(triangles.size()); ++h) {
      const std::int32_t twin = twins[h];
      if (twin < h || touched.count(h / 3) || touched.count(twin / 3) || random.integer(0, 1)) continue;
      const std::int32_t a = triangles[h], b = triangles[next_of(h)];
      const std::int32_t c = triangles[next_of(next_of(h))], d = triangles[next_of(next_of(twin))];
      if (reference_incircle(&points[2 * a], &points[2 * b], &points[2 * c], &points[2 * d]) != 0) continue;
      const std::array<std::int32_t, 3> left = {a, d, c}, right = {d, b, c};
      std::copy(left.begin(), left.end(), triangles.begin() + h / 3 * 3);
      std::copy(right.begin(), right.end(), triangles.begin() + twin / 3 * 3);
      touched.insert({h / 3, twin / 3});
    }
  }
}

/// A partition by labels of triangles; label -1: final.
struct LabelledMesh {
  Ids triangles;  // of input points, some Delaunay triangulation
  Ids twins;
  Ids labels;
  std::vector<char> is_border;  // by half-edge
  std::int32_t regions = 0;
};

/// Labels grow from random triangles for `steps` each, over what is there: connected, pinched, with holes, in
/// several parts; some edges within a region become border in both directions.
LabelledMesh random_cut(const Coordinates& points, FixtureRandom& random) {
  LabelledMesh cut;
  cut.triangles = triangulate(points).triangles;
  flip_ties(points, cut.triangles, random);
  cut.twins = geometry::match_edges(cut.triangles);
  const auto count = static_cast<std::int32_t>(cut.triangles.size() / 3);
  cut.labels.assign(count, 0);
  cut.regions = static_cast<std::int32_t>(random.integer(1, 6));
  for (std::int32_t label = 0; label < cut.regions && count > 0; ++label) {
    std::set<std::int32_t> open = {static_cast<std::int32_t>(random.integer(0, count - 1))};
    for (auto steps = random.integer(1, count); steps > 0 && !open.empty(); --steps) {
      auto at = open.begin();
      std::advance(at, random.integer(0, static_cast<std::int64_t>(open.size()) - 1));
      const std::int32_t t = *at;
      open.erase(at);
      cut.labels[t] = label;
      for (std::int32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (cut.twins[h] >= 0 && cut.labels[cut.twins[h] / 3] != label) open.insert(cut.twins[h] / 3);
      }
    }
  }
  for (std::int32_t& label : cut.labels) {
    if (random.integer(0, 9) == 0) label = -1;
  }
  cut.is_border.assign(cut.triangles.size(), 0);
  for (std::size_t h = 0; h < cut.triangles.size(); ++h) {
    const std::int32_t twin = cut.twins[h];
    if (twin < 0 || cut.labels[twin / 3] != cut.labels[h / 3]) {
      cut.is_border[h] = 1;
    } else if (random.integer(0, 9) == 0) {
      cut.is_border[h] = cut.is_border[twin] = 1;
    }
  }
  return cut;
}

Partition partition_of(const LabelledMesh& cut, FixtureRandom& random) {
  Partition partition;
  partition.regions.resize(cut.regions);
  for (std::int32_t label = -1; label < cut.regions; ++label) {
    std::map<std::int32_t, std::int32_t> position;
    Ids points;
    for (std::size_t h = 0; h < cut.triangles.size(); ++h) {
      if (cut.labels[h / 3] != label) continue;
      if (label < 0) {
        partition.triangles.push_back(cut.triangles[h]);
      } else if (position.emplace(cut.triangles[h], 0).second) {
        points.push_back(cut.triangles[h]);
      }
    }
    if (label < 0) continue;
    random.shuffle(points);
    for (std::size_t k = 0; k < points.size(); ++k) position[points[k]] = static_cast<std::int32_t>(k);
    Region& region = partition.regions[label];
    region.points = points;
    for (std::size_t h = 0; h < cut.triangles.size(); ++h) {
      if (cut.labels[h / 3] != label || !cut.is_border[h]) continue;
      region.border.push_back(position[cut.triangles[h]]);
      region.border.push_back(position[cut.triangles[next_of(static_cast<std::int32_t>(h))]]);
    }
  }
  return partition;
}

/// The regions as flat arrays of ids, for solve_regions.
geometry::RegionArrays arrays_of(const LabelledMesh& cut, const geometry::PointSets& sets) {
  Ids id_of(sets.representatives.size(), -1);
  for (std::size_t id = 0; id < sets.source.size(); ++id) id_of[sets.source[id]] = static_cast<int>(id);
  geometry::RegionArrays arrays;
  arrays.point_offsets = arrays.corner_offsets = {0};
  for (std::int32_t label = 0; label < cut.regions; ++label) {
    std::set<std::int32_t> inside, border;
    for (std::size_t h = 0; h < cut.triangles.size(); ++h) {
      if (cut.labels[h / 3] != label) continue;
      inside.insert(id_of[cut.triangles[h]]);
      if (!cut.is_border[h]) continue;
      // The next border edge: clockwise through the region's triangles about the end of this one.
      std::int32_t next = next_of(static_cast<std::int32_t>(h));
      while (!cut.is_border[next]) next = next_of(cut.twins[next]);
      border.insert({id_of[cut.triangles[h]], id_of[cut.triangles[next]]});
      for (const std::int32_t v : {cut.triangles[h], cut.triangles[next], cut.triangles[next_of(next)]}) {
        arrays.corners.push_back(id_of[v]);
      }
    }
    for (const std::int32_t id : inside) {
      if (!border.count(id)) arrays.points.push_back(id);
    }
    arrays.point_offsets.push_back(static_cast<std::int32_t>(arrays.points.size()));
    arrays.corner_offsets.push_back(static_cast<std::int32_t>(arrays.corners.size() / 3));
  }
  return arrays;
}

Coordinates points_of(const Coordinates& points, const Region& region) {
  Coordinates own;
  for (const std::int32_t i : region.points) fixtures_detail::add(own, points[2 * i], points[2 * i + 1]);
  return own;
}

/// Each region's points triangulated, ties at random, rows shuffled and turned over.
Solutions solve(const Coordinates& points, const Partition& partition, FixtureRandom& random) {
  Solutions solutions;
  for (const Region& region : partition.regions) {
    const Coordinates own = points_of(points, region);
    Ids triangles = triangulate(own).triangles;
    flip_ties(own, triangles, random);
    std::vector<std::array<std::int32_t, 3>> rows;
    for (std::size_t k = 0; k < triangles.size(); k += 3) {
      rows.push_back({triangles[k], triangles[k + 1], triangles[k + 2]});
      if (random.integer(0, 1)) std::swap(rows.back()[0], rows.back()[1]);
      if (random.integer(0, 1)) std::rotate(rows.back().begin(), rows.back().begin() + 1, rows.back().end());
    }
    random.shuffle(rows);
    solutions.push_back(flat_triangles(rows));
  }
  return solutions;
}

Triangulation assemble(const Coordinates& points, const Partition& partition, const Solutions& solutions) {
  return research::assemble(points.data(), points.size() / 2, partition, solutions);
}

/// Everything about the result but the order of its rows, which is the mode's own.
void expect_same(const Triangulation& result, const Triangulation& expected) {
  EXPECT_EQ(sorted_triangles(result.triangles), sorted_triangles(expected.triangles));
  EXPECT_EQ(result.neighbors, reference_neighbors(result.triangles));
  EXPECT_EQ(result.hull, expected.hull);
  EXPECT_EQ(result.representatives, expected.representatives);
  EXPECT_EQ(result.statistics.triangles, expected.statistics.triangles);
}

/// Sets where ties bite, and others.
std::vector<Coordinates> small_sets() {
  std::vector<Coordinates> sets;
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {3, 12, 70}) sets.push_back(fixture.make(n, n));
  }
  return sets;
}

TEST(Assemble, RandomPartitions) {
  FixtureRandom random(1);
  for (const Coordinates& points : small_sets()) {
    const Triangulation expected = triangulate(points);
    for (int round = 0; round < 6; ++round) {
      const Partition partition = partition_of(random_cut(points, random), random);
      expect_same(assemble(points, partition, solve(points, partition, random)), expected);
    }
  }
}

TEST(Assemble, LargerPartitions) {
  FixtureRandom random(2);
  for (const char* name :
       {"grid", "integer-circle", "circle", "nested-circles", "uniform", "star", "ladder"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 1500, 1);
    const Partition partition = partition_of(random_cut(points, random), random);
    expect_same(assemble(points, partition, solve(points, partition, random)), triangulate(points));
  }
}

TEST(Assemble, NoRegions) {
  for (const Coordinates& points : {Coordinates{}, Coordinates{1, 2}, Coordinates{0, 0, 1, 1, 2, 2, 1, 1}}) {
    expect_same(assemble(points, {}, {}), triangulate(points));
  }
  const Coordinates triangle = {0, 0, 1, 0, 0, 1};
  Partition partition;
  partition.triangles = {2, 1, 0};
  expect_same(assemble(triangle, partition, {}), triangulate(triangle));
}

/// A duplicate stands for its representative.
TEST(Assemble, Duplicates) {
  const Coordinates points = {0, 0, 2, 0, 0, 0, 0, 2, 2, 2, 1, 1};
  Partition partition;
  partition.regions.resize(1);
  partition.regions[0].points = {2, 1, 4, 3, 5};
  partition.regions[0].border = {0, 1, 1, 2, 2, 3, 3, 0};
  const Solutions solutions = {{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4}};
  expect_same(assemble(points, partition, solutions), triangulate(points));
  partition.regions[0].points.push_back(0);
  EXPECT_THROW(assemble(points, partition, solutions), Error);
}

// ---------------------------------------------------------------------------------------------------------
// Errors.

std::string error_of(const Coordinates& points, const Partition& partition, const Solutions& solutions) {
  try {
    assemble(points, partition, solutions);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    return error.what();
  }
  return "";
}

TEST(Assemble, WrongSolutionsNameTheRegion) {
  // A square with a point in it, not in the middle; region 1 is its upper half.
  const Coordinates points = {0, 0, 4, 0, 4, 4, 0, 4, 2, 1};
  Partition partition;
  partition.regions.resize(2);
  partition.regions[0].points = {0, 1, 4};
  partition.regions[0].border = {0, 1, 1, 2, 2, 0};
  partition.regions[1].points = {0, 1, 2, 3, 4};
  partition.regions[1].border = {1, 2, 2, 3, 3, 0, 0, 4, 4, 1};
  const Ids first = {0, 1, 2};
  const Ids second = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  ASSERT_EQ(error_of(points, partition, {first, second}), "");

  const auto expect_error = [&](const Ids& solution, const std::string& part) {
    const std::string error = error_of(points, partition, {first, solution});
    EXPECT_NE(error.find("region 1: "), std::string::npos) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  expect_error({}, "point 0 is in no triangle");
  expect_error({0, 1, 4, 1}, "multiple of 3");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 5}, "triangle 3 has position 5 of 5");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, -1}, "triangle 3 has position -1");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 3, 4}, "triangle 3 has no area");
  expect_error({0, 1, 2, 0, 2, 3}, "point 4 is in no triangle");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4}, "convex polygon");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 1, 4}, "one side of an edge");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 0, 1, 2}, "one side of an edge");
  expect_error({0, 1, 4, 1, 2, 4, 2, 3, 0, 0, 4, 2}, "is in the circle of triangle");

  EXPECT_NE(error_of(points, partition, {first}).find("1 solutions for 2 regions"), std::string::npos);
  Partition other = partition;
  other.triangles = {0, 1, 4};
  EXPECT_NE(error_of(points, other, {first, second}).find("do not make a whole"), std::string::npos);
  other.triangles = {0, 1, 9};
  EXPECT_NE(error_of(points, other, {first, second}).find("no point 9"), std::string::npos);
  for (const Ids& border : std::vector<Ids>{{1, 2, 2, 3, 3, 0, 0, 4, 4},
                                            {1, 2, 2, 3, 3, 0, 0, 4, 4, 7},
                                            {1, 2, 2, 3, 3, 0, 0, 4, 4, 4},
                                            {1, 2, 2, 3, 3, 0, 0, 4},
                                            {1, 2, 2, 3, 3, 0, 0, 4, 4, 1, 1, 2},
                                            {2, 1, 2, 3, 3, 0, 0, 4, 4, 1},
                                            {1, 3, 2, 3, 3, 0, 0, 4, 4, 1}}) {
    other = partition;
    other.regions[1].border = border;
    EXPECT_NE(error_of(points, other, {first, second}).find("region 1: its border"), std::string::npos);
  }
}

/// One change to a solution or to the partition gives an error, or the right result.
TEST(Assemble, RandomDamage) {
  FixtureRandom random(3);
  int errors = 0;
  for (const Coordinates& points : small_sets()) {
    const Triangulation expected = triangulate(points);
    if (expected.triangles.empty()) continue;
    const Partition whole = partition_of(random_cut(points, random), random);
    const Solutions right = solve(points, whole, random);
    for (int round = 0; round < 30; ++round) {
      Partition partition = whole;
      Solutions solutions = right;
      const std::size_t r =
          static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(right.size()) - 1));
      Region& region = partition.regions[r];
      Ids* const arrays[] = {&solutions[r],  &solutions[r],  &solutions[r],
                             &region.points, &region.border, &partition.triangles};
      Ids& damaged = *arrays[random.integer(0, 5)];
      const std::int64_t size = static_cast<std::int64_t>(damaged.size());
      if (size == 0) continue;
      const auto at = damaged.begin() + random.integer(0, size - 1);
      switch (random.integer(0, 4)) {
        case 0:
          *at = static_cast<std::int32_t>(random.integer(-1, static_cast<std::int64_t>(points.size() / 2)));
          break;
        case 1:
          std::swap(*at, damaged[random.integer(0, size - 1)]);
          break;
        case 2:
          damaged.erase(at);
          break;
        case 3:
          damaged.insert(damaged.end(), damaged.begin(), damaged.begin() + std::min<std::int64_t>(size, 3));
          break;
        default:
          damaged.resize(static_cast<std::size_t>(size / 3) * 2);
      }
      try {
        expect_same(assemble(points, partition, solutions), expected);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        ++errors;
      }
    }
  }
  EXPECT_GT(errors, 1000);
}

// ---------------------------------------------------------------------------------------------------------
// Regions of ids, on threads.

void expect_solved(const Coordinates& points, FixtureRandom& random) {
  const LabelledMesh cut = random_cut(points, random);
  const geometry::PointSets sets = geometry::ingest(points.data(), {0, points.size() / 2});
  const geometry::RegionArrays arrays = arrays_of(cut, sets);
  Ids triangles =
      partition::solve_regions(sets.predicates, sets.points.data(), arrays, dwyer::triangulate, 1);
  for (const int threads : {0, 2, 5}) {
    EXPECT_EQ(
        partition::solve_regions(sets.predicates, sets.points.data(), arrays, dwyer::triangulate, threads),
        triangles);
  }
  Ids id_of(points.size() / 2);
  for (std::size_t id = 0; id < sets.source.size(); ++id) id_of[sets.source[id]] = static_cast<int>(id);
  for (std::size_t k = 0; k < cut.triangles.size(); ++k) {
    if (cut.labels[k / 3] < 0) triangles.push_back(id_of[cut.triangles[k]]);
  }
  expect_same(geometry::finish(sets, triangles, {}, {}), triangulate(points));
}

TEST(SolveRegions, RandomPartitions) {
  FixtureRandom random(4);
  for (const Coordinates& points : small_sets()) {
    for (int round = 0; round < 3; ++round) expect_solved(points, random);
  }
}

TEST(SolveRegions, ManyRegionsOfCocircularPoints) {
  FixtureRandom random(5);
  for (const char* name : {"grid", "integer-circle", "nested-circles"}) {
    SCOPED_TRACE(name);
    expect_solved(make_fixture(name, 2000, 1), random);
  }
}

/// Every triangle of a circle's zigzag is a region of its own, or every other chord is missing.
TEST(RegionTriangles, EveryChordOfACircle) {
  const Coordinates points = make_fixture("integer-circle", 400, 1);
  const geometry::PointSets sets = geometry::ingest(points.data(), {0, points.size() / 2});
  const std::size_t n = sets.points.size();
  geometry::Mesh mesh = dwyer::triangulate(sets.predicates, sets.points.data(), n);
  FixtureRandom random(6);
  Coordinates distinct;
  for (const geometry::Point& p : sets.points) fixtures_detail::add(distinct, p.x, p.y);
  Ids other = mesh.triangles;
  flip_ties(distinct, other, random, 50);
  // All edges of the one as the border, the mesh of the other: both directions of each inner edge.
  std::vector<partition::BorderEdge> border;
  for (std::int32_t h = 0; h < static_cast<std::int32_t>(other.size()); ++h) {
    border.emplace_back(other[h], other[next_of(h)]);
  }
  const Ids triangles =
      partition::region_triangles(sets.predicates, sets.points.data(), n, border, std::move(mesh));
  EXPECT_EQ(sorted_triangles(triangles), sorted_triangles(other));
}

TEST(SolveRegions, FirstFailureIsReported) {
  // Two squares; the corners of both leave an edge out.
  const Coordinates points = {0, 0, 0, 1, 1, 0, 1, 1, 5, 0, 5, 1, 6, 0, 6, 1};
  const geometry::PointSets sets = geometry::ingest(points.data(), {0, 8});
  geometry::RegionArrays arrays;
  arrays.point_offsets = {0, 0, 0, 0};
  arrays.corner_offsets = {0, 4, 7, 10};
  arrays.corners = {1, 0, 2, 0, 2, 3, 2, 3, 1, 3, 1, 0,  // whole
                    5, 4, 6, 4, 6, 7, 6, 7, 5,           //
                    1, 0, 2, 0, 2, 3, 2, 3, 1};
  for (const int threads : {1, 3}) {
    try {
      partition::solve_regions(sets.predicates, sets.points.data(), arrays, dwyer::triangulate, threads);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::internal);
      EXPECT_EQ(std::string(error.what()).find("region 1: its border"), 0U) << error.what();
    }
  }
  EXPECT_TRUE(
      partition::solve_regions(sets.predicates, sets.points.data(), {}, dwyer::triangulate, 2).empty());
}

}  // namespace
}  // namespace flaunay::testing::regions
