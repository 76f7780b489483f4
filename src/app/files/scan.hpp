// Points with heights of laser scans and other files, as one set that need not fit memory.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::io {

/// Which points of .las files are used: none of those that are marked as withheld.
struct ScanChoice {
  enum class Returns { all, first, last };

  std::bitset<256> classes;  ///< none: all but noise
  Returns returns = Returns::all;

  bool takes_all() const { return classes.none() && returns == Returns::all; }
};

/// Points of .las files that are not used, whatever their classes, and by default.
struct LeftOut {
  std::uint64_t withheld = 0, noise = 0;
};

/// Least x and y, largest x and y.
using Box = std::array<double, 4>;

/// The points of files one after another: .las, .npy (n x 3, float64 or float32), .txt, .xyz and .csv (x,
/// y and z, without later columns, or the named columns), and points and lines of maps. Files are opened as
/// they are read, one at a time.
class Scan : public ValuedPoints {
 public:
  /// Opens each file and checks it as far as that needs no pass over binary files. Text is read at once, to a
  /// file without a name in `scratch`. Throws Error(usage) for other endings, and for a choice if there is a
  /// file that is no .las file; Error(input) for files that cannot be read or are truncated. third: the name
  /// of the column beside x and y in text. Throws Error(usage) for columns if a file is no text.
  Scan(const std::vector<std::string>& paths, const ScanChoice& choice, const std::string& scratch,
       const Columns& columns = {}, std::string_view third = "height");
  ~Scan() override;

  /// The box that headers of .las files announce, and points known from other files. Low is above high if
  /// nothing is known.
  Box announced_box() const;
  /// The coordinate systems that files have, each once, with the first file that has it.
  struct System {
    std::string crs, path;
  };
  std::vector<System> systems() const;

  /// Reads all points once, to find which are chosen: before this, no points can be read. Returns the box
  /// around them. Throws Error(input) for numbers that are not finite. progress: called with the share that
  /// is done.
  Box survey(const std::function<void(double done)>& progress);

  /// Whether heights of a layer are those of a field that was asked for.
  bool has_height_field() const;
  /// After survey.
  LeftOut left_out() const;
  /// The lowest and the highest value, after survey.
  std::array<double, 2> heights() const;

  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override;
  void read_values(std::uint64_t first, std::size_t count, double* values) override;

 private:
  class Part;

  void read_triples(std::uint64_t first, std::size_t count);

  ScanChoice choice_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::uint64_t size_ = 0;
  // The points that were read last, since their values are asked for next.
  std::vector<double> triples_;
  std::uint64_t triples_first_ = 0;
};

/// The files of folders that a Scan reads, in the order of their names, in place of the folders. Throws
/// Error(input) for a folder without such files.
std::vector<std::string> scan_files(const std::vector<std::string>& paths);

}  // namespace flaunay::io
