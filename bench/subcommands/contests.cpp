// flaunay-bench peers, modes, scaling and cliffs: flaunay's modes and other triangulators on the same points.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>

#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/measuring/triangulators.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::contests {
namespace {

struct ContestRequest : Request {
  std::vector<std::string> peers, hulls{"prune"}, tunings{""};
  std::size_t peers_most = std::size_t{1} << 22;
};

// With other tuning, coordinates are multiples of 2^-kPlaces of the power of two above the largest, which
// fixed point takes, too.
constexpr int kPlaces = 61;

void round_to_places(Input& input) {
  double largest = 0;
  for (const double x : input.coordinates) largest = std::max(largest, std::fabs(x));
  const int shift = kPlaces - 1 - (largest == 0 ? 0 : std::ilogb(largest));
  for (double& x : input.coordinates) x = std::ldexp(std::nearbyint(std::ldexp(x, shift)), -shift);
}

/// Each mode with each tuning value, and with each hull where it has hulls: "flaunay-flattened/quickhull".
Implementations make_variants(std::deque<Triangulator>& triangulators, const ContestRequest& request) {
  Implementations variants;
  const std::string given = variable("FLAUNAY_TUNING");
  for (const std::string& tuning : request.tunings) {
    // In addition to the environment.
    Triangulator& triangulator = triangulators.emplace_back(
        tuning.empty() ? Triangulator(request.device)
                       : triangulator_with("FLAUNAY_TUNING", given.empty() ? tuning : given + "," + tuning,
                                           request.device));
    for (const std::string& mode : request.modes) {
      const bool has_hulls = mode_named(mode).cuts_regions;
      for (const std::string& hull : request.hulls) {
        if (!has_hulls && hull != request.hulls.front()) continue;
        std::string name = implementation_name(mode);
        if (has_hulls && request.hulls.size() > 1) name += "/" + hull;
        if (!tuning.empty()) name += "/" + tuning;
        variants.push_back(mode_implementation(triangulator, name, options_of(mode, hull)));
      }
    }
  }
  return variants;
}

/// Where another mode becomes the fastest, between neighbouring sizes by power laws. Differences within noise
/// are ignored.
void add_crossovers(Result& result, const Jobs& jobs) {
  constexpr double kNoise = 0.03;
  result.tables["crossovers"] = Json::array();
  std::map<std::pair<std::string, std::size_t>, const Job*> fastest_jobs;  // by distribution and size
  for (const Job& job : jobs) {
    const Job*& best = fastest_jobs[{job.input->distribution, job.input->n}];
    if (job.valid() && (best == nullptr || job.median() < best->median())) best = &job;
  }
  std::string fastest, distribution;
  std::size_t before = 0;
  for (const auto& [key, best] : fastest_jobs) {
    if (best == nullptr) continue;
    const std::size_t n = key.second;
    if (key.first != distribution) fastest.clear();
    distribution = key.first;
    // The logarithm of how many times as long as the best one here the one takes that was fastest before.
    const auto slower_at = [&](std::size_t size) {
      const Json there = changed(best->row, {{"n", size}});
      const auto times =
          ratio(median_of(jobs, changed(there, {{"implementation", fastest}})), median_of(jobs, there));
      return times ? std::log(*times) : 0;
    };
    const double here = slower_at(n);
    if (here >= kNoise) {
      const double at_least = std::min(0.0, slower_at(before)), share = at_least / (at_least - here);
      const auto least = static_cast<double>(before), most = static_cast<double>(n);
      result.tables["crossovers"].push_back({{"distribution", distribution},
                                             {"faster_below", fastest},
                                             {"faster_above", best->row["implementation"]},
                                             {"n", std::lround(least * std::pow(most / least, share))}});
    }
    if (fastest.empty() || here >= kNoise) fastest = best->row["implementation"];
    before = n;
  }
}

/// The fastest of flaunay's modes on each input, and how it compares with the fastest of the others.
void add_best(Result& result, const Jobs& jobs) {
  std::map<const Input*, std::array<const Job*, 2>> fastest;  // of the others, of flaunay
  for (const Job& job : jobs) {
    const Job*& best = fastest[job.input][job.options.has_value()];
    if (job.valid() && (best == nullptr || job.median() < best->median())) best = &job;
  }
  for (const auto& [input, of_input] : fastest) {
    const auto [peer, flaunay] = of_input;
    if (flaunay == nullptr) continue;
    Json row{
        {"distribution", input->distribution}, {"n", input->n}, {"flaunay", flaunay->row["implementation"]}};
    if (peer != nullptr) {
      row.update({{"peer", peer->row["implementation"]}, {"ratio", flaunay->median() / peer->median()}});
    }
    result.tables["best"].push_back(row);
  }
}

/// Each implementation on each input beside itself on uniform points, and the steepest cliff of each.
void add_cliffs(Result& result, const Jobs& jobs) {
  constexpr double kMostTimesUniform = 2;
  std::map<std::string, Json> worst;
  for (const Job& job : jobs) {
    const auto uniform = median_of(jobs, changed(job.row, {{"distribution", "uniform"}}));
    if (job.input->distribution == "uniform" || !job.valid() || !uniform) continue;
    const double times = job.median() / *uniform;
    const Json cliff = changed(
        job.row,
        {{"times_uniform", times}, {"limit", kMostTimesUniform}, {"within", times <= kMostTimesUniform}});
    result.tables["cliffs"].push_back(cliff);
    Json& own = worst[job.row["implementation"]];
    if (own.is_null() || own["times_uniform"] < cliff["times_uniform"]) own = cliff;
  }
  for (const auto& [name, cliff] : worst) result.tables["worst"].push_back(cliff);
}

template <auto add_tables>
Result measure_contest(const ContestRequest& request) {
  std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  if (request.tunings.size() > 1) std::for_each(inputs.begin(), inputs.end(), round_to_places);
  const Jobs of_peers = try_peers(request.peers, inputs, request.limit, request.peers_most);
  std::deque<Triangulator> triangulators;
  Jobs jobs = beside(of_peers, make_variants(triangulators, request), inputs);
  measure(jobs, request.runs, request.limit);
  if (request.tunings.size() == 1) measure_device_memory(jobs, request.device);
  Result result(triangulators.front().device());
  add_rows(result, jobs);
  add_tables(result, jobs);
  return result;
}

/// own: further text about a subcommand.
void add_options(Options& options, ContestRequest& request, const std::string& own = "") {
  std::vector<std::string> names;
  std::string of_peers;
  for (const Peer& peer : all_peers()) {
    names.push_back(peer.name);
    of_peers += fmt::format("  {}: {}\n", peer.name, peer.description);
  }
  options.add("--peers", request.peers, "which others, of those that this build has", CLI::IsMember(names))
      .add("--peers-most", request.peers_most, "largest size for the others")
      .add("--hulls", request.hulls, "which variants of the dividing paths; dwyer has none",
           CLI::IsMember(hull_names()))
      .add("--tunings", request.tunings,
           "values of FLAUNAY_TUNING to set beside each other, such as fixed_point=0,fixed_point=1")
      .add("--limit", request.limit,
           "what takes more seconds is not run at larger sizes, others not at this one either")
      .runs()
      .help(fmt::format(
          R"({}Triangulation alone: from an array of coordinates in memory to a triangulation in memory; making
points, building kernels and releasing the result are not included. What each time includes:
  flaunay-MODE: the whole call, the way to the device and back too: points to triangles and neighbours in host arrays
{}
bytes_peak: for flaunay the most device memory held at once, without host arrays; for the others what one run in a
process of its own, which is ended after --limit seconds, adds to the resident memory at its peak. All must have as
many triangles as CGAL, or as flaunay's first mode where CGAL is not run; if not, a warning says so, and the entry is
not drawn.)",
          own, of_peers));
}

