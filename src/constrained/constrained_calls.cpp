// The public calls for triangulations with constraints.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "blocks/small.hpp"
#include "call/groups.hpp"
#include "constrained/carry.hpp"
#include "constrained/crossings/first_crossing.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/split.hpp"
#include "constrained/inside.hpp"
#include "constrained/refinement/given_mesh.hpp"
#include "constrained/small.hpp"
#include "constrained/stages.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/magnitudes.hpp"
#include "host/clock.hpp"
#include "host/memory/system_memory.hpp"
#include "host/opencl/device.hpp"
#include "points/query_range.hpp"
#include "space/triangulate.hpp"
#include "statistics/phases.hpp"

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
Options plain_options(const Options& options) {
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

// The results of the stages before refinement.
struct Staged {
  ConstrainedTriangulation result;
  Ids seeds{};               // per triangle that of its region, or -1; empty if there are none
  bool has_domains = false;  // whether domains were applied
  double domains_begin = 0;
  call::StayingMesh staying{};
};

bool needs_domains(const Constraints& constraints, const call::DomainRequest& request) {
  return request.needs_depths() || constraints.hole_count > 0 || constraints.seed_count > 0;
}

// Tells some errors before segments are inserted.
void check_first(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Constraints& constraints) {
  // So many are inserted in less time than it takes to look for them.
  constexpr std::size_t kFewSegments = 500;
  if (constraints.segment_count <= kFewSegments) return;
  constrained::check_first_segments(coordinates, offsets, constraints.segments, constraints.segment_count);
}

// The engine that finds holes and seeds.
call::Engine& for_places(call::Implementation& self, call::Engine& engine, const Constraints& constraints) {
  return constraints.hole_count > 0 || constraints.seed_count > 0 ? self.with_doubles(engine) : engine;
}

// Makes segments edges of a triangulation on an engine, and applies domains unless request is null.
// triangulates: whether the engine makes the triangulation, too; it has doubles then.
geometry::Fitted<geometry::Done> constrain_on(call::Engine& engine, call::Engine& with_doubles,
                                              bool triangulates, const double* coordinates,
                                              const std::vector<std::size_t>& offsets,
                                              const Constraints& constraints, const Options& options,
                                              const call::DomainRequest* request, Staged& staged) {
  ConstrainedTriangulation& result = staged.result;
  call::Left left;
  auto of_stages = std::make_unique<call::Frame>(engine, options.profile, true);
  call::Frame& call = *of_stages;
  const auto points = call.points(call::HostPoints{coordinates, nullptr, offsets.back()});
  const points::DeviceMesh mesh =
      triangulates ? call::triangulate_stage(call, points, offsets, plain_options(options), result)
                   : call::mesh_to_constrain(call, points, offsets, result);
  const statistics::Phases phases(options);
  const host::Runtime::BeforeCompiling announce(engine.runtime,
                                                [&] { phases.interrupt("compiling kernels"); });
  const double begin = host::now();
  if (triangulates) check_first(coordinates, offsets, constraints);
  auto inserted = call::insert_segments(call, mesh, constraints, options.halfedges, result);
  if (!inserted) return inserted.too_wide();
  staged.staying.mesh = *std::move(inserted);
  staged.has_domains = request != nullptr;
  if (!staged.has_domains) call.end();
  end_phase("constrain", begin, result.statistics);
  if (staged.has_domains) {
    staged.domains_begin = host::now();
    call::apply_domains(call, with_doubles, staged.staying.mesh, coordinates, offsets, constraints, *request,
                        result, left);
    call.end();
    staged.seeds = call::take_left(constraints, left, result);
  }
  result.edge_segments = constrained::first_pieces(staged.staying.mesh.edges, result.piece_edges);
  if (engine.runtime.sizes().in_host_memory == 0) {
    staged.staying.call = std::move(of_stages);
  } else {
    staged.staying = {};
  }
  return geometry::Done();
}

// Triangulates sets with segments, with neighbours. If the engine that has the mesh can do that, applies
// domains, too. request: null if they must not be applied. may_be_small: whether constrain_small has not been
// tried.
Staged constrain(call::Implementation& self, const double* coordinates,
                 const std::vector<std::size_t>& offsets, const Constraints& constraints,
                 const ConstrainedOptions& options, const call::DomainRequest* request, bool may_be_small) {
  Staged staged;
  if (may_be_small && are_small(self, offsets, constraints, options)) {
    ConstrainedOptions wanted = options;
    wanted.neighbors = true;
    if (auto small = constrain_small(self, coordinates, offsets, constraints, wanted, {})) {
      staged.result = *std::move(small);
      return staged;
    }
  }
  if (request != nullptr && !needs_domains(constraints, *request)) request = nullptr;
  const bool stays_here = self.stays_here(offsets.back() + constraints.segment_count, options.profile);
  call::Engine& engine = stays_here ? call::Engine::of_thread() : self.for_host_memory();
  const bool triangulates =
      !stays_here && engine.has_doubles() && offsets.back() > 0 && call::groups_of(engine, offsets).empty();
  if (triangulates) {
    engine.check_size(offsets.back());
  } else {
    static_cast<Triangulation&>(staged.result) =
        call::triangulate(self, {coordinates, nullptr, offsets.back()}, offsets, plain_options(options));
    check_first(coordinates, offsets, constraints);
  }
  const auto on = [&](call::Engine& used) {
    return constrain_on(used, for_places(self, used, constraints), triangulates, coordinates, offsets,
                        constraints, options, request, staged);
  };
  Statistics& statistics = staged.result.statistics;
  if (stays_here) {
    *on(engine);
    return staged;
  }
  call::in_fixed_point_or(
      [&] {
        const auto done = on(engine);
        if (done) call::add_accounts(engine, statistics);
        return done;
      },
      [&](const std::string& reason) {
        call::Engine& other = self.with_doubles(engine);
        if (statistics.host_points == 0)
          call::add_note(engine, other, reason, "segments inserted", statistics);
        const auto done = on(other);
        call::add_accounts(other, statistics);
        return done;
      });
  return staged;
}

// Applies domains to a triangulation in host memory, which has neighbours; see call::apply_domains_on.
Ids apply_domains(call::Implementation& self, const double* coordinates,
                  const std::vector<std::size_t>& offsets, const Constraints& constraints,
                  const call::DomainRequest& request, ConstrainedTriangulation& result) {
  if (!needs_domains(constraints, request)) return {};
  call::Engine& engine = self.for_points(result.triangles.size() / 6);  // about two triangles per point
  return call::apply_domains_on(engine, for_places(self, engine, constraints), coordinates, offsets,
                                constraints, request, result);
}

// Triangulates all points with the pieces as segments, and then numbers the added points after all others.
Staged constrain_split(call::Implementation& self, const double* coordinates,
                       const std::vector<std::size_t>& offsets, const Constraints& constraints,
                       const ConstrainedOptions& options, const call::DomainRequest& request) {
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
  Staged staged;
  const auto end_split = [&](double seconds) {
    Statistics& statistics = staged.result.statistics;
    statistics.seconds += seconds;
    statistics.phases.insert(statistics.phases.begin(), {"split", seconds});
  };
  if (split.is_as_it_was()) {
    const double seconds = host::now() - begin;
    staged = constrain(self, coordinates, offsets, constraints, options, &request, true);
    end_split(seconds);
    return staged;
  }
  const constrained::AllPoints all = constrained::join_added(coordinates, offsets, split);
  for (std::int32_t& v : split.pieces) v = all.place[v];
  const double seconds = host::now() - begin;

  Constraints pieces = constraints;
  pieces.segments = split.pieces.data();
  pieces.segment_count = split.pieces.size() / 2;
  staged = constrain(self, all.coordinates.data(), all.offsets, pieces, options, nullptr, true);
  constrained::carry_split(all, std::move(split), staged.result);
  staged.staying.call.reset();
  end_split(seconds);
  return staged;
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
    Staged staged;
    static_cast<Triangulation&>(staged.result) =
        call::triangulate_small({points, nullptr, n}, group.offsets, plain_options(options));
    *constrain_on(engine, engine, false, points, group.offsets, own, options,
                  request.needs_depths() ? &of_group : nullptr, staged);
    small = std::move(staged.result);
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
  Staged staged = at_once  ? Staged{*std::move(at_once)}
                  : splits ? constrain_split(self, coordinates, offsets, constraints, first, request)
                           : constrain(self, coordinates, offsets, constraints, first, &request, !is_small);
  ConstrainedTriangulation& result = staged.result;
  double begin = staged.has_domains ? staged.domains_begin : host::now();
  std::vector<double> all = with_added(coordinates, offsets.back(), result.added_points);
  const auto points = [&] { return all.empty() ? coordinates : all.data(); };
  Ids& seeds = staged.seeds;
  if (!at_once && !staged.has_domains)
    seeds = apply_domains(self, points(), offsets, constraints, request, result);
  std::vector<double> areas;
  if (mesh != nullptr) {
    areas = mesh->leave(points(), result, seeds);
    staged.staying.call.reset();
  }
  if (is_refined) {
    if (!at_once) end_phase("domains", std::exchange(begin, host::now()), result.statistics);
    call::refine(self, points(), offsets, options, seeds, areas, staged.staying, result);
    if (options.areas) all = with_added(coordinates, offsets.back(), result.added_points);
  }
  constrained::carry_markers(constraints, offsets.back(), result);
  finish(self, points(), options, result);
  end_phase(is_refined ? "refine" : "domains", begin, result.statistics);
  return std::move(result);
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
