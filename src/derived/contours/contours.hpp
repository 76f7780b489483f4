// Contour lines of values at the corners of triangles.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "flaunay/terrain.hpp"
#include "host/runtime.hpp"

namespace flaunay::contours {

struct Place {
  double x, y;
};
inline bool operator==(Place a, Place b) { return a.x == b.x && a.y == b.y; }
inline bool operator<(Place a, Place b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }
using Line = std::vector<Place>;

/// A side of a triangle, its smaller end first.
using Side = std::pair<Place, Place>;

/// A part of a line, and the sides between parts of the mesh on which it begins and ends.
struct Piece {
  Line line;
  std::optional<Side> begin, end;
  std::vector<Place> vertices;  ///< of the mesh, through which it goes
  bool is_in_order = true;      ///< whether rounding certainly makes it touch itself at these alone
};

/// Throws Error(usage) unless heights are finite and increase, and max_edge is a length.
void check(const std::vector<double>& heights, double max_edge);

/// The lines of triangles that come in parts; see trace_contours. The runtime runs natively.
class Lines {
 public:
  /// The arguments have been checked.
  Lines(const std::vector<double>& heights, double max_edge)
      : heights_(heights), max_edge_(max_edge), pieces_(heights.size()) {}

  /// Adds a part, whose arrays are there. A triangle is its own neighbour where the other one, if there is
  /// one, belongs to another part.
  void add(host::Runtime& runtime, const MeshView& mesh, const double* values);
  /// The lines of all parts. To be called once.
  Contours finish(host::Runtime& runtime);

 private:
  std::vector<double> heights_;
  double max_edge_;
  std::vector<std::vector<Piece>> pieces_;  // of each height
};

}  // namespace flaunay::contours
