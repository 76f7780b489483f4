#include "blocks/small.hpp"

#include <algorithm>
#include <numeric>

#include "arithmetic/coordinates.h"
#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/run.hpp"
#include "geometry/magnitudes.hpp"
#include "host/native/launch.hpp"
#include "host/of_thread.hpp"
#include "launchers/blocks/divide.cl.hpp"
#include "launchers/blocks/fans.cl.hpp"
#include "launchers/blocks/mesh.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "predicates/order.h"
#include "predicates/planar.h"

namespace flaunay::blocks {
namespace {

using host::here;
using host::Here;
using host::map_natively;

// The arrays of a call, as the stages of mode blocks describe them; they are used by the next call of the
// thread.
struct Scratch {
  std::vector<cl_int> offsets, set_blocks;
  std::vector<cl_double2> vertices;
  std::vector<cl_int> source;
  std::vector<kernel::ring_edge> edges;
  std::vector<cl_int> vertex_edge;
  std::vector<kernel::solved_block> solved;
  std::vector<cl_int> distinct;
  // The following have room for the largest block.
  std::vector<cl_double2> points;
  std::vector<cl_int> point_source;
  std::vector<cl_ulong> ranks;
  std::vector<cl_uchar> axes;
  std::vector<cl_uchar> inside, found;
  std::vector<cl_uint> first_rows;
  std::vector<cl_int> walked, hull_offsets;

  std::size_t bytes() const {
    const auto sum = [](const auto&... arrays) {
      return (... + (arrays.capacity() * sizeof(*arrays.data())));
    };
    return sum(offsets, set_blocks, vertices, source, edges, vertex_edge, solved, distinct, points,
               point_source, ranks, axes, inside, found, first_rows, walked, hull_offsets);
  }
};

// Returns an array of this size, whose elements may have any value.
template <typename T>
Here<T> sized(std::vector<T>& array, std::size_t size) {
  if (array.size() < size) array.resize(size);
  return here(array.data());
}

// Returns a result of this size.
template <typename T>
Here<T> result_of(std::vector<T>& array, std::size_t size) {
  array.resize(size);
  return here(array);
}

bool is_same(kernel::double2 p, kernel::double2 q) { return p.x == q.x && p.y == q.y; }

// Whether all points are on one line: of other points, this looks at a few. undecided: grows by the number of
// orientations that were evaluated exactly.
bool are_on_line(const kernel::double2* points, std::size_t n, kernel::filter_bound bound,
                 std::size_t& undecided) {
  const kernel::double2 first = points[0];
  std::size_t second = 1;
  while (second < n && is_same(points[second], first)) ++second;
  for (std::size_t i = second + 1; i < n; ++i) {
    int side = kernel::orient_filtered(first, points[second], points[i], bound);
    if (side == UNDECIDED) {
      ++undecided;
      side = kernel::orient_exact(first, points[second], points[i]);
    }
    if (side != 0) return false;
  }
  return true;
}

// Triangulates the set in s.vertices, whose points are on one line: without triangles, so that sorting is
// all.
MeshSizes sort_line(Scratch& s, std::size_t n, Triangulation& result) {
  const auto* const points = reinterpret_cast<const kernel::double2*>(s.vertices.data());
  sized(s.ranks, 2 * n);
  auto* elements = reinterpret_cast<kernel::keyed*>(s.ranks.data());
  const auto count = static_cast<int>(n);
  for (int i = 0; i < count; ++i) elements[i] = kernel::keyed_place(0, i);
  elements = kernel::sort_along(elements, elements + n, count, points, 0);
  result.hull.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const int at = kernel::place_of_keyed(elements[i]);
    if (!result.hull.empty() && is_same(points[at], points[result.hull.back()])) {
      result.representatives[at] = result.hull.back();
    } else {
      result.hull.push_back(at);
    }
  }
  MeshSizes sizes;
  sizes.triangle_offsets = {0, 0};
  sizes.hull_offsets = {0, result.hull.size()};
  sizes.vertices = result.hull.size();
  return sizes;
}

// Writes the results of a call other than arrays.
void write_outcome(Outcome outcome, std::size_t n, const Scratch& s, Triangulation& result) {
  result.statistics.device_bytes_peak = s.bytes();
  outcome.write(n, result.statistics);
  result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
  result.hull_offsets = std::move(outcome.sizes.hull_offsets);
}

}  // namespace

