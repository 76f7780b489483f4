#include "launchers/flattened/neighbors.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace geometry;

namespace {

struct EdgeTable {
  Buffer<cl_int> slots{};
  cl_uint mask = 0;
};

// A hash table that is at most three quarters full: the number of edges is half that of half-edges, plus half
// the hull's.
EdgeTable make_table(Workspace& work, std::size_t halfedges) {
  std::size_t slots = 16;
  while (3 * slots < 4 * (halfedges + 3) / 2 + 64) slots *= 2;
  EdgeTable table{work.scratch().allocate<cl_int>(slots), static_cast<cl_uint>(slots - 1)};
  work.runtime.fill(table.slots, slots, cl_int{-1});
  return table;
}

}  // namespace

void match_edges(Workspace& work, const Buffer<cl_int>& triangles, std::size_t count,
                 const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  const EdgeTable table = make_table(work, 3 * count);
  runtime.fill(twins, 3 * count, cl_int{-1});
  runtime.map(3 * count,
              kernels::insert_edges{.mask = table.mask, .triangles = triangles, .table = table.slots});
  runtime.map(
      3 * count,
      kernels::match_edges{.mask = table.mask, .triangles = triangles, .table = table.slots, .twins = twins});
}

bool match_loose_edges(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                       std::size_t count, const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto flags = scratch.allocate<cl_uchar>(3 * count);
  runtime.map(3 * count, kernels::loose_edges{.twins = twins, .flags = flags});
  const auto [list, loose] = host::pack_positions(runtime, flags, 3 * count, 1);
  // Most of them may be on the hull, each an edge of its own.
  const EdgeTable edges = make_table(work, 2 * loose);
  runtime.map(loose, kernels::insert_loose{
                         .mask = edges.mask, .list = list, .triangles = triangles, .table = edges.slots});
  runtime.map(
      loose,
      kernels::match_loose{
          .mask = edges.mask, .list = list, .triangles = triangles, .table = edges.slots, .twins = twins});
  return any_cocircular(work, table, triangles, twins, list, loose);
}

}  // namespace flaunay::flattened
