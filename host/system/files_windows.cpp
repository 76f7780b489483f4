#include <fcntl.h>
#include <io.h>
#include <windows.h>
// After windows.h.
#include <winioctl.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "host/system/files.hpp"
#include "host/system/wide.hpp"

namespace flaunay::system {
namespace {

// Others may rename and remove a file that is open, as when a signal ends the process.
constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
constexpr DWORD kMostBytes = DWORD{1} << 30;  // of one call

// Leaves the reason in errno.
void take_reason() {
  const DWORD error = GetLastError();
  // These have no entry in the table of the standard library, or one that says less.
  errno = error == ERROR_PATH_NOT_FOUND || error == ERROR_INVALID_NAME ? ENOENT
          : error == ERROR_SHARING_VIOLATION                           ? EBUSY
          : error == ERROR_NO_DATA || error == ERROR_BROKEN_PIPE       ? EPIPE
          : error == ERROR_HANDLE_DISK_FULL
              ? ENOSPC
              : std::system_category().default_error_condition(static_cast<int>(error)).value();
}

bool succeeded(BOOL result) {
  if (result == FALSE) take_reason();
  return result != FALSE;
}

HANDLE handle_of(int file) { return reinterpret_cast<HANDLE>(_get_osfhandle(file)); }

int descriptor_of(HANDLE handle, int how) {
  if (handle == INVALID_HANDLE_VALUE) {
    take_reason();
    return -1;
  }
  const int file = _open_osfhandle(reinterpret_cast<std::intptr_t>(handle), how | _O_BINARY | _O_NOINHERIT);
  if (file < 0) CloseHandle(handle);
  return file;
}

// Folders, too.
class Opened {
 public:
  explicit Opened(const std::string& name)
      : handle_(CreateFileW(wide(name).c_str(), FILE_READ_ATTRIBUTES, kShared, nullptr, OPEN_EXISTING,
                            FILE_FLAG_BACKUP_SEMANTICS, nullptr)) {
    if (!is_open()) take_reason();
  }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    if (is_open()) CloseHandle(handle_);
  }
  bool is_open() const { return handle_ != INVALID_HANDLE_VALUE; }
  HANDLE handle() const { return handle_; }

