#include "blocks/weighted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "arithmetic/bit_account.h"
#include "blocks/halving.h"
#include "blocks/parts.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/blocks/weighted.cl.hpp"
#include "launchers/blocks/weighted_halves.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

Error wrong_weight(std::size_t point, double weight, double scaled) {
  if (!std::isfinite(weight)) {
    return Error(ErrorKind::input,
                 fmt::format("point {} has a weight that is not finite: {}", point, weight));
  }
  return Error(
      ErrorKind::input,
      fmt::format("point {} has a weight, {}, that is too {} beside the squares of the coordinates for "
                  "exact arithmetic: scale the weights",
                  point, weight, std::fabs(scaled) > 1 ? "large" : "fine"));
}

Weights scale_weights(Workspace& work, const Weights& given, const std::vector<std::size_t>& offsets,
                      const std::vector<int>& shifts) {
  host::Runtime& runtime = work.runtime;
  const std::size_t n = offsets.back(), chunk = runtime.sizes().chunk(n);
  Weights scaled = given;
  scaled.by_point = work.persistent.allocate<cl_double>(n);
  Arena::Scope scope(work.scratch());
  const std::vector<cl_int> first = shifts.size() == 1 ? std::vector<cl_int>{0} : integers(offsets);
  std::vector<cl_double2> ranges((n + chunk - 1) / chunk);
  const auto device_ranges = work.scratch().allocate<cl_double2>(ranges.size());
  const auto bad = runtime.upload(work.scratch(), std::vector<cl_int>{kernel::NO_BAD});
  runtime.chunks(n, chunk,
                 kernels::scale_weights{.sets = shifts.size(),
                                        .offsets = runtime.upload(work.scratch(), first),
                                        .shifts = runtime.upload(work.scratch(), shifts),
                                        .weights = given.by_point,
                                        .scaled_weights = scaled.by_point,
                                        .bad = bad,
                                        .ranges = device_ranges});
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(device_ranges, 0, ranges.size(), ranges.data());
  const cl_int wrong = runtime.read_one(bad, 0);
  if (wrong != kernel::NO_BAD) {
    const auto at = static_cast<std::size_t>(wrong);
    throw wrong_weight(given.number ? given.number(at) : at, runtime.read_one(given.by_point, at),
                       runtime.read_one(scaled.by_point, at));
  }
  double least = HUGE_VAL, greatest = -HUGE_VAL;
  for (const cl_double2& range : ranges) {
    least = std::min(least, range.s[0]);
    greatest = std::max(greatest, range.s[1]);
  }
  scaled.range = greatest - least;
  return scaled;
}

void solve_weighted(Workspace& work, const Blocks& blocks, const Rings& rings, const BlocksLaunch& launch) {
  work.runtime.launch(launch.workers, tuning_of(work.runtime).block_group,
                      kernels::solve_weighted_blocks{.workers = launch.workers,
                                                     .blocks = launch.blocks,
                                                     .capacity = launch.capacity,
                                                     .larger = launch.larger,
                                                     .offsets = blocks.device_offsets,
                                                     .bounds = work.bounds,
                                                     .weights = work.weights->by_point,
                                                     .weight_range = work.weights->range,
                                                     .vertex_weights = rings.vertex_weights,
                                                     .links = rings.links,
                                                     .next = launch.next,
                                                     .block_points = launch.points,
                                                     .edges = rings.edges,
                                                     .vertex_edge = rings.vertex_edge,
                                                     .account = rings.device_account,
                                                     .block_scratch = launch.scratch,
                                                     .scratch_axes = launch.scratch_axes});
}

