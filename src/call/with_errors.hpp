// Turns failures of OpenCL into Errors of the public interface.
#pragma once

#include <fmt/format.h>

#include <boost/compute/exception/opencl_error.hpp>

#include "flaunay/flaunay.hpp"
#include "host/error.hpp"

namespace flaunay {

template <typename Work>
auto with_errors(const Work& work) {
  try {
    return work();
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what(), error.code(), error.call());
  } catch (const boost::compute::opencl_error& error) {
    throw Error(ErrorKind::device, fmt::format("{} ({})", error.what(), host::error_name(error.error_code())),
                error.error_code());
  }
}

}  // namespace flaunay
