// Lists of arguments that the kernels of interpolation have in common (kernels/interpolate/arguments.h).
#pragma once

#include "derived/locate/locator.hpp"
#include "launchers/interpolate/natural.cl.hpp"

namespace flaunay::interpolate {

inline kernels::faces faces_of(const locate::Locator& locator) {
  return {.points = locator.points, .source = locator.source, .faces = locator.faces};
}

/// Without the faces beyond constraints, in a mesh that has them.
inline kernels::faces visible_faces_of(const locate::Locator& locator) {
  return {.points = locator.points,
          .source = locator.source,
          .faces = locator.is_constrained ? locator.visible : locator.faces};
}

}  // namespace flaunay::interpolate
