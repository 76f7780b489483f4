#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <utility>

#include "host/opencl/private_folder.hpp"
#include "host/system/files.hpp"

namespace flaunay::host {
namespace {

// The descriptor of a file or folder, which it closes.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

// Why others can write to a file or folder: it belongs to another user, or its mode allows it. Empty if they
// cannot.
std::string who_else_writes(const struct stat& status) {
  if (status.st_uid != ::geteuid()) return fmt::format("it belongs to user {}", status.st_uid);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0) return "";
  return fmt::format("its mode {:04o} lets other users write to it (chmod go-w)", status.st_mode & 07777U);
}

}  // namespace

int make_private_folder(const std::string& folder) {
  const auto make = [&folder] {
    const bool is_there = ::mkdir(folder.c_str(), S_IRWXU) == 0 || errno == EEXIST;
    return is_there ? 0 : errno;
  };
  const int error = make();
  const std::string above = std::filesystem::path(folder).parent_path();
  if (error != ENOENT || above.empty() || above == folder) return error;
  const int error_above = make_private_folder(above);
  return error_above != 0 ? error_above : make();
}

PrivateFolder::PrivateFolder(const std::string& folder)
    : folder_(folder), descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  struct stat status {};
  const bool is_there = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0;
  if (!is_there && errno == ENOENT) return;
  reason_ = is_there ? who_else_writes(status) : std::strerror(errno);
  is_open_ = reason_.empty();
}

PrivateFolder::~PrivateFolder() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::optional<std::string> PrivateFolder::read(const std::string& name, std::size_t most_bytes) const {
  // Without waiting for the writer of a FIFO.
  const Descriptor file(
      ::openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat status {};
  if (!file || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size > most_bytes || !who_else_writes(status).empty()) return {};
  std::string content(size, '\0');
  if (system::read_at(file.number(), 0, content.size(), content.data()) < content.size()) return {};
  return content;
}

bool PrivateFolder::write(const std::string& name, const std::string& content) const {
  const std::string unfinished = system::temporary_path(name, "partial");
  Descriptor file(::openat(descriptor_, unfinished.c_str(),
                           O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
  if (!file) return false;
  const bool is_written = system::write_next(file.number(), content.data(), content.size());
  if (file.close() && is_written &&
      ::renameat(descriptor_, unfinished.c_str(), descriptor_, name.c_str()) == 0) {
    return true;
  }
  ::unlinkat(descriptor_, unfinished.c_str(), 0);
  return false;
}

}  // namespace flaunay::host
