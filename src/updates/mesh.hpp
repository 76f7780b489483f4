// A triangulation in the memory of a runtime, which batches of vertices change. docs/updates.md explains it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "flaunay/dynamic.hpp"
#include "host/runtime.hpp"
#include "refinement/records.h"
#include "updates/records.h"

namespace flaunay::updates {

using Ids = std::vector<std::int32_t>;
using host::Buffer;

/// An edge of a constraint that was split at a vertex.
struct SplitEdge {
  std::int32_t from, to, vertex;
};

/// Rows are triangles and, beyond the hull, ghosts; some are free. Vertices have the numbers of points. There
/// is at least one triangle, or nothing at all.
class Mesh {
 public:
  explicit Mesh(host::Runtime& runtime) : runtime_(runtime) {}

  /// Replaces the mesh by a triangulation with neighbours, of at least one triangle. coordinates: per number.
  /// shift: they are multiplied by 2^shift. edges: per corner, the segment of the edge opposite, or -1; empty
  /// if there are no constraints.
  void load(const std::vector<double>& coordinates, int shift, const Triangulation& triangulation,
            const Ids& edges);
  /// Whether it must be loaded before the next batch, because batches can no longer be counted.
  bool must_be_loaded() const { return batch_ >= kMostBatches; }
  int shift() const { return shift_; }
  std::size_t rows() const { return rows_; }
  std::size_t triangles() const { return triangles_; }

  /// Begins to account for changes.
  void begin_batch();
  /// Reports the changes since then.
  void end_batch(Changes& changes);
  /// The rows that held triangles when the batch began, also if it has ended by an error.
  Ids old_triangles();

  /// Chooses vertices of the mesh where walks begin, if there are many more than when this was done last.
  /// chosen(n): returns about n vertices, all over the plane.
  template <typename Choose>
  void update_hints(const std::vector<double>& coordinates, const Choose& choose) {
    if (triangles_ > 2 * hints_.points)
      make_hints(coordinates, choose(triangles_ / 2 / kVerticesPerHint + 1));
  }

  /// A vertex, and one that is in its place.
  struct Found {
    std::int32_t vertex, other;
  };
  /// Inserts vertices. coordinates: per number. Returns the vertices whose place another vertex has already,
  /// a vertex of the mesh or, after these, the smallest of several new ones. Adds split constraint edges to
  /// `splits`.
  std::vector<Found> insert(Ids vertices, const std::vector<double>& coordinates,
                            std::vector<SplitEdge>& splits);
  /// Takes vertices out. Returns whether it could: not if one has too many triangles around it, or if no
  /// triangle is left. The mesh must be loaded again then.
  bool remove(const Ids& vertices);
  /// Moves vertices to other places, as far as the mesh can be mended there. Returns those that were taken
  /// out instead, and are to be inserted; nothing if the mesh must be loaded again. are_many: none are taken
  /// out, and few edges are flipped, since triangulating anew would take less time.
  std::optional<Ids> move(Ids vertices, const std::vector<double>& coordinates, bool are_many);

  /// All rows, in host memory.
  std::vector<kernel::mesh_row> read_rows() const;

 private:
  struct Hints {
    Buffer<cl_double> xs{}, ys{};
    Buffer<cl_int> vertices{};
    std::size_t slabs = 0, points = 0;  // points: those that there were when they were made
  };
  // Rows of the mesh: all below a count, or the rows in a list.
  struct RowList {
    bool all = false;
    Buffer<cl_int> list{};
    std::size_t count = 0;
  };

  template <typename T>
  void grow(Buffer<T>& array, std::size_t used, std::size_t size);
  void reserve_rows(std::size_t rows);
  void reserve_vertices(std::size_t vertices);
  void reserve_touched(std::size_t more);
  cl_uint take_claims(std::size_t count);
  void make_hints(const std::vector<double>& coordinates, const Ids& vertices);
  std::int32_t take_row();
  Ids in_order_of_place(Ids vertices, const std::vector<double>& coordinates,
                        std::vector<Found>& doubled) const;
  std::vector<kernel::double2> scaled(const Ids& vertices, const std::vector<double>& coordinates) const;
  void swap_places(const Buffer<cl_int>& vertices, const Buffer<cl_double2>& others, std::size_t count);
  RowList rows_around(const Buffer<cl_int>& vertices, std::size_t count);
  void flip(RowList wrong);

  // One of this many vertices is a place where walks may begin; walks are then some 3 triangles long.
  static constexpr std::size_t kVerticesPerHint = 16;
  // Stamps of rows are twice as large.
  static constexpr std::int32_t kMostBatches = (1 << 30) - 2;

  host::Runtime& runtime_;
  int shift_ = 0;
  std::size_t rows_ = 0, row_room_ = 0, vertices_ = 0, vertex_room_ = 0, triangles_ = 0,
              triangles_at_begin_ = 0, rows_at_begin_ = 0;
  bool has_edges_ = false;
  Buffer<kernel::mesh_row> row_array_{};
  Buffer<cl_double2> points_{};
  Buffer<cl_int> rows_of_{}, moved_at_{};
  Buffer<cl_uint> claims_{}, visits_{};
  Buffer<cl_int> touched_{}, flips_{}, next_flips_{};
  std::size_t touched_count_ = 0;
  Hints hints_;
  Ids free_rows_;
  cl_uint next_claim_ = 0;
  std::int32_t batch_ = 0;
};

}  // namespace flaunay::updates
