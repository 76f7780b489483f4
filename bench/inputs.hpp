// What subcommands run on: generated points, modes and hulls by name.
#pragma once

#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "io/points.hpp"
#include "plot.hpp"

namespace flaunay::bench {

struct Input {
  std::string distribution;
  std::size_t n;
  io::Points points;
};

/// Every distribution at every size, sizes ascending.
std::vector<Input> make_inputs(const std::vector<std::string>& distributions, std::vector<std::size_t> sizes);

/// "kuzmin, 1000 points"
std::string input_name(const Input& input);

/// The names that --modes and --hulls take; every mode and every hull.
const std::vector<std::string>& mode_names();
const std::vector<std::string>& hull_names();
Mode mode_named(const std::string& name);
Hull hull_named(const std::string& name);

/// One triangulation in the mode of the options.
Triangulation run_mode(Triangulator& triangulator, const io::Points& points, const Options& options);

/// Makes what is made once, such as compiled kernels, so that no measured run contains it.
void prepare_mode(Triangulator& triangulator, const Options& options);

/// The horizontal axis for sizes: by powers of two if they all are some, else of ten.
plot::Axis size_axis(const std::vector<std::size_t>& sizes);

}  // namespace flaunay::bench
