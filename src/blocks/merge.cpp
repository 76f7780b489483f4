#include <algorithm>
#include <optional>

#include "blocks/halving.h"
#include "blocks/limits.h"
#include "blocks/parts.hpp"
#include "blocks/pipeline.hpp"
#include "blocks/records.h"
#include "launchers/blocks/local_parts.cl.hpp"
#include "launchers/blocks/local_parts_exact.cl.hpp"
#include "launchers/blocks/merge.cl.hpp"
#include "launchers/blocks/merge_exact.cl.hpp"
#include "launchers/blocks/seams.cl.hpp"
#include "launchers/blocks/stars.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "operations/limits.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

// Without undecided predicates, no merge stops.
bool may_stop(const Workspace& work) {
  return work.bounds.coarse == 0 && (work.bounds.orient != 0 || work.bounds.circle != 0);
}
// In fixed point, walks decide all predicates themselves (blocks/seams.cl).
bool walks_may_stop(const Workspace& work) {
  return !work.runtime.capabilities().fixed_point && may_stop(work);
}

// Of n vertices, some 4 sqrt(n) edges cross a seam, as a rule. A warp is there in any case.
std::size_t sewing_group_of(const Tuning& tuning, int height) {
  return std::min(tuning.sewing_group, std::max(tuning.block_group, std::size_t{4} << (height + 1) / 2));
}

// The lists of merges from both ends of their seam, and what their launches share.
struct Seams {
  Buffer<cl_int2> crossings{};
  Buffer<cl_int> removals{};
  Buffer<kernel::seam_walk> walks{};
  Buffer<cl_uchar> is_removed{};  // 0, all of them, between heights
};

// Two walks and the sewing are more work than one merge, but a shorter chain of steps, and lanes diverge
// less.
int first_height_of_seams(const Tuning& tuning) {
  int height = 1;
  while (least_vertices(height) < tuning.seam_points) ++height;
  return height;
}

// are_cleared: the marks, by the launch on local parts.
void make_lists(Workspace& work, const PointBlocks& blocks, int first_height, bool are_cleared,
                Seams& seams) {
  const std::size_t room = 2 * kernel::CROSSINGS_PER_VERTEX * blocks.points,
                    marks = 2 * kernel::PAIRS_PER_VERTEX * blocks.points;
  seams.crossings = work.scratch().allocate<cl_int2>(room);
  seams.removals = work.scratch().allocate<cl_int>(room);
  seams.walks = work.scratch().allocate<kernel::seam_walk>(2 * cells_of(blocks, first_height));
  seams.is_removed = work.scratch().allocate<cl_uchar>(marks);
  if (!are_cleared) work.runtime.fill<cl_uchar>(seams.is_removed, marks, 0);
}

// The data of merges of halves that all heights share.
struct Halves {
  Workspace& work;
  const PointBlocks& blocks;
  const HalvedBlocks& halved;
  const Rings& rings;
  Buffer<kernel::solved_block> parts{};
  Depths depths{};
  Buffer<cl_int> states{};
  Seams seams{};

  kernels::rings_of_parts rings_of_parts() const {
    return {.points = blocks.vertices,
            .edges = rings.edges,
            .vertex_edge = rings.vertex_edge,
            .parts = parts,
            .solved = rings.solved};
  }
};

// kernels::merge_parts or kernels::finish_parts.
template <typename Kernel>
void launch_on_parts(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, depths, states, seams] = halves;
  const std::size_t cells = cells_of(blocks, height);
  const std::size_t spread = spread_of_parts(tuning_of(work.runtime), blocks, height);
  launch_spread(work, spread, cells,
                Kernel{.spread = spread,
                       .places_of_parts = places_of_parts(blocks, halved, rings, height, depths),
                       .bounds = work.bounds,
                       .rings_of_parts = halves.rings_of_parts(),
                       .states = states,
                       .account = rings.device_account});
}

// kernels::walk_seams or kernels::finish_walks.
template <typename Kernel>
void launch_on_walks(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, depths, states, seams] = halves;
  const std::size_t walks = 2 * cells_of(blocks, height);
  const std::size_t spread = spread_of(tuning_of(work.runtime), walks);
  launch_spread(work, spread, walks,
                Kernel{.spread = spread,
                       .places_of_parts = places_of_parts(blocks, halved, rings, height, depths),
                       .bounds = work.bounds,
                       .rings_of_parts = halves.rings_of_parts(),
                       .crossings = seams.crossings,
                       .removals = seams.removals,
                       .is_removed = seams.is_removed,
                       .walks = seams.walks,
                       .account = rings.device_account});
}

// The greatest height of parts that are triangulated in local memory; less than 0 for none. If blocks have a
// fraction of the vertices, most work-items of a group are idle, which costs nothing while they would be idle
// anyhow. A leaf of a block may begin in one cell with a block of a single vertex, which is no leaf of a
// larger part.
int height_in_local_memory(Workspace& work, const PointBlocks& blocks) {
  const Tuning& tuning = tuning_of(work.runtime);
  const std::size_t vertices = tuning.local_vertices;
  const bool are_small =
      4 * blocks.points < vertices * blocks.count && kernel::LOCAL_MERGES * blocks.count > tuning.merge_items;
  if (vertices < 2 * kernel::LEAF_VERTICES || are_small) return -1;
  return kernel::halving_depth(static_cast<int>(vertices / 2 + 1));
}

