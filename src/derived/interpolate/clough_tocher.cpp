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
  const bool is_by_vertex = !gradients.are_given;
  Buffer<cl_double> rows = gradients.given;
  if (is_by_vertex) {
    const auto estimated = estimate(runtime, locator, table, gradients);
    rows = Buffer<cl_double>(estimated.kept_memory(), 2 * estimated.size());
  }
  runtime.map_in_small_groups(
      m, kernels::interpolate_clough_tocher{.placed_queries = located,
                                            .columns = table.columns,
                                            .is_by_vertex = is_by_vertex,
                                            .has_images = locator.has_images(),
                                            .outside = table.outside,
                                            .bound = located.orient_bound,
                                            .kept = locator.kept,
                                            .faces = faces_of(locator),
                                            .first_triangle = locator.first_triangle,
                                            .in_place = locator.in_place,
                                            .found = located.found,
                                            .values = table.values,
                                            .gradients = rows,
                                            .scales = slope_scales(runtime, locator, is_by_vertex ? 0 : -1),
                                            .results = results});
}

}  // namespace flaunay::interpolate
