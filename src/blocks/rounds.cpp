#include "blocks/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/open_sectors.h"
#include "blocks/parts.hpp"
#include "geometry/euler.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/blocks/rounds.cl.hpp"
#include "points/device_mesh.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

// A planar graph has less than 3 edges per vertex. Each edge is open at both ends, and a vertex of the hull
// has a ray to infinity.
constexpr std::size_t kMostOpenEdges = 7;

// The arrays into which all rounds emit.
struct Emitted {
  Buffer<cl_double2> points{};   // the vertices, as the first round numbers them
  Buffer<cl_int> indices{};      // in the input
  Buffer<cl_int> places{};       // 3 per place of a triangle, 2 places per vertex; -1 first in empty places
  Buffer<cl_int> links{};        // the same for their neighbours; null if these are not wanted
  Buffer<cl_int2> hull_links{};  // the next and the previous vertex of the hull
};

// The boxes around the sets' points, found in the first round: later rounds have fewer points. Nothing if
// each set is one block.
struct SetBoxes {
  Buffer<kernel::vertex_box> boxes{};
  Buffer<cl_int> places{};  // by set
};

// Numbers that the host reads together with a wait: the sizes of results, and as begin_round copies them, the
// account of triangulations, and how many vertices each block of the first round has.
struct Numbers {
  std::size_t sizes = 0;  // how many
  std::vector<cl_int> values{};
  Buffer<cl_int> on_device{};

  void allocate(Arena& persistent, const Blocks& blocks) {
    sizes = 2 * (blocks.sets + 1);
    values.resize(sizes + kernel::RINGS_NUMBERS + blocks.count);
    on_device = persistent.allocate<cl_int>(values.size());
  }
  void read_account_later(host::Runtime& runtime) {
    runtime.read_later(on_device, sizes, kernel::RINGS_NUMBERS, values.data() + sizes);
  }
  void read(host::Runtime& runtime) { runtime.read(on_device, 0, values.size(), values.data()); }
  const cl_uint* account() const { return reinterpret_cast<const cl_uint*>(values.data() + sizes); }
  // Must be called after that wait, before anything relies on the triangulations.
  void check() const { check_account(account()); }
  std::size_t undecided() const { return account()[kernel::RINGS_UNDECIDED]; }
  // The number of vertices of the blocks [first, last).
  std::size_t vertices(cl_int first, cl_int last) const {
    const auto distinct = values.begin() + static_cast<std::ptrdiff_t>(sizes + kernel::RINGS_NUMBERS);
    return std::accumulate(distinct + first, distinct + last, std::size_t{0});
  }
};

// The points that go on to a round, and their open edges.
struct OpenPoints {
  std::size_t most;                    // that can be in any round but the first
  std::vector<std::size_t> offsets{};  // by set
  Buffer<cl_double2> points{};
  Buffer<cl_int> vertices{};
  Buffer<cl_int> offsets_of_edges{};
  Buffer<kernel::open_edge> edges{};

  std::size_t count() const { return offsets.back(); }
  // Makes room where there is not enough. The memory is kept: rounds use two lists in turn.
  void reserve(Arena& persistent, std::size_t point_count, std::size_t edge_count) {
    if (points.size() < point_count) {
      points = persistent.allocate<cl_double2>(point_count);
      vertices = persistent.allocate<cl_int>(point_count);
      offsets_of_edges = persistent.allocate<cl_int>(point_count + 1);
    }
    if (edges.size() < edge_count) edges = persistent.allocate<kernel::open_edge>(edge_count);
  }
};

// One round: its blocks, their triangulations, and the states of their edges.
struct Round {
  bool is_first;
  bool is_merged;          // up the tree
  const OpenPoints& open;  // the list from which its points are made; in the first round, the offsets alone
  const Blocks& blocks;
  PartsOfBlocks parts{};
  Rings rings{};
  Buffer<cl_int> vertices{};  // by place in the blocks
  Buffer<cl_int> states{};    // by edge
  Buffer<cl_uchar> unsure{};  // by pair of edges; in the first round of one pair
  Buffer<cl_int> frame_offsets{};
  Buffer<kernel::block_frame> frames{};

  // Whether each set has one triangulation.
  bool is_last() const { return is_merged || blocks.count == blocks.sets; }
  // Whether every block is solved for certain: others are no larger than is guessed, as a rule.
  bool can_be_merged() const { return !blocks.offsets.empty(); }
  std::size_t frame_count() const { return blocks.count << parts.depth; }
};

