// The stage `chains`: hulls of sequences, and what brings points into the order of sequences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "launchers/flattened/chains.cl.hpp"
#include "shared/limits.h"
#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

constexpr std::size_t kGroups[] = {1, 5, 32, 64, 256};
constexpr Bounds kFiltered{1e-14, 1e-14, 1e-14};

/// The distinct points.
std::vector<cl_double2> places_of(const Coordinates& coordinates) {
  std::set<std::pair<double, double>> distinct;
  for (std::size_t i = 0; i < coordinates.size() / 2; ++i) {
    distinct.insert({coordinates[2 * i] + 0.0, coordinates[2 * i + 1] + 0.0});
  }
  std::vector<cl_double2> places;
  for (const auto& [x, y] : distinct) places.push_back({{x, y}});
  return places;
}

/// Regions of all axes, whose cuts go through points.
std::vector<Frame> random_frames(const std::vector<cl_double2>& places, std::size_t count,
                                 FixtureRandom& random) {
  std::vector<Frame> frames;
  for (std::size_t r = 0; r < count; ++r) {
    Frame frame{static_cast<int>(r % 4), 0.0};
    const auto any = random.integer(0, static_cast<std::int64_t>(places.size()) - 1);
    frame.q = frame.s(places[static_cast<std::size_t>(any)]);
    frames.push_back(frame);
  }
  return frames;
}

/// Ids in the order of u; of one u in random order, and some several times.
std::vector<int> random_sequence(const std::vector<cl_double2>& places, const Frame& frame, std::size_t size,
                                 FixtureRandom& random) {
  std::vector<int> ids;
  for (std::size_t i = 0; i < size; ++i) {
    ids.push_back(static_cast<int>(random.integer(0, static_cast<std::int64_t>(places.size()) - 1)));
  }
  std::stable_sort(ids.begin(), ids.end(),
                   [&](int a, int b) { return frame.u(places[a]) < frame.u(places[b]); });
  return ids;
}

Level level_of_frames(Runtime& runtime, const std::vector<Frame>& frames) {
  std::vector<cl_int> axes;
  std::vector<cl_double> cuts;
  for (const Frame& frame : frames) {
    axes.push_back(frame.axis);
    cuts.push_back(frame.q);
  }
  Level level;
  level.regions = frames.size();
  level.axis = testing::upload(runtime, axes);
  level.cut = testing::upload(runtime, cuts);
  return level;
}

/// Sizes of segments: none, one element, few of each, one huge one, and mixed.
std::vector<std::vector<std::size_t>> sizes_of_regions(std::size_t huge) {
  return {
      {0}, {1}, {0, 0, 1, 0}, std::vector<std::size_t>(70, 2), {huge}, {3, 0, huge / 3, 1, 300, 7, 0, 64}};
}

/// The hulls of sequences, by groups of some sizes, and their paths.
void check_chains(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& sizes,
                  const Bounds& bounds, FixtureRandom& random) {
  const std::vector<cl_double2> places = places_of(coordinates);
  const ExactPoints points(places);
  const std::vector<Frame> frames = random_frames(places, sizes.size(), random);
  std::vector<std::vector<int>> expected;
  std::vector<cl_int> begins{0}, ids;
  std::vector<cl_uint> expected_sizes;
  std::vector<cl_double2> projections;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    for (const int id : random_sequence(places, frames[r], sizes[r], random)) {
      ids.push_back(id);
      projections.push_back(projected(frames[r], places[id]));
    }
    expected.push_back(points.lower_hull(frames[r], {ids.begin() + begins.back(), ids.end()}));
    expected_sizes.push_back(static_cast<cl_uint>(expected.back().size()));
    begins.push_back(static_cast<cl_int>(ids.size()));
  }
  for (const std::size_t group : kGroups) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Call call(runtime);
    call.work.bounds = bounds;
    PointTable table;
    table.points = testing::upload(runtime, places);
    const Level level = level_of_frames(runtime, frames);
    const Sequences sequences{ids.size(), testing::upload(runtime, begins), testing::upload(runtime, ids),
                              testing::upload(runtime, projections)};
    const auto hull_sizes = testing::guarded<cl_uint>(runtime, sizes.size());
    chain_hulls(call.work, table, level, sequences, group, hull_sizes);
    ASSERT_TRUE(same(testing::download(runtime, hull_sizes, sizes.size()), expected_sizes));
    const HostPaths paths(points, frames, expected);
    const std::size_t vertices = paths.vertices.size();
    const auto path = testing::guarded<cl_int>(runtime, vertices);
    const auto path_regions = testing::guarded<cl_int>(runtime, vertices);
    const auto path_projections = testing::guarded<cl_double2>(runtime, vertices);
    const auto band = testing::guarded<cl_double>(runtime, vertices);
    runtime.launch(sizes.size() * group, group,
                   kernels::write_paths{.regions = sizes.size(),
                                        .begins = sequences.begins,
                                        .offsets = testing::upload(runtime, paths.offsets),
                                        .axis = level.axis,
                                        .ids = sequences.ids,
                                        .projections = sequences.projections,
                                        .path = path,
                                        .path_regions = path_regions,
                                        .path_projections = path_projections,
                                        .band = band});
    EXPECT_TRUE(same(testing::download(runtime, path, vertices), paths.vertices));
    EXPECT_TRUE(same(testing::download(runtime, path_regions, vertices), paths.regions));
    EXPECT_TRUE(same(testing::download(runtime, path_projections, vertices), paths.projections));
    std::size_t wrong_bands = 0;
    const auto bands = testing::download(runtime, band, vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto r = static_cast<std::size_t>(paths.regions[v]);
      const bool is_last = static_cast<cl_int>(v) + 1 == paths.offsets[r + 1];
      if (is_last) {
        wrong_bands += bands[v] != HUGE_VAL;
        continue;
      }
      const double height = std::max(paths.projections[v].s[0], paths.projections[v + 1].s[0]);
      const double length = paths.projections[v + 1].s[1] - paths.projections[v].s[1];
      const double least = frames[r].planar() ? height : height + length * length / 4;
      wrong_bands += bands[v] < least || bands[v] > least + 1e-5 * std::abs(least);
    }
    EXPECT_EQ(wrong_bands, 0u);
  }
}

