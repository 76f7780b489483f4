// Triangulations of groups of sets, joined to one of all sets.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/constrained.hpp"
#include "host/runtime.hpp"

namespace flaunay::mesh {

/// A group of sets that follow each other.
struct Group {
  std::vector<std::size_t> offsets;  ///< of its sets, from its first point on
  std::size_t first_point = 0;
};

/// The sets of the first groups together.
template <typename Result>
struct Joined {
  Result result;
  std::size_t groups = 0;   ///< how many
  std::size_t regions = 0;  ///< how many these have, if they have labels
};

/// Adds the parts of the next groups. Takes their memory.
void join(host::Runtime& runtime, const std::vector<Group>& groups, std::vector<Triangulation>& parts,
          Joined<Triangulation>& joined);
/// parts: without added points, each segment is one piece.
void join(host::Runtime& runtime, const std::vector<Group>& groups,
          std::vector<ConstrainedTriangulation>& parts, Joined<ConstrainedTriangulation>& joined);

}  // namespace flaunay::mesh
