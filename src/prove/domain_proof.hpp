// An exact check of constrained triangulations as calls return them: of several sets, with points that
// splitting and refinement added.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flaunay/constrained.hpp"

namespace flaunay::prove {

/// A result together with its input and options.
struct DomainClaim {
  const double* points;
  const std::vector<std::size_t>& offsets;
  const Constraints& constraints;
  const ConstrainedOptions& options;
  const ConstrainedTriangulation& mesh;  ///< its arrays have sizes and indices that fit each other
};

/// Returns the first error found; empty if all is right. O((n + s) log (n + s)) for s segments.
std::string find_problem(const DomainClaim& claim);

}  // namespace flaunay::prove
