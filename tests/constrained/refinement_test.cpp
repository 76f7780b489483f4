// Refinement: by its definition, for domains that are nasty; and the same bytes by any runtime, from input in
// any order.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "constrained/refinement/angles.hpp"
#include "constrained/refinement/cuts.hpp"
#include "constrained/refinement/refine.hpp"
#include "launchers/refinement/smooth.cl.hpp"
#include "prove/exact.hpp"
#include "refinement/codes.h"
#include "refinement/leaves.h"
#include "tests/constrained/domains.hpp"
#include "tests/constrained/moved.hpp"
#include "tests/constrained/nasty_domains.hpp"
#include "tests/constrained/refined.hpp"
#include "tests/support/device.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"

namespace flaunay::testing {
namespace {

using constrained::MeshToRefine;
using constrained::RefinedMesh;

using Runtimes = SharedRuntimes<make_tuned_runtime>;
[[maybe_unused]] ::testing::Environment* const kRuntimes = ::testing::AddGlobalTestEnvironment(new Runtimes);

/// A result that adds nothing.
RefinedMesh unrefined(const MeshToRefine& mesh) {
  RefinedMesh refined;
  refined.triangles = mesh.triangles;
  refined.neighbors = mesh.neighbors;
  refined.edges = mesh.edges;
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t)
    refined.parents.push_back(static_cast<std::int32_t>(t));
  return refined;
}

DomainToRefine unit_square() {
  DomainToRefine domain;
  nasty_detail::add_square(domain, 0.5, 0.5, 0.5);
  return domain;
}

TEST(SmallRefinedCheck, AcceptsWhatIsThere) {
  for (const NastyDomain& nasty : nasty_domains()) {
    SCOPED_TRACE(nasty.name);
    const DomainToRefine domain = nasty.make(40, 1);
    const MeshToRefine mesh = mesh_to_refine(domain);
    EXPECT_GT(mesh.triangles.size(), 0);
    EXPECT_EQ(what_is_wrong(mesh, unrefined(mesh), {}), "");
  }
}

// Each of these is one thing that is wrong with a square of two triangles.
TEST(SmallRefinedCheck, Refuses) {
  const DomainToRefine domain = unit_square();
  const MeshToRefine mesh = mesh_to_refine(domain);
  const auto problem = [&](const auto& change, const Refinement& wanted) {
    RefinedMesh refined = unrefined(mesh);
    change(refined);
    return what_is_wrong(mesh, refined, wanted);
  };
  const auto nothing = [](RefinedMesh&) {};
  Refinement area, angle;
  area.max_area = 0.49;
  EXPECT_NE(problem(nothing, area).find("larger"), std::string::npos);
  area.max_area = 0.5;
  EXPECT_EQ(problem(nothing, area), "");
  angle.min_angle = 30;
  EXPECT_EQ(problem(nothing, angle), "");
  const auto list = [](Excuse excuse) {
    return [excuse](RefinedMesh& refined) {
      refined.report.bad_triangles = {0};
      refined.report.excuses = {excuse};
    };
  };
  EXPECT_NE(problem(list(Excuse::input_angle), angle).find("is not bad"), std::string::npos);
  area.max_area = 0.25;
  EXPECT_NE(problem(list(Excuse::input_angle), area).find("no angle excuses"), std::string::npos);
  EXPECT_NE(problem(list(Excuse::min_edge), area).find("short"), std::string::npos);
  EXPECT_NE(problem(list(Excuse::kept), area).find("kept"), std::string::npos);
  EXPECT_NE(problem(list(Excuse::frozen), area).find("rounding"), std::string::npos);
  EXPECT_NE(problem(list(Excuse::most_points), area).find("points"), std::string::npos);
  EXPECT_NE(problem(list(Excuse::most_rounds), area).find("rounds"), std::string::npos);
  EXPECT_NE(problem([](RefinedMesh& r) { std::swap(r.triangles[1], r.triangles[2]); }, {}), "");
  EXPECT_NE(problem([](RefinedMesh& r) { r.neighbors.assign(6, -1); }, {}), "");
  EXPECT_NE(problem([](RefinedMesh& r) { std::swap(r.edges[0], r.edges[1]); }, {}), "");
  EXPECT_NE(problem([](RefinedMesh& r) { r.parents[1] = 2; }, {}), "");
  EXPECT_NE(problem([](RefinedMesh& r) { r.triangles.resize(3); }, {}), "");
  // Cut along the other diagonal.
  EXPECT_NE(problem(
                [](RefinedMesh& r) {
                  const auto border = [&](std::int32_t a, std::int32_t b) {
                    for (std::size_t c = 0; c < 6; ++c) {
                      const std::size_t t = c - c % 3;
                      if (r.neighbors[c] < 0 && r.triangles[t + (c + 1) % 3] == a &&
                          r.triangles[t + (c + 2) % 3] == b)
                        return r.edges[c];
                    }
                    return std::int32_t{-1};
                  };
                  const std::int32_t e01 = border(0, 1), e12 = border(1, 2), e23 = border(2, 3),
                                     e30 = border(3, 0);
                  const bool is_from_0 = std::find(&r.triangles[0], &r.triangles[3], 2) != &r.triangles[3] &&
                                         std::find(&r.triangles[0], &r.triangles[3], 0) != &r.triangles[3];
                  if (is_from_0) {
                    r.triangles = {0, 1, 3, 1, 2, 3};
                    r.neighbors = {1, -1, -1, -1, 0, -1};
                    r.edges = {-1, e30, e01, e23, -1, e12};
                  } else {
                    r.triangles = {0, 1, 2, 0, 2, 3};
                    r.neighbors = {-1, 1, -1, -1, -1, 0};
                    r.edges = {e12, -1, e01, e23, e30, -1};
                  }
                },
                {})
                .find("not in a fan"),
            std::string::npos);
}

// ---------------------------------------------------------------------------------------------------------------------
// Results

/// Under the tuning that the environment names alone, if it names one.
std::vector<std::string> tunings() {
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return {"own"};
  return {"own", "small", "gpu"};
}

void expect_same(const RefinedMesh& found, const RefinedMesh& expected) {
  EXPECT_TRUE(same(found.added, expected.added));
  EXPECT_TRUE(same(found.added_edges, expected.added_edges));
  EXPECT_TRUE(same(found.added_places, expected.added_places));
  EXPECT_TRUE(same(found.triangles, expected.triangles));
  EXPECT_TRUE(same(found.neighbors, expected.neighbors));
  EXPECT_TRUE(same(found.edges, expected.edges));
  EXPECT_TRUE(same(found.parents, expected.parents));
  EXPECT_TRUE(same(found.report.bad_triangles, expected.report.bad_triangles));
  EXPECT_EQ(found.report.excuses, expected.report.excuses);
  EXPECT_EQ(found.report.rounds, expected.report.rounds);
}

host::Runtime& native_runtime() {
  static host::Runtime runtime(native_tuning(""));
  return runtime;
}

/// By the definition, the same from input in another order, and the same bytes with every tuning, also with
/// tiny blocks. Returns the result.
RefinedMesh expect_right(const MeshToRefine& mesh, const Refinement& wanted) {
  const RefinedMesh refined = constrained::refine(native_runtime(), mesh, wanted);
  EXPECT_EQ(what_is_wrong(mesh, refined, wanted), "");
  const OwnedMesh other = shuffled(mesh, 7);
  const RefinedMesh from_other = constrained::refine(native_runtime(), other.mesh, wanted);
  EXPECT_TRUE(ByCoordinates(other.mesh, from_other) == ByCoordinates(mesh, refined));
  const RefinedMesh by_tiny = constrained::refine(native_runtime(), mesh, wanted, 2);
  EXPECT_EQ(what_is_wrong(mesh, by_tiny, wanted), "");
  EXPECT_TRUE(ByCoordinates(other.mesh, constrained::refine(native_runtime(), other.mesh, wanted, 2)) ==
              ByCoordinates(mesh, by_tiny));
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    expect_same(constrained::refine(Runtimes::get(tuning), mesh, wanted), refined);
    expect_same(constrained::refine(Runtimes::get(tuning), mesh, wanted, 2), by_tiny);
  }
  return refined;
}

