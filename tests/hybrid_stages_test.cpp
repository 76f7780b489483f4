// Every stage of Mode::hybrid against its plain twin (support/hybrid_twins.hpp), on random and on degenerate
// input, under the device's own tuning and under several of odd, small sizes.
//
// Suites named Small... have tiny inputs, for slow simulators: oclgrind test_hybrid_stages
// --gtest_filter='Small*'
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/device.hpp"
#include "host/runtime.hpp"
#include "hybrid/cut_tree.hpp"
#include "hybrid/stages.hpp"
#include "tests/support/cut_tree_twin.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/hybrid_twins.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"

namespace flaunay::hybrid {
namespace {

using host::Runtime;
using host::Tuning;
using testing::BlocksTwin;
using testing::comes_first;
using testing::Coordinates;
using testing::cut_tree;
using testing::CutTree;
using testing::FixtureRandom;
using testing::HostRings;
using testing::make_fixture;
using testing::MeshTwin;
using testing::RingCheck;
using testing::same;
using testing::sample_indices;
using testing::samples_for;
using testing::spread_indices;
using testing::TreeTwin;

using Offsets = std::vector<std::size_t>;

// -----------------------------------------------------------------------------------------------------------
// Runtimes

/// One for each tuning; "own" is the device's or what the environment names.
std::unique_ptr<Runtime> make_runtime(const std::string& name) {
  const char* const before = std::getenv("FLAUNAY_TUNING");
  const testing::ScopedEnvironment kind("FLAUNAY_TUNING", name == "small" ? "small" : before);
  auto runtime = std::make_unique<Runtime>(host::find_device(""));
  Tuning tuning = runtime->tuning();
  if (name == "odd") {
    // One work-item for all blocks, many chunks.
    tuning.block_points = 13;
    tuning.block_workers = 1;
    tuning.chunk_least = 2;  // as few as a scan can do with
    tuning.chunks_most = 0;
  }
  if (name == "single") {
    // Blocks without merges of their own, in memory that is shared if it was not.
    tuning.block_points = 1;
    tuning.block_workers = 1000;
    tuning.chunk_least = 3;
    tuning.chunks_most = 11;
    if (runtime->device().type() & CL_DEVICE_TYPE_CPU) tuning.in_host_memory = !tuning.in_host_memory;
  }
  runtime->set_tuning(tuning);
  return runtime;
}
using Runtimes = testing::SharedRuntimes<make_runtime>;
[[maybe_unused]] ::testing::Environment* const kRuntimes = ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Under the tuning that the environment names alone, if it names one.
template <typename Check>
void under_each_tuning(const Check& check) {
  const bool chosen = std::getenv("FLAUNAY_TUNING") != nullptr;
  for (const char* const name : {"own", "small", "odd", "single"}) {
    if (chosen && std::string(name) != "own") continue;
    SCOPED_TRACE(std::string("tuning ") + name);
    check(Runtimes::get(name));
  }
}

/// What triangulator.cpp sets up around the stages.
class Call {
 public:
  explicit Call(Runtime& used)
      : runtime(used),
        persistent_(used.context(), used.device()),
        scope_(used.arena()),
        work{used, persistent_} {
    if (used.tuning().separate_buffers) persistent_.separate_buffers();
  }

  template <typename T>
  std::vector<T> read(const Buffer<T>& buffer, std::size_t count) {
    std::vector<T> values(count);
    runtime.read(buffer, 0, count, values.data());
    return values;
  }

  Runtime& runtime;

 private:
  Arena persistent_;
  Arena::Scope scope_;

 public:
  Workspace work;
};

// -----------------------------------------------------------------------------------------------------------
// Input

void append(Coordinates& to, const Coordinates& points) { to.insert(to.end(), points.begin(), points.end()); }

cl_double2 point_of(const Coordinates& points, std::size_t i) { return {{points[2 * i], points[2 * i + 1]}}; }

std::vector<cl_double2> points_of(const Coordinates& coordinates) {
  std::vector<cl_double2> points;
  for (std::size_t i = 0; i < coordinates.size() / 2; ++i) points.push_back(point_of(coordinates, i));
  return points;
}

/// Integers in [0, width) x [0, height).
Coordinates coarse(std::size_t n, std::int64_t width, std::int64_t height, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back(static_cast<double>(random.integer(0, width - 1)));
    points.push_back(static_cast<double>(random.integer(0, height - 1)));
  }
  return points;
}

/// What a cut, a sort or a merge might stumble over, beside the fixtures; each of n points.
std::vector<std::pair<std::string, Coordinates>> awkward(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  std::vector<std::pair<std::string, Coordinates>> all;
  const auto add = [&](const std::string& name, Coordinates points) {
    all.emplace_back(name, std::move(points));
  };
  const auto made = [&](const std::string& name, const std::function<cl_double2(double)>& point) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    random.shuffle(order);
    Coordinates points;
    for (const std::size_t i : order) {
      const cl_double2 p = point(static_cast<double>(i));
      points.insert(points.end(), {p.s[0], p.s[1]});
    }
    add(name, points);
  };
  made("one place", [](double) { return cl_double2{{3, -0.1}}; });
  made("column", [](double i) { return cl_double2{{0.3, i}}; });
  made("row", [](double i) { return cl_double2{{i, 0.3}}; });
  made("oblique line", [](double i) { return cl_double2{{3 * i, 1 - 2 * i}}; });
  made("zeros of both signs", [&](double i) {
    return cl_double2{{random.integer(0, 1) ? 0.0 : -0.0, random.integer(0, 1) ? std::floor(i / 4) : -0.0}};
  });
  made("neighbouring doubles", [&](double i) {
    if (i == 0) return cl_double2{{1e9, -1e9}};
    return cl_double2{{1 + static_cast<double>(random.integer(0, 40)) * 0x1p-52,
                       1 + static_cast<double>(random.integer(0, 40)) * 0x1p-52}};
  });
  made("a heap and few others", [&](double i) {
    return i < 4 * static_cast<double>(n) / 5 ? cl_double2{{0.5, 0.5}}
                                              : cl_double2{{random.unit(), random.unit()}};
  });
  made("heaps", [&](double i) {
    const double heap = std::fmod(i, 3);
    return cl_double2{{heap * heap, heap}};
  });
  add("few places", coarse(n, 3, 3, random));
  add("few columns", coarse(n, 2, 1000000, random));
  add("few rows", coarse(n, 1000000, 2, random));
  add("grid", coarse(n, static_cast<std::int64_t>(std::sqrt(n)) + 1,
                     static_cast<std::int64_t>(std::sqrt(n)) + 1, random));
  // Differences of coordinates overflow before points are scaled.
  Coordinates huge = make_fixture("uniform", n, seed);
  for (double& c : huge) c = (c - 0.5) * 0x1.fp1023 * 2;
  add("huge", testing::scaled(make_fixture("grid", n, seed), 0x1p1010));
  add("overflowing", huge);
  add("tiny", testing::scaled(make_fixture("uniform", n, seed), 0x1p-900));
  return all;
}

