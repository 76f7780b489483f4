#include "blocks/small.hpp"

// clang-format off: before the headers of kernels
#include "host/native/opencl.hpp"
// clang-format on

#include <algorithm>
#include <numeric>

#include "arithmetic/bit_account.h"
#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "blocks/codes.h"
#include "blocks/halving.h"
#include "blocks/pipeline.hpp"
#include "blocks/rings_account.h"
#include "blocks/rows.h"
#include "blocks/run.hpp"
#include "geometry/magnitudes.hpp"
#include "host/of_thread.hpp"
#include "mesh/halfedges.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "points/cut_tree.h"

namespace flaunay::kernel {
#include "host/native/words.h"
//
#include "blocks/divide.cl"
#include "blocks/fans.cl"
#include "blocks/mesh.cl"
#include "points/inspect.cl"
//
#include "host/native/end_of_words.h"
}  // namespace flaunay::kernel

namespace flaunay::blocks {
namespace {

// The arrays of a call, as the stages of mode blocks describe them; they are used by the next call of the
// thread.
struct Scratch {
  std::vector<int> offsets, set_blocks;
  std::vector<kernel::double2> vertices;
  std::vector<int> source;
  std::vector<kernel::ring_edge> edges;
  std::vector<int> vertex_edge;
  std::vector<kernel::solved_block> solved;
  std::vector<int> distinct;
  // Of the largest block.
  std::vector<kernel::double2> points;
  std::vector<int> point_source;
  std::vector<kernel::int2> ranks;
  std::vector<kernel::uchar> axes;
  std::vector<kernel::uchar> inside, found;
  std::vector<kernel::uint> first_rows;
  std::vector<int> walked, hull_offsets, corner_of_edge;

