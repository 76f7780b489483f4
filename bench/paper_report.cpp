#include "paper_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "paper_claims.hpp"

namespace flaunay::bench::paper {
namespace {

// ---- Markdown

std::string row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string rows_of(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (const std::vector<std::string>& cells : rows) text += row(cells);
  return text;
}

/// The first column holds names, the others numbers.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::string text = row(header) + "|---|";
  for (std::size_t c = 1; c < header.size(); ++c) text += "--:|";
  return text + "\n" + rows_of(rows);
}

std::string spread(const Summary& values, int digits) {
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", values.median, digits, values.low, digits, values.high,
                     digits);
}

std::string percent(double share, int digits) { return fmt::format("{:.{}f} %", 100 * share, digits); }

std::vector<std::string> with_distributions(std::vector<std::string> cells) {
  cells.insert(cells.end(), distributions().begin(), distributions().end());
  return cells;
}

// ---- Claims

std::string claims_section(const Experiment& e) {
  std::vector<std::vector<std::string>> rows;
  for (const Claim& claim : claims(e)) {
    const bool reasoned = claim.verdict != Verdict::agree && !claim.reason.empty();
    rows.push_back({claim.claim, claim.measured, fmt::format("**{}**", text_of(claim.verdict)),
                    claim.rule + (reasoned ? ". Why: " + claim.reason : "")});
  }
  return "| claim | measured | verdict | agree if |\n|---|---|---|---|\n" + rows_of(rows);
}

// ---- Tables beside the figures

std::vector<std::string> spreads(const Experiment& e, std::string name, std::size_t n, const Method& method,
                                 const Quantity& quantity, int digits) {
  std::vector<std::string> cells{std::move(name)};
  for (const std::string& distribution : distributions()) {
    cells.push_back(spread(summarize(e, distribution, n, method, quantity), digits));
  }
  return cells;
}

std::string by_size_table(const Experiment& e, const Method& method, const Quantity& quantity, int digits) {
  std::vector<std::vector<std::string>> rows;
  for (const std::size_t n : e.sizes()) {
    rows.push_back(spreads(e, fmt::format("{}", n), n, method, quantity, digits));
  }
  return table(with_distributions({"points"}), rows);
}

std::string work_tables(const Experiment& e) {
  std::vector<std::vector<std::string>> rows;
  for (const Method& method : methods()) {
    rows.push_back(spreads(e, method_name(method), e.largest(), method, operations_per_point, 0));
  }
  return fmt::format("Operations per point at {} points:\n\n{}\nflaunay's operations / Dwyer's:\n\n{}",
                     e.largest(), table(with_distributions({"method"}), rows),
                     by_size_table(e, kDefault, work_ratio, 3));
}

std::string components_table(const Experiment& e) {
  std::vector<std::vector<std::string>> rows;
  for (const Method& method : methods()) {
    for (const std::string& distribution : distributions()) {
      const auto per_point = [&](const std::function<double(const Run&)>& operations_of) {
        const Summary values = summarize(
            e, distribution, e.largest(), method,
            [&](const Run& run, const Run&) { return operations_of(run) / static_cast<double>(run.n); });
        return fmt::format("{:.1f}", values.median);
      };
      std::vector<std::string> cells{
          method_name(method), distribution, per_point(sorting_operations), per_point([](const Run& run) {
            return component_operations(run, Component::cut) - sorting_operations(run);
          })};
      for (std::size_t c = at(Component::hull); c < kComponents; ++c) {
        cells.push_back(
            per_point([c](const Run& run) { return component_operations(run, static_cast<Component>(c)); }));
      }
      cells.push_back(per_point([](const Run& run) { return operations(run); }));
      rows.push_back(std::move(cells));
    }
  }
  return fmt::format(
      "Operations per point at {} points, medians:\n\n{}", e.largest(),
      table({"method", "distribution", "sorting", "cut", "hull", "merge", "split", "end game", "all"}, rows));
}

std::string depth_tables(const Experiment& e) {
  const auto depth = [](const Run& run, const Run&) { return critical_path(run); };
  return "Depth of flaunay:\n\n" + by_size_table(e, kDefault, depth, 0) + "\nWork / depth of flaunay:\n\n" +
         by_size_table(e, kDefault, parallelism, 0);
}

