// In the place of Boost.Compute's header, in a build without OpenCL: see host/without_opencl/CL/cl.h.
#pragma once

#include <CL/cl.h>

#include <boost/compute/platform.hpp>
#include <string>

namespace boost::compute {

/// Only the null device exists.
class device {
 public:
  device() = default;
  explicit device(cl_device_id) {}
  cl_device_id id() const { return nullptr; }
  compute::platform platform() const { return {}; }
  std::string name() const { return {}; }
  std::string vendor() const { return {}; }
  std::string driver_version() const { return {}; }
  cl_device_type type() const { return 0; }
  cl_uint compute_units() const { return 0; }
  cl_uint clock_frequency() const { return 0; }
  cl_ulong global_memory_size() const { return 0; }
  cl_ulong local_memory_size() const { return 0; }
  cl_ulong max_memory_alloc_size() const { return 0; }
  std::size_t max_work_group_size() const { return 0; }
  template <typename T>
  T get_info(int) const {
    return {};
  }
};

}  // namespace boost::compute