// One for each block, whose height may be less, and one for each cell of this height.
std::size_t local_groups(const PointBlocks& blocks, int height) {
  return blocks.count + cells_of(blocks, height);
}

// kernels::solve_local_parts or kernels::finish_local_parts. are_left: whether states tell which parts are to
// be triangulated.
template <typename Kernel>
void launch_on_local_parts(const Halves& halves, int height, bool are_left) {
  const auto& [work, blocks, halved, rings, parts, depths, states, seams] = halves;
  const Tuning& tuning = tuning_of(work.runtime);
  const std::size_t groups = local_groups(blocks, height);
  std::size_t group = std::min<std::size_t>(tuning.halve_group, kernel::LOCAL_MERGES);
  // If a GPU has room for more work-items, fewer walks that diverge share a warp.
  while (group < tuning.halve_group && 2 * group * groups <= tuning.merge_items) {
    group = std::min(2 * group, tuning.halve_group);
  }
  work.runtime.launch(group * groups, group,
                      Kernel{.groups = groups,
                             .blocks = blocks.count,
                             .are_left = are_left,
                             .places_of_parts = places_of_parts(blocks, halved, rings, height),
                             .bounds = work.bounds,
                             .rings_of_parts = halves.rings_of_parts(),
                             .is_removed = seams.is_removed,
                             .states = states,
                             .account = rings.device_account});
}

// Units whose vertices' stars are found: parts of the height of local memory, or whole blocks. Launches have
// groups for the largest possible one each.
struct StarUnits {
  int height;
  bool are_blocks;
  std::size_t count, most;

  StarUnits(const PointBlocks& blocks, int height_of_units, bool are_whole)
      : height(height_of_units),
        are_blocks(are_whole),
        count(are_whole ? blocks.count : local_groups(blocks, height)),
        most(static_cast<std::size_t>(kernel::LEAF_VERTICES) << height) {}

  // Few points, none of them in a larger unit, units of more than a leaf, and few groups for no vertex.
  bool suit(const Tuning& tuning, std::size_t points) const {
    constexpr std::size_t kMostGroupsPerPoint = 8;
    return points <= tuning.star_points && height > 0 && most <= kernel::STAR_VERTICES &&
           count * most <= kMostGroupsPerPoint * points;
  }
};

void solve_by_stars(const Halves& halves, const StarUnits& units) {
  const auto& [work, blocks, halved, rings, parts, depths, states, seams] = halves;
  host::Runtime& runtime = work.runtime;
  const Tuning& tuning = tuning_of(runtime);
  Arena::Scope scope(work.scratch());
  const std::size_t room = std::min(blocks.points, tuning.star_points);
  const auto stars = work.scratch().allocate<cl_int>(kernel::MOST_STAR * room);
  const auto star_sizes = work.scratch().allocate<cl_int>(room);
  const auto places = places_of_parts(blocks, halved, rings, units.height);
  const std::size_t largest = std::min<std::size_t>(tuning.halve_group, kernel::LARGEST_TILE_GROUP);
  // A work-item compares a few vertices; then the group's comparisons take as many steps.
  constexpr std::size_t kVerticesPerItem = 8;
  const std::size_t group = std::min(group_for(tuning, 1, units.most / kVerticesPerItem), largest);
  runtime.launch(group * units.count * units.most, group,
                 kernels::wrap_stars{.groups = units.count,
                                     .most = units.most,
                                     .blocks = blocks.count,
                                     .places_of_parts = places,
                                     .bounds = work.bounds,
                                     .points = blocks.vertices,
                                     .stars = stars,
                                     .star_sizes = star_sizes,
                                     .account = rings.device_account});
  const std::size_t shares = (units.most + kernel::STARS_JOINED - 1) / kernel::STARS_JOINED;
  runtime.launch(largest * units.count * shares, largest,
                 kernels::join_stars{.groups = units.count,
                                     .shares = shares,
                                     .are_blocks = units.are_blocks,
                                     .blocks = blocks.count,
                                     .places_of_parts = places,
                                     .rings_of_parts = halves.rings_of_parts(),
                                     .stars = stars,
                                     .star_sizes = star_sizes,
                                     .places_left = halved.block_of_place,
                                     .states = states,
                                     .account = rings.device_account});
}

// kernels::merge_trees or kernels::finish_trees.
template <typename Kernel>
void launch_on_trees(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t merges,
                     const Rings& rings, const Buffer<cl_int>& states) {
  const std::size_t spread = spread_of(tuning_of(work.runtime), merges);
  launch_spread(work, spread, merges,
                Kernel{.spread = spread,
                       .first_merge = first,
                       .merges = blocks.device_merges,
                       .nodes = blocks.device_nodes,
                       .bounds = work.bounds,
                       .points = blocks.vertices,
                       .edges = rings.edges,
                       .vertex_edge = rings.vertex_edge,
                       .solved = rings.solved,
                       .states = states,
                       .account = rings.device_account});
}

