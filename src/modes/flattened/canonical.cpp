#include <utility>

#include "launchers/flattened/canonical.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace geometry;

bool any_cocircular(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                    const Buffer<cl_int>& twins, const Buffer<cl_int>& list, std::size_t listed) {
  const auto found = work.scratch().allocate<cl_int>(1);
  work.runtime.fill(found, 1, cl_int{0});
  work.runtime.map(listed, kernels::cocircular_listed{.bound = work.bounds.circle,
                                                      .list = list,
                                                      .triangles = triangles,
                                                      .twins = twins,
                                                      .points = table.points,
                                                      .found = found,
                                                      .broken = work.broken});
  return work.runtime.read_one(found, 0) != 0;
}

void canonicalize(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                  std::size_t count, const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const std::size_t halfedges = 3 * count;
  const auto dissolved = scratch.allocate<cl_uchar>(halfedges);
  runtime.map(halfedges, kernels::cocircular_flags{.bound = work.bounds.circle,
                                                   .triangles = triangles,
                                                   .twins = twins,
                                                   .points = table.points,
                                                   .flags = dissolved,
                                                   .broken = work.broken});
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, dissolved, halfedges);
    run_list(work, kernels::cocircular_exact{.bound = work.bounds.circle,
                                             .count = work.list_length,
                                             .list = list,
                                             .triangles = triangles,
                                             .twins = twins,
                                             .points = table.points,
                                             .flags = dissolved,
                                             .broken = work.broken});
  }
  const auto [edges, edge_count] = host::pack_positions(runtime, dissolved, halfedges, 1);
  if (edge_count == 0) return;
  runtime.map(edge_count, kernels::dissolve_twins{.list = edges, .twins = twins, .flags = dissolved});
  const auto in_cell = scratch.allocate<cl_uchar>(count);
  const auto border = scratch.allocate<cl_uchar>(halfedges);
  runtime.map(count, kernels::cell_flags{.dissolved = dissolved, .in_cell = in_cell, .border = border});
  const auto [cell_triangles, cell_triangle_count] = host::pack_positions(runtime, in_cell, count, 1);
  const auto [list, list_count] = host::pack_positions(runtime, border, halfedges, 1);

  const Buffer<cl_int> label = scratch.allocate<cl_int>(list_count);
  {
    Arena::Scope label_scope(scratch);
    Buffer<cl_int> next = scratch.allocate<cl_int>(list_count);
    Buffer<cl_int> now = label;
    {
      Arena::Scope place_scope(scratch);
      const auto place = scratch.allocate<cl_int>(halfedges);
      runtime.map(list_count, kernels::cell_places{.list = list, .place = place});
      runtime.map(list_count, kernels::cell_links{.list = list,
                                                  .place = place,
                                                  .triangles = triangles,
                                                  .twins = twins,
                                                  .dissolved = dissolved,
                                                  .next = next,
                                                  .label = now});
    }
    Buffer<cl_int> other_next = scratch.allocate<cl_int>(list_count);
    Buffer<cl_int> other = scratch.allocate<cl_int>(list_count);
    const auto changed = scratch.allocate<cl_int>(1);
    // Each round doubles the distance over which labels travel along their cycle. When a round changes no
    // label, all labels of a cycle are equal.
    for (cl_int any = 1; any != 0;) {
      runtime.fill(changed, 1, cl_int{0});
      runtime.map(
          list_count,
          kernels::jump_labels{
              .next = next, .label = now, .new_next = other_next, .new_label = other, .changed = changed});
      std::swap(next, other_next);
      std::swap(now, other);
      any = runtime.read_one(changed, 0);
    }
    if (now.memory() != label.memory()) runtime.copy(now, 0, label, 0, list_count);
  }

  const auto counts = scratch.allocate<cl_uint>(list_count + 1);
  runtime.map(list_count,
              kernels::fan_flags{.list = list, .triangles = triangles, .label = label, .counts = counts});
  host::exclusive_scan(runtime, counts, list_count, counts);
  if (runtime.read_one(counts, list_count) != cell_triangle_count) {
    throw Error(ErrorKind::internal, "canonical: a cell's fan has not as many triangles as the cell");
  }
  const auto fans = scratch.allocate<cl_int>(3 * cell_triangle_count);
  runtime.map(list_count,
              kernels::fan_write{
                  .list = list, .triangles = triangles, .label = label, .scanned = counts, .fans = fans});
  runtime.map(cell_triangle_count,
              kernels::fan_place{.cell_triangles = cell_triangles, .fans = fans, .triangles = triangles});
  match_edges(work, triangles, count, twins);
}

}  // namespace flaunay::flattened
