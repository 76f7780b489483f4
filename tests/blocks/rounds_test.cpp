// Rounds of blocks: the same bytes as merging.
#include "blocks/rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "launchers/blocks/rounds.cl.hpp"
#include "statistics/phases.hpp"
#include "tests/blocks/support.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/stalling.hpp"
#include "tests/support/test_kernels.hpp"

namespace flaunay::blocks {
namespace {

using testing::stalling;

/// With round_points as the tuning has them; 0: merged.
Triangulation run_blocks(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets) {
  Call call(runtime);
  Triangulation result;
  // Values of -7 are not yet written.
  const auto room = [&runtime](std::vector<std::int32_t>& values, std::size_t count) {
    values.assign(count, -7);
    return runtime.output(values);
  };
  points::DeviceMesh mesh;
  const Exchange exchange{[&] { return runtime.view(coordinates.data(), coordinates.size()); },
                          room(result.representatives, coordinates.size() / 2), true,
                          [&](const MeshSizes& sizes) {
                            const std::size_t corners = 3 * sizes.triangles();
                            mesh.triangles = room(result.triangles, corners);
                            mesh.neighbors = room(result.neighbors, corners);
                            mesh.halfedges = room(result.halfedges, corners);
                            mesh.hull = room(result.hull, sizes.hull_vertices());
                            return mesh;
                          }};
  const Options options;
  statistics::Phases phases(options);
  Outcome outcome = *run(runtime, call.work.persistent, offsets, exchange, phases);
  runtime.fetch_later(exchange.representatives, result.representatives);
  runtime.fetch_later(mesh.triangles, result.triangles);
  runtime.fetch_later(mesh.neighbors, result.neighbors);
  runtime.fetch_later(mesh.halfedges, result.halfedges);
  runtime.fetch_later(mesh.hull, result.hull);
  runtime.finish();
  // Of few points the arrays had room for the most that there may be.
  for (auto* const array : {&result.triangles, &result.neighbors, &result.halfedges}) {
    array->resize(3 * outcome.sizes.triangles());
  }
  result.hull.resize(outcome.sizes.hull_vertices());
  outcome.write(offsets.back(), result.statistics);
  result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
  result.hull_offsets = std::move(outcome.sizes.hull_offsets);
  return result;
}

void expect_same(const Triangulation& found, const Triangulation& expected) {
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  EXPECT_EQ(found.hull_offsets, expected.hull_offsets);
  EXPECT_TRUE(same(found.triangles, expected.triangles)) << "triangles";
  EXPECT_TRUE(same(found.neighbors, expected.neighbors)) << "neighbors";
  EXPECT_TRUE(same(found.halfedges, expected.halfedges)) << "halfedges";
  EXPECT_TRUE(same(found.hull, expected.hull)) << "hull";
  EXPECT_TRUE(same(found.representatives, expected.representatives)) << "representatives";
  EXPECT_EQ(found.statistics.duplicates, expected.statistics.duplicates);
}

/// What rounds depend on. tile_group: 0 for cuts at medians.
struct RoundSizes {
  std::size_t block_points, round_points, merge_from_percent = 100, tile_group = 0, samples = 4,
                                          local_vertices = 0, star_points = 0;
};

/// Calls check with these sizes.
template <typename Check>
void with_sizes(const RoundSizes& sizes, const Check& check) {
  Runtime& runtime = Runtimes::get("rounds");
  const Tuning before = tuning_of(runtime);
  Tuning tuning = before;
  tuning.block_points = sizes.block_points;
  tuning.round_points = sizes.round_points;
  tuning.merge_from_percent = sizes.merge_from_percent;
  tuning.samples_per_gap_block = sizes.samples;
  if (!runtime.is_native()) {
    tuning.blocks_in_parallel = 1;
    tuning.tile_group = sizes.tile_group;
    tuning.local_vertices = sizes.local_vertices;
    tuning.star_points = sizes.star_points;
  }
  runtime.set_sizes(std::make_shared<Tuning>(tuning));
  check(runtime);
  runtime.set_sizes(std::make_shared<Tuning>(before));
}

/// What tests of rounds met.
struct MetRounds {
  std::size_t most = 0, merged = 0, merged_later = 0, points = 0;
};

/// Rounds against merging, byte by byte.
void compare(const RoundSizes& sizes, const Coordinates& coordinates, const Offsets& offsets,
             MetRounds& met) {
  SCOPED_TRACE("blocks of " + std::to_string(sizes.block_points) + ", then " +
               std::to_string(sizes.round_points) + ", merged from " +
               std::to_string(sizes.merge_from_percent) + " %, tile_group " +
               std::to_string(sizes.tile_group));
  Triangulation expected, found;
  RoundSizes merging = sizes;
  merging.round_points = merging.local_vertices = 0;
  with_sizes(merging, [&](Runtime& runtime) { expected = run_blocks(runtime, coordinates, offsets); });
  with_sizes(sizes, [&](Runtime& runtime) { found = run_blocks(runtime, coordinates, offsets); });
  EXPECT_EQ(expected.statistics.rounds, 0u);
  EXPECT_EQ(expected.statistics.round_points, 0u);
  expect_same(found, expected);
  if (sizes.local_vertices > 0) {
    RoundSizes by_stars = sizes;
    by_stars.star_points = offsets.back();
    with_sizes(by_stars,
               [&](Runtime& runtime) { expect_same(run_blocks(runtime, coordinates, offsets), expected); });
  }
  EXPECT_GE(found.statistics.rounds, 1u);
  EXPECT_GE(found.statistics.round_points, offsets.back());
  EXPECT_LE(found.statistics.merged_points, offsets.back());
  met.most = std::max(met.most, found.statistics.rounds);
  met.merged += found.statistics.merged_points > 0;
  met.merged_later += found.statistics.merged_points > 0 && found.statistics.rounds > 1;
  met.points += found.statistics.round_points;
}

void compare(const RoundSizes& sizes, const Coordinates& coordinates, MetRounds& met) {
  compare(sizes, coordinates, {0, coordinates.size() / 2}, met);
}

/// Many kinds natively, where they are fast; on a device those that differ there.
std::vector<RoundSizes> all_sizes() {
  if (testing::tests_native()) {
    return {{5, 4}, {6, 12}, {13, 5, 50}, {20, 20}, {64, 33}, {64, 64, 50}, {40, 7}};
  }
  // From a single sample, many blocks are larger than the host guesses.
  return {{16, 9, 100, 4}, {24, 12, 50, 32}, {30, 30, 100, 0}, {20, 5, 100, 8, 1}};
}

/// Without the larger ones on a device, where rounds of few points take as long as those of many.
std::vector<std::size_t> point_counts(const std::vector<std::size_t>& natively, std::size_t on_device) {
  return testing::tests_native() ? natively : std::vector<std::size_t>{on_device};
}

/// Many sets, empty ones, single points, collinear ones and those of equal points among them.
Nested sets_of_all_kinds(std::size_t most, std::uint64_t seed) {
  FixtureRandom random(seed);
  Nested sets;
  sets.add({});
  sets.add({3, -0.0});
  sets.add(Coordinates(2 * most, 0.5));
  sets.add({});
  for (std::size_t n = 1; n <= most; n += 1 + n / 3) {
    sets.add(make_fixture("uniform", n, seed + n));
    sets.add(coarse(n, 5, 5, random));
    if (n % 2 == 0) sets.add(make_fixture("collinear", n, n));
    if (n % 3 == 0) sets.add({});
    sets.add(Coordinates(2 * (n % 7), -1.25));
    sets.add(make_fixture("slender", n, n));
  }
  sets.add({});
  return sets;
}

}  // namespace

void run_rounds_of_all_kinds() {
  const Coordinates uniform = make_fixture("uniform", 500, 1), circle = make_fixture("integer-circle", 60, 1);
  with_sizes({24, 12, 100, 3}, [&](Runtime& runtime) {
    run_blocks(runtime, uniform, {0, 5});
    run_blocks(runtime, uniform, {0, uniform.size() / 2});
    run_blocks(runtime, uniform, {0, 100, uniform.size() / 2});
    run_blocks(runtime, circle, {0, circle.size() / 2});
  });
}

namespace {

TEST(SmallRounds, AreTheSameAsMerges) {
  MetRounds met;
  const RoundSizes sizes{6, 5, 100, 3};
  compare(sizes, make_fixture("uniform", 40, 1), met);
  compare({24, 9, 100, 3}, make_fixture("uniform", 90, 1), met);
  EXPECT_GE(met.most, 3u);
  compare({6, 8, 50, 0}, make_fixture("grid", 25, 1), met);
  compare(sizes, make_fixture("circle", 20, 1), met);
  EXPECT_GE(met.merged, 1u);
  const Nested sets = sets_of_all_kinds(9, 2);
  compare(sizes, sets.coordinates, sets.offsets, met);
}

TEST(Rounds, OfFixturesAreTheSameAsMerges) {
  MetRounds met;
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    for (const RoundSizes& sizes : all_sizes()) {
      for (const std::size_t n : point_counts({7, 31, 150, 700}, 70)) compare(sizes, fixture.make(n, n), met);
      if (testing::tests_native()) compare(sizes, testing::perturbed(fixture.make(90, 2), 3), met);
      if (HasFailure()) return;
    }
  }
  EXPECT_GE(met.most, 4u);
  EXPECT_GE(met.merged, 30u);
}

TEST(Rounds, OfAwkwardInputAreTheSameAsMerges) {
  MetRounds met;
  for (const RoundSizes& sizes : all_sizes()) {
    for (const auto& [name, points] : awkward(400, 4)) {
      SCOPED_TRACE(name);
      compare(sizes, points, met);
    }
  }
  EXPECT_GE(met.most, 3u);
}

TEST(Rounds, ThatStallAreTheSameAsMerges) {
  MetRounds met;
  for (const RoundSizes& sizes : all_sizes()) {
    for (const std::size_t n : point_counts({60, 500, 2000}, 150)) {
      for (const auto& [name, points] : stalling(n, n)) {
        SCOPED_TRACE(name + ", " + std::to_string(n) + " points");
        compare(sizes, points, met);
      }
    }
  }
  EXPECT_GE(met.merged, testing::tests_native() ? 50u : 10u);
  EXPECT_GE(met.merged_later, 5u);
}

TEST(Rounds, OfManySetsAreTheSameAsMerges) {
  MetRounds met;
  for (const RoundSizes& sizes : all_sizes()) {
    const Nested sets = sets_of_all_kinds(300, 5);
    compare(sizes, sets.coordinates, sets.offsets, met);
    // Each set stalls or ends at another time.
    Nested others;
    for (const auto& [name, points] : stalling(200, 6)) {
      others.add(points);
      others.add(make_fixture("uniform", 350, 7));
    }
    compare(sizes, others.coordinates, others.offsets, met);
    Nested tiny;
    FixtureRandom random(8);
    for (int s = 0; s < 500; ++s)
      tiny.add(coarse(static_cast<std::size_t>(random.integer(0, 30)), 6, 5, random));
    compare(sizes, tiny.coordinates, tiny.offsets, met);
  }
  EXPECT_GE(met.most, 4u);
}

/// Parts of blocks that are not merged, of several depths, also of a set's only block; blocks that are merged
/// after all, and calls with single blocks alone, for which there is no other way.
TEST(Rounds, OfPartsAreTheSameAsMerges) {
  if (testing::tests_native()) GTEST_SKIP() << "the host has no local memory";
  MetRounds met;
  for (const std::size_t local_vertices : {8u, 16u}) {
    const RoundSizes sizes{64, 40, 50, 32, 16, local_vertices};
    for (const char* const name : {"uniform", "line", "rotated-grid", "circle", "half-duplicates"}) {
      SCOPED_TRACE(name);
      compare(sizes, make_fixture(name, 3000, 13), met);
    }
    // A block with more parts than there are frames, which are higher.
    Coordinates crowded = make_fixture("uniform", 2000, 15);
    for (const double p : make_fixture("uniform", 600, 16)) crowded.push_back(0.5 + 1e-9 * p);
    crowded.insert(crowded.end(), 1000, 0.5);
    compare(sizes, crowded, met);
    const Nested sets = sets_of_all_kinds(150, 14);
    compare(sizes, sets.coordinates, sets.offsets, met);
    Nested large;
    for (const std::size_t n : {400u, 3u, 50u, 900u}) large.add(make_fixture("uniform", n, n));
    compare(sizes, large.coordinates, large.offsets, met);
  }
  EXPECT_GE(met.most, 3u);
  EXPECT_GE(met.merged, 2u);
}

/// Parallelograms and ellipses full of points, in all directions. Of some, a round leaves two points: those
/// of an edge of the upper hull, with nothing missing but the outside.
TEST(Rounds, ThatLeaveAHullEdgeAreTheSameAsMerges) {
  MetRounds met;
  FixtureRandom random(12);
  Nested sets;
  for (int s = 0; s < 400; ++s) {
    const bool is_round = s % 2 == 0;
    double map[4];
    for (double& entry : map) entry = 2 * random.unit() - 1;
    Coordinates points;
    for (std::int64_t left = random.integer(31, 120); left > 0;) {
      const double x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
      if (is_round && x * x + y * y > 1) continue;
      append(points, {map[0] * x + map[1] * y, map[2] * x + map[3] * y});
      --left;
    }
    sets.add(points);
  }
  for (const std::size_t round_points : {6, 10, 20}) {
    compare({30, round_points, 100, 4}, sets.coordinates, sets.offsets, met);
  }
  EXPECT_GE(met.most, 8u);
}

/// Nothing and nearly nothing: a single set of no points is not run.
TEST(SmallRounds, OfFewPoints) {
  MetRounds met;
  for (const RoundSizes& sizes : {RoundSizes{2, 2}, RoundSizes{6, 5, 100, 2}}) {
    for (const Coordinates& points : std::vector<Coordinates>{
             {1, 2}, {1, 2, 1, 2}, {0, 0, 1, 1}, {0, 0, 1, 1, 2, 2}, {0, 0, 1, 0, 0, 1}}) {
      compare(sizes, points, met);
    }
    compare(sizes, {0, 0, 1, 1, 5, 5, 5, 5}, {0, 0, 1, 2, 2, 4, 4}, met);
  }
}

TEST(Rounds, OfManyPointsAreTheSameAsMerges) {
  MetRounds met;
  const std::size_t n = testing::tests_native() ? 60000 : 15000;
  for (const char* const name : {"uniform", "kuzmin", "line", "corners", "grid", "circle"}) {
    SCOPED_TRACE(name);
    compare({64, 50, 50, 64, 16}, make_fixture(name, n, 9), met);
    compare({300, 200, 100, 256, 64}, make_fixture(name, n, 10), met);
  }
  EXPECT_GE(met.most, 3u);
}

Statistics statistics_of(const RoundSizes& sizes, const Coordinates& coordinates) {
  Statistics statistics;
  with_sizes(sizes, [&](Runtime& runtime) {
    statistics = run_blocks(runtime, coordinates, {0, coordinates.size() / 2}).statistics;
  });
  return statistics;
}

TEST(Rounds, StatisticsSayWhatTheyDid) {
  const std::size_t n = 20000;
  const RoundSizes sizes{512, 256, 50, 64, 64};
  const Coordinates uniform = make_fixture("uniform", n, 11), circle = make_fixture("circle", n, 11);
  const Statistics one = statistics_of({n, n}, uniform);
  EXPECT_EQ(one.rounds, 1u);
  EXPECT_EQ(one.round_points, n);
  EXPECT_EQ(one.merged_points, 0u);

  const Statistics many = statistics_of(sizes, uniform);
  EXPECT_GE(many.rounds, 2u);
  EXPECT_GT(many.round_points, n + n / 20);
  EXPECT_LT(many.round_points, 2 * n);
  // Medians fall on the old cuts; cuts in gaps get on without merging.
  if (!testing::tests_native()) {
    EXPECT_EQ(many.merged_points, 0u);
  }

  // No triangle is local: the blocks of the first round are merged.
  const Statistics stalled = statistics_of(sizes, circle);
  EXPECT_EQ(stalled.rounds, 1u);
  EXPECT_EQ(stalled.merged_points, n);
  EXPECT_EQ(stalled.round_points, n);
}

/// Kernels with one expression instead of another.
testing::ChangedKernels with_wrong(const std::string& file, const std::string& expression,
                                   const std::string& other) {
  return {file, [&](std::string text) {
            const std::size_t at = text.find(expression);
            EXPECT_NE(at, std::string::npos);
            return at == std::string::npos ? text : text.replace(at, expression.size(), other);
          }};
}

/// As a GPU solves blocks, with groups of any size and any share of a part in local memory.
TEST(Rounds, OfManyLanesHaveTheBytesOfTheHost) {
  if (testing::tests_native()) GTEST_SKIP() << "native kernels have no work-groups";
  Runtime& runtime = Runtimes::get("rounds");
  Runtime host(native_tuning());
  const Tuning before = tuning_of(runtime);
  FixtureRandom random(62);
  std::vector<Coordinates> inputs{coarse(700, 12, 12, random)};
  for (const char* const name : {"uniform", "grid", "integer-circle", "line"}) {
    for (const std::size_t n : {300, 2500}) inputs.push_back(make_fixture(name, n, 63));
  }
  for (const auto& [vertices, group] :
       {std::pair<std::size_t, std::size_t>{0, 3}, {0, 256}, {16, 32}, {64, 3}, {512, 1}, {512, 256}}) {
    Tuning tuning = before;
    tuning.blocks_in_parallel = 1;
    tuning.round_points = 500;
    tuning.local_vertices = vertices;
    tuning.star_points = group == 1 || group == 32 ? 1 << 20 : 0;
    tuning.merge_items = 1 << 20;
    tuning.tile_group = tuning.halve_group = tuning.block_group = tuning.sewing_group = group;
    runtime.set_sizes(std::make_shared<Tuning>(tuning));
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      SCOPED_TRACE("input " + std::to_string(k) + ", " + std::to_string(vertices) +
                   " vertices in local memory, groups of " + std::to_string(group));
      const Offsets offsets{0, inputs[k].size() / 2};
      expect_same(run_blocks(runtime, inputs[k], offsets), run_blocks(host, inputs[k], offsets));
    }
  }
  runtime.set_sizes(std::make_shared<Tuning>(before));
}

