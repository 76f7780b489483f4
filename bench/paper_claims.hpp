// What the paper claims, what was measured, and whether they agree.
#pragma once

#include <string>
#include <vector>

#include "paper_runs.hpp"

namespace flaunay::bench::paper {

enum class Verdict { agree, partly, disagree };

const char* text_of(Verdict verdict);

struct Claim {
  std::string claim;
  std::string measured;
  Verdict verdict;
  std::string rule;         ///< how the verdict is reached
  std::string reason = {};  ///< why it may be other than agree
};

std::vector<Claim> claims(const Experiment& experiment);

}  // namespace flaunay::bench::paper
