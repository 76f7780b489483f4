#include <algorithm>

#include "host/vector_operations.hpp"
#include "hybrid/cut_tree.hpp"
#include "hybrid/stages.hpp"
#include "input/inspect.hpp"

namespace flaunay::hybrid {
namespace {

// As blocks.cl has it.
struct Chunk {
  cl_int first, last, depth, nodes, row, counts, number, chunks;
};

// Where a block begins: behind `first`, as many points as counts [set_count, count) say; count is -1 if none.
struct BlockPlace {
  cl_int first, count;
};

// What the host decides before points move.
struct Plan {
  std::vector<SetToCut> cut;  // the sets that are larger than a block
  std::vector<Chunk> chunks;
  std::vector<cl_int> chunk_first;  // by chunk: the first point of its set
  std::vector<BlockPlace> places;   // by block
  std::vector<cl_int> set_counts;   // by block: its set's first count
  std::size_t nodes = 0;
  std::size_t cursors = 0;
  std::size_t counts = 0;
};

int depth_for(std::size_t n, std::size_t block_points) {
  int depth = 0;
  while (n > block_points << depth) ++depth;
  return depth;
}

// nodes: where those of the set's tree begin.
void add_merges(int depth, std::size_t nodes, std::size_t first_block,
                std::vector<std::vector<Merge>>& levels) {
  if (levels.size() < static_cast<std::size_t>(depth)) levels.resize(depth);
  for (int level = 0; level < depth; ++level) {
    const int below = depth - level;
    for (std::size_t j = 0; j < std::size_t{1} << level; ++j) {
      const auto low = static_cast<cl_int>(first_block + (j << below));
      const auto node = static_cast<cl_int>(nodes + (std::size_t{1} << level) + j);
      levels[level].push_back({low, low + (1 << (below - 1)), node, 0});
    }
  }
}

// Pieces of a set with a tree, each counted on its own.
void add_chunks(std::size_t first, std::size_t last, int depth, std::size_t size, Plan& plan) {
  const std::size_t blocks = std::size_t{1} << depth;
  // No more counts than points.
  size = std::max(size, blocks);
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

// A set that is one block; neighbouring ones share chunks.
void add_block(std::size_t first, std::size_t last, std::size_t size, Plan& plan) {
  plan.places.push_back({static_cast<cl_int>(first), -1});
  plan.set_counts.push_back(0);
  if (first == last) return;
  if (!plan.chunks.empty() && plan.chunks.back().depth == 0 &&
      last - static_cast<std::size_t>(plan.chunks.back().first) <= size) {
    plan.chunks.back().last = static_cast<cl_int>(last);
    return;
  }
  plan.chunks.push_back({static_cast<cl_int>(first), static_cast<cl_int>(last), 0, 0, 0, 0, 0, 0});
  plan.chunk_first.push_back(static_cast<cl_int>(first));
}

Plan make_plan(const host::Tuning& tuning, const std::vector<std::size_t>& offsets, Blocks& blocks) {
  Plan plan;
  const std::size_t chunk = tuning.chunk(blocks.points);
  std::vector<std::vector<Merge>> levels;
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

// The nodes of the trees, which the merges of blocks read too.
void make_trees(Workspace& work, const Plan& plan, const Buffer<cl_double>& input, Blocks& blocks) {
  if (plan.cut.empty()) return;
  blocks.device_nodes = work.persistent.allocate<CutNode>(plan.nodes);
  Arena::Scope scope(work.scratch());
  const CutTrees trees(work.runtime, plan.cut, kSamplesPerBlock);
  trees.cut(trees.draw(input).points, blocks.device_nodes);
}

void move_to_blocks(Workspace& work, const Plan& plan, const Scaling& scaling, const Buffer<cl_double>& input,
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
  const std::size_t group = runtime.tuning().chunk_group;
  const auto chunk_count = static_cast<cl_int>(plan.chunks.size());
  if (has_trees) {
    runtime.launch("blocks", "count_blocks", plan.chunks.size(), group, chunk_count, chunks, input,
                   blocks.device_nodes, block_of_point, cursors, counts);
    host::exclusive_scan(runtime, counts, plan.counts, counts);
  }
  const auto [s0, s1, s2] = scaling.powers();
  runtime.launch("blocks", "move_points", plan.chunks.size(), group, chunk_count, chunks, chunk_first, input,
                 s0, s1, s2, block_of_point, counts, cursors, blocks.vertices, blocks.source,
                 representatives);
  blocks.offsets.resize(blocks.count + 1);
  if (has_trees) {
    const auto places = runtime.upload(scratch, plan.places);
    const auto set_counts = runtime.upload(scratch, plan.set_counts);
    runtime.map("blocks", "block_offsets", blocks.count, places, set_counts, counts, blocks.device_offsets);
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
  const Scaling scaling =
      scaling_for(work.runtime, input, blocks.points, inspect(work.runtime, input, blocks.points));
  work.bounds = scaling.bounds;
  plan = make_plan(work.runtime.tuning(), offsets, blocks);
  make_trees(work, plan, input, blocks);
  blocks.vertices = work.persistent.allocate<cl_double2>(blocks.points);
  blocks.source = work.persistent.allocate<cl_int>(blocks.points);
  blocks.device_offsets = work.persistent.allocate<cl_int>(blocks.count + 1);
  blocks.device_set_blocks = work.runtime.upload(work.persistent, blocks.set_blocks);
  blocks.device_merges = work.runtime.upload(work.persistent, blocks.merges);
  move_to_blocks(work, plan, scaling, input, representatives, blocks);
  return blocks;
}

}  // namespace flaunay::hybrid