// Makes the heaviest of several points in one place the vertex. block_of_place: as of halve.
void choose_heaviest(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& block_of_place,
                     const Buffer<cl_int>& representatives, const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t n = blocks.points;
  const Buffer<cl_double>& weights = work.weights->by_point;
  const auto upper = work.scratch().allocate<cl_uint>(n), lower = work.scratch().allocate<cl_uint>(n);
  const auto heaviest = work.scratch().allocate<cl_int>(n);
  runtime.fill<cl_uint>(upper, n, 0);
  runtime.fill<cl_uint>(lower, n, 0);
  runtime.fill<cl_int>(heaviest, n, std::numeric_limits<cl_int>::max());
  runtime.map(
      n, kernels::find_upper_halves{.representatives = representatives, .weights = weights, .upper = upper});
  runtime.map(n, kernels::find_lower_halves{
                     .representatives = representatives, .weights = weights, .upper = upper, .lower = lower});
  runtime.map(n, kernels::find_heaviest{.representatives = representatives,
                                        .weights = weights,
                                        .upper = upper,
                                        .lower = lower,
                                        .heaviest = heaviest});
  runtime.map(n, kernels::name_by_weight{
                     .weights = weights, .heaviest = heaviest, .representatives = representatives});
  runtime.map(n, kernels::weigh_vertices{.block_of_place = block_of_place,
                                         .offsets = blocks.offsets,
                                         .distinct = rings.device_distinct,
                                         .weights = weights,
                                         .heaviest = heaviest,
                                         .source = blocks.source,
                                         .vertex_weights = rings.vertex_weights});
}

void merge_weighted_halves(Workspace& work, const PointBlocks& blocks, const HalvedBlocks& halved,
                           const Buffer<cl_int>& representatives, const Rings& rings) {
  choose_heaviest(work, blocks, halved.block_of_place, representatives, rings);
  const auto parts = work.scratch().allocate<kernel::solved_block>(cells_of(blocks, 0));
  const int heights = kernel::halving_depth(static_cast<int>(blocks.largest));
  for (int height = 0; height <= heights; ++height) {
    const std::size_t spread = spread_of_parts(tuning_of(work.runtime), blocks, height);
    launch_spread(
        work, spread, cells_of(blocks, height),
        kernels::merge_weighted_halves{.spread = spread,
                                       .places_of_parts = places_of_parts(blocks, halved, rings, height),
                                       .bounds = work.bounds,
                                       .vertex_weights = rings.vertex_weights,
                                       .weight_range = work.weights->range,
                                       .links = rings.links,
                                       .points = blocks.vertices,
                                       .edges = rings.edges,
                                       .vertex_edge = rings.vertex_edge,
                                       .parts = parts,
                                       .solved = rings.solved,
                                       .account = rings.device_account});
  }
}

void merge_weighted(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                    const Rings& rings) {
  const std::size_t merges = end - first, spread = spread_of(tuning_of(work.runtime), merges);
  launch_spread(work, spread, merges,
                kernels::merge_weighted_blocks{.spread = spread,
                                               .first_merge = first,
                                               .merges = blocks.device_merges,
                                               .nodes = blocks.device_nodes,
                                               .offsets = blocks.device_offsets,
                                               .bounds = work.bounds,
                                               .vertex_weights = rings.vertex_weights,
                                               .weight_range = work.weights->range,
                                               .links = rings.links,
                                               .points = blocks.vertices,
                                               .edges = rings.edges,
                                               .vertex_edge = rings.vertex_edge,
                                               .solved = rings.solved,
                                               .account = rings.device_account});
}

// The number of hidden points is not known yet, but the number of triangles is.
MeshSizes weighted_mesh_sizes(Workspace& work, const Blocks& blocks, const std::vector<cl_int>& walked,
                              const Buffer<cl_uint>& rows) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  std::vector<cl_uint> before(blocks.sets + 1);
  const auto device_before = work.scratch().allocate<cl_uint>(before.size());
  runtime.map(before.size(), kernels::rows_before_sets{.set_blocks = blocks.device_set_blocks,
                                                       .offsets = blocks.device_offsets,
                                                       .first_rows = rows,
                                                       .rows = device_before});
  runtime.read(device_before, 0, before.size(), before.data());
  MeshSizes sizes;
  sizes.triangle_offsets = sizes.hull_offsets = {0};
  for (std::size_t s = 0; s < walked.size(); ++s) {
    const bool is_empty = blocks.offsets[blocks.set_blocks[s]] == blocks.offsets[blocks.set_blocks[s + 1]];
    const std::size_t triangles = before[s + 1] - before[s];
    const std::size_t vertices = is_empty ? 0 : (triangles + 2 + walked[s]) / 2;
    sizes.vertices += vertices;
    sizes.triangle_offsets.push_back(sizes.triangle_offsets.back() + triangles);
    sizes.hull_offsets.push_back(sizes.hull_offsets.back() + (triangles == 0 ? vertices : walked[s]));
  }
  return sizes;
}

