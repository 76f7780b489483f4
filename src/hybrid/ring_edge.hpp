// Edges as kernels/shared/rings.h has them.
#pragma once

#include <cstddef>

#include "host/runtime.hpp"

namespace flaunay::hybrid {

struct RingEdge {
  cl_int to, next, previous;
};

/// Directed ones that a vertex brings.
constexpr std::size_t kEdgesPerVertex = 6;
/// The most vertices of a leaf.
constexpr std::size_t kLeafVertices = 4;

}  // namespace flaunay::hybrid
