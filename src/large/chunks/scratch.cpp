#include "large/chunks/scratch.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace flaunay::chunks {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);
constexpr std::size_t kWordsPerEdge = sizeof(OpenEdge) / kWord;
static_assert(sizeof(OpenEdge) == kWordsPerEdge * kWord);
constexpr std::size_t kMostBufferBytes = 96 * kBufferUnit;

}  // namespace

ChunkWriters::ChunkWriters(ScratchFile& file, std::size_t chunks, std::size_t buffer_bytes, bool has_values)
    : file_(file), has_values_(has_values), writers_(chunks) {
  const std::size_t own_bytes = buffer_bytes / std::max<std::size_t>(1, chunks);
  most_words_ = std::clamp(own_bytes / kBufferUnit * kBufferUnit, kBufferUnit, kMostBufferBytes) / kWord;
}

void ChunkWriters::add(std::size_t chunk, const ChunkPoints& from, std::size_t i) {
  Writer& writer = writers_[chunk];
  push(writer, from.point(i), from.ids[i], has_values_ ? from.values[i] : 0);
  const std::size_t edges = from.edge_count(i);
  writer.words.push_back(edges);
  const std::size_t at = writer.words.size();
  writer.words.resize(at + kWordsPerEdge * edges);
  if (edges > 0) std::memcpy(&writer.words[at], &from.edges[from.edge_offsets[i]], edges * sizeof(OpenEdge));
  count(writer);
}

void ChunkWriters::flush(Writer& writer) {
  if (writer.words.empty()) return;
  const std::size_t bytes = writer.words.size() * kWord;
  writer.stored.extents.push_back({file_.size(), bytes});
  file_.append(writer.words.data(), bytes);
  writer.words.clear();
}

std::vector<StoredChunk> ChunkWriters::take() {
  std::vector<StoredChunk> stored;
  for (Writer& writer : writers_) {
    flush(writer);
    stored.push_back(std::move(writer.stored));
    stored.back().has_values = has_values_;
  }
  return stored;
}

ChunkPoints read_chunk(const ScratchFile& file, const StoredChunk& chunk, bool is_first_round) {
  ChunkPoints points;
  points.coordinates.reserve(2 * chunk.points);
  points.ids.reserve(chunk.points);
  if (chunk.has_values) points.values.reserve(chunk.points);
  const std::size_t words_per_point = first_round_bytes(chunk.has_values) / kWord;
  if (!is_first_round) points.edge_offsets.push_back(0);
  std::vector<std::uint64_t> words;
  std::vector<OpenEdge> edges;
  for (const Extent& extent : chunk.extents) {
    words.resize(extent.bytes / kWord);
    file.read_at(extent.begin, extent.bytes, words.data());
    for (std::size_t at = 0; at < words.size();) {
      const kernel::double2 p = {kernel::as_double(words[at]), kernel::as_double(words[at + 1])};
      const auto id = static_cast<std::int64_t>(words[at + 2]);
      if (chunk.has_values) points.values.push_back(kernel::as_double(words[at + 3]));
      at += words_per_point;
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