/// Points of a set in a nested call.
struct Nested {
  Coordinates coordinates;
  Offsets offsets{0};
  void add(const Coordinates& points) {
    append(coordinates, points);
    offsets.push_back(coordinates.size() / 2);
  }
};

// -----------------------------------------------------------------------------------------------------------
// Cut trees

void check_tree(const std::vector<cl_double2>& samples, int depth) {
  const TreeTwin twin = testing::tree_twin(samples, depth);
  std::vector<cl_double2> changed = samples;
  const CutTree tree = cut_tree(changed, depth);
  ASSERT_EQ(tree.depth, depth);
  ASSERT_EQ(tree.nodes.size(), twin.nodes.size());
  TreeTwin found;
  found.depth = depth;
  found.nodes.resize(1);
  for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
    EXPECT_EQ(tree.nodes[k].axis(), twin.nodes[k].axis) << "node " << k;
    found.nodes.push_back(testing::decoded(tree.nodes[k]));
    EXPECT_EQ(found.nodes[k].axis, twin.nodes[k].axis) << "node " << k;
    for (const int c : {0, 1}) {
      EXPECT_EQ(found.nodes[k].pivot.s[c], twin.nodes[k].pivot.s[c]) << "node " << k;
      EXPECT_FALSE(found.nodes[k].pivot.s[c] == 0 && std::signbit(found.nodes[k].pivot.s[c])) << "node " << k;
    }
  }
  // Samples that all differ spread evenly.
  std::set<std::pair<double, double>> places;
  std::vector<std::size_t> leaves(std::size_t{1} << depth);
  for (const cl_double2& p : samples) {
    places.emplace(p.s[0], p.s[1]);
    ++leaves[static_cast<std::size_t>(found.leaf(p))];
  }
  if (places.size() < samples.size()) return;
  const auto [least, most] = std::minmax_element(leaves.begin(), leaves.end());
  EXPECT_GE(*least, samples.size() >> depth);
  EXPECT_LE(*most, (samples.size() + leaves.size() - 1) >> depth);
}

TEST(SmallCutTree, CutsSamplesInHalvesAcrossTheLongerRange) {
  for (const int depth : {0, 1, 2, 5}) {
    for (const std::size_t size : {std::size_t{1} << depth, samples_for(depth), samples_for(depth) + 5}) {
      SCOPED_TRACE(std::to_string(size) + " samples, depth " + std::to_string(depth));
      check_tree(points_of(make_fixture("uniform", size, 1)), depth);
      for (const auto& [name, points] : awkward(size, 2)) {
        SCOPED_TRACE(name);
        check_tree(points_of(points), depth);
      }
    }
  }
}

TEST(CutTree, CutsSamplesInHalvesAcrossTheLongerRange) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    check_tree(points_of(fixture.make(samples_for(7), 3)), 7);
  }
}

TEST(SmallCutTree, AxisIsThatOfTheLongerInterquartileRange) {
  // A few far points do not count: the range between the quarters does.
  std::vector<cl_double2> samples{{{-1000, 1}}, {{1000, 2}}};
  for (int i = 0; i < 14; ++i) samples.push_back({{i * 0.25, static_cast<double>(i)}});
  EXPECT_EQ(cut_tree(samples, 1).nodes[1].axis(), 1);
  for (cl_double2& p : samples) std::swap(p.s[0], p.s[1]);
  EXPECT_EQ(cut_tree(samples, 1).nodes[1].axis(), 0);
  std::vector<cl_double2> square{{{0, 0}}, {{1, 1}}, {{2, 2}}, {{3, 3}}};
  EXPECT_EQ(cut_tree(square, 1).nodes[1].axis(), 0);
}

TEST(SmallCutTree, SamplesComeFromEqualParts) {
  for (const int depth : {1, 3, 6}) {
    const std::size_t samples = samples_for(depth);
    for (const std::size_t n :
         {std::size_t{2}, samples - 1, samples, samples + 1, 10 * samples + 7, 1000 * samples}) {
      const std::vector<cl_int> indices = sample_indices(n, depth);
      ASSERT_EQ(indices.size(), samples);
      EXPECT_EQ(indices, sample_indices(n, depth));
      std::size_t late = 0;
      for (std::size_t k = 0; k < samples; ++k) {
        const std::size_t begin = k * n / samples, end = (k + 1) * n / samples;
        const auto index = static_cast<std::size_t>(indices[k]);
        ASSERT_LT(index, n);
        ASSERT_GE(index, begin);
        ASSERT_LT(index, std::max(end, begin + 1));
        late += index - begin >= (end - begin + 1) / 2;
      }
      // Drawn anywhere in their part.
      if (n < 1000 * samples) continue;
      EXPECT_GT(late, samples / 4);
      EXPECT_LT(late, samples * 3 / 4);
    }
  }
}

/// The points of each leaf of so many samples, sorted.
using Leaf = std::vector<std::pair<double, double>>;
std::vector<Leaf> leaves_of(const std::vector<cl_double2>& samples, std::size_t size) {
  std::vector<Leaf> leaves(samples.size() / size);
  for (std::size_t i = 0; i < samples.size(); ++i)
    leaves[i / size].emplace_back(samples[i].s[0], samples[i].s[1]);
  for (Leaf& leaf : leaves) std::sort(leaf.begin(), leaf.end());
  return leaves;
}

/// What the device made of all sets.
struct HostTrees {
  std::vector<CutNode> nodes;
  std::vector<cl_double2> samples;
  std::vector<cl_int> orders;
  std::size_t first_sample = 0, first_node = 0;  ///< of the set at hand
};

