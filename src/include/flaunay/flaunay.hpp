// flaunay: exact two-dimensional Delaunay triangulation on any OpenCL device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "flaunay/export.h"
#include "flaunay/opencl.h"

/// Exact two-dimensional Delaunay triangulation on any OpenCL device. All that fails throws Error.
namespace flaunay {

/// What went wrong, in the terms of the command's exit codes.
enum class ErrorKind {
  usage,     ///< a request that makes no sense (exit code 2)
  input,     ///< bad points: not finite, out of range, too many, unreadable (exit code 3)
  device,    ///< no device, device too small, an OpenCL call failed (exit code 4)
  internal,  ///< a broken invariant of flaunay itself; please report it
};

/// The one exception type of the library.
class FLAUNAY_API Error : public std::runtime_error {
 public:
  /// code and call: of OpenCL, if it was one of its calls that failed.
  explicit Error(ErrorKind kind, const std::string& message, int code = 0, const std::string& call = {})
      : std::runtime_error(message), kind_(kind), code_(code), call_(std::make_shared<std::string>(call)) {}
  /// Copied, and never moved from, so that call() always has a string to return.
  Error(const Error&) = default;
  /// Likewise.
  Error& operator=(const Error&) = default;
  /// For programs; what() is for people, and names the place.
  ErrorKind kind() const noexcept { return kind_; }
  /// What the OpenCL call returned, such as -5 for CL_OUT_OF_RESOURCES; 0 if none failed.
  int code() const noexcept { return code_; }
  /// The OpenCL call that failed, such as "clCreateBuffer"; empty if none did.
  const std::string& call() const noexcept { return *call_; }

 private:
  ErrorKind kind_;
  int code_;
  // Exceptions are copied, and their copies must not throw.
  std::shared_ptr<const std::string> call_;
};

/// Which way each region is cut.
enum class Cut {
  interquartile,  ///< across the longer interquartile range of its internal points
  alternate,      ///< x and y in turn, as in the paper
};

/// How the divide and conquer is executed. The result is the same set of triangles, whatever the mode.
enum class Mode {
  hybrid,            ///< on the device, blocks of points solved whole and merged: the fastest
  flattened,         ///< on the device, all regions of a level at once
  recursive_device,  ///< by the same kernels, one region at a time, depth first
  recursive,         ///< plain recursion on the host, one thread: the readable twin
  partition,         ///< a few flattened levels on the device, then Dwyer's algorithm on host threads
  dwyer,             ///< Dwyer's divide and conquer on the host, one thread: the sequential rival
};

/// How the dividing paths are computed. The result is the same, whatever the variant.
enum class Hull {
  prune,           ///< prune by candidates from buckets, then quickhull
  quickhull,       ///< quickhull alone
  balanced,        ///< a few rounds of quickhull, then balanced splits (Chan, Snoeyink and Yap)
  monotone_chain,  ///< Andrew's scan over points sorted along the cut; Mode::recursive only
};

/// As the command line names them: "recursive-device" and so on. The text is static.
FLAUNAY_API const char* to_string(Mode mode) noexcept;
/// Likewise: "monotone-chain" and so on.
FLAUNAY_API const char* to_string(Hull hull) noexcept;

/// What a caller can ask of one triangulation.
struct Options {
  Mode mode = Mode::hybrid;      ///< how; the triangles are the same, the order of rows is the mode's own
  Cut cut = Cut::interquartile;  ///< not in Mode::hybrid and Mode::dwyer
  Hull hull = Hull::prune;       ///< likewise
  bool neighbors = true;         ///< compute Triangulation::neighbors
  bool halfedges = false;        ///< compute Triangulation::halfedges
  bool profile = false;          ///< time every kernel by events; costs a little
  bool count = false;            ///< count operations into Statistics::work; slow; not in Mode::hybrid
  int partition_levels = 0;      ///< Mode::partition: levels on the device; 0 chooses
  int threads = 0;               ///< Mode::partition: host threads; 0 takes one per core
  /// Called between levels, on the calling thread; may be empty.
  /// done is the share of the points' work that is finished, 0 to 1.
  std::function<void(const std::string& stage, int level, double done)> progress;
};

/// The parts of the algorithm, as the paper divides its work.
enum class Component {
  cut,      ///< medians and axes; sorting and partitioning in Mode::dwyer
  hull,     ///< dividing paths
  merge,    ///< border merge; the merges of Mode::dwyer
  split,    ///< points to either side
  endgame,  ///< triangles of regions without internal points
};
/// How many components there are.
constexpr std::size_t kComponents = 5;

/// What one component did: numbers of operations by kind, and the length of its critical path in operations.
/// See docs/counting.md for what counts, and for how the depth of each vector operation is defined.
struct OperationCounts {
  std::uint64_t arithmetic = 0;     ///< additions, multiplications and comparisons outside of predicates
  std::uint64_t depths = 0;         ///< evaluations of the depth below a chord
  std::uint64_t orientations = 0;   ///< evaluations of the orientation of three points
  std::uint64_t circles = 0;        ///< evaluations of the in-circle test
  std::uint64_t critical_path = 0;  ///< operations that have to be done one after the other

