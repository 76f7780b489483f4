#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "flattened/device_info.hpp"
#include "flattened/self_test.hpp"
#include "flattened/stages.hpp"
#include "host/device.hpp"

namespace flaunay {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Kernels index with 32-bit integers: at most 6 corners a point, of 3 ids each.
constexpr std::size_t kMostPoints = ((std::size_t{1} << 31) - 1) / 18;
// What the arenas are made to hold for each input point; enough for all inputs measured
// (docs/performance.md). An input that needs more gets further blocks.
constexpr std::size_t kPersistentBytesPerPoint = 54;
constexpr std::size_t kStateBytesPerPoint = 37;  // twice: of the level at work and of the next
constexpr std::size_t kScratchBytesPerPoint = 170;
constexpr std::size_t kBytesPerPoint =
    kPersistentBytesPerPoint + 2 * kStateBytesPerPoint + kScratchBytesPerPoint;

host::Runtime make_runtime(const std::string& wanted) {
  try {
    const boost::compute::device device = host::find_device(wanted);
    if (!host::has_fp64(device)) {
      throw host::DeviceError(
          fmt::format("{} has no double precision (fp64), which exactness needs; "
                      "flaunay devices lists the others",
                      device.name()));
    }
    return host::Runtime(device);
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what());
  } catch (const boost::compute::opencl_error& error) {
    throw Error(ErrorKind::device,
                fmt::format("{} ({})", error.what(), host::error_name(error.error_code())));
  }
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

struct Triangulator::Implementation {
  explicit Implementation(const std::string& wanted)
      : runtime(make_runtime(wanted)),
        persistent(runtime.context(), runtime.device()),
        even(runtime.context(), runtime.device()),
        odd(runtime.context(), runtime.device()) {
    if (runtime.tuning().separate_buffers) {
      for (host::Arena* arena : {&persistent, &even, &odd}) arena->separate_buffers();
    }
    const std::string failure = flattened::self_test_failure(runtime);
    if (!failure.empty()) {
      throw Error(ErrorKind::device,
                  fmt::format("{} cannot be used, its arithmetic is not exact enough: {}; try "
                              "another device (FLAUNAY_DEVICE)",
                              runtime.device().name(), failure));
    }
  }

  std::size_t capacity() const {
    const std::size_t by_memory = runtime.device().global_memory_size() / kBytesPerPoint;
    // The arenas are made of blocks, but one array must be in one piece: at most 48 bytes a point, in strips.
    const std::size_t by_buffer = runtime.device().max_memory_alloc_size() / 48;
    return std::min({kMostPoints, by_memory, by_buffer});
  }

  std::size_t held_bytes() {
    return persistent.held_bytes() + even.held_bytes() + odd.held_bytes() + runtime.arena().held_bytes();
  }

  Triangulation triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                            const Options& options);

  host::Runtime runtime;
  host::Arena persistent, even, odd;
};

