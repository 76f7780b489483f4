// Checks of the arrays of given triangulations, before anything is proven about them.
#pragma once

#include <cstddef>
#include <vector>

#include "prove/domain_proof.hpp"

namespace flaunay::prove {

/// Throws Error(usage) for points and arrays of a triangulation whose sizes or indices do not fit each other,
/// and Error(input) for a point that is not finite. Neighbours, half-edges and areas may be empty. O(n).
void check_arrays(const double* points, const std::vector<std::size_t>& offsets, const Triangulation& mesh);
/// The same of a triangulation with constraints, and of these.
void check_arrays(const DomainClaim& claim);

}  // namespace flaunay::prove
