#include <utility>

#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Rounds after which quickhull splits at random instead of at the deepest point: more than any input has shown that
// was not made to be bad.
constexpr int kRoundsBeforeBalance = 64;

}  // namespace

Paths quickhull(Workspace& work, const PointTable& table, const Level& level, const HullPoints& start, int& rounds) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const std::size_t most_segments = level.regions + start.size;
  Paths paths;
  paths.vertices = scratch.allocate<cl_int>(most_segments + level.regions);
  paths.places = scratch.allocate<cl_double2>(most_segments + level.regions);
  paths.regions = scratch.allocate<cl_int>(most_segments + level.regions);
  paths.offsets = scratch.allocate<cl_int>(level.regions + 1);

  Arena::Scope scope(scratch);
  HullPoints now = start;
  HullPoints next;
  next.ids = scratch.allocate<cl_int>(start.size);
  next.segments = scratch.allocate<cl_int>(start.size);
  next.places = scratch.allocate<cl_double2>(start.size);
  const auto allocate_segments = [&](HullPoints& points) {
    points.chord_a = scratch.allocate<cl_int>(most_segments);
    points.chord_b = scratch.allocate<cl_int>(most_segments);
    points.chord_region = scratch.allocate<cl_int>(most_segments);
    points.chord_places = scratch.allocate<cl_double4>(most_segments);
    points.first = scratch.allocate<cl_int>(most_segments + 1);
  };
  allocate_segments(next);
  HullPoints spare;
  spare.ids = start.ids;
  spare.segments = start.segments;
  spare.places = start.places;
  allocate_segments(spare);
  const auto depth = scratch.allocate<cl_double>(start.size);
  const auto flags = scratch.allocate<cl_uchar>(start.size);
  const auto sides = scratch.allocate<cl_uint2>(start.size + 1);
  const auto deepest = scratch.allocate<cl_int>(most_segments);
  const auto splits = scratch.allocate<cl_uint>(most_segments + 1);
  const auto sizes = scratch.allocate<cl_uint>(2);

  std::size_t points = start.size;
  std::size_t segments = level.regions;
  for (rounds = 0; points > 0; ++rounds) {
    Arena::Scope round_scope(scratch);
    runtime.map("quickhull", "hull_depths", points, work.bounds.hull, now.segments, now.places, now.chord_places,
                now.chord_region, level.axis, level.cut, depth, flags);
    const auto list = pack_undecided(work, flags, points);
    run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{0}, cl_int{0}, now.ids, now.segments,
             now.chord_a, now.chord_b, now.chord_region, level.axis, level.cut, table.points, flags);
    runtime.fill(deepest, segments, cl_int{-1});
    host::segmented_arg_reduce(runtime, "quickhull", "deepest_points", now.segments, points, deepest,
                               cl_int{rounds >= kRoundsBeforeBalance}, flags, now.ids, depth, now.places,
                               now.chord_region, level.axis, level.cut);
    runtime.map("quickhull", "split_flags", segments, deepest, splits);
    host::exclusive_scan(runtime, splits, segments, splits);
    runtime.map("quickhull", "side_flags", points, now.segments, now.places, flags, deepest, sides);
    host::exclusive_scan(runtime, sides, points, sides);
    runtime.map("quickhull", "advance_points", points, now.ids, now.segments, now.places, now.first, sides, splits,
                next.ids, next.segments, next.places);
    runtime.map("quickhull", "advance_segments", segments, static_cast<cl_int>(points), now.ids, now.places, deepest,
                now.first, sides, splits, now.chord_a, now.chord_b, now.chord_places, now.chord_region, next.chord_a,
                next.chord_b, next.chord_places, next.chord_region, next.first, sizes);
    cl_uint new_sizes[2];
    runtime.read(sizes, 0, 2, new_sizes);
    points = new_sizes[0];
    segments = new_sizes[1];
    if (rounds == 0) {
      // The start's segment arrays have room for its own segments alone.
      now = spare;
    }
    std::swap(now, next);
  }

  runtime.map("quickhull", "write_path", segments, now.chord_a, now.chord_b, now.chord_places, now.chord_region,
              paths.vertices, paths.places, paths.regions, paths.offsets);
  paths.size = segments + level.regions;
  return paths;
}

Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  while (true) {
    const auto flags = scratch.allocate<cl_uchar>(paths.size);
    runtime.map("quickhull", "path_flags", paths.size, work.bounds.hull, paths.places, paths.regions, paths.offsets,
                level.axis, level.cut, flags);
    {
      Arena::Scope scope(scratch);
      const auto list = pack_undecided(work, flags, paths.size);
      run_list(work, "quickhull", "hull_depth_exact", list, cl_int{0}, cl_int{1}, cl_int{2}, paths.vertices,
               paths.vertices, paths.vertices, paths.vertices, paths.regions, level.axis, level.cut, table.points,
               flags);
    }
    const auto [kept, kept_count] = host::pack_positions(runtime, flags, paths.size, 1);
    if (kept_count == paths.size) return paths;
    Paths shorter;
    shorter.size = kept_count;
    shorter.vertices = scratch.allocate<cl_int>(kept_count);
    shorter.places = scratch.allocate<cl_double2>(kept_count);
    shorter.regions = scratch.allocate<cl_int>(kept_count);
    shorter.offsets = scratch.allocate<cl_int>(level.regions + 1);
    runtime.map("quickhull", "compact_path", kept_count, static_cast<cl_int>(paths.size), kept, paths.vertices,
                paths.places, paths.regions, shorter.vertices, shorter.places, shorter.regions, shorter.offsets);
    paths = shorter;
  }
}

}  // namespace flaunay::flattened
