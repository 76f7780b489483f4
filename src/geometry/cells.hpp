// Cells: polygons of several triangles with the same circumcircle, where the Delaunay triangulation is not
// unique.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/mesh.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::geometry {

/// One cell of a mesh.
struct Cell {
  std::vector<std::int32_t> triangles;  ///< in ascending order
  std::vector<std::int32_t> corners;    ///< counter-clockwise from the smallest; two more than triangles
  /// The twin of the side from corner k to the next corner; -1 on the hull.
  std::vector<std::int32_t> outer;
};

/// Two positions in Cell::corners, the smaller first.
using Chord = std::pair<std::int32_t, std::int32_t>;

/// Finds the cells of a Delaunay triangulation one by one. The caller may change the triangles of a cell
/// before it asks for the next one.
class CellFinder {
 public:
  /// points: indexed by the triangles of the mesh. Throws Error(internal) if an edge is not Delaunay. O(n).
  CellFinder(const Predicates& predicates, const Point* points, const Mesh& mesh);

  /// Finds the next cell; returns false after the last one. O(size of the cell).
  bool next(Cell& cell);

 private:
  void flood(std::int32_t seed, Cell& cell);
  void walk(std::int32_t start, Cell& cell) const;

  const Mesh& mesh_;
  std::vector<char> dissolved_;  // per half-edge: whether it is inside a cell
  std::vector<std::int32_t> seeds_;
  std::vector<char> done_;
  std::size_t position_ = 0;
};

/// Triangulates a cell again, with the chords as edges. Each part between chords becomes a fan from the first
/// corner of the part; without chords the cell is a fan from its smallest corner. chords: sorted by their
/// second corner and, if that is equal, by descending first corner; they may be repeated, and be sides of the
/// cell. Returns false, and leaves the mesh partly changed, if chords cross. O(k log k) for k corners and
/// chords.
bool fan_cell(const Cell& cell, const std::vector<Chord>& chords, Mesh& mesh);

}  // namespace flaunay::geometry