/// So many natively, and fewer where rounds of little work take long.
int repeated(int times) { return tests_native() ? times : std::max(1, times / 12); }

Refinement angle_of(double degrees) {
  Refinement wanted;
  wanted.min_angle = degrees;
  wanted.most_points = tests_native() ? 1000 : 200;
  return wanted;
}

std::size_t excused_for(const RefinedMesh& refined, Excuse excuse) {
  return static_cast<std::size_t>(
      std::count(refined.report.excuses.begin(), refined.report.excuses.end(), excuse));
}

TEST(SmallRefinement, NastyDomains) {
  const auto& all = nasty_domains();
  const std::size_t step = all.size() / static_cast<std::size_t>(repeated(static_cast<int>(all.size())));
  for (std::size_t i = 0; i < all.size(); i += step) {
    SCOPED_TRACE(all[i].name);
    const DomainToRefine domain = all[i].make(20, 3);
    expect_right(mesh_to_refine(domain), angle_of(28));
    if (HasFailure()) return;
  }
}

// Coordinates with few bits to spare, and tiny ones.
TEST(SmallRefinement, CoordinatesOfAnyMagnitude) {
  for (const auto& [scale, shift] : std::vector<std::pair<double, double>>{
           {1, 1e13}, {0.05, 1e13}, {1e-30, 0}, {0x1p300, 0}, {0x1p-300, 0}}) {
    SCOPED_TRACE(std::to_string(scale) + " at " + std::to_string(shift));
    DomainToRefine domain = nasty_detail::wedges(8, 2);
    for (double& value : domain.points) value = scale * value + shift;
    expect_right(mesh_to_refine(domain), angle_of(25));
    if (!tests_native()) return;
  }
}

