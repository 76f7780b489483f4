// The levels of a locator, for queries whose nearest point is far to walk to
// (kernels/locate/nearest_search.h).
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "arithmetic/records.h"
#include "locate/records.h"
#include "points/device_mesh.hpp"

namespace flaunay::locate {

struct Locator;

/// Triangulates sets of points. The mesh is in `results`; `persistent` holds arrays of the call.
using Triangulate = points::DeviceMesh (*)(host::Runtime& runtime, host::Arena& persistent,
                                           const std::vector<std::size_t>& offsets,
                                           const host::Buffer<cl_double>& coordinates, host::Arena& results);

/// The triangles with which the stars of vertices begin, and the fans of the triangulation.
struct Stars {
  host::Buffer<cl_int> starts{};
  host::Buffer<kernel::fan_part> fans{};
};

/// Triangulations of samples, from the largest on, of each set that is large enough; the mesh's own stars; a
/// tree of boxes around its vertices. About 16 bytes per triangle of the mesh, and 8 more while they are
/// made.
struct Levels {
  std::shared_ptr<host::Arena> own{};  ///< where the buffers come from
  std::size_t count = 0, sets = 0;     ///< levels, and sets that have them
  host::Buffer<cl_int> long_sets{};    ///< per set its number among those, or -1
  host::Buffer<cl_int> below{};        ///< per vertex of a sample, by its index there, the vertex below
  Stars stars{}, sample_stars{};
  host::Buffer<kernel::vertex_box> boxes{};
};

/// The sizes of the samples: set s has the samples [offsets[l * sets + s], offsets[l * sets + s + 1]) on
/// level l.
struct SampleSizes {
  std::size_t levels = 0, sets = 0;
  std::vector<std::size_t> offsets{0};
};

/// Chooses the levels of sets with these numbers of vertices: each is `ratio` times smaller than the one
/// below, and the last one has a few vertices of the largest set.
SampleSizes sample_sizes(const std::vector<std::size_t>& vertices, std::size_t ratio);

/// Makes the levels of a locator's mesh, and its samples. Sets with fewer triangles than `levels_from` have
/// none. If it throws, the locator is as it was. Waits some 20 times. O(n log n), a small part of a
/// triangulation.
void make_levels(host::Runtime& runtime, Locator& locator);

}  // namespace flaunay::locate
