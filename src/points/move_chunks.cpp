// Points to blocks by chunks, each by a work-item.
#include <algorithm>

#include "host/launch/vector_operations.hpp"
#include "launchers/points/distribute.cl.hpp"
#include "points/move_points.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {
namespace {

struct ChunkPlan {
  std::vector<kernel::chunk_of_points> chunks;
  std::vector<cl_int> chunk_first;          // per chunk: the first point of its set
  std::vector<kernel::block_place> places;  // per block
  std::vector<cl_int> set_counts;           // per block: the first count of its set
  std::size_t cursors = 0;
  std::size_t counts = 0;
  std::size_t largest_chunk = 0;
};

// Divides a set with a tree into chunks. Each chunk counts its points per block.
void add_chunks(std::size_t first, std::size_t last, const kernel::set_of_blocks& set, std::size_t size,
                ChunkPlan& plan) {
  const std::size_t blocks = std::size_t{1} << set.depth;
  // So that there are not more counts than points.
  size = std::max(size, blocks);
  plan.largest_chunk = std::max(plan.largest_chunk, std::min(size, last - first));
  const std::size_t chunks = (last - first + size - 1) / size;
  for (std::size_t k = 0; k < chunks; ++k) {
    const std::size_t begin = first + k * size;
    plan.chunks.push_back({static_cast<cl_int>(begin), static_cast<cl_int>(std::min(last, begin + size)),
                           set.depth, set.nodes, static_cast<cl_int>(plan.cursors),
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
}

// Adds a set that is a single block. Consecutive sets of this kind share chunks.
void add_block(std::size_t first, std::size_t last, std::size_t size, ChunkPlan& plan) {
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

// size: the number of points per chunk.
ChunkPlan make_plan(const Plan& sets, const std::vector<std::size_t>& offsets, std::size_t size) {
  ChunkPlan plan;
  for (std::size_t s = 0; s < sets.sets.size(); ++s) {
    const kernel::set_of_blocks& set = sets.sets[s];
    if (set.depth == 0) {
      add_block(offsets[s], offsets[s + 1], size, plan);
    } else {
      add_chunks(offsets[s], offsets[s + 1], set, size, plan);
    }
  }
  return plan;
}

}  // namespace

void move_by_chunks(Workspace& work, const Plan& sets, const std::vector<std::size_t>& offsets,
                    const Buffer<cl_double>& input, const Buffer<cl_int>& representatives, Blocks& blocks) {
  host::Runtime& runtime = work.runtime;
  const ChunkPlan plan = make_plan(sets, offsets, tuning_of(runtime).chunk(blocks.points));
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
                                         .input = input,
                                         .nodes = blocks.device_nodes,
                                         .block_of_point = block_of_point,
                                         .cursors = cursors,
                                         .counts = counts});
    host::exclusive_scan(runtime, counts, plan.counts, counts);
  }
  const kernel::scaling scale = blocks.scale;
  runtime.note_elements(plan.largest_chunk);
  runtime.launch(plan.chunks.size(), group, chunk_count,
                 kernels::move_points{.chunks = chunks,
                                      .set_first = chunk_first,
                                      .input = input,
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

}  // namespace flaunay::points
