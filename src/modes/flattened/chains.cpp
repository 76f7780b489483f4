#include <algorithm>
#include <utility>
#include <vector>

#include "flattened/codes.h"
#include "flattened/limits.h"
#include "launchers/flattened/chains.cl.hpp"
#include "modes/flattened/stages.hpp"
#include "operations/limits.h"

namespace flaunay::flattened {
using namespace geometry;
using namespace statistics;

namespace {

// Kept corners of all regions, in the order of (region, u).
struct KeptCorners {
  std::size_t count = 0;
  Buffer<cl_int> ids{}, owners{};
  Buffer<cl_double2> projections{};

  operator kernels::corners_to_join() const {
    return {.corner_ids = ids, .corner_owners = owners, .corner_projections = projections};
  }
  operator kernels::new_corners() const {
    return {.new_ids = ids, .new_owners = owners, .new_projections = projections};
  }
};

// The elements of a level that prune kept. Their counts stay on the device.
struct Kept {
  Buffer<cl_int> positions{};
  Buffer<cl_int2> before{};  // regions + 1: of internal points and of corners, in the regions before
  Buffer<cl_int> facts{};    // see keep_bounds
};

// A path's vertices, and the bands of its chords.
struct ChordPaths {
  Paths paths;
  Buffer<cl_double> band{};
};

KeptCorners allocate_corners(Arena& arena, std::size_t count) {
  return {count, arena.allocate<cl_int>(count), arena.allocate<cl_int>(count),
          arena.allocate<cl_double2>(count)};
}

// A level that has one point for each BUCKET points of every region, in the order of the lists, and no
// corners.
Level thinned(Workspace& work, const Level& level, Arena& arena) {
  Level thin = level;
  thin.points = level.points / kernel::BUCKET + level.regions;
  thin.corners = 0;
  thin.x_list = thin.y_list = arena.allocate<cl_int>(thin.points);
  thin.point_regions = arena.allocate<cl_int>(thin.points);
  thin.point_offsets = arena.allocate<cl_int>(level.regions + 1);
  thin.projections = arena.allocate<cl_double2>(thin.points);
  work.runtime.note_elements(kernel::BUCKET);
  work.runtime.map(thin.points, kernels::thin_lists{.regions = level.regions,
                                                    .offsets = level.point_offsets,
                                                    .lists = level,
                                                    .projections = level.projections,
                                                    .axis = level.axis,
                                                    .first_end = level.first_end,
                                                    .thin_offsets = thin.point_offsets,
                                                    .thin_ids = thin.x_list,
                                                    .thin_regions = thin.point_regions,
                                                    .thin_projections = thin.projections});
  return thin;
}

Sequences sequences_of(Workspace& work, const PointTable& table, const Level& list, Arena& arena) {
  Sequences made = allocate_sequences(arena, list.regions, list.points + 2 * list.regions);
  work.runtime.map(list.points, kernels::sequence_of_lists{.offsets = list.point_offsets,
                                                           .list = list.x_list,
                                                           .regions = list.point_regions,
                                                           .list_projections = list.projections,
                                                           .first_end = list.first_end,
                                                           .last_end = list.last_end,
                                                           .cuts = list.cuts(table),
                                                           .begins = made.begins,
                                                           .ids = made.ids,
                                                           .projections = made.projections});
  return made;
}

// Prunes a level by paths.
Kept keep(Workspace& work, const PointTable& table, const Level& level, const ChordPaths& chords,
          const Buffer<cl_uchar>& flags, const Sequences& joined, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  const std::size_t elements = level.points + level.corners;
  prune_roughly(work, table, level, chords.paths, chords.band, flags);
  Kept kept;
  kept.positions = arena.allocate<cl_int>(elements);
  kept.before = arena.allocate<cl_int2>(level.regions + 1);
  kept.facts = arena.allocate<cl_int>(kernel::KEPT_FACTS);
  const auto count = arena.allocate<cl_uint>(1);
  host::pack_positions(runtime, flags, elements, 1, kept.positions, count);
  runtime.fill(kept.facts, kernel::KEPT_FACTS, cl_int{0});
  runtime.launch(level.regions + 1, runtime.sizes().map_group, level.regions,
                 kernels::keep_bounds{.points_count = level.points,
                                      .kept_count = count,
                                      .positions = kept.positions,
                                      .point_offsets = level.point_offsets,
                                      .corner_offsets = level.corner_offsets,
                                      .path_offsets = chords.paths.offsets,
                                      .before = kept.before,
                                      .begins = joined.begins,
                                      .facts = kept.facts});
  return kept;
}

// most: of a region.
KeptCorners sorted_corners(Workspace& work, const PointTable& table, const Level& level, const Kept& kept,
                           std::size_t count, std::size_t most, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  KeptCorners now = allocate_corners(arena, count);
  if (count == 0) return now;
  runtime.map(count, kernels::gather_kept_corners{.regions = level.regions,
                                                  .points_count = level.points,
                                                  .before = kept.before,
                                                  .positions = kept.positions,
                                                  .corner_regions = level.corner_regions,
                                                  .corners = level.corner_ids,
                                                  .cuts = level.cuts(table),
                                                  .new_corners = now});
  KeptCorners then = allocate_corners(arena, count);
  if (most <= kernel::COUNTED_CORNERS) {
    runtime.map(count, kernels::place_kept_corners{
                           .before = kept.before, .corners_to_join = now, .new_corners = then});
    return then;
  }
  for (std::size_t run = 1; run < count; run *= kernel::MERGED_RUNS) {
    runtime.map(count, kernels::merge_corner_runs{.run = run, .corners_to_join = now, .new_corners = then});
    std::swap(now, then);
  }
  return now;
}

void join(Workspace& work, const Level& level, const Paths& paths, const Kept& kept,
          const KeptCorners& corners, const Sequences& joined) {
  work.runtime.note_elements(1 + joined.room / tuning_of(work.runtime).list_workers);
  run_list(work, kernels::join_sequences{.regions_count = level.regions,
                                         .before = kept.before,
                                         .begins = joined.begins,
                                         .positions = kept.positions,
                                         .regions = level.point_regions,
                                         .lists = level,
                                         .point_projections = level.projections,
                                         .axis = level.axis,
                                         .paths = paths,
                                         .path_regions = paths.regions,
                                         .corners_to_join = corners,
                                         .ids = joined.ids,
                                         .projections = joined.projections});
}

// The hulls that sequences have become, at most `size` vertices in all, as paths in arena.
ChordPaths paths_of(Workspace& work, const Level& level, const Sequences& sequences,
                    const Buffer<cl_int>& offsets, std::size_t size, std::size_t group, Arena& arena) {
  ChordPaths made;
  made.paths = allocate_paths(arena, size);
  made.paths.offsets = offsets;
  made.band = arena.allocate<cl_double>(size);
  work.runtime.launch(level.regions * group, group,
                      kernels::write_paths{.regions = level.regions,
                                           .begins = sequences.begins,
                                           .offsets = offsets,
                                           .axis = level.axis,
                                           .ids = sequences.ids,
                                           .projections = sequences.projections,
                                           .new_path_vertices = made.paths,
                                           .band = made.band});
  return made;
}

// The hulls of sequences, which are lost. paths: receives them, in arena.
ChordPaths hulls_of(Workspace& work, const PointTable& table, const Level& level, const Sequences& sequences,
                    Arena& arena) {
  host::Runtime& runtime = work.runtime;
  const std::size_t regions = level.regions;
  const std::size_t group = region_group(work, sequences.room / regions);
  const auto offsets = arena.allocate<cl_int>(regions + 1);
  chain_hulls(work, table, level, sequences, group, offsets.as<cl_uint>());
  host::exclusive_scan(runtime, offsets.as<cl_uint>(), regions, offsets.as<cl_uint>());
  return paths_of(work, level, sequences, offsets, sequences.room, group, arena);
}

}  // namespace

Sequences allocate_sequences(Arena& arena, std::size_t regions, std::size_t room) {
  Sequences made;
  made.room = room;
  made.begins = arena.allocate<cl_int>(regions + 1);
  made.ids = arena.allocate<cl_int>(room);
  made.projections = arena.allocate<cl_double2>(room);
  return made;
}

void chain_hulls(Workspace& work, const PointTable& table, const Level& level, const Sequences& sequences,
                 std::size_t group, const Buffer<cl_uint>& sizes) {
  Arena::Scope scope(work.scratch());
  work.runtime.launch(
      level.regions * group, group,
      kernels::hull_chains{.regions = level.regions,
                           .bound = work.bounds.hull,
                           .begins = sequences.begins,
                           .cuts = level.cuts(table),
                           .ids = sequences.ids,
                           .projections = sequences.projections,
                           .other_ids = work.scratch().allocate<cl_int>(sequences.room),
                           .other_projections = work.scratch().allocate<cl_double2>(sequences.room),
                           .sizes = sizes,
                           .undecided = work.undecided});
}

Paths lone_paths(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                 LevelStatistics& statistics) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena& waiting = *work.children;
  Arena::Scope waiting_scope(waiting);
  const std::size_t room = level.points + level.corners;
  statistics.survivors = room;
  const Sequences sequences = allocate_sequences(waiting, level.regions, room);
  const auto offsets = scratch.allocate<cl_int>(level.regions + 1);
  {
    Arena::Scope scope(scratch);
    const KeptCorners sorted = allocate_corners(scratch, level.corners);
    runtime.map(level.regions, kernels::hulls_alone{.bound = work.bounds.hull,
                                                    .point_offsets = level.point_offsets,
                                                    .corner_offsets = level.corner_offsets,
                                                    .lists = level,
                                                    .corners = level.corner_ids,
                                                    .cuts = level.cuts(table),
                                                    .begins = sequences.begins,
                                                    .ids = sequences.ids,
                                                    .projections = sequences.projections,
                                                    .sorted_corners = sorted.ids,
                                                    .sorted_projections = sorted.projections,
                                                    .sizes = offsets.as<cl_uint>(),
                                                    .flags = flags,
                                                    .undecided = work.undecided});
  }
  host::exclusive_scan(runtime, offsets.as<cl_uint>(), level.regions, offsets.as<cl_uint>());
  return paths_of(work, level, sequences, offsets,
                  static_cast<std::size_t>(runtime.read_one(offsets, level.regions)), 1, scratch)
      .paths;
}

