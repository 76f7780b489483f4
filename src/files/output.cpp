#include "files/output.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "files/file.hpp"

namespace flaunay::io {
namespace {

namespace fs = std::filesystem;

/// The path to which a chain of symbolic links leads, whether something is there or not.
std::string followed(std::string path) {
  constexpr int kMostLinks = 40;  // as in Linux
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code is_no_link;
    const fs::path next = fs::read_symlink(path, is_no_link);
    if (is_no_link) return path;
    path = (fs::path(path).parent_path() / next).string();
  }
  fail(path, "cannot be written: {}", system_reason(ELOOP));
}

/// Calls make with names that nothing in the folder should have, until it makes something. A short name,
/// because the target's may be as long as the file system allows.
template <typename Make>
std::string make_unique(const std::string& folder, const Make& make) {
  for (int attempt = 0;; ++attempt) {
    const std::string path = fmt::format("{}.flaunay-{}-{}.tmp", folder, ::getpid(), attempt);
    if (make(path.c_str())) return path;
    if (errno != EEXIST) return "";
  }
}

/// Whether the folder has one file for both names, for example because it ignores case.
bool are_one_name(const std::string& folder, const std::string& a, const std::string& b) {
  // Folders have their own rules for case and for composed characters, so this asks by making a file.
  const Uninterrupted made;
  const std::string path = make_unique(folder, [](const char* name) { return ::mkdir(name, 0700) == 0; });
  if (path.empty()) return false;  // a folder that cannot be written; an error elsewhere
  const Temporary probe(path, Temporary::Contents::all);
  const int file = ::open((path + "/" + a).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (file >= 0) ::close(file);
  return ::access((path + "/" + b).c_str(), F_OK) == 0;
}

bool differ_in_case_only(const std::string& a, const std::string& b) {
  const auto lower = [](unsigned char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

bool is_ascii(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x80; });
}

/// An unnamed file in the folder, or -1.
int open_unnamed([[maybe_unused]] const std::string& folder) {
#ifdef O_TMPFILE
  const int file = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) return -1;
  // Without this entry it could not be named.
  if (::access(fmt::format("/proc/self/fd/{}", file).c_str(), F_OK) == 0) return file;
  ::close(file);
#endif
  return -1;
}

bool exists(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

/// Renames, but replaces nothing: errno is EEXIST if something is there.
bool rename_to_new(const std::string& from, const std::string& to) {
#ifdef RENAME_NOREPLACE
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
#endif
  // Not every file system can do that.
  if (!exists(to)) return ::rename(from.c_str(), to.c_str()) == 0;
  errno = EEXIST;
  return false;
}

/// Each file gets the other's name.
bool exchange_names(const std::string& written, const std::string& target) {
#ifdef RENAME_EXCHANGE
  if (::renameat2(AT_FDCWD, written.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return true;
#endif
  // Not every file system can do that. With a hard link, the target has a file all the time.
  const std::string old = written + ".old";
  const bool is_linked = ::link(target.c_str(), old.c_str()) == 0;
  if (!is_linked && ::rename(target.c_str(), old.c_str()) != 0) return false;
  if (::rename(written.c_str(), target.c_str()) == 0) return ::rename(old.c_str(), written.c_str()) == 0;
  const int reason = errno;
  if (is_linked) {
    ::unlink(old.c_str());
  } else {
    ::rename(old.c_str(), target.c_str());
  }
  errno = reason;
  return false;
}

}  // namespace

Target find_target(const std::string& path) {
  Target target;
  struct stat status {};
  target.exists = ::stat(path.c_str(), &status) == 0;
  if (!target.exists && errno != ENOENT) fail(path, "cannot be written: {}", system_reason(errno));
  if (target.exists) {
    if (S_ISDIR(status.st_mode)) fail(path, "cannot be written: {}", system_reason(EISDIR));
    // Checked, because a rename would replace even a write-protected file.
    if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
      fail(path, "cannot be written: {}", system_reason(errno));
    }
    target.is_direct = !S_ISREG(status.st_mode);
    target.id = file_id(status);
    target.mode = status.st_mode & 07777;
  }
  const std::string real = target.is_direct ? path : followed(path);
  const std::size_t slash = real.find_last_of('/');
  target.folder = slash == std::string::npos ? "./" : real.substr(0, slash + 1);
  target.name = slash == std::string::npos ? real : real.substr(slash + 1);
  if (target.name.empty()) fail(path, "cannot be created: {}", system_reason(EISDIR));
  if (::stat(target.folder.c_str(), &status) != 0) {
    fail(path, "cannot be created in folder '{}': {}", target.folder, system_reason(errno));
  }
  target.folder_id = file_id(status);
  return target;
}

bool is_same(const Target& a, const Target& b) {
  if (a.exists && b.exists) return a.id == b.id;
  if (a.exists != b.exists || !(a.folder_id == b.folder_id)) return false;
  if (a.name == b.name) return true;
  const bool may_be_one = differ_in_case_only(a.name, b.name) || !is_ascii(a.name) || !is_ascii(b.name);
  return may_be_one && are_one_name(a.folder, a.name, b.name);
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (path == "-") {
    descriptor_ = STDOUT_FILENO;
    return;
  }
  target_ = find_target(path);
  if (target_.is_direct) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(path_, "cannot be opened for writing: {}", system_reason(errno));
  } else {
    open_temporary();
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ > STDERR_FILENO) ::close(descriptor_);
}

void OutputFile::check(const std::string& path) {
  if (!find_target(path).is_direct) OutputFile probe(path);
}

void check_output(const std::string& path, const std::string& ending) {
  if (ending_of(path) != ending) fail_ending(path, ending);
  OutputFile::check(path);
}

void OutputFile::open_temporary() {
  descriptor_ = open_unnamed(target_.folder);
  if (descriptor_ < 0) {
    const Uninterrupted made;
    const std::string name = make_unique(target_.folder, [this](const char* path) {
      descriptor_ = ::open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      return descriptor_ >= 0;
    });
    if (name.empty()) {
      fail(path_, "cannot be created in folder '{}': {}", target_.folder, system_reason(errno));
    }
    temporary_ = Temporary(name);
  }
  // Errors are ignored: some file systems have no modes.
  if (target_.exists && ::fchmod(descriptor_, target_.mode) != 0) return;
}

void OutputFile::write(const void* data, std::size_t bytes) {
  const char* begin = static_cast<const char*>(data);
  if (bytes >= kFull) {
    flush();
    write_through(begin, bytes);
  } else {
    buffer_.append(begin, begin + bytes);
    flush_if_full();
  }
}

void OutputFile::flush() {
  write_through(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void OutputFile::write_through(const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(descriptor_, data, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "cannot be written: {}", system_reason(errno));
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void OutputFile::write_at(std::uint64_t place, const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::pwrite(descriptor_, next, bytes, static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_, "cannot be written: {}", system_reason(errno));
    next += written;
    place += static_cast<std::uint64_t>(written);
    bytes -= static_cast<std::size_t>(written);
  }
}

void OutputFile::write_to_disk() {
  // Some file systems find only now that the disk is full. Others have no such call.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {
    fail(path_, "cannot be written: {}", system_reason(errno));
  }
}

void OutputFile::give_name() {
  struct stat status {};
  if (::fstat(descriptor_, &status) == 0) id_ = file_id(status);
  if (!temporary_.path().empty()) return;
  const std::string unnamed = fmt::format("/proc/self/fd/{}", descriptor_);
  const std::string name = make_unique(target_.folder, [&](const char* path) {
    return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
  });
  if (name.empty()) {
    fail(path_, "cannot be created in folder '{}': {}", target_.folder, system_reason(errno));
  }
  temporary_ = Temporary(name);
}

void OutputFile::close() {
  if (descriptor_ <= STDERR_FILENO) return;
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    fail(path_, "cannot be written: {}", system_reason(errno));
  }
}

OutputFile& Outputs::open(const std::string& path) {
  files_.push_back(std::make_unique<OutputFile>(path));
  return *files_.back();
}

void Outputs::write_out() {
  for (const auto& file : files_) {
    file->flush();
    if (file->is_placed()) file->write_to_disk();
  }
}

void Outputs::commit() {
  write_out();
  place_all();
}

void Outputs::commit_without_waiting() {
  for (const auto& file : files_) file->flush();
  place_all();
}

void Outputs::place_all() {
  const Uninterrupted placed;
  for (const auto& file : files_) {
    if (file->is_placed()) file->give_name();
    file->close();
  }
  try {
    for (const auto& file : files_) {
      if (file->is_placed()) place(*file);
    }
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}; {}", error.what(), take_back()));
  }
  placed_.clear();
  files_.clear();
}

