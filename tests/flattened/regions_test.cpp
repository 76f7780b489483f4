// Regions that are solved as blocks, against the host's way with the regions of a partition; and the search
// for twins across borders.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "modes/flattened/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "call/modes.hpp"
#include "modes/dwyer/dwyer.hpp"
#include "modes/flattened/levels.hpp"
#include "modes/partition/regions.hpp"
#include "tests/flattened/support.hpp"
#include "tests/support/neighbors_twin.hpp"

namespace flaunay::flattened {
namespace {

using Row = std::array<cl_int, 3>;

std::vector<Row> sorted_rows(const std::vector<cl_int>& triangles) {
  std::vector<Row> rows;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    Row row{triangles[t], triangles[t + 1], triangles[t + 2]};
    std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
    rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<cl_int> slice(const std::vector<cl_int>& values, std::size_t first, std::size_t last) {
  return {values.begin() + static_cast<std::ptrdiff_t>(first),
          values.begin() + static_cast<std::ptrdiff_t>(last)};
}

}  // namespace

void check_regions(Runtime& runtime, const Coordinates& coordinates, int levels, bool has_ties,
                   MetRegions& met) {
  Call call(runtime);
  Workspace& work = call.work;
  std::vector<std::int32_t> representatives(coordinates.size() / 2);
  PointTable table = ingest(work, coordinates.data(), {0, coordinates.size() / 2}, representatives.data());
  Arena even(runtime.memory()), odd(runtime.memory());
  const research::Options options;
  Recursion recursion(work, table, options, {&even, &odd}, 1);
  std::vector<std::int32_t> in_host_memory;
  const Borders borders = recursion.begin(in_host_memory);
  recursion.flattened(levels);
  const RegionArrays regions = recursion.read_regions();
  const PointSets sets = to_host(work, table, representatives);
  met.regions += regions.size();
  met.retired += recursion.done();

  const std::size_t count = borders.triangles;
  const auto twins = work.scratch().allocate<cl_int>(3 * count);
  runtime.fill(twins, 3 * count, cl_int{-1});
  const std::size_t done = recursion.done();
  const SolvedRegions solved = solve_regions(work, table, recursion.level(), recursion.other_arena(),
                                             call::block_solver(), recursion.triangles(), done, twins);
  ASSERT_EQ(call.broken(), 0);
  ASSERT_EQ(done + solved.triangles, count);
  const std::vector<cl_int> all = call.read(recursion.triangles(), 3 * count);
  const std::vector<cl_int> rows = slice(all, 3 * done, 3 * count);

  // Inside of the borders are as many triangles as the twin finds there, and the same where there is no
  // choice.
  const std::vector<std::int32_t> expected =
      partition::solve_regions(sets.predicates, sets.points.data(), regions, dwyer::triangulate, 1);
  EXPECT_EQ(rows.size(), expected.size());
  if (!has_ties) {
    EXPECT_EQ(sorted_rows(rows), sorted_rows(expected));
  }

  // Twins are known wherever both half-edges are in one region. A border parts every two regions.
  std::vector<cl_int> within = testing::twins_twin(all);
  const std::vector<cl_int> complete = within;
  std::set<std::pair<cl_int, cl_int>> border;
  std::set<cl_int> vertices;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    vertices.clear();
    for (std::int32_t c = regions.corner_offsets[r]; c < regions.corner_offsets[r + 1]; ++c) {
      border.insert({regions.corners[3 * c + 1], regions.corners[3 * c + 2]});
      met.several_corners += !vertices.insert(regions.corners[3 * c + 1]).second;
    }
  }
  const auto ends = [&](std::size_t h) { return std::pair(all[h], all[h % 3 == 2 ? h - 2 : h + 1]); };
  for (std::size_t h = 0; h < within.size(); ++h) {
    if (h < 3 * done || border.count(ends(h)) != 0) within[h] = -1;
  }
  EXPECT_TRUE(same(call.read(twins, 3 * count), within));

  // The others are found, and whether a circle passes through the apexes beside one of them.
  bool is_cocircular = false;
  const auto at = [&](cl_int h) { return sets.points[all[h]]; };
  for (std::size_t k = 0; k < within.size(); ++k) {
    const auto h = static_cast<cl_int>(k);
    const cl_int twin = complete[k];
    if (within[k] >= 0 || twin < 0) continue;
    const auto next = [](cl_int e) { return e % 3 == 2 ? e - 2 : e + 1; };
    is_cocircular = is_cocircular ||
                    sets.predicates.circle(at(h), at(next(h)), at(next(next(h))), at(next(next(twin)))) == 0;
  }
  met.cocircular_borders += is_cocircular;
  EXPECT_EQ(match_loose_edges(work, table, recursion.triangles(), count, twins), is_cocircular);
  EXPECT_TRUE(same(call.read(twins, 3 * count), complete));
  EXPECT_EQ(call.broken(), 0);
}

namespace {

const std::vector<std::string> kWithoutTies{"uniform", "kuzmin", "line", "normal", "clusters"};
const std::vector<std::string> kWithTies{"grid",     "integer-circle", "circle",         "columns",
                                         "parabola", "thirty-lines",   "small-integers", "hexagonal"};

void check_all(Runtime& runtime, const std::vector<std::size_t>& sizes, MetRegions& met) {
  for (const bool has_ties : {false, true}) {
    for (const std::string& name : has_ties ? kWithTies : kWithoutTies) {
      for (const std::size_t n : sizes) {
        for (const int levels : {0, 1, 2, 4, 7}) {
          SCOPED_TRACE(name + ", " + std::to_string(n) + " points, " + std::to_string(levels) + " levels");
          check_regions(runtime, make_fixture(name, n, n), levels, has_ties, met);
          if (::testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST(SmallRegions, AreSolvedAsByTheTwin) {
  MetRegions met;
  check_regions(Runtimes::get(true), make_fixture("uniform", 40, 1), 2, false, met);
  for (const char* const name : {"grid", "columns", "nested-circles", "small-integers"}) {
    check_regions(Runtimes::get(true), make_fixture(name, 60, 1), 3, true, met);
  }
  EXPECT_GT(met.regions, 4u);
  EXPECT_GT(met.cocircular_borders, 0u);
}

TEST(Regions, AreSolvedAsByTheTwin) {
  under_each_tuning([](Runtime& runtime) {
    MetRegions met;
    check_all(runtime, {3, 10, 60, 500}, met);
    EXPECT_GT(met.regions, 500u);
    EXPECT_GT(met.retired, 100u);
    EXPECT_GT(met.cocircular_borders, 10u);
    EXPECT_GT(met.several_corners, 10u);
  });
}

}  // namespace
}  // namespace flaunay::flattened
