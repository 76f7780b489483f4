#include "derived/interpolate/gradients.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arithmetic/coordinates.h"
#include "host/launch/vector_operations.hpp"
#include "launchers/interpolate/gradients.cl.hpp"

namespace flaunay::interpolate {
namespace {

// The error is at most 2 kRate^k of the gradients after k iterations, in the norm that is weighted by the
// vertices' blocks. kSafety: for single gradients, that are smaller than others.
const double kRate = 2 - std::sqrt(3.0);
constexpr double kSafety = 16;

// Rounding errors exceed the gain of later iterations.
constexpr double kLeastTolerance = 0x1p-53;

// The edges by vertex; see gradients.cl.
struct Edges {
  std::size_t points = 0, room = 0;
  Buffer<cl_int> vertices{};  // one number, how many there are
  Buffer<cl_uint> firsts{};
  Buffer<cl_int> neighbors{};
  Buffer<cl_double> weights{}, inverses{};

  operator kernels::edges() const {
    return {.room = room,
            .vertices = vertices,
            .firsts = firsts,
            .neighbors = neighbors,
            .weights = weights,
            .inverses = inverses};
  }
};

std::size_t vertices_at_most(const Locator& locator) { return locator.points.size(); }

Edges find_edges(host::Runtime& runtime, const Locator& locator) {
  host::Arena& arena = runtime.arena();
  const std::size_t n = vertices_at_most(locator);
  Edges edges;
  edges.points = n;
  // Each triangle has three, and a hull edge is in one triangle only.
  edges.room = 3 * locator.faces.size() + locator.hull.size();
  edges.vertices = arena.allocate<cl_int>(1);
  edges.firsts = arena.allocate<cl_uint>(n + 1);
  edges.neighbors = arena.allocate<cl_int>(edges.room);
  edges.weights = arena.allocate<cl_double>(edges.room);
  edges.inverses = arena.allocate<cl_double>(3 * n);
  runtime.copy(locator.first_vertices, locator.sets, edges.vertices, 0, 1);
  runtime.map(n, kernels::count_edges{.kept = locator.kept,
                                      .vertices = edges.vertices,
                                      .points = locator.points,
                                      .faces = locator.faces,
                                      .first_triangle = locator.first_triangle,
                                      .counts = edges.firsts});
  host::exclusive_scan(runtime, edges.firsts, n, edges.firsts);
  runtime.map(n, kernels::write_edges{.kept = locator.kept,
                                      .room = edges.room,
                                      .vertices = edges.vertices,
                                      .firsts = edges.firsts,
                                      .points = locator.points,
                                      .faces = locator.faces,
                                      .first_triangle = locator.first_triangle,
                                      .neighbors = edges.neighbors,
                                      .weights = edges.weights,
                                      .inverses = edges.inverses});
  return edges;
}

}  // namespace

Buffer<kernel::scaling> slope_scales(host::Runtime& runtime, const Locator& locator, int sign) {
  std::vector<kernel::scaling> scales;
  for (std::size_t s = 0; s < locator.sets; ++s) {
    scales.push_back(kernel::scale_of(sign * locator.range.shift(s)));
  }
  return runtime.upload(runtime.arena(), std::move(scales));
}

std::size_t iterations_for(double tolerance) {
  const double wanted = std::max(tolerance, kLeastTolerance) / (2 * kSafety);
  return static_cast<std::size_t>(std::max(1.0, std::ceil(std::log(wanted) / std::log(kRate))));
}

Buffer<cl_double2> estimate(host::Runtime& runtime, const Locator& locator, const Table& table,
                            const Gradients& wanted) {
  host::Arena& arena = runtime.arena();
  const std::size_t n = vertices_at_most(locator), numbers = n * table.columns;
  const std::size_t iterations = std::min(wanted.iterations, iterations_for(wanted.tolerance));
  auto result = arena.allocate<cl_double2>(numbers);
  if (iterations == 0) {
    runtime.fill(result, numbers, cl_double2{{0, 0}});
    return result;
  }
  host::Arena::Scope scope(arena);
  const Edges edges = find_edges(runtime, locator);
  const auto start = arena.allocate<cl_double2>(numbers);
  // Two approximations take turns, so that the last one is the result.
  Buffer<cl_double2> now = result, before = arena.allocate<cl_double2>(numbers);
  if (iterations % 2 == 0) std::swap(now, before);
  const auto share = [&] {
    if (!locator.has_images()) return;
    runtime.map(
        locator.in_place.size(),
        kernels::share_gradients{.columns = table.columns, .in_place = locator.in_place, .gradients = now});
  };
  runtime.map(n, kernels::start_gradients{.columns = table.columns,
                                          .edges = edges,
                                          .points = locator.points,
                                          .source = locator.source,
                                          .values = table.values,
                                          .start = start,
                                          .gradients = now});
  share();
  improve(iterations, [&](bool is_first, double factor) {
    runtime.map(n, kernels::improve_gradients{.columns = table.columns,
                                              .edges = edges,
                                              .is_second = is_first,
                                              .factor = factor,
                                              .points = locator.points,
                                              .start = start,
                                              .gradients = now,
                                              .before = before});
    std::swap(now, before);
    share();
  });
  return result;
}

void estimate_gradients(host::Runtime& runtime, const Locator& locator, const Table& table,
                        const Gradients& wanted, const Buffer<cl_double>& results) {
  host::Arena::Scope scope(runtime.arena());
  const std::size_t n = vertices_at_most(locator);
  runtime.fill(results, 2 * locator.point_offsets.back() * table.columns, table.outside);
  const auto at_vertices = estimate(runtime, locator, table, wanted);
  runtime.map(n, kernels::take_gradients{.columns = table.columns,
                                         .sets = locator.sets,
                                         .has_images = locator.has_images(),
                                         .first_vertices = locator.first_vertices,
                                         .scales = slope_scales(runtime, locator, 1),
                                         .source = locator.source,
                                         .in_place = locator.in_place,
                                         .gradients = at_vertices,
                                         .results = results});
}

}  // namespace flaunay::interpolate
