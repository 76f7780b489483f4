#include "chunks/scratch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "flaunay/flaunay.hpp"

namespace flaunay::chunks {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);
constexpr std::size_t kWordsPerPoint = kFirstRoundBytes / kWord;
constexpr std::size_t kWordsPerEdge = sizeof(OpenEdge) / kWord;
static_assert(sizeof(OpenEdge) == kWordsPerEdge * kWord);
// A buffer for one chunk; smaller ones would be slow to read.
constexpr std::size_t kLeastBufferBytes = std::size_t{1} << 12;
constexpr std::size_t kMostBufferBytes = std::size_t{1} << 20;

std::string scratch_folder(std::string given) {
  if (!given.empty()) return given;
  const char* const folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

std::string gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} GB", static_cast<double>(bytes) / 1e9);
}

}  // namespace

ScratchFile::ScratchFile(std::string folder) : folder_(scratch_folder(std::move(folder))) {}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchFile::fail(const std::string& what, int error_number) const {
  throw Error(ErrorKind::input, fmt::format("{}: {} the scratch file: {}; choose another scratch folder",
                                            folder_, what, std::strerror(error_number)));
}

void ScratchFile::require(std::uint64_t bytes) const {
  struct statvfs status {};
  if (::statvfs(folder_.c_str(), &status) != 0) fail("cannot make", errno);
  const std::uint64_t free = std::uint64_t{status.f_bavail} * status.f_frsize;
  if (free >= bytes) return;
  throw Error(
      ErrorKind::input,
      fmt::format("{}: the points of chunks need {} of scratch space, but {} are free; choose another "
                  "scratch folder",
                  folder_, gigabytes(bytes), gigabytes(free)));
}

void ScratchFile::open() {
  constexpr int kOwner = 0600;
#ifdef O_TMPFILE
  descriptor_ = ::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kOwner);
  if (descriptor_ >= 0) return;
#endif
  // Where the file system has no files without names, the name is removed at once.
  std::string path = folder_ + "/flaunay-XXXXXX";
  descriptor_ = ::mkostemp(path.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("cannot make", errno);
  ::unlink(path.c_str());
}

Extent ScratchFile::append(const void* data, std::size_t bytes) {
  if (descriptor_ < 0) open();
  const Extent extent{end_, bytes};
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t wrote = ::pwrite(descriptor_, static_cast<const char*>(data) + done, bytes - done,
                                   static_cast<off_t>(end_ + done));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) fail("cannot write", errno);
    done += static_cast<std::size_t>(wrote);
  }
  end_ += bytes;
  held_ += bytes;
  largest_ = std::max(largest_, held_);
  return extent;
}

void ScratchFile::read(Extent extent, void* to) const {
  for (std::size_t done = 0; done < extent.bytes;) {
    const ssize_t got = ::pread(descriptor_, static_cast<char*>(to) + done, extent.bytes - done,
                                static_cast<off_t>(extent.begin + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot read", errno);
    if (got == 0) fail("cannot read", EIO);
    done += static_cast<std::size_t>(got);
  }
}

void ScratchFile::release(Extent extent) {
  held_ -= extent.bytes;
#ifdef FALLOC_FL_PUNCH_HOLE
  // Whether this works matters to nobody but the disk.
  (void)::fallocate(descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(extent.begin),
                    static_cast<off_t>(extent.bytes));
#endif
}

ChunkWriters::ChunkWriters(ScratchFile& file, std::size_t chunks, std::size_t buffer_bytes)
    : file_(file),
      most_words_(
          std::clamp(buffer_bytes / std::max<std::size_t>(1, chunks), kLeastBufferBytes, kMostBufferBytes) /
          kWord),
      writers_(chunks) {}

void ChunkWriters::add(std::size_t chunk, const ChunkPoints& from, std::size_t i) {
  Writer& writer = writers_[chunk];
  push(writer, from.point(i), from.ids[i]);
  const std::size_t edges = from.edge_count(i);
  writer.words.push_back(edges);
  const std::size_t at = writer.words.size();
  writer.words.resize(at + kWordsPerEdge * edges);
  if (edges > 0) std::memcpy(&writer.words[at], &from.edges[from.edge_offsets[i]], edges * sizeof(OpenEdge));
  count(writer);
}

void ChunkWriters::flush(Writer& writer) {
  if (writer.words.empty()) return;
  writer.stored.extents.push_back(file_.append(writer.words.data(), writer.words.size() * kWord));
  writer.words.clear();
}

std::vector<StoredChunk> ChunkWriters::take() {
  std::vector<StoredChunk> stored;
  for (Writer& writer : writers_) {
    flush(writer);
    stored.push_back(std::move(writer.stored));
  }
  return stored;
}

ChunkPoints read_chunk(const ScratchFile& file, const StoredChunk& chunk, bool is_first_round) {
  ChunkPoints points;
  points.coordinates.reserve(2 * chunk.points);
  points.ids.reserve(chunk.points);
  if (!is_first_round) points.edge_offsets.push_back(0);
  std::vector<std::uint64_t> words;
  std::vector<OpenEdge> edges;
  for (const Extent& extent : chunk.extents) {
    words.resize(extent.bytes / kWord);
    file.read(extent, words.data());
    for (std::size_t at = 0; at < words.size();) {
      const kernel::double2 p = {kernel::as_double(words[at]), kernel::as_double(words[at + 1])};
      const auto id = static_cast<std::int64_t>(words[at + 2]);
      at += kWordsPerPoint;
      if (is_first_round) {
        points.coordinates.insert(points.coordinates.end(), {p.x, p.y});
        points.ids.push_back(id);
        continue;
      }
      edges.resize(words[at++]);
      if (!edges.empty()) std::memcpy(edges.data(), &words[at], edges.size() * sizeof(OpenEdge));
      at += kWordsPerEdge * edges.size();
      points.add(p, id, edges.data(), edges.size());
    }
  }
  if (!is_first_round) points.sort();
  return points;
}

}  // namespace flaunay::chunks
