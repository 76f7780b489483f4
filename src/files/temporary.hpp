// Temporary files and folders, which are removed even if a signal ends the process.
#pragma once

#include <mutex>
#include <string>

namespace flaunay::io {

/// From now on, SIGINT, SIGTERM and SIGHUP remove all temporary files and folders before they end the
/// process, unless they are ignored or blocked already. To be called before there are other threads.
void clean_up_when_interrupted();

/// While one exists, these signals wait: what is done meanwhile is done completely.
class Uninterrupted {
 public:
  Uninterrupted();

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

/// A file or folder that the destructor removes.
class Temporary {
 public:
  enum class Contents {
    none,  ///< a file; or a folder that is kept if something is in it
    all,   ///< a folder with everything in it
  };

  Temporary() = default;  ///< none
  /// Takes over what is at path. To be called in the scope of the Uninterrupted in which it was made.
  explicit Temporary(std::string path, Contents contents = Contents::none);
  Temporary(Temporary&& other) noexcept;
  Temporary& operator=(Temporary&& other) noexcept;
  ~Temporary();

  /// Empty if there is none, or no more.
  const std::string& path() const { return path_; }
  /// What is at the path stays there, if anything.
  void release();

 private:
  std::string path_;
  Contents contents_ = Contents::none;
};

}  // namespace flaunay::io
