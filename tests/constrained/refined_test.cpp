// Refined meshes by the public calls: what all arrays of a result are for each other, and that they do not
// depend on the device, the threads, the order of the input, and on what else is in a call.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/constrained.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/domains.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using Markers = std::vector<std::int32_t>;

// Sets with everything that refinement carries on.
struct Domain {
  Coordinates points;
  std::vector<std::size_t> offsets = {0};
  Segments segments;
  Markers segment_markers, point_markers;
  Coordinates seeds, seed_attributes;
  std::vector<std::size_t> seed_offsets = {0};

  void add(const Domain& other) {
    const auto first = static_cast<std::int32_t>(offsets.back());
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(points, other.points);
    for (const std::int32_t v : other.segments) segments.push_back(first + v);
    offsets.push_back(points.size() / 2);
    append(segment_markers, other.segment_markers);
    append(point_markers, other.point_markers);
    append(seeds, other.seeds);
    append(seed_attributes, other.seed_attributes);
    seed_offsets.push_back(seed_attributes.size());
  }
  Constraints constraints() const {
    Constraints result;
    result.segments = segments.data();
    result.segment_count = segments.size() / 2;
    result.segment_markers = segment_markers.data();
    result.point_markers = point_markers.data();
    result.seeds = seeds.data();
    result.seed_attributes = seed_attributes.data();
    result.seed_count = seed_attributes.size();
    result.seed_offsets = seed_offsets;
    return result;
  }
  std::size_t point_count() const { return points.size() / 2; }
};

Domain one(Domain set) {
  Domain all;
  all.add(set);
  return all;
}

void close_ring(Domain& domain, const Coordinates& ring, std::int32_t marker) {
  const auto first = static_cast<std::int32_t>(domain.points.size() / 2),
             size = static_cast<std::int32_t>(ring.size() / 2);
  for (std::int32_t k = 0; k < size; ++k) {
    domain.segments.insert(domain.segments.end(), {first + k, first + (k + 1) % size});
    domain.segment_markers.push_back(marker + k);
    domain.point_markers.push_back(100 + k);
  }
  domain.points.insert(domain.points.end(), ring.begin(), ring.end());
}

// A square with a hole in it, a wall across that makes two regions, and one to the hole.
Domain plate(double x) {
  Domain set;
  close_ring(set, {x, 0, x + 10, 0, x + 10, 10, x + 5, 10, x, 10}, 1);
  close_ring(set, {x + 1, 2, x + 3, 2, x + 3, 4.5, x + 1, 4}, 11);
  set.points.insert(set.points.end(), {x + 10.0 / 3, 0});
  set.point_markers.push_back(200);
  // This point is on the first side, and makes two edges of it.
  set.segments.insert(set.segments.end(), {9, 3});
  set.segment_markers.push_back(21);
  set.segments.insert(set.segments.end(), {3, 7});
  set.segment_markers.push_back(22);
  set.seeds = {x + 9, 1, x + 0.5, 1};
  set.seed_attributes = {7, -2};
  return set;
}

// A star of a circle's points, whose borders cross if they are not split.
Domain star(double scale) {
  Domain set;
  Coordinates ring;
  for (int k = 0; k < 7; ++k) {
    const double angle = 3 * k * 2 * 3.141592653589793 / 7;
    ring.insert(ring.end(), {scale * std::cos(angle), scale * std::sin(angle)});
  }
  close_ring(set, ring, 31);
  return set;
}

// Points without segments, two of which are there twice.
Domain cloud(std::size_t n, std::uint64_t seed) {
  Domain set;
  FixtureRandom random(seed);
  for (std::size_t i = 0; i < 2 * n; ++i) set.points.push_back(random.unit());
  for (std::size_t i = 0; i < 4 && n > 4; ++i) set.points.push_back(set.points[i]);
  set.point_markers.assign(set.points.size() / 2, 5);
  return set;
}

// Of all kinds, with sets that have no triangles between them.
Domain several() {
  Domain all;
  for (int k = 0; k < 3; ++k) {
    all.add(plate(2 * k));
    all.add(cloud(static_cast<std::size_t>(k), 1));
    all.add(star(1 + k));
    all.add(cloud(20, static_cast<std::uint64_t>(k)));
  }
  return all;
}

ConstrainedOptions refined_to(double min_angle, double max_area) {
  ConstrainedOptions options;
  options.halfedges = options.areas = options.labels = true;
  options.crossings = Crossings::split;
  options.refinement.min_angle = min_angle;
  options.refinement.max_area = max_area;
  return options;
}

ConstrainedTriangulation refine(Triangulator& by, const Domain& domain, const ConstrainedOptions& options) {
  return by.constrained(domain.points.data(), domain.offsets, domain.constraints(), options);
}

Coordinates all_points(const Domain& domain, const ConstrainedTriangulation& mesh) {
  Coordinates all = domain.points;
  all.insert(all.end(), mesh.added_points.begin(), mesh.added_points.end());
  return all;
}

