// What the kernels of a round write, beside plain sequential code: frames of blocks, the points and open
// edges that go on, rows, and the vertices of hulls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "blocks/open_sectors.h"
#include "launchers/blocks/rounds.cl.hpp"
#include "mesh/limits.h"
#include "points/sampled_cuts.h"
#include "predicates/bounds.h"
#include "tests/blocks/support.hpp"

namespace flaunay::blocks {
namespace {

using testing::download;
using testing::guarded;
using testing::upload;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// On the host with the sizes it has, on a device for groups of several sizes. larger: blocks of so many
/// points are not.
void with_round_runtimes(const std::function<void(Runtime&)>& check) {
  if (testing::tests_native()) return check(Runtimes::get("own"));
  with_groups(1000, check);
}

/// Points with small integer coordinates, whose orientations are exact in doubles, each but once.
Coordinates distinct_places(std::size_t most, std::int64_t width, std::int64_t height,
                            FixtureRandom& random) {
  const Coordinates all = coarse(most, width, height, random);
  std::set<std::pair<double, double>> seen;
  Coordinates distinct;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    if (seen.insert({all[i], all[i + 1]}).second) append(distinct, {all[i], all[i + 1]});
  }
  return distinct;
}

/// Sets of blocks, with their triangulations.
struct SolvedSets {
  BlockPoints points;
  std::vector<cl_int> set_blocks{0};

  Blocks blocks;
  Rings rings;
  std::vector<cl_double2> vertices;
  std::vector<kernel::ring_edge> edges;
  std::vector<cl_int> vertex_edge, distinct;
  std::vector<kernel::solved_block> solved;

  void end_set() { set_blocks.push_back(static_cast<cl_int>(points.count())); }
  std::size_t sets() const { return set_blocks.size() - 1; }
  /// largest: 0 for the largest block's size; blocks of more points are left unsolved.
  void solve_all(Call& call, std::size_t largest = 0) {
    Runtime& runtime = call.runtime;
    call.work.bounds = {HULL_DEPTH_BOUND, ORIENT_BOUND, CIRCLE_BOUND};
    const std::size_t n = points.points();
    blocks.sets = sets();
    blocks.points = n;
    blocks.count = points.count();
    blocks.set_blocks = set_blocks;
    if (largest == 0) blocks.offsets = points.offsets;
    blocks.largest = largest;
    blocks.device_set_blocks = upload(runtime, set_blocks);
    blocks.device_offsets = upload(runtime, points.offsets);
    blocks.vertices = upload(runtime, points.vertices);
    blocks.source = upload(runtime, points.sources());
    std::vector<cl_int> own(n);
    std::iota(own.begin(), own.end(), 0);
    rings = solve(call.work, blocks, upload(runtime, own));
    vertices = download(runtime, blocks.vertices, n);
    edges = call.read(rings.edges, kernel::EDGES_PER_VERTEX * n);
    vertex_edge = call.read(rings.vertex_edge, n);
    distinct = call.read(rings.device_distinct, points.count());
    solved = call.read(rings.solved, points.count());
  }
  std::size_t size_of_set(std::size_t s) const {
    return static_cast<std::size_t>(set_blocks[s + 1] - set_blocks[s]);
  }
  bool is_used(std::size_t e) const { return edges[e].to >= 0; }
  std::size_t next_around_face(std::size_t e) const {
    return static_cast<std::size_t>(edges[e ^ 1].previous);
  }
  std::size_t origin(std::size_t e) const { return static_cast<std::size_t>(edges[e ^ 1].to); }
  /// The edges of the face left of an edge.
  std::vector<std::size_t> face(std::size_t e) const {
    std::vector<std::size_t> around{e};
    while (next_around_face(around.back()) != e) around.push_back(next_around_face(around.back()));
    return around;
  }
  /// Twice the area of a polygon of small integers.
  double doubled_area(const std::vector<std::size_t>& around) const {
    double sum = 0;
    for (const std::size_t e : around) {
      const cl_double2 p = vertices[origin(e)], q = vertices[static_cast<std::size_t>(edges[e].to)];
      sum += p.s[0] * q.s[1] - p.s[1] * q.s[0];
    }
    return sum;
  }
  /// Whether the outside lies left of an edge.
  bool is_outside(std::size_t e) const { return doubled_area(face(e)) <= 0; }
};

/// Blocks of many kinds in sets of none, one and several.
SolvedSets sets_of_blocks(std::size_t most, std::uint64_t seed) {
  FixtureRandom random(seed);
  SolvedSets all;
  for (int s = 0; s < 12; ++s) {
    for (std::int64_t b = random.integer(0, 4); b > 0; --b) {
      const std::int64_t kind = random.integer(0, 5);
      const auto n = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(most)));
      if (kind == 0) all.points.add(distinct_places(n, 1, 60, random));
      if (kind == 1) all.points.add(distinct_places(3, 9, 9, random));
      if (kind == 2) all.points.add(Coordinates(2 * static_cast<std::size_t>(random.integer(0, 1)), 4));
      if (kind == 3) all.points.add({0, 0, 60, 0, 0, 60, 7, 9, 9, 7, 20, 0, 13, 14});
      if (kind > 3) all.points.add(distinct_places(n, 30, 30, random));
    }
    all.end_set();
  }
  return all;
}

