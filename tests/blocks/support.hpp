// What the tests of src/blocks share.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <vector>

#include "blocks/stages.hpp"
#include "tests/points/support.hpp"

namespace flaunay::blocks {

using testing::RingCheck;

/// Sets of up to so many points are held against the reference, too.
constexpr std::size_t kReferencePoints = 130;

/// Rings against what must hold of them; see divide_test.cpp.
void check_rings(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                 const Rings& rings, const std::vector<cl_int>& representatives, HostRings& g, Met& met);
/// Two triangles over a square, by hand, in a block with room for more.
HostRings square_rings();
/// The mesh of rings against its twin; see mesh_test.cpp.
void check_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, const HostRings& g,
                Triangulation& result, Met& met);
/// All stages, from points to a mesh; see stages_test.cpp. exact: no filter decides anything.
Triangulation check_stages(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets, Met& met,
                           bool exact = false);
void check_stages(Runtime& runtime, const Coordinates& coordinates, Met& met, bool exact = false);

}  // namespace flaunay::blocks
