#include "launchers/flattened/merge.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

void merge(Workspace& work, PointTable& table, const Level& level, const Paths& paths, Level& next,
           RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);

  // At most three steps per corner.
  work.add_depth(Component::merge, log2_ceiling(paths.size) + 3 * (2 + kernel::ORIENT_OPERATIONS) +
                                       scan_depth(level.corners) + scan_depth(paths.size) +
                                       scan_depth(2 * level.regions));
  work.add_depth(Component::split, 1 + scan_depth(level.points));
  const auto places = scratch.allocate<cl_int>(level.corners);
  const auto codes = scratch.allocate<cl_uchar>(level.corners);
  runtime.map(level.corners, kernels::corner_codes{.points_count = level.is_small ? 0 : level.points,
                                                   .bound = work.bounds.orient,
                                                   .kept = paths.flags,
                                                   .corners = level.corner_ids,
                                                   .regions = level.corner_regions,
                                                   .cuts = level.cuts(table),
                                                   .paths = paths,
                                                   .places = places,
                                                   .codes = codes});
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, codes, level.corners);
    run_list(work, kernels::corner_codes_exact{.count = work.list_length,
                                               .list = list,
                                               .corners = level.corner_ids,
                                               .regions = level.corner_regions,
                                               .cuts = level.cuts(table),
                                               .paths = paths,
                                               .places = places,
                                               .codes = codes});
  }
  const auto corner_sides = scratch.allocate<cl_uint2>(level.corners + 1);
  runtime.map(level.corners, kernels::corner_counts{.codes = codes, .counts = corner_sides});
  host::exclusive_scan(runtime, corner_sides, level.corners, corner_sides);

  const auto internal = scratch.allocate<cl_uint>(paths.size + 1);
  runtime.map(paths.size,
              kernels::path_internal{
                  .regions = level.regions, .paths = paths, .side = table.side, .internal = internal});
  host::exclusive_scan(runtime, internal, paths.size, internal);
  const ListSplit split = begin_split(work, table, level);

  const Children child =
      place_children(work, level, paths, {split.points_before, corner_sides, internal}, next, retired);

  runtime.map(level.corners, kernels::emit_corners{.old_corners = level.corner_ids,
                                                   .regions = level.corner_regions,
                                                   .corner_offsets = level.corner_offsets,
                                                   .paths = paths,
                                                   .places = places,
                                                   .codes = codes,
                                                   .scanned = corner_sides,
                                                   .children = child.list(next, retired)});
  runtime.map(paths.size, kernels::emit_path{.paths = paths,
                                             .path_region = paths.regions,
                                             .internal = internal,
                                             .corner_offsets = level.corner_offsets,
                                             .scanned = corner_sides,
                                             .children = child.list(next, retired)});

  split_lists(work, table, level, split, child, next);
}

}  // namespace flaunay::flattened