double smallest_angle(const Coordinates& points, const std::int32_t* corners) {
  double smallest = 180;
  for (int k = 0; k < 3; ++k) {
    const double* const p = &points[2 * static_cast<std::size_t>(corners[k])];
    const double* const q = &points[2 * static_cast<std::size_t>(corners[(k + 1) % 3])];
    const double* const r = &points[2 * static_cast<std::size_t>(corners[(k + 2) % 3])];
    const double ux = q[0] - p[0], uy = q[1] - p[1], vx = r[0] - p[0], vy = r[1] - p[1];
    smallest = std::min(smallest, std::atan2(ux * vy - uy * vx, ux * vx + uy * vy) * 180 / std::acos(-1.0));
  }
  return smallest;
}

// The directed edges opposite to corners that `chosen` holds for.
template <typename Chosen>
std::set<Edge> edges_where(const ConstrainedTriangulation& mesh, const Chosen& chosen) {
  std::set<Edge> edges;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    if (chosen(c)) edges.emplace(mesh.triangles[t + (c + 1) % 3], mesh.triangles[t + (c + 2) % 3]);
  }
  return edges;
}

// That triangles are constrained Delaunay, and that neighbours, half-edges, areas and offsets are theirs.
void expect_constrained_delaunay(const Domain& domain, const ConstrainedTriangulation& mesh) {
  const Coordinates points = all_points(domain, mesh);
  Plane plane(points);
  ASSERT_EQ(mesh.neighbors, reference_neighbors(mesh.triangles));
  ASSERT_EQ(mesh.constrained.size(), mesh.triangles.size());
  ASSERT_EQ(mesh.halfedges.size(), mesh.triangles.size());
  ASSERT_EQ(mesh.areas.size(), mesh.triangles.size() / 3);
  std::set<Edge> constraints;
  for (std::size_t e = 0; e < mesh.constraint_edges.size(); e += 2) {
    EXPECT_TRUE(constraints.insert(unordered(mesh.constraint_edges[e], mesh.constraint_edges[e + 1])).second);
  }
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    const std::int32_t* const row = &mesh.triangles[t];
    if (c == t) {
      ASSERT_GT(plane.orient(row[0], row[1], row[2]), 0);
      ASSERT_TRUE(row[0] < row[1] && row[0] < row[2]);
      ASSERT_GT(mesh.areas[t / 3], 0);
    }
    const Edge edge = unordered(row[(c + 1) % 3], row[(c + 2) % 3]);
    ASSERT_EQ(mesh.constrained[c] != 0, constraints.count(edge) != 0) << edge.first << "-" << edge.second;
    const std::int32_t beyond = mesh.neighbors[c];
    const std::size_t halfedge = t + (c + 1) % 3;
    ASSERT_EQ(mesh.halfedges[halfedge] < 0, beyond < 0);
    if (beyond < 0) continue;
    ASSERT_EQ(mesh.halfedges[halfedge] / 3, beyond);
    std::int32_t opposite = 3 * beyond;
    while (mesh.triangles[opposite] == edge.first || mesh.triangles[opposite] == edge.second) ++opposite;
    if (mesh.constrained[c] == 0) {
      ASSERT_LE(plane.circle(row[0], row[1], row[2], mesh.triangles[opposite]), 0);
      ASSERT_EQ(mesh.regions[c / 3], mesh.regions[beyond]);
    }
  }
  ASSERT_EQ(mesh.triangle_offsets.size(), domain.offsets.size());
  ASSERT_EQ(mesh.added_offsets.size(), domain.offsets.size());
  ASSERT_EQ(mesh.triangle_offsets.back(), mesh.triangles.size() / 3);
  ASSERT_EQ(mesh.added_offsets.back(), mesh.added_points.size() / 2);
  const std::size_t n = domain.point_count();
  for (std::size_t s = 0; s + 1 < domain.offsets.size(); ++s) {
    for (std::size_t c = 3 * mesh.triangle_offsets[s]; c < 3 * mesh.triangle_offsets[s + 1]; ++c) {
      const auto v = static_cast<std::size_t>(mesh.triangles[c]);
      const bool is_added = v >= n;
      const std::size_t place = is_added ? v - n : v;
      const std::vector<std::size_t>& offsets = is_added ? mesh.added_offsets : domain.offsets;
      ASSERT_TRUE(offsets[s] <= place && place < offsets[s + 1]) << "a point of another set";
    }
  }
  EXPECT_EQ(mesh.statistics.points, points.size() / 2);
  EXPECT_EQ(mesh.statistics.triangles, mesh.triangles.size() / 3);
  EXPECT_EQ(mesh.statistics.hull_vertices, mesh.hull.size());
}

