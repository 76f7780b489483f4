// Exact Delaunay triangulations, meshes and maps, on any CPU at once and on any OpenCL GPU.
//
// Programs contain the layout of the structs and classes here, so no version changes one without a new name
// of the shared library: libflaunay.so.0.1 is that of all 0.1.x. With another name, programs must be compiled
// again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "flaunay/export.h"
#include "flaunay/opencl.h"
#include "flaunay/version.h"

/// The library's interface for C++. Functions that fail throw Error.
namespace flaunay {

namespace research {
struct Options;  // see flaunay/research.hpp
}

/// The kinds of errors, one per exit code of the command.
enum class ErrorKind {
  usage,     ///< the request makes no sense (exit code 2)
  input,     ///< bad points: not finite, out of range, too many, unreadable (exit code 3)
  device,    ///< no device, device too small, or an OpenCL call failed (exit code 4)
  internal,  ///< a broken invariant of flaunay itself: please report it (CONTRIBUTING.md)
};

/// The one exception type of the library.
class FLAUNAY_API Error : public std::runtime_error {
 public:
  /// code and call: the error code and the name of the OpenCL call that failed, if one did.
  explicit Error(ErrorKind kind, const std::string& message, int code = 0, const std::string& call = {})
      : std::runtime_error(message), kind_(kind), code_(code), call_(std::make_shared<std::string>(call)) {}
  /// There is no move constructor, so that call() always has a string to return.
  Error(const Error&) = default;
  /// Errors are assigned by copying, too.
  Error& operator=(const Error&) = default;
  /// The kind of error, for programs. what() is the message for people.
  ErrorKind kind() const noexcept { return kind_; }
  /// The code that the OpenCL call returned, such as -5 for CL_OUT_OF_RESOURCES; 0 if none failed.
  int code() const noexcept { return code_; }
  /// The name of the OpenCL call that failed, such as "clCreateBuffer"; empty if none did.
  const std::string& call() const noexcept { return *call_; }

 private:
  ErrorKind kind_;
  int code_;
  // Shared, because copying an exception must not throw.
  std::shared_ptr<const std::string> call_;
};

/// The options of one triangulation.
struct Options {
  bool neighbors = true;   ///< compute Triangulation::neighbors
  bool halfedges = false;  ///< compute Triangulation::halfedges
  bool areas = false;      ///< compute Triangulation::areas
  bool profile = false;    ///< measure the time of every kernel with OpenCL events; this costs a little time
  /// If not empty, called from time to time on the calling thread. stage: the name of the stage that begins,
  /// which is "compiling kernels" whenever a device needs some that are not in the cache; level: the level of
  /// the recursion, or -1 if there is none; done: the finished share of the work, 0 to 1.
  std::function<void(const std::string& stage, int level, double done)> progress;
};

/// The launches of one kernel and their time (Options::profile).
struct KernelStatistics {
  std::string name;          ///< the kernel's name in its file in kernels/
  std::size_t launches = 0;  ///< number of launches
  double seconds = 0;        ///< time on the device, sum over all launches
};

/// A phase of a call and its wall time.
struct PhaseStatistics {
  std::string name;    ///< "blocks", "triangulate", "output" and others; they depend on the mode
  double seconds = 0;  ///< wall time on the host, including the time that it waits for the device
};

/// The work of a call and its time.
struct Statistics {
  std::string device;             ///< name of the device; "host" if none was used
  std::size_t points = 0;         ///< input points
  std::size_t duplicates = 0;     ///< input points that are not their own representative
  std::size_t triangles = 0;      ///< number of triangles over all sets
  std::size_t hull_vertices = 0;  ///< number of hull vertices over all sets
  double seconds = 0;        ///< from points to results; for device memory, until everything was enqueued
  double build_seconds = 0;  ///< compiling kernels; part of no other time
  std::size_t kernel_launches = 0;     ///< kernels enqueued on the device
  std::size_t host_waits = 0;          ///< times the host waited for the device
  std::size_t bytes_to_device = 0;     ///< copied to the device; memory that is used in place does not count
  std::size_t bytes_to_host = 0;       ///< copied to the host; memory that is used in place does not count
  std::size_t device_allocations = 0;  ///< OpenCL buffers created, without sub-buffers
  std::size_t device_bytes_peak = 0;   ///< most device memory held at the same time
  std::size_t undecided = 0;           ///< predicates that needed exact evaluation
  /// On devices with many lanes, mode blocks triangulates in rounds: each emits what is final and hands on
  /// the other points. The number of rounds; 0 if blocks were merged up the trees of cuts instead.
  std::size_t rounds = 0;
  std::size_t round_points = 0;  ///< points of all rounds together; the first has all points
  /// Points of a last round whose blocks were merged up the trees, because too many were left.
  std::size_t merged_points = 0;
  std::vector<PhaseStatistics> phases;    ///< in the order in which they ran
  std::vector<KernelStatistics> kernels;  ///< the slowest first; empty without Options::profile
  /// Points of a call of which a device without double precision has left something to the host.
  std::size_t host_points = 0;
  /// For people: what a device without double precision has left to the host, and why; and once per process,
  /// why the folder of compiled kernels is not used. Empty otherwise. The result is the same.
  std::string note;
};

/// Where the plane begins again: a place x farther along x, and a place y farther along y and `shear` along
/// x.
struct Period {
  /// From 2^-900 to 2^900 (about 1.2e-271 to 8.4e270), and at most 2^30 times the other. If one is infinite,
  /// the plane does not repeat itself in that direction: it is a cylinder.
  double x = 1;
  double y = 1;  ///< see x
  /// Any finite number, which is reduced by multiples of x. On a cylinder it must be 0. If it is not a
  /// multiple of x, then x may be at most 64 times y.
  double shear = 0;
};

/// How points of the unit sphere are given.
enum class SphereCoordinates {
  directions,  ///< x y z: any finite vector but 0; its length does not count
  degrees,     ///< longitude to the east, any number, and latitude, -90 to 90
};

/// The kinds of spaces that points lie in.
enum class SpaceKind {
  plane,   ///< the Euclidean plane
  torus,   ///< a plane that repeats itself in x and y, or a cylinder, which repeats itself in one of them
  sphere,  ///< the unit sphere
};

/// The space that points lie in, and their weights: Space::plane(), Space::torus({2, 3}), and others.
struct Space {
  /// The plane.
  static Space plane() noexcept { return Space(SpaceKind::plane); }
  /// A torus; a cylinder, if one of the periods is infinite.
  static Space torus(const Period& period) noexcept {
    Space space(SpaceKind::torus);
    space.period = period;
    return space;
  }
  /// The unit sphere.
  static Space sphere(SphereCoordinates coordinates) noexcept {
    Space space(SpaceKind::sphere);
    space.coordinates = coordinates;
    return space;
  }
  /// This space, for points with weights, one per point: squared lengths of any sign; of circles, the squared
  /// radii. The array belongs to the caller.
  Space with_weights(const double* given) const noexcept {
    Space space = *this;
    space.weights = given;
    return space;
  }

