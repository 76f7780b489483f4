// Rounds of chunks: each chunk is triangulated by one of several solvers, final triangles are written, and
// the other points are handed on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.hpp"
#include "large/chunks/distribute.hpp"

namespace flaunay::chunks {

/// Triangulates chunks on a device. It is called by one thread at a time.
struct Solver {
  std::string name;
  /// Triangulates n points, x0 y0 x1 y1 ..., with neighbours, and areas if they are wanted. If it throws
  /// Error(device), it is not used any more.
  std::function<Triangulation(const double* coordinates, std::size_t n)> triangulate;
};

/// Triangulates the points of a source of one point or more; see triangulate_chunks. options: progress and
/// scratch alone. values: of the same points, or null. folding: if some points are images; otherwise null.
ChunkStatistics run(PointSource& source, const Values* values, MeshSink& sink, const Plan& plan,
                    const std::vector<Solver>& solvers, const ChunkOptions& options,
                    Folding* folding = nullptr);

}  // namespace flaunay::chunks
