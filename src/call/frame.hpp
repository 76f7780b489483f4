// The frame of a public call: queue, memory, the arrays of the caller and where kernels have them, and the
// end. The work between is a function of a runtime and buffers, whatever computes and wherever the caller's
// arrays are.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "call/handles.hpp"
#include "call/implementation.hpp"
#include "flaunay/device_memory.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "points/download.hpp"

namespace flaunay::call {

using host::Buffer;

/// Coordinates in host memory, x0 y0 x1 y1 ..., in double or single precision; the other pointer is null.
struct HostPoints {
  const double* wide = nullptr;
  const float* narrow = nullptr;
  std::size_t count = 0;
};

using flaunay::expect;

/// Where a call is computed.
struct Place {
  Engine& engine;            ///< computes
  Engine* device = nullptr;  ///< has the caller's device memory: the engine, another one if that is native,
                             ///< or null for calls on host memory

  /// Whether the host computes, and the caller's arrays are in device memory.
  bool is_apart() const { return device != nullptr && device != &engine; }
};

/// Where calls are computed that need doubles, in place of this engine of the triangulator.
Place with_doubles(Implementation& self, Engine& asked);

/// Returns the result of work(), or if the input does not fit fixed point, that of with_doubles(reason). Both
/// return it as Fitted.
template <typename Work, typename WithDoubles>
auto in_fixed_point_or(const Work& work, const WithDoubles& with_doubles) {
  auto outcome = work();
  return *(outcome ? std::move(outcome) : with_doubles(outcome.too_wide().reason()));
}

/// Says in the statistics that the host did what this engine's device cannot do without doubles; nothing if
/// the engine that was used is the same or on a device. what: for what doubles are needed, such as
/// "constraints"; done: what became of them, such as "inserted".
void add_note(const Engine& asked, const Engine& used, const std::string& what, const std::string& done,
              Statistics& statistics);

/// Returns the coordinates of points in device memory, of one set.
std::vector<double> read_points(Implementation& self, const DevicePoints& points);

/// Adds what the engine did since its accounts were reset to what earlier steps of the call did.
void add_accounts(Engine& engine, Statistics& all);

template <typename T>
class Output;

/// Exists as long as the call. If it ends by an exception, waits for what uses the caller's memory. Results
/// in host memory must have been declared before it.
class Frame {
 public:
  /// A call on host memory, with the engine's own memory and queue. has_stages: whether results of a stage
  /// stay in the engine's memory for later stages, whatever scopes of the arena they are made in.
  explicit Frame(Engine& engine, bool profile = false, bool has_stages = false);
  /// A call on device memory. Checks the queue and the events; those are waited for by begin(), and checks
  /// that need no array go between.
  Frame(Implementation& self, const Place& place, const Enqueue& enqueue);
  void begin();
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  // Arrays that kernels read. A null pointer is an empty array. what: the array's name in error messages, for
  // calls on device memory. If the host computes those, the arrays are read back. In host memory they must
  // not change until the end.
  template <typename T>
  Buffer<T> in(const T* values, std::size_t count, const char* /*what*/ = "") {
    return runtime.view_later(values, count);
  }
  template <typename T>
  Buffer<T> in(const std::vector<T>& values, std::size_t /*count*/ = 0, const char* /*what*/ = "") {
    return runtime.view_later(values.data(), values.size());
  }
  template <typename T>
  Buffer<T> in(cl_mem memory, std::size_t count, const char* what) {
    check_buffer(place_.device->runtime, memory, count * sizeof(T), Access::read, what);
    memories_.push_back(memory);
    const Buffer<T> there(memory == nullptr ? nullptr : retained(memory), count);
    return place_.is_apart() ? read_back(there, 0, count) : there;
  }
  template <typename T>
  Buffer<T> in(const DeviceBuffer& buffer, std::size_t count, const char* what) {
    return in<T>(buffer.memory(), count, what);
  }
  // Arrays that kernels read and change. The end transfers what has become of them.
  template <typename T>
  Buffer<T> change(std::vector<T>& values, std::size_t /*count*/ = 0, const char* /*what*/ = "") {
    const Buffer<T> buffer = runtime.output(values);
    if (runtime.sizes().in_host_memory == 0) runtime.write_later(buffer, 0, values.size(), values.data());
    transfers_.push_back({buffer.kept_memory(), nullptr, in_place(values), values.size(), 0, fetch<T>});
    return buffer;
  }
  template <typename T>
  Buffer<T> change(const DeviceBuffer& array, std::size_t count, const char* what) {
    const Buffer<T> buffer = in<T>(array, count, what);
    if (place_.is_apart()) {
      transfers_.push_back({buffer.kept_memory(), retained(array.memory()), nullptr, count, 0, copy<T>});
    }
    return buffer;
  }
  /// Throws Error(usage) if the buffer of points is missing or too small, or if the points lie in another
  /// space or have weights that the call does not know.
  void check(const DevicePoints& points, const char* what, SpaceKind kind = SpaceKind::plane,
             bool can_have_weights = false);
  /// The coordinates in double precision. Those in device memory must have been checked.
  Buffer<cl_double> points(const HostPoints& points);
  Buffer<cl_double> points(const DevicePoints& points);
  static const Buffer<cl_double>& points(const Buffer<cl_double>& there) { return there; }
  /// The offsets of sets; see checked_offsets.
  std::vector<std::size_t> offsets(const DevicePoints& points);

