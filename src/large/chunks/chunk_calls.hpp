// Triangulations in chunks: with or without values at the points, and on a torus or a cylinder.
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

/// See flaunay::triangulate_chunks. The first is of the plane. values: of the points, or null. folding: if
/// some points are images; otherwise null.
ChunkStatistics triangulate_chunks(PointSource& points, const chunks::Values* values, MeshSink& sink,
                                   const ChunkOptions& options, chunks::Folding* folding = nullptr);
ChunkStatistics triangulate_chunks_on_torus(PointSource& points, MeshSink& sink, const ChunkOptions& options);

}  // namespace flaunay::call