/// Times 2^power, which may round.
DomainToRefine scaled(DomainToRefine domain, int power) {
  for (Coordinates* const places : {&domain.points, &domain.holes}) {
    for (double& x : *places) x = std::ldexp(x, power);
  }
  return domain;
}

// In units that are a power of two apart, results are the same as far as doubles have the binary places.
TEST(SmallRefinement, UnitsDoNotMatter) {
  const auto& all = nasty_domains();
  const std::size_t step = all.size() / static_cast<std::size_t>(repeated(static_cast<int>(all.size())));
  for (std::size_t i = 0; i < all.size(); i += step) {
    SCOPED_TRACE(all[i].name);
    const DomainToRefine domain = all[i].make(16, 9);
    MeshToRefine mesh = mesh_to_refine(domain);
    Refinement wanted = angle_of(i % 4 == 0 ? 0 : 25);
    if (i % 4 == 0) wanted.max_area = 0.5;
    if (i % 3 == 0) wanted.min_edge = 0.125;
    wanted.conforming = i % 5 == 0;
    wanted.smoothing_steps = i % 7 == 0;
    const RefinedMesh expected = constrained::refine(native_runtime(), mesh, wanted);
    for (const int power : {-820, -386, -1, 2, 512, 960}) {
      SCOPED_TRACE(power);
      if (wanted.max_area > 0 && std::abs(power) > 500) continue;  // there is no such area
      const DomainToRefine other = scaled(domain, power);
      mesh.coordinates = other.points.data();
      Refinement demand = wanted;
      demand.max_area = std::ldexp(wanted.max_area, 2 * power);
      if (wanted.min_edge > 0) demand.min_edge = std::ldexp(wanted.min_edge, power);
      RefinedMesh found = constrained::refine(native_runtime(), mesh, demand);
      EXPECT_EQ(what_is_wrong(mesh, found, demand), "");
      for (double& x : found.added) x = std::ldexp(x, -power);
      expect_same(found, expected);
    }
    if (HasFailure()) return;
  }
}

// Where there are few doubles, or the lowest bit of the input has none below it.
TEST(SmallRefinement, ScalesFromTheSmallestDoubleToTheLargest) {
  for (const int power : {-1073, -1070, -1060, -1040, -386, -220, -205, 510, 1021}) {
    SCOPED_TRACE(power);
    DomainToRefine domain;
    domain.points = {-1.5, 2, 1, -1.5, 2, -1, 1.5, 2};
    domain.chain(0, true);
    domain = scaled(domain, power);
    Refinement wanted = angle_of(25);
    wanted.conforming = true;
    wanted.max_area = std::ldexp(0.3, 2 * power);
    const RefinedMesh refined = expect_right(mesh_to_refine(domain), wanted);
    // Otherwise no area is as small, or all are.
    EXPECT_TRUE(std::abs(power) > 510 || refined.report.bad_triangles.empty());
    if (!tests_native()) return;
  }
}

TEST(SmallRefinement, NothingIsWanted) {
  const DomainToRefine domain = nasty_detail::polygon(30, 2);
  const MeshToRefine mesh = mesh_to_refine(domain);
  EXPECT_EQ(expect_right(mesh, {}).added.size(), 0);
  const DomainToRefine flat = nasty_detail::wedges(8, 2);
  EXPECT_EQ(expect_right(mesh_to_refine(flat), {}).added.size(), 0);
  Refinement wanted = angle_of(30);
  wanted.most_points = 0;
  const RefinedMesh none = expect_right(mesh, wanted);
  EXPECT_EQ(none.added.size(), 0);
  EXPECT_EQ(excused_for(none, Excuse::most_points), none.report.excuses.size());
  EXPECT_GT(none.report.excuses.size(), 0);
  wanted = angle_of(30);
  wanted.most_rounds = 1;
  EXPECT_EQ(expect_right(mesh, wanted).report.rounds, 1);
}

