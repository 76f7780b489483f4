// The stages of the flattened triangulator and what they hand to each other. Each stage is one function, in
// the file named as its kernel file; the level loop is in executions.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flattened/counting.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "host/vector_operations.hpp"
#include "input/magnitudes.hpp"

namespace flaunay::flattened {

using host::Arena;
using host::Buffer;

/// What every stage works with.
struct Workspace {
  host::Runtime& runtime;
  Arena& persistent;  ///< lives as long as the call
  Statistics& statistics;
  /// Of the regions that a step makes; before, of what waits for quickhull.
  Arena* children = nullptr;
  Hull hull = Hull::prune;
  Bounds bounds{};
  /// Bits set by kernels on a broken invariant; see check_invariants.
  Buffer<cl_int> broken{};
  /// Number of undecided predicates of the list at hand, on the device.
  Buffer<cl_uint> list_length{};
  /// Sum of list lengths.
  Buffer<cl_uint> undecided{};
  /// Internal points of each level's largest region; kMostLevels of them.
  Buffer<cl_int> largest{};

  /// Options::count; null otherwise.
  Counting* counting = nullptr;

  Arena& scratch() { return runtime.arena(); }
  void add_depth(Component component, std::uint64_t operations) {
    if (counting != nullptr) counting->add_depth(component, operations);
  }
};

/// Distinct points by id, the rank in (set, x, y).
struct PointTable {
  std::size_t input_count = 0;
  std::size_t count = 0;
  std::size_t sets = 0;
  Buffer<cl_double2> points{};
  Buffer<cl_int> source{};  ///< id to index of the input
  Buffer<cl_int> set_of_id{};
  Buffer<cl_int> set_offsets{};  ///< sets + 1 ids
  Buffer<cl_int> y_order{};      ///< ids by (set, y, x)
  Buffer<cl_uchar> side{};       ///< of internal points: where they go; SIDE_BORDER for all others
};

/// The regions of one level. Points and corners are grouped by region.
struct Level {
  std::size_t regions = 0;
  std::size_t points = 0;
  std::size_t corners = 0;
  Buffer<cl_int> x_list{}, y_list{};  ///< internal points of each region, in either order
  Buffer<cl_int> point_regions{};     ///< of both lists' places
  Buffer<cl_int> point_offsets{};     ///< regions + 1
  Buffer<cl_int> corner_ids{};        ///< 3 per corner: before, vertex, after
  Buffer<cl_int> corner_regions{};
  Buffer<cl_int> corner_offsets{};  ///< regions + 1
  Buffer<cl_int> axis{};
  Buffer<cl_double> cut{};
  /// Of internal points, in the places of the list that is sorted along their region's cut line.
  Buffer<cl_double2> projections{};
  Buffer<cl_int> first_end{}, last_end{};  ///< ends of each region's hull
};

/// Regions without internal points.
struct RetiredRegions {
  std::size_t regions = 0;
  std::size_t corners = 0;
  Buffer<cl_int> corner_ids{};
  Buffer<cl_int> offsets{};  ///< regions + 1
};

/// Every region's path: the vertices of its hull in the order of u.
struct Paths {
  std::size_t size = 0;
  Buffer<cl_int> vertices{};
  Buffer<cl_double2> projections{};  ///< (h, u); see kernels/shared/hull_height.h
  Buffer<cl_int> regions{};
  Buffer<cl_int> offsets{};  ///< regions + 1
  /// Prune's flags of internal points and corners: 0 is not on the path.
  Buffer<cl_uchar> flags{};
};

/// The borders of all sets, and what the host must know of them.
struct Borders {
  std::size_t size = 0;
  Buffer<cl_int> hull{};  ///< ids, set by set
  std::vector<std::size_t> hull_offsets;
  std::size_t triangles = 0;  ///< that all sets together will have
};

/// Checks, scales, sorts and renumbers. representatives: host memory for one index per input point.
/// Throws Error(input) for points that are not finite or beyond the range of magnitudes.
PointTable ingest(Workspace& work, const double* coordinates, const std::vector<std::size_t>& offsets,
                  std::int32_t* representatives);

/// The convex hulls, and the regions of level 0; sets without internal points retire at once.
Borders initial_borders(Workspace& work, PointTable& table, Level& level, RetiredRegions& retired);

/// Every level halves the largest number of internal points.
constexpr std::size_t kMostLevels = 32;

/// Chooses the cuts of a level, the depth-th. alternate_axis: 0 or 1, or -1 for the interquartile rule.
void cut(Workspace& work, const PointTable& table, Level& level, int depth, int alternate_axis);

/// Gives the level its projections.
void project(Workspace& work, const PointTable& table, Level& level);

/// The strict hulls of a level's regions, whose ends are known: prune (or not: Workspace::hull), quickhull,
/// clean-up.
/// Needs the level's projections.
Paths hulls(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics);

/// What prune says of internal points, and behind them of corners: 0 not on the hull, 1 perhaps, 3 a vertex
/// of the path.
struct Pruned {
  std::size_t elements = 0;
  Buffer<cl_uchar> flags{};
  /// Of what is kept: the path vertex whose chord it is below, and the depth below it.
  Buffer<cl_int> chord{};
  Buffer<cl_double> depth{};
};
Pruned allocate_pruned(Workspace& work, const Level& level);
/// Holds all elements against paths; keep_on also keeps what lies on them.
void prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on,
           const Pruned& pruned);

