// How the levels of the recursion are run on the device: all regions of a level at once, or one region at a
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "flattened/stages.hpp"
#include "recursive/regions.hpp"

namespace flaunay::flattened {

/// The recursion of one call: what its steps share, and where they put triangles.
class Recursion {
 public:
  /// arenas: level d lives in arenas[d % 2]; of recursive(), all levels in the first.
  Recursion(Workspace& work, PointTable& table, const Options& options, std::array<Arena*, 2> arenas);

  /// The first borders and regions; makes room for the triangles.
  Borders begin();

  /// All regions of a level at once, until no region has internal points or `levels` levels are done.
  void flattened(int levels = kMostLevels);

  /// The same kernels on one region at a time, depth first.
  void recursive();

  /// The regions that are left; no offsets if there are none.
  recursive::RegionArrays read_regions();

  const Buffer<cl_int>& triangles() const { return triangles_; }
  std::size_t done() const { return done_; }  ///< triangles so far
  /// The triangles so far, 3 ids each.
  std::vector<std::int32_t> read_triangles() { return read_all(work_, triangles_, 3 * done_); }

 private:
  /// Cuts a level's regions: their children's level, and the triangles of those without internal points.
  Level step(const Level& level, int depth);
  void recurse(const Level& region, int depth);
  Level single_region(const Level& level, std::size_t region, const std::vector<cl_int>& point_offsets,
                      const std::vector<cl_int>& corner_offsets);
  void report(int depth, std::size_t points_left);

  Workspace& work_;
  PointTable& table_;
  const Options& options_;
  std::array<Arena*, 2> arenas_;
  Level level_{};
  std::unique_ptr<Arena::Scope> scope_;
  Buffer<cl_int> triangles_{};
  std::size_t done_ = 0;
  std::size_t internal_points_ = 0;
  std::size_t finished_points_ = 0;
};

}  // namespace flaunay::flattened