/// Medians of a quantity by level.
std::string by_level_table(const Experiment& e, const std::string& column, const Method& method,
                           std::size_t beyond, const std::string& suffix,
                           const std::function<double(const Run&, const Run&, std::size_t)>& quantity,
                           int digits) {
  std::size_t levels = 0;
  for (const std::string& distribution : distributions()) {
    levels = std::max(levels, most_levels(e, distribution, e.largest(), method));
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t level = 0; level < levels + beyond; ++level) {
    std::vector<std::string> cells{fmt::format("{}", level)};
    for (const double value : medians(e, e.largest(), method, [&](const Run&run, const Run&dwyer) {
           return quantity(run, dwyer, level);
         })) {
      cells.push_back(fmt::format("{:.{}f}{}", value, digits, suffix));
    }
    rows.push_back(std::move(cells));
  }
  return table(with_distributions({column}), rows);
}

std::string largest_table(const Experiment& e) {
  return "Interquartile cuts:\n\n" +
         by_level_table(
             e, "level", kDefault, 0, "",
             [](const Run& run, const Run&, std::size_t level) { return largest_region(run, level); }, 0);
}

std::string sizes_table(const Experiment& e) {
  const auto sizes = [](const Run& run, const Run&, std::size_t level) {
    return subproblem_sizes(run, level);
  };
  return "Interquartile cuts:\n\n" + by_level_table(e, "level", kDefault, 0, "", sizes, 3) +
         "\nAlternate cuts:\n\n" +
         by_level_table(e, "level", {kDefault.algorithm, Cut::alternate}, 0, "", sizes, 3);
}

std::string cumulative_table(const Experiment& e) {
  return "flaunay, percent of Dwyer's total:\n\n" +
         by_level_table(
             e, "levels done", kDefault, 1, " %",
             [](const Run& run, const Run& dwyer, std::size_t level) {
               return 100 * operations_until(run, level) / operations(dwyer);
             },
             1) +
         fmt::format("\nUntil there are {} regions, relative to all of Dwyer's operations:\n\n",
                     kCoarseRegions) +
         table(with_distributions({""}),
               {spreads(e, "levels", e.largest(), kDefault, coarse_levels, 0),
                spreads(e, "work with sorting", e.largest(), kDefault, coarse_work, 3),
                spreads(e, "work after sorting", e.largest(), kDefault, coarse_work_after_sorting, 3)});
}

std::string endgame_table(const Experiment& e) {
  std::vector<std::vector<std::string>> rows;
  for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
    for (const std::string& distribution : distributions()) {
      const EndgameSizes sizes =
          endgame_sizes(endgame_histogram(e, distribution, e.largest(), {kDefault.algorithm, cut}));
      rows.push_back({cut_name(cut), distribution, fmt::format("{:.2f}", sizes.mean),
                      fmt::format("{:.0f}", sizes.median), fmt::format("{:.0f}", sizes.largest),
                      percent(sizes.share_over_50, 3)});
    }
  }
  return "Corners of a region without internal points, all instances together:\n\n" +
         table({"cuts", "distribution", "mean", "median", "largest", "over 50"}, rows);
}

std::string cuts_table(const Experiment& e) {
  std::vector<std::vector<std::string>> rows;
  for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
    const Method method{kDefault.algorithm, cut};
    const std::string name = cut_name(cut);
    rows.push_back(spreads(e, name + ": operations per point", e.largest(), method, operations_per_point, 0));
    rows.push_back(
        spreads(e, name + ": corners of the largest region", e.largest(), method, largest_cycle, 0));
    rows.push_back(
        spreads(e, name + ": most corners of a level / n", e.largest(), method, most_corners_per_point, 2));
  }
  return table(with_distributions({"cuts"}), rows);
}

/// In the order of the figures.
std::vector<std::string> tables(const Experiment& e) {
  return {"",
          work_tables(e),
          components_table(e),
          depth_tables(e),
          largest_table(e),
          sizes_table(e),
          cumulative_table(e),
          endgame_table(e),
          cuts_table(e)};
}

std::string figures_section(const Experiment& e, const std::vector<NamedFigure>& figures) {
  const std::vector<std::string> all_tables = tables(e);
  std::string text;
  for (std::size_t f = 0; f < figures.size(); ++f) {
    const NamedFigure& figure = figures[f];
    text += fmt::format("\n### {}\n\n{}\n\n![{}]({})\n", figure.figure.title, figure.caption,
                        figure.figure.title, figure.file);
    if (!all_tables[f].empty()) text += "\n" + all_tables[f];
  }
  return text;
}

// ---- The rest

