// For research: the paper's algorithm in several variants, Dwyer's algorithm for comparison, and counts of
// their operations. Programs that only need triangles do not need this header.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

/// Other algorithms for the same triangles, and what they cost, for experiments.
namespace flaunay::research {

/// The algorithm that computes the triangulation. All modes give the same set of triangles. A library that
/// was built with FLAUNAY_RESEARCH=OFF has blocks alone, and refuses others and partitions by Error(usage).
enum class Mode {
  blocks,            ///< the default: each work-item triangulates a block of points, then blocks are merged
  flattened,         ///< the paper's algorithm on the device, all regions of a level at once
  recursive_device,  ///< the kernels of flattened, one region at a time, depth first
  recursive,         ///< the paper's algorithm as a plain recursion on the host, one thread
  partition,         ///< a few levels of flattened on the device, then Dwyer's algorithm on host threads
  dwyer,             ///< Dwyer's divide and conquer on the host, one thread
};

/// Which way each region is cut.
enum class Cut {
  interquartile,  ///< across the longer interquartile range of its internal points
  alternate,      ///< x and y in turn, as in the paper
};

/// How the dividing paths are computed. All variants give the same paths.
enum class Hull {
  prune,           ///< discard most points by candidates from buckets, then quickhull; on a device, unless
                   ///< operations are counted, chains (docs/architecture.md)
  quickhull,       ///< quickhull alone
  balanced,        ///< a few rounds of quickhull, then balanced splits (Chan, Snoeyink and Yap)
  monotone_chain,  ///< Andrew's scan over points sorted along the cut; Mode::recursive only
};

/// Where the levels of Mode::flattened end. The triangles are the same, in another order.
enum class Finish {
  blocks,  ///< when regions are as small as a block; each is then solved like a block of Mode::blocks
  levels,  ///< when no region has internal points left, as in the paper
};

/// The name on the command line: "recursive-device" and so on. The text is static.
FLAUNAY_API const char* to_string(Mode mode) noexcept;
/// The name on the command line: "iqr" or "alternate". The text is static.
FLAUNAY_API const char* to_string(Cut cut) noexcept;
/// The name on the command line: "monotone-chain" and so on. The text is static.
FLAUNAY_API const char* to_string(Hull hull) noexcept;
/// The name on the command line: "blocks" or "levels". The text is static.
FLAUNAY_API const char* to_string(Finish finish) noexcept;

/// The parts into which the paper divides the algorithm's work.
enum class Component {
  cut,      ///< choosing medians and axes; in Mode::dwyer, sorting and partitioning
  hull,     ///< computing dividing paths
  merge,    ///< merging paths with borders; in Mode::dwyer, merging triangulations
  split,    ///< moving points to either side of the path
  endgame,  ///< triangulating regions without internal points
};
/// The number of components.
constexpr std::size_t kComponents = 5;

/// The work of one component: numbers of operations by kind, and the length of its critical path in
/// operations. docs/counting.md defines what counts, and the depth of each vector operation.
struct OperationCounts {
  std::uint64_t arithmetic = 0;     ///< additions, multiplications and comparisons outside of predicates
  std::uint64_t depths = 0;         ///< evaluations of the depth below a chord
  std::uint64_t orientations = 0;   ///< evaluations of the orientation of three points
  std::uint64_t circles = 0;        ///< evaluations of the in-circle test
  std::uint64_t critical_path = 0;  ///< operations that have to be done one after the other

