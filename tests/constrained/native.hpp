// Insertion of segments as the library has it, natively or with the tuning of a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "constrained/crossings/lines.hpp"
#include "constrained/stages.hpp"
#include "host/opencl/device.hpp"
#include "tests/support/runtimes.hpp"

namespace flaunay::testing {

/// Engines, as make_tuned_runtime makes runtimes.
inline std::unique_ptr<call::Engine> make_tuned_engine(const std::string& tuning) {
  const std::string names = tuning == "own" ? tuning_in_environment() : tuning;
  if (tests_native()) return std::make_unique<call::Engine>(names);
  return std::make_unique<call::Engine>(boost::compute::context(), host::find_device(""), names);
}

/// Makes segments edges of the mesh, which is a Delaunay triangulation.
inline geometry::Fitted<geometry::Done> insert_on(call::Engine& engine, const std::vector<double>& points,
                                                  const std::vector<std::size_t>& offsets,
                                                  const std::vector<std::int32_t>& segments,
                                                  bool with_halfedges, ConstrainedTriangulation& mesh,
                                                  bool profile = false) {
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  call::Frame call(engine, profile, true);
  const auto coordinates = call.points(call::HostPoints{points.data(), nullptr, offsets.back()});
  const auto made = call::insert_segments(call, call::mesh_to_constrain(call, coordinates, offsets, mesh),
                                          constraints, with_halfedges, mesh);
  if (!made) return made.too_wide();
  call.end();
  mesh.edge_segments = constrained::first_pieces(made->edges, mesh.piece_edges);
  return geometry::Done();
}

inline ConstrainedTriangulation insert(const std::vector<double>& points,
                                       const std::vector<std::size_t>& offsets, Triangulation delaunay,
                                       const std::vector<std::int32_t>& segments) {
  static call::Engine engine(tuning_in_environment());
  ConstrainedTriangulation mesh;
  static_cast<Triangulation&>(mesh) = std::move(delaunay);
  *insert_on(engine, points, offsets, segments, false, mesh);
  return mesh;
}

}  // namespace flaunay::testing