std::string record_section(const Experiment& e, const nlohmann::json& record) {
  const Plan& plan = e.plan();
  const auto value = [&](const char* key) {
    const std::string text = record.at(key).get<std::string>();
    return text.empty() ? std::string("none") : text;
  };
  return "| record | |\n|---|---|\n" +
         rows_of({{"command", "`" + value("command") + "`"},
                  {"commit", value("commit")},
                  {"date", value("date")},
                  {"host", value("host") + "; all counts but those of the cross-check are made on it"},
                  {"device", value("device") + ", for the cross-check"},
                  {"inputs", fmt::format("2^{} to 2^{} points, {} instances of each of {}", plan.smallest,
                                         plan.largest, plan.instances, fmt::join(distributions(), ", "))},
                  {"numbers", "medians of the instances, in brackets minimum to maximum"}});
}

std::string cross_check_section(const std::vector<CrossCheck>& checks, const std::string& unchecked) {
  if (checks.empty()) return fmt::format("Not made: {}.\n", unchecked);
  std::vector<std::string> header{"distribution", "points", "all"};
  for (std::size_t c = 0; c < kComponents; ++c) header.push_back(component_name(c));
  std::vector<std::vector<std::string>> rows;
  double difference = 0;
  for (const CrossCheck& check : checks) {
    rows.push_back({check.distribution, fmt::format("{}", check.n), fmt::format("{:.4f}", check.all)});
    for (const double ratio : check.by_component) rows.back().push_back(fmt::format("{:.4f}", ratio));
    difference = std::max(difference, std::abs(check.all - 1));
  }
  const char* const conclusion = difference <= kAgreeingRatio
                                     ? "They agree, so the figures hold for the kernels too."
                                     : "They differ, so the figures hold for the twin only.";
  return fmt::format(
      "The flattened kernels' operations relative to those of the recursive twin, on one instance of each "
      "distribution; sorting is left out, as devices sort by radix. {}\n\n{}",
      conclusion, table(header, rows));
}

constexpr const char* kIntroduction =
    "G. E. Blelloch, G. L. Miller, D. Talmor: *Developing a practical projection-based parallel Delaunay "
    "algorithm*, SoCG 1996, counted operations and depth on four distributions. These are the same "
    "experiments "
    "with flaunay. All of this page, its figures and its data are written by the command below; they are "
    "counts, "
    "so they do not depend on the machine.\n\n"
    "*flaunay* is prune and interquartile cuts, what the library does unless told otherwise; *the paper's "
    "variant* "
    "is the balanced hull and alternate cuts.\n\n";

constexpr const char* kDifferences =
    "- **Cuts.** The paper cuts x and y in turn. flaunay cuts each region across its longer interquartile "
    "range, which "
    "keeps regions round and borders short on `line`; alternate cuts remain as an option.\n"
    "- **Dividing paths.** The paper computes them by quickhull and mends its skewed splits with the "
    "balanced split of "
    "Chan, Snoeyink and Yap. flaunay first drops by candidates from buckets what cannot be on a path "
    "(prune), so that "
    "quickhull sees few points. All variants are measured here.\n"
    "- **Degenerate input.** The paper assumes general position. Here every decision is exact and no input "
    "is perturbed; "
    "exact evaluations after an undecided filter are rare on these inputs and not counted.\n"
    "- **End game.** Regions are cut until they have no internal points; each that remains is triangulated "
    "on its own: "
    "over an edge stands the corner that sees it under the greatest angle.\n"
    "- **What is counted.** Floating-point operations including comparisons, as in the paper, but by rules "
    "of our own "
    "for each stage: [docs/counting.md](../../docs/counting.md). Dwyer's algorithm is counted by the same "
    "rules; "
    "both sort their input, and both counts include that.\n"
    "- **Generators.** The same four distributions, from generators of our own.\n";

}  // namespace

std::string report(const Experiment& experiment, const std::vector<NamedFigure>& figures,
                   const std::vector<CrossCheck>& checks, const std::string& unchecked,
                   const nlohmann::json& record) {
  return std::string("# The paper's experiments, made again\n\n") + kIntroduction +
         record_section(experiment, record) + "\n## The paper's claims\n\n" +
         fmt::format("At {} points unless it says otherwise.\n\n", experiment.largest()) +
         claims_section(experiment) + "\n## How this differs from the paper\n\n" + kDifferences +
         "\n## Figures\n\nData: [all runs](paper-runs.csv), [levels](paper-levels.csv), [end game "
         "sizes](paper-endgame.csv).\n" +
         figures_section(experiment, figures) + "\n## The kernels beside the twin\n\n" +
         cross_check_section(checks, unchecked);
}

}  // namespace flaunay::bench::paper
