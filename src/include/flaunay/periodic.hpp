// Points on a torus or a cylinder: a plane that repeats itself in x and y, or in one of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "flaunay/chunks.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Takes n points, x0 y0 x1 y1 ..., to their places in the period, as Triangulator::triangulate does. Returns
/// the period as it is rounded. Throws Error(usage) for a period that is none, and Error(input) for points
/// that are not finite. O(n).
FLAUNAY_API Period take_to_places(const Period& period, double* points, std::size_t n);

/// Where a triangulation on a torus or a cylinder is written, in pieces. There is no hull.
class FLAUNAY_API PeriodicMeshSink : public MeshSink {
 public:
  ~PeriodicMeshSink() override;
  /// Stores `count` values as the entries [first, first + count) of Triangulation::corner_offsets; throws an
  /// Error if it cannot. It is called for all triangles, in any order.
  virtual void write_offsets(std::uint64_t first, const std::int8_t* offsets, std::size_t count) = 0;
};

/// Triangulates one set of points on a torus or a cylinder in chunks, as triangulate_chunks does in the
/// plane. The set of triangles with their offsets and neighbours, and the representatives are those of
/// Triangulator::triangulate; rows are in the order that triangulate_chunks says, and indices are 64-bit
/// numbers.
///
/// First, all points are read once more, on a cylinder twice, to find those near the border ("images" for
/// progress). Their images are held in memory and count as 48 bytes each, beside what chunks need. If these
/// were too few, which is found out at the end, all begins again with a wider margin, and everything is
/// written again. So there may be rows of no use beyond the number of triangles that is returned, but never
/// more than 2 n. Statistics are of the last time; rounds count images as points. Throws what
/// Triangulator::triangulate and triangulate_chunks throw; Error(input), too, if the images do not fit
/// memory_bytes, as if most points are near the border. O(n log n) work.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(PointSource& points, const Period& period,
                                                        PeriodicMeshSink& sink,
                                                        const ChunkOptions& options = {});
/// Points and results are in memory; there is no hull. offsets: room for 12 n numbers, or null. Throws as the
/// triangulate_chunks that has these arrays, too.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(const double* coordinates, std::uint64_t n,
                                                        const Period& period,
                                                        const MeshArrays<std::int32_t>& results,
                                                        std::int8_t* offsets,
                                                        const ChunkOptions& options = {});
/// Results have 64-bit indices.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(const double* coordinates, std::uint64_t n,
                                                        const Period& period,
                                                        const MeshArrays<std::int64_t>& results,
                                                        std::int8_t* offsets,
                                                        const ChunkOptions& options = {});

}  // namespace flaunay
