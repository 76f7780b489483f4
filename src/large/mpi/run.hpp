// Rounds over ranks: each triangulates its points, keeps final triangles, and hands on the rest to fewer
// ranks.
#pragma once

#include <cstddef>
#include <functional>

#include "flaunay/mpi.hpp"
#include "large/mpi/ranks.hpp"

namespace flaunay::mpi {

/// Triangulates a rank's points.
struct Solver {
  std::string name;
  std::size_t capacity = 0;  ///< points that it can take at once
  /// Whether it uses the memory of the machine, which other ranks on it use as well.
  bool shares_memory = true;
  /// With neighbours, and with areas if they are wanted.
  std::function<flaunay::Triangulation(const double* coordinates, std::size_t n)> triangulate;
};

/// See triangulate. Called by all ranks.
Triangulation run(Ranks& ranks, const Solver& solver, const double* coordinates, std::size_t n,
                  const Options& options);

}  // namespace flaunay::mpi
