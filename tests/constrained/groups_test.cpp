// Calls on many small sets, whose groups threads compute by themselves, and on one, which the calling thread
// computes segment by segment: the same bytes as of all sets together and of passes over all segments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blocks/small.hpp"
#include "constrained/inside.hpp"
#include "constrained/small.hpp"
#include "tests/constrained/domains.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/same.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::testing {
namespace {

Triangulator host(const char* tuning) {
  // So that not all groups are joined at once.
  const ScopedEnvironment scope("FLAUNAY_TUNING", tuning), threads("FLAUNAY_THREADS", "2");
  return Triangulator("host");
}

// One that has no groups, one whose groups have few sets, and one with a set in each.
struct Triangulators {
  Triangulator together = host("group_points=0"), groups = host("group_points=40"),
               alone = host("group_points=1");
};

// call(triangulator) with and without groups. By groups, there are two phases.
template <typename Call>
void compare(Triangulators& by, const Call& call) {
  const auto expected = call(by.together);
  for (Triangulator* triangulator : {&by.groups, &by.alone}) {
    const auto found = call(*triangulator);
    expect_same_arrays(found, expected);
    EXPECT_EQ(found.statistics.phases.size(), 2U) << "there were no groups";
  }
}

template <typename Call>
std::string error_of(Triangulator& triangulator, const Call& call) {
  try {
    call(triangulator);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

template <typename WithOptions>
void with_all_options(const WithOptions& run) {
  for (unsigned k = 0; k < 4; ++k) {
    ConstrainedOptions options;
    options.neighbors = k != 1;
    options.halfedges = options.areas = k > 1;
    options.labels = k % 2 != 0;
    run(options);
  }
}

SetsWithSegments sets_of(int count) {
  SetsWithSegments all = several_sets(count, true);
  const auto add = [&](const SegmentInput& input) {
    const auto first = static_cast<std::int32_t>(all.offsets.back());
    all.points.insert(all.points.end(), input.points.begin(), input.points.end());
    for (const std::int32_t v : input.segments) all.segments.push_back(first + v);
    all.offsets.push_back(all.points.size() / 2);
  };
  std::uint64_t seed = 0;
  for (const NastySegments& nasty : nasty_segments()) {
    const SegmentInput input = nasty.make(60, ++seed);
    add(input);
    add(duplicated(input, seed));
  }
  return all;
}

TEST(SmallGroups, OfPoints) {
  Triangulators by;
  const SetsWithSegments sets = sets_of(60);
  const std::vector<float> narrow(sets.points.begin(), sets.points.end());
  std::vector<float> small;
  std::vector<std::size_t> offsets = {0};
  for (int s = 0; s < 40; ++s) {
    for (const double c :
         random_integer_points(static_cast<std::size_t>(s), 9, static_cast<std::uint64_t>(s))) {
      small.push_back(static_cast<float>(c));
    }
    offsets.push_back(small.size() / 2);
  }
  with_all_options([&](const Options& options) {
    compare(by, [&](Triangulator& triangulator) {
      return triangulator.triangulate(sets.points.data(), sets.offsets, options);
    });
    compare(by, [&](Triangulator& triangulator) {
      return triangulator.triangulate(small.data(), offsets, options);
    });
  });
}

TEST(SmallGroups, OfSegments) {
  Triangulators by;
  const SetsWithSegments sets = sets_of(60);
  std::vector<std::int32_t> of_segments, of_points;
  for (std::size_t s = 0; s < sets.segments.size() / 2; ++s)
    of_segments.push_back(static_cast<std::int32_t>(7 * s));
  for (std::size_t i = 0; i < sets.points.size() / 2; ++i)
    of_points.push_back(static_cast<std::int32_t>(i % 5));
  Constraints constraints;
  constraints.segments = sets.segments.data();
  constraints.segment_count = of_segments.size();
  for (const bool have_markers : {false, true}) {
    constraints.segment_markers = have_markers ? of_segments.data() : nullptr;
    constraints.point_markers = have_markers ? of_points.data() : nullptr;
    with_all_options([&](ConstrainedOptions options) {
      for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
        options.outside = outside;
        compare(by, [&](Triangulator& triangulator) {
          return triangulator.constrained(sets.points.data(), sets.offsets, constraints, options);
        });
      }
    });
  }
}

// Squares in squares, with points on their sides, points that are there twice, and rings of two points.
TEST(SmallGroups, OfPolygons) {
  Triangulators by;
  FixtureRandom random(3);
  Coordinates points;
  std::vector<std::size_t> rings = {0}, parts = {0}, polygons = {0};
  for (int p = 0; p < 60; ++p) {
    for (std::int64_t part = random.integer(0, 2); part >= 0; --part) {
      const double x = 100.0 * static_cast<double>(part);
      for (std::int64_t radius = 40; radius > 0; radius -= random.integer(9, 15)) {
        const std::int64_t on_side = random.integer(0, 3), r = radius;
        const auto add = [&](std::int64_t dx, std::int64_t dy) {
          for (std::int64_t times = random.integer(1, 2); times > 0; --times) {
            points.insert(points.end(), {x + static_cast<double>(dx), static_cast<double>(dy)});
          }
        };
        for (std::int64_t k = 0; k < 4 * on_side; ++k) {
          const std::int64_t along = 2 * r * (k % on_side) / on_side - r;
          const std::int64_t to[4][2] = {{along, -r}, {r, along}, {-along, r}, {-r, -along}};
          add(to[k / on_side][0], to[k / on_side][1]);
        }
        if (on_side == 0) {
          add(r, 0);
          add(r, 1);
        }
        rings.push_back(points.size() / 2);
      }
      parts.push_back(rings.size() - 1);
    }
    polygons.push_back(rings.size() - 1);
  }
  for (const FillRule rule : {FillRule::even_odd, FillRule::winding, FillRule::nesting}) {
    for (const bool have_parts : {false, true}) {
      with_all_options([&](const ConstrainedOptions& all) {
        PolygonOptions options;
        static_cast<ConstrainedOptions&>(options) = all;
        options.fill_rule = rule;
        for (const Outside outside : {Outside::keep, Outside::holes}) {
          options.outside = outside;
          compare(by, [&](Triangulator& triangulator) {
            return triangulator.polygons(
                {points.data(), rings, polygons, have_parts ? parts : std::vector<std::size_t>()}, options);
          });
        }
      });
    }
  }
}

// The first error is that of all sets together, whichever group finds one first.
TEST(SmallGroups, ErrorsAreThoseOfAllSets) {
  Triangulators by;
  Coordinates points;
  std::vector<std::size_t> offsets = {0};
  Segments segments;
  for (int s = 0; s < 30; ++s) {
    const auto first = static_cast<std::int32_t>(points.size() / 2);
    for (const double c : {0.0, 0.0, 8.0, 8.0, 0.0, 8.0, 8.0, 0.0}) points.push_back(c);
    offsets.push_back(points.size() / 2);
    segments.insert(segments.end(), {first, first + 2, first + 2, first + 1});
  }
  const auto expect_same_error = [&](const Coordinates& at, const Segments& between) {
    Constraints constraints;
    constraints.segments = between.data();
    constraints.segment_count = between.size() / 2;
    const auto call = [&](Triangulator& triangulator) {
      return triangulator.constrained(at.data(), offsets, constraints);
    };
    const std::string expected = error_of(by.together, call);
    EXPECT_NE(expected, "no error");
    EXPECT_EQ(error_of(by.groups, call), expected);
    EXPECT_EQ(error_of(by.alone, call), expected);
  };
  // Two sets with crossing segments; an index of another set, and one that is none; a point that is not
  // finite.
  Segments crossing = segments;
  for (const std::int32_t set : {11, 23}) {
    const std::int32_t first = 4 * set;
    for (std::int32_t k = 0; k < 4; ++k) crossing[static_cast<std::size_t>(first + k)] = first + k;
  }
  expect_same_error(points, crossing);
  for (const std::int32_t wrong : {-1, 3, 1000}) {
    Segments others = segments;
    others[81] = wrong;
    expect_same_error(points, others);
    others[81] = segments[81];
    others[80] = wrong;
    expect_same_error(points, others);
  }
  Coordinates infinite = points;
  infinite[200] = HUGE_VAL;
  expect_same_error(infinite, crossing);
}

// The calling thread alone, and what it is to be like.
struct HereAndTogether {
  Triangulator together = host("group_points=0"), here = [] {
    const ScopedEnvironment unnamed("FLAUNAY_DEVICE", nullptr);
    return Triangulator();
  }();

  // Either the same arrays, or the same error.
  template <typename Call>
  bool compare(const Call& call) {
    const std::string expected = error_of(together, call);
    EXPECT_EQ(error_of(here, call), expected);
    if (expected == "no error") expect_same_arrays(call(here), call(together));
    return expected == "no error";
  }
  bool compare(const SegmentInput& input, const ConstrainedOptions& options, const Coordinates& holes = {}) {
    Constraints constraints;
    constraints.holes = holes.data();
    constraints.hole_count = holes.size() / 2;
    constraints.segments = input.segments.data();
    constraints.segment_count = input.segments.size() / 2;
    return compare([&](Triangulator& triangulator) {
      return triangulator.constrained(input.points.data(), input.points.size() / 2, constraints, options);
    });
  }
  template <typename Input>
  void compare_all(const Input& input) {
    with_all_options([&](ConstrainedOptions options) {
      for (const FillRule rule : {FillRule::nesting, FillRule::even_odd, FillRule::winding}) {
        for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
          options.fill_rule = rule;
          options.outside = outside;
          compare(input, options);
        }
        options.crossings = Crossings::split;
        compare(input, options);
        options.crossings = Crossings::error;
      }
    });
  }
};

// Whether rings are changed, and nothing is left to the passes.
bool is_done_here(const SegmentInput& input) {
  const std::vector<std::size_t> offsets = {0, input.points.size() / 2};
  Constraints constraints;
  constraints.segments = input.segments.data();
  constraints.segment_count = input.segments.size() / 2;
  ConstrainedTriangulation result;
  const auto rings = blocks::small_rings(input.points.data(), offsets, result);
  constrained::SmallRequest request;
  request.most_steps = native_tuning()->segment_steps;
  return !rings || constrained::constrain_small(*rings, offsets, constraints, request, result);
}

TEST(SmallSets, OfHardSegments) {
  HereAndTogether by;
  for (const NastySegments& nasty : nasty_segments()) {
    for (const int n : {8, 60}) {
      SCOPED_TRACE(nasty.name + " " + std::to_string(n));
      const SegmentInput input = nasty.make(n, static_cast<std::uint64_t>(n));
      // Gift-wrapping brushes takes too many steps.
      EXPECT_TRUE(is_done_here(input) || nasty.name == "brush");
      by.compare_all(input);
      by.compare_all(duplicated(input, 1));
    }
  }
}

// Edges of stretched triangulations, which leave few edges as they were; curves along them; segments that
// mostly cross, on grids of few points, of which many are on lines and circles.
TEST(SmallSets, OfRandomSegments) {
  HereAndTogether by;
  int crossing = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    FixtureRandom random(seed);
    const auto n = static_cast<std::size_t>(random.integer(0, 60));
    SegmentInput input;
    input.points = random_integer_points(n, random.integer(1, 9), seed);
    input.segments = edges_of_stretched(input.points, seed % 2 == 0 ? 7 : 0.2, 1 + seed % 4, seed);
    by.compare_all(input);
    Coordinates stretched = input.points;
    for (std::size_t i = 0; i < stretched.size(); i += 2) stretched[i] *= 5;
    input.segments = random_curves(delaunay_of(stretched, {0, n}), random, 1 + static_cast<int>(seed % 5));
    by.compare_all(input);
    input.segments = random_segments(random, n, static_cast<std::size_t>(random.integer(1, 6)));
    ConstrainedOptions options;
    crossing += by.compare(input, options) ? 0 : 1;
    options.crossings = Crossings::split;
    by.compare(input, options);
    if (n > 0) input.segments.push_back(0);
    if (n > 0) input.segments.push_back(seed % 2 == 0 ? -1 : static_cast<std::int32_t>(n));
    by.compare(input, options);
  }
  EXPECT_GT(crossing, 10);
}