/// What quickhull starts from: a path for each region, of its two ends at least, and points grouped by
/// segment, segment v being below the chord from path vertex v to the next.
struct HullPoints {
  std::size_t size = 0;
  Buffer<cl_int> ids{}, segments{};
  Buffer<cl_double2> projections{};  ///< (h, u)
  Buffer<cl_double> depths{};        ///< below their chords, which they all are, if that is known
  Paths ends{};                      ///< no offsets needed
  Buffer<cl_int> first{};            ///< where each segment's points begin, closed by their number
};
Paths quickhull(Workspace& work, const PointTable& table, const Level& level, const HullPoints& points,
                int& rounds);
/// Drops vertices that are not strictly below the segment of their neighbours, until there are none.
Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths);

/// Border merge and split: the next level's regions, and those that retire.
void merge(Workspace& work, PointTable& table, const Level& level, const Paths& paths, Level& next,
           RetiredRegions& retired);

/// Lays out children from their scanned sizes; used by merge and initial_borders.
struct Children {
  Buffer<cl_int> region{}, base{};
};
Children place_children(Workspace& work, const Buffer<cl_uint8>& sizes, std::size_t children, Level& next,
                        RetiredRegions& retired);

/// Triangulates retired regions; their triangles go to triangles[base...]. Returns how many.
std::size_t endgame(Workspace& work, const PointTable& table, const RetiredRegions& retired,
                    const Buffer<cl_int>& triangles, std::size_t base);

/// The triangles of regions too large for one work-item; see strips.cl.
void strips(Workspace& work, const PointTable& table, const RetiredRegions& retired,
            const Buffer<cl_int>& large, std::size_t large_count, const Buffer<cl_uint>& counts);

/// Twins of all half-edges; see neighbors.cl.
void match_edges(Workspace& work, const Buffer<cl_int>& triangles, std::size_t count,
                 const Buffer<cl_int>& twins);

/// Makes triangles canonical, and their twins with them.
void canonicalize(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                  std::size_t count, const Buffer<cl_int>& twins);

/// Packs the flags of value 2 into a list whose length stays on the device, and counts it as undecided.
Buffer<cl_int> pack_undecided(Workspace& work, const Buffer<cl_uchar>& flags, std::size_t n);

/// Launches a kernel that shares a list of device-side length among a fixed number of work-items.
template <typename... Arguments>
void run_list(Workspace& work, const char* file, const char* kernel, const Buffer<cl_int>& list,
              const Arguments&... arguments) {
  work.runtime.launch(file, kernel, work.runtime.tuning().list_workers, work.runtime.tuning().chunk_group,
                      work.list_length, list, arguments...);
}

/// The first count elements; one host wait.
template <typename T>
std::vector<T> read_all(Workspace& work, const Buffer<T>& from, std::size_t count) {
  std::vector<T> values(count);
  work.runtime.read(from, 0, count, values.data());
  return values;
}

/// Throws Error(internal) if a kernel found an invariant broken.
void check_invariants(Workspace& work);

}  // namespace flaunay::flattened
