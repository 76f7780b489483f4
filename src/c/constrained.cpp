// The C interface to triangulations with constraints.
#include "flaunay/constrained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::required;

namespace {

// Values that do not count must be 0, so that no has_... is forgotten.
void check_forgotten(const flaunay_refinement& given) {
  Refinement none;
  c::for_each_member<"areas_at", "areas_data", "mesh">(
      given, none, [](auto value, auto&, bool counts, const char* name) {
        if constexpr (std::is_arithmetic_v<decltype(value)>) {
          expect(counts || value == 0,
                 [=] { return fmt::format("{} is {}, but has_{} is 0: set it, too", name, value, name); });
        }
      });
}

Refinement to_refinement(const flaunay_refinement* wanted) {
  Refinement result;
  if (wanted == nullptr) return result;
  const flaunay_refinement& given = *wanted;
  c::take<"areas_at", "areas_data", "mesh">(given, result);
  if (given.areas_at != nullptr) {
    result.areas_at = [call = given.areas_at, data = given.areas_data](const double* places,
                                                                       std::size_t count, double* areas) {
      call(places, count, areas, data);
    };
  }
  if (given.mesh != nullptr) c::take(*given.mesh, result.mesh);
  expect(!(given.min_edge < 0),
         [&] { return fmt::format("min_edge is {}, but it must be a length from 0 on", given.min_edge); });
  check_forgotten(given);
  result.measured = true;
  return result;
}

// Polygons with their options.
struct AskedPolygons : Polygons, PolygonOptions {};

// Takes over what is the same for segments and for polygons.
template <typename Given>
void take_common(const Given& given, const flaunay_options* options, ConstrainedOptions& result) {
  const research::Options plain = c::to_options(options);
  expect(plain.mode == research::Mode::blocks, [&] {
    return fmt::format("mode {} has no constraints; mode {} has", to_string(plain.mode),
                       to_string(research::Mode::blocks));
  });
  static_cast<Options&>(result) = plain;
  result.refinement = to_refinement(given.refinement);
}

// A copy of the caller's arrays.
ConstrainedTriangulation to_result(const flaunay_mesh* mesh, const flaunay_constrained_arrays* arrays,
                                   const flaunay_refinement_report* report) {
  ConstrainedTriangulation result;
  c::copy_to(result, required(mesh, "the mesh"), required(arrays, "the arrays of constraints"));
  if (report == nullptr) return result;
  result.refinement.added_points = report->added_points;
  result.refinement.bad_triangles = c::copied(report->bad_triangles, report->bad_count, "bad triangles");
  return result;
}

// count: of what the offsets begin and end. Null: none.
std::vector<std::size_t> copy_offsets(const std::size_t* offsets, std::size_t count, const char* name) {
  if (offsets == nullptr) return {};
  check_count(count, name);
  return {offsets, offsets + count + 1};
}

AskedPolygons to_polygons(const flaunay_polygons& given, const flaunay_options* options) {
  AskedPolygons result;
  c::take<"ring_offsets", "ring_count", "polygon_offsets", "polygon_count", "part_offsets", "part_count",
          "refinement">(given, result);
  take_common(given, options, result);
  check_array(given.ring_offsets, given.ring_count, "rings");
  result.ring_offsets = {0};
  if (given.ring_count > 0) result.ring_offsets = copy_offsets(given.ring_offsets, given.ring_count, "rings");
  result.polygon_offsets = copy_offsets(given.polygon_offsets, given.polygon_count, "polygons");
  if (given.polygon_offsets == nullptr) {
    result.polygon_offsets.resize(given.ring_count + 1);
    std::iota(result.polygon_offsets.begin(), result.polygon_offsets.end(), 0);
  }
  result.part_offsets = copy_offsets(given.part_offsets, given.part_count, "parts");
  return result;
}

}  // namespace

