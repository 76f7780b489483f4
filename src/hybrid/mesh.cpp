#include <fmt/format.h>

#include <numeric>

#include "host/vector_operations.hpp"
#include "hybrid/stages.hpp"

namespace flaunay::hybrid {
namespace {

// By Euler's formula: d points, of which h are on the hull, make 2d - 2 - h triangles. Points on one line are
// walked there and back, so h is 2d - 2.
MeshSizes set_sizes(const Blocks& blocks, const Rings& rings, const std::vector<cl_int>& walked) {
  MeshSizes sizes;
  sizes.triangle_offsets.assign(1, 0);
  sizes.hull_offsets.assign(1, 0);
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    const cl_int points = std::accumulate(rings.distinct.begin() + blocks.set_blocks[s],
                                          rings.distinct.begin() + blocks.set_blocks[s + 1], 0);
    const cl_int triangles = points < 3 ? 0 : 2 * points - 2 - walked[s];
    sizes.vertices += points;
    sizes.triangle_offsets.push_back(sizes.triangle_offsets.back() + triangles);
    sizes.hull_offsets.push_back(sizes.hull_offsets.back() + (triangles == 0 ? points : walked[s]));
  }
  return sizes;
}

void write_hulls(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                 const Buffer<cl_int>& hull) {
  host::Runtime& runtime = work.runtime;
  const auto offsets = work.scratch().allocate<cl_int>(blocks.sets + 1);
  runtime.write_kept(offsets, std::vector<cl_int>(sizes.hull_offsets.begin(), sizes.hull_offsets.end()));
  runtime.map("mesh", "write_hulls", blocks.sets, blocks.device_set_blocks, rings.block_ends,
              rings.vertex_edge, rings.edges, blocks.source, offsets, hull);
}

}  // namespace

MeshSizes count_mesh(Workspace& work, const Blocks& blocks, const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  std::vector<cl_int> walked(blocks.sets);
  const host::Runtime::Settled settled(runtime);
  const auto rows = scratch.allocate<cl_uint>(blocks.points + 1);
  const auto hull_sizes = scratch.allocate<cl_int>(blocks.sets);
  runtime.map("mesh", "vertex_triangles", blocks.points, rings.vertex_edge, rows);
  runtime.map("mesh", "mark_outside", blocks.sets, blocks.device_set_blocks, rings.block_ends,
              rings.vertex_edge, rings.edges, rows, hull_sizes);
  host::exclusive_scan(runtime, rows, blocks.points, rows);

  runtime.read_later(hull_sizes, 0, blocks.sets, walked.data());
  const cl_uint counted = runtime.read_one(rows, blocks.points);
  MeshSizes sizes = set_sizes(blocks, rings, walked);
  if (counted != sizes.triangles()) {
    throw Error(ErrorKind::internal, fmt::format("{} triangles instead of {}; please report the input",
                                                 counted, sizes.triangles()));
  }
  sizes.first_rows = rows;
  return sizes;
}

void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                const MeshBuffers& buffers) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t pairs = rings.edges.size() / 2;
  const bool with_neighbors = buffers.neighbors.memory() != nullptr;
  const bool with_halfedges = buffers.halfedges.memory() != nullptr;
  const bool with_corners = with_neighbors || with_halfedges;
  if (buffers.triangles.memory() != nullptr) {
    const auto corner_of_edge = work.scratch().allocate<cl_int>(with_corners ? rings.edges.size() : 0);
    runtime.chunks("mesh", "write_triangles", pairs, runtime.tuning().chunk(pairs), cl_int{with_corners},
                   blocks.vertices, blocks.source, rings.edges, sizes.first_rows, buffers.triangles,
                   corner_of_edge);
    if (with_neighbors) {
      runtime.map("mesh", "write_neighbors", pairs, rings.edges, corner_of_edge, buffers.neighbors);
    }
    if (with_halfedges) {
      runtime.map("mesh", "write_halfedges", pairs, rings.edges, corner_of_edge, buffers.halfedges);
    }
  }
  if (buffers.hull.memory() != nullptr) write_hulls(work, blocks, rings, sizes, buffers.hull);
}

}  // namespace flaunay::hybrid
