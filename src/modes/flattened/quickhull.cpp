#include <utility>

#include "flattened/limits.h"
#include "launchers/flattened/quickhull.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

Paths quickhull(Workspace& work, const PointTable& table, const Level& level, const HullPoints& start,
                int& rounds) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const std::size_t most_vertices = start.ends.size + start.size;
  Paths result = allocate_paths(scratch, most_vertices);
  result.offsets = scratch.allocate<cl_int>(level.regions + 1);

  Arena::Scope scope(scratch);
  // Two copies of a round's state: each round reads one and writes the other. The first one for points is the
  // input's arrays.
  HullPoints now = start;
  HullPoints next = allocate_hull_points(scratch, start.size, 0);
  next.first = scratch.allocate<cl_int>(most_vertices + 1);
  next.ends = result;
  HullPoints spare = start;
  spare.first = scratch.allocate<cl_int>(most_vertices + 1);
  spare.ends = allocate_paths(scratch, most_vertices);
  const auto computed_depth = scratch.allocate<cl_double>(start.size);
  const int balanced_from =
      work.hull == Hull::balanced ? kernel::ROUNDS_BEFORE_BALANCE : kernel::MOST_QUICKHULL_ROUNDS;
  const auto flags = scratch.allocate<cl_uchar>(start.size);
  const auto sides = scratch.allocate<cl_uint2>(start.size + 1);
  const auto deepest = scratch.allocate<cl_int>(most_vertices);
  const auto splits = scratch.allocate<cl_uint>(most_vertices + 1);
  const auto sizes = scratch.allocate<cl_uint>(2);

  std::size_t points = start.size;
  std::size_t vertices = start.ends.size;
  for (rounds = 0; points > 0; ++rounds) {
    Arena::Scope round_scope(scratch);
    const Paths& paths = now.ends;
    const bool is_known = rounds == 0 && start.depths.size() > 0;
    const Buffer<cl_double>& depth = is_known ? start.depths : computed_depth;
    if (is_known) {
      runtime.fill(flags, points, cl_uchar{1});
    } else {
      runtime.map(points, kernels::hull_depths{.bound = work.bounds.hull,
                                               .hull_points = now,
                                               .path_vertices = paths,
                                               .axis = level.axis,
                                               .depth = depth,
                                               .flags = flags});
      decide_depths(work, table, level, paths, now.ids, now.segments, points, false, flags);
    }
    Buffer<cl_double> rank = depth;
    if (rounds >= balanced_from) {
      const auto pairs = scratch.allocate<cl_int>(vertices);
      rank = scratch.allocate<cl_double>(points);
      runtime.fill(pairs, vertices, cl_int{-1});
      host::segmented_arg_reduce(runtime, points,
                                 kernels::random_pairs{.segment = now.segments,
                                                       .result = pairs,
                                                       .first = now.first,
                                                       .flags = flags,
                                                       .projections = now.projections});
      runtime.map(points, kernels::tilted_depths{.hull_points = now,
                                                 .path_projections = paths.projections,
                                                 .pair = pairs,
                                                 .depth = depth,
                                                 .tilted = rank});
    }
    runtime.fill(deepest, vertices, cl_int{-1});
    host::segmented_arg_reduce(runtime, points,
                               kernels::deepest_points{.segment = now.segments,
                                                       .result = deepest,
                                                       .flags = flags,
                                                       .ids = now.ids,
                                                       .depth = rank,
                                                       .projections = now.projections,
                                                       .path_region = paths.regions,
                                                       .cuts = level.cuts(table)});
    if (rounds >= balanced_from) {
      runtime.map(points, kernels::drop_pairs{.bound = work.bounds.hull,
                                              .hull_points = now,
                                              .first = now.first,
                                              .path_region = paths.regions,
                                              .axis = level.axis,
                                              .deepest = deepest,
                                              .flags = flags});
    }
    work.add_depth(Component::hull,
                   (is_known ? 0 : kernel::DEPTH_OPERATIONS) + log2_ceiling(points) + 2 + scan_depth(points));
    if (rounds >= balanced_from) {
      work.add_depth(Component::hull,
                     kernel::TILT_OPERATIONS + log2_ceiling(points) + 2 + kernel::DEPTH_OPERATIONS);
    }
    runtime.map(vertices, kernels::split_counts{.deepest = deepest, .splits = splits});
    host::exclusive_scan(runtime, splits, vertices, splits);
    runtime.map(points,
                kernels::side_flags{.hull_points = now, .flags = flags, .deepest = deepest, .sides = sides});
    host::exclusive_scan(runtime, sides, points, sides);
    runtime.map(points, kernels::advance_points{.hull_points = now,
                                                .first = now.first,
                                                .sides = sides,
                                                .splits = splits,
                                                .new_hull_points = next});
    runtime.map(vertices, kernels::advance_paths{.points_count = points,
                                                 .hull_points = now,
                                                 .deepest = deepest,
                                                 .first = now.first,
                                                 .sides = sides,
                                                 .splits = splits,
                                                 .path_vertices = paths,
                                                 .new_path_vertices = next.ends,
                                                 .new_first = next.first,
                                                 .sizes = sizes});
    cl_uint new_sizes[2];
    runtime.read(sizes, 0, 2, new_sizes);
    points = new_sizes[0];
    vertices = new_sizes[1];
    // The input's path arrays are too small for the new path.
    if (rounds == 0) now = spare;
    std::swap(now, next);
  }

  if (now.ends.vertices.memory() != result.vertices.memory()) {
    now.ends.size = vertices;
    copy_paths(work, now.ends, result);
  }
  result.size = vertices;
  runtime.map(vertices,
              kernels::find_path_offsets{.path_region = result.regions, .path_offsets = result.offsets});
  return result;
}

