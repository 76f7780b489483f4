// How a set of points is cut into blocks.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::hybrid {

/// A cut across x or y, as blocks.cl has it: a point goes high unless it comes before the pivot, by (x, y),
/// or by (y, -x) if turn has all bits set. Coordinates as numbers in their order, of -x the complement.
struct CutNode {
  cl_ulong major, minor, turn;

  int axis() const { return turn != 0; }
};

/// In the order of a heap: node k has the children 2k and 2k + 1. Node 0 is not used.
struct CutTree {
  int depth = 0;
  std::vector<CutNode> nodes;
};

/// Samples that a tree of this depth is made from.
std::size_t samples_for(int depth);
/// Indices below n of that many samples: one from each of equal parts, drawn by the same rule every time.
std::vector<cl_int> sample_indices(std::size_t n, int depth);
/// The same for any number of samples.
std::vector<cl_int> spread_indices(std::size_t n, std::size_t count);
/// A sample and what it is a sample of.
struct NumberedSample {
  cl_double2 point;
  cl_int number;
};

/// A tree with 2^depth leaves that hold about as many samples each; cuts across the longer interquartile
/// range of the samples. samples: brought to the order of the leaves. O(m log m).
CutTree cut_tree(std::vector<cl_double2>& samples, int depth);
CutTree cut_tree(std::vector<NumberedSample>& samples, int depth);

}  // namespace flaunay::hybrid
