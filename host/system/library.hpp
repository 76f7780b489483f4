// Shared libraries that are loaded while the program runs: library_posix.cpp and library_windows.cpp.
#pragma once

#include <string>

namespace flaunay::system {

using AnyFunction = void();

/// Open OpenCL's loader, and the library at a path; null if it is not found.
void* open_opencl();
void* open_library(const std::string& path);
/// A function of a library; null if the library has no function of this name.
AnyFunction* find_function(void* library, const char* name);
/// A function of any library that was loaded for all to see.
AnyFunction* find_among_loaded(const char* name);

}  // namespace flaunay::system
