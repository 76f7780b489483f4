#include "hybrid/cut_tree.hpp"

#include <algorithm>

#include "recursive/sort.hpp"

namespace flaunay::hybrid {
namespace {

// The largest of so many blocks holds less than twice its share, as a rule.
constexpr std::size_t kSamplesPerBlock = 16;

using Samples = std::vector<cl_double2>;

double coordinate(const cl_double2& p, int axis) { return p.s[axis]; }

bool precedes(const cl_double2& p, const cl_double2& q, int axis) {
  if (coordinate(p, axis) != coordinate(q, axis)) return coordinate(p, axis) < coordinate(q, axis);
  return axis == 0 ? p.s[1] < q.s[1] : p.s[0] > q.s[0];
}

CutNode node_of(const cl_double2& pivot, int axis) {
  // Adding 0 turns -0 into 0.
  const cl_ulong x = recursive::sort_key(pivot.s[0] + 0.0), y = recursive::sort_key(pivot.s[1] + 0.0);
  return axis == 0 ? CutNode{x, y, 0} : CutNode{y, ~x, ~cl_ulong{0}};
}

double interquartile_range(Samples::iterator begin, Samples::iterator end, int axis) {
  const auto less = [axis](const cl_double2& p, const cl_double2& q) {
    return coordinate(p, axis) < coordinate(q, axis);
  };
  const auto quarter = (end - begin) / 4;
  std::nth_element(begin, begin + quarter, end, less);
  const double low = coordinate(begin[quarter], axis);
  const auto upper = end - 1 - quarter;
  std::nth_element(begin + quarter, upper, end, less);
  return coordinate(*upper, axis) - low;
}

void cut(CutTree& tree, std::size_t node, Samples::iterator begin, Samples::iterator end) {
  const int axis = interquartile_range(begin, end, 1) > interquartile_range(begin, end, 0) ? 1 : 0;
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end,
                   [axis](const cl_double2& p, const cl_double2& q) { return precedes(p, q, axis); });
  tree.nodes[node] = node_of(*middle, axis);
  if (2 * node >= tree.nodes.size()) return;
  cut(tree, 2 * node, begin, middle);
  cut(tree, 2 * node + 1, middle, end);
}

// Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

}  // namespace

std::size_t samples_for(int depth) { return kSamplesPerBlock << depth; }

std::vector<cl_int> sample_indices(std::size_t n, int depth) {
  std::vector<cl_int> indices(samples_for(depth));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const std::size_t begin = k * n / indices.size(), end = (k + 1) * n / indices.size();
    indices[k] = static_cast<cl_int>(begin + mixed(k) % std::max<std::size_t>(1, end - begin));
  }
  return indices;
}

CutTree cut_tree(Samples& samples, int depth) {
  CutTree tree;
  tree.depth = depth;
  tree.nodes.resize(std::size_t{1} << depth);
  if (depth > 0) cut(tree, 1, samples.begin(), samples.end());
  return tree;
}

}  // namespace flaunay::hybrid
