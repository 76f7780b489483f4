// flaunay-bench modes: flaunay's modes beside each other, by number of points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/measuring/contest.hpp"

namespace flaunay::bench::modes {
namespace {

struct ModesRequest : Request {
  std::vector<std::string> hulls{"prune"};
  std::size_t count_up_to = 131072;
};

/// Each mode with each hull, where it has hulls: "flaunay-flattened/quickhull".
Implementations make_variants(Triangulator& triangulator, const ModesRequest& request) {
  Implementations variants;
  for (const std::string& mode : request.modes) {
    const bool has_hulls = mode_named(mode).cuts_regions;
    for (const std::string& hull : request.hulls) {
      if (!has_hulls && hull != request.hulls.front()) continue;
      const std::string name = implementation_name(mode);
      const bool named = has_hulls && request.hulls.size() > 1;
      variants.push_back(
          mode_implementation(triangulator, named ? name + "/" + hull : name, options_of(mode, hull)));
    }
  }
  return variants;
}

/// Operations by component, and in all; see docs/counting.md.
Json work_record(const research::Work& work) {
  const research::Work::Components components = totals(work);
  Json result{{"operations", total(components).operations()}};
  for (std::size_t c = 0; c < research::kComponents; ++c) {
    result[component_name(c)] = {{"operations", components[c].operations()},
                                 {"operations_with_bounds", components[c].operations_with_bounds()},
                                 {"critical_path", components[c].critical_path}};
  }
  return result;
}

/// Counts in runs of their own, which take longer, in the modes that can. The counts become details of the
/// last measured runs.
void count_work(Triangulator& triangulator, Entries& entries, std::size_t up_to) {
  Progress progress(entries.size());
  for (Entry& entry : entries) {
    progress.step(fmt::format("counting operations: {} on {}", entry.name(), input_name(*entry.input)));
    research::Options options = *entry.implementation->options;
    const bool can_count = mode_named(research::to_string(options.mode)).counts;
    if (!can_count || !entry.skipped.empty() || entry.input->n > up_to) continue;
    options.count = true;
    const research::Triangulation mesh = call(triangulator, *entry.input, options);
    if (mesh.work.levels.empty()) continue;
    Json& details = entry.outcome.details;
    details["work"] = work_record(mesh.work);
    details["operations_per_point"] =
        details["work"]["operations"].get<double>() / static_cast<double>(entry.input->n);
  }
}

// ---- Crossovers

/// Logarithms of median seconds by those of sizes.
using Curve = std::map<double, double>;
using NamedCurve = std::pair<std::string, Curve>;

/// By implementation, in the order of the entries.
std::vector<NamedCurve> curves_of(const Entries& entries, const std::string& distribution) {
  std::vector<NamedCurve> curves;
  for (const Entry& entry : entries) {
    if (!entry.valid() || entry.input->distribution != distribution) continue;
    auto curve = std::find_if(curves.begin(), curves.end(),
                              [&](const NamedCurve& candidate) { return candidate.first == entry.name(); });
    if (curve == curves.end()) curve = curves.insert(curves.end(), {entry.name(), {}});
    curve->second[std::log(static_cast<double>(entry.input->n))] = std::log(entry.median());
  }
  return curves;
}

/// Between measured sizes, by a power law between neighbours; NaN outside of them.
double interpolated(const Curve& curve, double n) {
  const auto next = curve.lower_bound(n);
  if (next == curve.end() || (next == curve.begin() && next->first != n)) return std::nan("");
  if (next->first == n) return next->second;
  const auto before = std::prev(next);
  const double share = (n - before->first) / (next->first - before->first);
  return (1 - share) * before->second + share * next->second;
}

/// Where the order of two curves changes, between sizes that both have. Differences within noise are no
/// order: the curves cross between the last size with one clear order and the first with the other.
void add_crossovers_of(const NamedCurve& a, const NamedCurve& b, const std::string& distribution,
                       const std::vector<NamedCurve>& all, Json& crossovers) {
  constexpr double kNoise = 0.03, kRounding = 1e-9;
  double previous_n = 0, previous_ratio = 0;
  for (const auto& [n, seconds] : a.second) {
    const auto other = b.second.find(n);
    const double ratio = other == b.second.end() ? 0 : seconds - other->second;
    if (std::abs(ratio) < kNoise) continue;
    if (previous_ratio * ratio < 0) {
      const double crossing = previous_n + previous_ratio / (previous_ratio - ratio) * (n - previous_n);
      const double there = interpolated(a.second, crossing) - kRounding;
      const bool anything_faster = std::any_of(all.begin(), all.end(), [&](const NamedCurve& curve) {
        return interpolated(curve.second, crossing) < there;
      });
      const bool a_below = previous_ratio < 0;
      crossovers.push_back({{"distribution", distribution},
                            {"faster_below", a_below ? a.first : b.first},
                            {"faster_above", a_below ? b.first : a.first},
                            {"n", std::lround(std::exp(crossing))},
                            {"of_fastest", !anything_faster}});
    }
    previous_n = n;
    previous_ratio = ratio;
  }
}

Json crossovers_of(const Entries& entries, const std::vector<std::string>& distributions) {
  Json crossovers = Json::array();
  for (const std::string& distribution : distributions) {
    const std::vector<NamedCurve> curves = curves_of(entries, distribution);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      for (std::size_t j = i + 1; j < curves.size(); ++j) {
        add_crossovers_of(curves[i], curves[j], distribution, curves, crossovers);
      }
    }
  }
  return crossovers;
}

Result measure_modes(const ModesRequest& request) {
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Triangulator triangulator(request.device);
  Entries entries = make_entries(make_variants(triangulator, request), inputs);
  measure(entries, request.runs, request.limit);
  measure_device_memory(entries, request.device);
  count_work(triangulator, entries, request.count_up_to);

  Result result(triangulator.device());
  add_entries(result, entries);
  result.tables["crossovers"] = crossovers_of(entries, request.distributions);
  return result;
}

const Subcommand kSubcommand(
    "modes", "flaunay's modes beside each other, by number of points",
    "Times are from points in host memory to triangles and neighbours in host memory; all modes and inputs "
    "take "
    "turns, and the first run of each is not counted. bytes_per_point is device memory. Crossovers are "
    "interpolated between sizes by power laws, where differences are above 3 %; of_fastest: no other mode is "
    "faster there. Operations are those of docs/counting.md, counted in a run of its own.",
    measure_modes, [](Options& options, ModesRequest& request) {
      options.sizes(powers_of_two(8, 20))
          .distributions({"uniform"})
          .modes(mode_names())
          .add("--hulls", request.hulls, "which variants of the dividing paths; dwyer has none",
               CLI::IsMember(hull_names()))
          .limit(10, "a mode whose first run takes more seconds is not run at larger sizes")
          .add("--count-up-to", request.count_up_to, "largest size whose operations are counted", kAny)
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::modes
