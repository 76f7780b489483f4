// Cells: polygons of several triangles on one empty circle, where a Delaunay triangulation leaves a choice.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "recursive/mesh.hpp"
#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// One cell of a mesh.
struct Cell {
  std::vector<std::int32_t> triangles;  ///< ascending
  std::vector<std::int32_t> corners;    ///< counter-clockwise from the smallest; two more than triangles
  /// Twin of the side from corner k to the next; -1 beyond the hull.
  std::vector<std::int32_t> outer;
};

/// Two positions in Cell::corners, the smaller first.
using Chord = std::pair<std::int32_t, std::int32_t>;

/// Finds the cells of a Delaunay triangulation one by one. Changing the triangles of a cell that was returned
/// is allowed in between.
class CellFinder {
 public:
  /// points: by the indices that the triangles hold. Throws Error(internal) if an edge is not Delaunay. O(n).
  CellFinder(const Predicates& predicates, const Point* points, const Mesh& mesh);

  /// The next cell, or false if there is none. O(size of the cell).
  bool next(Cell& cell);

 private:
  void flood(std::int32_t seed, Cell& cell);
  void walk(std::int32_t start, Cell& cell) const;

  const Mesh& mesh_;
  std::vector<char> dissolved_;  // by half-edge: within a cell
  std::vector<std::int32_t> seeds_;
  std::vector<char> done_;
  std::size_t position_ = 0;
};

/// Triangulates a cell anew, with the chords as edges: a fan in each part between them, from the part's first
/// corner; without chords from the cell's smallest. chords: sorted by their second corner and, among those,
/// by descending first; repetitions and sides do no harm. Returns false, the mesh half changed, if chords
/// cross. O(k log k) for k corners and chords.
bool fan_cell(const Cell& cell, const std::vector<Chord>& chords, Mesh& mesh);

}  // namespace flaunay::recursive