TEST(SmallRefinement, Areas) {
  const DomainToRefine domain = nasty_detail::polygon(30, 4);
  MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.max_area = 2;
  const RefinedMesh by_area = expect_right(mesh, wanted);
  EXPECT_GT(by_area.triangles.size() / 3, 100);
  EXPECT_EQ(by_area.report.bad_triangles.size(), 0);

  wanted.max_area = 0;
  wanted.areas_at = [](const double* places, std::size_t count, double* areas) {
    for (std::size_t i = 0; i < count; ++i) areas[i] = places[2 * i] > 0 ? HUGE_VAL : 2;
  };
  const RefinedMesh by_place = expect_right(mesh, wanted);
  EXPECT_GT(by_place.triangles.size(), mesh.triangles.size());
  EXPECT_LT(by_place.triangles.size(), by_area.triangles.size());

  wanted.areas_at = nullptr;
  const std::vector<std::int32_t> regions = regions_of(mesh.neighbors, mesh.edges);
  for (const std::int32_t region : regions) mesh.largest_areas.push_back(region == 0 ? 1 : 0);
  const RefinedMesh by_region = expect_right(mesh, wanted);
  EXPECT_GT(by_region.triangles.size(), mesh.triangles.size());

  // Of a triangle alone: what is beside it is as it was but for a few that are needed.
  for (const bool is_limited : {true, false}) {
    mesh.largest_areas.assign(mesh.triangles.size() / 3, is_limited ? 0 : 2);
    mesh.largest_areas[mesh.largest_areas.size() / 2] = is_limited ? 2 : 0;
    expect_right(mesh, wanted);
  }

  // All at once, and where rounds end early.
  wanted.max_area = 3;
  wanted.areas_at = [](const double*, std::size_t count, double* areas) {
    std::fill(areas, areas + count, 0.5);
  };
  expect_right(mesh, wanted);
  wanted.most_rounds = 2;
  EXPECT_GT(expect_right(mesh, wanted).report.bad_triangles.size(), 0);
}

TEST(SmallRefinement, KeptEdges) {
  const DomainToRefine domain = nasty_detail::letter(0, 3);
  MeshToRefine mesh = mesh_to_refine(domain);
  mesh.kept_edges.assign(mesh.edge_ends.size() / 2, 1);
  const RefinedMesh refined = expect_right(mesh, angle_of(30));
  EXPECT_EQ(refined.report.split_points, 0);
  EXPECT_GT(excused_for(refined, Excuse::kept), 0);
  mesh.kept_edges.assign(mesh.edge_ends.size() / 2, 0);
  EXPECT_EQ(excused_for(expect_right(mesh, angle_of(30)), Excuse::kept), 0);
}

// A border of rounded points is not straight: between it and the hull are triangles of a height of 2^-54.
TEST(SmallRefinement, PocketsOfRoundedBorders) {
  DomainToRefine domain;
  for (int k = 0; k <= 10; ++k) domain.point(k / 10.0, k / 30.0);
  domain.point(0.3, 1);
  domain.chain(0, true);
  const MeshToRefine mesh = mesh_to_refine(domain);
  EXPECT_GT(mesh.triangles.size() / 3, 10);
  const RefinedMesh refined = expect_right(mesh, angle_of(30));
  EXPECT_LT(refined.added_edges.size(), 200);
  EXPECT_GT(excused_for(refined, Excuse::frozen), 0);
  EXPECT_EQ(excused_for(refined, Excuse::frozen) + excused_for(refined, Excuse::input_angle),
            refined.report.excuses.size());
}

// No edge that is left is needed: the triangles are those of the points alone.
TEST(SmallRefinement, Conforming) {
  DomainToRefine domain = unit_square();
  domain.segment(0.2, 0.5, 0.8, 0.5);
  domain.point(0.5, 0.55);
  const MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.conforming = true;
  const RefinedMesh refined = expect_right(mesh, wanted);
  EXPECT_EQ(refined.report.bad_triangles.size(), 0);
  EXPECT_GT(refined.report.split_points, 0);
  EXPECT_EQ(refined.report.split_points, refined.report.added_points);
  Coordinates points = domain.points;
  points.insert(points.end(), refined.added.begin(), refined.added.end());
  ExactPredicates exact;
  for (std::size_t c = 0; c < refined.neighbors.size(); ++c) {
    if (refined.neighbors[c] < 0) continue;
    const double* corners[3];
    for (std::size_t k = 0; k < 3; ++k) corners[k] = &points[2 * refined.triangles[c - c % 3 + k]];
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const p = &points[2 * refined.triangles[3 * refined.neighbors[c] + k]];
      EXPECT_LE(exact.incircle(corners[0], corners[1], corners[2], p), 0);
    }
  }
  wanted.min_angle = 25;
  expect_right(mesh, wanted);
  MeshToRefine kept = mesh;
  kept.kept_edges.assign(mesh.edge_ends.size() / 2, 1);
  EXPECT_GT(excused_for(expect_right(kept, wanted), Excuse::kept), 0);
}

// Segments so close to each other that only the smallest edge ends the refinement.
TEST(SmallRefinement, SmallestEdge) {
  DomainToRefine domain = unit_square();
  domain.segment(0.25, 0.5, 0.75, 0.5);
  domain.segment(0.25, 0.5 + 1e-9, 0.75, 0.5 + 1e-9);
  Refinement wanted = angle_of(30);
  wanted.min_edge = 0.02;
  const RefinedMesh refined = expect_right(mesh_to_refine(domain), wanted);
  EXPECT_LT(refined.added_edges.size(), 1000);
  EXPECT_EQ(excused_for(refined, Excuse::min_edge), refined.report.excuses.size());
  EXPECT_GT(refined.report.excuses.size(), 0);
}

