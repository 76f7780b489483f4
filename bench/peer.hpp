// Other triangulators, each behind one function. They serve the benchmark only, never the library.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/points.hpp"

namespace flaunay::bench {

/// What one run of a peer gave.
struct PeerRun {
  double seconds;  ///< from the array of coordinates to the triangulation in the peer's own structure
  std::size_t triangles;
};

struct Peer {
  std::string name;
  std::string description;  ///< what it is and what its time includes
  /// Empty if this build is without it.
  std::function<PeerRun(const io::Points&)> run;
};

/// All of them, also those that this build is without.
const std::vector<Peer>& all_peers();

PeerRun run_cgal(const io::Points& points);
PeerRun run_qhull(const io::Points& points);
PeerRun run_gts(const io::Points& points);

/// What became of a peer in a process of its own.
struct Trial {
  PeerRun run{0, 0};
  std::size_t bytes_peak = 0;  ///< most resident memory during the run, less what was resident before
  std::string failure;         ///< empty if it went well
};

/// Runs a peer once in a child process, which is ended after `limit` seconds.
Trial try_peer(const Peer& peer, const io::Points& points, double limit);

}  // namespace flaunay::bench