  SpaceKind kind;                                                 ///< the kind of space
  Period period;                                                  ///< of a torus
  SphereCoordinates coordinates = SphereCoordinates::directions;  ///< on a sphere, how points are given
  const double* weights = nullptr;                                ///< null: points have no weights

 private:
  explicit Space(SpaceKind given) noexcept : kind(given) {}
};

/// The triangulations of one or more point sets. Points and triangles are numbered over all sets.
struct Triangulation {
  /// The space of the points, without their weights. The period is as given, but for the last bit of a
  /// double, which is 0 unless the period is a power of two. The shear is more than -x / 2 and at most x / 2,
  /// a multiple of what x of places is. With a shear, y is a multiple of 2^-52 times the first power of two
  /// that is at least y + x / 2.
  Space space = Space::plane();
  /// x and y per point on a torus, a cylinder and the sphere; empty in the plane. A point's place is rounded
  /// once, and is then what the point is. On a torus it is the point in [0, period), a multiple of the
  /// period's last bit but one, or of the last bit if the period is a power of two; with a shear, y as that
  /// of the period. So every image of a point is exact. What has no period is not rounded. On the sphere it
  /// is where the line from the south pole through the point meets the plane of the equator; infinite for the
  /// south pole. Every pair of numbers is a point that lies on the sphere exactly.
  std::vector<double> places;
  /// 3 per triangle, counter-clockwise, on the sphere as seen from outside, smallest index first. n different
  /// points on a torus have 2 n, on a cylinder 2 n - h, if h of them are on its lowest and its highest
  /// circle, and on the sphere 2 n - 4 for n > 2. Points on one circle of the sphere have the two sides of a
  /// polygon.
  std::vector<std::int32_t> triangles;
  /// 3 per triangle: the triangle opposite to each vertex, -1 beyond the hull or the end of a cylinder. Empty
  /// unless Options::neighbors.
  std::vector<std::int32_t> neighbors;
  /// 3 per triangle. Halfedge 3t + k goes from vertex k of triangle t to its next vertex. Entry 3t + k is the
  /// opposite halfedge, in the adjacent triangle, or -1 on the hull. This is the convention of delaunator.
  /// Empty unless Options::halfedges.
  std::vector<std::int32_t> halfedges;
  /// 6 per triangle on a torus and a cylinder: i and j per corner. If the first corner is in its place, the
  /// corner is i (x, 0) + j (shear, y) away from its place. The first corner has 0, 0; the others -1, 0 or 1.
  /// With a shear they are from -2 to 2 if x is at most y, and otherwise |j| < 2 + x / y and |i| < 2 + |j| /
  /// 2. They tell apart corners that are the same point, as few points have them.
  std::vector<std::int8_t> corner_offsets;
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order. Empty except in the plane.
  std::vector<std::int32_t> hull;
  /// One per input point: the smallest index of a point of its set with the same coordinates, or the same
  /// place, and the same weight.
  std::vector<std::int32_t> representatives;
  /// Of points with weights those without a power cell, in ascending order: they lie on or above what other
  /// points of their set span, and are in no triangle. Points that another point represents are not among
  /// them.
  std::vector<std::int32_t> hidden;
  /// Whether the points have weights, so that triangles are regular, which need not be Delaunay.
  bool is_weighted = false;
  /// One per triangle: its area, rounded to the nearest double, ties to even, whatever the coordinates: 0 up
  /// to 2^-1075, infinite from about 2^1024. Otherwise it is positive, since triangles are counter-clockwise.
  /// Empty unless Options::areas.
  std::vector<double> areas;
  /// sets + 1 values: set s has triangles [triangle_offsets[s], triangle_offsets[s + 1]).
  std::vector<std::size_t> triangle_offsets;
  /// sets + 1 values: set s has hull vertices [hull_offsets[s], hull_offsets[s + 1]). Empty except in the
  /// plane.
  std::vector<std::size_t> hull_offsets;
  /// sets + 1 values, except in the plane: set s has points [point_offsets[s], point_offsets[s + 1]).
  std::vector<std::size_t> point_offsets;
  /// On a torus and a cylinder, images that were triangulated besides the points, because empty circles reach
  /// across the border.
  std::size_t images = 0;
  Statistics statistics;  ///< what the call did and how long it took; elsewhere, its last step in the plane
};

/// An OpenCL device, or the host, for which most members are empty.
struct DeviceInfo {
  std::string name;              ///< CL_DEVICE_NAME; FLAUNAY_DEVICE may name a part of it
  std::string platform;          ///< CL_PLATFORM_NAME
  std::string vendor;            ///< CL_DEVICE_VENDOR
  std::string driver;            ///< CL_DRIVER_VERSION
  std::string version;           ///< CL_DEVICE_VERSION
  std::string type;              ///< "CPU", "GPU", "accelerator"
  unsigned compute_units = 0;    ///< CL_DEVICE_MAX_COMPUTE_UNITS
  unsigned clock_mhz = 0;        ///< CL_DEVICE_MAX_CLOCK_FREQUENCY
  std::size_t memory_bytes = 0;  ///< CL_DEVICE_GLOBAL_MEM_SIZE
  /// The part of it that can be used now. A device that shares the host's memory has at most what is free
  /// there, and what the limits of the process and of its control group leave.
  std::size_t available_bytes = 0;
  std::size_t largest_buffer_bytes = 0;  ///< CL_DEVICE_MAX_MEM_ALLOC_SIZE
  std::size_t local_memory_bytes = 0;    ///< CL_DEVICE_LOCAL_MEM_SIZE
  std::size_t work_group_size = 0;       ///< CL_DEVICE_MAX_WORK_GROUP_SIZE
  bool fp64 = false;                     ///< whether it has double precision
  /// Whether it computes in fixed point: it lacks fp64 or, as far as the self test was run, its doubles are
  /// not exact or slower. What fixed point cannot do is done with its doubles or, if there are none, natively
  /// on the host. Results are the same.
  bool fixed_point = false;
  /// The fault that the arithmetic self test found; empty if it passed or was not run.
  std::string self_test_failure;
  bool self_test_passed = false;  ///< whether the arithmetic self test was run and passed
};

/// Lists every device of every platform, in the order in which "#k" counts them. With self_test, builds and
/// runs the arithmetic self test on each device, which takes some seconds per device. Throws Error(device) if
/// there is no OpenCL platform.
FLAUNAY_API std::vector<DeviceInfo> list_devices(bool self_test = false);

// Types for points and results in device memory. Include flaunay/device_memory.hpp to use them.
struct DevicePoints;
struct DeviceTriangulation;
struct DeviceClippedVoronoi;
struct DeviceVoronoi;
struct Enqueue;
struct Parts;
class DeviceBuffer;
struct DeviceSegments;
// Types for triangulations with constraints. Include flaunay/constrained.hpp to use them.
struct ConstrainedOptions;
struct ConstrainedTriangulation;
struct Polygons;
struct PolygonOptions;
struct Constraints;
/// Returns Enqueue{}: the triangulator's own queue, without waiting for events. O(1).
FLAUNAY_API const Enqueue& own_queue() noexcept;
/// Returns Parts{}: the triangles alone. O(1).
FLAUNAY_API const Parts& triangles_alone() noexcept;

/// The dual of a triangulation of n points, in the plane or on the sphere. Where more than three points are
/// cocircular, circumcentres coincide.
struct Voronoi {
  /// x and y per triangle. They are rounded; which cells are adjacent was decided by exact predicates. Those
  /// that coincide but for rounding are equal, so that bounded cells do not cross themselves. On the sphere x
  /// y z: the centre of the empty cap whose rim passes through the triangle's corners.
  std::vector<double> circumcentres;
  /// n + 1 values: the cell of point i has corners [cell_offsets[i], cell_offsets[i + 1]) of cells.
  std::vector<std::int32_t> cell_offsets;
  /// The triangles whose circumcentres are the corners of the cells. They go counter-clockwise around each
  /// point and begin with the smallest index. In an unbounded cell they begin at the hull edge that leaves
  /// the point and end at the hull edge that arrives at it; from the first and the last corner, a ray
  /// perpendicular to that edge goes outwards. Points that another point represents, and points on one line,
  /// have no corners. On the sphere, cells are counter-clockwise as seen from outside, and a set of one or
  /// two points has no corners: the cells of two points are hemispheres. If all points are on one great
  /// circle, cells are lunes with two corners (and some that coincide), opposite to each other, so that a
  /// side needs its middle to be drawn: of the cell of p that is the direction of a x (q - p), for the side
  /// that begins at the centre a of a triangle and is shared with q, the corner before p in that triangle.
  std::vector<std::int32_t> cells;
  /// n values in the plane: 1 for points on the hull and for all points of a set on one line, otherwise 0.
  std::vector<std::uint8_t> unbounded;
  /// n values on the sphere: the areas of the cells, of which those of a set sum to 4 pi; rounded by some
  /// 1e-15, and if all points are within an angle r, by that divided by r^2; of points within some 1e-15 of
  /// each other a sum can rarely be another multiple of 4 pi. Points that another one represents have 0, two
  /// points a hemisphere each, and a point alone the sphere.
  std::vector<double> areas;
};

/// The Voronoi cells of n points, clipped to a convex polygon.
struct ClippedVoronoi {
  /// x and y per vertex of a cell, counter-clockwise. Which vertices a cell has was decided by exact
  /// predicates; they are rounded, and those that coincide but for that are one, in all cells that share
  /// them. So polygons are simple, and tile.
  std::vector<double> vertices;
  /// n + 1 values: the cell of point i has vertices [offsets[i], offsets[i + 1]). Points that another point
  /// represents have none, nor have points whose cells have no area in the polygon, or none but for rounding.
  /// Other cells have at least three.
  std::vector<std::int32_t> offsets;
  std::vector<double> areas;      ///< n values; 0 for points whose cells have no area
  std::vector<double> centroids;  ///< x and y per point; NaN for these
};

/// Polygons with holes, each the union of the cells of a group.
struct JoinedCells {
  std::vector<std::int32_t> corners;  ///< vertices of the cells
  /// Ring r has corners [ring_offsets[r], ring_offsets[r + 1]), and meets no place twice.
  std::vector<std::int32_t> ring_offsets;
  /// Part q has rings [part_offsets[q], part_offsets[q + 1]): an outer one, counter-clockwise, and then its
  /// holes, clockwise.
  std::vector<std::int32_t> part_offsets;
  /// Group g has parts [group_offsets[g], group_offsets[g + 1]), none if its cells have no area.
  std::vector<std::int32_t> group_offsets;
};
/// Joins cells, or other polygons that tile, whose vertices alone are read: edges that two cells of a group
/// share cancel, exactly. groups: from 0 to group_count - 1, one per cell. bounds: the corners of the polygon
/// to which cells are clipped, and which they cover; on its edges, corners at which cells of one group alone
/// meet are left out. If empty, all corners stay. Throws Error(usage) for arrays that do not fit each other,
/// and Error(input) if vertices are not finite or their magnitudes differ too much. O(n) expected.
FLAUNAY_API JoinedCells join_cells(const ClippedVoronoi& cells, const std::vector<std::int32_t>& groups,
                                   std::size_t group_count, const std::vector<double>& bounds = {});

/// Computes triangulations, on one device or on the host. It owns the compiled kernels, the working memory
/// and a queue; the context is its own or the caller's. Using a device for the first time compiles kernels,
/// so keep the triangulator for the next call. It and its locators do one call at a time: a call during
/// another one, on another thread or from a progress callback, throws Error(usage). Triangulators on several
/// threads may share a context and a device.
///
/// If no device is named, calls on points in host memory use the first GPU with fp64, or else the first GPU
/// or, if there is none, the host's cores without OpenCL; small sets are triangulated on the calling thread
/// in any case. OpenCL is loaded when it is first needed. Results do not depend on any of this.
///
/// A device without fp64 computes in fixed point. What that cannot represent, coordinates whose bits span
/// more than 62 binary places, is left to the host, and Statistics::note says so. Voronoi diagrams,
/// relaxation and interpolation are always computed on the host then, for arrays in device memory too, which
/// are copied there and back; the call waits for that. So are the triangles at holes, and nearest points and
/// triangles of queries that are more than 2^60 times as fine or as far away as the points.
class FLAUNAY_API Triangulator {
 public:
  /// device: "" (what FLAUNAY_DEVICE names if it is set; otherwise flaunay's own choice, see above), "#k"
  /// (the k-th device of list_devices, from 0), a part of a device's or platform's name in upper or lower
  /// case, or "host" for the host without OpenCL. A named device does all the work, that of small sets too,
  /// except what a device without fp64 leaves to the host. The environment variables FLAUNAY_DEVICE
  /// and FLAUNAY_TUNING are read here, once, also for devices that are opened later. Throws Error(device) if
  /// there is no such device, if its arithmetic fails the self test, or if FLAUNAY_TUNING is not valid.
  explicit Triangulator(const std::string& device = "");
  /// Makes a triangulator in the caller's context, which is retained. Throws Error(usage) if the device does
  /// not belong to the context, and Error(device) if its arithmetic fails the self test.
  Triangulator(cl_context context, cl_device_id device);
  /// Waits for the work that was enqueued. Locators and results of the triangulator stay valid.
  ~Triangulator();
  /// A triangulator that was moved from can only be destroyed or assigned to.
  Triangulator(Triangulator&&) noexcept;
  /// Releases the memory of the triangulator that is assigned to. The other can then only be destroyed or
  /// assigned to.
  Triangulator& operator=(Triangulator&&) noexcept;

