// In the place of Boost.Compute's header, in a build without OpenCL: see host/without_opencl/CL/cl.h.
#pragma once

#include <CL/cl.h>

#include <boost/compute/device.hpp>

namespace boost::compute {

/// Only the null context exists.
class context {
 public:
  context() = default;
  explicit context(const device&) {}
  explicit context(cl_context) {}
  cl_context get() const { return nullptr; }
};

}  // namespace boost::compute
