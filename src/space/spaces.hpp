// Triangulations and proofs in other spaces than the plane, and of points with weights.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "call/frame.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::call {

/// The arrays of triangulations in device memory in another space than the plane.
constexpr Parts kPartsInSpace{true, true, false, false, true, false};

/// Counts the points and triangles of a result, and not those in the plane.
template <typename Result>
void write_counts(std::size_t duplicates, Result& result) {
  Statistics& statistics = result.statistics;
  statistics.points = result.point_offsets.back();
  statistics.duplicates = duplicates;
  statistics.triangles = result.triangle_offsets.back();
  statistics.hull_vertices = 0;
}

/// The functions of public calls in a kind of space. It is the triangulator's turn; offsets have been
/// checked.
struct SpaceCalls {
  const char* refusal_of_weights;  ///< what a call with weights says; null: points can have weights
  Triangulation (*triangulate)(Implementation& self, const HostPoints& points,
                               const std::vector<std::size_t>& offsets, const Space& space,
                               const Options& options);
  void (*triangulate_on_device)(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                                const Parts& parts, const Enqueue& enqueue);
  /// See verify.
  std::string (*find_problem)(const double* points, const std::vector<std::size_t>& offsets,
                              const Space& space, const Triangulation& mesh);
};
extern const SpaceCalls kOnTorus, kOnSphere, kWithWeights;  // the last one: in the plane

/// Throws Error(usage) for arrays that are not those of a triangulation of these points with weights.
void check_with_hidden(const double* points, const std::vector<std::size_t>& offsets,
                       const Triangulation& mesh);

}  // namespace flaunay::call
