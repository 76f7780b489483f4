#include <utility>

#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Rounds after which quickhull splits at random instead of at the deepest point: more than any input has
// shown that was not made to be bad.
constexpr int kRoundsBeforeBalance = 64;

}  // namespace

Paths quickhull(Workspace& work, const PointTable& table, const Level& level, const HullPoints& start,
                int& rounds) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const std::size_t most_vertices = start.ends.size + start.size;
  const auto allocate_paths = [&] {
    Paths paths;
    paths.vertices = scratch.allocate<cl_int>(most_vertices);
    paths.places = scratch.allocate<cl_double2>(most_vertices);
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
  next.places = scratch.allocate<cl_double2>(start.size);
  next.first = scratch.allocate<cl_int>(most_vertices + 1);
  next.ends = result;
  HullPoints spare = start;
  spare.first = scratch.allocate<cl_int>(most_vertices + 1);
  spare.ends = allocate_paths();
  const auto depth = scratch.allocate<cl_double>(start.size);
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
    runtime.map("quickhull", "hull_depths", points, work.bounds.hull, now.segments, now.places, paths.places,
                paths.regions, level.axis, level.cut, depth, flags);
    const auto list = pack_undecided(work, flags, points);
    run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{0}, now.ids, now.segments,
             paths.vertices, paths.regions, level.axis, level.cut, table.points, flags);
    runtime.fill(deepest, vertices, cl_int{-1});
    host::segmented_arg_reduce(runtime, "quickhull", "deepest_points", now.segments, points, deepest,
                               cl_int{rounds >= kRoundsBeforeBalance}, flags, now.ids, depth, now.places,
                               paths.regions, level.axis, level.cut);
    runtime.map("quickhull", "split_flags", vertices, deepest, splits);
    host::exclusive_scan(runtime, splits, vertices, splits);
    runtime.map("quickhull", "side_flags", points, now.segments, now.places, flags, deepest, sides);
    host::exclusive_scan(runtime, sides, points, sides);
    runtime.map("quickhull", "advance_points", points, now.ids, now.segments, now.places, now.first, sides,
                splits, next.ids, next.segments, next.places);
    runtime.map("quickhull", "advance_paths", vertices, static_cast<cl_int>(points), now.ids, now.places,
                deepest, now.first, sides, splits, paths.vertices, paths.places, paths.regions,
                next.ends.vertices, next.ends.places, next.ends.regions, next.first, sizes);
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
    runtime.copy(now.ends.places, 0, result.places, 0, vertices);
    runtime.copy(now.ends.regions, 0, result.regions, 0, vertices);
  }
  result.size = vertices;
  runtime.map("quickhull", "find_path_offsets", vertices, result.regions, result.offsets);
  return result;
}

Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  while (true) {
    const auto flags = scratch.allocate<cl_uchar>(paths.size);
    runtime.map("quickhull", "path_flags", paths.size, work.bounds.hull, paths.places, paths.regions,
                paths.offsets, level.axis, level.cut, flags);
    {
      Arena::Scope scope(scratch);
      const auto list = pack_undecided(work, flags, paths.size);
      run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{1}, paths.vertices,
               paths.vertices, paths.vertices, paths.regions, level.axis, level.cut, table.points, flags);
    }
    const auto [kept, kept_count] = host::pack_positions(runtime, flags, paths.size, 1);
    if (kept_count == paths.size) return paths;
    Paths shorter;
    shorter.size = kept_count;
    shorter.vertices = scratch.allocate<cl_int>(kept_count);
    shorter.places = scratch.allocate<cl_double2>(kept_count);
    shorter.regions = scratch.allocate<cl_int>(kept_count);
    shorter.offsets = scratch.allocate<cl_int>(level.regions + 1);
    runtime.map("quickhull", "compact_path", kept_count, kept, paths.vertices, paths.places, paths.regions,
                shorter.vertices, shorter.places, shorter.regions);
    runtime.map("quickhull", "find_path_offsets", kept_count, shorter.regions, shorter.offsets);
    paths = shorter;
  }
}

}  // namespace flaunay::flattened
