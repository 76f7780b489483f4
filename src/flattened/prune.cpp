#include "flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

constexpr std::size_t kBucket = 8;  // BUCKET in prune.cl

// Brings flagged internal points and corners together by region. elements: level.points, or with the corners.
HullPoints gather(Workspace& work, const Level& level, const Buffer<cl_uchar>& flags, std::size_t elements) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const auto points_count = static_cast<cl_int>(level.points);
  HullPoints points;
  const auto counts = scratch.allocate<cl_uint>(elements + 1);
  runtime.map("prune", "flag_counts", elements, flags, counts);
  host::exclusive_scan(runtime, counts, elements, counts);
  points.size = runtime.read_one(counts, elements);
  points.ids = scratch.allocate<cl_int>(points.size);
  points.segments = scratch.allocate<cl_int>(points.size);
  points.chord_a = scratch.allocate<cl_int>(level.regions);
  points.chord_b = scratch.allocate<cl_int>(level.regions);
  points.chord_region = scratch.allocate<cl_int>(level.regions);
  points.first = scratch.allocate<cl_int>(level.regions + 1);
  runtime.map("prune", "gather_points", elements, points_count, counts, level.point_regions, level.x_list,
              level.y_list, level.corner_regions, level.corner_ids, level.point_offsets, level.corner_offsets,
              level.axis, points.ids, points.segments);
  runtime.map("prune", "begin_segments", level.regions, points_count, static_cast<cl_int>(elements), counts,
              level.point_offsets, level.corner_offsets, level.first_end, level.last_end, points.chord_a,
              points.chord_b, points.chord_region, points.first);
  return points;
}

}  // namespace

Pruned prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Pruned pruned;
  pruned.elements = level.points + level.corners;
  pruned.flags = scratch.allocate<cl_uchar>(pruned.elements);
  Arena::Scope scope(scratch);
  const auto ids = scratch.allocate<cl_int>(pruned.elements);
  const auto chord = scratch.allocate<cl_int>(pruned.elements);
  runtime.map("prune", "prune_points", pruned.elements, static_cast<cl_int>(level.points), cl_int{keep_on},
              work.bounds.hull, level.point_regions, level.x_list, level.y_list, level.corner_regions,
              level.corner_ids, level.axis, level.cut, table.points, paths.offsets, paths.vertices, paths.u, ids,
              chord, pruned.flags);
  const auto list = pack_undecided(work, pruned.flags, pruned.elements);
  run_list(work, "quickhull", "hull_depth_exact", list, cl_int{keep_on}, cl_int{0}, cl_int{1}, ids, chord,
           paths.vertices, paths.vertices, paths.regions, level.axis, level.cut, table.points, pruned.flags);
  return pruned;
}

Paths hulls(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const auto flags = scratch.allocate<cl_uchar>(level.points);
  runtime.map("prune", "candidate_flags", (level.points + kBucket - 1) / kBucket, static_cast<cl_int>(level.points),
              level.point_regions, level.x_list, level.y_list, level.axis, level.cut, table.points, flags);
  const HullPoints candidates = gather(work, level, flags, level.points);
  statistics.candidates = candidates.size;
  const Paths chords = quickhull(work, table, level, candidates, statistics.candidate_rounds);

  const Pruned pruned = prune(work, table, level, chords, false);
  const HullPoints survivors = gather(work, level, pruned.flags, pruned.elements);
  statistics.survivors = survivors.size;
  return strict(work, table, level, quickhull(work, table, level, survivors, statistics.hull_rounds));
}

}  // namespace flaunay::flattened
