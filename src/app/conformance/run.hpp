// Tests a device: every call of the library on the device and on the host, byte by byte, and every kernel
// that these launch, natively once more.
#pragma once

#include <cstddef>
#include <string>

namespace flaunay::conformance {

struct Request {
  std::string device;         ///< as for Triangulator, not the host; empty: the first one
  std::string only;           ///< a call's name; empty: all of them
  std::string record;         ///< a file for the record; calls of this device in it are not run again
  std::size_t points = 1000;  ///< of an input, about
};

/// Prints a line per call and per kernel that differs. Returns whether nothing differs.
bool run(const Request& request);

}  // namespace flaunay::conformance
