#include "peer.hpp"

#include <malloc.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "child.hpp"
#include "flaunay/flaunay.hpp"

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

/// Runs the peer in this process, which must be a child: what was resident before counts as the parent's.
nlohmann::json run_measured(const Peer& peer, const Input& input) {
  // Freed memory that the allocator keeps would be used again without being seen; and the highest mark is
  // still the parent's until it is reset.
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  const std::size_t before = status_bytes("VmRSS");
  const Outcome outcome = peer.run(input);
  const std::size_t peak = status_bytes("VmHWM");
  return {{"seconds", outcome.seconds},
          {"triangles", outcome.triangles},
          {"bytes_peak", peak > before ? peak - before : 0}};
}

std::function<Outcome(const Input&)> if_built(bool built, Outcome (*run)(const Input&)) {
  if (!built) return {};
  return run;
}

}  // namespace

// Peers that were not found when this was built.
#ifndef FLAUNAY_BENCH_CGAL
#define FLAUNAY_BENCH_CGAL 0
Outcome run_cgal(const Input&) { throw Error(ErrorKind::usage, "built without CGAL"); }
#endif
#ifndef FLAUNAY_BENCH_QHULL
#define FLAUNAY_BENCH_QHULL 0
Outcome run_qhull(const Input&) { throw Error(ErrorKind::usage, "built without Qhull"); }
#endif
#ifndef FLAUNAY_BENCH_GTS
#define FLAUNAY_BENCH_GTS 0
Outcome run_gts(const Input&) { throw Error(ErrorKind::usage, "built without GTS"); }
#endif

const std::vector<Peer>& all_peers() {
  static const std::vector<Peer> kPeers = {
      {"cgal",
       "CGAL's Delaunay_triangulation_2 with Exact_predicates_inexact_constructions_kernel, exact, one "
       "thread: "
       "copying the points, sorting them spatially with their indices, inserting them, writing triangles and "
       "neighbours into arrays",
       if_built(FLAUNAY_BENCH_CGAL, run_cgal)},
      {"qhull",
       "libqhull_r with 'd Qt Qbb Qc Qz Q12', not exact (it merges facets that it cannot tell apart), one "
       "thread: lifting the points, their convex hull in three dimensions, splitting merged facets",
       if_built(FLAUNAY_BENCH_QHULL, run_qhull)},
      {"gts",
       "GTS's gts_delaunay_add_vertex, exact predicates, one thread: making its vertices, sorting them "
       "(rounds "
       "that double in size, in each along a Hilbert curve), inserting each near the one before, removing "
       "the "
       "enclosing triangle",
       if_built(FLAUNAY_BENCH_GTS, run_gts)},
  };
  return kPeers;
}

Trial try_peer(const Peer& peer, const Input& input, double limit) {
  const Answer answer = ask_child([&] { return run_measured(peer, input).dump(); }, limit);
  if (!answer.failure.empty()) return {{0, 0}, 0, answer.failure};
  const auto json = nlohmann::json::parse(answer.text);
  return {{json.at("seconds"), json.at("triangles")}, json.at("bytes_peak"), ""};
}

}  // namespace flaunay::bench
