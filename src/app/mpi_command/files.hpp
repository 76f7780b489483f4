// Files that all ranks read and write at the same time, by MPI-IO. All functions are to be called by all
// ranks; if one fails on a rank, all throw its error.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "files/output.hpp"
#include "large/mpi/ranks.hpp"

namespace flaunay::mpi {

/// Points of a binary file, of which each rank reads an equal share.
class PointFile {
 public:
  /// Reads the header. Throws Error(usage) for other formats, and Error(input) for what is no such file.
  PointFile(Ranks& ranks, const std::string& path);
  std::uint64_t size() const { return records_.size; }
  /// This rank's share: x0 y0 x1 y1 ... Throws Error(input) if the file became shorter.
  std::vector<double> read(Ranks& ranks) const;

 private:
  std::string path_;
  io::PointRecords records_;
};

/// A .npy file of indices among the outputs of rank 0.
class IndexFile {
 public:
  /// outputs: those of rank 0, which commits them; path must be that of a regular file. columns: 0: an array
  /// of one dimension. rows: of all ranks.
  IndexFile(Ranks& ranks, io::Outputs& outputs, const std::string& path, std::size_t columns,
            std::uint64_t rows, io::IndexType type);
  ~IndexFile();
  IndexFile(const IndexFile&) = delete;
  IndexFile& operator=(const IndexFile&) = delete;

  /// Writes this rank's values, whose rows begin at first_row, and closes the file when it is on the disk.
  void write(Ranks& ranks, const std::vector<std::int64_t>& values, std::uint64_t first_row);

 private:
  std::string path_;
  std::size_t columns_;
  std::uint64_t rows_;
  io::IndexType type_;
  io::Temporary partial_;  // on the other ranks, which remove it if rank 0 is killed
  MPI_File file_ = MPI_FILE_NULL;
};

}  // namespace flaunay::mpi
