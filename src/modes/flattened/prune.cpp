#include "flattened/limits.h"
#include "launchers/flattened/prune.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

Buffer<cl_uchar> candidates(Workspace& work, const Level& level) {
  const auto flags = work.scratch().allocate<cl_uchar>(level.points);
  work.runtime.map((level.points + kernel::BUCKET - 1) / kernel::BUCKET,
                   kernels::candidate_flags{.elements = level.points,
                                            .regions = level.point_regions,
                                            .projections = level.projections,
                                            .flags = flags});
  work.add_depth(Component::hull, log2_ceiling(kernel::BUCKET) + scan_depth(level.points));
  return flags;
}

HullPoints gather(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  std::size_t elements, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  const auto points_count = static_cast<cl_int>(level.points);
  const auto regions = static_cast<cl_int>(level.regions);
  const auto [positions, kept] = host::pack_positions(runtime, flags, elements, 1);
  const HullPoints points = allocate_hull_points(arena, kept, 2 * level.regions);
  const auto before = work.scratch().allocate<cl_int2>(level.regions + 1);
  const std::size_t group = runtime.sizes().map_group;
  runtime.launch(level.regions + 1, group, regions,
                 kernels::begin_paths{.points_count = points_count,
                                      .kept = kept,
                                      .positions = positions,
                                      .point_offsets = level.point_offsets,
                                      .corner_offsets = level.corner_offsets,
                                      .first_end = level.first_end,
                                      .last_end = level.last_end,
                                      .cuts = level.cuts(table),
                                      .new_path_vertices = points.ends,
                                      .first = points.first,
                                      .before = before});
  runtime.map(kept, kernels::gather_points{.points_count = points_count,
                                           .regions_count = regions,
                                           .positions = positions,
                                           .before = before,
                                           .regions = level.point_regions,
                                           .point_projections = level.projections,
                                           .lists = level,
                                           .corner_regions = level.corner_regions,
                                           .corners = level.corner_ids,
                                           .cuts = level.cuts(table),
                                           .new_hull_points = points});
  return points;
}

Pruned allocate_pruned(Workspace& work, const Level& level, const Buffer<cl_uchar>& flags) {
  const std::size_t elements = level.points + level.corners;
  return {elements, flags, work.scratch().allocate<cl_int>(elements),
          work.scratch().allocate<cl_double>(elements)};
}

namespace {

// rough: see prune_points; then `pruned` has flags alone.
void hold_against(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                  const Buffer<cl_double>& band, bool keep_on, bool rough, const Buffer<cl_int>& ids,
                  const Pruned& pruned) {
  host::Runtime& runtime = work.runtime;
  const kernels::candidates candidates{
      .ids = ids, .chord = pruned.chord, .depth = pruned.depth, .flags = pruned.flags};
  runtime.note_elements(kernel::BUCKET);
  runtime.map((level.points + kernel::BUCKET - 1) / kernel::BUCKET,
              kernels::prune_points{.elements = level.points,
                                    .keep_on = keep_on,
                                    .rough = rough,
                                    .bound = work.bounds.hull,
                                    .regions = level.point_regions,
                                    .lists = level,
                                    .projections = level.projections,
                                    .cuts = level.cuts(table),
                                    .band = band,
                                    .paths = paths,
                                    .candidates = candidates});
  runtime.map(level.corners, kernels::prune_corners{.points_count = level.points,
                                                    .rough = rough,
                                                    .bound = work.bounds.hull,
                                                    .corner_regions = level.corner_regions,
                                                    .corners = level.corner_ids,
                                                    .cuts = level.cuts(table),
                                                    .band = band,
                                                    .paths = paths,
                                                    .candidates = candidates});
}

}  // namespace

void prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on,
           const Pruned& pruned) {
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto ids = scratch.allocate<cl_int>(pruned.elements);
  const auto band = scratch.allocate<cl_double>(paths.size);
  work.runtime.map(paths.size, kernels::chord_bands{.regions = level.regions,
                                                    .paths = paths,
                                                    .path_region = paths.regions,
                                                    .axis = level.axis,
                                                    .band = band});
  hold_against(work, table, level, paths, band, keep_on, false, ids, pruned);
  // Operations one after the other: the bands, the projection of a corner, the searches of a run and of a
  // point in it, and three comparisons: with the band, of u, and which point is lower.
  work.add_depth(Component::hull, kernel::BAND_OPERATIONS + kernel::PROJECT_OPERATIONS + 2 +
                                      2 * log2_ceiling(paths.size) + 1 + 1 + kernel::LOWER_OPERATIONS +
                                      kernel::DEPTH_OPERATIONS + scan_depth(pruned.elements));
  decide_depths(work, table, level, paths, ids, pruned.chord, pruned.elements, keep_on, pruned.flags);
}

void prune_roughly(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                   const Buffer<cl_double>& band, const Buffer<cl_uchar>& flags) {
  const auto none = work.scratch().allocate<cl_int>(0);
  hold_against(work, table, level, paths, band, false, true, none,
               {level.points + level.corners, flags, none, work.scratch().allocate<cl_double>(0)});
}

HullPoints gather_below(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                        const Pruned& pruned, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const auto [positions, kept] = host::pack_positions(runtime, pruned.flags, pruned.elements, 1);
  HullPoints points = allocate_hull_points(arena, kept, paths.size);
  points.depths = arena.allocate<cl_double>(kept);
  copy_paths(work, paths, points.ends);
  {
    Arena::Scope scope(scratch);
    const auto keys = scratch.allocate<cl_ulong>(kept);
    runtime.map(kept, kernels::chord_keys{.positions = positions, .chord = pruned.chord, .keys = keys});
    host::sort_by_key(runtime, keys, positions, kept);
    work.add_depth(Component::hull, log2_ceiling(paths.size) * scan_depth(kept));
    runtime.map(kept, kernels::gather_below{.points_count = level.points,
                                            .keys = keys,
                                            .elements = positions,
                                            .path_region = paths.regions,
                                            .element_depth = pruned.depth,
                                            .point_projections = level.projections,
                                            .lists = level,
                                            .corners = level.corner_ids,
                                            .cuts = level.cuts(table),
                                            .new_hull_points = points,
                                            .depth = points.depths});
  }
  runtime.launch(paths.size + 1, runtime.sizes().map_group, paths.size,
                 kernels::chord_begins{.kept = kept, .segment = points.segments, .first = points.first});
  return points;
}

Level level_of(Workspace& work, const Level& level, const HullPoints& points) {
  Level thin = level;
  thin.points = points.size;
  thin.corners = 0;
  thin.x_list = thin.y_list = points.ids;
  thin.projections = points.projections;
  thin.point_regions = work.scratch().allocate<cl_int>(points.size);
  thin.point_offsets = work.scratch().allocate<cl_int>(level.regions + 1);
  work.runtime.map(points.size,
                   kernels::thin_regions{.segment = points.segments, .regions = thin.point_regions});
  const std::size_t group = work.runtime.sizes().map_group;
  work.runtime.launch(level.regions + 1, group, level.regions,
                      kernels::thin_offsets{.first = points.first, .offsets = thin.point_offsets});
  return thin;
}

}  // namespace flaunay::flattened
