// Points of chunks on disk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "arithmetic/language.h"
#include "files/scratch.hpp"
#include "flaunay/chunks.hpp"
#include "large/chunks/points.hpp"

namespace flaunay::chunks {

/// The bytes of a point of the first round in the scratch file.
constexpr std::size_t first_round_bytes(bool has_values) {
  return kScratchBytesPerPoint + (has_values ? kScratchBytesPerValue : 0);
}

/// Buffers for a chunk have a multiple of this many bytes: whole points, and whole blocks of the disk, so
/// that these can be given back. Smaller ones would be slow to read.
constexpr std::size_t kBufferUnit = 512 * kScratchBytesPerPoint;
static_assert(kBufferUnit % first_round_bytes(true) == 0);

/// A part of the scratch file.
struct Extent {
  std::uint64_t begin, bytes;
};

using io::ScratchFile;

/// Points of one chunk in the scratch file: words of 8 bytes.
struct StoredChunk {
  std::vector<Extent> extents;
  std::uint64_t points = 0;
  bool has_values = false;
};

/// Brings points to chunks in the scratch file, through a buffer for each.
class ChunkWriters {
 public:
  /// buffer_bytes: of all chunks together.
  ChunkWriters(ScratchFile& file, std::size_t chunks, std::size_t buffer_bytes, bool has_values);

  /// Adds a point in the first round. value: ignored if points have no values.
  void add(std::size_t chunk, kernel::double2 p, std::int64_t id, double value) {
    push(writers_[chunk], p, id, value);
    count(writers_[chunk]);
  }
  /// Adds point i of a list, with its open edges, in later rounds.
  void add(std::size_t chunk, const ChunkPoints& from, std::size_t i);
  /// Writes the contents of the buffers.
  std::vector<StoredChunk> take();

 private:
  struct Writer {
    std::vector<std::uint64_t> words;
    StoredChunk stored;
  };
  void push(Writer& writer, kernel::double2 p, std::int64_t id, double value) const {
    if (writer.words.empty()) writer.words.reserve(most_words_);
    writer.words.push_back(kernel::as_ulong(p.x));
    writer.words.push_back(kernel::as_ulong(p.y));
    writer.words.push_back(static_cast<std::uint64_t>(id));
    if (has_values_) writer.words.push_back(kernel::as_ulong(value));
  }
  // To be called when all words of a point are there.
  void count(Writer& writer) {
    ++writer.stored.points;
    if (writer.words.size() >= most_words_) flush(writer);
  }
  void flush(Writer& writer);

  ScratchFile& file_;
  std::size_t most_words_ = 0;
  bool has_values_;
  std::vector<Writer> writers_;
};

/// Reads the points of a chunk.
ChunkPoints read_chunk(const ScratchFile& file, const StoredChunk& chunk, bool is_first_round);

}  // namespace flaunay::chunks