  /// What is done one after the other: critical paths add up too.
  FLAUNAY_API OperationCounts& operator+=(const OperationCounts& other) noexcept;
  /// All as floating-point operations, arithmetic and comparisons: a predicate counts for the operations of
  /// its plain evaluation, without the error bound's.
  FLAUNAY_API std::uint64_t operations() const noexcept;
  /// The same with the operations that bound each predicate's error.
  FLAUNAY_API std::uint64_t operations_with_bounds() const noexcept;
};

/// Options::count: the work by component and level. Level 0 is the first cut (in Mode::dwyer the last merge);
/// start is what precedes it: sorting and the first hulls.
struct Work {
  /// By Component.
  using Components = std::array<OperationCounts, kComponents>;
  Components start{};              ///< what precedes the first cut
  std::vector<Components> levels;  ///< level by level
  /// Corners of each region that the end game triangulated: histogram[k] regions of k corners. Regions of
  /// more than 1023 corners count as such of 1023; there are no zeros at the end.
  std::vector<std::uint64_t> endgame_sizes;
};

/// One level of the recursion.
struct LevelStatistics {
  std::size_t regions = 0;          ///< regions cut at this level
  std::size_t internal_points = 0;  ///< their internal points, all together
  std::size_t corners = 0;          ///< their border corners, all together
  std::size_t largest_region = 0;   ///< internal points of the largest of them
  std::size_t candidates = 0;       ///< for prune's paths, candidates of candidates included
  std::size_t survivors = 0;        ///< points that prune leaves to quickhull
  std::size_t path_vertices = 0;    ///< vertices of the dividing paths, all together
  int candidate_rounds = 0;         ///< quickhull rounds on the candidates
  int hull_rounds = 0;              ///< quickhull rounds on the survivors
  double seconds = 0;               ///< wall time
};

/// Where one kernel's time went (Options::profile).
struct KernelStatistics {
  std::string name;          ///< as in its file in kernels/
  std::size_t launches = 0;  ///< how often it ran
  double seconds = 0;        ///< on the device, all launches together
};

/// A named part of the work and its wall time.
struct PhaseStatistics {
  std::string name;    ///< "blocks", "triangulate", "output" and others, by mode
  double seconds = 0;  ///< wall time on the host, waits included
};

/// How a result came about.
struct Statistics {
  std::string device;                     ///< its name; "host" in modes of the host
  std::size_t points = 0;                 ///< input points
  std::size_t duplicates = 0;             ///< input points that are not their own representative
  std::size_t triangles = 0;              ///< over all sets
  std::size_t hull_vertices = 0;          ///< over all sets
  double seconds = 0;                     ///< from points in host memory to results in host memory
  double build_seconds = 0;               ///< building programs, part of no other figure
  std::size_t kernel_launches = 0;        ///< enqueued on the device
  std::size_t host_waits = 0;             ///< times the host waited for the device
  std::size_t bytes_to_device = 0;        ///< copied by the host; memory that is used in place is not
  std::size_t bytes_to_host = 0;          ///< likewise
  std::size_t device_allocations = 0;     ///< OpenCL buffers made, sub-buffers not counted
  std::size_t device_bytes_peak = 0;      ///< most device memory held at once
  std::size_t undecided = 0;              ///< predicates that needed exact evaluation
  std::vector<PhaseStatistics> phases;    ///< in the order of time
  std::vector<LevelStatistics> levels;    ///< of the modes that go level by level
  std::vector<KernelStatistics> kernels;  ///< the longest first; empty if not profiled
  Work work;                              ///< empty without Options::count
};

/// The triangulations of one or more point sets. All indices are those of the input points, over all sets;
/// triangle indices count over all sets too.
struct Triangulation {
  /// 3 per triangle, counter-clockwise, smallest index first.
  std::vector<std::int32_t> triangles;
  /// 3 per triangle: the triangle opposite to each vertex, -1 beyond the hull. Empty if not asked for.
  std::vector<std::int32_t> neighbors;
  /// 3 per triangle: halfedge 3t + k goes from vertex k of triangle t to the next one; here is the halfedge
  /// that goes back, in the triangle beyond, or -1 on the hull. The convention of delaunator. Empty if not
  /// asked for.
  std::vector<std::int32_t> halfedges;
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order.
  std::vector<std::int32_t> hull;
  /// One per input point: the smallest index of a point of its set with the same coordinates.
  std::vector<std::int32_t> representatives;
  /// Set s has triangles [triangle_offsets[s], triangle_offsets[s + 1]) and likewise hull vertices.
  std::vector<std::size_t> triangle_offsets;
  std::vector<std::size_t> hull_offsets;  ///< sets + 1, as triangle_offsets
  Statistics statistics;                  ///< how it came about
};

/// A region of a partition: a part of the triangulation still to be computed. Its border is made of Delaunay
/// edges, so the triangles on its inside depend on its own points alone.
struct Region {
  /// Indices of input points: those inside, and those of the border.
  std::vector<std::int32_t> points;
  /// Directed edges, two positions in points each, the region on the left.
  std::vector<std::int32_t> border;
};

/// A set of points cut into regions by some levels of the recursion.
struct Partition {
  std::vector<Region> regions;  ///< what is left to do
  /// Triangles that are final already, of regions that had no points inside: 3 indices of input points each.
  std::vector<std::int32_t> triangles;
  Statistics statistics;  ///< how it came about
};

/// Puts a partition together again. solutions: for each region any Delaunay triangulation of its points, 3
/// positions in Region::points per triangle, in either orientation, what lies outside the border included.
/// The result is that of triangulate. Throws Error(input) if a solution is not a triangulation of its
/// region's points. Uses no device. O(n log n) work, on the calling thread.
FLAUNAY_API Triangulation assemble(const double* coordinates, std::size_t n, const Partition& partition,
                                   const std::vector<std::vector<std::int32_t>>& solutions,
                                   const Options& options = {});

/// Mode::recursive and Mode::dwyer without a device, on the calling thread. Points, offsets and result as of
/// Triangulator::triangulate. Throws Error(usage) for another mode, and what that throws. O(n log n) work.
FLAUNAY_API Triangulation triangulate_on_host(const double* coordinates,
                                              const std::vector<std::size_t>& offsets,
                                              const Options& options);

/// What the library says of an OpenCL device.
struct DeviceInfo {
  std::string name;                      ///< as FLAUNAY_DEVICE matches it
  std::string platform;                  ///< CL_PLATFORM_NAME
  std::string vendor;                    ///< CL_DEVICE_VENDOR
  std::string driver;                    ///< CL_DRIVER_VERSION
  std::string version;                   ///< CL_DEVICE_VERSION
  std::string type;                      ///< "CPU", "GPU", "accelerator"
  unsigned compute_units = 0;            ///< CL_DEVICE_MAX_COMPUTE_UNITS
  unsigned clock_mhz = 0;                ///< CL_DEVICE_MAX_CLOCK_FREQUENCY
  std::size_t memory_bytes = 0;          ///< CL_DEVICE_GLOBAL_MEM_SIZE
  std::size_t largest_buffer_bytes = 0;  ///< CL_DEVICE_MAX_MEM_ALLOC_SIZE
  std::size_t local_memory_bytes = 0;    ///< CL_DEVICE_LOCAL_MEM_SIZE
  std::size_t work_group_size = 0;       ///< CL_DEVICE_MAX_WORK_GROUP_SIZE
  bool fp64 = false;                     ///< double precision, without which flaunay refuses the device
  /// Empty if the arithmetic self test passed, else what failed. Only filled if it was asked for.
  std::string self_test_failure;
  bool self_test_passed = false;  ///< it was asked for, and passed
};

/// Every device of every platform, in the order that "#k" counts. Throws Error(device) if there is no OpenCL
/// platform. With self_test, builds and runs the arithmetic self test on each device that has fp64.
FLAUNAY_API std::vector<DeviceInfo> list_devices(bool self_test = false);

/// What coordinates and values in device memory are made of.
enum class Precision {
  float64,  ///< double, 16 bytes a point
  float32,  ///< float, 8 bytes a point; each is taken as the double of the same value
};

/// Points in device memory, in one or more sets.
struct DevicePoints {
  cl_mem memory = nullptr;                   ///< x0 y0 x1 y1 ..., as arrays of double2 or float2 are
  std::size_t count = 0;                     ///< of points
  Precision precision = Precision::float64;  ///< of the coordinates
  std::size_t first = 0;                     ///< points that precede them in the buffer
  /// Set s has points [offsets[s], offsets[s + 1]), counted from `first`; begins with 0 and ends with count.
  /// Empty: one set, or what device_offsets says.
  std::vector<std::size_t> offsets;
  /// The same in device memory, sets + 1 int32; 4 bytes a set cross to the host.
  cl_mem device_offsets = nullptr;
  std::size_t sets = 0;  ///< of device_offsets
};

/// How a call on device memory is enqueued.
struct Enqueue {
  /// Of the triangulator's context and device; in order or not. Null: the triangulator's own. It is retained
  /// until the triangulator gets another or goes; with one that its owner has released by then, a call works
  /// or throws Error(usage), as far as OpenCL lets it be seen.
  cl_command_queue queue = nullptr;
  std::vector<cl_event> wait_for;  ///< what must be done before
  /// If not null, gets an event that is complete when the results are there; the caller releases it.
  cl_event* event = nullptr;
  /// Time every kernel by events, for Statistics::kernels: waits for the end. The queue must have
  /// CL_QUEUE_PROFILING_ENABLE, if one is given.
  bool profile = false;
};

/// Results in device memory: in a buffer of the caller, or in one that flaunay makes when it is first needed,
/// keeps for the next call, and replaces by a larger one where it is too small. A handle: copies refer to the
/// same buffer.
class FLAUNAY_API DeviceBuffer {
 public:
  DeviceBuffer() noexcept = default;
  /// The caller's, which is retained and never replaced. Throws Error(usage) if it is no buffer.
  explicit DeviceBuffer(cl_mem memory);
  /// Null as long as there is none. Valid as long as this or a copy of it; clRetainMemObject makes it stay
  /// longer.
  cl_mem memory() const noexcept { return memory_.get(); }
  /// The buffer's size, which may be more than its contents need.
  std::size_t bytes() const noexcept { return bytes_; }
  /// Whether it was made from a buffer of the caller.
  bool is_callers() const noexcept { return is_callers_; }

