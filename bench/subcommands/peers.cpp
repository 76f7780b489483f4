// flaunay-bench peers: flaunay beside other triangulators on the same points.
#include <fmt/format.h>

#include "bench/measuring/contest.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::peers {
namespace {

struct PeersRequest : Request {
  std::vector<std::string> peers;
};

/// The fastest of flaunay's modes on each input, and how it compares with the fastest of the others.
Json best_of(const Entries& entries, const std::vector<Input>& inputs) {
  Json best = Json::array();
  for (const Input& input : inputs) {
    const Entry* fastest[2] = {nullptr, nullptr};  // of the others, of flaunay
    for (const Entry& entry : entries) {
      const Entry*& own = fastest[entry.implementation->options.has_value()];
      if (entry.input == &input && entry.valid() && (own == nullptr || entry.median() < own->median())) {
        own = &entry;
      }
    }
    const auto [peer, flaunay] = fastest;
    if (flaunay == nullptr) continue;
    best.push_back({{"distribution", input.distribution}, {"n", input.n}, {"flaunay", flaunay->name()}});
    if (peer == nullptr) continue;
    best.back()["peer"] = peer->name();
    best.back()["ratio"] = flaunay->median() / peer->median();
  }
  return best;
}

Result measure_peers(const PeersRequest& request) {
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  const Entries of_peers = try_peers(request.peers, inputs, request.limit);
  Triangulator triangulator(request.device);
  Entries entries = beside(of_peers, mode_implementations(triangulator, request.modes), inputs);
  measure(entries, request.runs);
  measure_device_memory(entries, request.device);

  Result result(triangulator.device());
  add_entries(result, entries);
  result.tables["best"] = best_of(entries, inputs);
  return result;
}

constexpr const char* kHelp =
    "Triangulation alone: from an array of coordinates in memory to a triangulation in memory; making "
    "points, "
    "building kernels and releasing the result are not included. All implementations and inputs take turns, "
    "and "
    "the first run of each is not counted.\n\n"
    "What each time includes:\n"
    "  flaunay-MODE: the whole call, the way to the device and back too: points to triangles and neighbours "
    "in "
    "host arrays\n"
    "{}\n"
    "bytes_peak: for flaunay the most device memory held at once, without host arrays; for the others what "
    "one "
    "run in a process of its own adds to the resident memory at its peak.\n"
    "Peers with more than --limit seconds are not run on this or larger sizes of the distribution. All must "
    "have "
    "as many triangles as CGAL, or as flaunay's first mode where CGAL is not run; if not, a warning says so, "
    "the "
    "entry is not drawn, and the exit code is 1.";

void add_options(Options& options, PeersRequest& request) {
  std::string of_peers;
  for (const Peer& peer : all_peers()) {
    of_peers += fmt::format("  {}{}: {}\n", peer.name,
                            peer.run != nullptr ? "" : " (this build is without it)", peer.description);
    request.peers.push_back(peer.name);
  }
  options.help(fmt::format(kHelp, of_peers))
      .sizes({10000, 1000000})
      .distributions(kPaperDistributions)
      .modes({"flattened", "blocks"})
      .add("--peers", request.peers, "which others", CLI::IsMember(request.peers))
      .limit(60, "seconds that a run of another implementation may take")
      .runs();
}

const Subcommand kSubcommand("peers", "flaunay beside other triangulators on the same points", "",
                             measure_peers, add_options);

}  // namespace
}  // namespace flaunay::bench::peers
