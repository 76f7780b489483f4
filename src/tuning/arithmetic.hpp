// Which arithmetic a device's kernels use: double precision, or integers in fixed point and single precision
// (Capabilities::fixed_point). Results are the same; OpenCL does not tell which is faster.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "flaunay/device_memory.hpp"
#include "host/opencl/program_cache.hpp"
#include "host/runtime.hpp"

namespace flaunay::tuning {

/// Makes the runtime's kernels use fixed point if its device is one of those whose tuning asks for the rate
/// of fp64 (Tuning::fixed_point_from) and fp64 is that slow. The rate is measured once per device and driver,
/// and remembered in the folder of compiled programs. Does nothing for other devices, and if the measurement
/// fails.
void choose_arithmetic(host::Runtime& runtime);

// ---- Its parts, for tests

/// Runs a chain of `steps` steps on every lane, and returns the seconds that it took.
using RunSteps = std::function<double(Precision, std::size_t steps)>;

/// How many times as long double precision takes as single precision.
double slowness_of_fp64(const RunSteps& run_steps);

/// How many times as long it takes on a device, which must have fp64. Measuring takes some milliseconds.
double measured_slowness_of_fp64(host::Runtime& runtime);

/// The value remembered under a key. If there is no such value, calls `measure` and remembers its result.
double remembered_slowness(const host::ProgramCache& cache, const std::string& key,
                           const std::function<double()>& measure);

/// choose_arithmetic with a slowness that is asked for only if the tuning values need it.
void choose_arithmetic(host::Runtime& runtime, const std::function<double()>& slowness);

}  // namespace flaunay::tuning
