#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "flattened/device_info.hpp"
#include "flattened/errors.hpp"
#include "flattened/implementation.hpp"
#include "flattened/partition.hpp"
#include "flattened/self_test.hpp"
#include "flattened/stages.hpp"
#include "host/clock.hpp"
#include "host/device.hpp"
#include "recursive/counter.hpp"
#include "recursive/halfedges.hpp"
#include "recursive/mesh.hpp"
#include "recursive/phases.hpp"
#include "recursive/regions.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;
using host::now;

namespace {

// Kernels index with 32-bit integers: at most 6 corners a point, of 3 ids each.
constexpr std::size_t kMostPoints = ((std::size_t{1} << 31) - 1) / 18;
// What the arenas are made to hold for each input point; enough for points in general position
// (docs/performance.md). An input that needs more gets further blocks.
constexpr std::size_t kPersistentBytesPerPoint = 54;
constexpr std::size_t kStateBytesPerPoint = 37;  // twice: of the level at work and of the next
constexpr std::size_t kScratchBytesPerPoint = 118;
// Shares of its time, for progress.
constexpr double kBlocksMade = 0.15;
constexpr double kTriangulated = 0.8;
// The most that any input measured has needed, those made to be bad among them.
constexpr std::size_t kBytesPerPoint = 320;

boost::compute::device checked_device(const boost::compute::device& device) {
  if (host::has_fp64(device)) return device;
  throw host::DeviceError(fmt::format(
      "{} has no double precision (fp64), which exactness needs; flaunay devices lists the others",
      device.name()));
}

boost::compute::context context_of(const boost::compute::device& device) {
  return boost::compute::context(checked_device(device));
}

// Memory for so many rows of three, for the time that the device is busy: page faults would cost more than
// the writing.
void reserve_rows(std::vector<std::int32_t>& values, std::size_t rows, bool is_wanted) {
  if (!is_wanted) return;
  values.reserve(3 * rows);
  host::prefer_huge_pages(values.data(), 3 * rows * sizeof(std::int32_t));
  values.resize(3 * rows);
}

// Touched memory that stays unused is given back if it is much.
void cut_rows(std::vector<std::int32_t>& values, std::size_t rows, bool is_wanted) {
  if (!is_wanted) return;
  values.resize(3 * rows);
  if (values.capacity() / 2 > 3 * rows) values.shrink_to_fit();
}

}  // namespace

namespace flattened {

Buffer<cl_int> pack_undecided(Workspace& work, const Buffer<cl_uchar>& flags, std::size_t n) {
  const auto list = work.scratch().allocate<cl_int>(n);
  host::pack_positions(work.runtime, flags, n, 2, list, work.list_length);
  work.runtime.launch("pack", "add_count", 1, 1, work.list_length, work.undecided);
  return list;
}

void check_invariants(Workspace& work) {
  const cl_int bits = work.runtime.read_one(work.broken, 0);
  if (bits == 0) return;
  std::string what;
  if (bits & 1) what += " a point on a cut line is not on its path;";
  if (bits & 2) what += " a region's border does not enclose it;";
  if (bits & 4) what += " an edge is not Delaunay;";
  throw Error(ErrorKind::internal, fmt::format("broken invariant:{} please report the input", what));
}

}  // namespace flattened

Triangulator::Implementation::Implementation(const std::string& wanted)
    : Implementation(boost::compute::context(), host::find_device(wanted)) {}

Triangulator::Implementation::Implementation(const boost::compute::context& context,
                                             const boost::compute::device& device)
    : runtime(context.get() == nullptr ? context_of(device) : context, checked_device(device)),
      persistent(runtime.context(), runtime.device()),
      even(runtime.context(), runtime.device()),
      odd(runtime.context(), runtime.device()) {
  if (runtime.tuning().separate_buffers) {
    for (Arena* arena : {&persistent, &even, &odd}) arena->separate_buffers();
  }
  const std::string failure = flattened::self_test_failure(runtime);
  if (!failure.empty()) {
    throw Error(ErrorKind::device,
                fmt::format("{} cannot be used, its arithmetic is not exact enough: {}; try "
                            "another device (FLAUNAY_DEVICE)",
                            runtime.device().name(), failure));
  }
}

