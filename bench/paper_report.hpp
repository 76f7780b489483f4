// bench/results/paper.md: the paper's claims beside what was measured, and the medians of each figure.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "paper_figures.hpp"
#include "paper_runs.hpp"

namespace flaunay::bench::paper {

/// The kernels' operations on one input relative to those of the recursive twin, sorting left out.
struct CrossCheck {
  std::string distribution;
  std::size_t n;
  double all;
  std::array<double, kComponents> by_component;
};

/// The kernels and the twin agree if their operations differ by no more than this share: prune's buckets
/// begin at other points where all regions of a level are in one list.
constexpr double kAgreeingRatio = 0.03;

/// checks may be empty; then unchecked says why.
std::string report(const Experiment& experiment, const std::vector<NamedFigure>& figures,
                   const std::vector<CrossCheck>& checks, const std::string& unchecked,
                   const nlohmann::json& record);

}  // namespace flaunay::bench::paper
