// The polygons outside of which a map is empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/map.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::cli {

/// Polygons, each with what is inside by the even-odd rule.
class Boundary {
 public:
  /// Throws Error(input) that names the file for a map without polygons, and for places so far away that no
  /// terrain reaches them.
  Boundary(const std::string& path, const io::Map& polygons);

  /// Takes the values of pixels away whose centres no polygon has. Rows go down.
  void leave_out(const RasterGrid& grid, double* pixels) const;
  /// The pieces of lines in the polygons, those of one height in the order of their points.
  Contours clipped(const Contours& lines) const;

 private:
  struct Edge {
    double ax, ay, bx, by;  // a is not above b
    std::size_t polygon;

    double x_at(double y) const { return ax + (bx - ax) * ((y - ay) / (by - ay)); }
  };
  struct Place {
    double x, y;
    bool operator==(const Place& other) const { return x == other.x && y == other.y; }
    bool operator<(const Place& other) const { return x < other.x || (x == other.x && y < other.y); }
  };
  using Line = std::vector<Place>;

  std::size_t band_of(double y) const;
  bool has(Place place) const;
  void find_cuts(Place p, Place q, std::vector<double>& cuts) const;
  std::vector<Line> pieces_of(const Line& line) const;

  std::vector<Edge> edges_;
  // Bands of equal heights, with the edges in each.
  double low_ = 0, bands_by_ = 0;
  std::vector<std::vector<std::uint32_t>> bands_;
};

}  // namespace flaunay::cli
