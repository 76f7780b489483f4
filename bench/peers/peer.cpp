#include "bench/peers/peer.hpp"

#include <malloc.h>

#include <algorithm>
#include <fstream>

#include "bench/measuring/processes.hpp"

namespace flaunay::bench {
namespace {

/// A figure in kB of /proc/self/status, in bytes.
std::size_t status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kilobytes = 0;
    if (word == name + ":" && status >> kilobytes) return 1024 * kilobytes;
  }
  return 0;
}

}  // namespace

std::vector<Peer>& all_peers() {
  static std::vector<Peer> peers = {
      {kCgal,
       "CGAL's Delaunay_triangulation_2 with Exact_predicates_inexact_constructions_kernel, exact, one "
       "thread: copying the points, sorting them spatially with their indices, inserting them, writing "
       "triangles and neighbours into arrays"},
      {"qhull",
       "libqhull_r with 'd Qt Qbb Qc Qz Q12', not exact (it merges facets that it cannot tell apart), one "
       "thread: lifting the points, their convex hull in three dimensions, splitting merged facets"},
      {"gts",
       "GTS's gts_delaunay_add_vertex, exact predicates, one thread: making its vertices, sorting them "
       "(rounds that double in size, in each along a Hilbert curve), inserting each near the one before, "
       "removing the enclosing triangle"},
  };
  return peers;
}

BuiltPeer::BuiltPeer(const std::string& name, Outcome (*run)(const Input&)) {
  for (Peer& peer : all_peers()) {
    if (peer.name == name) peer.run = run;
  }
}

Trial try_peer(const std::function<Outcome(const Input&)>& run, const Input& input, double limit) {
  const auto peak_of_run = [&] {
    // Freed memory that the allocator keeps would be used again without being seen; and the highest mark is
    // still the parent's until it is reset.
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
    const std::size_t before = status_bytes("VmRSS");
    run(input);
    return std::to_string(std::max(status_bytes("VmHWM"), before) - before);
  };
  const Answer answer = ask_child(peak_of_run, limit);
  if (!answer.failure.empty()) return {0, answer.failure};
  return {std::stoull(answer.text), ""};
}

Corners sorted_corners(const std::int32_t* triangle) {
  Corners corners{triangle[0], triangle[1], triangle[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace flaunay::bench