std::size_t Triangulator::Implementation::capacity() const {
  const std::size_t by_memory = runtime.device().global_memory_size() / kBytesPerPoint;
  // The arenas are made of blocks, but one array must be in one piece: at most the edges of rings.
  const std::size_t by_buffer =
      runtime.device().max_memory_alloc_size() / (hybrid::kEdgesPerVertex * sizeof(hybrid::RingEdge));
  return std::min({kMostPoints, by_memory, by_buffer});
}

std::size_t Triangulator::Implementation::held_bytes() {
  return persistent.held_bytes() + even.held_bytes() + odd.held_bytes() + runtime.arena().held_bytes();
}

std::size_t Triangulator::Implementation::allocations() {
  return persistent.block_allocations() + even.block_allocations() + odd.block_allocations() +
         runtime.arena().block_allocations() + buffer_allocations;
}

// One call: the accounts, the arenas' contents and the points, sorted.
struct Triangulator::Implementation::Call {
  Call(Implementation& owner, const double* coordinates, const std::vector<std::size_t>& offsets,
       const Options& wanted, Statistics& statistics, std::vector<std::int32_t>& representatives);

  void end_phase(const char* name) {
    const double time = now();
    work.statistics.phases.push_back({name, time - phase_begin});
    phase_begin = time;
  }
  void report(const char* stage, double done) const {
    if (options.progress) options.progress(stage, -1, done);
  }
  /// After the last level: invariants, the largest regions, the counts.
  void end_levels(std::size_t done, std::size_t wanted);
  void finish_statistics();

  const double begin = now();
  double phase_begin = begin;
  Implementation& owner;
  const Options& options;
  Arena::Scope scope;
  flattened::Workspace work;
  std::unique_ptr<flattened::Counting> counting;
  flattened::PointTable table;
};

Triangulator::Implementation::Call::Call(Implementation& owner_, const double* coordinates,
                                         const std::vector<std::size_t>& offsets, const Options& wanted,
                                         Statistics& statistics, std::vector<std::int32_t>& representatives)
    : owner(owner_),
      options(wanted),
      scope(owner_.persistent),
      work{owner_.runtime, owner_.persistent, statistics} {
  const std::size_t n = offsets.back();
  host::Runtime& runtime = owner.runtime;
  Arena& persistent = owner.persistent;
  owner.begin_accounts(options.profile);
  persistent.reserve(n * kPersistentBytesPerPoint);
  owner.even.reserve(n * kStateBytesPerPoint);
  owner.odd.reserve(n * kStateBytesPerPoint);
  runtime.arena().reserve(n * kScratchBytesPerPoint);
  work.hull = options.hull;
  work.broken = persistent.allocate<cl_int>(1);
  work.list_length = persistent.allocate<cl_uint>(1);
  work.undecided = persistent.allocate<cl_uint>(1);
  work.largest = persistent.allocate<cl_int>(flattened::kMostLevels);
  runtime.fill(work.largest, flattened::kMostLevels, cl_int{0});
  runtime.fill(work.broken, 1, cl_int{0});
  runtime.fill(work.undecided, 1, cl_uint{0});
  if (options.count) {
    counting = std::make_unique<flattened::Counting>(runtime, persistent, statistics.work);
    work.counting = counting.get();
  }
  report("sorting", 0.0);
  representatives.resize(n);
  table = ingest(work, coordinates, offsets, representatives.data());
  if (counting) {
    const std::vector<cl_int> distinct = read_all(work, table.set_offsets, table.sets + 1);
    counting->add_sort(offsets);
    counting->add_sort({distinct.begin(), distinct.end()});
  }
  statistics.device = runtime.device().name();
  statistics.points = n;
  statistics.duplicates = n - table.count;
  end_phase("sort");
  report("borders", 0.05);
}

