// Where an axis has its ticks, and what stands beside them.
#pragma once

#include <string>
#include <vector>

#include "plot.hpp"

namespace flaunay::bench::plot {

struct Range {
  double low, high;
};

struct Tick {
  double value;
  std::string label;
};

/// Whether the scale can show the value.
bool showable(Scale scale, double value);

/// Position of a value between low (0) and high (1).
double share(Scale scale, Range range, double value);

/// A range around data from low to high, with room at the ends; from_zero: a linear one begins at 0.
Range range_around(Scale scale, Range data, bool from_zero);

/// About `wanted` ticks at round values within the range.
std::vector<Tick> ticks(const Axis& axis, Range range, int wanted);

/// A single value, with three digits and the unit's prefix: "1.25 ms", "20 MB", "1.5M".
std::string value_label(Unit unit, double value);

}  // namespace flaunay::bench::plot
