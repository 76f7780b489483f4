#include "c/errors.hpp"

#include <exception>
#include <new>
#include <string>

#include "host/of_thread.hpp"

namespace flaunay::c {
namespace {

constexpr const char* kOutOfMemory = "the host is out of memory";

struct Texts {
  std::string message, call;
};

// Refers to the thread's Texts, or to literals if there was no memory for copies.
struct LastError {
  const char *message = "", *call = "";
  int code = 0;
  flaunay_status status = FLAUNAY_SUCCESS;
};
thread_local LastError last;

void remember(const char* message, const std::string& call = {}, int code = 0) noexcept {
  last.code = code;
  last.call = "";
  last.message = kOutOfMemory;
  try {
    Texts& texts = host::of_thread<Texts>();
    texts.call = call;
    texts.message = message;
    last.call = texts.call.c_str();
    last.message = texts.message.c_str();
  } catch (...) {
    // There was no memory.
  }
}

flaunay_status status_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return FLAUNAY_ERROR_USAGE;
    case ErrorKind::input:
      return FLAUNAY_ERROR_INPUT;
    case ErrorKind::device:
      return FLAUNAY_ERROR_DEVICE;
    case ErrorKind::internal:
      break;
  }
  return FLAUNAY_ERROR_INTERNAL;
}

flaunay_status remember_handled() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    remember(error.what(), error.call(), error.code());
    return status_of(error.kind());
  } catch (const std::bad_alloc&) {
    last = {kOutOfMemory, ""};
    return FLAUNAY_ERROR_MEMORY;
  } catch (const Stopped& error) {
    remember(error.what());
    return FLAUNAY_ERROR_STOPPED;
  } catch (const std::exception& error) {
    remember(error.what());
  } catch (...) {
    remember("an exception of unknown type");
  }
  return FLAUNAY_ERROR_INTERNAL;
}

}  // namespace

flaunay_status remember_exception() noexcept {
  last.status = remember_handled();
  return last.status;
}

}  // namespace flaunay::c

const char* flaunay_last_error(void) { return flaunay::c::last.message; }
int flaunay_last_error_status(void) { return flaunay::c::last.status; }
int flaunay_last_error_code(void) { return flaunay::c::last.code; }
const char* flaunay_last_error_call(void) { return flaunay::c::last.call; }

const char* flaunay_status_string(int status) {
  switch (status) {
    case FLAUNAY_SUCCESS:
      return "success";
    case FLAUNAY_ERROR_INTERNAL:
      return "internal error";
    case FLAUNAY_ERROR_USAGE:
      return "usage error";
    case FLAUNAY_ERROR_INPUT:
      return "bad input";
    case FLAUNAY_ERROR_DEVICE:
      return "device error";
    case FLAUNAY_ERROR_MEMORY:
      return "out of host memory";
    case FLAUNAY_ERROR_STOPPED:
      return "stopped by the caller";
  }
  return "unknown status";
}
