// The modes that go level by level on the device: flattened, recursive-device, and the levels of partition.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/region_arrays.hpp"
#include "host/runtime.hpp"

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

/// Triangulates sets with at least one point, whose offsets were checked, in one of the modes flattened,
/// recursive_device and partition. Mode partition stops after partition_levels levels and calls solve_regions
/// for the remaining regions. The offsets in `result` must have their sizes. Throws what
/// research::triangulate throws. O(n log n) work.
void run(host::Runtime& runtime, const Memory& memory, const double* coordinates,
         const std::vector<std::size_t>& offsets, const research::Options& options, int partition_levels,
         const SolveRegions& solve_regions, research::Triangulation& result);

/// Implements research::partition for at least one point.
void partition(host::Runtime& runtime, const Memory& memory, const double* coordinates, std::size_t n,
               int levels, const research::Options& options, research::Partition& result);

}  // namespace flaunay::flattened