/// A set's tree against that which the host makes of the same samples.
void check_device_tree(const Coordinates& coordinates, int depth, std::size_t samples_per_leaf,
                       const HostTrees& found) {
  std::vector<cl_double2> expected, samples;
  for (const cl_int i : spread_indices(coordinates.size() / 2, samples_per_leaf << depth)) {
    expected.push_back(point_of(coordinates, static_cast<std::size_t>(i)));
    samples.push_back(found.samples[found.first_sample + samples.size()]);
  }
  EXPECT_TRUE(same(samples, expected));
  const CutTree tree = cut_tree(expected, depth);  // and brings them to the order of leaves
  for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
    const CutNode &node = found.nodes[found.first_node + k], &twin = tree.nodes[k];
    ASSERT_TRUE(node.major == twin.major && node.minor == twin.minor && node.turn == twin.turn)
        << "node " << k;
  }
  for (const std::size_t order : {std::size_t{0}, found.samples.size()}) {
    std::vector<cl_double2> by_leaf;
    std::set<std::size_t> members;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto sample = static_cast<std::size_t>(found.orders[order + found.first_sample + i]);
      ASSERT_GE(sample, found.first_sample);
      ASSERT_LT(sample, found.first_sample + samples.size());
      ASSERT_TRUE(members.insert(sample).second) << "sample " << sample << " is there twice";
      by_leaf.push_back(found.samples[sample]);
    }
    EXPECT_TRUE(leaves_of(by_leaf, samples_per_leaf) == leaves_of(expected, samples_per_leaf));
  }
}

/// Returns the number of launches.
std::size_t check_device_trees(Runtime& runtime, const std::vector<std::pair<Coordinates, int>>& sets,
                               std::size_t samples_per_leaf) {
  const Arena::Scope scope(runtime.arena());
  // Points before and behind, which no tree is to see.
  Coordinates all{NAN, NAN};
  std::vector<SetToCut> to_cut;
  for (const auto& [coordinates, depth] : sets) {
    to_cut.push_back({depth, all.size() / 2, coordinates.size() / 2});
    append(all, coordinates);
    append(all, {NAN, NAN});
  }
  const auto input = testing::upload(runtime, all);
  const CutTrees trees(runtime, to_cut, samples_per_leaf);
  const auto nodes = testing::guarded<CutNode>(runtime, trees.nodes());
  const std::size_t before = runtime.launches();
  const auto samples = trees.draw(input);
  const auto orders = trees.cut(samples.points, nodes);
  const std::size_t launches = runtime.launches() - before;
  HostTrees found{testing::download(runtime, nodes, trees.nodes()), std::vector<cl_double2>(trees.samples()),
                  std::vector<cl_int>(2 * trees.samples())};
  runtime.read(samples.points, 0, found.samples.size(), found.samples.data());
  std::vector<cl_int> indices(trees.samples());
  runtime.read(samples.indices, 0, indices.size(), indices.data());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const cl_double2 drawn = point_of(all, static_cast<std::size_t>(indices[i]));
    EXPECT_TRUE(drawn.s[0] == found.samples[i].s[0] && drawn.s[1] == found.samples[i].s[1]) << i;
  }
  runtime.read(orders, 0, found.orders.size(), found.orders.data());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SCOPED_TRACE("set " + std::to_string(s));
    const auto& [coordinates, depth] = sets[s];
    check_device_tree(coordinates, depth, samples_per_leaf, found);
    if (::testing::Test::HasFatalFailure()) return launches;
    found.first_sample += samples_per_leaf << depth;
    found.first_node += std::size_t{1} << depth;
  }
  EXPECT_EQ(found.first_sample, trees.samples());
  EXPECT_EQ(found.first_node, trees.nodes());
  return launches;
}

/// Sets of many kinds, depths in no order, some of a single leaf, of fewer points than samples and of more.
std::vector<std::pair<Coordinates, int>> sets_of_all_depths(std::size_t points,
                                                            const std::vector<int>& depths) {
  std::vector<std::pair<Coordinates, int>> sets;
  std::size_t k = 0;
  for (const auto& [name, coordinates] : awkward(points, 31)) {
    sets.emplace_back(coordinates, depths[k % depths.size()]);
    sets.emplace_back(make_fixture("uniform", 1 + 3 * k, 32), 0);
    sets.emplace_back(make_fixture("uniform", 5 * points, k), depths[(k + 1) % depths.size()]);
    ++k;
  }
  return sets;
}

// Where no node is larger than a chunk: draw, sort, cut.
constexpr std::size_t kLeastLaunches = 3;

TEST(SmallCutTrees, AreThoseOfTheHost) {
  under_each_tuning([](Runtime& runtime) {
    for (const std::size_t samples_per_leaf : {1, 3, 16}) {
      SCOPED_TRACE(std::to_string(samples_per_leaf) + " samples a leaf");
      check_device_trees(runtime, {{make_fixture("uniform", 40, 1), 1}}, samples_per_leaf);
      check_device_trees(runtime, sets_of_all_depths(9, {1, 4, 2}), samples_per_leaf);
    }
  });
}

TEST(CutTrees, AreThoseOfTheHost) {
  under_each_tuning([](Runtime& runtime) {
    for (const std::size_t samples_per_leaf : {1, 16}) {
      SCOPED_TRACE(std::to_string(samples_per_leaf) + " samples a leaf");
      check_device_trees(runtime, sets_of_all_depths(1000, {5, 1, 9, 0, 3}), samples_per_leaf);
      for (const auto& [name, points] : awkward(30000, 33)) {
        SCOPED_TRACE(name);
        EXPECT_GT(check_device_trees(runtime, {{points, 12}}, samples_per_leaf), kLeastLaunches + 1);
      }
      for (const testing::Fixture& fixture : testing::all_fixtures()) {
        SCOPED_TRACE(fixture.name);
        check_device_trees(runtime, {{fixture.make(3000, 34), 7}}, samples_per_leaf);
      }
    }
  });
}

TEST(CutTrees, ManySetsTakeNoMoreLaunchesThanOne) {
  under_each_tuning([](Runtime& runtime) {
    std::vector<std::pair<Coordinates, int>> sets;
    for (std::size_t k = 0; k < 300; ++k) {
      sets.emplace_back(make_fixture("uniform", 100 + k, k), k % 7 == 0 ? 0 : 2);
    }
    sets.emplace_back(make_fixture("uniform", 2000, 5), 6);
    const std::size_t together = check_device_trees(runtime, sets, 16);
    // But for the scans of more counts.
    EXPECT_LE(together, 2 * check_device_trees(runtime, {sets.back()}, 16) + 20);
  });
}

// -----------------------------------------------------------------------------------------------------------
// Sorting

/// A runtime whose kernel files are the shared headers and tests/kernels/order.cl.
class OrderKernels {
 public:
  OrderKernels()
      : environment_("FLAUNAY_KERNEL_PATH", folder_.path().c_str()), runtime(host::find_device("")) {
    namespace fs = std::filesystem;
    const fs::path source = fs::path(FLAUNAY_TEST_DATA) / ".." / "..";
    fs::copy(source / "kernels" / "shared", fs::path(folder_.path()) / "shared");
    fs::copy(source / "tests" / "kernels" / "order.cl", folder_.path());
  }

