// In the place of Boost.Compute's header, in a build without OpenCL: see host/without_opencl/CL/cl.h.
#pragma once

#include <string>

namespace boost::compute {

class platform {
 public:
  std::string name() const { return {}; }
};

}  // namespace boost::compute