/// An error of ours that the account tells, before anything is made of such triangulations: in rounds, in the
/// last round, and with merging.
TEST(Rounds, WalksThatDoNotMeetAreAnError) {
  if (testing::tests_native()) GTEST_SKIP() << "the host solves blocks one by one";
  // Walks that end at the first edge of their seam, and so do not meet if it has more.
  const auto changed = with_wrong("blocks/seams.h", "if (is_beyond(s, low, high))", "if (1)");
  const auto runtime = points::make_runtime("lanes");
  const Coordinates points = make_fixture("uniform", 900, 61);
  for (const auto& [block_points, round_points] : {std::pair{100, 50}, {1000, 500}, {100, 0}}) {
    SCOPED_TRACE("blocks of " + std::to_string(block_points) + ", then " + std::to_string(round_points));
    Tuning tuning = tuning_of(*runtime);
    tuning.block_points = block_points;
    tuning.round_points = round_points;
    tuning.star_points = 0;
    runtime->set_sizes(std::make_shared<Tuning>(tuning));
    testing::expect_error(ErrorKind::internal, {"walks along a seam"}, [&] {
      run_blocks(*runtime, points, {0, 900});
    });
    // Stars leave nothing to walks.
    tuning.star_points = 900;
    runtime->set_sizes(std::make_shared<Tuning>(tuning));
    EXPECT_NO_THROW(run_blocks(*runtime, points, {0, 900}));
  }
}