  /// The device that calls on host memory use; it passed the self test. The host's name is "host". Throws
  /// Error(device) if it cannot be used.
  DeviceInfo device() const;
  /// The context, for the caller's own buffers, kernels and queues. Owned by the triangulator. This and other
  /// functions for device memory use the device that was named, or else the first GPU with fp64, the first
  /// GPU, the first device with fp64, or the first device. They throw Error(device) if there is none, and
  /// Error(usage) if "host" was named.
  cl_context context() const;
  /// The OpenCL handle of the device. Owned by the triangulator.
  cl_device_id device_id() const;
  /// The triangulator's own queue, which is in order. Owned by the triangulator.
  cl_command_queue queue() const;

  /// The largest number of points that one call can take on this device, with the memory that is free now.
  std::size_t capacity() const;

  /// Triangulates one set of n points. coordinates: 2 n values, x0 y0 x1 y1 ...; may be null if n is 0.
  /// Throws Error(input) for a coordinate that is not finite, a range of magnitudes too large for exact
  /// arithmetic, or too many points; Error(device) if an OpenCL call fails. O(n log n) work.
  Triangulation triangulate(const double* coordinates, std::size_t n, const Options& options = {});
  /// Triangulates one set of n points in single precision. The result and the errors are those for the
  /// coordinates converted to double.
  Triangulation triangulate(const float* coordinates, std::size_t n, const Options& options = {});