  /// Adds work that is done after this work, so critical paths are added as well.
  FLAUNAY_API OperationCounts& operator+=(const OperationCounts& other) noexcept;
  /// The total number of floating-point operations and comparisons. A predicate counts as the operations of
  /// its plain evaluation, without those of its error bound.
  FLAUNAY_API std::uint64_t operations() const noexcept;
  /// The total number of operations, including those of the predicates' error bounds.
  FLAUNAY_API std::uint64_t operations_with_bounds() const noexcept;
};

/// The work per component and level (Options::count). Level 0 is the first cut; in Mode::dwyer it is the last
/// merge.
struct Work {
  /// One value per Component.
  using Components = std::array<OperationCounts, kComponents>;
  Components start{};              ///< work before the first cut: sorting and the first hulls
  std::vector<Components> levels;  ///< work of each level
  /// endgame_sizes[k]: how many regions with k corners the end game triangulated. Regions of more than 1023
  /// corners count as regions of 1023. The last entry is not 0.
  std::vector<std::uint64_t> endgame_sizes;
};

/// One level of the recursion.
struct LevelStatistics {
  std::size_t regions = 0;          ///< regions cut at this level
  std::size_t internal_points = 0;  ///< internal points of these regions, in total
  std::size_t corners = 0;          ///< border corners of these regions, in total
  std::size_t largest_region = 0;   ///< internal points of the largest region
  std::size_t candidates = 0;       ///< candidates by which prune discards points
  std::size_t survivors = 0;        ///< points that prune leaves, of which the hulls are
  std::size_t path_vertices = 0;    ///< vertices of the dividing paths, in total
  int candidate_rounds = 0;         ///< rounds of quickhull on the candidates, if any
  int hull_rounds = 0;              ///< rounds of quickhull on the survivors, if any
  double seconds = 0;               ///< wall time
};

/// The record of a call's launches.
enum class Record {
  nothing,   ///< the default, which costs nothing
  launches,  ///< every launch: its kernel and work-items, and with Options::profile its time
  steps,     ///< kernels count their steps, too, which is slow
};

/// One launch of a call, which the calls' order says when.
struct LaunchStatistics {
  std::string kernel;          ///< the kernel's name; "fill" and "copy" are those of OpenCL
  std::size_t work_items = 0;  ///< without those that fill up the last work-group; 0 for fills and copies
  std::size_t group = 0;       ///< the work-group's size
  std::size_t busy = 0;        ///< the most work-items of a work-group that have work
  std::size_t elements = 0;    ///< the most elements that a work-item goes through
  std::size_t bytes = 0;       ///< bytes that a fill or a copy writes
  /// The most steps that one block, merge or walk takes, one after the other; 0 if the kernel does not count
  /// them. docs/counting.md defines them.
  std::uint32_t longest_chain = 0;
  std::uint64_t steps = 0;  ///< the steps of all work-items
  double seconds = 0;       ///< time on the device; 0 without Options::profile
};

/// The options of one triangulation, and how to compute it.
struct Options : flaunay::Options {
  Mode mode = Mode::blocks;         ///< decides the order of the triangles, but not which they are
  Cut cut = Cut::interquartile;     ///< ignored by Mode::blocks and Mode::dwyer
  Hull hull = Hull::prune;          ///< ignored by Mode::blocks and Mode::dwyer
  Finish finish = Finish::blocks;   ///< Mode::flattened; with `count` its levels go to the bottom anyway
  bool count = false;               ///< count operations into Triangulation::work; slow; not in Mode::blocks
  int partition_levels = 0;         ///< Mode::partition: number of levels on the device; 0: chosen by size
  int threads = 0;                  ///< Mode::partition: number of host threads; 0: one per core
  Record record = Record::nothing;  ///< fills Triangulation::launches; needs `count` to be false
};

/// A triangulation and what it cost. statistics.device is "host" in the modes that run on the host.
struct Triangulation : flaunay::Triangulation {
  std::vector<LevelStatistics> levels;     ///< one per level; empty in Mode::blocks and Mode::dwyer
  Work work;                               ///< empty without Options::count
  std::vector<LaunchStatistics> launches;  ///< empty without Options::record and in modes without a device
};

/// The facts about a mode that programs need to list modes and to check options.
struct ModeInfo {
  Mode mode;                ///< the mode
  const char* name;         ///< to_string(mode)
  const char* description;  ///< one line for users
  bool on_host;             ///< it needs no device, and works with triangulate_on_host
  bool cuts_regions;        ///< it uses Options::cut and Options::hull
  bool counts;              ///< it supports Options::count
};
/// All modes, the default first. O(1).
FLAUNAY_API const std::vector<ModeInfo>& list_modes();

/// Triangulates one set of points in host memory in any mode. coordinates: 2 n values, x0 y0 x1 y1 ... Throws
/// Error(usage) for options that the mode does not support, and what Triangulator::triangulate throws.
/// O(n log n) work.
FLAUNAY_API Triangulation triangulate(Triangulator& triangulator, const double* coordinates, std::size_t n,
                                      const Options& options);
/// Triangulates several sets: set s has points [offsets[s], offsets[s + 1]); see Triangulator::triangulate.
FLAUNAY_API Triangulation triangulate(Triangulator& triangulator, const double* coordinates,
                                      const std::vector<std::size_t>& offsets, const Options& options);
/// Triangulates one set of points in single precision. The result is that for the coordinates converted to
/// double.
FLAUNAY_API Triangulation triangulate(Triangulator& triangulator, const float* coordinates, std::size_t n,
                                      const Options& options);
/// Triangulates several sets of points in single precision.
FLAUNAY_API Triangulation triangulate(Triangulator& triangulator, const float* coordinates,
                                      const std::vector<std::size_t>& offsets, const Options& options);

/// Triangulates without a device, on the calling thread. options.mode must be Mode::recursive or Mode::dwyer;
/// any other mode is Error(usage). Points, offsets, result and the other errors are those of triangulate.
/// O(n log n) work.
FLAUNAY_API Triangulation triangulate_on_host(const double* coordinates,
                                              const std::vector<std::size_t>& offsets,
                                              const Options& options);

/// A region of a partition, which is still to be triangulated. Its border is made of Delaunay edges, so the
/// triangles inside depend on the region's own points alone.
struct Region {
  /// Indices of the input points inside the region and on its border.
  std::vector<std::int32_t> points;
  /// 2 per edge: positions in `points`. Edges are directed, with the region on their left.
  std::vector<std::int32_t> border;
};

/// A set of points cut into regions by some levels of the recursion.
struct Partition {
  std::vector<Region> regions;  ///< the regions that are still to be triangulated
  /// Triangles of regions without internal points, which are final: 3 indices of input points each.
  std::vector<std::int32_t> triangles;
  Statistics statistics;                ///< what the call did and how long it took
  std::vector<LevelStatistics> levels;  ///< one per level
};

/// Cuts n points into at most 2^levels regions by `levels` levels of the recursion. Options::mode and
/// Options::count are ignored. Throws Error(usage) if levels is negative, and what triangulate throws.
/// O(levels n) work after sorting.
FLAUNAY_API Partition partition(Triangulator& triangulator, const double* coordinates, std::size_t n,
                                int levels, const Options& options = {});

/// Combines the triangulations of a partition's regions. solutions: per region any Delaunay triangulation of
/// its points, as 3 positions in Region::points per triangle, in either orientation. Triangles outside of the
/// region's border may be included; they are ignored. The result is that of triangulate. Throws Error(input)
/// if a solution is not a triangulation of its region's points. Uses no device, and the calling thread alone.
/// O(n log n) work.
FLAUNAY_API flaunay::Triangulation assemble(const double* coordinates, std::size_t n,
                                            const Partition& partition,
                                            const std::vector<std::vector<std::int32_t>>& solutions,
                                            const flaunay::Options& options = {});

}  // namespace flaunay::research
