// Other programs, as whole processes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace flaunay::bench {

/// A folder that is removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// The program of this name in the folder of this one.
std::string beside_this(const std::string& name);

/// Runs a program with its output thrown away, and returns the seconds that passed. words: its path or its
/// name, and its arguments. variables: its environment, NAME=VALUE each; empty: that of this process. Throws
/// Error(device) unless it succeeds.
double run_program(std::vector<std::string> words, std::vector<std::string> variables = {});

}  // namespace flaunay::bench
