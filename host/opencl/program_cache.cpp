#include "host/opencl/program_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/uuid/detail/sha1.hpp>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <utility>
#include <vector>

#include "host/opencl/private_folder.hpp"
#include "host/system/files.hpp"

namespace flaunay::host {
namespace {

namespace fs = std::filesystem;

// A file is this line, the lengths of key and program, the key, the program, and the hash of all that.
const std::string kFirstLine = "flaunay program 1\n";
const std::string kEnding = ".program";
constexpr std::size_t kHashLength = 40;

std::string hash_of(const std::string& text) {
  boost::uuids::detail::sha1 hash;
  hash.process_bytes(text.data(), text.size());
  unsigned int digest[5];
  hash.get_digest(digest);
  return fmt::format("{:08x}{:08x}{:08x}{:08x}{:08x}", digest[0], digest[1], digest[2], digest[3], digest[4]);
}

std::string packed(const std::string& key, const std::string& program) {
  const std::uint64_t lengths[2] = {key.size(), program.size()};
  std::string content = kFirstLine;
  content.append(reinterpret_cast<const char*>(lengths), sizeof lengths);
  content += key;
  content += program;
  return content + hash_of(content);
}

// The program in a file's content; nothing if the file is damaged or has another key.
std::optional<std::string> unpacked(const std::string& content, const std::string& key) {
  std::uint64_t lengths[2];
  const std::size_t begin = kFirstLine.size() + sizeof lengths;
  if (content.size() < begin + kHashLength || content.compare(0, kFirstLine.size(), kFirstLine) != 0)
    return {};
  std::memcpy(lengths, content.data() + kFirstLine.size(), sizeof lengths);
  const std::size_t rest = content.size() - begin - kHashLength;
  if (lengths[0] != key.size() || lengths[0] > rest || lengths[1] != rest - lengths[0]) return {};
  const std::size_t end = content.size() - kHashLength;
  if (content.compare(begin, key.size(), key) != 0) return {};
  if (content.compare(end, kHashLength, hash_of(content.substr(0, end))) != 0) return {};
  return content.substr(begin + key.size(), lengths[1]);
}

std::string name_of(const std::string& key) { return hash_of(key) + kEnding; }

// The message that the user has not read yet.
struct Note {
  std::mutex mutex;
  bool is_made = false;
  std::string text;
};
Note& the_note() {
  static Note note;
  return note;
}

void make_note(const std::string& folder, const std::string& reason) {
  Note& note = the_note();
  const std::lock_guard<std::mutex> lock(note.mutex);
  if (note.is_made) return;
  note.is_made = true;
  note.text = fmt::format(
      "compiled kernels are not kept in {}: {}; mend that, or name another folder in FLAUNAY_CACHE_DIR",
      folder, reason);
}

}  // namespace

std::string take_cache_note() {
  Note& note = the_note();
  const std::lock_guard<std::mutex> lock(note.mutex);
  return std::exchange(note.text, "");
}

ProgramCache::ProgramCache(std::string folder, std::size_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

bool ProgramCache::is_usable(const PrivateFolder& folder) const {
  if (!folder.reason().empty()) make_note(folder_, folder.reason());
  return folder.is_open();
}

std::optional<std::string> ProgramCache::load(const std::string& key) const {
  if (folder_.empty()) return {};
  const PrivateFolder folder(folder_);
  if (!is_usable(folder)) return {};
  const std::optional<std::string> content = folder.read(name_of(key), most_bytes_);
  return content ? unpacked(*content, key) : std::nullopt;
}

void ProgramCache::store(const std::string& key, const std::string& program) const {
  const std::string content = packed(key, program);
  if (folder_.empty() || content.size() > most_bytes_) return;
  if (const int error = make_private_folder(folder_); error != 0) {
    make_note(folder_, std::strerror(error));
    return;
  }
  const PrivateFolder folder(folder_);
  if (is_usable(folder) && folder.write(name_of(key), content)) remove_oldest();
}

void ProgramCache::remove_oldest() const {
  struct Entry {
    fs::file_time_type time;
    std::uintmax_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  std::uintmax_t sum = 0;
  std::error_code error;
  // Unfinished files that a killed process has left count, too.
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    const Entry entry{fs::last_write_time(it->path(), gone), fs::file_size(it->path(), gone), it->path()};
    if (gone || it->path().filename().string().find(kEnding) == std::string::npos) continue;
    sum += entry.bytes;
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (auto entry = entries.begin(); entry != entries.end() && sum > most_bytes_; ++entry) {
    sum -= entry->bytes;
    fs::remove(entry->path, error);
  }
}

std::string default_cache_folder() {
  if (const char* given = std::getenv("FLAUNAY_CACHE_DIR"); given != nullptr) {
    return system::environment("FLAUNAY_CACHE_DIR");
  }
  const std::string folder = system::cache_folder();
  return folder.empty() ? "" : folder + "/flaunay";
}

}  // namespace flaunay::host
