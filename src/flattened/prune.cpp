#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

constexpr std::size_t kBucket = 16;  // BUCKET in prune.cl
// Candidates a region from which on it pays to prune them by candidates of their own.
constexpr std::size_t kManyCandidates = 256;

// Brings flagged internal points and corners together by region. elements: level.points, or with the corners.
HullPoints gather(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  std::size_t elements) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const auto points_count = static_cast<cl_int>(level.points);
  const auto regions = static_cast<cl_int>(level.regions);
  HullPoints points;
  const auto [positions, kept] = host::pack_positions(runtime, flags, elements, 1);
  points.size = kept;
  points.ids = scratch.allocate<cl_int>(kept);
  points.segments = scratch.allocate<cl_int>(kept);
  points.places = scratch.allocate<cl_double2>(kept);
  points.ends.size = 2 * level.regions;
  points.ends.vertices = scratch.allocate<cl_int>(points.ends.size);
  points.ends.places = scratch.allocate<cl_double2>(points.ends.size);
  points.ends.regions = scratch.allocate<cl_int>(points.ends.size);
  points.first = scratch.allocate<cl_int>(points.ends.size + 1);
  const auto before = scratch.allocate<cl_int2>(level.regions + 1);
  const std::size_t group = runtime.tuning().map_group;
  runtime.launch("prune", "begin_paths", level.regions + 1, group, regions, points_count,
                 static_cast<cl_int>(kept), positions, level.point_offsets, level.corner_offsets,
                 level.first_end, level.last_end, level.axis, table.points, points.ends.vertices,
                 points.ends.places, points.ends.regions, points.first, before);
  runtime.map("prune", "gather_points", kept, points_count, regions, positions, before, level.point_regions,
              level.x_list, level.y_list, level.corner_regions, level.corner_ids, level.axis, table.points,
              points.ids, points.segments, points.places);
  return points;
}

}  // namespace

Pruned allocate_pruned(Workspace& work, const Level& level) {
  const std::size_t elements = level.points + level.corners;
  return {elements, work.scratch().allocate<cl_uchar>(elements)};
}

void prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on,
           const Pruned& pruned) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto ids = scratch.allocate<cl_int>(pruned.elements);
  const auto chord = scratch.allocate<cl_int>(pruned.elements);
  const auto band = scratch.allocate<cl_int>(level.regions);
  runtime.fill(band, level.regions, cl_int{0});
  runtime.map("prune", "path_bands", paths.size, paths.regions, paths.places, level.axis, level.cut, band);
  runtime.map("prune", "prune_points", (level.points + kBucket - 1) / kBucket,
              static_cast<cl_int>(level.points), cl_int{keep_on}, work.bounds.hull, level.point_regions,
              level.x_list, level.y_list, level.axis, level.cut, table.points, band, paths.offsets,
              paths.vertices, paths.places, ids, chord, pruned.flags);
  runtime.map("prune", "prune_corners", level.corners, static_cast<cl_int>(level.points), work.bounds.hull,
              level.corner_regions, level.corner_ids, level.axis, level.cut, table.points, band,
              paths.offsets, paths.vertices, paths.places, ids, chord, pruned.flags);
  const auto list = pack_undecided(work, pruned.flags, pruned.elements);
  run_list(work, "quickhull", "hull_depth_exact", list, cl_int{keep_on}, cl_int{0}, ids, chord,
           paths.vertices, paths.regions, level.axis, level.cut, table.points, pruned.flags);
}

namespace {

// Chord paths over all of a level's internal points and ends, good enough to prune by: quickhull of one
// candidate a bucket, which themselves have been pruned the same way while there are many of them.
Paths chord_paths(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  host::Runtime& runtime = work.runtime;
  const auto flags = work.scratch().allocate<cl_uchar>(level.points);
  runtime.map("prune", "candidate_flags", (level.points + kBucket - 1) / kBucket,
              static_cast<cl_int>(level.points), level.point_regions, level.x_list, level.y_list, level.axis,
              level.cut, table.points, flags);
  HullPoints candidates = gather(work, table, level, flags, level.points);
  statistics.candidates += candidates.size;
  if (candidates.size > kManyCandidates * level.regions) {
    Level thin = level;
    thin.points = candidates.size;
    thin.corners = 0;
    thin.x_list = thin.y_list = candidates.ids;
    thin.point_regions = work.scratch().allocate<cl_int>(candidates.size);
    thin.point_offsets = work.scratch().allocate<cl_int>(level.regions + 1);
    runtime.map("prune", "thin_regions", candidates.size, candidates.segments, thin.point_regions);
    const std::size_t group = runtime.tuning().map_group;
    runtime.launch("prune", "thin_offsets", level.regions + 1, group, static_cast<cl_int>(level.regions),
                   candidates.first, thin.point_offsets);
    const Pruned pruned = allocate_pruned(work, thin);
    {
      Arena::Scope scope(work.scratch());
      prune(work, table, thin, chord_paths(work, table, thin, statistics), false, pruned);
    }
    candidates = gather(work, table, thin, pruned.flags, thin.points);
  }
  int rounds = 0;
  const Paths paths = quickhull(work, table, level, candidates, rounds);
  statistics.candidate_rounds += rounds;
  return paths;
}

}  // namespace

Paths hulls(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  const Pruned pruned = allocate_pruned(work, level);
  {
    Arena::Scope scope(work.scratch());
    prune(work, table, level, chord_paths(work, table, level, statistics), false, pruned);
  }
  const HullPoints survivors = gather(work, table, level, pruned.flags, pruned.elements);
  statistics.survivors = survivors.size;
  Paths paths = strict(work, table, level, quickhull(work, table, level, survivors, statistics.hull_rounds));
  paths.flags = pruned.flags;
  return paths;
}

}  // namespace flaunay::flattened
