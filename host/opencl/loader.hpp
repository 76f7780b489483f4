// Drivers of OpenCL beside those that are installed.
#pragma once

#include <string>
#include <vector>

namespace flaunay::host {

/// Adds the platforms of a driver, a shared library, to the system's from now on, unless one has that name.
/// The driver is loaded when platforms are listed; if loading fails, it adds no platforms.
#ifdef FLAUNAY_WITHOUT_OPENCL
inline void add_driver(const std::string&, const std::string&) {}
#else
void add_driver(const std::string& platform, const std::string& path);
#endif

/// The drivers that are installed, as the loader finds them: the first line of each file *.icd.
std::vector<std::string> installed_drivers();

}  // namespace flaunay::host