namespace {

// Replaces each path by the hull of its vertices, computed by quickhull.
void restart(Workspace& work, const PointTable& table, const Level& level, Paths& paths) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const HullPoints points = allocate_hull_points(scratch, paths.size, 2 * level.regions);
  runtime.copy(paths.vertices, 0, points.ids, 0, paths.size);
  runtime.copy(paths.projections, 0, points.projections, 0, paths.size);
  runtime.map(paths.size,
              kernels::restart_segments{.path_region = paths.regions, .segment = points.segments});
  runtime.map(level.regions, kernels::restart_paths{
                                 .paths = paths, .new_path_vertices = points.ends, .first = points.first});
  int rounds = 0;
  const Paths made = quickhull(work, table, level, points, rounds);
  paths.size = made.size;
  copy_paths(work, made, paths);
  runtime.copy(made.offsets, 0, paths.offsets, 0, level.regions + 1);
}

}  // namespace

Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  // Each round reads one of two paths and writes the other, and so with the lists of earlier positions.
  Paths shorter = allocate_paths(scratch, paths.size);
  shorter.offsets = scratch.allocate<cl_int>(level.regions + 1);
  Buffer<cl_int> kept = scratch.allocate<cl_int>(paths.size);
  Buffer<cl_int> kept_before = scratch.allocate<cl_int>(paths.size);
  const auto flags = scratch.allocate<cl_uchar>(paths.size);
  const auto kept_count = scratch.allocate<cl_uint>(1);
  bool first_round = true;
  for (int round = 1;; ++round) {
    if (round == kernel::CLEAN_UP_ROUNDS) {
      restart(work, table, level, paths);
      first_round = true;
    }
    runtime.map(paths.size, kernels::path_flags{.bound = work.bounds.hull,
                                                .first_round = first_round,
                                                .kept = kept_before,
                                                .paths = paths,
                                                .path_region = paths.regions,
                                                .cuts = level.cuts(table),
                                                .flags = flags});
    {
      Arena::Scope scope(scratch);
      decide_vertices(work, table, level, paths, flags);
    }
    work.add_depth(Component::hull, 2 + kernel::DEPTH_OPERATIONS + scan_depth(paths.size));
    host::pack_positions(runtime, flags, paths.size, 1, kept, kept_count);
    shorter.size = runtime.read_one(kept_count, 0);
    if (shorter.size == paths.size) return paths;
    runtime.map(shorter.size,
                kernels::compact_path{.kept = kept, .path_vertices = paths, .new_path_vertices = shorter});
    runtime.map(shorter.size,
                kernels::find_path_offsets{.path_region = shorter.regions, .path_offsets = shorter.offsets});
    std::swap(paths, shorter);
    std::swap(kept, kept_before);
    first_round = false;
  }
}

}  // namespace flaunay::flattened
