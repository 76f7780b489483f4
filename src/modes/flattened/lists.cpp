#include "launchers/flattened/lists.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// Counts the points of each chunk of a list that go left and right, and computes their prefix sums.
void count_chunks(Workspace& work, const PointTable& table, const Buffer<cl_int>& list,
                  const ListSplit& split) {
  work.runtime.chunks(split.points, split.chunk,
                      kernels::list_counts{.list = list, .side = table.side, .counts = split.chunk_counts});
  host::exclusive_scan(work.runtime, split.chunk_counts, split.chunks, split.chunk_counts);
}

void split_list(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_int>& list,
                const ListSplit& split, const Children& children, const Level& next,
                const Buffer<cl_int>& new_list) {
  work.runtime.chunks(level.points, split.chunk,
                      kernels::list_split{.list = list,
                                          .regions = level.point_regions,
                                          .side = table.side,
                                          .scanned = split.chunk_counts,
                                          .before = split.points_before,
                                          .child_region = children.region,
                                          .new_list = new_list,
                                          .new_regions = next.point_regions});
}

}  // namespace

ListSplit begin_split(Workspace& work, const PointTable& table, const Level& level) {
  host::Runtime& runtime = work.runtime;
  runtime.map(level.points, kernels::point_sides{.list = level.x_list,
                                                 .regions = level.point_regions,
                                                 .cuts = level.cuts(table),
                                                 .side = table.side,
                                                 .broken = work.broken});
  ListSplit split;
  split.points = level.points;
  split.chunk = runtime.sizes().chunk(level.points);
  split.chunks = (level.points + split.chunk - 1) / split.chunk;
  split.chunk_counts = work.scratch().allocate<cl_uint2>(split.chunks + 1);
  split.points_before = work.scratch().allocate<cl_uint2>(level.regions + 1);
  count_chunks(work, table, level.x_list, split);
  runtime.chunks(level.points, split.chunk,
                 kernels::list_bounds{.regions_count = level.regions,
                                      .list = level.x_list,
                                      .regions = level.point_regions,
                                      .side = table.side,
                                      .scanned = split.chunk_counts,
                                      .before = split.points_before});
  return split;
}

void split_lists(Workspace& work, const PointTable& table, const Level& level, const ListSplit& split,
                 const Children& children, const Level& next) {
  split_list(work, table, level, level.x_list, split, children, next, next.x_list);
  count_chunks(work, table, level.y_list, split);
  split_list(work, table, level, level.y_list, split, children, next, next.y_list);
}

void first_list(Workspace& work, const PointTable& table, const Buffer<cl_int>& list,
                const Children& children, const Buffer<cl_int>& new_list, const Buffer<cl_int>& new_regions) {
  host::Runtime& runtime = work.runtime;
  const std::size_t n = table.count;
  Arena::Scope scope(work.scratch());
  const auto counts = work.scratch().allocate<cl_uint>(n + 1);
  runtime.map(n, kernels::first_flags{.list = list, .side = table.side, .counts = counts});
  host::exclusive_scan(runtime, counts, n, counts);
  runtime.map(n, kernels::first_list{.list = list,
                                     .scanned = counts,
                                     .set_of_id = table.set_of_id,
                                     .child_region = children.region,
                                     .new_list = new_list,
                                     .new_regions = new_regions});
}

}  // namespace flaunay::flattened
