// The public calls for triangulations with constraints.
#include "call/constrained.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "blocks/small.hpp"
#include "call/groups.hpp"
#include "call/triangulate.hpp"
#include "constrained/carry.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/split.hpp"
#include "constrained/inside.hpp"
#include "constrained/refinement/given_mesh.hpp"
#include "constrained/small.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "host/memory/system_memory.hpp"
#include "host/opencl/device.hpp"
#include "points/query_range.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

void check(const Constraints& constraints, const ConstrainedOptions& options) {
  const Refinement& refinement = options.refinement;
  check_enumerator(options.crossings);
  check_enumerator(options.outside);
  check_enumerator(options.fill_rule);
  check_enumerator(refinement.kept);
  check_array(constraints.segments, constraints.segment_count, "segments", kMostIndexed / 2);
  check_array(constraints.holes, constraints.hole_count, "holes", kMostIndexed / 2);
  check_array(constraints.seeds, constraints.seed_count, "seeds", kMostIndexed / 2);
  call::expect(constraints.seed_count == 0 || constraints.seed_attributes != nullptr ||
                   refinement.seed_areas != nullptr,
               "seeds have neither attributes nor areas: both pointers are null");
  check_array(refinement.mesh.triangles, refinement.mesh.count, "triangles of the mesh", kMostIndexed / 3);
  call::check_refinement(refinement, constraints.seed_count);
}

// The coordinates of n points and of those that splitting added. Empty if there are none of these.
std::vector<double> with_added(const double* coordinates, std::size_t n, const std::vector<double>& added) {
  std::vector<double> all;
  if (added.empty()) return all;
  all.assign(coordinates, coordinates + 2 * n);
  all.insert(all.end(), added.begin(), added.end());
  return all;
}

// Adds a phase that began at this time to the statistics.
void end_phase(const char* name, double begin, Statistics& statistics) {
  const double seconds = host::now() - begin;
  statistics.seconds += seconds;
  statistics.phases.push_back({name, seconds});
}

// The options of the triangulation into which segments are inserted.
Options plain_options(const ConstrainedOptions& options) {
  Options plain = options;
  plain.neighbors = true;
  plain.halfedges = plain.areas = false;
  return plain;
}

// Whether all stages are done on the calling thread.
bool are_small(call::Implementation& self, const std::vector<std::size_t>& offsets,
               const Constraints& constraints, const Options& options) {
  return call::are_small(self, offsets, options.profile) &&
         self.stays_here(offsets.back() + constraints.segment_count, options.profile);
}

// Whether all holes are as near to the points as places may be.
bool are_holes_near(const double* coordinates, const std::vector<std::size_t>& offsets,
                    const Constraints& constraints) {
  const auto both = geometry::joined(geometry::inspect(coordinates, 0, offsets.back()),
                                     geometry::inspect(constraints.holes, 0, constraints.hole_count));
  return both.bad == kernel::NO_BAD && geometry::bits_of(both) <= points::kOrientLimits.most_bits();
}

// Does what the stages do with small sets, on the calling thread. Nothing if it does not pay or errors are to
// be told. leaves_holes: there is one set, whose holes are left out.
std::optional<ConstrainedTriangulation> constrain_small(
    const call::Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
    const Constraints& constraints, const ConstrainedOptions& options, const call::DomainRequest& request,
    bool leaves_holes = false) {
  if (self.host_tuning().segment_steps == 0) return {};
  if (leaves_holes && !are_holes_near(coordinates, offsets, constraints)) return {};
  const statistics::Phases phases(options);
  phases.progress("triangulate", 0);
  double begin = host::now();
  constrained::SmallRequest wanted{request.rules};
  wanted.has_depths = request.needs_depths();
  wanted.labels = request.labels;
  wanted.neighbors = options.neighbors || options.halfedges;
  wanted.most_steps = self.host_tuning().segment_steps;
  if (wanted.has_depths) wanted.curves = request.curves;
  if (leaves_holes) wanted.with_holes = coordinates;
  std::optional<ConstrainedTriangulation> result(std::in_place);
  if (!constrained::triangulate_inside(coordinates, offsets, constraints, wanted, *result)) {
    const auto rings = blocks::small_rings(coordinates, offsets, result.emplace());
    if (!rings) return {};
    end_phase("triangulate", std::exchange(begin, host::now()), result->statistics);
    if (!constrained::constrain_small(*rings, offsets, constraints, wanted, *result)) return {};
  }
  result->statistics.device = host::kHostName;
  end_phase("constrain", begin, result->statistics);
  phases.progress("output", 1);
  return result;
}

