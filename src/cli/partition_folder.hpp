// The folder that holds a partition: partition.json, finished.npy, for each region region-00000.node and
// region-00000.poly, and what other programs put beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

/// How a partition was made.
struct PartitionFacts {
  std::string input;
  int levels = 0;
  Cut cut = Cut::interquartile;
  Hull dividing_paths = Hull::prune;
};

/// Writes a partition. All files are written aside and take their places in keep(); without it nothing is
/// left that was not there, and nothing is gone that was.
class PartitionWriter {
 public:
  /// Makes the folder if it is missing. input: must not be overwritten; "-" for none. Throws Error(usage) if
  /// the folder holds files of a partition and force is not set, Error(input) if nothing can be written
  /// there.
  PartitionWriter(const std::string& folder, const std::string& input, bool force);
  ~PartitionWriter();
  PartitionWriter(const PartitionWriter&) = delete;
  PartitionWriter& operator=(const PartitionWriter&) = delete;

  void write(const io::Points& points, const Partition& partition, const PartitionFacts& facts);
  /// Replaces the partition that was there, its solutions too.
  void keep();

 private:
  std::string folder_;
  std::string aside_;
  bool made_folder_ = false;
  std::vector<std::string> placed_;  // until all are
};

/// Reads the folder of a PartitionWriter, and the solutions.
class PartitionReader {
 public:
  /// Reads partition.json. This and the other members throw Error(input) that names the file.
  explicit PartitionReader(const std::string& folder);

  std::size_t regions() const { return sizes_.size(); }
  /// The file with region r's solution: region-00000.npy, .ele or .1.ele; empty if there is none.
  std::string solution_path(std::size_t r) const;
  /// Where region r's files are, without their endings.
  std::string stem(std::size_t r) const;
  std::string description_path() const;

  /// Everything, held against the points of the file `input`.
  Partition read(const std::string& input, const io::Points& points) const;

 private:
  struct Sizes {
    std::size_t points;
    std::size_t border_edges;
  };
  Region read_region(std::size_t r, const std::string& input, const io::Points& points) const;

  std::string folder_;
  std::size_t input_points_ = 0;
  std::size_t finished_triangles_ = 0;
  std::vector<Sizes> sizes_;
};

/// Throws Error(usage) if path, an output, is or would be one of the files of a partition in folder.
void check_no_partition_file(const std::string& folder, const std::string& path);

}  // namespace flaunay::cli