// Points of one round that are near to each other: on two segments, at an apex, and any others.
TEST(SmallRefinement, SmallestEdgeWithinARound) {
  DomainToRefine domain;
  domain.points = {0.25, 0, 0, -1, -0.25, 0};
  Refinement wanted = angle_of(20);
  wanted.max_area = 0.002;
  wanted.min_edge = 0.25;
  expect_right(mesh_to_refine(domain), wanted);
  // As near as doubles are.
  domain.points = {1.6213730109551478e+37, 2.1954370617152846e+37, 1.6213730109550668e+37,
                   2.195437061715312e+37,  1.621373010955045e+37,  2.195437061715323e+37};
  wanted = angle_of(30);
  wanted.min_edge = 6.45253392423892e+21;
  expect_right(mesh_to_refine(domain), wanted);
  const auto& all = nasty_domains();
  for (std::size_t i = 0; i < all.size() && tests_native(); ++i) {
    SCOPED_TRACE(all[i].name);
    domain = all[i].make(12, 4);
    const MeshToRefine mesh = mesh_to_refine(domain);
    wanted.min_angle = 30;
    wanted.max_area = 0;
    wanted.smoothing_steps = i % 2;
    for (wanted.min_edge = 2; wanted.min_edge > 1e-2; wanted.min_edge /= 9) expect_right(mesh, wanted);
    if (HasFailure()) return;
  }
}

// At 2^62 doubles are so far apart that no point mends triangles of a height of 1. Points on a side that is
// as long would make triangles that all have it in their circles.
TEST(SmallRefinement, NoSmallestEdge) {
  DomainToRefine domain;
  domain.points = {0, 0, 0x1p62, 0, 0x1p62, 1, 0, 1};
  Refinement wanted = angle_of(30);
  wanted.min_edge = 0;
  const RefinedMesh refined = expect_right(mesh_to_refine(domain), wanted);
  for (std::size_t i = 0; i < refined.added.size(); i += 2) EXPECT_LT(refined.added[i], 0x1p62);
}

// A point that rounding would move by more than an eighth of its distance from the triangle is not inserted.
TEST(SmallRefinement, RoundedPoints) {
  DomainToRefine domain;
  domain.points = {0, 0, 8, 0, 8, 8, 0, 8, 4, 4, 5, 4};
  for (double& x : domain.points) x += 0x1p52;
  Refinement wanted = angle_of(30);
  wanted.min_edge = 0;
  const RefinedMesh refined = expect_right(mesh_to_refine(domain), wanted);
  EXPECT_EQ(refined.added.size(), 0);
  EXPECT_GT(excused_for(refined, Excuse::min_edge), 0);
}

// An edge that rounding did not allow to split beside a flat triangle, which others replace later.
TEST(SmallRefinement, FrozenEdgesThaw) {
  if (!tests_native()) GTEST_SKIP() << "hundreds of rounds";
  DomainToRefine domain;
  domain.points = {1.2408,        0.401, 1, 0, 1.24045281663, 0.400662130809, 1.24045281664, 0.40066213,
                   1.24045699574, 0.401, 0, 0};
  domain.segments = {3, 4};
  Refinement wanted = angle_of(33);
  wanted.most_points = 3000;
  EXPECT_EQ(excused_for(expect_right(mesh_to_refine(domain), wanted), Excuse::frozen), 0);
}

// Also where only the triangle beyond has moved.
TEST(SmallRefinement, EdgesThawBesideMovedTriangles) {
  host::Runtime& runtime = Runtimes::get("own");
  const host::Arena::Scope scope(runtime.arena());
  const cl_int frozen = 5 | kernel::EDGE_FROZEN;
  // In a row; the first and the last edge are on the border.
  const std::vector<kernel::mesh_row> strip = {{{0, 1, 2}, {1, -1, -1}, {frozen, frozen, -1}, 0, 0},
                                               {{1, 3, 2}, {2, 0, -1}, {frozen, frozen, -1}, 0, 0},
                                               {{3, 4, 2}, {-1, 1, -1}, {frozen, frozen, -1}, 0, 0}};
  const auto rows = upload(runtime, strip);
  const auto states = upload(runtime, std::vector<cl_uchar>(3, kernel::ROW_BAD));
  runtime.map(3,
              kernels::forget_changed{
                  .changes = upload(runtime, std::vector<cl_uint>{2, 0, 0}), .rows = rows, .states = states});
  EXPECT_EQ(download(runtime, states, 3),
            (std::vector<cl_uchar>{kernel::ROW_NEW, kernel::ROW_BAD, kernel::ROW_BAD}));
  std::vector<cl_int> edges;
  for (const kernel::mesh_row& row : download(runtime, rows, 3))
    edges.insert(edges.end(), row.edge, row.edge + 3);
  EXPECT_EQ(edges, (std::vector<cl_int>{5, 5, -1, frozen, 5, -1, frozen, frozen, -1}));
}

