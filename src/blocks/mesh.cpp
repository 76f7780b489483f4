#include <fmt/format.h>

#include <numeric>

#include "blocks/pipeline.hpp"
#include "blocks/weighted.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/blocks/mesh.cl.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

void write_hulls(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                 const Buffer<cl_int>& hull) {
  host::Runtime& runtime = work.runtime;
  const auto offsets = work.scratch().allocate<cl_int>(blocks.sets + 1);
  runtime.write_kept(offsets, std::vector<cl_int>(sizes.hull_offsets.begin(), sizes.hull_offsets.end()));
  runtime.map(blocks.sets, kernels::write_hulls{.set_blocks = blocks.device_set_blocks,
                                                .solved = rings.solved,
                                                .vertex_edge = rings.vertex_edge,
                                                .edges = rings.edges,
                                                .source = blocks.source,
                                                .offsets = offsets,
                                                .hull = hull});
}

}  // namespace

// Euler's formula: d points with h of them on the hull have 2d - 2 - h triangles. The hull of points on one
// line is a walk there and back, so h is 2d - 2.
MeshSizes mesh_sizes(const std::vector<cl_int>& set_blocks, const std::vector<cl_int>& distinct,
                     const std::vector<cl_int>& walked, std::size_t counted) {
  const std::size_t sets = walked.size();
  MeshSizes sizes;
  sizes.triangle_offsets.reserve(sets + 1);
  sizes.hull_offsets.reserve(sets + 1);
  sizes.triangle_offsets.push_back(0);
  sizes.hull_offsets.push_back(0);
  for (std::size_t s = 0; s < sets; ++s) {
    const cl_int points =
        std::accumulate(distinct.begin() + set_blocks[s], distinct.begin() + set_blocks[s + 1], 0);
    const cl_int triangles = points < 3 ? 0 : 2 * points - 2 - walked[s];
    sizes.vertices += points;
    sizes.triangle_offsets.push_back(sizes.triangle_offsets.back() + triangles);
    sizes.hull_offsets.push_back(sizes.hull_offsets.back() + (triangles == 0 ? points : walked[s]));
  }
  if (counted != sizes.triangles()) {
    throw Error(ErrorKind::internal, fmt::format("{} triangles instead of {}; please report the input",
                                                 counted, sizes.triangles()));
  }
  return sizes;
}

MeshSizes count_mesh(Workspace& work, const Blocks& blocks, const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  std::vector<cl_int> walked(blocks.sets);
  const host::Runtime::Settled settled(runtime);
  const auto rows = scratch.allocate<cl_uint>(blocks.points + 1);
  const auto hull_sizes = scratch.allocate<cl_int>(blocks.sets);
  runtime.map(blocks.points, kernels::vertex_triangles{.vertex_edge = rings.vertex_edge, .counts = rows});
  runtime.map(blocks.sets, kernels::mark_outside{.set_blocks = blocks.device_set_blocks,
                                                 .solved = rings.solved,
                                                 .vertex_edge = rings.vertex_edge,
                                                 .edges = rings.edges,
                                                 .counts = rows,
                                                 .hull_sizes = hull_sizes});
  host::exclusive_scan(runtime, rows, blocks.points, rows);

  runtime.read_later(hull_sizes, 0, blocks.sets, walked.data());
  MeshSizes sizes;
  if (work.weights != nullptr) {
    sizes = work.weights->solver->mesh_sizes(work, blocks, walked, rows);
  } else {
    const cl_uint counted = runtime.read_one(rows, blocks.points);
    sizes = mesh_sizes(blocks.set_blocks, rings.distinct, walked, counted);
  }
  sizes.first_rows = rows;
  return sizes;
}

void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, const MeshSizes& sizes,
                const DeviceMesh& mesh, Milestones* milestones) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const std::size_t pairs = rings.edges.size() / 2;
  const bool with_neighbors = mesh.neighbors.memory() != nullptr;
  const bool with_halfedges = mesh.halfedges.memory() != nullptr;
  const bool with_corners = with_neighbors || with_halfedges;
  if (mesh.triangles.memory() != nullptr) {
    runtime.chunks(pairs, runtime.sizes().chunk(pairs),
                   kernels::write_triangles{.with_corners = with_corners,
                                            .points = blocks.vertices,
                                            .source = blocks.source,
                                            .edges = rings.edges,
                                            .first_rows = sizes.first_rows,
                                            .triangles = mesh.triangles});
    if (milestones != nullptr) milestones->set("output", kTrianglesWritten);
    if (with_neighbors) {
      runtime.map(pairs, kernels::write_neighbors{.edges = rings.edges, .neighbors = mesh.neighbors});
    }
    if (with_halfedges) {
      runtime.map(pairs, kernels::write_halfedges{.edges = rings.edges, .halfedges = mesh.halfedges});
    }
  }
  if (mesh.hull.memory() != nullptr) write_hulls(work, blocks, rings, sizes, mesh.hull);
}

}  // namespace flaunay::blocks