  std::size_t bytes() const {
    const auto sum = [](const auto&... arrays) {
      return (... + (arrays.capacity() * sizeof(*arrays.data())));
    };
    return sum(offsets, set_blocks, vertices, source, edges, vertex_edge, solved, distinct, points,
               point_source, ranks, axes, inside, found, first_rows, walked, hull_offsets, corner_of_edge);
  }
};

// Returns an array of this size, whose elements may have any value.
template <typename T>
T* sized(std::vector<T>& array, std::size_t size) {
  if (array.size() < size) array.resize(size);
  return array.data();
}

// Runs a kernel with n work-items.
template <typename Work>
void for_each_item(std::size_t n, const Work& work) {
  kernel::work_item = {0, n};
  for (; kernel::work_item.number < n; ++kernel::work_item.number) work();
}

geometry::Magnitudes inspected(const double* coordinates, std::size_t first, std::size_t last) {
  geometry::Magnitudes magnitudes;
  kernel::inspect_points(static_cast<int>(first), static_cast<int>(last),
                         reinterpret_cast<const kernel::double_bits*>(coordinates), &magnitudes.largest);
  return magnitudes;
}

}  // namespace

void run_small(const double* coordinates, const std::vector<std::size_t>& offsets, const Options& options,
               Triangulation& result) {
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  const auto point_count = static_cast<int>(n), set_count = static_cast<int>(sets);
  const geometry::SetScalings scalings = geometry::set_scalings(
      coordinates, offsets,
      [coordinates](std::size_t first, std::size_t last) { return inspected(coordinates, first, last); });

  Scratch& s = host::of_thread<Scratch>();
  s.offsets.assign(offsets.begin(), offsets.end());
  s.set_blocks.resize(sets + 1);
  std::iota(s.set_blocks.begin(), s.set_blocks.end(), 0);
  std::size_t largest = 0;
  for (std::size_t b = 0; b < sets; ++b) largest = std::max(largest, offsets[b + 1] - offsets[b]);

  result.representatives.resize(n);
  std::iota(result.representatives.begin(), result.representatives.end(), 0);
  int* const source = sized(s.source, n);
  std::iota(source, source + n, 0);
  kernel::double2* const vertices = sized(s.vertices, n);
  for (std::size_t set = 0; set < sets; ++set) {
    const kernel::scaling scale = kernel::scale_of(scalings.shift(set));
    for (int i = s.offsets[set]; i < s.offsets[set + 1]; ++i) {
      vertices[i] = kernel::scaled_point(i, coordinates, scale);
    }
  }

  kernel::ring_edge* const edges = sized(s.edges, kernel::EDGES_PER_VERTEX * n);
  int* const vertex_edge = sized(s.vertex_edge, n);
  kernel::solved_block* const solved = sized(s.solved, sets);
  s.distinct.resize(sets);
  int next = 0;
  kernel::uint account[kernel::RINGS_NUMBERS] = {};
  for_each_item(1, [&] {
    kernel::solve_blocks(1, set_count, static_cast<int>(largest), -1, s.offsets.data(), scalings.bounds,
                         &next, vertices, source, result.representatives.data(), solved, s.distinct.data(),
                         edges, vertex_edge, account, sized(s.points, largest),
                         sized(s.point_source, largest), sized(s.ranks, 3 * largest), sized(s.axes, largest));
  });

  const int pairs = kernel::PAIRS_PER_VERTEX * point_count;
  if (account[kernel::RINGS_TIES] > 0) {
    kernel::uchar* const inside = sized(s.inside, static_cast<std::size_t>(pairs));
    kernel::uchar* const found = sized(s.found, static_cast<std::size_t>(pairs));
    const auto for_each_pair = [pairs](const auto& work) {
      for_each_item(static_cast<std::size_t>(pairs), work);
    };
    const double bound = scalings.bounds.circle;
    for_each_pair([&] { kernel::find_inside(pairs, bound, account, vertices, edges, inside); });
    for_each_pair([&] { kernel::find_inside_exactly(pairs, bound, account, vertices, edges, inside); });
    for_each_item(n, [&] { kernel::leave_inside(point_count, account, edges, inside, vertex_edge); });
    for_each_pair([&] { kernel::find_fans(pairs, account, vertices, edges, inside, found); });
    for_each_pair([&] { kernel::build_fans(pairs, account, inside, found, edges); });
  }

  kernel::uint* const first_rows = sized(s.first_rows, n + 1);
  for_each_item(n, [&] { kernel::vertex_triangles(point_count, vertex_edge, first_rows); });
  s.walked.resize(sets);
  for_each_item(sets, [&] {
    kernel::mark_outside(set_count, s.set_blocks.data(), solved, vertex_edge, edges, first_rows,
                         s.walked.data());
  });
  first_rows[n] = 0;
  std::exclusive_scan(first_rows, first_rows + n + 1, first_rows, kernel::uint{0});
  MeshSizes sizes = mesh_sizes(s.set_blocks, s.distinct, s.walked, first_rows[n]);

  const bool with_corners = options.neighbors || options.halfedges;
  int* const corner_of_edge = with_corners ? sized(s.corner_of_edge, kernel::EDGES_PER_VERTEX * n) : nullptr;
  result.triangles.resize(3 * sizes.triangles());
  for_each_item(1, [&] {
    kernel::write_triangles(pairs, pairs, with_corners, vertices, source, edges, first_rows,
                            result.triangles.data(), corner_of_edge);
  });
  if (options.neighbors) {
    result.neighbors.resize(3 * sizes.triangles());
    for_each_item(static_cast<std::size_t>(pairs),
                  [&] { kernel::write_neighbors(pairs, corner_of_edge, result.neighbors.data()); });
  }
  if (options.halfedges) {
    result.halfedges.resize(3 * sizes.triangles());
    for_each_item(static_cast<std::size_t>(pairs),
                  [&] { kernel::write_halfedges(pairs, corner_of_edge, result.halfedges.data()); });
  }
  result.hull.resize(sizes.hull_vertices());
  s.hull_offsets.assign(sizes.hull_offsets.begin(), sizes.hull_offsets.end());
  for_each_item(sets, [&] {
    kernel::write_hulls(set_count, s.set_blocks.data(), solved, vertex_edge, edges, source,
                        s.hull_offsets.data(), result.hull.data());
  });
  result.statistics.device_bytes_peak = s.bytes();
  Outcome outcome{std::move(sizes), account[kernel::RINGS_UNDECIDED]};
  outcome.write(n, result.statistics);
  result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
  result.hull_offsets = std::move(outcome.sizes.hull_offsets);
}

}  // namespace flaunay::blocks
