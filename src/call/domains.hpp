// Labels of a triangulation with constraints in host memory, and what is left without the outside and holes.
#pragma once

#include <cstddef>
#include <vector>

#include "call/implementation.hpp"
#include "constrained/domains/domain_on_host.hpp"

namespace flaunay::call {

/// What the options ask for. are_closed: whether segments are known to be closed curves.
constrained::DomainRequest request_of(const ConstrainedOptions& options, bool are_closed);

/// Labels a triangulation, which must have neighbours, and leaves out what the request and the holes say, on
/// the engine for host memory with doubles or, if it is small and no device was named, on the calling thread.
/// coordinates: of all points, those that splitting added too; offsets: without those.
void apply_domains(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const constrained::DomainRequest& request,
                   ConstrainedTriangulation& result);
/// Labels on a device, or natively. with_doubles: finds holes; another one if the first one computes in
/// fixed point.
void apply_domains_on(host::Runtime& runtime, host::Runtime& with_doubles, const double* coordinates,
                      const std::vector<std::size_t>& offsets, const Constraints& constraints,
                      const constrained::DomainRequest& request, ConstrainedTriangulation& result);
/// Writes the attributes of triangles if there are seeds, to a result that has neighbours. coordinates and
/// offsets: as of apply_domains.
void write_attributes(Implementation& self, const double* coordinates,
                      const std::vector<std::size_t>& offsets, const Constraints& constraints,
                      ConstrainedTriangulation& result);

}  // namespace flaunay::call
