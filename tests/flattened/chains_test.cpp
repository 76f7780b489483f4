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

#include "flattened/axes.h"
#include "flattened/codes.h"
#include "flattened/limits.h"
#include "launchers/flattened/chains.cl.hpp"
#include "operations/limits.h"
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
                                        .new_path_vertices = {.new_path = path,
                                                              .new_projections = path_projections,
                                                              .new_region = path_regions},
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
                                                  .lists = {.x_list = testing::upload(runtime, x_list),
                                                            .y_list = testing::upload(runtime, y_list)},
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
        operator kernels::corners_to_join() const { return {ids, owners, projections}; }
        operator kernels::new_corners() const { return {ids, owners, projections}; }
      };

      const auto fresh = [&] {
        return Arrays{testing::guarded<cl_int>(runtime, count), testing::guarded<cl_int>(runtime, count),
                      testing::guarded<cl_double2>(runtime, count)};
      };
      const Arrays input{testing::upload(runtime, ids), testing::upload(runtime, owners),
                         testing::upload(runtime, projections)};
      const Arrays compared = fresh();
      runtime.map(count, kernels::place_kept_corners{.before = testing::upload(runtime, before),
                                                     .corners_to_join = input,
                                                     .new_corners = compared});
      Arrays now = input, then = fresh();
      for (std::size_t run = 1; run < count; run *= kernel::MERGED_RUNS) {
        runtime.map(count,
                    kernels::merge_corner_runs{.run = run, .corners_to_join = now, .new_corners = then});
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

/// Lists between the ends of their regions. A set without points has -1 everywhere.
void check_sequences_of_lists(Runtime& runtime, const std::vector<std::size_t>& sizes,
                              FixtureRandom& random) {
  const std::vector<cl_double2> places = places_of(make_fixture("small-integers", 300, 68));
  const std::vector<Frame> frames = random_frames(places, sizes.size(), random);
  const auto any_id = [&] {
    return static_cast<cl_int>(random.integer(0, static_cast<std::int64_t>(places.size()) - 1));
  };
  std::vector<cl_int> offsets{0}, list, regions, first_end, last_end, begins, ids;
  std::vector<cl_double2> list_projections, projections;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    const bool is_empty = sizes[r] == 0;
    const std::size_t size = is_empty ? 1 : sizes[r];
    std::vector<std::pair<cl_int, cl_double2>> own;
    for (std::size_t i = 0; i < size; ++i) {
      const auto h = static_cast<double>(random.integer(0, 9));
      own.emplace_back(is_empty ? -1 : any_id(), is_empty ? cl_double2{{0, 0}} : cl_double2{{h, 1.0 * i}});
    }
    for (const cl_int end : {is_empty ? -1 : any_id(), is_empty ? -1 : any_id()}) {
      (first_end.size() == r ? first_end : last_end).push_back(end);
    }
    for (const auto& [id, p] : own) {
      list.push_back(id);
      list_projections.push_back(p);
      regions.push_back(static_cast<cl_int>(r));
    }
    offsets.push_back(static_cast<cl_int>(list.size()));
    const auto end = [&](cl_int id) {
      return std::pair(id, id < 0 ? cl_double2{{0, 0}} : projected(frames[r], places[id]));
    };
    if (frames[r].axis == kernel::AXIS_Y) std::reverse(own.begin(), own.end());
    own.insert(own.begin(), end(first_end[r]));
    own.push_back(end(last_end[r]));
    begins.push_back(static_cast<cl_int>(ids.size()));
    for (const auto& [id, p] : own) {
      ids.push_back(id);
      projections.push_back(p);
    }
  }
  begins.push_back(static_cast<cl_int>(ids.size()));
  for (const std::size_t group : kGroups) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Call call(runtime);
    const Level level = level_of_frames(runtime, frames);
    const auto found_begins = testing::guarded<cl_int>(runtime, begins.size());
    const auto found_ids = testing::guarded<cl_int>(runtime, ids.size());
    const auto found_projections = testing::guarded<cl_double2>(runtime, ids.size());
    runtime.launch(
        list.size(), group, list.size(),
        kernels::sequence_of_lists{
            .offsets = testing::upload(runtime, offsets),
            .list = testing::upload(runtime, list),
            .regions = testing::upload(runtime, regions),
            .list_projections = testing::upload(runtime, list_projections),
            .first_end = testing::upload(runtime, first_end),
            .last_end = testing::upload(runtime, last_end),
            .cuts = {.axis = level.axis, .cut = level.cut, .points = testing::upload(runtime, places)},
            .begins = found_begins,
            .ids = found_ids,
            .projections = found_projections});
    ASSERT_TRUE(same(testing::download(runtime, found_begins, begins.size()), begins));
    ASSERT_TRUE(same(testing::download(runtime, found_ids, ids.size()), ids));
    ASSERT_TRUE(same(testing::download(runtime, found_projections, ids.size()), projections));
  }
}

