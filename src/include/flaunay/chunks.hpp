// Triangulations of more points than fit into the memory of a device or of the machine: points are read in
// pieces, results are written in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flaunay/export.h"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Points that are read in pieces. No two calls are made at a time.
class FLAUNAY_API PointSource {
 public:
  virtual ~PointSource();
  /// The number of points.
  virtual std::uint64_t size() const = 0;
  /// Reads the points [first, first + count): 2 count coordinates, x0 y0 x1 y1 ... Throws Error(input) if it
  /// cannot. Every point is read twice, and some more often; they must be the same each time.
  virtual void read(std::uint64_t first, std::size_t count, double* coordinates) = 0;
};

/// The arrays of a triangulation, as Triangulation describes them. In `triangles` and `neighbors`, a row has
/// three entries.
enum class MeshArray { triangles, neighbors, hull, representatives, areas };

/// Where a triangulation is written, in pieces. No two calls are made at a time.
class FLAUNAY_API MeshSink {
 public:
  virtual ~MeshSink();
  /// Whether an array is wanted. Others are not computed.
  virtual bool wants(MeshArray array) const = 0;
  /// Stores `count` values as the entries [first, first + count) of an array; throws an Error if it cannot.
  /// Entries may be written in any order. Some neighbours are written twice, and the later value counts.
  virtual void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) = 0;
  /// As write, for the areas, which are doubles. A sink that does not override it gets none.
  virtual void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count);
  /// As write, for Triangulation::corner_offsets. It is called for all triangles on a torus or a cylinder. A
  /// sink that does not override it gets none.
  virtual void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count);
};

/// Bytes in the scratch folder for each point.
constexpr std::size_t kScratchBytesPerPoint = 24;
/// Further bytes for the value of a point, if points have some.
constexpr std::size_t kScratchBytesPerValue = 8;

/// The options of triangulate_chunks.
struct ChunkOptions {
  /// The space of the points: the plane, a torus or a cylinder, without weights. Rasters are of the plane.
  Space space = Space::plane();
  /// Bytes that the call may use on the host, devices that share its memory included, but not what the system
  /// keeps of files. 0: half of what is free.
  std::uint64_t memory_bytes = 0;
  /// The folder for the points of chunks, kScratchBytesPerPoint each, in a file without a name. Empty:
  /// TMPDIR, or /tmp.
  std::string scratch;
  /// The devices, each named as for Triangulator; "all": every usable device. They take chunks from one
  /// queue. Empty: flaunay's own choice of one.
  std::vector<std::string> devices;
  /// Instead of devices: triangulators of the caller's, such as those of sub-devices. They take chunks from
  /// one queue and must not be used meanwhile.
  std::vector<Triangulator*> triangulators;
  /// Points of a chunk. 0: as many as suit the devices. In any case no more than the memory permits at once,
  /// and not so few that the chunks' buffers would not fit it.
  std::size_t chunk_points = 0;
  /// If not empty, called from time to time on the calling thread. stage: "images" (on a torus or a
  /// cylinder), "sampling", "distributing" or "triangulating"; round: the round of chunks, from 0; done: the
  /// finished share of the call, 0 to 1. An exception that it throws ends the call.
  std::function<void(const std::string& stage, int round, double done)> progress;
};

/// A round of chunks.
struct ChunkRound {
  std::uint64_t points =
      0;  ///< points of the round; of the first one, without those that are equal to very many
  std::uint64_t chunks = 0;     ///< chunks into which they were cut
  std::uint64_t triangles = 0;  ///< triangles that became final
  std::uint64_t handed_on = 0;  ///< points that went on to the next round
};

/// The statistics of triangulate_chunks.
struct ChunkStatistics {
  std::uint64_t points = 0;                  ///< input points
  std::uint64_t duplicates = 0;              ///< input points that are not their own representative
  std::uint64_t triangles = 0;               ///< number of rows of `triangles` and `neighbors`
  std::uint64_t hull_vertices = 0;           ///< number of entries of `hull`
  std::uint64_t undecided = 0;               ///< predicates that needed exact evaluation
  std::uint64_t scratch_bytes = 0;           ///< the largest size of the scratch file
  std::size_t chunk_points = 0;              ///< points of a chunk, at most about
  std::vector<ChunkRound> rounds;            ///< the first has all points
  std::vector<std::string> devices;          ///< their names
  std::vector<std::uint64_t> device_points;  ///< points of the chunks that each device triangulated
  std::vector<PhaseStatistics> phases;       ///< in the order in which they ran
  double seconds = 0;                        ///< wall time
  std::uint64_t host_points = 0;  ///< points of the chunks that devices without fp64 left to the host
  std::string note;               ///< as Statistics::note; of such chunks, that of the first
  std::uint64_t images = 0;       ///< on a torus, images of points that were triangulated besides the points
};

