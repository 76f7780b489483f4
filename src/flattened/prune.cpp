#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

constexpr std::size_t kBucket = 16;  // BUCKET in prune.cl
// Candidates a region from which on it pays to prune them by candidates of their own.
constexpr std::size_t kManyCandidates = 256;

// Brings flagged internal points and corners together by region. elements: level.points, or with the corners.
// They are put into `arena`.
HullPoints gather(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  std::size_t elements, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  const auto points_count = static_cast<cl_int>(level.points);
  const auto regions = static_cast<cl_int>(level.regions);
  HullPoints points;
  const auto [positions, kept] = host::pack_positions(runtime, flags, elements, 1);
  points.size = kept;
  points.ids = arena.allocate<cl_int>(kept);
  points.segments = arena.allocate<cl_int>(kept);
  points.projections = arena.allocate<cl_double2>(kept);
  points.ends.size = 2 * level.regions;
  points.ends.vertices = arena.allocate<cl_int>(points.ends.size);
  points.ends.projections = arena.allocate<cl_double2>(points.ends.size);
  points.ends.regions = arena.allocate<cl_int>(points.ends.size);
  points.first = arena.allocate<cl_int>(points.ends.size + 1);
  const auto before = work.scratch().allocate<cl_int2>(level.regions + 1);
  const std::size_t group = runtime.tuning().map_group;
  runtime.launch("prune", "begin_paths", level.regions + 1, group, regions, points_count,
                 static_cast<cl_int>(kept), positions, level.point_offsets, level.corner_offsets,
                 level.first_end, level.last_end, level.axis, level.cut, table.points, points.ends.vertices,
                 points.ends.projections, points.ends.regions, points.first, before);
  runtime.map("prune", "gather_points", kept, points_count, regions, positions, before, level.point_regions,
              level.projections, level.x_list, level.y_list, level.corner_regions, level.corner_ids,
              level.axis, level.cut, table.points, points.ids, points.segments, points.projections);
  return points;
}

}  // namespace

Pruned allocate_pruned(Workspace& work, const Level& level) {
  Arena& scratch = work.scratch();
  const std::size_t elements = level.points + level.corners;
  return {elements, scratch.allocate<cl_uchar>(elements), scratch.allocate<cl_int>(elements),
          scratch.allocate<cl_double>(elements)};
}

void prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on,
           const Pruned& pruned) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto ids = scratch.allocate<cl_int>(pruned.elements);
  const auto band = scratch.allocate<cl_double>(paths.size);
  runtime.map("prune", "chord_bands", paths.size, paths.regions, paths.projections, level.axis, band);
  runtime.map("prune", "prune_points", (level.points + kBucket - 1) / kBucket,
              static_cast<cl_int>(level.points), cl_int{keep_on}, work.bounds.hull, level.point_regions,
              level.x_list, level.y_list, level.projections, level.axis, level.cut, table.points, band,
              paths.offsets, paths.vertices, paths.projections, ids, pruned.chord, pruned.depth,
              pruned.flags);
  runtime.map("prune", "prune_corners", level.corners, static_cast<cl_int>(level.points), work.bounds.hull,
              level.corner_regions, level.corner_ids, level.axis, level.cut, table.points, band,
              paths.offsets, paths.vertices, paths.projections, ids, pruned.chord, pruned.depth,
              pruned.flags);
  // Bands; a corner's projection; the searches of a run and of a point of it; band, equal u and which is
  // lower.
  work.add_depth(Component::hull, 6 + 2 + 2 + 2 * log2_ceiling(paths.size) + 1 + 1 + 4 + kDepthOperations +
                                      scan_depth(pruned.elements));
  const auto list = pack_undecided(work, pruned.flags, pruned.elements);
  run_list(work, "quickhull", "hull_depth_exact", list, cl_int{keep_on}, cl_int{0}, ids, pruned.chord,
           paths.vertices, paths.regions, level.axis, level.cut, table.points, pruned.flags);
}

namespace {

// What was kept below paths, for quickhull to go on with, and the paths, into `arena`.
HullPoints gather_below(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                        const Pruned& pruned, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  HullPoints points;
  const auto [positions, kept] = host::pack_positions(runtime, pruned.flags, pruned.elements, 1);
  points.size = kept;
  points.ids = arena.allocate<cl_int>(kept);
  points.segments = arena.allocate<cl_int>(kept);
  points.projections = arena.allocate<cl_double2>(kept);
  points.depths = arena.allocate<cl_double>(kept);
  points.ends.size = paths.size;
  points.ends.vertices = arena.allocate<cl_int>(paths.size);
  points.ends.projections = arena.allocate<cl_double2>(paths.size);
  points.ends.regions = arena.allocate<cl_int>(paths.size);
  runtime.copy(paths.vertices, 0, points.ends.vertices, 0, paths.size);
  runtime.copy(paths.projections, 0, points.ends.projections, 0, paths.size);
  runtime.copy(paths.regions, 0, points.ends.regions, 0, paths.size);
  points.first = arena.allocate<cl_int>(paths.size + 1);
  {
    Arena::Scope scope(scratch);
    const auto keys = scratch.allocate<cl_ulong>(kept);
    runtime.map("prune", "chord_keys", kept, positions, pruned.chord, keys);
    host::sort_by_key(runtime, keys, positions, kept);
    work.add_depth(Component::hull, log2_ceiling(paths.size) * scan_depth(kept));
    runtime.map("prune", "gather_below", kept, static_cast<cl_int>(level.points), keys, positions,
                paths.regions, pruned.depth, level.projections, level.x_list, level.y_list, level.corner_ids,
                level.axis, level.cut, table.points, points.ids, points.segments, points.projections,
                points.depths);
  }
  runtime.launch("prune", "chord_begins", paths.size + 1, runtime.tuning().map_group,
                 static_cast<cl_int>(paths.size), static_cast<cl_int>(kept), points.segments, points.first);
  return points;
}

Paths pruned_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  LevelStatistics& statistics, int& rounds);

