#include "modes/flattened/counting.hpp"

#include <algorithm>

#include "geometry/sort.hpp"
#include "operations/counters.h"

namespace flaunay::flattened {
using namespace statistics;

namespace {

static_assert(static_cast<int>(Component::cut) == kernel::COMPONENT_CUT &&
              static_cast<int>(Component::hull) == kernel::COMPONENT_HULL &&
              static_cast<int>(Component::merge) == kernel::COMPONENT_MERGE &&
              static_cast<int>(Component::split) == kernel::COMPONENT_SPLIT &&
              static_cast<int>(Component::endgame) == kernel::COMPONENT_ENDGAME &&
              kComponents == kernel::COMPONENTS);

std::uint64_t whole(const cl_uint* halves) {
  return halves[0] + (static_cast<std::uint64_t>(halves[1]) << 32);
}

}  // namespace

Counting::Counting(host::Runtime& runtime, host::Arena& arena, Work& work)
    : runtime_(runtime), work_(work), counters_(arena.allocate<cl_uint>(kernel::COUNTERS_LENGTH)) {
  runtime_.fill(counters_, kernel::COUNTERS_LENGTH, cl_uint{0});
  runtime_.set_counters(counters_);
}

Counting::~Counting() { runtime_.set_counters({}); }

void Counting::add_depth(Component component, std::uint64_t operations) {
  depth_[static_cast<std::size_t>(component)] += operations;
}

void Counting::add_sort(const std::vector<std::size_t>& offsets) {
  std::uint64_t depth = 0;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const std::size_t size = offsets[s + 1] - offsets[s];
    sort_comparisons_ += geometry::comparisons_to_sort(size);
    depth = std::max(depth, geometry::depth_of_sort(size));
  }
  add_depth(Component::cut, depth);
}

void Counting::end_step(int level) {
  std::vector<cl_uint> counters(kernel::COUNTER_DEAREST + 1);
  runtime_.read(counters_, 0, counters.size(), counters.data());
  runtime_.fill(counters_, counters.size(), cl_uint{0});
  add_depth(Component::endgame, counters[kernel::COUNTER_DEAREST]);
  if (level >= static_cast<int>(work_.levels.size())) work_.levels.resize(level + 1);
  Work::Components& components = level < 0 ? work_.start : work_.levels[level];
  for (std::size_t c = 0; c < kComponents; ++c) {
    OperationCounts& counts = components[c];
    const cl_uint* kinds = counters.data() + 2 * kernel::KINDS * c;
    counts.arithmetic += whole(kinds + 2 * kernel::KIND_ARITHMETIC);
    counts.depths += whole(kinds + 2 * kernel::KIND_DEPTH);
    counts.orientations += whole(kinds + 2 * kernel::KIND_ORIENTATION);
    counts.circles += whole(kinds + 2 * kernel::KIND_CIRCLE);
    counts.critical_path = std::max(counts.critical_path, depth_[c]);
    depth_[c] = 0;
  }
  part_of(components, Component::cut).arithmetic += sort_comparisons_;
  sort_comparisons_ = 0;
}

void Counting::finish() {
  std::vector<cl_uint> sizes(kernel::MOST_COUNTED_SIZE + 1);
  runtime_.read(counters_, kernel::COUNTER_SIZES, sizes.size(), sizes.data());
  while (!sizes.empty() && sizes.back() == 0) sizes.pop_back();
  work_.endgame_sizes.assign(sizes.begin(), sizes.end());
}

}  // namespace flaunay::flattened
