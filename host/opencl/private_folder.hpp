// Folders of the user's own, to which nobody else can write.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace flaunay::host {

/// Makes a folder, and those above it that are missing, for this user alone (mode 0700). Returns an errno, 0
/// if there is something of this name.
int make_private_folder(const std::string& folder);

/// An open folder: files are created in the folder that was checked, even if its name has been given to
/// another one. On Windows it inherits an access control list; in the user's own folders that lets nobody
/// else write.
class PrivateFolder {
 public:
  /// Opens the folder if it is there and nobody else can write to it.
  explicit PrivateFolder(const std::string& folder);
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  ~PrivateFolder();

  bool is_open() const { return is_open_; }
  /// Why it is not open; empty if it is not there.
  const std::string& reason() const { return reason_; }

  /// The content of a regular file of at most this many bytes, to which nobody else can write.
  std::optional<std::string> read(const std::string& name, std::size_t most_bytes) const;
  /// Writes a file in one step as seen by other processes. Whether that was possible.
  bool write(const std::string& name, const std::string& content) const;

 private:
  std::string folder_, reason_;
  int descriptor_ = -1;
  bool is_open_ = false;
};

}  // namespace flaunay::host
