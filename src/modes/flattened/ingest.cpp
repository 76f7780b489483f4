#include "launchers/flattened/ingest.cl.hpp"
#include "modes/flattened/stages.hpp"
#include "points/inspect.hpp"

namespace flaunay::flattened {
using namespace geometry;

PointTable ingest(Workspace& work, const double* coordinates, const std::vector<std::size_t>& offsets,
                  std::int32_t* representatives) {
  host::Runtime& runtime = work.runtime;
  const std::size_t n = offsets.back();
  const std::size_t sets = offsets.size() - 1;
  PointTable table;
  table.input_count = n;
  table.sets = sets;
  Arena::Scope scope(work.scratch());
  Arena& scratch = work.scratch();

  const auto given = runtime.view(coordinates, 2 * n);
  const auto device_offsets = runtime.upload(scratch, std::vector<cl_int>(offsets.begin(), offsets.end()));

  const points::UniformPoints input = *points::make_uniform(runtime, given, offsets);
  const auto pairs = input.coordinates.as<cl_double2>();
  work.bounds = input.scaling.bounds;
  const kernel::scaling scale = input.scaling.powers();

  // Sorts by y and assigns dense ranks, then sorts stably by x, and by set.
  const auto keys = scratch.allocate<cl_ulong>(n);
  const auto order = scratch.allocate<cl_int>(n);
  const auto counts = scratch.allocate<cl_uint>(n + 1);
  const auto y_rank = scratch.allocate<cl_uint>(n);
  runtime.map(n, kernels::keys_y{.input = pairs, .scale = scale, .keys = keys, .order = order});
  host::sort_by_key(runtime, keys, order, n);
  runtime.map(n, kernels::change_flags{.keys = keys, .flags = counts});
  host::exclusive_scan(runtime, counts, n, counts);
  runtime.map(n, kernels::write_ranks{.order = order, .scanned = counts, .rank = y_rank});
  runtime.map(n, kernels::keys_x{.input = pairs, .scale = scale, .order = order, .keys = keys});
  host::sort_by_key(runtime, keys, order, n);
  const auto set_count = static_cast<cl_int>(sets);
  if (sets > 1) {
    runtime.map(
        n, kernels::keys_set{.sets = set_count, .offsets = device_offsets, .order = order, .keys = keys});
    host::sort_by_key(runtime, keys, order, n);
  }

  runtime.map(
      n, kernels::distinct_flags{
             .sets = set_count, .offsets = device_offsets, .input = pairs, .order = order, .flags = counts});
  host::exclusive_scan(runtime, counts, n, counts);
  table.count = n == 0 ? 0 : runtime.read_one(counts, n);
  table.points = work.persistent.allocate<cl_double2>(table.count);
  table.source = work.persistent.allocate<cl_int>(table.count);
  table.side = work.persistent.allocate<cl_uchar>(table.count);
  table.set_of_id = work.persistent.allocate<cl_int>(table.count);
  table.set_offsets = work.persistent.allocate<cl_int>(sets + 1);
  table.y_order = work.persistent.allocate<cl_int>(table.count);
  runtime.map(n, kernels::distinct_write{.input = pairs,
                                         .scale = scale,
                                         .order = order,
                                         .ids = counts,
                                         .y_rank = y_rank,
                                         .points = table.points,
                                         .source = table.source,
                                         .y_keys = keys});
  runtime.map(sets + 1, kernels::set_offsets{
                            .offsets = device_offsets, .ids = counts, .point_offsets = table.set_offsets});
  const Buffer<cl_int> representative = scratch.allocate<cl_int>(n);
  runtime.map(n,
              kernels::representatives{
                  .order = order, .ids = counts, .source = table.source, .representative = representative});
  runtime.read(representative, 0, n, representatives);

  runtime.map(
      table.count,
      kernels::keys_y_order{
          .sets = set_count, .point_offsets = table.set_offsets, .keys = keys, .order = table.y_order});
  host::sort_by_key(runtime, keys, table.y_order, table.count);
  runtime.map(
      table.count,
      kernels::sets_of_ids{.sets = set_count, .offsets = table.set_offsets, .set_of_id = table.set_of_id});
  runtime.fill(table.side, table.count, cl_uchar{0});
  return table;
}

}  // namespace flaunay::flattened