TEST(SmallChains, HullsOfSequences) {
  FixtureRandom random(61);
  check_chains(Runtimes::get(false), make_fixture("small-integers", 12, 5), {0, 9, 1, 33}, Bounds{}, random);
}

TEST(Chains, HullsOfSequences) {
  FixtureRandom random(62);
  for (const char* const name : {"uniform", "grid", "circle", "integer-circle", "columns", "parabola",
                                 "collinear", "half-duplicates", "small-integers", "kuzmin"}) {
    SCOPED_TRACE(name);
    for (const auto& sizes : sizes_of_regions(3000)) {
      check_chains(Runtimes::get(false), make_fixture(name, 900, 63), sizes, kFiltered, random);
    }
  }
}

TEST(Chains, NothingDecidedByFilters) {
  FixtureRandom random(64);
  for (const char* const name : {"grid", "integer-circle", "columns", "thirty-lines"}) {
    SCOPED_TRACE(name);
    check_chains(Runtimes::get(false), long_numbers(name, 200, 65), {0, 400, 1, 2, 65}, kUndecided, random);
  }
}

/// Lists of one point per BUCKET points, of regions of any size.
TEST(Chains, ThinLists) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(66);
    for (const auto& sizes : sizes_of_regions(5000)) {
      Call call(runtime);
      const auto regions = static_cast<int>(sizes.size());
      std::vector<cl_int> offsets{0}, x_list, y_list, axis, first_end;
      std::vector<cl_double2> projections;
      for (std::size_t r = 0; r < sizes.size(); ++r) {
        for (std::size_t i = 0; i < sizes[r]; ++i) {
          x_list.push_back(static_cast<cl_int>(2 * x_list.size()));
          y_list.push_back(x_list.back() + 1);
          projections.push_back({{static_cast<double>(random.integer(0, 20)), static_cast<double>(i)}});
        }
        axis.push_back(static_cast<cl_int>(r % 2));
        first_end.push_back(-1 - static_cast<cl_int>(r));
        offsets.push_back(static_cast<cl_int>(x_list.size()));
      }
      std::vector<cl_int> ids, owners, begins;
      std::vector<cl_double2> lowest;
      for (int r = 0; r < regions; ++r) {
        const cl_int low = offsets[r], count = offsets[r + 1] - low;
        const int begin = low / kernel::BUCKET + r;
        const int parts = offsets[r + 1] / kernel::BUCKET + r + 1 - begin;
        ASSERT_EQ(begin, static_cast<int>(ids.size()));
        begins.push_back(begin);
        for (int part = 0; part < parts; ++part) {
          owners.push_back(r);
          if (count == 0) {
            ids.push_back(first_end[r]);
            lowest.push_back({{0.0, 0.0}});
            continue;
          }
          const int from = std::min(low + count * part / parts, low + count - 1);
          const int to = std::max(from + 1, low + count * (part + 1) / parts);
          const auto best =
              std::min_element(projections.begin() + from, projections.begin() + to,
                               [](const cl_double2& a, const cl_double2& b) { return a.s[0] < b.s[0]; });
          const auto i = best - projections.begin();
          ids.push_back(axis[r] == 1 ? x_list[i] : y_list[i]);
          lowest.push_back(*best);
        }
      }
      begins.push_back(static_cast<cl_int>(ids.size()));
      const auto thin_offsets = testing::guarded<cl_int>(runtime, sizes.size() + 1);
      const auto thin_ids = testing::guarded<cl_int>(runtime, ids.size());
      const auto thin_regions = testing::guarded<cl_int>(runtime, ids.size());
      const auto thin_projections = testing::guarded<cl_double2>(runtime, ids.size());
      runtime.map(ids.size(), kernels::thin_lists{.regions = regions,
                                                  .offsets = testing::upload(runtime, offsets),
                                                  .x_list = testing::upload(runtime, x_list),
                                                  .y_list = testing::upload(runtime, y_list),
                                                  .projections = testing::upload(runtime, projections),
                                                  .axis = testing::upload(runtime, axis),
                                                  .first_end = testing::upload(runtime, first_end),
                                                  .thin_offsets = thin_offsets,
                                                  .thin_ids = thin_ids,
                                                  .thin_regions = thin_regions,
                                                  .thin_projections = thin_projections});
      EXPECT_TRUE(same(testing::download(runtime, thin_offsets, begins.size()), begins));
      EXPECT_TRUE(same(testing::download(runtime, thin_ids, ids.size()), ids));
      EXPECT_TRUE(same(testing::download(runtime, thin_regions, ids.size()), owners));
      EXPECT_TRUE(same(testing::download(runtime, thin_projections, ids.size()), lowest));
    }
  });
}

