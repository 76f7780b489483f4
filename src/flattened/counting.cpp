#include "flattened/counting.hpp"

#include <algorithm>

#include "recursive/sort.hpp"

namespace flaunay::flattened {
namespace {

// As in kernels/shared/counting.h.
constexpr std::size_t kKinds = 4;
constexpr std::size_t kDearest = 2 * kComponents * kKinds;
constexpr std::size_t kSizes = kDearest + 1;
constexpr std::size_t kMostCountedSize = 1023;
constexpr std::size_t kCounters = kSizes + kMostCountedSize + 1;

std::uint64_t whole(const cl_uint* halves) {
  return halves[0] + (static_cast<std::uint64_t>(halves[1]) << 32);
}

}  // namespace

Counting::Counting(host::Runtime& runtime, host::Arena& arena, Work& work)
    : runtime_(runtime), work_(work), counters_(arena.allocate<cl_uint>(kCounters)) {
  runtime_.fill(counters_, kCounters, cl_uint{0});
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
    sort_comparisons_ += recursive::comparisons_to_sort(size);
    depth = std::max(depth, recursive::depth_of_sort(size));
  }
  add_depth(Component::cut, depth);
}

void Counting::end_step(int level) {
  std::vector<cl_uint> counters(kDearest + 1);
  runtime_.read(counters_, 0, counters.size(), counters.data());
  runtime_.fill(counters_, counters.size(), cl_uint{0});
  add_depth(Component::endgame, counters[kDearest]);
  if (level >= static_cast<int>(work_.levels.size())) work_.levels.resize(level + 1);
  Work::Components& components = level < 0 ? work_.start : work_.levels[level];
  for (std::size_t c = 0; c < kComponents; ++c) {
    OperationCounts& counts = components[c];
    const cl_uint* kinds = counters.data() + 2 * kKinds * c;
    counts.arithmetic += whole(kinds);
    counts.depths += whole(kinds + 2);
    counts.orientations += whole(kinds + 4);
    counts.circles += whole(kinds + 6);
    counts.critical_path = std::max(counts.critical_path, depth_[c]);
    depth_[c] = 0;
  }
  components[static_cast<std::size_t>(Component::cut)].arithmetic += sort_comparisons_;
  sort_comparisons_ = 0;
}

void Counting::finish() {
  std::vector<cl_uint> sizes(kMostCountedSize + 1);
  runtime_.read(counters_, kSizes, sizes.size(), sizes.data());
  while (!sizes.empty() && sizes.back() == 0) sizes.pop_back();
  work_.endgame_sizes.assign(sizes.begin(), sizes.end());
}

}  // namespace flaunay::flattened