  /// An array of results, whose size may be known later. most: the size of the buffer that is needed, if it
  /// is in device memory.
  template <typename T>
  Output<T> output(std::vector<T>& to, std::size_t most = 0, const char* what = "");
  template <typename T>
  Output<T> output(DeviceBuffer& to, std::size_t most, const char* what);
  /// An array of `count` results.
  template <typename T, typename To>
  Buffer<T> out(To& to, std::size_t count, const char* what = "") {
    return output<T>(to, count, what).buffer(count);
  }

  /// Throws Error(usage) if two arrays of the caller, or of these, are in the same buffer.
  void check_distinct(const std::vector<cl_mem>& others = {});
  /// Throws Error if the engine cannot take arrays of n points out of device memory.
  void check_size(std::size_t n) const;
  /// Transfers results in host memory before the end, as they are now, and waits for them.
  void fetch();
  /// Enqueues these transfers before a wait of the caller's. The end need not wait again for them alone.
  void transfer();
  /// Leaves out the transfer of a result in host memory, after a later stage has written another one.
  template <typename T>
  void drop(const std::vector<T>& values) {
    const auto is_dropped = [&](const Transfer& transfer) { return transfer.values.get() == &values; };
    transfers_.erase(std::remove_if(transfers_.begin(), transfers_.end(), is_dropped), transfers_.end());
  }
  /// Makes an array of results in host memory shorter, whether it is transferred already or not.
  template <typename T>
  void trim(std::vector<T>& values, std::size_t count) {
    for (Transfer& transfer : transfers_) {
      if (transfer.values.get() == &values) transfer.count = count;
    }
    if (values.size() > count) values.resize(count);
  }
  /// Transfers the results, and waits for them if they are in host memory; otherwise sets the caller's event.
  void end();

  Engine& engine;          ///< computes
  host::Runtime& runtime;  ///< the engine's

 private:
  template <typename T>
  friend class Output;

  // The caller's vector, which stays the caller's.
  template <typename T>
  static std::shared_ptr<std::vector<T>> in_place(std::vector<T>& values) {
    return {std::shared_ptr<void>(), &values};
  }
  // Where a native engine has values of the caller's device memory, which are read once.
  template <typename T>
  Buffer<T> read_back(const Buffer<T>& there, std::size_t first, std::size_t count) {
    const std::array<std::size_t, 2> range = {first * sizeof(T), count * sizeof(T)};
    for (const ReadBack& read : read_) {
      if (read.from == there.memory() && read.range == range) return {read.values, count};
    }
    const auto values =
        std::make_shared<std::vector<T>>(points::download(place_.device->runtime, there, first, count));
    const Buffer<T> here = runtime.view(values->data(), count);
    read_.push_back({there.memory(), range, {values, here.memory()}});
    return here;
  }
  struct ReadBack {
    cl_mem from;
    std::array<std::size_t, 2> range;  // the first byte, and how many
    std::shared_ptr<_cl_mem> values;
  };

