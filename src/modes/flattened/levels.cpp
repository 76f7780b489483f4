#include "modes/flattened/levels.hpp"

#include <algorithm>
#include <utility>

namespace flaunay::flattened {
using namespace geometry;
using namespace statistics;

Recursion::Recursion(Workspace& work, PointTable& table, const research::Options& options,
                     std::array<Arena*, 2> arenas, double levels_end)
    : work_(work), table_(table), options_(options), arenas_(arenas), levels_end_(levels_end) {}

Borders Recursion::begin(std::vector<std::int32_t>& triangles) {
  work_.children = arenas_[0];
  scope_ = std::make_unique<Arena::Scope>(*work_.children);
  RetiredRegions retired;
  const Borders borders = initial_borders(work_, table_, level_, retired);
  internal_points_ = level_.points;
  // A median goes to the border, so that a region's children have at most half of its points each.
  largest_ = std::min(borders.largest_set, level_.points);
  triangles_ = result_memory(work_, work_.persistent, triangles, 3 * borders.triangles);
  done_ = endgame(work_, table_, retired, triangles_, 0);
  if (work_.counting != nullptr) work_.counting->end_step(-1);
  return borders;
}

// Without bounds for their corners, there may not be many on average.
bool Recursion::is_small(const Level& level, int depth) const {
  const std::size_t most = tuning_of(work_.runtime).hull_alone_most;
  return work_.hull == Hull::monotone_chain && largest_ >> depth <= most &&
         level.corners <= most * level.regions;
}

Level Recursion::step(const Level& level, int depth) {
  const double begin = work_.runtime.working_clock();
  Arena::Scope scope(work_.scratch());
  LevelStatistics statistics;
  statistics.regions = level.regions;
  statistics.internal_points = level.points;
  statistics.corners = level.corners;
  Level cut_level = level;
  cut_level.is_small = is_small(level, depth);
  cut(work_, table_, cut_level, depth, options_.cut == Cut::alternate ? depth % 2 : -1);
  project(work_, table_, cut_level);
  const Paths paths = hulls(work_, table_, cut_level, statistics);
  cl_int path_vertices = 0;
  const host::Runtime::Settled settled(work_.runtime);
  work_.runtime.read_later(paths.offsets, level.regions, 1, &path_vertices);
  Level children;
  RetiredRegions retired;
  merge(work_, table_, cut_level, paths, children, retired);
  statistics.path_vertices = static_cast<std::size_t>(path_vertices);
  done_ += endgame(work_, table_, retired, triangles_, done_);
  if (work_.counting != nullptr) work_.counting->end_step(depth);
  statistics.seconds = work_.runtime.working_clock() - begin;
  auto& levels = work_.levels;
  if (levels.size() <= static_cast<std::size_t>(depth)) levels.resize(depth + 1);
  add_part(levels[depth], statistics);
  return children;
}

void Recursion::report(int depth, double share) {
  if (options_.progress)
    options_.progress("levels", depth, kBordersMade + (levels_end_ - kBordersMade) * share);
}

double Recursion::share_without(std::size_t points_left) const {
  if (internal_points_ == 0) return 1;
  return 1 - static_cast<double>(points_left) / static_cast<double>(internal_points_);
}

void Recursion::flattened(int levels) {
  for (int depth = 0; depth < levels && level_.regions > 0; ++depth) {
    work_.children = arenas_[(depth + 1) % 2];
    auto scope = std::make_unique<Arena::Scope>(*work_.children);
    level_ = step(level_, depth);
    scope_ = std::move(scope);
    // A few levels end with most points left, so that their number tells more.
    report(depth, std::max(share_without(level_.points), static_cast<double>(depth + 1) / levels));
  }
}

int Recursion::levels_to(std::size_t internal_points) const {
  int levels = 0;
  while (internal_points << levels < largest_) ++levels;
  return levels;
}

void Recursion::recursive() {
  // One arena holds the regions from the first one down to the current one as a stack.
  work_.children = arenas_[0];
  recurse_each(level_, 0);
}

void Recursion::recurse(const Level& region, int depth) {
  Arena::Scope scope(*work_.children);
  const Level children = step(region, depth);
  finished_points_ += region.points - children.points;
  report(depth, share_without(internal_points_ - finished_points_));
  if (children.regions == 1) {
    recurse(children, depth + 1);
  } else if (children.regions > 1) {
    recurse_each(children, depth + 1);
  }
}

void Recursion::recurse_each(const Level& level, int depth) {
  host::Runtime& runtime = work_.runtime;
  const std::vector<cl_int> point_offsets = read_all(work_, level.point_offsets, level.regions + 1);
  const std::vector<cl_int> corner_offsets = read_all(work_, level.corner_offsets, level.regions + 1);
  for (std::size_t r = 0; r < level.regions; ++r) {
    Arena::Scope scope(*work_.children);
    const std::size_t first_point = point_offsets[r], first_corner = corner_offsets[r];
    const Level single = allocate_level(*work_.children, 1, point_offsets[r + 1] - first_point,
                                        corner_offsets[r + 1] - first_corner);
    runtime.copy(level.x_list, first_point, single.x_list, 0, single.points);
    runtime.copy(level.y_list, first_point, single.y_list, 0, single.points);
    runtime.copy(level.corner_ids, 3 * first_corner, single.corner_ids, 0, 3 * single.corners);
    runtime.fill(single.point_regions, single.points, cl_int{0});
    runtime.fill(single.corner_regions, single.corners, cl_int{0});
    const cl_int point_bounds[2] = {0, static_cast<cl_int>(single.points)};
    const cl_int corner_bounds[2] = {0, static_cast<cl_int>(single.corners)};
    runtime.write(single.point_offsets, 0, 2, point_bounds);
    runtime.write(single.corner_offsets, 0, 2, corner_bounds);
    recurse(single, depth);
  }
}

RegionArrays Recursion::read_regions() {
  RegionArrays regions;
  if (level_.regions == 0) return regions;
  regions.points = read_all(work_, level_.x_list, level_.points);
  regions.corners = read_all(work_, level_.corner_ids, 3 * level_.corners);
  regions.point_offsets = read_all(work_, level_.point_offsets, level_.regions + 1);
  regions.corner_offsets = read_all(work_, level_.corner_offsets, level_.regions + 1);
  return regions;
}

}  // namespace flaunay::flattened