// Triangulates sets with segments. All triangles are kept, without labels; there are neighbours.
// may_be_small: whether constrain_small has not been tried.
ConstrainedTriangulation constrain(call::Implementation& self, const double* coordinates,
                                   const std::vector<std::size_t>& offsets, const Constraints& constraints,
                                   const ConstrainedOptions& options, bool may_be_small = true) {
  const Options plain = plain_options(options);
  if (may_be_small && are_small(self, offsets, constraints, options)) {
    ConstrainedOptions wanted = options;
    wanted.neighbors = true;
    if (auto small = constrain_small(self, coordinates, offsets, constraints, wanted, {}))
      return *std::move(small);
  }
  ConstrainedTriangulation result;
  static_cast<Triangulation&>(result) =
      call::triangulate(self, {coordinates, nullptr, offsets.back()}, offsets, plain);

  const double begin = host::now();
  call::insert_segments(self, coordinates, offsets, constraints, options, result);
  end_phase("constrain", begin, result.statistics);
  return result;
}

// Triangulates all points with the pieces as segments, and then numbers the added points after all others.
ConstrainedTriangulation constrain_split(call::Implementation& self, const double* coordinates,
                                         const std::vector<std::size_t>& offsets,
                                         const Constraints& constraints, const ConstrainedOptions& options) {
  // Memory for each piece while segments are split and pieces triangulated; a segment with one place on it
  // has two pieces.
  constexpr std::size_t kBytesPerPiece = 320;
  // To ask how much memory there is takes longer than a small call, for which there is always enough.
  constexpr std::size_t kNeverLacking = std::size_t{64} << 20;
  const double begin = host::now();
  constrained::SplitLimits limits;
  limits.more = [most = limits.pieces] { return std::min(most, host::memory_left().bytes / kBytesPerPiece); };
  limits.pieces = kNeverLacking / kBytesPerPiece;
  constrained::Split split = constrained::split(
      coordinates, offsets, {constraints.segments, constraints.segments + 2 * constraints.segment_count},
      limits);
  ConstrainedTriangulation result;
  const auto end_split = [&](double seconds) {
    result.statistics.seconds += seconds;
    result.statistics.phases.insert(result.statistics.phases.begin(), {"split", seconds});
  };
  if (split.is_as_it_was()) {
    const double seconds = host::now() - begin;
    result = constrain(self, coordinates, offsets, constraints, options);
    end_split(seconds);
    return result;
  }
  const constrained::AllPoints all = constrained::join_added(coordinates, offsets, split);
  for (std::int32_t& v : split.pieces) v = all.place[v];
  const double seconds = host::now() - begin;

  Constraints pieces = constraints;
  pieces.segments = split.pieces.data();
  pieces.segment_count = split.pieces.size() / 2;
  result = constrain(self, all.coordinates.data(), all.offsets, pieces, options);
  constrained::carry_split(all, std::move(split), result);
  end_split(seconds);
  return result;
}

// Makes half-edges and areas, or leaves out neighbours, as the options say, and counts the triangles.
// coordinates: of all points, those that splitting added too.
void finish(call::Implementation& self, const double* coordinates, const Options& options,
            ConstrainedTriangulation& result) {
  // Otherwise all triangles were kept.
  if (result.halfedges.size() != result.triangles.size()) geometry::write_halfedges(options, result);
  if (!options.neighbors) result.neighbors.clear();
  if (options.areas) {
    call::write_areas(self.for_host_memory(), {coordinates, nullptr, result.representatives.size()}, result);
  }
  result.statistics.triangles = result.triangles.size() / 3;
}