 private:
  friend struct DeviceBufferAccess;
  std::shared_ptr<struct _cl_mem> memory_;
  std::size_t bytes_ = 0;
  bool is_callers_ = false;
};

/// Which parts of a triangulation to compute on the device. Neighbours and halfedges need the triangles.
struct Parts {
  bool triangles = true;         ///< Triangulation::triangles
  bool neighbors = false;        ///< Triangulation::neighbors
  bool halfedges = false;        ///< Triangulation::halfedges
  bool hull = false;             ///< Triangulation::hull
  bool representatives = false;  ///< Triangulation::representatives
};

/// A Triangulation in device memory, all arrays int32. Bytes for n points, at most: triangles, neighbors,
/// halfedges 24 n each, hull and representatives 4 n each; flaunay makes its own buffers so large, and the
/// caller's must be.
struct DeviceTriangulation {
  DeviceBuffer triangles;        ///< 3 per triangle
  DeviceBuffer neighbors;        ///< 3 per triangle
  DeviceBuffer halfedges;        ///< 3 per triangle
  DeviceBuffer hull;             ///< 1 per hull vertex
  DeviceBuffer representatives;  ///< 1 per point
  /// What the last call computed.
  Parts parts{false, false, false, false, false};
  std::size_t points = 0;  ///< over all sets
  /// In host memory, sets + 1, known when the call returns: set s has points [point_offsets[s],
  /// point_offsets[s + 1]).
  std::vector<std::size_t> point_offsets;
  std::vector<std::size_t> triangle_offsets;  ///< likewise its triangles, whatever the parts
  std::vector<std::size_t> hull_offsets;      ///< likewise its hull vertices, whatever the parts
  /// How it came about; seconds: until all was enqueued.
  Statistics statistics;
};

/// The dual of a triangulation. Where more than three points are cocircular, circumcentres coincide.
struct Voronoi {
  /// 2 per triangle, rounded: exact predicates decide what is adjacent, not these.
  std::vector<double> circumcentres;
  /// The cell of point i has corners [cell_offsets[i], cell_offsets[i + 1]) of cells. n + 1.
  std::vector<std::int32_t> cell_offsets;
  /// Triangles, whose circumcentres are the cells' corners, counter-clockwise around each point, from the
  /// smallest index on. Of an unbounded cell: from the hull edge that leaves the point to the one that
  /// arrives at it; a ray perpendicular to these edges goes outwards from the first and from the last corner.
  /// None for a point that another represents, and for points on one line.
  std::vector<std::int32_t> cells;
  std::vector<std::uint8_t> unbounded;  ///< 1 for points on the hull, also for all of a set on one line; n
};

/// A Voronoi diagram in device memory, of n points.
struct DeviceVoronoi {
  DeviceBuffer circumcentres;  ///< Voronoi::circumcentres, double2, 16 bytes a triangle
  DeviceBuffer cell_offsets;   ///< Voronoi::cell_offsets, int32, 4 (n + 1) bytes
  DeviceBuffer cells;          ///< Voronoi::cells, int32, 12 bytes a triangle
  DeviceBuffer unbounded;      ///< Voronoi::unbounded, uchar, n bytes
};

/// Owns a device's programs and memory, and its context and queue or the caller's; reusable, movable, one
/// thread at a time. Triangulators on several threads may share a context and a device.
class FLAUNAY_API Triangulator {
 public:
  /// device: "" (FLAUNAY_DEVICE if set, else the first GPU, else the first device with fp64),
  /// "#k" (the k-th of list_devices, from 0), or a part of a device's or platform's name, whatever its case.
  /// Throws Error(device) if there is none, or if its arithmetic fails the self test.
  explicit Triangulator(const std::string& device = "");
  /// In the caller's context, which is retained. Throws Error(usage) if the device is not one of the context,
  /// Error(device) as above.
  Triangulator(cl_context context, cl_device_id device);
  /// Results stay, and so do Locators.
  ~Triangulator();
  /// What was moved from can only be destroyed or assigned to.
  Triangulator(Triangulator&&) noexcept;
  /// Likewise.
  Triangulator& operator=(Triangulator&&) noexcept;

