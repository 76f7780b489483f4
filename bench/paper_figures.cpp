#include "paper_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "inputs.hpp"

namespace flaunay::bench::paper {
namespace {

// Distributions have the first colours of the palette in all figures.
constexpr int kColorOfDefault = 5, kColorOfAlternate = 7;

std::string subtitle(const Experiment& experiment, std::size_t n = 0) {
  const std::string points = n > 0 ? fmt::format("{} points; ", n) : "";
  return fmt::format("{}median of {} instances, minimum to maximum", points, experiment.plan().instances);
}

void append(plot::Series& series, double x, const Summary& values) {
  series.x.push_back(x);
  series.y.push_back(values.median);
  series.low.push_back(values.low);
  series.high.push_back(values.high);
}

plot::Series series_of(std::size_t distribution) {
  plot::Series series{distributions()[distribution], {}, {}};
  series.color = static_cast<int>(distribution);
  return series;
}

/// A quantity against the number of points, a series for each distribution.
plot::Lines by_size(const Experiment& experiment, const std::string& title, const Method& method,
                    const plot::Axis& y, const Quantity& quantity) {
  plot::Lines panel;
  panel.title = title;
  panel.x = size_axis(experiment.sizes());
  panel.y = y;
  for (std::size_t d = 0; d < distributions().size(); ++d) {
    plot::Series series = series_of(d);
    for (const std::size_t n : experiment.sizes()) {
      append(series, static_cast<double>(n), summarize(experiment, distributions()[d], n, method, quantity));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

/// A quantity of one level of a run.
using LevelQuantity = std::function<double(const Run& run, const Run& dwyer, std::size_t level)>;

/// A quantity of the largest inputs by level 0 to the deepest and `beyond`, a series for each distribution.
plot::Lines by_level(const Experiment& experiment, const std::string& title, const Method& method,
                     const plot::Axis& x, const plot::Axis& y, const LevelQuantity& quantity,
                     std::size_t beyond = 0) {
  plot::Lines panel;
  panel.title = title;
  panel.x = x;
  panel.y = y;
  for (std::size_t d = 0; d < distributions().size(); ++d) {
    plot::Series series = series_of(d);
    const std::string& name = distributions()[d];
    const std::size_t levels = most_levels(experiment, name, experiment.largest(), method) + beyond;
    for (std::size_t level = 0; level < levels; ++level) {
      append(series, static_cast<double>(level),
             summarize(experiment, name, experiment.largest(), method,
                       [&](const Run& run, const Run& dwyer) { return quantity(run, dwyer, level); }));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

std::string cuts_title(Cut cut) { return std::string(cut_name(cut)) + " cuts"; }

// ---- 6: distributions

plot::Scatter picture(std::size_t distribution, std::size_t points, double visible) {
  plot::Scatter panel;
  panel.color = static_cast<int>(distribution);
  panel.visible = visible;
  const std::vector<double> coordinates = instance_coordinates(distributions()[distribution], points, 0);
  for (std::size_t i = 0; i < points; ++i) {
    panel.x.push_back(coordinates[2 * i]);
    panel.y.push_back(coordinates[2 * i + 1]);
  }
  return panel;
}

NamedFigure distributions_figure() {
  constexpr std::size_t kShown = 3000;
  constexpr double kKuzminShown = 0.95, kMiddle = 0.02;
  plot::Figure figure;
  figure.title = "Figure 6: the four distributions";
  figure.subtitle =
      fmt::format("above {} points; below, the middle of {} points: the square that holds {} of them", kShown,
                  kShown / kMiddle, kShown);
  figure.columns = distributions().size();
  for (std::size_t d = 0; d < distributions().size(); ++d) {
    const bool clipped = distributions()[d] == "kuzmin";
    plot::Scatter panel = picture(d, kShown, clipped ? kKuzminShown : 1);
    panel.title = distributions()[d];
    panel.caption =
        clipped ? fmt::format("the farthest {:.0f} % are not shown", 100 * (1 - kKuzminShown)) : "all points";
    figure.panels.push_back(std::move(panel));
  }
  for (std::size_t d = 0; d < distributions().size(); ++d) {
    plot::Scatter panel = picture(d, static_cast<std::size_t>(kShown / kMiddle), kMiddle);
    panel.caption = fmt::format("the middle {:.0f} %", 100 * kMiddle);
    figure.panels.push_back(std::move(panel));
  }
  return {"paper-figure-6-distributions.svg",
          "The inputs. Of kuzmin the points farthest out are not shown: without that the rest would be one "
          "dot. The lower row magnifies the middle.",
          std::move(figure)};
}

// ---- 7: work

NamedFigure work_figure(const Experiment& experiment) {
  const plot::Axis work{"operations per point"}, ratio{"times Dwyer's operations"};
  plot::Figure figure;
  figure.title = "Figure 7: work against Dwyer's algorithm";
  figure.subtitle = subtitle(experiment);
  figure.columns = 2;
  figure.panels = {by_size(experiment, "work of flaunay (prune, interquartile cuts)", kDefault, work,
                           operations_per_point),
                   by_size(experiment, "work of Dwyer's algorithm", kDwyer, work, operations_per_point),
                   by_size(experiment, "flaunay / Dwyer", kDefault, ratio, work_ratio),
                   by_size(experiment, "the paper's variant (balanced, alternate cuts) / Dwyer", kPublished,
                           ratio, work_ratio)};
  for (const std::size_t p : {std::size_t{2}, std::size_t{3}}) {
    std::get<plot::Lines>(figure.panels[p]).references = {
        {"Dwyer", 1, false}, {"paper, least", 1.1, false}, {"paper, most", 2.5, false}};
  }
  return {"paper-figure-7-work.svg",
          "Floating-point operations per point, and as multiples of Dwyer's. The paper has 1.1 to 2.5 times.",
          std::move(figure)};
}

// ---- 8: components

enum Part { kSorting, kCuts, kHull, kMerge, kSplit, kEndgame, kDwyersMerges, kParts };

std::vector<double> parts_of(const Run& run) {
  std::vector<double> parts(kParts);
  const auto share = [&](Component component) {
    return component_operations(run, component) / static_cast<double>(run.n);
  };
  parts[kSorting] = sorting_operations(run) / static_cast<double>(run.n);
  parts[kCuts] = share(Component::cut) - parts[kSorting];
  parts[kHull] = share(Component::hull);
  parts[run.method.algorithm == kDwyer.algorithm ? kDwyersMerges : kMerge] = share(Component::merge);
  parts[kSplit] = share(Component::split);
  parts[kEndgame] = share(Component::endgame);
  return parts;
}

plot::Bar components_bar(const Experiment& experiment, const std::string& distribution, const Method& method,
                         const std::string& name) {
  const std::size_t n = experiment.largest();
  plot::Bar bar{name, {}};
  for (std::size_t part = 0; part < kParts; ++part) {
    bar.parts.push_back(summarize(experiment, distribution, n, method, [&](const Run& run, const Run&) {
                          return parts_of(run)[part];
                        }).median);
  }
  const Summary whole = summarize(experiment, distribution, n, method, operations_per_point);
  bar.low = whole.low;
  bar.high = whole.high;
  return bar;
}

plot::Bars components_panel(const Experiment& experiment, Cut cut,
                            const std::vector<std::string>& algorithms) {
  plot::Bars panel;
  panel.title = cuts_title(cut);
  panel.y = {"operations per point"};
  panel.parts = {
      "sorting",       "cut: axes (Dwyer: also splits)", "hull", "border merge", "split", "end game",
      "Dwyer's merges"};
  panel.values = true;
  for (const std::string& distribution : distributions()) {
    plot::BarGroup group{distribution, {}};
    for (const std::string& algorithm : algorithms) {
      group.bars.push_back(components_bar(experiment, distribution, {algorithm, cut}, algorithm));
    }
    group.bars.push_back(components_bar(experiment, distribution, kDwyer, "Dwyer"));
    panel.groups.push_back(std::move(group));
  }
  return panel;
}

NamedFigure components_figure(const Experiment& experiment) {
  plot::Figure figure;
  figure.title = "Figure 8: work by component";
  figure.subtitle = subtitle(experiment, experiment.largest());
  figure.columns = 1;
  figure.panel_width = 900;
  figure.panels = {
      components_panel(experiment, Cut::interquartile, {"quickhull", "balanced", "prune", "monotone-chain"}),
      components_panel(experiment, Cut::alternate, {"quickhull", "balanced", "prune"})};
  return {"paper-figure-8-components.svg",
          "Operations per point by component, for each way to compute the dividing paths, beside Dwyer's "
          "algorithm. A bar is made of its components' medians.",
          std::move(figure)};
}

// ---- 9: depth

NamedFigure depth_figure(const Experiment& experiment) {
  const auto depth = [](const Run& run, const Run&) { return critical_path(run); };
  const plot::Axis y{"depth (operations)", plot::Scale::log10}, speed{"work / depth", plot::Scale::log10};
  plot::Figure figure;
  figure.title = "Figure 9: depth and average parallelism";
  figure.subtitle = subtitle(experiment);
  figure.columns = 2;
  figure.panels = {
      by_size(experiment, "depth of flaunay (prune, interquartile cuts)", kDefault, y, depth),
      by_size(experiment, "depth of the paper's variant (balanced, alternate cuts)", kPublished, y, depth),
      by_size(experiment, "work / depth of flaunay", kDefault, speed, parallelism),
      by_size(experiment, "work / depth of the paper's variant", kPublished, speed, parallelism)};
  for (const std::size_t p : {std::size_t{2}, std::size_t{3}}) {
    std::get<plot::Lines>(figure.panels[p]).references = {{"paper, at 10^{5}", 1e4, false}};
  }
  return {"paper-figure-9-depth.svg",
          "The critical path, summed over levels, and what it leaves for processors to do side by side.",
          std::move(figure)};
}

// ---- 10 to 12: levels

const plot::Axis kLevelAxis{"level"};

/// What halving at each level would leave.
plot::Series halves_of(int power) {
  plot::Series halves{"n / 2^{level}", {}, {}};
  halves.color = plot::kInkColor;
  halves.stroke = plot::Stroke::dashed;
  halves.markers = false;
  for (int level = 0; level <= power; ++level) {
    halves.x.push_back(level);
    halves.y.push_back(std::ldexp(1.0, power - level));
  }
  return halves;
}

NamedFigure largest_subproblem_figure(const Experiment& experiment) {
  plot::Figure figure;
  figure.title = "Figure 10: the largest subproblem of each level";
  figure.subtitle = subtitle(experiment, experiment.largest());
  figure.columns = 2;
  const std::vector<Method> cuts = {kDefault, {kDefault.algorithm, Cut::alternate}};
  for (const Method& method : cuts) {
    plot::Lines panel =
        by_level(experiment, cuts_title(method.cut), method, kLevelAxis,
                 {"internal points of the largest region", plot::Scale::log2},
                 [](const Run& run, const Run&, std::size_t level) { return largest_region(run, level); });
    panel.series.push_back(halves_of(experiment.plan().largest));
    figure.panels.push_back(std::move(panel));
  }
  for (const Method& method : cuts) {
    plot::Lines panel = by_level(experiment, "", method, kLevelAxis, {"the same / (n / 2^{level})"},
                                 [](const Run& run, const Run&, std::size_t level) {
                                   return std::ldexp(largest_region(run, level), static_cast<int>(level)) /
                                          static_cast<double>(run.n);
                                 });
    figure.panels.push_back(std::move(panel));
  }
  return {
      "paper-figure-10-largest-subproblem.svg",
      "Internal points of the largest region of each level, and the same relative to what halving at each "
      "level would leave. Cuts go through the median, so no region has more than half of its parent's.",
      std::move(figure)};
}

NamedFigure subproblem_sizes_figure(const Experiment& experiment) {
  plot::Figure figure;
  figure.title = "Figure 11: the sum of all subproblems of each level";
  figure.subtitle = subtitle(experiment, experiment.largest());
  for (const Method& method : {kDefault, Method{kDefault.algorithm, Cut::alternate}}) {
    figure.panels.push_back(
        by_level(experiment, cuts_title(method.cut), method, kLevelAxis, {"(internal points + corners) / n"},
                 [](const Run& run, const Run&, std::size_t level) { return subproblem_sizes(run, level); }));
  }
  return {"paper-figure-11-subproblem-sizes.svg",
          "Internal points and border corners of all regions that are cut at a level, relative to n. Borders "
          "add to it, regions that are finished take from it.",
          std::move(figure)};
}

plot::Lines cumulative_work_panel(const Experiment& experiment, const std::string& title,
                                  const Method& method) {
  plot::Lines panel = by_level(
      experiment, title, method, {"levels done"},
      {"operations so far / Dwyer's total", plot::Scale::linear, plot::Unit::percent},
      [](const Run& run, const Run& dwyer, std::size_t level) {
        return operations_until(run, level) / operations(dwyer);
      },
      1);
  panel.references = {{"Dwyer", 1, false}};
  return panel;
}

/// A panel's first levels, at a scale of their own.
plot::Lines beginning(plot::Lines panel, std::size_t points, const std::string& title) {
  panel.title = title;
  panel.references.clear();
  double high = 0;
  for (plot::Series& series : panel.series) {
    for (auto* values : {&series.x, &series.y, &series.low, &series.high}) {
      values->resize(std::min(values->size(), points));
    }
    high = std::max(high, series.high.back());
  }
  panel.x.high = static_cast<double>(points) - 0.8;
  panel.y.high = 1.05 * high;
  return panel;
}

NamedFigure cumulative_work_figure(const Experiment& experiment) {
  constexpr std::size_t kFirstLevels = 7;
  plot::Figure figure;
  figure.title = "Figure 12: what a coarse partition would cost";
  figure.subtitle = subtitle(experiment, experiment.largest()) + "; sorting is what is done before level 0";
  figure.columns = 2;
  const plot::Lines ours = cumulative_work_panel(experiment, "flaunay (prune, interquartile cuts)", kDefault);
  const plot::Lines published =
      cumulative_work_panel(experiment, "the paper's variant (balanced, alternate cuts)", kPublished);
  figure.panels = {ours, published, beginning(ours, kFirstLevels, "flaunay, first levels"),
                   beginning(published, kFirstLevels, "the paper's variant, first levels")};
  return {"paper-figure-12-cumulative-work.svg",
          "Work up to each level, sorting included, relative to all of Dwyer's: what a coarse partitioner "
          "would have done when it hands over to a sequential algorithm.",
          std::move(figure)};
}

// ---- Beyond the paper's figures

/// The share of regions that have at least so many corners.
plot::Series tail_of(std::size_t distribution, const std::vector<std::uint64_t>& histogram) {
  plot::Series series = series_of(distribution);
  series.markers = false;
  double regions = 0;
  for (const std::uint64_t count : histogram) regions += static_cast<double>(count);
  double at_least = regions;
  for (std::size_t k = 0; k < histogram.size(); ++k) {
    if (histogram[k] == 0) continue;
    series.x.push_back(static_cast<double>(k));
    series.y.push_back(at_least / regions);
    at_least -= static_cast<double>(histogram[k]);
  }
  return series;
}

NamedFigure endgame_figure(const Experiment& experiment) {
  plot::Figure figure;
  figure.title = "Figure 13: regions when the end game begins";
  figure.subtitle =
      fmt::format("{} points; {} instances together", experiment.largest(), experiment.plan().instances);
  for (const Method& method : {kDefault, Method{kDefault.algorithm, Cut::alternate}}) {
    plot::Lines panel;
    panel.title = cuts_title(method.cut);
    panel.x = {"corners", plot::Scale::log10};
    panel.y = {"share of regions with so many or more", plot::Scale::log10, plot::Unit::none};
    panel.references = {{"50", 50}};
    for (std::size_t d = 0; d < distributions().size(); ++d) {
      panel.series.push_back(
          tail_of(d, endgame_histogram(experiment, distributions()[d], experiment.largest(), method)));
    }
    figure.panels.push_back(std::move(panel));
  }
  return {"paper-figure-13-endgame-sizes.svg", "Corners of the regions that have no internal points left.",
          std::move(figure)};
}

plot::Bars cuts_panel(const Experiment& experiment, const std::string& title, const plot::Axis& y,
                      const Quantity& quantity) {
  plot::Bars panel;
  panel.title = title;
  panel.y = y;
  panel.values = true;
  for (const std::string& distribution : distributions()) {
    plot::BarGroup group{distribution, {}};
    for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
      const Summary values =
          summarize(experiment, distribution, experiment.largest(), {kDefault.algorithm, cut}, quantity);
      plot::Bar bar{cuts_title(cut), {values.median}};
      bar.low = values.low;
      bar.high = values.high;
      bar.color = cut == Cut::interquartile ? kColorOfDefault : kColorOfAlternate;
      group.bars.push_back(std::move(bar));
    }
    panel.groups.push_back(std::move(group));
  }
  return panel;
}

NamedFigure cuts_figure(const Experiment& experiment) {
  plot::Figure figure;
  figure.title = "Figure 14: interquartile against alternate cuts";
  figure.subtitle = subtitle(experiment, experiment.largest()) + "; dividing paths by prune";
  figure.columns = 3;
  figure.panel_width = 380;
  figure.panels = {
      cuts_panel(experiment, "work", {"operations per point"}, operations_per_point),
      cuts_panel(experiment, "largest region of the end game", {"corners", plot::Scale::log10},
                 largest_cycle),
      cuts_panel(experiment, "borders of the level that has most", {"corners / n"}, most_corners_per_point)};
  return {"paper-figure-14-cuts.svg",
          "The axis of each cut: across the longer interquartile range, or x and y in turn as in the paper.",
          std::move(figure)};
}

}  // namespace

std::vector<NamedFigure> figures(const Experiment& experiment) {
  return {distributions_figure(),
          work_figure(experiment),
          components_figure(experiment),
          depth_figure(experiment),
          largest_subproblem_figure(experiment),
          subproblem_sizes_figure(experiment),
          cumulative_work_figure(experiment),
          endgame_figure(experiment),
          cuts_figure(experiment)};
}

}  // namespace flaunay::bench::paper