// Where the segments of each group begin, and their end. Empty if they are not in the order of the groups.
std::vector<std::size_t> group_segments(const std::vector<call::Group>& groups,
                                        const Constraints& constraints) {
  std::vector<std::size_t> first(1, 0);
  for (std::size_t s = 0; s < constraints.segment_count; ++s) {
    const auto v = static_cast<std::size_t>(constraints.segments[2 * s]);
    while (first.size() < groups.size() && v >= groups[first.size()].first_point) first.push_back(s);
    if (v < groups[first.size() - 1].first_point) return {};
  }
  first.resize(groups.size() + 1, constraints.segment_count);
  return first;
}

// The end of a call on small sets, after all stages.
void end_small(call::Implementation& self, const double* coordinates, const Constraints& constraints,
               std::size_t n, const ConstrainedOptions& options, ConstrainedTriangulation& result) {
  constrained::carry_markers(constraints, n, result);
  finish(self, coordinates, options, result);
}

// All stages of a group of sets on the calling thread, for segments [first, end).
ConstrainedTriangulation constrain_group(call::Implementation& self, const double* coordinates,
                                         const call::Group& group, const Constraints& constraints,
                                         std::size_t first, std::size_t end,
                                         const ConstrainedOptions& options,
                                         const call::DomainRequest& request) {
  const double* const points = coordinates + 2 * group.first_point;
  const std::size_t n = group.offsets.back();
  Ids segments(constraints.segments + 2 * first, constraints.segments + 2 * end);
  for (std::int32_t& v : segments) v -= static_cast<std::int32_t>(group.first_point);
  Constraints own;
  own.segments = segments.data();
  own.segment_count = end - first;
  if (constraints.segment_markers != nullptr) own.segment_markers = constraints.segment_markers + first;
  if (constraints.point_markers != nullptr) own.point_markers = constraints.point_markers + group.first_point;
  constrained::Curves curves;
  call::DomainRequest of_group = request;
  if (request.curves != nullptr) {
    curves = constrained::part_of(*request.curves, first, end);
    of_group.curves = &curves;
  }
  auto small = constrain_small(self, points, group.offsets, own, options, of_group);
  if (!small) {
    call::Engine& engine = call::Engine::of_thread();
    static_cast<Triangulation&>(small.emplace()) =
        call::triangulate_small({points, nullptr, n}, group.offsets, plain_options(options));
    *call::insert_segments_on(engine, points, group.offsets, own, options, *small);
    if (request.needs_depths())
      call::apply_domains_on(engine, engine, points, group.offsets, own, of_group, *small);
  }
  end_small(self, points, own, n, options, *small);
  return *std::move(small);
}

// Whether no segment has several pieces.
bool are_whole(const Ids& piece_offsets) {
  return std::adjacent_find(piece_offsets.begin(), piece_offsets.end(),
                            [](std::int32_t first, std::int32_t next) { return next - first > 1; }) ==
         piece_offsets.end();
}

// Whether groups of sets need to know of no others, but for holes and for points that splitting adds.
bool can_be_grouped(const Constraints& constraints, const ConstrainedOptions& options) {
  return constraints.seed_count == 0 && options.refinement.mesh.count == 0 && !options.profile;
}

// Nothing if there are no groups, or if there is an error.
std::optional<ConstrainedTriangulation> constrain_by_groups(
    call::Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
    const Constraints& constraints, const ConstrainedOptions& options, const call::DomainRequest& request) {
  if (self.stays_here(offsets.back())) return {};
  call::Engine& engine = self.for_host_memory();
  const std::vector<call::Group> groups = call::groups_of(engine, offsets);
  if (groups.empty()) return {};
  engine.check_size(offsets.back());
  const std::vector<std::size_t> first = group_segments(groups, constraints);
  if (first.empty()) return {};
  ConstrainedOptions of_group = options;
  of_group.progress = nullptr;
  return call::by_groups<ConstrainedTriangulation>(engine, groups, options, [&](std::size_t k) {
    return constrain_group(self, coordinates, groups[k], constraints, first[k], first[k + 1], of_group,
                           request);
  });
}