// ---------------------------------------------------------------------------------------------------------------------
// frame_blocks

/// The edges of a hull of three edges, from the outside; otherwise none.
std::set<cl_int> outside_twin(const SolvedSets& all, std::size_t b) {
  std::set<cl_int> outside;
  double area = 0;
  for (std::size_t e = kernel::EDGES_PER_VERTEX * all.points.first(b);
       e < kernel::EDGES_PER_VERTEX * all.points.first(b + 1); ++e) {
    if (!all.is_used(e) || !all.is_outside(e)) continue;
    outside.insert(static_cast<cl_int>(e));
    area = all.doubled_area(all.face(e));
  }
  return outside.size() == 3 && area < 0 ? outside : std::set<cl_int>{testing::kNone};
}

/// Of a leaf of a set's tree, from the root down.
kernel::vertex_box rectangle_twin(const std::vector<std::pair<int, cl_double2>>& cuts, std::size_t leaves,
                                  std::size_t leaf, double scale) {
  kernel::vertex_box r{{-kInfinite, -kInfinite}, {kInfinite, kInfinite}};
  std::size_t node = 1, begin = 0;
  for (std::size_t size = leaves; size > 1; size /= 2) {
    const auto& [axis, pivot] = cuts[node];
    const bool is_high = leaf >= begin + size / 2;
    double& side = is_high ? (axis ? r.low.y : r.low.x) : (axis ? r.high.y : r.high.x);
    const double at = pivot.s[axis] * scale;
    side = is_high ? std::max(side, at) : std::min(side, at);
    if (is_high) begin += size / 2;
    node = 2 * node + is_high;
  }
  return r;
}

