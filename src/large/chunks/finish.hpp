// Finds the final triangles of a chunk and the points to hand on: a round of blocks
// (kernels/blocks/rounds.cl) with chunks in the place of blocks. Both decide by blocks/certify.h and
// blocks/open_sectors.h. Unlike there, the outside is no triangle here: the vertices of the hull go on to the
// last round, which has the hull.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "arithmetic/records.h"
#include "blocks/records.h"
#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.hpp"
#include "geometry/magnitudes.hpp"
#include "host/native/threads.hpp"
#include "large/chunks/folding.hpp"
#include "large/chunks/points.hpp"
#include "large/chunks/values.hpp"

namespace flaunay::chunks {

/// Where a chunk lies: its rectangle, on or beyond whose sides all other points are, and the box around all
/// points, not scaled.
struct Place {
  kernel::vertex_box rectangle, all;
};

/// A triangulated chunk. Rows are counted from the number of its first one, which may be known only later.
class FinishedChunk {
 public:
  /// mesh: the triangulation of the chunk's points, with neighbours, and with areas if these are wanted.
  /// scaling: of all points. folding: says which triangles get rows; null: all. O(points), and in later
  /// rounds O(points log points).
  FinishedChunk(host::Threads& threads, ChunkPoints points, Triangulation mesh, const Place& place,
                const geometry::Scaling& scaling, const Folding* folding = nullptr);

  /// The number of triangles that are final and get a row, and of those that get none.
  std::uint64_t triangles() const { return triangles_; }
  std::uint64_t dropped() const { return dropped_; }
  const ChunkPoints& points() const { return points_; }
  const Triangulation& mesh() const { return mesh_; }

  /// Gives each representative the common value of its duplicates, unless it is one of the first `fixed`
  /// points of the input. Call it in the first round, before points are handed on.
  void merge_values(Duplicates duplicates, std::uint64_t fixed);
  /// The points around which triangles are missing.
  ChunkPoints handed_on(std::uint64_t first_row) const;
  /// The edges between triangles with and without rows, and, if this is the only chunk of the last round,
  /// those on the hull.
  std::vector<kernel::seam_record> folds(const Folding& folding, std::uint64_t first_row, bool is_last) const;
  /// Writes the final triangles, their areas, and neighbours, including missing ones of earlier rounds.
  void write(MeshSink& sink, std::uint64_t first_row) const;
  /// The final triangles with the values of their corners. Nothing else may be called after it.
  ChunkSurface take_surface() &&;
  /// Writes which points are not their own representatives.
  void write_duplicates(MeshSink& sink) const;
  /// Writes the hull, if this is the only chunk of the last round.
  void write_hull(MeshSink& sink) const;

 private:
  // Instead of rows.
  static constexpr std::int32_t kNotFinal = -1, kDropped = -2;
  // Instead of open edges.
  static constexpr std::int64_t kNone = -1, kFold = -2;

  // A side of a final triangle whose other side is not final in this chunk, or is final and has no row.
  struct Border {
    std::int32_t triangle, corner;
    std::int64_t closed;  // the open edge that it closes, kNone, or kFold for a side that is final
  };

  // An edge that is open at a point of the chunk.
  struct OpenAt {
    std::int32_t at;
    OpenEdge edge;
  };

  std::int32_t corner(std::size_t t, int k) const { return mesh_.triangles[3 * t + k]; }
  std::int64_t entry(const Border& border, std::uint64_t first_row) const;
  std::int64_t row_beyond(const Border& border) const;
  void write_rows(MeshSink& sink, std::uint64_t first_row) const;
  void write_links(MeshSink& sink, std::uint64_t first_row) const;
  bool is_missing(std::size_t t) const;
  void find_final(host::Threads& threads, const kernel::block_frame& frame, const Folding* folding);
  void number_edge_ends(kernel::scaling scale);
  void find_border(host::Threads& threads);
  std::vector<OpenAt> open_edges(std::uint64_t first_row) const;
  std::vector<char> unfinished() const;
  std::int64_t open_edge(std::int32_t from, std::int32_t to, int begins) const;

  ChunkPoints points_;
  Triangulation mesh_;
  double orient_bound_;
  std::vector<kernel::double2> scaled_;   // the points, and the ends of open edges in other chunks
  std::vector<kernel::open_edge> edges_;  // the open edges, with places in scaled_
  std::vector<std::int32_t> rows_;        // by triangle: which one of those with rows, kNotFinal or kDropped
  std::vector<Border> border_;
  std::uint64_t triangles_ = 0, dropped_ = 0;
};

}  // namespace flaunay::chunks
