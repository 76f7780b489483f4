// Half-edges whose twin is in another window of rows, or nowhere.
#pragma once

#include <cstdint>
#include <string>

#include "app/verify/external_sort.hpp"
#include "prove/describe.hpp"
#include "prove/exact.hpp"

namespace flaunay::prove {

/// Half-edge 3 t + k is the side of triangle t opposite to its corner k: from corner k + 1 to corner k + 2.
struct OpenEdge {
  std::uint64_t half_edge;
  std::int64_t neighbor;  ///< the triangle that `neighbors` has there; unused without `neighbors`
  Vertex origin, target;
  Vertex apex;  ///< corner k

  std::uint64_t row() const { return half_edge / 3; }
  std::uint64_t smaller() const { return origin.id < target.id ? origin.id : target.id; }
  std::uint64_t larger() const { return origin.id < target.id ? target.id : origin.id; }
  bool ascends() const { return is_before(origin, target); }
};

struct ByEnds {
  bool operator()(const OpenEdge& a, const OpenEdge& b) const {
    if (a.smaller() != b.smaller()) return a.smaller() < b.smaller();
    if (a.larger() != b.larger()) return a.larger() < b.larger();
    return a.half_edge < b.half_edge;
  }
};

/// Around a convex polygon from its lexicographically smallest vertex on, counter-clockwise.
struct ByTurn {
  bool operator()(const OpenEdge& a, const OpenEdge& b) const {
    const bool ascends = a.ascends();
    if (ascends != b.ascends()) return ascends;
    if (!is_same_place(a.origin, b.origin)) return is_before(a.origin, b.origin) == ascends;
    return a.half_edge < b.half_edge;
  }
};

using OpenEdges = ExternalSorter<OpenEdge, ByEnds>;
using Boundary = ExternalSorter<OpenEdge, ByTurn>;

/// The counts of check_across.
struct AcrossCounts {
  std::uint64_t matched = 0;     ///< edges with two triangles
  std::uint64_t cocircular = 0;  ///< edges whose triangles share a circle
  std::uint64_t boundary = 0;    ///< half-edges without twin
};

/// Matches half-edges of different windows and checks their edges as within a window; adds those without twin
/// to `boundary`. Throws a Violation.
AcrossCounts check_across(OpenEdges& edges, bool has_neighbors, Boundary& boundary,
                          ExactPredicates& predicates);

/// Checks that the half-edges are one convex counter-clockwise polygon. Throws a Violation.
void check_boundary(Boundary& boundary, ExactPredicates& predicates);

}  // namespace flaunay::prove