namespace flaunay::c {

flaunay_constrained_arrays view_of(const ConstrainedTriangulation& result) {
  flaunay_constrained_arrays view{};
  show<"added_count", "constraint_count", "segment_count", "piece_count">(result, view);
  view.added_count = result.added_points.size() / 2;
  view.constraint_count = result.constraint_edges.size() / 2;
  view.segment_count = result.piece_offsets.size() - 1;
  view.piece_count = result.piece_edges.size() / 2;
  return view;
}

void copy_to(ConstrainedTriangulation& result, const flaunay_mesh& mesh,
             const flaunay_constrained_arrays& more) {
  copy_to(result, mesh);
  const std::size_t triangles = mesh.triangle_count;
  expect(more.added_count <= mesh.point_count, "there are more added points than points");
  result.added_points = copied(more.added_points, 2 * more.added_count, "added points");
  result.added_offsets = copied_offsets(more.added_offsets, mesh.set_count, more.added_count);
  result.constraint_edges = copied(more.constraint_edges, 2 * more.constraint_count, "constraint edges");
  result.edge_segments = copied(more.edge_segments, more.constraint_count, "segments of edges");
  result.piece_offsets = {0};
  if (more.segment_count > 0 || more.piece_offsets != nullptr)
    result.piece_offsets = copied(more.piece_offsets, more.segment_count + 1, "offsets of pieces");
  result.piece_edges = copied(more.piece_edges, 2 * more.piece_count, "edges of pieces");
  result.constrained = copied(more.constrained, 3 * triangles, "constrained", true);
  result.depths = copied(more.depths, triangles, "depths", true);
  result.regions = copied(more.regions, triangles, "regions", true);
}

AskedConstraints to_constraints(const flaunay_constraints& given, std::size_t sets,
                                const flaunay_options* options) {
  AskedConstraints result;
  take<"hole_offsets", "seed_offsets", "refinement">(given, result);
  take_common(given, options, result);
  result.hole_offsets = copy_offsets(given.hole_offsets, sets, "sets");
  result.seed_offsets = copy_offsets(given.seed_offsets, sets, "sets");
  return result;
}

}  // namespace flaunay::c

flaunay_status flaunay_triangulate_constrained(flaunay_triangulator* triangulator, const double* coordinates,
                                               size_t n, const size_t* offsets, size_t sets,
                                               const flaunay_constraints* constraints,
                                               const flaunay_options* options,
                                               flaunay_triangulation** result) {
  return c::make(triangulator, result, [&](Triangulator& cpp) {
    const flaunay_constraints given = constraints != nullptr ? *constraints : flaunay_constraints{};
    const std::vector<std::size_t> sets_of_points = c::to_offsets(offsets, sets, n);
    const auto asked = c::to_constraints(given, c::set_count(sets_of_points), options);
    return cpp.constrained(coordinates, sets_of_points, asked, asked);
  });
}

flaunay_status flaunay_triangulate_polygons(flaunay_triangulator* triangulator,
                                            const flaunay_polygons* polygons, const flaunay_options* options,
                                            flaunay_triangulation** result) {
  return c::make(triangulator, result, [&](Triangulator& cpp) {
    const AskedPolygons asked = to_polygons(required(polygons, "the polygons"), options);
    return cpp.polygons(asked, asked);
  });
}

FLAUNAY_ACCESSOR(const flaunay_constrained_arrays*, triangulation, constraints,
                 handle.constrained() != nullptr ? &handle.constraints : nullptr)
FLAUNAY_ACCESSOR(const flaunay_refinement_report*, triangulation, refinement,
                 handle.constrained() != nullptr ? &handle.refinement : nullptr)

flaunay_status flaunay_mesh_verify_constrained(const flaunay_mesh* mesh,
                                               const flaunay_constrained_arrays* arrays,
                                               const flaunay_refinement_report* report,
                                               const double* coordinates, const size_t* offsets,
                                               const flaunay_constraints* constraints) {
  return c::verified([&] {
    const ConstrainedTriangulation result = to_result(mesh, arrays, report);
    const flaunay_constraints given = constraints != nullptr ? *constraints : flaunay_constraints{};
    const std::size_t n = result.representatives.size() - result.added_points.size() / 2;
    const auto asked = c::to_constraints(given, std::max<std::size_t>(mesh->set_count, 1), nullptr);
    return verify(coordinates, c::copied_offsets(offsets, mesh->set_count, n), asked, asked, result);
  });
}

flaunay_status flaunay_mesh_verify_polygons(const flaunay_mesh* mesh,
                                            const flaunay_constrained_arrays* arrays,
                                            const flaunay_refinement_report* report,
                                            const flaunay_polygons* polygons) {
  return c::verified([&] {
    const AskedPolygons asked = to_polygons(required(polygons, "the polygons"), nullptr);
    return verify(asked, asked, to_result(mesh, arrays, report));
  });
}

flaunay_status flaunay_triangulate_constrained_device(flaunay_triangulator* triangulator,
                                                      const flaunay_device_points* points, cl_mem segments,
                                                      size_t segment_count, const flaunay_enqueue* enqueue,
                                                      flaunay_device_triangulation* mesh) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    flaunay_device_triangulation& handle = required(mesh, "the mesh");
    handle.clear();
    cpp.constrained(c::to_points(points), {segments, segment_count}, handle.cpp, queued);
    handle.show();
  });
}
