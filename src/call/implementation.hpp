// The members of a Triangulator: which engine runs a call, and that calls come one at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "call/engine.hpp"
#include "call/with_errors.hpp"
#include "flaunay/flaunay.hpp"
#include "tuning/tuning.hpp"

namespace flaunay {

/// If a device is named, every call runs on it, and it is opened at once. If none is named, calls on host
/// memory run on the first GPU or, where there is none, natively on the host; OpenCL is looked for when it is
/// first needed.
struct Triangulator::Implementation {
  /// wanted: as in Triangulator's constructor. Throws DeviceError if it names a device that does not exist.
  explicit Implementation(const std::string& wanted);
  Implementation(const boost::compute::context& context, const boost::compute::device& device);

  /// The engine of calls on device memory: the named device, or the one that OpenCL offers first. Throws
  /// DeviceError or Error(device) if there is none that can be used.
  call::Engine& on_device();
  /// The engine of calls on host memory. Throws as on_device if it is a device that cannot be used.
  call::Engine& for_host_memory();
  /// Whether the calling thread works on this number of points in host memory itself: no device was named,
  /// nothing is profiled, and other threads or a device would take longer to begin than the work takes.
  bool stays_here(std::size_t points, bool profile = false);
  /// The engine for work on this number of points in host memory: the calling thread's own, or
  /// for_host_memory().
  call::Engine& for_points(std::size_t points, bool profile = false);
  /// The engine for native work on this number of points: the calling thread's own, or native().
  call::Engine& native_for(std::size_t points);
  /// The engine that runs kernels natively, made when it is first needed.
  call::Engine& native();
  /// The engine that has doubles in place of this one, which is on_device() or for_host_memory(): itself, or
  /// another one on the same device and in its context, or native() if that device has no doubles.
  call::Engine& with_doubles(call::Engine& engine);
  /// Whether a device was named, on which all work is to be done.
  bool is_named() const { return is_named_; }
  /// The sizes that hold without a device.
  const Tuning& host_tuning() const { return *host_tuning_; }
  /// Waits for all work that was enqueued.
  void settle();
  /// To be called at the end of a call: notes how much memory the engines hold.
  void note_held_bytes();

  std::atomic<std::uint64_t> turns{0};  ///< twice the turns that there were, and 1 more during one; see Turn

 private:
  bool uses_device_for_host_memory();

  bool is_named_ = false;
  bool is_host_named_ = false;
  // As the environment has it when the object is made; engines that are made later follow it, too.
  const std::string tuning_ = tuning_in_environment();
  std::shared_ptr<const Tuning> host_tuning_ = native_tuning(tuning_);
  // Held while an engine is made or looked for.
  std::recursive_mutex making_;
  std::unique_ptr<call::Engine> device_, native_;
  // On the same device, for calls that need doubles, if device_ computes in fixed point.
  std::unique_ptr<call::Engine> device_with_doubles_;
  bool has_looked_for_doubles_ = false;
  std::optional<bool> uses_gpu_;  ///< for host memory, if no device is named; empty until it is looked for
};

/// Gives functions that are not members of Triangulator access to its implementation.
struct TriangulatorAccess {
  using Implementation = Triangulator::Implementation;
  static Implementation& implementation(Triangulator& triangulator) { return *triangulator.implementation_; }
  static std::shared_ptr<Implementation> shared(Triangulator& triangulator) {
    return triangulator.implementation_;
  }
};

namespace call {

using Implementation = TriangulatorAccess::Implementation;

/// As long as this lives, public calls of this thread on the triangulator are parts of the call whose turn it
/// is.
class WithinTurn {
 public:
  explicit WithinTurn(const Implementation& self);
  ~WithinTurn();
  WithinTurn(const WithinTurn&) = delete;
  WithinTurn& operator=(const WithinTurn&) = delete;

 private:
  const Implementation* before_;  // that of the turn around this one, or null
};

/// Marks a triangulator as busy for the length of a call. Throws Error(usage) if it is busy already, since
/// two calls at once would overwrite each other's memory and kernel arguments.
class Turn {
 public:
  explicit Turn(Implementation& self);
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  Implementation& self_;
  bool is_part_;  // of a call whose turn it is; see WithinTurn
};

/// Runs a public call that uses the triangulator's memory or queue; see Turn and with_errors.
template <typename Work>
auto take_turn(Implementation& self, const Work& work) {
  return with_errors([&] {
    const Turn turn(self);
    return work();
  });
}

}  // namespace call

}  // namespace flaunay
