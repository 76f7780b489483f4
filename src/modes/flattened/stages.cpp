#include "modes/flattened/stages.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flattened/codes.h"

namespace flaunay::flattened {

std::size_t region_group(const Workspace& work, std::size_t elements) {
  const Tuning& tuning = tuning_of(work.runtime);
  if (tuning.tile_group == 0) return 1;
  std::size_t group = std::clamp<std::size_t>(tuning.chain_group_least, 1, tuning.tile_group);
  while (2 * group <= tuning.tile_group && 2 * group * tuning.chain_points <= elements) group *= 2;
  return group;
}

Level allocate_level(Arena& arena, std::size_t regions, std::size_t points, std::size_t corners) {
  Level level;
  level.regions = regions;
  level.points = points;
  level.corners = corners;
  level.x_list = arena.allocate<cl_int>(points);
  level.y_list = arena.allocate<cl_int>(points);
  level.point_regions = arena.allocate<cl_int>(points);
  level.point_offsets = arena.allocate<cl_int>(regions + 1);
  level.corner_ids = arena.allocate<cl_int>(3 * corners);
  level.corner_regions = arena.allocate<cl_int>(corners);
  level.corner_offsets = arena.allocate<cl_int>(regions + 1);
  return level;
}

Paths allocate_paths(Arena& arena, std::size_t size) {
  return {size, arena.allocate<cl_int>(size), arena.allocate<cl_double2>(size), arena.allocate<cl_int>(size)};
}

void copy_paths(Workspace& work, const Paths& from, const Paths& to) {
  work.runtime.copy(from.vertices, 0, to.vertices, 0, from.size);
  work.runtime.copy(from.projections, 0, to.projections, 0, from.size);
  work.runtime.copy(from.regions, 0, to.regions, 0, from.size);
}

HullPoints allocate_hull_points(Arena& arena, std::size_t size, std::size_t vertices) {
  HullPoints points;
  points.size = size;
  points.ids = arena.allocate<cl_int>(size);
  points.segments = arena.allocate<cl_int>(size);
  points.projections = arena.allocate<cl_double2>(size);
  points.ends = allocate_paths(arena, vertices);
  points.first = arena.allocate<cl_int>(vertices + 1);
  return points;
}

Buffer<cl_int> pack_undecided(Workspace& work, const Buffer<cl_uchar>& flags, std::size_t n) {
  const auto list = work.scratch().allocate<cl_int>(n);
  host::pack_positions(work.runtime, flags, n, kernel::FLAG_UNDECIDED, list, work.list_length);
  host::add_count(work.runtime, work.list_length, work.undecided);
  return list;
}

void check_invariants(Workspace& work) {
  const cl_int bits = work.runtime.read_one(work.broken, 0);
  if (bits == 0) return;
  std::string what;
  if (bits & kernel::BROKEN_PATH) what += " a point on a cut line is not on its path;";
  if (bits & kernel::BROKEN_BORDER) what += " a region's border does not enclose it;";
  if (bits & kernel::BROKEN_CIRCLE) what += " an edge is not Delaunay;";
  throw Error(ErrorKind::internal, fmt::format("broken invariant:{} please report the input", what));
}

}  // namespace flaunay::flattened