void Outputs::place(OutputFile& file) {
  const std::string& written = file.temporary_.path();
  const std::string target = file.target_.path();
  if (rename_to_new(written, target)) {
    placed_.push_back({&file, false});
    return;
  }
  if (errno != EEXIST) fail(file.path_, "cannot be put in place: {}", system_reason(errno));
  const Target found = find_target(file.path_);
  const auto is_found = [&](const Placed& placed) { return placed.file->id_ == found.id; };
  if (std::any_of(placed_.begin(), placed_.end(), is_found)) {
    throw Error(ErrorKind::usage, fmt::format("{}: two outputs have the same path", file.path_));
  }
  if (found.is_direct) fail(file.path_, "cannot be replaced: is no regular file");
  if (!exchange_names(written, target)) fail(file.path_, "cannot be replaced: {}", system_reason(errno));
  placed_.push_back({&file, true});
}

std::string Outputs::take_back() {
  std::string left;
  for (; !placed_.empty(); placed_.pop_back()) {
    auto& [file, has_replaced] = placed_.back();
    const std::string target = file->target_.path();
    const std::string& written = file->temporary_.path();
    if (has_replaced ? exchange_names(written, target) : rename_to_new(target, written)) continue;
    left += fmt::format("; {} is the new file already", file->path_);
    if (has_replaced) left += fmt::format(", and the old one is {}", written);
    file->temporary_.release();
  }
  return left.empty() ? "all outputs are as they were" : left.substr(2);
}

}  // namespace flaunay::io
