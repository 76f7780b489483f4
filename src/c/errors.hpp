// Turns exceptions into statuses, and keeps the last error of each thread.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::c {

/// A function that the caller passed ended the call.
class Stopped : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns the status for the exception that is being handled and keeps its message as this thread's last
/// error. To be called in a catch block.
flaunay_status remember_exception() noexcept;

/// Runs work() and turns an exception into a status.
template <typename Work>
flaunay_status guarded(const Work& work) noexcept {
  try {
    work();
    return FLAUNAY_SUCCESS;
  } catch (...) {
    return remember_exception();
  }
}

/// The object that the pointer points to. Throws Error(usage) if it is null; what: its name in the message.
template <typename T>
T& required(T* pointer, const char* what) {
  if (pointer == nullptr) throw Error(ErrorKind::usage, fmt::format("{} must not be NULL", what));
  return *pointer;
}

/// Copies results to the caller's array. Throws Error(usage) if there are some, but the pointer is null.
template <typename T, typename Values>
void copy_to(T* place, const Values& values, const char* name) {
  check_array(place, values.size(), name, kMostCountable);
  std::copy(values.begin(), values.end(), place);
}

/// Fails with what find_problem() returns, if that is something: FLAUNAY_ERROR_INTERNAL.
template <typename FindProblem>
flaunay_status verified(const FindProblem& find_problem) noexcept {
  return guarded([&] {
    const std::string problem = find_problem();
    if (!problem.empty()) throw Error(ErrorKind::internal, problem);
  });
}

/// Stores the handle that make() returns in *place, or null if it throws.
template <typename Handle, typename Make>
flaunay_status create(Handle** place, const Make& make) noexcept {
  return guarded([&] {
    required(place, "the pointer to the new handle") = nullptr;
    *place = make().release();
  });
}

/// Returns get(*handle); null or 0 if the handle is null or get throws.
template <typename Handle, typename Get>
auto read(const Handle* handle, const Get& get) noexcept -> decltype(get(*handle)) {
  decltype(get(*handle)) value{};
  guarded([&] { value = get(required(handle, "the handle")); });
  return value;
}

}  // namespace flaunay::c