void Triangulator::Implementation::Call::end_levels(std::size_t done, std::size_t wanted) {
  check_invariants(work);
  auto& levels = work.statistics.levels;
  const std::vector<cl_int> largest = read_all(work, work.largest, levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    levels[l].largest_region = static_cast<std::size_t>(largest[l]);
  }
  if (done != wanted) {
    throw Error(ErrorKind::internal,
                fmt::format("{} triangles instead of {}; please report the input", done, wanted));
  }
  if (counting) counting->finish();
  // What follows is the same for every mode and is not counted.
  work.counting = nullptr;
  counting.reset();
}

void Triangulator::Implementation::Call::finish_statistics() {
  Statistics& statistics = work.statistics;
  statistics.undecided = owner.runtime.read_one(work.undecided, 0);
  owner.write_accounts(statistics);
  statistics.seconds = now() - begin;
}

void Triangulator::Implementation::begin_accounts(bool profile) {
  own_memory().use_queue(nullptr, profile);
  reset_accounts();
}

void Triangulator::Implementation::reset_accounts() {
  runtime.reset_accounts();
  allocations_before = allocations();
}

void Triangulator::Implementation::write_accounts(Statistics& statistics) {
  statistics.device_bytes_peak = held_bytes();
  statistics.kernel_launches = runtime.launches();
  statistics.host_waits = runtime.waits();
  statistics.bytes_to_device = runtime.bytes_to_device();
  statistics.bytes_to_host = runtime.bytes_to_host();
  statistics.device_allocations = allocations() - allocations_before;
  statistics.build_seconds = runtime.build_seconds();
  for (const auto& [name, time] : runtime.kernel_times()) {
    statistics.kernels.push_back({name, time.launches, time.seconds});
  }
  std::sort(statistics.kernels.begin(), statistics.kernels.end(),
            [](const KernelStatistics& a, const KernelStatistics& b) { return a.seconds > b.seconds; });
}

void Triangulator::Implementation::check_size(std::size_t n) const {
  if (n <= capacity()) return;
  throw Error(
      n > kMostPoints ? ErrorKind::input : ErrorKind::device,
      fmt::format("{} points are too many: {} would fit on {} ({} bytes of memory, {} in one piece, {} "
                  "bytes a point)",
                  n, capacity(), runtime.device().name(), runtime.device().global_memory_size(),
                  runtime.device().max_memory_alloc_size(), kBytesPerPoint));
}

void Triangulator::Implementation::check_request(std::size_t n, const Options& options) const {
  if (options.hull == Hull::monotone_chain) {
    throw Error(ErrorKind::usage, "monotone-chain hulls are computed by mode recursive only");
  }
  if (options.count && options.mode == Mode::hybrid) {
    throw Error(ErrorKind::usage, "mode hybrid does not count operations; take flattened");
  }
  check_size(n);
}

Buffer<cl_double> Triangulator::Implementation::on_device(const HostPoints& points, std::size_t n) {
  if (points.wide != nullptr) return runtime.view(points.wide, 2 * n);
  const auto wide = runtime.arena().allocate<cl_double>(2 * n);
  Arena::Scope scope(runtime.arena());
  runtime.map("ingest", "widen_points", n, cl_ulong{0}, runtime.view(points.narrow, 2 * n), wide);
  return wide;
}

Triangulation Triangulator::Implementation::triangulate(const HostPoints& points,
                                                        const std::vector<std::size_t>& offsets,
                                                        const Options& options) {
  check_offsets(offsets);
  const std::size_t n = offsets.back();
  if (points.narrow == nullptr) check_coordinates(points.wide, n);
  Triangulation result;
  result.statistics.device = runtime.device().name();
  result.triangle_offsets.assign(offsets.size(), 0);
  result.hull_offsets.assign(offsets.size(), 0);
  if (options.mode == Mode::hybrid) {
    check_request(n, options);
    if (n > 0) hybrid(points, offsets, options, result);
    return result;
  }
  std::vector<double> widened;
  if (points.narrow != nullptr) widened.assign(points.narrow, points.narrow + 2 * n);
  const double* coordinates = points.narrow != nullptr ? widened.data() : points.wide;
  if (options.mode == Mode::recursive || options.mode == Mode::dwyer) {
    return triangulate_on_host(coordinates, offsets, options);
  }
  check_request(n, options);
  if (n > 0) level_by_level(coordinates, offsets, options, result);
  return result;
}