  /// Its device, which passed the self test.
  DeviceInfo device() const;
  /// For the caller's own buffers, kernels and queues; owned by the triangulator.
  cl_context context() const noexcept;
  /// The same device for OpenCL; owned by the triangulator.
  cl_device_id device_id() const noexcept;
  /// Its own queue, in order; owned by the triangulator.
  cl_command_queue queue() const noexcept;

  /// The largest number of points that one call can take on this device.
  std::size_t capacity() const;

  /// Triangulates one set of points. coordinates: x0 y0 x1 y1 ..., n points.
  /// The result is the caller's, in host memory, complete when the call returns. Throws Error(input) for a
  /// coordinate that is not finite, a range of magnitudes beyond what is exact, or too many points;
  /// Error(usage) for options that do not go together; Error(device) if an OpenCL call fails. O(n log n)
  /// work.
  Triangulation triangulate(const double* coordinates, std::size_t n, const Options& options = {});
  /// The same of float; the result is that of the same numbers as double.
  Triangulation triangulate(const float* coordinates, std::size_t n, const Options& options = {});

  /// Triangulates many sets at once: set s has points [offsets[s], offsets[s + 1]); offsets[0] is 0 and the
  /// last offset the number of points; sets may be empty. Throws Error(usage) too if they decrease.
  Triangulation triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options = {});
  /// Many sets of float.
  Triangulation triangulate(const float* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options = {});