/// Regions' internal points, corners and path vertices. Of the first two, prune has kept some.
struct KeptElements {
  KeptElements(const std::vector<std::size_t>& sizes, std::int64_t percent, FixtureRandom& random)
      : regions(sizes.size()) {
    for (std::size_t r = 0; r < regions; ++r) {
      // All three kinds of elements have empty and huge segments, but of different regions.
      const std::size_t corners = sizes[regions - 1 - r], vertices = sizes[(r + 1) % regions] / 2;
      point_offsets.push_back(point_offsets.back() + static_cast<cl_int>(sizes[r]));
      corner_offsets.push_back(corner_offsets.back() + static_cast<cl_int>(corners));
      path_offsets.push_back(path_offsets.back() + static_cast<cl_int>(vertices));
      point_regions.insert(point_regions.end(), sizes[r], static_cast<cl_int>(r));
      corner_regions.insert(corner_regions.end(), corners, static_cast<cl_int>(r));
    }
    for (cl_int i = 0; i < points() + corner_offsets.back(); ++i) {
      if (random.integer(0, 99) < percent) positions.push_back(i);
    }
    for (std::size_t r = 0; r <= regions; ++r) {
      before.push_back({{kept_in(0, point_offsets[r]), kept_in(points(), points() + corner_offsets[r])}});
      begins.push_back(path_offsets[r] + before[r].s[0] + before[r].s[1]);
    }
  }
  cl_int points() const { return point_offsets.back(); }
  cl_int kept_points() const { return before.back().s[0]; }
  cl_int kept_corners() const { return before.back().s[1]; }
  cl_int kept_in(cl_int first, cl_int end) const {
    return static_cast<cl_int>(
        std::count_if(positions.begin(), positions.end(), [=](cl_int i) { return first <= i && i < end; }));
  }

  std::size_t regions;
  std::vector<cl_int> point_offsets{0}, corner_offsets{0}, path_offsets{0};
  std::vector<cl_int> point_regions, corner_regions;
  std::vector<cl_int> positions;
  std::vector<cl_int2> before;
  std::vector<cl_int> begins;
};

void check_keep_bounds(Runtime& runtime, const KeptElements& kept) {
  std::vector<cl_int> facts(kernel::KEPT_FACTS, 0);
  facts[kernel::KEPT_ALL] = kept.begins.back();
  facts[kernel::KEPT_CORNERS] = kept.kept_corners();
  for (std::size_t r = 0; r < kept.regions; ++r) {
    facts[kernel::KEPT_CORNERS_MOST] =
        std::max(facts[kernel::KEPT_CORNERS_MOST], kept.before[r + 1].s[1] - kept.before[r].s[1]);
  }
  for (const std::size_t group : kGroups) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Call call(runtime);
    const auto before = testing::guarded<cl_int2>(runtime, kept.regions + 1);
    const auto begins = testing::guarded<cl_int>(runtime, kept.regions + 1);
    const auto found = testing::upload(runtime, std::vector<cl_int>(kernel::KEPT_FACTS, 0));
    const std::vector<cl_uint> count{static_cast<cl_uint>(kept.positions.size())};
    runtime.launch(kept.regions + 1, group, kept.regions,
                   kernels::keep_bounds{.points_count = kept.points(),
                                        .kept_count = testing::upload(runtime, count),
                                        .positions = testing::upload(runtime, kept.positions),
                                        .point_offsets = testing::upload(runtime, kept.point_offsets),
                                        .corner_offsets = testing::upload(runtime, kept.corner_offsets),
                                        .path_offsets = testing::upload(runtime, kept.path_offsets),
                                        .before = before,
                                        .begins = begins,
                                        .facts = found});
    ASSERT_TRUE(same(testing::download(runtime, before, kept.regions + 1), kept.before));
    ASSERT_TRUE(same(testing::download(runtime, begins, kept.regions + 1), kept.begins));
    ASSERT_TRUE(same(testing::download(runtime, found, facts.size()), facts));
  }
}

