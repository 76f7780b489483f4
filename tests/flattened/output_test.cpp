// The stage `output`: rows by their smallest index, in the order of sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "host/launch/vector_operations.hpp"
#include "launchers/flattened/output.cl.hpp"
#include "tests/flattened/support.hpp"
#include "tests/support/neighbors_twin.hpp"

namespace flaunay::flattened {

void check_output(Runtime& runtime, const TriangleSet& mesh, FixtureRandom& random) {
  Call call(runtime);
  constexpr int kIds = 300;
  const std::vector<cl_int> triangles = scrambled(mesh, kIds - 1, random);
  const std::size_t count = triangles.size() / 3;
  const std::vector<cl_int> twins = testing::twins_twin(triangles);
  std::vector<cl_int> source(kIds);
  std::iota(source.begin(), source.end(), 1000);
  random.shuffle(source);
  std::vector<cl_int> expected_rows, expected_neighbors;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::pair<cl_int, cl_int>, 3> row;  // vertex, triangle opposite to it
    for (std::size_t j = 0; j < 3; ++j) {
      const cl_int twin = twins[3 * t + (j + 1) % 3];
      row[j] = {source[static_cast<std::size_t>(triangles[3 * t + j])], twin < 0 ? -1 : twin / 3};
    }
    std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
    for (const auto& [vertex, neighbor] : row) {
      expected_rows.push_back(vertex);
      expected_neighbors.push_back(neighbor);
    }
  }
  const auto device_triangles = testing::upload(runtime, triangles);
  const auto device_twins = testing::upload(runtime, twins);
  const auto device_source = testing::upload(runtime, source);
  for (const int with_neighbors : {1, 0}) {
    const auto rows = testing::guarded<cl_int>(runtime, 3 * count);
    const auto neighbors = testing::guarded<cl_int>(runtime, with_neighbors ? 3 * count : 0);
    runtime.map(count, kernels::finish_rows{.with_neighbors = with_neighbors,
                                            .triangles = device_triangles,
                                            .twins = device_twins,
                                            .source = device_source,
                                            .rows = rows,
                                            .neighbors = neighbors});
    EXPECT_TRUE(same(testing::download(runtime, rows, 3 * count), expected_rows));
    const auto found = testing::download(runtime, neighbors, with_neighbors ? 3 * count : 0);
    if (with_neighbors) {
      EXPECT_TRUE(same(found, expected_neighbors));
    }
  }
  // What callers rely on, by another way.
  EXPECT_TRUE(same(expected_neighbors, testing::reference_neighbors(expected_rows)));

  const auto indices = testing::guarded<cl_int>(runtime, triangles.size());
  runtime.map(triangles.size(),
              kernels::map_ids{.ids = device_triangles, .source = device_source, .indices = indices});
  std::vector<cl_int> expected_indices;
  for (const cl_int id : triangles) expected_indices.push_back(source[static_cast<std::size_t>(id)]);
  EXPECT_TRUE(same(testing::download(runtime, indices, triangles.size()), expected_indices));

  // Several sets: stably by the set of a triangle's vertices.
  constexpr std::size_t kSets = 7;
  std::vector<cl_int> set_of_id(kIds);
  for (cl_int& set : set_of_id) set = static_cast<cl_int>(random.integer(0, kSets - 1));
  const auto set_of = [&](std::size_t t) { return set_of_id[static_cast<std::size_t>(triangles[3 * t])]; };
  std::vector<cl_uint> expected_counts(kSets, 0);
  std::vector<cl_ulong> expected_keys;
  std::vector<cl_int> identity(count);
  std::iota(identity.begin(), identity.end(), 0);
  for (std::size_t t = 0; t < count; ++t) {
    ++expected_counts[static_cast<std::size_t>(set_of(t))];
    expected_keys.push_back(static_cast<cl_ulong>(set_of(t)));
  }
  std::vector<cl_int> by_set = identity;
  std::stable_sort(by_set.begin(), by_set.end(), [&](int t, int u) {
    return set_of(static_cast<std::size_t>(t)) < set_of(static_cast<std::size_t>(u));
  });
  const auto keys = testing::guarded<cl_ulong>(runtime, count);
  const auto order = testing::guarded<cl_int>(runtime, count);
  const auto counts = testing::upload(runtime, std::vector<cl_uint>(kSets, 0));
  runtime.map(count, kernels::triangle_sets{.triangles = device_triangles,
                                            .set_of_id = testing::upload(runtime, set_of_id),
                                            .keys = keys,
                                            .order = order,
                                            .counts = counts});
  EXPECT_TRUE(same(testing::download(runtime, keys, count), expected_keys));
  EXPECT_TRUE(same(testing::download(runtime, order, count), identity));
  EXPECT_TRUE(same(testing::download(runtime, counts, kSets), expected_counts));
  host::sort_by_key(runtime, keys, order, count);
  const auto reordered = testing::guarded<cl_int>(runtime, 3 * count);
  runtime.map(count, kernels::reorder_triangles{
                         .order = order, .triangles = device_triangles, .reordered = reordered});
  std::vector<cl_int> expected_reordered;
  for (const int t : by_set) {
    expected_reordered.insert(expected_reordered.end(), triangles.begin() + 3 * t,
                              triangles.begin() + 3 * t + 3);
  }
  EXPECT_TRUE(same(testing::download(runtime, reordered, 3 * count), expected_reordered));

  // Their twins go along.
  const auto places = testing::guarded<cl_int>(runtime, count);
  const auto reordered_twins = testing::guarded<cl_int>(runtime, 3 * count);
  runtime.map(count, kernels::triangle_places{.order = order, .places = places});
  runtime.map(count,
              kernels::reorder_twins{
                  .order = order, .places = places, .twins = device_twins, .reordered = reordered_twins});
  EXPECT_TRUE(
      same(testing::download(runtime, reordered_twins, 3 * count), testing::twins_twin(expected_reordered)));
}

namespace {

TEST(SmallOutput, Rows) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(21);
    check_output(runtime, testing::reference_delaunay(make_fixture("uniform", 20, 22)), random);
  });
}

TEST(Output, Rows) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(23);
    for (const char* const name : {"uniform", "grid", "integer-star"}) {
      check_output(runtime, testing::reference_delaunay(make_fixture(name, 250, 24)), random);
    }
  });
}

}  // namespace

}  // namespace flaunay::flattened
