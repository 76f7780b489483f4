#include "call/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "call/device_info.hpp"
#include "host/error.hpp"
#include "host/note.hpp"
#include "host/of_thread.hpp"
#include "host/opencl/device.hpp"
#include "host/opencl/program_cache.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "tuning/arithmetic.hpp"
#include "tuning/self_test.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

// Kernels use 32-bit indices. The longest array has up to 6 corners per point, with 3 ids each.
constexpr std::size_t kMostPoints = ((std::size_t{1} << 31) - 1) / 18;
// The most device memory per point that any measured input has needed, including adversarial inputs.
constexpr std::size_t kBytesPerPoint = 320;
constexpr std::size_t kBytesPerPointInRounds = 416;

std::size_t bytes_per_point(const host::Runtime& runtime) {
  return tuning_of(runtime).round_points > 0 ? kBytesPerPointInRounds : kBytesPerPoint;
}

// Calls that need no more memory than this are not checked, because asking the system would take a part of
// their time that can be measured.
constexpr std::size_t kNeverLacking = std::size_t{64} << 20;

// The most points of a call on a device whose loops end early. On any input, loops over so few points were
// seen to need at most a tenth of the steps after which these devices end them.
constexpr std::size_t kMostPointsInShortLoops = 4096;

// The largest number of points that arrays, indices and loops allow, whatever memory is free.
std::size_t largest_call(const host::Runtime& runtime) {
  // An arena may have several blocks, but each array is in one buffer. The largest array has the rings'
  // edges.
  const std::size_t by_arrays =
      runtime.memory().largest / (kernel::EDGES_PER_VERTEX * sizeof(kernel::ring_edge));
  const std::size_t by_loops = runtime.capabilities().loops_end_early ? kMostPointsInShortLoops : kMostPoints;
  return std::min({kMostPoints, by_arrays, by_loops});
}

}  // namespace

Engine::Engine(std::shared_ptr<const Tuning> tuning, std::size_t threads)
    : runtime(std::move(tuning), threads),
      persistent(runtime.memory(), runtime.arena().pool()),
      even(runtime.memory(), runtime.arena().pool()),
      odd(runtime.memory(), runtime.arena().pool()) {}

Engine::Engine(const std::string& tuning) : Engine(native_tuning(tuning)) { check_arithmetic(); }

Engine& Engine::of_thread() {
  struct Own {
    static std::shared_ptr<const Tuning> tuning() {
      const auto own = std::make_shared<Tuning>(*native_tuning());
      // There is nobody to share chunks with.
      own->chunks_most = 1;
      own->chunk_least = std::numeric_limits<std::int32_t>::max();
      return own;
    }
    Engine engine{tuning(), 1};
  };
  return host::of_thread<Own>().engine;
}

Engine::Engine(const boost::compute::context& context, const boost::compute::device& device,
               const std::string& tuning)
    : Engine(context.get() == nullptr ? boost::compute::context(device) : context, device,
             settings_for(device, tuning)) {
  tuning::choose_arithmetic(runtime);
  check_arithmetic();
}

Engine::Engine(const boost::compute::context& context, const boost::compute::device& device,
               host::Settings settings)
    : runtime(context, device, std::move(settings)),
      persistent(runtime.memory(), runtime.arena().pool()),
      even(runtime.memory(), runtime.arena().pool()),
      odd(runtime.memory(), runtime.arena().pool()) {}

std::unique_ptr<Engine> Engine::with_doubles() const {
  const boost::compute::device& device = runtime.device();
  if (!host::has_fp64(device)) return nullptr;
  host::Settings settings{runtime.sizes().copy(), runtime.capabilities()};
  settings.capabilities.fixed_point = false;
  std::unique_ptr<Engine> engine(new Engine(runtime.context(), device, std::move(settings)));
  if (!tuning::self_test_failure(engine->runtime).empty()) return nullptr;
  return engine;
}

bool Engine::has_doubles() const { return !runtime.capabilities().fixed_point; }

void Engine::check_arithmetic() {
  const std::string failure = tuning::make_exact(runtime);
  if (!failure.empty()) {
    throw Error(ErrorKind::device,
                fmt::format("{} cannot be used, its arithmetic is not exact enough: {}; try "
                            "another device (FLAUNAY_DEVICE)",
                            runtime.name(), failure));
  }
}

