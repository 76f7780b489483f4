#include "points/distribute.hpp"

#include <algorithm>

#include "host/vector_operations.hpp"
#include "launchers/points/distribute.cl.hpp"
#include "points/cut_tree.hpp"
#include "points/inspect.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {
namespace {

// What the host decides before points are moved to blocks.
struct Plan {
  std::vector<SetToCut> cut;  // the sets that are larger than a block
  std::vector<kernel::chunk_of_points> chunks;
  std::vector<cl_int> chunk_first;          // per chunk: the first point of its set
  std::vector<kernel::block_place> places;  // per block
  std::vector<cl_int> set_counts;           // per block: the first count of its set
  std::size_t nodes = 0;
  std::size_t cursors = 0;
  std::size_t counts = 0;
  std::size_t largest_chunk = 0;
};

int depth_for(std::size_t n, std::size_t block_points) {
  int depth = 0;
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

// Divides a set with a tree into chunks, each of which counts its points per block.
void add_chunks(std::size_t first, std::size_t last, int depth, std::size_t size, Plan& plan) {
  const std::size_t blocks = std::size_t{1} << depth;
  // So that there are not more counts than points.
  size = std::max(size, blocks);
  plan.largest_chunk = std::max(plan.largest_chunk, std::min(size, last - first));
  const std::size_t chunks = (last - first + size - 1) / size;
  for (std::size_t k = 0; k < chunks; ++k) {
    const std::size_t begin = first + k * size;
    plan.chunks.push_back({static_cast<cl_int>(begin), static_cast<cl_int>(std::min(last, begin + size)),
                           depth, static_cast<cl_int>(plan.nodes), static_cast<cl_int>(plan.cursors),
                           static_cast<cl_int>(plan.counts), static_cast<cl_int>(k),
                           static_cast<cl_int>(chunks)});
    plan.chunk_first.push_back(static_cast<cl_int>(first));
    plan.cursors += blocks;
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    plan.places.push_back({static_cast<cl_int>(first), static_cast<cl_int>(plan.counts + b * chunks)});
    plan.set_counts.push_back(static_cast<cl_int>(plan.counts));
  }
  plan.counts += blocks * chunks;
  plan.nodes += blocks;
}

// Adds a set that is a single block. Consecutive sets of this kind share chunks.
void add_block(std::size_t first, std::size_t last, std::size_t size, Plan& plan) {
  plan.places.push_back({static_cast<cl_int>(first), -1});
  plan.set_counts.push_back(0);
  if (first == last) return;
  if (!plan.chunks.empty() && plan.chunks.back().depth == 0 &&
      last - static_cast<std::size_t>(plan.chunks.back().first) <= size) {
    plan.chunks.back().last = static_cast<cl_int>(last);
    plan.largest_chunk =
        std::max(plan.largest_chunk, last - static_cast<std::size_t>(plan.chunks.back().first));
    return;
  }
  plan.largest_chunk = std::max(plan.largest_chunk, last - first);
  plan.chunks.push_back({static_cast<cl_int>(first), static_cast<cl_int>(last), 0, 0, 0, 0, 0, 0});
  plan.chunk_first.push_back(static_cast<cl_int>(first));
}

Plan make_plan(const Tuning& tuning, const std::vector<std::size_t>& offsets, Blocks& blocks) {
  Plan plan;
  const std::size_t chunk = tuning.chunk(blocks.points);
  std::vector<std::vector<kernel::block_merge>> levels;
  blocks.set_blocks.push_back(0);
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    const std::size_t first = offsets[s], last = offsets[s + 1];
    const int depth = depth_for(last - first, tuning.block_points);
    if (depth == 0) {
      add_block(first, last, chunk, plan);
    } else {
      plan.cut.push_back({depth, first, last - first});
      add_merges(depth, plan.nodes, plan.places.size(), levels);
      add_chunks(first, last, depth, chunk, plan);
    }
    blocks.set_blocks.push_back(static_cast<cl_int>(plan.places.size()));
  }
  blocks.count = plan.places.size();
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    blocks.merges.insert(blocks.merges.end(), level->begin(), level->end());
    blocks.level_ends.push_back(blocks.merges.size());
  }
  return plan;
}

