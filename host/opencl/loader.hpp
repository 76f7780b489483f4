// Drivers of OpenCL beside those that are installed.
#pragma once

#include <string>
#include <vector>

namespace flaunay::host {

/// Adds the platforms of a driver, a shared library, to those of the system from now on, unless the system
/// has a platform of that name. It is loaded when platforms are listed; if that fails, it has none.
void add_driver(const std::string& platform, const std::string& path);

/// The drivers that are installed, as the loader finds them: the first line of each file *.icd.
std::vector<std::string> installed_drivers();

}  // namespace flaunay::host
