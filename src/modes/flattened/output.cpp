#include "geometry/halfedges.hpp"
#include "launchers/flattened/output.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

std::vector<std::size_t> order_by_sets(Workspace& work, const PointTable& table,
                                       const Buffer<cl_int>& triangles, const Buffer<cl_int>& twins,
                                       std::size_t count) {
  if (table.sets == 1) return {0, count};
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const auto keys = work.scratch().allocate<cl_ulong>(count);
  const auto order = work.scratch().allocate<cl_int>(count);
  const auto counts = work.scratch().allocate<cl_uint>(table.sets);
  const auto unsorted = work.scratch().allocate<cl_int>(3 * count);
  runtime.fill(counts, table.sets, cl_uint{0});
  runtime.map(count, kernels::triangle_sets{.triangles = triangles,
                                            .set_of_id = table.set_of_id,
                                            .keys = keys,
                                            .order = order,
                                            .counts = counts});
  host::sort_by_key(runtime, keys, order, count);
  runtime.copy(triangles, 0, unsorted, 0, 3 * count);
  runtime.map(count,
              kernels::reorder_triangles{.order = order, .triangles = unsorted, .reordered = triangles});
  if (twins.memory() != nullptr) {
    const auto places = work.scratch().allocate<cl_int>(count);
    runtime.map(count, kernels::triangle_places{.order = order, .places = places});
    runtime.copy(twins, 0, unsorted, 0, 3 * count);
    runtime.map(count, kernels::reorder_twins{
                           .order = order, .places = places, .twins = unsorted, .reordered = twins});
  }
  std::vector<std::size_t> offsets{0};
  for (const cl_uint size : read_all(work, counts, table.sets)) offsets.push_back(offsets.back() + size);
  return offsets;
}

Buffer<cl_int> result_memory(Workspace& work, Arena& arena, std::vector<std::int32_t>& values,
                             std::size_t size) {
  if (work.runtime.sizes().in_host_memory == 0) return arena.allocate<cl_int>(size);
  work.runtime.resize(values, size);
  return work.runtime.output(values);
}

void read_rows(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
               const Buffer<cl_int>& twins, std::size_t count, const Options& options,
               Triangulation& result) {
  host::Runtime& runtime = work.runtime;
  const host::Runtime::Settled settled(runtime);
  Arena::Scope scope(work.scratch());
  const bool with_neighbors = options.neighbors || options.halfedges;
  const auto target = [&](std::vector<std::int32_t>& values, const Buffer<cl_int>& in_place,
                          std::size_t size) {
    if (!values.empty()) return in_place;
    runtime.resize(values, size);
    return runtime.output(values);
  };
  const auto output = target(result.triangles, triangles, 3 * count);
  const auto neighbors = target(result.neighbors, twins, with_neighbors ? 3 * count : 0);
  runtime.map(count, kernels::finish_rows{.with_neighbors = with_neighbors,
                                          .triangles = triangles,
                                          .twins = twins,
                                          .source = table.source,
                                          .rows = output,
                                          .neighbors = neighbors});
  runtime.fetch_later(output, result.triangles);
  runtime.fetch_later(neighbors, result.neighbors);
  runtime.finish();
  if (with_neighbors) geometry::write_halfedges(options, result);
}

std::vector<std::int32_t> read_indices(Workspace& work, const PointTable& table, const Buffer<cl_int>& ids,
                                       std::size_t count) {
  Arena::Scope scope(work.scratch());
  const auto indices = work.scratch().allocate<cl_int>(count);
  work.runtime.map(count, kernels::map_ids{.ids = ids, .source = table.source, .indices = indices});
  return read_all(work, indices, count);
}

}  // namespace flaunay::flattened
