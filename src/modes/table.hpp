// The table of modes, one row per mode, with what it supports and how it is run.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/research.hpp"
#include "modes/flattened/run.hpp"
#include "space/triangulate.hpp"

namespace flaunay::call {

/// The input of every mode. Offsets, options and the number of points have been checked.
struct Request {
  const HostPoints& points;
  const std::vector<std::size_t>& offsets;
  const research::Options& options;
};

struct ModeRow {
  research::ModeInfo info;
  /// Runs the mode on an engine of a Triangulator; null for a mode that needs none.
  research::Triangulation (*with_engine)(TriangulatorAccess::Implementation& self, const Request& request);
  /// Runs the mode on the host; null for a mode that needs an engine. coordinates: in double precision.
  research::Triangulation (*on_host)(const double* coordinates, const Request& request);
};

/// Mode blocks as the solver of the regions of mode flattened.
flattened::BlockSolver block_solver();

/// The row of a mode. Throws Error(usage) for an unknown mode.
const ModeRow& row_of(research::Mode mode);

}  // namespace flaunay::call
