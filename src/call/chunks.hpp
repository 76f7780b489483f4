// Triangulations in chunks, with or without values at the points.
#pragma once

#include "flaunay/chunks.hpp"
#include "large/chunks/values.hpp"

namespace flaunay::call {

/// See flaunay::triangulate_chunks. values: those of the points, or null.
ChunkStatistics triangulate_chunks(PointSource& points, const chunks::Values* values, MeshSink& sink,
                                   const ChunkOptions& options);

}  // namespace flaunay::call