const Subcommand kPeers("peers", "flaunay beside other triangulators on the same points", "",
                        measure_contest<add_best>, [](Options& options, ContestRequest& request) {
                          for (const Peer& peer : all_peers()) request.peers.push_back(peer.name);
                          options.sizes({10000, 1000000});
                          options.distributions(kPaperDistributions).modes({"flattened", "blocks"});
                          add_options(options, request);
                        });

constexpr const char* kCrossovers =
    R"(Crossovers are where another implementation becomes the fastest, interpolated between sizes by power laws,
where differences are above 3 %. )";

const Subcommand kModes("modes", "flaunay's modes beside each other, by number of points", "",
                        measure_contest<add_crossovers>, [](Options& options, ContestRequest& request) {
                          options.sizes(powers_of_two(8, 20)).distributions({"uniform"}).modes(mode_names());
                          add_options(options, request, kCrossovers);
                        });

const Subcommand kScaling("scaling", "time per point over many sizes, modes beside CGAL", "",
                          measure_contest<add_crossovers>, [](Options& options, ContestRequest& request) {
                            request.peers = {kCgal};
                            options.sizes(powers_of_two(10, 24));
                            options.distributions({"uniform", "kuzmin", "line"}).modes();
                            add_options(options, request, kCrossovers);
                          });

const Subcommand kCliffs(
    "cliffs", "inputs on which triangulators are slow, beside uniform points", "",
    measure_contest<add_cliffs>, [](Options& options, ContestRequest& request) {
      request.peers = {kCgal};
      options.sizes({100000, 1000000})
          .distributions({"uniform", "horizontal", "collinear", "thirty-lines", "power-of-two-span",
                          "one-ulp", "circle", "grid", "columns", "parabola", "integer-circle",
                          "mostly-equal", "two-clusters", "half-duplicates"})
          .modes();
      add_options(
          options, request,
          R"(Each time is set beside the same implementation's on as many uniform points; more than 2 times that is a
cliff.
)");
    });

}  // namespace
}  // namespace flaunay::bench::contests
