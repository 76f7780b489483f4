#include "modes/flattened/regions.hpp"

#include "launchers/flattened/regions.cl.hpp"
#include "launchers/flattened/strips.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
namespace {

// The blocks that regions are solved as, and where the points of each place are.
struct RegionBlocks {
  points::Blocks blocks;
  Buffer<cl_int> owners{};  ///< the place of the first of equal points, by place
  Buffer<cl_int> ids{};     ///< by place
};

RegionBlocks make_blocks(Workspace& work, const PointTable& table, const Level& level, Arena& arena) {
  host::Runtime& runtime = work.runtime;
  RegionBlocks made;
  points::Blocks& blocks = made.blocks;
  blocks.sets = 1;
  blocks.count = level.regions;
  blocks.points = level.points + level.corners;
  blocks.device_offsets = arena.allocate<cl_int>(level.regions + 1);
  blocks.vertices = arena.allocate<cl_double2>(blocks.points);
  blocks.source = arena.allocate<cl_int>(blocks.points);
  made.owners = arena.allocate<cl_int>(blocks.points);
  made.ids = arena.allocate<cl_int>(blocks.points);
  runtime.map(level.regions + 1, kernels::region_offsets{.point_offsets = level.point_offsets,
                                                         .corner_offsets = level.corner_offsets,
                                                         .offsets = blocks.device_offsets});
  runtime.map(level.points, kernels::place_points{.list = level.x_list,
                                                  .regions = level.point_regions,
                                                  .corner_offsets = level.corner_offsets,
                                                  .points = table.points,
                                                  .vertices = blocks.vertices,
                                                  .source = blocks.source,
                                                  .owners = made.owners,
                                                  .ids = made.ids});
  runtime.map(level.corners, kernels::place_corners{.corners = level.corner_ids,
                                                    .regions = level.corner_regions,
                                                    .point_offsets = level.point_offsets,
                                                    .points = table.points,
                                                    .vertices = blocks.vertices,
                                                    .source = blocks.source,
                                                    .owners = made.owners,
                                                    .ids = made.ids});
  blocks.offsets = read_all(work, blocks.device_offsets, level.regions + 1);
  return made;
}

// Makes every edge of a border an edge of its region's rings, and finds it by its corner.
Buffer<cl_int> find_borders(Workspace& work, const PointTable& table, const Level& level,
                            const points::Blocks& blocks, const points::Rings& rings,
                            const Buffer<cl_int>& corner_vertex) {
  host::Runtime& runtime = work.runtime;
  const kernels::strip_corners strip_corners{.corners = level.corner_ids,
                                             .corner_region = level.corner_regions,
                                             .corner_vertex = corner_vertex,
                                             .vertices = blocks.source};
  const auto border_edge = work.scratch().allocate<cl_int>(level.corners);
  const auto missing = work.scratch().allocate<cl_int>(level.regions);
  runtime.fill(missing, level.regions, cl_int{0});
  runtime.map(level.corners, kernels::border_edges{.strip_corners = strip_corners,
                                                   .vertex_edge = rings.vertex_edge,
                                                   .edges = rings.edges,
                                                   .border_edge = border_edge,
                                                   .missing = missing});
  runtime.map(level.regions, kernels::restore_border{.missing = missing,
                                                     .large_offsets = level.corner_offsets.as<cl_uint>(),
                                                     .strip_corners = strip_corners,
                                                     .places = blocks.vertices,
                                                     .points = table.points,
                                                     .bounds = work.bounds,
                                                     .edges = rings.edges,
                                                     .vertex_edge = rings.vertex_edge,
                                                     .border_edge = border_edge,
                                                     .broken = work.broken});
  return border_edge;
}

// Marks triangles outside of the borders. The arena of the level has room, after its largest levels. Returns
// where the rows of each vertex begin, closed by their number.
Buffer<cl_uint> cut_out(Workspace& work, const PointTable& table, const Level& level,
                        const RegionBlocks& made, const points::Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const points::Blocks& blocks = made.blocks;
  const auto rows = work.children->allocate<cl_uint>(blocks.points + 1);
  Arena::Scope scope(scratch), children_scope(*work.children);
  const auto vertex_of = work.children->allocate<cl_int>(blocks.points);
  const auto corner_vertex = scratch.allocate<cl_int>(level.corners);
  runtime.map(blocks.points, kernels::name_vertices{.vertex_edge = rings.vertex_edge,
                                                    .ids = made.ids,
                                                    .side = table.side,
                                                    .source = blocks.source,
                                                    .vertex_of = vertex_of,
                                                    .counts = rows});
  runtime.map(level.corners, kernels::corner_vertices{.regions = level.corner_regions,
                                                      .point_offsets = level.point_offsets,
                                                      .owners = made.owners,
                                                      .vertex_of = vertex_of,
                                                      .corner_vertex = corner_vertex});
  const auto border_edge = find_borders(work, table, level, blocks, rings, corner_vertex);
  runtime.map(level.corners, kernels::close_vertices{.regions = level.corner_regions,
                                                     .point_offsets = level.point_offsets,
                                                     .owners = made.owners,
                                                     .corner_vertex = corner_vertex,
                                                     .vertex_edge = rings.vertex_edge,
                                                     .edges = rings.edges});
  runtime.map(level.corners, kernels::open_wedges{.corners = level.corner_ids,
                                                  .corner_vertex = corner_vertex,
                                                  .border_edge = border_edge,
                                                  .ids = blocks.source,
                                                  .points = blocks.vertices,
                                                  .edges = rings.edges,
                                                  .counts = rows,
                                                  .broken = work.broken});
  host::exclusive_scan(runtime, rows, blocks.points, rows);
  return rows;
}

}  // namespace

SolvedRegions solve_regions(Workspace& work, const PointTable& table, const Level& level, Arena& arena,
                            const BlockSolver& solver, const Buffer<cl_int>& triangles, std::size_t base,
                            const Buffer<cl_int>& twins) {
  SolvedRegions solved;
  if (level.regions == 0) return solved;
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch), arena_scope(arena), children_scope(*work.children);
  const RegionBlocks made = make_blocks(work, table, level, arena);
  points::Workspace solver_work{runtime, scratch, work.bounds};
  const points::Rings rings = solver.solve(solver_work, made.blocks, made.owners);
  solved.undecided = rings.undecided;
  solved.ties = rings.ties;
  const Buffer<cl_uint> rows = cut_out(work, table, level, made, rings);
  solved.triangles = runtime.read_one(rows, made.blocks.points);
  // The rows of a broken border need not fit.
  check_invariants(work);
  if (base + solved.triangles > triangles.size() / 3) return solved;
  runtime.map(made.blocks.points + 1, kernels::shift_rows{.base = static_cast<cl_uint>(base), .rows = rows});
  solver.write_rows(solver_work, made.blocks, rings, rows, triangles, twins);
  return solved;
}

}  // namespace flaunay::flattened
