// From a triangulation to a map: rasters and contours of values at points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/export.h"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Triangles of points in host memory, as Triangulation and ConstrainedTriangulation have them:
/// counter-clockwise, of one set, and with neighbours. Refers to the caller's arrays.
struct MeshView {
  const double* coordinates = nullptr;      ///< x0 y0 x1 y1 ...
  std::size_t points = 0;                   ///< number of points
  const std::int32_t* triangles = nullptr;  ///< 3 points per triangle
  const std::int32_t* neighbors = nullptr;  ///< the triangle opposite to each corner, or -1
  std::size_t count = 0;                    ///< number of triangles
};

/// The pixels of a raster. The centre of the pixel in row r and column c is (x + c dx, y + r dy), each
/// product and each sum rounded to double precision.
struct RasterGrid {
  double x = 0;             ///< the centre of the pixel in row 0 and column 0
  double y = 0;             ///< its other coordinate
  double dx = 1;            ///< from a column to the next one; positive
  double dy = 1;            ///< from a row to the next one; negative if north is up
  std::size_t rows = 0;     ///< less than 2^31
  std::size_t columns = 0;  ///< less than 2^31
};

/// The options of a raster.
struct RasterOptions {
  /// Pixels in triangles with a longer edge have no value, as if these were not there: across bays and gaps.
  /// Lengths are compared by their squares, rounded.
  double max_edge = std::numeric_limits<double>::infinity();
  double fill = std::numeric_limits<double>::quiet_NaN();  ///< of pixels without a value
};

/// Computes a raster by linear interpolation in the triangles. pixels: room for rows x columns numbers, row
/// by row. values: one per point. A pixel has the value at its centre; which triangle that lies in is decided
/// exactly. The border belongs to the triangles, and a centre on an edge between two of them to one: to that
/// which it would lie in if it were moved to the right, by less than anything. At a point it has the point's
/// own value. So the raster depends on points, values and triangles alone, not on their order, the device or
/// the number of threads. O(triangles + pixels). Throws Error(usage) for a grid that makes no sense and for
/// triangles of other points; Error(input) for coordinates that are not finite, or so large or fine that they
/// are not multiples of 2^-511 below 2^509, and for pixels so small that rounding moves them by a quarter.
FLAUNAY_API void rasterize(Triangulator& triangulator, const MeshView& mesh, const double* values,
                           const RasterGrid& grid, const RasterOptions& options, double* pixels);

/// How hills are shaded.
struct ShadingOptions {
  double vertical_factor = 1;  ///< by which heights are multiplied; positive
  bool is_geographic = false;  ///< x and y are longitudes and latitudes in degrees, and heights metres
  bool colors = false;         ///< by height, from green over yellow and brown to white
};

/// Draws a raster of heights as hills that are lit from the north-west, 45 degrees high. picture: room for
/// rows x columns bytes of grey, or with colours of red, of green and of blue, and then for as many of alpha,
/// which is 0 where a pixel or one that its slope is taken from is not finite. O(pixels). Throws Error(usage)
/// for a factor and a grid that make no sense, and Error(input) as rasterize does.
FLAUNAY_API void shade_hills(const RasterGrid& grid, const double* pixels, const ShadingOptions& options,
                             std::uint8_t* picture);

/// Contour lines at several heights. Those of one height follow each other, in the order of their points.
struct Contours {
  std::vector<double> coordinates;    ///< x and y per point of a line
  std::vector<std::size_t> offsets;   ///< lines + 1 values: line i has points [offsets[i], offsets[i + 1])
  std::vector<std::int32_t> heights;  ///< per line the number of its height
};

/// Computes the contour lines of values that are linear in each triangle. Heights must increase. Higher
/// values are on the left of a line. It is closed, with its first point again at the end, or begins and ends
/// at the border of the triangles. A closed line begins at its lexicographically smallest point. A value that
/// equals a height counts as above it; so no two lines cross, but by rounding, but they can have points in
/// common at such a vertex. No line goes through a point twice, and none crosses itself, which is decided
/// exactly: what a line does between two visits of a point is a closed line of its own, or left out if that
/// is hardly wider than rounding; docs/exactness.md says how far anything moves. Triangles with a longer edge
/// than max_edge, and those with a value that is not finite, are left out. Points are rounded, on each edge
/// the same for both triangles; equal ones that follow each other are one, and lines of one point, and closed
/// ones of two, are none. So the result depends on points, values and triangles alone, not on their order or
/// the number of threads. It runs on threads of the host. O(triangles log heights + points of lines), and O(k
/// log k) for a line of k points in triangles thinner than rounding, as a rule. Throws Error(usage) for
/// heights that do not increase or are not finite, and for triangles of other points.
FLAUNAY_API Contours trace_contours(Triangulator& triangulator, const MeshView& mesh, const double* values,
                                    const std::vector<double>& heights,
                                    double max_edge = std::numeric_limits<double>::infinity());

/// Points with a value each, such as heights, that are read in pieces.
class FLAUNAY_API ValuedPoints : public PointSource {
 public:
  ~ValuedPoints() override;
  /// Reads the values of the points [first, first + count), as read() does coordinates.
  virtual void read_values(std::uint64_t first, std::size_t count, double* values) = 0;
};

/// Which value a place has where several points are equal. The mean is that of doubles, summed in ascending
/// order.
enum class Duplicates { highest, lowest, mean };

/// Computes the raster of points in chunks: triangulates them as triangulate_chunks does, and scans triangles
/// into pixels as they become final. pixels: as for rasterize, such as a memory-mapped file. The raster is
/// that of rasterize with all triangles, whatever the chunks. memory_bytes of the chunks' options do not
/// count the pixels; on disk, values take kScratchBytesPerValue per point. Throws as triangulate_chunks and
/// rasterize do, and Error(input) for a value that is not finite.
FLAUNAY_API ChunkStatistics rasterize_chunks(ValuedPoints& points, Duplicates duplicates,
                                             const RasterGrid& grid, const RasterOptions& options,
                                             double* pixels, const ChunkOptions& chunks = {});

/// Lines that become edges of the triangles. The arrays belong to the caller.
struct Breaklines {
  const double* coordinates = nullptr;  ///< x0 y0 x1 y1 ... of the lines' points
  const double* values = nullptr;  ///< one per point: that of its place, whatever other points have there
  std::size_t points = 0;          ///< number of points; in messages, they are numbered before the others
  const std::int32_t* segments = nullptr;  ///< 2 indices of these points per segment
  std::size_t segment_count = 0;           ///< number of segments
};

/// In the same pass the contours of trace_contours, with the max_edge of the options, of the triangulation in
/// which breaklines are edges; the grid may have no pixels. Contours, and the triangles that breaklines
/// cross, are in memory, which memory_bytes do not count. Throws as trace_contours and
/// Triangulator::constrained, too.
FLAUNAY_API ChunkStatistics rasterize_chunks(ValuedPoints& points, Duplicates duplicates,
                                             const RasterGrid& grid, const RasterOptions& options,
                                             double* pixels, const std::vector<double>& heights,
                                             Contours& contours, const Breaklines& breaklines,
                                             const ChunkOptions& chunks = {});

}  // namespace flaunay
