// Rounded polygons of cells, made valid.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/launch/vector_operations.hpp"
#include "host/runtime.hpp"

namespace flaunay::voronoi {

/// Polygons that tile but for rounding. Corners that polygons share are the same to the last bit.
struct Cells {
  std::vector<std::int32_t> offsets;  ///< cells + 1: cell i has the corners offsets[i] up to offsets[i + 1]
  std::vector<double> vertices;       ///< x and y of each corner, counter-clockwise
};

constexpr std::array<double, 2> kNoPeriod = {HUGE_VAL, HUGE_VAL};

/// Makes polygons valid: afterwards each is simple and counter-clockwise, which is decided exactly, or empty.
/// Corners that coincide (CORNERS_COINCIDE) become one in all cells that have them; and of a polygon that
/// crosses itself the ends of the shortest edge do, relative to its coordinates, until it is simple. A
/// polygon of which nothing is left, or that crosses itself though all its edges are long, becomes empty.
/// docs/exactness.md says how far corners move. Polygons with corners that are not finite are left alone. The
/// result does not depend on the order of the cells.
/// runtime: its threads are used if it is native. sites: the cells' points, 2 coordinates each. fixed: places
/// that stay, such as the corners of what cells are clipped to. period: how far the images of a corner are
/// apart, which must be exact; infinite without. O(n) where polygons are convex; a polygon of d corners that
/// is not takes O(d^2).
void mend(host::Runtime& runtime, const double* sites, const std::vector<double>& fixed,
          const std::array<double, 2>& period, Cells& cells);

/// As mend, of cells whose corners are numbers of centres: these are moved. Unbounded cells do not count.
void mend_centres(host::Runtime& runtime, const std::vector<double>& sites,
                  const std::vector<std::int32_t>& offsets, const std::vector<std::int32_t>& corners,
                  const std::vector<std::uint8_t>& unbounded, std::vector<double>& centres);

/// Whether one of n cells or triangles is in doubt. mark: launches a kernel of voronoi/mend.cl. Waits.
template <typename Mark>
bool is_any_doubtful(host::Runtime& runtime, std::size_t n, const Mark& mark) {
  host::Arena::Scope scope(runtime.arena());
  const auto doubtful = runtime.arena().allocate<cl_uint>(n + 1);
  mark(doubtful);
  host::exclusive_scan(runtime, doubtful, n, doubtful);
  return runtime.read_one(doubtful, n) > 0;
}

}  // namespace flaunay::voronoi