  /// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]), which may be none; the
  /// first offset is 0 and the last one is the number of points. Throws Error(usage) if the offsets decrease
  /// or do not begin with 0, and otherwise what the call for one set throws. O(n log n) work.
  Triangulation triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options = {});
  /// Triangulates many sets of points in single precision. The result and the errors are those for the
  /// coordinates converted to double.
  Triangulation triangulate(const float* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options = {});

  /// Triangulates one set of n points of a space: in the plane x0 y0 x1 y1 ..., with weights or without; on a
  /// torus or a cylinder any finite numbers, which are taken into the period; on the sphere as
  /// Space::coordinates says. Results are exact, and functions of the set of places and weights.
  ///
  /// With weights it is the regular triangulation: the lower hull of the points at height x^2 + y^2 - weight;
  /// with equal weights the Delaunay triangulation, to the byte. Where more than three lifted points are on a
  /// plane, those that are no corners of their hull there are hidden; the others' polygon is triangulated as
  /// the farthest-point Delaunay triangulation, and where these are cocircular, as a fan from the
  /// lexicographically smallest one. It runs on the device that was named, if it has double precision;
  /// otherwise on the host's cores.
  ///
  /// On a torus or a cylinder it is the Delaunay triangulation of all images of all points, of which it has
  /// each triangle once, however few points there are; images have the weights of their points. Where more
  /// than three points are cocircular, their polygon is a fan from its lexicographically smallest vertex.
  /// Triangles are in the order that they have in the plane, which the number of points given has a part in.
  ///
  /// On the sphere it is the convex hull of the points in space: the triangulation of their places, and
  /// around the south pole what is beyond the hull there, which is the farthest-point Delaunay triangulation
  /// of the hull (Brown, 1979). Where more than three points are cocircular, their polygon is a fan from the
  /// first of them: the south pole, or else the smallest place, x before y.
  ///
  /// Throws what the call for the plane throws; Error(usage) also for a period that is none, for weights on
  /// the sphere, and for half-edges and areas on a torus or the sphere, which have neighbours
  /// always; Error(input) also for a weight that is not finite or beyond the squares of what coordinates may
  /// be, for the direction 0, and for a latitude beyond a pole. O(n log n) work.
  Triangulation triangulate(const double* points, std::size_t n, const Space& space,
                            const Options& options = {});
  /// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
  Triangulation triangulate(const double* points, const std::vector<std::size_t>& offsets, const Space& space,
                            const Options& options = {});
  /// Does not compile: research::triangulate takes these options, which this would ignore.
  template <typename Coordinate, typename Size>
  Triangulation triangulate(const Coordinate* coordinates, const Size& size,
                            const research::Options& options) = delete;

