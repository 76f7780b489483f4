// Work in processes of its own, for what must be ended when it takes too long, whose memory is to be told
// from all else, or whose driver is to read another environment; and programs, in folders of their own.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/measuring/inputs.hpp"

namespace flaunay::bench {

/// What became of a child process.
struct Answer {
  std::string text;     ///< what its work returned
  std::string failure;  ///< empty if it went well
};

/// Runs work in a copy of this process, which is ended after `limit` seconds (0: never). To be called before
/// there is a device: a child process has none of the threads of its parent's driver.
Answer ask_child(const std::function<std::string()>& work, double limit = 0);

/// A variable of the environment; empty if it is not set.
std::string variable(const char* name);

/// A variable of the environment has another value for as long as this is there.
class WithVariable {
 public:
  WithVariable(const char* name, const std::string& value);
  ~WithVariable();
  WithVariable(const WithVariable&) = delete;
  WithVariable& operator=(const WithVariable&) = delete;

 private:
  const char* name_;
  bool was_set_;
  std::string before_;
};

/// A folder that is removed at the end.
class Folder {
 public:
  /// parent: empty for the system's folder for temporary files.
  explicit Folder(const std::string& parent = {});
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Writes the points to a file, unless it is there, and returns its path.
  std::string write(const std::string& name, const std::string& distribution, std::size_t n) const;

 private:
  std::filesystem::path path_;
};

/// What a process took.
struct ProcessUse {
  double seconds = 0;
  double cpu_seconds = 0;         ///< of all its threads, the system's work for it included
  std::size_t resident_peak = 0;  ///< bytes
};

/// Runs a program, by its path or its name, with its output thrown away. Throws Error(device) if it fails.
ProcessUse run_program(std::vector<std::string> words);

/// The given program, or if that is empty the one of this name in the folder of this one.
std::string program_or(const std::string& given, const std::string& name);

}  // namespace flaunay::bench
