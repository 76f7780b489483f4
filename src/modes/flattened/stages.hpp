// The stages of mode flattened and the data between them. Each stage is one file with the name of its kernel
// file. levels.cpp runs the stages level by level; hulls.cpp runs those that compute the dividing paths.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/magnitudes.hpp"
#include "host/launch/vector_operations.hpp"
#include "host/runtime.hpp"
#include "launchers/flattened/merge.cl.hpp"
#include "launchers/flattened/prune.cl.hpp"
#include "launchers/flattened/quickhull.cl.hpp"
#include "modes/flattened/counting.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::flattened {

using host::Arena;
using host::Buffer;

/// The runtime, arenas and options that every stage uses.
struct Workspace {
  host::Runtime& runtime;
  Arena& persistent;                                 ///< arrays that live as long as the call
  std::vector<statistics::LevelStatistics>& levels;  ///< the statistics of this call's levels
  /// The arena for the regions that a step makes. Before they are made, it holds the points for quickhull.
  Arena* children = nullptr;
  /// Hull::monotone_chain: prunes and makes chains, without rounds.
  statistics::Hull hull = statistics::Hull::monotone_chain;
  geometry::Bounds bounds{};
  /// Bits set by kernels on a broken invariant; see check_invariants.
  Buffer<cl_int> broken{};
  /// The length of the current list of undecided predicates, on the device.
  Buffer<cl_uint> list_length{};
  /// The sum of the lengths of all such lists.
  Buffer<cl_uint> undecided{};
  /// The number of internal points of each level's largest region; kMostLevels values.
  Buffer<cl_int> largest{};

  /// Null without Options::count.
  Counting* counting = nullptr;

  Arena& scratch() { return runtime.arena(); }
  void add_depth(statistics::Component component, std::uint64_t operations) {
    if (counting != nullptr) counting->add_depth(component, operations);
  }
};

/// The distinct points by id. The id of a point is its rank in the order of (set, x, y).
struct PointTable {
  std::size_t input_count = 0;
  std::size_t count = 0;
  std::size_t sets = 0;
  Buffer<cl_double2> points{};
  Buffer<cl_int> source{};  ///< index of the input point of each id
  Buffer<cl_int> set_of_id{};
  Buffer<cl_int> set_offsets{};  ///< sets + 1 ids
  Buffer<cl_int> y_order{};      ///< ids in the order of (set, y, x)
  Buffer<cl_uchar> side{};       ///< the side to which an internal point goes; SIDE_BORDER for other points
};

/// The regions of one level. Points and corners are grouped by region.
struct Level {
  std::size_t regions = 0;
  std::size_t points = 0;
  std::size_t corners = 0;
  Buffer<cl_int> x_list{}, y_list{};  ///< internal points of each region, in the orders of x and of y
  Buffer<cl_int> point_regions{};     ///< the region of each place in these lists
  Buffer<cl_int> point_offsets{};     ///< regions + 1
  Buffer<cl_int> corner_ids{};        ///< 3 per corner: before, vertex, after
  Buffer<cl_int> corner_regions{};
  Buffer<cl_int> corner_offsets{};  ///< regions + 1
  /// Regions are so small that a work-item makes a region's path from all of its points: without ends and
  /// projections.
  bool is_small = false;
  Buffer<cl_int> axis{};
  Buffer<cl_double> cut{};
  /// The projections of internal points, in the order of the list that is sorted along the region's cut line.
  Buffer<cl_double2> projections{};
  Buffer<cl_int> first_end{}, last_end{};  ///< ends of each region's hull

  operator kernels::lists() const { return {.x_list = x_list, .y_list = y_list}; }
  kernels::cuts cuts(const PointTable& table) const {
    return {.axis = axis, .cut = cut, .points = table.points};
  }
};
/// Memory for a level's lists and corners.
Level allocate_level(Arena& arena, std::size_t regions, std::size_t points, std::size_t corners);

/// Regions without internal points.
struct RetiredRegions {
  std::size_t regions = 0;
  std::size_t corners = 0;
  Buffer<cl_int> corner_ids{};
  Buffer<cl_int> offsets{};  ///< regions + 1
};

