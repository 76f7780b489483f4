// Exceptions as statuses, and the last error of each thread.
#pragma once

#include <fmt/format.h>

#include "flaunay/flaunay.h"
#include "flaunay/flaunay.hpp"

namespace flaunay::c {

/// The exception that is being handled, as a status; its message becomes this thread's last error.
flaunay_status remember_exception() noexcept;

/// Runs work; what it throws becomes a status.
template <typename Work>
flaunay_status guarded(const Work& work) noexcept {
  try {
    work();
    return FLAUNAY_SUCCESS;
  } catch (...) {
    return remember_exception();
  }
}

/// Throws Error(usage) that names it if the pointer is null.
template <typename T>
T& required(T* pointer, const char* what) {
  if (pointer == nullptr) throw Error(ErrorKind::usage, fmt::format("{} must not be NULL", what));
  return *pointer;
}

/// What make() returns goes to *place, which is null if it throws.
template <typename Handle, typename Make>
flaunay_status create(Handle** place, const Make& make) noexcept {
  return guarded([&] {
    required(place, "the pointer to the new handle") = nullptr;
    *place = make().release();
  });
}

/// What get() returns of a handle; null or 0 if there is none.
template <typename Handle, typename Get>
auto read(const Handle* handle, const Get& get) noexcept -> decltype(get(*handle)) {
  decltype(get(*handle)) value{};
  guarded([&] { value = get(required(handle, "the handle")); });
  return value;
}

}  // namespace flaunay::c
