// Labels of a triangulation with constraints in host memory, and what is left without the outside and holes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "call/implementation.hpp"
#include "constrained/domains/domain.hpp"
#include "constrained/domains/map.hpp"

namespace flaunay::call {

/// What a call does with the domains of a triangulation.
struct DomainRequest {
  constrained::DepthRules rules{};
  bool labels = false;  ///< whether to compute ConstrainedTriangulation::depths and regions
  /// The curves that bound polygons, if depths are numbers of those; rules.fill is that of each curve.
  const constrained::Curves* curves = nullptr;
  bool polygons = false;  ///< whether to compute ConstrainedTriangulation::polygons
  Overlaps overlaps = Overlaps::first;

  bool needs_depths() const { return labels || polygons || rules.outside != Outside::keep; }
};

/// What the options ask for. are_closed: whether segments are known to be closed curves.
DomainRequest request_of(const ConstrainedOptions& options, bool are_closed);

/// Labels a triangulation, which must have neighbours, leaves out what the request and the holes say, and
/// writes the attributes of triangles if there are seeds: on the engine for host memory or, if it is small
/// and no device was named, on the calling thread. coordinates: of all points, those that splitting added
/// too; offsets: without those. Returns for each triangle that is left the seed of its region, or -1; nothing
/// if there are no seeds.
std::vector<std::int32_t> apply_domains(Implementation& self, const double* coordinates,
                                        const std::vector<std::size_t>& offsets,
                                        const Constraints& constraints, const DomainRequest& request,
                                        ConstrainedTriangulation& result);
/// Applies the domains on an engine. with_doubles: finds holes and seeds; another engine if the first one
/// computes in fixed point.
std::vector<std::int32_t> apply_domains_on(Engine& engine, Engine& with_doubles, const double* coordinates,
                                           const std::vector<std::size_t>& offsets,
                                           const Constraints& constraints, const DomainRequest& request,
                                           ConstrainedTriangulation& result);

}  // namespace flaunay::call