void check_gathered_corners(Runtime& runtime, const KeptElements& kept, FixtureRandom& random) {
  const std::vector<cl_double2> places = places_of(make_fixture("small-integers", 300, 69));
  const std::vector<Frame> frames = random_frames(places, kept.regions, random);
  std::vector<cl_int> corners, ids, owners;
  for (std::size_t k = 0; k < 3 * kept.corner_regions.size(); ++k) {
    corners.push_back(static_cast<cl_int>(random.integer(0, static_cast<std::int64_t>(places.size()) - 1)));
  }
  std::vector<cl_double2> projections;
  for (const cl_int i : kept.positions) {
    if (i < kept.points()) continue;
    const auto corner = static_cast<std::size_t>(i - kept.points());
    owners.push_back(kept.corner_regions[corner]);
    ids.push_back(corners[3 * corner + 1]);
    projections.push_back(projected(frames[owners.back()], places[ids.back()]));
  }
  if (ids.empty()) return;
  for (const std::size_t group : kGroups) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Call call(runtime);
    const Level level = level_of_frames(runtime, frames);
    const auto found_ids = testing::guarded<cl_int>(runtime, ids.size());
    const auto found_owners = testing::guarded<cl_int>(runtime, ids.size());
    const auto found_projections = testing::guarded<cl_double2>(runtime, ids.size());
    runtime.launch(
        ids.size(), group, ids.size(),
        kernels::gather_kept_corners{
            .regions = kept.regions,
            .points_count = kept.points(),
            .before = testing::upload(runtime, kept.before),
            .positions = testing::upload(runtime, kept.positions),
            .corner_regions = testing::upload(runtime, kept.corner_regions),
            .corners = testing::upload(runtime, corners),
            .cuts = {.axis = level.axis, .cut = level.cut, .points = testing::upload(runtime, places)},
            .new_corners = {
                .new_ids = found_ids, .new_owners = found_owners, .new_projections = found_projections}});
    ASSERT_TRUE(same(testing::download(runtime, found_ids, ids.size()), ids));
    ASSERT_TRUE(same(testing::download(runtime, found_owners, ids.size()), owners));
    ASSERT_TRUE(same(testing::download(runtime, found_projections, ids.size()), projections));
  }
}

/// Ascending random coordinates along the cut line, many of them equal.
std::vector<double> random_us(std::size_t count, FixtureRandom& random) {
  std::vector<double> us;
  for (std::size_t i = 0; i < count; ++i) us.push_back(static_cast<double>(random.integer(-9, 9)) / 2);
  std::sort(us.begin(), us.end());
  return us;
}

