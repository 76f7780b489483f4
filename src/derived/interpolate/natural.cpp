#include "derived/interpolate/natural.hpp"

#include <limits>
#include <utility>

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

NaturalLists::NaturalLists(host::Runtime& runtime, const Locator& locator, NaturalWeights method,
                           const Buffer<cl_double>& queries, std::size_t m,
                           const std::vector<std::size_t>& query_offsets)
    : runtime_(runtime),
      locator_(locator),
      method_(method),
      m_(m),
      located_(locate::locate_by_place(runtime, locator, queries, m, query_offsets, points::kCircleLimits)) {
  host::Arena& arena = runtime.arena();
  const auto firsts = arena.allocate<cl_int>(m + 1), counts = arena.allocate<cl_int>(m);
  runtime.fill(firsts, m + 1, cl_int{0});
  list(firsts, counts, arena.allocate<cl_int>(0), arena.allocate<cl_double>(0));
  std::vector<cl_int> all(m);
  runtime.read(counts, 0, m, all.data());
  offsets_.push_back(0);
  for (const cl_int count : all) offsets_.push_back(offsets_.back() + static_cast<std::size_t>(count));
  if (offsets_.back() > std::numeric_limits<cl_int>::max()) {
    throw Error(ErrorKind::usage, "more weights than 32-bit indices can count: ask in several calls");
  }
}

void NaturalLists::write(const Buffer<cl_int>& neighbors, const Buffer<cl_double>& weights) const {
  host::Arena& arena = runtime_.arena();
  std::vector<cl_int> firsts(offsets_.begin(), offsets_.end());
  list(runtime_.upload(arena, std::move(firsts)), arena.allocate<cl_int>(m_), neighbors, weights);
}

void NaturalLists::list(const Buffer<cl_int>& firsts, const Buffer<cl_int>& counts,
                        const Buffer<cl_int>& neighbors, const Buffer<cl_double>& weights) const {
  runtime_.map_in_small_groups(m_, kernels::list_natural{.placed_queries = located_,
                                                         .method = static_cast<cl_int>(method_),
                                                         .records = locator_.records,
                                                         .faces = visible_faces_of(locator_),
                                                         .found = located_.found,
                                                         .firsts = firsts,
                                                         .counts = counts,
                                                         .neighbors = neighbors,
                                                         .weights = weights});
}

}  // namespace flaunay::interpolate