 private:
  testing::TemporaryFolder folder_;
  testing::ScopedEnvironment environment_;

 public:
  Runtime runtime;
};

struct SortCase {
  std::string name;
  std::vector<cl_double2> points;
  std::vector<cl_uint> places;  ///< in the order of elements
};

std::vector<SortCase> sort_cases(const std::vector<std::size_t>& sizes, FixtureRandom& random) {
  std::vector<SortCase> cases;
  for (const std::size_t n : sizes) {
    auto inputs = awkward(n, n + 1);
    inputs.emplace_back("uniform", make_fixture("uniform", n, n));
    inputs.emplace_back("far away", make_fixture("far-away", n, n));
    inputs.emplace_back("log-spiral", make_fixture("log-spiral", n, n));
    for (const auto& [name, coordinates] : inputs) {
      SortCase one{name + ", " + std::to_string(n) + " points", points_of(coordinates),
                   std::vector<cl_uint>(n)};
      std::iota(one.places.begin(), one.places.end(), 0);
      cases.push_back(one);
      std::reverse(one.places.begin(), one.places.end());
      one.name += ", reversed";
      cases.push_back(one);
      random.shuffle(one.places);
      one.name += " and shuffled";
      cases.push_back(one);
    }
  }
  return cases;
}

/// The leading 24 of the bits in which the coordinates of the points differ.
std::vector<cl_uint> coarse_keys(const std::vector<cl_double2>& points, int axis) {
  std::vector<cl_ulong> keys;
  for (const cl_double2& p : points) {
    // The place in the order of doubles: of negative ones the bits descend.
    const double c = p.s[axis] == 0 ? 0.0 : p.s[axis];
    const double magnitude = std::fabs(c);
    cl_ulong bits = 0;
    std::memcpy(&bits, &magnitude, sizeof bits);
    keys.push_back(c < 0 ? (cl_ulong{1} << 63) - 1 - bits : (cl_ulong{1} << 63) + bits);
  }
  std::vector<cl_uint> coarse;
  if (keys.empty()) return coarse;
  const auto [least, most] = std::minmax_element(keys.begin(), keys.end());
  int dropped = 0;
  while ((*most - *least) >> dropped >= cl_ulong{1} << 24) ++dropped;
  for (const cl_ulong key : keys) coarse.push_back(static_cast<cl_uint>((key - *least) >> dropped));
  return coarse;
}

std::vector<cl_uint> places_of(const std::vector<cl_uint2>& elements, std::size_t first, std::size_t count) {
  std::vector<cl_uint> places;
  for (std::size_t i = first; i < first + count; ++i) places.push_back(elements[i].s[1]);
  return places;
}

/// What the tests met, so that they can say that they met it.
struct MetSorting {
  std::size_t finished = 0, given_up = 0, ties = 0;
};

void check_sorting(Runtime& runtime, const std::vector<SortCase>& cases, int axis, MetSorting& met) {
  SCOPED_TRACE("axis " + std::to_string(axis));
  const Arena::Scope scope(runtime.arena());
  std::vector<cl_int> offsets{0};
  std::vector<cl_double2> points;
  std::vector<cl_uint2> elements;
  for (const SortCase& one : cases) {
    points.insert(points.end(), one.points.begin(), one.points.end());
    for (const cl_uint place : one.places) elements.push_back({{0xdeadbeef, place}});
    offsets.push_back(static_cast<cl_int>(points.size()));
  }
  const std::size_t n = points.size();
  const auto device_offsets = testing::upload(runtime, offsets);
  const auto device_points = testing::upload(runtime, points);
  const auto spare = testing::guarded<cl_uint2>(runtime, n);
  const auto sorted = testing::guarded<cl_uint2>(runtime, n);
  const auto coarse = testing::guarded<cl_uint2>(runtime, n);
  const auto finished = testing::guarded<cl_int>(runtime, cases.size());
  const auto ties = testing::guarded<cl_uint2>(runtime, n);
  const auto merged = testing::guarded<cl_uint2>(runtime, n);
  const auto uploaded = testing::upload(runtime, elements);
  const auto again = testing::upload(runtime, elements);
  runtime.map("order", "sort_cases", cases.size(), cl_int{axis}, device_offsets, device_points, uploaded,
              spare, sorted);
  runtime.map("order", "sort_steps", cases.size(), cl_int{axis}, device_offsets, device_points, again, spare,
              coarse, finished, ties, merged);
  const auto host_sorted = testing::download(runtime, sorted, n);
  const auto host_coarse = testing::download(runtime, coarse, n);
  const auto host_finished = testing::download(runtime, finished, cases.size());
  const auto host_ties = testing::download(runtime, ties, n);
  const auto host_merged = testing::download(runtime, merged, n);
  testing::download(runtime, spare, n);
  testing::download(runtime, uploaded, n);

  for (std::size_t c = 0; c < cases.size(); ++c) {
    const SortCase& one = cases[c];
    SCOPED_TRACE(one.name);
    const auto first = static_cast<std::size_t>(offsets[c]);
    const std::size_t size = one.places.size();
    std::vector<cl_uint> expected = one.places;
    std::stable_sort(expected.begin(), expected.end(),
                     [&](cl_uint i, cl_uint j) { return comes_first(one.points[i], one.points[j], axis); });
    EXPECT_TRUE(same(places_of(host_sorted, first, size), expected));
    EXPECT_TRUE(same(places_of(host_merged, first, size), expected));

    const std::vector<cl_uint> keys = coarse_keys(one.points, axis);
    std::vector<cl_uint2> by_key;
    for (const cl_uint place : one.places) by_key.push_back({{keys[place], place}});
    std::stable_sort(by_key.begin(), by_key.end(),
                     [](const cl_uint2& a, const cl_uint2& b) { return a.s[0] < b.s[0]; });
    const auto begin = host_coarse.begin() + static_cast<std::ptrdiff_t>(first);
    EXPECT_TRUE(same(std::vector<cl_uint2>(begin, begin + static_cast<std::ptrdiff_t>(size)), by_key));

    // Insertion moves an element past those of its key that it precedes; given up beyond four a point.
    std::size_t moves = 0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = i; j > 0 && by_key[j - 1].s[0] == by_key[i].s[0] && moves <= 4 * size; --j) {
        moves += comes_first(one.points[by_key[i].s[1]], one.points[by_key[j - 1].s[1]], axis);
      }
    }
    EXPECT_EQ(host_finished[c], moves <= 4 * size ? 1 : 0);
    if (moves <= 4 * size) {
      EXPECT_TRUE(same(places_of(host_ties, first, size), expected));
    }
    met.ties += moves > 0;
    ++(moves <= 4 * size ? met.finished : met.given_up);
  }
}

