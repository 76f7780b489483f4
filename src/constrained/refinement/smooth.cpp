#include "constrained/refinement/smooth.hpp"

#include "host/launch/vector_operations.hpp"
#include "refinement/codes.h"

namespace flaunay::constrained {
namespace {

using host::Arena;
using host::Buffer;

// Moves vertices, if no triangle turns over or becomes bad. changes: 1 for rows that have such vertices.
void move_vertices(host::Runtime& runtime, const MeshToSmooth& of, const Buffer<cl_uint>& changes) {
  Arena& arena = runtime.arena();
  Arena::Scope scope(arena);
  const auto stars = arena.allocate<cl_int>(of.vertices), moves = arena.allocate<cl_int>(of.vertices);
  const auto targets = arena.allocate<cl_double2>(of.vertices);
  const auto spoiled = arena.allocate<cl_uchar>(of.rows);
  runtime.fill(stars, of.vertices, cl_int{kernel::NO_STAR});
  runtime.map(of.rows, kernels::find_stars{.rows = of.triangles, .stars = stars});
  runtime.map_in_small_groups(
      of.vertices,
      kernels::propose_moves{
          .rules = of.rules, .stars = stars, .refined_mesh = of.mesh, .targets = targets, .moves = moves});
  for (int pass = kernel::STAYS;; ++pass) {
    Arena::Scope pass_scope(arena);
    runtime.map_in_small_groups(of.rows, kernels::find_spoiled{.pass = pass,
                                                               .rules = of.rules,
                                                               .refined_mesh = of.mesh,
                                                               .targets = targets,
                                                               .moves = moves,
                                                               .spoiled = spoiled});
    const auto [at, count] = host::pack_positions(runtime, spoiled, of.rows, 1);
    if (count == 0) break;
    runtime.map(count, kernels::cancel_moves{
                           .pass = pass + 1, .positions = at, .rows = of.triangles, .moves = moves});
  }
  runtime.map(of.vertices, kernels::apply_moves{.targets = targets, .moves = moves, .points = of.points});
  runtime.map(of.rows, kernels::find_moved{.rows = of.triangles, .moves = moves, .changes = changes});
}

// Which edges are flipped first depends on their coordinates alone, since triangles inherit from those
// before.
void make_delaunay(host::Runtime& runtime, const MeshToSmooth& of, const Buffer<cl_uint>& changes) {
  Arena& arena = runtime.arena();
  Arena::Scope scope(arena);
  const auto flips = arena.allocate<cl_uchar>(3 * of.rows);
  const auto claims = arena.allocate<cl_uint>(of.rows);
  for (cl_uint pass = 1;; ++pass) {
    Arena::Scope pass_scope(arena);
    runtime.map_in_small_groups(
        of.rows,
        kernels::find_flips{.pass = pass, .refined_mesh = of.mesh, .changes = changes, .flips = flips});
    const auto [corners, count] = host::pack_positions(runtime, flips, 3 * of.rows, 1);
    if (count == 0) break;
    const auto keys = arena.allocate<cl_ulong>(count);
    const auto wins = arena.allocate<cl_uchar>(count);
    runtime.map(count, kernels::keys_of_edges{.corners = corners, .refined_mesh = of.mesh, .keys = keys});
    host::sort_by_key(runtime, keys, corners, count);
    runtime.fill(claims, of.rows, cl_uint{UNCLAIMED_ROW});
    runtime.map(count, kernels::claim_flips{.corners = corners, .rows = of.triangles, .claims = claims});
    runtime.map(count, kernels::decide_flips{
                           .corners = corners, .rows = of.triangles, .claims = claims, .wins = wins});
    runtime.map(count, kernels::flip{.next_pass = pass + 1,
                                     .corners = corners,
                                     .wins = wins,
                                     .rows = of.triangles,
                                     .changes = changes});
  }
}

}  // namespace

void smooth(host::Runtime& runtime, const MeshToSmooth& of) {
  Arena& arena = runtime.arena();
  Arena::Scope scope(arena);
  const auto changes = arena.allocate<cl_uint>(of.rows);
  move_vertices(runtime, of, changes);
  make_delaunay(runtime, of, changes);
  runtime.map(of.rows,
              kernels::forget_changed{.changes = changes, .rows = of.triangles, .states = of.states});
}

}  // namespace flaunay::constrained
