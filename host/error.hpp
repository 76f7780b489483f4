// OpenCL failures as exceptions that name the call, the code, and what to do.
#pragma once

#include <CL/cl.h>

#include <stdexcept>
#include <string>

namespace flaunay::host {

/// An OpenCL call failed, or there is no usable device.
class DeviceError : public std::runtime_error {
 public:
  explicit DeviceError(const std::string& message, cl_int code = CL_SUCCESS, const std::string& call = {})
      : std::runtime_error(message), code_(code), call_(call) {}
  cl_int code() const noexcept { return code_; }
  /// The name of the OpenCL call; empty if none failed.
  const std::string& call() const noexcept { return call_; }

 private:
  cl_int code_;
  std::string call_;
};

/// "CL_OUT_OF_RESOURCES" for -5, and so on; "unknown OpenCL error -1234" otherwise.
std::string error_name(cl_int code);

/// What a user can do about the code; empty if nothing helpful is known.
std::string error_advice(cl_int code);

/// Throws DeviceError for a code other than CL_SUCCESS. call: the call's own text; kernel: its name or "".
void check_call(cl_int code, const char* call, const std::string& kernel = {});

}  // namespace flaunay::host

/// Evaluates an OpenCL call that returns its code, and throws a DeviceError that shows the call.
#define FLAUNAY_CL(call) ::flaunay::host::check_call((call), #call)
#define FLAUNAY_CL_KERNEL(call, kernel) ::flaunay::host::check_call((call), #call, (kernel))
