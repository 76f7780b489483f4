#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/platform.hpp>

#include "call/device_info.hpp"
#include "call/with_errors.hpp"
#include "host/error.hpp"
#include "host/opencl/device.hpp"
#include "tuning/arithmetic.hpp"
#include "tuning/self_test.hpp"
#include "tuning/tuning.hpp"

namespace flaunay {
namespace call {

host::MemoryLeft usable_memory(const boost::compute::device& device, std::size_t held) {
  const host::MemoryLeft whole{static_cast<std::size_t>(device.global_memory_size()),
                               "the driver's account (CL_DEVICE_GLOBAL_MEM_SIZE)"};
  if (!host::shares_host_memory(device)) return whole;
  const host::MemoryLeft left = host::memory_left();
  return left.bytes < whole.bytes - std::min(whole.bytes, held)
             ? host::MemoryLeft{left.bytes + held, left.limit}
             : whole;
}

DeviceInfo describe(const boost::compute::device& device) {
  DeviceInfo info;
  info.name = device.name();
  info.platform = device.platform().name();
  info.vendor = device.vendor();
  info.driver = device.driver_version();
  info.version = device.get_info<std::string>(CL_DEVICE_VERSION);
  const cl_device_type type = device.type();
  info.type = type & CL_DEVICE_TYPE_GPU ? "GPU" : type & CL_DEVICE_TYPE_CPU ? "CPU" : "accelerator";
  info.compute_units = device.compute_units();
  info.clock_mhz = device.clock_frequency();
  info.memory_bytes = device.global_memory_size();
  info.available_bytes = usable_memory(device).bytes;
  info.largest_buffer_bytes = device.max_memory_alloc_size();
  info.local_memory_bytes = device.local_memory_size();
  info.work_group_size = device.max_work_group_size();
  info.fp64 = host::has_fp64(device);
  info.fixed_point = !info.fp64;
  return info;
}

host::MemoryLeft usable_memory(const host::Runtime& runtime, std::size_t held) {
  if (!runtime.is_native()) return usable_memory(runtime.device(), held);
  const host::MemoryLeft left = host::memory_left();
  // Nothing may be known, so that the sum could overflow.
  return {std::max(left.bytes, left.bytes + held), left.limit};
}

DeviceInfo describe(const host::Runtime& runtime) {
  DeviceInfo info;
  if (runtime.is_native()) {
    info.name = runtime.name();
    info.platform = "without OpenCL";
    info.version = fmt::format("flaunay {}", version());
    info.type = "CPU";
    info.compute_units = static_cast<unsigned>(runtime.threads());
    info.memory_bytes = host::physical_memory();
    info.available_bytes = usable_memory(runtime, 0).bytes;
    info.largest_buffer_bytes = info.memory_bytes;
    info.fp64 = true;
  } else {
    info = describe(runtime.device());
    info.fixed_point = runtime.capabilities().fixed_point;
  }
  info.self_test_passed = true;
  return info;
}

}  // namespace call

std::vector<DeviceInfo> list_devices(bool self_test) {
  return with_errors([&] {
    std::vector<DeviceInfo> infos;
    for (const boost::compute::device& device : host::all_devices()) {
      DeviceInfo info = call::describe(device);
      if (self_test) {
        try {
          host::Runtime runtime(device, settings_for(device));
          tuning::choose_arithmetic(runtime);
          info.self_test_failure = tuning::make_exact(runtime);
          info.self_test_passed = info.self_test_failure.empty();
          info.fixed_point = runtime.capabilities().fixed_point;
        } catch (const std::exception& error) {
          info.self_test_failure = error.what();
        }
      }
      infos.push_back(info);
    }
    return infos;
  });
}

}  // namespace flaunay