// Whether the parts of blocks may stay apart. A set with one block needs no later round if that is whole,
// which must be so if there is none.
bool may_be_parts(const Workspace& work, const Round& round) {
  const std::vector<cl_int>& blocks = round.blocks.set_blocks;
  const std::vector<std::size_t>& points = round.open.offsets;
  std::size_t alone = 0;  // points of such sets whose block may have parts
  for (std::size_t s = 0; s < round.blocks.sets; ++s) {
    const std::size_t own = points[s + 1] - points[s];
    if (blocks[s + 1] - blocks[s] == 1 && own > tuning_of(work.runtime).local_vertices) alone += own;
  }
  return !round.is_merged && (alone == 0 || (!round.is_last() && 2 * alone <= points.back()));
}

kernels::places_of_parts places_of_parts(const Round& round) {
  return places_of_parts({.points = round.blocks.points, .offsets = round.blocks.device_offsets},
                         round.parts.halved, round.rings, round.parts.height);
}

kernels::frames frames_of(const Round& round) {
  return {.frame_count = round.frame_count(), .frame_offsets = round.frame_offsets, .frames = round.frames};
}

// Makes the triangulations of the blocks canonical; if blocks are merged, the triangulations of the sets.
void complete(Workspace& work, const Round& round) {
  if (round.is_merged) merge(work, round.blocks, round.rings);
  // Coarse coordinates have no ties: merges break them.
  if (!work.runtime.at_most(work.bounds.circle != 0.0, true)) return;
  (round.is_merged ? make_fans : make_fans_of_blocks)(work, round.blocks, round.rings);
}

SetBoxes boxes_of_sets(Workspace& work, const Round& round) {
  const Blocks& blocks = round.blocks;
  if (work.runtime.at_most(blocks.merges.empty() && round.parts.depth == 0, false)) return {};
  const SetBoxes found{work.persistent.allocate<kernel::vertex_box>(blocks.count), blocks.device_set_blocks};
  work.runtime.map(blocks.count, kernels::box_blocks{.places_of_parts = places_of_parts(round),
                                                     .depth = round.parts.depth,
                                                     .parts = round.parts.ends,
                                                     .solved = round.rings.solved,
                                                     .points = blocks.vertices,
                                                     .boxes = found.boxes});
  std::size_t most = 1;
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    most = std::max<std::size_t>(most, blocks.set_blocks[s + 1] - blocks.set_blocks[s]);
  }
  for (std::size_t step = 1; step < most; step *= kernel::JOINED_BOXES) {
    work.runtime.map(
        blocks.count,
        kernels::join_boxes{
            .sets = blocks.sets, .step = step, .set_blocks = blocks.device_set_blocks, .boxes = found.boxes});
  }
  return found;
}

// Where the nodes of each set's tree begin, if there are any.
std::vector<cl_int> first_nodes(const Blocks& blocks) {
  std::vector<cl_int> nodes;
  if (blocks.merges.empty()) return nodes;
  cl_int next = 0;
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    nodes.push_back(next);
    const cl_int leaves = blocks.set_blocks[s + 1] - blocks.set_blocks[s];
    if (leaves > 1) next += leaves;
  }
  return nodes;
}

// Names the vertices of a round, and finds where frames lie.
void begin_round(Workspace& work, const Round& round, const SetBoxes& boxes, const Emitted& emitted,
                 const Numbers& numbers) {
  const Blocks& blocks = round.blocks;
  Arena::Scope scope(work.scratch());
  const auto set_nodes = work.runtime.upload(work.scratch(), first_nodes(blocks));
  const std::size_t items =
      std::max({blocks.points, round.frame_count(), std::size_t{kernel::RINGS_NUMBERS}});
  work.runtime.map(items, kernels::begin_round{.places_of_parts = places_of_parts(round),
                                               .depth = round.parts.depth,
                                               .blocks = blocks.count,
                                               .cut_sets = {.sets = blocks.sets,
                                                            .set_blocks = blocks.device_set_blocks,
                                                            .set_nodes = set_nodes,
                                                            .nodes = blocks.device_nodes},
                                               .is_merged = round.is_merged,
                                               .scale = blocks.scale,
                                               .parts = round.parts.ends,
                                               .solved = round.rings.solved,
                                               .set_boxes = boxes.places,
                                               .boxes = boxes.boxes,
                                               .points = blocks.vertices,
                                               .edges = round.rings.edges,
                                               .vertex_edge = round.rings.vertex_edge,
                                               .is_first = round.is_first,
                                               .listed = blocks.source,
                                               .listed_vertices = round.open.vertices,
                                               .vertices = round.vertices,
                                               .emitted = emitted.places,
                                               .hull_links = emitted.hull_links.as<cl_int>(),
                                               .frame_offsets = round.frame_offsets,
                                               .frames = round.frames,
                                               .account = round.rings.device_account,
                                               .numbers = numbers.on_device});
}

