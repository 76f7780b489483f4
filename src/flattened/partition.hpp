// The coarse partitioner: what becomes of the regions that are left after a few levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flattened/executions.hpp"
#include "recursive/points.hpp"

namespace flaunay::flattened {

/// How many levels to run on the device: Options::partition_levels, or so many that every host thread gets
/// several regions, none of them tiny.
int partition_levels(std::size_t n, const Options& options);

/// The distinct points, for what goes on on the host.
recursive::PointSets to_host(Workspace& work, const PointTable& table,
                             const std::vector<std::int32_t>& representatives);

/// The regions as indices of input points. Each region's points: those inside, then those of its border.
std::vector<Region> to_input(Workspace& work, const PointTable& table,
                             const recursive::RegionArrays& regions);

}  // namespace flaunay::flattened