// That pieces lead from one end to the other one of each segment, near it, and that edges know them.
void expect_pieces(const Domain& domain, const ConstrainedTriangulation& mesh) {
  const Coordinates points = all_points(domain, mesh);
  Plane plane(points);
  Markers first(mesh.edge_segments.size(), std::numeric_limits<std::int32_t>::max());
  const std::size_t n = domain.point_count();
  std::vector<std::int32_t> first_of_points(points.size() / 2, std::numeric_limits<std::int32_t>::max());
  for (std::size_t s = 0; s < domain.segments.size() / 2; ++s) {
    std::int32_t a = domain.segments[2 * s], b = domain.segments[2 * s + 1];
    if (plane.before(b, a)) std::swap(a, b);
    a = mesh.representatives[static_cast<std::size_t>(a)];
    b = mesh.representatives[static_cast<std::size_t>(b)];
    const double *p = plane.at(a), *q = plane.at(b);
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    std::int32_t at = a;
    for (std::int32_t piece = mesh.piece_offsets[s]; piece < mesh.piece_offsets[s + 1]; ++piece) {
      for (std::int32_t e = mesh.piece_edges[2 * piece]; e < mesh.piece_edges[2 * piece + 1]; ++e) {
        ASSERT_EQ(mesh.constraint_edges[2 * e], at) << "segment " << s;
        at = mesh.constraint_edges[2 * e + 1];
        const double* const v = plane.at(at);
        const double off = (v[0] - p[0]) * (q[1] - p[1]) - (v[1] - p[1]) * (q[0] - p[0]);
        ASSERT_LE(std::fabs(off), 1e-13 * length * (1 + std::fabs(p[0]) + std::fabs(q[0])))
            << "segment " << s;
        first[e] = std::min(first[e], static_cast<std::int32_t>(s));
        for (const std::int32_t end : {mesh.constraint_edges[2 * e], at}) {
          first_of_points[end] = std::min(first_of_points[end], static_cast<std::int32_t>(s));
        }
      }
    }
    ASSERT_EQ(at, b) << "segment " << s;
  }
  EXPECT_EQ(mesh.edge_segments, first);
  ASSERT_EQ(mesh.edge_markers.size(), first.size());
  for (std::size_t e = 0; e < first.size(); ++e)
    EXPECT_EQ(mesh.edge_markers[e], domain.segment_markers[first[e]]);
  ASSERT_EQ(mesh.vertex_markers.size(), points.size() / 2);
  ASSERT_EQ(mesh.representatives.size(), points.size() / 2);
  for (std::size_t v = 0; v < mesh.vertex_markers.size(); ++v) {
    const bool is_on = first_of_points[v] < static_cast<std::int32_t>(domain.segment_markers.size());
    const std::int32_t expected = v < n   ? domain.point_markers[v]
                                  : is_on ? domain.segment_markers[first_of_points[v]]
                                          : 0;
    ASSERT_EQ(mesh.vertex_markers[v], expected) << "point " << v;
    if (v >= n) {
      EXPECT_EQ(mesh.representatives[v], static_cast<std::int32_t>(v));
    }
  }
}

// That the hull is what the triangles end at, if all are there.
void expect_hull(const ConstrainedTriangulation& mesh) {
  std::set<Edge> expected;
  for (std::size_t s = 0; s + 1 < mesh.hull_offsets.size(); ++s) {
    if (mesh.triangle_offsets[s] == mesh.triangle_offsets[s + 1]) continue;
    for (std::size_t i = mesh.hull_offsets[s]; i < mesh.hull_offsets[s + 1]; ++i) {
      expected.emplace(mesh.hull[i],
                       mesh.hull[i + 1 < mesh.hull_offsets[s + 1] ? i + 1 : mesh.hull_offsets[s]]);
    }
  }
  EXPECT_EQ(edges_where(mesh, [&](std::size_t c) { return mesh.neighbors[c] < 0; }), expected);
}

// That triangles are as good as is asked for, but for those that are listed. largest(t): its area.
template <typename Largest>
void expect_quality(const Domain& domain, const ConstrainedTriangulation& mesh, double min_angle,
                    const Largest& largest) {
  const Coordinates points = all_points(domain, mesh);
  const RefinementReport& report = mesh.refinement;
  ASSERT_EQ(report.bad_triangles.size(), report.excuses.size());
  EXPECT_TRUE(std::is_sorted(report.bad_triangles.begin(), report.bad_triangles.end()));
  const std::set<std::int32_t> bad(report.bad_triangles.begin(), report.bad_triangles.end());
  double smallest = 180;
  for (std::size_t t = 0; t < mesh.areas.size(); ++t) {
    const double angle = smallest_angle(points, &mesh.triangles[3 * t]);
    smallest = std::min(smallest, angle);
    const bool is_good = angle >= min_angle - 1e-12 && mesh.areas[t] <= largest(t);
    const bool is_listed = bad.count(static_cast<std::int32_t>(t)) != 0;
    EXPECT_TRUE(is_good || is_listed) << "triangle " << t << ": " << angle << ", " << mesh.areas[t];
    EXPECT_FALSE(is_listed && angle > min_angle + 1e-12 && mesh.areas[t] <= largest(t)) << "triangle " << t;
  }
  EXPECT_NEAR(report.smallest_angle, smallest, 1e-12);
  EXPECT_GE(report.largest_angle, 60);
  EXPECT_LE(report.largest_angle, 180 - 2 * report.smallest_angle + 1e-12);
  EXPECT_LE(report.split_points, report.added_points);
}

