// Markers of segments and points, and attributes of regions, by the public calls against their definition.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/constrained.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using Markers = std::vector<std::int32_t>;

// Several sets with crossing and overlapping segments.
struct Input : SetsWithSegments {
  explicit Input(std::uint64_t round) {
    FixtureRandom random(round);
    for (std::uint64_t s = 0; s < 4; ++s) {
      const auto n = static_cast<std::size_t>(random.integer(0, 20));
      const Coordinates set = random_integer_points(n, 7, 10 * round + s);
      for (const std::int32_t v : random_segments(random, n, n / 2)) {
        segments.push_back(static_cast<std::int32_t>(offsets.back()) + v);
      }
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
  }
  Constraints constraints() const {
    Constraints result;
    result.segments = segments.data();
    result.segment_count = segments.size() / 2;
    return result;
  }
};

ConstrainedOptions split_with(Outside outside, bool labels) {
  ConstrainedOptions options;
  options.crossings = Crossings::split;
  options.outside = outside;
  options.labels = labels;
  return options;
}

// For each point that splitting added the first segment with an edge that ends there.
std::vector<std::size_t> first_segments(const ConstrainedTriangulation& mesh, std::size_t points) {
  const std::size_t segments = mesh.piece_offsets.size() - 1;
  std::vector<std::size_t> first(mesh.added_points.size() / 2, segments);
  for (std::size_t s = segments; s-- > 0;) {
    for (auto p = static_cast<std::size_t>(mesh.piece_offsets[s]);
         p < static_cast<std::size_t>(mesh.piece_offsets[s + 1]); ++p) {
      for (std::int32_t i = 2 * mesh.piece_edges[2 * p]; i < 2 * mesh.piece_edges[2 * p + 1]; ++i) {
        const auto v = static_cast<std::size_t>(mesh.constraint_edges[static_cast<std::size_t>(i)]);
        if (v >= points) first[v - points] = s;
      }
    }
  }
  return first;
}

TEST(SmallCarried, MarkersOfEdgesAndPointsAreThoseOfSegments) {
  std::size_t added = 0;
  for (std::uint64_t round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const Input input(round);
    const std::size_t n = input.points.size() / 2;
    Markers of_segments(input.segments.size() / 2), of_points(n);
    for (std::size_t s = 0; s < of_segments.size(); ++s) of_segments[s] = -7 * static_cast<std::int32_t>(s);
    for (std::size_t i = 0; i < n; ++i) of_points[i] = 1000 + static_cast<std::int32_t>(i);
    Constraints constraints = input.constraints();
    const ConstrainedOptions options = split_with(Outside::keep, false);
    const auto constrain = [&] {
      return triangulator().constrained(input.points.data(), input.offsets, constraints, options);
    };
    const ConstrainedTriangulation plain = constrain();
    EXPECT_TRUE(plain.edge_markers.empty() && plain.vertex_markers.empty());
    added += plain.added_points.size() / 2;

    constraints.point_markers = of_points.data();
    Markers expected = of_points;
    expected.resize(n + plain.added_points.size() / 2);
    EXPECT_EQ(constrain().vertex_markers, expected) << "those that are added have 0";

    constraints.segment_markers = of_segments.data();
    const ConstrainedTriangulation mesh = constrain();
    EXPECT_EQ(mesh.triangles, plain.triangles);
    const std::vector<std::size_t> first = first_segments(mesh, n);
    for (std::size_t k = 0; k < first.size(); ++k) expected[n + k] = of_segments.at(first[k]);
    EXPECT_EQ(mesh.vertex_markers, expected);
    ASSERT_EQ(mesh.edge_markers.size(), mesh.constraint_edges.size() / 2);
    for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e) {
      EXPECT_EQ(mesh.edge_markers[e], of_segments[static_cast<std::size_t>(mesh.edge_segments[e])]);
    }
  }
  EXPECT_GT(added, 100U);
}

// ------------------------------------------------------------------------------------------------ attributes

int turn(const double* a, const double* b, const double* c) {
  const mpq_class ax(a[0]), ay(a[1]);
  return sgn((mpq_class(b[0]) - ax) * (mpq_class(c[1]) - ay) -
             (mpq_class(b[1]) - ay) * (mpq_class(c[0]) - ax));
}

