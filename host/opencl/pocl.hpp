// Checks whether the system has what PoCL, the OpenCL implementation for CPUs, needs. If anything is missing,
// PoCL ends the process, so the check comes before the first call of PoCL.
#pragma once

#include <CL/cl.h>

#include <string>

namespace flaunay::host {

#ifdef _WIN32

// There, it is a driver like all others.
constexpr bool is_pocl(cl_platform_id) { return false; }
inline void require_space_to_load_pocl() {}
inline void require_space_for_pocl() {}
inline void require_pocl_folder() {}
inline void require_pocl_compiler() {}
inline void note_pocl_ended_well() noexcept {}

#else

bool is_pocl(cl_platform_id platform);

/// To be called before platforms are listed: where there are several, the ICD loader asks all of them for
/// their devices to sort them. Throws DeviceError if PoCL is installed, but not loaded yet, and the limits of
/// the process leave too little address space for its library and its device.
void require_space_to_load_pocl();

/// To be called before PoCL opens its device. Throws DeviceError if the limits of the process leave too
/// little address space for it.
void require_space_for_pocl();

/// To be called before PoCL compiles a program. Throws DeviceError if the limits of the process leave too
/// little address space for it, or if PoCL cannot write to its folder of compiled kernels. The first call
/// removes empty kernels from that folder if the last process did not end well, or if nobody looked in the
/// last hour: to look takes milliseconds.
void require_pocl_compiler();

/// To be called when PoCL has compiled and run its kernels: the next process need not look for empty ones.
void note_pocl_ended_well() noexcept;

/// Throws DeviceError as require_cache_folder does for the folder in which PoCL keeps compiled kernels.
void require_pocl_folder();

/// The folder in which PoCL keeps compiled kernels.
std::string pocl_cache_folder();

/// Throws DeviceError, which names the folder and the remedy, if it is not writable or has too little space.
void require_cache_folder(const std::string& folder);

/// Removes empty kernels from PoCL's folder, which a full disk or a power failure has left. PoCL would not
/// compile them again, but fail to load them and end the process.
void remove_empty_kernels(const std::string& folder);

#endif

}  // namespace flaunay::host
