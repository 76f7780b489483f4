// Refines constrained triangulations: adds points until triangles are as good as is asked for
// (docs/refinement.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "constrained/refinement/angles.hpp"
#include "flaunay/constrained.hpp"
#include "host/runtime.hpp"

namespace flaunay::constrained {

/// A canonical constrained Delaunay triangulation, of one or more sets, to be refined. It contains only
/// triangles to be refined, none outside or in holes. All its borders, such as the convex hull where that is
/// no constraint, are edges in `edge_ends`.
struct MeshToRefine {
  const double* coordinates = nullptr;  ///< x and y per point
  std::size_t points = 0;               ///< number of points
  std::vector<std::int32_t> triangles;  ///< 3 points per triangle, counter-clockwise
  std::vector<std::int32_t> neighbors;  ///< 3 per triangle, opposite to its corners; -1 on a border
  std::vector<std::int32_t> edges;  ///< 3 per triangle, opposite to its corners: an index of an edge, or -1
  std::vector<std::int32_t> edge_ends;   ///< 2 points per edge that must stay, in any order
  std::vector<std::uint8_t> kept_edges;  ///< one per edge: 1 if it must not be split; empty if all may be
  std::vector<double>
      largest_areas;  ///< one per triangle: the area of those with their centroid in it, 0 for any; or empty
  // The same arrays in the memory of the runtime, if they are there.
  host::Buffer<cl_double> coordinates_there{};
  host::Buffer<cl_int> triangles_there{}, neighbors_there{};
};

/// A refined triangulation: canonical, of the points before and those added.
struct RefinedMesh {
  std::vector<double> added;              ///< x and y of points added; the k-th is point `points` + k
  std::vector<std::int32_t> added_edges;  ///< one per added point: the edge that it is on, or -1
  std::vector<double>
      added_places;  ///< one per added point: where it is on that edge, see docs/refinement.md
  std::vector<std::int32_t> triangles;  ///< as in MeshToRefine; rows begin with their smallest index
  std::vector<std::int32_t> neighbors;  ///< as in MeshToRefine
  std::vector<std::int32_t> edges;      ///< as in MeshToRefine: of pieces of an edge, that edge
  std::vector<std::int32_t> parents;    ///< one per triangle: a triangle of MeshToRefine in the same region;
                                        ///< if areas differ in it, the one with the centroid
  RefinementReport report;              ///< without angles; its triangles are rows of this mesh
  Angles before_smoothing{true};        ///< of the triangles that smoothing began with
};

/// Bad triangles per block. Twice as many make 0.3 % fewer points, and half as many blocks for threads.
constexpr std::size_t kRefinementBlock = 256;

/// Refines a mesh on a runtime that computes with doubles. The result does not depend on the runtime, nor on
/// the order of points, triangles and edges, but for numbers. Throws Error(input) if there is no memory for
/// the points that are needed, or they are more than indices can count.
/// block: a part of the result; others than the default are for tests.
RefinedMesh refine(host::Runtime& runtime, const MeshToRefine& mesh, const Refinement& wanted,
                   std::size_t block = kRefinementBlock);

}  // namespace flaunay::constrained
