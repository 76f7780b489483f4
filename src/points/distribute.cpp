#include "points/distribute.hpp"

#include <algorithm>

#include "arithmetic/records.h"
#include "mesh/limits.h"
#include "points/cut_tree.hpp"
#include "points/inspect.hpp"
#include "points/move_points.hpp"
#include "points/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::points {
using namespace geometry;

namespace {

// alone: the largest number of points of a set that is one block.
int depth_for(std::size_t n, std::size_t block_points, std::size_t alone) {
  int depth = 0;
  if (n <= alone) return 0;
  while (n > block_points << depth) ++depth;
  return depth;
}

// Adds the merges of a set. nodes: the first node of the set's tree.
void add_merges(int depth, std::size_t nodes, std::size_t first_block,
                std::vector<std::vector<kernel::block_merge>>& levels) {
  if (levels.size() < static_cast<std::size_t>(depth)) levels.resize(depth);
  for (int level = 0; level < depth; ++level) {
    const int below = depth - level;
    for (std::size_t j = 0; j < std::size_t{1} << level; ++j) {
      const auto low = static_cast<cl_int>(first_block + (j << below));
      const auto node = static_cast<cl_int>(nodes + (std::size_t{1} << level) + j);
      levels[level].push_back({low, low + (1 << (below - 1)), node});
    }
  }
}

Plan make_plan(std::size_t block_points, std::size_t alone, const std::vector<std::size_t>& offsets,
               Blocks& blocks) {
  Plan plan;
  std::vector<std::vector<kernel::block_merge>> levels;
  blocks.set_blocks.push_back(0);
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    const std::size_t first = offsets[s], last = offsets[s + 1];
    const int depth = depth_for(last - first, block_points, alone);
    plan.sets.push_back({static_cast<cl_int>(blocks.count), depth, static_cast<cl_int>(plan.nodes)});
    if (depth > 0) {
      plan.cut.push_back({depth, first, last - first});
      add_merges(depth, plan.nodes, blocks.count, levels);
      plan.nodes += std::size_t{1} << depth;
    }
    blocks.count += std::size_t{1} << depth;
    blocks.set_blocks.push_back(static_cast<cl_int>(blocks.count));
  }
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    blocks.merges.insert(blocks.merges.end(), level->begin(), level->end());
    blocks.level_ends.push_back(blocks.merges.size());
  }
  return plan;
}

// Computes the nodes of the trees, which the merges of blocks read later.
void make_trees(Workspace& work, const Plan& plan, const Buffer<cl_double>& input, Cuts cuts,
                const Blocks& blocks) {
  if (plan.cut.empty()) return;
  const Tuning& tuning = tuning_of(work.runtime);
  Arena::Scope scope(work.scratch());
  if (cuts == Cuts::in_gaps && tuning.tile_group != 0) {
    const CutTrees trees(work.runtime, plan.cut, tuning.samples_per_gap_block);
    trees.cut_at_gaps(trees.draw(input).points, blocks.device_nodes);
  } else {
    const CutTrees trees(work.runtime, plan.cut, tuning.samples_per_block);
    trees.cut(trees.draw(input).points, blocks.device_nodes);
  }
}

// The host's part of blocks, and memory for the others.
Plan begin_blocks(Workspace& work, const std::vector<std::size_t>& offsets, std::size_t block_points,
                  std::size_t alone, Blocks& blocks) {
  blocks.sets = offsets.size() - 1;
  blocks.points = offsets.back();
  Plan plan = make_plan(block_points, alone, offsets, blocks);
  if (plan.nodes > 0) blocks.device_nodes = work.persistent.allocate<kernel::cut_node>(plan.nodes);
  blocks.vertices = work.persistent.allocate<cl_double2>(blocks.points);
  blocks.source = work.persistent.allocate<cl_int>(blocks.points);
  blocks.device_offsets = work.persistent.allocate<cl_int>(blocks.count + 1);
  blocks.device_set_points = work.runtime.upload(work.persistent, integers(offsets));
  blocks.device_set_blocks = work.runtime.upload(work.persistent, blocks.set_blocks);
  blocks.device_merges = work.runtime.upload(work.persistent, blocks.merges);
  return plan;
}

// coordinates: x0 y0 x1 y1 ..., to be multiplied by blocks.scale.
void fill_blocks(Workspace& work, const Plan& plan, const Buffer<cl_double>& coordinates,
                 const std::vector<std::size_t>& offsets, Cuts cuts, BlockSizes sizes,
                 const Buffer<cl_int>& representatives, Blocks& blocks) {
  make_trees(work, plan, coordinates, cuts, blocks);
  if (work.runtime.sizes().tile_group != 0) {
    move_by_tiles(work, plan, offsets, coordinates, sizes, representatives, blocks);
  } else {
    move_by_chunks(work, plan, offsets, coordinates, representatives, blocks);
  }
}

}  // namespace

Fitted<Blocks> make_blocks(Workspace& work, const Buffer<cl_double>& input,
                           const std::vector<std::size_t>& offsets, const Buffer<cl_int>& representatives,
                           const double* host_points) {
  Blocks blocks;
  const host::Runtime::Settled settled(work.runtime);
  const std::size_t block_points = tuning_of(work.runtime).block_points;
  const Plan plan = begin_blocks(work, offsets, block_points, block_points, blocks);
  Arena::Scope scope(work.scratch());
  const Fitted<UniformPoints> uniform = make_uniform(work.runtime, input, offsets, host_points);
  if (!uniform) return uniform.too_wide();
  work.bounds = uniform->scaling.bounds;
  blocks.scale = uniform->scaling.powers();
  blocks.shifts = uniform->shifts;
  fill_blocks(work, plan, uniform->coordinates, offsets, Cuts::at_medians, BlockSizes::read, representatives,
              blocks);
  return blocks;
}

Blocks make_blocks_of(Workspace& work, const Buffer<cl_double2>& points,
                      const std::vector<std::size_t>& offsets, std::size_t block_points, Cuts cuts,
                      BlockSizes sizes) {
  Blocks blocks;
  const host::Runtime::Settled settled(work.runtime);
  // A set of two blocks would need one more round than a single block.
  // If all blocks were tiny, halving would take this for read.
  blocks.largest = std::max<std::size_t>(2 * block_points, kernel::TINY_BLOCK + 1);
  const Plan plan = begin_blocks(work, offsets, block_points, blocks.largest, blocks);
  Arena::Scope scope(work.scratch());
  // Not needed: these points have no duplicates.
  const auto representatives = work.scratch().allocate<cl_int>(blocks.points);
  fill_blocks(work, plan, points.as<cl_double>(), offsets, cuts, sizes, representatives, blocks);
  return blocks;
}

}  // namespace flaunay::points
