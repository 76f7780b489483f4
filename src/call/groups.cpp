#include "call/groups.hpp"

#include "tuning/tuning.hpp"

namespace flaunay::call {

std::vector<Group> groups_of(const Engine& engine, const std::vector<std::size_t>& offsets) {
  const Tuning& tuning = tuning_of(engine.runtime);
  // Launches of single threads are not recorded.
  if (!engine.runtime.is_native() || engine.runtime.accounts().log != nullptr) return {};
  if (offsets.back() <= tuning.group_points || tuning.group_points == 0) return {};
  std::vector<Group> groups;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    if (offsets[s + 1] - offsets[s] > tuning.block_points) return {};
    if (s == 0 || offsets[s + 1] - groups.back().first_point > tuning.group_points)
      groups.push_back({{0}, offsets[s]});
    groups.back().offsets.push_back(offsets[s + 1] - groups.back().first_point);
  }
  return groups.size() > 1 ? groups : std::vector<Group>();
}

}  // namespace flaunay::call