// The representatives of points in the place of heavier ones, ascending: of those with the same place and
// weight, the first. names: the complements of heavier points, of which some are not the heaviest.
std::vector<cl_int> names_of_lighter(const std::vector<cl_int>& lighter, std::vector<cl_int> names,
                                     const std::vector<cl_double>& weights) {
  const std::size_t count = lighter.size();
  // The heaviest points. Mostly a point's heavier one comes behind it, so few steps are left from the last
  // one on.
  for (std::size_t k = count; k-- > 0;) {
    for (cl_int above = ~names[k];;) {
      const auto at = std::lower_bound(lighter.begin(), lighter.end(), above);
      names[k] = above;
      if (at == lighter.end() || *at != above) break;
      const cl_int known = names[static_cast<std::size_t>(at - lighter.begin())];
      above = known < 0 ? ~known : known;
    }
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) { return std::tuple(names[k], weights[k]); };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
  std::vector<cl_int> own(count);
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_new = k == 0 || key(order[k - 1]) != key(order[k]);
    own[order[k]] = is_new ? lighter[order[k]] : own[order[k - 1]];
  }
  return own;
}

void settle_lighter(Workspace& work, std::size_t n, const Buffer<cl_int>& representatives,
                    const Buffer<cl_uchar>& hidden) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto flags = scratch.allocate<cl_uchar>(n);
  runtime.map(n, kernels::flag_lighter{.representatives = representatives, .flags = flags});
  const auto [lighter, count] = host::pack_positions(runtime, flags, n, 1);
  if (count == 0) return;
  const auto names = scratch.allocate<cl_int>(count);
  const auto weights = scratch.allocate<cl_double>(count);
  runtime.map(count, kernels::gather_lighter{.lighter = lighter,
                                             .representatives = representatives,
                                             .weights = work.weights->by_point,
                                             .names = names,
                                             .their_weights = weights});
  std::vector<cl_int> their_points(count), their_names(count);
  std::vector<cl_double> their_weights(count);
  {
    const host::Runtime::Settled settled(runtime);
    runtime.read_later(lighter, 0, count, their_points.data());
    runtime.read_later(names, 0, count, their_names.data());
    runtime.read(weights, 0, count, their_weights.data());
  }
  runtime.write_kept(names, names_of_lighter(their_points, std::move(their_names), their_weights));
  runtime.map(count,
              kernels::settle_lighter{
                  .lighter = lighter, .names = names, .representatives = representatives, .hidden = hidden});
}

std::size_t settle(Workspace& work, const Blocks& blocks, const Rings& rings,
                   const Buffer<cl_int>& representatives) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t n = blocks.points;
  const auto is_hidden = work.scratch().allocate<cl_uchar>(n);
  runtime.fill<cl_uchar>(is_hidden, n, 0);
  runtime.map(n, kernels::flag_hidden{
                     .vertex_edge = rings.vertex_edge, .source = blocks.source, .hidden = is_hidden});
  settle_lighter(work, n, representatives, is_hidden);
  const auto [hidden, count] = host::pack_positions(runtime, is_hidden, n, 1);
  runtime.copy(hidden, 0, work.weights->hidden(count), 0, count);
  return count;
}

}  // namespace

const WeightedSolver kWeightedSolver = {scale_weights,  solve_weighted,      merge_weighted_halves,
                                        merge_weighted, weighted_mesh_sizes, settle};

}  // namespace flaunay::blocks
