// Refines what is left of a triangulation with constraints, in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "call/implementation.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::call {

/// Throws Error(usage), which names the member, if a refinement cannot be what is meant.
void check_refinement(const Refinement& wanted, std::size_t seeds);

/// Reports the angles of a result that was not refined. coordinates: of the n points of the caller.
void measure_angles(Implementation& self, const double* coordinates, std::size_t n,
                    ConstrainedTriangulation& result);

/// Refines the result, which must have neighbours: on the engine for host memory or, if little is expected
/// and no device was named, on the calling thread. Several sets are refined one by one, so that each is as if
/// it were alone; small ones on threads of the host. All arrays but half-edges, areas and markers are
/// extended. coordinates: of all points, those that splitting added too; offsets: without those; seeds: for
/// each triangle that of its region, or -1; empty if there are none; areas: for each triangle the area that
/// it and its parts may have, 0 for any, or empty. Throws what constrained::refine throws.
void refine(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
            const ConstrainedOptions& options, const std::vector<std::int32_t>& seeds,
            const std::vector<double>& areas, ConstrainedTriangulation& result);

}  // namespace flaunay::call
