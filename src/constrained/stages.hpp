// Constrained triangulations of points in host memory, and their stages: inserting segments, labelling
// domains and leaving some out, refining the rest. Between stages of one Frame, the mesh stays where the
// engine has it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "call/frame.hpp"
#include "constrained/domains/domain.hpp"
#include "constrained/domains/map.hpp"
#include "flaunay/constrained.hpp"
#include "geometry/magnitudes.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::call {

// ---- Segments

/// The triangulation of points in host memory, with neighbours, for insert_segments. coordinates: those of
/// the points.
points::DeviceMesh mesh_to_constrain(Frame& call, const Buffer<cl_double>& coordinates,
                                     const std::vector<std::size_t>& offsets, Triangulation& result);

/// Makes segments edges of a triangulation with neighbours, whose arrays are those of the result after the
/// end of the call. Each segment is one piece, and no points are added. The caller writes edge_segments. If
/// points do not fit fixed point, nothing is changed. Throws what constrained::constrain throws.
geometry::Fitted<constrained::DomainMesh> insert_segments(Frame& call, const points::DeviceMesh& mesh,
                                                          const Constraints& constraints, bool halfedges,
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

/// The triangles that are left, if some are left out.
struct Left {
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::uint8_t> constrained;
  std::vector<std::size_t> triangle_offsets;
  std::vector<std::int32_t> seeds;  ///< per triangle that of its region, or -1; empty if there are no seeds
};

/// Labels the triangles of a mesh, and leaves out of it what the request and the holes say. with_doubles:
/// finds holes and seeds; another engine if the call's computes in fixed point. coordinates: of all points,
/// those that splitting added too; offsets: without those; left: must have been declared before the call.
void apply_domains(Frame& call, Engine& with_doubles, constrained::DomainMesh& mesh,
                   const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const DomainRequest& request,
                   ConstrainedTriangulation& result, Left& left);
/// After the end of the call: takes what is left, and writes the attributes of triangles if there are seeds.
/// Returns the seeds of triangles.
std::vector<std::int32_t> take_left(const Constraints& constraints, Left& left,
                                    ConstrainedTriangulation& result);
/// Applies domains to a triangulation in host memory, which must have neighbours, in a call of its own.
/// Returns the seeds of triangles.
std::vector<std::int32_t> apply_domains_on(Engine& engine, Engine& with_doubles, const double* coordinates,
                                           const std::vector<std::size_t>& offsets,
                                           const Constraints& constraints, const DomainRequest& request,
                                           ConstrainedTriangulation& result);

/// A mesh that earlier stages have left in the memory of a device, where it stays as long as this lives.
struct StayingMesh {
  std::unique_ptr<Frame> call;  ///< null if there is none: other devices use the arrays of the result
  constrained::DomainMesh mesh;
};

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
/// it and its parts may have, 0 for any, or empty; staying: the same mesh, unless there is none. Throws what
/// constrained::refine throws.
void refine(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
            const ConstrainedOptions& options, const std::vector<std::int32_t>& seeds,
            const std::vector<double>& areas, const StayingMesh& staying, ConstrainedTriangulation& result);

// ---- All stages

/// Triangulates sets with segments, labels the triangles, and leaves out what the request and the holes say.
/// Rings must have been checked.
ConstrainedTriangulation constrain_and_leave(Implementation& self, const double* coordinates,
                                             const std::vector<std::size_t>& offsets,
                                             const Constraints& constraints,
                                             const ConstrainedOptions& options, const DomainRequest& request);

}  // namespace flaunay::call
