#include "launchers/flattened/children.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Computes offsets from the sizes of the children; the last entry is their sum.
Children place(Workspace& work, const Buffer<cl_uint8>& sizes, std::size_t children, Level& next,
               RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Children placed;
  host::exclusive_scan(runtime, sizes, children, sizes);
  const cl_uint8 total = runtime.read_one(sizes, children);
  Arena& state = *work.children;
  next = allocate_level(state, total.s[0], total.s[2], total.s[1]);
  retired.regions = total.s[3];
  retired.corners = total.s[4];
  retired.corner_ids = state.allocate<cl_int>(3 * retired.corners);
  retired.offsets = state.allocate<cl_int>(retired.regions + 1);
  placed.region = scratch.allocate<cl_int>(children);
  placed.base = scratch.allocate<cl_int>(children);
  runtime.map(children, kernels::child_places{.scanned = sizes,
                                              .child_region = placed.region,
                                              .child_base = placed.base,
                                              .point_offsets = next.point_offsets,
                                              .corner_offsets = next.corner_offsets,
                                              .retired_offsets = retired.offsets});
  return placed;
}

}  // namespace

Children place_children(Workspace& work, const Level& level, const Paths& paths, const ChildCounts& counts,
                        Level& next, RetiredRegions& retired) {
  const std::size_t children = 2 * level.regions;
  const auto sizes = work.scratch().allocate<cl_uint8>(children + 1);
  work.runtime.map(level.regions, kernels::child_sizes{.corner_offsets = level.corner_offsets,
                                                       .path_offsets = paths.offsets,
                                                       .points_before = counts.points_before,
                                                       .corner_sides = counts.corner_sides,
                                                       .internal = counts.internal,
                                                       .sizes = sizes});
  return place(work, sizes, children, next, retired);
}

Children place_sets(Workspace& work, std::size_t sets, const Buffer<cl_int>& points,
                    const Buffer<cl_int>& corners, Level& next, RetiredRegions& retired) {
  const auto sizes = work.scratch().allocate<cl_uint8>(sets + 1);
  work.runtime.map(sets,
                   kernels::set_sizes{.child_points = points, .child_corners = corners, .sizes = sizes});
  return place(work, sizes, sets, next, retired);
}

}  // namespace flaunay::flattened
