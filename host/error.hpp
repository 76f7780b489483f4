// Failures of OpenCL as exceptions that name the call, the error code and a remedy.
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
  /// The name of the OpenCL call that failed; empty if none did.
  const std::string& call() const noexcept { return call_; }

 private:
  cl_int code_;
  std::string call_;
};

/// The name of an error code, "CL_OUT_OF_RESOURCES" for -5; "unknown OpenCL error -1234" if it has none.
std::string error_name(cl_int code);

/// Advice on how to fix this error; empty if no remedy is known.
std::string error_advice(cl_int code);

/// Throws DeviceError unless the code is CL_SUCCESS. call: the source text of the call; kernel: the name of
/// the kernel that it is about, or "".
void check_call(cl_int code, const char* call, const std::string& kernel = {});

}  // namespace flaunay::host

/// Evaluates an OpenCL call that returns its code, and throws a DeviceError that shows the call.
#define FLAUNAY_CL(call) ::flaunay::host::check_call((call), #call)
#define FLAUNAY_CL_KERNEL(call, kernel) ::flaunay::host::check_call((call), #call, (kernel))
