// Runs the levels of the recursion on the device: all regions of a level at once, or one region at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/point_sets.hpp"
#include "geometry/region_arrays.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

/// The share of a call's time that is over when the recursion begins, for progress.
constexpr double kBordersMade = 0.1;

/// The recursion of one call: the data that its steps share, and the triangles so far.
class Recursion {
 public:
  /// arenas: level d is stored in arenas[d % 2]; recursive() stores all levels in the first one. levels_end:
  /// the share of the call's time that is over after the last level, for progress.
  Recursion(Workspace& work, PointTable& table, const research::Options& options,
            std::array<Arena*, 2> arenas, double levels_end);

  /// Computes the first borders and regions, and allocates memory for the triangles; see result_memory.
  Borders begin(std::vector<std::int32_t>& triangles);

  /// Cuts all regions of a level at once, until no region has internal points or `levels` levels are done.
  void flattened(int levels = kMostLevels);

  /// The number of levels after which no region has more internal points than this.
  int levels_to(std::size_t internal_points) const;

  /// Cuts one region at a time with the same kernels, depth first.
  void recursive();

  /// Copies the regions that are left to the host. There are no offsets if no regions are left.
  geometry::RegionArrays read_regions();

  const Level& level() const { return level_; }  ///< the regions that are left
  /// The arena that does not hold these regions.
  Arena& other_arena() const { return *arenas_[work_.children == arenas_[0] ? 1 : 0]; }
  const Buffer<cl_int>& triangles() const { return triangles_; }
  std::size_t done() const { return done_; }  ///< number of triangles so far
  /// Copies the triangles so far to the host, 3 ids each.
  std::vector<std::int32_t> read_triangles() { return read_all(work_, triangles_, 3 * done_); }

 private:
  /// Cuts the regions of a level. Returns the level of their children, and triangulates children without
  /// internal points.
  Level step(const Level& level, int depth);
  bool is_small(const Level& level, int depth) const;
  void recurse(const Level& region, int depth);
  void recurse_each(const Level& level, int depth);
  /// share: that of the recursion which is done.
  void report(int depth, double share);
  double share_without(std::size_t points_left) const;

  Workspace& work_;
  PointTable& table_;
  const research::Options& options_;
  std::array<Arena*, 2> arenas_;
  double levels_end_;
  Level level_{};
  std::unique_ptr<Arena::Scope> scope_;
  Buffer<cl_int> triangles_{};
  std::size_t done_ = 0;
  std::size_t internal_points_ = 0;
  std::size_t largest_ = 0;  ///< no first region has more internal points
  std::size_t finished_points_ = 0;
};

/// Copies the distinct points to the host.
geometry::PointSets to_host(Workspace& work, const PointTable& table,
                            const std::vector<std::int32_t>& representatives);

/// Converts regions from ids to indices of input points. In Region::points, internal points precede border
/// points.
std::vector<research::Region> to_input(Workspace& work, const PointTable& table,
                                       const geometry::RegionArrays& regions);

}  // namespace flaunay::flattened
