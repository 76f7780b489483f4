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

namespace flaunay {

/// What went wrong, in the terms of the command's exit codes.
enum class ErrorKind {
  usage,     ///< a request that makes no sense (exit code 2)
  input,     ///< bad points: not finite, out of range, too many, unreadable (exit code 3)
  device,    ///< no device, device too small, an OpenCL call failed (exit code 4)
  internal,  ///< a broken invariant of flaunay itself; please report it
};

/// The one exception type of the library.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
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

/// As the command line names them: "recursive-device", "monotone-chain"...
const char* to_string(Mode mode) noexcept;
const char* to_string(Hull hull) noexcept;

/// What a caller can ask of one triangulation.
struct Options {
  Mode mode = Mode::hybrid;
  Cut cut = Cut::interquartile;
  Hull hull = Hull::prune;
  bool neighbors = true;     ///< compute Triangulation::neighbors
  bool profile = false;      ///< time every kernel by events; costs a little
  bool count = false;        ///< count operations into Statistics::work; slow; not in Mode::hybrid
  int partition_levels = 0;  ///< Mode::partition: levels on the device; 0 chooses
  int threads = 0;           ///< Mode::partition: host threads; 0 takes one per core
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
constexpr std::size_t kComponents = 5;

/// What one component did: numbers of operations by kind, and the length of its critical path in operations.
/// See docs/counting.md for what counts, and for how the depth of each vector operation is defined.
struct OperationCounts {
  std::uint64_t arithmetic = 0;    ///< additions, multiplications and comparisons outside of predicates
  std::uint64_t depths = 0;        ///< evaluations of the depth below a chord
  std::uint64_t orientations = 0;  ///< evaluations of the orientation of three points
  std::uint64_t circles = 0;       ///< evaluations of the in-circle test
  std::uint64_t critical_path = 0;