void check_sorting(const std::vector<std::size_t>& sizes) {
  OrderKernels kernels;
  FixtureRandom random(4);
  const std::vector<SortCase> cases = sort_cases(sizes, random);
  MetSorting met;
  for (const int axis : {0, 1}) check_sorting(kernels.runtime, cases, axis, met);
  EXPECT_GT(met.finished, 20u);
  EXPECT_GT(met.given_up, 3u);
  EXPECT_GT(met.ties, 10u);
}

TEST(SmallOrder, SortsStablyByExactComparison) { check_sorting({0, 1, 2, 3, 17, 40}); }

TEST(Order, SortsStablyByExactComparison) { check_sorting({0, 1, 2, 255, 256, 257, 5000}); }

// -----------------------------------------------------------------------------------------------------------
// Stages

/// What the tests met.
struct Met {
  std::size_t merges = 0, empty_blocks = 0, large_blocks = 0, duplicates = 0, flat = 0, triangles = 0;
};

void check_blocks(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                  const Buffer<cl_int>& representatives, HostRings& g, Met& met) {
  SCOPED_TRACE("blocks");
  const testing::IngestTwin ingest = testing::ingest_twin(coordinates, offsets);
  const std::size_t n = offsets.back();
  const BlocksTwin twin(coordinates, offsets, call.runtime.tuning().block_points, ingest.shift,
                        sample_indices);
  EXPECT_EQ(blocks.sets, offsets.size() - 1);
  EXPECT_EQ(blocks.points, n);
  ASSERT_TRUE(same(blocks.set_blocks, twin.set_blocks));
  ASSERT_TRUE(same(blocks.offsets, twin.offsets));
  ASSERT_EQ(blocks.count, twin.offsets.size() - 1);
  EXPECT_TRUE(same(call.read(blocks.device_set_blocks, blocks.set_blocks.size()), twin.set_blocks));
  EXPECT_TRUE(same(call.read(blocks.device_offsets, blocks.offsets.size()), twin.offsets));
  EXPECT_TRUE(same(call.read(blocks.source, n), twin.source));
  EXPECT_TRUE(same(call.read(blocks.vertices, n), twin.vertices));
  std::vector<cl_int> identity(n);
  std::iota(identity.begin(), identity.end(), 0);
  EXPECT_TRUE(same(call.read(representatives, n), identity));
  EXPECT_EQ(testing::broken_nodes(call.read(blocks.device_nodes, blocks.device_nodes.size()), twin.trees),
            "");
  EXPECT_EQ(testing::broken_merges(blocks, twin.trees, g.spans), "");
  const auto merges = call.read(blocks.device_merges, blocks.merges.size());
  for (std::size_t m = 0; m < merges.size(); ++m) {
    EXPECT_TRUE(merges[m].low == blocks.merges[m].low && merges[m].high == blocks.merges[m].high &&
                merges[m].node == blocks.merges[m].node)
        << "merge " << m << " on the device";
  }
  EXPECT_EQ(call.work.bounds.orient == 0, ingest.bits <= 25);
  EXPECT_EQ(call.work.bounds.circle == 0, ingest.bits <= 11);
  g.set_blocks = twin.set_blocks;
  g.offsets = twin.offsets;
  g.vertices = twin.vertices;
  g.source = twin.source;
  met.merges += merges.size();
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const auto size = static_cast<std::size_t>(blocks.offsets[b + 1] - blocks.offsets[b]);
    met.empty_blocks += size == 0;
    met.large_blocks += size > 4 * call.runtime.tuning().block_points;
  }
}

/// Sets of up to so many points are held against the reference, too.
constexpr std::size_t kReferencePoints = 130;

void check_rings(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                 const Rings& rings, const std::vector<cl_int>& representatives, HostRings& g, Met& met) {
  SCOPED_TRACE("rings");
  const std::size_t n = offsets.back();
  EXPECT_TRUE(same(representatives, testing::ingest_twin(coordinates, offsets).representatives));
  const HostRings before = g;
  g.vertices = call.read(blocks.vertices, n);
  g.source = call.read(blocks.source, n);
  ASSERT_EQ(rings.edges.size(), testing::kEdgesPerPoint * n);
  g.edges = call.read(rings.edges, rings.edges.size());
  g.vertex_edge = call.read(rings.vertex_edge, n);
  g.block_ends = call.read(rings.block_ends, blocks.count);
  g.distinct = rings.distinct;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    ASSERT_EQ(testing::broken_vertices(g, b, before), "");
  }
  for (std::size_t s = 0; s < g.sets(); ++s) {
    RingCheck check(g, s);
    ASSERT_EQ(check.run(), "") << "set " << s;
    const auto size = offsets[s + 1] - offsets[s];
    if (size > kReferencePoints) continue;
    std::vector<std::int32_t> expected =
        testing::flat_triangles(testing::reference_delaunay(coordinates.data() + 2 * offsets[s], size));
    for (std::int32_t& i : expected) i += static_cast<std::int32_t>(offsets[s]);
    ASSERT_TRUE(same(testing::flat_triangles(testing::sorted_triangles(check.triangles())), expected))
        << "set " << s;
    met.flat += expected.empty();
  }
  for (std::size_t i = 0; i < n; ++i) met.duplicates += representatives[i] != static_cast<cl_int>(i);
}

// As callers do it.
void run_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, Triangulation& result) {
  Runtime& runtime = call.runtime;
  host::Arena::Scope scope(runtime.arena());
  MeshSizes sizes = count_mesh(call.work, blocks, rings);
  const std::size_t rows = 3 * sizes.triangles();
  result.triangles.assign(rows, -7);
  result.neighbors.assign(neighbors ? rows : 0, -7);
  result.halfedges.assign(neighbors ? rows : 0, -7);
  result.hull.assign(sizes.hull_vertices(), -7);
  MeshBuffers buffers;
  buffers.triangles = runtime.output(result.triangles);
  if (neighbors) buffers.neighbors = runtime.output(result.neighbors);
  if (neighbors) buffers.halfedges = runtime.output(result.halfedges);
  buffers.hull = runtime.output(result.hull);
  write_mesh(call.work, blocks, rings, sizes, buffers);
  runtime.fetch_later(buffers.triangles, result.triangles);
  runtime.fetch_later(buffers.neighbors, result.neighbors);
  runtime.fetch_later(buffers.halfedges, result.halfedges);
  runtime.fetch_later(buffers.hull, result.hull);
  runtime.finish();
  result.triangle_offsets = sizes.triangle_offsets;
  result.hull_offsets = sizes.hull_offsets;
  result.statistics.duplicates = blocks.points - sizes.vertices;
}