  /// Triangulates one set of n points with segments as edges: the canonical constrained Delaunay
  /// triangulation, a function of the sets of points and of segments. Throws what triangulate throws;
  /// Error(usage) for an index that is no point; Error(input) for segments that cross where no point is,
  /// unless they are to be split, for a hole that is in no triangle or on a constraint, and for segments that
  /// are no closed curves if the fill rule needs such. Expected O(n log n + s log^2 s) work for s segments,
  /// besides the number of triangles that they cross.
  ConstrainedTriangulation constrained(const double* coordinates, std::size_t n,
                                       const Constraints& constraints);
  /// Triangulates one set of n points with segments as edges.
  ConstrainedTriangulation constrained(const double* coordinates, std::size_t n,
                                       const Constraints& constraints, const ConstrainedOptions& options);
  /// Triangulates many sets with segments at once. Set s has points [offsets[s], offsets[s + 1]). Throws
  /// Error(usage) if the ends of a segment are in different sets, and otherwise what the call for one set
  /// throws.
  ConstrainedTriangulation constrained(const double* coordinates, const std::vector<std::size_t>& offsets,
                                       const Constraints& constraints);
  /// Triangulates many sets with segments at once.
  ConstrainedTriangulation constrained(const double* coordinates, const std::vector<std::size_t>& offsets,
                                       const Constraints& constraints, const ConstrainedOptions& options);
  /// Triangulates the insides of polygons, all at once. Each polygon is a set of its own, or all are one
  /// (PolygonOptions::map). Throws Error(usage) if the offsets do not fit each other, and otherwise what the
  /// call for sets with segments throws; if segments cross, the message names the polygon, too.
  ConstrainedTriangulation polygons(const Polygons& polygons);
  /// Triangulates the insides of polygons, all at once.
  ConstrainedTriangulation polygons(const Polygons& polygons, const PolygonOptions& options);

  /// Triangulates points in device memory into device memory. Points and results are not copied to the host;
  /// only sizes are, some bytes per block of 2,048 points, and the host waits 5 or 6 times for them, on
  /// devices with many lanes once or twice per round (Statistics::host_waits). The call returns when
  /// everything is enqueued; the number of triangles is known then. The results are complete when the event
  /// is complete, and for all commands that are enqueued later on the same in-order queue; until then the
  /// points and the buffers of the results must not be changed. A second call of the same size allocates no
  /// device memory. Throws Error(usage) for buffers that are too small or of another context, a queue of
  /// another context or device, offsets that decrease or do not end with the number of points; Error(input)
  /// and Error(device) as for points in host memory. The results are unspecified after an error. The queue,
  /// the events and the buffers must be alive when the call is made; the behaviour with a released one is
  /// undefined. O(n log n) work.
  void triangulate(const DevicePoints& points, DeviceTriangulation& result,
                   const Parts& parts = triangles_alone(), const Enqueue& enqueue = own_queue());

  /// Triangulates points in device memory with segments as edges, into device memory. Segments that cross
  /// where no point is are Error(input); no triangles are left out. The mesh has the arrays of constraints,
  /// and of the others all but halfedges and areas; Voronoi diagrams and locators refuse it. The host waits
  /// once per round of segments, about 8 times more than for triangulate. Otherwise the work is enqueued like
  /// that of triangulate for device memory, with the same errors and those of constrained for host memory.
  void constrained(const DevicePoints& points, const DeviceSegments& segments, DeviceTriangulation& mesh,
                   const Enqueue& enqueue = own_queue());

  /// An upper bound of the device memory, in bytes, that a call on n points in `sets` sets needs besides
  /// points and results. Throws Error(input) or Error(device) if n is above the capacity.
  std::size_t workspace_bytes(std::size_t n, std::size_t sets = 1) const;
  /// Makes later calls use the caller's buffer as their working memory; the buffer is retained. Null: the
  /// triangulator uses its own memory again. A call that needs more throws Error(usage), whose message says
  /// how much it needs. Modes other than blocks (research.hpp) always use the triangulator's own memory.
  /// Waits for the work that was enqueued.
  void use_workspace(cl_mem workspace);

