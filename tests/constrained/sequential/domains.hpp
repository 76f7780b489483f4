// The twin of constrained/domains: regions, depths, holes and what is left, one triangle after the other.
#pragma once

#include <cstddef>
#include <vector>

#include "constrained/stages.hpp"

namespace flaunay::sequential {

/// Labels a triangulation with constraints and leaves out what the request and the holes say. It must have
/// neighbours, and no added points. Curves must be closed where the rule needs it, and holes in triangles.
void apply_domains(const double* coordinates, const Constraints& constraints,
                   const call::DomainRequest& request, ConstrainedTriangulation& mesh);

}  // namespace flaunay::sequential