TEST(SmallRefinement, SmallInputAngles) {
  DomainToRefine domain;
  domain.point(0, 0);
  domain.point(1, 0);
  domain.point(0.9, 0.1);
  domain.chain(0, true);
  const RefinedMesh refined = expect_right(mesh_to_refine(domain), angle_of(30));
  const std::size_t excused =
      excused_for(refined, Excuse::input_angle) + excused_for(refined, Excuse::near_apex);
  EXPECT_GE(excused_for(refined, Excuse::input_angle), 1);
  EXPECT_EQ(excused, refined.report.excuses.size());
}

/// A square with a triangle inside, turned by an angle.
DomainToRefine turned_triangle(double angle, const Coordinates& corners) {
  DomainToRefine domain;
  nasty_detail::add_square(domain, 0.5, 0.5, 0.5);
  const auto first = static_cast<std::int32_t>(domain.points.size() / 2);
  for (std::size_t k = 0; k < corners.size(); k += 2) {
    const double x = corners[k], y = corners[k + 1];
    domain.point(0.5 + std::cos(angle) * x - std::sin(angle) * y,
                 0.5 + std::sin(angle) * x + std::cos(angle) * y);
  }
  domain.chain(first, true);
  return domain;
}
constexpr double kTurn = 2 * 3.141592653589793;

// Only an angle of the domain excuses triangles, and never those that stand on a constraint.
TEST(SmallRefinement, AnglesOutsideExcuseNothing) {
  DomainToRefine domain = turned_triangle(0, {-0.3, 0, 0.1, -0.0035, 0.1, 0.0035});
  domain.outside = Outside::holes;
  EXPECT_EQ(expect_right(mesh_to_refine(domain), angle_of(30)).report.bad_triangles.size(), 0);
  // Corners of 60 degrees, which rounding makes smaller.
  FixtureRandom random(1);
  for (int round = 0; round < repeated(200); ++round) {
    const double half = 0.2 * std::sqrt(3.0);
    domain = turned_triangle(kTurn * random.unit(), {0.4, 0, -0.2, half, -0.2, -half});
    for (const Outside outside : {Outside::holes, Outside::hull}) {
      domain.outside = outside;
      const MeshToRefine mesh = mesh_to_refine(domain);
      const RefinedMesh refined = constrained::refine(native_runtime(), mesh, angle_of(30));
      ASSERT_EQ(what_is_wrong(mesh, refined, angle_of(30)), "");
      ASSERT_EQ(refined.report.bad_triangles.size(), 0) << round;
    }
  }
}

// Bad triangles for eight blocks are one, in which nothing waits for further rounds.
TEST(SmallRefinement, FewBlocksAreOne) {
  DomainToRefine domain;
  for (int i = 0; i < 500; ++i) {
    const double angle = kTurn * i / 500, radius = 1 + 0.01 * std::sin(i * i);
    domain.point(radius * std::cos(angle), radius * std::sin(angle));
  }
  domain.chain(0, true);
  domain.outside = Outside::holes;
  const MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.min_angle = 30;
  EXPECT_EQ(constrained::refine(native_runtime(), mesh, wanted).report.rounds, 1);
  EXPECT_GT(constrained::refine(native_runtime(), mesh, wanted, 50).report.rounds, 1);
}

// Two angles of 25 degrees but for rounding, of which one is between edges of the border.
TEST(SmallRefinement, TheSmallestAngleIsExact) {
  FixtureRandom random(1);
  Refinement wanted = angle_of(30);
  wanted.most_points = 0;
  std::size_t excused = 0;
  for (int round = 0; round < 100; ++round) {
    const double angle = kTurn * random.unit(), c = std::cos(angle), s = std::sin(angle);
    DomainToRefine domain;
    for (const auto& [x, y] :
         {std::pair(-1.0, 0.0), {1.0, 0.0}, {1.0, 0.7}, {0.0, std::tan(kTurn * 25 / 360)}})
      domain.point(c * x - s * y, s * x + c * y);
    const MeshToRefine mesh = mesh_to_refine(domain);
    const RefinedMesh refined = constrained::refine(native_runtime(), mesh, wanted);
    ASSERT_EQ(what_is_wrong(mesh, refined, wanted), "") << round;
    excused += excused_for(refined, Excuse::input_angle);
  }
  EXPECT_GT(excused, 20);
  EXPECT_LT(excused, 80);
}