kernels::open_vertices open_vertices(const Round& round) {
  return {.is_first = round.is_first,
          .vertices = round.vertices,
          .listed = round.blocks.source,
          .open_offsets = round.open.offsets_of_edges,
          .open_edges = round.open.edges};
}

// kernels::emit_triangles or kernels::emit_unsure.
template <typename Kernel>
void launch_emission(Workspace& work, const Round& round, const Emitted& emitted) {
  const Blocks& blocks = round.blocks;
  work.runtime.map(round.states.size() / 2, Kernel{.open_vertices = open_vertices(round),
                                                   .bound = work.bounds.orient,
                                                   .frames = frames_of(round),
                                                   .points = blocks.vertices,
                                                   .edges = round.rings.edges,
                                                   .all_points = emitted.points,
                                                   .indices = emitted.indices,
                                                   .places = emitted.places,
                                                   .states = round.states,
                                                   .hull_links = emitted.hull_links.as<cl_int>(),
                                                   .unsure = round.unsure});
}

// Allocates the arrays that describe a round's triangulations.
void allocate_states(Workspace& work, Round& round) {
  const Blocks& blocks = round.blocks;
  round.vertices = work.scratch().allocate<cl_int>(blocks.points);
  round.states = work.scratch().allocate<cl_int>(round.rings.edges.size());
  round.unsure = work.scratch().allocate<cl_uchar>(round.is_first ? 1 : round.states.size() / 2);
  const std::size_t frames =
      work.runtime.at_most(round.frame_count(), most_frames(work, blocks.count, blocks.points));
  round.frame_offsets = work.scratch().allocate<cl_int>(frames);
  round.frames = work.scratch().allocate<kernel::block_frame>(frames);
}

// Emits the final triangles of a round; of a round whose blocks are merged after all, a second time.
void emit(Workspace& work, const Round& round, const SetBoxes& boxes, const Emitted& emitted,
          const Numbers& numbers) {
  host::Runtime& runtime = work.runtime;
  begin_round(work, round, boxes, emitted, numbers);
  launch_emission<kernels::emit_triangles>(work, round, emitted);
  if (!round.is_first) launch_emission<kernels::emit_unsure>(work, round, emitted);
  if (emitted.links.memory() == nullptr) return;
  runtime.map(round.states.size() / 2, kernels::link_triangles{.open_vertices = open_vertices(round),
                                                               .edges = round.rings.edges,
                                                               .states = round.states,
                                                               .links = emitted.links});
}

// Whether so large a share of a round's points goes on that merging is less work. If all points went on,
// rounds would never end.
bool stalls(host::Runtime& runtime, const Round& round, const OpenPoints& next) {
  const std::size_t before = round.open.count();
  return 100 * next.count() > tuning_of(runtime).merge_from_percent * before || next.count() == before;
}

