// The triangulations of blocks, as rings of edges around their vertices.
#pragma once

#include <cstddef>
#include <vector>

#include "arithmetic/language.h"
#include "host/runtime.hpp"
#include "mesh/records.h"
#include "predicates/records.h"

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

/// The rings of small sets, in memory of the calling thread that its next call reuses. Vertices of a set are
/// contiguous. An edge with the outside on its left has the complement of the next edge.
struct SmallRings {
  kernel::filter_bounds bounds;
  std::size_t vertices = 0;         ///< as many as points; those without an edge are duplicates, or alone
  const kernel::double2* points{};  ///< by vertex, scaled
  const cl_int* source{};           ///< by vertex its point
  kernel::ring_edge* edges{};
  cl_int* vertex_edge{};
  const cl_uint*
      first_rows{};  ///< by vertex its first triangle (blocks/mesh.cl), and the number of triangles
};

}  // namespace flaunay::points
