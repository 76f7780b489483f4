// Constrained triangulations of points in host memory, and their stages: inserting segments, labelling
// domains and leaving some out, refining the rest. Each stage runs on the calling thread or on an engine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "call/implementation.hpp"
#include "constrained/domains/domain.hpp"
#include "constrained/domains/map.hpp"
#include "flaunay/constrained.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay::call {

// ---- Segments

/// Makes the segments edges of the result, which is what call::triangulate returned, with neighbours. Each
/// segment is one piece, and no points are added. Small sets stay on the calling thread if no device was
/// named. Throws what constrained::constrain throws.
void insert_segments(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                     const Constraints& constraints, const Options& options,
                     ConstrainedTriangulation& result);

/// Makes them edges on this engine. If points do not fit fixed point, nothing is changed.
geometry::Fitted<geometry::Done> insert_segments_on(Engine& engine, const double* coordinates,
                                                    const std::vector<std::size_t>& offsets,
                                                    const Constraints& constraints, const Options& options,
                                                    ConstrainedTriangulation& result);

// ---- Domains

/// The rules by which a call labels domains, and leaves some out.
struct DomainRequest {
  constrained::DepthRules rules{};
  bool labels = false;  ///< whether to compute ConstrainedTriangulation::depths and regions
  /// The curves that bound polygons, if depths are numbers of those; rules.fill is that of each curve.
  const constrained::Curves* curves = nullptr;
  bool polygons = false;  ///< whether to compute ConstrainedTriangulation::polygons
  Overlaps overlaps = Overlaps::first;

  bool needs_depths() const { return labels || polygons || rules.outside != Outside::keep; }
};

/// The rules of the options. are_closed: whether segments are known to be closed curves.
DomainRequest request_of(const ConstrainedOptions& options, bool are_closed);

/// Labels a triangulation, which must have neighbours, leaves out what the request and the holes say, and
/// writes the attributes of triangles if there are seeds: on the engine for host memory or, if it is small
/// and no device was named, on the calling thread. coordinates: of all points, those that splitting added
/// too; offsets: without those. Returns for each triangle that is left the seed of its region, or -1; nothing
/// if there are no seeds.
std::vector<std::int32_t> apply_domains(Implementation& self, const double* coordinates,
                                        const std::vector<std::size_t>& offsets,
                                        const Constraints& constraints, const DomainRequest& request,
                                        ConstrainedTriangulation& result);
/// Applies the domains on an engine. with_doubles: finds holes and seeds; another engine if the first one
/// computes in fixed point.
std::vector<std::int32_t> apply_domains_on(Engine& engine, Engine& with_doubles, const double* coordinates,
                                           const std::vector<std::size_t>& offsets,
                                           const Constraints& constraints, const DomainRequest& request,
                                           ConstrainedTriangulation& result);

// ---- Refinement

/// Throws Error(usage), which names the member, for a refinement that makes no sense.
void check_refinement(const Refinement& wanted, std::size_t seeds);

/// Reports the angles of a result that was not refined. coordinates: of the n points of the caller.
void measure_angles(Implementation& self, const double* coordinates, std::size_t n,
                    ConstrainedTriangulation& result);

/// Refines the result, which must have neighbours: on the engine for host memory or, if little is expected
/// and no device was named, on the calling thread. Several sets are refined one by one, so that each is as if
/// it were alone; small ones on threads of the host. All arrays but half-edges, areas and markers are
/// extended. coordinates: of all points, those that splitting added too; offsets: without those; seeds: for
/// each triangle that of its region, or -1; empty if there are none; areas: for each triangle the area that
/// it and its parts may have, 0 for any, or empty. Throws what constrained::refine throws.
void refine(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
            const ConstrainedOptions& options, const std::vector<std::int32_t>& seeds,
            const std::vector<double>& areas, ConstrainedTriangulation& result);

// ---- All stages

/// Triangulates sets with segments, labels the triangles, and leaves out what the request and the holes say.
/// Rings must have been checked.
ConstrainedTriangulation constrain_and_leave(Implementation& self, const double* coordinates,
                                             const std::vector<std::size_t>& offsets,
                                             const Constraints& constraints,
                                             const ConstrainedOptions& options, const DomainRequest& request);

}  // namespace flaunay::call