std::optional<points::SmallRings> small_rings(const double* coordinates,
                                              const std::vector<std::size_t>& offsets,
                                              Triangulation& result) {
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  const geometry::SetScalings scalings =
      geometry::set_scalings(coordinates, offsets, [coordinates](std::size_t first, std::size_t last) {
        return geometry::inspect(coordinates, first, last);
      });

  Scratch& s = host::of_thread<Scratch>();
  s.offsets.assign(offsets.begin(), offsets.end());
  s.set_blocks.resize(sets + 1);
  std::iota(s.set_blocks.begin(), s.set_blocks.end(), 0);
  std::size_t largest = 0;
  for (std::size_t b = 0; b < sets; ++b) largest = std::max(largest, offsets[b + 1] - offsets[b]);

  const auto representatives = result_of(result.representatives, n);
  std::iota(result.representatives.begin(), result.representatives.end(), 0);
  const auto source = sized(s.source, n);
  std::iota(s.source.begin(), s.source.begin() + static_cast<std::ptrdiff_t>(n), 0);
  const auto vertices = sized(s.vertices, n);
  for (std::size_t set = 0; set < sets; ++set) {
    const kernel::scaling scale = kernel::scale_of(scalings.shift(set));
    for (std::size_t i = offsets[set]; i < offsets[set + 1]; ++i) {
      const kernel::double2 p = kernel::scaled_point(static_cast<int>(i), coordinates, scale);
      s.vertices[i] = {p.x, p.y};
    }
  }

  std::size_t undecided = 0;
  if (sets == 1 && n > 0 &&
      are_on_line(reinterpret_cast<const kernel::double2*>(s.vertices.data()), n, scalings.bounds.orient,
                  undecided)) {
    MeshSizes sizes = sort_line(s, n, result);
    write_outcome({std::move(sizes), undecided}, n, s, result);
    return {};
  }

  const auto edges = sized(s.edges, kernel::EDGES_PER_VERTEX * n);
  const auto vertex_edge = sized(s.vertex_edge, n);
  const auto solved = sized(s.solved, sets);
  cl_int next = 0;
  cl_uint counts[kernel::RINGS_NUMBERS] = {};
  const auto account = here(counts);
  host::run_natively(1,
                     kernels::solve_blocks{.workers = 1,
                                           .blocks = sets,
                                           .capacity = largest,
                                           .larger = -1,
                                           .offsets = here(s.offsets),
                                           .bounds = scalings.bounds,
                                           .most_ties = kernel::MOST_TIES,
                                           .next = here(&next),
                                           .block_points = {.points = vertices,
                                                            .source = source,
                                                            .representatives = representatives,
                                                            .solved = solved,
                                                            .distinct_counts = result_of(s.distinct, sets)},
                                           .edges = edges,
                                           .vertex_edge = vertex_edge,
                                           .account = account,
                                           .block_scratch = {.scratch_points = sized(s.points, largest),
                                                             .scratch_source = sized(s.point_source, largest),
                                                             .scratch_ranks = sized(s.ranks, 3 * largest)},
                                           .scratch_axes = sized(s.axes, largest)});

  const std::size_t pairs = kernel::PAIRS_PER_VERTEX * n;
  if (counts[kernel::RINGS_TIES_LEFT] > 0) {
    const auto inside = sized(s.inside, pairs), found = sized(s.found, pairs);
    const float bound = scalings.bounds.circle;
    map_natively(
        pairs, kernels::find_inside{
                   .bound = bound, .account = account, .points = vertices, .edges = edges, .unsure = found});
    map_natively(pairs, kernels::find_inside_exactly{.with_quadrilaterals = 0,
                                                     .bound = bound,
                                                     .account = account,
                                                     .points = vertices,
                                                     .edges = edges,
                                                     .unsure = found,
                                                     .inside = inside});
    map_natively(pairs, kernels::find_fans{.account = account,
                                           .points = vertices,
                                           .edges = edges,
                                           .inside = inside,
                                           .vertex_edge = vertex_edge,
                                           .found = found});
    map_natively(pairs,
                 kernels::build_fans{.account = account, .inside = inside, .found = found, .edges = edges});
  }

  const auto first_rows = sized(s.first_rows, n + 1);
  map_natively(n, kernels::vertex_triangles{.vertex_edge = vertex_edge, .counts = first_rows});
  const auto set_blocks = here(s.set_blocks);
  map_natively(sets, kernels::mark_outside{.set_blocks = set_blocks,
                                           .solved = solved,
                                           .vertex_edge = vertex_edge,
                                           .edges = edges,
                                           .counts = first_rows,
                                           .hull_sizes = result_of(s.walked, sets)});
  s.first_rows[n] = 0;
  std::exclusive_scan(s.first_rows.data(), s.first_rows.data() + n + 1, s.first_rows.data(), cl_uint{0});
  MeshSizes sizes = mesh_sizes(s.set_blocks, s.distinct, s.walked, s.first_rows[n]);

  s.hull_offsets.assign(sizes.hull_offsets.begin(), sizes.hull_offsets.end());
  map_natively(sets, kernels::write_hulls{.set_blocks = set_blocks,
                                          .solved = solved,
                                          .vertex_edge = vertex_edge,
                                          .edges = edges,
                                          .source = source,
                                          .offsets = here(s.hull_offsets),
                                          .hull = result_of(result.hull, sizes.hull_vertices())});
  write_outcome({std::move(sizes), counts[kernel::RINGS_UNDECIDED]}, n, s, result);
  return points::SmallRings{scalings.bounds,
                            n,
                            reinterpret_cast<const kernel::double2*>(s.vertices.data()),
                            s.source.data(),
                            s.edges.data(),
                            s.vertex_edge.data(),
                            s.first_rows.data()};
}

void run_small(const double* coordinates, const std::vector<std::size_t>& offsets, const Options& options,
               Triangulation& result) {
  if (!small_rings(coordinates, offsets, result)) return;
  Scratch& s = host::of_thread<Scratch>();
  const std::size_t pairs = kernel::PAIRS_PER_VERTEX * offsets.back();
  const auto edges = here(s.edges);
  const bool with_corners = options.neighbors || options.halfedges;
  const std::size_t rows = 3 * result.triangle_offsets.back();
  host::run_chunk_natively(pairs, kernels::write_triangles{.with_corners = with_corners,
                                                           .points = here(s.vertices),
                                                           .source = here(s.source),
                                                           .edges = edges,
                                                           .first_rows = here(s.first_rows),
                                                           .triangles = result_of(result.triangles, rows)});
  if (options.neighbors) {
    map_natively(pairs,
                 kernels::write_neighbors{.edges = edges, .neighbors = result_of(result.neighbors, rows)});
  }
  if (options.halfedges) {
    map_natively(pairs,
                 kernels::write_halfedges{.edges = edges, .halfedges = result_of(result.halfedges, rows)});
  }
}

}  // namespace flaunay::blocks
