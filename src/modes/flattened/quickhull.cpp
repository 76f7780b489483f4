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
  const auto allocate_paths = [&] {
    Paths paths;
    paths.vertices = scratch.allocate<cl_int>(most_vertices);
    paths.projections = scratch.allocate<cl_double2>(most_vertices);
    paths.regions = scratch.allocate<cl_int>(most_vertices);
    return paths;
  };
  Paths result = allocate_paths();
  result.offsets = scratch.allocate<cl_int>(level.regions + 1);

  Arena::Scope scope(scratch);
  // Two copies of a round's state: each round reads one and writes the other. The first one for points is the
  // input's arrays.
  HullPoints now = start;
  HullPoints next;
  next.ids = scratch.allocate<cl_int>(start.size);
  next.segments = scratch.allocate<cl_int>(start.size);
  next.projections = scratch.allocate<cl_double2>(start.size);
  next.first = scratch.allocate<cl_int>(most_vertices + 1);
  next.ends = result;
  HullPoints spare = start;
  spare.first = scratch.allocate<cl_int>(most_vertices + 1);
  spare.ends = allocate_paths();
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
                                               .segment = now.segments,
                                               .projections = now.projections,
                                               .path_projections = paths.projections,
                                               .path_region = paths.regions,
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
      runtime.map(points, kernels::tilted_depths{.segment = now.segments,
                                                 .projections = now.projections,
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
                                                       .axis = level.axis,
                                                       .cut = level.cut,
                                                       .points = table.points});
    if (rounds >= balanced_from) {
      runtime.map(points, kernels::drop_pairs{.bound = work.bounds.hull,
                                              .segment = now.segments,
                                              .first = now.first,
                                              .projections = now.projections,
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
    runtime.map(points, kernels::side_flags{.segment = now.segments,
                                            .projections = now.projections,
                                            .flags = flags,
                                            .deepest = deepest,
                                            .sides = sides});
    host::exclusive_scan(runtime, sides, points, sides);
    runtime.map(points, kernels::advance_points{.ids = now.ids,
                                                .segment = now.segments,
                                                .projections = now.projections,
                                                .first = now.first,
                                                .sides = sides,
                                                .splits = splits,
                                                .new_ids = next.ids,
                                                .new_segment = next.segments,
                                                .new_projections = next.projections});
    runtime.map(vertices, kernels::advance_paths{.points_count = points,
                                                 .ids = now.ids,
                                                 .projections = now.projections,
                                                 .deepest = deepest,
                                                 .first = now.first,
                                                 .sides = sides,
                                                 .splits = splits,
                                                 .path_vertices = {.path = paths.vertices,
                                                                   .path_projections = paths.projections,
                                                                   .path_region = paths.regions},
                                                 .new_path = next.ends.vertices,
                                                 .new_projections = next.ends.projections,
                                                 .new_region = next.ends.regions,
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
    runtime.copy(now.ends.vertices, 0, result.vertices, 0, vertices);
    runtime.copy(now.ends.projections, 0, result.projections, 0, vertices);
    runtime.copy(now.ends.regions, 0, result.regions, 0, vertices);
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
  HullPoints points;
  points.size = paths.size;
  points.ids = scratch.allocate<cl_int>(paths.size);
  points.projections = scratch.allocate<cl_double2>(paths.size);
  points.segments = scratch.allocate<cl_int>(paths.size);
  runtime.copy(paths.vertices, 0, points.ids, 0, paths.size);
  runtime.copy(paths.projections, 0, points.projections, 0, paths.size);
  runtime.map(paths.size,
              kernels::restart_segments{.path_region = paths.regions, .segment = points.segments});
  points.ends.size = 2 * level.regions;
  points.ends.vertices = scratch.allocate<cl_int>(points.ends.size);
  points.ends.projections = scratch.allocate<cl_double2>(points.ends.size);
  points.ends.regions = scratch.allocate<cl_int>(points.ends.size);
  points.first = scratch.allocate<cl_int>(points.ends.size + 1);
  runtime.map(level.regions, kernels::restart_paths{.path_offsets = paths.offsets,
                                                    .path = paths.vertices,
                                                    .path_projections = paths.projections,
                                                    .ends = points.ends.vertices,
                                                    .end_projections = points.ends.projections,
                                                    .end_region = points.ends.regions,
                                                    .first = points.first});
  int rounds = 0;
  const Paths made = quickhull(work, table, level, points, rounds);
  paths.size = made.size;
  runtime.copy(made.vertices, 0, paths.vertices, 0, made.size);
  runtime.copy(made.projections, 0, paths.projections, 0, made.size);
  runtime.copy(made.regions, 0, paths.regions, 0, made.size);
  runtime.copy(made.offsets, 0, paths.offsets, 0, level.regions + 1);
}

}  // namespace

Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  // Each round reads one of two paths and writes the other, and so with the lists of earlier positions.
  Paths shorter;
  shorter.vertices = scratch.allocate<cl_int>(paths.size);
  shorter.projections = scratch.allocate<cl_double2>(paths.size);
  shorter.regions = scratch.allocate<cl_int>(paths.size);
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
                                                .path = paths.vertices,
                                                .path_projections = paths.projections,
                                                .path_region = paths.regions,
                                                .path_offsets = paths.offsets,
                                                .axis = level.axis,
                                                .cut = level.cut,
                                                .points = table.points,
                                                .flags = flags});
    {
      Arena::Scope scope(scratch);
      decide_vertices(work, table, level, paths, flags);
    }
    work.add_depth(Component::hull, 2 + kernel::DEPTH_OPERATIONS + scan_depth(paths.size));
    host::pack_positions(runtime, flags, paths.size, 1, kept, kept_count);
    shorter.size = runtime.read_one(kept_count, 0);
    if (shorter.size == paths.size) return paths;
    runtime.map(shorter.size, kernels::compact_path{.kept = kept,
                                                    .path = paths.vertices,
                                                    .path_projections = paths.projections,
                                                    .path_region = paths.regions,
                                                    .new_path = shorter.vertices,
                                                    .new_projections = shorter.projections,
                                                    .new_region = shorter.regions});
    runtime.map(shorter.size,
                kernels::find_path_offsets{.path_region = shorter.regions, .path_offsets = shorter.offsets});
    std::swap(paths, shorter);
    std::swap(kept, kept_before);
    first_round = false;
  }
}

}  // namespace flaunay::flattened