  /// Triangulates points in device memory into device memory (Mode::hybrid). No points and no results cross
  /// to the host: only sizes do, some bytes for each block of 2,048 points, and the host waits 5 or 6 times
  /// in between (Statistics::host_waits). Returns when all is enqueued, with the numbers of triangles known;
  /// the results are there when the event is complete, or for whatever is enqueued on the same in-order queue
  /// later. The points and the results' buffers must not change until then. A second call of the same size
  /// allocates no device memory. Throws Error(usage) for buffers that are too small or of another context, a
  /// queue of another context or device or (where that shows) one that was released, offsets that decrease or
  /// do not end with the number of points; Error(input) and Error(device) as above. Results are unspecified
  /// after an error.
  void triangulate(const DevicePoints& points, DeviceTriangulation& result, const Parts& parts = {},
                   const Enqueue& enqueue = {});

  /// Bytes of device memory that calls in Mode::hybrid on up to n points need besides points and results, at
  /// most.
  std::size_t workspace_bytes(std::size_t n, std::size_t sets = 1) const;
  /// From now on that memory is the caller's buffer, which is retained; null: the triangulator's own again. A
  /// call for which it is too small throws Error(usage) that says how much is needed. Other modes have memory
  /// of their own. Waits for what was enqueued.
  void use_workspace(cl_mem workspace);