// Positions by the sequential twin, and then the canonical triangulation of these.
TEST(SmallRefinement, SmoothingMovesPointsByItsDefinition) {
  std::size_t moved = 0, cancelled = 0;
  for (const auto& [area, min_edge] :
       {std::pair(0.0, kDefaultMinEdge), {1.0, kDefaultMinEdge}, {0.0, 0.02}}) {
    DomainToRefine domain = nasty_detail::polygon(60, 3);
    if (area == 0) {
      domain = {};
      domain.points = make_fixture("uniform", 400, 1);
    }
    const MeshToRefine mesh = mesh_to_refine(domain);
    Refinement wanted = angle_of(area > 0 ? 20 : 30);
    wanted.most_points = 10000;
    wanted.max_area = area;
    wanted.min_edge = min_edge;
    const RefinedMesh before = constrained::refine(native_runtime(), mesh, wanted);
    wanted.smoothing_steps = 1;
    const RefinedMesh after = expect_right(mesh, wanted);
    const Moves moves(mesh, before, wanted);
    moved += moves.proposed();
    cancelled += moves.cancelled();
    const Coordinates expected = moves.added();
    ASSERT_GE(after.added.size(), expected.size());
    EXPECT_TRUE(same({after.added.begin(), after.added.begin() + std::ssize(expected)}, expected));
    EXPECT_EQ(after.report.rounds == before.report.rounds, after.added.size() == expected.size());
  }
  EXPECT_GT(moved, 20);
  EXPECT_GT(cancelled, 0);
}

TEST(SmallRefinement, SmoothedDomains) {
  const auto& all = nasty_domains();
  const std::size_t step = all.size() / static_cast<std::size_t>(repeated(static_cast<int>(all.size())));
  for (std::size_t i = 0; i < all.size(); i += step) {
    SCOPED_TRACE(all[i].name);
    const DomainToRefine domain = all[i].make(20, 5);
    Refinement wanted = angle_of(i % 3 == 0 ? 0 : 25);
    if (i % 2 == 0) {
      wanted.areas_at = [](const double* places, std::size_t count, double* areas) {
        for (std::size_t k = 0; k < count; ++k) areas[k] = 0.01 + places[2 * k] * places[2 * k];
      };
    }
    wanted.smoothing_steps = 3;
    expect_right(mesh_to_refine(domain), wanted);
    if (HasFailure()) return;
  }
}

