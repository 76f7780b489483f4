// Mode blocks for points and results in host memory.
#pragma once

#include <cstddef>
#include <vector>

#include "call/implementation.hpp"

namespace flaunay::call {

/// Coordinates in host memory, x0 y0 x1 y1 ..., in double or single precision; the other pointer is null.
struct HostPoints {
  const double* wide = nullptr;
  const float* narrow = nullptr;
};

/// Converts the points to double precision. Returns an empty vector if they already are in it.
std::vector<double> widened(const HostPoints& points, std::size_t n);

/// Implements Triangulator::triangulate for host memory: small sets on the calling thread if no device was
/// named, others on the triangulator's engine for host memory. The offsets must have been checked.
Triangulation triangulate(TriangulatorAccess::Implementation& self, const HostPoints& points,
                          const std::vector<std::size_t>& offsets, const Options& options);

/// Triangulates sets on this engine. If the engine computes in fixed point, throws
/// geometry::TooWideForFixedPoint for what that cannot represent.
Triangulation triangulate_on(Engine& engine, const HostPoints& points,
                             const std::vector<std::size_t>& offsets, const Options& options);

/// Returns a result for this many sets without any triangles.
Triangulation empty_result(Engine& self, std::size_t sets);

}  // namespace flaunay::call
