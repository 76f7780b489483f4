// Calls on many small sets: one thread computes a group of sets from the first stage to the last, while all
// its arrays are in that core's cache.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "call/implementation.hpp"
#include "host/clock.hpp"
#include "mesh/join.hpp"
#include "statistics/phases.hpp"

namespace flaunay::call {

using mesh::Group;

/// The groups of all sets for an engine. Empty if sets are too large, if all are one group, or if the engine
/// is a device.
std::vector<Group> groups_of(const Engine& engine, const std::vector<std::size_t>& offsets);

/// Joins work(group k) of all groups, which must use no runtime but that of its thread. Returns nothing if
/// one ends by an exception: the sets together tell which error is the first one.
template <typename Result, typename Work>
std::optional<Result> by_groups(Engine& engine, const std::vector<Group>& groups, const Options& options,
                                const Work& work) {
  // So many are joined while they are in caches, and the next ones get their memory.
  constexpr std::size_t kGroupsOfAThread = 32;
  const statistics::Phases phases(options);
  phases.progress("triangulate", 0);
  double computing = 0, joining = 0, begin = host::now();
  mesh::Joined<Result> joined;
  std::vector<Result> parts;
  while (joined.groups < groups.size()) {
    const std::size_t first = joined.groups;
    parts.clear();
    parts.resize(std::min(groups.size() - first, kGroupsOfAThread * engine.runtime.threads()));
    try {
      engine.runtime.share(parts.size(), [&](std::size_t k) { parts[k] = work(first + k); });
    } catch (const Error&) {
      return {};
    }
    const double computed = host::now();
    mesh::join(engine.runtime, groups, parts, joined);
    computing += computed - std::exchange(begin, host::now());
    joining += begin - computed;
    phases.progress("triangulate",
                    0.9 * static_cast<double>(joined.groups) / static_cast<double>(groups.size()));
  }
  Statistics& statistics = joined.result.statistics;
  statistics.seconds = computing + joining;
  statistics.phases = {{"triangulate", computing}, {"output", joining}};
  phases.progress("output", 1);
  return std::move(joined.result);
}

}  // namespace flaunay::call
