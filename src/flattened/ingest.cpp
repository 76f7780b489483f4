#include "flattened/stages.hpp"
#include "input/inspect.hpp"

namespace flaunay::flattened {

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

  const auto input = scratch.allocate<cl_double>(2 * n);
  runtime.write(input, 0, 2 * n, coordinates);
  std::vector<cl_int> input_offsets(offsets.begin(), offsets.end());
  const auto device_offsets = scratch.allocate<cl_int>(sets + 1);
  runtime.write(device_offsets, 0, sets + 1, input_offsets.data());

  const Scaling scaling = scaling_for(runtime, input, n, inspect(runtime, input, n));
  work.bounds = scaling.bounds;
  const auto [s0, s1, s2] = scaling.powers();

  // Sort by y, with dense ranks; then stably by x, and by set.
  const auto keys = scratch.allocate<cl_ulong>(n);
  const auto order = scratch.allocate<cl_int>(n);
  const auto counts = scratch.allocate<cl_uint>(n + 1);
  const auto y_rank = scratch.allocate<cl_uint>(n);
  runtime.map("ingest", "keys_y", n, input, s0, s1, s2, keys, order);
  host::sort_by_key(runtime, keys, order, n);
  runtime.map("ingest", "change_flags", n, keys, counts);
  host::exclusive_scan(runtime, counts, n, counts);
  runtime.map("ingest", "write_ranks", n, order, counts, y_rank);
  runtime.map("ingest", "keys_x", n, input, s0, s1, s2, order, keys);
  host::sort_by_key(runtime, keys, order, n);
  const auto set_count = static_cast<cl_int>(sets);
  if (sets > 1) {
    runtime.map("ingest", "keys_set", n, set_count, device_offsets, order, keys);
    host::sort_by_key(runtime, keys, order, n);
  }

  runtime.map("ingest", "distinct_flags", n, set_count, device_offsets, input, order, counts);
  host::exclusive_scan(runtime, counts, n, counts);
  table.count = n == 0 ? 0 : runtime.read_one(counts, n);
  table.points = work.persistent.allocate<cl_double2>(table.count);
  table.source = work.persistent.allocate<cl_int>(table.count);
  table.side = work.persistent.allocate<cl_uchar>(table.count);
  table.set_of_id = work.persistent.allocate<cl_int>(table.count);
  table.set_offsets = work.persistent.allocate<cl_int>(sets + 1);
  table.y_order = work.persistent.allocate<cl_int>(table.count);
  runtime.map("ingest", "distinct_write", n, input, s0, s1, s2, order, counts, y_rank, table.points,
              table.source, keys);
  runtime.map("ingest", "set_offsets", sets + 1, device_offsets, counts, table.set_offsets);
  const Buffer<cl_int> representative = scratch.allocate<cl_int>(n);
  runtime.map("ingest", "representatives", n, order, counts, table.source, representative);
  runtime.read(representative, 0, n, representatives);

  runtime.map("ingest", "keys_y_order", table.count, set_count, table.set_offsets, keys, table.y_order);
  host::sort_by_key(runtime, keys, table.y_order, table.count);
  runtime.map("border", "sets_of_ids", table.count, set_count, table.set_offsets, table.set_of_id);
  runtime.fill(table.side, table.count, cl_uchar{0});
  return table;
}

}  // namespace flaunay::flattened
