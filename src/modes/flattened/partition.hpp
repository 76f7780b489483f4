// Partitions: the regions that are left after a few levels, for the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/point_sets.hpp"
#include "modes/flattened/levels.hpp"

namespace flaunay::flattened {

/// Copies the distinct points to the host.
geometry::PointSets to_host(Workspace& work, const PointTable& table,
                            const std::vector<std::int32_t>& representatives);

/// Converts regions from ids to indices of input points. In Region::points, internal points precede those of
/// the border.
std::vector<research::Region> to_input(Workspace& work, const PointTable& table,
                                       const geometry::RegionArrays& regions);

}  // namespace flaunay::flattened
