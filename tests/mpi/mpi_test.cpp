// Triangulations over ranks against single calls: the same triangles with the same neighbours, the same hull
// and representatives, whatever the ranks and however points are spread over them. Run by mpirun;
// communicators of fewer ranks are made here. Rank 0 compares.
#include "flaunay/mpi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "large/chunks/tree.hpp"
#include "large/mpi/ranks.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/stalling.hpp"

static int duplicated = 0;

// In place of MPI's, which it calls: that of its profiling interface.
extern "C" int MPI_Comm_dup(MPI_Comm given, MPI_Comm* made) {
  ++duplicated;
  return PMPI_Comm_dup(given, made);
}

namespace flaunay::mpi {
namespace {

using testing::Coordinates;
using testing::make_fixture;
using Row = std::array<std::int64_t, 3>;

int world_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int world_size() {
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

Triangulator& triangulator() {
  static Triangulator only("host");
  return only;
}

/// The first ranks of all; MPI_COMM_NULL on others. Made once: it takes many messages.
MPI_Comm first_ranks(int count) {
  static std::map<int, MPI_Comm> made;
  const auto [at, is_new] = made.emplace(count, MPI_COMM_NULL);
  if (is_new) MPI_Comm_split(MPI_COMM_WORLD, world_rank() < count ? 0 : MPI_UNDEFINED, 0, &at->second);
  return at->second;
}

/// How many points each rank gives.
using Spread = std::function<std::size_t(std::size_t n, int rank, int size)>;

std::size_t evenly(std::size_t n, int rank, int size) {
  const auto r = static_cast<std::size_t>(rank), k = static_cast<std::size_t>(size);
  return n * (r + 1) / k - n * r / k;
}
std::size_t all_on_first(std::size_t n, int rank, int) { return rank == 0 ? n : 0; }
std::size_t all_on_last(std::size_t n, int rank, int size) { return rank == size - 1 ? n : 0; }
std::size_t on_every_other(std::size_t n, int rank, int size) {
  return rank % 2 == 0 ? evenly(n, rank / 2, (size + 1) / 2) : 0;
}

const std::vector<std::pair<std::string, Spread>>& spreads() {
  static const std::vector<std::pair<std::string, Spread>> all = {{"evenly", evenly},
                                                                  {"all on the first rank", all_on_first},
                                                                  {"all on the last rank", all_on_last},
                                                                  {"on every other rank", on_every_other}};
  return all;
}

/// The results of all ranks, on rank 0.
Triangulation gathered(MPI_Comm communicator, const Triangulation& own) {
  Triangulation all;
  Ranks ranks(communicator);
  all.triangles = ranks.gather(own.triangles);
  all.neighbors = ranks.gather(own.neighbors);
  all.areas = ranks.gather(own.areas);
  all.hull = ranks.gather(own.hull);
  all.representatives = ranks.gather(own.representatives);
  all.statistics = own.statistics;
  return all;
}

/// Each triangle with its neighbours as triangles, sorted: what does not depend on the order of rows.
template <typename Index>
std::vector<std::array<Row, 4>> sorted_rows(const std::vector<Index>& triangles,
                                            const std::vector<Index>& neighbors) {
  const auto row = [&](std::size_t t) {
    return Row{triangles.at(3 * t), triangles.at(3 * t + 1), triangles.at(3 * t + 2)};
  };
  std::vector<std::array<Row, 4>> rows;
  for (std::size_t t = 0; 3 * t < triangles.size(); ++t) {
    std::array<Row, 4> all{row(t)};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = neighbors.at(3 * t + k);
      all[k + 1] = other < 0 ? Row{other, other, other} : row(static_cast<std::size_t>(other));
    }
    rows.push_back(all);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Each triangle with its area, sorted.
template <typename Index>
std::vector<std::pair<Row, double>> sorted_areas(const std::vector<Index>& triangles,
                                                 const std::vector<double>& areas) {
  std::vector<std::pair<Row, double>> rows;
  for (std::size_t t = 0; t < areas.size(); ++t) {
    rows.push_back({{triangles.at(3 * t), triangles.at(3 * t + 1), triangles.at(3 * t + 2)}, areas[t]});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

std::vector<std::int64_t> wide(const std::vector<std::int32_t>& values) {
  return {values.begin(), values.end()};
}

Options with_rounds_of(std::size_t points) {
  Options options;
  options.round_points = points;
  return options;
}

/// On the ranks of the communicator. The statistics are those of this rank.
Statistics compare_on(MPI_Comm communicator, const Coordinates& points, const Spread& spread,
                      Options options) {
  options.areas = true;
  int size = 0, rank = 0;
  MPI_Comm_size(communicator, &size);
  MPI_Comm_rank(communicator, &rank);
  const std::size_t n = points.size() / 2;
  std::size_t first = 0;
  for (int r = 0; r < rank; ++r) first += spread(n, r, size);
  const std::size_t own = spread(n, rank, size);
  const Triangulation result =
      triangulate(communicator, triangulator(), own > 0 ? points.data() + 2 * first : nullptr, own, options);
  EXPECT_EQ(result.first_point, static_cast<std::int64_t>(first));
  EXPECT_EQ(result.representatives.size(), own);
  EXPECT_EQ(result.neighbors.size(), options.neighbors ? result.triangles.size() : 0);
  std::int64_t rows = static_cast<std::int64_t>(result.triangles.size() / 3), rows_before = 0;
  MPI_Exscan(&rows, &rows_before, 1, MPI_INT64_T, MPI_SUM, communicator);
  EXPECT_EQ(result.first_row, rank == 0 ? 0 : rows_before);
  EXPECT_TRUE(rank == 0 || result.hull.empty());
  const Triangulation all = gathered(communicator, result);
  if (rank != 0) return result.statistics;
  flaunay::Options with_areas;
  with_areas.areas = true;
  const flaunay::Triangulation expected = triangulator().triangulate(points.data(), n, with_areas);
  EXPECT_EQ(all.triangles.size(), expected.triangles.size());
  EXPECT_EQ(all.areas.size(), expected.areas.size());
  EXPECT_TRUE(sorted_areas(all.triangles, all.areas) == sorted_areas(expected.triangles, expected.areas));
  if (options.neighbors && all.triangles.size() == expected.triangles.size()) {
    EXPECT_TRUE(sorted_rows(all.triangles, all.neighbors) ==
                sorted_rows(expected.triangles, expected.neighbors));
  }
  EXPECT_EQ(all.hull, wide(expected.hull));
  EXPECT_EQ(all.representatives, wide(expected.representatives));
  const Statistics& statistics = result.statistics;
  EXPECT_EQ(statistics.points, n);
  EXPECT_EQ(statistics.duplicates, expected.statistics.duplicates);
  EXPECT_EQ(3 * statistics.triangles, expected.triangles.size());
  EXPECT_EQ(statistics.hull_vertices, expected.hull.size());
  return statistics;
}

/// On the first `ranks` ranks.
Statistics compare(int ranks, const Coordinates& points, const Spread& spread = evenly,
                   const Options& options = {}) {
  const MPI_Comm first = first_ranks(ranks);
  return first != MPI_COMM_NULL ? compare_on(first, points, spread, options) : Statistics();
}

/// Numbers of ranks in turn, from 1 to all. Not everything is tested with all: where other programs use the
/// cores, ranks wait for those at each message, milliseconds long, as they let them go first.
int next_ranks() {
  static int last = 0;
  return last = last % world_size() + 1;
}

TEST(Ranks, OfFixtures) {
  constexpr std::size_t kSizes[] = {150, 1, 700, 2, 150, 3, 700, 7};
  std::size_t next = 0;
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const std::size_t n = kSizes[next++ % std::size(kSizes)];
    if (n < 700) {
      compare(next_ranks(), fixture.make(n, n), evenly, with_rounds_of(10));
    } else {
      compare(next_ranks(), testing::perturbed(fixture.make(n, 2), 3));
    }
  }
}

TEST(Ranks, OfNoPoints) {
  for (int ranks = 1; ranks <= world_size(); ++ranks) compare(ranks, {});
}

TEST(Ranks, WithPointsHoweverSpread) {
  for (const auto& [name, spread] : spreads()) {
    SCOPED_TRACE(name);
    for (const char* const fixture : {"uniform", "kuzmin", "grid"})
      compare(next_ranks(), make_fixture(fixture, 1000, 1), spread, with_rounds_of(30));
  }
}

TEST(Ranks, OfPointsThatStall) {
  for (const auto& [name, points] : testing::stalling(1000, 1)) {
    SCOPED_TRACE(name);
    compare(next_ranks(), points, evenly, with_rounds_of(50));
  }
}

TEST(Ranks, AreFewerFromRoundToRound) {
  const Statistics statistics =
      compare(world_size(), make_fixture("uniform", 20000, 3), evenly, with_rounds_of(400));
  if (world_size() < 7) GTEST_SKIP() << "on fewer than 7 ranks";
  ASSERT_GE(statistics.rounds.size(), 3u);
  EXPECT_EQ(statistics.rounds.front().ranks, 7u);
  EXPECT_LT(statistics.rounds[1].ranks, 7u);
  EXPECT_GT(statistics.rounds[1].ranks, 1u);
  EXPECT_EQ(statistics.rounds.back().ranks, 1u);
  for (std::size_t r = 1; r < statistics.rounds.size(); ++r)
    EXPECT_EQ(statistics.rounds[r].points, statistics.rounds[r - 1].handed_on);
}

TEST(Ranks, HaveAboutAsManyPointsEach) {
  const char* const fixtures[] = {"uniform", "kuzmin", "line"};
  for (int ranks = 2; ranks <= world_size(); ++ranks) {
    const char* const fixture = fixtures[ranks % 3];
    SCOPED_TRACE(fixture);
    const MPI_Comm first = first_ranks(ranks);
    if (first == MPI_COMM_NULL) continue;
    const Statistics statistics = compare_on(first, make_fixture(fixture, 40000, 1), all_on_last, {});
    EXPECT_LT(static_cast<double>(statistics.rounds.front().most), 1.25 * 40000 / ranks);
  }
}

TEST(Ranks, WithEqualPointsOnAll) {
  Coordinates points;
  const Coordinates few = make_fixture("uniform", 200, 5);
  for (int copy = 0; copy < 7; ++copy) points.insert(points.end(), few.begin(), few.end());
  Coordinates signed_zeros;
  for (int k = 0; k < 500; ++k) {
    signed_zeros.insert(signed_zeros.end(), {k % 2 == 0 ? 0.0 : -0.0, 0.25});
    signed_zeros.insert(signed_zeros.end(), {few[2 * (k % 90)], few[2 * (k % 90) + 1]});
  }
  for (const auto& [name, spread] : spreads()) {
    SCOPED_TRACE(name);
    for (const Coordinates& set : {points, signed_zeros, Coordinates(2 * 600, 0.5)})
      compare(next_ranks(), set, spread, with_rounds_of(20));
  }
}

/// What the library keeps with a communicator is made once, ends with it, and no copy has it.
TEST(Ranks, OfCommunicatorsThatEnd) {
  for (int time = 0; time < 2; ++time) {
    MPI_Comm copy = MPI_COMM_NULL;
    duplicated = 0;
    MPI_Comm_dup(MPI_COMM_WORLD, &copy);
    for (const std::size_t n : {50, 60}) compare_on(copy, make_fixture("uniform", n, 1), evenly, {});
    EXPECT_EQ(duplicated, 2);  // with the copy itself
    EXPECT_EQ(MPI_Comm_free(&copy), MPI_SUCCESS);
  }
}

TEST(Ranks, WithoutNeighbours) {
  Options options;
  options.neighbors = false;
  compare(world_size(), make_fixture("uniform", 2000, 1), evenly, options);
}

TEST(Ranks, SendEachPointOnce) {
  const std::size_t n = 200000;
  const Coordinates points = make_fixture("uniform", n, 1);
  for (int ranks = 2; ranks <= world_size(); ranks += 5) {
    const MPI_Comm first = first_ranks(ranks);
    if (first == MPI_COMM_NULL) continue;
    const Statistics statistics = compare_on(first, points, evenly, {});
    const double own_bytes = 16.0 * static_cast<double>(n) / ranks;
    EXPECT_LT(static_cast<double>(statistics.bytes_sent), 1.2 * own_bytes) << ranks << " ranks";
  }
}

/// Rows do not depend on how the points are spread.
TEST(Ranks, HaveTheSameRowsFromAnySpread) {
  const Coordinates points = make_fixture("kuzmin", 5000, 4);
  Triangulation once;
  for (const auto& [name, spread] : spreads()) {
    SCOPED_TRACE(name);
    std::size_t first = 0;
    for (int r = 0; r < world_rank(); ++r) first += spread(5000, r, world_size());
    const Triangulation result = triangulate(MPI_COMM_WORLD, triangulator(), points.data() + 2 * first,
                                             spread(5000, world_rank(), world_size()), with_rounds_of(300));
    if (once.triangles.empty()) once = result;
    EXPECT_EQ(result.triangles, once.triangles);
    EXPECT_EQ(result.neighbors, once.neighbors);
    EXPECT_EQ(result.first_row, once.first_row);
  }
}

/// All ranks throw the same error, and messages before and after work.
void expect_error(Coordinates own, const std::string& text, ErrorKind kind, const Options& options = {},
                  bool is_solver_given = true) {
  try {
    if (is_solver_given) {
      triangulate(MPI_COMM_WORLD, triangulator(), own.data(), own.size() / 2, options);
    } else {
      triangulate(MPI_COMM_WORLD, own.data(), own.size() / 2, options);
    }
    ADD_FAILURE() << "no error; expected " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos)
        << error.what() << "\nexpected " << text;
  }
}

TEST(Ranks, EndWithOneError) {
  if (world_size() < 3) GTEST_SKIP() << "on fewer than 3 ranks";
  const Coordinates fine = make_fixture("uniform", 100, 1);
  Coordinates bad = fine;
  if (world_rank() == 2) bad[2 * 50 + 1] = NAN;
  expect_error(bad, "rank 2: point 250 is not finite: (", ErrorKind::input);
  bad = fine;
  if (world_rank() == 2) bad[2 * 7] = 0x1p1000;
  if (world_rank() == 1) bad[2 * 3 + 1] = 0x1p-1000;
  expect_error(bad, "point 207 has x = 1.07", ErrorKind::input);
  expect_error(bad, "point 103 has y = 9.33", ErrorKind::input);
  Options options;
  options.device = world_rank() == 1 ? "no such device" : "host";
  expect_error(fine, "rank 1: ", ErrorKind::device, options, false);
  options.device = "host,no such device";
  expect_error(fine, "rank 1: ", ErrorKind::device, options, false);
  compare(world_size(), fine);
}

TEST(Trees, HaveAnyNumberOfLeaves) {
  if (world_rank() != 0) GTEST_SKIP() << "rank 0 tests it alone";
  const Coordinates points = make_fixture("kuzmin", 20000, 1);
  std::vector<kernel::double2> samples;
  for (std::size_t i = 0; i < points.size(); i += 2) samples.push_back({points[i], points[i + 1]});
  for (std::size_t leaves = 1; leaves <= 20; ++leaves) {
    for (const chunks::Cuts cuts : {chunks::Cuts::at_medians, chunks::Cuts::in_gaps}) {
      SCOPED_TRACE(leaves);
      const auto tree = chunks::ChunkTree::of_leaves(samples, leaves, cuts);
      const chunks::ChunkTree copy(leaves, tree.nodes());
      std::vector<std::size_t> of_point(samples.size()), of_copy(samples.size()), counts(leaves, 0);
      tree.find_leaves(points.data(), samples.size(), of_point.data());
      copy.find_leaves(points.data(), samples.size(), of_copy.data());
      EXPECT_EQ(of_point, of_copy);
      bool all_inside = true;
      for (std::size_t i = 0; i < samples.size(); ++i) {
        ++counts.at(of_point[i]);
        const kernel::vertex_box box = tree.rectangle(of_point[i], chunks::whole_plane());
        const kernel::double2 p = samples[i];
        all_inside &= box.low.x <= p.x && p.x <= box.high.x && box.low.y <= p.y && p.y <= box.high.y;
      }
      EXPECT_TRUE(all_inside);
      const double most = cuts == chunks::Cuts::at_medians ? 1.01 : 1.5;
      EXPECT_LT(static_cast<double>(*std::max_element(counts.begin(), counts.end())),
                most * 20000 / leaves + 1);
    }
  }
}

}  // namespace
}  // namespace flaunay::mpi

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  ::testing::InitGoogleTest(&argc, argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // The others print failures alone.
  if (rank != 0) ::testing::FLAGS_gtest_brief = true;
  const int failed = RUN_ALL_TESTS();
  int any_failed = 0;
  MPI_Allreduce(&failed, &any_failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return any_failed;
}
