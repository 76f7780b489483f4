// Where the command's results go: standard output, and files that are kept only if everything succeeded.
#pragma once

#include <string>
#include <vector>

namespace flaunay::cli {

/// Writes text to standard output and flushes it. Returns false if the pipe is closed, which is not an error;
/// throws Error(input) for any other failure, such as a full disk.
bool print(const std::string& text);

/// Writes a text file. Throws Error(input) with the path and the reason that the system gives.
void write_text(const std::string& path, const std::string& text);

/// The files that one run writes. The destructor removes those that did not exist before, unless keep() was
/// called.
class OutputFiles {
 public:
  /// input: a file that no output may overwrite; "-" for none.
  explicit OutputFiles(const std::string& input);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Announces a mesh in one of the formats of write_mesh. An empty path means that there is none. Throws
  /// Error(usage) if the ending is unknown or another file of this run has the path, Error(input) if the file
  /// cannot be created.
  void add_mesh(const std::string& path);
  /// Announces a file whose ending must be `ending`, with the same errors.
  void add(const std::string& path, const std::string& ending);
  /// Announces points in one of the formats of write_points, with the same errors.
  void add_points(const std::string& path);

  /// Everything is written: the destructor removes nothing.
  void keep() { keep_ = true; }

 private:
  void reserve(const std::string& path);

  struct File {
    std::string path;
    bool existed;
  };
  std::string input_;
  std::vector<File> files_;
  bool keep_ = false;
};

}  // namespace flaunay::cli