/// Triangulates one set of points in chunks. What is final in a chunk is written; points around which
/// something is missing, some hundredths of a chunk's, go on to chunks that are cut otherwise, until one
/// chunk has them all. The set of triangles with their neighbours and areas, the hull and the representatives
/// are those of Triangulator::triangulate. Rows are in the order of rounds, then of chunks, then of the rows
/// of a call on the chunk alone; so their order depends on the options, too. Indices are 64-bit numbers.
///
/// Throws what Triangulator::triangulate throws, and: Error(input) if the scratch folder has too little room
/// or writing there fails; if the points that are left to the last chunk do not fit memory_bytes, as of
/// points that are all on one circle; Error(usage) if memory_bytes is too small for any work. What was
/// written to the sink before an error is without use. A device that fails in the middle of the call leaves
/// its chunk to the others; the call fails if none is left. O(n log n) work.
///
/// On a torus or a cylinder, the triangles have corner offsets, too, and there is no hull. First, all points
/// are read once more, on a cylinder twice, to find those near the border ("images" for progress). Their
/// images are held in memory and count as 48 bytes each, beside what chunks need; Error(input) if they do not
/// fit memory_bytes, as if most points are near the border. If these were too few, which is found out at the
/// end, all begins again with a wider margin, and everything is written again. So there may be rows of no use
/// beyond the number of triangles that is returned, but never more than 2 n. Statistics are of the last time;
/// rounds count images as points. Throws Error(usage) for another space, and if a hull is wanted.
FLAUNAY_API ChunkStatistics triangulate_chunks(PointSource& points, MeshSink& sink,
                                               const ChunkOptions& options = {});

/// Points in memory, such as a memory-mapped file.
class FLAUNAY_API ArrayPoints : public PointSource {
 public:
  /// coordinates: 2 n values, which are not copied.
  ArrayPoints(const double* coordinates, std::uint64_t n) : coordinates_(coordinates), n_(n) {}
  std::uint64_t size() const override { return n_; }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override;

 private:
  const double* coordinates_;
  std::uint64_t n_;
};

/// Arrays in memory for the results, such as memory-mapped files. Index: std::int32_t or std::int64_t. An
/// array that is null is not wanted. n points have at most 2 n triangles and n hull vertices.
template <typename Index>
struct MeshArrays {
  Index* triangles = nullptr;        ///< room for 6 n indices
  Index* neighbors = nullptr;        ///< room for 6 n indices
  Index* hull = nullptr;             ///< room for n indices
  Index* representatives = nullptr;  ///< room for n indices
  double* areas = nullptr;           ///< room for 2 n numbers
  /// Room for 12 n numbers; null in the plane.
  std::int8_t* corner_offsets = nullptr;
};

/// Points and results are in memory. Throws Error(input), too, if there are more points than 32-bit indices
/// can count, and Error(usage) if the plane is to have corner offsets.
FLAUNAY_API ChunkStatistics triangulate_chunks(const double* coordinates, std::uint64_t n,
                                               const MeshArrays<std::int32_t>& results,
                                               const ChunkOptions& options = {});
/// Results have 64-bit indices.
FLAUNAY_API ChunkStatistics triangulate_chunks(const double* coordinates, std::uint64_t n,
                                               const MeshArrays<std::int64_t>& results,
                                               const ChunkOptions& options = {});

/// Takes n points, x0 y0 x1 y1 ..., to their places on a torus or a cylinder, which are
/// Triangulation::places of a call that has them in memory. Returns the period as it is rounded. Throws
/// Error(usage) for a period that is none, and Error(input) for points that are not finite. O(n).
FLAUNAY_API Period take_to_places(const Period& period, double* points, std::size_t n);

}  // namespace flaunay
