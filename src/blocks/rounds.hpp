// Rounds of blocks instead of merges up the trees: final triangles are emitted, and points around which
// triangles are missing are distributed to new blocks (kernels/blocks/rounds.cl).
#pragma once

#include <cstddef>
#include <vector>

#include "blocks/pipeline.hpp"
#include "blocks/run.hpp"

namespace flaunay::blocks {

/// Does the same as run(), in rounds, with the same bytes as results.
geometry::Fitted<Outcome> run_rounds(host::Runtime& runtime, Arena& persistent,
                                     const std::vector<std::size_t>& offsets, const Exchange& exchange,
                                     statistics::Phases& phases);

}  // namespace flaunay::blocks