// Holes, seeds and markers.
TEST(SmallSets, OfPlacesAndMarkers) {
  HereAndTogether by;
  const SegmentInput input = nasty_segments()[11].make(100, 1);
  const double places[] = {0.1, 0.2, 0.01, 0.02}, attributes[] = {3, 4};
  const std::vector<std::int32_t> markers(input.points.size() + input.segments.size(), 7);
  Constraints constraints;
  constraints.segments = input.segments.data();
  constraints.segment_count = input.segments.size() / 2;
  constraints.segment_markers = constraints.point_markers = markers.data();
  for (const std::size_t holes : {0U, 1U}) {
    constraints.holes = places;
    constraints.hole_count = holes;
    constraints.seeds = places + 2;
    constraints.seed_attributes = attributes;
    constraints.seed_count = 1 - holes;
    const auto call = [&](Triangulator& triangulator) {
      return triangulator.constrained(input.points.data(), input.points.size() / 2, constraints);
    };
    EXPECT_TRUE(by.compare(call));
    // Holes alone need no passes.
    EXPECT_EQ(call(by.here).statistics.phases.back().name, holes > 0 ? "constrain" : "domains");
  }
}

// Inside of triangles and on their edges, at vertices, outside, and where no sign is exact.
TEST(SmallSets, OfHoles) {
  HereAndTogether by;
  int right = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    FixtureRandom random(seed);
    SegmentInput input;
    input.points = random_integer_points(40, 9, seed);
    input.segments =
        random_curves(delaunay_of(input.points, {0, 40}), random, 1 + static_cast<int>(seed % 4));
    Coordinates holes;
    for (int k = 0; k < 4 && k <= static_cast<int>(seed % 5); ++k)
      holes.push_back((0.5 + random.integer(0, 16)) / (seed % 3 == 0 ? 2 : 1.83));
    holes.resize(holes.size() / 2 * 2);
    ConstrainedOptions options;
    options.labels = seed % 2 == 0;
    options.crossings = seed % 7 == 0 ? Crossings::split : Crossings::error;
    for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
      options.outside = outside;
      right += by.compare(input, options, holes) ? 1 : 0;
    }
    if (holes.empty()) continue;
    options.refinement.min_angle = 20;
    options.refinement.most_points = 100;
    by.compare(input, options, holes);
    for (const double x : {1e300, 1e-300, 5e-324, HUGE_VAL}) {
      holes[0] = x;
      by.compare(input, options, holes);
    }
  }
  EXPECT_GT(right, 50);
}