  // How end() transfers an array that kernels have written. A small struct, since some calls take a
  // microsecond.
  struct Transfer {
    std::shared_ptr<_cl_mem> from, to;  // to: the caller's device memory if the host computes
    std::shared_ptr<void> values;       // the vector for them, if there is one
    std::size_t count, most;
    void (*run)(Frame& call, const Transfer& transfer);
  };
  static constexpr std::size_t kUsualTransfers = 5;
  // Makes the vector as long as its results. If more than half of its memory is unused, it is released.
  // Otherwise the vector keeps its reserved capacity: unused pages cost no memory, and a caller can append
  // without a copy.
  template <typename T>
  static void fit(host::Runtime& runtime, std::vector<T>& values, const Transfer& transfer) {
    const std::size_t count = transfer.count;
    runtime.resize(values, count, transfer.most / 2 > count ? count : transfer.most);
    if (values.capacity() / 2 > count) values.shrink_to_fit();
  }
  template <typename T>
  static void fetch(Frame& call, const Transfer& transfer) {
    auto& values = *static_cast<std::vector<T>*>(transfer.values.get());
    const bool is_copy = call.runtime.sizes().in_host_memory == 0;
    if (is_copy && values.size() != transfer.count) fit(call.runtime, values, transfer);
    call.runtime.fetch_later(Buffer<T>(transfer.from, transfer.count), values);
    if (call.place_.is_apart()) call.write<T>(transfer, std::move(values));
  }
  template <typename T>
  static void copy(Frame& call, const Transfer& transfer) {
    std::vector<T> values(transfer.count);
    call.runtime.read(Buffer<T>(transfer.from, transfer.count), 0, transfer.count, values.data());
    call.write<T>(transfer, std::move(values));
  }
  template <typename T>
  void write(const Transfer& transfer, std::vector<T> values) {
    write_result(place_.device->runtime, Buffer<T>(transfer.to, transfer.count), std::move(values));
  }

  Place place_;
  Enqueue enqueue_;
  std::vector<ReadBack> read_;
  std::vector<Transfer> transfers_;
  bool has_transferred_ = false;
  std::vector<cl_mem> memories_;  // of the caller's arrays
  std::optional<host::Arena::Scope> scope_, stages_;
  std::optional<QueuedCall> queued_;
  std::optional<host::Runtime::Settled> settled_;  // of calls on host memory
};

/// An array of results of a call.
template <typename T>
class Output {
 public:
  /// One that is not wanted.
  Output() = default;
  bool is_wanted() const { return frame_ != nullptr; }
  bool is_in_host_memory() const { return values_ != nullptr; }
  /// Touches host memory for `count` values while the device computes; otherwise page faults would take
  /// longer than writing the results. Another thread may do it before the transfer.
  void reserve(std::size_t count) const {
    if (values_ != nullptr) frame_->runtime.resize(*values_, count);
  }
  /// After buffer() for an upper bound: how many values there are.
  void trim(std::size_t count) const {
    if (values_ != nullptr) frame_->trim(*values_, count);
  }
  /// The buffer to which kernels write `count` values; none if the array is not wanted. A vector gets its
  /// length here if kernels write to it, otherwise when the results are transferred, while the device
  /// computes.
  Buffer<T> buffer(std::size_t count) const {
    if (values_ == nullptr) return there_;
    host::Runtime& runtime = frame_->runtime;
    Frame::Transfer transfer{{}, there_.kept_memory(), values_, count, most_, Frame::fetch<T>};
    Buffer<T> made;
    if (runtime.sizes().in_host_memory != 0) {
      Frame::fit(runtime, *values_, transfer);
      made = runtime.output(*values_);
    } else {
      made = (frame_->stages_ ? frame_->engine.even : runtime.arena()).template allocate<T>(count);
    }
    transfer.from = made.kept_memory();
    if (frame_->transfers_.empty()) frame_->transfers_.reserve(Frame::kUsualTransfers);
    frame_->transfers_.push_back(std::move(transfer));
    return made;
  }

 private:
  friend class Frame;
  Output(Frame& frame, std::size_t most, std::shared_ptr<std::vector<T>> values, Buffer<T> there)
      : frame_(&frame), most_(most), values_(std::move(values)), there_(std::move(there)) {}

  Frame* frame_ = nullptr;
  std::size_t most_ = 0;
  std::shared_ptr<std::vector<T>> values_;  // in host memory: the caller's vector, or a native engine's
  Buffer<T> there_{};                       // in device memory
};

template <typename T>
Output<T> Frame::output(std::vector<T>& to, std::size_t most, const char* /*what*/) {
  return {*this, most, in_place(to), {}};
}

template <typename T>
Output<T> Frame::output(DeviceBuffer& to, std::size_t most, const char* what) {
  const auto there =
      result_buffer<T>(place_.device->runtime, to, most, what, place_.device->buffer_allocations);
  memories_.push_back(there.memory());
  return {*this, most, place_.is_apart() ? std::make_shared<std::vector<T>>() : nullptr, there};
}

}  // namespace flaunay::call