  /// The dual, from triangles and neighbours, of one or more sets. Throws Error(usage) for a triangulation
  /// without neighbours or of another number of points. O(n) work; a point of degree d takes one work-item d
  /// steps.
  Voronoi voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation);
  /// The same in device memory, enqueued as triangulate is. Needs the parts triangles, neighbors, hull and
  /// representatives.
  void voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation, DeviceVoronoi& result,
               const Enqueue& enqueue = {});

  /// The regions after `levels` levels, up to 2^levels of them; O(levels n) work after sorting. Options::mode
  /// and count mean nothing here. Throws Error(usage) if levels is negative, and what triangulate throws.
  Partition partition(const double* coordinates, std::size_t n, int levels, const Options& options = {});

 private:
  friend class Locator;
  struct FLAUNAY_LOCAL Implementation;
  // A Locator keeps it, too.
  std::shared_ptr<Implementation> implementation_;
};

/// Finds where queries lie in a triangulation: by a tree down to a vertex nearby, and from there by exact
/// steps from triangle to triangle. Queries are points, as many at once as wanted; of nested triangulations
/// they come in as many sets, each for its own. Shares device and memory with the triangulator that made
/// it, so both are for one thread at a time; it may outlive it. A query that is not finite, or so fine that
/// exactness is beyond doubles, is an Error(input) that names it.
class FLAUNAY_API Locator {
 public:
  /// Of a triangulation with neighbours. Copies what it needs: some 80 bytes of device memory a point. O(n
  /// log n).
  Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
          const Triangulation& triangulation);
  /// The same of several sets.
  Locator(Triangulator& triangulator, const double* coordinates, const std::vector<std::size_t>& offsets,
          const Triangulation& triangulation);
  /// The same of points in device memory, enqueued as Triangulator::triangulate is. Needs the parts
  /// triangles, neighbors, hull and representatives.
  Locator(Triangulator& triangulator, const DevicePoints& points, const DeviceTriangulation& triangulation,
          const Enqueue& enqueue = {});
  /// Releases its memory.
  ~Locator();
  /// What was moved from can only be destroyed or assigned to.
  Locator(Locator&&) noexcept;
  /// Likewise.
  Locator& operator=(Locator&&) noexcept;

  /// For each of m queries, x0 y0 x1 y1 ..., the triangle that it lies in, exactly; on an edge or a vertex
  /// the one of the smallest index of those that it lies in; -1 outside of the hull. About O(log n) a query.
  std::vector<std::int32_t> locate(const double* queries, std::size_t m);
  /// Of several sets: as many sets of queries, their offsets as those of points.
  std::vector<std::int32_t> locate(const double* queries, const std::vector<std::size_t>& offsets);
  /// In device memory, enqueued as Triangulator::triangulate is; triangles: int32, 4 bytes a query.
  void locate(const DevicePoints& queries, DeviceBuffer& triangles, const Enqueue& enqueue = {});

  /// For each query the index of the nearest point, by exact comparisons; of several the first in the order
  /// of x, then y. -1 if the set is empty.
  std::vector<std::int32_t> nearest(const double* queries, std::size_t m);
  /// Of several sets, as locate.
  std::vector<std::int32_t> nearest(const double* queries, const std::vector<std::size_t>& offsets);
  /// In device memory, as locate; points: int32, 4 bytes a query.
  void nearest(const DevicePoints& queries, DeviceBuffer& points, const Enqueue& enqueue = {});

  /// For each query the linear interpolation of its triangle's three values, rounded; at a vertex exactly its
  /// value; NaN outside of the hull. values: one for each input point, of which those of duplicates'
  /// representatives count.
  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m);
  /// Of several sets, as locate; values over all sets.
  std::vector<double> interpolate(const double* values, const double* queries,
                                  const std::vector<std::size_t>& offsets);
  /// In device memory, as locate; values and results: double, 8 bytes a point and a query.
  void interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                   const Enqueue& enqueue = {});

 private:
  struct FLAUNAY_LOCAL Implementation;
  FLAUNAY_LOCAL static std::unique_ptr<Implementation> make(Triangulator& triangulator);
  std::unique_ptr<Implementation> implementation_;
};

/// Of the library, not of the header: "0.1.0". The text is static.
FLAUNAY_API const char* version() noexcept;

}  // namespace flaunay
