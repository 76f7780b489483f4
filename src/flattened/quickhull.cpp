#include <utility>

#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Rounds after which splits are balanced. More than any input has shown that was not made to be bad; with
// Hull::balanced, what the paper's authors found to serve skewed input well.
constexpr int kMostQuickhullRounds = 64;
constexpr int kRoundsBeforeBalance = 4;

}  // namespace

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
  // The state of a round, twice; the points move to and fro between the start's arrays and others.
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
  const int balanced_from = work.hull == Hull::balanced ? kRoundsBeforeBalance : kMostQuickhullRounds;
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
      runtime.map("quickhull", "hull_depths", points, work.bounds.hull, now.segments, now.projections,
                  paths.projections, paths.regions, level.axis, depth, flags);
      const auto list = pack_undecided(work, flags, points);
      run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{0}, now.ids, now.segments,
               paths.vertices, paths.regions, level.axis, level.cut, table.points, flags);
    }
    Buffer<cl_double> rank = depth;
    if (rounds >= balanced_from) {
      const auto pairs = scratch.allocate<cl_int>(vertices);
      rank = scratch.allocate<cl_double>(points);
      runtime.fill(pairs, vertices, cl_int{-1});
      host::segmented_arg_reduce(runtime, "quickhull", "random_pairs", now.segments, points, pairs, now.first,
                                 flags, now.projections);
      runtime.map("quickhull", "tilted_depths", points, now.segments, now.projections, paths.projections,
                  pairs, depth, rank);
    }
    runtime.fill(deepest, vertices, cl_int{-1});
    host::segmented_arg_reduce(runtime, "quickhull", "deepest_points", now.segments, points, deepest, flags,
                               now.ids, rank, now.projections, paths.regions, level.axis, level.cut,
                               table.points);
    if (rounds >= balanced_from) {
      runtime.map("quickhull", "drop_pairs", points, work.bounds.hull, now.segments, now.first,
                  now.projections, paths.regions, level.axis, deepest, flags);
    }
    work.add_depth(Component::hull,
                   (is_known ? 0 : kDepthOperations) + log2_ceiling(points) + 2 + scan_depth(points));
    if (rounds >= balanced_from) {
      work.add_depth(Component::hull, 6 + log2_ceiling(points) + 2 + kDepthOperations);
    }
    runtime.map("quickhull", "split_counts", vertices, deepest, splits);
    host::exclusive_scan(runtime, splits, vertices, splits);
    runtime.map("quickhull", "side_flags", points, now.segments, now.projections, flags, deepest, sides);
    host::exclusive_scan(runtime, sides, points, sides);
    runtime.map("quickhull", "advance_points", points, now.ids, now.segments, now.projections, now.first,
                sides, splits, next.ids, next.segments, next.projections);
    runtime.map("quickhull", "advance_paths", vertices, static_cast<cl_int>(points), now.ids, now.projections,
                deepest, now.first, sides, splits, paths.vertices, paths.projections, paths.regions,
                next.ends.vertices, next.ends.projections, next.ends.regions, next.first, sizes);
    cl_uint new_sizes[2];
    runtime.read(sizes, 0, 2, new_sizes);
    points = new_sizes[0];
    vertices = new_sizes[1];
    // The start's path arrays have room for the ends alone.
    if (rounds == 0) now = spare;
    std::swap(now, next);
  }

  if (now.ends.vertices.memory() != result.vertices.memory()) {
    runtime.copy(now.ends.vertices, 0, result.vertices, 0, vertices);
    runtime.copy(now.ends.projections, 0, result.projections, 0, vertices);
    runtime.copy(now.ends.regions, 0, result.regions, 0, vertices);
  }
  result.size = vertices;
  runtime.map("quickhull", "find_path_offsets", vertices, result.regions, result.offsets);
  return result;
}

namespace {

// Dropping can lay bare one vertex at a time; after so many rounds quickhull sorts out what is left.
constexpr int kCleanUpRounds = 8;

// Replaces paths by quickhull of their vertices.
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
  runtime.map("quickhull", "restart_segments", paths.size, paths.regions, points.segments);
  points.ends.size = 2 * level.regions;
  points.ends.vertices = scratch.allocate<cl_int>(points.ends.size);
  points.ends.projections = scratch.allocate<cl_double2>(points.ends.size);
  points.ends.regions = scratch.allocate<cl_int>(points.ends.size);
  points.first = scratch.allocate<cl_int>(points.ends.size + 1);
  runtime.map("quickhull", "restart_paths", level.regions, paths.offsets, paths.vertices, paths.projections,
              points.ends.vertices, points.ends.projections, points.ends.regions, points.first);
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
  // The vertices move to and fro between two paths, and where they stood before between two lists.
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
    if (round == kCleanUpRounds) {
      restart(work, table, level, paths);
      first_round = true;
    }
    runtime.map("quickhull", "path_flags", paths.size, work.bounds.hull, cl_int{first_round}, kept_before,
                paths.vertices, paths.projections, paths.regions, paths.offsets, level.axis, level.cut,
                table.points, flags);
    {
      Arena::Scope scope(scratch);
      const auto list = pack_undecided(work, flags, paths.size);
      run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{1}, paths.vertices,
               paths.vertices, paths.vertices, paths.regions, level.axis, level.cut, table.points, flags);
    }
    work.add_depth(Component::hull, 2 + kDepthOperations + scan_depth(paths.size));
    host::pack_positions(runtime, flags, paths.size, 1, kept, kept_count);
    shorter.size = runtime.read_one(kept_count, 0);
    if (shorter.size == paths.size) return paths;
    runtime.map("quickhull", "compact_path", shorter.size, kept, paths.vertices, paths.projections,
                paths.regions, shorter.vertices, shorter.projections, shorter.regions);
    runtime.map("quickhull", "find_path_offsets", shorter.size, shorter.regions, shorter.offsets);
    std::swap(paths, shorter);
    std::swap(kept, kept_before);
    first_round = false;
  }
}

}  // namespace flaunay::flattened
