// Points to blocks by tiles, each by a work-group: a radix sort by the numbers of blocks.
#include <algorithm>
#include <utility>

#include "host/launch/vector_operations.hpp"
#include "launchers/points/distribute_tiles.cl.hpp"
#include "points/device_mesh.hpp"
#include "points/move_points.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {
namespace {

// How blocks' numbers fall apart into digits of `bits` bits.
struct Digits {
  int count, bits;
};

Digits digits_of(std::size_t blocks, std::size_t most_bits) {
  int bits = 1;
  while ((blocks - 1) >> bits > 0) ++bits;
  const int most = static_cast<int>(most_bits), count = (bits + most - 1) / most;
  return {count, (bits + count - 1) / count};
}

// The tiles of points, and a table of how many points of each tile have each digit.
struct Tiles {
  std::size_t points, size, count;
  Digits digits;
  Buffer<cl_uint> table;

  Tiles(Workspace& work, const Blocks& blocks)
      : points(blocks.points),
        size(tuning_of(work.runtime).point_tile),
        count((points + size - 1) / size),
        digits(digits_of(blocks.count, tuning_of(work.runtime).block_bits)),
        table(work.scratch().allocate<cl_uint>((count << digits.bits) + 1)) {}

  template <typename Kernel>
  void launch(host::Runtime& runtime, const Kernel& kernel) const {
    const std::size_t group = runtime.sizes().tile_group;
    runtime.launch(count * group, group, points, kernel);
  }
  void scan(host::Runtime& runtime) const {
    host::exclusive_scan(runtime, table, count << digits.bits, table);
  }
};

// The blocks of points, and the points' indices.
struct Keys {
  Buffer<cl_int> blocks, indices;
};

Keys allocate_keys(Workspace& work, std::size_t points) {
  return {work.scratch().allocate<cl_int>(points), work.scratch().allocate<cl_int>(points)};
}

void count_tile_blocks(Workspace& work, const Plan& plan, const Blocks& blocks,
                       const Buffer<cl_double>& input, const Tiles& tiles,
                       const Buffer<cl_int>& block_of_point, const Buffer<cl_int>& representatives) {
  const auto sets = work.runtime.upload(work.scratch(), plan.sets);
  tiles.launch(work.runtime, kernels::count_tile_blocks{.size = tiles.size,
                                                        .set_count = plan.sets.size(),
                                                        .set_offsets = blocks.device_set_points,
                                                        .sets = sets,
                                                        .input = input,
                                                        .nodes = blocks.device_nodes,
                                                        .bits = tiles.digits.bits,
                                                        .block_of_point = block_of_point,
                                                        .representatives = representatives,
                                                        .table = tiles.table});
  tiles.scan(work.runtime);
}

// Sorts by all digits but the last; the table is then that of the last one. Returns the keys in their order.
Keys sort_by_lower_digits(Workspace& work, const Tiles& tiles, Keys keys) {
  Keys moved{}, spare{};
  for (int digit = 0; digit + 1 < tiles.digits.count; ++digit) {
    const int bits = tiles.digits.bits, shift = digit * bits;
    // Two in turn.
    if (digit < 2) moved = allocate_keys(work, tiles.points);
    tiles.launch(work.runtime, kernels::move_keys{.size = tiles.size,
                                                  .shift = shift,
                                                  .bits = bits,
                                                  .is_first = digit == 0,
                                                  .blocks = keys.blocks,
                                                  .indices = keys.indices,
                                                  .scanned = tiles.table,
                                                  .moved_blocks = moved.blocks,
                                                  .moved_indices = moved.indices});
    tiles.launch(work.runtime, kernels::count_digits{.size = tiles.size,
                                                     .shift = shift + bits,
                                                     .bits = bits,
                                                     .blocks = moved.blocks,
                                                     .table = tiles.table});
    tiles.scan(work.runtime);
    keys = moved;
    std::swap(moved, spare);
  }
  return keys;
}

void sort_into_blocks(Workspace& work, const Plan& plan, const Buffer<cl_double>& input,
                      const Buffer<cl_int>& representatives, Blocks& blocks) {
  const Tiles tiles(work, blocks);
  const auto block_of_point = work.scratch().allocate<cl_int>(blocks.points);
  count_tile_blocks(work, plan, blocks, input, tiles, block_of_point, representatives);
  const Keys keys = sort_by_lower_digits(work, tiles, {block_of_point, block_of_point});
  const int lower_digits = tiles.digits.count - 1;
  // The blocks as they were found first are not needed any more.
  const auto& sorted = block_of_point;
  tiles.launch(work.runtime, kernels::move_tiles{.size = tiles.size,
                                                 .shift = lower_digits * tiles.digits.bits,
                                                 .bits = tiles.digits.bits,
                                                 .is_first = lower_digits == 0,
                                                 .blocks = keys.blocks,
                                                 .indices = keys.indices,
                                                 .scanned = tiles.table,
                                                 .input = input,
                                                 .scale = blocks.scale,
                                                 .block_count = blocks.count,
                                                 .offsets = blocks.device_offsets,
                                                 .moved_blocks = sorted,
                                                 .points = blocks.vertices,
                                                 .source = blocks.source});
  if (lower_digits == 0) return;
  work.runtime.map(
      blocks.count + 1,
      kernels::block_starts{.points = blocks.points, .blocks = sorted, .offsets = blocks.device_offsets});
}

}  // namespace

void move_by_tiles(Workspace& work, const Plan& plan, const std::vector<std::size_t>& offsets,
                   const Buffer<cl_double>& input, BlockSizes sizes, const Buffer<cl_int>& representatives,
                   Blocks& blocks) {
  Arena::Scope scope(work.scratch());
  if (!plan.cut.empty()) {
    sort_into_blocks(work, plan, input, representatives, blocks);
    if (sizes == BlockSizes::guessed) return;
    blocks.offsets.resize(blocks.count + 1);
    work.runtime.read(blocks.device_offsets, 0, blocks.count, blocks.offsets.data());
    blocks.offsets[blocks.count] = static_cast<cl_int>(blocks.points);
    return;
  }
  work.runtime.map(blocks.points, kernels::copy_points{.input = input,
                                                       .scale = blocks.scale,
                                                       .points = blocks.vertices,
                                                       .source = blocks.source,
                                                       .representatives = representatives});
  // Each set is one block.
  blocks.offsets.assign(offsets.begin(), offsets.end());
  blocks.device_offsets = blocks.device_set_points;
}

}  // namespace flaunay::points