/// Of units that are parts of a block, and whole blocks.
TEST(Rounds, StarsThatDifferAreAnError) {
  if (testing::tests_native()) GTEST_SKIP() << "the host solves blocks one by one";
  const auto changed =
      with_wrong("blocks/stars.cl", "star[at] = found.vertex", "star[at] = v == 5 ? first : found.vertex");
  const auto runtime = points::make_runtime("lanes");
  for (const std::size_t round_points : {500, 0}) {
    Tuning tuning = tuning_of(*runtime);
    tuning.block_points = 1000;
    tuning.round_points = round_points;
    tuning.star_points = 900;
    runtime->set_sizes(std::make_shared<Tuning>(tuning));
    testing::expect_error(ErrorKind::internal, {"the stars of an edge's vertices"}, [&] {
      run_blocks(*runtime, make_fixture("uniform", 900, 61), {0, 900});
    });
  }
}

/// Blocks that are cut along any axes into parts of a height, whose ends alone are known.
struct CutBlocks {
  int height;
  std::vector<cl_int> offsets{0}, distinct{};
  std::vector<cl_double2> points{};
  std::vector<cl_uchar> axes{};
  std::vector<kernel::solved_block> parts{}, solved{};

  /// A block of these vertices, with further places.
  void add(std::vector<cl_double2> vertices, std::size_t places, FixtureRandom& random) {
    const std::size_t first = points.size();
    points.insert(points.end(), vertices.begin(), vertices.end());
    points.resize(first + vertices.size() + places, {{-7, -7}});
    axes.resize(points.size());
    parts.resize(points.size() / 2 + 1);
    solved.push_back({kernel::no_ends(), {-1, -1}});
    offsets.push_back(static_cast<cl_int>(points.size()));
    distinct.push_back(static_cast<cl_int>(vertices.size()));
    if (!vertices.empty()) cut(first, distinct.back(), 0, 0, random);
  }