  /// Computes the dual of a triangulation of these n points, in one or more sets. Throws Error(usage) for a
  /// triangulation without neighbours or of another number of points. O(n) work; one work-item per point
  /// takes as many steps as the point has triangles. In other spaces, coordinates and n are not read.
  Voronoi voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation);
  /// Computes the dual of a triangulation on the sphere. Throws Error(usage) for another space and for arrays
  /// that do not fit each other. O(n).
  Voronoi voronoi(const Triangulation& triangulation);
  /// Does not compile: a constrained triangulation is not the dual of a Voronoi diagram.
  Voronoi voronoi(const double* coordinates, std::size_t n,
                  const ConstrainedTriangulation& triangulation) = delete;
  /// Computes the dual in device memory. The triangulation must have the parts triangles, neighbors, hull and
  /// representatives. The work is enqueued like that of triangulate for device memory, with the same errors.
  /// The host waits once, or until cells are mended that would cross themselves but for that.
  void voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation, DeviceVoronoi& result,
               const Enqueue& enqueue = own_queue());

  /// Computes the Voronoi cells of these n points, in one or more sets, clipped to a convex polygon: corners
  /// has x0 y0 x1 y1 ... for 3 to 16,383 corners, counter-clockwise. A corner may lie on the line through its
  /// neighbours; cells do not have it then. What vertices cells have is decided exactly. Any points do: two,
  /// points on one line, or one, whose cell is the polygon. Throws Error(usage) for a triangulation without
  /// neighbours or of another number of points, and Error(input), which names a corner, for a polygon that is
  /// not finite, not convex, or not counter-clockwise, or that together with the points exceeds the range of
  /// magnitudes. O(n log m) work for m corners, and O(m) for each Voronoi edge across the polygon's border.
  ClippedVoronoi clipped_voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation,
                                 const double* corners, std::size_t corner_count);
  /// Computes the power cells of one set of n points with weights, clipped to a convex polygon: of each point
  /// the places whose power, the squared distance less the weight, is least for it. Vertices, areas and
  /// centroids are rounded; polygons are simple, and tile. Points without a cell in the polygon, such as
  /// hidden ones, have no vertices. Errors are those above; Error(usage) for several sets, too. O(n k) for k
  /// corners, but for points with very many neighbours. Without weights and in other spaces, as the other
  /// functions do.
  ClippedVoronoi clipped_voronoi(const double* coordinates, const double* weights, std::size_t n,
                                 const Triangulation& triangulation, const double* corners,
                                 std::size_t corner_count);
  /// Computes the Voronoi cells on a torus, each around its point's place, so that some reach beyond the
  /// period. Vertices are rounded to the units of the period, so that their images are exact; polygons are
  /// simple, and tile the torus. The areas of a set's cells sum to that of the period. weights: of points
  /// with weights, whose power cells these are; a point may lie outside of its cell. Throws Error(usage) for
  /// another space, for arrays that do not fit each other, and for a cylinder, where cells have no end. O(n).
  ClippedVoronoi clipped_voronoi(const Triangulation& triangulation, const double* weights = nullptr);
  /// Does not compile: a constrained triangulation is not the dual of a Voronoi diagram.
  ClippedVoronoi clipped_voronoi(const double* coordinates, std::size_t n,
                                 const ConstrainedTriangulation& triangulation, const double* corners,
                                 std::size_t corner_count) = delete;
  /// Computes clipped cells in device memory. The triangulation must have the parts triangles, neighbors,
  /// hull and representatives; the corners are in host memory. The host waits three times, or
  /// until polygons are mended; otherwise the work is enqueued like that of triangulate for device memory,
  /// with the same errors.
  void clipped_voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                       const double* corners, std::size_t corner_count, DeviceClippedVoronoi& result,
                       const Enqueue& enqueue = own_queue());

  /// Relaxes one set of n points, which may be no triangulation's, by Lloyd's method: each point moves to the
  /// centroid of its Voronoi cell clipped to the polygon, `iterations` times. Returns the points, x0 y0 x1 y1
  /// ... A point without a cell stays where it is in that iteration: of equal points all but the first, and
  /// points outside of the polygon whose cells do not meet it. Other points outside move inside. On a device,
  /// the points stay there between iterations. Throws what triangulate and clipped_voronoi throw.
  std::vector<double> relax(const double* coordinates, std::size_t n, const double* corners,
                            std::size_t corner_count, std::size_t iterations = 1);
  /// Relaxes one set of n points of a space, given and returned as triangulate takes them. On a torus they
  /// move to the centroids of their cells there, and are returned as places, in the period. On the sphere
  /// they move to where the sum of squared distances to the places of their cells is least on the sphere: the
  /// direction of the centroid of the cell in space (Du, Gunzburger and Ju, 2003), which is that of the sum
  /// over the sides of the cell of their angles times the normals of their planes. With weights, cells are
  /// power cells; hidden points stay where they are, too; on the sphere, points that stay are returned as
  /// they were given. No bit depends on the order of the points.
  /// corners: of the polygon, in the plane alone. Throws what triangulate and clipped_voronoi throw;
  /// Error(usage) for a cylinder, where cells have no end.
  std::vector<double> relax(const double* points, std::size_t n, const Space& space,
                            std::size_t iterations = 1, const double* corners = nullptr,
                            std::size_t corner_count = 0);
  /// Relaxes one set of points in device memory; result: double2, 16 bytes per point, another buffer than
  /// that of the points. The host waits as often per iteration as triangulate does, and three times more; the
  /// points do not travel. Otherwise the work is enqueued like that of triangulate, with the same errors.
  void relax(const DevicePoints& points, const double* corners, std::size_t corner_count,
             std::size_t iterations, DeviceBuffer& result, const Enqueue& enqueue = own_queue());

 private:
  friend class Locator;
  friend struct TriangulatorAccess;
  struct FLAUNAY_LOCAL Implementation;
  // Shared with the locators, which may outlive the triangulator.
  std::shared_ptr<Implementation> implementation_;
};

