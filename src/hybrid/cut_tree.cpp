#include "hybrid/cut_tree.hpp"

#include <algorithm>

#include "recursive/sort.hpp"

namespace flaunay::hybrid {
namespace {

// The largest of so many blocks holds less than twice its share, as a rule.
constexpr std::size_t kSamplesPerBlock = 16;

const cl_double2& point_of(const cl_double2& sample) { return sample; }
const cl_double2& point_of(const NumberedSample& sample) { return sample.point; }

template <typename Sample>
double coordinate(const Sample& sample, int axis) {
  return point_of(sample).s[axis];
}

template <typename Sample>
bool precedes(const Sample& p, const Sample& q, int axis) {
  if (coordinate(p, axis) != coordinate(q, axis)) return coordinate(p, axis) < coordinate(q, axis);
  return axis == 0 ? coordinate(p, 1) < coordinate(q, 1) : coordinate(p, 0) > coordinate(q, 0);
}

CutNode node_of(const cl_double2& pivot, int axis) {
  // Adding 0 turns -0 into 0.
  const cl_ulong x = recursive::sort_key(pivot.s[0] + 0.0), y = recursive::sort_key(pivot.s[1] + 0.0);
  return axis == 0 ? CutNode{x, y, 0} : CutNode{y, ~x, ~cl_ulong{0}};
}

template <typename Iterator>
double interquartile_range(Iterator begin, Iterator end, int axis) {
  const auto less = [axis](const auto& p, const auto& q) {
    return coordinate(p, axis) < coordinate(q, axis);
  };
  const auto quarter = (end - begin) / 4;
  std::nth_element(begin, begin + quarter, end, less);
  const double low = coordinate(begin[quarter], axis);
  const auto upper = end - 1 - quarter;
  std::nth_element(begin + quarter, upper, end, less);
  return coordinate(*upper, axis) - low;
}

template <typename Iterator>
void cut(CutTree& tree, std::size_t node, Iterator begin, Iterator end) {
  const int axis = interquartile_range(begin, end, 1) > interquartile_range(begin, end, 0) ? 1 : 0;
  const auto middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [axis](const auto& p, const auto& q) { return precedes(p, q, axis); });
  tree.nodes[node] = node_of(point_of(*middle), axis);
  if (2 * node >= tree.nodes.size()) return;
  cut(tree, 2 * node, begin, middle);
  cut(tree, 2 * node + 1, middle, end);
}

template <typename Sample>
CutTree tree_of(std::vector<Sample>& samples, int depth) {
  CutTree tree;
  tree.depth = depth;
  tree.nodes.resize(std::size_t{1} << depth);
  if (depth > 0) cut(tree, 1, samples.begin(), samples.end());
  return tree;
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

std::vector<cl_int> sample_indices(std::size_t n, int depth) { return spread_indices(n, samples_for(depth)); }

std::vector<cl_int> spread_indices(std::size_t n, std::size_t count) {
  std::vector<cl_int> indices(count);
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const std::size_t begin = k * n / indices.size(), end = (k + 1) * n / indices.size();
    indices[k] = static_cast<cl_int>(begin + mixed(k) % std::max<std::size_t>(1, end - begin));
  }
  return indices;
}

CutTree cut_tree(std::vector<cl_double2>& samples, int depth) { return tree_of(samples, depth); }
CutTree cut_tree(std::vector<NumberedSample>& samples, int depth) { return tree_of(samples, depth); }

}  // namespace flaunay::hybrid
