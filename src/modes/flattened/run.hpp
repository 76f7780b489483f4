// The modes that go level by level on the device: flattened, recursive-device, and the levels of partition.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/region_arrays.hpp"
#include "host/runtime.hpp"
#include "points/distribute.hpp"
#include "points/rings.hpp"

namespace flaunay::flattened {

/// The arenas of a call besides the runtime's own, which is for temporary arrays.
struct Memory {
  host::Arena& persistent;  ///< arrays that live as long as the call
  host::Arena& even;        ///< the regions of even levels
  host::Arena& odd;         ///< the regions of odd levels
};

/// Triangulates the regions that are left after some levels. Returns their triangles, 3 ids each,
/// counter-clockwise. counts: if not null, receives the work.
using SolveRegions = std::function<std::vector<std::int32_t>(const geometry::PointSets& sets,
                                                             const geometry::RegionArrays& regions,
                                                             research::OperationCounts* counts)>;

/// How blocks of points are triangulated.
struct BlockSolver {
  /// Triangulates blocks, which are independent of each other: blocks.merges is empty. The first of several
  /// equal points represents the others. Waits once.
  std::function<points::Rings(points::Workspace& work, const points::Blocks& blocks,
                              const host::Buffer<cl_int>& representatives)>
      solve;
  /// Writes the triangles left of edges, but of those edges whose `next` is a complement, into the rows of
  /// the triangle's middle vertex along x; and the half-edges' twins. first_rows: the first row of each
  /// vertex, closed by the number of all. Does not wait.
  std::function<void(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings,
                     const host::Buffer<cl_uint>& first_rows, const host::Buffer<cl_int>& triangles,
                     const host::Buffer<cl_int>& twins)>
      write_rows;
};

/// Solvers of the regions that the levels leave.
struct Solvers {
  int partition_levels = 0;   ///< mode partition stops after this many levels
  SolveRegions regions = {};  ///< mode partition
  BlockSolver blocks = {};    ///< mode flattened with Finish::blocks
};

/// Triangulates sets with at least one point, whose offsets were checked, in one of the modes flattened,
/// recursive_device and partition. The offsets in `result` must have their sizes. Throws the errors of
/// research::triangulate. O(n log n) work.
void run(host::Runtime& runtime, const Memory& memory, const double* coordinates,
         const std::vector<std::size_t>& offsets, const research::Options& options, const Solvers& solvers,
         research::Triangulation& result);

/// Implements research::partition for at least one point.
void partition(host::Runtime& runtime, const Memory& memory, const double* coordinates, std::size_t n,
               int levels, const research::Options& options, research::Partition& result);

}  // namespace flaunay::flattened