Paths chain_paths(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  LevelStatistics& statistics) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  // Until the next level is made, its arena holds temporary arrays of this one.
  Arena& waiting = *work.children;
  Arena::Scope waiting_scope(waiting);
  std::vector<Level> lists{level};
  do {
    lists.push_back(thinned(work, lists.back(), waiting));
    statistics.candidates += lists.back().points;
  } while (lists.back().points > kernel::MANY_CANDIDATES * level.regions);
  ChordPaths chords;
  {
    Arena::Scope scope(waiting);
    const Sequences between_ends = sequences_of(work, table, lists.back(), waiting);
    chords = hulls_of(work, table, level, between_ends, scratch);
  }
  for (std::size_t t = lists.size() - 2; t > 0; --t) {
    Arena::Scope scope(waiting);
    const Level& list = lists[t];
    const auto list_flags = waiting.allocate<cl_uchar>(list.points);
    const Sequences joined = allocate_sequences(waiting, level.regions, list.points + chords.paths.size);
    const Kept kept = keep(work, table, list, chords, list_flags, joined, waiting);
    join(work, list, chords.paths, kept, allocate_corners(waiting, 0), joined);
    chords = hulls_of(work, table, level, joined, scratch);
  }

  Sequences joined = allocate_sequences(waiting, level.regions, 0);
  const Kept kept = keep(work, table, level, chords, flags, joined, waiting);
  cl_int facts[kernel::KEPT_FACTS];
  runtime.read(kept.facts, 0, kernel::KEPT_FACTS, facts);
  joined.room = facts[kernel::KEPT_ALL];
  joined.ids = waiting.allocate<cl_int>(joined.room);
  joined.projections = waiting.allocate<cl_double2>(joined.room);
  statistics.survivors = joined.room;
  {
    Arena::Scope scope(scratch);
    const KeptCorners corners = sorted_corners(work, table, level, kept, facts[kernel::KEPT_CORNERS],
                                               facts[kernel::KEPT_CORNERS_MOST], scratch);
    join(work, level, chords.paths, kept, corners, joined);
  }
  return hulls_of(work, table, level, joined, scratch).paths;
}

}  // namespace flaunay::flattened