// mesh: the given mesh that has made these constraints and options, or null.
ConstrainedTriangulation constrain_and_refine(call::Implementation& self, const double* coordinates,
                                              const std::vector<std::size_t>& offsets,
                                              const Constraints& constraints,
                                              const ConstrainedOptions& options,
                                              const call::DomainRequest& request,
                                              const constrained::GivenMesh* mesh) {
  const bool is_refined = options.refinement.is_wanted();
  // Half-edges and areas are made after refinement.
  ConstrainedOptions first = options;
  if (is_refined) {
    first.neighbors = true;
    first.halfedges = first.areas = false;
  }
  const bool has_holes = constraints.hole_count > 0, splits = options.crossings == Crossings::split;
  const bool can_be_at_once = can_be_grouped(constraints, first) && (!has_holes || offsets.size() == 2);
  const bool is_small = can_be_at_once && !request.polygons && are_small(self, offsets, constraints, options);
  std::optional<ConstrainedTriangulation> at_once;
  if (has_holes) constrained::holes_of(constraints, offsets.size() - 1);
  if (is_small) {
    at_once = constrain_small(self, coordinates, offsets, constraints, first, request, has_holes);
    // Splitting makes segments of pieces, also where these are edges already.
    if (splits && at_once && !are_whole(at_once->piece_offsets)) at_once.reset();
    if (at_once) end_small(self, coordinates, constraints, offsets.back(), first, *at_once);
  } else if (can_be_at_once && !has_holes && !splits) {
    at_once = constrain_by_groups(self, coordinates, offsets, constraints, first, request);
  }
  if (at_once && !is_refined) return *std::move(at_once);
  ConstrainedTriangulation result =
      at_once  ? *std::move(at_once)
      : splits ? constrain_split(self, coordinates, offsets, constraints, first)
               : constrain(self, coordinates, offsets, constraints, first, !is_small);
  double begin = host::now();
  std::vector<double> all = with_added(coordinates, offsets.back(), result.added_points);
  const auto points = [&] { return all.empty() ? coordinates : all.data(); };
  Ids seeds;
  if (!at_once) seeds = call::apply_domains(self, points(), offsets, constraints, request, result);
  std::vector<double> areas;
  if (mesh != nullptr) areas = mesh->leave(points(), result, seeds);
  if (is_refined) {
    if (!at_once) end_phase("domains", std::exchange(begin, host::now()), result.statistics);
    call::refine(self, points(), offsets, options, seeds, areas, result);
    if (options.areas) all = with_added(coordinates, offsets.back(), result.added_points);
  }
  constrained::carry_markers(constraints, offsets.back(), result);
  finish(self, points(), options, result);
  end_phase(is_refined ? "refine" : "domains", begin, result.statistics);
  return result;
}

}  // namespace

ConstrainedTriangulation call::constrain_and_leave(Implementation& self, const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options,
                                                   const DomainRequest& request) {
  check_offsets(offsets);
  check_points(coordinates, offsets.back());
  check(constraints, options);
  std::optional<constrained::GivenMesh> mesh;
  if (options.refinement.mesh.count > 0) mesh.emplace(coordinates, offsets.back(), constraints, options);
  ConstrainedTriangulation result =
      constrain_and_refine(self, coordinates, offsets, mesh ? mesh->constraints() : constraints,
                           mesh ? mesh->options() : options, request, mesh ? &*mesh : nullptr);
  const Refinement& wanted = options.refinement;
  if (wanted.measured && !wanted.is_wanted()) measure_angles(self, coordinates, offsets.back(), result);
  return result;
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options) {
  return call::take_turn(*implementation_, [&] {
    const Rings& rings = constraints.rings;
    const bool has_rings = !rings.segment_offsets.empty();
    check(constraints, options);
    if (has_rings) constrained::check_rings(rings, constraints.segment_count, options.fill_rule);
    const constrained::Curves curves = has_rings ? constrained::curves_of(rings) : constrained::Curves();
    call::DomainRequest request = call::request_of(options, false);
    if (has_rings) request.curves = &curves;
    return call::constrain_and_leave(*implementation_, coordinates, offsets, constraints, options, request);
  });
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Constraints& constraints) {
  return constrained(coordinates, offsets, constraints, {});
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates, std::size_t n,
                                                   const Constraints& constraints,
                                                   const ConstrainedOptions& options) {
  return constrained(coordinates, std::vector<std::size_t>{0, n}, constraints, options);
}

ConstrainedTriangulation Triangulator::constrained(const double* coordinates, std::size_t n,
                                                   const Constraints& constraints) {
  return constrained(coordinates, n, constraints, {});
}

}  // namespace flaunay
