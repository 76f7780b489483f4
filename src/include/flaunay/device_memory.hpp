// Types for points and results in device memory, which Triangulator and Locator use without a copy to the
// host. All OpenCL handles in these structs must be alive when a call is made with them; the behaviour with a
// released handle is undefined.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// The type of coordinates in device memory.
enum class Precision {
  float64,  ///< double, 16 bytes per point
  float32,  ///< float, 8 bytes per point; every value is converted to double, which is exact
};

/// Points in device memory, in one or more sets.
struct DevicePoints {
  cl_mem memory = nullptr;                   ///< x0 y0 x1 y1 ..., an array of double2 or float2
  std::size_t count = 0;                     ///< number of points
  Precision precision = Precision::float64;  ///< type of the coordinates
  std::size_t first = 0;                     ///< number of points in the buffer before the first one to use
  /// Set s has points [offsets[s], offsets[s + 1]), counted from `first`. There are sets + 1 offsets, from 0
  /// to count. Empty: there is one set, unless device_offsets is given.
  std::vector<std::size_t> offsets;
  /// The sets + 1 offsets in device memory, int32. They are copied to the host, 4 bytes per set.
  cl_mem device_offsets = nullptr;
  std::size_t sets = 0;  ///< number of sets in device_offsets
  /// The space that the points lie in. On the sphere, the buffer has per point the numbers of the
  /// coordinates: x y z, or longitude and latitude.
  Space space = Space::plane();
  /// In the plane, on a torus and on a cylinder: the weights of the points to use, double, 8 bytes each.
  /// Null: they have none. Space::weights must be null.
  cl_mem weights = nullptr;
};

/// How a call on device memory is enqueued. The queue and the events must be alive when the call is made; the
/// behaviour with a released one is undefined.
struct Enqueue {
  /// A queue of the triangulator's context and device, in order or not. Null: the triangulator's own queue.
  /// The triangulator retains it until a call uses another queue, so its owner may release it after the call.
  cl_command_queue queue = nullptr;
  std::vector<cl_event> wait_for;  ///< events that must complete before the work begins
  /// If not null, receives an event that completes when the results are written. The caller releases the
  /// event.
  cl_event* event = nullptr;
  /// Measure the time of every kernel with events (Statistics::kernels), and wait until all work is done. A
  /// queue given above must have CL_QUEUE_PROFILING_ENABLE.
  bool profile = false;
};

/// A buffer for results in device memory. It is the caller's, or one that flaunay makes when it is first
/// needed, keeps for the next call, and replaces by a larger one if it is too small. Copies of this handle
/// refer to the same buffer.
class FLAUNAY_API DeviceBuffer {
 public:
  DeviceBuffer() noexcept = default;
  /// Uses the caller's buffer, which is retained and never replaced. Throws Error(usage) if memory is not a
  /// buffer.
  explicit DeviceBuffer(cl_mem memory);
  /// The OpenCL buffer, or null if there is none yet. It is valid as long as this handle or a copy of it; to
  /// keep it longer, call clRetainMemObject.
  cl_mem memory() const noexcept { return memory_.get(); }
  /// The size of the buffer, which may be larger than the results in it.
  std::size_t bytes() const noexcept { return bytes_; }
  /// Whether the buffer is the caller's.
  bool is_callers() const noexcept { return is_callers_; }

 private:
  friend struct DeviceBufferAccess;
  std::shared_ptr<struct _cl_mem> memory_;
  std::size_t bytes_ = 0;
  bool is_callers_ = false;
};

/// Which arrays of a triangulation to compute on the device. Neighbours, halfedges and areas need the
/// triangles.
struct Parts {
  bool triangles = true;         ///< Triangulation::triangles
  bool neighbors = false;        ///< Triangulation::neighbors
  bool halfedges = false;        ///< Triangulation::halfedges
  bool hull = false;             ///< Triangulation::hull
  bool representatives = false;  ///< Triangulation::representatives
  bool areas = false;            ///< Triangulation::areas
};