// Chord paths over all of a level's internal points and ends, good enough to prune by: the hulls of one
// candidate a bucket, which themselves have been pruned the same way while there are many of them.
Paths chord_paths(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  host::Runtime& runtime = work.runtime;
  const auto flags = work.scratch().allocate<cl_uchar>(level.points);
  runtime.map("prune", "candidate_flags", (level.points + kBucket - 1) / kBucket,
              static_cast<cl_int>(level.points), level.point_regions, level.projections, flags);
  work.add_depth(Component::hull, log2_ceiling(kBucket) + scan_depth(level.points));
  const HullPoints candidates = gather(work, table, level, flags, level.points, work.scratch());
  statistics.candidates += candidates.size;
  int rounds = 0;
  if (candidates.size > kManyCandidates * level.regions) {
    Level thin = level;
    thin.points = candidates.size;
    thin.corners = 0;
    thin.x_list = thin.y_list = candidates.ids;
    thin.projections = candidates.projections;
    thin.point_regions = work.scratch().allocate<cl_int>(candidates.size);
    thin.point_offsets = work.scratch().allocate<cl_int>(level.regions + 1);
    runtime.map("prune", "thin_regions", candidates.size, candidates.segments, thin.point_regions);
    const std::size_t group = runtime.tuning().map_group;
    runtime.launch("prune", "thin_offsets", level.regions + 1, group, static_cast<cl_int>(level.regions),
                   candidates.first, thin.point_offsets);
    const Paths paths =
        pruned_hull(work, table, thin, work.scratch().allocate<cl_uchar>(thin.points), statistics, rounds);
    statistics.candidate_rounds += rounds;
    return paths;
  }
  Paths paths = quickhull(work, table, level, candidates, rounds);
  statistics.candidate_rounds += rounds;
  return strict(work, table, level, paths);
}

// Prunes by chord paths and goes on from them. flags: prune's, of all points and corners. What goes from one
// to the other waits where the next level will be, so that all that prune needs is released before quickhull
// begins. rounds: of quickhull below them.
Paths pruned_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  LevelStatistics& statistics, int& rounds) {
  Arena& scratch = work.scratch();
  Arena::Scope waiting_scope(*work.children);
  HullPoints survivors;
  {
    Arena::Scope scope(scratch);
    const Paths paths = chord_paths(work, table, level, statistics);
    const std::size_t elements = level.points + level.corners;
    const Pruned pruned{elements, flags, scratch.allocate<cl_int>(elements),
                        scratch.allocate<cl_double>(elements)};
    prune(work, table, level, paths, false, pruned);
    survivors = gather_below(work, table, level, paths, pruned, *work.children);
  }
  statistics.survivors = survivors.size;
  return strict(work, table, level, quickhull(work, table, level, survivors, rounds));
}

Paths plain_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                 LevelStatistics& statistics) {
  Arena::Scope waiting_scope(*work.children);
  const std::size_t elements = level.points + level.corners;
  work.runtime.fill(flags, elements, cl_uchar{1});
  const HullPoints all = gather(work, table, level, flags, elements, *work.children);
  statistics.survivors = all.size;
  return strict(work, table, level, quickhull(work, table, level, all, statistics.hull_rounds));
}

}  // namespace

void project(Workspace& work, const PointTable& table, Level& level) {
  level.projections = work.scratch().allocate<cl_double2>(level.points);
  work.runtime.map("prune", "project_points", level.points, level.point_regions, level.x_list, level.y_list,
                   level.axis, level.cut, table.points, level.projections);
  work.add_depth(Component::hull, kProjectOperations);
}

Paths hulls(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  const auto flags = work.scratch().allocate<cl_uchar>(level.points + level.corners);
  Paths paths = work.hull == Hull::prune
                    ? pruned_hull(work, table, level, flags, statistics, statistics.hull_rounds)
                    : plain_hull(work, table, level, flags, statistics);
  paths.flags = flags;
  return paths;
}

}  // namespace flaunay::flattened
