#include "peer.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>

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

struct Answer {
  PeerRun run;
  std::size_t bytes_peak;
};

[[noreturn]] void answer_from_child(const Peer& peer, const io::Points& points, int pipe) {
  // Freed memory that the allocator keeps would be used again without being seen; and the highest mark is
  // still the parent's until it is reset.
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
  const std::size_t before = status_bytes("VmRSS");
  Answer answer{peer.run(points), 0};
  const std::size_t peak = status_bytes("VmHWM");
  answer.bytes_peak = peak > before ? peak - before : 0;
  const bool told = write(pipe, &answer, sizeof answer) == sizeof answer;
  // Without destructors and exit handlers: those belong to the parent.
  _exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
}

/// Whether something can be read, or the other end is closed, before the limit is over.
bool wait_for(int pipe, double limit) {
  pollfd waiting{pipe, POLLIN, 0};
  return poll(&waiting, 1, static_cast<int>(1e3 * limit)) > 0;
}

std::function<PeerRun(const io::Points&)> if_built(bool built, PeerRun (*run)(const io::Points&)) {
  if (!built) return {};
  return run;
}

}  // namespace

// Peers that were not found when this was built.
#ifndef FLAUNAY_BENCH_CGAL
#define FLAUNAY_BENCH_CGAL 0
PeerRun run_cgal(const io::Points&) { throw Error(ErrorKind::usage, "built without CGAL"); }
#endif
#ifndef FLAUNAY_BENCH_QHULL
#define FLAUNAY_BENCH_QHULL 0
PeerRun run_qhull(const io::Points&) { throw Error(ErrorKind::usage, "built without Qhull"); }
#endif
#ifndef FLAUNAY_BENCH_GTS
#define FLAUNAY_BENCH_GTS 0
PeerRun run_gts(const io::Points&) { throw Error(ErrorKind::usage, "built without GTS"); }
#endif

const std::vector<Peer>& all_peers() {
  static const std::vector<Peer> kPeers = {
      {"cgal",
       "CGAL's Delaunay_triangulation_2 with Exact_predicates_inexact_constructions_kernel, exact, one "
       "thread: "
       "copying the points, sorting them spatially, inserting them as a range",
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

Trial try_peer(const Peer& peer, const io::Points& points, double limit) {
  int ends[2];
  if (pipe(ends) != 0) return {{0, 0}, 0, "cannot make a pipe"};
  std::fflush(nullptr);  // what is buffered would be written twice
  const pid_t child = fork();
  if (child < 0) return {{0, 0}, 0, "cannot make a process"};
  if (child == 0) {
    close(ends[0]);
    try {
      answer_from_child(peer, points, ends[1]);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}\n", peer.name, error.what());
      _exit(EXIT_FAILURE);
    }
  }
  close(ends[1]);
  Trial trial;
  Answer answer{};
  if (!wait_for(ends[0], limit)) {
    kill(child, SIGKILL);
    trial.failure = fmt::format("took more than {:g} s", limit);
  } else if (read(ends[0], &answer, sizeof answer) != sizeof answer) {
    trial.failure = "failed";
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (trial.failure == "failed" && WIFSIGNALED(status)) {
    trial.failure = fmt::format("was ended by signal {}", WTERMSIG(status));
  }
  trial.run = answer.run;
  trial.bytes_peak = answer.bytes_peak;
  return trial;
}

}  // namespace flaunay::bench