void Triangulator::Implementation::level_by_level(const double* coordinates,
                                                  const std::vector<std::size_t>& offsets,
                                                  const Options& options, Triangulation& result) {
  using namespace flattened;
  Statistics& statistics = result.statistics;
  Call call(*this, coordinates, offsets, options, statistics, result.representatives);
  Workspace& work = call.work;
  PointTable& table = call.table;
  Recursion recursion(work, table, options, {&even, &odd});
  const Borders borders = recursion.begin();
  call.end_phase("borders");
  if (options.mode == Mode::partition) {
    finish_partition(call, recursion, borders, result);
  } else {
    if (options.mode == Mode::flattened) {
      recursion.flattened();
    } else {
      recursion.recursive();
    }
    call.end_levels(recursion.done(), borders.triangles);
    call.end_phase("levels");
    call.report("canonical form", 0.9);
    write_result(call, recursion.triangles(), borders, result);
  }
  statistics.triangles = borders.triangles;
  statistics.hull_vertices = borders.size;
  call.finish_statistics();
}

void Triangulator::Implementation::hybrid(const HostPoints& points, const std::vector<std::size_t>& offsets,
                                          const Options& options, Triangulation& result) {
  const std::size_t n = offsets.back();
  recursive::Phases phases(options);
  begin_accounts(options.profile);
  if (workspace != nullptr) provide_workspace(n, offsets.size() - 1);
  Arena::Scope scope(persistent), scratch_scope(runtime.arena());
  persistent.reserve(n * hybrid::kPersistentBytesPerPoint);
  hybrid::Workspace work{runtime, persistent};
  result.statistics.points = n;
  hybrid::Rings rings;
  const host::Runtime::Settled settled(runtime);

  phases.progress("blocks", 0);
  result.representatives.resize(n);
  const auto representatives = runtime.output(result.representatives);
  const hybrid::Blocks blocks = [&] {
    Arena::Scope input_scope(runtime.arena());
    return make_blocks(work, on_device(points, n), offsets, representatives);
  }();
  phases.end("blocks");
  phases.progress("triangulate", kBlocksMade);
  rings = divide(work, blocks, representatives);
  // A vertex is the middle one of two triangles at most.
  reserve_rows(result.triangles, 2 * n, true);
  reserve_rows(result.neighbors, 2 * n, options.neighbors);
  reserve_rows(result.halfedges, 2 * n, options.halfedges);
  await_rings(work, blocks, rings);
  runtime.fetch_later(representatives, result.representatives);
  phases.end("triangulate");
  phases.progress("output", kTriangulated);

  hybrid::MeshSizes sizes = count_mesh(work, blocks, rings);
  cut_rows(result.triangles, sizes.triangles(), true);
  cut_rows(result.neighbors, sizes.triangles(), options.neighbors);
  cut_rows(result.halfedges, sizes.triangles(), options.halfedges);
  result.hull.resize(sizes.hull_vertices());
  const auto output = [&](std::vector<std::int32_t>& values, bool is_wanted) {
    return is_wanted ? runtime.output(values) : Buffer<cl_int>();
  };
  const hybrid::MeshBuffers buffers{output(result.triangles, true),
                                    output(result.neighbors, options.neighbors),
                                    output(result.halfedges, options.halfedges), output(result.hull, true)};
  write_mesh(work, blocks, rings, sizes, buffers);
  runtime.fetch_later(buffers.triangles, result.triangles);
  runtime.fetch_later(buffers.neighbors, result.neighbors);
  runtime.fetch_later(buffers.halfedges, result.halfedges);
  runtime.fetch_later(buffers.hull, result.hull);
  runtime.finish();
  phases.end("output");

  result.triangle_offsets = std::move(sizes.triangle_offsets);
  result.hull_offsets = std::move(sizes.hull_offsets);
  result.statistics.duplicates = n - sizes.vertices;
  result.statistics.undecided = rings.undecided;
  result.statistics.triangles = result.triangle_offsets.back();
  result.statistics.hull_vertices = result.hull_offsets.back();
  write_accounts(result.statistics);
  phases.write(result.statistics);
  phases.progress("output", 1);
}