void check_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, const HostRings& g,
                Triangulation& result, Met& met) {
  SCOPED_TRACE(neighbors ? "mesh with neighbours" : "mesh without neighbours");
  const MeshTwin twin(g);
  call.runtime.write(rings.edges, 0, g.edges.size(), g.edges.data());
  run_mesh(call, blocks, rings, neighbors, result);
  EXPECT_TRUE(same(result.triangle_offsets, twin.triangle_offsets));
  EXPECT_TRUE(same(result.hull_offsets, twin.hull_offsets));
  EXPECT_TRUE(same(result.triangles, twin.triangles));
  EXPECT_TRUE(same(result.hull, twin.hull));
  EXPECT_TRUE(same(result.neighbors,
                   neighbors ? testing::reference_neighbors(twin.triangles) : std::vector<std::int32_t>()));
  EXPECT_TRUE(same(result.halfedges,
                   neighbors ? testing::reference_halfedges(twin.triangles) : std::vector<std::int32_t>()));
  EXPECT_EQ(result.statistics.duplicates, blocks.points - twin.vertices);
  // The rings stay as they are, but for what says that the outside is on an edge's left.
  const auto edges = call.read(rings.edges, g.edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    ASSERT_EQ(edges[e].to, g.edges[e].to) << "edge " << e;
    if (edges[e].to == testing::kNone) continue;
    const cl_int next = g.edges[e].next;
    ASSERT_EQ(edges[e].next, twin.outside.count(static_cast<cl_int>(e)) ? ~next : next) << "edge " << e;
    ASSERT_EQ(edges[e].previous, g.edges[e].previous) << "edge " << e;
  }
  met.triangles += twin.triangles.size() / 3;
}

/// exact: no filter decides anything.
Triangulation check_stages(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets, Met& met,
                           bool exact = false) {
  Call call(runtime);
  Triangulation result;
  // Not yet written, as the library's caller has it.
  result.representatives.assign(offsets.back(), -7);
  const auto representatives = runtime.output(result.representatives);
  const Blocks blocks = make_blocks(call.work, call.runtime.view(coordinates.data(), coordinates.size()),
                                    offsets, representatives);
  HostRings g;
  check_blocks(call, coordinates, offsets, blocks, representatives, g, met);
  if (::testing::Test::HasFatalFailure()) return result;
  if (exact) call.work.bounds = {2, 2, 2};
  Rings rings = divide(call.work, blocks, representatives);
  await_rings(call.work, blocks, rings);
  runtime.fetch_later(representatives, result.representatives);
  runtime.finish();
  check_rings(call, coordinates, offsets, blocks, rings, result.representatives, g, met);
  if (::testing::Test::HasFatalFailure()) return result;
  check_mesh(call, blocks, rings, false, g, result, met);
  check_mesh(call, blocks, rings, true, g, result, met);
  return result;
}

void check_stages(Runtime& runtime, const Coordinates& coordinates, Met& met, bool exact = false) {
  check_stages(runtime, coordinates, {0, coordinates.size() / 2}, met, exact);
}

/// Subsets of the points of a grid, of `least` to `most` points, all as sets of one call.
Nested subsets(int width, int height, int least, int most,
               const std::function<cl_double2(double, double)>& place) {
  Nested all;
  for (unsigned subset = 0; subset < 1u << (width * height); ++subset) {
    Coordinates points;
    for (int i = 0; i < width * height; ++i) {
      if ((subset >> i & 1) == 0) continue;
      const cl_double2 p = place(i / height, i % height);
      points.insert(points.end(), {p.s[0], p.s[1]});
    }
    const int size = static_cast<int>(points.size() / 2);
    if (size >= least && size <= most) all.add(points);
  }
  return all;
}

/// Grids as they are, of many bits, and sheared, so that no two points are in a column.
const std::vector<std::pair<std::string, std::function<cl_double2(double, double)>>> kGrids{
    {"grid",
     [](double x, double y) {
       return cl_double2{{x, y}};
     }},
    {"grid of many bits",
     [](double x, double y) {
       return cl_double2{{x * (1 + 0x1p-45), y * (1 + 0x1p-45)}};
     }},
    {"turned grid",
     [](double x, double y) {
       return cl_double2{{5 * x - 3 * y, 3 * x + 5 * y}};
     }},
    {"bent grid", [](double x, double y) {
       return cl_double2{{x + 0x1p-50 * x * x, y - 0x1p-50 * x * y}};
     }}};

TEST(SmallStages, AllSubsetsOfASmallGrid) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    const Nested sets = subsets(3, 2, 0, 4, kGrids[1].second);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.flat, 10u);
    EXPECT_GT(met.triangles, 20u);
  });
}

TEST(Stages, AllSubsetsOfAGrid) {
  under_each_tuning([](Runtime& runtime) {
    for (const auto& [name, place] : kGrids) {
      SCOPED_TRACE(name);
      Met met;
      const Nested sets = subsets(4, 4, 1, 4, place);
      ASSERT_EQ(sets.offsets.size() - 1, 16u + 120 + 560 + 1820);
      check_stages(runtime, sets.coordinates, sets.offsets, met);
      EXPECT_GT(met.triangles, 2500u);
      const Nested larger = subsets(4, 3, 5, 12, place);
      check_stages(runtime, larger.coordinates, larger.offsets, met, true);
    }
  });
}

/// Two empty sets, one point, all sizes about that of a block.
Nested sizes_about_blocks(std::size_t block_points, std::size_t most, std::uint64_t seed) {
  Nested all;
  all.add({});
  all.add({});
  all.add({0.25, -0.0});
  for (std::size_t size = block_points; size <= most; size *= 2) {
    for (const std::size_t n : {size - 1, size, size + 1}) {
      FixtureRandom random(seed + n);
      all.add(make_fixture("uniform", n, seed + n));
      all.add(coarse(n, 4, 4, random));
      if (n % 3 == 0) all.add({});
    }
  }
  all.add({});
  return all;
}

TEST(SmallStages, SetsOfAllSizes) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    const Nested sets = sizes_about_blocks(6, 12, 5);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.duplicates, 5u);
  });
}

TEST(Stages, SetsOfSizesAboutBlocks) {
  under_each_tuning([](Runtime& runtime) {
    const std::size_t block = runtime.tuning().block_points;
    Met met;
    const Nested sets = sizes_about_blocks(block, std::max<std::size_t>(2 * block, 200), 6);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.merges, 10u);
  });
}