/// The dividing path of every region: the vertices of its hull in the order of u.
struct Paths {
  std::size_t size = 0;  ///< there are no more vertices; their number is the last of `offsets`
  Buffer<cl_int> vertices{};
  Buffer<cl_double2> projections{};  ///< (h, u); see kernels/flattened/hull_height.h
  Buffer<cl_int> regions{};
  Buffer<cl_int> offsets{};  ///< regions + 1
  /// The flags that prune gave to internal points and corners, in small regions to corners alone; those with
  /// flag 0 are not on the path.
  Buffer<cl_uchar> flags{};

  operator kernels::paths() const {
    return {.path_offsets = offsets, .path = vertices, .path_projections = projections};
  }
  operator kernels::path_vertices() const {
    return {.path = vertices, .path_projections = projections, .path_region = regions};
  }
  operator kernels::new_path_vertices() const {
    return {.new_path = vertices, .new_projections = projections, .new_region = regions};
  }
};
/// Allocates paths of `size` vertices in all, without offsets.
Paths allocate_paths(Arena& arena, std::size_t size);
/// Copies the vertices, without offsets.
void copy_paths(Workspace& work, const Paths& from, const Paths& to);

/// The convex hulls of all sets, and the numbers that the host needs about them.
struct Borders {
  std::size_t size = 0;
  Buffer<cl_int> hull{};  ///< ids, set by set
  std::vector<std::size_t> hull_offsets;
  std::size_t triangles = 0;    ///< number of triangles that all sets will have
  std::size_t largest_set = 0;  ///< distinct points of the largest set
};

/// Checks, scales and sorts the points, and numbers the distinct ones. representatives: host memory for one
/// index per input point. Throws Error(input) for points that are not finite or whose magnitudes differ too
/// much.
PointTable ingest(Workspace& work, const double* coordinates, const std::vector<std::size_t>& offsets,
                  std::int32_t* representatives);

/// Computes the convex hulls and the regions of level 0. Sets without internal points retire at once.
Borders initial_borders(Workspace& work, PointTable& table, Level& level, RetiredRegions& retired);

/// Every level halves the largest number of internal points.
constexpr std::size_t kMostLevels = 32;

/// Chooses the cuts of the level at this depth. alternate_axis: 0 or 1, or -1 for the interquartile rule.
void cut(Workspace& work, const PointTable& table, Level& level, int depth, int alternate_axis);

/// Computes the projections of a level's internal points.
void project(Workspace& work, const PointTable& table, Level& level);

/// Computes the strict hulls of a level's regions by the variant Workspace::hull. Needs the ends of the hulls
/// and the level's projections.
Paths hulls(Workspace& work, const PointTable& table, const Level& level,
            statistics::LevelStatistics& statistics);

struct HullPoints;
/// Flags one candidate for the hull in each bucket of internal points.
Buffer<cl_uchar> candidates(Workspace& work, const Level& level);
/// Collects the flagged elements below the chord of their region's ends, by region, in `arena`. Elements are
/// the internal points, and behind them the corners; elements: level.points, or that plus level.corners.
/// Waits once.
HullPoints gather(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  std::size_t elements, Arena& arena);
/// Makes a level that has these points as its internal points, and no corners.
Level level_of(Workspace& work, const Level& level, const HullPoints& points);

/// The results of prune per element. Elements are the internal points, followed by the corners. Flag 0: not
/// on the hull; 1: perhaps on the hull; FLAG_ON_PATH: a vertex of the path.
struct Pruned {
  std::size_t elements = 0;
  Buffer<cl_uchar> flags{};
  /// For elements that are kept: the path vertex at which the chord above them begins, and their
  /// depth below that chord, which is not written if points on the paths are kept.
  Buffer<cl_int> chord{};
  Buffer<cl_double> depth{};
};
Pruned allocate_pruned(Workspace& work, const Level& level, const Buffer<cl_uchar>& flags);
/// Compares all elements with the paths, and flags those below them. keep_on: also flags those on the paths.
void prune(Workspace& work, const PointTable& table, const Level& level, const Paths& paths, bool keep_on,
           const Pruned& pruned);

/// Flags the elements of a level that may be on the hulls, including all elements below the paths: 0 or 1, or
/// FLAG_ON_PATH. band: the bands of the paths' chords.
void prune_roughly(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                   const Buffer<cl_double>& band, const Buffer<cl_uchar>& flags);