// A few levels on the device, the rest and the canonical form on the host, where the triangles are then.
void Triangulator::Implementation::finish_partition(Call& call, flattened::Recursion& recursion,
                                                    const flattened::Borders& borders,
                                                    Triangulation& result) {
  using namespace flattened;
  const Options& options = call.options;
  recursion.flattened(partition_levels(call.table.input_count, options));
  const recursive::PointSets sets = to_host(call.work, call.table, result.representatives);
  std::vector<std::int32_t> triangles = recursion.read_triangles();
  const recursive::RegionArrays regions = recursion.read_regions();
  call.end_phase("partition");
  call.report("regions", 0.4);
  OperationCounts counts;
  const std::vector<std::int32_t> solved = recursive::solve_regions(
      sets.predicates, sets.points.data(), regions, options.threads, options.count ? &counts : nullptr);
  triangles.insert(triangles.end(), solved.begin(), solved.end());
  call.end_levels(triangles.size() / 3, borders.triangles);
  Work& work = result.statistics.work;
  Work::Components& last = work.levels.empty() ? work.start : work.levels.back();
  recursive::add_beside(last[static_cast<std::size_t>(Component::endgame)], counts);
  call.end_phase("regions");
  call.report("canonical form", 0.9);
  Triangulation finished = recursive::finish(sets, std::move(triangles), {}, options);
  finished.statistics = std::move(result.statistics);
  result = std::move(finished);
  call.end_phase("canonical form");
}

Partition Triangulator::Implementation::partition(const double* coordinates, std::size_t n, int levels,
                                                  const Options& options) {
  using namespace flattened;
  if (levels < 0) throw Error(ErrorKind::usage, "a partition's number of levels cannot be negative");
  Options uncounted = options;
  uncounted.count = false;
  check_request(n, uncounted);
  check_coordinates(coordinates, n);
  Partition result;
  result.statistics.device = runtime.device().name();
  if (n == 0) return result;
  std::vector<std::int32_t> representatives;
  Call call(*this, coordinates, {0, n}, uncounted, result.statistics, representatives);
  Recursion recursion(call.work, call.table, uncounted, {&even, &odd});
  const Borders borders = recursion.begin();
  call.end_phase("borders");
  recursion.flattened(std::min<int>(levels, kMostLevels));
  check_invariants(call.work);
  result.regions = to_input(call.work, call.table, recursion.read_regions());
  const std::size_t rows = 3 * recursion.done();
  const auto triangles = call.work.scratch().allocate<cl_int>(rows);
  runtime.map("output", "map_ids", rows, recursion.triangles(), call.table.source, triangles);
  result.triangles = read_all(call.work, triangles, rows);
  call.end_phase("levels");
  result.statistics.triangles = borders.triangles;
  result.statistics.hull_vertices = borders.size;
  call.finish_statistics();
  return result;
}

