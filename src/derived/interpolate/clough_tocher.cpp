#include "derived/interpolate/arguments.hpp"
#include "derived/interpolate/gradients.hpp"
#include "derived/interpolate/interpolate.hpp"
#include "launchers/interpolate/clough_tocher.cl.hpp"

namespace flaunay::interpolate {

void clough_tocher(host::Runtime& runtime, const Locator& locator, const Table& table,
                   const Gradients& gradients, const Buffer<cl_double>& queries, std::size_t m,
                   const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results) {
  host::Arena::Scope scope(runtime.arena());
  const locate::LocatedQueries located = locate_by_place(runtime, locator, queries, m, query_offsets);
  if (m == 0) return;
  const auto at_vertices = at_vertices_of(runtime, locator, table, gradients);
  runtime.map_in_small_groups(m, kernels::interpolate_clough_tocher{.placed_queries = located,
                                                                    .columns = table.columns,
                                                                    .outside = table.outside,
                                                                    .bound = located.orient_bound,
                                                                    .kept = locator.kept,
                                                                    .faces = faces_of(locator),
                                                                    .found = located.found,
                                                                    .values = table.values,
                                                                    .gradients = at_vertices,
                                                                    .results = results});
}

}  // namespace flaunay::interpolate