// A ring about a place, whose corners it sees, or a band that is wound around it.
void add_curve(SegmentInput& input, double x, double y, double radius, bool is_wound, double grid,
               FixtureRandom& random) {
  const auto n = static_cast<int>(random.integer(4, 24)), half = n / 2;
  const auto first = static_cast<std::int32_t>(input.points.size() / 2);
  const double varies = random.unit(), turn = 2 * std::acos(-1);
  for (int k = 0; k < n; ++k) {
    const int along = k < half ? k : n - 1 - k;
    const double angle = is_wound ? 3 * turn * along / half : turn * k / n;
    const double at = is_wound ? (k < half ? 0.2 : 0.25) + 0.7 * along / half : 1 - varies * random.unit();
    for (const double to : {x + radius * at * std::cos(angle), y + radius * at * std::sin(angle)})
      input.points.push_back(grid > 0 ? std::round(to * grid) : to);
  }
  const bool is_turned = random.integer(0, 1) == 0;
  for (int k = 0; k < n; ++k) {
    const int from = is_turned ? n - 1 - k : k, to = is_turned ? (from + n - 1) % n : (k + 1) % n;
    input.segments.insert(input.segments.end(), {first + from, first + to});
  }
}

// Curves in each other and side by side; on grids, many points are on lines and circles, curves have corners
// twice, touch and cross.
TEST(SmallSets, InsideOfCurves) {
  HereAndTogether by;
  int inside = 0, others = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    FixtureRandom random(seed);
    const double grid = seed % 3 == 0 ? 0 : static_cast<double>(random.integer(1, 40));
    SegmentInput input;
    for (int k = 0; k <= static_cast<int>(seed % 5); ++k) {
      add_curve(input, k / 3 * 2.5, 0, std::pow(0.4, k % 3), seed % 7 == 0 && k % 3 == 2 - k / 3, grid,
                random);
    }
    by.compare_all(input);
    by.compare_all(duplicated(input, seed));
    Constraints constraints;
    constraints.segments = input.segments.data();
    constraints.segment_count = input.segments.size() / 2;
    constrained::SmallRequest request{{FillRule::even_odd, Outside::holes}};
    request.most_steps = native_tuning()->segment_steps;
    ConstrainedTriangulation result;
    ++(constrained::triangulate_inside(input.points.data(), {0, input.points.size() / 2}, constraints,
                                       request, result)
           ? inside
           : others);
  }
  EXPECT_GT(inside, 12);
  EXPECT_GT(others, 4);
}