 private:
  HANDLE handle_;
};

std::optional<FileStatus> status_of(HANDLE handle) {
  if (GetFileType(handle) != FILE_TYPE_DISK) return FileStatus{FileKind::other, 0, 0, 0};
  BY_HANDLE_FILE_INFORMATION about{};
  if (!succeeded(GetFileInformationByHandle(handle, &about))) return {};
  const bool is_folder = (about.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
  return FileStatus{is_folder ? FileKind::folder : FileKind::regular,
                    std::uint64_t{about.nFileSizeHigh} << 32 | about.nFileSizeLow, about.dwVolumeSerialNumber,
                    0};
}

// Calls transfer(handle, count, &done, &place) and keeps the place after which the next bytes come.
template <typename Transfer>
std::int64_t at_place(int file, std::uint64_t place, std::size_t bytes, const Transfer& transfer) {
  const HANDLE handle = handle_of(file);
  LARGE_INTEGER before{};
  if (!succeeded(SetFilePointerEx(handle, {}, &before, FILE_CURRENT))) return -1;
  OVERLAPPED at{};
  at.Offset = static_cast<DWORD>(place);
  at.OffsetHigh = static_cast<DWORD>(place >> 32);
  DWORD done = 0;
  const BOOL is_done =
      transfer(handle, static_cast<DWORD>(std::min<std::size_t>(bytes, kMostBytes)), &done, &at);
  if (is_done == FALSE) {
    if (GetLastError() == ERROR_HANDLE_EOF) return 0;
    take_reason();
    return -1;
  }
  SetFilePointerEx(handle, before, nullptr, FILE_BEGIN);
  return done;
}

}  // namespace

int open_file(const std::string& name, Access access) {
  const bool is_read = access == Access::read;
  const HANDLE handle = CreateFileW(wide(name).c_str(), is_read ? GENERIC_READ : GENERIC_WRITE, kShared,
                                    nullptr, access == Access::create ? CREATE_NEW : OPEN_EXISTING,
                                    is_read ? FILE_FLAG_BACKUP_SEMANTICS : FILE_ATTRIBUTE_NORMAL, nullptr);
  return descriptor_of(handle, is_read ? _O_RDONLY : _O_WRONLY);
}

int open_unnamed(const std::string& folder) {
  for (int number = 0;; ++number) {
    const std::string name = temporary_path(folder + "/.flaunay-" + std::to_string(number), "scratch");
    const HANDLE handle =
        CreateFileW(wide(name).c_str(), GENERIC_READ | GENERIC_WRITE, kShared, nullptr, CREATE_NEW,
                    FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
    if (handle == INVALID_HANDLE_VALUE && GetLastError() == ERROR_FILE_EXISTS) continue;
    DWORD ignored = 0;
    // So that release_bytes has an effect. Not every file system can do that.
    if (handle != INVALID_HANDLE_VALUE) {
      DeviceIoControl(handle, FSCTL_SET_SPARSE, nullptr, 0, nullptr, 0, &ignored, nullptr);
    }
    return descriptor_of(handle, _O_RDWR);
  }
}

bool close_file(int file) { return _close(file) == 0; }

std::int64_t read_some(int file, void* to, std::size_t bytes) {
  return _read(file, to, static_cast<unsigned>(std::min<std::size_t>(bytes, kMostBytes)));
}
std::int64_t write_some(int file, const void* data, std::size_t bytes) {
  return _write(file, data, static_cast<unsigned>(std::min<std::size_t>(bytes, kMostBytes)));
}
std::int64_t read_some_at(int file, std::uint64_t place, void* to, std::size_t bytes) {
  return at_place(file, place, bytes, [to](HANDLE handle, DWORD count, DWORD* done, OVERLAPPED* at) {
    return ReadFile(handle, to, count, done, at);
  });
}
std::int64_t write_some_at(int file, std::uint64_t place, const void* data, std::size_t bytes) {
  return at_place(file, place, bytes, [data](HANDLE handle, DWORD count, DWORD* done, OVERLAPPED* at) {
    return WriteFile(handle, data, count, done, at);
  });
}

bool cut_file(int file, std::uint64_t bytes) {
  FILE_END_OF_FILE_INFO end{};
  end.EndOfFile.QuadPart = static_cast<LONGLONG>(bytes);
  return succeeded(SetFileInformationByHandle(handle_of(file), FileEndOfFileInfo, &end, sizeof end));
}

bool write_to_disk(int file) { return succeeded(FlushFileBuffers(handle_of(file))); }

// Only an administrator can do that for files that are closed.
bool write_folder_to_disk(const std::string&) { return true; }

void release_bytes(int file, std::uint64_t begin, std::uint64_t count) {
  FILE_ZERO_DATA_INFORMATION zeros{};
  zeros.FileOffset.QuadPart = static_cast<LONGLONG>(begin);
  zeros.BeyondFinalZero.QuadPart = static_cast<LONGLONG>(begin + count);
  DWORD ignored = 0;
  DeviceIoControl(handle_of(file), FSCTL_SET_ZERO_DATA, &zeros, sizeof zeros, nullptr, 0, &ignored, nullptr);
}

std::optional<FileStatus> status_of(int file) {
  const HANDLE handle = handle_of(file);
  if (handle != INVALID_HANDLE_VALUE) return status_of(handle);
  errno = EBADF;
  return {};
}

std::optional<FileStatus> status_of(const std::string& name) {
  const Opened file(name);
  return file.is_open() ? status_of(file.handle()) : std::nullopt;
}

// Access control lists, which files inherit from their folders, take the place of permissions.
void set_permissions(int, unsigned) {}

bool is_readable(const std::string& name) { return status_of(name).has_value(); }

bool is_writable(const std::string& name) {
  const DWORD attributes = GetFileAttributesW(wide(name).c_str());
  const bool is_read_only =
      attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY) != 0;
  if (is_read_only) errno = EACCES;
  return !is_read_only;
}

bool is_one_file(const std::string& a, const std::string& b) {
  const Opened file_a(a), file_b(b);
  BY_HANDLE_FILE_INFORMATION of_a{}, of_b{};
  return file_a.is_open() && file_b.is_open() &&
         GetFileInformationByHandle(file_a.handle(), &of_a) != FALSE &&
         GetFileInformationByHandle(file_b.handle(), &of_b) != FALSE &&
         of_a.dwVolumeSerialNumber == of_b.dwVolumeSerialNumber &&
         of_a.nFileIndexHigh == of_b.nFileIndexHigh && of_a.nFileIndexLow == of_b.nFileIndexLow;
}

bool rename_file(const std::string& from, const std::string& to) {
  return succeeded(MoveFileExW(wide(from).c_str(), wide(to).c_str(), MOVEFILE_REPLACE_EXISTING));
}

bool link_file(const std::string& name, const std::string& second) {
  return succeeded(CreateHardLinkW(wide(second).c_str(), wide(name).c_str(), nullptr));
}

bool remove_file(const std::string& name) {
  const std::wstring path = wide(name);
  return DeleteFileW(path.c_str()) != FALSE || succeeded(RemoveDirectoryW(path.c_str()));
}

std::size_t last_name(const std::string& path) { return path.find_last_of("/\\:") + 1; }

std::string temporary_folder() {
  const std::string usual = environment("TMPDIR");
  if (!usual.empty()) return usual;
  wchar_t folder[MAX_PATH + 1] = L"";
  GetTempPathW(MAX_PATH + 1, folder);
  return narrow(folder);
}

std::string cache_folder() { return environment("LOCALAPPDATA"); }

std::string environment(const char* variable) {
  const wchar_t* const value = _wgetenv(wide(variable).c_str());
  return value != nullptr ? narrow(value) : "";
}

}  // namespace flaunay::system
