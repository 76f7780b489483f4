// Lists of arguments that the kernels of interpolation have in common (kernels/interpolate/arguments.h).
#pragma once

#include "derived/locate/locator.hpp"
#include "launchers/interpolate/natural.cl.hpp"

namespace flaunay::interpolate {

inline kernels::placed_queries placed_queries(const locate::LocatedQueries& located) {
  return {.sets = located.sets,
          .query_offsets = located.query_offsets,
          .frames = located.frames,
          .order = located.order,
          .placed = located.placed};
}

inline kernels::faces faces_of(const locate::Locator& locator) {
  return {.points = locator.points, .source = locator.source, .faces = locator.faces};
}

}  // namespace flaunay::interpolate
