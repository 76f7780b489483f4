#include "flattened/codes.h"
#include "launchers/flattened/endgame.cl.hpp"
#include "launchers/flattened/endgame_exact.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

std::size_t endgame(Workspace& work, const PointTable& table, const RetiredRegions& retired,
                    const Buffer<cl_int>& triangles, std::size_t base) {
  if (retired.regions == 0) return 0;
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto counts = scratch.allocate<cl_uint>(retired.regions + 1);
  const auto status = scratch.allocate<cl_uchar>(retired.regions);
  runtime.map_in_small_groups(retired.regions, kernels::small_regions{.bounds = work.bounds,
                                                                      .offsets = retired.offsets,
                                                                      .points = table.points,
                                                                      .corners = retired.corner_ids,
                                                                      .counts = counts,
                                                                      .status = status,
                                                                      .broken = work.broken});
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, status, retired.regions);
    run_list(work, kernels::small_regions_exact{.count = work.list_length,
                                                .list = list,
                                                .bounds = work.bounds,
                                                .offsets = retired.offsets,
                                                .points = table.points,
                                                .corners = retired.corner_ids,
                                                .counts = counts,
                                                .broken = work.broken});
  }
  const auto [large, large_count] =
      host::pack_positions(runtime, status, retired.regions, kernel::FLAG_TOO_LARGE);
  if (large_count > 0) strips(work, table, retired, large, large_count, counts);
  host::exclusive_scan(runtime, counts, retired.regions, counts);
  runtime.map(retired.regions, kernels::collect_triangles{.base = base,
                                                          .offsets = retired.offsets,
                                                          .scanned = counts,
                                                          .slots = retired.corner_ids,
                                                          .triangles = triangles});
  return runtime.read_one(counts, retired.regions);
}

}  // namespace flaunay::flattened
