// Domains to refine, and whether a refined mesh is right, by its definition in docs/refinement.md. The check
// is exact, and shares only the bounds of angles with src/constrained and the kernels.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "constrained/refinement/refine.hpp"
#include "flaunay/constrained.hpp"
#include "tests/constrained/nasty.hpp"

namespace flaunay::testing {

/// Segments, and what of the triangles between them is refined.
struct DomainToRefine : SegmentInput {
  std::vector<double> holes;  ///< x and y of places that are left out
  Outside outside = Outside::keep;
};

/// The mesh of a domain, on the host. The points are the domain's, which must stay. Throws Error(input) if
/// segments cross.
constrained::MeshToRefine mesh_to_refine(const DomainToRefine& domain);

/// What is connected over edges that need not stay: a number per triangle, of its first triangle.
std::vector<std::int32_t> regions_of(const std::vector<std::int32_t>& neighbors,
                                     const std::vector<std::int32_t>& edges);

/// The first thing that is wrong with the result of refining a mesh, or "". What is listed as `frozen` is
/// only checked to be where edges are near to what rounding can tell apart.
std::string what_is_wrong(const constrained::MeshToRefine& mesh, const constrained::RefinedMesh& refined,
                          const Refinement& wanted);

/// A mesh with its points.
struct OwnedMesh {
  Coordinates points;
  constrained::MeshToRefine mesh;
};

/// The same mesh with points, triangles and edges in another order, and triangles and edges that begin with
/// other corners and ends.
OwnedMesh shuffled(const constrained::MeshToRefine& mesh, std::uint64_t seed);

/// What of a result does not depend on numbers, in an order of its own.
struct ByCoordinates {
  /// The corners of triangles, from the lexicographically smallest on, and their excuses or 0.
  std::vector<std::array<double, 7>> triangles;
  /// Points that were added, where they are on their edges, and the ends of these.
  std::vector<std::array<double, 7>> added;
  std::size_t rounds = 0;

  ByCoordinates(const constrained::MeshToRefine& mesh, const constrained::RefinedMesh& refined);
  bool operator==(const ByCoordinates&) const = default;
};

}  // namespace flaunay::testing
