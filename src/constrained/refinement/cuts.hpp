// Cuts the plane into the blocks of a phase (docs/refinement.md).
#pragma once

#include <cstddef>
#include <vector>

#include "host/runtime.hpp"
#include "refinement/records.h"

namespace flaunay::constrained {

/// How a node of the tree is cut.
enum class Cuts {
  medians,  ///< in the median, across the longer side
  gaps      ///< in the middle of the widest gap of both axes near the median: places lie along cuts before
};

/// A tree of cuts, the root first, whose leaves have at most `most` of these places each, as far as they
/// differ. It does not depend on the order of places. Threads of the runtime share many.
std::vector<kernel::block_cut> cut_plane(host::Runtime& runtime, std::vector<kernel::double2> places,
                                         std::size_t most, Cuts how);

/// The number of its leaves.
std::size_t leaves_of(const std::vector<kernel::block_cut>& cuts);

}  // namespace flaunay::constrained
