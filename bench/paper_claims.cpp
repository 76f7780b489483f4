#include "paper_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace flaunay::bench::paper {
namespace {

std::string percent(double share, int digits = 0) { return fmt::format("{:.{}f} %", 100 * share, digits); }

/// A median for each distribution, in their order, under one method.
using Medians = std::vector<double>;

double least(const Medians& values) { return *std::min_element(values.begin(), values.end()); }
double most(const Medians& values) { return *std::max_element(values.begin(), values.end()); }

double of(const Medians& values, const std::string& distribution) {
  const auto found = std::find(distributions().begin(), distributions().end(), distribution);
  return values.at(static_cast<std::size_t>(found - distributions().begin()));
}

std::string listed(const Medians& values, int digits) {
  std::vector<std::string> parts;
  for (std::size_t d = 0; d < values.size(); ++d) {
    parts.push_back(fmt::format("{} {:.{}f}", distributions()[d], values[d], digits));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string percent_range(const Medians& values) {
  return fmt::format("{} to {}", percent(least(values)), percent(most(values)));
}

/// By how much more than uniform.
Medians excess(const Medians& values) {
  Medians result;
  for (const double value : values) result.push_back(value / of(values, "uniform") - 1);
  return result;
}

/// flaunay as it is, and the algorithm as the paper has it.
struct Both {
  Medians ours, published;
};

Both both(const Experiment& e, std::size_t n, const Quantity& quantity) {
  return {medians(e, n, kDefault, quantity), medians(e, n, kPublished, quantity)};
}

std::string listed(const Both& values, int digits) {
  return fmt::format("flaunay: {}; the paper's variant: {}", listed(values.ours, digits),
                     listed(values.published, digits));
}

Verdict verdict_of(bool whole, bool part) {
  return whole ? Verdict::agree : part ? Verdict::partly : Verdict::disagree;
}

constexpr const char* kDepthsAreDearer =
    "without prune, every round of quickhull holds every point that is left against a chord, 12 operations "
    "each time; and the corners of a region's border, which at the last levels are more than its points, "
    "are looked at anew at every level";

Claim work_claim(const Experiment& e) {
  constexpr double kMost = 2.5;
  const Both ratios = both(e, e.largest(), work_ratio);
  return {"work within a factor of about 2 of Dwyer's: 1.1 to 2.5 times, by distribution", listed(ratios, 2),
          verdict_of(most(ratios.ours) <= kMost && most(ratios.published) <= kMost,
                     most(ratios.ours) <= kMost || most(ratios.published) <= kMost),
          "at most 2.5 times on every distribution; partly if by one of the two", kDepthsAreDearer};
}

Claim efficiency_claim(const Experiment& e) {
  constexpr double kLeast = 0.4;
  const Both efficiencies =
      both(e, e.largest(), [](const Run& run, const Run& dwyer) { return 1 / work_ratio(run, dwyer); });
  return {"work efficiency (Dwyer's operations / the algorithm's) 0.4 to 0.9", listed(efficiencies, 2),
          verdict_of(least(efficiencies.ours) >= kLeast && least(efficiencies.published) >= kLeast,
                     least(efficiencies.ours) >= kLeast || least(efficiencies.published) >= kLeast),
          "at least 0.4 on every distribution; partly if by one of the two", "as above, whose inverse it is"};
}

/// By how much more kuzmin costs than uniform, with one way to compute the dividing paths.
struct KuzminExcess {
  double interquartile, alternate;
};

KuzminExcess kuzmin_excess(const Experiment& e, const std::string& algorithm) {
  const auto with = [&](Cut cut) {
    return of(excess(medians(e, e.largest(), {algorithm, cut}, operations_per_point)), "kuzmin");
  };
  return {with(Cut::interquartile), with(Cut::alternate)};
}

std::string text_of(const KuzminExcess& excess) {
  return fmt::format("interquartile cuts {}, alternate cuts {}", percent(excess.interquartile),
                     percent(excess.alternate));
}

Claim quickhull_claim(const Experiment& e) {
  constexpr double kLeast = 0.5, kMost = 1.0, kNoticed = 0.25;
  const KuzminExcess alone = kuzmin_excess(e, "quickhull");
  const auto near = [&](double value) { return value >= kLeast && value <= kMost; };
  return {"kuzmin up to 75 % dearer than uniform with quickhull alone", text_of(alone),
          verdict_of(near(alone.interquartile) && near(alone.alternate),
                     std::max(alone.interquartile, alone.alternate) >= kNoticed),
          "50 to 100 % with either cut; partly from 25 %",
          "it depends on quickhull's share of all work, and that on what each predicate counts"};
}

Claim balanced_claim(const Experiment& e) {
  constexpr double kMost = 0.35;
  const KuzminExcess alone = kuzmin_excess(e, "quickhull"), balanced = kuzmin_excess(e, "balanced");
  return {"kuzmin up to 25 % dearer than uniform with the balanced hull",
          fmt::format("{}; with prune: {}", text_of(balanced), text_of(kuzmin_excess(e, "prune"))),
          verdict_of(std::max(balanced.interquartile, balanced.alternate) <= kMost,
                     balanced.interquartile < alone.interquartile && balanced.alternate < alone.alternate),
          "at most 35 % with either cut; partly if less than with quickhull alone",
          "besides what a round of quickhull costs, a balanced one computes a slope for each pair, a height "
          "for each point, and a depth for each pair on one side; its better splits have to save that first"};
}

/// The size next to so many points.
std::size_t size_near(const Experiment& e, double points) {
  const auto distance = [&](std::size_t n) { return std::abs(std::log(static_cast<double>(n) / points)); };
  const std::vector<std::size_t> sizes = e.sizes();
  return *std::min_element(sizes.begin(), sizes.end(),
                           [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
}

Claim parallelism_claim(const Experiment& e) {
  constexpr double kLeast = 3.2e3, kMost = 3.2e4;  // half a decade to either side
  const std::size_t n = size_near(e, 1e5);
  const Both values = both(e, n, parallelism);
  const auto near = [&](const Medians& v) { return least(v) >= kLeast && most(v) <= kMost; };
  return {"work / depth about 10^4 at 10^5 points", fmt::format("at {} points, {}", n, listed(values, 0)),
          verdict_of(near(values.ours) && near(values.published),
                     most(values.ours) >= kLeast || most(values.published) >= kLeast),
          "all within half a decade of 10^4; partly if one is as high",
          "a round of quickhull is as deep here as its predicate is long, and a region's end game is "
          "sequential; less work for the same depth makes less parallelism"};
}

/// Whether regions are as small as the paper says on every distribution, with one way to cut.
struct SmallRegions {
  std::string text;
  bool agree;
};

SmallRegions small_regions(const Experiment& e, Cut cut) {
  constexpr double kMany = 10, kRare = 0.01;
  EndgameSizes worst;
  for (const std::string& distribution : distributions()) {
    const EndgameSizes sizes =
        endgame_sizes(endgame_histogram(e, distribution, e.largest(), {kDefault.algorithm, cut}));
    worst.mean = std::max(worst.mean, sizes.mean);
    worst.share_over_50 = std::max(worst.share_over_50, sizes.share_over_50);
    worst.largest = std::max(worst.largest, sizes.largest);
  }
  return {fmt::format("{} cuts: mean at most {:.1f}, over 50 at most {}, largest {:.0f}", cut_name(cut),
                      worst.mean, percent(worst.share_over_50, 2), worst.largest),
          worst.mean < kMany && worst.share_over_50 < kRare};
}

Claim endgame_claim(const Experiment& e) {
  const SmallRegions interquartile = small_regions(e, Cut::interquartile);
  const SmallRegions alternate = small_regions(e, Cut::alternate);
  return {"components have fewer than 10 corners on average when the end game begins, rarely over 50",
          interquartile.text + "; " + alternate.text,
          verdict_of(interquartile.agree && alternate.agree, interquartile.agree || alternate.agree),
          "mean below 10 and less than 1 % of regions over 50, on every distribution with either cut; partly "
          "with one of them",
          "these are whole regions, which may fall apart into several components; and where alternate cuts "
          "run along dense strips, borders are long"};
}

Claim decline_claim(const Experiment& e) {
  constexpr double kMost = 0.75;
  double worst = 0, mean = 0;
  for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
    for (const std::string& distribution : distributions()) {
      for (int i = 0; i < e.plan().instances; ++i) {
        const Decline decline =
            decline_of_largest_region(e.run(distribution, e.largest(), {kDefault.algorithm, cut}, i));
        worst = std::max(worst, decline.worst);
        mean = std::max(mean, decline.mean);
      }
    }
  }
  return {"the largest subproblem falls geometrically from level to level",
          fmt::format("to {:.2f} of the level before on average, to {:.2f} at worst", mean, worst),
          verdict_of(worst <= kMost, mean <= kMost),
          "to at most three quarters at every level, with either cut; partly if on average"};
}

Claim coarse_claim(const Experiment& e) {
  constexpr double kNearlyFree = 0.1;
  const Both work = both(e, e.largest(), coarse_work_after_sorting);
  const Medians levels = medians(e, e.largest(), kDefault, coarse_levels);
  const Medians sorting = medians(e, e.largest(), kDefault, [](const Run& run, const Run& dwyer) {
    return sorting_operations(run) / operations(dwyer);
  });
  return {"as a coarse partitioner the algorithm is nearly free",
          fmt::format("{} regions after {:.0f} levels, for {} of all of Dwyer's operations (the paper's "
                      "variant: {}); sorting, which a sequential algorithm needs too, takes {}",
                      kCoarseRegions, most(levels), percent_range(work.ours), percent_range(work.published),
                      percent_range(sorting)),
          verdict_of(most(work.ours) <= kNearlyFree, least(work.ours) <= kNearlyFree),
          "at most 10 % by flaunay on every distribution, after sorting; partly if on one",
          "a level touches every point, and a tenth of Dwyer's operations for four of them leaves a few "
          "operations for each"};
}

Claim work_goal(const Experiment& e) {
  const Medians ratios = medians(e, e.largest(), kDefault, work_ratio);
  return {"goal of this project: at most 1.0 times Dwyer's operations on each distribution",
          listed(ratios, 2), verdict_of(most(ratios) <= 1, least(ratios) <= 1),
          "on every distribution; partly if on one"};
}

Claim hull_goal(const Experiment& e) {
  constexpr double kMost = 0.1;
  const Medians above = excess(medians(e, e.largest(), kDefault, [](const Run& run, const Run&) {
    return component_operations(run, Component::hull);
  }));
  std::vector<std::string> parts;
  for (const char* distribution : {"normal", "kuzmin", "line"}) {
    parts.push_back(fmt::format("{} {:+.0f} %", distribution, 100 * of(above, distribution)));
  }
  return {"goal of this project: no distribution more than 10 % above uniform in the hull",
          fmt::format("{}", fmt::join(parts, ", ")),
          verdict_of(most(above) <= kMost, std::min(of(above, "kuzmin"), of(above, "line")) <= kMost),
          "on every distribution; partly if on kuzmin or line"};
}

}  // namespace

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::agree:
      return "agree";
    case Verdict::partly:
      return "partly";
    case Verdict::disagree:
      break;
  }
  return "disagree";
}

std::vector<Claim> claims(const Experiment& experiment) {
  return {work_claim(experiment),     efficiency_claim(experiment),  quickhull_claim(experiment),
          balanced_claim(experiment), parallelism_claim(experiment), endgame_claim(experiment),
          decline_claim(experiment),  coarse_claim(experiment),      work_goal(experiment),
          hull_goal(experiment)};
}

}  // namespace flaunay::bench::paper