void sew_seams(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, depths, states, seams] = halves;
  host::Runtime& runtime = work.runtime;
  const std::size_t group = sewing_group_of(tuning_of(runtime), height);
  runtime.launch(group * cells_of(blocks, height), group,
                 kernels::sew_seams{.cells = cells_of(blocks, height),
                                    .places_of_parts = places_of_parts(blocks, halved, rings, height, depths),
                                    .rings_of_parts = halves.rings_of_parts(),
                                    .crossings = seams.crossings,
                                    .walks = seams.walks,
                                    .removals = seams.removals,
                                    .is_removed = seams.is_removed,
                                    .account = rings.device_account});
}

}  // namespace

void merge_halves(Workspace& work, const PointBlocks& blocks, const PartsOfBlocks& parts, const Rings& rings,
                  int from, int to, Depths depths) {
  Arena::Scope scope(work.scratch());
  Halves halves{work, blocks, parts.halved, rings, parts.ends, depths};
  const Tuning& tuning = tuning_of(work.runtime);
  const int in_local = from == 0 ? height_in_local_memory(work, blocks) : -1;
  halves.states = work.scratch().allocate<cl_int>(
      in_local < 0 ? cells_of(blocks, from) : std::max(cells_of(blocks, 0), local_groups(blocks, in_local)));
  const int first = std::max(from, in_local + 1),
            first_seams = std::max(first_height_of_seams(tuning), first);
  // Of blocks with parts that stay apart, these.
  const bool are_parts = depths.least > 0;
  const StarUnits units(blocks, are_parts ? std::max(in_local, 0) : blocks.height(), !are_parts);
  const bool have_stars = from == 0 && units.suit(tuning, blocks.points), are_left = have_stars && are_parts;
  if (work.runtime.at_most(have_stars, from == 0 && tuning.star_points > 0)) solve_by_stars(halves, units);
  // When memory is counted, some blocks are as high as any.
  if (work.runtime.at_most(first_seams <= to, true))
    make_lists(work, blocks, first_seams, in_local >= 0 && !are_left, halves.seams);
  if (in_local >= 0) {
    launch_on_local_parts<kernels::solve_local_parts>(halves, in_local, are_left);
    if (walks_may_stop(work)) launch_on_local_parts<kernels::finish_local_parts>(halves, in_local, true);
  }
  for (int height = first; height < first_seams && height <= to; ++height) {
    launch_on_parts<kernels::merge_parts>(halves, height);
    if (may_stop(work)) launch_on_parts<kernels::finish_parts>(halves, height);
  }
  for (int height = first_seams; height <= to; ++height) {
    launch_on_walks<kernels::walk_seams>(halves, height);
    if (walks_may_stop(work)) launch_on_walks<kernels::finish_walks>(halves, height);
    sew_seams(halves, height);
  }
}

// Rounds certify parts of blocks, at most 2 to this power of each.
constexpr int kMostDepthOfFrames = 3;

std::size_t most_frames(const Workspace& work, std::size_t blocks, std::size_t places) {
  const std::size_t least_points = std::max<std::size_t>(1, tuning_of(work.runtime).local_vertices / 8);
  return std::max(blocks, places / least_points);
}

void solve_in_parallel(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& representatives,
                       const Rings& rings, PartsOfBlocks* parts) {
  PartsOfBlocks own;
  if (const int in_local = height_in_local_memory(work, blocks); parts != nullptr && in_local >= 0) {
    own.height = in_local;
    own.depth = std::clamp<int>(blocks.height() - in_local, 0, kMostDepthOfFrames);
    while (own.depth > 0 && blocks.count << own.depth > most_frames(work, blocks.count, blocks.points))
      --own.depth;
  }
  std::optional<Arena::Scope> scope;
  // When memory is counted, there are parts wherever they may be.
  const bool are_kept = work.runtime.at_most(own.depth > 0, parts != nullptr);
  if (!are_kept) scope.emplace(work.scratch());
  own.halved = halve(work, blocks, representatives, rings);
  if (work.weights != nullptr)
    return work.weights->solver->merge_halves(work, blocks, own.halved, representatives, rings);
  own.ends = work.scratch().allocate<kernel::solved_block>(cells_of(blocks, 0));
  merge_halves(work, blocks, own, rings, 0, blocks.height() - own.depth, {own.depth});
  if (are_kept) *parts = own;
}

void merge_trees(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                 const Rings& rings) {
  Arena::Scope scope(work.scratch());
  const auto states = work.scratch().allocate<cl_int>(end - first);
  launch_on_trees<kernels::merge_trees>(work, blocks, first, end - first, rings, states);
  if (may_stop(work)) launch_on_trees<kernels::finish_trees>(work, blocks, first, end - first, rings, states);
}

}  // namespace flaunay::blocks
