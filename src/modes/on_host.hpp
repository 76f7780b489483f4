// Steps before and after the algorithm that all modes on the host share.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/mesh.hpp"
#include "geometry/point_sets.hpp"
#include "statistics/phases.hpp"

namespace flaunay::modes {

/// A mode's own work: computes the triangles of all sets, in the form that geometry::finish expects, and adds
/// levels and work to the result.
using HostMode = geometry::Mesh (*)(const geometry::PointSets& sets, const research::Options& options,
                                    const statistics::Phases& phases, research::Triangulation& result);

/// Sorts the points, runs the mode, and makes the canonical result. O(n log n).
research::Triangulation run_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                                    const research::Options& options, HostMode mode);

}  // namespace flaunay::modes
