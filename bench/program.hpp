// Runs the command as a process, in folders of its own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace flaunay::bench {

/// A folder that is removed at the end.
class Folder {
 public:
  /// parent: empty for the system's folder for temporary files.
  explicit Folder(const std::string& parent = {});
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// What a process took.
struct Spent {
  double seconds = 0;
  double cpu_seconds = 0;         ///< of all its threads, the system's work for it included
  std::size_t resident_peak = 0;  ///< bytes
};

/// Runs a program, by its path or its name, with its output thrown away. environment: empty for that of this
/// process. Throws Error(device) if it fails.
Spent run_program(std::vector<std::string> words, std::vector<std::string> environment = {});

/// The program of this name in the folder of this one.
std::string beside_this(const std::string& name);

}  // namespace flaunay::bench