std::size_t Engine::capacity() const {
  return std::min(largest_call(runtime),
                  usable_memory(runtime, held_at_rest).bytes / bytes_per_point(runtime));
}

void Engine::check_size(std::size_t n) const {
  const std::size_t most = largest_call(runtime);
  if (n <= most && n <= std::max<std::size_t>(kNeverLacking, held_at_rest) / bytes_per_point(runtime)) return;
  const host::MemoryLeft memory = usable_memory(runtime, held_at_rest);
  const std::size_t fitting = std::min(most, memory.bytes / bytes_per_point(runtime));
  if (n <= fitting) return;
  const std::string in_one_piece =
      runtime.is_native() ? "" : fmt::format(", {} in one piece", host::mebibytes(runtime.memory().largest));
  const std::string loops = runtime.capabilities().loops_end_early ? ", and its loops end early" : "";
  throw Error(
      n > kMostPoints ? ErrorKind::input : ErrorKind::device,
      fmt::format("{} points are too many: {} would fit on {} ({} of memory by {}{}, {} bytes a point{})", n,
                  fitting, runtime.name(), host::mebibytes(memory.bytes), memory.limit, in_one_piece,
                  bytes_per_point(runtime), loops));
}

void Engine::use_own_memory() {
  persistent.lend(nullptr, 0, 0);
  runtime.arena().lend(nullptr, 0, 0);
}

void Engine::provide_memory(std::size_t n, std::size_t sets) {
  if (n != counted_points_ || sets != counted_sets_) {
    needed_ = blocks::workspace_bytes(runtime, n, sets);
    counted_points_ = n;
    counted_sets_ = sets;
  }
  const blocks::WorkspaceBytes& needed = needed_;
  if (workspace == nullptr) {
    // Enough for any n points, so that the next call on as many points allocates nothing.
    persistent.reserve(needed.persistent);
    runtime.arena().reserve(needed.scratch);
    return;
  }
  std::size_t size = 0;
  FLAUNAY_CL(clGetMemObjectInfo(workspace.get(), CL_MEM_SIZE, sizeof size, &size, nullptr));
  if (size < needed.persistent + needed.scratch) {
    throw Error(ErrorKind::usage,
                fmt::format("the workspace is too small: it has {} bytes, {} points in {} sets "
                            "need {}",
                            size, n, sets, needed.persistent + needed.scratch));
  }
  persistent.lend(workspace, 0, needed.persistent);
  runtime.arena().lend(workspace, needed.persistent, size - needed.persistent);
}

void Engine::begin_call(bool profile) {
  use_own_memory();
  runtime.use_queue(nullptr, profile);
  reset_accounts();
}

void Engine::reset_accounts() {
  runtime.reset_accounts();
  allocations_before_ = allocations();
}

void Engine::write_accounts(Statistics& statistics) {
  statistics.device_bytes_peak = held_bytes();
  statistics.kernel_launches = runtime.accounts().launches;
  statistics.host_waits = runtime.accounts().waits;
  statistics.bytes_to_device = runtime.accounts().bytes_to_device;
  statistics.bytes_to_host = runtime.accounts().bytes_to_host;
  statistics.device_allocations = allocations() - allocations_before_;
  statistics.build_seconds = runtime.accounts().build_seconds;
  host::append_note(statistics.note, host::take_cache_note());
  for (const auto& [name, time] : runtime.kernel_times()) {
    statistics.kernels.push_back({name, time.launches, time.seconds});
  }
  std::sort(statistics.kernels.begin(), statistics.kernels.end(),
            [](const KernelStatistics& a, const KernelStatistics& b) { return a.seconds > b.seconds; });
}

std::size_t Engine::held_bytes() const {
  return persistent.held_bytes() + even.held_bytes() + odd.held_bytes() + runtime.arena().held_bytes();
}

std::size_t Engine::allocations() const {
  return persistent.block_allocations() + even.block_allocations() + odd.block_allocations() +
         runtime.arena().block_allocations() + buffer_allocations;
}

}  // namespace flaunay::call