// The triangle of a set that has a place inside or on its border; -1 if there is none or it is on a
// constraint.
std::int32_t triangle_at(const ConstrainedTriangulation& mesh, const Coordinates& points, std::size_t set,
                         const double* place) {
  std::int32_t found = -1;
  for (std::size_t t = mesh.triangle_offsets[set]; t < mesh.triangle_offsets[set + 1]; ++t) {
    const double* p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = &points[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    }
    int sides[3];
    for (std::size_t k = 0; k < 3; ++k) sides[k] = turn(p[(k + 1) % 3], p[(k + 2) % 3], place);
    if (std::min({sides[0], sides[1], sides[2]}) < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      if (sides[k] == 0 && mesh.constrained[3 * t + k] != 0) return -1;
    }
    found = static_cast<std::int32_t>(t);
  }
  return found;
}

// Random places on a finer grid than points, which are often on edges, and some far away.
struct Seeds {
  explicit Seeds(const Input& input, std::uint64_t round) {
    FixtureRandom random(100 + round);
    for (std::size_t s = 0; s + 1 < input.offsets.size(); ++s) {
      for (auto count = random.integer(0, 25); count > 0; --count) {
        for (int c = 0; c < 2; ++c) places.push_back(static_cast<double>(random.integer(-1, 15)) / 2);
        attributes.push_back(0.5 + static_cast<double>(attributes.size()));
      }
      offsets.push_back(attributes.size());
    }
  }
  void give(Constraints& constraints) const {
    constraints.seeds = places.data();
    constraints.seed_attributes = attributes.data();
    constraints.seed_count = attributes.size();
    constraints.seed_offsets = offsets;
  }
  std::vector<double> places, attributes;
  std::vector<std::size_t> offsets = {0};
};

TEST(SmallCarried, TrianglesHaveTheAttributesOfTheirRegions) {
  std::size_t with = 0, without = 0;
  Triangulator any;
  for (std::uint64_t round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const Input input(round);
    const Seeds seeds(input, round);
    Constraints constraints = input.constraints();
    seeds.give(constraints);
    for (const Outside outside : {Outside::keep, Outside::hull}) {
      const auto constrain = [&](Triangulator& by, bool labels) {
        return by.constrained(input.points.data(), input.offsets, constraints, split_with(outside, labels));
      };
      const ConstrainedTriangulation mesh = constrain(triangulator(), true);
      Coordinates all = input.points;
      all.insert(all.end(), mesh.added_points.begin(), mesh.added_points.end());
      std::vector<double> expected(mesh.regions.size(), 0);
      for (std::size_t s = 0; s + 1 < seeds.offsets.size(); ++s) {
        for (std::size_t k = seeds.offsets[s]; k < seeds.offsets[s + 1]; ++k) {
          const std::int32_t found = triangle_at(mesh, all, s, &seeds.places[2 * k]);
          ++(found < 0 ? without : with);
          for (std::size_t t = 0; t < expected.size() && found >= 0; ++t) {
            if (mesh.regions[t] == mesh.regions[static_cast<std::size_t>(found)]) {
              expected[t] = seeds.attributes[k];
            }
          }
        }
      }
      EXPECT_EQ(mesh.triangle_attributes, expected);
      EXPECT_EQ(constrain(any, true).triangle_attributes, expected) << "on the calling thread";
      const ConstrainedTriangulation unlabelled = constrain(triangulator(), false);
      EXPECT_EQ(unlabelled.triangle_attributes, expected);
      EXPECT_TRUE(unlabelled.regions.empty());
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(with, 100U);
  EXPECT_GT(without, 100U);
}

TEST(SmallCarried, SeedsThatAreNone) {
  const Coordinates square = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<double> attributes = {7, 8};
  std::vector<double> places = {0.5, 0.25, 1e300, 0.5};
  Constraints constraints;
  constraints.seeds = places.data();
  constraints.seed_attributes = attributes.data();
  constraints.seed_count = 2;
  const auto constrain = [&] { return triangulator().constrained(square.data(), 4, constraints); };
  const auto error = [&](ErrorKind kind) -> std::string {
    try {
      constrain();
    } catch (const Error& thrown) {
      EXPECT_EQ(thrown.kind(), kind);
      return thrown.what();
    }
    return "no error";
  };
  EXPECT_EQ(constrain().triangle_attributes, (std::vector<double>{7, 7})) << "far away is outside";
  places[3] = NAN;
  EXPECT_EQ(error(ErrorKind::input), "seed 1 is not finite: (1.0000000000000001e+300, nan)");
  constraints.seed_offsets = {0, 1, 2};
  EXPECT_EQ(error(ErrorKind::usage), "the offsets of 2 seeds do not fit 1 sets");
  constraints.seed_attributes = nullptr;
  EXPECT_EQ(error(ErrorKind::usage), "seeds have neither attributes nor areas: both pointers are null");
}

}  // namespace
}  // namespace flaunay::testing
