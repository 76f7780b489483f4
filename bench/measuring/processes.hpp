// Runs work in separate processes: work that must be ended when it takes too long, whose memory is measured
// separately, or whose driver shall read another environment. Also runs programs, in folders of their own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/measuring/jobs.hpp"

namespace flaunay::bench {

/// The outcome of a child process.
struct Answer {
  std::string text;               ///< what its work returned
  std::string failure;            ///< empty if it went well
  std::size_t resident_peak = 0;  ///< bytes
};

/// Runs work in a copy of this process, which is ended after `limit` seconds (0: never). To be called before
/// there is a device: a child process has none of the threads of its parent's driver.
Answer ask_child(const std::function<std::string()>& work, double limit = 0);

/// A variable of the environment; empty if it is not set.
std::string variable(const char* name);

/// A triangulator that is made while a variable of the environment has this value.
Triangulator triangulator_with(const char* name, const std::string& value, const std::string& device);

/// A folder that is removed at the end.
class Folder {
 public:
  /// parent: empty for the system's folder for temporary files.
  explicit Folder(const std::string& parent = {});
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes points to a file, unless it is there, and returns its path.
  std::string write(const std::string& distribution, std::size_t n) const;

 private:
  std::filesystem::path path_;
};

/// Runs a program, by its path or its name, with its output thrown away: wall seconds, and its peak of
/// resident memory. Throws Error(device) if it fails.
Outcome run_program(std::vector<std::string> words);

/// The given program, or if that is empty the one of this name in the folder of this one.
std::string program_or(const std::string& given, const std::string& name);

}  // namespace flaunay::bench