// Finds the points around which something is missing after a round. Waits once. Returns false, without the
// points, if the round's own blocks should be merged.
bool find_open(Workspace& work, Arena& persistent, const Round& round, const Numbers& numbers,
               OpenPoints& next) {
  host::Runtime& runtime = work.runtime;
  const Blocks& blocks = round.blocks;
  Arena::Scope scope(work.scratch());
  std::vector<cl_uint2> sizes(blocks.sets + 1);
  const host::Runtime::Settled settled(runtime);
  const auto counts = work.scratch().allocate<cl_uint2>(blocks.points + 1);
  runtime.map(blocks.points, kernels::count_open{.open_vertices = open_vertices(round),
                                                 .sets = blocks.sets,
                                                 .set_blocks = blocks.device_set_blocks,
                                                 .depth = round.parts.depth,
                                                 .frames = frames_of(round),
                                                 .edges = round.rings.edges,
                                                 .vertex_edge = round.rings.vertex_edge,
                                                 .states = round.states,
                                                 .counts = counts});
  host::exclusive_scan(runtime, counts, blocks.points, counts);
  if (blocks.sets == 1) {
    sizes[1] = runtime.read_one(counts, blocks.points);
  } else {
    const auto device_sizes = work.scratch().allocate<cl_uint2>(sizes.size());
    runtime.map(sizes.size(),
                kernels::measure_open{
                    .set_points = blocks.device_set_points, .scanned = counts, .sizes = device_sizes});
    runtime.read(device_sizes, 0, sizes.size(), sizes.data());
  }
  numbers.check();
  next.offsets.clear();
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    next.offsets.push_back(runtime.at_most<std::size_t>(sizes[s].s[0], round.open.offsets[s]));
  }
  if (next.count() == 0) return true;
  // When memory is counted, the round is assumed to go on.
  if (runtime.at_most(round.can_be_merged() && stalls(runtime, round, next), false)) return false;
  const std::size_t points = runtime.at_most(next.count(), next.most);
  next.reserve(
      persistent, points,
      std::max<std::size_t>(1, runtime.at_most(std::size_t{sizes.back().s[1]}, kMostOpenEdges * points)));
  runtime.map(blocks.points, kernels::write_open{.open_vertices = open_vertices(round),
                                                 .points = blocks.vertices,
                                                 .edges = round.rings.edges,
                                                 .vertex_edge = round.rings.vertex_edge,
                                                 .states = round.states,
                                                 .scanned = counts,
                                                 .next_points = next.points,
                                                 .next_vertices = next.vertices,
                                                 .next_offsets = next.offsets_of_edges,
                                                 .next_edges = next.edges});
  return true;
}

// Emits what is final of a round, and finds the points that go on, unless it is the last one. Returns false
// if its blocks should be merged instead.
bool finish(Workspace& work, Arena& persistent, Round& round, const SetBoxes& boxes, const Emitted& emitted,
            Numbers& numbers, OpenPoints& next) {
  Arena::Scope scope(work.scratch());
  allocate_states(work, round);
  emit(work, round, boxes, emitted, numbers);
  if (!round.is_last()) numbers.read_account_later(work.runtime);
  next.offsets.assign(round.blocks.sets + 1, 0);
  return round.is_last() || find_open(work, persistent, round, numbers, next);
}

// Makes rows and hulls from the emitted triangles.
class Results {
 public:
  // blocks: of the first round.
  Results(Workspace& work, const Emitted& emitted, const Blocks& blocks, Numbers& numbers)
      : work_(work),
        emitted_(emitted),
        sets_(blocks.sets),
        n_(blocks.points),
        set_blocks_(blocks.set_blocks),
        set_points_(blocks.device_set_points),
        numbers_(numbers) {
    scanned_ = work.scratch().allocate<cl_uint>(3 * n_ + 1);
  }

  // Whether a work-group scans the results alone. Then it takes longer to wait for their sizes than to
  // transfer some more.
  bool are_few() const {
    const host::Sizes& sizes = work_.runtime.sizes();
    return 3 * n_ <= sizes.scan_tiles_alone * group() * sizes.scan_items;
  }

  void count() {
    host::Runtime& runtime = work_.runtime;
    if (are_few()) {
      return runtime.launch(group(), group(), 3 * n_,
                            kernels::count_few_results{.vertices = n_,
                                                       .items = runtime.sizes().scan_items,
                                                       .places = emitted_.places,
                                                       .hull_links = emitted_.hull_links,
                                                       .sets = sets_,
                                                       .set_points = set_points_,
                                                       .scanned = scanned_,
                                                       .sizes = numbers_.on_device});
    }
    runtime.map(3 * n_, kernels::count_results{.vertices = n_,
                                               .places = emitted_.places,
                                               .hull_links = emitted_.hull_links,
                                               .counts = scanned_});
    host::exclusive_scan(runtime, scanned_, 3 * n_, scanned_);
    runtime.map(sets_ + 1, kernels::measure_sets{
                               .set_points = set_points_, .scanned = scanned_, .sizes = numbers_.on_device});
  }

  // Upper bounds.
  MeshSizes most() const { return {{0, kMostTrianglesPerPoint * n_}, {0, n_}}; }

