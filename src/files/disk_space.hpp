// Whether disks have room for outputs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flaunay::io {

/// A file, none if the path is empty, and about how many bytes it will have.
struct SizedOutput {
  std::string path;
  std::uint64_t bytes;
  bool is_scratch = false;  ///< a file without a name; the path is that of its folder
};
/// Throws Error(input) that names an output, or else the scratch folder, if a disk has no room for the files
/// that go there.
void check_disk_space(const std::vector<SizedOutput>& files);

}  // namespace flaunay::io
