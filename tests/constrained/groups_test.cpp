// Calls on many small sets, whose groups threads compute by themselves: the same bytes as of all sets
// together.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/constrained/domains.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/same.hpp"

namespace flaunay::testing {
namespace {

Triangulator host(const char* tuning) {
  const ScopedEnvironment scope("FLAUNAY_TUNING", tuning);
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

}  // namespace
}  // namespace flaunay::testing
