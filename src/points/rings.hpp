// The triangulations of blocks, as rings of edges around their vertices.
#pragma once

#include <cstddef>
#include <vector>

#include "host/runtime.hpp"
#include "mesh/records.h"

namespace flaunay::points {

/// Directed edges, each in the ring of its origin (mesh/rings.h).
struct Rings {
  host::Buffer<kernel::ring_edge> edges{};  ///< kernel::EDGES_PER_VERTEX per point
  host::Buffer<cl_int> vertex_edge{};
  host::Buffer<kernel::solved_block> solved{};
  host::Buffer<cl_int> device_distinct{};
  host::Buffer<cl_uint> device_account{};
  host::Buffer<cl_double> vertex_weights{};  ///< if points have weights
  host::Buffer<cl_int> links{};              ///< if points have weights: see mesh/power_rings.h
  std::vector<cl_int> distinct;              ///< number of vertices of each block
  std::size_t undecided = 0;                 ///< predicates that were evaluated exactly
  std::size_t ties = 0;                      ///< how many of them found cocircular points
  std::size_t ties_left = 0;                 ///< how many of these left edges as they were
};

}  // namespace flaunay::points