void Triangulator::Implementation::write_result(Call& call, const Buffer<cl_int>& triangles,
                                                const flattened::Borders& borders, Triangulation& result) {
  using namespace flattened;
  const std::size_t triangle_count = borders.triangles;
  Workspace& work = call.work;
  const PointTable& table = call.table;
  const Options& options = call.options;
  const std::size_t sets = table.sets;
  const std::size_t rows = 3 * triangle_count;
  {
    Arena::Scope scope(work.scratch());
    if (sets > 1) {
      Arena::Scope sort_scope(work.scratch());
      const auto keys = work.scratch().allocate<cl_ulong>(triangle_count);
      const auto order = work.scratch().allocate<cl_int>(triangle_count);
      const auto counts = work.scratch().allocate<cl_uint>(sets);
      const auto unsorted = work.scratch().allocate<cl_int>(rows);
      runtime.fill(counts, sets, cl_uint{0});
      runtime.map("output", "triangle_sets", triangle_count, triangles, table.set_of_id, keys, order, counts);
      host::sort_by_key(runtime, keys, order, triangle_count);
      runtime.copy(triangles, 0, unsorted, 0, rows);
      runtime.map("output", "reorder_triangles", triangle_count, order, unsorted, triangles);
      std::vector<cl_uint> host_counts(sets);
      runtime.read(counts, 0, sets, host_counts.data());
      for (std::size_t s = 0; s < sets; ++s) {
        result.triangle_offsets[s + 1] = result.triangle_offsets[s] + host_counts[s];
      }
    } else {
      result.triangle_offsets[1] = triangle_count;
    }
    const auto twins = work.scratch().allocate<cl_int>(rows);
    match_edges(work, triangles, triangle_count, twins);
    canonicalize(work, table, triangles, triangle_count, twins);
    check_invariants(work);
    call.end_phase("canonical form");

    call.report("output", 0.95);
    const auto output = work.scratch().allocate<cl_int>(rows);
    const bool with_neighbors = options.neighbors || options.halfedges;
    const auto neighbors = work.scratch().allocate<cl_int>(with_neighbors ? rows : 0);
    runtime.map("output", "finish_rows", triangle_count, cl_int{with_neighbors}, triangles, twins,
                table.source, output, neighbors);
    result.triangles.resize(rows);
    runtime.read(output, 0, rows, result.triangles.data());
    if (with_neighbors) {
      result.neighbors.resize(rows);
      runtime.read(neighbors, 0, rows, result.neighbors.data());
      recursive::write_halfedges(options, result);
    }
    const auto hull = work.scratch().allocate<cl_int>(borders.size);
    runtime.map("output", "map_ids", borders.size, borders.hull, table.source, hull);
    result.hull.resize(borders.size);
    runtime.read(hull, 0, borders.size, result.hull.data());
    result.hull_offsets = borders.hull_offsets;
  }
  call.end_phase("output");
}

Triangulator::Triangulator(const std::string& device)
    : implementation_(with_errors([&] { return std::make_shared<Implementation>(device); })) {}
Triangulator::~Triangulator() {
  // A locator may keep the device, but what was enqueued here is to be done. Errors can be told to nobody.
  if (implementation_) clFinish(implementation_->runtime.queue());
}
Triangulator::Triangulator(Triangulator&&) noexcept = default;
Triangulator& Triangulator::operator=(Triangulator&&) noexcept = default;

DeviceInfo Triangulator::device() const {
  return with_errors([&] {
    DeviceInfo info = flattened::describe(implementation_->runtime.device());
    info.self_test_passed = true;
    return info;
  });
}

std::size_t Triangulator::capacity() const {
  return with_errors([&] { return implementation_->capacity(); });
}

Triangulation Triangulator::triangulate(const double* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const float* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  return with_errors([&] { return implementation_->triangulate({coordinates, nullptr}, offsets, options); });
}

Triangulation Triangulator::triangulate(const float* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  return with_errors([&] { return implementation_->triangulate({nullptr, coordinates}, offsets, options); });
}

Partition Triangulator::partition(const double* coordinates, std::size_t n, int levels,
                                  const Options& options) {
  return with_errors([&] { return implementation_->partition(coordinates, n, levels, options); });
}

const char* to_string(Mode mode) noexcept {
  switch (mode) {
    case Mode::hybrid:
      return "hybrid";
    case Mode::flattened:
      return "flattened";
    case Mode::recursive_device:
      return "recursive-device";
    case Mode::recursive:
      return "recursive";
    case Mode::partition:
      return "partition";
    case Mode::dwyer:
      return "dwyer";
  }
  return "";
}

const char* to_string(Hull hull) noexcept {
  switch (hull) {
    case Hull::prune:
      return "prune";
    case Hull::quickhull:
      return "quickhull";
    case Hull::balanced:
      return "balanced";
    case Hull::monotone_chain:
      return "monotone-chain";
  }
  return "";
}

const char* version() noexcept { return FLAUNAY_VERSION; }

}  // namespace flaunay
