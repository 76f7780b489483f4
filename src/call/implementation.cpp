#include "call/implementation.hpp"

#include "host/device.hpp"

namespace flaunay {

using call::Engine;

Triangulator::Implementation::Implementation(const std::string& wanted) : host_tuning_(native_tuning()) {
  const std::string name = host::wanted_device(wanted);
  is_named_ = !name.empty();
  is_host_named_ = name == host::kHostName;
  if (is_host_named_) {
    for_host_memory();
  } else if (is_named_) {
    device_ = std::make_unique<Engine>(boost::compute::context(), host::find_device(wanted));
  }
}

Triangulator::Implementation::Implementation(const boost::compute::context& context,
                                             const boost::compute::device& device)
    : is_named_(true), host_tuning_(native_tuning()), device_(std::make_unique<Engine>(context, device)) {}

Engine& Triangulator::Implementation::on_device() {
  const std::lock_guard lock(making_);
  if (device_ == nullptr) {
    if (is_host_named_) {
      throw Error(ErrorKind::usage,
                  "the device \"host\" has no OpenCL: it runs mode blocks, Voronoi diagrams and queries on "
                  "points in host memory; name another device");
    }
    device_ = std::make_unique<Engine>(boost::compute::context(), host::find_device(""));
  }
  return *device_;
}

Engine& Triangulator::Implementation::for_host_memory() {
  const std::lock_guard lock(making_);
  if (native_ != nullptr) return *native_;
  if (is_named_ && !is_host_named_) return on_device();
  if (!is_host_named_ && host::find_gpu()) return on_device();
  native_ = std::make_unique<Engine>();
  return *native_;
}

void Triangulator::Implementation::settle() {
  if (device_ != nullptr) device_->runtime.settle();
}

void Triangulator::Implementation::note_held_bytes() {
  const std::lock_guard lock(making_);
  for (Engine* engine : {device_.get(), native_.get()}) {
    if (engine != nullptr) engine->held_at_rest = engine->held_bytes();
  }
}

call::Turn::Turn(Implementation& self) : self_(self) {
  if (self.is_busy.exchange(true, std::memory_order_acquire)) {
    throw Error(ErrorKind::usage,
                "the triangulator is in use by another call, on another thread or around this one (from a "
                "progress callback): it and its locators do one call at a time; make a triangulator for each "
                "thread");
  }
}

call::Turn::~Turn() {
  self_.note_held_bytes();
  self_.is_busy.store(false, std::memory_order_release);
}

}  // namespace flaunay
