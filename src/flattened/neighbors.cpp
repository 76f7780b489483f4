#include "flattened/stages.hpp"
#include "launchers/flattened/neighbors.cl.hpp"

namespace flaunay::flattened {

void match_edges(Workspace& work, const Buffer<cl_int>& triangles, std::size_t count,
                 const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  // The number of edges is half that of half-edges, plus half the hull's. The hash table is at most three
  // quarters full.
  std::size_t slots = 16;
  while (3 * slots < 4 * (3 * count + 3) / 2 + 64) slots *= 2;
  const auto table = work.scratch().allocate<cl_int>(slots);
  runtime.fill(table, slots, cl_int{-1});
  runtime.fill(twins, 3 * count, cl_int{-1});
  const auto mask = static_cast<cl_uint>(slots - 1);
  runtime.map(3 * count, kernels::insert_edges{.mask = mask, .triangles = triangles, .table = table});
  runtime.map(3 * count,
              kernels::match_edges{.mask = mask, .triangles = triangles, .table = table, .twins = twins});
}

}  // namespace flaunay::flattened