TEST(SmallStages, AwkwardInput) {
  under_each_tuning([](Runtime& runtime) {
    for (const auto& [name, points] : awkward(26, 7)) {
      SCOPED_TRACE(name);
      Met met;
      check_stages(runtime, points, met);
    }
  });
}

TEST(Stages, AwkwardInput) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const std::size_t n : {26, 120, 2500}) {
      for (const auto& [name, points] : awkward(n, 8)) {
        SCOPED_TRACE(name + ", " + std::to_string(n) + " points");
        check_stages(runtime, points, met, n == 120);
      }
    }
    if (runtime.tuning().block_points > 100) return;
    EXPECT_GT(met.empty_blocks, 100u);
    EXPECT_GT(met.large_blocks, 10u);
  });
}

TEST(SmallStages, Fixtures) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const char* const name : {"uniform", "integer-star", "slender"}) {
      SCOPED_TRACE(name);
      check_stages(runtime, make_fixture(name, 20, 9), met);
    }
    check_stages(runtime, make_fixture("ladder", 13, 9), met, true);
  });
}

TEST(Stages, Fixtures) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const testing::Fixture& fixture : testing::all_fixtures()) {
      SCOPED_TRACE(fixture.name);
      check_stages(runtime, fixture.make(kReferencePoints, 10), met);
      const Coordinates some = fixture.make(60, 11);
      check_stages(runtime, some, met, true);
      check_stages(runtime, testing::perturbed(some, 12), met);
      check_stages(runtime, fixture.make(1500, 13), met);
    }
  });
}

TEST(Stages, ThousandsOfTinySets) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(14);
    Nested sets;
    for (int s = 0; s < 4000; ++s)
      sets.add(coarse(static_cast<std::size_t>(random.integer(0, 9)), 5, 4, random));
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.flat, 500u);
    EXPECT_GT(met.duplicates, 500u);
    EXPECT_GT(met.triangles, 5000u);
  });
}

TEST(Stages, SetsOfVeryDifferentSizes) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(15);
    Nested sets;
    for (const std::size_t n : {3, 5000, 0, 7, 40, 800, 1, 0, 12}) sets.add(make_fixture("uniform", n, n));
    sets.add(coarse(700, 20, 20, random));
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.duplicates, 200u);
  });
}

TEST(Stages, OneLargeSet) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    runtime.arena().reset_peak();
    check_stages(runtime, make_fixture("uniform", 20000, 16), met);
    // However small blocks and chunks are, with 16 samples for each; a table of both would be larger.
    EXPECT_LT(runtime.arena().peak_bytes(), 20000u * 1600);
    EXPECT_GE(met.merges, 15u);
    check_stages(runtime, make_fixture("grid", 12000, 17), met);
  });
}

/// What tells blocks of many equal points from others is their size: on both sides of it.
TEST(SmallStages, BlocksAboutTheRoomOfManyWorkers) {
  under_each_tuning([](Runtime& runtime) {
    const std::size_t block = std::min<std::size_t>(runtime.tuning().block_points, 13);
    Met met;
    for (const std::size_t n : {4 * block, 4 * block + 1}) {
      Nested sets;
      sets.add(Coordinates(2 * n, 0.5));
      sets.add(make_fixture("uniform", 9, n));
      check_stages(runtime, sets.coordinates, sets.offsets, met);
    }
    EXPECT_EQ(met.large_blocks, runtime.tuning().block_points <= 13 ? 1u : 0u);
  });
}

/// Rows and all do not depend on who does which block, on chunks, nor on whose memory it is.
TEST(Stages, ResultsDoNotDependOnTuning) {
  Nested sets;
  sets.add(make_fixture("uniform", 900, 18));
  sets.add(make_fixture("random-integers", 30, 19));
  sets.add(make_fixture("ladder", 300, 20));
  for (const std::size_t block_points : {2, 6, 64}) {
    std::vector<Triangulation> results;
    for (const int variant : {0, 1, 2, 3}) {
      Runtime runtime(host::find_device(""));
      Tuning tuning = runtime.tuning();
      tuning.block_points = block_points;
      tuning.block_workers = std::array<std::size_t, 4>{1, 3, 64, 5000}[static_cast<std::size_t>(variant)];
      tuning.chunk_least = std::array<std::size_t, 4>{2, 7, 100, 2000}[static_cast<std::size_t>(variant)];
      tuning.chunks_most = variant == 2 ? 3 : 0;
      if (runtime.device().type() & CL_DEVICE_TYPE_CPU) tuning.in_host_memory = variant % 2;
      tuning.separate_buffers = variant == 3;
      runtime.set_tuning(tuning);
      Met met;
      results.push_back(check_stages(runtime, sets.coordinates, sets.offsets, met));
    }
    for (const Triangulation& result : results) {
      EXPECT_TRUE(same(result.triangles, results[0].triangles));
      EXPECT_TRUE(same(result.neighbors, results[0].neighbors));
      EXPECT_TRUE(same(result.hull, results[0].hull));
    }
  }
}