void check_frames(Runtime& runtime, bool is_merged, std::uint64_t seed) {
  Call call(runtime);
  FixtureRandom random(seed);
  SolvedSets all;
  std::vector<cl_int> set_nodes, set_boxes, vertices;
  std::vector<std::vector<std::pair<int, cl_double2>>> cuts;
  std::vector<kernel::cut_node> nodes;
  std::vector<kernel::vertex_box> boxes;
  for (const std::size_t leaves : {1, 1, 1, 4, 16, 2, 1, 8, 1}) {
    for (std::size_t b = 0; b < leaves; ++b) {
      const std::int64_t kind = random.integer(0, 3);
      if (kind == 0) all.points.add({0, 0, 30, 0, 0, 30, 10, 10, 9, 3});
      if (kind == 1)
        all.points.add(distinct_places(static_cast<std::size_t>(random.integer(0, 4)), 5, 5, random));
      if (kind == 2) all.points.add({1, 2});
      if (kind == 3) all.points.add(distinct_places(30, 9, 9, random));
    }
    all.end_set();
    set_nodes.push_back(static_cast<cl_int>(nodes.size()));
    cuts.emplace_back();
    for (std::size_t node = 0; node < leaves && leaves > 1; ++node) {
      const auto axis = static_cast<int>(random.integer(0, 1));
      const cl_double2 pivot{{static_cast<double>(random.integer(-9, 9)), random.unit() - 0.5}};
      cuts.back().emplace_back(axis, pivot);
      nodes.push_back(kernel::node_of(axis, {pivot.s[0], pivot.s[1]}));
    }
    set_boxes.push_back(static_cast<cl_int>(boxes.size() + 1));
    for (int k = 0; k < 2; ++k) boxes.push_back({{random.unit(), random.unit()}, {1 + random.unit(), 2}});
  }
  all.solve_all(call);
  const std::size_t n = all.points.points();
  for (std::size_t i = 0; i < n; ++i) vertices.push_back(static_cast<cl_int>(n - 1 - i));
  const auto frames = guarded<kernel::block_frame>(runtime, all.points.count());
  const auto hull_next = upload(runtime, std::vector<cl_int>(n, -7));
  runtime.map(all.points.count(),
              kernels::frame_blocks{.cut_sets = {.sets = all.sets(),
                                                 .set_blocks = all.blocks.device_set_blocks,
                                                 .set_nodes = upload(runtime, set_nodes),
                                                 .nodes = upload(runtime, nodes)},
                                    .is_merged = is_merged,
                                    .scale = kernel::scaling{0.5, 8, 1},
                                    .solved = all.rings.solved,
                                    .set_boxes = upload(runtime, set_boxes),
                                    .boxes = upload(runtime, boxes),
                                    .edges = all.rings.edges,
                                    .vertex_edge = all.rings.vertex_edge,
                                    .vertices = upload(runtime, vertices),
                                    .hull_next = hull_next,
                                    .frames = frames});
  const auto found = download(runtime, frames, all.points.count());
  std::vector<cl_int> expected_next(n, -7);
  for (std::size_t s = 0; s < all.sets(); ++s) {
    const auto first = static_cast<std::size_t>(all.set_blocks[s]);
    for (std::size_t b = first; b < static_cast<std::size_t>(all.set_blocks[s + 1]); ++b) {
      SCOPED_TRACE("block " + std::to_string(b) + " of set " + std::to_string(s));
      const std::size_t leaves = is_merged ? 1 : all.size_of_set(s);
      const kernel::vertex_box r = rectangle_twin(cuts[s], leaves, b - first, 4);
      EXPECT_EQ(found[b].rectangle.low.x, r.low.x);
      EXPECT_EQ(found[b].rectangle.low.y, r.low.y);
      EXPECT_EQ(found[b].rectangle.high.x, r.high.x);
      EXPECT_EQ(found[b].rectangle.high.y, r.high.y);
      EXPECT_EQ(found[b].all.low.x, boxes[static_cast<std::size_t>(set_boxes[s])].low.x);
      EXPECT_EQ(found[b].all.high.x, boxes[static_cast<std::size_t>(set_boxes[s])].high.x);
      // When blocks are merged, the set's triangulation is the first one's.
      const std::size_t whole = is_merged ? first : b;
      const std::set<cl_int> outside(found[b].outside, found[b].outside + 3);
      EXPECT_EQ(outside, outside_twin(all, whole));
      if (leaves == 1 && all.distinct[whole] == 1) {
        cl_int& next = expected_next[n - 1 - all.points.first(whole)];
        next = static_cast<cl_int>(n - 1 - all.points.first(whole));
      }
    }
  }
  EXPECT_TRUE(same(download(runtime, hull_next, n), expected_next));
}

TEST(SmallRoundsKernels, FramesOfBlocks) {
  with_round_runtimes([](Runtime& runtime) {
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
      check_frames(runtime, false, seed);
      check_frames(runtime, true, seed);
    }
  });
}

// ---------------------------------------------------------------------------------------------------------------------
// count_open and write_open

/// An open edge without its corner: the other vertex, and whether the open side begins at it.
using OpenEdge = std::tuple<cl_int, cl_int, cl_int>;
OpenEdge numbers_of(const kernel::open_edge& edge) { return {edge.to, edge.corner, edge.begins}; }