/// Path vertices, kept points and kept corners of each region, merged stably by u.
void check_joined(Runtime& runtime, const KeptElements& kept, FixtureRandom& random) {
  cl_int fresh = 0;
  std::vector<cl_int> axis, x_list, y_list, path, path_regions, corner_ids, corner_owners, ids;
  std::vector<cl_double2> point_projections, path_projections, corner_projections, projections;
  const auto heighten = [&](double u) { return cl_double2{{static_cast<double>(random.integer(0, 99)), u}}; };
  for (std::size_t r = 0; r < kept.regions; ++r) {
    axis.push_back(static_cast<cl_int>(r % 4));
    const bool descends = axis[r] == kernel::AXIS_Y;
    const cl_int low = kept.point_offsets[r], high = kept.point_offsets[r + 1];
    std::vector<double> us = random_us(static_cast<std::size_t>(high - low), random);
    if (descends) std::reverse(us.begin(), us.end());
    for (const double u : us) {
      x_list.push_back(fresh++);
      y_list.push_back(fresh++);
      point_projections.push_back(heighten(u));
    }
    std::vector<std::pair<cl_int, cl_double2>> own;
    const auto vertices = static_cast<std::size_t>(kept.path_offsets[r + 1] - kept.path_offsets[r]);
    for (const double u : random_us(vertices, random)) {
      path.push_back(fresh++);
      path_regions.push_back(static_cast<cl_int>(r));
      path_projections.push_back(heighten(u));
      own.emplace_back(path.back(), path_projections.back());
    }
    std::vector<std::pair<cl_int, cl_double2>> kept_points;
    for (const cl_int i : kept.positions) {
      if (i < low || i >= high) continue;
      kept_points.emplace_back(descends ? x_list[i] : y_list[i], point_projections[i]);
    }
    if (descends) std::reverse(kept_points.begin(), kept_points.end());
    own.insert(own.end(), kept_points.begin(), kept_points.end());
    const auto corners = static_cast<std::size_t>(kept.before[r + 1].s[1] - kept.before[r].s[1]);
    for (const double u : random_us(corners, random)) {
      corner_ids.push_back(fresh++);
      corner_owners.push_back(static_cast<cl_int>(r));
      corner_projections.push_back(heighten(u));
      own.emplace_back(corner_ids.back(), corner_projections.back());
    }
    std::stable_sort(own.begin(), own.end(),
                     [](const auto& a, const auto& b) { return a.second.s[1] < b.second.s[1]; });
    for (const auto& [id, p] : own) {
      ids.push_back(id);
      projections.push_back(p);
    }
  }
  for (const std::size_t group : kGroups) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Call call(runtime);
    const auto found_ids = testing::guarded<cl_int>(runtime, ids.size());
    const auto found_projections = testing::guarded<cl_double2>(runtime, ids.size());
    // Fewer work-items than elements, or more.
    runtime.launch(
        3 * group, group,
        kernels::join_sequences{
            .regions_count = kept.regions,
            .before = testing::upload(runtime, kept.before),
            .begins = testing::upload(runtime, kept.begins),
            .positions = testing::upload(runtime, kept.positions),
            .regions = testing::upload(runtime, kept.point_regions),
            .lists = {.x_list = testing::upload(runtime, x_list), .y_list = testing::upload(runtime, y_list)},
            .point_projections = testing::upload(runtime, point_projections),
            .axis = testing::upload(runtime, axis),
            .paths = {.path_offsets = testing::upload(runtime, kept.path_offsets),
                      .path = testing::upload(runtime, path),
                      .path_projections = testing::upload(runtime, path_projections)},
            .path_regions = testing::upload(runtime, path_regions),
            .corners_to_join = {.corner_ids = testing::upload(runtime, corner_ids),
                                .corner_owners = testing::upload(runtime, corner_owners),
                                .corner_projections = testing::upload(runtime, corner_projections)},
            .ids = found_ids,
            .projections = found_projections});
    ASSERT_TRUE(same(testing::download(runtime, found_ids, ids.size()), ids));
    ASSERT_TRUE(same(testing::download(runtime, found_projections, ids.size()), projections));
  }
}

/// All of these, for segments of all sizes up to `huge`, of which prune has kept nothing, some, or
/// everything.
void check_steps_of_sequences(std::size_t huge, FixtureRandom& random) {
  Runtime& runtime = Runtimes::get(false);
  for (const auto& sizes : sizes_of_regions(huge)) {
    SCOPED_TRACE(std::to_string(sizes.size()) + " regions");
    check_sequences_of_lists(runtime, sizes, random);
    for (const std::int64_t percent : {0, 30, 100}) {
      SCOPED_TRACE(std::to_string(percent) + " % kept");
      const KeptElements kept(sizes, percent, random);
      check_keep_bounds(runtime, kept);
      check_gathered_corners(runtime, kept, random);
      check_joined(runtime, kept, random);
    }
  }
}

TEST(SmallChains, StepsOfSequences) {
  FixtureRandom random(70);
  check_steps_of_sequences(12, random);
}

TEST(Chains, StepsOfSequences) {
  FixtureRandom random(71);
  for (const std::size_t huge : {300, 4000}) check_steps_of_sequences(huge, random);
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