  // Waits once, for all numbers.
  MeshSizes sizes() const {
    numbers_.read(work_.runtime);
    numbers_.check();
    MeshSizes sizes;
    const auto rows = numbers_.values.begin(), hulls = rows + static_cast<std::ptrdiff_t>(sets_ + 1);
    sizes.triangle_offsets.assign(rows, hulls);
    sizes.hull_offsets.assign(hulls, hulls + static_cast<std::ptrdiff_t>(sets_ + 1));
    for (std::size_t s = 0; s < sets_; ++s) {
      const std::size_t vertices = numbers_.vertices(set_blocks_[s], set_blocks_[s + 1]);
      geometry::check_euler(sizes.triangle_offsets[s + 1] - sizes.triangle_offsets[s],
                            sizes.hull_offsets[s + 1] - sizes.hull_offsets[s], vertices,
                            fmt::format(" in set {}", s));
      sizes.vertices += vertices;
    }
    return sizes;
  }

  void write(const MeshSizes& sizes, const DeviceMesh& mesh) {
    host::Runtime& runtime = work_.runtime;
    Arena::Scope scope(work_.scratch());
    const bool with_hull = mesh.hull.memory() != nullptr;
    const std::size_t count = with_hull ? runtime.at_most(sizes.hull_vertices(), n_) : 0;
    const HullLists lists{work_.scratch().allocate<cl_int>(count), work_.scratch().allocate<cl_int2>(count),
                          work_.scratch().allocate<cl_int2>(count)};
    runtime.map((with_hull ? 3 : 2) * n_,
                kernels::write_results{.vertices = n_,
                                       .with_triangles = mesh.triangles.memory() != nullptr,
                                       .with_neighbors = mesh.neighbors.memory() != nullptr,
                                       .with_halfedges = mesh.halfedges.memory() != nullptr,
                                       .places = emitted_.places,
                                       .links = emitted_.links,
                                       .scanned = scanned_,
                                       .triangles = mesh.triangles,
                                       .neighbors = mesh.neighbors,
                                       .halfedges = mesh.halfedges,
                                       .points = emitted_.points,
                                       .hull_links = emitted_.hull_links,
                                       .hull_vertices = lists.vertices,
                                       .ahead = lists.ahead});
    if (with_hull) write_hulls(sizes, lists, mesh.hull);
  }

 private:
  // The vertices of hulls, and where those ahead of them stand, in two arrays in turn.
  struct HullLists {
    Buffer<cl_int> vertices;
    Buffer<cl_int2> ahead, farther;
  };

  std::size_t group() const { return std::max<std::size_t>(1, work_.runtime.sizes().tile_group); }

  void write_hulls(const MeshSizes& sizes, HullLists lists, const Buffer<cl_int>& hull) {
    host::Runtime& runtime = work_.runtime;
    const std::size_t count = lists.vertices.size(), per_item = (count + group() - 1) / group();
    // More launches take no longer than more vertices per work-item.
    constexpr std::size_t kMostPerItem = 4;
    if (are_few() || per_item <= kMostPerItem) {
      if (!are_few()) runtime.note_elements(per_item);
      return runtime.launch(group(), group(),
                            kernels::order_hull{.sets = sets_,
                                                .sizes = numbers_.on_device,
                                                .hull_vertices = lists.vertices,
                                                .ahead = lists.ahead,
                                                .spare = lists.farther,
                                                .indices = emitted_.indices,
                                                .hull = hull});
    }
    std::size_t longest = 1;
    for (std::size_t s = 0; s < sets_; ++s) {
      longest = std::max(longest, sizes.hull_offsets[s + 1] - sizes.hull_offsets[s]);
    }
    for (std::size_t reach = 1; reach < longest; reach *= kernel::HULL_HOPS) {
      runtime.map(count, kernels::rank_hull{.from = lists.ahead, .to = lists.farther});
      std::swap(lists.ahead, lists.farther);
    }
    runtime.map(count, kernels::write_hull{.sets = sets_,
                                           .sizes = numbers_.on_device,
                                           .hull_vertices = lists.vertices,
                                           .ahead = lists.ahead,
                                           .indices = emitted_.indices,
                                           .hull = hull});
  }

  Workspace& work_;
  const Emitted& emitted_;
  std::size_t sets_, n_;
  const std::vector<cl_int>& set_blocks_;
  Buffer<cl_int> set_points_;
  Buffer<cl_uint> scanned_{};
  Numbers& numbers_;  // the sizes are where sets begin among rows, and among hull vertices
};

Emitted make_emitted(Workspace& work, const Blocks& blocks, bool with_links) {
  Emitted emitted;
  emitted.points = blocks.vertices;
  emitted.indices = blocks.source;
  Arena& arena = work.persistent;
  const std::size_t corners = 3 * kMostTrianglesPerPoint * blocks.points;
  emitted.places = arena.allocate<cl_int>(corners);
  if (with_links) emitted.links = arena.allocate<cl_int>(corners);
  emitted.hull_links = arena.allocate<cl_int2>(blocks.points);
  return emitted;
}

