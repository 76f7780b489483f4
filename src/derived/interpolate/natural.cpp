#include "derived/interpolate/natural.hpp"

#include "derived/interpolate/arguments.hpp"
#include "launchers/interpolate/natural.cl.hpp"

namespace flaunay::interpolate {

void natural(host::Runtime& runtime, const Locator& locator, NaturalWeights method, const Table& table,
             const Buffer<cl_double>& queries, std::size_t m, const std::vector<std::size_t>& query_offsets,
             const Buffer<cl_double>& results) {
  host::Arena::Scope scope(runtime.arena());
  const locate::LocatedQueries located =
      locate::locate_by_place(runtime, locator, queries, m, query_offsets, points::kCircleLimits);
  const auto left = runtime.arena().allocate<cl_uchar>(m);
  // Else not all values are needed, and few of them more than once.
  const bool is_by_vertex = m >= locator.points.size();
  Buffer<cl_double> values = table.values;
  if (is_by_vertex) {
    const std::size_t n = locator.points.size();
    values = runtime.arena().allocate<cl_double>(n * table.columns);
    runtime.map(n, kernels::place_values{.sets = located.sets,
                                         .columns = table.columns,
                                         .first_vertices = locator.first_vertices,
                                         .source = locator.source,
                                         .values = table.values,
                                         .placed = values});
  }
  runtime.map_in_small_groups(m, kernels::interpolate_natural{.placed_queries = located,
                                                              .columns = table.columns,
                                                              .is_by_vertex = is_by_vertex,
                                                              .method = static_cast<cl_int>(method),
                                                              .outside = table.outside,
                                                              .faces = visible_faces_of(locator),
                                                              .found = located.found,
                                                              .values = values,
                                                              .results = results,
                                                              .left = left});
  runtime.map_in_small_groups(m, kernels::interpolate_natural_exactly{.placed_queries = located,
                                                                      .columns = table.columns,
                                                                      .is_by_vertex = is_by_vertex,
                                                                      .method = static_cast<cl_int>(method),
                                                                      .outside = table.outside,
                                                                      .records = locator.records,
                                                                      .faces = visible_faces_of(locator),
                                                                      .found = located.found,
                                                                      .values = values,
                                                                      .left = left,
                                                                      .results = results});
}

}  // namespace flaunay::interpolate