/// How values are computed between points.
enum class Interpolation {
  linear,   ///< linearly in each triangle; continuous
  nearest,  ///< the values of the nearest point
  /// By cubics, with a continuous gradient: the reduced element of Hsieh, Clough and Tocher, as SciPy's
  /// CloughTocher2DInterpolator; on the sphere Renka's interpolant.
  clough_tocher,
  /// By Sibson's natural-neighbour weights: the areas that a query's Voronoi cell would take from the cells
  /// of the points around it. Smooth except at the points. Exact for linear functions, up to rounding.
  sibson,
  /// By Laplace's natural-neighbour weights: the lengths of that cell's edges over the distances of the
  /// points. Continuous, and exact for linear functions, up to rounding.
  laplace,
};

/// How gradients are estimated: so that the curvature along all edges is least (Nielson, 1983; Renka and
/// Cline, 1984). Each iteration multiplies the error by about 0.27, so 14 reach the default tolerance.
struct GradientOptions {
  double tolerance = 1e-6;       ///< the error, relative to all gradients together
  std::size_t iterations = 400;  ///< no more than these are made
};

/// The options of one interpolation.
struct InterpolationOptions {
  Interpolation method = Interpolation::linear;  ///< how values are computed
  std::size_t columns = 1;  ///< numbers per point: values are rows of so many, and so are results
  /// The result outside of the hull. The nearest point has none, except in a set without points.
  double fill = std::numeric_limits<double>::quiet_NaN();
  /// For Interpolation::clough_tocher: x and y per number of the values, on the sphere x, y and z, such as
  /// Locator::gradients returns. Null: they are estimated in each call.
  const double* gradients = nullptr;
  cl_mem device_gradients = nullptr;  ///< InterpolationOptions::gradients for values in device memory
  GradientOptions estimation;         ///< how gradients are estimated if none are given
};

/// The weights of points at queries: query i has the points and weights [offsets[i], offsets[i + 1]).
struct NaturalWeights {
  std::vector<std::size_t> offsets;  ///< one more than there are queries
  std::vector<std::int32_t> points;  ///< without an order; of duplicates the representative
  std::vector<double> weights;       ///< 0 or more, with the sum 1
};