/// Points of each region in the order of u. Points with equal u are in any order, and points may be repeated.
struct Sequences {
  std::size_t room = 0;     ///< no more points than that
  Buffer<cl_int> begins{};  ///< regions + 1
  Buffer<cl_int> ids{};
  Buffer<cl_double2> projections{};
};
Sequences allocate_sequences(Arena& arena, std::size_t regions, std::size_t room);
/// Replaces sequences by their strict lower hulls. group: work-items that share a region. sizes: of the
/// hulls.
void chain_hulls(Workspace& work, const PointTable& table, const Level& level, const Sequences& sequences,
                 std::size_t group, const Buffer<cl_uint>& sizes);
/// Computes the strict hulls of a level's regions without rounds; see chains.cl. flags: prune's decisions
/// about all points and corners. Waits once.
Paths chain_paths(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  statistics::LevelStatistics& statistics);

/// Computes the strict hulls of a level's regions, a work-item each, without ends and projections. Waits
/// once.
Paths lone_paths(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                 statistics::LevelStatistics& statistics);

/// Decides exactly the elements, of `count`, whose flag is FLAG_UNDECIDED. Element i is point ids[i], which
/// is compared with the chord that begins at path vertex chord[i]. keep_on: also keeps points on the chord.
void decide_depths(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                   const Buffer<cl_int>& ids, const Buffer<cl_int>& chord, std::size_t count, bool keep_on,
                   const Buffer<cl_uchar>& flags);
/// Decides exactly those path vertices whose flag is FLAG_UNDECIDED. A vertex is compared with the chord
/// between its neighbours.
void decide_vertices(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                     const Buffer<cl_uchar>& flags);

/// The input of quickhull: a path per region, which has at least its two ends, and points grouped by segment.
/// Segment v has the points below the chord from path vertex v to the next vertex.
struct HullPoints {
  std::size_t size = 0;
  Buffer<cl_int> ids{}, segments{};
  Buffer<cl_double2> projections{};  ///< (h, u)
  Buffer<cl_double> depths{};        ///< depths below the chords, if known; then all points are below them
  Paths ends{};                      ///< the paths; their offsets are not needed
  Buffer<cl_int> first{};            ///< segments + 1: where the points of each segment begin

  operator kernels::hull_points() const {
    return {.ids = ids, .segment = segments, .projections = projections};
  }
  operator kernels::new_hull_points() const {
    return {.new_ids = ids, .new_segment = segments, .new_projections = projections};
  }
};
/// Allocates memory for `size` points, without depths, and for paths of `vertices` vertices in all.
HullPoints allocate_hull_points(Arena& arena, std::size_t size, std::size_t vertices);
/// Collects the elements that prune kept, and copies the paths, for quickhull; into `arena`. Waits once.
HullPoints gather_below(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                        const Pruned& pruned, Arena& arena);
Paths quickhull(Workspace& work, const PointTable& table, const Level& level, const HullPoints& points,
                int& rounds);
/// Removes vertices that are not strictly below the segment between their neighbours, until all are below it.
Paths strict(Workspace& work, const PointTable& table, const Level& level, Paths paths);

/// Merges paths with borders and splits the points. Computes the regions of the next level, and those that
/// retire.
void merge(Workspace& work, PointTable& table, const Level& level, const Paths& paths, Level& next,
           RetiredRegions& retired);

/// The children of a level's regions: the number of each child in the next level (or -1 - its number among
/// the retired regions), and where its corners begin.
struct Children {
  Buffer<cl_int> region{}, base{};

  kernels::children list(const Level& next, const RetiredRegions& retired) const {
    return {.child_region = region,
            .child_base = base,
            .corners = next.corner_ids,
            .corner_region = next.corner_regions,
            .retired = retired.corner_ids};
  }
};
/// Prefix sums of the elements that regions give to their children: internal points per region, corners that
/// come from corners, and corners that come from path vertices that were internal points.
struct ChildCounts {
  Buffer<cl_uint2> points_before, corner_sides;
  Buffer<cl_uint> internal;
};
/// Allocates two children per region. Waits once.
Children place_children(Workspace& work, const Level& level, const Paths& paths, const ChildCounts& counts,
                        Level& next, RetiredRegions& retired);
/// Allocates one child per set, with the given numbers of internal points and corners. Waits once.
Children place_sets(Workspace& work, std::size_t sets, const Buffer<cl_int>& points,
                    const Buffer<cl_int>& corners, Level& next, RetiredRegions& retired);

