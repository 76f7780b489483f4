// The stages of mode blocks and the data between them: divide turns blocks into edge rings, fans makes these
// canonical, mesh turns them into triangles. Each stage is one file with the name of its kernel file.
// points/distribute.hpp makes the blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blocks/milestones.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "points/distribute.hpp"
#include "points/rings.hpp"
#include "shared/limits.h"
#include "shared/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {

using namespace geometry;
using namespace points;

using host::Arena;
using host::Buffer;

/// Bytes of the persistent arena per point: vertices, their sources and edges, and the arrays of blocks.
constexpr std::size_t kPersistentBytesPerPoint = 97;

/// The share of a call's time that is over when a stage ends, for progress.
constexpr double kBlocksMade = 0.15;
constexpr double kBlocksSolved = 0.7;
constexpr double kBlocksMerged = 0.8;
constexpr double kMeshCounted = 0.85;
constexpr double kTrianglesWritten = 0.95;

/// Triangulates blocks and merges them; sets the representatives of duplicates. Does not wait: await_rings
/// sets the numbers in Rings that are on the host. Sets a milestone for some of the blocks each, and for each
/// level of merges, unless milestones are null.
Rings divide(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives,
             Milestones* milestones = nullptr);
/// An upper bound of the scratch memory of divide for n points, without the arrays of blocks.
std::size_t solve_bytes(const Tuning& tuning, std::size_t n);
void await_rings(Workspace& work, const Blocks& blocks, Rings& rings);

/// Makes the triangulations canonical, which they are already if there were no ties. Does not wait. Temporary
/// memory: 6 bytes per point.
void make_fans(Workspace& work, const Blocks& blocks, const Rings& rings);

/// The size of a mesh.
struct MeshSizes {
  std::vector<std::size_t> triangle_offsets, hull_offsets;  ///< sets + 1
  std::size_t vertices = 0;
  Buffer<cl_uint> first_rows{};  ///< the first triangle of each vertex; the last entry is their total

  std::size_t triangles() const { return triangle_offsets.back(); }
  std::size_t hull_vertices() const { return hull_offsets.back(); }
};

/// Computes the sizes of a mesh from the number of vertices of each block and from the number of steps of the
/// walk around each set's hull. set_blocks: the first block of each set, and the number of blocks. counted:
/// the number of triangles as the vertices count them; throws Error(internal) if it contradicts.
MeshSizes mesh_sizes(const std::vector<cl_int>& set_blocks, const std::vector<cl_int>& distinct,
                     const std::vector<cl_int>& walked, std::size_t counted);

/// Counts triangles and hull vertices, and marks the edges on the hull in `rings`. first_rows are for
/// write_mesh and come from the scratch arena. Waits once. Throws Error(internal) if numbers contradict each
/// other.
MeshSizes count_mesh(Workspace& work, const Blocks& blocks, const Rings& rings);

/// A triangle is written at its vertex in the middle; no vertex is in the middle of more than two triangles.
constexpr std::size_t kMostTrianglesPerPoint = 2;

/// The arrays for the parts of a mesh, as flaunay.hpp describes them. Parts that are not wanted have no
/// memory.
struct MeshBuffers {
  Buffer<cl_int> triangles{}, neighbors{}, halfedges{}, hull{};
};

/// Writes the parts of the mesh, with milestones unless they are null. Neighbours and halfedges need the
/// triangles. Does not wait.
void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                const MeshBuffers& buffers, Milestones* milestones = nullptr);

}  // namespace flaunay::blocks