/// Triangulations of which some faces were emitted in rounds before, and others now. A face is a triangle, or
/// the outside of an edge of the hull.
struct HalfEmitted {
  const SolvedSets& all;
  std::vector<cl_int> name;     // by vertex
  std::vector<std::size_t> of;  // by edge: the face on its left
  std::vector<std::vector<std::size_t>> edges_of;
  std::vector<bool> is_ghost;
  std::vector<int> when;  // by face: 0 not yet, 1 before, 2 now

  HalfEmitted(const SolvedSets& solved, bool is_first, FixtureRandom& random)
      : all(solved), name(solved.points.points()), of(solved.edges.size(), 0) {
    std::iota(name.begin(), name.end(), 100);
    random.shuffle(name);
    for (std::size_t e = 0; e < of.size(); ++e) {
      if (!all.is_used(e)) continue;
      const std::vector<std::size_t> around = all.face(e);
      const bool is_outside = all.doubled_area(around) <= 0;
      if (!is_outside && *std::min_element(around.begin(), around.end()) < e) continue;
      edges_of.push_back(is_outside ? std::vector<std::size_t>{e} : around);
      is_ghost.push_back(is_outside);
      // Nothing is known of points on one line.
      const bool is_line = is_outside && all.doubled_area(around) == 0;
      when.push_back(is_line ? 0 : static_cast<int>(random.integer(0, 2)));
      if (is_first && when.back() == 1) when.back() = 2;
      for (const std::size_t edge : edges_of.back()) of[edge] = edges_of.size() - 1;
    }
    // A vertex around which all was emitted would have been done.
    for (std::size_t v = 0; v < name.size(); ++v) {
      const std::vector<std::size_t> around = faces_at(v);
      const bool is_done = !around.empty() && std::all_of(around.begin(), around.end(),
                                                          [&](std::size_t f) { return when[f] == 1; });
      if (is_done) when[around[0]] = 0;
    }
  }

  std::vector<std::size_t> ring(std::size_t v) const {
    std::vector<std::size_t> ring;
    if (all.vertex_edge[v] < 0) return ring;
    const auto start = static_cast<std::size_t>(all.vertex_edge[v]);
    for (std::size_t e = start; ring.empty() || e != start; e = static_cast<std::size_t>(all.edges[e].next)) {
      ring.push_back(e);
    }
    return ring;
  }
  /// The ghost behind another one: that of the edge of the hull that ends where this one begins.
  std::size_t ghost_behind(std::size_t e) const {
    return of[static_cast<std::size_t>(all.edges[e].next) ^ 1];
  }
  std::vector<std::size_t> faces_at(std::size_t v) const {
    std::vector<std::size_t> faces;
    for (const std::size_t e : ring(v)) {
      faces.push_back(of[e]);
      if (is_ghost[of[e]]) faces.push_back(ghost_behind(e));
    }
    return faces;
  }
  /// The corner opposite to an edge in the face on its left.
  cl_int corner(std::size_t e) const {
    return is_ghost[of[e]] ? kernel::GHOST : static_cast<cl_int>(3 * e + 1);
  }
  cl_int state(std::size_t e) const {
    if (!all.is_used(e)) return kernel::OPEN;
    if (when[of[e]] == 2) return corner(e);
    return is_ghost[of[e]] ? kernel::OPEN_GHOST : kernel::OPEN;
  }
  /// The borders, at a vertex, of the faces that were emitted before, or until now.
  std::vector<OpenEdge> open_edges(std::size_t v, bool until_now) const {
    std::vector<OpenEdge> open;
    const auto is_emitted = [&](std::size_t f) { return when[f] == 1 || (until_now && when[f] == 2); };
    for (const std::size_t e : ring(v)) {
      const std::size_t left = of[e], right = of[e ^ 1];
      const cl_int to = name[static_cast<std::size_t>(all.edges[e].to)];
      if (is_emitted(right) && !is_emitted(left)) open.emplace_back(to, corner(e ^ 1), 1);
      if (is_emitted(left) && !is_emitted(right)) open.emplace_back(to, corner(e), 0);
      if (!is_ghost[left]) continue;
      const std::size_t behind = ghost_behind(e);
      if (is_emitted(left) != is_emitted(behind)) open.emplace_back(-1, kernel::GHOST, is_emitted(left));
    }
    return open;
  }
  bool is_any_emitted(std::size_t v) const {
    const std::vector<std::size_t> faces = faces_at(v);
    return std::any_of(faces.begin(), faces.end(), [&](std::size_t f) { return when[f] != 0; });
  }
};

