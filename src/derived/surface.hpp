// Code that rasters and contours share.
#pragma once

#include <fmt/format.h>

#include <cstddef>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Throws the error for a triangle whose indices are outside of the mesh.
[[noreturn]] inline void refuse_triangle(std::size_t triangle, std::size_t points, std::size_t triangles) {
  throw Error(ErrorKind::usage,
              fmt::format("triangles: triangle {} has a corner that is none of the {} points, or a neighbour "
                          "that is none of the {} triangles",
                          triangle, points, triangles));
}

}  // namespace flaunay