// Computes the nodes of the trees, which the merges of blocks read later.
void make_trees(Workspace& work, const Plan& plan, const Buffer<cl_double>& input, Blocks& blocks) {
  if (plan.cut.empty()) return;
  blocks.device_nodes = work.persistent.allocate<kernel::cut_node>(plan.nodes);
  Arena::Scope scope(work.scratch());
  const CutTrees trees(work.runtime, plan.cut, tuning_of(work.runtime).samples_per_block);
  trees.cut(trees.draw(input).points, blocks.device_nodes);
}

void move_to_blocks(Workspace& work, const Plan& plan, const UniformPoints& input,
                    const Buffer<cl_int>& representatives, Blocks& blocks) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto chunks = runtime.upload(scratch, plan.chunks);
  const auto chunk_first = runtime.upload(scratch, plan.chunk_first);
  const bool has_trees = plan.counts > 0;
  const auto block_of_point = scratch.allocate<cl_int>(has_trees ? blocks.points : 0);
  const auto cursors = scratch.allocate<cl_int>(plan.cursors);
  const auto counts = scratch.allocate<cl_uint>(plan.counts + 1);
  const std::size_t group = runtime.sizes().chunk_group;
  const auto chunk_count = static_cast<cl_int>(plan.chunks.size());
  if (has_trees) {
    runtime.note_elements(plan.largest_chunk);
    runtime.launch(plan.chunks.size(), group, chunk_count,
                   kernels::count_blocks{.chunks = chunks,
                                         .input = input.coordinates,
                                         .nodes = blocks.device_nodes,
                                         .block_of_point = block_of_point,
                                         .cursors = cursors,
                                         .counts = counts});
    host::exclusive_scan(runtime, counts, plan.counts, counts);
  }
  const kernel::scaling scale = input.scaling.powers();
  runtime.note_elements(plan.largest_chunk);
  runtime.launch(plan.chunks.size(), group, chunk_count,
                 kernels::move_points{.chunks = chunks,
                                      .set_first = chunk_first,
                                      .input = input.coordinates,
                                      .scale = scale,
                                      .block_of_point = block_of_point,
                                      .scanned = counts,
                                      .cursors = cursors,
                                      .points = blocks.vertices,
                                      .source = blocks.source,
                                      .representatives = representatives});
  blocks.offsets.resize(blocks.count + 1);
  if (has_trees) {
    const auto places = runtime.upload(scratch, plan.places);
    const auto set_counts = runtime.upload(scratch, plan.set_counts);
    runtime.map(
        blocks.count,
        kernels::block_offsets{
            .places = places, .set_count = set_counts, .scanned = counts, .offsets = blocks.device_offsets});
    runtime.read(blocks.device_offsets, 0, blocks.count, blocks.offsets.data());
  } else {
    for (std::size_t b = 0; b < blocks.count; ++b) blocks.offsets[b] = plan.places[b].first;
  }
  blocks.offsets[blocks.count] = static_cast<cl_int>(blocks.points);
  runtime.write(blocks.device_offsets, 0, blocks.count + 1, blocks.offsets.data());
}

}  // namespace

Blocks make_blocks(Workspace& work, const Buffer<cl_double>& input, const std::vector<std::size_t>& offsets,
                   const Buffer<cl_int>& representatives) {
  Blocks blocks;
  blocks.sets = offsets.size() - 1;
  blocks.points = offsets.back();
  Arena::Scope scope(work.scratch());
  Plan plan;
  const host::Runtime::Settled settled(work.runtime);
  const UniformPoints uniform = make_uniform(work.runtime, input, offsets);
  work.bounds = uniform.scaling.bounds;
  plan = make_plan(tuning_of(work.runtime), offsets, blocks);
  make_trees(work, plan, uniform.coordinates, blocks);
  blocks.vertices = work.persistent.allocate<cl_double2>(blocks.points);
  blocks.source = work.persistent.allocate<cl_int>(blocks.points);
  blocks.device_offsets = work.persistent.allocate<cl_int>(blocks.count + 1);
  blocks.device_set_blocks = work.runtime.upload(work.persistent, blocks.set_blocks);
  blocks.device_merges = work.runtime.upload(work.persistent, blocks.merges);
  move_to_blocks(work, plan, uniform, representatives, blocks);
  return blocks;
}

}  // namespace flaunay::points
