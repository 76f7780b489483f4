#include "derived/interpolate/arguments.hpp"
#include "derived/interpolate/interpolate.hpp"
#include "launchers/interpolate/linear.cl.hpp"

namespace flaunay::interpolate {

void linear(host::Runtime& runtime, const Locator& locator, const Table& table,
            const Buffer<cl_double>& queries, std::size_t m, const std::vector<std::size_t>& query_offsets,
            const Buffer<cl_double>& results) {
  host::Arena::Scope scope(runtime.arena());
  const locate::LocatedQueries located = locate_by_place(runtime, locator, queries, m, query_offsets);
  runtime.map_in_small_groups(m, kernels::interpolate_linear{.placed_queries = located,
                                                             .columns = table.columns,
                                                             .outside = table.outside,
                                                             .bound = located.orient_bound,
                                                             .faces = faces_of(locator),
                                                             .found = located.found,
                                                             .values = table.values,
                                                             .results = results});
}

void nearest(host::Runtime& runtime, Locator& locator, const Table& table, const Buffer<cl_double>& queries,
             std::size_t m, const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results) {
  host::Arena::Scope scope(runtime.arena());
  const auto points = runtime.arena().allocate<cl_int>(m);
  *locate::nearest(runtime, locator, queries, m, query_offsets, points);
  runtime.map(m, kernels::take_nearest{.columns = table.columns,
                                       .outside = table.outside,
                                       .nearest = points,
                                       .values = table.values,
                                       .results = results});
}

}  // namespace flaunay::interpolate