void expect_everything(const Domain& domain, const ConstrainedTriangulation& mesh) {
  expect_constrained_delaunay(domain, mesh);
  expect_pieces(domain, mesh);
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// What does not depend on the numbers of points and triangles.
using Shape = std::array<double, 6>;
std::vector<Shape> shapes(const Domain& domain, const ConstrainedTriangulation& mesh) {
  const Coordinates points = all_points(domain, mesh);
  std::vector<Shape> all;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::array<std::array<double, 2>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t + k]);
      corners[k] = {points[2 * v], points[2 * v + 1]};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.push_back({corners[0][0], corners[0][1], corners[1][0], corners[1][1], corners[2][0], corners[2][1]});
  }
  std::sort(all.begin(), all.end());
  return all;
}

void expect_same_report(const ConstrainedTriangulation& found, const ConstrainedTriangulation& expected) {
  expect_same_arrays(found, expected);
  EXPECT_EQ(found.refinement.rounds, expected.refinement.rounds);
  EXPECT_EQ(found.refinement.bad_triangles, expected.refinement.bad_triangles);
  EXPECT_EQ(found.refinement.excuses, expected.refinement.excuses);
}

TEST(SmallRefined, NothingIsAddedUnlessItIsAskedFor) {
  const Domain domain = one(plate(0));
  ConstrainedOptions options = refined_to(0, 0);
  options.refinement.kept = KeptEdges::all;
  const ConstrainedTriangulation mesh = refine(triangulator(), domain, options);
  EXPECT_TRUE(mesh.added_points.empty());
  EXPECT_EQ(mesh.refinement.rounds, 0U);
}

TEST(SmallRefined, ArraysAreThoseOfTheRefinedMesh) {
  const std::pair<Domain, double> cases[] = {
      {one(plate(0)), 0.5}, {one(cloud(30, 2)), 0.005}, {one(star(1)), 0.02}, {several(), 0.3}};
  for (const auto& [domain, area] : cases) {
    for (const double min_angle : {0.0, 20.0, 30.0}) {
      const double max_area = min_angle == 20 ? 0 : area;
      ConstrainedOptions options = refined_to(min_angle, max_area);
      const ConstrainedTriangulation whole = refine(triangulator(), domain, options);
      EXPECT_TRUE(whole.refinement.added_points > 0 || max_area == 0);
      expect_everything(domain, whole);
      expect_hull(whole);
      expect_quality(domain, whole, min_angle,
                     [&](std::size_t) { return max_area > 0 ? max_area : HUGE_VAL; });
      for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
        options.outside = outside;
        const ConstrainedTriangulation left = refine(triangulator(), domain, options);
        expect_everything(domain, left);
        options.refinement.min_angle = options.refinement.max_area = 0;
        const ConstrainedTriangulation plain = refine(triangulator(), domain, options);
        EXPECT_NEAR(sum(left.areas), sum(plain.areas), 1e-12 * sum(plain.areas));
        options.refinement = refined_to(min_angle, max_area).refinement;
      }
    }
  }
}

// Of triangles that are parts of one, which is seen at their places.
TEST(SmallRefined, LabelsAndAttributesAreInherited) {
  const Domain domain = one(plate(0));
  const ConstrainedTriangulation mesh = refine(triangulator(), domain, refined_to(25, 0.5));
  const Coordinates points = all_points(domain, mesh);
  std::set<std::int32_t> regions;
  for (std::size_t t = 0; t < mesh.areas.size(); ++t) {
    double x = 0, y = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x += points[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])] / 3;
      y += points[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k]) + 1] / 3;
    }
    const bool is_hole = x > 1 && x < 3 && y > 2 && y < 4 + 0.25 * (x - 1);
    const int depth = is_hole ? 2 : 1;
    EXPECT_EQ(mesh.depths[t], depth) << x << ", " << y;
    regions.insert(mesh.regions[t]);
    EXPECT_LE(mesh.regions[t], static_cast<std::int32_t>(regions.size()) - 1) << "a first triangle is before";
    const double attribute = is_hole ? 0 : x > 10.0 / 3 + y / 6 ? 7 : -2;
    EXPECT_EQ(mesh.triangle_attributes[t], attribute) << x << ", " << y;
  }
  EXPECT_EQ(regions.size(), 3U);
}

