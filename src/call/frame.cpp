#include "call/frame.hpp"

#include <fmt/format.h>

#include <utility>

#include "host/note.hpp"
#include "points/inspect.hpp"

namespace flaunay::call {

Place with_doubles(Implementation& self, Engine& asked) {
  Engine& engine = self.with_doubles(asked);
  return {engine, !engine.runtime.is_native() ? &engine : !asked.runtime.is_native() ? &asked : nullptr};
}

void add_note(const Engine& asked, const Engine& used, const std::string& what, const std::string& done,
              Statistics& statistics) {
  if (&asked == &used || !used.runtime.is_native()) return;
  statistics.host_points = statistics.points;
  host::append_note(statistics.note, fmt::format("{} has no double precision (fp64) for {}: {} on the host",
                                                 asked.runtime.name(), what, done));
}

void add_accounts(Engine& engine, Statistics& all) {
  Statistics step;
  engine.write_accounts(step);
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

namespace {

// For another engine on the same device: a queue of the caller's, or else the own queue of the triangulator,
// which is that of its first engine.
Enqueue on_queue_of(Engine& first, const Engine& device, const Enqueue& enqueue) {
  const bool is_own = enqueue.queue == nullptr || enqueue.queue == first.runtime.own_queue();
  if (&device == &first || !is_own) return enqueue;
  Enqueue same = enqueue;
  // Kernels are timed on a queue of their engine, and calls that time them wait for it.
  if (enqueue.profile) first.runtime.settle();
  same.queue = enqueue.profile ? nullptr : first.runtime.own_queue();
  return same;
}

template <typename T>
Buffer<T> caller_points(const DevicePoints& points) {
  return {retained(points.memory), 2 * (points.first + points.count)};
}

}  // namespace

Frame::Frame(Engine& used, bool profile, bool has_stages)
    : engine(used), runtime(used.runtime), place_{used} {
  engine.begin_call(profile);
  scope_.emplace(runtime.arena());
  // Only modes that go level by level have something else there.
  if (has_stages) stages_.emplace(engine.even);
  settled_.emplace(runtime);
}

Frame::Frame(Implementation& self, const Place& place, const Enqueue& enqueue)
    : engine(place.engine),
      runtime(engine.runtime),
      place_(place),
      enqueue_(on_queue_of(self.on_device(), *place.device, enqueue)) {
  place.device->use_own_memory();
  check_enqueue(place.device->runtime, enqueue_);
}

void Frame::begin() {
  queued_.emplace(place_.device->runtime, enqueue_);
  place_.device->reset_accounts();
  if (place_.is_apart()) engine.begin_call(false);
  scope_.emplace(runtime.arena());
}

void Frame::check(const DevicePoints& points, const char* what, SpaceKind kind, bool can_have_weights) {
  expect(points.space.kind == kind && points.space.weights == nullptr,
         [&] { return fmt::format("the {} are given for another space", what); });
  expect(points.weights == nullptr || can_have_weights,
         [&] { return fmt::format("the {} have weights, which this call does not know", what); });
  check_device_points(place_.device->runtime, points, what);
  memories_.push_back(points.memory);
}

Buffer<cl_double> Frame::points(const HostPoints& points) {
  if (points.narrow == nullptr) return in(points.wide, 2 * points.count);
  const auto wide = runtime.arena().allocate<cl_double>(2 * points.count);
  host::Arena::Scope scope(runtime.arena());
  points::widen(runtime, in(points.narrow, 2 * points.count), 0, points.count, wide);
  return wide;
}

Buffer<cl_double> Frame::points(const DevicePoints& points) {
  const std::size_t n = points.count;
  if (n == 0) return runtime.arena().allocate<cl_double>(0);
  if (points.precision == Precision::float64) {
    const auto given = caller_points<cl_double>(points);
    if (place_.is_apart()) return read_back(given, 2 * points.first, 2 * n);
    if (points.first == 0) return given;
    // A copy and not a sub-buffer, which would have to begin at an aligned address.
    const auto copy = runtime.arena().allocate<cl_double>(2 * n);
    runtime.copy(given, 2 * points.first, copy, 0, 2 * n);
    return copy;
  }
  const auto wide = runtime.arena().allocate<cl_double>(2 * n);
  const auto given = caller_points<cl_float>(points);
  if (place_.is_apart()) {
    points::widen(runtime, read_back(given, 2 * points.first, 2 * n), 0, n, wide);
  } else {
    points::widen(runtime, given, points.first, n, wide);
  }
  return wide;
}

std::vector<std::size_t> Frame::offsets(const DevicePoints& points) {
  memories_.push_back(points.device_offsets);
  return checked_offsets(place_.device->runtime, points);
}

std::vector<double> read_points(Implementation& self, const DevicePoints& points) {
  Engine& engine = self.on_device();
  const Enqueue own;
  Frame call(self, {engine, &engine}, own);
  call.check(points, "points");
  expect(points.offsets.size() <= 2 && points.device_offsets == nullptr, "points of several sets");
  call.begin();
  if (points.precision == Precision::float64) {
    return points::download(call.runtime, caller_points<cl_double>(points), 2 * points.first,
                            2 * points.count);
  }
  const std::vector<float> narrow =
      points::download(call.runtime, caller_points<cl_float>(points), 2 * points.first, 2 * points.count);
  return {narrow.begin(), narrow.end()};
}

void Frame::check_distinct(const std::vector<cl_mem>& others) {
  std::vector<cl_mem> all = memories_;
  all.insert(all.end(), others.begin(), others.end());
  call::check_distinct(std::move(all));
}

void Frame::check_size(std::size_t n) const {
  if (place_.device != &engine) engine.check_size(n);
}

void Frame::transfer() {
  if (place_.device != nullptr) return;
  for (const Transfer& transfer : std::exchange(transfers_, {})) transfer.run(*this, transfer);
  has_transferred_ = true;
}

void Frame::fetch() {
  if (has_transferred_ && transfers_.empty()) return;
  runtime.flush();  // the device computes while vectors get their length
  for (const Transfer& transfer : transfers_) transfer.run(*this, transfer);
  runtime.finish();
}

void Frame::end() {
  if (place_.device == nullptr) return fetch();
  for (const Transfer& transfer : transfers_) transfer.run(*this, transfer);
  queued_->end();
}

}  // namespace flaunay::call