struct MetOpen {
  std::size_t done = 0, rays = 0, closed = 0, unsolved = 0, edges = 0;
};

void check_open(Runtime& runtime, SolvedSets all, bool is_first, std::size_t largest, std::uint64_t seed,
                MetOpen& met) {
  Call call(runtime);
  FixtureRandom random(seed);
  all.solve_all(call, largest);
  const std::size_t n = all.points.points();
  const HalfEmitted half(all, is_first, random);
  // The list that the blocks were made from has the points in another order.
  std::vector<cl_int> listed(n), open_offsets{0}, states;
  std::iota(listed.begin(), listed.end(), 0);
  random.shuffle(listed);
  std::vector<std::size_t> place_of(n);
  for (std::size_t v = 0; v < n; ++v) place_of[static_cast<std::size_t>(listed[v])] = v;
  std::vector<kernel::open_edge> before;
  // Vertices of blocks that are left unsolved have open edges of any kind, or none.
  std::map<std::size_t, std::vector<OpenEdge>> kept;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t v = place_of[k];
    std::vector<OpenEdge> open = half.open_edges(v, false);
    if (all.vertex_edge[v] < 0 && !is_first && random.integer(0, 1) == 1) {
      open = {{7, 8, 1}, {9, 2, 0}};
      kept[v] = open;
    }
    random.shuffle(open);
    for (const auto& [to, corner, begins] : open) before.push_back({to, corner, begins});
    open_offsets.push_back(static_cast<cl_int>(before.size()));
  }
  for (std::size_t e = 0; e < all.edges.size(); ++e) states.push_back(half.state(e));
  const auto device_listed = upload(runtime, listed), device_offsets = upload(runtime, open_offsets);
  const auto device_before = upload(runtime, before);
  const auto device_states = upload(runtime, states);
  const auto device_names = upload(runtime, half.name);
  const auto counts = guarded<cl_uint2>(runtime, n);
  runtime.map(n, kernels::count_open{.open_vertices = {.is_first = is_first,
                                                       .vertices = device_names,
                                                       .listed = device_listed,
                                                       .open_offsets = device_offsets,
                                                       .open_edges = device_before},
                                     .sets = all.sets(),
                                     .blocks = all.points.count(),
                                     .set_blocks = all.blocks.device_set_blocks,
                                     .offsets = all.blocks.device_offsets,
                                     .distinct = all.rings.device_distinct,
                                     .edges = all.rings.edges,
                                     .vertex_edge = all.rings.vertex_edge,
                                     .states = device_states,
                                     .counts = counts});
  const std::vector<cl_uint2> counted = download(runtime, counts, n);
  // The twin.
  std::vector<std::size_t> goes_on;
  std::vector<std::vector<OpenEdge>> open_after;
  std::vector<cl_uint2> scanned{{{0, 0}}};
  for (std::size_t s = 0; s < all.sets(); ++s) {
    for (auto b = static_cast<std::size_t>(all.set_blocks[s]);
         b < static_cast<std::size_t>(all.set_blocks[s + 1]); ++b) {
      for (std::size_t v = all.points.first(b); v < all.points.first(b + 1); ++v) {
        const bool is_vertex =
            !is_first || v < all.points.first(b) + static_cast<std::size_t>(all.distinct[b]);
        std::vector<OpenEdge> open = half.open_edges(v, true);
        if (kept.count(v) != 0) open = kept[v];
        cl_uint2 expected{{0, 0}};
        if (is_vertex && all.size_of_set(s) > 1 && (!open.empty() || !half.is_any_emitted(v))) {
          expected = {{1, static_cast<cl_uint>(open.size())}};
          goes_on.push_back(v);
          open_after.push_back(open);
        } else {
          ++met.done;
        }
        met.unsolved += all.points.size(b) > 0 && all.distinct[b] == 0;
        met.closed += half.open_edges(v, false).size() > open.size();
        ASSERT_EQ(counted[v].s[0], expected.s[0]) << "vertex " << v;
        ASSERT_EQ(counted[v].s[1], expected.s[1]) << "vertex " << v;
        const cl_uint2 last = scanned.back();
        scanned.push_back({{last.s[0] + expected.s[0], last.s[1] + expected.s[1]}});
      }
    }
  }
  const std::size_t points = scanned.back().s[0], edges = scanned.back().s[1];
  const auto next_points = guarded<cl_double2>(runtime, points);
  const auto next_vertices = guarded<cl_int>(runtime, points),
             next_offsets = guarded<cl_int>(runtime, points + 1);
  const auto next_edges = guarded<kernel::open_edge>(runtime, edges);
  runtime.map(n, kernels::write_open{.open_vertices = {.is_first = is_first,
                                                       .vertices = device_names,
                                                       .listed = device_listed,
                                                       .open_offsets = device_offsets,
                                                       .open_edges = device_before},
                                     .points = all.blocks.vertices,
                                     .edges = all.rings.edges,
                                     .vertex_edge = all.rings.vertex_edge,
                                     .states = device_states,
                                     .scanned = upload(runtime, scanned),
                                     .next_points = next_points,
                                     .next_vertices = next_vertices,
                                     .next_offsets = next_offsets,
                                     .next_edges = next_edges});
  const auto found_points = download(runtime, next_points, points);
  const auto found_vertices = download(runtime, next_vertices, points);
  const auto found_offsets = download(runtime, next_offsets, points + 1);
  const auto found_edges = download(runtime, next_edges, edges);
  for (std::size_t k = 0; k < points; ++k) {
    const std::size_t v = goes_on[k];
    ASSERT_EQ(found_points[k].s[0], all.vertices[v].s[0]);
    ASSERT_EQ(found_points[k].s[1], all.vertices[v].s[1]);
    ASSERT_EQ(found_vertices[k], half.name[v]);
    ASSERT_EQ(static_cast<std::size_t>(found_offsets[k + 1] - found_offsets[k]), open_after[k].size());
    std::multiset<OpenEdge> expected(open_after[k].begin(), open_after[k].end()), found;
    for (cl_int e = found_offsets[k]; e < found_offsets[k + 1]; ++e) {
      found.insert(numbers_of(found_edges[static_cast<std::size_t>(e)]));
    }
    ASSERT_EQ(found, expected) << "vertex " << v;
    met.edges += found.size();
    for (const OpenEdge& edge : found) met.rays += std::get<0>(edge) == -1;
  }
  if (points == 0) return;
  ASSERT_EQ(found_offsets[0], 0);
}

