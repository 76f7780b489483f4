// The C interface to triangulations with constraints.
#include "flaunay/constrained.hpp"

#include <fmt/format.h>

#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::elements;
using c::read;
using c::required;

namespace {

flaunay_constrained_arrays view_of(const ConstrainedTriangulation& result) {
  flaunay_constrained_arrays view{};
  view.added_count = result.added_points.size() / 2;
  view.constraint_count = result.constraint_edges.size() / 2;
  view.segment_count = result.piece_offsets.size() - 1;
  view.piece_count = result.piece_edges.size() / 2;
  view.added_points = elements(result.added_points);
  view.added_offsets = elements(result.added_offsets);
  view.constraint_edges = elements(result.constraint_edges);
  view.edge_segments = elements(result.edge_segments);
  view.piece_offsets = elements(result.piece_offsets);
  view.piece_edges = elements(result.piece_edges);
  view.constrained = elements(result.constrained);
  view.depths = elements(result.depths);
  view.regions = elements(result.regions);
  return view;
}

// The enumerator of a number, of which there are `count` from 0.
template <typename Enum>
Enum to_enum(int value, int count, const char* name) {
  if (value >= 0 && value < count) return static_cast<Enum>(value);
  throw Error(ErrorKind::usage, fmt::format("{} is no {}", value, name));
}

static_assert(FLAUNAY_CROSSINGS_SPLIT == static_cast<int>(Crossings::split));
static_assert(FLAUNAY_OUTSIDE_HULL == static_cast<int>(Outside::hull) &&
              FLAUNAY_OUTSIDE_HOLES == static_cast<int>(Outside::holes));
static_assert(FLAUNAY_FILL_RULE_EVEN_ODD == static_cast<int>(FillRule::even_odd) &&
              FLAUNAY_FILL_RULE_WINDING == static_cast<int>(FillRule::winding));

Constraints to_constraints(const flaunay_constraints& given, std::size_t sets) {
  Constraints result;
  result.segments = given.segments;
  result.segment_count = given.segment_count;
  result.holes = given.holes;
  result.hole_count = given.hole_count;
  if (given.hole_offsets != nullptr) {
    result.hole_offsets.assign(given.hole_offsets, given.hole_offsets + sets + 1);
  }
  return result;
}

ConstrainedOptions to_constrained_options(const flaunay_constraints& given, const flaunay_options* options) {
  const research::Options plain = c::to_options(options);
  if (plain.mode != research::Mode::blocks) {
    throw Error(ErrorKind::usage, fmt::format("mode {} has no constraints; mode {} has",
                                              to_string(plain.mode), to_string(research::Mode::blocks)));
  }
  ConstrainedOptions result;
  static_cast<Options&>(result) = plain;
  result.crossings = to_enum<Crossings>(given.crossings, 2, "flaunay_crossings");
  result.outside = to_enum<Outside>(given.outside, 3, "flaunay_outside");
  result.fill_rule = to_enum<FillRule>(given.fill_rule, 3, "flaunay_fill_rule");
  result.labels = given.labels != 0;
  return result;
}

}  // namespace

struct flaunay_constrained {
  explicit flaunay_constrained(ConstrainedTriangulation computed) : cpp(std::move(computed)) {
    statistics.show(cpp.statistics);
    mesh = c::view_of(cpp, statistics);
    arrays = view_of(cpp);
  }
  // The views refer to the other members.
  flaunay_constrained(const flaunay_constrained&) = delete;
  flaunay_constrained& operator=(const flaunay_constrained&) = delete;

  ConstrainedTriangulation cpp;
  c::StatisticsView statistics;
  flaunay_mesh mesh;
  flaunay_constrained_arrays arrays;
};

flaunay_status flaunay_triangulate_constrained(flaunay_triangulator* triangulator, const double* coordinates,
                                               size_t n, const size_t* offsets, size_t sets,
                                               const flaunay_constraints* constraints,
                                               const flaunay_options* options, flaunay_constrained** result) {
  return create(result, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const flaunay_constraints given = constraints != nullptr ? *constraints : flaunay_constraints{};
    c::check_reserved(given, "flaunay_constraints");
    const std::vector<std::size_t> sets_of_points = c::to_offsets(offsets, sets, n);
    return std::make_unique<flaunay_constrained>(
        cpp.constrained(coordinates, sets_of_points, to_constraints(given, c::set_count(sets_of_points)),
                        to_constrained_options(given, options)));
  });
}

void flaunay_constrained_destroy(flaunay_constrained* result) { delete result; }

const flaunay_mesh* flaunay_constrained_mesh(const flaunay_constrained* result) {
  return read(result, [](const auto& handle) { return &handle.mesh; });
}

const flaunay_constrained_arrays* flaunay_constrained_get_arrays(const flaunay_constrained* result) {
  return read(result, [](const auto& handle) { return &handle.arrays; });
}
