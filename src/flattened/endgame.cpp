#include "flattened/stages.hpp"

namespace flaunay::flattened {

std::size_t endgame(Workspace& work, const PointTable& table, const RetiredRegions& retired,
                    const Buffer<cl_int>& triangles, std::size_t base) {
  if (retired.regions == 0) return 0;
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto counts = scratch.allocate<cl_uint>(retired.regions + 1);
  const auto status = scratch.allocate<cl_uchar>(retired.regions);
  runtime.map("endgame", "small_regions", retired.regions, work.bounds.orient, work.bounds.circle,
              retired.offsets, table.points, retired.corner_ids, counts, status, work.broken);
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, status, retired.regions);
    run_list(work, "endgame_exact", "small_regions_exact", list, work.bounds.orient, work.bounds.circle,
             retired.offsets, table.points, retired.corner_ids, counts, work.broken);
  }
  const auto [large, large_count] = host::pack_positions(runtime, status, retired.regions, 3);
  if (large_count > 0) strips(work, table, retired, large, large_count, counts);
  host::exclusive_scan(runtime, counts, retired.regions, counts);
  runtime.map("endgame", "collect_triangles", retired.regions, static_cast<cl_int>(base), retired.offsets,
              counts, retired.corner_ids, triangles);
  return runtime.read_one(counts, retired.regions);
}

}  // namespace flaunay::flattened
