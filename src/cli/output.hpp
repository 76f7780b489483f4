// Where the command's results go: standard output, and files that are kept only if everything succeeded.
#pragma once

#include <string>
#include <vector>

namespace flaunay::cli {

/// Writes text to standard output, flushed. Returns false if the reader has gone (a closed pipe), which is no
/// error; throws Error(input) for any other failure, such as a full disk.
bool print(const std::string& text);

/// Writes a text file. Throws Error(input) naming path and the system's reason.
void write_text(const std::string& path, const std::string& text);

/// The files that one run writes. Those that were not there before are removed again unless keep() is called.
class OutputFiles {
 public:
  /// input: a file that no output may overwrite; "-" for none.
  explicit OutputFiles(const std::string& input);
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Announces a mesh output, by write_mesh's rules; an empty path is none. Throws Error(usage) if the ending
  /// is unknown or the path is in use in this run, Error(input) if the path cannot be created.
  void add_mesh(const std::string& path);
  /// The same for an output whose ending must be `ending`.
  void add(const std::string& path, const std::string& ending);
  /// The same for points, by write_points's rules.
  void add_points(const std::string& path);

  /// All is written: nothing will be removed.
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