// Blocks of the points that go on. Only merges and blocks that are solved one by one need to know sizes.
Blocks blocks_of(Workspace& work, const OpenPoints& open, bool is_merged) {
  const Tuning& tuning = tuning_of(work.runtime);
  if (is_merged) {
    return make_blocks_of(work, open.points, open.offsets, tuning.block_points, Cuts::at_medians,
                          BlockSizes::read);
  }
  return make_blocks_of(work, open.points, open.offsets, tuning.round_points, Cuts::in_gaps,
                        tuning.blocks_in_parallel != 0 ? BlockSizes::guessed : BlockSizes::read);
}

}  // namespace

geometry::Fitted<Outcome> run_rounds(host::Runtime& runtime, Arena& persistent,
                                     const std::vector<std::size_t>& offsets, const Exchange& exchange,
                                     statistics::Phases& phases) {
  Workspace work{runtime, persistent};
  Numbers numbers;
  const host::Runtime::Settled settled(runtime);

  phases.progress("blocks", 0);
  const Buffer<cl_int>& representatives = exchange.representatives;
  const geometry::Fitted<Blocks> made = [&] {
    Arena::Scope points_scope(runtime.arena());
    return make_blocks(work, exchange.points(), offsets, representatives, exchange.host_points);
  }();
  if (!made) return made.too_wide();
  const Blocks& first_blocks = *made;
  phases.end("blocks");

  double done = kBlocksMade;
  phases.progress("triangulate", done);
  const Emitted emitted = make_emitted(work, first_blocks, exchange.wants_links);
  // Scratch memory of a round is released when it ends.
  Workspace rounds_work{runtime, runtime.arena(), work.bounds};
  SetBoxes boxes;
  // If more went on from the first round, its blocks would be merged.
  const std::size_t n = offsets.back();
  const std::size_t most = std::clamp<std::size_t>(tuning_of(runtime).merge_from_percent * n / 100, 1, n);
  // Of all rounds. Ties of one round only make later ones look for polygons, too.
  const auto account = make_account(work);
  numbers.allocate(persistent, first_blocks);
  OpenPoints lists[2] = {{.most = most, .offsets = offsets}, {.most = most}};
  Outcome outcome;
  bool is_merged = false;
  for (std::size_t r = 0; lists[r % 2].count() > 0; ++r) {
    const OpenPoints& open = lists[r % 2];
    OpenPoints& next = lists[(r + 1) % 2];
    Arena::Scope scope(work.scratch());
    std::optional<Blocks> later_blocks;
    if (r > 0) later_blocks = blocks_of(rounds_work, open, is_merged);
    const Blocks& blocks = r > 0 ? *later_blocks : first_blocks;
    Round round{r == 0, is_merged, open, blocks};
    round.rings = solve(rounds_work, blocks, representatives, account, nullptr,
                        may_be_parts(rounds_work, round) ? &round.parts : nullptr);
    complete(rounds_work, round);
    if (r == 0) {
      exchange.while_device_computes();
      boxes = boxes_of_sets(work, round);
    }
    if (!finish(rounds_work, persistent, round, boxes, emitted, numbers, next)) {
      round.is_merged = true;
      merge_parts(rounds_work, blocks, round.rings, round.parts);
      complete(rounds_work, round);
      finish(rounds_work, persistent, round, boxes, emitted, numbers, next);
    }
    ++outcome.rounds;
    outcome.round_points += open.count();
    if (round.is_merged) outcome.merged_points = open.count();
    is_merged = stalls(runtime, round, next);
    done = std::max(done, kBlocksMerged - (kBlocksMerged - kBlocksMade) * static_cast<double>(next.count()) /
                                              static_cast<double>(n));
    phases.progress("triangulate", done);
  }
  phases.end("triangulate");

  phases.progress("output", kBlocksMerged);
  Results results(work, emitted, first_blocks, numbers);
  results.count();
  if (results.are_few()) {
    const MeshSizes bounds = results.most();
    results.write(bounds, exchange.mesh(bounds));
    exchange.transfer();
  }
  outcome.sizes = results.sizes();
  outcome.undecided = numbers.undecided();
  phases.progress("output", kMeshCounted);
  if (!results.are_few()) results.write(outcome.sizes, exchange.mesh(outcome.sizes));
  return outcome;
}

}  // namespace flaunay::blocks
