// The paper's figures with today's numbers.
#pragma once

#include <string>
#include <vector>

#include "paper_runs.hpp"
#include "plot.hpp"

namespace flaunay::bench::paper {

/// A figure, and what it shows in a sentence or two.
struct NamedFigure {
  std::string file;  ///< without a folder
  std::string caption;
  plot::Figure figure;
};

/// Numbered as in the paper; what the paper has no figure for counts on from 13.
std::vector<NamedFigure> figures(const Experiment& experiment);

}  // namespace flaunay::bench::paper