TEST(SmallRoundsKernels, WhatGoesOn) {
  with_round_runtimes([](Runtime& runtime) {
    MetOpen met;
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      check_open(runtime, sets_of_blocks(40, seed), true, 0, seed, met);
      check_open(runtime, sets_of_blocks(40, seed), false, 0, seed, met);
      // Solved one by one, all blocks are.
      if (!testing::tests_native()) check_open(runtime, sets_of_blocks(40, seed), false, 20, seed, met);
      if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(met.done, 50u);
    EXPECT_GT(met.closed, 20u);
    EXPECT_GT(met.rays, 50u);
    EXPECT_GT(met.edges, 1000u);
    if (!testing::tests_native()) {
      EXPECT_GT(met.unsolved, 50u);
    }
  });
}

/// In the first round, places of duplicates are no vertices.
TEST(SmallRoundsKernels, DuplicatesDoNotGoOn) {
  with_round_runtimes([](Runtime& runtime) {
    MetOpen met;
    FixtureRandom random(7);
    SolvedSets all;
    for (int s = 0; s < 4; ++s) {
      for (int b = 0; b <= s; ++b) all.points.add(coarse(static_cast<std::size_t>(30 * s), 5, 6, random));
      all.end_set();
    }
    check_open(runtime, all, true, 0, 8, met);
    EXPECT_GT(met.done, 100u);
  });
}

