// The folder that holds a partition: partition.json, finished.npy, region-00000.node and region-00000.poly
// for each region, and the solutions that other programs put beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/points.hpp"
#include "files/output.hpp"
#include "files/temporary.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

/// How a partition was made.
struct PartitionFacts {
  std::string input;
  int levels = 0;
  research::Cut cut = research::Cut::interquartile;
  research::Hull dividing_paths = research::Hull::prune;
};

/// Makes the folder of a partition if it is missing; then it is removed again unless something is in it in
/// the end. input: the file that must not be overwritten; "-" for none. Throws Error(usage) if the folder
/// holds files of a partition and force is not set.
io::Temporary make_partition_folder(const std::string& folder, const std::string& input, bool force);
/// Throws Error(input) if nothing can be written there.
void announce_partition(io::Outputs& outputs, const std::string& folder);
/// Writes a partition that replaces the one in the folder, with its solutions.
void write_partition(io::Outputs& outputs, const std::string& folder, const io::Points& points,
                     const research::Partition& partition, const PartitionFacts& facts);

/// Reads a folder with a partition, and finds the solutions.
class PartitionReader {
 public:
  /// Reads partition.json. This and the other members throw Error(input) that names the file.
  explicit PartitionReader(const std::string& folder);

  std::size_t regions() const { return sizes_.size(); }
  /// The file with region r's solution: region-00000.npy, .ele or .1.ele; empty if there is none.
  std::string solution_path(std::size_t r) const;
  /// The path of region r's files without their endings.
  std::string stem(std::size_t r) const;
  std::string description_path() const;

  /// Reads the regions and the finished triangles. The points of the file `input` are compared with the
  /// regions'.
  research::Partition read(const std::string& input, const io::Points& points) const;

 private:
  struct Sizes {
    std::size_t points;
    std::size_t border_edges;
  };

  std::string folder_;
  std::size_t input_points_ = 0;
  std::size_t finished_triangles_ = 0;
  std::vector<Sizes> sizes_;
};

/// Throws Error(usage) if the output `path` would be one of the files of a partition in the folder.
void check_no_partition_file(const std::string& folder, const std::string& path);

}  // namespace flaunay::cli
