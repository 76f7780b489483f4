// Temporary files and folders, which are removed even if a signal ends the process.
#pragma once

#include <mutex>
#include <string>
#include <utility>

namespace flaunay::io {

/// From now on, SIGINT, SIGTERM and SIGHUP remove all temporary files and folders before they end the
/// process, unless they are ignored or blocked already; and so do Ctrl-C and its like on Windows. To be
/// called before there are other threads.
void clean_up_when_interrupted();

/// These signals wait while such an object exists, so that its scope runs to the end.
class Uninterrupted {
 public:
  Uninterrupted();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

/// A file, or a folder, that the destructor removes if it is still there and, in the case of a folder, empty.
class Temporary {
 public:
  Temporary() = default;  ///< none
  /// Takes over the file or folder at path. Must be called in the same scope of Uninterrupted that made it.
  explicit Temporary(std::string path);
  Temporary(Temporary&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  Temporary& operator=(Temporary&& other) noexcept {
    std::swap(path_, other.path_);
    return *this;
  }
  ~Temporary();

  /// Empty if there is no file.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace flaunay::io
