// Half-edges of a list of triangles: half-edge 3t + k runs from vertex k of triangle t to the next.
#pragma once

#include <cstdint>

#include "flaunay/flaunay.hpp"

namespace flaunay::recursive {

inline std::int32_t next_halfedge(std::int32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline std::int32_t previous_halfedge(std::int32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/// The half-edges of a result from its neighbours, and no neighbours, as the options want it.
void write_halfedges(const Options& options, Triangulation& result);

}  // namespace flaunay::recursive
