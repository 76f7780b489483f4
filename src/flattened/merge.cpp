#include "flattened/stages.hpp"

namespace flaunay::flattened {

Children place_children(Workspace& work, const Buffer<cl_uint8>& sizes, std::size_t children, Level& next,
                        RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Children placed;
  host::exclusive_scan(runtime, sizes, children, sizes);
  const cl_uint8 total = runtime.read_one(sizes, children);
  next.regions = total.s[0];
  next.corners = total.s[1];
  next.points = total.s[2];
  retired.regions = total.s[3];
  retired.corners = total.s[4];
  Arena& state = *work.children;
  next.x_list = state.allocate<cl_int>(next.points);
  next.y_list = state.allocate<cl_int>(next.points);
  next.point_regions = state.allocate<cl_int>(next.points);
  next.point_offsets = state.allocate<cl_int>(next.regions + 1);
  next.corner_ids = state.allocate<cl_int>(3 * next.corners);
  next.corner_regions = state.allocate<cl_int>(next.corners);
  next.corner_offsets = state.allocate<cl_int>(next.regions + 1);
  retired.corner_ids = state.allocate<cl_int>(3 * retired.corners);
  retired.offsets = state.allocate<cl_int>(retired.regions + 1);
  placed.region = scratch.allocate<cl_int>(children);
  placed.base = scratch.allocate<cl_int>(children);
  runtime.map("merge", "child_places", children, sizes, placed.region, placed.base, next.point_offsets,
              next.corner_offsets, retired.offsets);
  return placed;
}

void merge(Workspace& work, PointTable& table, const Level& level, const Paths& paths, Level& next,
           RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);

  // A corner takes three turns at most.
  work.add_depth(Component::merge, log2_ceiling(paths.size) + 3 * (2 + kOrientOperations) +
                                       scan_depth(level.corners) + scan_depth(paths.size) +
                                       scan_depth(2 * level.regions));
  work.add_depth(Component::split, 1 + scan_depth(level.points));
  const auto places = scratch.allocate<cl_int>(level.corners);
  const auto codes = scratch.allocate<cl_uchar>(level.corners);
  runtime.map("merge", "corner_codes", level.corners, static_cast<cl_int>(level.points), work.bounds.orient,
              paths.flags, level.corner_ids, level.corner_regions, level.axis, level.cut, table.points,
              paths.offsets, paths.vertices, paths.projections, places, codes);
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, codes, level.corners);
    run_list(work, "merge", "corner_codes_exact", list, level.corner_ids, level.corner_regions, level.axis,
             level.cut, table.points, paths.offsets, paths.vertices, places, codes);
  }
  const auto corner_sides = scratch.allocate<cl_uint2>(level.corners + 1);
  runtime.map("merge", "corner_counts", level.corners, codes, corner_sides);
  host::exclusive_scan(runtime, corner_sides, level.corners, corner_sides);

  const auto internal = scratch.allocate<cl_uint>(paths.size + 1);
  runtime.map("merge", "path_internal", paths.size, paths.vertices, table.side, internal);
  host::exclusive_scan(runtime, internal, paths.size, internal);
  runtime.map("lists", "point_sides", level.points, level.x_list, level.point_regions, level.axis, level.cut,
              table.points, table.side, work.broken);
  const std::size_t chunk = runtime.tuning().chunk(level.points);
  const std::size_t chunk_count = (level.points + chunk - 1) / chunk;
  const auto point_counts = scratch.allocate<cl_uint2>(chunk_count + 1);
  const auto points_before = scratch.allocate<cl_uint2>(level.regions + 1);
  runtime.chunks("lists", "list_counts", level.points, chunk, level.x_list, table.side, point_counts);
  host::exclusive_scan(runtime, point_counts, chunk_count, point_counts);
  runtime.chunks("lists", "list_bounds", level.points, chunk, static_cast<cl_int>(level.regions),
                 level.x_list, level.point_regions, table.side, point_counts, points_before);

  const std::size_t children = 2 * level.regions;
  const auto sizes = scratch.allocate<cl_uint8>(children + 1);
  runtime.map("merge", "child_sizes", level.regions, level.corner_offsets, paths.offsets, points_before,
              corner_sides, internal, sizes);
  const Children child = place_children(work, sizes, children, next, retired);

  runtime.map("merge", "emit_corners", level.corners, level.corner_ids, level.corner_regions,
              level.corner_offsets, paths.vertices, paths.offsets, places, codes, corner_sides, child.region,
              child.base, next.corner_ids, next.corner_regions, retired.corner_ids);
  runtime.map("merge", "emit_path", paths.size, paths.vertices, paths.regions, paths.offsets, internal,
              level.corner_offsets, corner_sides, child.region, child.base, next.corner_ids,
              next.corner_regions, retired.corner_ids);

  runtime.chunks("lists", "list_split", level.points, chunk, level.x_list, level.point_regions, table.side,
                 point_counts, points_before, child.region, next.x_list, next.point_regions);
  runtime.chunks("lists", "list_counts", level.points, chunk, level.y_list, table.side, point_counts);
  host::exclusive_scan(runtime, point_counts, chunk_count, point_counts);
  runtime.chunks("lists", "list_split", level.points, chunk, level.y_list, level.point_regions, table.side,
                 point_counts, points_before, child.region, next.y_list, next.point_regions);
}

}  // namespace flaunay::flattened
