// flaunay-bench cliffs: inputs on which one triangulator or another is 10 to 100 times slower.
#include <fmt/format.h>

#include <algorithm>

#include "bench/measuring/contest.hpp"

namespace flaunay::bench::cliffs {
namespace {

constexpr double kMostTimesUniform = 2;
constexpr const char* kUniform = "uniform";

/// Each implementation on each input beside itself on uniform points.
Json cliffs_of(const Entries& entries) {
  Json cliffs = Json::array();
  for (const Entry& entry : entries) {
    const auto uniform = median_of(entries, entry.name(), kUniform, entry.input->n);
    if (entry.input->distribution == kUniform || !entry.valid() || !uniform) continue;
    const double times_uniform = entry.median() / *uniform;
    cliffs.push_back(entry.row);
    cliffs.back()["times_uniform"] = times_uniform;
    cliffs.back()["limit"] = kMostTimesUniform;
    cliffs.back()["within"] = times_uniform <= kMostTimesUniform;
  }
  return cliffs;
}

/// The steepest of each implementation.
Json worst_of(const Json& cliffs) {
  Json worst = Json::array();
  for (const Json& cliff : cliffs) {
    const auto found = std::find_if(worst.begin(), worst.end(), [&](const Json& candidate) {
      return candidate["implementation"] == cliff["implementation"];
    });
    if (found == worst.end()) {
      worst.push_back(cliff);
    } else if ((*found)["times_uniform"] < cliff["times_uniform"]) {
      *found = cliff;
    }
  }
  return worst;
}

Result measure_cliffs(const Request& request) {
  std::vector<std::string> distributions{kUniform};
  append(distributions, request.distributions);
  const std::vector<Input> inputs = make_inputs(distributions, request.sizes);
  const Entries of_cgal = try_peers({kCgal}, inputs, request.limit);
  Triangulator triangulator(request.device);
  Entries entries = beside(of_cgal, mode_implementations(triangulator, request.modes), inputs);
  measure(entries, request.runs, request.limit);

  Result result(triangulator.device());
  add_entries(result, entries);
  result.tables["cliffs"] = cliffs_of(entries);
  result.tables["worst"] = worst_of(result.tables["cliffs"]);
  return result;
}

const Subcommand kSubcommand(
    "cliffs", "inputs on which triangulators are slow, beside uniform points",
    fmt::format("Each time is set beside the same implementation's on as many uniform points; more than {:g} "
                "times that "
                "is a cliff. All implementations and inputs take turns, and the first run of each is not "
                "counted. CGAL "
                "is tried in a process of its own, which is ended after --limit seconds. The exit code is 1 "
                "if numbers "
                "of triangles differ from CGAL's.",
                kMostTimesUniform),
    measure_cliffs, [](Options& options, Request&) {
      options.sizes({100000, 1000000})
          .distributions({"horizontal", "collinear", "thirty-lines", "power-of-two-span", "one-ulp", "circle",
                          "grid", "columns", "parabola", "integer-circle", "mostly-equal", "two-clusters",
                          "half-duplicates"})
          .modes()
          .limit(10, "what takes more seconds is not run at larger sizes, CGAL not at this one either")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::cliffs
