// flaunay-bench peers: flaunay beside other triangulators on the same points.
#include <fmt/format.h>

#include "contest.hpp"
#include "peer.hpp"

namespace flaunay::bench::peers {
namespace {

std::vector<std::string> peer_names() {
  std::vector<std::string> names;
  for (const Peer& peer : all_peers()) names.push_back(peer.name);
  return names;
}

struct Request : Measurement {
  std::vector<std::size_t> sizes{10000, 1000000};
  std::vector<std::string> distributions = kPaperDistributions;
  std::vector<std::string> modes{"flattened", to_string(kDefaultMode)};
  std::vector<std::string> peers = peer_names();
  double limit = 60;
};

std::string help() {
  std::string text =
      "Triangulation alone: from an array of coordinates in memory to a triangulation in memory; making "
      "points, building kernels and releasing the result are not included. All implementations and inputs "
      "take turns, and the first run of each is not counted.\n\n"
      "What each time includes:\n"
      "  flaunay-MODE: the whole call, the way to the device and back too: points to triangles and "
      "neighbours "
      "in host arrays\n";
  for (const Peer& peer : all_peers()) {
    text += fmt::format("  {}{}: {}\n", peer.name, peer.run != nullptr ? "" : " (this build is without it)",
                        peer.description);
  }
  return text +
         "\nbytes_peak: for flaunay the most device memory held at once, without host arrays; for the others "
         "what one run in a process of its own adds to the resident memory at its peak.\n"
         "Peers with more than --limit seconds are not run on this or larger sizes of the distribution. All "
         "must have as many triangles as CGAL, or as flaunay's first mode where CGAL is not run; if not, a "
         "warning says so, the entry is not drawn, and the exit code is 1.";
}

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

Result measure_peers(const Request& request) {
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  // Before there is a device: see ask_child.
  const Entries of_peers = try_peers(peer_implementations(request.peers), inputs, request.limit);
  Triangulator triangulator(request.device);
  Entries entries =
      by_input(make_entries(mode_implementations(triangulator, request.modes), inputs), of_peers);
  measure(entries, request.runs);
  measure_device_memory(entries, request.device);

  Result result{triangulator.device()};
  result.agree = check_counts(entries);
  add_entries(result.tables, entries);
  result.tables["best"] = best_of(entries, inputs);
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      add_command(app, action, "peers", "flaunay beside other triangulators on the same points", help(),
                  request, measure_peers);
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_option(command, "--peers", request->peers, "which others")->check(CLI::IsMember(peer_names()));
  add_option(command, "--limit", request->limit, "seconds that a run of another implementation may take");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::peers