 private:
  static bool before(cl_double2 a, cl_double2 b, int axis) {
    return kernel::precedes({a.s[0], a.s[1]}, {b.s[0], b.s[1]}, axis) != 0;
  }
  void cut(std::size_t first, int count, int depth, int number, FixtureRandom& random) {
    const int begin = kernel::part_begin(count, depth, number),
              end = kernel::part_begin(count, depth, number + 1), own_height = kernel::halving_depth(count);
    const auto from = points.begin() + static_cast<std::ptrdiff_t>(first) + begin, to = from + (end - begin);
    if (own_height - depth <= height || depth == 0) {
      const auto place_of = [&](auto extreme, int axis) {
        return static_cast<int>(
            extreme(from, to, [&](cl_double2 a, cl_double2 b) { return before(a, b, axis); }) -
            points.begin());
      };
      const auto least = [](auto... args) { return std::min_element(args...); };
      const auto greatest = [](auto... args) { return std::max_element(args...); };
      const kernel::hull_ends ends = kernel::ends_of(place_of(least, 0), place_of(greatest, 0),
                                                     place_of(least, 1), place_of(greatest, 1));
      (depth == 0 ? solved.back() : parts[(first + static_cast<std::size_t>(begin)) / 2]).ends = ends;
    }
    if (own_height - depth <= height) return;
    const int axis = static_cast<int>(random.integer(0, 1));
    std::sort(from, to, [&](cl_double2 a, cl_double2 b) { return before(a, b, axis); });
    axes[first + static_cast<std::size_t>((1 << depth) + number)] = static_cast<cl_uchar>(axis);
    for (const int half : {0, 1}) cut(first, count, depth + 1, 2 * number + half, random);
  }
};

