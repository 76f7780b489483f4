// The arrays of a triangulation as .npy files, written in pieces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/output.hpp"
#include "flaunay/chunks.hpp"
#include "flaunay/result_arrays.hpp"

namespace flaunay::io {

constexpr std::size_t kMeshArrays = kMeshArrayIndices.size();  ///< of MeshArray

/// Writes each array to a file of `outputs`, which must be regular files: entries are written in any order.
/// Nothing has a name before the outputs are committed. Throws Error(input) that names the file.
class MeshFiles : public MeshSink {
 public:
  /// In the order of MeshArray; an empty one means that the array is not wanted.
  using Paths = std::array<std::string, kMeshArrays>;
  /// partials: the partial files that another process has created. corner_offsets: the path for six
  /// columns of int8.
  MeshFiles(Outputs& outputs, const Paths& paths, IndexType type, const Paths& partials = {},
            const std::string& corner_offsets = {});
  Paths partial_paths() const;

  bool wants(MeshArray array) const override;
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override;
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override;
  void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) override;

  /// Keeps this many triangles and drops the ones written after them.
  void keep_triangles(std::uint64_t triangles);
  /// Says how many entries an array has, if other processes write some of them.
  void extend(MeshArray array, std::uint64_t entries);
  /// Writes the headers, after all entries.
  void finish();

 private:
  struct File {
    OutputFile* output = nullptr;  // null: not wanted
    std::uint64_t entries = 0;     // up to the last one that was written
  };

  static void finish(const File& file, const char* descr, std::size_t columns);
  static void keep(File& file, std::uint64_t entries, std::size_t bytes);
  const File& file_of(MeshArray array) const { return files_[static_cast<std::size_t>(array)]; }

  IndexType type_;
  std::array<File, kMeshArrays> files_;
  File corner_offsets_;
  std::vector<std::int32_t> narrow_;
};

/// Throws Error(input) if the disks have no room for the arrays of n points, which have at most 2 n
/// triangles, and for the points of chunks in the scratch folder, if there is one. The hull is not counted,
/// since it is long for few inputs. corner_offsets: as of MeshFiles.
void check_room(const MeshFiles::Paths& paths, std::uint64_t n, IndexType type,
                const std::optional<std::string>& scratch, const std::string& corner_offsets = {});

/// Entries per row of an array's file; 0: it has one dimension.
std::size_t columns_of(MeshArray array);

/// Throws Error(usage) if the file exists and is no regular file.
void check_stream_output(const std::string& path);

}  // namespace flaunay::io
