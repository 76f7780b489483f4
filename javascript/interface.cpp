// What library.js needs of flaunay.wasm besides flaunay.h.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "c/handles.hpp"
#include "declarations.h"
#include "flaunay/flaunay.h"
#include "space/spaces.hpp"
#include "space/triangulate.hpp"

namespace {

namespace call = flaunay::call;
using call::Implementation;

template <typename Work>
auto in_turn(flaunay_triangulator* triangulator, const Work& work) {
  Implementation& self = flaunay::TriangulatorAccess::implementation(triangulator->cpp);
  return call::take_turn(self, [&] { return work(self); });
}

// Halfedge k of a triangle joins the same vertices as halfedge 2 - k of the triangle that is turned.
std::int32_t turned(std::int32_t halfedge) {
  return halfedge < 0 ? halfedge : halfedge / 3 * 6 + 2 - halfedge;
}

}  // namespace

extern "C" {

// flaunay_triangulate in mode blocks and in the plane alone: all modes and spaces would double the module.
flaunay_status triangulate(flaunay_triangulator* triangulator, const double* coordinates, std::size_t n,
                           const std::size_t* offsets, std::size_t sets, unsigned parts,
                           flaunay_triangulation** result) {
  return flaunay::c::create(result, [&] {
    flaunay::Options options;
    flaunay::c::request(parts, options);
    const std::vector<std::size_t> all = flaunay::c::to_offsets(offsets, sets, n);
    return std::make_unique<flaunay_triangulation>(in_turn(triangulator, [&](Implementation& self) {
      return call::triangulate(self, call::checked_points(coordinates, nullptr, all), all, options);
    }));
  });
}

// The functions of these names, likewise.
flaunay_status voronoi(flaunay_triangulator* triangulator, const double* coordinates, std::size_t n,
                       const flaunay_triangulation* mesh, flaunay_voronoi** result) {
  return flaunay::c::create(result, [&] {
    const call::CellInput input{{coordinates, nullptr, n}, flaunay::Space::plane(), mesh->plain(), {}};
    return std::make_unique<flaunay_voronoi>(flaunay_voronoi{
        in_turn(triangulator, [&](Implementation& self) { return call::dual_in_plane(self, input); })});
  });
}
flaunay_status clipped_voronoi(flaunay_triangulator* triangulator, const double* coordinates, std::size_t n,
                               const flaunay_triangulation* mesh, const double* corners,
                               std::size_t corner_count, flaunay_clipped_voronoi** result) {
  return flaunay::c::create(result, [&] {
    const call::CellInput input{{coordinates, nullptr, n},
                                flaunay::Space::plane(),
                                mesh->plain(),
                                flaunay::voronoi::checked_polygon(corners, corner_count)};
    return std::make_unique<flaunay_clipped_voronoi>(flaunay_clipped_voronoi{
        in_turn(triangulator, [&](Implementation& self) { return call::cells_in_plane(self, input); })});
  });
}
flaunay_status locator(flaunay_triangulator* triangulator, const double* coordinates, std::size_t n,
                       const std::size_t* offsets, std::size_t sets, const flaunay_triangulation* mesh,
                       flaunay_locator** result) {
  return flaunay::c::create(result, [&] {
    return std::make_unique<flaunay_locator>(flaunay_locator{flaunay::Locator(
        triangulator->cpp, coordinates, flaunay::c::to_offsets(offsets, sets, n), mesh->plain())});
  });
}

// Makes triangles and the hull clockwise, each with the same first vertex as before. Delaunator calls that
// counter-clockwise, because y goes down on its screens. The hull of points on one line keeps its order.
void turn_clockwise(std::int32_t* triangles, std::int32_t* halfedges, std::size_t t, std::int32_t* hull,
                    std::size_t h) {
  for (std::size_t i = 0; i < 3 * t; i += 3) {
    const std::int32_t second = triangles[i + 1], first = halfedges[i];
    triangles[i + 1] = triangles[i + 2];
    triangles[i + 2] = second;
    halfedges[i] = turned(halfedges[i + 2]);
    halfedges[i + 1] = turned(halfedges[i + 1]);
    halfedges[i + 2] = turned(first);
  }
  if (t > 0) std::reverse(hull + 1, hull + h);
}
}