TEST(SmallRefined, ResultsDoNotDependOnWhatComputes) {
  const Domain domain = several();
  const ConstrainedOptions options = refined_to(30, 0.2);
  const ConstrainedTriangulation expected = refine(triangulator(), domain, options);
  for (const char* threads : {"1", "2", "3"}) {
    const ScopedEnvironment scope("FLAUNAY_THREADS", threads);
    Triangulator host("host"), own;
    expect_same_report(refine(host, domain, options), expected);
    expect_same_report(refine(own, domain, options), expected);
  }
  // Groups of sets are constrained by threads of their own.
  const ScopedEnvironment scope("FLAUNAY_TUNING", "group_points=40");
  Triangulator groups("host");
  ConstrainedOptions uncrossed = options;
  uncrossed.crossings = Crossings::error;
  Domain plates;
  for (int k = 0; k < 20; ++k) {
    plates.add(plate(k));
    plates.add(cloud(9, static_cast<std::uint64_t>(k)));
  }
  plates.seeds = plates.seed_attributes = {};
  plates.seed_offsets = {};
  expect_same_report(refine(groups, plates, uncrossed), refine(triangulator(), plates, uncrossed));
}

TEST(SmallRefined, SetsAreAsByThemselves) {
  const Domain domain = several();
  const ConstrainedOptions options = refined_to(28, 0.2);
  const ConstrainedTriangulation together = refine(triangulator(), domain, options);
  std::vector<Shape> all;
  std::size_t added = 0;
  for (int k = 0; k < 3; ++k) {
    for (const Domain& set :
         {one(plate(2 * k)), one(star(1 + k)), one(cloud(20, static_cast<std::uint64_t>(k)))}) {
      const ConstrainedTriangulation alone = refine(triangulator(), set, options);
      const std::vector<Shape> own = shapes(set, alone);
      all.insert(all.end(), own.begin(), own.end());
      added += alone.refinement.added_points;
    }
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(shapes(domain, together), all);
  EXPECT_EQ(together.refinement.added_points, added);
}

// Smallest edges and limits are those of each set.
TEST(SmallRefined, SetsOfDifferentSizes) {
  const double gap = 1.0 / 64;
  const Domain large = one(cloud(20, 1));
  Domain small;
  close_ring(small, {0, 0, 1, 0, 1, 1, 0, 1}, 1);
  close_ring(small, {0.25, 0.5, 0.75, 0.5, 0.75, 0.5 + gap}, 11);
  Domain domain;
  domain.add(large);
  for (double& value : domain.points) value *= 0x1p36;
  const Domain scaled = domain;
  for (int k = 0; k < 3; ++k) domain.add(small);
  ConstrainedOptions options = refined_to(30, 0);
  options.refinement.most_points = 400;
  const ConstrainedTriangulation mesh = refine(triangulator(), domain, options);
  std::size_t rounds = 0;
  std::vector<Shape> all;
  for (const Domain& set : {scaled, one(small), one(small), one(small)}) {
    const ConstrainedTriangulation alone = refine(triangulator(), set, options);
    rounds = std::max(rounds, alone.refinement.rounds);
    const std::vector<Shape> own = shapes(set, alone);
    EXPECT_GT(own.size(), 20U);
    all.insert(all.end(), own.begin(), own.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(shapes(domain, mesh), all);
  EXPECT_EQ(mesh.refinement.rounds, rounds);
}

TEST(SmallRefined, ShuffledInputHasTheSameTriangles) {
  const Domain domain = one(plate(0.1));
  const ConstrainedOptions options = refined_to(30, 0.3);
  const std::vector<Shape> expected = shapes(domain, refine(triangulator(), domain, options));
  FixtureRandom random(4);
  for (int round = 0; round < 5; ++round) {
    std::vector<std::int32_t> place(domain.point_count()), order(domain.segments.size() / 2);
    std::iota(place.begin(), place.end(), 0);
    std::iota(order.begin(), order.end(), 0);
    random.shuffle(place);
    random.shuffle(order);
    Domain shuffled = domain;
    for (std::size_t i = 0; i < place.size(); ++i) {
      std::copy_n(&domain.points[2 * i], 2, &shuffled.points[2 * static_cast<std::size_t>(place[i])]);
    }
    for (std::size_t s = 0; s < order.size(); ++s) {
      const std::size_t from = 2 * static_cast<std::size_t>(order[s]), turned = random.integer(0, 1);
      for (std::size_t k = 0; k < 2; ++k)
        shuffled.segments[2 * s + k] = place[domain.segments[from + (k ^ turned)]];
    }
    const ConstrainedTriangulation mesh = refine(triangulator(), shuffled, options);
    EXPECT_EQ(shapes(shuffled, mesh), expected);
  }
}

TEST(SmallRefined, AreasOfRegionsAndPlaces) {
  const Domain domain = one(plate(0));
  const double seed_areas[] = {0.02, 0};
  ConstrainedOptions options = refined_to(20, 0.5);
  options.refinement.seed_areas = seed_areas;
  const auto largest = [](const ConstrainedTriangulation& mesh) {
    return [&mesh](std::size_t t) { return mesh.triangle_attributes[t] == 7 ? 0.02 : 0.5; };
  };
  const ConstrainedTriangulation by_region = refine(triangulator(), domain, options);
  expect_everything(domain, by_region);
  expect_quality(domain, by_region, 20, largest(by_region));

  // Areas without attributes.
  Constraints constraints = domain.constraints();
  constraints.seed_attributes = nullptr;
  const ConstrainedTriangulation plain =
      triangulator().constrained(domain.points.data(), domain.offsets, constraints, options);
  EXPECT_EQ(plain.triangles, by_region.triangles);
  EXPECT_TRUE(plain.triangle_attributes.empty());

  options.refinement.seed_areas = nullptr;
  std::size_t calls = 0;
  options.refinement.areas_at = [&](const double* places, std::size_t count, double* areas) {
    ++calls;
    for (std::size_t k = 0; k < count; ++k) areas[k] = places[2 * k] < 5 ? 0.05 : 0;
  };
  const ConstrainedTriangulation by_place = refine(triangulator(), domain, options);
  const Coordinates points = all_points(domain, by_place);
  expect_quality(domain, by_place, 20, [&](std::size_t t) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k)
      x += points[2 * static_cast<std::size_t>(by_place.triangles[3 * t + k])];
    return x / 3 < 5 - 1e-9 ? 0.05 : 0.5;
  });
  EXPECT_GT(calls, 0U);
  EXPECT_LE(calls, by_place.refinement.rounds + 2);
}

// What is refined again has the triangles and attributes of before, in any direction, and smaller areas on
// one side.
TEST(SmallRefined, AMeshIsRefinedFurther) {
  const Domain drawing = one(plate(0));
  ConstrainedOptions options = refined_to(25, 1);
  options.outside = Outside::holes;
  // The wall that has one region on both sides is no segment of the mesh.
  options.refinement.conforming = true;
  const ConstrainedTriangulation coarse = refine(triangulator(), drawing, options);
  Domain domain;
  domain.points = all_points(drawing, coarse);
  domain.offsets = {0, domain.points.size() / 2};
  domain.seed_offsets = {0, 0};
  std::vector<std::int32_t> triangles = coarse.triangles;
  std::vector<double> areas;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const double x = domain.points[2 * triangles[t]] + domain.points[2 * triangles[t + 1]] +
                     domain.points[2 * triangles[t + 2]];
    areas.push_back(x / 3 < 5 ? 0.02 : 0);
    if (t % 2 == 0) std::swap(triangles[t], triangles[t + 1]);
  }
  options = refined_to(0, 0);
  GivenTriangles& mesh = options.refinement.mesh;
  mesh = {triangles.data(), areas.size(), nullptr, coarse.triangle_attributes.data()};
  const auto attributes_of = [](const Domain& of, const ConstrainedTriangulation& from) {
    std::map<double, double> sums;
    for (std::size_t t = 0; t < from.areas.size(); ++t) sums[from.triangle_attributes[t]] += from.areas[t];
    return std::pair(shapes(of, from).size(), sums);
  };
  const ConstrainedTriangulation same = refine(triangulator(), domain, options);
  EXPECT_EQ(shapes(domain, same), shapes(drawing, coarse));
  EXPECT_EQ(same.added_points.size(), 0U);
  EXPECT_EQ(attributes_of(domain, same).second.size(), 2U);

  mesh.areas = areas.data();
  options.refinement.min_angle = 25;
  const ConstrainedTriangulation fine = refine(triangulator(), domain, options);
  EXPECT_NEAR(sum(fine.areas), sum(coarse.areas), 1e-9);
  for (const auto& [attribute, area] : attributes_of(domain, same).second)
    EXPECT_NEAR(attributes_of(domain, fine).second[attribute], area, 1e-9);
  expect_quality(domain, fine, 25, [](std::size_t) { return 1; });
  const Coordinates points = all_points(domain, fine);
  double largest = 0;
  for (std::size_t t = 0; t < fine.areas.size(); ++t) {
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k) x += points[2 * fine.triangles[3 * t + k]] / 3;
    EXPECT_TRUE(x > 4 || fine.areas[t] <= 0.02) << x << ", " << fine.areas[t];
    if (x > 6) largest = std::max(largest, fine.areas[t]);
  }
  EXPECT_GT(largest, 0.2);

  const auto expect_named = [&](const std::string& part, ErrorKind kind) {
    try {
      refine(triangulator(), domain, options);
      ADD_FAILURE() << part;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const std::int32_t first = triangles[0];
  triangles[0] = triangles[1];
  expect_named("triangle 0 of the mesh", ErrorKind::input);
  triangles[0] = static_cast<std::int32_t>(domain.point_count());
  expect_named("no point", ErrorKind::usage);
  std::copy_n(&triangles[3], 3, &triangles[0]);
  expect_named("triangles 0 and 1 of the mesh", ErrorKind::input);
  triangles[0] = first;
  areas[1] = -1;
  expect_named("triangle of the mesh 1", ErrorKind::usage);
  areas[1] = 1;
  options.outside = Outside::hull;
  expect_named("outside", ErrorKind::usage);
}

// Triangles that are not those of the points: areas are where they were given.
TEST(SmallRefined, AreasOfOtherTriangles) {
  Domain domain;
  // A strip whose diagonals are the long ones.
  domain.points = {0, 0, 4, 0, 8, 0, 12, 0, 3, 1, 7, 1, 11, 1};
  domain.offsets = {0, 7};
  domain.seed_offsets = {0, 0};
  const std::vector<std::int32_t> triangles = {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 6};
  const std::vector<double> areas = {0.01, 0, 0, 0, 0};
  ConstrainedOptions options = refined_to(0, 0);
  options.refinement.mesh = {triangles.data(), 5, areas.data(), nullptr};
  const ConstrainedTriangulation mesh = refine(triangulator(), domain, options);
  const ConstrainedTriangulation plain = triangulator().constrained(
      domain.points.data(), domain.offsets, domain.constraints(), ConstrainedOptions());
  EXPECT_NE(plain.triangles, triangles);
  EXPECT_NEAR(sum(mesh.areas), 10, 1e-12);
  // One of the triangles has its centroid in the small one.
  const auto small = std::count_if(mesh.areas.begin(), mesh.areas.end(), [](double a) { return a <= 0.01; });
  EXPECT_GT(small, 150);
  EXPECT_GT(*std::max_element(mesh.areas.begin(), mesh.areas.end()), 0.5);
}

TEST(SmallRefined, ErrorsOfFunctionsOfPlacesEndTheCall) {
  for (const Domain& domain : {one(plate(0)), several()}) {
    ConstrainedOptions options = refined_to(20, 0.5);
    for (int last = 1; last <= 3; ++last) {
      int calls = 0;
      options.refinement.areas_at = [&](const double*, std::size_t count, double* areas) {
        if (++calls == last) throw std::domain_error("mine");
        std::fill(areas, areas + count, 0.01);
      };
      EXPECT_THROW(refine(triangulator(), domain, options), std::domain_error);
      EXPECT_EQ(calls, last);
    }
    options.refinement.areas_at = nullptr;
    expect_everything(domain, refine(triangulator(), domain, options));
  }
}

TEST(SmallRefined, SmoothedMeshes) {
  const Domain domain = several();
  ConstrainedOptions options = refined_to(25, 0.02);
  const ConstrainedTriangulation plain = refine(triangulator(), domain, options);
  options.refinement.smoothing_steps = 3;
  const ConstrainedTriangulation mesh = refine(triangulator(), domain, options);
  expect_everything(domain, mesh);
  expect_quality(domain, mesh, 25, [](std::size_t) { return 0.02; });
  EXPECT_NEAR(mesh.refinement.smallest_angle_before, plain.refinement.smallest_angle, 1e-12);
  EXPECT_GT(mesh.refinement.mean_angle, mesh.refinement.mean_angle_before + 1);
  EXPECT_EQ(plain.refinement.mean_angle, 0);
}

TEST(SmallRefined, KeptEdgesAreNotSplit) {
  const Domain domain = one(plate(0));
  ConstrainedOptions options = refined_to(30, 0.2);
  options.outside = Outside::holes;
  const auto edges_of = [&](const ConstrainedTriangulation& mesh, std::size_t segment) {
    return mesh.piece_edges[2 * segment + 1] - mesh.piece_edges[2 * segment];
  };
  const ConstrainedTriangulation free = refine(triangulator(), domain, options);
  options.refinement.kept = KeptEdges::all;
  const ConstrainedTriangulation kept = refine(triangulator(), domain, options);
  expect_everything(domain, kept);
  EXPECT_EQ(kept.refinement.split_points, 0U);
  EXPECT_EQ(kept.constraint_edges.size() / 2, 12U);
  EXPECT_FALSE(kept.refinement.bad_triangles.empty());
  options.refinement.kept = KeptEdges::border;
  const ConstrainedTriangulation border = refine(triangulator(), domain, options);
  expect_everything(domain, border);
  options.refinement.kept = KeptEdges::none;
  std::vector<std::uint8_t> kept_segments(domain.segments.size() / 2, 0);
  kept_segments[2] = kept_segments[7] = 1;
  options.refinement.kept_segments = kept_segments.data();
  const ConstrainedTriangulation some = refine(triangulator(), domain, options);
  expect_everything(domain, some);
  for (std::size_t s = 0; s < kept_segments.size(); ++s) {
    const bool is_wall = s >= 9;
    const std::int32_t whole = s == 0 ? 2 : 1;
    EXPECT_GT(edges_of(free, s), whole) << s;
    EXPECT_EQ(edges_of(border, s) > whole, is_wall) << s;
    EXPECT_EQ(edges_of(some, s) > whole, kept_segments[s] == 0) << s;
  }
}

TEST(SmallRefined, PolygonsAndMaps) {
  const Coordinates points = {0, 0, 4, 0, 4, 3, 0, 3, 1, 1, 2, 1, 2, 2, 4, 0, 9, 0, 9, 3, 4, 3};
  const Polygons polygons = {points.data(), {0, 4, 7, 11}, {0, 2, 3}};
  PolygonOptions options;
  static_cast<Options&>(options) = refined_to(0, 0);
  options.labels = true;
  options.refinement = refined_to(30, 0.2).refinement;
  for (const bool map : {false, true}) {
    options.map = map;
    const ConstrainedTriangulation mesh = triangulator().polygons(polygons, options);
    EXPECT_NEAR(sum(mesh.areas), 12 - 0.5 + 15, 1e-12);
    EXPECT_LE(*std::max_element(mesh.areas.begin(), mesh.areas.end()), 0.2);
    EXPECT_GE(mesh.refinement.smallest_angle, 30 - 1e-12);
    double of_second = 0;
    for (std::size_t t = 0; t < mesh.areas.size(); ++t) {
      const bool is_second = map ? mesh.polygons[t] == 1 : t >= mesh.triangle_offsets[1];
      if (is_second) of_second += mesh.areas[t];
    }
    EXPECT_NEAR(of_second, 15, 1e-12);
  }
}

TEST(SmallRefined, Limits) {
  const Domain domain = one(plate(0));
  ConstrainedOptions options = refined_to(30, 0.01);
  options.refinement.most_points = 50;
  const ConstrainedTriangulation few = refine(triangulator(), domain, options);
  expect_everything(domain, few);
  EXPECT_LE(few.refinement.added_points, 50U);
  ASSERT_FALSE(few.refinement.excuses.empty());
  EXPECT_EQ(few.refinement.excuses[0], Excuse::most_points);
  expect_quality(domain, few, 30, [](std::size_t) { return 0.01; });
}

// Touching rectangles in metres of a map: between two sides is a sliver as wide as doubles there are apart.
TEST(SmallRefined, SmallestEdgeFarFromTheOrigin) {
  Domain touching;
  close_ring(touching,
             {500678.1709357662, 5000469.351808475, 500657.8201839499, 5000484.798189634, 500647.46619000135,
              5000471.156705653, 500667.81694181764, 5000455.710324494},
             1);
  close_ring(touching,
             {500651.46880684304, 5000476.430190822, 500642.27627582557, 5000483.407394376,
              500639.24653724267, 5000479.415685423, 500648.43906826014, 5000472.438481869},
             11);
  ConstrainedOptions options = refined_to(30, 0);
  options.crossings = Crossings::split;
  options.refinement.most_points = 1000;
  EXPECT_LT(refine(triangulator(), one(touching), options).refinement.added_points, 100U);
}

// Also where squares of lengths are no doubles.
TEST(SmallRefined, AnglesOfAnyScale) {
  for (const int power : {-1074, -600, -514, 0, 512, 1021}) {
    Domain square;
    close_ring(square, {0, 0, 3, 1, 2, 4, -1, 3}, 1);
    for (double& value : square.points) value = std::ldexp(value, power);
    const RefinementReport report = refine(triangulator(), one(square), refined_to(20, 0)).refinement;
    EXPECT_EQ(report.added_points, 0U) << power;
    EXPECT_NEAR(report.smallest_angle, 45, 1e-12) << power;
    EXPECT_NEAR(report.largest_angle, 90, 1e-12) << power;
  }
}

TEST(SmallRefined, WrongRequestsAreNamed) {
  const Domain domain = one(plate(0));
  const auto error_of = [&](const std::function<void(Refinement&)>& change) -> std::string {
    ConstrainedOptions options = refined_to(30, 0);
    change(options.refinement);
    try {
      refine(triangulator(), domain, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
    return "";
  };
  const auto expect_named = [&](const std::string& part, const std::function<void(Refinement&)>& change) {
    EXPECT_NE(error_of(change).find(part), std::string::npos) << error_of(change);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double areas[] = {1, -1};
  expect_named("34.5 degrees", [](Refinement& wanted) { wanted.min_angle = 34.5; });
  expect_named("-1 degrees", [](Refinement& wanted) { wanted.min_angle = -1; });
  expect_named("nan", [&](Refinement& wanted) { wanted.min_angle = nan; });
  expect_named("largest area is -2", [](Refinement& wanted) { wanted.max_area = -2; });
  expect_named("seed 1", [&](Refinement& wanted) { wanted.seed_areas = areas; });
  for (const double wrong : {nan, -0.5, HUGE_VAL})
    expect_named("smallest edge", [&](Refinement& wanted) { wanted.min_edge = wrong; });
}

}  // namespace
}  // namespace flaunay::testing
