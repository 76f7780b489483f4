// Calls on many small sets: groups of them, each of which one thread computes from the first stage to the
// last, while all that it needs is in that core's cache.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "call/implementation.hpp"
#include "flaunay/constrained.hpp"
#include "host/clock.hpp"
#include "statistics/phases.hpp"

namespace flaunay::call {

/// A group of sets that follow each other.
struct Group {
  std::vector<std::size_t> offsets;  ///< of its sets, from its first point on
  std::size_t first_point = 0;
};

/// The groups of all sets for an engine. Empty if sets are too large, if all are one group, or if the engine
/// is a device.
std::vector<Group> groups_of(const Engine& engine, const std::vector<std::size_t>& offsets);

/// The sets of all groups together. Takes the memory of the parts.
Triangulation join(host::Runtime& runtime, const std::vector<Group>& groups,
                   std::vector<Triangulation>& parts);
/// parts: without added points, each segment is one piece.
ConstrainedTriangulation join(host::Runtime& runtime, const std::vector<Group>& groups,
                              std::vector<ConstrainedTriangulation>& parts);

/// Joins work(group k) of all groups, which must use no runtime but that of its thread. Returns nothing if
/// one ends by an exception: the sets together tell which error is the first one.
template <typename Result, typename Work>
std::optional<Result> by_groups(Engine& engine, const std::vector<Group>& groups, const Options& options,
                                const Work& work) {
  const statistics::Phases phases(options);
  phases.progress("triangulate", 0);
  const double begin = host::now();
  std::vector<Result> parts(groups.size());
  try {
    engine.runtime.share(groups.size(), [&](std::size_t k) { parts[k] = work(k); });
  } catch (const Error&) {
    return {};
  }
  phases.progress("output", 0.9);
  const double computed = host::now();
  Result result = join(engine.runtime, groups, parts);
  const double end = host::now();
  result.statistics.seconds = end - begin;
  result.statistics.phases = {{"triangulate", computed - begin}, {"output", end - computed}};
  phases.progress("output", 1);
  return result;
}

}  // namespace flaunay::call
