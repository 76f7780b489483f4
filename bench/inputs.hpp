// What subcommands run on: generated points, modes and hulls by name.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "io/points.hpp"
#include "plot.hpp"

namespace flaunay::bench {

/// The mode that is measured if none is asked for.
inline constexpr Mode kDefaultMode = Mode::hybrid;

/// The paper's distributions, and inputs full of ties: cocircular points everywhere.
inline const std::vector<std::string> kPaperDistributions{"uniform", "normal", "kuzmin", "line"};
inline const std::vector<std::string> kDegenerateDistributions{"grid", "integer-circle", "circle"};

/// One set of points, or several.
struct Input {
  std::string distribution;  ///< or what the sets are
  std::size_t n;             ///< of all sets together
  io::Points points;
  std::vector<std::size_t> offsets;  ///< of the sets, as Triangulator::triangulate takes them
};

Input make_input(const std::string& distribution, std::size_t n);

/// Uniform sets of the same size.
Input equal_sets(std::size_t sets, std::size_t size);

/// n points in sets whose sizes have a heavy tail, up to a tenth of all points. A ninth of the sets is empty,
/// a quarter is degenerate: collinear, gridded, all or nearly all equal, or with many duplicates.
Input heavy_tailed_sets(std::size_t n);

/// Every distribution at every size, sizes ascending.
std::vector<Input> make_inputs(const std::vector<std::string>& distributions, std::vector<std::size_t> sizes);

/// "kuzmin, 1000 points"
std::string input_name(const Input& input);

/// As --modes takes it.
std::string default_mode_name();

/// The names that --modes and --hulls take; every mode and every hull.
const std::vector<std::string>& mode_names();
const std::vector<std::string>& hull_names();
Mode mode_named(const std::string& name);
Hull hull_named(const std::string& name);

/// One call in the mode of the options.
Triangulation run_mode(Triangulator& triangulator, const Input& input, const Options& options);

/// Makes what is made once, such as compiled kernels, so that no measured run contains it.
void prepare_mode(Triangulator& triangulator, const Options& options);

/// Most device memory that calls hold at once.
class DeviceMemory {
 public:
  explicit DeviceMemory(std::string device) : device_(std::move(device)) {}
  /// To be asked in ascending order of size: a triangulator keeps what it has for the next call. Each
  /// combination of options has one of its own.
  std::size_t peak(const Input& input, const Options& options);

 private:
  std::string device_;
  std::map<std::pair<Mode, Hull>, Triangulator> triangulators_;
};

/// 2^least ... 2^most
std::vector<std::size_t> powers_of_two(int least, int most);

/// The horizontal axis for sizes: by powers of two if they all are some, else of ten.
plot::Axis size_axis(const std::vector<std::size_t>& sizes);

}  // namespace flaunay::bench