/// The state of splitting a level's lists.
struct ListSplit {
  std::size_t points = 0, chunk = 0, chunks = 0;
  Buffer<cl_uint2> chunk_counts{};   ///< points before each chunk of the current list that go left and right
  Buffer<cl_uint2> points_before{};  ///< points before each region that go left and right
};
/// Decides to which side each internal point goes, and counts these points.
ListSplit begin_split(Workspace& work, const PointTable& table, const Level& level);
/// Writes the children's lists.
void split_lists(Workspace& work, const PointTable& table, const Level& level, const ListSplit& split,
                 const Children& children, const Level& next);
/// Makes a list of the first level, and the regions of its points, from the internal points in a list of all
/// ids.
void first_list(Workspace& work, const PointTable& table, const Buffer<cl_int>& list,
                const Children& children, const Buffer<cl_int>& new_list, const Buffer<cl_int>& new_regions);

/// Triangulates retired regions and writes their triangles to triangles[base...]. Returns their number.
std::size_t endgame(Workspace& work, const PointTable& table, const RetiredRegions& retired,
                    const Buffer<cl_int>& triangles, std::size_t base);

/// Triangulates regions that are too large for one work-item; see strips.cl.
void strips(Workspace& work, const PointTable& table, const RetiredRegions& retired,
            const Buffer<cl_int>& large, std::size_t large_count, const Buffer<cl_uint>& counts);

/// Finds the twins of all half-edges; see neighbors.cl.
void match_edges(Workspace& work, const Buffer<cl_int>& triangles, std::size_t count,
                 const Buffer<cl_int>& twins);

/// Finds the twins of the half-edges that have none. Returns whether the points beside one of their edges are
/// cocircular. Waits twice.
bool match_loose_edges(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                       std::size_t count, const Buffer<cl_int>& twins);

/// Whether the points beside one of the listed half-edges are cocircular. Waits once.
bool any_cocircular(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                    const Buffer<cl_int>& twins, const Buffer<cl_int>& list, std::size_t listed);

/// Replaces the triangles of cocircular points by the canonical ones, and updates the twins.
void canonicalize(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                  std::size_t count, const Buffer<cl_int>& twins);

/// Sorts triangles, and twins unless they have no memory, by sets. Returns sets + 1 offsets: where the
/// triangles of each set begin.
std::vector<std::size_t> order_by_sets(Workspace& work, const PointTable& table,
                                       const Buffer<cl_int>& triangles, const Buffer<cl_int>& twins,
                                       std::size_t count);
/// Memory for an array of the result. On a device that works in host memory it is that array, otherwise it
/// comes from the arena.
Buffer<cl_int> result_memory(Workspace& work, Arena& arena, std::vector<std::int32_t>& values,
                             std::size_t size);
/// Copies triangles and, if the options ask for them, neighbours and half-edges to the result; or changes
/// them in place if they are in its arrays.
void read_rows(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
               const Buffer<cl_int>& twins, std::size_t count, const Options& options, Triangulation& result);
/// Converts ids to indices of input points and copies them to the host.
std::vector<std::int32_t> read_indices(Workspace& work, const PointTable& table, const Buffer<cl_int>& ids,
                                       std::size_t count);

/// The size of work-groups that take one region of about this many elements each. 1 on devices where a
/// work-item walks a chunk.
std::size_t region_group(const Workspace& work, std::size_t elements);

/// Lists the elements with FLAG_UNDECIDED. The length of the list stays on the device, and is added to
/// Workspace::undecided.
Buffer<cl_int> pack_undecided(Workspace& work, const Buffer<cl_uchar>& flags, std::size_t n);

/// Launches a kernel with a fixed number of work-items, which share a list whose length is on the device.
template <typename Kernel>
void run_list(Workspace& work, const Kernel& kernel) {
  work.runtime.launch(tuning_of(work.runtime).list_workers, work.runtime.sizes().chunk_group, kernel);
}

/// Copies the first `count` elements to the host. Waits once.
template <typename T>
std::vector<T> read_all(Workspace& work, const Buffer<T>& from, std::size_t count) {
  std::vector<T> values(count);
  work.runtime.read(from, 0, count, values.data());
  return values;
}

/// Throws Error(internal) if a kernel detected a broken invariant.
void check_invariants(Workspace& work);

}  // namespace flaunay::flattened
