// Brings points to chunks: from the source in the first round, from handed-on points in later ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flaunay/chunks.hpp"
#include "geometry/magnitudes.hpp"
#include "host/native/threads.hpp"
#include "large/chunks/finish.hpp"
#include "large/chunks/points.hpp"
#include "large/chunks/scratch.hpp"
#include "large/chunks/tree.hpp"
#include "large/chunks/values.hpp"

namespace flaunay::chunks {

/// Sizes that follow from the memory of a call.
struct Plan {
  std::size_t chunk_points = 0;      ///< chunks have at most this many points, as a rule
  std::size_t largest_chunk = 0;     ///< points that the memory permits at once
  std::string limit = "the memory";  ///< the limit that permits no more, for messages
  std::size_t buffer_bytes = 0;      ///< of all buffers to the scratch file
  /// If more than this share of a round's points is handed on, they all go to one last chunk.
  int most_handed_on_percent = 70;
};

/// A chunk on disk. All other points are on or beyond the sides of its rectangle.
struct Chunk {
  StoredChunk stored;
  kernel::vertex_box rectangle;
};

/// The number of chunks for this many points.
std::size_t chunks_for(std::uint64_t points, const Plan& plan);

/// Called with the share of a step that is done.
using Progress = std::function<void(const char* step, double done)>;

/// The chunks of the first round, and properties of all points.
struct FirstRound {
  std::vector<Chunk> chunks;
  geometry::Scaling scaling;
  kernel::vertex_box all;
  std::uint64_t equal_points = 0;  ///< duplicates that were left out already
};

/// Reads all points twice: some for a sample, then all. Writes that each is its own representative, and the
/// representatives of duplicates that it leaves out because a chunk would have nothing else. values: of the
/// points, or null. Throws Error(input) for points and values that are not finite, and for points whose
/// magnitudes differ too much.
FirstRound distribute(PointSource& source, const Values* values, MeshSink& sink, ScratchFile& file,
                      const Plan& plan, host::Threads& threads, const Progress& progress);

/// The points that chunks of a round hand on, on disk, with a sample of them.
class HandedOn {
 public:
  explicit HandedOn(ScratchFile& file) : file_(file) {}
  void add(const ChunkPoints& points);
  std::uint64_t points() const { return points_; }
  /// All of them at once, released.
  ChunkPoints read_all();
  /// Distributes the points to chunks, cut in gaps, and releases the list.
  std::vector<Chunk> distribute(const Plan& plan);

 private:
  ScratchFile& file_;
  std::vector<StoredChunk> batches_;
  std::vector<kernel::double2> sample_;  // every stride-th point
  std::uint64_t points_ = 0, stride_ = 1;
};

}  // namespace flaunay::chunks
