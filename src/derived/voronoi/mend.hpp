// Rounded polygons of cells, made valid.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/launch/vector_operations.hpp"
#include "host/runtime.hpp"
#include "periodic/torus.h"
#include "points/device_mesh.hpp"
#include "points/download.hpp"

namespace flaunay::voronoi {

/// Polygons that tile but for rounding. Corners that polygons share are the same to the last bit.
struct Cells {
  std::vector<std::int32_t> offsets;  ///< cells + 1: cell i has the corners offsets[i] up to offsets[i + 1]
  std::vector<double> vertices;       ///< x and y of each corner, counter-clockwise
};

/// The plane, which does not repeat itself.
constexpr kernel::periodic_lattice kNoPeriod{{HUGE_VAL, HUGE_VAL}, {}, {}, {}, {}};

/// The number of vectors of the lattice; none if it is not that of a cell's corner.
inline int vectors(double number) { return std::fabs(number) < 128 ? static_cast<int>(number) : 0; }

/// The image of a place that is nearest to p along y, and of these along x.
inline kernel::double2 image_near(kernel::double2 p, kernel::double2 place,
                                  const kernel::periodic_lattice& lattice) {
  place = kernel::moved(place, 0, vectors(std::round((p.y - place.y) / lattice.period[1])), &lattice);
  return kernel::moved(place, vectors(std::round((p.x - place.x) / lattice.period[0])), 0, &lattice);
}

/// Makes polygons valid: afterwards each is simple and counter-clockwise, which is decided exactly, or empty.
/// Corners that coincide (CORNERS_COINCIDE) become one in all cells that have them. Where a polygon crosses
/// itself, the ends of the shortest edge between the edges that cross do, relative to its coordinates, until
/// it is simple. A polygon that crosses itself where all edges are long becomes a part of the one at its
/// longest edge. docs/exactness.md says how far corners move. Polygons with corners that are not finite are
/// left alone. The result of a set depends on nothing else, nor on the order of its cells. runtime: its
/// threads are used if it is native. sets: set s has the cells sets[s] up to sets[s + 1]. sites: the cells'
/// points, 2 coordinates each. fixed: places that stay, such as the corners of the polygon to which cells are
/// clipped. lattice: of the images of a corner, which must be exact. O(n) if few cells are in doubt. A
/// polygon of d corners that is not convex takes O(d log d) and its crossings, each time it changes.
void mend(host::Runtime& runtime, const std::vector<std::size_t>& sets, const double* sites,
          const std::vector<double>& fixed, const kernel::periodic_lattice& lattice, Cells& cells);

/// As mend, of cells whose corners are numbers of centres: these are moved. Unbounded cells do not count, and
/// those with long edges alone stay as they are. doubts: as doubts_of finds them; sets without any are left
/// alone.
void mend_centres(host::Runtime& runtime, const points::DeviceMesh& mesh, const std::vector<cl_uint>& doubts,
                  const std::vector<double>& sites, const std::vector<std::int32_t>& offsets,
                  const std::vector<std::int32_t>& corners, const std::vector<std::uint8_t>& unbounded,
                  std::vector<double>& centres);

/// For each of n cells or triangles, and for n, how many before are in doubt; empty if none is. mark:
/// launches a kernel of voronoi/mend.cl. Waits.
template <typename Mark>
std::vector<cl_uint> doubts_of(host::Runtime& runtime, std::size_t n, const Mark& mark) {
  host::Arena::Scope scope(runtime.arena());
  const auto doubtful = runtime.arena().allocate<cl_uint>(n + 1);
  mark(doubtful);
  host::exclusive_scan(runtime, doubtful, n, doubtful);
  if (runtime.read_one(doubtful, n) == 0) return {};
  return points::download(runtime, doubtful, n + 1);
}

}  // namespace flaunay::voronoi
