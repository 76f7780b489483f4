#include <utility>

#include "flattened/stages.hpp"

namespace flaunay::flattened {

void match_edges(Workspace& work, const Buffer<cl_int>& triangles, std::size_t count,
                 const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  // Edges are half as many as half-edges, and some more for the hull's; at most three quarters of the table
  // full.
  std::size_t slots = 16;
  while (3 * slots < 4 * (3 * count + 3) / 2 + 64) slots *= 2;
  const auto table = work.scratch().allocate<cl_int>(slots);
  runtime.fill(table, slots, cl_int{-1});
  runtime.fill(twins, 3 * count, cl_int{-1});
  const auto mask = static_cast<cl_uint>(slots - 1);
  runtime.map("neighbors", "insert_edges", 3 * count, mask, triangles, table);
  runtime.map("neighbors", "match_edges", 3 * count, mask, triangles, table, twins);
}

void canonicalize(Workspace& work, const PointTable& table, const Buffer<cl_int>& triangles,
                  std::size_t count, const Buffer<cl_int>& twins) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const std::size_t halfedges = 3 * count;
  const auto dissolved = scratch.allocate<cl_uchar>(halfedges);
  runtime.map("canonical", "cocircular_flags", halfedges, work.bounds.circle, triangles, twins, table.points,
              dissolved, work.broken);
  {
    Arena::Scope list_scope(scratch);
    const auto list = pack_undecided(work, dissolved, halfedges);
    run_list(work, "canonical", "cocircular_exact", list, triangles, twins, table.points, dissolved,
             work.broken);
  }
  const auto [edges, edge_count] = host::pack_positions(runtime, dissolved, halfedges, 1);
  if (edge_count == 0) return;
  runtime.map("canonical", "dissolve_twins", edge_count, edges, twins, dissolved);
  const auto in_cell = scratch.allocate<cl_uchar>(count);
  const auto border = scratch.allocate<cl_uchar>(halfedges);
  runtime.map("canonical", "cell_flags", count, dissolved, in_cell, border);
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
      runtime.map("canonical", "cell_places", list_count, list, place);
      runtime.map("canonical", "cell_links", list_count, list, place, triangles, twins, dissolved, next, now);
    }
    Buffer<cl_int> other_next = scratch.allocate<cl_int>(list_count);
    Buffer<cl_int> other = scratch.allocate<cl_int>(list_count);
    const auto changed = scratch.allocate<cl_int>(1);
    // When doubling the reach changes no label, every label is its whole cycle's.
    for (cl_int any = 1; any != 0;) {
      runtime.fill(changed, 1, cl_int{0});
      runtime.map("canonical", "jump_labels", list_count, next, now, other_next, other, changed);
      std::swap(next, other_next);
      std::swap(now, other);
      any = runtime.read_one(changed, 0);
    }
    if (now.memory() != label.memory()) runtime.copy(now, 0, label, 0, list_count);
  }

  const auto counts = scratch.allocate<cl_uint>(list_count + 1);
  runtime.map("canonical", "fan_flags", list_count, list, triangles, label, counts);
  host::exclusive_scan(runtime, counts, list_count, counts);
  if (runtime.read_one(counts, list_count) != cell_triangle_count) {
    throw Error(ErrorKind::internal, "canonical: a cell's fan has not as many triangles as the cell");
  }
  const auto fans = scratch.allocate<cl_int>(3 * cell_triangle_count);
  runtime.map("canonical", "fan_write", list_count, list, triangles, label, counts, fans);
  runtime.map("canonical", "fan_place", cell_triangle_count, cell_triangles, fans, triangles);
  match_edges(work, triangles, count, twins);
}

}  // namespace flaunay::flattened
