#include "call/insert_segments.hpp"

#include <algorithm>

#include "call/frame.hpp"
#include "constrained/crossings/first_crossing.hpp"
#include "geometry/magnitudes.hpp"
#include "host/note.hpp"
#include "host/of_thread.hpp"
#include "statistics/phases.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

// Adds what one step of a call did to what others did.
void add(const Statistics& step, Statistics& all) {
  all.build_seconds += step.build_seconds;
  all.kernel_launches += step.kernel_launches;
  all.host_waits += step.host_waits;
  all.bytes_to_device += step.bytes_to_device;
  all.bytes_to_host += step.bytes_to_host;
  all.device_allocations += step.device_allocations;
  host::append_note(all.note, step.note);
  all.device_bytes_peak = std::max(all.device_bytes_peak, step.device_bytes_peak);
  for (const KernelStatistics& kernel : step.kernels) {
    const auto same = std::find_if(all.kernels.begin(), all.kernels.end(),
                                   [&kernel](const KernelStatistics& k) { return k.name == kernel.name; });
    if (same == all.kernels.end()) {
      all.kernels.push_back(kernel);
    } else {
      same->launches += kernel.launches;
      same->seconds += kernel.seconds;
    }
  }
  std::stable_sort(
      all.kernels.begin(), all.kernels.end(),
      [](const KernelStatistics& a, const KernelStatistics& b) { return a.seconds > b.seconds; });
}

// Runs what a thread does alone. As mode blocks does for small sets, it takes the compiler's arithmetic to be
// exact.
struct RuntimeOfThread {
  host::Runtime runtime{native_tuning(), 1};
};

}  // namespace

constrained::Result insert_on(Engine& engine, const double* coordinates,
                              const std::vector<std::size_t>& offsets, Triangulation& delaunay,
                              const std::vector<std::int32_t>& segments, const Options& options) {
  const statistics::Phases phases(options);
  const host::Runtime::BeforeCompiling announce(engine.runtime,
                                                [&] { phases.interrupt("compiling kernels"); });
  engine.begin_call(options.profile);
  constrained::Result result =
      constrained::constrain(engine.runtime, coordinates, offsets, delaunay, segments, options.halfedges);
  Statistics step;
  engine.write_accounts(step);
  add(step, delaunay.statistics);
  return result;
}

constrained::Result insert_segments(Implementation& self, const double* coordinates,
                                    const std::vector<std::size_t>& offsets, Triangulation& delaunay,
                                    const std::vector<std::int32_t>& segments, const Options& options) {
  constrained::check_first_segments(coordinates, offsets, segments);
  const bool may_stay = !self.is_named() && !options.profile;
  const std::size_t size = offsets.back() + segments.size() / 2;
  if (may_stay && size <= self.host_tuning().host_points) {
    host::Runtime& runtime = host::of_thread<RuntimeOfThread>().runtime;
    return constrained::constrain(runtime, coordinates, offsets, delaunay, segments, options.halfedges);
  }
  Engine& engine = self.for_host_memory();
  const auto insert = [&](Engine& used) {
    return insert_on(used, coordinates, offsets, delaunay, segments, options);
  };
  return in_fixed_point_or([&] { return insert(engine); },
                           [&](const std::string& reason) {
                             Engine& other = self.with_doubles(engine);
                             if (delaunay.statistics.host_points == 0) {
                               add_note(engine, other, reason, "segments inserted", delaunay.statistics);
                             }
                             return insert(other);
                           });
}

}  // namespace flaunay::call
