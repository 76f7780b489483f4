#include "call/implementation.hpp"

#include <fmt/format.h>

#include "host/opencl/device.hpp"

namespace flaunay {

using call::Engine;

namespace {

thread_local const call::Implementation* within_turn_of = nullptr;

// Whether the device that nobody has named passes the self-test, as one without fp64 may not. The host does
// as well.
[[maybe_unused]] bool can_be_used(call::Implementation& self) {
  try {
    with_errors([&self] { self.on_device(); });
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::device) throw;
    return false;
  }
}

}  // namespace

Triangulator::Implementation::Implementation(const std::string& wanted) {
  const std::string name = host::wanted_device(wanted);
  is_named_ = !name.empty();
  is_host_named_ = name == host::kHostName;
  if (is_host_named_) {
    for_host_memory();
  } else if (is_named_) {
    device_ = std::make_unique<Engine>(boost::compute::context(), host::find_device(wanted), tuning_);
  }
}

Triangulator::Implementation::Implementation(const boost::compute::context& context,
                                             const boost::compute::device& device)
    : is_named_(true), device_(std::make_unique<Engine>(context, device, tuning_)) {}

Engine& Triangulator::Implementation::on_device() {
  const std::lock_guard lock(making_);
  if (device_ == nullptr) {
    if (is_host_named_) {
      throw Error(
          ErrorKind::usage,
          "the device \"host\" has no OpenCL: it works on points in host memory; name another device");
    }
    device_ = std::make_unique<Engine>(boost::compute::context(), host::best_device(), tuning_);
  }
  return *device_;
}

Engine& Triangulator::Implementation::native() {
  const std::lock_guard lock(making_);
  if (native_ == nullptr) native_ = std::make_unique<Engine>(tuning_);
  return *native_;
}

bool Triangulator::Implementation::uses_device_for_host_memory() {
  if (is_named_) return !is_host_named_;
  if constexpr (host::kCanUseOpenCl) {
    if (!uses_gpu_) {
      const auto gpu = host::find_gpu();
      uses_gpu_ = gpu && (host::has_fp64(*gpu) || can_be_used(*this));
    }
    return *uses_gpu_;
  }
  return false;
}

Engine& Triangulator::Implementation::for_host_memory() {
  const std::lock_guard lock(making_);
  return uses_device_for_host_memory() ? on_device() : native();
}

bool Triangulator::Implementation::stays_here(std::size_t points, bool profile) {
  if (is_named_ || profile) return false;
  return points <= host_tuning_->host_points || points <= tuning_of(for_host_memory().runtime).host_points;
}

Engine& Triangulator::Implementation::for_points(std::size_t points, bool profile) {
  return stays_here(points, profile) ? Engine::of_thread() : for_host_memory();
}

Engine& Triangulator::Implementation::native_for(std::size_t points) {
  return points <= host_tuning_->host_points ? Engine::of_thread() : native();
}

Engine& Triangulator::Implementation::with_doubles(Engine& engine) {
  const std::lock_guard lock(making_);
  // Without OpenCL, the first is known to the compiler, which leaves out the rest.
  if (engine.runtime.is_native() || engine.has_doubles()) return engine;
  if (!has_looked_for_doubles_) device_with_doubles_ = engine.with_doubles();
  has_looked_for_doubles_ = true;
  return device_with_doubles_ != nullptr ? *device_with_doubles_ : native();
}

void Triangulator::Implementation::settle() {
  for (const auto* engine : {&device_, &device_with_doubles_}) {
    if (*engine != nullptr) (*engine)->runtime.settle();
  }
}

void Triangulator::Implementation::note_held_bytes() {
  const std::lock_guard lock(making_);
  for (const auto* engine : {&device_, &native_, &device_with_doubles_}) {
    if (*engine != nullptr) (*engine)->held_at_rest = (*engine)->held_bytes();
  }
}

call::WithinTurn::WithinTurn(const Implementation& self) : before_(within_turn_of) { within_turn_of = &self; }
call::WithinTurn::~WithinTurn() { within_turn_of = before_; }

call::Turn::Turn(Implementation& self) : self_(self), is_part_(within_turn_of == &self) {
  if (is_part_) return;
  std::uint64_t turns = self.turns.load(std::memory_order_relaxed);
  if (turns % 2 != 0 || !self.turns.compare_exchange_strong(turns, turns + 1, std::memory_order_acquire)) {
    throw Error(ErrorKind::usage,
                "the triangulator is in use by another call, on another thread or around this one (from a "
                "progress callback): it and its locators do one call at a time; make a triangulator for each "
                "thread");
  }
}

call::Turn::~Turn() {
  if (is_part_) return;
  self_.note_held_bytes();
  self_.turns.fetch_add(1, std::memory_order_release);
}

}  // namespace flaunay
