// The stages of mode blocks and the data between them: divide turns blocks into edge rings, fans makes these
// canonical, mesh turns them into triangles. Each stage is one file with the name of its kernel file. On
// devices with many lanes divide is two stages, halve and merge.
// points/distribute.hpp makes the blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blocks/halving.h"
#include "blocks/milestones.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "points/device_mesh.hpp"
#include "points/distribute.hpp"
#include "points/rings.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {

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

/// The result of stage `halve` for stage `merge`, from the scratch arena.
struct HalvedBlocks {
  host::Buffer<cl_int> block_of_place{};
  host::Buffer<cl_uchar> axes{};
};

/// Depths of parts in their blocks.
struct Depths {
  int least = 0, end = kernel::MOST_DEPTH;
};

/// Blocks that are triangulated part by part (kernels/blocks/parts.h): all parts of at most this height, and
/// higher ones of blocks that had more than 2^depth. Arrays are from the scratch arena.
struct PartsOfBlocks {
  int height = 0, depth = 0;
  HalvedBlocks halved{};
  host::Buffer<kernel::solved_block> ends{};  ///< by half the place of a part's first vertex
};

/// How many parts this number of blocks may have. If they have fewer points each than local memory holds, it
/// is not worth while to leave the parts of a few larger ones apart.
std::size_t most_frames(const points::Workspace& work, std::size_t blocks, std::size_t places);

/// Triangulates blocks and merges them; sets the representatives of duplicates. Does not wait: await_rings
/// sets the numbers in Rings that are on the host. Sets a milestone for some of the blocks each, and for each
/// level of merges, unless milestones are null.
points::Rings divide(points::Workspace& work, const points::Blocks& blocks,
                     const host::Buffer<cl_int>& representatives, Milestones* milestones = nullptr);
/// The first part of divide: triangulates each block. If the host has not read the blocks' sizes, those that
/// are larger than expected are left as blocks without vertices; that takes `blocks_in_parallel`.
/// account: from make_account, added to. parts: if not null, set to the parts that blocks may be left as.
points::Rings solve(points::Workspace& work, const points::Blocks& blocks,
                    const host::Buffer<cl_int>& representatives, const host::Buffer<cl_uint>& account,
                    Milestones* milestones = nullptr, PartsOfBlocks* parts = nullptr);
/// Merges the parts of each block, if they are several.
void merge_parts(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings,
                 PartsOfBlocks& parts);
/// The account of rings, with nothing in it.
host::Buffer<cl_uint> make_account(points::Workspace& work);
/// The second part of divide: merges the triangulations of blocks.
void merge(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings,
           Milestones* milestones = nullptr);
/// Waits once. Throws as check_account does.
void await_rings(points::Workspace& work, const points::Blocks& blocks, points::Rings& rings);
/// Throws Error(internal) if the account of rings says that a merge has failed.
void check_account(const cl_uint* account);

/// Blocks of points. The host only knows upper bounds of their sizes.
struct PointBlocks {
  std::size_t count = 0;   ///< number of blocks; they may be empty
  std::size_t points = 0;  ///< number of places; the blocks occupy all or the first of them
  /// Blocks with more points than this get no vertices, as if all their points were duplicates.
  std::size_t largest = 0;
  host::Buffer<cl_int> offsets{};  ///< count + 1: the first point of each block
  /// As in Blocks.
  host::Buffer<cl_double2> vertices{};
  host::Buffer<cl_int> source{};

  int height() const { return kernel::halving_depth(static_cast<int>(largest)); }
};

/// Triangulates blocks of any points, as divide does before it merges them, on devices with many lanes: the
/// halves of all blocks at once. rings: with all its arrays, of the sizes that divide gives them; the account
/// is added to. Edges may be numbered otherwise than by divide on other devices, but are the same. Does not
/// wait. Makes up to 5 launches, 2 more for few points, 2 or 3 per height of parts that local memory does not
/// hold, and some more if blocks may have more points than local memory has room for, or if most are tiny.
/// parts: as of solve.
void solve_in_parallel(points::Workspace& work, const PointBlocks& blocks,
                       const host::Buffer<cl_int>& representatives, const points::Rings& rings,
                       PartsOfBlocks* parts = nullptr);

/// Sorts each block's points, drops duplicates, and halves the remaining points down to leaves. Sets the
/// vertices, the sources, the representatives of duplicates, and in `rings` the numbers of vertices and the
/// entries of empty blocks.
HalvedBlocks halve(points::Workspace& work, const PointBlocks& blocks,
                   const host::Buffer<cl_int>& representatives, const points::Rings& rings);
/// Merges the halves of parts from one height up to another; at height 0, makes the leaves. depths: of the
/// parts that local memory does not hold.
void merge_halves(points::Workspace& work, const PointBlocks& blocks, const PartsOfBlocks& parts,
                  const points::Rings& rings, int from, int to, Depths depths = {});
/// Merges the blocks of a level of the trees: merges [first, end).
void merge_trees(points::Workspace& work, const points::Blocks& blocks, std::size_t first, std::size_t end,
                 const points::Rings& rings);

/// Makes the triangulations canonical, unless the account says that there were no ties: then they are
/// already. Does not wait. Temporary memory: 6 bytes per point.
void make_fans(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings);
/// The same of blocks that are not merged, in one launch.
void make_fans_of_blocks(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings);

/// The size of a mesh.
struct MeshSizes {
  std::vector<std::size_t> triangle_offsets, hull_offsets;  ///< sets + 1
  std::size_t vertices = 0;
  host::Buffer<cl_uint> first_rows{};  ///< the first triangle of each vertex; the last entry is their total

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
MeshSizes count_mesh(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings);

/// A triangle is written at its vertex in the middle; no vertex is in the middle of more than two triangles.
constexpr std::size_t kMostTrianglesPerPoint = 2;

/// Writes the parts of the mesh that have memory, with milestones unless they are null. Neighbours and
/// halfedges need the triangles. Does not wait.
void write_mesh(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings,
                const MeshSizes& sizes, const points::DeviceMesh& mesh, Milestones* milestones = nullptr);

}  // namespace flaunay::blocks