/// A Triangulation in device memory. Areas are double, other arrays int32 if nothing else is said. For n
/// points the caller's buffers must have, and flaunay's have, 24 n bytes for triangles, neighbors and
/// halfedges each, 4 n bytes for hull and representatives each, and 16 n bytes for areas.
struct DeviceTriangulation {
  DeviceBuffer triangles;        ///< 3 per triangle
  DeviceBuffer neighbors;        ///< 3 per triangle
  DeviceBuffer halfedges;        ///< 3 per triangle
  DeviceBuffer hull;             ///< 1 per hull vertex
  DeviceBuffer representatives;  ///< 1 per point
  DeviceBuffer areas;            ///< 1 per triangle
  DeviceBuffer places;           ///< except in the plane, double2, 16 n bytes
  DeviceBuffer corner_offsets;   ///< on a torus and a cylinder, char, 12 n bytes
  DeviceBuffer hidden;           ///< of points with weights, 4 n bytes; 1 per hidden point
  /// With constraints, ConstrainedTriangulation::constrained, uchar, 6 n bytes.
  DeviceBuffer constrained;
  DeviceBuffer piece_edges;  ///< ConstrainedTriangulation::piece_edges, 8 bytes per segment
  /// ConstrainedTriangulation::constraint_edges, 8 bytes per edge: one per segment at least, and as many more
  /// as there are points on segments.
  DeviceBuffer constraint_edges;
  DeviceBuffer coordinates;  ///< of a DynamicTriangulation, its coordinates, double2, 16 n bytes
  /// The arrays up to areas that the last call computed: on a torus, a cylinder and the sphere triangles,
  /// neighbors and representatives, whatever was asked for. The others are there where a call has them.
  Parts parts{false, false, false, false, false, false};
  Space space = Space::plane();  ///< Triangulation::space
  std::size_t images = 0;        ///< Triangulation::images
  bool is_weighted = false;      ///< Triangulation::is_weighted
  std::size_t hidden_count = 0;  ///< the number of hidden points, known when the call returns
  /// On the sphere, the triangulation of the places in the plane, kept for the memory that the next call
  /// needs for it.
  std::shared_ptr<DeviceTriangulation> planar;
  bool is_constrained = false;       ///< whether segments were made edges of it
  std::size_t constraint_count = 0;  ///< the number of constraint edges, known when the call returns
  std::size_t points = 0;            ///< number of points over all sets
  /// sets + 1 values in host memory, known when the call returns: set s has points [point_offsets[s],
  /// point_offsets[s + 1]).
  std::vector<std::size_t> point_offsets;
  /// sets + 1 values in host memory, known when the call returns, whatever the parts: set s has triangles
  /// [triangle_offsets[s], triangle_offsets[s + 1]).
  std::vector<std::size_t> triangle_offsets;
  /// sets + 1 values in host memory, known when the call returns, whatever the parts: set s has hull vertices
  /// [hull_offsets[s], hull_offsets[s + 1]).
  std::vector<std::size_t> hull_offsets;
  /// The work of the call and its time; Statistics::seconds lasts until everything was enqueued.
  Statistics statistics;
};

/// Segments in device memory that are to be edges.
struct DeviceSegments {
  /// An array of int32: 2 indices of points of the same set per segment, counted from the first point to use.
  cl_mem memory = nullptr;
  std::size_t count = 0;  ///< number of segments
};

/// The Voronoi diagram of n points in device memory.
struct DeviceVoronoi {
  DeviceBuffer circumcentres;  ///< Voronoi::circumcentres, double2, 16 bytes per triangle
  DeviceBuffer cell_offsets;   ///< Voronoi::cell_offsets, int32, 4 (n + 1) bytes
  DeviceBuffer cells;          ///< Voronoi::cells, int32, 12 bytes per triangle
  DeviceBuffer unbounded;      ///< Voronoi::unbounded, uchar, n bytes
};

/// The clipped Voronoi cells of n points in device memory. For n points and v vertices, the caller's buffers
/// must have the sizes given here. v is known when the call returns: about 6 per point, as a rule.
struct DeviceClippedVoronoi {
  DeviceBuffer vertices;         ///< ClippedVoronoi::vertices, double2, 16 v bytes
  DeviceBuffer offsets;          ///< ClippedVoronoi::offsets, int32, 4 (n + 1) bytes
  DeviceBuffer areas;            ///< ClippedVoronoi::areas, double, 8 n bytes
  DeviceBuffer centroids;        ///< ClippedVoronoi::centroids, double2, 16 n bytes
  std::size_t vertex_count = 0;  ///< v
};

}  // namespace flaunay