Triangulation Triangulator::Implementation::triangulate(const double* coordinates,
                                                        const std::vector<std::size_t>& offsets,
                                                        const Options& options) {
  using namespace flattened;
  const double begin = now();
  check_offsets(offsets);
  const std::size_t n = offsets.back();
  const std::size_t sets = offsets.size() - 1;
  if (n > capacity()) {
    throw Error(
        n > kMostPoints ? ErrorKind::input : ErrorKind::device,
        fmt::format("{} points are too many: {} would fit on {} ({} bytes of memory, {} in one piece, {} "
                    "bytes a point)",
                    n, capacity(), runtime.device().name(), runtime.device().global_memory_size(),
                    runtime.device().max_memory_alloc_size(), kBytesPerPoint));
  }
  Triangulation result;
  Statistics& statistics = result.statistics;
  statistics.device = runtime.device().name();
  statistics.points = n;
  result.representatives.resize(n);
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);
  if (n == 0) return result;

  runtime.reset_accounts();
  runtime.set_profiling(options.profile);
  persistent.reserve(n * kPersistentBytesPerPoint);
  even.reserve(n * kStateBytesPerPoint);
  odd.reserve(n * kStateBytesPerPoint);
  runtime.arena().reserve(n * kScratchBytesPerPoint);
  double phase_begin = begin;
  const auto end_phase = [&](const char* name) {
    const double time = now();
    statistics.phases.push_back({name, time - phase_begin});
    phase_begin = time;
  };
  const auto report = [&](const char* stage, int level, double done) {
    if (options.progress) options.progress(stage, level, done);
  };

  Arena::Scope persistent_scope(persistent);
  Workspace work{runtime, persistent, &even, &odd, statistics};
  work.broken = persistent.allocate<cl_int>(1);
  work.list_length = persistent.allocate<cl_uint>(1);
  work.undecided = persistent.allocate<cl_uint>(1);
  work.largest = persistent.allocate<cl_int>(kMostLevels);
  runtime.fill(work.largest, kMostLevels, cl_int{0});
  runtime.fill(work.broken, 1, cl_int{0});
  runtime.fill(work.undecided, 1, cl_uint{0});
  report("sorting", -1, 0.0);
  PointTable table = ingest(work, coordinates, offsets, result.representatives.data());
  for (std::size_t i = 0; i < n; ++i)
    statistics.duplicates += result.representatives[i] != static_cast<cl_int>(i);
  end_phase("sort");

  report("borders", -1, 0.05);
  Level level, next;
  RetiredRegions retired;
  // The first regions are made in the even arena.
  std::swap(work.state, work.next_state);
  auto state_scope = std::make_unique<Arena::Scope>(*work.next_state);
  const Borders borders = initial_borders(work, table, level, retired);
  const std::size_t triangle_count = borders.triangles;
  const auto triangles = persistent.allocate<cl_int>(3 * triangle_count);
  std::size_t done = endgame(work, table, retired, triangles, 0);
  end_phase("borders");

  const std::size_t internal_points = level.points;
  for (int depth = 0; level.regions > 0; ++depth) {
    const double level_begin = now();
    std::swap(work.state, work.next_state);
    auto next_scope = std::make_unique<Arena::Scope>(*work.next_state);
    {
      Arena::Scope scope(work.scratch());
      LevelStatistics level_statistics;
      level_statistics.regions = level.regions;
      level_statistics.internal_points = level.points;
      level_statistics.corners = level.corners;
      cut(work, table, level, depth, options.cut == Cut::alternate ? depth % 2 : -1);
      const Paths paths = hulls(work, table, level, level_statistics);
      level_statistics.path_vertices = paths.size;
      next = Level{};
      merge(work, table, level, paths, next, retired);
      done += endgame(work, table, retired, triangles, done);
      level_statistics.seconds = now() - level_begin;
      statistics.levels.push_back(level_statistics);
    }
    level = next;
    state_scope = std::move(next_scope);
    report("levels", depth,
           0.1 + 0.8 * (1.0 - static_cast<double>(level.points) /
                                  static_cast<double>(std::max<std::size_t>(1, internal_points))));
  }
  state_scope.reset();
  check_invariants(work);
  std::vector<cl_int> largest(statistics.levels.size());
  runtime.read(work.largest, 0, largest.size(), largest.data());
  for (std::size_t l = 0; l < largest.size(); ++l)
    statistics.levels[l].largest_region = static_cast<std::size_t>(largest[l]);
  if (done != triangle_count) {
    throw Error(ErrorKind::internal,
                fmt::format("{} triangles instead of {}; please report the input", done, triangle_count));
  }
  end_phase("levels");

  report("canonical form", -1, 0.9);
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
    end_phase("canonical form");

    report("output", -1, 0.95);
    const auto output = work.scratch().allocate<cl_int>(rows);
    const auto neighbors = work.scratch().allocate<cl_int>(options.neighbors ? rows : 0);
    runtime.map("output", "finish_rows", triangle_count, cl_int{options.neighbors}, triangles, twins,
                table.source, output, neighbors);
    result.triangles.resize(rows);
    runtime.read(output, 0, rows, result.triangles.data());
    if (options.neighbors) {
      result.neighbors.resize(rows);
      runtime.read(neighbors, 0, rows, result.neighbors.data());
    }
    const auto hull = work.scratch().allocate<cl_int>(borders.size);
    runtime.map("output", "map_ids", borders.size, borders.hull, table.source, hull);
    result.hull.resize(borders.size);
    runtime.read(hull, 0, borders.size, result.hull.data());
    result.hull_offsets = borders.hull_offsets;
  }
  end_phase("output");

  statistics.triangles = triangle_count;
  statistics.hull_vertices = borders.size;
  statistics.undecided = runtime.read_one(work.undecided, 0);
  statistics.device_bytes_peak = held_bytes();
  statistics.kernel_launches = runtime.launches();
  statistics.host_waits = runtime.waits();
  statistics.build_seconds = runtime.build_seconds();
  for (const auto& [name, time] : runtime.kernel_times()) {
    statistics.kernels.push_back({name, time.launches, time.seconds});
  }
  std::sort(statistics.kernels.begin(), statistics.kernels.end(),
            [](const KernelStatistics& a, const KernelStatistics& b) { return a.seconds > b.seconds; });
  statistics.seconds = now() - begin;
  return result;
}

Triangulator::Triangulator(const std::string& device)
    : implementation_(std::make_unique<Implementation>(device)) {}
Triangulator::~Triangulator() = default;
Triangulator::Triangulator(Triangulator&&) noexcept = default;
Triangulator& Triangulator::operator=(Triangulator&&) noexcept = default;

DeviceInfo Triangulator::device() const {
  DeviceInfo info = flattened::describe(implementation_->runtime.device());
  info.self_test_passed = true;
  return info;
}

std::size_t Triangulator::capacity() const { return implementation_->capacity(); }

Triangulation Triangulator::triangulate(const double* coordinates, std::size_t n, const Options& options) {
  return triangulate(coordinates, std::vector<std::size_t>{0, n}, options);
}

Triangulation Triangulator::triangulate(const double* coordinates, const std::vector<std::size_t>& offsets,
                                        const Options& options) {
  try {
    return implementation_->triangulate(coordinates, offsets, options);
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what());
  } catch (const boost::compute::opencl_error& error) {
    throw Error(ErrorKind::device, fmt::format("{} ({})", error.what(), host::error_name(error.error_code())));
  }
}

const char* version() noexcept { return FLAUNAY_VERSION; }

}  // namespace flaunay
