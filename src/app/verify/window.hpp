// The check of the triangles of one window of rows.
#pragma once

#include <cstddef>
#include <cstdint>

#include "app/files/npy.hpp"
#include "app/verify/buffer.hpp"
#include "app/verify/open_edges.hpp"
#include "prove/describe.hpp"
#include "prove/exact.hpp"
#include "prove/half_edges.hpp"

namespace flaunay::prove {

/// Arrays for one window after the other. Vertices are named by their numbers in the window.
class Window {
 public:
  static constexpr std::uint32_t kNone = HalfEdges<std::uint32_t, std::uint32_t>::kNone;
  /// Bytes per row that the arrays take at most, if no two rows have a vertex in common.
  static constexpr std::uint64_t kRowBytes = 3 * (8 + 16 + 4) + 3 * (4 + 8 + 4);

  /// piece_rows: rows of `neighbors` that are read at a time.
  Window(std::uint64_t most_rows, std::size_t piece_rows);

  /// To be filled before check: the window's rows, then the id and the coordinates of each vertex.
  std::uint64_t first_row = 0;
  std::uint64_t rows = 0;
  std::uint64_t vertices = 0;
  Buffer<std::uint32_t> corners;
  Buffer<std::uint64_t> ids;
  Buffer<double> coordinates;

  /// Checks the triangles and the edges between them, and adds the half-edges without twin to `edges`.
  /// neighbors may be null. Throws a Violation.
  void check(io::RowSource* neighbors, OpenEdges& edges);

  std::uint64_t cocircular_edges() const { return cocircular_; }  ///< of all windows checked so far
  std::uint64_t matched_edges() const { return matched_; }
  std::uint64_t exact_evaluations() const { return predicates_.exact_evaluations(); }

 private:
  std::uint32_t origin(std::uint32_t half_edge) const { return half_edges_.origin(half_edge); }
  std::uint32_t target(std::uint32_t half_edge) const { return half_edges_.target(half_edge); }
  const double* place(std::uint32_t vertex) const { return coordinates.data() + 2 * std::size_t{vertex}; }
  Vertex vertex(std::uint32_t i) const { return {ids[i], {place(i)[0], place(i)[1]}}; }
  std::string describe_row(std::uint32_t t) const {
    return describe_triangle(first_row + t, vertex(corners[3 * t]), vertex(corners[3 * t + 1]),
                             vertex(corners[3 * t + 2]));
  }

  void check_orientations();
  void match_half_edges();
  void check_edges(io::RowSource* neighbors, OpenEdges& edges);
  void check_pair(std::uint32_t half_edge, std::uint32_t twin);

  HalfEdges<std::uint32_t, std::uint32_t> half_edges_{corners.data()};
  Buffer<std::uint32_t> begins_;  // see HalfEdges::match
  Buffer<std::uint64_t> keys_;
  Buffer<std::uint32_t> twins_;   // of each half-edge; kNone without a twin in the window
  Buffer<std::int64_t> claimed_;  // a piece of the neighbours
  std::size_t piece_rows_;
  std::uint64_t cocircular_ = 0, matched_ = 0;
  ExactPredicates predicates_;
};

}  // namespace flaunay::prove
