// Triangulations of points that are spread over the ranks of MPI. Link flaunay::mpi, which needs an MPI
// library; flaunay itself does not. See docs/scaling.md.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/export.h"
#include "flaunay/flaunay.hpp"

/// Triangulations over the ranks of MPI.
namespace flaunay::mpi {

/// The options of triangulate, the same on all ranks but for `device`.
struct Options {
  /// The rank's device, named as for Triangulator. Several names with commas between them: the ranks of a
  /// machine take them in turn.
  std::string device;
  bool neighbors = true;  ///< compute Triangulation::neighbors
  bool areas = false;     ///< compute Triangulation::areas
  /// Points that a rank should have at most in rounds after the first, in which as few ranks as possible work
  /// on what is left. 0: a sixteenth of the mean of the first round, but at least 65,536.
  std::size_t round_points = 0;
};

/// A round: each of some ranks triangulates its points, keeps what is final and hands on the rest.
struct Round {
  std::uint64_t points = 0;     ///< distinct points of the round; of the first one, with duplicates
  std::uint64_t ranks = 0;      ///< ranks that triangulated
  std::uint64_t most = 0;       ///< the most points that one of them had
  std::uint64_t triangles = 0;  ///< triangles that became final
  std::uint64_t handed_on = 0;  ///< points that went on to the next round
};

/// The statistics of a call. The first members are the same on all ranks.
struct Statistics {
  std::uint64_t points = 0;         ///< input points of all ranks
  std::uint64_t duplicates = 0;     ///< input points that are not their own representative
  std::uint64_t triangles = 0;      ///< number of rows of all ranks
  std::uint64_t hull_vertices = 0;  ///< number of hull vertices
  std::uint64_t undecided = 0;      ///< predicates that needed exact evaluation
  /// Points that devices without fp64 left to their hosts; see flaunay::Statistics::note.
  std::uint64_t host_points = 0;
  std::vector<Round> rounds;  ///< in the order in which they ran
  std::string device;         ///< this rank's device
  /// Points and results that this rank sent to others, in bytes.
  std::uint64_t bytes_sent = 0;
  std::vector<PhaseStatistics> phases;  ///< of this rank, with the time that it waited for others
  double seconds = 0;                   ///< wall time
};

/// A rank's part of a triangulation. Points are numbered over all ranks: those of rank 0 first, then those of
/// rank 1, and so on. Rows (triangles) are numbered so, too.
struct Triangulation {
  /// 3 point numbers per row, counter-clockwise, smallest number first.
  std::vector<std::int64_t> triangles;
  /// 3 row numbers per row: the triangle opposite to each vertex, -1 beyond the hull. Empty unless
  /// Options::neighbors.
  std::vector<std::int64_t> neighbors;
  /// One per row: the triangle's area, as flaunay::Triangulation::areas. Empty unless Options::areas.
  std::vector<double> areas;
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order. On rank 0; empty on the others.
  std::vector<std::int64_t> hull;
  /// One per point that this rank gave: the smallest number of a point with the same coordinates.
  std::vector<std::int64_t> representatives;
  std::int64_t first_point = 0;  ///< the number of the first point that this rank gave
  std::int64_t first_row = 0;    ///< the number of this rank's first row
  Statistics statistics;         ///< what the call did and how long it took
};

/// Triangulates the points of all ranks of a communicator. All must call it; each gives n points, which may
/// be none: x0 y0 x1 y1 ... The triangles, neighbours, hull and representatives are those of
/// Triangulator::triangulate for all points together. Which rank has a triangle, and in which order rows
/// are, depends on the points and on the number of ranks and on Options::round_points, and not on how points
/// are spread over ranks or on devices.
///
/// MPI must be initialised with MPI_THREAD_FUNNELED or more. Other messages on the communicator do not
/// matter: the first call duplicates it, and its duplicate, which has its error handler, ends with it. Throws
/// what Triangulator and its triangulate throw, and Error(input) if a rank would have more points than its
/// device can take at once. All ranks throw the same error, which names the first rank that failed. If MPI
/// fails, what the communicator's error handler says happens; if it returns, that rank throws Error(internal)
/// alone. A rank has about as many points in the call as any other; each point is sent once, and a few of a
/// hundred once more. O(n log n) work over all ranks.
FLAUNAY_API Triangulation triangulate(MPI_Comm communicator, const double* coordinates, std::size_t n,
                                      const Options& options = {});
/// Uses the rank's own triangulator, for several calls. Options::device is not used.
FLAUNAY_API Triangulation triangulate(MPI_Comm communicator, Triangulator& triangulator,
                                      const double* coordinates, std::size_t n, const Options& options = {});

}  // namespace flaunay::mpi