/// Corners by (region, u), stably: by comparing each with all of its region, and by merging runs.
TEST(Chains, KeptCornersAreSorted) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(67);
    for (const auto& sizes : sizes_of_regions(2000)) {
      Call call(runtime);
      std::vector<cl_int2> before{{{0, 0}}};
      std::vector<cl_int> ids, owners;
      std::vector<cl_double2> projections;
      for (std::size_t r = 0; r < sizes.size(); ++r) {
        for (std::size_t i = 0; i < sizes[r]; ++i) {
          ids.push_back(static_cast<cl_int>(ids.size()));
          owners.push_back(static_cast<cl_int>(r));
          projections.push_back({{0.0, static_cast<double>(random.integer(-9, 9))}});
        }
        before.push_back({{0, static_cast<cl_int>(ids.size())}});
      }
      const std::size_t count = ids.size();
      if (count == 0) continue;
      std::vector<cl_int> expected = ids;
      std::stable_sort(expected.begin(), expected.end(), [&](cl_int a, cl_int b) {
        return std::tuple(owners[a], projections[a].s[1]) < std::tuple(owners[b], projections[b].s[1]);
      });
      struct Arrays {
        Buffer<cl_int> ids, owners;
        Buffer<cl_double2> projections;
      };
      const auto fresh = [&] {
        return Arrays{testing::guarded<cl_int>(runtime, count), testing::guarded<cl_int>(runtime, count),
                      testing::guarded<cl_double2>(runtime, count)};
      };
      const Arrays given{testing::upload(runtime, ids), testing::upload(runtime, owners),
                         testing::upload(runtime, projections)};
      const Arrays compared = fresh();
      runtime.map(count, kernels::place_kept_corners{.before = testing::upload(runtime, before),
                                                     .ids = given.ids,
                                                     .owners = given.owners,
                                                     .projections = given.projections,
                                                     .new_ids = compared.ids,
                                                     .new_owners = compared.owners,
                                                     .new_projections = compared.projections});
      Arrays now = given, then = fresh();
      for (std::size_t run = 1; run < count; run *= kernel::MERGED_RUNS) {
        runtime.map(count, kernels::merge_corner_runs{.run = run,
                                                      .ids = now.ids,
                                                      .owners = now.owners,
                                                      .projections = now.projections,
                                                      .new_ids = then.ids,
                                                      .new_owners = then.owners,
                                                      .new_projections = then.projections});
        std::swap(now, then);
      }
      for (const Arrays& sorted : {compared, now}) {
        EXPECT_TRUE(same(testing::download(runtime, sorted.ids, count), expected));
        EXPECT_TRUE(same(testing::download(runtime, sorted.owners, count), owners));
        const auto places = testing::download(runtime, sorted.projections, count);
        for (std::size_t c = 0; c < count; ++c) ASSERT_EQ(places[c].s[1], projections[expected[c]].s[1]) << c;
      }
    }
  });
}

TEST(Chains, ManyKeptCorners) {
  Met met;
  under_each_tuning([&](Runtime& runtime) { check_many_kept_corners(runtime, met); });
  EXPECT_GT(met.levels, 2u);
}

}  // namespace

/// A flat lens of border vertices close to the cut line, and a few points inside.
void check_many_kept_corners(Runtime& runtime, Met& met) {
  Coordinates coordinates;
  constexpr int kHalf = 3 * kernel::COUNTED_CORNERS;
  for (int i = -kHalf; i <= kHalf; ++i) {
    const double bulge = (1.0 * kHalf * kHalf - 1.0 * i * i) / (1 << 20);
    coordinates.insert(coordinates.end(), {1.0 * i, 1 + bulge, 1.0 * i, -1 - bulge});
  }
  for (int i = 0; i < 5; ++i) coordinates.insert(coordinates.end(), {i / 64.0, (i % 3 - 1) / 4.0});
  check_levels(runtime, coordinates, {false, false, false, 1000}, met);
}

}  // namespace flaunay::flattened
