// Compiled programs on disk, so that later processes need not compile kernels.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "host/opencl/private_folder.hpp"

namespace flaunay::host {

/// A folder of compiled programs, each in a file that is named by the hash of its key. Several processes may
/// use a folder at the same time. Nothing here throws: a folder that cannot be used and a file that is
/// damaged are as if they were not there.
///
/// Drivers execute programs and are no match for damaged ones. So the folder must belong to the user, and
/// nobody else may be able to write to it or to a file that is read; see take_cache_note.
class ProgramCache {
 public:
  /// folder: made when a program is stored, for the user alone; empty: nothing is kept. most_bytes: when
  /// programs take more, those that were stored first are removed.
  explicit ProgramCache(std::string folder, std::size_t most_bytes = std::size_t{64} << 20);

  /// The program that was stored with this key, if any.
  std::optional<std::string> load(const std::string& key) const;
  /// Stores a program, in one step as seen by other processes.
  void store(const std::string& key, const std::string& program) const;

  const std::string& folder() const { return folder_; }

 private:
  bool is_usable(const PrivateFolder& folder) const;
  void remove_oldest() const;

  std::string folder_;
  std::size_t most_bytes_;
};

/// Why a folder is not used, for the user, once per process; empty otherwise.
std::string take_cache_note();

/// The folder of the cache: the environment variable FLAUNAY_CACHE_DIR if it is set ("" for no cache), else
/// flaunay in the folder of the user's caches; empty if the user has no such folder.
std::string default_cache_folder();

}  // namespace flaunay::host