/// Each set has one block, so that frames are between the cuts into parts alone.
TEST(SmallRounds, FramesLieBetweenTheCutsIntoParts) {
  Runtime& runtime = Runtimes::get("rounds");
  FixtureRandom random(21);
  for (const auto& [height, depth] : {std::pair{0, 3}, {1, 3}, {2, 2}, {3, 1}, {6, 0}}) {
    SCOPED_TRACE("height " + std::to_string(height) + ", depth " + std::to_string(depth));
    const Arena::Scope scope(runtime.arena());
    CutBlocks given{.height = height};
    const auto most = std::size_t{kernel::LEAF_VERTICES} << (height + depth);
    for (std::size_t n = 0; n <= most; n += 1 + n / 3) {
      std::vector<cl_double2> vertices;
      while (vertices.size() < n) {
        const cl_double2 p{{static_cast<double>(random.integer(0, 40)), random.unit()}};
        vertices.push_back(p);
      }
      given.add(vertices, n % 3, random);
    }
    const std::size_t blocks = given.distinct.size(), places = given.points.size(), frames = blocks << depth;
    std::vector<cl_int> each(blocks + 1), none(places, kernel::NO_EDGE);
    std::iota(each.begin(), each.end(), 0);
    const kernel::vertex_box all{{0, 0}, {40, 1}};
    const auto ints = [&](const std::vector<cl_int>& values) { return testing::upload(runtime, values); };
    const auto frame_offsets = ints(std::vector<cl_int>(frames, -7));
    const auto device_frames = testing::upload(runtime, std::vector<kernel::block_frame>(frames));
    runtime.map(std::max({places, frames, std::size_t{kernel::RINGS_NUMBERS}}),
                kernels::begin_round{.places_of_parts = {.height = height,
                                                         .least_depth = 0,
                                                         .end_depth = kernel::MOST_DEPTH,
                                                         .places = places,
                                                         .offsets = ints(given.offsets),
                                                         .distinct = ints(given.distinct),
                                                         .block_of_place = Buffer<cl_int>{},
                                                         .axes = testing::upload(runtime, given.axes)},
                                     .depth = depth,
                                     .blocks = blocks,
                                     .cut_sets = {.sets = blocks,
                                                  .set_blocks = ints(each),
                                                  .set_nodes = Buffer<cl_int>{},
                                                  .nodes = Buffer<kernel::cut_node>{}},
                                     .is_merged = 0,
                                     .scale = kernel::scaling{1, 1, 1},
                                     .parts = testing::upload(runtime, given.parts),
                                     .solved = testing::upload(runtime, given.solved),
                                     .set_boxes = ints(std::vector<cl_int>(blocks, 0)),
                                     .boxes = testing::upload(runtime, std::vector<kernel::vertex_box>{all}),
                                     .points = testing::upload(runtime, given.points),
                                     .edges = Buffer<kernel::ring_edge>{},
                                     .vertex_edge = ints(none),
                                     .is_first = 1,
                                     .listed = Buffer<cl_int>{},
                                     .listed_vertices = Buffer<cl_int>{},
                                     .vertices = ints(none),
                                     .emitted = ints(std::vector<cl_int>(6 * places, -1)),
                                     .hull_links = ints(std::vector<cl_int>(2 * places, -1)),
                                     .frame_offsets = frame_offsets,
                                     .frames = device_frames,
                                     .account = testing::upload(runtime, std::vector<cl_uint>(4, 0)),
                                     .numbers = ints(std::vector<cl_int>(3 * blocks + 6, -1))});
    const auto begins = testing::download(runtime, frame_offsets, frames);
    const auto found = testing::download(runtime, device_frames, frames);
    std::size_t cut = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const cl_int first = given.offsets[b], end = first + given.distinct[b];
      EXPECT_EQ(begins[b << depth], first);
      cl_int next = first;
      for (std::size_t f = b << depth; f < (b + 1) << depth; ++f) {
        const kernel::vertex_box& r = found[f].rectangle;
        const auto is_within = [&](cl_double2 p) {
          return r.low.x < p.s[0] && p.s[0] < r.high.x && r.low.y < p.s[1] && p.s[1] < r.high.y;
        };
        const auto is_around = [&](cl_double2 p) {
          return r.low.x <= p.s[0] && p.s[0] <= r.high.x && r.low.y <= p.s[1] && p.s[1] <= r.high.y;
        };
        EXPECT_EQ(begins[f], next);
        const cl_int own_end = next + found[f].vertices;
        for (cl_int v = first; v < end && found[f].vertices > 0; ++v) {
          const cl_double2 p = given.points[static_cast<std::size_t>(v)];
          const bool is_own = next <= v && v < own_end;
          EXPECT_TRUE(is_own ? is_around(p) : !is_within(p))
              << "block " << b << ", frame " << f << ", vertex " << v;
        }
        cut += found[f].vertices > 0 && found[f].vertices < given.distinct[b];
        next = own_end == end ? given.offsets[b + 1] : own_end;
      }
      EXPECT_EQ(next, given.offsets[b + 1]);
    }
    EXPECT_EQ(cut > 0, depth > 0);
  }
}