// ---------------------------------------------------------------------------------------------------------------------
// write_rows

/// n vertices, with triangles in some of their places; links between corners at random.
void check_rows(Runtime& runtime, std::size_t n, std::int64_t empty, bool with_neighbors, bool with_halfedges,
                std::uint64_t seed) {
  const Arena::Scope scope(runtime.arena());
  FixtureRandom random(seed);
  std::vector<cl_int> places(6 * n, -1), links(6 * n, -1), triangles;
  std::vector<cl_uint> row_of{0};
  std::vector<std::size_t> corners;
  for (std::size_t p = 0; p < 2 * n; ++p) {
    const bool is_there = random.integer(0, 9) >= empty;
    for (std::size_t k = 0; k < 3 && is_there; ++k) {
      places[3 * p + k] = static_cast<cl_int>(random.integer(0, 1000));
      triangles.push_back(places[3 * p + k]);
      corners.push_back(3 * p + k);
    }
    row_of.push_back(row_of.back() + is_there);
  }
  random.shuffle(corners);
  for (std::size_t k = 0; k + 2 < corners.size(); k += 2) {
    links[corners[k]] = static_cast<cl_int>(corners[k + 1]);
    links[corners[k + 1]] = static_cast<cl_int>(corners[k]);
  }
  const std::size_t rows = triangles.size();
  std::vector<cl_int> neighbors(rows, -1), halfedges(rows, -1);
  for (const std::size_t corner : corners) {
    if (links[corner] < 0) continue;
    const std::size_t row = row_of[corner / 3], k = corner % 3;
    const auto link = static_cast<std::size_t>(links[corner]);
    const std::size_t other = row_of[link / 3];
    neighbors[3 * row + k] = static_cast<cl_int>(other);
    // The halfedge that is opposite to corner k starts at the next corner.
    halfedges[3 * row + (k + 1) % 3] = static_cast<cl_int>(3 * other + (link % 3 + 1) % 3);
  }
  const auto room = [&](bool is_wanted) { return guarded<cl_int>(runtime, is_wanted ? rows : 1); };
  const auto found = room(true), found_neighbors = room(with_neighbors),
             found_halfedges = room(with_halfedges);
  runtime.map(2 * n, kernels::write_rows{.with_neighbors = with_neighbors,
                                         .with_halfedges = with_halfedges,
                                         .places = upload(runtime, places),
                                         .links = upload(runtime, links),
                                         .scanned = upload(runtime, row_of),
                                         .triangles = found,
                                         .neighbors = found_neighbors,
                                         .halfedges = found_halfedges});
  EXPECT_TRUE(same(download(runtime, found, rows), triangles));
  if (with_neighbors) {
    EXPECT_TRUE(same(download(runtime, found_neighbors, rows), neighbors));
  }
  if (with_halfedges) {
    EXPECT_TRUE(same(download(runtime, found_halfedges, rows), halfedges));
  }
}

TEST(SmallRoundsKernels, RowsWithoutGaps) {
  with_round_runtimes([](Runtime& runtime) {
    for (const std::size_t n : {1, 2, 33, 200}) {
      for (const std::int64_t empty : {0, 2, 9, 10}) {
        for (const int parts : {0, 1, 2, 3}) {
          check_rows(runtime, n, empty, (parts & 1) != 0, (parts & 2) != 0,
                     n + static_cast<std::size_t>(empty));
        }
      }
    }
  });
}

// ---------------------------------------------------------------------------------------------------------------------
// list_hull

/// Convex polygons, chains of points on one line, and single vertices; other vertices are inside of hulls.
struct Hulls {
  std::vector<cl_double2> points;
  std::vector<cl_int> next, previous;
  std::vector<std::vector<std::size_t>> orders;  // each from its first vertex on