// Rings along the triangles of a grid's triangulation, as borders, holes and parts in any order.
TEST(SmallSets, OfPolygons) {
  HereAndTogether by;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    FixtureRandom random(seed);
    const Coordinates grid = random_integer_points(14, 4, seed);
    const Segments curves = random_curves(delaunay_of(grid, {0, 14}), random, 2);
    Coordinates points;
    Polygons polygons;
    polygons.ring_offsets = polygons.part_offsets = polygons.polygon_offsets = {0};
    for (std::size_t i = 0; i < curves.size(); i += 6) {
      for (std::size_t k = 0; k < 6; k += 2) {
        const double* const p = &grid[2 * static_cast<std::size_t>(curves[i + k])];
        points.insert(points.end(), {p[0], p[1]});
      }
      polygons.ring_offsets.push_back(points.size() / 2);
      const std::size_t rings = polygons.ring_offsets.size() - 1;
      const auto end = random.integer(0, 4);
      if (end < 3 || i + 6 == curves.size()) polygons.part_offsets.push_back(rings);
      if (end == 0 || i + 6 == curves.size()) polygons.polygon_offsets.push_back(rings);
    }
    polygons.coordinates = points.data();
    with_all_options([&](const ConstrainedOptions& all) {
      PolygonOptions options;
      static_cast<ConstrainedOptions&>(options) = all;
      options.map = seed % 4 == 0;
      for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
        options.fill_rule = rule;
        options.outside = seed % 3 == 0 ? Outside::keep : Outside::holes;
        EXPECT_TRUE(
            by.compare([&](Triangulator& triangulator) { return triangulator.polygons(polygons, options); }));
      }
    });
  }
}

}  // namespace
}  // namespace flaunay::testing