/// One work-group counts results, and orders hulls, as its twins do here one by one.
TEST(SmallRounds, AWorkGroupMakesFewResults) {
  Runtime& runtime = Runtimes::get("rounds");
  const Arena::Scope scope(runtime.arena());
  FixtureRandom random(21);
  for (const std::size_t group : {1, 3, 32, 64, 256}) {
    std::vector<cl_int> set_points{0}, hull_offsets{0}, hull_vertices, indices, hull, places;
    std::vector<cl_int2> hull_links, ahead;
    std::vector<cl_uint> scanned{0};
    for (const std::size_t points : {0, 1, 70, 300, 2}) {
      const cl_int first = hull_offsets.back();
      std::vector<cl_int> order;
      for (std::size_t v = 0; v < points; ++v) {
        const bool is_on_hull = random.integer(0, 2) > 0, is_before = random.integer(0, 1) > 0;
        hull_links.push_back({{is_on_hull && !is_before ? 3 : -1, is_on_hull && is_before ? 4 : -1}});
        indices.push_back(static_cast<cl_int>(random.integer(0, 1000)));
        if (!is_on_hull) continue;
        order.insert(order.begin() + random.integer(0, static_cast<std::int64_t>(order.size())),
                     first + static_cast<cl_int>(order.size()));
        hull_vertices.push_back(static_cast<cl_int>(hull_links.size()) - 1);
      }
      set_points.push_back(static_cast<cl_int>(hull_links.size()));
      hull_offsets.push_back(first + static_cast<cl_int>(order.size()));
      ahead.resize(hull_vertices.size());
      for (std::size_t k = 0; k < order.size(); ++k) {
        const auto at = static_cast<std::size_t>(order[k]);
        ahead[at] = k + 1 < order.size() ? cl_int2{{order[k + 1], 1}} : cl_int2{{order[k], 0}};
        hull.push_back(indices[static_cast<std::size_t>(hull_vertices[at])]);
      }
    }
    const std::size_t n = hull_links.size(), sets = set_points.size() - 1;
    for (std::size_t p = 0; p < 2 * n; ++p) {
      places.insert(places.end(), {static_cast<cl_int>(random.integer(-1, 0)), -1, 7});
      scanned.push_back(scanned.back() + (places[3 * p] >= 0));
    }
    for (const cl_int2& links : hull_links)
      scanned.push_back(scanned.back() + (links.s[0] + links.s[1] > -2));
    std::vector<cl_int> sizes;
    for (const cl_int first : set_points) sizes.push_back(static_cast<cl_int>(scanned[2 * first]));
    sizes.insert(sizes.end(), hull_offsets.begin(), hull_offsets.end());

    const auto found_scanned = testing::guarded<cl_uint>(runtime, 3 * n + 1);
    const auto found_sizes = testing::guarded<cl_int>(runtime, 2 * (sets + 1));
    runtime.launch(group, group, 3 * n,
                   kernels::count_few_results{.vertices = n,
                                              .items = 5,
                                              .places = testing::upload(runtime, places),
                                              .hull_links = testing::upload(runtime, hull_links),
                                              .sets = sets,
                                              .set_points = testing::upload(runtime, set_points),
                                              .scanned = found_scanned,
                                              .sizes = found_sizes});
    EXPECT_EQ(testing::download(runtime, found_scanned, 3 * n + 1), scanned) << group;
    EXPECT_EQ(testing::download(runtime, found_sizes, 2 * (sets + 1)), sizes) << group;
    const auto found_hull = testing::guarded<cl_int>(runtime, hull.size());
    runtime.launch(group, group,
                   kernels::order_hull{.sets = sets,
                                       .sizes = found_sizes,
                                       .hull_vertices = testing::upload(runtime, hull_vertices),
                                       .ahead = testing::upload(runtime, ahead),
                                       .spare = runtime.arena().allocate<cl_int2>(ahead.size()),
                                       .indices = testing::upload(runtime, indices),
                                       .hull = found_hull});
    EXPECT_EQ(testing::download(runtime, found_hull, hull.size()), hull) << group;
  }
}

