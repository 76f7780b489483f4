// Triangulations in chunks, with or without values at the points.
#pragma once

#include <cstdint>

#include "flaunay/chunks.hpp"
#include "large/chunks/folding.hpp"
#include "large/chunks/values.hpp"

namespace flaunay::call {

/// The least memory that a call needs.
constexpr std::uint64_t kLeastChunkBytes = std::uint64_t{128} << 20;
/// The bytes that a call may use. Throws Error(usage) if they are less.
std::uint64_t chunk_memory(const ChunkOptions& options);

/// Throws Error(usage) if there are points, but no coordinates; Error(input) for more points than results
/// with indices up to most_index can refer to.
void check_chunk_arrays(const double* coordinates, std::uint64_t n, std::uint64_t most_index);

/// See flaunay::triangulate_chunks. values: of the points, or null. folding: if some points are images;
/// otherwise null.
ChunkStatistics triangulate_chunks(PointSource& points, const chunks::Values* values, MeshSink& sink,
                                   const ChunkOptions& options, chunks::Folding* folding = nullptr);

}  // namespace flaunay::call