TEST(SmallStages, BadInputIsRefused) {
  Runtime& runtime = Runtimes::get("own");
  const auto message = [&](const Coordinates& coordinates) {
    Call call(runtime);
    std::vector<cl_int> representatives(coordinates.size() / 2);
    const auto output = runtime.output(representatives);
    try {
      make_blocks(call.work, runtime.view(coordinates.data(), coordinates.size()),
                  {0, coordinates.size() / 2}, output);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({0, 0, 1, 0, 0, std::nan(""), HUGE_VAL, 0}).find("point 2 is not finite"),
            std::string::npos);
  EXPECT_NE(message({0, 0, -HUGE_VAL, 0, 0, 1, 1, 1}).find("point 1 is not finite"), std::string::npos);
  EXPECT_NE(message({0x1p300, 0, 1, 0x1p-300, 0, 1}).find("magnitudes differ too much"), std::string::npos);
}

TEST(SmallStages, NumbersThatDoNotFitAreReported) {
  Runtime& runtime = Runtimes::get("own");
  const Coordinates coordinates = make_fixture("uniform", 10, 21);
  Call call(runtime);
  Triangulation result;
  result.representatives.resize(10);
  const auto representatives = runtime.output(result.representatives);
  const Blocks blocks =
      make_blocks(call.work, runtime.view(coordinates.data(), 20), {0, 10}, representatives);
  Rings rings = divide(call.work, blocks, representatives);
  await_rings(call.work, blocks, rings);
  const auto edges = call.read(rings.edges, rings.edges.size());
  run_mesh(call, blocks, rings, true, result);
  const cl_int right = rings.distinct[0];
  for (const cl_int wrong : {right - 1, right + 1}) {
    rings.distinct[0] = wrong;
    runtime.write(rings.edges, 0, edges.size(), edges.data());
    try {
      run_mesh(call, blocks, rings, true, result);
      ADD_FAILURE() << "nothing was noticed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::internal);
      EXPECT_NE(std::string(error.what()).find("triangles instead of"), std::string::npos) << error.what();
    }
  }
}

/// Two triangles over a square, by hand, in a block with room for more.
HostRings square_rings() {
  HostRings g;
  g.set_blocks = {0, 1};
  g.offsets = {0, 4};
  g.spans = {1};
  g.vertices = {{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}};
  g.source = {0, 1, 2, 3};
  g.distinct = {4};
  // Vertices 0 to 3 counter-clockwise, edges 2k from k to k + 1, and 8 from 0 to 2.
  g.edges = {{1, 8, 7}, {0, 2, 2}, {2, 1, 1}, {1, 4, 9}, {3, 9, 3},
             {2, 6, 6}, {0, 5, 5}, {3, 0, 8}, {2, 7, 0}, {0, 3, 4}};
  for (cl_int e = 10; e < 24; ++e) g.edges.push_back({-1, e % 2 == 0 && e < 22 ? e + 2 : -1, e});
  g.vertex_edge = {0, 2, 4, 6};
  g.block_ends = {{{0, 2, 1, 3}}};
  return g;
}

/// Edges that merges removed stay as they were but for what says so; divide() happens to use all of them
/// again.
TEST(SmallStages, RemovedEdgesAreNoTriangles) {
  Runtime& runtime = Runtimes::get("own");
  HostRings g = square_rings();
  for (const cl_int e : {11, 13}) g.edges[static_cast<std::size_t>(e)].previous = e + 1;
  ASSERT_EQ(RingCheck(g, 0).run(), "");
  Call call(runtime);
  Blocks blocks;
  blocks.sets = blocks.count = 1;
  blocks.points = g.vertices.size();
  blocks.set_blocks = g.set_blocks;
  blocks.offsets = g.offsets;
  blocks.device_set_blocks = testing::upload(runtime, g.set_blocks);
  blocks.device_offsets = testing::upload(runtime, g.offsets);
  blocks.vertices = testing::upload(runtime, g.vertices);
  blocks.source = testing::upload(runtime, g.source);
  Rings rings;
  rings.edges = call.work.persistent.allocate<RingEdge>(g.edges.size());
  runtime.write(rings.edges, 0, g.edges.size(), g.edges.data());
  rings.vertex_edge = testing::upload(runtime, g.vertex_edge);
  rings.block_ends = testing::upload(runtime, g.block_ends);
  rings.distinct = g.distinct;
  Met met;
  Triangulation result;
  check_mesh(call, blocks, rings, true, g, result, met);
  EXPECT_EQ(met.triangles, 2u);
}

// -----------------------------------------------------------------------------------------------------------
// The twins themselves

/// What RingCheck says when something of the rings is changed.
TEST(SmallTwins, RingCheckFindsWhatIsBroken) {
  const HostRings g = square_rings();
  RingCheck unchanged(g, 0);
  ASSERT_EQ(unchanged.run(), "");
  EXPECT_EQ(unchanged.triangles(), (std::vector<std::int32_t>{0, 1, 2, 2, 3, 0}));
  const MeshTwin mesh(g);
  EXPECT_EQ(mesh.triangles, (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.hull, (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.outside, (std::set<cl_int>{1, 3, 5, 7}));

  const auto found = [&](const std::function<void(HostRings&)>& change) {
    HostRings changed = g;
    change(changed);
    return RingCheck(changed, 0).run();
  };
  EXPECT_EQ(found([](HostRings& h) { h.edges[1].to = -1; }), "edge 0 is half used");
  EXPECT_EQ(found([](HostRings& h) { h.edges[11].previous = 24; }), "edge 11 is before none");
  EXPECT_EQ(found([](HostRings& h) { h.edges[0].previous = 8; }), "the edge after 7 does not point back");
  EXPECT_EQ(found([](HostRings& h) { h.edges[1].next = 4; }), "edge 1 is in the ring of another vertex");
  EXPECT_EQ(found([](HostRings& h) { h.edges[14].next = -1; }), "2 free lists");
  EXPECT_EQ(found([](HostRings& h) { h.edges[14].next = 4; }), "2 free lists");
  EXPECT_EQ(found([](HostRings& h) { h.vertex_edge[1] = 3; }), "vertex 1 has the edge of another");
  EXPECT_EQ(found([](HostRings& h) { h.vertex_edge[1] = 1; }), "the hull's corner 1 has another edge");
  EXPECT_EQ(found([](HostRings& h) { h.block_ends[0].s[1] = 1; }), "end 1 of block 0");
  EXPECT_EQ(found([](HostRings& h) {
              h.edges[0].next = 7, h.edges[7].next = 8, h.edges[8].next = 0;
              h.edges[0].previous = 8, h.edges[7].previous = 0, h.edges[8].previous = 7;
            }),
            "the ring of vertex 0 turns 2 times");
  EXPECT_EQ(found([](HostRings& h) { h.vertices[0] = {{4, 1}}; }).substr(0, 8), "the ring");
  // A corner inwards: the other diagonal, whatever its circles.
  EXPECT_EQ(found([](HostRings& h) { h.vertices[0] = {{0.5, 0.5}}; }).substr(0, 3), "end");
  EXPECT_EQ(found([](HostRings& h) { h.vertices[2] = {{5, 3}}; }), "vertex 1 is in the circle across edge 8");
  // On one circle, but numbered so that the diagonal misses the first.
  EXPECT_EQ(found([](HostRings& h) {
              std::rotate(h.vertices.begin(), h.vertices.begin() + 1, h.vertices.end());
              h.block_ends[0] = {{3, 1, 0, 2}};
            }),
            "edge 8 is not the canonical diagonal");
}

/// Whatever a stage launches on ordinary and degenerate input is all there is: no kernel is left over, none
/// untested.
TEST(Kernels, AllAreLaunched) {
  std::set<std::string> launched;
  Runtime& runtime = Runtimes::get("odd");
  runtime.set_profiling(true);
  Met met;
  check_stages(runtime, make_fixture("uniform", 100, 22), met);
  for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
  runtime.set_profiling(false);
  std::size_t kernels = 0;
  for (const char* const file : {"blocks", "divide", "mesh"}) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, 17u);
}

}  // namespace
}  // namespace flaunay::hybrid
