// Other triangulators, each behind one function. They serve the benchmark only, never the library.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "inputs.hpp"

namespace flaunay::bench {

/// What one run of an implementation gave.
struct Outcome {
  double seconds;  ///< of what the implementation's description says
  std::size_t triangles;
};

struct Peer {
  std::string name;
  std::string description;  ///< what it is and what its time includes
  /// Empty if this build is without it. All but CGAL's take inputs of one set only.
  std::function<Outcome(const Input&)> run;
};

/// All of them, also those that this build is without.
const std::vector<Peer>& all_peers();

/// To triangles and neighbours in arrays, as flaunay; the sets of an input in a loop.
Outcome run_cgal(const Input& input);
Outcome run_qhull(const Input& input);
Outcome run_gts(const Input& input);

/// What became of a peer in a process of its own.
struct Trial {
  Outcome outcome{0, 0};
  std::size_t bytes_peak = 0;  ///< most resident memory during the run, less what was resident before
  std::string failure;         ///< empty if it went well
};

/// Runs a peer once in a child process, which is ended after `limit` seconds; see ask_child.
Trial try_peer(const Peer& peer, const Input& input, double limit);

}  // namespace flaunay::bench
