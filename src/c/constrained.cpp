// The C interface to triangulations with constraints.
#include "flaunay/constrained.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::elements;
using c::required;

FLAUNAY_HANDLE(device_constraints, DeviceConstraintEdges)

namespace {

static_assert(c::agree<flaunay_excuse, Excuse, 1>());

// A value that counts if the caller says so. Others must be 0, so that none is forgotten.
template <typename T>
void take(int counts, T given, const char* name, T& value) {
  if (counts != 0) {
    value = given;
  } else if (given != 0) {
    throw Error(ErrorKind::usage, fmt::format("{} is {}, but has_{} is 0: set it, too", name, given, name));
  }
}

Refinement to_refinement(const flaunay_refinement* wanted) {
  Refinement result;
  if (wanted == nullptr) return result;
  const flaunay_refinement& given = *wanted;
  c::check_reserved(given, "flaunay_refinement");
  result.min_angle = given.min_angle;
  result.max_area = given.max_area;
  result.seed_areas = given.seed_areas;
  if (given.areas_at != nullptr) {
    result.areas_at = [call = given.areas_at, data = given.areas_data](const double* places,
                                                                       std::size_t count, double* areas) {
      call(places, count, areas, data);
    };
  }
  result.conforming = given.conforming != 0;
  if (given.mesh != nullptr) {
    c::check_reserved(*given.mesh, "flaunay_given_triangles");
    result.mesh = {given.mesh->triangles, given.mesh->count, given.mesh->areas, given.mesh->attributes};
  }
  result.kept = c::to_enum<flaunay_kept_edges, KeptEdges>(given.kept);
  result.kept_segments = given.kept_segments;
  if (given.min_edge < 0) {
    throw Error(ErrorKind::usage,
                fmt::format("min_edge is {}, but it must be a length from 0 on", given.min_edge));
  }
  take(given.has_min_edge, given.min_edge, "min_edge", result.min_edge);
  take(given.has_most_points, given.most_points, "most_points", result.most_points);
  take(given.has_most_rounds, given.most_rounds, "most_rounds", result.most_rounds);
  result.smoothing_steps = given.smoothing_steps;
  result.measured = true;
  return result;
}

// The options that are the same for segments and for polygons, without the defaults that differ.
template <typename Result, typename Given>
Result to_common_options(const Given& given, const flaunay_options* options) {
  const research::Options plain = c::to_options(options);
  if (plain.mode != research::Mode::blocks) {
    throw Error(ErrorKind::usage, fmt::format("mode {} has no constraints; mode {} has",
                                              to_string(plain.mode), to_string(research::Mode::blocks)));
  }
  Result result;
  static_cast<Options&>(result) = plain;
  result.crossings = c::to_enum<flaunay_crossings, Crossings>(given.crossings);
  result.labels = given.labels != 0;
  result.refinement = to_refinement(given.refinement);
  return result;
}

PolygonOptions to_polygon_options(const flaunay_polygons& given, const flaunay_options* options) {
  auto result = to_common_options<PolygonOptions>(given, options);
  if (given.has_outside != 0) result.outside = c::to_enum<flaunay_outside, Outside>(given.outside);
  if (given.has_fill_rule != 0) result.fill_rule = c::to_enum<flaunay_fill_rule, FillRule>(given.fill_rule);
  result.map = given.map != 0;
  result.overlaps = c::to_enum<flaunay_overlaps, Overlaps>(given.overlaps);
  return result;
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

Polygons to_polygons(const flaunay_polygons& given) {
  check_array(given.ring_offsets, given.ring_count, "rings");
  Polygons result;
  result.coordinates = given.coordinates;
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
  view.added_count = result.added_points.size() / 2;
  view.constraint_count = result.constraint_edges.size() / 2;
  view.segment_count = result.piece_offsets.size() - 1;
  view.piece_count = result.piece_edges.size() / 2;
#define VIEW(type, name, ...) view.name = elements(result.name);
  FLAUNAY_CONSTRAINED_ARRAYS(VIEW)
#undef VIEW
  return view;
}

flaunay_refinement_report view_of(const RefinementReport& report) {
  flaunay_refinement_report view{};
  view.rounds = report.rounds;
  view.added_points = report.added_points;
  view.split_points = report.split_points;
  view.smallest_angle = report.smallest_angle;
  view.largest_angle = report.largest_angle;
  view.bad_count = report.bad_triangles.size();
  view.bad_triangles = elements(report.bad_triangles);
  view.mean_angle = report.mean_angle;
  view.smallest_angle_before = report.smallest_angle_before;
  view.mean_angle_before = report.mean_angle_before;
  view.excuses = reinterpret_cast<const std::uint8_t*>(elements(report.excuses));
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

Constraints to_constraints(const flaunay_constraints& given, std::size_t sets) {
  Constraints result;
  result.segments = given.segments;
  result.segment_count = given.segment_count;
  result.holes = given.holes;
  result.hole_count = given.hole_count;
  result.hole_offsets = copy_offsets(given.hole_offsets, sets, "sets");
  result.segment_markers = given.segment_markers;
  result.point_markers = given.point_markers;
  result.seeds = given.seeds;
  result.seed_attributes = given.seed_attributes;
  result.seed_count = given.seed_count;
  result.seed_offsets = copy_offsets(given.seed_offsets, sets, "sets");
  return result;
}

ConstrainedOptions to_constrained_options(const flaunay_constraints& given, const flaunay_options* options) {
  auto result = to_common_options<ConstrainedOptions>(given, options);
  result.outside = c::to_enum<flaunay_outside, Outside>(given.outside);
  result.fill_rule = c::to_enum<flaunay_fill_rule, FillRule>(given.fill_rule);
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
    c::check_reserved(given, "flaunay_constraints");
    const std::vector<std::size_t> sets_of_points = c::to_offsets(offsets, sets, n);
    return cpp.constrained(coordinates, sets_of_points,
                           c::to_constraints(given, c::set_count(sets_of_points)),
                           c::to_constrained_options(given, options));
  });
}

flaunay_status flaunay_triangulate_polygons(flaunay_triangulator* triangulator,
                                            const flaunay_polygons* polygons, const flaunay_options* options,
                                            flaunay_triangulation** result) {
  return c::make(triangulator, result, [&](Triangulator& cpp) {
    const flaunay_polygons& given = required(polygons, "the polygons");
    c::check_reserved(given, "flaunay_polygons");
    return cpp.polygons(to_polygons(given), to_polygon_options(given, options));
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
    c::check_reserved(given, "flaunay_constraints");
    const std::size_t n = result.representatives.size() - result.added_points.size() / 2;
    return verify(coordinates, c::copied_offsets(offsets, mesh->set_count, n),
                  c::to_constraints(given, std::max<std::size_t>(mesh->set_count, 1)),
                  c::to_constrained_options(given, nullptr), result);
  });
}

flaunay_status flaunay_mesh_verify_polygons(const flaunay_mesh* mesh,
                                            const flaunay_constrained_arrays* arrays,
                                            const flaunay_refinement_report* report,
                                            const flaunay_polygons* polygons) {
  return c::verified([&] {
    const flaunay_polygons& given = required(polygons, "the polygons");
    c::check_reserved(given, "flaunay_polygons");
    return verify(to_polygons(given), to_polygon_options(given, nullptr), to_result(mesh, arrays, report));
  });
}

FLAUNAY_DEVICE_RESULT(constraints, flaunay_constraint_part, FLAUNAY_CONSTRAINT_ARRAYS, "the constraint edges",
                      "constraint edges")
FLAUNAY_ACCESSOR(size_t, device_constraints, edge_count, handle.cpp.edge_count)

flaunay_status flaunay_triangulate_constrained_device(flaunay_triangulator* triangulator,
                                                      const flaunay_device_points* points, cl_mem segments,
                                                      size_t segment_count, const flaunay_enqueue* enqueue,
                                                      flaunay_device_triangulation* mesh,
                                                      flaunay_device_constraints* edges) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    flaunay_device_triangulation& handle = required(mesh, "the mesh");
    DeviceConstraintEdges& result = required(edges, "the constraint edges").cpp;
    handle.clear();
    cpp.constrained(c::to_points(points), {segments, segment_count}, handle.cpp, result, queued);
    handle.show();
  });
}
