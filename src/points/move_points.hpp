// How points are brought to their blocks.
#pragma once

#include <cstddef>
#include <vector>

#include "points/distribute.hpp"
#include "points/inspect.hpp"

namespace flaunay::points {

/// Decisions of the host before points are moved to blocks.
struct Plan {
  std::vector<SetToCut> cut;                ///< the sets that are larger than a block
  std::vector<kernel::set_of_blocks> sets;  ///< all sets
  std::size_t nodes = 0;                    ///< of the trees of all sets
};

/// Writes the blocks' points and where they begin, and each point's representative: itself. offsets: the
/// first point of each set, and the end. One work-item moves a chunk of points.
void move_by_chunks(Workspace& work, const Plan& plan, const std::vector<std::size_t>& offsets,
                    const Buffer<cl_double>& input, const Buffer<cl_int>& representatives, Blocks& blocks);
/// Does the same with one work-group per tile of points, for devices with many lanes. May wait for sizes.
void move_by_tiles(Workspace& work, const Plan& plan, const std::vector<std::size_t>& offsets,
                   const Buffer<cl_double>& input, BlockSizes sizes, const Buffer<cl_int>& representatives,
                   Blocks& blocks);

}  // namespace flaunay::points
