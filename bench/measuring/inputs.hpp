// The generated points that subcommands run on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flaunay::bench {

/// The paper's distributions, and inputs full of ties: cocircular points everywhere.
inline const std::vector<std::string> kPaperDistributions{"uniform", "normal", "kuzmin", "line"};
inline const std::vector<std::string> kDegenerateDistributions{"grid", "integer-circle", "circle"};

/// One set of points, or several.
struct Input {
  std::string distribution;  ///< or what the sets are
  std::size_t n;             ///< of all sets together
  std::vector<double> coordinates;
  std::vector<std::size_t> offsets;  ///< of the sets, as Triangulator::triangulate takes them

  std::size_t sets() const { return offsets.size() - 1; }
};

Input make_input(const std::string& distribution, std::size_t n, std::uint64_t seed = 1);

/// Sets of the same size.
Input equal_sets(std::size_t sets, std::size_t size, const std::string& distribution = "uniform");

/// n points in sets whose sizes have a heavy tail, up to a tenth of all points. A ninth of the sets is empty,
/// a quarter is degenerate: collinear, gridded, all or nearly all equal, or with many duplicates.
Input heavy_tailed_sets(std::size_t n);

/// Every distribution at every size, sizes ascending.
std::vector<Input> make_inputs(const std::vector<std::string>& distributions, std::vector<std::size_t> sizes);

/// "kuzmin, 1000 points"
std::string input_name(const Input& input);

/// 2^least ... 2^most
std::vector<std::size_t> powers_of_two(int least, int most);

/// "4M", "10k", "300"
std::string thousands(std::size_t n);

template <typename T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace flaunay::bench