/// Answers queries on a triangulation: the containing triangle, the nearest point, an interpolated value. A
/// search tree leads to a vertex near the query, and from there an exact walk goes from triangle to triangle.
/// One call answers any number of queries. If the triangulation has several sets, there must be as many sets
/// of queries, each for the set of the same number; their offsets are like those of points. A query that is
/// not finite, or whose coordinates are too fine for exact arithmetic in doubles, is an Error(input) that
/// names it. The locator shares device and memory with its triangulator, so a call during another one of
/// either throws Error(usage); it may outlive the triangulator. A locator that was made from host memory
/// without OpenCL answers queries in host memory only. Among points with weights it locates, and interpolates
/// within triangles; nearest points (see PointTree) and natural neighbours are Error(usage).
class FLAUNAY_API Locator {
 public:
  /// Makes a locator for a triangulation of these n points, which must have neighbours. The locator copies
  /// what it needs, about 80 bytes of device memory per point. Throws Error(usage) for a triangulation
  /// without neighbours or of another number of points. O(n log n) work.
  Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
          const Triangulation& triangulation);
  /// Makes a locator for a triangulation of several sets: set s has points [offsets[s], offsets[s + 1]).
  Locator(Triangulator& triangulator, const double* coordinates, const std::vector<std::size_t>& offsets,
          const Triangulation& triangulation);
  /// Makes a locator for a triangulation on a torus, a cylinder or the sphere; it copies what it needs. On a
  /// torus or a cylinder, queries are any places of the plane, and are rounded to places as points are. They
  /// are answered in the plane, with images of points around the box; on a cylinder with three times as many
  /// points. On the sphere, queries are given as the points were, and are rounded to places as these: of the
  /// points' places a locator in the plane finds one near the query's, from which an exact walk goes on over
  /// the sphere. weights: of points with weights on a torus or a cylinder. Throws Error(usage) for the plane,
  /// and for arrays that do not fit each other. O(n log n).
  Locator(Triangulator& triangulator, const Triangulation& triangulation, const double* weights = nullptr);
  /// Makes a locator for a triangulation with constraints, which must have neighbours and be of one set, such
  /// as a map. coordinates: those of the n points that were triangulated; values and answers are of the
  /// points that were added, too. Queries in no triangle, such as those in holes, are outside. Nearest points
  /// are those of all points, whatever is between. Natural neighbours are those that can be seen without
  /// crossing a constraint or the border: weights are those of Seidel's extended Voronoi diagram (1988), tend
  /// to linear interpolation on constraints, and are exact for linear functions. Clough-Tocher is smooth
  /// across constraints. If triangles are left out, all points are triangulated again with the edges there.
  Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
          const ConstrainedTriangulation& triangulation);
  /// Makes a locator for points and a triangulation in device memory, which must have the parts triangles,
  /// neighbors, hull and representatives. The work is enqueued like that of Triangulator::triangulate for
  /// device memory, with the same errors.
  Locator(Triangulator& triangulator, const DevicePoints& points, const DeviceTriangulation& triangulation,
          const Enqueue& enqueue = own_queue());
  /// Releases its device memory.
  ~Locator();
  /// A locator that was moved from can only be destroyed or assigned to.
  Locator(Locator&&) noexcept;
  /// Releases the memory of the locator that is assigned to. The other can then only be destroyed or assigned
  /// to.
  Locator& operator=(Locator&&) noexcept;

  /// Makes later queries on the sphere be given so. Throws Error(usage) in other spaces.
  void set_coordinates(SphereCoordinates coordinates);

  /// Finds for each of m queries, x0 y0 x1 y1 ..., the triangle that contains it, exactly. On an edge or a
  /// vertex it is the triangle of the smallest index that contains the query, on a torus always the same one;
  /// outside of the hull, beyond the ends of a cylinder, and beyond a set that lies within a hemisphere it is
  /// -1. On the sphere, triangles are between arcs of great circles. About O(log n) per query.
  std::vector<std::int32_t> locate(const double* queries, std::size_t m);
  /// Answers several sets of queries, one per set of the triangulation: set s has queries [offsets[s],
  /// offsets[s + 1]). Throws Error(usage) if the number of sets differs.
  std::vector<std::int32_t> locate(const double* queries, const std::vector<std::size_t>& offsets);
  /// Answers queries in device memory, enqueued like Triangulator::triangulate for device memory. triangles:
  /// int32, 4 m bytes.
  void locate(const DevicePoints& queries, DeviceBuffer& triangles, const Enqueue& enqueue = own_queue());

  /// Finds for each of m queries the index of the nearest point, by exact comparisons. If several points are
  /// nearest, it is the first of them in the order of x, then y, on a torus as they lie around the query's
  /// place, and on the sphere the south pole, or else the smallest place. It is -1 if the set is empty. About
  /// O(log n) per query is expected, except at a vertex with very many neighbours that are all about as near
  /// and not cocircular. On meshes where some walks are long (points on a curve, vertices with very many
  /// neighbours), the first call with such a query takes up to half as long as making the locator did, once.
  std::vector<std::int32_t> nearest(const double* queries, std::size_t m);
  /// Answers several sets of queries; see locate.
  std::vector<std::int32_t> nearest(const double* queries, const std::vector<std::size_t>& offsets);
  /// Answers queries in device memory; see locate. points: int32, 4 m bytes.
  void nearest(const DevicePoints& queries, DeviceBuffer& points, const Enqueue& enqueue = own_queue());

  /// Computes for each of m queries the linear interpolation of the values at the corners of its triangle,
  /// rounded; at a vertex exactly the value of that vertex, and outside of the hull NaN. values: one per
  /// input point; for duplicates, the value of their representative is used. About O(log n) per query.
  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m);
  /// Answers several sets of queries; see locate. values: one per input point, over all sets.
  std::vector<double> interpolate(const double* values, const double* queries,
                                  const std::vector<std::size_t>& offsets);
  /// Answers queries in device memory; see locate. values: double, 8 n bytes; results: double, 8 m bytes.
  void interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                   const Enqueue& enqueue = own_queue());

  /// Interpolates by any method, several numbers per point at once. On the sphere, linear interpolation is
  /// the value where the direction of the query meets the triangle in space; Clough-Tocher stands for Renka's
  /// interpolant (1984), of cubics along great circles with a continuous gradient; and natural neighbors
  /// (Brown, 1994) have areas of cells on the sphere, and lengths of arcs. Natural neighbors of so few points
  /// on a torus that a circle without points is wider than the shorter period, on a cylinder one with its
  /// centre between the ends, are Error(input). values: one row of options.columns numbers per input point;
  /// the result has one row per query. At a point, every method gives exactly that point's values; for
  /// duplicates, those of their representative are used. Throws Error(usage) if options.columns is 0.
  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m,
                                  const InterpolationOptions& options);
  /// Answers several sets of queries; see locate. values: one row per input point, over all sets.
  std::vector<double> interpolate(const double* values, const double* queries,
                                  const std::vector<std::size_t>& offsets,
                                  const InterpolationOptions& options);
  /// Answers queries in device memory; see locate. values and results: double, 8 bytes per number.
  void interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                   const InterpolationOptions& options, const Enqueue& enqueue = own_queue());

  /// Returns the natural neighbours of m queries with the weights by which Interpolation::sibson or laplace
  /// interpolates any values; none outside. On a torus or a cylinder a point can be there
  /// several times, for images of it.
  /// Throws Error(usage) for another method and for several sets.
  NaturalWeights natural_weights(const double* queries, std::size_t m,
                                 Interpolation method = Interpolation::sibson);

  /// Estimates the gradients of values at the points, for Interpolation::clough_tocher. values: rows of
  /// `columns` numbers, one row per input point. Returns x and y per number, on the sphere x, y and z of a
  /// vector that is tangent there. It is NaN at points that another one represents, at hidden ones, and at
  /// those of a set without triangles. O(n) per column and iteration; one work-item takes as many steps as a
  /// point has neighbours.
  std::vector<double> gradients(const double* values, std::size_t columns = 1,
                                const GradientOptions& options = {});
  /// Estimates the gradients in device memory, enqueued like Triangulator::triangulate for device memory.
  /// values and gradients: double, 8 and 16 bytes per number.
  void gradients(cl_mem values, DeviceBuffer& gradients, std::size_t columns = 1,
                 const GradientOptions& options = {}, const Enqueue& enqueue = own_queue());

 private:
  struct FLAUNAY_LOCAL Implementation;
  FLAUNAY_LOCAL static std::unique_ptr<Implementation> make(Triangulator& triangulator, bool on_device);
  std::unique_ptr<Implementation> implementation_;
};

/// The version of the library that is linked, such as "0.1.0". The text is static.
FLAUNAY_API const char* version() noexcept;

}  // namespace flaunay