  void add_vertex(double x, double y) {
    points.push_back({{x, y}});
    next.push_back(-1);
    previous.push_back(-1);
  }
  /// These vertices in this order; closed: the first follows the last.
  void add_hull(const std::vector<std::size_t>& order, bool is_closed) {
    for (std::size_t k = 0; k + (is_closed ? 0 : 1) < order.size(); ++k) {
      const std::size_t v = order[k], w = order[(k + 1) % order.size()];
      next[v] = static_cast<cl_int>(w);
      previous[w] = static_cast<cl_int>(v);
    }
    orders.push_back(order);
  }
};

Hulls hulls_of_all_kinds(std::uint64_t seed) {
  FixtureRandom random(seed);
  Hulls all;
  for (const std::size_t size : {1, 3, 2, 4, 1, 7, 40, 3, 100}) {
    const std::size_t begin = all.points.size();
    // On a parabola, upwards, its points in order of x are the hull, counter-clockwise from the first one.
    const bool is_line = size < 3 || random.integer(0, 2) == 0;
    std::vector<std::size_t> numbers(size + static_cast<std::size_t>(random.integer(0, 9)));
    std::iota(numbers.begin(), numbers.end(), begin);
    random.shuffle(numbers);
    for (std::size_t k = 0; k < numbers.size(); ++k) all.add_vertex(3, 5);
    numbers.resize(size);
    for (std::size_t k = 0; k < size; ++k) {
      const auto x = static_cast<double>(k);
      // Of a vertical line, the lower point comes first.
      all.points[numbers[k]] = is_line ? cl_double2{{0.5, x}} : cl_double2{{x, x * x}};
    }
    // The hull of a single vertex: it is followed by itself, but by nothing before.
    all.add_hull(numbers, !is_line);
    if (size == 1) all.next[numbers[0]] = static_cast<cl_int>(numbers[0]);
  }
  return all;
}

TEST(SmallRoundsKernels, VerticesOfHulls) {
  with_round_runtimes([](Runtime& runtime) {
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Arena::Scope scope(runtime.arena());
      const Hulls all = hulls_of_all_kinds(seed);
      const std::size_t n = all.points.size();
      const auto next = upload(runtime, all.next), previous = upload(runtime, all.previous);
      const auto counts = guarded<cl_uint>(runtime, n);
      runtime.map(n, kernels::count_hull{.hull_next = next, .hull_previous = previous, .counts = counts});
      std::vector<cl_uint> flags(n, 0), place{0};
      for (const auto& order : all.orders) {
        for (const std::size_t v : order) flags[v] = 1;
      }
      EXPECT_TRUE(same(download(runtime, counts, n), flags));
      std::vector<cl_int> vertices;
      for (std::size_t v = 0; v < n; ++v) {
        place.push_back(place.back() + flags[v]);
        if (flags[v] != 0) vertices.push_back(static_cast<cl_int>(v));
      }
      const auto hull_vertices = guarded<cl_int>(runtime, vertices.size());
      const auto ahead = guarded<cl_int2>(runtime, vertices.size());
      runtime.map(n, kernels::list_hull{.points = upload(runtime, all.points),
                                        .hull_next = next,
                                        .hull_previous = previous,
                                        .scanned = upload(runtime, place),
                                        .hull_vertices = hull_vertices,
                                        .ahead = ahead});
      EXPECT_TRUE(same(download(runtime, hull_vertices, vertices.size()), vertices));
      const auto found = download(runtime, ahead, vertices.size());
      for (const auto& order : all.orders) {
        for (std::size_t k = 0; k < order.size(); ++k) {
          const bool is_last = k + 1 == order.size();
          const cl_int2 at = found[place[order[k]]];
          EXPECT_EQ(at.s[0], static_cast<cl_int>(place[order[is_last ? k : k + 1]]));
          EXPECT_EQ(at.s[1], is_last ? 0 : 1);
        }
      }
    }
  });
}

}  // namespace
}  // namespace flaunay::blocks
