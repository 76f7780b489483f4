#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "call/frame.hpp"
#include "constrained/refinement/bounds.hpp"
#include "constrained/refinement/sets.hpp"
#include "constrained/stages.hpp"
#include "statistics/phases.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

using constrained::MeshToRefine;
using constrained::RefinedMesh;

// The threads for loops over this number of triangles.
host::Runtime& threads_for(Implementation& self, std::size_t triangles) {
  return (triangles > host::Runtime::kPart ? self.native() : Engine::of_thread()).runtime;
}

RefinedMesh refine_on(Engine& engine, const MeshToRefine& mesh, bool profile, const Refinement& wanted,
                      Statistics& statistics) {
  RefinedMesh refined;
  {
    Frame call(engine, profile);
    refined = constrained::refine(engine.runtime, mesh, wanted);
    call.end();
  }
  if (&engine != &Engine::of_thread()) add_accounts(engine, statistics);
  return refined;
}

// Refines sets one by one, small ones on threads, so that each is as if it were alone.
RefinedMesh refine_sets(Implementation& self, Engine& engine, const MeshToRefine& all,
                        const std::vector<constrained::SetNumbers>& sets, bool profile,
                        const Refinement& wanted, constrained::RefinedOffsets& offsets,
                        Statistics& statistics) {
  std::vector<RefinedMesh> parts(sets.size());
  std::vector<std::size_t> small;
  const auto refine_set = [&](std::size_t s, Engine& by) {
    std::vector<double> coordinates;
    const MeshToRefine mesh = constrained::mesh_of_set(all, sets[s], coordinates);
    parts[s] = refine_on(by, mesh, profile, wanted, statistics);
  };
  const std::size_t most = self.host_tuning().host_points;
  std::size_t triangles = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::size_t first = sets[s].first_triangle, end = first + sets[s].triangles;
    if (first == end) continue;
    if (!profile && constrained::expected_points(all, first, end) <= most) {
      small.push_back(s);
    } else {
      refine_set(s, engine);
    }
  }
  // The caller's function has one thread.
  const bool is_alone = wanted.areas_at || &engine == &Engine::of_thread();
  const auto share = [&](std::size_t count, const std::function<void(std::size_t)>& work) {
    if (!is_alone) return self.native().runtime.share(count, work);
    for (std::size_t k = 0; k < count; ++k) work(k);
  };
  share(small.size(), [&](std::size_t k) { refine_set(small[k], Engine::of_thread()); });
  for (const RefinedMesh& part : parts) triangles += part.parents.size();
  return constrained::join_sets(threads_for(self, triangles), sets, parts, all.points, share, offsets);
}

}  // namespace

void measure_angles(Implementation& self, const double* coordinates, std::size_t n,
                    ConstrainedTriangulation& result) {
  constrained::measure_angles(threads_for(self, result.triangles.size() / 3), coordinates, n, false, result);
}

void check_refinement(const Refinement& wanted, std::size_t seeds) {
  constrained::quality_bounds(wanted.min_angle);
  constrained::check_areas(&wanted.max_area, 1, "all triangles");
  if (wanted.seed_areas != nullptr) constrained::check_areas(wanted.seed_areas, seeds, "seed");
  if (wanted.mesh.areas != nullptr)
    constrained::check_areas(wanted.mesh.areas, wanted.mesh.count, "triangle of the mesh");
  expect(wanted.min_edge == kDefaultMinEdge || (wanted.min_edge >= 0 && std::isfinite(wanted.min_edge)), [&] {
    return fmt::format("the smallest edge is {}, but it must be a length from 0 on", wanted.min_edge);
  });
}

void refine(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
            const ConstrainedOptions& options, const std::vector<std::int32_t>& seeds,
            const std::vector<double>& areas, const StayingMesh& staying, ConstrainedTriangulation& result) {
  const Refinement& wanted = options.refinement;
  const std::size_t n = offsets.back(), points = n + result.added_points.size() / 2;
  constrained::FixedEdges edges;
  MeshToRefine mesh = constrained::take_mesh(threads_for(self, result.triangles.size() / 3), coordinates,
                                             points, wanted, seeds, areas, result, edges);
  Engine& asked =
      self.for_points(constrained::expected_points(mesh, 0, mesh.triangles.size() / 3), options.profile);
  Engine& engine = self.with_doubles(asked);
  if (staying.call && &staying.call->engine == &engine) {
    mesh.coordinates_there = staying.mesh.coordinates;
    mesh.triangles_there = staying.mesh.triangles;
    mesh.neighbors_there = staying.mesh.neighbors;
  }
  add_note(asked, engine, "refinement", "refined", result.statistics);
  const statistics::Phases phases(options);
  const host::Runtime::BeforeCompiling announce(engine.runtime,
                                                [&] { phases.interrupt("compiling kernels"); });
  phases.progress("refine", 0);
  constrained::RefinedOffsets sets;
  RefinedMesh refined =
      offsets.size() > 2
          ? refine_sets(self, engine, mesh, constrained::numbers_of_sets(mesh, offsets, result),
                        options.profile, wanted, sets, result.statistics)
          : refine_on(engine, mesh, options.profile, wanted, result.statistics);
  if (offsets.size() == 2) sets = {{0, refined.parents.size()}, {0, refined.added.size() / 2}};

  const constrained::Angles before = refined.before_smoothing;
  host::Runtime& threads = threads_for(self, refined.parents.size());
  constrained::write_mesh(threads, edges, n, sets, refined, result);
  constrained::measure_angles(threads, coordinates, n, wanted.smoothing_steps > 0, result);
  result.refinement.smallest_angle_before = before.smallest();
  result.refinement.mean_angle_before = before.mean();
  result.statistics.points += result.refinement.added_points;
  result.statistics.hull_vertices = result.hull.size();
}

}  // namespace flaunay::call