  /// What is done one after the other: critical paths add up too.
  OperationCounts& operator+=(const OperationCounts& other) noexcept;
  /// All as floating-point operations, arithmetic and comparisons: a predicate counts for the operations of
  /// its plain evaluation, without the error bound's.
  std::uint64_t operations() const noexcept;
  /// The same with the operations that bound each predicate's error.
  std::uint64_t operations_with_bounds() const noexcept;
};

/// Options::count: the work by component and level. Level 0 is the first cut (in Mode::dwyer the last merge);
/// start is what precedes it: sorting and the first hulls.
struct Work {
  using Components = std::array<OperationCounts, kComponents>;
  Components start{};
  std::vector<Components> levels;
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
  double seconds = 0;
};

/// Where one kernel's time went (Options::profile).
struct KernelStatistics {
  std::string name;
  std::size_t launches = 0;
  double seconds = 0;
};

/// A named part of the work and its wall time.
struct PhaseStatistics {
  std::string name;
  double seconds = 0;
};

/// How a result came about.
struct Statistics {
  std::string device;
  std::size_t points = 0;      ///< input points
  std::size_t duplicates = 0;  ///< input points that are not their own representative
  std::size_t triangles = 0;
  std::size_t hull_vertices = 0;
  double seconds = 0;        ///< from points in host memory to results in host memory
  double build_seconds = 0;  ///< building programs, part of no other figure
  std::size_t kernel_launches = 0;
  std::size_t host_waits = 0;         ///< times the host waited for the device
  std::size_t device_bytes_peak = 0;  ///< most device memory held at once
  std::size_t undecided = 0;          ///< predicates that needed exact evaluation
  std::vector<PhaseStatistics> phases;
  std::vector<LevelStatistics> levels;
  std::vector<KernelStatistics> kernels;
  Work work;  ///< empty without Options::count
};

/// The triangulations of one or more point sets. All indices are those of the input points, over all sets;
/// triangle indices count over all sets too.
struct Triangulation {
  /// 3 per triangle, counter-clockwise, smallest index first.
  std::vector<std::int32_t> triangles;
  /// 3 per triangle: the triangle opposite to each vertex, -1 beyond the hull. Empty if not asked for.
  std::vector<std::int32_t> neighbors;
  /// The convex hull with the points on its edges, counter-clockwise from the lexicographically smallest
  /// point. Collinear sets: the distinct points in lexicographic order.
  std::vector<std::int32_t> hull;
  /// One per input point: the smallest index of a point of its set with the same coordinates.
  std::vector<std::int32_t> representatives;
  /// Set s has triangles [triangle_offsets[s], triangle_offsets[s + 1]) and likewise hull vertices.
  std::vector<std::size_t> triangle_offsets;
  std::vector<std::size_t> hull_offsets;
  Statistics statistics;
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
  std::vector<Region> regions;
  /// Triangles that are final already, of regions that had no points inside: 3 indices of input points each.
  std::vector<std::int32_t> triangles;
  Statistics statistics;
};

/// Puts a partition together again. solutions: for each region any Delaunay triangulation of its points, 3
/// positions in Region::points per triangle, in either orientation, what lies outside the border included.
/// The result is that of triangulate. Throws Error(input) if a solution is not a triangulation of its
/// region's points. Uses no device.
Triangulation assemble(const double* coordinates, std::size_t n, const Partition& partition,
                       const std::vector<std::vector<std::int32_t>>& solutions, const Options& options = {});

/// Mode::recursive and Mode::dwyer without a device. Throws Error(usage) for another mode.
Triangulation triangulate_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Options& options);

/// What the library says of an OpenCL device.
struct DeviceInfo {
  std::string name;  ///< as FLAUNAY_DEVICE matches it
  std::string platform;
  std::string vendor;
  std::string driver;
  std::string version;
  std::string type;  ///< "CPU", "GPU", "accelerator"
  unsigned compute_units = 0;
  unsigned clock_mhz = 0;
  std::size_t memory_bytes = 0;
  std::size_t largest_buffer_bytes = 0;
  std::size_t local_memory_bytes = 0;
  std::size_t work_group_size = 0;
  bool fp64 = false;
  /// Empty if the arithmetic self test passed, else what failed. Only filled if it was asked for.
  std::string self_test_failure;
  bool self_test_passed = false;
};

/// Every device of every platform, in the order that "#k" counts. Throws Error(device) if there is no OpenCL
/// platform. With self_test, builds and runs the arithmetic self test on each device that has fp64.
std::vector<DeviceInfo> list_devices(bool self_test = false);

/// Owns a device's context, queue, programs and memory; reusable, movable, one thread at a time.
class Triangulator {
 public:
  /// device: "" (FLAUNAY_DEVICE if set, else the first GPU, else the first device with fp64),
  /// "#k" (the k-th of list_devices, from 0), or a part of a device's or platform's name, whatever its case.
  /// Throws Error(device) if there is none, or if its arithmetic fails the self test.
  explicit Triangulator(const std::string& device = "");
  ~Triangulator();
  Triangulator(Triangulator&&) noexcept;
  Triangulator& operator=(Triangulator&&) noexcept;

  DeviceInfo device() const;

  /// The largest number of points that one call can take on this device.
  std::size_t capacity() const;

  /// Triangulates one set of points. coordinates: x0 y0 x1 y1 ..., n points.
  /// Throws Error(input) for a coordinate that is not finite, a range of magnitudes beyond what is exact, or
  /// too many points. O(n log n) work.
  Triangulation triangulate(const double* coordinates, std::size_t n, const Options& options = {});

  /// Triangulates many sets at once: set s has points [offsets[s], offsets[s + 1]); offsets[0] is 0 and the
  /// last offset the number of points; sets may be empty.
  Triangulation triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options = {});

  /// The regions after `levels` levels, up to 2^levels of them; O(levels n) work after sorting. Options::mode
  /// and count mean nothing here.
  Partition partition(const double* coordinates, std::size_t n, int levels, const Options& options = {});

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// "0.1.0"
const char* version() noexcept;

}  // namespace flaunay
