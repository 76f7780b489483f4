#include <algorithm>

#include "flattened/stages.hpp"
#include "hybrid/ring_edge.hpp"

namespace flaunay::flattened {

using hybrid::kEdgesPerVertex;
using hybrid::kLeafVertices;
using hybrid::RingEdge;

void strips(Workspace& work, const PointTable& table, const RetiredRegions& retired,
            const Buffer<cl_int>& large, std::size_t large_count, const Buffer<cl_uint>& counts) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);

  const auto large_offsets = scratch.allocate<cl_uint>(large_count + 1);
  runtime.map("strips", "large_sizes", large_count, large, retired.offsets, large_offsets);
  host::exclusive_scan(runtime, large_offsets, large_count, large_offsets);
  std::vector<cl_uint> offsets(large_count + 1);
  runtime.read(large_offsets, 0, large_count + 1, offsets.data());
  const std::size_t corners = offsets.back();
  cl_uint largest = 0;
  for (std::size_t l = 0; l < large_count; ++l) largest = std::max(largest, offsets[l + 1] - offsets[l]);

  const auto large_corners = scratch.allocate<cl_int>(3 * corners);
  const auto corner_region = scratch.allocate<cl_int>(corners);
  const auto corner_vertex = scratch.allocate<cl_int>(corners);
  const auto vertices = scratch.allocate<cl_int>(corners);
  const auto vertex_region = scratch.allocate<cl_int>(corners);
  const auto vertex_offsets = scratch.allocate<cl_int>(large_count + 1);
  const auto scanned = scratch.allocate<cl_uint>(corners + 1);
  const auto regions = static_cast<cl_int>(large_count);
  {
    Arena::Scope sort_scope(scratch);
    const auto keys = scratch.allocate<cl_ulong>(corners);
    const auto order = scratch.allocate<cl_int>(corners);
    runtime.map("strips", "gather_large", corners, regions, large, large_offsets, retired.offsets,
                retired.corner_ids, large_corners, corner_region, keys, order);
    host::sort_by_key(runtime, keys, order, corners);
    runtime.map("strips", "vertex_flags", corners, keys, scanned);
    host::exclusive_scan(runtime, scanned, corners, scanned);
    runtime.map("strips", "write_vertices", corners, regions, keys, order, scanned, vertices, vertex_region,
                vertex_offsets, corner_vertex);
  }
  const std::size_t vertex_count = runtime.read_one(scanned, corners);

  const auto edges = scratch.allocate<RingEdge>(kEdgesPerVertex * vertex_count);
  const auto vertex_edge = scratch.allocate<cl_int>(vertex_count);
  const auto free_lists = scratch.allocate<cl_int2>(vertex_count);
  const auto places = scratch.allocate<cl_double2>(vertex_count);
  int depth = 0;
  while ((kLeafVertices << depth) < largest) ++depth;
  for (; depth >= 0; --depth) {
    runtime.map("strips", "merge_strips", vertex_count, cl_int{depth}, work.bounds.orient, work.bounds.circle,
                vertices, vertex_region, vertex_offsets, table.points, places, edges, vertex_edge,
                free_lists);
  }

  const auto border_edge = scratch.allocate<cl_int>(corners);
  const auto missing = scratch.allocate<cl_int>(large_count);
  runtime.fill(missing, large_count, cl_int{0});
  runtime.map("strips", "border_edges", corners, large_corners, corner_region, corner_vertex, vertices,
              vertex_edge, edges, border_edge, missing);
  runtime.map("strips", "restore_border", large_count, missing, large_offsets, large_corners, corner_vertex,
              vertices, places, table.points, work.bounds.orient, work.bounds.circle, edges, vertex_edge,
              border_edge, work.broken);
  for (const cl_int write : {0, 1}) {
    runtime.map("strips", "count_fans", corners, write, large_corners, corner_region, corner_vertex, vertices,
                edges, border_edge, large, large_offsets, retired.offsets, scanned, scanned,
                retired.corner_ids, work.broken);
    if (!write) host::exclusive_scan(runtime, scanned, corners, scanned);
  }
  runtime.map("strips", "large_counts", large_count, large, large_offsets, scanned, counts);
}

}  // namespace flaunay::flattened
