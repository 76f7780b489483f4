#include <algorithm>

#include "launchers/flattened/strips.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

void strips(Workspace& work, const PointTable& table, const RetiredRegions& retired,
            const Buffer<cl_int>& large, std::size_t large_count, const Buffer<cl_uint>& counts) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);

  const auto large_offsets = scratch.allocate<cl_uint>(large_count + 1);
  runtime.map(large_count,
              kernels::large_sizes{.large = large, .offsets = retired.offsets, .sizes = large_offsets});
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
    runtime.map(corners, kernels::gather_large{.regions = regions,
                                               .large = large,
                                               .large_offsets = large_offsets,
                                               .offsets = retired.offsets,
                                               .corners = retired.corner_ids,
                                               .large_corners = large_corners,
                                               .corner_region = corner_region,
                                               .keys = keys,
                                               .order = order});
    host::sort_by_key(runtime, keys, order, corners);
    runtime.map(corners, kernels::vertex_flags{.keys = keys, .flags = scanned});
    host::exclusive_scan(runtime, scanned, corners, scanned);
    runtime.map(corners, kernels::write_vertices{.regions = regions,
                                                 .keys = keys,
                                                 .order = order,
                                                 .scanned = scanned,
                                                 .vertices = vertices,
                                                 .vertex_region = vertex_region,
                                                 .vertex_offsets = vertex_offsets,
                                                 .corner_vertex = corner_vertex});
  }
  const std::size_t vertex_count = runtime.read_one(scanned, corners);

  const auto edges = scratch.allocate<kernel::ring_edge>(kernel::EDGES_PER_VERTEX * vertex_count);
  const auto vertex_edge = scratch.allocate<cl_int>(vertex_count);
  const auto free_lists = scratch.allocate<kernel::free_edges>(vertex_count);
  const auto places = scratch.allocate<cl_double2>(vertex_count);
  int depth = 0;
  while ((cl_uint{kernel::LEAF_VERTICES} << depth) < largest) ++depth;
  for (; depth >= 0; --depth) {
    runtime.map(vertex_count, kernels::merge_strips{.depth = depth,
                                                    .bounds = work.bounds,
                                                    .vertices = vertices,
                                                    .vertex_region = vertex_region,
                                                    .vertex_offsets = vertex_offsets,
                                                    .points = table.points,
                                                    .places = places,
                                                    .edges = edges,
                                                    .vertex_edge = vertex_edge,
                                                    .free_lists = free_lists});
  }

  const kernels::strip_corners strip_corners{.corners = large_corners,
                                             .corner_region = corner_region,
                                             .corner_vertex = corner_vertex,
                                             .vertices = vertices};
  const auto border_edge = scratch.allocate<cl_int>(corners);
  const auto missing = scratch.allocate<cl_int>(large_count);
  runtime.fill(missing, large_count, cl_int{0});
  runtime.map(corners, kernels::border_edges{.strip_corners = strip_corners,
                                             .vertex_edge = vertex_edge,
                                             .edges = edges,
                                             .border_edge = border_edge,
                                             .missing = missing});
  runtime.map(large_count, kernels::restore_border{.missing = missing,
                                                   .large_offsets = large_offsets,
                                                   .strip_corners = strip_corners,
                                                   .places = places,
                                                   .points = table.points,
                                                   .bounds = work.bounds,
                                                   .edges = edges,
                                                   .vertex_edge = vertex_edge,
                                                   .border_edge = border_edge,
                                                   .broken = work.broken});
  for (const cl_int write : {0, 1}) {
    runtime.map(corners, kernels::count_fans{.write = write,
                                             .strip_corners = strip_corners,
                                             .edges = edges,
                                             .border_edge = border_edge,
                                             .large = large,
                                             .large_offsets = large_offsets,
                                             .offsets = retired.offsets,
                                             .scanned = scanned,
                                             .counts = scanned,
                                             .triangles = retired.corner_ids,
                                             .broken = work.broken});
    if (!write) host::exclusive_scan(runtime, scanned, corners, scanned);
  }
  runtime.map(large_count,
              kernels::large_counts{
                  .large = large, .large_offsets = large_offsets, .scanned = scanned, .counts = counts});
}

}  // namespace flaunay::flattened