/// Boxes that are too large make rounds longer, but change no result.
TEST(SmallRounds, BoxesOfSetsAreJoined) {
  Runtime& runtime = Runtimes::get("rounds");
  const Arena::Scope scope(runtime.arena());
  FixtureRandom random(20);
  // Sets of 1, 2, 16, 17, 300 and 4 blocks, some of them empty.
  std::vector<cl_int> set_blocks{0};
  for (const cl_int blocks : {1, 2, 16, 17, 300, 4}) set_blocks.push_back(set_blocks.back() + blocks);
  std::vector<kernel::vertex_box> boxes(static_cast<std::size_t>(set_blocks.back()));
  for (kernel::vertex_box& box : boxes) {
    const double x = random.unit(), y = random.unit();
    box = {{x, y}, {x + random.unit(), y + random.unit()}};
    if (random.integer(0, 3) == 0) box = {{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
  }
  const auto on_device = testing::upload(runtime, boxes);
  const std::size_t sets = set_blocks.size() - 1;
  for (std::size_t step = 1; step < 300; step *= 16) {
    runtime.map(boxes.size(), kernels::join_boxes{.sets = sets,
                                                  .step = step,
                                                  .set_blocks = testing::upload(runtime, set_blocks),
                                                  .boxes = on_device});
  }
  const auto found = testing::download(runtime, on_device, boxes.size());
  for (std::size_t s = 0; s < sets; ++s) {
    const auto first = static_cast<std::size_t>(set_blocks[s]),
               end = static_cast<std::size_t>(set_blocks[s + 1]);
    kernel::vertex_box all = boxes[first];
    for (std::size_t b = first; b < end; ++b) {
      all.low = {std::min(all.low.x, boxes[b].low.x), std::min(all.low.y, boxes[b].low.y)};
      all.high = {std::max(all.high.x, boxes[b].high.x), std::max(all.high.y, boxes[b].high.y)};
    }
    EXPECT_EQ(found[first].low.x, all.low.x) << s;
    EXPECT_EQ(found[first].low.y, all.low.y) << s;
    EXPECT_EQ(found[first].high.x, all.high.x) << s;
    EXPECT_EQ(found[first].high.y, all.high.y) << s;
  }
}

}  // namespace
}  // namespace flaunay::blocks
