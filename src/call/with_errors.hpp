// Turns failures of OpenCL into Errors of the public interface.
#pragma once

#include <fmt/format.h>

#include "flaunay/flaunay.hpp"
#include "host/error.hpp"
#ifndef FLAUNAY_WITHOUT_OPENCL
#include <boost/compute/exception/opencl_error.hpp>
#endif

namespace flaunay {

template <typename Work>
auto with_errors(const Work& work) {
  try {
    return work();
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what(), error.code(), error.call());
#ifndef FLAUNAY_WITHOUT_OPENCL
  } catch (const boost::compute::opencl_error& error) {
    throw Error(ErrorKind::device, fmt::format("{} ({})", error.what(), host::error_name(error.error_code())),
                error.error_code());
#endif
  }
}

}  // namespace flaunay
