// The stages of Mode::hybrid and what they hand to each other: points to blocks, blocks to edge rings, edge
// rings to triangles. Each is one file, named as its kernel file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "hybrid/ring_edge.hpp"
#include "input/magnitudes.hpp"

namespace flaunay::hybrid {

using host::Arena;
using host::Buffer;

/// What every stage works with.
struct Workspace {
  host::Runtime& runtime;
  Arena& persistent;  ///< lives as long as the call
  Bounds bounds{};

  Arena& scratch() { return runtime.arena(); }
};

/// Two neighbouring parts of a set, by their first blocks, and the axis of the cut between them; as kernels
/// read it.
struct Merge {
  cl_int low, high, axis, unused;
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

/// Checks and scales the points and brings them to blocks. representatives: one per point, each its own.
/// Throws Error(input) for points that are not finite or beyond the range of magnitudes. O(n log n).
Blocks make_blocks(Workspace& work, const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Buffer<cl_int>& representatives);

/// Triangulates blocks and merges them; sets the representatives of duplicates. Does not wait: the numbers in
/// Rings come with await_rings.
Rings divide(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives);
void await_rings(Workspace& work, const Blocks& blocks, Rings& rings);

/// Memory for all triangles that there can be, for the time that the device is busy.
void prepare_result(const Blocks& blocks, bool neighbors, Triangulation& result);

/// Triangles, neighbours if they are asked for, and hulls, into the result. Throws Error(internal) if their
/// numbers do not fit together.
void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, bool neighbors,
                Triangulation& result);

}  // namespace flaunay::hybrid
