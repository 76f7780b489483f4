// Regions, depths, holes and what is left, one triangle after the other: the plain version of domain.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/domains/domain.hpp"

namespace flaunay::constrained {

/// What a call does with the domains of a triangulation.
struct DomainRequest {
  DepthRules rules{};
  bool labels = false;  ///< whether to compute ConstrainedTriangulation::depths and regions

  bool needs_depths() const { return labels || rules.outside != Outside::keep; }
};

/// Regions in host memory; see Regions.
struct HostRegions {
  std::vector<std::int32_t> of_triangles, depths;
  std::vector<char> left;
};
HostRegions find_regions_on_host(const ConstrainedTriangulation& mesh);
/// Labels a triangulation with constraints and leaves out what the request and the holes say. It must have
/// neighbours; half-edges are not kept up to date. coordinates: of all points, those that splitting added
/// too. n: the number of points without those. Expected O(n + s) for s segments, besides the holes: O(log h)
/// per triangle of a set with h holes, and one step per hole in the range of its x coordinates.
void apply_domains_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                           const Constraints& constraints, const DomainRequest& request,
                           ConstrainedTriangulation& result);
/// Its last steps: leaves out what the regions and the holes say, also of the result's polygons, and writes
/// the labels if they are wanted.
void leave_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, bool labels, HostRegions& regions,
                   ConstrainedTriangulation& result);

/// The magnitudes of the points of sets that have places, with those that splitting added; of other sets, of
/// none.
std::vector<geometry::Magnitudes> magnitudes_at(const Places& places, const double* coordinates,
                                                const std::vector<std::size_t>& offsets,
                                                const std::vector<std::size_t>& added_offsets);

}  // namespace flaunay::constrained