TEST(SmallRefinement, Refuses) {
  const DomainToRefine domain = unit_square();
  MeshToRefine mesh = mesh_to_refine(domain);
  const auto kind = [&](const Refinement& wanted) {
    try {
      constrained::refine(Runtimes::get("own"), mesh, wanted);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  Refinement wanted;
  for (const double angle : {-1.0, 34.5, HUGE_VAL, std::nan("")}) {
    wanted.min_angle = angle;
    EXPECT_EQ(kind(wanted), ErrorKind::usage) << angle;
  }
  wanted = {};
  for (const double area : {-1.0, std::nan("")}) {
    wanted.max_area = area;
    EXPECT_EQ(kind(wanted), ErrorKind::usage) << area;
  }
  wanted = {};
  mesh.largest_areas = {1, -1};
  EXPECT_EQ(kind(wanted), ErrorKind::usage);
  mesh.largest_areas.clear();
  wanted.areas_at = [](const double*, std::size_t count, double* areas) {
    std::fill(areas, areas + count, std::nan(""));
  };
  EXPECT_EQ(kind(wanted), ErrorKind::usage);
}

TEST(SmallRefinement, RandomDomains) {
  FixtureRandom random(1);
  const auto& all = nasty_domains();
  for (int round = 0; round < repeated(60); ++round) {
    const auto& nasty = all[static_cast<std::size_t>(random.integer(0, std::ssize(all) - 1))];
    SCOPED_TRACE(std::to_string(round) + ": " + nasty.name);
    DomainToRefine domain =
        nasty.make(static_cast<int>(random.integer(4, 40)), static_cast<std::uint64_t>(round));
    move_and_scale(random, domain);
    Refinement wanted = angle_of(random.integer(0, 3) == 0 ? 33 : 30 * random.unit());
    MeshToRefine mesh;
    try {
      mesh = mesh_to_refine(domain);
    } catch (const Error&) {
      continue;  // rounding made segments cross
    }
    expect_right(mesh, wanted);
    if (HasFailure()) return;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Large input: the number of points beside that of Triangle 1.6.

struct Known {
  const char* name;
  std::size_t n;
  double degrees, area;
  std::size_t of_triangle;
};

// At most so many times the points of Triangle 1.6, more for few points, most of which are near the hull.
TEST(Refinement, NumbersOfPoints) {
  const std::vector<Known> all = {
      {"uniform", 1000, 20.7, 0, 1924},   {"uniform", 1000, 30, 0, 3492},   {"kuzmin", 1000, 30, 0, 3027},
      {"uniform", 10000, 20.7, 0, 16729}, {"uniform", 10000, 30, 0, 28796}, {"uniform", 10000, 33, 0, 38659},
      {"kuzmin", 10000, 20.7, 0, 16088},  {"kuzmin", 10000, 30, 0, 27788},  {"square", 0, 30, 1e-4, 8063}};
  for (const Known& known : all) {
    SCOPED_TRACE(known.name + std::string(" ") + std::to_string(known.n) + " at " +
                 std::to_string(known.degrees));
    DomainToRefine domain = unit_square();
    if (!tests_native() && known.n != 1000) continue;
    if (known.n > 0) {
      domain = {};
      domain.points = make_fixture(known.name, known.n, 1);
    }
    const MeshToRefine mesh = mesh_to_refine(domain);
    Refinement wanted;
    wanted.min_angle = known.degrees;
    wanted.max_area = known.area;
    const RefinedMesh refined = constrained::refine(Runtimes::get("own"), mesh, wanted);
    EXPECT_EQ(what_is_wrong(mesh, refined, wanted), "");
    // Corners of the hull may be sharper.
    EXPECT_EQ(excused_for(refined, Excuse::input_angle) + excused_for(refined, Excuse::near_apex),
              refined.report.excuses.size());
    const auto points = static_cast<double>(mesh.points + refined.report.added_points);
    EXPECT_LE(points,
              static_cast<double>(known.of_triangle) * (known.n < 10000 || known.degrees > 30 ? 1.07 : 1.04));
    EXPECT_LE(refined.report.rounds, 10);
  }
}

// Angles are on average better, none is below the bound, and nearly no points are added.
TEST(Refinement, SmoothingMakesTrianglesMoreRegular) {
  const DomainToRefine domain = nasty_detail::polygon(200, 5);
  const MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.min_angle = 25;
  wanted.max_area = 0.2;
  wanted.smoothing_steps = 5;
  const RefinedMesh refined = constrained::refine(native_runtime(), mesh, wanted);
  EXPECT_EQ(what_is_wrong(mesh, refined, wanted), "");
  Coordinates points(mesh.coordinates, mesh.coordinates + 2 * mesh.points);
  points.insert(points.end(), refined.added.begin(), refined.added.end());
  constrained::Angles angles(true);
  for (std::size_t t = 0; t < refined.triangles.size(); t += 3)
    angles.add(points.data(), &refined.triangles[t]);
  EXPECT_GT(angles.mean(), refined.before_smoothing.mean() + 2);
  wanted.smoothing_steps = 0;
  const RefinedMesh before = constrained::refine(native_runtime(), mesh, wanted);
  EXPECT_EQ(before.before_smoothing.mean(), 0);
  EXPECT_LE(static_cast<double>(refined.report.added_points),
            1.01 * static_cast<double>(before.report.added_points));
}

// Threads and groups, with more work than one of them takes.
TEST(Refinement, SameBytes) {
  const DomainToRefine domain = nasty_detail::polygon(2000, 5);
  const MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.min_angle = 30;
  wanted.smoothing_steps = 2;
  const RefinedMesh refined = expect_right(mesh, wanted);
  for (const std::size_t threads : {1, 2, 3}) {
    SCOPED_TRACE(threads);
    host::Runtime runtime(native_tuning(), threads);
    expect_same(constrained::refine(runtime, mesh, wanted), refined);
  }
  if (std::getenv("FLAUNAY_TUNING") == nullptr)
    expect_same(constrained::refine(Runtimes::get("gpu:32"), mesh, wanted), refined);
}

// Few places are cut by one thread, many by several.
TEST(Refinement, LeavesHaveNumbersOfTheirOwn) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate;
  for (const std::size_t n : {1000, 20000}) {
    std::vector<kernel::double2> places(n);
    for (kernel::double2& place : places) place = {coordinate(random), coordinate(random)};
    for (const constrained::Cuts how : {constrained::Cuts::medians, constrained::Cuts::gaps}) {
      const auto cuts = constrained::cut_plane(native_runtime(), places, 50, how);
      std::vector<std::size_t> counts(constrained::leaves_of(cuts), 0);
      for (const kernel::double2 place : places)
        ++counts.at(static_cast<std::size_t>(kernel::leaf_at(cuts.data(), place)));
      EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 0);
      EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 50);
    }
  }
}

// So many rows, bad triangles and vertices that threads share the loops between phases and after them.
TEST(Refinement, SameBytesOfMany) {
  const DomainToRefine domain = nasty_detail::polygon(40000, 5);
  const MeshToRefine mesh = mesh_to_refine(domain);
  Refinement wanted;
  wanted.min_angle = 25;
  host::Runtime one(native_tuning(), 1), three(native_tuning(), 3);
  const RefinedMesh refined = constrained::refine(one, mesh, wanted);
  EXPECT_GT(refined.parents.size(), 100000);
  expect_same(constrained::refine(three, mesh, wanted), refined);
}

}  // namespace
}  // namespace flaunay::testing
