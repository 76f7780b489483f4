// Makes segments edges of a triangulation in host memory: on the calling thread or on an engine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "call/implementation.hpp"
#include "constrained/insertion/insert.hpp"

namespace flaunay::call {

/// Makes the segments edges. delaunay: what call::triangulate returned, with neighbours; its triangles and
/// neighbours are used up, and what this step did is added to its statistics. Small sets stay on the calling
/// thread if no device was named. Throws what constrained::constrain throws.
constrained::Result insert_segments(Implementation& self, const double* coordinates,
                                    const std::vector<std::size_t>& offsets, Triangulation& delaunay,
                                    const std::vector<std::int32_t>& segments, const Options& options);

/// The same on an engine with doubles.
constrained::Result insert_on(Engine& engine, const double* coordinates,
                              const std::vector<std::size_t>& offsets, Triangulation& delaunay,
                              const std::vector<std::int32_t>& segments, const Options& options);

}  // namespace flaunay::call
