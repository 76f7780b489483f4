// The stages of Mode::hybrid and what they hand to each other: points to blocks, blocks to edge rings, edge
// rings to triangles. Each is one file, named as its kernel file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "hybrid/cut_tree.hpp"
#include "hybrid/ring_edge.hpp"
#include "input/magnitudes.hpp"

namespace flaunay::hybrid {

using host::Arena;
using host::Buffer;

/// What the persistent arena holds for each point: vertices, their sources and edges, and what belongs to
/// blocks.
constexpr std::size_t kPersistentBytesPerPoint = 97;

/// What every stage works with.
struct Workspace {
  host::Runtime& runtime;
  Arena& persistent;  ///< lives as long as the call
  Bounds bounds{};

  Arena& scratch() { return runtime.arena(); }
};

/// Two neighbouring parts of a set, by their first blocks, and the node that cuts between them; as kernels
/// read it.
struct Merge {
  cl_int low, high, node, unused;
};

/// The leaves of all sets' cut trees.
struct Blocks {
  std::size_t sets = 0;
  std::size_t points = 0;
  std::size_t count = 0;
  std::vector<cl_int> set_blocks;  ///< sets + 1: the first block of each set
  std::vector<cl_int> offsets;     ///< count + 1: the first point of each block
  std::vector<Merge> merges;       ///< from the leaves up
  /// Merges [level_ends[l - 1], level_ends[l]) do not depend on each other.
  std::vector<std::size_t> level_ends;
  Buffer<cl_int> device_set_blocks{}, device_offsets{};
  Buffer<Merge> device_merges{};
  Buffer<CutNode> device_nodes{};  ///< of all trees
  /// Scaled, block by block, and their indices in the input. Once blocks are solved, vertices: a block's
  /// distinct points come first.
  Buffer<cl_double2> vertices{};
  Buffer<cl_int> source{};
};

/// Every set's triangulation.
struct Rings {
  Buffer<RingEdge> edges{};  ///< kEdgesPerVertex per point
  Buffer<cl_int> vertex_edge{};
  Buffer<cl_int4> block_ends{};
  Buffer<cl_int> device_distinct{};
  Buffer<cl_uint> device_undecided{};
  std::vector<cl_int> distinct;  ///< vertices by block: their number
  std::size_t undecided = 0;     ///< predicates that were evaluated exactly
};

/// Checks and scales the points, x0 y0 x1 y1..., and brings them to blocks. representatives: one per point,
/// each its own. Throws Error(input) for points that are not finite or beyond the range of magnitudes. O(n
/// log n).
Blocks make_blocks(Workspace& work, const Buffer<cl_double>& input, const std::vector<std::size_t>& offsets,
                   const Buffer<cl_int>& representatives);

/// Triangulates blocks and merges them; sets the representatives of duplicates. Does not wait: the numbers in
/// Rings come with await_rings.
Rings divide(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives);
/// The most scratch that it takes for n points, but for what belongs to blocks.
std::size_t solve_bytes(const host::Tuning& tuning, std::size_t n);
void await_rings(Workspace& work, const Blocks& blocks, Rings& rings);

/// How large a mesh is.
struct MeshSizes {
  std::vector<std::size_t> triangle_offsets, hull_offsets;  ///< sets + 1
  std::size_t vertices = 0;
  Buffer<cl_uint> first_rows{};  ///< of each vertex, and behind the last one's

  std::size_t triangles() const { return triangle_offsets.back(); }
  std::size_t hull_vertices() const { return hull_offsets.back(); }
};

/// Waits once. Throws Error(internal) if numbers do not fit together. first_rows come from the scratch arena
/// and are for write_mesh; the outsides of edges are marked from now on.
MeshSizes count_mesh(Workspace& work, const Blocks& blocks, const Rings& rings);

/// Where the parts of a mesh go, as flaunay.hpp describes them; without memory what is not wanted.
struct MeshBuffers {
  Buffer<cl_int> triangles{}, neighbors{}, halfedges{}, hull{};
};

/// Does not wait. Neighbours and halfedges need the triangles.
void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                const MeshBuffers& buffers);

}  // namespace flaunay::hybrid
