// Breaklines in triangulations in chunks: a triangle that no line crosses is one of the constrained
// triangulation, too; the others are kept, and the area that they cover is triangulated again in the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "flaunay/constrained.hpp"
#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"
#include "large/chunks/values.hpp"

namespace flaunay::chunks {

/// Points of breaklines, and then others.
class PointsWithLines : public ValuedPoints {
 public:
  PointsWithLines(const Breaklines& lines, ValuedPoints& others) : lines_(lines), others_(others) {}
  std::uint64_t size() const override { return lines_.points + others_.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override;
  void read_values(std::uint64_t first, std::size_t count, double* values) override;

 private:
  const Breaklines& lines_;
  ValuedPoints& others_;
};

class CrossedTriangles {
 public:
  /// Throws Error(usage) for segments of other points.
  explicit CrossedTriangles(const Breaklines& lines);

  /// Moves the triangles of a chunk that lines cross here.
  void take_from(host::Runtime& runtime, ChunkSurface& surface);
  /// Triangulates their area with lines as edges. constrain: triangulates with constraints and neighbours.
  ChunkSurface triangulated(
      const std::function<ConstrainedTriangulation(const std::vector<double>&, const Constraints&)>&
          constrain) const;

 private:
  struct Box {
    double low_x, low_y, high_x, high_y;
  };
  std::size_t band_of(double y) const;
  template <typename Visit>
  void for_each_near(const Box& box, const Visit& visit) const;

  const Breaklines& lines_;
  std::vector<Box> boxes_;  // of segments
  // Bands of equal heights, with the segments in each.
  double low_ = 0, bands_by_ = 0;
  std::vector<std::vector<std::uint32_t>> bands_;
  geometry::Magnitudes magnitudes_;
  // For each triangle taken, x and y and the value of each of its three corners.
  std::vector<double> coordinates_, values_;
};

}  // namespace flaunay::chunks
